//! The order of a solve: the loop of a minimisation, and the stages and rounds that call it.

use std::ops::ControlFlow;

use super::operators::Operators;
use super::plan::{Stage, plan};
use super::posed::Posed;
use super::report::{Iteration, Solved, Status};
use super::start::{Begin, check_hardness, check_wall};
use super::state::State;
use super::{Branch, Method, Settings, rey2017};
use crate::adhesion::{AdhesionLaw, SharedLaw};
use crate::constraint::{ContactConstraint, Update};
use crate::error::{Error, Result};
use crate::problem::{Control, PressedFlat, smoothed_law};
use crate::real::Real;

pub struct Job<'a, T: Real> {
    pub(super) law: &'a dyn AdhesionLaw<T>,
    /// the law of the problem, as it was given
    pub(super) given: &'a SharedLaw<T>,
    pub(super) flat: &'a PressedFlat<T>,
    pub(super) constraint: &'a mut dyn ContactConstraint<T>,
    pub(super) control: Control,
    pub(super) settings: Settings,
    pub(super) begin: Begin<'a, T>,
    pub(super) observe: Observer<'a>,
}

/// The observer of iterations, which may stop the solve.
pub(crate) type Observer<'a> = &'a mut (dyn FnMut(&Iteration) -> ControlFlow<()> + Send);

/// The end of a minimisation.
pub(super) enum End {
    Converged,
    /// A tensile load has pulled the surfaces apart.
    Adrift,
    /// Progress ceased.
    Stalled,
    /// The iterations ran out, or the observer stopped the solve.
    Cut(Status),
}

/// Minimises the energy of the present stage by the method of the settings.
pub(super) fn minimise<T: Real, Lo: Real>(state: &mut State<'_, T, Lo>, observe: Observer<'_>) -> Result<End> {
    match state.posed.settings.method {
        Method::Preconditioned => descend(state, observe),
        Method::Rey2017 => rey2017::descend(state, observe),
    }
}

fn descend<T: Real, Lo: Real>(state: &mut State<'_, T, Lo>, observe: Observer<'_>) -> Result<End> {
    state.residual();
    loop {
        state.certify()?;
        if let Some(end) = state.check_end(observe)? {
            return Ok(end);
        }
        state.note_progress();
        let verdict = state.verdict(state.patience().1);
        if matches!(verdict, Some(End::Stalled)) && state.may_renew() {
            state.renew()?;
            continue;
        }
        if let Some(end) = verdict {
            return Ok(end);
        }
        if state.is_adrift() {
            return Ok(End::Adrift);
        }
        let contact = state.sums.tally.contact;
        let moved = state.step()?;
        if !moved && !state.may_renew() {
            return Ok(End::Stalled);
        }
        if !moved {
            state.renew()?;
        }
        state.follow_contacts(contact);
    }
}

/// Solves a problem: the stages of its plan, and then the solution in rounds of the constraint.
pub(super) fn run<T: Real, Lo: Real>(operators: &mut dyn Operators<T, Lo>, job: Job<'_, T>) -> Result<Solved<T>> {
    let Job { law, given, flat, constraint, control, settings, begin, observe } = job;
    Error::positive("tolerance", settings.tolerance_in::<T>())?;
    check_wall(law, constraint.wall())?;
    let load = flat.load(control, constraint.wall())?;
    check_hardness(law, load, flat, constraint.wall())?;
    let branch = Branch::of_start(&begin, &settings, law, (load, constraint.wall()), flat)?;
    let preconditioned = settings.method == Method::Preconditioned;
    let smoothed = if preconditioned { smoothed_law(operators.state(), law) } else { None };
    let mut posed = Posed {
        operators,
        adhesion: law,
        smoothed: smoothed.as_deref(),
        touched: None,
        spreads: false,
        given,
        flat,
        constraint,
        control,
        load,
        branch,
        settings,
        stage: Stage::SOLUTION,
        holds: [].iter(),
        leads_on: true,
        from_full_contact: begin.is_default() && branch == Some(Branch::Unloading),
    };
    let plan = plan(posed.facts(!begin.is_default()));
    posed.holds = plan.holds.iter();
    posed.begin(plan.starts.first().copied().unwrap_or(Stage::SOLUTION));
    let touches = law.hints().touches() && !begin.is_default() && branch != Some(Branch::Unloading);
    let mut state = State::new(posed, begin, touches)?;
    for stage in plan.starts {
        state.enter(stage);
        let end = minimise(&mut state, &mut *observe)?;
        state.leave(stage)?;
        if let End::Cut(status) = end {
            return state.finish(status);
        }
    }
    if plan.torn {
        state.hold_apart();
    }
    loop {
        let end = minimise(&mut state, &mut *observe)?;
        if !matches!(end, End::Cut(_)) && state.is_apart() && state.seek_hold(&mut *observe)? {
            continue;
        }
        match end {
            End::Converged if state.touches_more() => state.posed.spreads = true,
            End::Converged if std::mem::take(&mut state.posed.spreads) => state.restart(),
            End::Converged => match state.update_constraint() {
                Update::Done => return state.finish(Status::Converged),
                Update::Again => {}
                Update::Failed => return state.finish(Status::IterationLimit),
            },
            End::Adrift => state.hold_apart(),
            End::Stalled => return state.finish(Status::Stalled),
            End::Cut(status) => return state.finish(status),
        }
    }
}
