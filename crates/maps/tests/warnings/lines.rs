//! Warnings of scan lines.

use super::*;

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
