//! The operator of a solve in both of its precisions.

use crate::elastic::{ElasticOperator, Foundation, Spectral};
use crate::error::Result;
use crate::field::Field;
use crate::real::Real;

/// Fields that wait for their next use.
type Idle<'a, Lo> = [&'a mut Field<Lo>; 3];

/// The operator for a state of precision T with corrections of Lo.
pub(super) trait Operators<T: Real, Lo: Real> {
    fn state(&self) -> &dyn ElasticOperator<T>;

    /// The operator for the corrections: the response to a change, the preconditioner, and its coarse space.
    fn corrections(&mut self) -> &mut dyn ElasticOperator<Lo>;

    /// The pressure K⁻¹g of a gap. The memory of `idle` fields may be used, and is zero then.
    fn pressure(&mut self, gap: &Field<T>, pressure: &mut Field<T>, idle: &mut [&mut Field<Lo>]) -> Result<()>;

    /// The displacement K p of a pressure, with `idle` as above.
    fn displacement(&mut self, pressure: &Field<T>, displacement: &mut Field<T>, idle: Idle<'_, Lo>) -> Result<()>;

    /// The mean of p·K p; `idle` has at least one field.
    fn work(&mut self, pressure: &Field<T>, foundation: f64, idle: Idle<'_, Lo>) -> Result<f64>;
}

pub(super) struct One<'a, T>(pub(super) &'a mut dyn ElasticOperator<T>);

impl<T: Real> Operators<T, T> for One<'_, T> {
    fn state(&self) -> &dyn ElasticOperator<T> {
        self.0
    }
    fn corrections(&mut self) -> &mut dyn ElasticOperator<T> {
        self.0
    }
    fn pressure(&mut self, gap: &Field<T>, pressure: &mut Field<T>, _: &mut [&mut Field<T>]) -> Result<()> {
        self.0.pressure(gap.view(), pressure.view_mut())
    }
    fn displacement(&mut self, pressure: &Field<T>, displacement: &mut Field<T>, _: Idle<'_, T>) -> Result<()> {
        self.0.displacement(pressure.view(), displacement.view_mut())
    }
    fn work(&mut self, pressure: &Field<T>, foundation: f64, [field, ..]: Idle<'_, T>) -> Result<f64> {
        let foundation = Foundation::uniform(foundation, foundation);
        Ok(self.0.precondition(pressure.view(), foundation, field.view_mut())?.error)
    }
}

/// An operator in `f64`, and the same one in `f32` for the corrections. Only one at a time keeps a spectrum.
pub(super) struct Two<'a> {
    state: &'a mut dyn ElasticOperator<f64>,
    corrections: Spectral<f32>,
}

impl<'a> Two<'a> {
    pub(super) fn new(state: &'a mut dyn ElasticOperator<f64>, corrections: Spectral<f32>) -> Self {
        state.release_memory();
        Self { state, corrections }
    }

    /// Applies the operator in `f64`, in memory of that in `f32` and of idle fields.
    fn apply<R>(
        &mut self,
        idle: &mut [&mut Field<f32>],
        apply: impl FnOnce(&mut dyn ElasticOperator<f64>) -> Result<R>,
    ) -> Result<R> {
        let shape = self.state.grid().field_shape();
        self.corrections.release_memory();
        idle.iter_mut().for_each(|field| **field = Field::default());
        let result = apply(self.state);
        self.state.release_memory();
        idle.iter_mut().for_each(|field| **field = Field::zeros(shape));
        result
    }
}

impl Operators<f64, f32> for Two<'_> {
    fn state(&self) -> &dyn ElasticOperator<f64> {
        self.state
    }
    fn corrections(&mut self) -> &mut dyn ElasticOperator<f32> {
        &mut self.corrections
    }
    fn pressure(&mut self, gap: &Field<f64>, pressure: &mut Field<f64>, idle: &mut [&mut Field<f32>]) -> Result<()> {
        self.apply(idle, |operator| operator.pressure(gap.view(), pressure.view_mut()))
    }
    fn displacement(&mut self, pressure: &Field<f64>, result: &mut Field<f64>, mut idle: Idle<'_, f32>) -> Result<()> {
        self.apply(&mut idle, |operator| operator.displacement(pressure.view(), result.view_mut()))
    }
    fn work(&mut self, pressure: &Field<f64>, foundation: f64, mut idle: Idle<'_, f32>) -> Result<f64> {
        self.apply(&mut idle, |operator| {
            let (foundation, mut field) = (Foundation::uniform(foundation, foundation), Field::zeros(pressure.dim()));
            Ok(operator.precondition(pressure.view(), foundation, field.view_mut())?.error)
        })
    }
}
