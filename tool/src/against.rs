//! The other body: its surface, which faces the one that is pressed, and its modulus.

use std::path::PathBuf;

use asperity::Surface;
use asperity_scene::{Boundary, between};
use clap::Args;

use crate::heights::{Origin, map_in};
use crate::outcome::Outcome;
use crate::printing::in_options;
use crate::quantity::{LENGTH, PRESSURE, Quantity};

/// The body on the other side, flat and rigid by default.
#[derive(Args)]
#[command(next_help_heading = "Surface")]
pub struct AgainstOptions {
    /// Heights of the surface on the other side, peaks up as they were measured, of as many nodes and the same sides;
    /// it is turned over about the y axis as it faces the other one
    #[arg(long, value_name = "FILE")]
    pub against: Option<PathBuf>,
    /// Contact modulus E/(1 - nu^2) of the body on the other side, an elastic half-space [default: it is rigid]
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = PRESSURE.positive())]
    against_modulus: Option<Quantity>,
    /// Shift of the surface on the other side along x and y, any part of a node [default: 0 0]; negative ones with a
    /// unit are written --shift=-1um,0um
    #[arg(long, value_names = ["X", "Y"], num_args = 1..=2, value_delimiter = ',', allow_negative_numbers = true)]
    #[arg(requires = "against", value_parser = LENGTH.finite())]
    shift: Option<Vec<Quantity>>,
}

impl AgainstOptions {
    /// The contact modulus, unless the body is rigid.
    pub fn modulus(&self) -> Option<f64> {
        self.against_modulus.map(|modulus| modulus.value)
    }

    /// The shift, if there is a surface.
    pub fn shift(&self) -> Option<(f64, f64)> {
        let along =
            |axis: usize| self.shift.as_ref().and_then(|shift| shift.get(axis)).map_or(0.0, |shift| shift.value);
        self.against.as_ref().map(|_| (along(0), along(1)))
    }

    /// The surface between the first one and the one on the other side, if there is one.
    pub fn between(&self, first: Surface, origin: &Origin, si: bool, given: (Boundary, bool)) -> Outcome<Surface> {
        let (Some(path), Some(shift)) = (&self.against, self.shift()) else { return Ok(first) };
        let (map, _) = map_in(si, path)?;
        in_options(between((&first, origin.unit.as_deref(), origin.original), map, shift, given))
    }
}
