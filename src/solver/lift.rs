//! The mean gap under a given pressure: how stiff the contacts are, and what moves when it changes.

use super::Method;
use super::state::State;
use crate::adhesion::AdhesionLaw;
use crate::constraint::ContactConstraint;
use crate::elastic::ElasticOperator;
use crate::field::{Partial, read, write};
use crate::par::IndexedParallelIterator;
use crate::problem::Control;
use crate::real::Real;

/// The stiffness of the contacts is not taken to be less than this share of that of the softest wave.
const SOFTEST: f64 = 0.1;

/// How much stiffer than the contacts the lift is taken to be, as its shape is only an estimate.
const STIFFER: f64 = 1.5;

/// The gap, in rms heights, at which a node follows the mean by 1/√2; and the least gap that counts, in units of that.
const HALF: f64 = 0.3;
const LEAST: f64 = 1e-3;

impl<T, O, L, C> State<'_, T, O, L, C>
where
    T: Real,
    O: ElasticOperator<T>,
    L: AdhesionLaw<T>,
    C: ContactConstraint<T>,
{
    /// The stiffness of the contacts against a change of the mean gap, about λ̄/h_rms for rough surfaces.
    fn contact_stiffness(&self) -> f64 {
        let external = match self.control {
            Control::MeanGap(_) => -self.multiplier(),
            Control::MeanPressure(pressure) => pressure,
        };
        (external + self.tally.traction / self.nodes()).abs() / self.problem.rms_height
    }

    /// The stiffness that long waves meet beside their own: that of the contacts. On the way from a far start under a given
    /// pressure it is not known yet.
    pub(super) fn foundation(&self) -> f64 {
        let (softest, stiffest) = self.problem.operator.stiffness_range();
        if stiffest <= 0.0 {
            return self.problem.operator.modulus() / self.problem.grid().lengths().0;
        }
        let contact = self.contact_stiffness();
        let near = self.given || self.is_gap_controlled();
        if near && contact.is_finite() { contact.clamp(SOFTEST * softest, stiffest) } else { softest }
    }

    /// Lets the mean gap follow the load, under a given pressure.
    ///
    /// Near the solution, nodes that are far apart follow the mean, and those near the edge of a contact hardly move. A
    /// uniform lift, which M makes of the mean of r', would tear all edges open. Its place in z is taken by
    /// v⟨v r'⟩/(⟨v⟩²k), with v = √(g/(g + g₀)) and k the stiffness of the contacts.
    ///
    /// On the way from a far start v = 1, and k is the geometric mean of the stiffness of the contacts, far too small for light
    /// loads, and that of the softest wave.
    pub(super) fn lift(&mut self, foundation: f64) {
        let (softest, stiffest) = self.problem.operator.stiffness_range();
        if self.is_gap_controlled() || self.settings.method != Method::Preconditioned || stiffest <= 0.0 {
            return;
        }
        let nodes = self.nodes();
        let near = self.given && self.constraint.projects();
        let stiffness = if near {
            STIFFER * foundation
        } else {
            let mean = (softest * self.contact_stiffness()).sqrt();
            if mean.is_finite() { mean.clamp(0.01 * softest, stiffest) } else { softest }
        };
        let half = HALF * self.problem.rms_height;
        let (half, least) = (T::lit(half), T::lit(LEAST * half));
        let follows = move |gap: T| if near { ((gap + least) / (gap + half)).sqrt() } else { T::one() };
        let Self { reducer, gap, residual, preconditioned, .. } = self;
        let total = reducer.run(read(gap).zip(read(residual)), |_, (gap, residual)| {
            let mut part = Partial::NONE;
            for (&gap, &r) in gap.iter().zip(residual) {
                let v = follows(gap).widen();
                part.sum[0] += r.widen();
                part.sum[1] += v;
                part.sum[2] += v * r.widen();
            }
            part
        });
        let [sum, v, product, ..] = total.sum;
        let scale = T::lit(product / v / (v / nodes) / stiffness);
        let uniform = T::lit(sum / nodes / foundation);
        if !(scale.is_finite() && uniform.is_finite()) {
            return;
        }
        reducer.run(read(gap).zip(write(preconditioned)), |_, (gap, z)| {
            z.iter_mut().zip(gap).for_each(|(z, &gap)| *z += scale * follows(gap) - uniform);
            Partial::NONE
        });
    }
}
