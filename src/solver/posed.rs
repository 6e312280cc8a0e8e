//! The problem that is posed to the driver.

use super::minimisation::Goal;
use super::operators::Operators;
use super::potential::Potential;
use super::{Branch, Method, Settings};
use crate::adhesion::AdhesionLaw;
use crate::constraint::{ContactConstraint, Wall};
use crate::error::{Error, Result};
use crate::problem::{Control, Load, PressedFlat, Window};
use crate::real::Real;

/// The mean pressure, over the rms pressure that presses the surface flat, up to which undeformed surfaces that touch
/// are the better start without adhesion on a periodic grid.
const HARDLY_PRESSED: f64 = 1e-3;

/// The energy to be minimised, and how well. A phase may change law, constraint, load and goal.
pub(super) struct Posed<'a, T, Lo> {
    pub(super) operators: &'a mut dyn Operators<T, Lo>,
    pub(super) law: &'a dyn AdhesionLaw<T>,
    pub(super) flat: &'a PressedFlat<T>,
    pub(super) constraint: &'a mut dyn ContactConstraint<T>,
    pub(super) load: Load,
    /// the control, of which the load is made, and the name of the wall
    pub(super) asked: (Control, &'static str),
    pub(super) branch: Option<Branch>,
    pub(super) settings: Settings,
    pub(super) goal: Goal,
    /// whether the present round of the constraint may lead to another one
    pub(super) leads_on: bool,
    /// whether full contact may have thrown the surfaces apart
    pub(super) from_full_contact: bool,
}

impl<'a, T: Real, Lo: Real> Posed<'a, T, Lo> {
    /// Prepares the constraint, and refuses what does not suit the grid, the load or the method.
    pub(super) fn prepare(&mut self) -> Result<()> {
        let (flat, operator) = (self.flat, self.operators.state());
        if !self.constraint.takes_slabs() {
            operator.grid().slab().alone("contact constraint")?;
        }
        let surface = flat.window.as_ref().map_or(operator.grid(), Window::held);
        self.constraint.start(surface, operator.stiffness_range().1, self.settings.tolerance_in::<T>())?;
        let unknown =
            flat.window.is_some() || self.load.stiffness() > 0.0 || self.constraint.wall().hardness().is_some();
        if self.settings.method == Method::Rey2017 && unknown {
            return Err(Error::Control {
                control: "Algorithm 3 of Rey, Anciaux and Molinari (2017)",
                reason: "it knows neither springs nor absent nodes nor a free boundary nor a hardness: take the \
                         default method",
            });
        }
        Ok(())
    }

    pub(super) fn nodes(&self) -> f64 {
        self.operators.state().grid().nodes() as f64
    }

    pub(super) fn potential(&self) -> Potential<'_, T> {
        Potential::new(self.law, &*self.constraint, self.flat.window.as_ref())
    }

    pub(super) fn projects(&self) -> bool {
        self.constraint.wall().projects()
    }

    /// Whether nothing but the law keeps the surfaces apart.
    pub(super) fn has_no_wall(&self) -> bool {
        matches!(self.constraint.wall(), Wall::None)
    }

    pub(super) fn is_gap_controlled(&self) -> bool {
        matches!(self.load, Load::Gap(_))
    }

    /// Whether the load of the wall alone hardly presses the surfaces together.
    pub(super) fn is_hardly_pressed(&self) -> bool {
        let flat = self.flat.rms_pressure();
        self.branch.is_some() && matches!(self.load, Load::Pressure(pressure) if pressure <= HARDLY_PRESSED * flat)
    }
}
