//! The adhesive sphere with concentric waves, of Guduru (2007).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::numerics::{falls_to, integral, peak};
use crate::error::{Error, Result};

/// The least number of steps in a wave, and in the radius of the smallest contact that adhesion holds.
const STEPS: f64 = 16.0;

/// The contact of a sphere with concentric waves, r²/2R + A (1 − cos kr), k = 2π/λ, with adhesion of no range.
///
/// ```math
/// F = F₁(a) − √(8πwE*a³) ,   δ = δ₁(a) − √(2πwa/E*) ,
/// F₁ = 4E*a³/3R + 2E*Ak a² ∫ sin²θ sin(ka sin θ) dθ ,   δ₁ = a²/R + Ak a ∫ sin(ka sin θ) dθ    over 0 ≤ θ ≤ π/2
/// ```
///
/// F₁ and δ₁ hold without adhesion; Guduru (2007) has them in Bessel and Struve functions. For A = 0 it is
/// [`Jkr`](super::Jkr). The contact is taken to be a disc. Where a wave makes δ fall with a, the contact
/// [jumps](Self::jumps), and dissipates energy.
///
/// ```
/// use asperity::exact::WavySphere;
/// let sphere = WavySphere::new(2.0, 1.0, 1e-6, (1e-4, 0.02))?;
/// let far = sphere.approach(0.04);
/// let (together, apart) = (sphere.jumps(-1e-3, far)?, sphere.jumps(far, -1e-3)?);
/// // where it was pressed, it sticks: the last contact is larger than the first
/// assert!(apart.last().unwrap()[0] > together[0][1]);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavySphere {
    radius: f64,
    modulus: f64,
    work_of_adhesion: f64,
    amplitude: f64,
    wave_number: f64,
}

impl WavySphere {
    /// A sphere of radius of curvature R (length) with a wave of amplitude A and wavelength λ (lengths) on a half-space
    /// of contact modulus E* (pressure), with work of adhesion w (energy per area).
    ///
    /// # Errors
    /// [`Error::Value`] if one is not positive and finite; the amplitude may be zero.
    pub fn new(radius: f64, modulus: f64, work_of_adhesion: f64, (amplitude, wavelength): (f64, f64)) -> Result<Self> {
        Error::positive("radius of curvature", radius)?;
        Error::positive("contact modulus", modulus)?;
        Error::positive("work of adhesion", work_of_adhesion)?;
        Error::non_negative("amplitude of the wave", amplitude)?;
        let wave_number = TAU / Error::positive("wavelength", wavelength)?;
        Ok(Self { radius, modulus, work_of_adhesion, amplitude, wave_number })
    }

    /// The height of the surface at the distance r from the axis.
    pub fn height(&self, r: f64) -> f64 {
        // 1 − cos x without cancellation
        -0.5 * r * r / self.radius - 2.0 * self.amplitude * (0.5 * self.wave_number * r).sin().powi(2)
    }

    /// The load F at a contact radius a, compression positive.
    pub fn load(&self, contact_radius: f64) -> f64 {
        let (a, e) = (contact_radius, self.modulus);
        let sphere = 4.0 / 3.0 * e * a.powi(3) / self.radius;
        let wave = 2.0 * e * self.amplitude * self.wave_number * a * a * self.over_angles(a, |sin| sin * sin);
        sphere + wave - (8.0 * PI * self.work_of_adhesion * e * a.powi(3)).sqrt()
    }

    /// The approach δ at a contact radius a.
    pub fn approach(&self, contact_radius: f64) -> f64 {
        let a = contact_radius;
        let wave = self.amplitude * self.wave_number * a * self.over_angles(a, |_| 1.0);
        a * a / self.radius + wave - (TAU * self.work_of_adhesion * a / self.modulus).sqrt()
    }

    /// The integral of `weight`(sin θ) sin(ka sin θ) over θ from 0 to π/2.
    fn over_angles(&self, a: f64, weight: impl Fn(f64) -> f64) -> f64 {
        let ka = self.wave_number * a;
        integral(|theta| weight(theta.sin()) * (ka * theta.sin()).sin(), 0.0, FRAC_PI_2, 48 + 3 * ka.ceil() as usize)
    }

    /// The contact radius before and after each jump, 0 without contact, as the given approach goes from one value to
    /// another. Coming together starts without contact, moving apart from the largest contact at `from`.
    ///
    /// # Errors
    /// [`Error::Value`] if an approach is not finite.
    pub fn jumps(&self, from: f64, to: f64) -> Result<Vec<[f64; 2]>> {
        Error::finite("approach", from)?;
        Error::finite("approach", to)?;
        let branches = self.branches(from.max(to));
        Ok(if to > from { self.together(&branches, from, to) } else { self.apart(&branches, from, to) })
    }

    fn together(&self, branches: &[[f64; 2]], from: f64, to: f64) -> Vec<[f64; 2]> {
        let mut jumps = Vec::new();
        // without contact the bodies touch at no approach
        let (mut radius, mut until) = (0.0, 0.0);
        for &[low, high] in branches.iter().filter(|[_, high]| self.approach(*high) > 0.0) {
            let end = self.approach(high);
            if until >= to {
                break;
            }
            if end > until {
                if until >= from {
                    jumps.push([radius, self.radius_at(until, [low, high])]);
                }
                (radius, until) = (high, end);
            }
        }
        jumps
    }

    fn apart(&self, branches: &[[f64; 2]], from: f64, to: f64) -> Vec<[f64; 2]> {
        let mut jumps = Vec::new();
        let (mut radius, mut until) = (None, from);
        for &[low, high] in branches.iter().rev().filter(|[low, _]| self.approach(*low) < from) {
            let end = self.approach(low);
            if until <= to {
                break;
            }
            if end < until {
                jumps.extend(radius.map(|radius| [radius, self.radius_at(until, [low, high])]));
                (radius, until) = (Some(low), end);
            }
        }
        jumps.extend(radius.filter(|_| until > to).map(|radius| [radius, 0.0]));
        jumps
    }

    /// The contact radius at an approach, on a branch on which the approach grows with it.
    fn radius_at(&self, approach: f64, [low, high]: [f64; 2]) -> f64 {
        falls_to(|a| -self.approach(a), -approach, low, high)
    }

    /// The radii at the ends of the branches that are stable at a given approach, up to one of more than `highest`.
    fn branches(&self, highest: f64) -> Vec<[f64; 2]> {
        let Self { radius, modulus, work_of_adhesion, amplitude, wave_number } = *self;
        let curvature = radius.recip() + amplitude * wave_number * wave_number;
        let smallest = (PI * work_of_adhesion / (8.0 * modulus * curvature * curvature)).cbrt();
        let step = smallest.min(TAU / wave_number) / STEPS;
        // the wave takes less than this of the approach
        let wave = |a: f64| amplitude * (1.0 + (FRAC_PI_2 * wave_number * a).sqrt());
        let least = |a: f64| a * a / radius - wave(a) - (TAU * work_of_adhesion * a / modulus).sqrt();
        let approach = |a: f64| self.approach(a);
        // it falls at first
        let (mut branches, mut low, mut before) = (Vec::new(), None, 0.0);
        let mut a = step;
        loop {
            let now = approach(a);
            let between = (a - 2.0 * step, a);
            match low {
                None if now > before => low = Some(peak(|a| -approach(a), between.0.max(0.0), between.1)),
                Some(start) if now < before => {
                    branches.push([start, peak(approach, between.0, between.1)]);
                    low = None;
                }
                _ => {}
            }
            if least(a) > highest {
                branches.extend(low.map(|low| [low, a]));
                return branches;
            }
            (before, a) = (now, a + step);
        }
    }
}
