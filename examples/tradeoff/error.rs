//! Errors: of the discretisation, of the solver, and both together.

use asperity::{ElasticOperator, Westergaard};
use ndarray::Array2;

use crate::choice::{Choice, Found, measure};
use crate::scene::{Scene, State};
use common::Outcome;

/// Relative differences of two states; over several loads the root mean square.
#[derive(Clone, Copy, Default)]
pub struct Errors {
    /// of the displacement at the nodes, in the energy norm
    pub energy: f64,
    /// of the share of nodes in contact
    pub counted: f64,
    /// of the contact fraction corrected for its edge
    pub area: f64,
    /// of the mean gap or mean pressure
    pub answer: f64,
}

impl Errors {
    pub fn between(found: &State, truth: &State, operator: &mut Westergaard<f64>) -> Outcome<Self> {
        let mut pressure = Array2::zeros(truth.displacement.dim());
        let mut work = |u: &Array2<f64>| -> Outcome<f64> {
            operator.pressure(u.view(), pressure.view_mut())?;
            Ok((u * &pressure).sum())
        };
        let all = work(&truth.displacement)?;
        let wrong = work(&(&found.displacement - &truth.displacement))?.max(0.0);
        let relative = |found: f64, truth: f64| (found / truth - 1.0).abs();
        Ok(Self {
            energy: (wrong / all).sqrt(),
            counted: relative(found.counted, truth.counted),
            area: relative(found.area, truth.area),
            answer: relative(found.answer, truth.answer),
        })
    }

    /// The root mean square.
    pub fn mean(all: &[Self]) -> Self {
        let of = |part: fn(&Self) -> f64| {
            (all.iter().map(|errors| part(errors).powi(2)).sum::<f64>() / all.len() as f64).sqrt()
        };
        Self { energy: of(|e| e.energy), counted: of(|e| e.counted), area: of(|e| e.area), answer: of(|e| e.answer) }
    }
}

/// One of the errors.
pub type Part = fn(&Errors) -> f64;

/// A grid of a scene.
pub struct OnGrid {
    pub n: usize,
    /// Nodes, (N, 1) or (N, N).
    pub nodes: f64,
    /// Of the solution converged on the grid, against the truth.
    pub discretisation: Errors,
    /// Of areas extrapolated from this grid and one of half the nodes along a side: counted as of first order, and
    /// corrected for the edge as of second.
    pub extrapolated: Option<[f64; 2]>,
    pub rows: Vec<Row>,
}

/// A choice on a grid.
pub struct Row {
    pub choice: Choice,
    /// In units of one application on the grid, in `f32` and in `f64`; the mean over the loads, as are the seconds.
    pub applications: [f64; 2],
    pub seconds: f64,
    /// Under all loads.
    pub converged: bool,
    /// Against the solution converged on the grid, and against the truth.
    pub solver: Errors,
    pub whole: Errors,
}

impl Row {
    pub fn applications(&self) -> f64 {
        self.applications[0] + self.applications[1]
    }

    /// The error of the discretisation and that of the solver together, as if they never cancelled: a loose tolerance
    /// that happens to make up for a coarse grid is no choice.
    pub fn bound(&self, grid: &OnGrid, part: Part) -> f64 {
        part(&grid.discretisation) + part(&self.solver)
    }

    /// Applications times nodes, in units of a million nodes in `f64`. In `f32` one moves half of the bytes, and counts
    /// half.
    pub fn work(&self, grid: &OnGrid) -> f64 {
        1e-6 * (0.5 * self.applications[0] + self.applications[1]) * grid.nodes
    }
}

/// Measures a scene on all of its grids.
pub fn on_grids(scene: &Scene, choices: impl Fn(usize) -> Vec<Choice>) -> Outcome<Vec<OnGrid>> {
    let mut grids: Vec<OnGrid> = Vec::new();
    let mut coarser: Vec<(State, usize)> = Vec::new();
    for &n in &scene.sizes {
        let surface = scene.surface(n)?;
        let mut operator = scene.operator(n)?;
        let (mut truths, mut converged) = (Vec::new(), Vec::new());
        for load in 0..scene.loads.len() {
            truths.push(scene.truth(n, load)?);
            converged.push(scene.converged(&surface, load)?);
        }
        let mut against = |found: &[State], truths: &[State]| -> Outcome<Errors> {
            let pairs = found.iter().zip(truths);
            let all = pairs.map(|(found, truth)| Errors::between(found, truth, &mut operator));
            Ok(Errors::mean(&all.collect::<Outcome<Vec<_>>>()?))
        };
        let discretisation = against(&converged, &truths)?;
        let extrapolated = coarser.iter().all(|before| 2 * before.1 == n) && !coarser.is_empty();
        let extrapolated = extrapolated.then(|| {
            let of = |part: fn(&State) -> f64, share: f64| {
                let error = |((fine, coarse), truth): ((&State, &(State, usize)), &State)| {
                    (part(fine) + share * (part(fine) - part(&coarse.0))) / part(truth) - 1.0
                };
                let pairs = converged.iter().zip(&coarser).zip(&truths);
                (pairs.map(|pair| error(pair).powi(2)).sum::<f64>() / truths.len() as f64).sqrt()
            };
            [of(|state| state.counted, 1.0), of(|state| state.area, 1.0 / 3.0)]
        });
        let mut rows = Vec::new();
        for choice in choices(n) {
            let found: Outcome<Vec<Found>> =
                scene.loads.iter().map(|&load| measure(scene, &surface, load, choice)).collect();
            let found = found?;
            let mean = |part: &dyn Fn(&Found) -> f64| found.iter().map(part).sum::<f64>() / found.len() as f64;
            let (applications, seconds) =
                ([0, 1].map(|k| mean(&|found| found.applications[k])), mean(&|found| found.seconds));
            let is_converged = found.iter().all(|found| found.status == asperity::Status::Converged);
            let states: Vec<_> = found.into_iter().map(|found| found.state).collect();
            let (solver, whole) = (against(&states, &converged)?, against(&states, &truths)?);
            rows.push(Row { choice, applications, seconds, converged: is_converged, solver, whole });
        }
        coarser = converged.into_iter().map(|state| (state, n)).collect();
        grids.push(OnGrid { n, nodes: surface.grid().nodes() as f64, discretisation, extrapolated, rows });
    }
    Ok(grids)
}
