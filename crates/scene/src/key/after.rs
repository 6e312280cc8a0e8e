//! The findings that are asked for after a solve: the contact stiffness, and the conductance and the flow that follow.

use crate::key::adhesion::Adhesion;
use crate::key::elastic::Elastic;
use crate::key::quantity::{Dimension, ELECTRICAL_CONDUCTANCE, THERMAL_CONDUCTANCE};
use crate::key::wall::Wall;

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
    pub(crate) fn resistivities(self) -> (f64, f64) {
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

/// The column of the error of a conductance.
pub(crate) const ERROR: &str = "conductance_error";

/// The columns of a leakage.
pub(crate) const LEAKAGE: [&str; 4] =
    ["transmissivity_x_lower", "transmissivity_x_upper", "transmissivity_y_lower", "transmissivity_y_upper"];
