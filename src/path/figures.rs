//! The figures of a state in the balance of energy, and the quantity that is held.

use crate::solver::{Plastic, Report};

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum Mode {
    /// the position
    #[default]
    Gap,
    Pressure,
    /// the rest of a spring of this compliance, length per mean pressure
    Spring(f64),
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Figures {
    /// what the load works on: the mean gap, or with a free boundary minus the approach
    pub(super) position: f64,
    /// the position at which the spring is relaxed, if there is one
    pub(super) rest: f64,
    pub(super) gap: f64,
    pub(super) pressure: f64,
    /// elastic and adhesive, and that dissipated by yielding
    pub(super) energy: f64,
    pub(super) contact: f64,
}

impl Figures {
    pub(super) fn of(report: &Report) -> Self {
        // to the surface as it was made
        let Plastic { depth_mean, energy, .. } = report.plastic.unwrap_or_default();
        let gap = report.mean_gap - depth_mean;
        let position = report.approach.map_or(gap, |approach| -approach);
        Self {
            position,
            rest: position,
            gap,
            pressure: report.mean_pressure,
            energy: report.elastic_energy + report.adhesive_energy + energy,
            contact: report.contact_fraction,
        }
    }

    /// The held quantity, and the derivative of the potential by it.
    pub(super) fn slope(&self, mode: Mode) -> (f64, f64) {
        match mode {
            Mode::Gap => (self.position, -self.pressure),
            Mode::Pressure => (self.pressure, self.position),
            Mode::Spring(_) => (self.rest, -self.pressure),
        }
    }

    /// The potential, which is at a minimum in equilibrium.
    pub(super) fn potential(&self, mode: Mode) -> f64 {
        match mode {
            Mode::Gap => self.energy,
            Mode::Pressure => self.energy + self.pressure * self.position,
            Mode::Spring(compliance) => self.energy + 0.5 * compliance * self.pressure.powi(2),
        }
    }

    pub(super) fn held_by(self, mode: Mode) -> Self {
        let length = if let Mode::Spring(compliance) = mode { compliance * self.pressure } else { 0.0 };
        Self { rest: self.position - length, ..self }
    }
}
