//! The order of a solve: a start with the jumps of the law smoothed, rounds of the constraint, and the loop within
//! each.

use std::marker::PhantomData;
use std::ops::ControlFlow;

use super::minimisation::Goal;
use super::operators::{One, Operators, Two};
use super::report::{Iteration, Solved, Status};
use super::start::{Begin, check_wall};
use super::state::State;
use super::{Branch, Method, Settings};
use crate::adhesion::{AdhesionLaw, Discretisation, NoAdhesion};
use crate::constraint::{ContactConstraint, Projection, Update, Wall};
use crate::elastic::ElasticOperator;
use crate::error::{Error, Result};
use crate::par;
use crate::problem::{Control, Load, PressedFlat, smoothed_law};
use crate::real::{Compiled, Real};

/// The input of a solve, but for the operator.
pub(super) struct Job<'a, T> {
    pub(super) law: &'a dyn AdhesionLaw<T>,
    pub(super) flat: &'a PressedFlat<T>,
    pub(super) constraint: &'a mut dyn ContactConstraint<T>,
    pub(super) control: Control,
    pub(super) settings: Settings,
    pub(super) begin: Begin<'a, T>,
    pub(super) observe: Observer<'a>,
}

/// A mean pressure that is nothing beside the rounding of corrections in `f32`, over the rms pressure that presses the
/// surface flat.
const LIGHT: f64 = 1e-8;

impl<T: Real> Job<'_, T> {
    /// Whether the load is so light that corrections in `f32` would not find the first contact.
    fn is_light(&self) -> bool {
        let flat = self.flat.stiffness * self.flat.rms_height;
        let load = self.flat.load(self.control, self.constraint.wall());
        matches!(load, Ok(Load::Pressure(pressure)) if pressure.abs() < LIGHT * flat)
    }

    /// Whether the law itself keeps the surfaces apart: its slopes make much of the rounding of corrections.
    fn has_no_wall(&self) -> bool {
        matches!(self.constraint.wall(), Wall::None)
    }
}

/// The observer, called in every iteration, which may stop the solve.
pub(crate) type Observer<'a> = &'a mut (dyn FnMut(&Iteration) -> ControlFlow<()> + Send);

/// The end of a minimisation.
pub(super) enum End {
    /// The criterion is met.
    Converged,
    /// A tensile load has pulled the surfaces apart.
    Adrift,
    /// The iterations ran out, progress ceased, or the observer stopped it.
    Gave(Status),
}

/// Solves a problem, compiled once for each precision.
pub(super) fn solve<'a, T: Real>(operator: &'a mut dyn ElasticOperator<T>, job: Job<'a, T>) -> Result<Solved<T>> {
    par::within(|| T::call::<Solve<'a>>((operator, job)))
}

struct Solve<'a>(PhantomData<&'a ()>);

impl<'a> Compiled for Solve<'a> {
    type Input<T: Real> = (&'a mut dyn ElasticOperator<T>, Job<'a, T>);
    type Output<T: Real> = Result<Solved<T>>;
    fn single((operator, job): Self::Input<f32>) -> Result<Solved<f32>> {
        run(&mut One(operator), job)
    }
    fn double((operator, job): Self::Input<f64>) -> Result<Solved<f64>> {
        let two = job.settings.method == Method::Preconditioned && !job.is_light() && !job.has_no_wall();
        match operator.abilities().in_single().filter(|_| two) {
            Some(corrections) => run(&mut Two::new(operator, corrections), job),
            None => run(&mut One(operator), job),
        }
    }
}

fn run<T: Real, L: Real>(operators: &mut dyn Operators<T, L>, job: Job<'_, T>) -> Result<Solved<T>> {
    let Job { law, flat, constraint, control, settings, begin, observe } = job;
    let held = flat.window.as_ref().and_then(|window| law.adapted(Discretisation::Rows(*window.held())));
    let law = held.as_deref().unwrap_or(law);
    Error::positive("tolerance", settings.tolerance_in::<T>())?;
    check_wall(law, constraint.wall())?;
    let load = flat.load(control, constraint.wall())?;
    let (default_start, near) = (begin.is_default(), begin.is_near());
    let branch = Branch::of_start(&begin, &settings, law, (load, constraint.wall()), flat)?;
    let comes_from_afar = default_start && branch == Some(Branch::Loading);
    let smooth = (near || default_start) && settings.method == Method::Preconditioned;
    let smoothed = if smooth { smoothed_law(operators.state(), law) } else { None };
    let (mut rigid, mut repelled): (_, Option<(&mut dyn ContactConstraint<T>, f64)>) = (Projection, None);
    let (first, wall): (&dyn AdhesionLaw<T>, &mut dyn ContactConstraint<T>) = match constraint.wall() {
        Wall::None if comes_from_afar => {
            repelled = Some((&mut *constraint, law.hints().rest.map_or(0.0, T::widen)));
            (&NoAdhesion, &mut rigid)
        }
        _ if comes_from_afar => (&NoAdhesion, constraint),
        _ => (law, constraint),
    };
    let separation = repelled.as_ref().map_or(0.0, |(_, separation)| *separation);
    let first_load = if comes_from_afar { load.of_wall(separation) } else { load };
    let mut state = State::new(operators, first, flat, wall, (first_load, branch), begin, settings)?;
    if near {
        state.stays_near();
    }
    if comes_from_afar {
        state.goal = Goal::Wall;
        let end = minimise(&mut state, &mut *observe)?;
        state.adhere(law, load, repelled)?;
        if let End::Gave(status @ (Status::Stopped | Status::IterationLimit)) = end {
            return state.finish(status);
        }
    }
    let torn = state.is_torn();
    if torn {
        state.hold_apart();
    }
    if let Some(smoothed) = smoothed.as_ref().filter(|_| !torn) {
        state.change_law(&**smoothed, Goal::Start);
        let end = minimise(&mut state, &mut *observe)?;
        state.sharpen(law)?;
        if let End::Gave(status @ (Status::Stopped | Status::IterationLimit)) = end {
            return state.finish(status);
        }
    }
    // a given start is on a branch, which ends where the surfaces come apart
    let mut seek = default_start && !comes_from_afar;
    let status = loop {
        match minimise(&mut state, &mut *observe)? {
            End::Converged => match state.update_constraint() {
                Update::Done => break Status::Converged,
                Update::Again => {}
                Update::Failed => break Status::IterationLimit,
            },
            End::Adrift => {
                if !(std::mem::take(&mut seek) && state.seek_hold(&mut *observe)?) {
                    state.hold_apart();
                }
            }
            End::Gave(status) => break status,
        }
    };
    state.finish(status)
}

/// Minimises the energy with the present law, control and multipliers.
pub(super) fn minimise<T: Real, L: Real>(state: &mut State<'_, T, L>, observe: Observer<'_>) -> Result<End> {
    loop {
        state.residual();
        state.precondition()?;
        let converged = state.converged() && state.confirm()?;
        if observe(&state.iteration()).is_break() {
            return Ok(End::Gave(Status::Stopped));
        }
        if converged {
            return Ok(End::Converged);
        }
        match state.verdict() {
            Some(Status::Stalled) if state.renew()? => continue,
            Some(status) => return Ok(End::Gave(status)),
            None => {}
        }
        if state.is_adrift() {
            return Ok(End::Adrift);
        }
        if !state.step()? && !state.renew()? {
            return Ok(End::Gave(Status::Stalled));
        }
    }
}
