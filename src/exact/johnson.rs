//! The adhesive wavy line of Johnson (1995).

use std::f64::consts::PI;

use super::numerics::{falls_to, peak};
use super::wave::{Body, WaveContact};
use super::westergaard::share;
use crate::error::{Error, Result};

/// Johnson's contact of a wave h₀ cos(2πx/λ), with the adhesion of JKR. With s = sin²(πa/λ) and p* = πE*h₀/λ:
///
/// ```math
/// p̄ = p* s − p₁ ,   ḡ = h₀ (1 − s + s ln s) − λp₁/(πE*) · ln s ,
/// p₁ = √((2E*w/λ) tan(πa/λ)) = α p* √tan(πa/λ) ,   α² = 2wλ/(π²E*h₀²)
/// ```
///
/// Johnson (1995). Under a given pressure it opens at the minimum of p̄ and jumps to full contact at its maximum; they
/// merge at α = 4 (3/8)^(3/4) (5/8)^(5/4) = 1.065, above which partial contact is unstable. Full contact is left out.
///
/// ```
/// use asperity::exact::AdhesiveWavyLine;
/// let w = 0.5 * (0.2 * std::f64::consts::PI * 0.02f64).powi(2);
/// let wave = AdhesiveWavyLine::new(0.02, 1.0, 1.0, w)?; // amplitude, wavelength, contact modulus, work of adhesion
/// assert!((wave.alpha() - 0.2).abs() < 1e-15);
/// assert!((wave.pull_off()?.mean_pressure() / wave.closing_pressure() + 0.0556).abs() < 5e-5);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdhesiveWavyLine {
    body: Body,
    work_of_adhesion: f64,
}

/// tan²(πa/λ) where the extremes of the mean pressure merge.
const MERGED: f64 = 0.6;

impl AdhesiveWavyLine {
    /// A wave of amplitude h₀ and wavelength λ (lengths) on a half-space of contact modulus E* (pressure), with work
    /// of adhesion w (energy per area).
    ///
    /// # Errors
    /// [`Error::Value`] if one is not positive and finite.
    pub fn new(amplitude: f64, wavelength: f64, modulus: f64, work_of_adhesion: f64) -> Result<Self> {
        Error::positive("work of adhesion", work_of_adhesion)?;
        Ok(Self { body: Body::new(amplitude, wavelength, modulus)?, work_of_adhesion })
    }

    /// The mean pressure p* = πE*h₀/λ that closes the contact without adhesion.
    pub fn closing_pressure(&self) -> f64 {
        self.body.closing_pressure()
    }

    /// Johnson's parameter α = √(2wλ/(π²E*h₀²)).
    pub fn alpha(&self) -> f64 {
        let Body { amplitude, wavelength, modulus } = self.body;
        (2.0 * self.work_of_adhesion * wavelength / modulus).sqrt() / (PI * amplitude)
    }

    /// The contact of half-width 0 ≤ a < λ/2, stable or not.
    ///
    /// # Errors
    /// [`Error::Value`] if the half-width is out of its range.
    pub fn at_half_width(&self, half_width: f64) -> Result<WaveContact> {
        let share = share(&self.body, half_width)?;
        if share == 0.5 {
            return Err(Error::Value {
                name: "half-width",
                value: half_width,
                requirement: "below half the wavelength",
            });
        }
        Ok(self.partial((PI * share).tan()))
    }

    /// The contact at the mean pressure p̄ that is stable under it, between the pull-off and the jump to full contact.
    ///
    /// # Errors
    /// [`Error::Value`] if the pressure is not finite or there is no such contact.
    pub fn at_mean_pressure(&self, mean_pressure: f64) -> Result<WaveContact> {
        Error::finite("mean pressure", mean_pressure)?;
        let (low, high) = self.extremes()?;
        let f = |log: f64| -self.at(log).mean_pressure();
        if -mean_pressure > f(low) || -mean_pressure < f(high) {
            let requirement = "between the pull-off and the jump to full contact";
            return Err(Error::Value { name: "mean pressure", value: mean_pressure, requirement });
        }
        Ok(self.at(falls_to(f, -mean_pressure, low, high)))
    }

    /// The contact at the mean gap ḡ > 0 that is stable under it, of the larger half-width.
    ///
    /// # Errors
    /// [`Error::Value`] if the gap is not positive and finite, or larger than in any contact.
    pub fn at_mean_gap(&self, mean_gap: f64) -> Result<WaveContact> {
        Error::positive("mean gap", mean_gap)?;
        let f = |log: f64| self.at(log).mean_gap();
        let start = peak(f, self.lowest(), 20.0);
        if mean_gap > f(start) {
            let requirement = "no more than the mean gap at which contact is lost";
            return Err(Error::Value { name: "mean gap", value: mean_gap, requirement });
        }
        Ok(self.at(falls_to(f, mean_gap, start, 300.0)))
    }

    /// The partial contact of least mean pressure, from which it opens.
    ///
    /// # Errors
    /// [`Error::Value`] if α ≥ 1.065, where there is none.
    pub fn pull_off(&self) -> Result<WaveContact> {
        Ok(self.at(self.extremes()?.0))
    }

    /// The partial contact of largest mean pressure, from which it jumps to full contact.
    ///
    /// # Errors
    /// As for [`pull_off`](Self::pull_off).
    pub fn jump_to_full_contact(&self) -> Result<WaveContact> {
        Ok(self.at(self.extremes()?.1))
    }

    fn partial(&self, tangent: f64) -> WaveContact {
        self.body.partial(tangent, self.alpha() * self.body.closing_pressure() * tangent.sqrt())
    }

    fn at(&self, log_tangent: f64) -> WaveContact {
        self.partial(log_tangent.exp())
    }

    /// ln tan(πa/λ), safely below the extremes, which go like α^(2/3).
    fn lowest(&self) -> f64 {
        self.alpha().ln().min(0.0) - 8.0
    }

    /// ln tan(πa/λ) at the extremes of p̄, where 4 t^(3/2)/(1 + t²)² = α with t the tangent.
    fn extremes(&self) -> Result<(f64, f64)> {
        let alpha = self.alpha();
        let slope = |log: f64| 4.0 * (1.5 * log).exp() / (1.0 + (2.0 * log).exp()).powi(2);
        let merged = 0.5 * MERGED.ln();
        if alpha >= slope(merged) {
            let requirement = "below 1.065 for a contact to be stable under a given pressure";
            return Err(Error::Value { name: "Johnson's parameter alpha", value: alpha, requirement });
        }
        let minimum = -falls_to(|log| slope(-log), alpha, -merged, 1e3 - merged);
        let maximum = falls_to(slope, alpha, merged, 300.0);
        Ok((minimum, maximum))
    }
}
