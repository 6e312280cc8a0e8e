//! Bounds of the leakage next to dense matrices.

use super::*;

/// The conductance of the network along an axis by Gaussian elimination, from the definition.
fn dense(values: &Array2<f64>, (lx, ly): (f64, f64), periodic: bool, axis: Axis) -> f64 {
    let ((nx, ny), sides) = (values.dim(), [lx / values.dim().0 as f64, ly / values.dim().1 as f64]);
    let (n, number) = (nx * ny, |i: usize, j: usize| i * ny + j);
    // from, to (none at a side), conductance, pressure that falls besides the pressure of the nodes
    let mut edges: Vec<(usize, Option<usize>, f64, f64)> = Vec::new();
    for (i, j) in (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))) {
        for way in Axis::BOTH {
            let a = way as usize;
            let (k, m) = [(i, nx), (j, ny)][a];
            let (g, shape) = (values[[i, j]].powi(3), sides[1 - a] / sides[a]);
            let to = if way == Axis::X { ((i + 1) % nx, j) } else { (i, (j + 1) % ny) };
            let h = values[to].powi(3);
            if (periodic || k + 1 < m) && g > 0.0 && h > 0.0 {
                let driven = if way == axis && k + 1 == m { 1.0 } else { 0.0 };
                edges.push((number(i, j), Some(number(to.0, to.1)), shape * 2.0 / (1.0 / g + 1.0 / h), driven));
            }
            if !periodic && way == axis && g > 0.0 {
                // the first side is at a pressure of 1, and the last one at 0
                if k == 0 {
                    edges.push((number(i, j), None, 2.0 * shape * g, -1.0));
                }
                if k + 1 == m {
                    edges.push((number(i, j), None, 2.0 * shape * g, 0.0));
                }
            }
        }
    }
    let mut matrix = Array2::zeros((n, n + 1));
    for &(from, to, c, driven) in &edges {
        matrix[[from, from]] += c;
        matrix[[from, n]] -= c * driven;
        if let Some(to) = to {
            matrix[[to, to]] += c;
            matrix[[from, to]] -= c;
            matrix[[to, from]] -= c;
            matrix[[to, n]] += c * driven;
        }
    }
    let scale: Vec<f64> = (0..n).map(|k| matrix[[k, k]]).collect();
    for k in 0..n {
        // a node that is closed, or the last one of a part without sides
        if matrix[[k, k]] <= 1e-12 * scale[k] {
            continue;
        }
        for row in (0..n).filter(|row| *row != k) {
            let share = matrix[[row, k]] / matrix[[k, k]];
            if share != 0.0 {
                (0..=n).for_each(|column| matrix[[row, column]] -= share * matrix[[k, column]]);
            }
        }
    }
    let pressure = |k: usize| if matrix[[k, k]] <= 1e-12 * scale[k] { 0.0 } else { matrix[[k, n]] / matrix[[k, k]] };
    let fall = |from, to: Option<usize>| pressure(from) - to.map_or(0.0, pressure);
    let power: f64 = edges.iter().map(|&(from, to, c, driven)| c * (fall(from, to) + driven).powi(2)).sum();
    // below the least of a single channel there is rounding alone
    if power < 1e-20 { 0.0 } else { power }
}

#[test]
fn bounds_enclose_dense_solutions_and_close() {
    let lengths = (1.0, 1.7);
    let mut flowing = 0;
    for (case, (values, periodic)) in random_gaps(11).take(500).enumerate() {
        let gap = Gap::new(values.view(), Grid::new(values.dim(), lengths).unwrap()).unwrap();
        let gap = if periodic { gap } else { gap.free() };
        for axis in Axis::BOTH {
            let exact = dense(&values, lengths, periodic, axis) / 12.0;
            for tolerance in [0.5, 1e-3, 1e-11] {
                let flow = Leakage::default().tolerance(tolerance).along(&gap, &gap.percolation(), axis).unwrap();
                let bounds = flow.transmissivity;
                assert!(flow.reached && bounds.width() <= tolerance, "{case}: {bounds:?}");
                // the rounding of the dense solution: its power is right to second order
                let slack = 1e-13 * exact;
                assert!(bounds.lower <= exact + slack && exact - slack <= bounds.upper, "{case}: {exact} {bounds:?}");
                assert_eq!(bounds.upper > 0.0, gap.percolation().along(axis).is_some());
            }
            flowing += usize::from(exact > 0.0);
        }
    }
    assert!(flowing > 200, "{flowing}");
}

/// The bounds of the conductance by means of the cubes: of a flow along straight lines, and of a pressure that is uniform
/// across the axis.
fn means(values: &Array2<f64>, (lx, ly): (f64, f64), axis: Axis) -> [f64; 2] {
    let cubes = values.mapv(|gap| gap.powi(3));
    let (along, across) = (ndarray::Axis(axis as usize), ndarray::Axis(1 - axis as usize));
    let cells = cubes.len_of(along) as f64 / cubes.len_of(across) as f64;
    let shape = if axis == Axis::X { ly / lx } else { lx / ly } * cells;
    let lines = cubes.mapv(f64::recip).sum_axis(along).mapv(f64::recip).sum();
    let layers = cubes.sum_axis(across).mapv(f64::recip).sum().recip();
    [shape * lines, shape * layers]
}

#[test]
fn bounds_of_means_enclose_dense_solutions_and_are_kept() {
    let lengths = (1.0, 1.7);
    let mut open = 0;
    for (case, (values, periodic)) in random_gaps(23).take(500).enumerate() {
        let gap = Gap::new(values.view(), Grid::new(values.dim(), lengths).unwrap()).unwrap();
        let gap = if periodic { gap } else { gap.free() };
        for axis in Axis::BOTH {
            let [lines, layers] = means(&values, lengths, axis).map(|bound| bound / 12.0);
            // the rounding of sums of some ten terms
            let slack = 1.0 + 1e-13;
            let exact = dense(&values, lengths, periodic, axis) / 12.0;
            assert!(lines <= exact * slack && exact <= layers * slack, "{case}: {lines} {exact} {layers}");
            let leakage = Leakage::default().tolerance(0.99).max_iterations(1);
            let bounds = leakage.along(&gap, &gap.percolation(), axis).unwrap().transmissivity;
            assert!(lines <= bounds.lower * slack && bounds.upper <= layers * slack, "{case}: {bounds:?}");
            open += usize::from(lines > 0.0);
        }
    }
    assert!(open > 100, "{open}");
}
