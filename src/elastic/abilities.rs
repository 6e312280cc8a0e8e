use ndarray::{ArrayView2, ArrayViewMut2};

use super::{Boundary, CoarseSpace, ElasticOperator};
use crate::error::Result;
use crate::real::Real;

/// The abilities of an operator beside its applications, [`ElasticOperator::abilities`]; none by default.
///
/// A wrapper returns the abilities of its operator, except for those that it changes.
#[non_exhaustive]
pub struct Abilities<'a, T: Real> {
    /// The boundary of the body; periodic by default.
    pub boundary: Boundary,
    /// Whether the operator takes fields of [`Grid::field_shape`](crate::Grid::field_shape) on a shared grid.
    pub slabs: bool,
    /// Whether a solve in `f64` may have its corrections from the operator [in `f32`](Waves::in_single).
    pub single: bool,
    /// The waves of a spectral operator.
    pub waves: Option<&'a mut dyn Waves<T>>,
}

impl<T: Real> Default for Abilities<'_, T> {
    fn default() -> Self {
        Self { boundary: Boundary::default(), slabs: false, single: false, waves: None }
    }
}

impl<T: Real> Abilities<'_, T> {
    pub(crate) fn coarse_space(self, dimension: usize) -> Option<CoarseSpace> {
        self.waves?.coarse_space(dimension)
    }

    pub(crate) fn in_single(self) -> Option<Box<dyn ElasticOperator<f32>>> {
        self.waves.filter(|_| self.single)?.in_single()
    }

    pub(crate) fn release_memory(self) {
        self.waves.into_iter().for_each(Waves::release_memory);
    }
}

/// The waves of an elastic operator, as [`Spectral`](crate::Spectral) knows them.
pub trait Waves<T: Real> {
    /// The space of the longest waves, of about `dimension` dimensions, that the preconditioner treats with the
    /// contacts where they are. Without one the foundation is uniform, and a solve takes more iterations.
    fn coarse_space(&mut self, dimension: usize) -> Option<CoarseSpace>;

    /// The operator in `f32`, for the corrections of a solve in `f64`; none if a stiffness leaves the range of `f32`.
    ///
    /// A solve in `f64` applies it to the changes of the gap and to the residuals, and the operator itself to the gap
    /// now and then. It must be the same operator but for rounding.
    fn in_single(&mut self) -> Option<Box<dyn ElasticOperator<f32>>>;

    /// The elastic pressure K⁻¹h of heights in `f64`, and the mean of h·K⁻¹h; the heights have no mean, or one not
    /// larger than their rms value.
    ///
    /// # Errors
    /// [`Error::Shape`](crate::Error::Shape) if a field does not fit the grid.
    fn surface_pressure(&mut self, heights: ArrayView2<'_, f64>, pressure: ArrayViewMut2<'_, T>) -> Result<f64>;

    /// Gives back the memory that is kept between two applications; the next one takes it anew.
    fn release_memory(&mut self);
}
