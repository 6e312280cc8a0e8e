//! The order of a solve: phases, rounds of the constraint, and the loop in each.

use std::ops::ControlFlow;

use super::minimisation::{Goal, Left};
use super::operators::Operators;
use super::posed::Posed;
use super::report::{Iteration, Solved, Status};
use super::start::{Begin, check_hardness, check_wall};
use super::state::State;
use super::tension::Hold;
use super::{Branch, Method, Settings};
use crate::adhesion::{AdhesionLaw, NoAdhesion, SharedLaw};
use crate::constraint::{ContactConstraint, Projection, Update, Wall};
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
    /// The iterations ran out, progress ceased, or the observer stopped it.
    Gave(Status),
}

impl End {
    pub(super) fn is_final(&self) -> Option<Status> {
        match *self {
            Self::Gave(status @ (Status::Stopped | Status::IterationLimit)) => Some(status),
            _ => None,
        }
    }
}

pub(super) fn minimise<T: Real, Lo: Real>(state: &mut State<'_, T, Lo>, observe: Observer<'_>) -> Result<End> {
    state.residual(Left::Nothing);
    loop {
        state.precondition()?;
        if state.converged() {
            state.confirm()?;
        }
        let converged = state.converged();
        if observe(&state.iteration()).is_break() {
            return Ok(End::Gave(Status::Stopped));
        }
        if converged {
            return Ok(End::Converged);
        }
        state.note_progress();
        let verdict = state.verdict();
        if verdict == Some(Status::Stalled) && state.may_renew() {
            state.renew()?;
            continue;
        }
        if let Some(status) = verdict {
            return Ok(End::Gave(status));
        }
        if state.is_adrift() {
            return Ok(End::Adrift);
        }
        let moved = state.step()?;
        if !moved && !state.may_renew() {
            return Ok(End::Gave(Status::Stalled));
        }
        if !moved {
            state.renew()?;
        }
    }
}

/// Solves a problem: from afar with the wall alone, then with the law smoothed, then with the law itself.
pub(super) fn run<T: Real, Lo: Real>(operators: &mut dyn Operators<T, Lo>, job: Job<'_, T>) -> Result<Solved<T>> {
    let Job { law, given, flat, constraint, control, settings, begin, observe } = job;
    Error::positive("tolerance", settings.tolerance_in::<T>())?;
    check_wall(law, constraint.wall())?;
    let load = flat.load(control, constraint.wall())?;
    check_hardness(law, load, flat, constraint.wall())?;
    let asked = (control, constraint.wall().name());
    let branch = Branch::of_start(&begin, &settings, law, (load, constraint.wall()), flat)?;
    let (default_start, nearness) = (begin.is_default(), begin.nearness());
    let from_afar = default_start && branch == Some(Branch::Loading);
    let smooths = settings.method == Method::Preconditioned;
    let smoothed = if smooths { smoothed_law(operators.state(), law) } else { None };

    // a wall stands for the repulsion of a law, in gaps above its equilibrium separation
    let mut rigid = Projection;
    let (wall, repelled): (&mut dyn ContactConstraint<T>, Option<&mut dyn ContactConstraint<T>>) =
        match constraint.wall() {
            Wall::None if from_afar => (&mut rigid, Some(constraint)),
            _ => (constraint, None),
        };
    let separation = repelled.as_ref().and_then(|_| law.hints().rest).unwrap_or_else(T::zero);
    let (first_law, first_load): (&dyn AdhesionLaw<T>, _) =
        if from_afar { (&NoAdhesion, load.of_wall(separation.widen())) } else { (law, load) };

    let goal = if from_afar { Goal::Wall } else { Goal::Solution };
    let posed = Posed {
        operators,
        law: first_law,
        given,
        flat,
        constraint: wall,
        load: first_load,
        asked,
        branch,
        settings,
        goal,
        leads_on: true,
        from_full_contact: default_start && branch == Some(Branch::Unloading),
    };
    let mut state = State::new(posed, begin)?;
    state.begins(nearness);
    if from_afar {
        let end = minimise(&mut state, &mut *observe)?;
        if let Some(constraint) = repelled {
            state.stand_on(constraint, separation)?;
        }
        state.adhere(law, load)?;
        if let Some(status) = end.is_final() {
            return state.finish(status);
        }
    }
    if state.posed.is_torn() {
        state.hold_apart();
    } else if let Some(smoothed) = &smoothed {
        state.change_law(&**smoothed, Goal::Start);
        let end = minimise(&mut state, &mut *observe)?;
        state.sharpen(law, branch.is_some())?;
        if let Some(status) = end.is_final() {
            return state.finish(status);
        }
    }
    // a given start is on a branch, which ends where the surfaces come apart
    let mut holds = if default_start && !from_afar { [Hold::Touching, Hold::Gap].iter() } else { [].iter() };
    loop {
        let end = minimise(&mut state, &mut *observe)?;
        if let Some(status) = end.is_final() {
            return state.finish(status);
        }
        if state.is_apart() && state.seek_hold(&mut holds, (law, smoothed.as_deref()), &mut *observe)? {
            continue;
        }
        match end {
            End::Converged => match state.update_constraint() {
                Update::Done => return state.finish(Status::Converged),
                Update::Again => {}
                Update::Failed => return state.finish(Status::IterationLimit),
            },
            End::Adrift => state.hold_apart(),
            End::Gave(status) => return state.finish(status),
        }
    }
}
