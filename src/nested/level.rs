//! A level of nested grids: its cost, and the quantities found there.

#[cfg(doc)]
use super::{Nested, NestedSolution};
use crate::contact::ContactArea;
use crate::error::Result;
use crate::real::Real;
use crate::solver::{Solution, Status};
use crate::stability::ContactStiffness;

/// The cost of the solve on one of the nested grids ([`NestedSolution`]), and what it found there.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// The nodes (Nx, Ny) of the grid.
    pub shape: (usize, usize),
    /// The status of its solve.
    pub status: Status,
    /// The number of steps on the whole grid, from its last start.
    pub iterations: usize,
    /// The number of operator applications, with the application of the problem; on a part in units of one on the
    /// whole.
    pub operator_applications: usize,
    /// The certified relative error, [`Report::relative_error`](crate::Report::relative_error).
    pub relative_error: f64,
    /// The mean gap, [`Report::mean_gap`](crate::Report::mean_gap).
    pub mean_gap: f64,
    /// The approach, with a free boundary, [`Report::approach`](crate::Report::approach).
    pub approach: Option<f64>,
    /// The mean external pressure, [`Report::mean_pressure`](crate::Report::mean_pressure).
    pub mean_pressure: f64,
    /// The mean contact pressure, [`Report::mean_contact_pressure`](crate::Report::mean_contact_pressure).
    pub mean_contact_pressure: f64,
    /// The elastic energy per area, [`Report::elastic_energy`](crate::Report::elastic_energy).
    pub elastic_energy: f64,
    /// The range of the law, if that is the range of the grid, [`Report::range`](crate::Report::range).
    pub range: Option<f64>,
    /// The adhesive energy per area, [`Report::adhesive_energy`](crate::Report::adhesive_energy).
    pub adhesive_energy: f64,
    /// The contact by that energy, [`Report::adhesive_contact_fraction`](crate::Report::adhesive_contact_fraction).
    pub adhesive_contact_fraction: Option<f64>,
    /// The contact area, as nodes count it and corrected.
    pub area: ContactArea,
    /// The contact stiffness, by [`Nested::stiffness`].
    pub stiffness: Option<ContactStiffness>,
}

impl Level {
    pub(crate) fn of<T: Real>(solution: &Solution<T>) -> Result<Self> {
        let report = &solution.report;
        Ok(Self {
            shape: solution.grid.shape(),
            status: report.status,
            iterations: report.iterations,
            operator_applications: report.operator_applications + 1,
            relative_error: report.relative_error,
            mean_gap: report.mean_gap,
            approach: report.approach,
            mean_pressure: report.mean_pressure,
            mean_contact_pressure: report.mean_contact_pressure,
            elastic_energy: report.elastic_energy,
            range: report.range,
            adhesive_energy: report.adhesive_energy,
            adhesive_contact_fraction: report.adhesive_contact_fraction,
            area: ContactArea::of_solution(solution)?,
            stiffness: None,
        })
    }
}

/// The operator applications on all levels, in units of one on the last.
pub(crate) fn equivalent_applications(levels: &[Level]) -> f64 {
    let nodes = |level: &Level| (level.shape.0 * level.shape.1) as f64;
    let finest = levels.last().map_or(1.0, nodes);
    levels.iter().map(|level| level.operator_applications as f64 * nodes(level) / finest).sum()
}
