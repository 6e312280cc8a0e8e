//! The accuracy that is asked for: its options.

use asperity::accuracy::Quantity;
use asperity_scene::Goal;
use clap::{Args, ValueEnum};

use crate::allowed::positive;

/// The accuracy that is asked for, from which tolerance and grid follow.
#[derive(Args)]
pub struct AccuracyOptions {
    /// Relative error that is wanted, as 0.01: chooses the tolerance, solves on coarser grids too, and interpolates the
    /// surface on finer ones until the estimated error is as small; the results are on the finest grid
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = positive, help_heading = "Solver")]
    #[arg(conflicts_with_all = ["initial_gap", "nested", "no_nested", "stability", "leave"])]
    pub accuracy: Option<f64>,
    /// Quantity that has the accuracy [default: area]
    #[arg(long, value_enum, value_name = "QUANTITY", requires = "accuracy", help_heading = "Solver")]
    pub accuracy_of: Option<Of>,
    /// Memory that --accuracy may take, in GiB [default: all that is free]
    #[arg(long, value_name = "GIB", allow_hyphen_values = true, value_parser = positive, help_heading = "Solver")]
    #[arg(requires = "accuracy")]
    pub memory: Option<f64>,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum Of {
    /// Contact area, corrected for its edge
    Area,
    /// Mean gap
    Gap,
    /// Approach, with a free boundary
    Approach,
    /// Mean pressure
    Pressure,
    /// Contact stiffness
    Stiffness,
}

impl AccuracyOptions {
    /// The accuracy, if one is asked for.
    pub fn goal(&self) -> Option<Goal> {
        let of = match self.accuracy_of.unwrap_or(Of::Area) {
            Of::Area => Quantity::Area,
            Of::Gap => Quantity::Gap,
            Of::Approach => Quantity::Approach,
            Of::Pressure => Quantity::Pressure,
            Of::Stiffness => Quantity::Stiffness,
        };
        self.accuracy.map(|accuracy| Goal { accuracy, of, memory: self.memory })
    }
}
