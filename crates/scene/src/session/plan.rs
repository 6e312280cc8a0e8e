//! The plan of a solve to an accuracy, and the time that it is likely to take.

use asperity::accuracy::{Accuracy, Plan};
use asperity::{AdhesionLaw, Control, ElasticOperator, Real, Result, Solver, Surface};
use ndarray::Array2;

use crate::clock::Instant;
use crate::key::elastic::Elastic;
use crate::key::wall::Constraint;

/// The plan of a solve to an accuracy, and the seconds that it is likely to take, by those of an operator application.
///
/// # Errors
/// Those of the operator and of [`Accuracy::plan`].
pub(crate) fn planned<T: Real>(
    wanted: &Accuracy,
    solver: &Solver<Constraint<T>>,
    surface: &Surface,
    elastic: &Elastic,
    law: &dyn AdhesionLaw<T>,
    control: Control,
) -> Result<(Plan, f64)> {
    let mut operator = elastic.operator::<T>(*surface.grid())?;
    let plan = wanted.plan(solver, surface, &mut operator, &law, control)?;
    Ok((plan, plan.applications * seconds_of(&mut operator)?))
}

/// The seconds of an application of an operator, of which the first is a trial.
///
/// # Errors
/// Those of the operator.
pub(crate) fn seconds_of<T: Real>(operator: &mut impl ElasticOperator<T>) -> Result<f64> {
    let mut fields = [(); 2].map(|()| Array2::<T>::zeros(operator.grid().field_shape()));
    let [u, p] = &mut fields;
    operator.pressure(u.view(), p.view_mut())?;
    let clock = Instant::now();
    operator.pressure(u.view(), p.view_mut())?;
    Ok(clock.elapsed().as_secs_f64())
}
