//! The displacements of two elastic bodies under the pressure between them.

use asperity::elastic::Boundary;
use asperity::{ElasticOperator, Real, Result, Solution};
use ndarray::{Array2, ArrayView2};

use crate::account::Sight;
use crate::key::Elastic;

impl<T: Real> Sight<T> {
    /// The displacements of both bodies of a solution, each away from the other one, if both are elastic: û = p̂/k of
    /// each wave of the elastic pressure. With a free boundary they vanish far away, and with a periodic boundary they
    /// have no mean but the mean of a body with a known mean compliance. Several processes may share a periodic grid.
    ///
    /// # Errors
    /// Those of the body and the operator.
    pub fn displacements(&self, elastic: &Elastic, pressure: ArrayView2<'_, T>) -> Result<Option<[Array2<f64>; 2]>> {
        let Some(other) = elastic.other() else { return Ok(None) };
        Ok(Some([self.displacement(&elastic.alone(), pressure)?, self.displacement(&other, pressure)?]))
    }

    /// The mean of the waves of the displacement over the nodes that face the surface, less the mean over all nodes,
    /// which is zero: without absent nodes it is the same. With them one process has to have all of a periodic grid.
    ///
    /// # Errors
    /// Those of the operator.
    pub(crate) fn facing_displacement(&self, elastic: &Elastic, solution: &Solution<T>) -> Result<f64> {
        if solution.report.absent_nodes == 0 {
            return Ok(0.0);
        }
        let mut displaced = Array2::zeros(solution.gap.dim());
        elastic.operator::<T>(self.grid)?.displacement(solution.pressure.view(), displaced.view_mut())?;
        let facing = solution.gap.iter().zip(&displaced).filter(|(gap, _)| gap.is_finite());
        let (sum, count) = facing.fold((0.0, 0.0), |(sum, count), (_, u)| (sum + u.widen(), count + 1.0));
        Ok(sum / count)
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
