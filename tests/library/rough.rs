//! Rough surfaces: what is generated, and what is measured on it.

mod statistics;

use std::f64::consts::{PI, TAU};

use approx::assert_relative_eq;
use asperity::surface::rms_slope;
use asperity::surface::{Psd, Spectrum};
use asperity::{Amplitude, Error, Grid, SelfAffine, Surface};

/// A surface with waves that a quick test resolves.
fn short(seed: u64) -> SelfAffine {
    SelfAffine::default().k_l(2.0).k_r(4.0).k_s(20.0).seed(seed)
}

/// Squares, rectangles, odd sizes and lines that resolve the waves of [`short`].
fn grids() -> Vec<Grid> {
    [
        ((64, 64), (1.0, 1.0)),
        ((45, 45), (3.0, 3.0)),
        ((50, 121), (1e-6, 2.5e-6)),
        ((97, 32), (3.0, 0.7)),
        ((41, 41), (1.0, 1.0)),
        ((256, 1), (2.0, 2.0)),
        ((75, 1), (2.0, 5.0)),
    ]
    .map(|(shape, lengths)| Grid::new(shape, lengths).unwrap())
    .to_vec()
}

#[track_caller]
fn assert_same(a: &Psd, b: &Psd, tolerance: f64) {
    assert_eq!((&a.wave_numbers, &a.waves), (&b.wave_numbers, &b.waves));
    let largest = b.densities.iter().fold(0.0, |m: f64, d| m.max(*d));
    for (a, b) in a.densities.iter().zip(&b.densities) {
        assert_relative_eq!(*a, *b, max_relative = tolerance, epsilon = tolerance * tolerance * largest);
    }
}

#[test]
fn rms_height_and_slope_are_exact_to_rounding() {
    for grid in grids() {
        for random_phase in [false, true] {
            let height = 0.003 * grid.lengths().0;
            let amplitude = Amplitude::RmsHeight(height);
            let surface = short(1).amplitude(amplitude).random_phase(random_phase).surface(grid).unwrap();
            assert_relative_eq!(surface.rms_height(), height, max_relative = 1e-12);
            assert_relative_eq!(surface.spectrum().rms_height(), height, max_relative = 1e-12);
            assert!(surface.mean().abs() < 1e-14 * height);

            let amplitude = Amplitude::RmsSlope(0.25);
            let surface = short(1).amplitude(amplitude).random_phase(random_phase).surface(grid).unwrap();
            assert_relative_eq!(surface.statistics().rms_slope, 0.25, max_relative = 1e-12);
        }
    }
}

#[test]
fn grids_that_resolve_a_surface_have_the_same_one() {
    for random_phase in [false, true] {
        let rough = SelfAffine::default().random_phase(random_phase).seed(5);
        let fine = rough.surface(Grid::square(512, 1.0).unwrap()).unwrap();
        let coarse = rough.surface(Grid::square(256, 1.0).unwrap()).unwrap();
        let rounding = 1e-12 * fine.rms_height();
        for ((i, j), h) in coarse.heights().indexed_iter() {
            assert!((h - fine.heights()[[2 * i, 2 * j]]).abs() < rounding);
        }
    }
    // origins coincide, and nodes three to one, on odd grids, rectangles and lines
    for (shape, lengths) in [((43, 43), (1.0, 1.0)), ((45, 150), (1.0, 3.0)), ((77, 1), (1.0, 1.0))] {
        let coarse = short(2).surface(Grid::new(shape, lengths).unwrap()).unwrap();
        let threefold = (3 * shape.0, if shape.1 == 1 { 1 } else { 3 * shape.1 });
        let fine = short(2).surface(Grid::new(threefold, lengths).unwrap()).unwrap();
        let rounding = 1e-12 * fine.rms_height();
        let at = |i: usize, n: usize| (3 * i + 3 * n / 2 - 3 * (n / 2)) % (3 * n);
        for ((i, j), h) in coarse.heights().indexed_iter() {
            let j = if shape.1 == 1 { 0 } else { at(j, shape.1) };
            assert!((h - fine.heights()[[at(i, shape.0), j]]).abs() < rounding);
        }
    }
    let origins = [41, 42, 64, 101].map(|n| {
        let surface = short(3).surface(Grid::square(n, 1.0).unwrap()).unwrap();
        surface.heights()[[n / 2, n / 2]]
    });
    origins.iter().for_each(|h| assert_relative_eq!(*h, origins[0], max_relative = 1e-11));
}

#[test]
fn surfaces_scale_with_the_lengths_and_differ_by_seed() {
    let unit = short(1).surface(Grid::square(48, 1.0).unwrap()).unwrap();
    let small = short(1).surface(Grid::square(48, 5e-7).unwrap()).unwrap();
    let rounding = 1e-13 * small.rms_height();
    for (a, b) in small.heights().iter().zip(unit.heights()) {
        assert!((a - 5e-7 * b).abs() < rounding);
    }
    // Ly has no influence on a line
    let line = |ly| short(1).surface(Grid::new((64, 1), (1.0, ly)).unwrap()).unwrap().heights().clone();
    assert_eq!(line(1.0), line(0.01));
    // any bit of the seed matters
    for seed in [0, 3, 1 << 32, u64::MAX] {
        let other = short(seed).surface(*unit.grid()).unwrap();
        let product = (other.heights() * unit.heights()).mean().unwrap();
        assert!((product / (unit.rms_height() * other.rms_height())).abs() < 0.5);
    }
}

#[test]
fn heights_are_the_same_on_every_platform() {
    let surface = short(1).surface(Grid::square(64, 1.0).unwrap()).unwrap();
    let found = [[0, 0], [32, 32], [17, 50]].map(|at| surface.heights()[at]);
    // by a sum over the waves: python3 tests/library/rough.py
    for (found, expected) in
        found.into_iter().zip([0.0015618708900996512, -0.0027630915494871867, -0.002371534490825297])
    {
        assert_relative_eq!(found, expected, max_relative = 1e-11);
    }
}

#[test]
#[cfg(feature = "parallel")]
fn threads_do_not_change_a_bit() {
    let drawn = [1, 2, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let surface = short(1).surface(Grid::new((150, 97), (1.0, 0.8)).unwrap()).unwrap();
            (surface.statistics(), surface.spectrum(), surface.spectrum().autocorrelation(), surface)
        })
    });
    assert!(drawn[0] == drawn[1] && drawn[0] == drawn[2]);
}

#[test]
fn random_phases_have_the_target_for_their_spectrum() {
    for grid in grids() {
        for amplitude in [Amplitude::RmsHeight(0.01 * grid.lengths().0), Amplitude::RmsSlope(0.1)] {
            let rough = short(4).random_phase(true).amplitude(amplitude);
            let (target, measured) = (rough.spectrum(grid).unwrap(), rough.surface(grid).unwrap().spectrum());
            assert_same(&measured.radial_psd(), &target.radial_psd(), 1e-10);
            assert_relative_eq!(measured.rms_curvature(), target.rms_curvature(), max_relative = 1e-12);
            assert_relative_eq!(measured.nayak(), target.nayak(), max_relative = 1e-11);
        }
    }
}

#[test]
fn the_target_has_plateau_power_law_and_ends() {
    let at = |psd: &Psd, k: f64| {
        let i = psd.wave_numbers.iter().position(|q| (q / TAU - k).abs() < 1e-9).unwrap();
        psd.densities[i]
    };
    let rough = SelfAffine::default().hurst(0.7).k_l(3.0).k_r(10.0).k_s(50.0);
    let line = rough.spectrum(Grid::line(128, 1.0).unwrap()).unwrap().radial_psd();
    assert_eq!((at(&line, 2.0), at(&line, 51.0)), (0.0, 0.0));
    for (k, share) in [(3.0, 1.0), (10.0, 1.0), (20.0, 2_f64.powf(-2.4)), (50.0, 5_f64.powf(-2.4))] {
        assert_relative_eq!(at(&line, k), share * at(&line, 5.0), max_relative = 1e-12);
    }
    // along the rings of a surface; some hold waves of one length only: its first in k
    let plane = rough.spectrum(Grid::square(128, 1.0).unwrap()).unwrap().radial_psd();
    let near = |k: f64| plane.wave_numbers.iter().position(|q| (q / TAU - k).abs() < 0.5).unwrap();
    for i in [near(20.0), near(30.0), near(45.0)] {
        let (k, share) = (plane.wave_numbers[i] / TAU, plane.densities[i] / plane.densities[near(6.0)]);
        assert_relative_eq!(share, (k / 10.0).powf(-3.4), max_relative = 5e-3);
    }
    assert!(
        plane.wave_numbers.iter().zip(&plane.densities).all(|(q, c)| *c == 0.0 || (2.5..50.5).contains(&(q / TAU)))
    );
}

/// Each |ĥ|² has an exponential distribution, with a standard deviation equal to its mean, so that a mean over m
/// independent waves has a relative standard error of 1/√m.
#[test]
fn gaussian_surfaces_have_the_target_for_their_mean_spectrum() {
    let grid = Grid::square(96, 1.0).unwrap();
    let seeds = 64;
    let rough = SelfAffine::default().k_s(40.0).k_r(8.0).amplitude(Amplitude::RmsHeight(1.0));
    let target = rough.spectrum(grid).unwrap().radial_psd();
    let mut mean = vec![0.0; target.densities.len()];
    for seed in 0..seeds {
        let psd = rough.seed(seed).surface(grid).unwrap().spectrum().radial_psd();
        mean.iter_mut().zip(psd.densities).for_each(|(mean, density)| *mean += density / seeds as f64);
    }
    let (mut squares, mut count) = (0.0, 0.0);
    let points = target.wave_numbers.iter().zip(&target.densities).zip(&target.waves).zip(&mean);
    for (((q, density), waves), mean) in points.filter(|(((q, _), _), _)| (5.0..39.0).contains(&(*q / TAU))) {
        // mirror images are not independent
        let error = (0.5 * (waves * seeds as usize) as f64).sqrt().recip();
        let deviation = (mean / density - 1.0) / error;
        assert!(deviation.abs() < 4.5, "{deviation} standard errors at k = {}", q / TAU);
        squares += deviation * deviation;
        count += 1.0;
    }
    // the sum of squares of standard normal numbers: as many, give or take twice its root
    assert!((squares / count - 1.0).abs() < 4.0 * (2.0_f64 / count).sqrt(), "{}", squares / count);
}

#[test]
fn amplitudes_and_heights_are_gaussian() {
    // on a line each entry of the spectrum is one wave
    let rough = SelfAffine::default().k_l(1.0).k_r(4e4).k_s(4e4);
    let grid = Grid::line(1 << 17, 1.0).unwrap();
    let (target, line) = (rough.spectrum(grid).unwrap(), rough.surface(grid).unwrap());
    let ratios: Vec<f64> = std::iter::zip(line.spectrum().radial_psd().densities, target.radial_psd().densities)
        .filter(|(_, target)| *target > 0.0)
        .map(|(found, target)| found / target)
        .collect();
    assert_eq!(ratios.len(), 40_000);
    let share = |limit: f64| ratios.iter().filter(|r| **r > limit).count() as f64 / ratios.len() as f64;
    for limit in [0.1_f64, 0.5, 1.0, 2.0, 4.0, 7.0] {
        let expected = (-limit).exp();
        assert!((share(limit) - expected).abs() < 4.0 * (expected / 4e4).sqrt(), "{limit}: {}", share(limit));
    }
    let statistics = line.statistics();
    // standard errors √(6/m) and √(24/m), with m the number of independent heights, twice the number of waves
    assert!(statistics.skewness.abs() < 4.0 * (6.0_f64 / 8e4).sqrt(), "{}", statistics.skewness);
    assert!((statistics.kurtosis - 3.0).abs() < 4.0 * (24.0_f64 / 8e4).sqrt(), "{}", statistics.kurtosis);
    assert!((-6.0..-3.0).contains(&(statistics.lowest / statistics.rms_height)));

    // phases are uniform: waves do not prefer a direction
    let mut sums = [0.0; 3];
    for seed in 0..200 {
        let s = short(seed).amplitude(Amplitude::RmsHeight(1.0));
        let s = s.surface(Grid::square(42, 1.0).unwrap()).unwrap();
        let (h, side) = (s.heights()[[21, 21]], s.spectrum().radial_psd().total());
        assert_relative_eq!(side, 1.0, max_relative = 1e-12);
        sums[0] += h / 200.0;
        sums[1] += h * h / 200.0;
        sums[2] += h.powi(4) / 200.0;
    }
    assert!(sums[0].abs() < 4.0 * 200_f64.sqrt().recip(), "{sums:?}");
    assert!((sums[1] - 1.0).abs() < 4.0 * (2.0_f64 / 200.0).sqrt(), "{sums:?}");
    assert!((sums[2] - 3.0).abs() < 4.0 * (96.0_f64 / 200.0).sqrt(), "{sums:?}");
}

/// The exponent 2H of the structure function ⟨(h(x + r) − h(x))²⟩ = 2(R(0) − R(r)) about r.
fn structure_exponent(spectrum: &Spectrum, r: f64) -> f64 {
    let r_of = spectrum.radial_autocorrelation();
    let at = |r: f64| {
        let i = r_of.iter().position(|(lag, _)| *lag >= r).unwrap();
        (r_of[i].0.ln(), (2.0 * (r_of[0].1 - r_of[i].1)).ln())
    };
    let (near, far) = (at(r / 1.5), at(1.5 * r));
    (far.1 - near.1) / (far.0 - near.0)
}

/// Equation (32) prints the exponent −2 − H in its second branch: that is the surface of half the Hurst exponent.
#[test]
fn equation_32_needs_the_exponent_minus_two_times_one_plus_h() {
    let grid = Grid::square(1024, 1.0).unwrap();
    let with_exponent = |exponent: f64| {
        let hurst = -0.5 * exponent - 1.0;
        SelfAffine::default().hurst(hurst).k_l(1.0).k_r(1.0).k_s(500.0).spectrum(grid).unwrap()
    };
    let (right, printed) = (with_exponent(-2.0 * (1.0 + 0.8)), with_exponent(-2.0 - 0.8));
    let [right, printed] = [&right, &printed].map(|spectrum| 0.5 * structure_exponent(spectrum, 0.02));
    // the ends of the spectrum cost some hundredths
    assert!((right - 0.8).abs() < 0.08 && (printed - 0.4).abs() < 0.08, "{right} {printed}");
}

#[test]
fn bad_parameters_and_coarse_grids_are_refused() {
    let good = SelfAffine::default();
    let grid = Grid::square(256, 1.0).unwrap();
    for (rough, name) in [
        (good.hurst(-0.1), "Hurst"),
        (good.hurst(1.1), "Hurst"),
        (good.hurst(f64::NAN), "Hurst"),
        (good.k_l(0.0), "k_l is 0"),
        (good.k_l(f64::NAN), "k_l is NaN"),
        (good.k_r(3.0), "k_r is 3: it must be at least k_l"),
        (good.k_r(f64::NAN), "k_r is NaN"),
        (good.k_s(3.0), "k_s is 3: it must be at least k_r"),
        (good.k_s(f64::INFINITY), "k_s is inf"),
        (good.amplitude(Amplitude::RmsHeight(0.0)), "rms height is 0"),
        (good.amplitude(Amplitude::RmsSlope(f64::NAN)), "rms slope is NaN"),
        (good.k_l(4.1).k_r(4.1).k_s(4.11), "number of waves from k_l to k_s is 0"),
    ] {
        let error = rough.surface(grid).unwrap_err();
        assert!(matches!(error, Error::Value { .. }) && error.to_string().contains(name), "{error}");
        assert_eq!(rough.spectrum(grid).unwrap_err().to_string(), error.to_string());
    }
    for (shape, lengths, limit) in [
        ((128, 128), (1.0, 1.0), 64.0),
        ((256, 100), (1.0, 1.0), 50.0),
        ((256, 128), (1.0, 2.0), 32.0),
        ((100, 256), (1.0, 2.0), 50.0),
        ((127, 1), (1.0, 1.0), 63.5),
        ((1, 256), (1.0, 1.0), 0.5),
    ] {
        let error = good.surface(Grid::new(shape, lengths).unwrap()).unwrap_err();
        assert_eq!(error, Error::Unresolved { k_s: 64.0, limit, shape });
    }
    let message = good.surface(Grid::square(128, 1.0).unwrap()).unwrap_err().to_string();
    for part in ["k_s is 64", "below 64", "128 x 128", "more nodes", "smaller k_s"] {
        assert!(message.contains(part), "{message}");
    }
    // one node more will do, and a rectangle of square cells
    good.surface(Grid::square(129, 1.0).unwrap()).unwrap();
    good.surface(Grid::new((129, 258), (0.3, 0.6)).unwrap()).unwrap();
}
