//! The accuracy that is asked for, and its plan.

use asperity::accuracy::{Accuracy, Plan, Quantity};
use asperity::stability::ContactStiffness;
use asperity::{AdhesionLaw, Control, ElasticOperator, Real, Result, Solver, Surface};
use asperity_maps::io::available_memory;
use ndarray::Array2;

use crate::clock::Instant;
use crate::elastic::Elastic;
use crate::wall::Constraint;

/// The bytes of a GiB.
pub(crate) const GIB: f64 = 1_073_741_824.0;

/// The accuracy that is asked for, from which tolerance and grid follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// The relative error that is wanted, between 0 and 1.
    pub accuracy: f64,
    /// The quantity that has it.
    pub of: Quantity,
    /// The memory that it may take, in GiB; all that is free if none is given.
    pub memory: Option<f64>,
}

impl Goal {
    /// The accuracy, with the contact stiffness if that is asked for.
    pub fn wanted(&self, stiffness: bool) -> Accuracy {
        let mut wanted = Accuracy::new(self.accuracy, self.of);
        wanted.memory = self.memory.map_or_else(available_memory, |memory| memory * GIB);
        wanted.nested.stiffness = stiffness.then_some(ContactStiffness::TOLERANCE);
        wanted
    }
}

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
