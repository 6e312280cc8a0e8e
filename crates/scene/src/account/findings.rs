//! The findings after a solve: the conductance of the contact, and the flow through its gap.

use asperity::{Grid, Real, Result};
use asperity_flow::{Conductance, Gap, Leakage};
use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::account::{Along, Answer, Narrowest, Transmissivity, check_finite};
use crate::key::{After, Boundary, Conductors, ERROR, Elastic, LEAKAGE, LeakAsked, record};

record! {
    /// The conductance of a contact, as its report has it.
    #[derive(Clone, Copy, Debug, Serialize)]
    Conducted of (found: Conductance, share: f64, relative_error: Option<f64>, conductors: Conductors) {
        /// Conductance per area.
        value: f64 = found.per_area,
        /// Conductance of the whole map, or of the original of a mirrored one.
        whole: f64 = share * found.whole,
        /// Relative error, with the estimated error of the grid.
        relative_error: Option<f64> as Error = relative_error,
        /// Resistivities of both bodies.
        resistivities: Option<(f64, f64)> = if let Conductors::Electrical(pair) = conductors { Some(pair) } else { None },
        /// Conductivities of both bodies.
        conductivities: Option<(f64, f64)> = if let Conductors::Thermal(pair) = conductors { Some(pair) } else { None },
        /// The conductors.
        #[serde(skip)]
        conductors: Conductors = conductors,
    }
}

/// The findings after a solve, besides the contact stiffness.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// The conductance.
    pub conductance: Option<Conducted>,
    /// Whether open nodes connect the sides.
    pub percolates: Option<Along<bool>>,
    /// The widest passages.
    pub constriction: Option<Along<Option<Narrowest>>>,
    /// The transmissivity.
    pub transmissivity: Option<Along<Transmissivity>>,
}

impl Findings {
    /// The cells of the columns of a table.
    pub(crate) fn cells(&self) -> Map<String, Value> {
        let mut cells = Map::new();
        if let Some(found) = &self.conductance {
            cells.insert(found.conductors.column().to_owned(), json!(found.value));
            cells.insert(ERROR.to_owned(), json!(found.relative_error));
        }
        if let Some(found) = &self.transmissivity {
            let bounds = [found.x.lower, found.x.upper, found.y.lower, found.y.upper];
            cells.extend(LEAKAGE.into_iter().zip(bounds).map(|(name, bound)| (name.to_owned(), json!(bound))));
        }
        cells
    }
}

impl<T: Real> Answer<T> {
    /// The findings that are asked for after the solve, besides the contact stiffness; none if it was stopped, or has
    /// run away.
    ///
    /// # Errors
    /// As [`Conductance::from_stiffness`], [`Conductance::of_spots`] and [`LeakAsked::find`].
    pub(crate) fn after(&self, after: &After, elastic: &Elastic) -> Result<Findings> {
        if check_finite(&self.solution).is_err() {
            return Ok(Findings::default());
        }
        let conductance = after.conductors.map(|conductors| self.conductance(conductors, elastic));
        let mut findings = Findings { conductance: conductance.transpose()?.flatten(), ..Findings::default() };
        if !after.percolation && after.leakage.is_none() {
            return Ok(findings);
        }
        let part = self.part()?;
        let free = elastic.boundary == Boundary::Free || self.sight.original.is_some();
        let widened = part.gap.mapv(T::widen);
        let gap = Gap::of_solution(widened.view(), part.grid)?;
        if let Some(tolerance) = after.leakage {
            let asked = LeakAsked {
                boundary: if free { Boundary::Free } else { Boundary::Periodic },
                absent_gap: None,
                settings: Leakage::default().tolerance(tolerance),
                viscosity: None,
                // its columns are the bounds
                grid_error: false,
            };
            let (_, leaked) = asked.find(gap)?;
            (findings.percolates, findings.constriction) = (Some(leaked.percolates), Some(leaked.constriction));
            findings.transmissivity = Some(leaked.transmissivity);
        } else {
            let percolation = if free { gap.free() } else { gap }.percolation();
            findings.percolates = Some(Along::from_axes(|axis| percolation.along(axis).is_some()));
            findings.constriction = Some(Along::from_axes(|axis| percolation.along(axis).map(Narrowest::record)));
        }
        Ok(findings)
    }

    /// The conductance by the contact stiffness; with adhesion, which conducts nothing between the spots, by the
    /// stiffness of the spots alone.
    fn conductance(&self, conductors: Conductors, elastic: &Elastic) -> Result<Option<Conducted>> {
        let (solution, resistivities) = (&self.solution, conductors.resistivities());
        let Some(stiffness) = &self.stiffness else { return Ok(None) };
        let (found, relative_error) = if !self.sight.law.hints().zero {
            let contact = solution.gap.mapv(|gap| gap <= T::zero());
            let grid = Grid::new(contact.dim(), solution.grid.lengths())?;
            let periodic = elastic.boundary == Boundary::Periodic;
            let found = Conductance::of_spots(contact.view(), grid, periodic, resistivities)?;
            (found, (found.per_area == 0.0).then_some(0.0))
        } else {
            let found = Conductance::from_stiffness(stiffness, solution.report.modulus, resistivities)?;
            (found, stiffness.error())
        };
        let share = self.sight.original.map_or(1.0, |original| original.share());
        Ok(Some(Conducted::record(found, share, relative_error, conductors)))
    }
}
