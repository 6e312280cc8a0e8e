//! The sight of a solution: what a later look needs beside its fields.

use std::sync::Arc;

use asperity::accuracy::{GridError, Quantity};
use asperity::contact::Original;
use asperity::nested::Level;
use asperity::{AdhesionLaw, Report, Surface};

/// The estimated errors of the finest of nested grids, where they can be told.
pub type Errors = [(Quantity, Option<GridError>); 4];

/// The errors of nested grids, which are estimated with the first look at them.
pub enum Estimate {
    Open { surface: Arc<Surface>, levels: Vec<Level> },
    Found(Errors),
}

impl Estimate {
    /// The errors, if they have been estimated.
    pub fn found(&self) -> Option<&Errors> {
        if let Self::Found(errors) = self { Some(errors) } else { None }
    }

    /// The errors; the surface is not needed any more then.
    pub fn errors(&mut self, report: &Report) -> Errors {
        let errors = match self {
            Self::Open { surface, levels } => {
                GridError::of_all(levels, report, surface.nodes_per_wave(report.boundary))
            }
            Self::Found(errors) => *errors,
        };
        *self = Self::Found(errors);
        errors
    }
}

/// What a look needs beside the fields.
pub struct Sight<T> {
    pub law: Arc<dyn AdhesionLaw<T>>,
    /// The part that statistics are of, if they are not of the whole
    pub original: Option<Original>,
    /// The number of threads that was asked for
    pub threads: Option<usize>,
    /// Nothing where no nested grids were used
    pub estimate: Option<Estimate>,
}
