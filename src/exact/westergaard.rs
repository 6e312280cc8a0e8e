//! The wavy line of Westergaard (1939), without adhesion.

use std::f64::consts::{PI, SQRT_2};

use super::numerics::falls_to;
use super::wave::{Body, WaveContact};
use crate::error::{Error, Result};

/// Westergaard's contact of a wave h₀ cos(2πx/λ), without adhesion. With s = sin²(πa/λ) and p* = πE*h₀/λ:
///
/// ```math
/// p̄ = p* s ,   ḡ = h₀ (1 − s + s ln s)
/// ```
///
/// Westergaard (1939); the fields are in [`WaveContact`].
///
/// ```
/// use asperity::exact::WavyLine;
/// let wave = WavyLine::new(0.02, 1.0, 1.0)?; // amplitude, wavelength, contact modulus
/// let half = wave.at_mean_pressure(0.5 * wave.closing_pressure())?;
/// assert!((half.half_width() - 0.25).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavyLine {
    body: Body,
}

impl WavyLine {
    /// A wave of amplitude h₀ and wavelength λ (lengths) on a half-space of contact modulus E* (pressure).
    ///
    /// # Errors
    /// [`Error::Value`] if one is not positive and finite.
    pub fn new(amplitude: f64, wavelength: f64, modulus: f64) -> Result<Self> {
        Ok(Self { body: Body::new(amplitude, wavelength, modulus)? })
    }

    /// The mean pressure p* = πE*h₀/λ at which the contact closes.
    pub fn closing_pressure(&self) -> f64 {
        self.body.closing_pressure()
    }

    /// The contact of half-width 0 ≤ a ≤ λ/2.
    ///
    /// # Errors
    /// [`Error::Value`] if the half-width is out of its range.
    pub fn at_half_width(&self, half_width: f64) -> Result<WaveContact> {
        let share = share(&self.body, half_width)?;
        Ok(if share == 0.5 {
            self.body.full(self.closing_pressure())
        } else {
            self.body.partial((PI * share).tan(), 0.0)
        })
    }

    /// The contact at the mean pressure p̄ ≥ 0; full contact from p* on.
    ///
    /// # Errors
    /// [`Error::Value`] if the pressure is negative or not finite.
    pub fn at_mean_pressure(&self, mean_pressure: f64) -> Result<WaveContact> {
        Error::non_negative("mean pressure", mean_pressure)?;
        let closing = self.closing_pressure();
        if mean_pressure >= closing {
            return Ok(self.body.full(mean_pressure));
        }
        Ok(self.body.partial((mean_pressure / (closing - mean_pressure)).sqrt(), 0.0))
    }

    /// The contact at the mean gap 0 ≤ ḡ ≤ h₀; at ḡ = 0 under p*, the least pressure that closes it.
    ///
    /// # Errors
    /// [`Error::Value`] if the gap is out of its range.
    pub fn at_mean_gap(&self, mean_gap: f64) -> Result<WaveContact> {
        if !(0.0..=self.body.amplitude).contains(&mean_gap) {
            let requirement = "from 0 to the amplitude";
            return Err(Error::Value { name: "mean gap", value: mean_gap, requirement });
        }
        if mean_gap == 0.0 {
            return Ok(self.body.full(self.closing_pressure()));
        }
        if mean_gap == self.body.amplitude {
            return Ok(self.body.partial(0.0, 0.0));
        }
        let at = |log: f64| self.body.partial(log.exp(), 0.0);
        Ok(at(falls_to(|log| at(log).mean_gap(), mean_gap, -300.0, 300.0)))
    }
}

pub(super) fn share(body: &Body, half_width: f64) -> Result<f64> {
    let share = half_width / body.wavelength;
    if (0.0..=0.5).contains(&share) {
        return Ok(share);
    }
    Err(Error::Value { name: "half-width", value: half_width, requirement: "from 0 to half the wavelength" })
}

/// The mean pressure √2πE\*h₀/λ that closes a wave h₀ cos(2πx/λ) cos(2πy/λ), without adhesion: full contact is under
/// p̄ + √2πE\*h₀/λ cos cos.
///
/// # Errors
/// [`Error::Value`] if a number is not positive and finite.
///
/// ```
/// let closing = asperity::exact::closing_pressure_2d(0.01, 1.0, 1.0)?; // amplitude, wavelength, contact modulus
/// assert!((closing - 0.0444288).abs() < 1e-7);
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn closing_pressure_2d(amplitude: f64, wavelength: f64, modulus: f64) -> Result<f64> {
    Ok(SQRT_2 * Body::new(amplitude, wavelength, modulus)?.closing_pressure())
}
