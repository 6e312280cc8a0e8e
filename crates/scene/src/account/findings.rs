//! The findings after a solve: the conductance of the contact, and the flow through its gap.

use asperity::accuracy::GridError;
use asperity::stability::ContactStiffness;
use asperity::{Grid, Real, Result};
use asperity_flow::{Conductance, Gap, Leakage};
use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::account::{Along, Found, Narrowest, Transmissivity, check_finite};
use crate::key::{After, Boundary, Conductors, ERROR, Elastic, LEAKAGE, LeakAsked};

/// The conductance of a contact, as its report has it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Conducted {
    /// The conductance per area.
    pub value: f64,
    /// The conductance of the whole map, or of the part of a mirrored one that results are of.
    pub whole: f64,
    /// The relative error of the stiffness, the estimated one of the grid included; none where that is unknown.
    pub relative_error: Option<f64>,
    /// The resistivities of both bodies, if they are given.
    pub resistivities: Option<(f64, f64)>,
    /// The conductivities of both bodies, if they are given.
    pub conductivities: Option<(f64, f64)>,
    /// The conductors.
    #[serde(skip)]
    pub conductors: Conductors,
}

/// The findings after a solve, beside the contact stiffness.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// The relative error of the contact stiffness, the estimated one of the grid included; none where that is unknown.
    pub stiffness_error: Option<f64>,
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
        cells.insert("stiffness_error".to_owned(), json!(self.stiffness_error));
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

impl<T: Real> Found<T> {
    /// The findings that are asked for after the solve, beside the contact stiffness; none if it was stopped, or has
    /// run away.
    ///
    /// # Errors
    /// Those of [`Conductance::of`], [`Conductance::of_spots`] and [`LeakAsked::find`].
    pub(crate) fn after(&self, after: &After, elastic: &Elastic) -> Result<Findings> {
        if check_finite(&self.solution).is_err() {
            return Ok(Findings::default());
        }
        let stiffness_error = self.stiffness.as_ref().and_then(stiffness_error);
        let conductance = after.conductors.map(|conductors| self.conductance(conductors, elastic));
        let conductance = conductance.transpose()?.flatten();
        if !after.percolation && after.leakage.is_none() {
            return Ok(Findings { stiffness_error, conductance, ..Findings::default() });
        }
        let part = self.part()?;
        let free = elastic.boundary == Boundary::Free || self.sight.original.is_some();
        let widened = part.gap.mapv(T::widen);
        let gap = Gap::new(widened.view(), part.grid)?;
        let Some(tolerance) = after.leakage else {
            let percolation = if free { gap.free() } else { gap }.percolation();
            let constriction = Some(Along::of(|axis| percolation.along(axis).map(Narrowest::of)));
            let percolates = Some(Along::of(|axis| percolation.along(axis).is_some()));
            return Ok(Findings { stiffness_error, conductance, percolates, constriction, transmissivity: None });
        };
        let asked = LeakAsked {
            boundary: if free { Boundary::Free } else { Boundary::Periodic },
            absent_gap: None,
            settings: Leakage::default().tolerance(tolerance),
            viscosity: None,
            // its columns are the bounds
            grid_error: false,
        };
        let (_, leaked) = asked.find(gap)?;
        let (percolates, constriction) = (Some(leaked.percolates), Some(leaked.constriction));
        let transmissivity = Some(leaked.transmissivity);
        Ok(Findings { stiffness_error, conductance, percolates, constriction, transmissivity })
    }

    /// The conductance by the contact stiffness; with adhesion, whose slope between the spots conducts nothing, by
    /// that of the spots alone.
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
            let found = Conductance::of(stiffness, solution.report.modulus, resistivities)?;
            (found, stiffness_error(stiffness))
        };
        let share = self.sight.original.map_or(1.0, |original| original.share());
        let (resistivities, conductivities) = match conductors {
            Conductors::Electrical(pair) => (Some(pair), None),
            Conductors::Thermal(pair) => (None, Some(pair)),
        };
        Ok(Some(Conducted {
            value: found.per_area,
            whole: share * found.whole,
            relative_error,
            resistivities,
            conductivities,
            conductors,
        }))
    }
}

/// The relative error of a contact stiffness, as far as that of the grid is known; none without any contact.
fn stiffness_error(stiffness: &ContactStiffness) -> Option<f64> {
    let ContactStiffness { pressure_per_length, relative_error, edge, .. } = *stiffness;
    if pressure_per_length == 0.0 {
        return Some(relative_error);
    }
    Some(relative_error + GridError::COVER * (edge?.stiffness / pressure_per_length).abs())
}
