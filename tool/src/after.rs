//! The options for what is asked for after a solve.

use asperity_scene::{After, Conductors};
use clap::Args;

use crate::allowed::share;
use crate::options::ProblemOptions;
use crate::outcome::Outcome;
use crate::printing::in_options;
use crate::processes::Processes;
use crate::quantity::{CONDUCTIVITY, Quantity, RESISTIVITY};

/// The conductors, of which the contact stiffness tells the conductance.
#[derive(Args)]
pub struct ConductorOptions {
    /// Electrical resistivities of both half-spaces: with --stiffness the electrical conductance of the contact per
    /// area, by Barber's identity, and its relative error, that of the grid included
    #[arg(long, value_names = ["R1", "R2"], num_args = 2, allow_negative_numbers = true, help_heading = "Output")]
    #[arg(value_parser = RESISTIVITY.non_negative(), conflicts_with = "conductivities")]
    resistivities: Option<Vec<Quantity>>,
    /// Thermal conductivities of both half-spaces: the same for heat
    #[arg(long, value_names = ["K1", "K2"], num_args = 2, allow_negative_numbers = true, help_heading = "Output")]
    #[arg(value_parser = CONDUCTIVITY.positive())]
    conductivities: Option<Vec<Quantity>>,
}

impl ConductorOptions {
    /// The conductors, if they are given.
    pub fn conductors(&self) -> Option<Conductors> {
        let pair = |given: &Option<Vec<Quantity>>| match given.as_deref() {
            Some([first, second]) => Some((first.value, second.value)),
            _ => None,
        };
        let thermal = || pair(&self.conductivities).map(Conductors::Thermal);
        pair(&self.resistivities).map(Conductors::Electrical).or_else(thermal)
    }
}

/// The leakage of a table.
#[derive(Args)]
pub struct LeakageOptions {
    /// Enclose the transmissivity of the gap along x and y under each load between two bounds, as asperity leak, in
    /// columns transmissivity_x_lower and so on, as close as a share of the upper one [default: 1e-3 if --leakage
    /// stands alone]
    #[arg(long, value_name = "T", num_args = 0..=1, default_missing_value = "1e-3", help_heading = "Output")]
    #[arg(value_parser = share, allow_negative_numbers = true)]
    pub leakage: Option<f64>,
}

/// Refuses findings that a problem does not have, and those that have no form for several processes.
pub fn check(after: &After, problem: ProblemOptions<'_>, processes: &Processes) -> Outcome<()> {
    let adhesion = problem.adhesion.described();
    in_options(after.check(&problem.surface.elastic(), &adhesion))?;
    after.takes_whole_fields(adhesion.adheres()).map_or(Ok(()), |name| processes.alone(name))
}
