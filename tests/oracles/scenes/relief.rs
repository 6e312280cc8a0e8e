//! The grids and heights of scenes.

use super::*;

/// Lines, strips, primes, and squares of up to 21² nodes; cells and sides of all proportions.
pub(super) fn grid(random: &mut ChaCha8Rng, body: Body) -> Grid {
    let least = if body == Body::Free { 2 } else { 1 };
    let shape = match random.random_range(0..20) {
        0 => (least, random.random_range(least..40)),
        1 => (random.random_range(least..160), least),
        2 => (random.random_range(30..80), random.random_range(2..4)),
        3 => (random.random_range(12..22), random.random_range(12..22)),
        _ => (random.random_range(least..12), random.random_range(least..12)),
    };
    let lx = power(random, -9.0, 3.0);
    let aspect = power(random, -1.5, 1.5);
    // windows of cells that are not too far from square
    let aspect = if body == Body::Free { aspect.powf(0.5) * shape.1 as f64 / shape.0 as f64 } else { aspect };
    Grid::new(shape, (lx, lx * aspect)).unwrap()
}

/// Heights of some unit, by name.
pub(super) fn relief(random: &mut ChaCha8Rng, (nx, ny): (usize, usize)) -> (&'static str, Array2<f64>) {
    let names = ["noise", "smooth", "levels", "spike", "step", "board", "flat", "sphere"];
    let name = names[[0, 0, 0, 1, 1, 1, 2, 2, 3, 4, 5, 6, 7, 7][random.random_range(0..14)]];
    let phases: [f64; 3] = std::array::from_fn(|_| random.random_range(0.0..7.0));
    let wave = |i: usize, n: usize, phase: f64| (TAU * i as f64 / n as f64 + phase).cos();
    let from_centre = |i: usize, n: usize| (i as f64 - 0.5 * n as f64) / n as f64;
    let heights = Array2::from_shape_fn((nx, ny), |(i, j)| {
        let (noise, level) = (random.random_range(0.0..1.0), f64::from(random.random_range(0..3_u8)));
        match name {
            "noise" => noise,
            "smooth" => wave(i, nx, phases[0]) + wave(j, ny, phases[1]) + wave(2 * i + j, nx, phases[2]),
            "levels" => 0.5 * level,
            "spike" => f64::from(u8::from((i, j) == (nx / 2, ny / 3))),
            "step" => f64::from(u8::from(2 * i < nx)),
            "board" => f64::from(u8::from((i + j) % 2 == 0)),
            "sphere" => -2.0 * (from_centre(i, nx).powi(2) + from_centre(j, ny).powi(2)),
            _ => 0.25,
        }
    });
    // its own mirror image
    let mirrored = random.random_bool(0.15);
    let mirror = |(i, j): (usize, usize)| heights[[i.min((nx - i) % nx), j]];
    (name, if mirrored { Array2::from_shape_fn((nx, ny), mirror) } else { heights })
}

/// Takes the surface away at some nodes: here and there, or outside of an ellipse.
pub(super) fn punch(random: &mut ChaCha8Rng, heights: &mut Array2<f64>) {
    let (share, round) = (random.random_range(0.02..0.5), random.random_bool(0.4));
    let (nx, ny) = heights.dim();
    let outside = |i: usize, n: usize| ((2 * i + 1) as f64 / n as f64 - 1.0).powi(2);
    let kept = (random.random_range(0..nx), random.random_range(0..ny));
    for ((i, j), height) in heights.indexed_iter_mut() {
        let lost = if round { outside(i, nx) + outside(j, ny) > 1.0 } else { random.random_bool(share) };
        if lost && (i, j) != kept {
            *height = f64::NAN;
        }
    }
}
