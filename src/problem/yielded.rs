//! The plastic depth of a surface: how far it has yielded under former loads.

use ndarray::ArrayView2;

use super::PressedFlat;
use crate::elastic::ElasticOperator;
use crate::error::{Error, Result};
use crate::field::Field;
use crate::real::Real;

/// The plastic depth of a surface, on the grid of the operator, and the surface as it was before.
#[derive(Clone, Debug)]
pub(crate) struct Yielded<T> {
    pub(crate) depth: Field<T>,
    /// K⁻¹h, ⟨h, K⁻¹h⟩, and the height of the peak over the mean plane, of the surface before
    pressure: Field<T>,
    work: f64,
    peak: f64,
    /// the mean depth over the operator's grid
    pub(crate) mean: f64,
}

impl<T: Real> PressedFlat<T> {
    /// The mean plastic depth over the operator's grid: by so much the mean plane of the surface is lower than it was.
    pub(crate) fn mean_depth(&self) -> f64 {
        self.yielded.as_ref().map_or(0.0, |yielded| yielded.mean)
    }

    /// A plastic depth of the surface's grid, on the operator's grid.
    pub(super) fn placed(&self, operator: &dyn ElasticOperator<T>, depth: ArrayView2<'_, T>) -> Result<Field<T>> {
        let grid = *operator.grid();
        let surface = self.grid(&grid);
        surface.fits("plastic depth", depth.dim())?;
        surface.finite("plastic depth", depth)?;
        let negative = depth.iter().find(|&&depth| depth < T::zero());
        let refused = |&depth: &T| Error::non_negative("plastic depth", depth.widen()).map(|_| ());
        surface.agreed(negative.map_or(Ok(()), refused))?;
        Ok(self.place(Field::of(self.hold(depth)), T::zero()))
    }

    /// Lowers the surface, as it was made, by a depth on the operator's grid. The same depth gives the same bits,
    /// whatever the depths before it were.
    pub(super) fn flatten(&mut self, operator: &mut dyn ElasticOperator<T>, depth: Field<T>) -> Result<()> {
        let grid = *operator.grid();
        let (pressure, work, peak) = match self.yielded.take() {
            Some(before) => (before.pressure, before.work, before.peak),
            None => (self.pressure.clone(), self.work, self.peak),
        };
        let mean = grid.mean(depth.view(), T::widen);
        operator.pressure(depth.view(), self.pressure.view_mut())?;
        let own = grid.mean_of_both(depth.view(), self.pressure.view(), |d, p| d.widen() * p.widen());
        let mixed = grid.mean_of_both(depth.view(), pressure.view(), |d, p| d.widen() * p.widen());
        self.work = (work - 2.0 * mixed + own).max(0.0);
        self.pressure.view_mut().zip_mut_with(&pressure, |p, &before| *p = before - *p);
        self.peak = peak + mean;
        self.yielded = Some(Yielded { depth, pressure, work, peak, mean });
        Ok(())
    }
}
