//! The findings that are asked for after a solve: the contact stiffness, and the conductance and the flow that follow.

use crate::key::{
    Adhesion, CONDUCTIVITY, Dimension, ELECTRICAL_CONDUCTANCE, Elastic, Entries, Kind, RESISTIVITY, Range,
    THERMAL_CONDUCTANCE, Wall, keys,
};

keys! {
    /// The findings after a solution.
    FindingsKeys {
        "Output" {
            /// Test whether the solution is stable, and write its softest mode to mode.npy
            stability: bool = Kind::switch().excludes(&["nested"]),
            /// Continue from an unstable equilibrium to one that is not, and say how far the energy falls; implies
            /// {stability}
            leave: bool = Kind::switch().excludes(&["nested"]),
            /// Find the contact stiffness, the slope of the mean pressure over the approach
            stiffness: bool = Kind::switch(),
        }
    }
}

keys! {
    /// The contact stiffness of each row of a table.
    StiffnessKeys {
        "Output" {
            /// Find the contact stiffness under each load, in two more columns: contact_stiffness, the slope of the
            /// mean pressure over the approach, and normal_stiffness, the slope of the force
            stiffness: bool = Kind::switch(),
        }
    }
}

keys! {
    /// The conductors: their conductance follows from the contact stiffness.
    ConductorKeys {
        "Output" {
            /// Electrical resistivities of both half-spaces: with {stiffness} these give the electrical conductance of
            /// the contact per area, with its relative error
            resistivities: Vec<f64> = Kind::quantity(RESISTIVITY, Range::NON_NEGATIVE, &["R1", "R2"]).each()
                .excludes(&["conductivities"]),
            /// Thermal conductivities of both half-spaces: the same for heat
            conductivities: Vec<f64> = Kind::quantity(CONDUCTIVITY, Range::POSITIVE, &["K1", "K2"]).each(),
        }
    }
}

keys! {
    /// The percolation of a gap.
    PercolationKeys {
        "Output" {
            /// Find out whether the gap is open along x and along y, and where the widest passage is narrowest
            percolation: bool = Kind::switch(),
        }
    }
}

keys! {
    /// The leakage after a solve, or in each row of a table.
    LeakageKeys {
        "Output" {
            /// Enclose the transmissivity of the gap along x and y under each load between two bounds, like asperity
            /// leak, in the columns transmissivity_x_lower and so on. The value is the distance of the bounds over the
            /// upper one [default: 1e-3 if {leakage} has no value]
            leakage: Option<f64> = Kind::number(Range::SHARE, &["T"]).alone("1e-3"),
        }
    }
}

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

impl Entries {
    /// Whether the stability is asked for, by itself or with what implies it.
    pub fn is_tested(&self) -> bool {
        let FindingsKeys { stability, leave, .. } = self.keys();
        stability || leave
    }

    /// The findings that are asked for after a solve.
    ///
    /// # Errors
    /// Both pairs of conductors, and a leakage that is no share, for [`worded`](crate::worded).
    pub fn after(&self) -> std::result::Result<After, String> {
        let (LeakageKeys { leakage }, PercolationKeys { percolation }) = (self.keys(), self.keys());
        let (StiffnessKeys { stiffness }, ConductorKeys { resistivities, conductivities }) = (self.keys(), self.keys());
        if let Some(given) = leakage.filter(|share| !Range::SHARE.has(*share)) {
            return Err(format!("{{leakage}} is {given}: it must be a share between 0 and 1"));
        }
        let conductors = match (&resistivities[..], &conductivities[..]) {
            ([_, ..], [_, ..]) => {
                return Err("{resistivities} and {conductivities} are both given: give one of them".to_owned());
            }
            (&[first, second], _) => Some(Conductors::Electrical((first, second))),
            (_, &[first, second]) => Some(Conductors::Thermal((first, second))),
            _ => None,
        };
        Ok(After { stiffness, conductors, percolation, leakage })
    }
}

impl Conductors {
    /// Their key, and their numbers.
    fn parts(self) -> (&'static str, (f64, f64)) {
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
        let (key, (first, second)) = self.parts();
        let (range, requirement) = match self {
            Self::Electrical(_) => (Range::NON_NEGATIVE, "zero or positive and finite, and not both zero"),
            Self::Thermal(_) => (Range::POSITIVE, "positive and finite"),
        };
        let allowed = range.has(first) && range.has(second) && first + second > 0.0;
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
        let (key, _) = conductors.parts();
        if !self.stiffness {
            return Err(format!("{{{key}}} needs {{stiffness=}}, which gives the conductance: give both"));
        }
        if let Some(other) = elastic.no_half_space() {
            return Err(format!(
                "{{{key}}}: conductance is known between two half-spaces alone: leave it out, or {{{other}}}"
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

    /// The columns of a table for what is asked for, besides the columns of the stiffness.
    pub fn columns(&self) -> Vec<&'static str> {
        let conductance = self.conductors.into_iter().flat_map(|conductors| [conductors.column(), ERROR]);
        conductance.chain(self.leakage.into_iter().flat_map(|_| LEAKAGE)).collect()
    }

    /// The inputs on which these columns depend, besides the stiffness.
    pub(crate) fn identity(&self) -> Vec<(&'static str, String)> {
        let conductors = self.conductors.map(|conductors| {
            let (key, (first, second)) = conductors.parts();
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
