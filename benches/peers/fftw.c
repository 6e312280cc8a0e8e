/* One operator application by FFTW: r2c, product with a real symbol that includes the normalisation, c2r; measured plans,
 * one thread, aligned arrays. Prints a line of JSON with the median time of `count` applications after two that do not
 * count.
 *
 *     fftw LIBRARY N COUNT WISDOM
 *
 * LIBRARY is a shared libfftw3 or libfftw3f (compile with -DREAL=float); WISDOM a file that keeps the plans of a run. The
 * field is a fixed pattern, and `check` the sum of the squares of what comes out, the same for every build.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#ifndef REAL
#define REAL double
#define PREFIX "fftw_"
#else
#define PREFIX "fftwf_"
#endif
#define MEASURE 0u
#define DESTROY_INPUT 1u

typedef REAL complex_[2];
typedef void *plan;

static void *library;

static void *symbol(const char *name) {
    char full[64];
    snprintf(full, sizeof full, PREFIX "%s", name);
    void *found = dlsym(library, full);
    if (!found) {
        fprintf(stderr, "%s: %s\n", full, dlerror());
        exit(1);
    }
    return found;
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static int order(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(int argc, char **argv) {
    if (argc != 5) {
        fprintf(stderr, "usage: fftw LIBRARY N COUNT WISDOM\n");
        return 1;
    }
    library = dlopen(argv[1], RTLD_NOW);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    int n = atoi(argv[2]), count = atoi(argv[3]), half = n / 2 + 1;
    size_t nodes = (size_t)n * n, waves = (size_t)n * half;
    void *(*alloc)(size_t) = symbol("malloc");
    plan (*r2c)(int, int, REAL *, complex_ *, unsigned) = symbol("plan_dft_r2c_2d");
    plan (*c2r)(int, int, complex_ *, REAL *, unsigned) = symbol("plan_dft_c2r_2d");
    void (*run_r2c)(plan, REAL *, complex_ *) = symbol("execute_dft_r2c");
    void (*run_c2r)(plan, complex_ *, REAL *) = symbol("execute_dft_c2r");
    int (*load)(const char *) = symbol("import_wisdom_from_filename");
    int (*save)(const char *) = symbol("export_wisdom_to_filename");
    const char *version = symbol("version");

    REAL *u = alloc(nodes * sizeof *u), *p = alloc(nodes * sizeof *p), *q = malloc(waves * sizeof *q);
    complex_ *spectrum = alloc(waves * sizeof *spectrum);
    double *seconds = malloc(count * sizeof *seconds);
    if (!u || !p || !q || !spectrum || !seconds) {
        fprintf(stderr, "out of memory\n");
        return 1;
    }
    load(argv[4]);
    plan forward = r2c(n, n, u, spectrum, MEASURE);
    plan inverse = c2r(n, n, spectrum, p, MEASURE | DESTROY_INPUT);
    save(argv[4]);

    for (size_t i = 0; i < nodes; i++)
        u[i] = (REAL)((i * 2654435761u) % 1009) / 1009;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < half; j++) {
            double kx = i <= n / 2 ? i : i - n;
            q[(size_t)i * half + j] = (REAL)(acos(-1.0) * sqrt(kx * kx + (double)j * j) / nodes);
        }
    for (int k = -2; k < count; k++) {
        double begin = now();
        run_r2c(forward, u, spectrum);
        for (size_t i = 0; i < waves; i++) {
            spectrum[i][0] *= q[i];
            spectrum[i][1] *= q[i];
        }
        run_c2r(inverse, spectrum, p);
        if (k >= 0)
            seconds[k] = now() - begin;
    }
    double check = 0;
    for (size_t i = 0; i < nodes; i++)
        check += (double)p[i] * p[i];
    qsort(seconds, count, sizeof *seconds, order);
    printf("{\"seconds\": %.9g, \"check\": %.9g, \"version\": \"%s\"}\n", seconds[count / 2], check, version);
    return 0;
}
