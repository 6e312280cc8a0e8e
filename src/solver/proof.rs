//! The proof of an iterate: how far it is from the solution, and whether the surfaces are apart.

use super::Criterion;
use super::iterate::{Iterate, SCALED};
use crate::degrees::{ROUGHLY, ROUNDINGS, TWICE};
use crate::problem::Load;
use crate::real::Real;

mod apart;
mod scale;

use scale::Scale;

/// An iterate with the mean of r'·K r', which is infinite as long as it is not known.
pub(super) struct Proof<'i, 'a, T: Real, Lo> {
    iterate: &'i Iterate<'a, T, Lo>,
    certificate: f64,
}

impl<'i, 'a, T: Real, Lo: Real> Proof<'i, 'a, T, Lo> {
    pub(super) fn of(iterate: &'i Iterate<'a, T, Lo>, certificate: f64) -> Self {
        Self { iterate, certificate }
    }

    /// The certified relative error in the energy norm, √(certificate/⟨u, p⟩), and at least the error by rounding.
    pub(super) fn relative_error(&self) -> f64 {
        let scale = self.error_scale();
        // where every node is in contact no gap is wrong
        let exact = self.certificate == 0.0 && self.iterate.sums_of_residual().working == 0.0;
        scale.error_of(if exact { 0.0 } else { self.certificate.max(scale.rounding) })
    }

    /// The mean traction that has the energy of adhesion over its range; zero without adhesion.
    pub(super) fn attraction(&self) -> f64 {
        let range = self.iterate.posed.law().hints().range.widen();
        let stored = -self.iterate.tally().adhesive / self.iterate.posed.nodes();
        if stored > 0.0 && range > 0.0 { stored / range } else { 0.0 }
    }

    pub(super) fn tolerance(&self) -> f64 {
        self.iterate.posed.settings.tolerance_in::<T>()
    }

    pub(super) fn is_at_floor(&self) -> bool {
        let Scale { energy, rounding } = self.error_scale();
        let floor = (rounding / energy).sqrt();
        self.certificate <= TWICE * TWICE * rounding && self.load_error() <= TWICE * floor
    }

    /// The error of the load. Without contact the mean of r is the load that adhesion lacks.
    pub(super) fn load_error(&self) -> f64 {
        match (self.iterate.posed.load, self.iterate.tally().free) {
            (Load::Gap(gap), _) => self.gap_error(gap),
            // contact everywhere: in balance, unless it is under tension somewhere
            (_, 0.0) => self.share_of_load((-self.iterate.tally().min_r.0).max(0.0)),
            _ => self.share_of_load(self.iterate.imbalance()),
        }
    }

    /// The distance of the mean gap from a held mean gap, beyond rounding, as a share of the held gap; where the law
    /// alone keeps the surfaces apart, and mean gaps may be nearly zero, as a share of the range.
    fn gap_error(&self, held: f64) -> f64 {
        let off = (self.iterate.mean_gap() - held).abs();
        let rounding = SCALED * T::epsilon().widen() * (held.abs() + self.iterate.posed.flat.rms_height);
        let range = if self.iterate.posed.has_no_wall() { self.iterate.posed.law().hints().range.widen() } else { 0.0 };
        if off <= rounding { 0.0 } else { off / held.abs().max(range) }
    }

    /// A pressure as a share of the larger of |p̄| and the mean contact pressure.
    pub(super) fn share_of_load(&self, pressure: f64) -> f64 {
        let contact = self.iterate.given() + self.iterate.mean_traction();
        // a relaxed spring carries only the rounding of its length, and surfaces apart under no load the rounding of
        // K⁻¹h
        let lengths = self.iterate.mean_gap().abs() + self.iterate.posed.load.rest().abs();
        let unloaded = self.iterate.given() == 0.0 && self.iterate.tally().contact == 0.0;
        let of_surface = if unloaded { self.iterate.posed.flat.rms_pressure() } else { 0.0 };
        let rounding = ROUNDINGS * T::epsilon().widen() * (self.iterate.posed.load.stiffness() * lengths + of_surface);
        // flats at rest have neither load nor traction
        let adhesion = if self.iterate.given() == 0.0 { self.attraction() } else { 0.0 };
        let scale = self.iterate.given().abs().max(contact.abs()).max(adhesion);
        if pressure.abs() <= rounding { 0.0 } else { pressure.abs() / scale }
    }

    pub(super) fn converged(&self) -> bool {
        self.meets(self.load_error())
    }

    /// Whether the goal is reached, given the relative error of the load.
    pub(super) fn meets(&self, load_error: f64) -> bool {
        if let Some(tolerance) = self.start_tolerance() {
            return self.relative_error() <= tolerance && load_error <= tolerance;
        }
        let tolerance = self.tolerance();
        self.measure() <= tolerance && load_error <= tolerance
    }

    /// The tolerance of a state from which a minimisation of another energy continues; none of the solution.
    pub(super) fn start_tolerance(&self) -> Option<f64> {
        let tolerance = self.tolerance();
        match self.iterate.posed.stage.tolerance {
            Some(start) => Some(start.max(tolerance)),
            None if self.iterate.posed.spreads => Some(ROUGHLY.max(tolerance)),
            None if self.iterate.posed.leads_on => {
                Some(self.iterate.posed.constraint.round_tolerance()).filter(|&round| round > tolerance)
            }
            None => None,
        }
    }

    /// The measure that has to fall below the tolerance.
    pub(super) fn measure(&self) -> f64 {
        match self.iterate.posed.settings.criterion {
            Criterion::EnergyNorm => self.relative_error(),
            Criterion::Complementarity if self.iterate.sums_of_residual().working > self.iterate.tally().free => {
                f64::INFINITY
            }
            Criterion::Complementarity => self.scaled_complementarity(),
        }
    }

    pub(super) fn scaled_complementarity(&self) -> f64 {
        let (lx, ly) = self.iterate.posed.operators.state().grid().lengths();
        self.iterate.sums_of_residual().complementarity
            / (self.iterate.posed.operators.state().modulus() * (lx * ly).sqrt())
    }
}
