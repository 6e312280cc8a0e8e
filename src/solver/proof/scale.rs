//! The scale of a certified error: the energy that a certificate is compared with, and the certificate of rounding.

use super::Proof;
use crate::degrees::TWICE;
use crate::real::Real;

/// The scale of a certificate, and the floor under it, both as the mean of u·p.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Scale {
    pub(in crate::solver) energy: f64,
    /// the certificate of a gap with no error but rounding
    pub(in crate::solver) rounding: f64,
}

impl Scale {
    /// The certificate over its scale, as an error in the energy norm.
    pub(in crate::solver) fn error_of(&self, certificate: f64) -> f64 {
        let error = if certificate == 0.0 { 0.0 } else { (certificate / self.energy).sqrt() };
        if error.is_nan() { f64::INFINITY } else { error }
    }
}

impl<T: Real, Lo: Real> Proof<'_, '_, T, Lo> {
    /// The scale of an error: the energy of the waves of the displacement, or of flats where it has no waves but those that
    /// rounding makes.
    pub(in crate::solver) fn error_scale(&self) -> Scale {
        let rounding = self.rounding_of_waves();
        let (waves, flats) = (self.energy_of_waves(rounding), self.energy_of_flats());
        if waves >= flats {
            return Scale { energy: waves, rounding };
        }
        Scale { energy: flats.max(self.energy_of_held_flats()), rounding: 0.0 }
    }

    /// The certificate of a gap with no error but rounding, ε²(⟨h, K⁻¹h⟩ + ½kḡ(ḡ + h_rms)). The first term is the rounding
    /// of p = K⁻¹h + K⁻¹g where the two cancel. The second term is the rounding of the gap, which a transform spreads evenly
    /// over all waves, with k the stiffness of the shortest wave.
    fn rounding_of_waves(&self) -> f64 {
        let (epsilon, stiffest) = (T::epsilon().widen(), self.iterate.posed.stiffness_range().1);
        let mean = self.iterate.mean_gap().abs();
        epsilon
            * epsilon
            * (self.iterate.posed.flat.work + 0.5 * stiffest * mean * (mean + self.iterate.posed.flat.rms_height))
    }

    /// The energy of the waves, ⟨u, p⟩. Without contact a surface has at least ⟨h, K⁻¹h⟩. Nodes that bear their own
    /// attraction deform hardly anything: they have the energy of the deformation that it would make without contact.
    fn energy_of_waves(&self, rounding: f64) -> f64 {
        let apart = if self.iterate.tally().contact > 0.0 { 0.0 } else { self.iterate.posed.flat.work };
        let waves = self.iterate.mean_work().max(apart);
        let (adhesion, hints) = (self.attraction(), self.iterate.posed.law().hints());
        let attracts = self.iterate.mean_traction().max(adhesion) >= self.iterate.given().abs();
        if attracts && rounding > (self.tolerance() / TWICE).powi(2) * waves {
            let strongest = (hints.work_of_adhesion / hints.range).widen();
            return waves.max(adhesion * strongest / self.iterate.posed.stiffness_range().1);
        }
        waves
    }

    /// The energy that rounding leaves in flats that attract each other, or that their mean gap, or a law with gaps of its
    /// range, holds apart.
    fn energy_of_flats(&self) -> f64 {
        let (epsilon, softest, traction) =
            (T::epsilon().widen(), self.iterate.posed.stiffness_range().0, self.iterate.mean_traction());
        let lifted = match self.iterate.posed.has_no_wall() {
            true => self.iterate.mean_gap().abs().max(self.iterate.posed.law().hints().range.widen()),
            _ if self.iterate.tally().contact > 0.0 => 0.0,
            _ => self.iterate.mean_gap(),
        };
        if softest > 0.0 { epsilon * (traction * traction / softest + softest * lifted * lifted) } else { 0.0 }
    }

    /// The energy of the load, or of the traction, at single nodes of flats that the law alone holds.
    fn energy_of_held_flats(&self) -> f64 {
        let traction = self.iterate.mean_traction();
        let stiffest = self.iterate.posed.stiffness_range().1;
        if self.iterate.posed.has_no_wall() { traction.max(self.iterate.given().abs()).powi(2) / stiffest } else { 0.0 }
    }
}
