//! The order of a solve: its stages, and the rounds of its solution.

use std::ops::ControlFlow;

use super::descent::{Descent, End};
use super::finish::finish;
use super::minimisation::Nearness;
use super::operators::Operators;
use super::plan::{Stage, plan};
use super::posed::Posed;
use super::report::{Iteration, Solved, Status};
use super::rescue::rescue;
use super::stages::{enter, leave, update_constraint};
use super::start::{Begin, check_hardness, check_wall};
use super::tension::hold_apart;
use super::touch::touches_more;
use super::{Branch, Method, Settings};
use crate::adhesion::{AdhesionLaw, SharedLaw};
use crate::constraint::{ContactConstraint, Update};
use crate::error::{Error, Result};
use crate::problem::{Control, PressedFlat, smoothed_law};
use crate::real::Real;

/// What a solve is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Aim {
    /// The solution.
    Solution,
    /// Whether surfaces bear a load, and a state from which to go on: its error is not proved on a pressure that is computed
    /// anew, and surfaces that come apart are not held apart.
    Trial,
}

pub struct Job<'a, T: Real> {
    pub(super) aim: Aim,
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

/// Solves a problem: the stages of its plan, and then the solution in rounds of the constraint.
pub(super) fn run<T: Real, Lo: Real>(operators: &mut dyn Operators<T, Lo>, job: Job<'_, T>) -> Result<Solved<T>> {
    let Job { aim, law, given, flat, constraint, control, settings, begin, observe } = job;
    Error::positive("tolerance", settings.tolerance_in::<T>())?;
    check_wall(law, constraint.wall())?;
    let load = flat.load(control, constraint.wall())?;
    check_hardness(law, load, flat, constraint.wall())?;
    let branch = Branch::of_start(&begin, &settings, law, (load, constraint.wall()), flat)?;
    let preconditioned = settings.method == Method::Preconditioned;
    let smoothed = if preconditioned { smoothed_law(operators.state(), law) } else { None };
    let mut posed = Posed {
        aim,
        operators,
        adhesion: law,
        smoothed: smoothed.as_deref(),
        touched: None,
        spreads: false,
        touches: false,
        given,
        flat,
        constraint,
        control,
        load,
        branch,
        settings,
        stage: Stage::SOLUTION,
        nearness: Nearness::Afar,
        detached: None,
        holds: [].iter(),
        leads_on: true,
        from_full_contact: begin.is_default() && branch == Some(Branch::Unloading),
    };
    let plan = plan(posed.facts(!begin.is_default()));
    posed.holds = plan.holds.iter();
    posed.begin(plan.starts.first().copied().unwrap_or(Stage::SOLUTION));
    let touches = law.hints().touches() && !begin.is_default() && branch != Some(Branch::Unloading);
    let mut descent = Descent::new(posed, begin, touches)?;
    for stage in plan.starts {
        enter(&mut descent, stage);
        let end = descent.minimise(&mut *observe)?;
        leave(&mut descent, stage, &end)?;
        if let End::Cut(status) = end {
            return finish(descent, status);
        }
    }
    if plan.torn {
        hold_apart(&mut descent);
    }
    let status = solve(&mut descent, observe)?;
    finish(descent, status)
}

/// Finds the solution in rounds of the constraint; returns how it has ended.
fn solve<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, observe: Observer<'_>) -> Result<Status> {
    loop {
        let end = descent.minimise(&mut *observe)?;
        if rescue(descent, &end, &mut *observe)? {
            continue;
        }
        match end {
            End::Converged if touches_more(descent) => descent.iterate.posed.spreads = true,
            End::Converged => match update_constraint(descent) {
                Update::Done => return Ok(Status::Converged),
                Update::Again => {}
                Update::Failed => return Ok(Status::IterationLimit),
            },
            // in a trial: else surfaces are held apart
            End::Adrift => {
                descent.iterate.posed.detached = Some(descent.iterate.given());
                return Ok(Status::Detached);
            }
            End::Stalled => return Ok(Status::Stalled),
            End::Cut(status) => return Ok(status),
        }
    }
}
