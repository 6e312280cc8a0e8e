//! The rescues of a descent that has ended short of the solution.

use super::descent::{Descent, End};
use super::driver::{Aim, Observer};
use super::tension::{Hold, hold_apart, hold_gap, touch};
use crate::error::Result;
use crate::real::Real;

/// What may help where a descent ends: where it would stall, and where it has ended.
#[derive(Clone, Copy, Debug)]
pub(super) enum Rescue {
    /// The pressure is computed anew from the gap, as many updates may leave mostly rounding.
    Renew,
    /// Another state may hold the load of surfaces that have come apart.
    Hold(Hold),
    /// The surfaces that drift apart are held out of each other's reach.
    Part,
}

impl Rescue {
    /// The rescue of a descent that would stall.
    pub(super) fn of_stall<T: Real, Lo: Real>(descent: &Descent<'_, T, Lo>, end: &End) -> Option<Self> {
        (matches!(end, End::Stalled) && descent.may_renew()).then_some(Self::Renew)
    }

    /// The next rescue of a descent that has ended.
    fn of_end<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, end: &End) -> Option<Self> {
        let apart = !matches!(end, End::Cut(_)) && descent.proof().is_apart();
        let hold = apart.then(|| descent.iterate.posed.holds.next()).flatten();
        let parts = matches!(end, End::Adrift) && descent.iterate.posed.aim == Aim::Solution;
        hold.map(|&hold| Self::Hold(hold)).or(parts.then_some(Self::Part))
    }

    /// Rescues a descent; `false` if that was of no use.
    pub(super) fn apply<T: Real, Lo: Real>(
        self,
        descent: &mut Descent<'_, T, Lo>,
        observe: Observer<'_>,
    ) -> Result<bool> {
        match self {
            Self::Renew => descent.renew()?,
            Self::Hold(Hold::Touching) => return touch(descent, observe),
            Self::Hold(Hold::Gap) => return hold_gap(descent, observe),
            Self::Part => hold_apart(descent),
        }
        Ok(true)
    }
}

/// Rescues a descent that has ended, if that can be done: it goes on then.
pub(super) fn rescue<T: Real, Lo: Real>(
    descent: &mut Descent<'_, T, Lo>,
    end: &End,
    observe: Observer<'_>,
) -> Result<bool> {
    while let Some(rescue) = Rescue::of_end(descent, end) {
        if rescue.apply(descent, &mut *observe)? {
            return Ok(true);
        }
    }
    Ok(false)
}
