//! The rms slopes of the surface of a solve.

use asperity::Surface;
use asperity::surface::{Spectrum, rms_slope};
use serde::Serialize;

use crate::key::{Boundary, record};

record! {
    /// The rms slopes of the surface that a solve presses, of the sum where two surfaces face each other.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    Slopes of (rms_slope: Option<f64>, differences: Option<f64>, nodes_per_wave: Option<f64>) {
        /// Rms slope of the waves of the surface, to which a reduced pressure refers; none without a period, or with absent
        /// nodes.
        rms_slope: Option<f64> = rms_slope,
        /// Rms slope from differences between neighbouring nodes, to which warnings refer; none with absent nodes.
        rms_slope_differences: Option<f64> = differences,
        /// The nodes of the shortest wave, where the spectrum was computed; for the error of the grid.
        #[serde(skip)]
        nodes_per_wave: Option<f64> = nodes_per_wave,
    }
}

impl Slopes {
    /// The slopes of a surface, of the whole of a shared one.
    pub(crate) fn on(surface: &Surface, boundary: Boundary) -> Self {
        if surface.absent_nodes() > 0 {
            return Self::default();
        }
        let surface = surface.whole();
        let (grid, periodic) = (surface.grid(), boundary == Boundary::Periodic);
        // where there is no room for the spectrum, there is none for a solve, which is refused later
        let room = || Vec::<f64>::new().try_reserve_exact(3 * grid.nodes()).is_ok();
        let known = |slope: f64| Some(slope).filter(|slope| slope.is_finite());
        let spectrum = (periodic && room()).then(|| surface.spectrum());
        let of_waves = spectrum.as_ref().map(Spectrum::rms_slope).and_then(known);
        let differences = known(rms_slope(surface.heights().view(), grid.spacing(), periodic));
        Self::record(of_waves, differences, spectrum.as_ref().map(Spectrum::nodes_per_wave))
    }
}
