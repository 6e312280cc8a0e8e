//! The way of surfaces that adhere to no load, on which the last contacts hold each other.

use super::tension::TRIES;
use super::{Begin, Place, Solved};
use crate::degrees::FIRST_STEP;
use crate::error::Result;
use crate::problem::Control;
use crate::real::Real;

/// Takes the load of surfaces away in steps, since a single step may part contacts that hold each other. Each load is a
/// sixteenth of the load before. Returns the state under no load; none if the last contacts do not hold.
pub(crate) fn unload<T: Real>(
    mut solve: impl FnMut(Control, Begin<'_, T>) -> Result<Solved<T>>,
    load: Control,
    mut place: Place<T>,
) -> Result<Option<Solved<T>>> {
    for step in 1..=TRIES {
        let of_load = |share: f64| load.with_value(share * load.value());
        let pressed = solve(of_load(FIRST_STEP.powi(step as i32)), Begin::Found(place))?;
        if !pressed.is_settled() || pressed.solution.report.contact_nodes == 0 {
            break;
        }
        place = pressed.place();
        let released = solve(of_load(0.0), Begin::Found(place.clone()))?;
        if released.solution.report.contact_nodes > 0 {
            return Ok(Some(released));
        }
    }
    Ok(None)
}
