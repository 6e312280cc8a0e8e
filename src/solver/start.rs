//! The start of a solve: its gap, its law, and their checks.

use ndarray::{Array2, CowArray, Ix2};

use super::state::{Goal, State};
use crate::adhesion::AdhesionLaw;
use crate::error::{Error, Result};
use crate::field::{self, flat};
use crate::problem::{Control, PressedFlat};
use crate::real::Real;

/// The first trial length from a start near the solution. The residual r' then has short waves at the edges of
/// contacts, for which a whole step is too long.
const NEAR: f64 = 0.5;

impl<'a, T: Real> State<'a, T> {
    /// Treats the start as near the solution.
    pub(super) fn stays_near(&mut self) {
        (self.near, self.step_length) = (true, NEAR);
    }

    /// Refuses a law that is not finite at the gaps of the start.
    pub(super) fn check_start(&self) -> Result<()> {
        if self.energy().is_finite() && self.tally.sum_r.is_finite() {
            return Ok(());
        }
        let law = self.law;
        let mut value = [T::zero()];
        for (node, gap) in flat(&self.fields.gap).iter().enumerate() {
            let gap = gap.max(T::zero());
            for function in ["adhesive energy", "adhesive traction"] {
                match function {
                    "adhesive energy" => law.energies(node, &[gap], &mut value),
                    _ => law.tractions(node, &[gap], &mut value),
                }
                if !value[0].is_finite() {
                    return Err(Error::Law { function, gap: gap.widen(), value: value[0].widen(), expected: None });
                }
            }
        }
        Ok(())
    }

    /// Goes on with another law, whose equilibrium is the goal.
    pub(super) fn change_law(&mut self, law: &'a dyn AdhesionLaw<T>, goal: Goal) {
        (self.law, self.goal) = (law, goal);
        self.restart();
    }

    /// Goes on with the law itself from an equilibrium of the smoothed one.
    pub(super) fn sharpen(&mut self, law: &'a dyn AdhesionLaw<T>) -> Result<()> {
        self.law = law;
        if self.is_adrift() {
            // the law itself may hold a tension that the smoothed one does not
            self.fields.gap.fill(T::lit(uniform_start(law, self.flat, self.control)));
            self.refresh()?;
        }
        self.change_law(law, Goal::Solution);
        // this certificate was of the smoothed law
        self.certificate = f64::INFINITY;
        Ok(())
    }
}

/// The uniform gap from which a solve starts, if no other is given.
pub(super) fn uniform_start<T: Real>(law: &dyn AdhesionLaw<T>, flat: &PressedFlat<T>, control: Control) -> f64 {
    match control {
        Control::MeanGap(gap) => gap,
        Control::MeanPressure(_) if law.is_zero() => 2.0 * flat.rms_height,
        Control::MeanPressure(_) => 0.0,
    }
}

/// A gap that was given, as a start under a control.
pub(super) fn given_start<T: Real>(
    start: CowArray<'_, T, Ix2>,
    shape: (usize, usize),
    control: Control,
    projects: bool,
) -> Result<Array2<T>> {
    Error::shape("starting gap", start.dim(), shape)?;
    Error::all_finite("starting gap", start.view())?;
    if let Some(gap) = start.iter().find(|&&gap| projects && gap < T::zero()) {
        let requirement = "zero or positive at every node";
        return Err(Error::Value { name: "starting gap", value: gap.widen(), requirement });
    }
    let mut gap = if start.is_standard_layout() { start.into_owned() } else { start.as_standard_layout().into_owned() };
    if let Control::MeanGap(mean) = control {
        let present = field::mean(gap.view(), T::widen);
        if gap.iter().any(|&g| g < T::zero()) {
            // gaps of both signs may have hardly any mean
            gap.mapv_inplace(|g| g + T::lit(mean - present));
        } else if present > 0.0 {
            gap.mapv_inplace(|g| g * T::lit(mean / present));
        } else {
            gap.fill(T::lit(mean));
        }
    }
    Ok(gap)
}
