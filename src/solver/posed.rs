//! The problem that is posed to the driver.

use std::slice;

use ndarray::{CowArray, Ix2};

use super::descent::rey2017;
use super::driver::Aim;
use super::minimisation::Nearness;
use super::operators::Operators;
use super::plan::{Facts, Stage, StageLaw};
use super::potential::Potential;
use super::tension::Hold;
use super::{Branch, Method, Settings};
use crate::adhesion::{AdhesionLaw, NoAdhesion, SharedLaw, Touched};
use crate::constraint::{ContactConstraint, Projection, Wall};
use crate::degrees::HARDLY;
use crate::error::Result;
use crate::field::Field;
use crate::problem::{Control, Load, PressedFlat};
use crate::real::Real;

/// The stiffness of springs, over the stiffness of the stiffest wave, above which a solve with springs starts from a
/// rigid wall.
const STIFF: f64 = 8.0;

/// The energy to be minimised, and how well. A stage has its law, wall and tolerance, and may have a load of its own.
pub(super) struct Posed<'a, T: Real, Lo> {
    pub(super) aim: Aim,
    pub(super) operators: &'a mut dyn Operators<T, Lo>,
    /// the law itself
    pub(super) adhesion: &'a dyn AdhesionLaw<T>,
    /// the law with its jumps smoothed
    pub(super) smoothed: Option<&'a dyn AdhesionLaw<T>>,
    /// the law where surfaces attract each other next to their contacts alone
    pub(super) touched: Option<Touched<'a, T>>,
    /// whether surfaces may touch at further nodes: until then a round need not be solved to the tolerance
    pub(super) spreads: bool,
    /// the law of the problem, as it was given
    pub(super) given: &'a SharedLaw<T>,
    pub(super) flat: &'a PressedFlat<T>,
    pub(super) constraint: &'a mut dyn ContactConstraint<T>,
    pub(super) control: Control,
    pub(super) load: Load,
    pub(super) branch: Option<Branch>,
    pub(super) settings: Settings,
    pub(super) stage: Stage,
    pub(super) nearness: Nearness,
    /// the load that has pulled the surfaces apart
    pub(super) detached: Option<f64>,
    /// whether surfaces have touched where they did not attract each other
    pub(super) touches: bool,
    /// the states that may hold a load where surfaces come apart, which were not tried
    pub(super) holds: slice::Iter<'static, Hold>,
    /// whether the present round of the constraint may lead to another one
    pub(super) leads_on: bool,
    /// whether full contact may have thrown the surfaces apart
    pub(super) from_full_contact: bool,
}

impl<'a, T: Real, Lo: Real> Posed<'a, T, Lo> {
    /// Prepares the constraint, and refuses what does not suit the grid, the load or the method.
    pub(super) fn prepare(&mut self) -> Result<()> {
        let (flat, operator) = (self.flat, self.operators.state());
        let surface = flat.grid(operator.grid()).alone();
        self.constraint.start(&surface, operator.stiffness_range().1, self.settings.tolerance_in::<T>())?;
        let unknown = !flat.faces_all() || self.load.stiffness() > 0.0 || self.constraint.wall().hardness().is_some();
        if self.settings.method == Method::Rey2017 && unknown {
            return Err(rey2017::refused(
                "it knows neither springs nor absent nodes nor a free boundary nor a hardness: take the default method",
            ));
        }
        Ok(())
    }

    /// What the plan of the solve depends on, of a start that is `given` or not.
    pub(super) fn facts(&self, given: bool) -> Facts {
        Facts {
            given,
            branch: self.branch,
            jumps: self.smoothed.is_some(),
            repels: self.separation().is_some(),
            stiff: self.settings.method == Method::Preconditioned && self.nearly_rigid(),
            torn: self.is_torn(),
        }
    }

    /// Poses the first stage. The wall alone has the load that it bears.
    pub(super) fn begin(&mut self, stage: Stage) {
        self.stage = stage;
        if stage.law == StageLaw::None {
            let separation = self.separation().unwrap_or_else(T::zero);
            self.load = self.load.of_wall(separation.widen());
        }
    }

    /// The law of the present stage, where surfaces touch.
    pub(super) fn law(&self) -> &dyn AdhesionLaw<T> {
        match &self.touched {
            Some(touched) if self.stage.law != StageLaw::None => touched,
            _ => self.formula(),
        }
    }

    /// The law of the present stage, as a function of the gap.
    pub(super) fn formula(&self) -> &'a dyn AdhesionLaw<T> {
        match self.stage.law {
            StageLaw::None => &NoAdhesion,
            StageLaw::Smoothed => self.smoothed.unwrap_or(self.adhesion),
            StageLaw::Own => self.adhesion,
        }
    }

    /// The wall of the present stage.
    pub(super) fn wall(&self) -> Wall<'_, T> {
        self.present().wall()
    }

    fn present(&self) -> &dyn ContactConstraint<T> {
        if self.stage.rigid { &Projection } else { &*self.constraint }
    }

    /// Whether springs end at a rigid wall, or are so stiff that their gap is near the gap at a rigid wall.
    fn nearly_rigid(&self) -> bool {
        let Some(springs) = self.constraint.wall().springs() else { return false };
        let stiffness = springs.slope(0, self.pressed()).widen();
        self.constraint.ends_rigid() || stiffness > STIFF * self.stiffness_range().1
    }

    /// A gap of hardly any interpenetration.
    pub(super) fn pressed(&self) -> T {
        T::lit(-self.flat.rms_height) * T::epsilon()
    }

    /// The gap at which a wall stands for the repulsion of a law.
    pub(super) fn separation(&self) -> Option<T> {
        (!self.constraint.wall().keeps_apart()).then(|| self.adhesion.hints().rest.unwrap_or_else(T::zero))
    }

    /// Whether the surfaces adhere in the present stage.
    pub(super) fn adheres(&self) -> bool {
        !self.law().hints().zero
    }

    pub(super) fn nodes(&self) -> f64 {
        self.operators.state().grid().nodes() as f64
    }

    /// The least and the largest stiffness of a wave.
    pub(super) fn stiffness_range(&self) -> (f64, f64) {
        self.operators.state().stiffness_range()
    }

    /// The number of nodes that face the surface.
    pub(super) fn facing(&self) -> f64 {
        self.flat.facing(self.operators.state().grid().nodes()) as f64
    }

    pub(super) fn potential(&self) -> Potential<'_, T> {
        Potential::new(self.law(), self.present(), self.flat.window.as_ref())
    }

    pub(super) fn projects(&self) -> bool {
        self.wall().projects()
    }

    /// All of a field on the surface's grid, with a value where no surface faces the half-space.
    pub(super) fn on_surface<'f>(&self, field: &'f Field<T>, absent: T) -> CowArray<'f, T, Ix2> {
        match &self.flat.window {
            Some(window) => window.held().whole(window.cut(field, absent).into_array()),
            None => self.operators.state().grid().whole(&**field),
        }
    }

    /// Whether nothing but the law keeps the surfaces apart.
    pub(super) fn has_no_wall(&self) -> bool {
        !self.wall().keeps_apart()
    }

    pub(super) fn is_gap_controlled(&self) -> bool {
        matches!(self.load, Load::Gap(_))
    }

    /// Whether the load of the wall alone hardly presses the surfaces together: undeformed surfaces that touch are the
    /// better start then.
    pub(super) fn is_hardly_pressed(&self) -> bool {
        let flat = self.flat.rms_pressure();
        self.branch.is_some() && matches!(self.load, Load::Pressure(pressure) if pressure <= HARDLY * flat)
    }
}
