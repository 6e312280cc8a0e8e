//! The rms slopes of the surface of a solve.

use asperity::Surface;
use asperity::surface::rms_slope;
use serde::Serialize;

use crate::boundary::Boundary;

/// The rms slopes of the surface that a solve presses, of the sum where two surfaces face each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Slopes {
    /// The one of its waves, as in a reduced pressure; none where the surface does not repeat itself, or has absent
    /// nodes.
    pub rms_slope: Option<f64>,
    /// The one from differences between neighbours, as in warnings; none with absent nodes.
    pub rms_slope_differences: Option<f64>,
}

impl Slopes {
    /// The slopes of a whole surface; none of a part that a process has of a shared one.
    pub fn of(surface: &Surface, boundary: Boundary) -> Self {
        let grid = surface.grid();
        if surface.absent_nodes() > 0 || grid.is_shared() {
            return Self::default();
        }
        let periodic = boundary == Boundary::Periodic;
        // where there is no room for the spectrum, there is none for a solve, which is refused later
        let room = || Vec::<f64>::new().try_reserve_exact(5 * grid.nodes()).is_ok();
        let known = |slope: f64| Some(slope).filter(|slope| slope.is_finite());
        Self {
            rms_slope: (periodic && room()).then(|| surface.spectrum().rms_slope()).and_then(known),
            rms_slope_differences: known(rms_slope(surface.heights().view(), grid.spacing(), periodic)),
        }
    }
}
