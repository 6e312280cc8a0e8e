use super::potential::{Buffer, Of, Potential};
use crate::adhesion::AdhesionLaw;
use crate::constraint::ContactConstraint;
use crate::field::Partial;
use crate::real::Real;

/// Sums over the nodes, of a gap and its pressure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tally {
    /// how many nodes are not held by the constraint
    pub(super) free: f64,
    /// Σ r over these
    pub(super) sum_r: f64,
    /// the least r over all
    pub(super) min_r: f64,
    pub(super) sum_gap: f64,
    /// Σ g·(p + K⁻¹h), which with Σ h·K⁻¹h makes Σ u·p
    pub(super) work: f64,
    /// Σ φ of the law
    pub(super) adhesive: f64,
    /// Σ φ' of the law
    pub(super) traction: f64,
    /// Σ of the constraint's energy
    pub(super) penalty: f64,
    /// how many nodes have no gap
    pub(super) contact: f64,
}

impl Tally {
    pub(super) fn new(total: &Partial) -> Self {
        let [free, sum_r, sum_gap, work, adhesive, traction, penalty, contact, _] = total.sum;
        Self { free, sum_r, min_r: total.min, sum_gap, work, adhesive, traction, penalty, contact }
    }
}

/// The part of a [`Tally`] that a chunk of nodes gives; `tractions` are those of its gaps, of law and constraint.
pub(super) fn tally<T: Real, L: AdhesionLaw<T>, C: ContactConstraint<T>>(
    potential: &Potential<'_, L, C>,
    offset: T,
    first: usize,
    (gaps, pressures, surface): (&[T], &[T], &[T]),
    tractions: &[T],
    buffer: &mut Buffer<T>,
) -> Partial {
    let projects = potential.constraint.projects();
    let [mut free, mut sum_r, mut sum_gap, mut work, mut contact] = [0.0; 5];
    let mut min = f64::INFINITY;
    for (i, ((&gap, &pressure), &surface)) in gaps.iter().zip(pressures).zip(surface).enumerate() {
        let r = (pressure + offset + if tractions.is_empty() { T::zero() } else { tractions[i] }).widen();
        let touches =
            if projects { gap <= T::zero() } else { potential.constraint.traction(first + i, gap) < T::zero() };
        if !(touches && projects) {
            free += 1.0;
            sum_r += r;
        }
        contact += f64::from(u8::from(touches));
        min = min.min(r);
        sum_gap += gap.widen();
        work += gap.widen() * (pressure.widen() + surface.widen());
    }
    let [mut adhesive, mut traction, mut penalty] = [0.0; 3];
    if !potential.law.is_zero() {
        let out = &mut buffer[..gaps.len()];
        potential.law(Of::Energy, gaps, out);
        adhesive = out.iter().map(|e| e.widen()).sum();
        let tractions = if projects {
            tractions
        } else {
            potential.law(Of::Traction, gaps, out);
            out
        };
        traction = tractions.iter().map(|t| t.widen()).sum();
    }
    if !projects {
        penalty = gaps.iter().enumerate().map(|(i, &gap)| potential.constraint.energy(first + i, gap).widen()).sum();
    }
    Partial { sum: [free, sum_r, sum_gap, work, adhesive, traction, penalty, contact, 0.0], min }
}
