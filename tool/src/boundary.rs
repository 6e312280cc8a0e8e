//! The boundary of the half-space, and the loads that it has: their options.

use asperity::Control;
use asperity_scene::{Boundary, Load};
use clap::Args;

use crate::allowed::{finite, share};
use crate::loads::{Loads, list};
use crate::outcome::Outcome;
use crate::printing::in_options;
use crate::quantity::{FORCE, FORCE_PER_LENGTH, LENGTH, PRESSURE, Quantity};

/// The boundary of the half-space, and the nodes at which nothing faces it.
#[derive(Args, Clone, Copy)]
pub struct BoundaryOptions {
    /// What is beyond the map
    #[arg(long, value_enum, value_name = "BOUNDARY", default_value_t = Boundary::Periodic, help_heading = "Surface")]
    pub boundary: Boundary,
    /// Take missing points of the file for absent nodes, at which nothing faces the half-space, as around a punch or in
    /// a hole; in the files of results their gap is NaN and their pressures 0
    #[arg(long, help_heading = "Surface")]
    pub absent_missing: bool,
}

/// Refuses a load that a boundary does not have.
pub fn check_load(boundary: Boundary, control: Control) -> Outcome<()> {
    in_options(Load::Held(control).check(boundary, false))
}

/// The load of a solve: one of several kinds.
#[derive(Args)]
#[group(skip)]
pub struct LoadOptions {
    /// Mean gap that is held, a length; with a periodic boundary
    #[arg(long, value_name = "G", allow_hyphen_values = true, value_parser = LENGTH.non_negative())]
    #[arg(help_heading = "Load")]
    mean_gap: Option<Quantity>,
    /// Mean external pressure that is held, over the area of the map, compression positive
    #[arg(long, value_name = "P", allow_hyphen_values = true, value_parser = PRESSURE.finite())]
    #[arg(help_heading = "Load")]
    mean_pressure: Option<Quantity>,
    /// Normal force that is held, compression positive: the mean pressure times the area of the map
    #[arg(long, value_name = "F", allow_hyphen_values = true, value_parser = FORCE.finite())]
    #[arg(help_heading = "Load")]
    normal_force: Option<Quantity>,
    /// Approach that is held, with a free boundary: how far the bodies have moved towards each other since they would
    /// first touch undeformed; negative before
    #[arg(long, value_name = "D", allow_hyphen_values = true, value_parser = LENGTH.finite())]
    #[arg(help_heading = "Load")]
    approach: Option<Quantity>,
    /// Stiffness of a spring in series, as of a machine or a cantilever, force per length; needs --spring-position
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = FORCE_PER_LENGTH.positive())]
    #[arg(help_heading = "Load", requires = "spring_position")]
    spring_stiffness: Option<Quantity>,
    /// Position of the spring's far end: with a free boundary the approach D at which the spring is relaxed, F = K (Z -
    /// D); with a periodic one the mean gap G at which it is, F = K (G - Z)
    #[arg(long, value_name = "Z", allow_hyphen_values = true, value_parser = LENGTH.finite())]
    #[arg(help_heading = "Load", requires = "spring_stiffness")]
    spring_position: Option<Quantity>,
    /// Mean pressure that is held, over the contact modulus and the rms slope of the surface: p/(E* h'rms)
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = finite, help_heading = "Load")]
    reduced_pressure: Option<f64>,
    /// Share of the nodes that is to be in contact, to one node or 1 %: the mean pressure for it is searched for by
    /// some solves, with adhesion the mean gap, with a free boundary and adhesion the approach. If the contact jumps
    /// past it, the nearer side of the jump is written, and the exit code is 2
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = share, help_heading = "Load")]
    #[arg(conflicts_with_all = ["accuracy", "nested"])]
    pub contact_fraction: Option<f64>,
}

/// The options of which one is a load of a solve, for the group that needs one.
pub const LOAD: [&str; 7] = [
    "mean_gap",
    "mean_pressure",
    "normal_force",
    "approach",
    "spring_stiffness",
    "reduced_pressure",
    "contact_fraction",
];

impl LoadOptions {
    /// The load that is given.
    pub fn load(&self) -> Load {
        let number = |given: Option<Quantity>| given.map(|given| given.value);
        let spring = self.spring_stiffness.zip(self.spring_position);
        let given = [
            ("mean_gap", number(self.mean_gap)),
            ("mean_pressure", number(self.mean_pressure)),
            ("normal_force", number(self.normal_force)),
            ("approach", number(self.approach)),
            ("reduced_pressure", self.reduced_pressure),
            ("contact_fraction", self.contact_fraction),
        ];
        let one = given.iter().find_map(|&(key, number)| Load::of(key, &[number?]));
        let spring = || Load::of("spring", &spring.map_or([0.0; 2], |(stiffness, at)| [stiffness.value, at.value]));
        // one is given
        one.or_else(spring).unwrap_or(Load::Fraction(0.0))
    }
}

/// The loads of a table: a list of one of several kinds.
#[derive(Args)]
#[group(skip)]
pub struct LoadsOptions {
    /// Mean gaps, lengths, with a periodic boundary: numbers and ranges FROM:TO:COUNT or FROM:TO:COUNT:log, with commas
    /// between
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = list(LENGTH.non_negative()))]
    #[arg(help_heading = "Loads")]
    mean_gaps: Option<Loads>,
    /// Mean external pressures over the area of the map, compression positive: a list as for the gaps
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = list(PRESSURE.finite()))]
    #[arg(help_heading = "Loads")]
    mean_pressures: Option<Loads>,
    /// Normal forces, compression positive: a list as for the gaps
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = list(FORCE.finite()))]
    #[arg(help_heading = "Loads")]
    normal_forces: Option<Loads>,
    /// Approaches, with a free boundary: how far the bodies have moved towards each other since they would first touch
    /// undeformed, negative before; a list as for the gaps. A list that grows from a negative one begins with the
    /// bodies apart
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = list(LENGTH.finite()))]
    #[arg(help_heading = "Loads")]
    approaches: Option<Loads>,
    /// Stiffness of a spring in series, as of a machine or a cantilever, force per length; needs --spring-positions
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = FORCE_PER_LENGTH.positive())]
    #[arg(help_heading = "Loads", requires = "spring_positions")]
    spring_stiffness: Option<Quantity>,
    /// Positions Z of the spring's far end: with a free boundary the approach D at which the spring is relaxed, F = K
    /// (Z - D); with a periodic one the mean gap G at which it is, F = K (G - Z); a list as for the gaps. With a free
    /// boundary a list that grows from a negative one begins with the bodies apart
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = list(LENGTH.finite()))]
    #[arg(help_heading = "Loads", requires = "spring_stiffness")]
    spring_positions: Option<Loads>,
    /// Mean pressures over the contact modulus and the rms slope of the surface, p/(E* h'rms): a list as for the gaps
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = list(ratio), help_heading = "Loads")]
    reduced_pressures: Option<Loads>,
}

/// The contact fractions of a table.
#[derive(Args)]
#[group(skip)]
pub struct FractionsOptions {
    /// Shares of the nodes that are to be in contact: a list as for the gaps. The load of each is searched for as by
    /// asperity solve --contact-fraction, and the columns wanted_contact_fraction and reached are added
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = list(fraction), help_heading = "Loads")]
    contact_fractions: Option<Loads>,
}

impl FractionsOptions {
    /// The contact fractions, if they are given.
    pub fn values(&self) -> Option<&[f64]> {
        self.contact_fractions.as_ref().map(|list| &list.values[..])
    }
}

fn ratio(text: &str) -> std::result::Result<Quantity, String> {
    finite(text).map(Quantity::number)
}

fn fraction(text: &str) -> std::result::Result<Quantity, String> {
    share(text).map(Quantity::number)
}

/// The options of which one is a list of loads, for the group that needs one.
pub const LOADS: [&str; 6] =
    ["mean_gaps", "mean_pressures", "normal_forces", "approaches", "spring_stiffness", "reduced_pressures"];

impl LoadsOptions {
    /// The values of the list.
    pub fn list(&self) -> &[f64] {
        let lists = [&self.mean_gaps, &self.mean_pressures, &self.normal_forces, &self.approaches];
        let list = lists.into_iter().chain([&self.spring_positions, &self.reduced_pressures]).flatten().next();
        list.map_or(&[], |list| &list.values)
    }

    /// The values of the loads on a surface that a reduced pressure of 1 makes this `full` pressure.
    pub fn values(&self, full: f64) -> Vec<f64> {
        let factor = if self.reduced_pressures.is_some() { full } else { 1.0 };
        self.list().iter().map(|value| factor * value).collect()
    }

    /// Whether the loads are reduced pressures.
    pub fn are_reduced(&self) -> bool {
        self.reduced_pressures.is_some()
    }

    /// The loads of values.
    pub fn controls(&self, values: &[f64]) -> Vec<Control> {
        values.iter().map(|&value| self.control(value)).collect()
    }

    /// The load of a value.
    pub fn control(&self, value: f64) -> Control {
        match self {
            Self { reduced_pressures: Some(_), .. } => Control::MeanPressure(value),
            Self { mean_gaps: Some(_), .. } => Control::MeanGap(value),
            Self { mean_pressures: Some(_), .. } => Control::MeanPressure(value),
            Self { normal_forces: Some(_), .. } => Control::Force(value),
            Self { approaches: Some(_), .. } => Control::Approach(value),
            _ => Control::Spring { stiffness: self.spring_stiffness().unwrap_or_default(), rest: value },
        }
    }

    /// The stiffness of the spring, if there is one.
    pub fn spring_stiffness(&self) -> Option<f64> {
        self.spring_stiffness.map(|stiffness| stiffness.value)
    }
}
