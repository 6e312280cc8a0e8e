//! The displacements of two elastic bodies under the pressure between them.

use asperity::elastic::Boundary;
use asperity::{ElasticOperator, Real, Result};
use ndarray::{Array2, ArrayView2};

use crate::account::Sight;
use crate::key::Elastic;

impl<T: Real> Sight<T> {
    /// The displacements of both bodies of a solution, each away from the other one, if both are elastic: û = p̂/k of
    /// each wave of the elastic pressure. With a free boundary they vanish far away, and with a periodic one they have no
    /// mean but that of a body whose mean compliance is known. Several processes may share a periodic grid.
    ///
    /// # Errors
    /// Those of [`Elastic::operator`] and [`Elastic::body`].
    pub fn displacements(&self, elastic: &Elastic, pressure: ArrayView2<'_, T>) -> Result<Option<[Array2<f64>; 2]>> {
        let Some(other) = elastic.other() else { return Ok(None) };
        Ok(Some([self.displacement(&elastic.alone(), pressure)?, self.displacement(&other, pressure)?]))
    }

    fn displacement(&self, elastic: &Elastic, pressure: ArrayView2<'_, T>) -> Result<Array2<f64>> {
        let mut operator = elastic.operator::<T>(self.grid)?;
        let (whole, (nx, ny)) = (*operator.grid(), pressure.dim());
        let compliance = match operator.boundary() {
            Boundary::Free { mean_compliance, .. } => mean_compliance,
            _ => elastic.body()?.mean_compliance(),
        };
        let mean = compliance * self.report.net_pressure * self.grid.nodes() as f64 / whole.nodes() as f64;
        let load = |(i, j)| if i < nx && j < ny { pressure[[i, j]] } else { T::zero() };
        let loaded = Array2::from_shape_fn(whole.field_shape(), load);
        let mut displaced = Array2::zeros(whole.field_shape());
        operator.displacement(loaded.view(), displaced.view_mut())?;
        Ok(Array2::from_shape_fn((nx, ny), |node| displaced[node].widen() + mean))
    }
}
