//! Tests of the corrections of a measurement: offsets of scan lines, spikes, and codes for missing points.

use approx::assert_relative_eq;

use super::super::{RowAlignment, ScanAxis, Topography};
use super::{map, pierced, rough};
use asperity::Error;

/// A rough map with offset lines along x, a lost line and lost points.
fn scanned(offset: impl Fn(usize, usize) -> f64) -> Topography {
    let mut map = pierced(rough((60, 41), 12.0), |i, j| j == 17 || (7 * i + 3 * j).is_multiple_of(29));
    map.heights.indexed_iter_mut().for_each(|((i, j), h)| *h += offset(i, j));
    map
}

#[test]
fn aligned_rows_do_not_know_of_offsets_between_lines() {
    let drift = |j: usize| 30.0 * (1.3 * j as f64).sin() + j as f64;
    let (even, uneven) = (scanned(|_, _| 0.0), scanned(|_, j| drift(j)));
    for alignment in [RowAlignment::Median, RowAlignment::MedianDifference, RowAlignment::Polynomial(0)] {
        let [a, b] = [&even, &uneven].map(|map| map.clone().align_rows(alignment, ScanAxis::X).unwrap());
        assert_relative_eq!(a.mean(), even.mean(), epsilon = 1e-12);
        assert_relative_eq!(b.mean(), uneven.mean(), max_relative = 1e-12);
        // the same but for the mean height of the drift, with the rounding of heights of 70
        let shift = b.mean() - a.mean();
        for (a, b) in a.heights.iter().zip(&b.heights) {
            assert!(a.is_nan() && b.is_nan() || (b - a - shift).abs() < 1e-12, "{alignment:?}: {a} {b}");
        }
        // lines along y are another matter
        let mut turned = uneven.clone();
        turned.heights = turned.heights.reversed_axes();
        let turned = turned.align_rows(alignment, ScanAxis::Y).unwrap();
        let same = |(a, b): (&f64, &f64)| a.is_nan() && b.is_nan() || (a - b).abs() < 1e-12;
        assert!(turned.heights.t().iter().zip(&b.heights).all(same));
        let across = uneven.clone().align_rows(alignment, ScanAxis::Y).unwrap();
        assert!(across.heights.iter().zip(&b.heights).any(|(a, b)| (a - b).abs() > 1.0));
    }
    // tilts and bows of each line, too
    let bent = scanned(|i, j| drift(j) + (j as f64).cos() * i as f64 + 0.1 * (j as f64).sin() * (i * i) as f64);
    let [a, b] = [&even, &bent].map(|map| map.clone().align_rows(RowAlignment::Polynomial(2), ScanAxis::X).unwrap());
    let shift = b.mean() - a.mean();
    for (a, b) in a.heights.iter().zip(&b.heights) {
        assert!(a.is_nan() && b.is_nan() || (b - a - shift).abs() < 1e-9, "{a} {b}");
    }
    assert!(matches!(
        bent.align_rows(RowAlignment::Polynomial(13), ScanAxis::X),
        Err(Error::Value { value: 13.0, .. })
    ));
}

#[test]
fn differences_of_lines_keep_a_large_feature_that_medians_flatten() {
    // a plateau that grows by two nodes from line to line, until it covers most of them, on lines with offsets
    let plateau = |i: f64, j: f64| if j > 12.0 && i + 2.0 * (j - 12.0) > 40.0 { 5.0 } else { 0.0 };
    let offset = |j: f64| 20.0 * (2.0 * j).cos();
    let map = map((40, 30), (1.0, 1.0), |i, j| plateau(i, j) + offset(j) + 0.1 * (3.0 * i + 7.0 * j).sin());
    // next to the plateau, the last lines above the first: 0 but for the noise, or its height below
    let beside = |alignment| {
        let heights = map.clone().align_rows(alignment, ScanAxis::X).unwrap().heights;
        let mean = |lines| {
            heights.select(ndarray::Axis(1), lines).rows().into_iter().take(5).map(|r| r.sum()).sum::<f64>() / 25.0
        };
        mean(&[25, 26, 27, 28, 29]) - mean(&[5, 6, 7, 8, 9])
    };
    let (medians, differences) = (beside(RowAlignment::Median), beside(RowAlignment::MedianDifference));
    assert!((medians + 5.0).abs() < 0.5 && differences.abs() < 0.5, "{medians} {differences}");
}

#[test]
fn spikes_are_found_and_replaced_and_nothing_else() {
    let clean = pierced(rough((80, 60), 8.0), |i, j| (i + 3 * j).is_multiple_of(37) || i < 6 && j < 20);
    assert_eq!(clean.spikes(10.0).unwrap().worst, None);
    assert!(clean.clone().despike(10.0).unwrap().heights.iter().zip(&clean.heights).all(|(a, b)| a == b || b.is_nan()));
    // in a corner, next to a hole, down, and three nodes together
    let spikes = [((79, 59), 50.0), ((6, 9), -80.0), ((40, 30), 60.0), ((40, 31), 61.0), ((41, 31), 62.0)];
    let mut dirty = clean.clone();
    spikes.iter().for_each(|(node, height)| dirty.heights[*node] = *height);
    let found = dirty.spikes(10.0).unwrap();
    let nodes: Vec<_> = found.nodes.iter().map(|(node, _)| *node).collect();
    assert_eq!(nodes, [(6, 9), (40, 30), (40, 31), (41, 31), (79, 59)]);
    let (worst, distance) = found.worst.unwrap();
    // heights are 1 rms, and smooth
    assert!(worst == (6, 9) && (distance + 80.0).abs() < 5.0, "{distance} at {worst:?}");
    let despiked = dirty.despike(10.0).unwrap();
    for ((node, after), before) in despiked.heights.indexed_iter().zip(&clean.heights) {
        let spike = nodes.contains(&node);
        assert!(
            after == before || after.is_nan() && before.is_nan() || spike && after.abs() < 5.0,
            "{after} at {node:?}"
        );
    }
    // slopes at edges, in corners and next to holes are no spikes
    let tilted = |i: f64, j: f64| 50.0 * i - 20.0 * j + 0.1 * (i * i + 3.0 * j).sin();
    let tilted =
        pierced(map((40, 30), (1.0, 1.0), tilted), |i, j| (10..20).contains(&i) && j < 12 || i == 30 && j != 4);
    assert_eq!(tilted.spikes(10.0).unwrap().nodes, []);
    // levels with a spike have a deviation, flat maps have none
    let mut levels = map((30, 30), (1.0, 1.0), |i, _| if i < 15.0 { 1.0 } else { 2.0 });
    assert!(levels.spikes(10.0).unwrap().nodes.is_empty());
    levels.heights[[3, 3]] = 9.0;
    assert_eq!(levels.spikes(10.0).unwrap().nodes, [((3, 3), 1.0)]);
    assert!(matches!(levels.despike(0.0), Err(Error::Value { name: "threshold of spikes", .. })));
}

#[test]
fn scars_are_counted_and_filled_and_nothing_else_is() {
    // rough down to two nodes, and round; waves along the lines, and across them; with holes
    let clean = [
        rough((96, 80), 30.0),
        rough((96, 80), 6.0),
        map((96, 80), (1.0, 1.0), |_, j| (0.3 * j).cos()),
        map((96, 80), (1.0, 1.0), |i, j| (0.4 * i).sin() + 0.01 * j),
        pierced(rough((96, 80), 12.0), |i, j| (i + 3 * j).is_multiple_of(37) || i < 6 && j < 20),
    ];
    for (k, clean) in clean.iter().enumerate() {
        for along in [ScanAxis::X, ScanAxis::Y] {
            assert_eq!(clean.scars(0.667, along).unwrap().count, 0, "{k} {along:?}");
        }
        let same = clean.clone().remove_scars(0.667, ScanAxis::X).unwrap().heights;
        assert!(same.iter().zip(&clean.heights).all(|(a, b)| a.to_bits() == b.to_bits()), "{k}");
    }
    // up and down, one to three lines wide, and a short one, which stays
    let mut scarred = clean[0].clone();
    for (from, to, line, width, height) in
        [(5, 40, 10, 1, 9.0), (50, 96, 11, 2, -7.0), (20, 60, 50, 3, 6.0), (0, 16, 70, 1, -20.0), (30, 45, 75, 1, 9.0)]
    {
        for (i, j) in (from..to).flat_map(|i| (line..line + width).map(move |j| (i, j))) {
            scarred.heights[[i, j]] += height;
        }
    }
    let scars = scarred.scars(0.667, ScanAxis::X).unwrap();
    let on_scars = scars.map.iter().filter(|on_scar| **on_scar).count();
    assert_eq!((scars.count, on_scars), (4, 35 + 2 * 46 + 3 * 40 + 16));
    let left = scarred.clone().without(&scars).unwrap();
    let distance = |map: &Topography| {
        let squares = map.heights.iter().zip(&clean[0].heights).zip(&scars.map);
        squares.filter(|(_, on_scar)| **on_scar).map(|((a, b), _)| (a - b).powi(2)).sum::<f64>() / on_scars as f64
    };
    // of the heights, 1 rms, a membrane over one to three lines misses less than a third
    assert!(distance(&left).sqrt() < 0.33 && distance(&scarred).sqrt() > 6.0, "{}", distance(&left).sqrt());
    for (node, on_scar) in scars.map.indexed_iter() {
        assert!(*on_scar || left.heights[node] == scarred.heights[node], "{node:?}");
    }
    // lines along y are columns
    let mut turned = scarred.clone();
    turned.heights = turned.heights.reversed_axes();
    turned.lengths = turned.lengths.map(|(x, y)| (y, x));
    let turned = turned.remove_scars(0.667, ScanAxis::Y).unwrap();
    assert!(turned.heights.t().iter().zip(&left.heights).all(|(a, b)| (a - b).abs() < 1e-9));
    assert!(matches!(left.scars(0.0, ScanAxis::X), Err(Error::Value { name: "threshold of scars", .. })));
}

#[test]
fn codes_become_missing_to_the_rounding_of_their_file() {
    let code = -9999.9;
    let mut coded = rough((20, 20), 6.0);
    coded.heights[[3, 4]] = code;
    coded.heights[[5, 6]] = f64::from(code as f32);
    coded.heights[[7, 8]] = code + 0.1;
    let declared = coded.declare_missing(code);
    assert_eq!(declared.missing(), 2);
    assert_eq!(declared.heights[[7, 8]], code + 0.1);
    let zeros = map((4, 4), (1.0, 1.0), |i, j| i * j).declare_missing(0.0);
    assert_eq!(zeros.missing(), 7);
}
