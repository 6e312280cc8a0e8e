//! Tests of height maps.

use std::f64::consts::TAU;

use approx::assert_relative_eq;
use ndarray::{Array2, Zip};

use super::{Topography, Trend};
use asperity::Error;
use asperity::Grid;
use asperity::{Amplitude, SelfAffine, Surface};

mod defects;
mod form;

/// A map of `f` of the indices, with side lengths.
fn map(shape: (usize, usize), lengths: (f64, f64), f: impl Fn(f64, f64) -> f64) -> Topography {
    let heights = Array2::from_shape_fn(shape, |(i, j)| f(i as f64, j as f64));
    Topography { lengths: Some(lengths), ..Topography::new(heights) }
}

fn rough(shape: (usize, usize), k_s: f64) -> Topography {
    let amplitude = Amplitude::RmsHeight(1.0);
    let rough = SelfAffine::default().hurst(0.7).k_l(1.0).k_r(2.0).k_s(k_s).amplitude(amplitude).seed(5);
    rough.surface(Grid::new(shape, (1.0, 1.3)).unwrap()).unwrap().into()
}

/// Makes holes where `missing` says so.
fn pierced(mut map: Topography, missing: impl Fn(usize, usize) -> bool) -> Topography {
    map.heights.indexed_iter_mut().filter(|((i, j), _)| missing(*i, *j)).for_each(|(_, h)| *h = f64::NAN);
    map
}

#[track_caller]
fn assert_same(a: &Array2<f64>, b: &Array2<f64>, epsilon: f64) {
    assert_eq!(a.dim(), b.dim());
    Zip::indexed(a).and(b).for_each(|at, a, b| assert!((a - b).abs() <= epsilon, "{a} is not {b} at {at:?}"));
}

#[test]
fn discrete_harmonic_functions_fill_their_holes() {
    let holes = |i: usize, j: usize| {
        (5..18).contains(&i) && (4..9).contains(&j) || i == 25 && (2..15).contains(&j) || (i + j).is_multiple_of(7)
    };
    let inside = |i: usize, j: usize| i > 0 && j > 0 && i < 29 && j < 19;
    // second differences of i² over Δx² and of j² over Δy² cancel if the curvatures do, on oblong cells too
    for (lengths, f) in [
        (
            (30.0, 20.0),
            Box::new(|x: f64, y: f64| 3.0 + 0.5 * x - y + 0.1 * (x * x - y * y)) as Box<dyn Fn(f64, f64) -> f64>,
        ),
        ((30.0, 20.0), Box::new(|x, y| x * y * (x * x - y * y) / 100.0)),
        ((30.0, 60.0), Box::new(|x, y| 0.1 * (x * x - y * y))),
    ] {
        let whole = map((30, 20), lengths, |i, j| f(i * lengths.0 / 30.0, j * lengths.1 / 20.0));
        let filled = pierced(whole.clone(), |i, j| holes(i, j) && inside(i, j)).fill().unwrap();
        assert_eq!(filled.missing(), 0);
        // a residual of 1e-12 times the condition number of the holes, about their size squared
        assert_same(&filled.heights, &whole.heights, 1e-9);
    }
}

#[test]
fn every_pattern_of_holes_is_filled_between_its_surroundings() {
    let whole = map((24, 17), (1.0, 1.0), |i, j| 1e3 + (0.7 * i).sin() + (0.3 * j * i).cos());
    // edges and corners, a checkerboard, all but a point, islands, infinities
    let patterns: [fn(usize, usize) -> bool; 6] = [
        |i, _| i < 9,
        |i, j| (i + j).is_multiple_of(2),
        |i, j| (i, j) != (3, 16),
        |i, j| (5..20).contains(&i) && (3..14).contains(&j) && (i, j) != (12, 8),
        |_, j| j != 2,
        |_, _| false,
    ];
    for missing in patterns {
        let pierced = pierced(whole.clone(), missing);
        let known = pierced.heights.iter().copied().filter(|h| h.is_finite());
        let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let filled = pierced.clone().fill().unwrap();
        for ((at, h), before) in filled.heights.indexed_iter().zip(&pierced.heights) {
            assert!(*h >= low - 1e-9 && *h <= high + 1e-9, "{h} at {at:?}");
            assert!(!before.is_finite() || before == h);
        }
    }
    // nothing across the edge, and a gap in a line is bridged by a straight piece
    let mut line = map((9, 1), (3.0, 77.0), |i, _| if (2.0..5.0).contains(&i) { f64::INFINITY } else { i * i });
    line.heights[[8, 0]] = f64::NAN;
    let filled = line.fill().unwrap().heights;
    for (i, expected) in [0.0, 1.0, 7.0, 13.0, 19.0, 25.0, 36.0, 49.0, 49.0].into_iter().enumerate() {
        assert_relative_eq!(filled[[i, 0]], expected, epsilon = 1e-10);
    }
    let nothing = Topography::new(Array2::from_elem((3, 4), f64::NAN));
    for result in
        [nothing.clone().fill().map(drop), nothing.fit(Trend::Plane).map(drop), nothing.detrend(Trend::Mean).map(drop)]
    {
        assert!(matches!(result, Err(Error::Value { name: "number of measured heights", value: 0.0, .. })));
    }
}

#[test]
fn trends_are_found_and_removed_exactly_whatever_is_missing() {
    // x and y from the centre of the map
    let (shape, lengths) = ((31, 22), (6.2, 2.2));
    let at = |i: f64, j: f64| ((i - 15.0) * 0.2, (j - 10.5) * 0.1);
    let whole = map(shape, lengths, |i, j| {
        let (x, y) = at(i, j);
        1e4 + 2.0 * x - 3.0 * y + 0.5 * x * x + 0.25 * x * y - y * y
    });
    let patterns: [fn(usize, usize) -> bool; 4] =
        [|_, _| false, |i, j| i > 20 || j < 5, |i, j| (i * j) % 3 != 0, |i, j| !(i < 4 && j < 5)];
    for missing in patterns {
        let pierced = pierced(whole.clone(), missing);
        let fit = pierced.fit(Trend::Quadric).unwrap();
        assert_relative_eq!(fit.height, 1e4, max_relative = 1e-12);
        for (found, expected) in [
            (fit.slopes.0, 2.0),
            (fit.slopes.1, -3.0),
            (fit.curvatures.0, 1.0),
            (fit.curvatures.1, 0.25),
            (fit.curvatures.2, -2.0),
        ] {
            // rounding of heights of 1e4, extrapolated from the corner in the last pattern
            assert_relative_eq!(found, expected, epsilon = 1e-7);
        }
        let flat = pierced.clone().detrend(Trend::Quadric).unwrap();
        assert_eq!(flat.missing(), pierced.missing());
        assert!(flat.heights.iter().all(|h| !h.is_finite() || h.abs() < 1e-10));
        assert!(fit.residual < 1e-10);
    }

    // what remains is orthogonal to the trend, and has the least squares
    let measured = pierced(rough((40, 36), 12.0), |i, j| (i * i + j).is_multiple_of(11));
    for (trend, terms) in [(Trend::Mean, 1), (Trend::Plane, 3), (Trend::Quadric, 6)] {
        let flat = measured.clone().detrend(trend).unwrap();
        let sum = |term: usize| -> f64 {
            let weigh = |(i, j): (usize, usize)| {
                let (x, y) = (i as f64 / 40.0, j as f64 / 36.0);
                [1.0, x, y, x * x, x * y, y * y][term]
            };
            flat.heights.indexed_iter().filter(|(_, h)| h.is_finite()).map(|(at, h)| weigh(at) * h).sum()
        };
        assert!((0..terms).all(|term| sum(term).abs() < 1e-10), "{trend:?}");
        assert_relative_eq!(flat.rms_height(), measured.fit(trend).unwrap().residual, max_relative = 1e-12);
        assert_same(
            &flat.clone().detrend(trend).unwrap().heights.mapv(|h| if h.is_nan() { 0.0 } else { h }),
            &flat.heights.mapv(|h| if h.is_nan() { 0.0 } else { h }),
            1e-13,
        );
    }

    // a line, two rows, a single point: what cannot be told apart has no share
    let line = map((9, 1), (9.0, 9.0), |i, _| 1.0 + 2.0 * i + 3.0 * i * i);
    let fit = line.fit(Trend::Quadric).unwrap();
    assert_relative_eq!(fit.curvatures.0, 6.0, epsilon = 1e-12);
    assert_eq!((fit.slopes.1, fit.curvatures.1, fit.curvatures.2), (0.0, 0.0, 0.0));
    let rows = map((2, 9), (2.0, 9.0), |i, j| 5.0 * i + j * j);
    assert!(rows.detrend(Trend::Quadric).unwrap().heights.iter().all(|h| h.abs() < 1e-12));
    let point = pierced(map((5, 5), (1.0, 1.0), |_, _| 7.0), |i, j| (i, j) != (1, 3)).detrend(Trend::Quadric).unwrap();
    assert_eq!((point.heights[[1, 3]], point.missing()), (0.0, 24));
}

#[test]
fn refinement_keeps_nodes_mean_and_mirror_images() {
    for (shape, fine) in
        [((16, 10), (48, 50)), ((15, 9), (45, 9)), ((16, 9), (16, 27)), ((12, 1), (60, 1)), ((1, 7), (1, 21))]
    {
        let map = map(shape, (2.0, 3.0), |i, j| 1e3 + ((3.1 * i + 1.7 * j * j).sin() * 2.0).exp());
        let refined = map.clone().resample(fine).unwrap();
        assert_eq!((refined.heights.dim(), refined.lengths), (fine, map.lengths));
        let (a, b) = (fine.0 / shape.0, fine.1 / shape.1);
        let kept = Array2::from_shape_fn(shape, |(i, j)| refined.heights[[a * i + a / 2, b * j + b / 2]]);
        assert_same(&kept, &map.heights, 1e-11);
        let turned = |map: &Topography| {
            Array2::from_shape_fn(map.heights.dim(), |(i, j)| map.heights[[map.heights.nrows() - 1 - i, j]])
        };
        for nodes in [fine, (shape.0.div_ceil(2), 2 * shape.1)] {
            let facing = Topography { heights: turned(&map), ..map.clone() }.resample(nodes).unwrap();
            assert_same(&facing.heights, &turned(&map.clone().resample(nodes).unwrap()), 1e-11);
        }
        assert_relative_eq!(refined.mean(), map.mean(), max_relative = 1e-14);
        // and back again, the shortest waves too
        assert_same(&refined.resample(shape).unwrap().heights, &map.heights, 1e-11);
    }
}

#[test]
fn band_limited_surfaces_are_resampled_exactly() {
    // the same surface for a seed on every grid that resolves it, but for where the origin lies
    let (coarse, fine) = (rough((32, 36), 12.0), rough((96, 90), 12.0));
    let (low, high) = (coarse.clone().surface().unwrap(), fine.clone().surface().unwrap());
    let refined = coarse.clone().resample((96, 90)).unwrap();
    let spectrum = refined.clone().surface().unwrap().statistics();
    assert_relative_eq!(spectrum.rms_slope, high.statistics().rms_slope, max_relative = 1e-11);
    assert_relative_eq!(spectrum.rms_curvature, high.statistics().rms_curvature, max_relative = 1e-11);
    assert_relative_eq!(refined.rms_height(), low.rms_height(), max_relative = 1e-12);
    // half a coarse node less half a fine one before its nodes; behind them where it is turned over
    let facing = |map: &Topography, nodes: (f64, f64)| {
        let surface = map.clone().surface().unwrap();
        let (grid, (dx, dy)) = (*surface.grid(), surface.grid().spacing());
        Surface::from_fn(grid, |_, _| 0.0).unwrap().against(&surface, (nodes.0 * dx, nodes.1 * dy)).unwrap()
    };
    let behind = (0.5 * 3.0 - 0.5, 0.5 - 0.5 * 2.5);
    assert_same(facing(&refined, behind).heights(), facing(&fine, (0.0, 0.0)).heights(), 1e-11);
    assert_same(&refined.clone().resample((32, 36)).unwrap().heights, &coarse.heights, 1e-12);
    assert_same(
        &refined.clone().resample((64, 34)).unwrap().resample((96, 90)).unwrap().heights,
        &refined.heights,
        1e-11,
    );
}

#[test]
fn the_shortest_wave_of_an_even_grid_is_a_cosine() {
    let alternating = map((6, 1), (1.0, 1.0), |i, _| if i % 2.0 == 0.0 { 1.0 } else { -1.0 });
    let refined = alternating.clone().resample((17, 1)).unwrap();
    for (i, h) in refined.heights.iter().enumerate() {
        assert_relative_eq!(*h, (3.0 * TAU * ((i as f64 + 0.5) / 17.0 - 0.5 / 6.0)).cos(), epsilon = 1e-14);
    }
    // coarser: a wave that is too short for the nodes vanishes, and the shortest one that they resolve is sampled
    let coarse = alternating.resample((3, 1)).unwrap();
    assert!(coarse.heights.iter().all(|h| h.abs() < 1e-15));
    let wave = map((12, 1), (1.0, 1.0), |i, _| (3.0 * TAU * i / 12.0 + 0.5).cos());
    for (i, h) in wave.resample((6, 1)).unwrap().heights.iter().enumerate() {
        assert_relative_eq!(*h, (3.0 * TAU * ((i as f64 + 0.5) / 6.0 - 0.5 / 12.0) + 0.5).cos(), epsilon = 1e-14);
    }
}

#[test]
fn a_mirrored_map_is_periodic_and_continuous() {
    let map = map((7, 4), (1.4, 2.0), |i, j| 10.0 * i + j * j);
    let mirrored = map.clone().mirror();
    assert_eq!((mirrored.heights.dim(), mirrored.lengths), ((14, 8), Some((2.8, 4.0))));
    assert_relative_eq!(mirrored.mean(), map.mean(), max_relative = 1e-14);
    assert_relative_eq!(mirrored.rms_height(), map.rms_height(), max_relative = 1e-14);
    assert_eq!((map.original, mirrored.original), (None, Some((7, 4))));
    assert_eq!(mirrored.clone().mirror().original, Some((7, 4)));
    let refined = mirrored.clone().resample((22, 16)).unwrap();
    assert_eq!(refined.original, Some((11, 8)));
    // half of 21 nodes is no side of the original
    let odd = mirrored.clone().resample((21, 16)).unwrap_err();
    assert!(odd.to_string().starts_with("nodes along x is 21: it must be even"), "{odd}");
    for ((i, j), value) in refined.heights.indexed_iter() {
        // images are met exactly
        assert_relative_eq!(*value, refined.heights[[21 - i, 15 - j]], epsilon = 1e-12);
    }
    assert_eq!(mirrored.clone().crop(0..7, 0..4).unwrap().original, None);
    let h = &mirrored.heights;
    for ((i, j), value) in h.indexed_iter() {
        assert_eq!(*value, h[[13 - i, j]]);
        assert_eq!(*value, h[[i, 7 - j]]);
        if i < 7 && j < 4 {
            assert_eq!(*value, map.heights[[i, j]]);
        }
    }
    // steps between neighbours, those across the edges too, are no larger than in the map
    for ((i, j), value) in h.indexed_iter() {
        assert!((h[[(i + 1) % 14, j]] - value).abs() <= 10.0 && (h[[i, (j + 1) % 8]] - value).abs() <= 5.0);
    }
    let line = Topography::new(Array2::from_shape_fn((3, 1), |(i, _)| i as f64)).mirror();
    assert_eq!(line.heights.into_raw_vec_and_offset().0, [0.0, 1.0, 2.0, 2.0, 1.0, 0.0]);
    let twice = pierced(map, |i, j| (i, j) == (2, 1)).mirror();
    assert_eq!(twice.missing(), 4);
}

#[test]
fn a_window_keeps_the_mean_and_the_middle_and_closes_the_edges() {
    let tilted = map((40, 30), (1.0, 1.0), |i, j| 1e3 + 5.0 * i - 2.0 * j + (i * j).sin());
    let windowed = tilted.clone().window(0.2).unwrap();
    assert_relative_eq!(windowed.mean(), tilted.mean(), max_relative = 1e-14);
    assert!(windowed.rms_height() < tilted.rms_height());
    let shift = windowed.heights[[20, 15]] - tilted.heights[[20, 15]];
    for (i, j) in [(8, 6), (31, 23), (8, 23), (19, 14)] {
        assert_relative_eq!(windowed.heights[[i, j]] - tilted.heights[[i, j]], shift, epsilon = 1e-10);
    }
    // at the outermost nodes sin²(π/2 · ½/8), and on the edge itself nothing
    let share = (0.25 * TAU * 0.5 / 8.0).sin().powi(2);
    let middle = windowed.heights.row(0).iter().map(|h| (h - tilted.mean()).abs()).fold(0.0, f64::max);
    assert!(middle < share * 2.0 * 160.0, "{middle}");
    // where heights know nothing of the window, the rms height falls by the rms of the window
    let noise = Topography::new(Array2::from_shape_fn((200, 150), |(i, j)| ((i * 7919 + j * 104_729) as f64).sin()));
    let mean_square = |n: usize| {
        let w = |i: usize| {
            let d = (i.min(n - 1 - i) as f64 + 0.5) / n as f64 / 0.25;
            if d < 1.0 { (0.25 * TAU * d).sin().powi(2) } else { 1.0 }
        };
        (0..n).map(|i| w(i).powi(2)).sum::<f64>() / n as f64
    };
    let expected = (mean_square(200) * mean_square(150)).sqrt();
    let ratio = noise.clone().window(0.25).unwrap().rms_height() / noise.rms_height();
    assert!((ratio / expected - 1.0).abs() < 0.02, "{ratio} is not {expected}");
    // on a line only x is tapered, and a flat map stays flat
    let line = map((50, 1), (1.0, 1.0), |i, _| i).window(0.5).unwrap().heights;
    assert!(line[[25, 0]] - line[[24, 0]] > 0.9);
    assert_same(
        &map((8, 8), (1.0, 1.0), |_, _| 3.0).window(0.3).unwrap().heights,
        &Array2::from_elem((8, 8), 3.0),
        1e-15,
    );
}

#[test]
fn what_cannot_be_is_refused() {
    let map = pierced(map((6, 5), (6.0, 5.0), |i, j| i + j), |i, j| (i, j) == (4, 2));
    for fraction in [0.0, -0.1, 0.51, f64::NAN, f64::INFINITY] {
        assert!(matches!(map.clone().window(fraction), Err(Error::Value { name: "window", .. })));
    }
    for result in
        [map.clone().window(0.1).map(drop), map.clone().resample((9, 9)).map(drop), map.clone().surface().map(drop)]
    {
        let Err(Error::NotFinite { count: 1, nodes: 30, first: (4, 2), .. }) = result else { panic!("{result:?}") };
        assert!(result.unwrap_err().to_string().contains("asperity_maps::fill"));
    }
    let full = map.clone().fill().unwrap();
    assert!(matches!(full.clone().resample((0, 3)), Err(Error::Value { .. })));
    assert!(matches!(full.clone().resample((usize::MAX, 3)), Err(Error::Value { .. })));
    for (x, y) in [(0..0, 0..5), (0..7, 0..5), (0..6, 5..6)] {
        assert!(matches!(full.clone().crop(x, y), Err(Error::Value { .. })));
    }
    let unknown = Topography::new(full.heights.clone()).surface().unwrap_err().to_string();
    assert!(unknown.contains("side length Lx") && unknown.contains("Topography::lengths"), "{unknown}");
    assert_eq!(full.clone().flip().flip(), full);
    assert_eq!(full.clone().flip().heights, -&full.heights);
    let surface = full.clone().surface().unwrap();
    assert_eq!(Topography::from(surface), full);
    assert_eq!(
        Surface::new(Grid::new((6, 5), (6.0, 5.0)).unwrap(), full.heights.clone()).unwrap(),
        full.surface().unwrap()
    );
}

#[test]
fn polynomials_of_any_order_are_removed_exactly() {
    for order in 0..=Trend::HIGHEST_ORDER {
        // all terms of the order, on oblong cells with holes
        let whole = map((41, 33), (4.0, 1.0), |i, j| {
            let (x, y) = ((i - 20.0) / 20.0, (j - 16.0) / 16.0);
            (0..=order).map(|k| (1.0 + k as f64) * x.powi(k as i32) * y.powi((order - k) as i32)).sum::<f64>() + 7.0
        });
        let pierced = pierced(whole, |i, j| (3 * i + 5 * j).is_multiple_of(11) || i < 6 && j > 20);
        let flat = pierced.clone().detrend(Trend::Polynomial(order)).unwrap();
        assert!(flat.heights.iter().all(|h| !h.is_finite() || h.abs() < 1e-11), "order {order}");
        if order > 0 {
            let lower = pierced.detrend(Trend::Polynomial(order - 1)).unwrap();
            assert!(lower.rms_height() > 1e-4, "order {order}: {}", lower.rms_height());
        }
    }
    let map = rough((40, 36), 12.0);
    for (trend, order) in [(Trend::Mean, 0), (Trend::Plane, 1), (Trend::Quadric, 2)] {
        assert_eq!(map.fit(trend).unwrap(), map.fit(Trend::Polynomial(order)).unwrap());
    }
    let refused = map.detrend(Trend::Polynomial(13)).unwrap_err();
    assert!(matches!(refused, Error::Value { name: "order of the trend", value: 13.0, .. }), "{refused}");
}
