//! The operator of a solve: in the precision of the state, and in that of its corrections.

use ndarray::Array2;

use crate::elastic::{ElasticOperator, Foundation};
use crate::error::Result;
use crate::real::{Real, cast};

/// The operator of a solve whose state is of precision T and whose corrections are of precision L.
pub(super) trait Operators<T: Real, L: Real> {
    /// The operator for the state.
    fn state(&self) -> &dyn ElasticOperator<T>;

    /// The operator for the corrections: the response to a change, the preconditioner, and its coarse space.
    fn corrections(&mut self) -> &mut dyn ElasticOperator<L>;

    /// The pressure K⁻¹g of a gap. The memory of `idle` fields may be used; they are zero then.
    fn pressure(&mut self, gap: &Array2<T>, pressure: &mut Array2<T>, idle: &mut [&mut Array2<L>]) -> Result<()>;

    /// The mean of p·K p, with a field to write to.
    fn work(&mut self, pressure: &Array2<T>, foundation: f64, displacement: &mut Array2<L>) -> Result<f64>;
}

/// One operator for both.
pub(super) struct One<'a, T>(pub(super) &'a mut dyn ElasticOperator<T>);

impl<T: Real> Operators<T, T> for One<'_, T> {
    fn state(&self) -> &dyn ElasticOperator<T> {
        self.0
    }
    fn corrections(&mut self) -> &mut dyn ElasticOperator<T> {
        self.0
    }
    fn pressure(&mut self, gap: &Array2<T>, pressure: &mut Array2<T>, _: &mut [&mut Array2<T>]) -> Result<()> {
        self.0.pressure(gap.view(), pressure.view_mut())
    }
    fn work(&mut self, pressure: &Array2<T>, foundation: f64, displacement: &mut Array2<T>) -> Result<f64> {
        let foundation = Foundation::uniform(foundation, foundation);
        Ok(self.0.precondition(pressure.view(), foundation, displacement.view_mut())?.error)
    }
}

/// An operator in `f64`, which keeps no memory while it is not used, and the same one in `f32` for the corrections.
pub(super) struct Two<'a> {
    pub(super) state: &'a mut dyn ElasticOperator<f64>,
    pub(super) corrections: Box<dyn ElasticOperator<f32>>,
}

impl Operators<f64, f32> for Two<'_> {
    fn state(&self) -> &dyn ElasticOperator<f64> {
        self.state
    }
    fn corrections(&mut self) -> &mut dyn ElasticOperator<f32> {
        &mut *self.corrections
    }
    fn pressure(&mut self, gap: &Array2<f64>, pressure: &mut Array2<f64>, idle: &mut [&mut Array2<f32>]) -> Result<()> {
        self.corrections.rest();
        idle.iter_mut().for_each(|field| **field = Array2::zeros((0, 0)));
        self.state.pressure(gap.view(), pressure.view_mut())?;
        self.state.rest();
        idle.iter_mut().for_each(|field| **field = Array2::zeros(gap.dim()));
        Ok(())
    }
    fn work(&mut self, pressure: &Array2<f64>, foundation: f64, displacement: &mut Array2<f32>) -> Result<f64> {
        let (rounded, foundation) = (pressure.mapv(cast), Foundation::uniform(foundation, foundation));
        Ok(self.corrections.precondition(rounded.view(), foundation, displacement.view_mut())?.error)
    }
}
