//! The boundary of the half-space, and the loads that it has: options, and what they make.

use std::fmt;

use asperity::{Boussinesq, Control, ElasticOperator, Grid, Real, Result, Surface, Westergaard};
use clap::{Args, ValueEnum};
use ndarray::Array2;

use crate::loads::{Loads, list};
use crate::outcome::Outcome;
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

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum Boundary {
    /// the same again: a piece of a surface that goes on
    Periodic,
    /// nothing: a tip, an indenter, a chip; the half-space is free of load there
    Free,
}

impl Boundary {
    /// The half-space under the nodes of `grid`.
    pub fn half_space<T: Real>(self, grid: Grid, modulus: f64) -> Result<Box<dyn ElasticOperator<T>>> {
        Ok(match self {
            Self::Periodic => Box::new(Westergaard::new(grid, modulus)?),
            Self::Free => Box::new(Boussinesq::new(grid, modulus)?),
        })
    }

    /// The gap of a body that comes from afar: undeformed, at the approach at which `loads` begin, if they grow from one
    /// before touch. With adhesion the default start of a solve would find the body sticking.
    pub fn start_afar(self, surface: &Surface, loads: &[Control]) -> Option<Array2<f64>> {
        let (from, to) = match *loads {
            [Control::Approach(from), Control::Approach(to), ..] => (from, to),
            [Control::Spring { rest: from, .. }, Control::Spring { rest: to, .. }, ..] => (from, to),
            _ => return None,
        };
        let comes = self == Self::Free && from < 0.0 && to > from;
        let peak = surface.heights().fold(f64::NEG_INFINITY, |peak, &height| peak.max(height));
        comes.then(|| surface.heights().mapv(|height| peak - height - from))
    }

    /// Refuses a load that the boundary does not have.
    pub fn check(self, control: Control) -> Outcome<()> {
        match (self, control) {
            (Self::Periodic, Control::Approach(_)) => {
                Err("an approach needs --boundary free: in a periodic cell bodies \
                                                           have none, give a mean gap, a pressure or a force"
                    .into())
            }
            (Self::Free, Control::MeanGap(_)) => {
                Err("a mean gap needs --boundary periodic: a free half-space has none \
                                                      to be held, give an approach, a force, a pressure or a spring"
                    .into())
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Display for Boundary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Periodic => "periodic",
            Self::Free => "free",
        })
    }
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
}

/// The options of which one is a load of a solve, for the group that needs one.
pub const LOAD: [&str; 5] = ["mean_gap", "mean_pressure", "normal_force", "approach", "spring_stiffness"];

impl LoadOptions {
    /// The load that is given.
    pub fn control(&self) -> Control {
        match *self {
            Self { mean_gap: Some(gap), .. } => Control::MeanGap(gap.value),
            Self { mean_pressure: Some(pressure), .. } => Control::MeanPressure(pressure.value),
            Self { normal_force: Some(force), .. } => Control::Force(force.value),
            Self { approach: Some(approach), .. } => Control::Approach(approach.value),
            Self { spring_stiffness, spring_position, .. } => {
                let [stiffness, rest] =
                    [spring_stiffness, spring_position].map(|given| given.map_or(0.0, |given| given.value));
                Control::Spring { stiffness, rest }
            }
        }
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
}

/// The options of which one is a list of loads, for the group that needs one.
pub const LOADS: [&str; 5] = ["mean_gaps", "mean_pressures", "normal_forces", "approaches", "spring_stiffness"];

impl LoadsOptions {
    /// The values of the list, each with its load.
    pub fn values(&self) -> &[f64] {
        let lists = [&self.mean_gaps, &self.mean_pressures, &self.normal_forces, &self.approaches];
        let list = lists.into_iter().chain([&self.spring_positions]).flatten().next();
        list.map_or(&[], |list| &list.values)
    }

    /// The load of a value of the list.
    pub fn control(&self, value: f64) -> Control {
        match self {
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

    /// The loads, in their order.
    pub fn controls(&self) -> Vec<Control> {
        self.values().iter().map(|&value| self.control(value)).collect()
    }

    /// The kind of the loads, with all that they have in common, for comparing two runs.
    pub fn kind(&self) -> String {
        let name = self.control(0.0).name();
        self.spring_stiffness().map_or(name.to_owned(), |stiffness| format!("{name} of stiffness {stiffness}"))
    }
}
