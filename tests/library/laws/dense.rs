//! Soft walls next to a dense minimiser.

use super::*;

/// The gap that solves p + φ' + p̄ = 0 by Newton's method with the dense stiffness, halved where the residual grows.
fn dense_minimiser(dense: &Dense, heights: &[f64], law: &dyn AdhesionLaw<f64>, load: f64, start: f64) -> Vec<f64> {
    let n = dense.nodes;
    let residual = |gap: &[f64]| -> Vec<f64> {
        let u: Vec<f64> = gap.iter().zip(heights).map(|(g, h)| g + h).collect();
        dense.pressure(&u).iter().zip(gap).map(|(p, &g)| p + law.traction(g) + load).collect()
    };
    let energy = |gap: &[f64]| -> f64 {
        let u: Vec<f64> = gap.iter().zip(heights).map(|(g, h)| g + h).collect();
        let elastic: f64 = dense.pressure(&u).iter().zip(&u).map(|(p, u)| 0.5 * p * u).sum();
        elastic + gap.iter().map(|&g| law.energy(g) + load * g).sum::<f64>()
    };
    let mut gap = vec![start; n];
    for _ in 0..200 {
        let r = residual(&gap);
        if r.iter().all(|r| r.abs() < 1e-13) {
            break;
        }
        // the convex part of the law alone, so that the step descends
        let mut matrix: Vec<Vec<f64>> = (0..n)
            .map(|i| {
                let mut row = dense.stiffness[i * n..(i + 1) * n].to_vec();
                row[i] += law.slope(gap[i]).max(1e-3);
                row.push(-r[i]);
                row
            })
            .collect();
        let exact: Vec<Vec<f64>> = (0..n)
            .map(|i| {
                let mut row = dense.stiffness[i * n..(i + 1) * n].to_vec();
                row[i] += law.slope(gap[i]);
                row.push(-r[i]);
                row
            })
            .collect();
        if r.iter().all(|r| r.abs() < 1e-4) {
            matrix = exact;
        }
        let step = eliminate(matrix);
        let before = energy(&gap);
        let mut length = 1.0;
        loop {
            let next: Vec<f64> = gap.iter().zip(&step).map(|(g, s)| g + length * s).collect();
            if energy(&next) <= before + 1e-14 || length < 1e-6 {
                gap = next;
                break;
            }
            length *= 0.5;
        }
    }
    gap
}

fn eliminate(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&a, &b| rows[a][i].abs().total_cmp(&rows[b][i].abs())).unwrap();
        rows.swap(i, pivot);
        let (above, below) = rows.split_at_mut(i + 1);
        for row in below {
            let factor = row[i] / above[i][i];
            (i..=n).for_each(|k| row[k] -= factor * above[i][k]);
        }
    }
    let mut x = vec![0.0; n];
    for i in (0..n).rev() {
        x[i] = (rows[i][n] - (i + 1..n).map(|k| rows[i][k] * x[k]).sum::<f64>()) / rows[i][i];
    }
    x
}

#[test]
fn soft_walls_agree_with_a_dense_minimiser() {
    let shape = (12, 10);
    let grid = Grid::new(shape, (1.0, 0.8)).unwrap();
    let surface = Surface::from_fn(grid, |x, y| 0.03 * (6.3 * x).cos() + 0.02 * (7.9 * y + 3.0 * x).sin()).unwrap();
    let dense = Dense::new(shape, (1.0, 0.8), 1.0);
    let heights: Vec<f64> = surface.heights().iter().copied().collect();
    let laws: [(Box<dyn AdhesionLaw<f64>>, f64); 2] =
        [(Box::new(Morse::new(2e-3, 0.02).unwrap()), 0.0), (Box::new(LennardJones::new(2e-3, 0.03).unwrap()), 0.03)];
    for (law, rest) in laws {
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
        for load in [0.2, 0.02, 0.0] {
            let expected = dense_minimiser(&dense, &heights, problem.law(), load, rest);
            let solution = without_wall(1e-9).solve(&mut problem, Control::MeanPressure(load)).unwrap();
            let report = &solution.report;
            assert_eq!(report.status, Status::Converged);
            let off = solution.gap.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-7, "load {load}: gaps are off by {off:e}");
            // contact is where the law repels, and carries the load with the attraction
            let repelled = solution.gap.iter().filter(|&&g| g < rest).count();
            assert_eq!(report.contact_nodes, repelled);
            assert_eq!(solution.contact_map().iter().filter(|&&c| c).count(), repelled);
            assert!((report.net_pressure - load).abs() < 1e-8);
            assert!(rest == 0.0 || report.min_gap > 0.0);
            // at the same mean gap it is the same state
            let mut by_gap = without_wall(1e-9);
            let held = by_gap.solve(&mut problem, Control::MeanGap(report.mean_gap)).unwrap();
            assert_eq!(held.report.status, Status::Converged);
            assert!((held.report.mean_pressure - load).abs() < 1e-6, "{}", held.report.mean_pressure);
        }
    }
}

#[test]
fn a_hard_wall_is_the_limit_of_ever_stiffer_soft_walls() {
    let (grid, half_space) = unit(64);
    let surface = rough(grid, 8, 1);
    let error = |range: f64| {
        // the same traction, over less and less range
        let law = Morse::new(0.02 * range, range).unwrap();
        let mut problem = Problem::new(&surface, half_space.clone(), law).unwrap();
        let control = Control::MeanPressure(0.1);
        let soft = without_wall(1e-8).solve(&mut problem, control).unwrap();
        let settings = Settings::default().tolerance(1e-8);
        let hard = Solver::new(settings).solve(&mut problem, control).unwrap();
        assert_eq!((soft.report.status, hard.report.status), (Status::Converged, Status::Converged));
        let mean = |a: &Array2<f64>| a.iter().map(|x| x * x).sum::<f64>();
        (mean(&(&soft.contact_pressure - &hard.contact_pressure)) / mean(&hard.contact_pressure)).sqrt()
    };
    let errors = [4e-3, 1e-3, 2.5e-4].map(error);
    let orders = [0, 1].map(|i| (errors[i] / errors[i + 1]).log(4.0));
    // the depth at which a pressure is carried goes with the range: first order, but for its logarithm
    assert!(orders.iter().all(|order| (0.6..1.4).contains(order)), "{errors:?}, orders {orders:?}");
}
