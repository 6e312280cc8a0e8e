//! The wavy line in contact: pressure, gap and load of one wave.

use std::f64::consts::{FRAC_PI_2, PI};

use ndarray::Array2;

use super::numerics::entropy_gap;
use crate::error::{Error, Result};
use crate::grid::Grid;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Body {
    pub(super) amplitude: f64,
    pub(super) wavelength: f64,
    pub(super) modulus: f64,
}

impl Body {
    pub(super) fn new(amplitude: f64, wavelength: f64, modulus: f64) -> Result<Self> {
        Error::positive("amplitude", amplitude)?;
        Error::positive("wavelength", wavelength)?;
        Error::positive("contact modulus", modulus)?;
        Ok(Self { amplitude, wavelength, modulus })
    }

    pub(super) fn closing_pressure(&self) -> f64 {
        PI * self.modulus * self.amplitude / self.wavelength
    }

    /// The partial contact of given tan(πa/λ): Westergaard's, less a tension of mean `tension`, singular at the edge.
    pub(super) fn partial(&self, tangent: f64, tension: f64) -> WaveContact {
        let open = tangent.hypot(1.0).recip().powi(2); // cos²
        let s = tangent.recip().hypot(1.0).recip().powi(2);
        let log_s = -(tangent * tangent).recip().ln_1p();
        let pull = self.wavelength * tension / (PI * self.modulus);
        WaveContact {
            body: *self,
            angle: tangent.atan(),
            root_s: s.sqrt(),
            tension,
            mean_pressure: self.closing_pressure() * s - tension,
            mean_gap: self.amplitude * entropy_gap(open) - if tension > 0.0 { pull * log_s } else { 0.0 },
        }
    }

    pub(super) fn full(&self, mean_pressure: f64) -> WaveContact {
        WaveContact { body: *self, angle: FRAC_PI_2, root_s: 1.0, tension: 0.0, mean_pressure, mean_gap: 0.0 }
    }
}

/// The state of a contact of a wave h₀ cos(2πx/λ), a crest at x = 0, with a half-space: with a the half-width of a
/// contact, ψ = πx/λ, ψ_a = πa/λ and s = sin²ψ_a, by Westergaard (1939) and Johnson (1995),
///
/// ```math
/// p = 2p* cos ψ √(s − sin²ψ) − p₁ cos ψ / √(s − sin²ψ) ,
/// g = 2h₀ [v √(v² − s) − s arcosh(v/√s)] + 2λp₁/(πE*) · arcosh(v/√s)
/// ```
///
/// in the contacts and, with v = |sin ψ|, in the gaps between them; p* = πE*h₀/λ, and p₁ is zero without adhesion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaveContact {
    body: Body,
    angle: f64,
    root_s: f64,
    tension: f64,
    mean_pressure: f64,
    mean_gap: f64,
}

impl WaveContact {
    /// The half-width a of a contact: λ/2 in full contact.
    pub fn half_width(&self) -> f64 {
        self.angle / PI * self.body.wavelength
    }

    /// The mean pressure p̄, compression positive.
    pub fn mean_pressure(&self) -> f64 {
        self.mean_pressure
    }

    /// The mean gap ḡ.
    pub fn mean_gap(&self) -> f64 {
        self.mean_gap
    }

    /// The pressure at x. With adhesion it falls to −∞ at the edges; there and in the gaps it is zero.
    pub fn pressure(&self, x: f64) -> f64 {
        let psi = self.folded(x);
        let closing = self.body.closing_pressure();
        if self.angle >= FRAC_PI_2 {
            return self.mean_pressure + closing * (2.0 * psi).cos();
        }
        if psi >= self.angle {
            return 0.0;
        }
        let root = ((self.angle - psi).sin() * (self.angle + psi).sin()).sqrt();
        psi.cos() * (2.0 * closing * root - if self.tension > 0.0 { self.tension / root } else { 0.0 })
    }

    /// The gap at x: zero in the contacts.
    pub fn gap(&self, x: f64) -> f64 {
        let psi = self.folded(x);
        if psi <= self.angle {
            return 0.0;
        }
        let Body { amplitude, wavelength, modulus } = self.body;
        let (v, root) = (psi.sin(), ((psi - self.angle).sin() * (psi + self.angle).sin()).sqrt());
        if self.root_s == 0.0 {
            return 2.0 * amplitude * v * v;
        }
        let angle = (root / self.root_s).asinh(); // arcosh(v/√s)
        let bare = 2.0 * amplitude * (v * root - self.root_s * self.root_s * angle).max(0.0);
        bare + 2.0 * wavelength * self.tension / (PI * modulus) * angle
    }

    /// The displacement at x in the datum of the surface, u = h + g with h = h₀ cos(2πx/λ).
    pub fn displacement(&self, x: f64) -> f64 {
        self.gap(x) + self.body.amplitude * (2.0 * self.folded(x)).cos()
    }

    /// [`WaveContact::pressure`] at the nodes of a grid, with a crest through its origin.
    pub fn pressure_field(&self, grid: &Grid) -> Array2<f64> {
        grid.sample(|x, _| self.pressure(x))
    }

    /// [`WaveContact::displacement`] at the nodes of a grid, as [`WaveContact::pressure_field`].
    pub fn displacement_field(&self, grid: &Grid) -> Array2<f64> {
        grid.sample(|x, _| self.displacement(x))
    }

    /// |ψ| in the period about the nearest crest.
    fn folded(&self, x: f64) -> f64 {
        let t = x / self.body.wavelength;
        PI * (t - t.round()).abs()
    }
}
