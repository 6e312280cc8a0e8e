//! Tests of the warnings.

mod contact;
mod lines;

use asperity::*;
use asperity_maps::warning::{Warning, WarningCode};
use asperity_maps::{RowAlignment, ScanAxis, Topography, Trend, surface_with_absent};
use ndarray::Array2;

const SIDES: (f64, f64) = (1.0, 0.8);

fn codes(surface: &Surface) -> Vec<&'static str> {
    Warning::of_surface(surface).iter().map(short).map(|warning| warning.code.name()).collect()
}

/// A warning that is a line of at most 90 characters.
fn short(warning: &Warning) -> &Warning {
    assert!(warning.to_string().chars().count() <= 90, "{warning}");
    warning
}

#[test]
fn the_page_of_warnings_explains_each_code() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/program/warnings.md")).unwrap();
    let entries: Vec<_> = page.lines().filter_map(|line| line.strip_prefix("## ")).collect();
    let codes = WarningCode::ALL.iter().map(|code| code.name()).chain(["unconverged"]);
    assert_eq!(entries, codes.collect::<Vec<_>>());
}

#[test]
fn a_map_that_is_to_be_prepared_is_warned_of_as_its_surface() {
    let map = |change: fn(&mut Array2<f64>)| {
        let mut map = Topography::from(rough());
        change(&mut map.heights);
        let codes = |found: Vec<Warning>| found.iter().map(|warning| warning.code.name()).collect::<Vec<_>>();
        (codes(Warning::of_topography(&map)), codes(Warning::of_surface(&map.surface().unwrap())))
    };
    type Change = fn(&mut Array2<f64>);
    let changes: [(Change, &[&str]); 4] = [
        (|_| {}, &[]),
        (|heights| heights[[20, 30]] += 4.0 * heights.std(0.0), &["spikes"]),
        (|heights| heights.indexed_iter_mut().for_each(|((i, _), h)| *h += 2e-3 * i as f64), &["tilt", "open-edges"]),
        // a single one of the usual codes, far from all else
        (|heights| *heights = heights.mapv(|h| if h == heights[[3, 7]] { -1.0 } else { 490.0 + h }), &["missing-code"]),
    ];
    for (change, expected) in changes {
        assert_eq!(map(change), (expected.to_vec(), expected.to_vec()));
    }
}

/// A rough map of 80 × 64 square cells, periodic.
fn rough() -> Surface {
    let grid = Grid::new((80, 64), SIDES).unwrap();
    let rough = SelfAffine::default().k_l(2.0).k_r(2.0).k_s(24.0);
    rough.surface(grid).unwrap()
}

/// The codes of the rough map after a change of its heights.
#[track_caller]
fn changed(change: impl FnOnce(&mut Array2<f64>)) -> Vec<&'static str> {
    let mut heights = rough().heights().clone();
    change(&mut heights);
    codes(&Surface::new(Grid::new((80, 64), SIDES).unwrap(), heights).unwrap())
}

#[test]
fn clean_periodic_surfaces_have_no_warning() {
    let none: [&str; 0] = [];
    let mut count = 0;
    for shape in [(64, 64), (65, 43), (32, 96), (31, 1), (128, 1), (7, 7), (16, 16)] {
        // square cells
        let grid = Grid::new(shape, (1.0, shape.1 as f64 / shape.0 as f64)).unwrap();
        // all waves that the grid resolves
        let k_s = 0.5 * shape.0 as f64 - 0.6;
        for hurst in [0.2, 0.5, 0.8, 1.0] {
            for seed in 0..8 {
                let amplitude = Amplitude::RmsSlope(0.4);
                let rough =
                    SelfAffine::default().hurst(hurst).k_l(1.0).k_r(1.0).k_s(k_s).amplitude(amplitude).seed(seed);
                let surface = rough.surface(grid).unwrap();
                assert_eq!(codes(&surface), none, "{shape:?} {hurst} {seed}");
                count += 1;
            }
        }
    }
    assert_eq!(count, 224);
    for n in [16, 33, 64, 257] {
        let (grid, line) = (Grid::square(n, 1.0).unwrap(), Grid::line(n, 1.0).unwrap());
        for (name, surface) in [
            ("cylinder", Surface::paraboloid(line, 2.0)),
            ("wave", Surface::wave(grid, 0.01, 1)),
            ("short waves", Surface::wave_2d(grid, 0.001, n / 2 - 1)),
            ("wave on a line", Surface::wave(line, 0.01, 3)),
            ("sine on a line", Surface::from_fn(line, |x, _| 0.01 * (std::f64::consts::TAU * x).sin())),
            ("cap", Surface::from_fn(grid, |x, y| (0.2 - (x * x + y * y)).max(0.1))),
            ("small cap", Surface::from_fn(grid, |x, y| (0.2 - (x * x + y * y)).max(0.19))),
            ("cone", Surface::from_fn(grid, |x, y| (0.05 - 0.1 * x.hypot(y)).max(0.0))),
            ("square wave", Surface::from_fn(grid, |x, _| if x < 0.0 { 1e-4 } else { 0.0 })),
            ("pillars", Surface::from_fn(grid, |x, y| if x.abs().max(y.abs()) < 0.1 { 1e-4 } else { 0.0 })),
        ] {
            assert_eq!(codes(&surface.unwrap()), none, "{name} {n}");
        }
    }
}

#[test]
fn grids_of_a_few_nodes_have_no_warning() {
    let heights = [0.0, 0.3, -0.2, 0.1, 0.25, -0.1, 0.05, 0.4];
    for nx in 1..=8 {
        for ny in 1..=8 {
            let grid = Grid::new((nx, ny), (nx as f64, ny as f64)).unwrap();
            let field = Array2::from_shape_fn((nx, ny), |(i, j)| heights[(3 * i + 5 * j) % 8]);
            let found = codes(&Surface::new(grid, field).unwrap());
            assert_eq!(found, if nx * ny == 1 { vec!["flat"] } else { vec![] }, "{nx} x {ny}");
        }
    }
}

#[test]
fn a_plane_is_flat_and_nothing_else_whatever_its_height() {
    for height in [0.0, 1.0, -1e300, 1e-300] {
        for grid in [Grid::square(8, 1.0), Grid::line(100, 1.0), Grid::square(64, 1e-9)] {
            let surface = Surface::from_fn(grid.unwrap(), |_, _| height).unwrap();
            assert_eq!(codes(&surface), ["flat"], "{height}");
        }
    }
    // the rounding of a datum is no height
    let surface = Surface::from_fn(Grid::square(8, 1.0).unwrap(), |x, _| 1e6 + 1e-11 * x).unwrap();
    assert_eq!(codes(&surface), ["flat"]);
}

#[test]
fn a_tilt_is_told_with_its_slopes_and_goes_with_the_plane() {
    let (grid, heights) = (Grid::new((80, 64), SIDES).unwrap(), rough().heights().clone());
    let tilted = |slopes: (f64, f64)| {
        let plane = grid.sample(|x, y| slopes.0 * x + slopes.1 * y);
        Surface::new(grid, &heights + &plane).unwrap()
    };
    for slopes in [(0.2, 0.0), (0.0, -0.2), (-0.1, 0.15)] {
        assert_eq!(codes(&tilted(slopes)), ["tilt", "open-edges"], "{slopes:?}");
    }
    let warnings = Warning::of_surface(&tilted((0.25, -0.125)));
    let message = warnings[0].message();
    let words: Vec<_> = message.split_whitespace().collect();
    let slope: f64 = words[5].parse().unwrap();
    // the plane that is in the roughness itself comes on top
    assert!((slope - 0.25).abs() < 0.03, "{}", warnings[0]);
    assert!(warnings[0].message().contains("remove a plane"), "{}", warnings[0]);
    let levelled = Topography::from(tilted((0.2, 0.1))).detrend(Trend::Plane).unwrap().surface().unwrap();
    assert!(!codes(&levelled).contains(&"tilt"));
}

#[test]
fn edges_that_do_not_meet_are_told_and_mirrors_or_a_window_close_them() {
    let cut = Topography::from(rough()).crop(0..50, 0..64).unwrap();
    let mut cut = cut.heights.clone();
    // without a tilt: the profile of a valley that ends elsewhere than it begins
    let n = cut.nrows() as f64;
    cut.indexed_iter_mut().for_each(|((i, _), h)| *h = 0.05 * *h + 0.1 * (5.0 * i as f64 / n).cos());
    let mut map = Topography::new(cut);
    map.lengths = Some((1.0, 1.28));
    let map = map.detrend(Trend::Plane).unwrap();
    let open = map.clone().surface().unwrap();
    let warnings = Warning::of_surface(&open);
    assert_eq!(codes(&open), ["open-edges"]);
    let message = warnings[0].message();
    assert!(message.contains(" along x") && !message.contains(" along y") && message.contains("mirror"), "{message}");
    for closed in [map.clone().mirror(), map.window(0.2).unwrap()] {
        assert_eq!(codes(&closed.surface().unwrap()), [""; 0]);
    }
}

#[test]
fn a_body_that_ends_is_told_and_no_surface_that_goes_on() {
    for n in [32, 33, 64, 257] {
        let grid = Grid::square(n, 1.0).unwrap();
        let paraboloid = grid.sample(|x, y| -0.25 * (x * x + y * y));
        let sphere_beside_the_middle = grid.sample(|x, y| (4.0 - (x + 0.03).powi(2) - (y - 0.05).powi(2)).sqrt());
        let cone = grid.sample(|x, y| -0.1 * x.hypot(y));
        let punch = grid.sample(|x, y| if x.hypot(y) < 0.3 { 0.0 } else { f64::NAN });
        for (k, body) in [paraboloid, sphere_beside_the_middle, cone, punch].into_iter().enumerate() {
            let found = codes(&surface_with_absent(grid, body).unwrap());
            assert!(found.contains(&"ends"), "{k} {n}: {found:?}");
        }
        let rough = SelfAffine::default().k_l(2.0).k_r(2.0).k_s(0.4 * n as f64).amplitude(Amplitude::RmsHeight(0.002));
        let tip = rough.surface(grid).unwrap().heights() + Surface::paraboloid(grid, 1.0).unwrap().heights();
        assert_eq!(codes(&Surface::new(grid, tip).unwrap()), ["ends"], "rough tip {n}");
        // in the hole of a surface that continues
        let hole =
            grid.sample(|x, y| if x.hypot(y) > 0.6 { f64::NAN } else { 0.01 * (std::f64::consts::TAU * x).sin() });
        assert!(!codes(&surface_with_absent(grid, hole).unwrap()).contains(&"ends"), "hole {n}");
    }
    let pillar = Grid::square(32, 1.0).unwrap().sample(|x, y| if x.hypot(y) < 0.3 { 0.0 } else { f64::NAN });
    let pillar = surface_with_absent(Grid::square(32, 1.0).unwrap(), pillar).unwrap();
    let message = Warning::of_surface(&pillar)[0].message();
    assert!(message.contains("except for an array of pillars"), "{message}");
    let message = Warning::of_surface(&Surface::paraboloid(Grid::square(64, 1.0).unwrap(), 2.0).unwrap())[0].message();
    // −(31/64)²/4 against −1/24 on average
    assert!(["by 0.017 or more", "free boundary"].iter().all(|part| message.contains(part)), "{message}");
    // a piece of a ball with its roughness, mirrored
    for (seed, bow) in (0..30).flat_map(|seed| [0.0, 0.02, 0.3, 2.0].map(|bow| (seed, bow))) {
        let rough = SelfAffine::default().k_l(1.0).k_r(1.0).k_s(20.0).seed(seed);
        let mut map =
            Topography::from(rough.surface(Grid::square(64, 1.0).unwrap()).unwrap()).crop(0..44, 7..60).unwrap();
        map.heights.indexed_iter_mut().for_each(|((i, j), h)| {
            let (x, y) = (i as f64 / 44.0 - 0.45, j as f64 / 53.0 - 0.55);
            *h = 0.02 * *h - bow * (x * x + y * y);
        });
        assert!(!codes(&map.mirror().surface().unwrap()).contains(&"ends"), "{seed} {bow}");
    }
}

#[test]
fn a_modulus_in_another_unit_than_metres_ask_for_is_told() {
    let found = |modulus: f64, length: f64, unit: Option<&str>| {
        Warning::of_modulus(modulus, &Grid::square(100, length).unwrap(), unit).map(|found| found.message())
    };
    for (modulus, length, unit) in [(70.0, 1e-6, Some("m")), (2.5, 1e-3, Some("m")), (1100.0 / 2.0, 1e-6, None)] {
        let message = found(modulus, length, unit).unwrap();
        assert!(
            message.contains(&format!("is {}, ", Warning::figure(modulus))) && message.contains("1e3 Pa"),
            "{message}"
        );
    }
    // pascals, another unit of length, no unit, and pressures over the modulus
    for (modulus, length, unit) in [
        (70e9, 1e-6, Some("m")),
        (2e3, 1e-6, Some("m")),
        (70.0, 1.0, Some("µm")),
        (70.0, 1.0, None),
        (70.0, 1e-3, None),
        (1.0, 1e-6, Some("m")),
    ] {
        assert_eq!(found(modulus, length, unit), None, "{modulus} {length} {unit:?}");
    }
}

#[test]
fn heights_and_lengths_in_different_units_are_steep_or_smooth() {
    // picometres on a side in metres
    assert_eq!(changed(|heights| heights.mapv_inplace(|h| (h * 1e6).round())), ["steep"]);
    let slope = |slope| {
        let amplitude = Amplitude::RmsSlope(slope);
        let rough = SelfAffine::default().amplitude(amplitude).k_s(8.0);
        codes(&rough.surface(Grid::square(256, 1.0).unwrap()).unwrap())
    };
    assert_eq!((slope(0.49), slope(0.52)), (vec![], vec!["steep"]));
    assert_eq!((slope(1.05e-8), slope(0.95e-8)), (vec![], vec!["smooth"]));
}

#[test]
fn a_repeated_value_far_outside_is_a_code_for_missing_points_and_nothing_else_is_told() {
    let strip = |heights: &mut Array2<f64>| (10..12).for_each(|i| heights.row_mut(i).fill(-9999.0));
    assert_eq!(changed(strip), ["missing-code"]);
    assert_eq!(changed(|heights| heights[[4, 5]] = -32768.0), ["missing-code"]);
    // in the unit of the heights after scaling, and at the other end, both
    let both = |heights: &mut Array2<f64>| {
        heights[[4, 5]] = -9.999;
        heights[[40, 5]] = -9.999;
        heights[[41, 50]] = 1e308;
        heights[[42, 50]] = 1e308;
    };
    assert_eq!(changed(both), ["missing-code", "missing-code"]);
    let mut heights = rough().heights().clone();
    strip(&mut heights);
    let message = Warning::of_surface(&Surface::new(*rough().grid(), heights).unwrap())[0].message();
    assert!(["-9999 stands at 128 nodes", "--missing -9999"].iter().all(|part| message.contains(part)), "{message}");
}

#[test]
fn single_nodes_far_out_of_their_neighbours_are_spikes() {
    let mut heights = rough().heights().clone();
    let rms = rough().rms_height();
    heights[[20, 30]] += 12.0 * rms;
    heights[[50, 9]] -= 5.0 * rms;
    let warnings = Warning::of_surface(&Surface::new(*rough().grid(), heights).unwrap());
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    let message = warnings[0].message();
    assert!(["2 single nodes", "[20, 30]", "despike"].iter().all(|part| message.contains(part)), "{message}");
    // on a line too
    let line = Surface::wave(Grid::line(200, 1.0).unwrap(), 0.01, 2).unwrap();
    let mut heights = line.heights().clone();
    heights[[77, 0]] += 0.02;
    assert_eq!(codes(&Surface::new(*line.grid(), heights).unwrap()), ["spikes"]);
}

#[test]
fn cells_far_from_square_are_told_but_not_on_lines() {
    let heights = |i: usize, j: usize| 0.001 * ((i as f64).sin() + (j as f64).cos());
    let found = |shape: (usize, usize), lengths| {
        let field = Array2::from_shape_fn(shape, |(i, j)| heights(i, j));
        codes(&Surface::new(Grid::new(shape, lengths).unwrap(), field).unwrap())
    };
    assert_eq!(found((12, 8), (1.0, 1.0)), [""; 0]);
    assert_eq!(found((12, 4), (1.0, 1.0)), ["cells"]);
    assert_eq!(found((12, 1), (1.0, 1.0)), [""; 0]);
    assert_eq!(found((1, 12), (1.0, 1.0)), [""; 0]);
}

#[test]
fn heights_at_the_ends_of_the_range_do_no_harm() {
    for scale in [1e-320, 1e-300, 1e150, 1e308] {
        let surface =
            Surface::from_fn(Grid::square(20, 1.0).unwrap(), |x, y| scale * (7.0 * x).sin() * (5.0 * y).cos());
        for warning in Warning::of_surface(&surface.unwrap()) {
            assert!(!warning.message().contains("NaN"), "{scale:e}: {warning}");
        }
    }
}
