//! The error of the grid.

use super::*;

#[test]
fn the_error_of_the_grid_is_enclosed_where_the_gap_is_resolved() {
    let epsilon = 0.6_f64;
    let (along, across) =
        (1.0 + 1.5 * epsilon.powi(2), 2.0 * (1.0 - epsilon.powi(2)).powf(2.5) / (2.0 + epsilon.powi(2)));
    let estimate = |gap: &Gap<'_>| {
        let settings = Leakage::default();
        let leak = settings.through(gap).unwrap();
        settings.grid_error(gap, &leak).unwrap()
    };
    for n in [32, 64, 128] {
        let grid = Grid::square(n, 1.0).unwrap();
        let values = grid.sample(|x, y| 1.0 + epsilon * (TAU * (x + y)).cos());
        let gap = Gap::new(values.view(), grid).unwrap();
        let error = (conductances(&gap)[0] / (0.5 * (along + across)) - 1.0).abs();
        for told in estimate(&gap) {
            // of second order: three times the error
            assert!((told.unwrap() / error - 3.0).abs() < 0.6, "{n}: {told:?} {error}");
        }
    }
    // a slot of whole nodes has none, a closed gap and one of an odd number of nodes are not told
    let slot = Array2::from_shape_fn((16, 8), |(_, j)| if j < 4 { 2.0 } else { 0.0 });
    let [x, y] = estimate(&Gap::new(slot.view(), Grid::new((16, 8), (2.0, 1.0)).unwrap()).unwrap());
    assert!(x.unwrap() < 2e-4 && y.is_none());
    let odd = Array2::from_elem((7, 8), 1.0);
    assert_eq!(estimate(&Gap::new(odd.view(), Grid::new((7, 8), (1.0, 1.0)).unwrap()).unwrap()), [None; 2]);
}

/// The gap of a rough surface, of waves from 4 to `k_s` a side, under a mean pressure.
fn pressed(n: usize, k_s: f64, pressure: f64, seed: u64) -> (Array2<f64>, Grid) {
    let grid = Grid::square(n, 1.0).unwrap();
    let rough = SelfAffine::default().k_l(4.0).k_s(k_s).amplitude(Amplitude::RmsSlope(0.1)).seed(seed);
    let heights = rough.surface(grid).unwrap();
    let mut problem = Problem::new(&heights, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    (Solver::default().solve(&mut problem, Control::MeanPressure(pressure)).unwrap().gap, grid)
}

/// Prints the deviation of each transmissivity from that on the finest grid, and its estimate.
#[test]
#[ignore = "minutes: cargo test --release -p asperity-flow --test flow -- --ignored --nocapture error_of_the_grid"]
fn the_error_of_the_grid_tells_when_a_rough_gap_is_not_resolved() {
    let (mut all, mut below) = (0, 0);
    for (seed, pressure) in [1, 2].into_iter().flat_map(|seed| [0.005, 0.015, 0.019, 0.0205, 0.022].map(|p| (seed, p)))
    {
        let found = [256, 512, 1024, 2048].map(|n| {
            let (values, grid) = pressed(n, 32.0, pressure, seed);
            let gap = Gap::new(values.view(), grid).unwrap();
            let leak = Leakage::default().through(&gap).unwrap();
            let errors = Leakage::default().grid_error(&gap, &leak).unwrap();
            Axis::BOTH.map(|axis| (leak.along(axis).transmissivity.upper, errors[axis as usize]))
        });
        let [coarser @ .., finest] = &found;
        for (k, coarse) in coarser.iter().enumerate() {
            for (axis, ((own, told), (fine, _))) in Axis::BOTH.into_iter().zip(coarse.iter().zip(finest)) {
                if let Some(told) = told.filter(|_| *fine > 0.0) {
                    let deviation = (own / fine - 1.0).abs();
                    println!("seed {seed}, {pressure}, {}², {axis:?}: {deviation:.4}, told {told:.4}", 256 << k);
                    (all, below) = (all + 1, below + usize::from(deviation <= told));
                    assert!(deviation < 1.25 * told, "{deviation} {told}");
                }
            }
        }
    }
    println!("{below} of {all} are at most what is told");
    assert!(all > 40 && 10 * below > 9 * all);
}

#[test]
#[ignore = "a minute: cargo test --release -p asperity-flow --test flow -- --ignored --nocapture near_percolation"]
fn a_gap_of_2048_squared_nodes_near_percolation_is_enclosed() {
    let (values, grid) = pressed(2048, 128.0, 0.0205, 1);
    let gap = Gap::new(values.view(), grid).unwrap();
    let start = std::time::Instant::now();
    let leak = Leakage::default().through(&gap).unwrap();
    println!("{:?}, at most {:.0} MiB", start.elapsed(), Leakage::memory(&gap) / 1048576.0);
    for axis in Axis::BOTH {
        let (flow, constriction) = (leak.along(axis), leak.percolation.along(axis).unwrap());
        println!("{axis:?} {:?} {} iterations", flow.transmissivity, flow.iterations);
        assert!(flow.reached && flow.transmissivity.lower > 0.0);
        // far below the transmissivity of the widest gap everywhere
        let widest = values.iter().copied().fold(0.0, f64::max);
        assert!(flow.transmissivity.upper < widest.powi(3) / 12.0 && constriction.gap < 0.1 * widest);
    }
}

#[test]
fn the_error_of_the_grid_covers_or_is_none_where_cells_meet_at_corners() {
    // squares of two gaps, like a chequerboard: √(k₁k₂) by Keller, k = g³/12
    for wide in [1.5, 2.0, 3.0, 5.0, 10.0, 100.0_f64] {
        for (nodes, cells) in [(32, 4), (64, 4), (128, 4), (64, 2), (64, 8)] {
            let grid = Grid::square(nodes, 1.0).unwrap();
            let field = Array2::from_shape_fn((nodes, nodes), |(i, j)| {
                if (i * cells / nodes + j * cells / nodes) % 2 == 0 { 1.0 } else { wide }
            });
            let gap = Gap::new(field.view(), grid).unwrap();
            let leak = Leakage::default().through(&gap).unwrap();
            let found = leak.along(Axis::X).transmissivity.upper;
            let error = wide.powf(1.5) / 12.0 / found - 1.0;
            let told = Leakage::default().grid_error(&gap, &leak).unwrap()[0];
            // none where the transmissivity converges by less than a third from grid to grid
            assert!(told.is_none_or(|told| error.abs() < told) && told.is_some() == (wide < 3.0), "{error} {told:?}");
        }
    }
}
