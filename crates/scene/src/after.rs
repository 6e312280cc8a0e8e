//! The findings that are asked for after a solve: the contact stiffness, and the conductance and the flow that follow.

use asperity::accuracy::GridError;
use asperity::stability::ContactStiffness;
use asperity::{Grid, Real, Result};
use asperity_flow::{Conductance, Gap, Leakage};
use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::adhesion::Adhesion;
use crate::boundary::Boundary;
use crate::elastic::Elastic;
use crate::found::{Found, check_finite};
use crate::leaked::{Along, LeakAsked, Narrowest, Transmissivity};
use crate::quantity::{Dimension, ELECTRICAL_CONDUCTANCE, THERMAL_CONDUCTANCE};
use crate::wall::Wall;

/// The findings that are asked for after a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct After {
    /// Whether to find the contact stiffness.
    pub stiffness: bool,
    /// The conductors, if their conductance is asked for.
    pub conductors: Option<Conductors>,
    /// Whether to find the percolation of the gap.
    pub percolation: bool,
    /// The relative distance of the bounds of the transmissivity, if that is asked for.
    pub leakage: Option<f64>,
}

/// Two bodies that conduct.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Conductors {
    /// Electric current, by their resistivities.
    Electrical((f64, f64)),
    /// Heat, by their conductivities.
    Thermal((f64, f64)),
}

impl Conductors {
    /// The conductors of the pair that is given, if one is.
    ///
    /// # Errors
    /// The reason why both cannot be given, for [`worded`](crate::worded).
    pub fn of(
        resistivities: Option<(f64, f64)>,
        conductivities: Option<(f64, f64)>,
    ) -> std::result::Result<Option<Self>, String> {
        match (resistivities, conductivities) {
            (Some(_), Some(_)) => {
                Err("{resistivities} and {conductivities} are both given: give one of them".to_owned())
            }
            (Some(pair), None) => Ok(Some(Self::Electrical(pair))),
            (None, pair) => Ok(pair.map(Self::Thermal)),
        }
    }

    /// Their key, and their numbers.
    fn given(self) -> (&'static str, (f64, f64)) {
        match self {
            Self::Electrical(pair) => ("resistivities", pair),
            Self::Thermal(pair) => ("conductivities", pair),
        }
    }

    /// The columns of the conductances.
    pub(crate) const COLUMNS: [&str; 2] = ["electrical_conductance", "thermal_conductance"];

    /// The column of their conductance.
    pub fn column(self) -> &'static str {
        Self::COLUMNS[usize::from(matches!(self, Self::Thermal(_)))]
    }

    /// The dimension of their conductance per area.
    pub(crate) fn dimension(self) -> Dimension {
        if let Self::Electrical(_) = self { ELECTRICAL_CONDUCTANCE } else { THERMAL_CONDUCTANCE }
    }

    /// The resistivities, for heat the reciprocal conductivities.
    fn resistivities(self) -> (f64, f64) {
        match self {
            Self::Electrical(pair) => pair,
            Self::Thermal((first, second)) => (first.recip(), second.recip()),
        }
    }

    /// Refuses bodies that do not conduct, or both without resistance.
    fn check(self) -> std::result::Result<(), String> {
        let (key, (first, second)) = self.given();
        let both = [first, second];
        let (allowed, requirement) = match self {
            Self::Electrical(_) => {
                let allowed = both.iter().all(|one| *one >= 0.0 && one.is_finite()) && first + second > 0.0;
                (allowed, "zero or positive and finite, and not both zero")
            }
            Self::Thermal(_) => (both.iter().all(|one| *one > 0.0 && one.is_finite()), "positive and finite"),
        };
        let refused = || format!("{{{key}}} is {first}, {second}: they must be {requirement}");
        if allowed { Ok(()) } else { Err(refused()) }
    }
}

impl After {
    /// Refuses a conductance where the contact stiffness does not have it.
    ///
    /// # Errors
    /// The reason and the remedy, for [`worded`](crate::worded).
    pub fn check(&self, elastic: &Elastic, adhesion: &Adhesion) -> std::result::Result<(), String> {
        let Some(conductors) = self.conductors else { return Ok(()) };
        conductors.check()?;
        let (key, _) = conductors.given();
        if !self.stiffness {
            return Err(format!("{{{key}}} needs {{stiffness=}}, of which the conductance is found: give both"));
        }
        if let Some(other) = elastic.no_half_space() {
            return Err(format!(
                "{{{key}}}: a contact conducts as it resists between half-spaces alone: leave it out, or {{{other}}}"
            ));
        }
        if adhesion.wall != Wall::Hard {
            return Err(format!(
                "{{{key}}}: current passes where the surfaces touch, and only a hard wall says where: leave it out, or \
                 {{wall}}"
            ));
        }
        Ok(())
    }

    /// The name of a finding that takes whole fields, for several processes to refuse it.
    pub fn takes_whole_fields(&self, adhesive: bool) -> Option<&'static str> {
        let all = [
            (self.percolation, "--percolation"),
            (self.leakage.is_some(), "a transmissivity"),
            (self.conductors.is_some() && adhesive, "a conductance with adhesion"),
        ];
        all.into_iter().find_map(|(asked, name)| asked.then_some(name))
    }

    /// The columns of a table for what is asked for, beside those of the stiffness.
    pub fn columns(&self) -> Vec<&'static str> {
        let conductance = self.conductors.into_iter().flat_map(|conductors| [conductors.column(), ERROR]);
        conductance.chain(self.leakage.into_iter().flat_map(|_| LEAKAGE)).collect()
    }

    /// The inputs on which these columns depend, beside the stiffness.
    pub(crate) fn identity(&self) -> Vec<(&'static str, String)> {
        let conductors = self.conductors.map(|conductors| {
            let (key, (first, second)) = conductors.given();
            (key, format!("{first} {second}"))
        });
        let leakage = self.leakage.map(|tolerance| ("leakage", format!("to {tolerance}")));
        conductors.into_iter().chain(leakage).collect()
    }
}

const ERROR: &str = "conductance_error";
pub(crate) const LEAKAGE: [&str; 4] =
    ["transmissivity_x_lower", "transmissivity_x_upper", "transmissivity_y_lower", "transmissivity_y_upper"];

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
