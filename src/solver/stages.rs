//! The passage from stage to stage of a solve.

use super::descent::{Descent, End};
use super::passes::Fields;
use super::plan::{Stage, StageLaw};
use super::start::{check_start, uniform_start};
use crate::constraint::Update;
use crate::error::Result;
use crate::field::{CHUNK, Field, read, write};
use crate::par::Parts;
use crate::problem::{Held, Load};
use crate::real::Real;

/// Continues with another stage, if it is another one.
pub(super) fn enter<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, stage: Stage) {
    if stage != descent.iterate.posed.stage {
        descent.iterate.posed.stage = stage;
        descent.restart();
    }
}

/// Goes over from a stage that has ended to the problem itself.
pub(super) fn leave<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, stage: Stage, end: &End) -> Result<()> {
    if stage.law == StageLaw::None {
        return leave_wall(descent);
    }
    if stage.rigid {
        soften(descent)?;
    }
    sharpen(descent, end)
}

/// Continues with adhesion, under the load. A wall that stood for the repulsion of the law leaves the surfaces as
/// far apart as the law's equilibrium separation, or a smaller mean gap that is held.
fn leave_wall<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>) -> Result<()> {
    if let Some(separation) = descent.iterate.posed.separation() {
        let control = descent.iterate.posed.control;
        let lift = if control.holds() == Held::MeanGap { separation.min(T::lit(control.value())) } else { separation };
        descent.iterate.each_gap(|gap| gap + lift);
    }
    let load =
        descent.iterate.posed.flat.load(descent.iterate.posed.control, descent.iterate.posed.constraint.wall())?;
    if descent.iterate.posed.adhesion.hints().touches() {
        if matches!(load, Load::Pressure(_)) {
            descent.iterate.close_up();
        }
        descent.iterate.posed.touch(&descent.iterate.fields.gap, None);
    }
    adhere(descent, load, Stage::SOLUTION)
}

/// Continues with adhesion under a load, from a gap without it.
pub(super) fn adhere<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, load: Load, stage: Stage) -> Result<()> {
    (descent.iterate.posed.load, descent.iterate.posed.stage) = (load, stage);
    // the contacts before are not those that adhesion makes
    descent.forget_contacts();
    descent.restart();
    descent.forget_certificate();
    check_start(&descent.iterate)
}

/// Continues with springs from the state of a rigid wall: they take over its contact pressures, or yield to them.
fn soften<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>) -> Result<()> {
    let (shift, below) = (descent.iterate.shift(), descent.iterate.posed.pressed());
    let local = descent.iterate.posed.potential();
    let Fields { reducer, gap, pressure, .. } = &mut descent.iterate.fields;
    let mut contact = Field::zeros(gap.dim());
    let fields = read(gap).zip(read(pressure)).zip(write(&mut contact));
    local.run(reducer, fields, |local, first, ((gap, pressure), contact)| {
        let mut borne = [T::zero(); CHUNK];
        borne.iter_mut().zip(pressure).for_each(|(borne, &p)| *borne = p + shift);
        local.contact_pressures(first, gap, &borne[..gap.len()], contact);
    });
    descent.iterate.posed.stage = Stage::SOLUTION;
    let pressures = descent.iterate.posed.on_surface(&contact, T::zero());
    if !descent.iterate.posed.constraint.bear(pressures.view(), descent.proof().relative_error()) {
        let local = descent.iterate.posed.potential();
        let Some(springs) = descent.iterate.posed.constraint.wall().springs() else { return Ok(()) };
        let Fields { reducer, gap, .. } = &mut descent.iterate.fields;
        local.run(reducer, write(gap).zip(read(&contact)), |_, first, (gap, contact)| {
            let nodes = gap.iter_mut().zip(contact).zip(first..).filter(|((_, pressure), _)| **pressure > T::zero());
            for ((gap, &pressure), node) in nodes {
                *gap = -(pressure + springs.traction(node, T::zero())) / springs.slope(node, below);
            }
        });
    }
    descent.iterate.count();
    descent.iterate.refresh()
}

/// Continues with the problem itself, once [`soften`] has put springs in the place of a rigid wall: the law itself takes
/// the place of the smoothed one. A given start is on a branch, which ends where the smoothed law lets go. A solve that is
/// cut short keeps its gap.
fn sharpen<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, end: &End) -> Result<()> {
    descent.iterate.posed.stage = Stage::SOLUTION;
    if descent.goes_on(end) && descent.iterate.posed.branch.is_some() && descent.proof().is_adrift() {
        // the law itself may hold this tension
        let uniform =
            uniform_start(descent.iterate.posed.adhesion, descent.iterate.posed.flat, descent.iterate.posed.load);
        descent.iterate.fields.gap.nodes_mut().fill(T::lit(uniform));
        descent.iterate.refresh()?;
    }
    descent.restart();
    // this certificate was of the smoothed law
    descent.forget_certificate();
    Ok(())
}

pub(super) fn update_constraint<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>) -> Update {
    let whole = || descent.iterate.posed.on_surface(&descent.iterate.fields.gap, T::infinity());
    let gap = descent.iterate.posed.constraint.wall().springs().map(|_| whole());
    let work = descent.proof().error_scale().energy * descent.iterate.posed.nodes();
    let outer = gap.map_or(Update::Done, |gap| descent.iterate.posed.constraint.update(gap.view(), work));
    // a constraint that is met where a round ended early has to be met by the solution
    descent.iterate.posed.leads_on = outer != Update::Done || descent.proof().start_tolerance().is_none();
    if outer == Update::Again {
        descent.restart();
    }
    if descent.iterate.posed.leads_on { outer } else { Update::Again }
}
