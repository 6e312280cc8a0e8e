//! Tests of the warnings.

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

#[test]
fn a_range_beyond_the_heights_or_below_the_grid_is_told() {
    let surface = Surface::wave_2d(Grid::square(64, 1.0).unwrap(), 0.01, 2).unwrap();
    let found = |work: f64, range: f64| Warning::of_law::<f64>(&Exponential::new(work, range).unwrap(), &surface, 1.0);
    assert!(found(1e-5, 2e-3).is_empty());
    let resolved = |warnings: Vec<Warning>| (warnings.len(), warnings[0].code, short(&warnings[0]).message());
    // √(1e-5/64)/ρ
    let (count, code, message) = resolved(found(1e-5, 3e-4));
    assert_eq!((count, code), (1, WarningCode::Range));
    for part in ["mu_rho = 1.32", "0.72 to 1.65 w", "use jkr"] {
        assert!(message.contains(part), "{message}");
    }
    // far beyond what was measured
    let (_, _, message) = resolved(found(1e-5, 2e-5));
    assert!(message.contains("<0.25 to >13.8 w"), "{message}");
    // without a range there is none to resolve
    assert!(Warning::of_law::<f64>(&Jkr::new(1e-5).unwrap(), &surface, 1.0).is_empty());
    // a law that jumps is smoothed
    assert!(Warning::of_law::<f64>(&MaugisDugdale::new(1e-5, 1e-3).unwrap(), &surface, 1.0).is_empty());
    let (count, code, message) = resolved(found(1e-5, 0.1));
    assert_eq!((count, code), (1, WarningCode::Range));
    assert!(["0.1", "0.02", "unit"].iter().all(|part| message.contains(part)), "{message}");
    // J/m² and Pa next to sides of 1000 nm
    let surface = Surface::wave_2d(Grid::square(64, 1e3).unwrap(), 10.0, 2).unwrap();
    let of_work = |work: f64, modulus: f64| {
        let found = Warning::of_law::<f64>(&Jkr::new(work).unwrap(), &surface, modulus);
        found
            .iter()
            .map(short)
            .filter(|found| found.code == WarningCode::Work)
            .map(Warning::message)
            .collect::<Vec<_>>()
    };
    assert!(of_work(0.05, 70e9)[0].starts_with("w/E* is 7.14e-13, 7.14e-16 sides: check the units"));
    assert!(of_work(50.0, 1e-3)[0].starts_with("w/E* is 50000, 50 sides"));
    assert!(of_work(0.05, 70.0).is_empty() && of_work(0.0, 70e9).is_empty());
    assert!(found(0.0, 0.1).is_empty() && Warning::of_law::<f64>(&NoAdhesion, &surface, 1.0).is_empty());
}

#[test]
fn a_cycle_that_jumps_in_too_early_is_told() {
    let grid = Grid::square(64, 1.0).unwrap();
    let told = |law: &dyn AdhesionLaw<f64>, smooth| {
        Warning::of_cycle(law, &grid, 1.0, smooth).map(|warning| short(&warning).to_string())
    };
    // the width of the smoothed fall is 5 wΔx/(E* ρ), half of it beyond the range
    let blunt = |range: f64| told(&MaugisDugdale::new(1e-5, range).unwrap(), true);
    assert!(blunt(1e-3).unwrap().contains("reaches 39.1 % farther"), "{:?}", blunt(1e-3));
    assert_eq!(blunt(2e-3), None);
    assert_eq!(told(&MaugisDugdale::new(1e-5, 1e-3).unwrap(), false), None);
    // attraction next to contacts alone is as sudden as in the limit
    assert_eq!(told(&Jkr::new(1e-5).unwrap(), true), None);
    assert_eq!(told(&Exponential::new(1e-5, 1e-3).unwrap(), true), None);
    assert_eq!(told(&NoAdhesion, true), None);
}

#[test]
fn a_contact_pressure_above_the_modulus_is_told() {
    let grid = Grid::square(16, 1.0).unwrap();
    let surface = Surface::wave_2d(grid, 0.5, 1).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 2.0).unwrap(), NoAdhesion).unwrap();
    let mut found = |pressure| {
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(pressure)).unwrap();
        Warning::of_solution(&solution, None)
    };
    assert!(found(0.01).is_empty());
    let warnings = found(3.0);
    assert_eq!((warnings.len(), warnings[0].code), (1, WarningCode::BeyondModulus));
    assert!(short(&warnings[0]).message().contains(" E*: "), "{}", warnings[0]);
}

#[test]
fn the_pull_off_is_as_wrong_as_the_warning_says() {
    let (grid, work) = (Grid::line(256, 1.0).unwrap(), 4.4e-5);
    let surface = Surface::wave(grid, 0.01, 1).unwrap();
    let exact = |work| exact::AdhesiveWavyLine::new(0.01, 1.0, 1.0, work).unwrap().pull_off().unwrap().mean_pressure();
    for (mu_rho, factor) in [(1.0, 1.17), (2.0, 3.49)] {
        let law = Exponential::new(work, (work / 256.0_f64).sqrt() / mu_rho).unwrap();
        let warnings = Warning::of_law::<f64>(&law, &surface, 1.0);
        let told = format!(" to {} w", if factor > 2.0 { "3.5" } else { "1.17" });
        assert!(warnings[0].message().contains(&told), "{}", warnings[0]);
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
        let preload = 0.3 * std::f64::consts::PI * 0.01;
        let found = PullOff::default().preload(Some(preload)).find(&mut Solver::default(), &mut problem).unwrap();
        let ratio = found.solution.report.mean_pressure / exact(factor * work);
        assert!((0.93..1.03).contains(&ratio), "{ratio}");
    }
}

/// A number from −½ to ½ that looks random.
fn drawn(seed: u64, i: usize) -> f64 {
    let mixed = (seed ^ (i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((mixed ^ (mixed >> 32)) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
}

/// Heights of all waves that 128 × 128 nodes resolve; those along y are `lay` times as long as those along x.
fn rolled(hurst: f64, lay: usize, seed: u64) -> Topography {
    let grid = Grid::new((128, 128 / lay), (1.0, 1.0 / lay as f64)).unwrap();
    let k_s = 64.0 / (lay as f64).sqrt() - 0.6;
    let rough = SelfAffine::default().hurst(hurst).k_l(1.0).k_r(1.0).k_s(k_s.min(63.4 / lay as f64)).seed(seed);
    let map = Topography::from(rough.surface(grid).unwrap());
    if lay == 1 { map } else { map.resample((128, 128)).unwrap() }
}

/// A map less its values, plus a function of the node, in rms steps along y.
fn with(map: &Topography, added: impl Fn(usize, usize) -> f64) -> Topography {
    let mut map = map.clone();
    let steps: f64 = map
        .heights
        .rows()
        .into_iter()
        .flat_map(|row| row.to_vec())
        .collect::<Vec<_>>()
        .windows(2)
        .map(|h| (h[1] - h[0]).powi(2))
        .sum();
    let rms = f64::sqrt(steps / map.heights.len() as f64);
    map.heights.indexed_iter_mut().for_each(|((i, j), h)| *h += rms * added(i, j));
    map
}

#[test]
fn scan_lines_along_the_other_axis_are_told_and_no_surface_is_taken_for_them() {
    let axes = [ScanAxis::X, ScanAxis::Y];
    let told = |map: &Topography| axes.map(|axis| Warning::of_lines(map, axis).is_some());
    let (mut surfaces, mut found) = (0, [0; 2]);
    for hurst in [0.2, 0.5, 0.8, 1.0] {
        for seed in 0..8 {
            for lay in [1, 4, 16] {
                let map = rolled(hurst, lay, seed);
                for noise in [0.0, 0.3, 3.0] {
                    let noisy = with(&map, |i, j| noise * drawn(seed, 128 * i + j));
                    assert_eq!(told(&noisy), [false; 2], "hurst {hurst}, seed {seed}, lay {lay}, noise {noise}");
                    surfaces += 1;
                }
            }
            // rms offsets of two and of six rms steps, from line to line or added up, lines along y
            for (size, adds) in [(2.0, false), (6.0, false), (2.0, true), (6.0, true)] {
                let mut drift = 0.0;
                let offsets = Vec::from_iter((0..128).map(|i| {
                    let step = (0..12).map(|k| drawn(100 * seed + k, i)).sum::<f64>();
                    drift = size * step + if adds { drift } else { 0.0 };
                    drift
                }));
                let [x, y] = told(&with(&rolled(hurst, 1, seed), |i, _| offsets[i]));
                assert!(!y, "hurst {hurst}, seed {seed}, size {size}");
                found[usize::from(adds)] += usize::from(x);
            }
        }
    }
    assert_eq!(surfaces, 288);
    println!("of 64 scans each {found:?} with offsets of their own, and that add up");
    assert!(found[0] >= 62 && found[1] >= 40, "{found:?} of 64");
}

#[test]
fn bodies_gratings_and_few_lines_are_no_scan_lines() {
    let grid = Grid::square(128, 1.0).unwrap();
    let noisy = |of: &dyn Fn(f64, usize) -> f64| {
        let map = |(i, j): (usize, usize)| of(i as f64 / 128.0 - 0.5, i) + 1e-3 * drawn(7, 128 * i + j);
        Topography::new(Array2::from_shape_fn((128, 128), map))
    };
    let tau = std::f64::consts::TAU;
    let mut maps = vec![
        ("sphere", Topography::from(Surface::paraboloid(grid, 2.0).unwrap())),
        ("flat", Topography::new(Array2::zeros((128, 128)))),
        ("cylinder", noisy(&|x, _| -x * x)),
        ("tilt", noisy(&|x, _| x)),
        ("step", noisy(&|x, _| if x < 0.1 { 0.0 } else { 1.0 })),
    ];
    for period in [3, 4, 5, 8, 16, 32] {
        maps.push(("grating", noisy(&|_, i| if 2 * (i % period) < period { 1.0 } else { 0.0 })));
        maps.push(("wave", noisy(&|_, i| (tau * i as f64 / period as f64).sin())));
        maps.push(("saw", noisy(&|_, i| (i % period) as f64)));
    }
    for (name, map) in maps {
        assert_eq!(Warning::of_lines(&map, ScanAxis::X), None, "{name}");
        assert_eq!(Warning::of_lines(&map, ScanAxis::Y), None, "{name}");
    }
    let lines =
        |n: usize| Topography::new(Array2::from_shape_fn((n, 80), |(i, j)| drawn(1, i) + 0.1 * drawn(2, 80 * i + j)));
    assert!(Warning::of_lines(&lines(63), ScanAxis::X).is_none());
    let mut holed = lines(96);
    holed.heights.iter_mut().step_by(7).for_each(|h| *h = f64::NAN);
    holed.heights.row_mut(40).fill(f64::NAN);
    let message = Warning::of_lines(&holed, ScanAxis::X).unwrap().message();
    assert!(message.starts_with("lines along y are offset") && message.contains("as lines along x"), "{message}");
}

#[test]
fn a_punch_reaches_the_edge_of_its_window_and_a_sphere_does_not() {
    let grid = Grid::square(32, 0.3).unwrap();
    let codes = |surface: &Surface, load: f64| {
        let mut problem = Problem::new(surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
        let found = Solver::default().solve(&mut problem, Control::Force(load)).unwrap();
        Warning::of_solution(&found, None).iter().map(|warning| warning.code).collect::<Vec<_>>()
    };
    assert_eq!(codes(&Surface::from_fn(grid, |_, _| 0.0).unwrap(), 1e-4), [WarningCode::WindowEdge]);
    assert!(codes(&Surface::paraboloid(grid, 1.0).unwrap(), 1e-4).is_empty());
}

#[test]
fn offsets_of_lines_are_told_until_the_lines_are_aligned() {
    let offset = |line: usize| ((line * line * 7919) as f64 * 0.618_034).fract() - 0.5;
    // of lines of 128 nodes, the offsets in rms steps of the surface, uniform: from half a step on they are told
    for (k_s, hurst) in [(16.0, 0.8), (63.0, 0.8), (63.0, 0.3)] {
        for seed in 0..6 {
            let grid = Grid::new((128, 192), (1.0, 1.5)).unwrap();
            let rough = SelfAffine::default().hurst(hurst).k_l(2.0).k_r(2.0).k_s(k_s).seed(seed).surface(grid).unwrap();
            let clean = Topography::from(rough);
            let step = clean.rms_slope().unwrap() / 128.0 / f64::sqrt(2.0);
            let told = |map: &Topography| {
                let found = Warning::of_surface(&map.clone().surface().unwrap());
                found.iter().map(short).find(|found| found.code == WarningCode::LineOffsets).map(Warning::message)
            };
            for share in [2.0, 3.0] {
                let mut map = clean.clone();
                map.heights
                    .columns_mut()
                    .into_iter()
                    .enumerate()
                    .for_each(|(j, mut line)| line += share * step * offset(j));
                for map in [map.clone(), map.clone().mirror()] {
                    let found = told(&map).unwrap_or_else(|| panic!("{k_s} {hurst} {seed} {share}"));
                    assert!(
                        found.starts_with("lines along x are offset by ") && found.ends_with("scan axis x"),
                        "{found}"
                    );
                    let lengths = map.lengths.map(|(lx, ly)| (ly, lx));
                    let mut across = Topography::new(map.heights.t().to_owned());
                    across.lengths = lengths;
                    assert!(told(&across).unwrap().ends_with("scan axis y"));
                }
                for by in [RowAlignment::Median, RowAlignment::MedianDifference] {
                    assert_eq!(
                        told(&map.clone().align_rows(by, ScanAxis::X).unwrap()),
                        None,
                        "{k_s} {hurst} {seed} {share}"
                    );
                }
            }
            assert_eq!(told(&clean), None);
        }
    }
}
