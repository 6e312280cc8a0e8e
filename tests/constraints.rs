//! The third seam: constraints that are terms of the energy fit the driver as it is.

mod common;

use approx::assert_relative_eq;
use asperity::*;
use common::sphere;
use ndarray::{Array2, ArrayView2};

/// Resists interpenetration by ½k g² and, with multipliers, removes it step by step.
struct Augmented {
    stiffness: f64,
    multipliers: Option<Array2<f64>>,
    updates: usize,
}

impl Augmented {
    fn pressure(&self, node: usize, gap: f64) -> f64 {
        let multiplier = self.multipliers.as_ref().and_then(|m| m.as_slice()).map_or(0.0, |m| m[node]);
        (multiplier - self.stiffness * gap).max(0.0)
    }
}

impl ContactConstraint<f64> for Augmented {
    fn projects(&self) -> bool {
        false
    }
    fn start(&mut self, grid: &Grid) -> Result<()> {
        if let Some(multipliers) = &mut self.multipliers {
            *multipliers = Array2::zeros(grid.shape());
        }
        Ok(())
    }
    fn energy(&self, node: usize, gap: f64) -> f64 {
        let multiplier = self.pressure(node, 0.0);
        0.5 * (self.pressure(node, gap).powi(2) - multiplier * multiplier) / self.stiffness
    }
    fn traction(&self, node: usize, gap: f64) -> f64 {
        -self.pressure(node, gap)
    }
    fn slope(&self, node: usize, gap: f64) -> f64 {
        if self.pressure(node, gap) > 0.0 { self.stiffness } else { 0.0 }
    }
    fn update(&mut self, gap: ArrayView2<'_, f64>) -> Outer {
        if self.multipliers.is_none() || gap.iter().all(|&g| g > -1e-9) {
            return Outer::Done;
        }
        self.updates += 1;
        let gaps = gap.as_slice().expect("the solver's fields are in standard layout");
        let next: Vec<f64> = gaps.iter().enumerate().map(|(i, &g)| self.pressure(i, g)).collect();
        self.multipliers = Some(Array2::from_shape_vec(gap.dim(), next).expect("one per node"));
        Outer::Again
    }
}

#[test]
fn a_penalty_interpenetrates_by_the_pressure_over_its_stiffness() {
    let exact = common::solve(&mut sphere::<f64, _>(64, NoAdhesion), Control::MeanGap(0.0398), 1e-9);
    let mut last = f64::INFINITY;
    for stiffness in [50.0, 500.0] {
        let constraint = Augmented { stiffness, multipliers: None, updates: 0 };
        let mut solver = Solver { settings: Settings { tolerance: 1e-8, ..Settings::default() }, constraint };
        let solution = solver.solve(&mut sphere(64, NoAdhesion), Control::MeanGap(0.0398)).unwrap();
        assert_eq!(solution.report.status, Status::Converged);
        let deepest = solution.contact_pressure.iter().copied().fold(0.0, f64::max);
        assert_relative_eq!(solution.report.min_gap, -deepest / stiffness, max_relative = 1e-9);
        let error = (solution.report.mean_pressure / exact.report.mean_pressure - 1.0).abs();
        assert!(error < last && error < 20.0 / stiffness, "{error}");
        last = error;
    }
}

#[test]
fn multipliers_remove_the_interpenetration() {
    let exact = common::solve(&mut sphere::<f64, _>(64, NoAdhesion), Control::MeanGap(0.0398), 1e-9);
    let constraint = Augmented { stiffness: 200.0, multipliers: Some(Array2::zeros((0, 0))), updates: 0 };
    let mut solver = Solver { settings: Settings { tolerance: 1e-9, ..Settings::default() }, constraint };
    let solution = solver.solve(&mut sphere(64, NoAdhesion), Control::MeanGap(0.0398)).unwrap();
    assert_eq!(solution.report.status, Status::Converged);
    assert!(solution.report.min_gap > -1e-9 && solver.constraint.updates > 1);
    assert_relative_eq!(solution.report.mean_pressure, exact.report.mean_pressure, max_relative = 1e-5);
}
