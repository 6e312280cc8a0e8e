//! Statistics of surfaces.

use super::*;

/// A wave of amplitude `a` with so many periods along x and y.
struct Wave(f64, i32, i32);

fn waves(grid: Grid, waves: &[Wave]) -> Surface {
    let (lx, ly) = grid.lengths();
    let wave = |w: &Wave, x: f64, y: f64| w.0 * (TAU * (f64::from(w.1) * x / lx + f64::from(w.2) * y / ly) + 0.3).cos();
    Surface::from_fn(grid, |x, y| 1e3 * lx + waves.iter().map(|w| wave(w, x, y)).sum::<f64>()).unwrap()
}

#[test]
fn statistics_of_waves_are_closed_sums() {
    let plane = [Wave(0.01, 3, 0), Wave(0.02, 0, 4), Wave(0.005, 5, -2), Wave(0.001, -6, -7)];
    let line = [Wave(0.01, 3, 0), Wave(0.02, 7, 0), Wave(0.003, 11, 0)];
    for (shape, lengths, given) in [
        ((32, 32), (1.0, 1.0), &plane[..]),
        ((27, 35), (2.0, 0.7), &plane[..]),
        ((32, 1), (2.0, 9.0), &line[..]),
        ((31, 1), (2.0, 9.0), &line[..]),
    ] {
        let grid = Grid::new(shape, lengths).unwrap();
        let surface = waves(grid, given);
        let (found, spectrum) = (surface.statistics(), surface.spectrum());
        let sum = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
            given
                .iter()
                .map(|w| 0.5 * w.0 * w.0 * f(TAU * f64::from(w.1) / lengths.0, TAU * f64::from(w.2) / lengths.1))
                .sum()
        };
        let (square, fourth) = (sum(&|x, y| x * x + y * y), sum(&|x, y| (x * x + y * y).powi(2)));
        let one_dimensional = shape.1 == 1;
        let half = if one_dimensional { 1.0 } else { 0.5 };
        assert_relative_eq!(found.mean, 1e3 * lengths.0, max_relative = 1e-12);
        // of heights that a large datum leaves thirteen digits
        assert_relative_eq!(found.rms_height.powi(2), sum(&|_, _| 1.0), max_relative = 1e-9);
        assert_relative_eq!(found.rms_slope.powi(2), square, max_relative = 1e-9);
        assert_relative_eq!(found.rms_curvature.powi(2), half * half * fourth, max_relative = 1e-9);

        let (dx, dy) = grid.spacing();
        let difference = |q: f64, d: f64| (2.0 * (0.5 * q * d).sin() / d).powi(2);
        let slope = sum(&|x, y| difference(x, dx) + difference(y, dy));
        let laplacian = sum(&|x, y| (difference(x, dx) + difference(y, dy)).powi(2));
        assert_relative_eq!(found.rms_slope_differences.powi(2), slope, max_relative = 1e-8);
        assert_relative_eq!(found.rms_curvature_differences.powi(2), half * half * laplacian, max_relative = 1e-8);

        let m = spectrum.moments();
        let expected = if one_dimensional {
            [sum(&|_, _| 1.0), square, fourth]
        } else {
            // means over profiles in all directions
            let profile = |power: i32| {
                let directions = (0..360).map(|i| f64::from(i) * TAU / 360.0);
                directions.map(|t| sum(&|x, y| (x * t.cos() + y * t.sin()).powi(power))).sum::<f64>() / 360.0
            };
            [profile(0), profile(2), profile(4)]
        };
        for (m, expected) in m.iter().zip(expected) {
            assert_relative_eq!(*m, expected, max_relative = 1e-9);
        }
        assert_relative_eq!(found.nayak, expected[0] * expected[2] / expected[1].powi(2), max_relative = 1e-9);

        assert_relative_eq!(spectrum.radial_psd().total(), sum(&|_, _| 1.0), max_relative = 1e-9);
        let autocorrelation = spectrum.autocorrelation();
        for ((i, j), r) in autocorrelation.indexed_iter() {
            let expected = sum(&|x, y| (x * grid.x(i) + y * grid.y(j)).cos());
            assert_relative_eq!(*r, expected, epsilon = 1e-9 * found.rms_height.powi(2));
        }
    }
}

#[test]
fn slopes_by_differences_have_the_edge_and_heights_of_any_size() {
    let heights = ndarray::arr2(&[[0.0, 3.0], [4.0, 7.0], [8.0, 11.0], [12.0, 15.0]]);
    let grid = Grid::new((4, 2), (4.0, 2.0)).unwrap();
    // a step of 4 along x and of 3 along y, and back at the edge
    let periodic = f64::sqrt((3.0 * 16.0 + 144.0) / 4.0 + 9.0);
    for scale in [1.0, 1e200, 1e-200] {
        let surface = Surface::new(grid, &heights * scale).unwrap();
        assert_relative_eq!(surface.statistics().rms_slope_differences, scale * periodic, max_relative = 1e-14);
        assert_relative_eq!(
            rms_slope(surface.heights().view(), grid.spacing(), false),
            scale * 5.0,
            max_relative = 1e-14
        );
    }
    // one beyond all numbers is not left out
    let tiny = Grid::new((4, 2), (4e-12, 2e-12)).unwrap();
    let surface = Surface::new(tiny, &heights * 1e300).unwrap();
    assert_eq!(surface.statistics().rms_slope_differences, f64::INFINITY);
    assert_eq!(rms_slope(surface.heights().view(), tiny.spacing(), false), f64::INFINITY);
}

#[test]
fn densities_of_single_waves() {
    let grid = Grid::new((30, 40), (2.0, 3.0)).unwrap();
    let surface = Surface::from_fn(grid, |x, y| 0.1 * (TAU * (4.0 * x / 2.0 + 5.0 * y / 3.0)).cos()).unwrap();
    let spectrum = surface.spectrum();
    // half of the variance to each sign
    let half = 0.25 * 0.01;
    let (qx, qy) = (TAU * 4.0 / 2.0, TAU * 5.0 / 3.0);
    let radial = spectrum.radial_psd();
    let total: usize = radial.waves.iter().sum();
    assert_eq!(total, 30 * 40 - 1);
    let ring = (qx.hypot(qy) / PI).round();
    let at = radial.wave_numbers.iter().position(|q| (q / PI).round() == ring).unwrap();
    let density = half / (TAU / 2.0 * TAU / 3.0) * 2.0 / radial.waves[at] as f64;
    assert_relative_eq!(radial.densities[at], density, max_relative = 1e-12);
    assert!(radial.wave_numbers.is_sorted());

    // the Nyquist wave has no mirror image
    let nyquist = Surface::from_fn(Grid::line(8, 1.0).unwrap(), |x, _| (8.0 * PI * x).cos()).unwrap();
    let psd = nyquist.spectrum().radial_psd();
    assert_eq!(psd.waves, [2, 2, 2, 1]);
    assert_relative_eq!(psd.densities[3] * psd.cell, 1.0, max_relative = 1e-12);
    assert_relative_eq!(psd.total(), 1.0, max_relative = 1e-12);
}

#[test]
fn autocorrelation_of_a_rough_surface_is_its_definition() {
    let surface = short(1).surface(Grid::new((50, 43), (1.0, 0.9)).unwrap()).unwrap();
    let (h, r) = (surface.heights(), surface.spectrum().autocorrelation());
    for (a, b) in [(0, 0), (1, 0), (7, 12), (30, 3), (49, 42)] {
        let product = |(i, j): (usize, usize), x: &f64| x * h[[(i + a) % 50, (j + b) % 43]];
        let defined = h.indexed_iter().map(|(at, x)| product(at, x)).sum::<f64>() / h.len() as f64;
        assert_relative_eq!(r[[(25 + a) % 50, (21 + b) % 43]], defined, epsilon = 1e-13 * r[[25, 21]]);
    }
    let radial = surface.spectrum().radial_autocorrelation();
    assert_eq!(radial[0].0, 0.0);
    assert_relative_eq!(radial[0].1, surface.rms_height().powi(2), max_relative = 1e-12);
    assert!(radial.windows(2).all(|pair| pair[1].0 > pair[0].0) && radial[radial.len() - 1].0 <= 0.45 * (1.0 + 1e-12));
}

#[test]
fn flat_surfaces_and_single_nodes_have_statistics() {
    for shape in [(1, 1), (1, 2), (2, 2), (7, 1), (1, 7), (16, 3)] {
        let surface = Surface::from_fn(Grid::new(shape, (1.0, 2.0)).unwrap(), |_, _| 7.25).unwrap();
        let found = surface.statistics();
        assert_eq!((found.mean, found.lowest, found.highest, found.rms_height), (7.25, 7.25, 7.25, 0.0));
        assert_eq!((found.rms_slope, found.rms_slope_differences), (0.0, 0.0));
        assert_eq!((found.rms_curvature, found.rms_curvature_differences), (0.0, 0.0));
        assert!(found.nayak.is_nan() && found.skewness.is_nan() && found.kurtosis.is_nan());
        assert_eq!(surface.spectrum().radial_psd().total(), 0.0);
        assert!(surface.spectrum().autocorrelation().iter().all(|r| *r == 0.0));
    }
}
