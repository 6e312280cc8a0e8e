//! What is asked of a gap: its leakage.

use asperity_flow::Leakage;

use crate::key::{Boundary, Entries, Kind, LENGTH, Range, VISCOSITY, keys};

keys! {
    /// The leakage through a gap.
    LeakKeys {
        "" {
            /// Surroundings of the map: with a free boundary the fluid enters at one side and leaves at the other
            /// [default: the folder's, or periodic]
            boundary: Option<Boundary> = Kind::word(Boundary::words, &["BOUNDARY"]),
            /// Gap of absent nodes, at which the file has no number; without it they are closed
            absent_gap: Option<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["G"]),
            /// Dynamic viscosity of the fluid, for the flow per pressure
            viscosity: Option<f64> = Kind::quantity(VISCOSITY, Range::POSITIVE, &["ETA"]),
        }
        "Solver" {
            /// Distance of the bounds at which to stop, relative to the upper one
            tolerance: Option<f64> = Kind::number(Range::SHARE, &["T"]).or("1e-6"),
            /// The most iterations along each axis
            max_iterations: Option<usize> = Kind::whole(&["N"]).or("1000"),
        }
    }
}

impl Entries {
    /// What is asked of a gap with a boundary, unless that is given.
    pub fn leak(&self, boundary: Boundary) -> LeakAsked {
        let settings = Leakage::default();
        let LeakKeys { boundary: given, absent_gap, viscosity, tolerance, max_iterations } = self.keys();
        let (tolerance, most) =
            (tolerance.unwrap_or(settings.tolerance), max_iterations.unwrap_or(settings.max_iterations));
        LeakAsked {
            boundary: given.unwrap_or(boundary),
            absent_gap,
            settings: settings.tolerance(tolerance).max_iterations(most),
            viscosity,
            grid_error: true,
        }
    }
}

/// What is asked of a gap.
#[derive(Clone, Copy, Debug)]
pub struct LeakAsked {
    /// What is beyond the map.
    pub boundary: Boundary,
    /// The gap of absent nodes, if they are open.
    pub absent_gap: Option<f64>,
    /// The settings.
    pub settings: Leakage,
    /// The viscosity, if it is known.
    pub viscosity: Option<f64>,
    /// Whether to estimate the error of the grid.
    pub grid_error: bool,
}
