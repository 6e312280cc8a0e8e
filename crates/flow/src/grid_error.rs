//! The error of the grid in the transmissivity, from grids of half the resolution.

use asperity::Result;

use crate::gap::{Axis, Gap};
use crate::leakage::{Leak, Leakage};

/// The least distance of the bounds on the coarser grids: far below what a grid leaves.
const COARSE: f64 = 1e-4;

/// The fall of differences from grid to grid from which the limit is out of sight: where squares of gaps of 1 and 3 meet at
/// corners it is 0.72.
const SLOWEST: f64 = 0.7;

/// The factor on what is left of the differences, whose fall may slow down. Where the gap is resolved, a third of the last
/// difference is left.
const SAFETY: f64 = 3.0;

/// Keeps the differences of the transmissivities along both axes, relative to the finer grid, that are larger.
fn keep_largest(differences: &mut [f64; 2], fine: &Leak, coarse: &Leak) {
    for (axis, difference) in Axis::BOTH.into_iter().zip(differences) {
        let [fine, coarse] = [fine, coarse].map(|leak| leak.along(axis).transmissivity.upper);
        if fine > 0.0 {
            *difference = f64::max(*difference, (coarse / fine - 1.0).abs());
        }
    }
}

impl Leakage {
    /// The estimated relative error of the grid in the transmissivity along both axes: the largest difference from the
    /// transmissivity on the even nodes alone, and on the odd nodes alone, or what is left of such differences from
    /// grid to grid. None without a passage, where a side has an odd number of nodes, and where the differences to
    /// grids of half and of a quarter of the nodes hardly fall, as where open cells meet at corners.
    ///
    /// The network is right to second order in the spacing where the gap is resolved, and the difference is then three
    /// times its error. Where it is not, three times what is left of the differences counts, as for cells that meet at
    /// corners; at a constriction of a few nodes the differences scatter, up to one and more.
    /// The estimate is no bound, and does not contain the error of the gap itself.
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
    /// As [`Self::through`].
    pub fn grid_error(&self, gap: &Gap<'_>, leak: &Leak) -> Result<[Option<f64>; 2]> {
        self.grid_error_while(gap, leak, &|| true)
    }

    /// The same, by [`Self::through_while`].
    ///
    /// # Errors
    /// As [`Self::through`].
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
        let settings = self.tolerance(self.tolerance.max(COARSE));
        // the differences from a grid to grids of half and of a quarter of the nodes, the larger ones
        let (mut halves, mut quarters) = ([0.0; 2], [0.0; 2]);
        for first in 0..2 {
            let half_gap = gap.every_second(first)?;
            let half = settings.through_while(&half_gap, goes_on)?;
            keep_largest(&mut halves, leak, &half);
            if nx.is_multiple_of(4) && ny.is_multiple_of(4) {
                keep_largest(&mut quarters, &half, &settings.through_while(&half_gap.every_second(first)?, goes_on)?);
            }
        }
        Ok(Axis::BOTH.map(|axis| {
            leak.percolation.along(axis)?;
            let (half, quarter) = (halves[axis as usize], quarters[axis as usize]);
            // what is left of a geometric series, which falls to a fourth where the gap is resolved
            // below the distance of their bounds differences are none
            let fall = if half > COARSE && quarter > 0.0 { half / quarter } else { 0.0 };
            (fall <= SLOWEST).then(|| half * f64::max(1.0, SAFETY * fall / (1.0 - fall)))
        }))
    }
}
