//! Leakage against exact solutions, and against dense ones of the same network.

mod dense;
mod grid_error;

use std::f64::consts::TAU;
use std::sync::atomic::{AtomicUsize, Ordering};

use approx::assert_relative_eq;
use asperity::{Amplitude, Control, Grid, NoAdhesion, Problem, SelfAffine, Solver, Westergaard};
use asperity_flow::{Axis, Gap, Leakage};
use ndarray::Array2;

use crate::random_gaps;

/// Twelve times the transmissivities along x and y, with both bounds within 1e-9.
fn conductances(gap: &Gap<'_>) -> [f64; 2] {
    let leak = Leakage::default().tolerance(1e-9).through(gap).unwrap();
    assert!(leak.reached());
    Axis::BOTH.map(|axis| {
        let bounds = leak.along(axis).transmissivity;
        assert!(bounds.lower <= bounds.upper && bounds.width() <= 1e-9);
        6.0 * (bounds.lower + bounds.upper)
    })
}

#[test]
fn slots_side_by_side_and_one_after_the_other() {
    let (nx, ny) = (24, 10);
    let grid = Grid::new((nx, ny), (3.0, 2.0)).unwrap();
    let slot = |j: usize| 0.3 + 0.1 * (j as f64) + if j.is_multiple_of(3) { 2.0 } else { 0.0 };
    let values = Array2::from_shape_fn((nx, ny), |(_, j)| slot(j));
    let cubes: Vec<f64> = (0..ny).map(|j| slot(j).powi(3)).collect();
    let arithmetic = cubes.iter().sum::<f64>() / ny as f64;
    let harmonic = ny as f64 / cubes.iter().map(|cube| 1.0 / cube).sum::<f64>();
    let gap = Gap::new(values.view(), grid).unwrap();
    for gap in [gap.clone(), gap.free()] {
        let [along, across] = conductances(&gap);
        assert_relative_eq!(along, arithmetic * 2.0 / 3.0, max_relative = 1e-9);
        assert_relative_eq!(across, harmonic * 3.0 / 2.0, max_relative = 1e-9);
    }
}

#[test]
fn a_plane_slot_of_a_square_cell_has_a_twelfth_of_the_cube() {
    let grid = Grid::square(8, 5.0).unwrap();
    let values = Array2::from_elem((8, 8), 2.0);
    let leak = Leakage::default().tolerance(1e-12).through(&Gap::new(values.view(), grid).unwrap().free()).unwrap();
    for axis in Axis::BOTH {
        let flow = leak.along(axis);
        assert_relative_eq!(flow.transmissivity.lower, 8.0 / 12.0, max_relative = 1e-12);
        assert_relative_eq!(flow.transmissivity.upper, 8.0 / 12.0, max_relative = 1e-12);
        // fields are right to the square root of what the bounds are; the pressure is that in the middle of the cells
        let (along, across) = (&flow.flow[axis as usize], &flow.flow[1 - axis as usize]);
        assert!(along.iter().all(|flow| (flow - 8.0 / 12.0 / 5.0).abs() < 1e-6));
        assert!(across.iter().all(|flow| flow.abs() < 1e-6));
        let fall = |k: usize| 1.0 - (k as f64 + 0.5) / 8.0;
        let expected = |(i, j)| fall(if axis == Axis::X { i } else { j });
        assert!(flow.pressure.indexed_iter().all(|(node, pressure)| (pressure - expected(node)).abs() < 1e-6));
    }
}

#[test]
fn a_wave_leaks_along_and_across_as_in_closed_form() {
    let (n, epsilon) = (64, 0.6_f64);
    let grid = Grid::square(n, 1.0).unwrap();
    let (along, across) =
        (1.0 + 1.5 * epsilon.powi(2), 2.0 * (1.0 - epsilon.powi(2)).powf(2.5) / (2.0 + epsilon.powi(2)));
    let values = grid.sample(|x, _| 1.0 + epsilon * (TAU * x).cos());
    let [x, y] = conductances(&Gap::new(values.view(), grid).unwrap());
    // sums over a period converge faster than any power of the spacing
    assert_relative_eq!(x, across, max_relative = 1e-8);
    assert_relative_eq!(y, along, max_relative = 1e-8);

    // waves along a diagonal: the mean of both, to second order
    let error = |n: usize| {
        let grid = Grid::square(n, 1.0).unwrap();
        let values = grid.sample(|x, y| 1.0 + epsilon * (TAU * (x + y)).cos());
        let [x, y] = conductances(&Gap::new(values.view(), grid).unwrap());
        assert_relative_eq!(x, y, max_relative = 1e-8);
        (x - 0.5 * (along + across)).abs()
    };
    let errors = [16, 32, 64].map(error);
    assert!(errors[2] < 1e-2, "{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.3, "{errors:?}");
    }
}

#[test]
fn a_checkerboard_tends_to_the_geometric_mean() {
    // A. M. Dykhne, Sov. Phys. JETP 32, 63 (1971)
    let contrast = 4.0_f64;
    let error = |n: usize| {
        let grid = Grid::square(n, 1.0).unwrap();
        let wide = |k: usize| 2 * k < n;
        let field = |(i, j)| if wide(i) == wide(j) { contrast.cbrt() } else { 1.0 };
        let [x, y] = conductances(&Gap::new(Array2::from_shape_fn((n, n), field).view(), grid).unwrap());
        assert_relative_eq!(x, y, max_relative = 1e-8);
        (x / contrast.sqrt() - 1.0).abs()
    };
    let errors = [8, 16, 32, 64].map(error);
    assert!(errors[3] < 2e-2 && errors.windows(2).all(|pair| pair[1] < 0.7 * pair[0]), "{errors:?}");
}

#[test]
fn stripes_of_any_contrast_are_exact() {
    let n = 32;
    let grid = Grid::square(n, 1.0).unwrap();
    for narrow in [1e-2, 1e-4, 1e-6] {
        let values = Array2::from_shape_fn((n, n), |(_, j)| if j % 8 < 4 { 1.0 } else { narrow });
        let gap = Gap::new(values.view(), grid).unwrap();
        for gap in [gap.clone(), gap.free()] {
            // pressures near 1 that are rounded lose 1e-32 at each of 2000 wide edges, against 2e-18
            let leak = Leakage::default().tolerance(1e-10).through(&gap).unwrap();
            let cube = narrow * narrow * narrow;
            for (axis, exact) in Axis::BOTH.into_iter().zip([0.5 * (1.0 + cube), 2.0 / (1.0 + 1.0 / cube)]) {
                let flow = leak.along(axis);
                assert!(flow.reached && flow.iterations == 0, "{narrow} {axis:?}: {:?}", flow.transmissivity);
                assert_relative_eq!(12.0 * flow.transmissivity.upper, exact, max_relative = 1e-10);
            }
        }
    }
}

#[test]
fn both_axes_at_once_are_each_axis_alone() {
    let mut apart = 0;
    for (values, periodic) in random_gaps(17).take(200) {
        let gap = Gap::new(values.view(), Grid::new(values.dim(), (1.0, 1.7)).unwrap()).unwrap();
        let gap = if periodic { gap } else { gap.free() };
        let both = Leakage::default().through(&gap).unwrap();
        for axis in Axis::BOTH {
            let (one, alone) = (both.along(axis), Leakage::default().along(&gap, &gap.percolation(), axis).unwrap());
            assert_eq!(one.transmissivity, alone.transmissivity);
            assert!(one.flow == alone.flow);
            apart += usize::from(periodic && alone.nodes != both.along(Axis::X).nodes);
        }
    }
    // some wind along one axis alone
    assert!(apart > 5, "{apart}");
}

#[test]
fn nothing_flows_where_nothing_percolates() {
    let grid = Grid::square(6, 1.0).unwrap();
    let mut values = Array2::from_elem((6, 6), 1.0);
    values.row_mut(3).fill(0.0);
    let leak = Leakage::default().through(&Gap::new(values.view(), grid).unwrap()).unwrap();
    let (x, y) = (leak.along(Axis::X), leak.along(Axis::Y));
    assert_eq!((x.transmissivity.lower, x.transmissivity.upper, x.reached), (0.0, 0.0, true));
    assert!(x.pressure.iter().all(|pressure| pressure.is_nan()) && x.flow.iter().flatten().all(|flow| *flow == 0.0));
    assert_relative_eq!(y.transmissivity.upper, 5.0 / 6.0 / 12.0, max_relative = 1e-6);
}

#[test]
fn contrasts_of_1e12_and_more_are_enclosed() {
    // two wide pools that a narrow channel connects, with dead ends
    let n = 40;
    let grid = Grid::square(n, 1.0).unwrap();
    for narrow in [1e-2, 1e-4, 1e-6] {
        let field = |(i, j): (usize, usize)| match i {
            18..22 if j == 7 => narrow,
            18..22 => 0.0,
            _ if i % 5 == 3 && j % 4 != 1 => 0.0,
            _ => 1.0 + 0.3 * (j as f64).sin(),
        };
        let values = Array2::from_shape_fn((n, n), field);
        let gap = Gap::new(values.view(), grid).unwrap();
        for gap in [gap.clone(), gap.free()] {
            let [x, _] = conductances(&gap);
            // four cells in a row, and half a wide one at either end, compared with which the pools resist little
            assert!((x / (narrow.powi(3) / 4.0) - 1.0).abs() < 10.0 * narrow.powi(3) + 1e-7, "{narrow}: {x}");
        }
    }
}

#[test]
fn units_do_not_matter_and_bits_repeat() {
    for (values, periodic) in random_gaps(5).take(20) {
        let leak = |scale: f64, tolerance: f64| {
            let grid = Grid::new(values.dim(), (scale, 2.0 * scale)).unwrap();
            let scaled = values.mapv(|gap| gap * scale);
            let gap = Gap::new(scaled.view(), grid).unwrap();
            let gap = if periodic { gap } else { gap.free() };
            let leak = Leakage::default().tolerance(tolerance).through(&gap).unwrap();
            Axis::BOTH.map(|axis| [leak.along(axis).transmissivity.lower, leak.along(axis).transmissivity.upper])
        };
        let ones = leak(1.0, 1e-3);
        assert_eq!(ones, leak(1.0, 1e-3));
        assert_eq!(ones, leak(0.5_f64.powi(30), 1e-3).map(|bounds| bounds.map(|bound| bound * 2.0_f64.powi(90))));
        for (one, small) in leak(1.0, 1e-10).iter().flatten().zip(leak(1e-9, 1e-10).iter().flatten()) {
            assert_relative_eq!(*one, small * 1e27, max_relative = 2e-10);
        }
    }
}

#[test]
fn absent_nodes_are_closed_or_open_as_asked() {
    let grid = Grid::square(4, 1.0).unwrap();
    let values = Array2::from_shape_fn((4, 4), |(i, _)| if i == 2 { f64::NAN } else { 1.0 });
    let gap = Gap::new(values.view(), grid).unwrap();
    assert_eq!(conductances(&gap)[0], 0.0);
    let open = gap.absent(2.0).unwrap();
    assert_relative_eq!(conductances(&open)[0], 4.0 / (3.0 + 1.0 / 8.0), max_relative = 1e-9);
}

#[test]
fn unusable_input_is_refused_by_name() {
    let grid = Grid::square(4, 1.0).unwrap();
    let values = Array2::from_elem((4, 4), 1.0);
    let gap = Gap::new(values.view(), grid).unwrap();
    let named = |error: asperity::Error| error.to_string();
    assert!(named(Gap::new(values.view(), Grid::square(5, 1.0).unwrap()).unwrap_err()).contains("gap"));
    // heights, but not what a solve leaves of zero, nor what has no surface
    for (own, refused) in [(-26.3, true), (-1e-5, true), (-1e-7, false), (f64::NEG_INFINITY, false)] {
        let mut heights = values.clone();
        heights[[2, 1]] = own;
        let found = Gap::new(heights.view(), grid);
        let is_named = |error: &asperity::Error| matches!(error, asperity::Error::Value { value, .. } if *value == own);
        assert_eq!(found.err().as_ref().map(is_named), refused.then_some(true), "{own}");
    }
    assert!(named(gap.clone().absent(-1.0).unwrap_err()).contains("gap of absent nodes is -1"));
    for tolerance in [0.0, 1.0, f64::NAN] {
        assert!(named(Leakage::default().tolerance(tolerance).through(&gap).unwrap_err()).contains("tolerance"));
    }
    assert!(named(Leakage::default().max_iterations(0).through(&gap).unwrap_err()).contains("max_iterations"));
    let mut minute = values.clone();
    minute[[1, 1]] = 1e-120;
    let minute = Gap::new(minute.view(), grid).unwrap();
    assert!(named(Leakage::default().through(&minute).unwrap_err()).contains("least open gap over the greatest"));
}

#[test]
fn too_few_iterations_leave_bounds_apart_that_hold() {
    let grid = Grid::square(32, 1.0).unwrap();
    let values = grid.sample(|x, y| 1.0 + 0.9 * (TAU * (3.0 * x + y)).cos() * (TAU * 2.0 * y).sin());
    let gap = Gap::new(values.view(), grid).unwrap();
    let exact = conductances(&gap);
    let few = Leakage::default().max_iterations(3).tolerance(1e-12).through(&gap).unwrap();
    assert!(!few.reached());
    for axis in Axis::BOTH {
        let bounds = few.along(axis).transmissivity;
        let exact = exact[axis as usize] / 12.0;
        assert!(
            bounds.width() > 1e-12 && bounds.lower <= exact && exact <= bounds.upper * (1.0 + 1e-9),
            "{bounds:?} {exact}"
        );
    }
}

#[test]
fn a_leakage_that_does_not_go_on_has_bounds_that_hold() {
    let grid = Grid::square(64, 1.0).unwrap();
    let wavy = grid.sample(|x, y| 1.0 + 0.9 * (TAU * (x + 2.0 * y)).cos() * (TAU * 3.0 * x).sin());
    let gap = Gap::new(wavy.view(), grid).unwrap();
    let whole = Leakage::default().through(&gap).unwrap();
    let looks = AtomicUsize::new(0);
    let cut = Leakage::default().through_while(&gap, &|| looks.fetch_add(1, Ordering::Relaxed) < 4).unwrap();
    for axis in Axis::BOTH {
        let [(own, reached), (ended, early)] =
            [&whole, &cut].map(|leak| (leak.along(axis).transmissivity, leak.along(axis).reached));
        assert!(reached && !early && ended.lower < own.lower && own.upper < ended.upper, "{own:?} {ended:?}");
        // the preparation has the first looks
        assert_eq!(cut.along(axis).iterations, 0);
    }
}
