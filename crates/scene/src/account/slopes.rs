//! The rms slopes of the surface of a solve.

use asperity::Surface;
use asperity::surface::{Spectrum, rms_slope};
use serde::Serialize;

use crate::key::Boundary;

/// The rms slopes of the surface that a solve presses, of the sum where two surfaces face each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Slopes {
    /// The one of its waves, as in a reduced pressure; none where the surface does not repeat itself, or has absent
    /// nodes.
    pub rms_slope: Option<f64>,
    /// The one from differences between neighbours, as in warnings; none with absent nodes.
    pub rms_slope_differences: Option<f64>,
    /// The nodes of the shortest wave, where the spectrum was computed; for the error of the grid.
    #[serde(skip)]
    pub(crate) nodes_per_wave: Option<f64>,
}

impl Slopes {
    /// The slopes of a surface, of the whole of a shared one.
    pub(crate) fn of(surface: &Surface, boundary: Boundary) -> Self {
        if surface.absent_nodes() > 0 {
            return Self::default();
        }
        let surface = surface.whole();
        let (grid, periodic) = (surface.grid(), boundary == Boundary::Periodic);
        // where there is no room for the spectrum, there is none for a solve, which is refused later
        let room = || Vec::<f64>::new().try_reserve_exact(3 * grid.nodes()).is_ok();
        let known = |slope: f64| Some(slope).filter(|slope| slope.is_finite());
        let spectrum = (periodic && room()).then(|| surface.spectrum());
        Self {
            rms_slope: spectrum.as_ref().map(Spectrum::rms_slope).and_then(known),
            rms_slope_differences: known(rms_slope(surface.heights().view(), grid.spacing(), periodic)),
            nodes_per_wave: spectrum.as_ref().map(Spectrum::nodes_per_wave),
        }
    }
}
