//! What the grid leaves in the transmissivity, from grids of half the resolution.

use asperity::Result;

use crate::gap::{Axis, Gap};
use crate::leakage::{Leak, Leakage};

/// The least distance of the bounds on the coarser grids: far below what a grid leaves.
const COARSE: f64 = 1e-4;

impl Leakage {
    /// The estimated relative error of the grid in the transmissivity along both axes: the largest difference from that
    /// on the even nodes alone, and from that on the odd ones. None without a passage, and where a side has an odd
    /// number of nodes.
    ///
    /// The network is right to second order in the spacing where the gap is resolved, and the difference is three times
    /// its error then. Where it is not, as at a constriction of a few nodes, both differences scatter, up to one and
    /// more. The estimate is no bound, and does not contain the error of the gap itself.
    ///
    /// ```
    /// use asperity::Grid;
    /// use asperity_flow::{Axis, Gap, Leakage};
    /// let grid = Grid::square(64, 1.0)?;
    /// let wavy = grid.sample(|x, y| 1.0 + 0.5 * (std::f64::consts::TAU * (x + y)).cos());
    /// let gap = Gap::new(wavy.view(), grid)?;
    /// let leak = Leakage::default().through(&gap)?;
    /// let [error, _] = Leakage::default().grid_error(&gap, &leak)?;
    /// let exact = 0.5 * (2.0 * 0.75_f64.powf(2.5) / 2.25 + 1.375) / 12.0; // the mean of along and across
    /// let own = leak.along(Axis::X).transmissivity.upper / exact - 1.0;
    /// assert!(error.is_some_and(|error| own.abs() < error && error < 0.02));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Self::through`].
    pub fn grid_error(&self, gap: &Gap<'_>, leak: &Leak) -> Result<[Option<f64>; 2]> {
        self.grid_error_while(gap, leak, &|| true)
    }

    /// The same, by [`Self::through_while`].
    ///
    /// # Errors
    /// Those of [`Self::through`].
    pub fn grid_error_while(
        &self,
        gap: &Gap<'_>,
        leak: &Leak,
        goes_on: &(dyn Fn() -> bool + Sync),
    ) -> Result<[Option<f64>; 2]> {
        let (nx, ny) = gap.grid().shape();
        if !(nx.is_multiple_of(2) && ny.is_multiple_of(2)) {
            return Ok([None; 2]);
        }
        let mut errors = Axis::BOTH.map(|axis| leak.percolation.along(axis).map(|_| 0.0));
        let settings = self.tolerance(self.tolerance.max(COARSE));
        for first in 0..2 {
            let coarse = settings.through_while(&gap.every_second(first)?, goes_on)?;
            for (axis, error) in Axis::BOTH.into_iter().zip(&mut errors) {
                let [own, half] = [leak, &coarse].map(|leak| leak.along(axis).transmissivity.upper);
                *error = error.map(|error: f64| error.max((half / own - 1.0).abs()));
            }
        }
        Ok(errors)
    }
}
