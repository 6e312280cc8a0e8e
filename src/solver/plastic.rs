//! How far a surface has yielded in a solve.

use ndarray::Array2;

use super::passes::count;
use super::potential::Of;
use super::report::Plastic;
use super::state::State;
use crate::field::{CHUNK, Partial, read, write};
use crate::par::Parts;
use crate::problem::Yielded;
use crate::real::Real;

impl<T: Real, Lo: Real> State<'_, T, Lo> {
    /// Whether some nodes yield in the present state.
    pub(super) fn has_yielded(&self) -> bool {
        let yields = self.posed.wall().hardness().is_some();
        // these are in contact, and free
        yields && self.sums.tally.contact + self.sums.tally.free > self.posed.nodes()
    }

    /// The plastic depth on the operator's grid and its figures, with the depth that the surface had before; nothing if
    /// the wall does not yield. The energy is over all nodes of the operator's grid. Last the work that the law has done
    /// at nodes that yield, below the gap of touching surfaces.
    pub(super) fn yielded(&mut self) -> Option<(Array2<T>, Plastic, f64)> {
        let Self { fields, posed, .. } = self;
        let hardness = posed.wall().hardness()?.mean();
        let before = posed.flat.yielded.as_ref().map(Yielded::depth);
        let mut depth = before.cloned().unwrap_or_else(|| Array2::zeros(fields.gap.dim()));
        let local = posed.potential();
        let chunks = read(&fields.gap).zip(write(&mut depth));
        let total = local.run(&mut fields.reducer, chunks, |local, first, (gaps, depths)| {
            let ([mut caps, mut pulls], mut part) = ([[T::zero(); CHUNK]; 2], Partial::NONE);
            if !local.is_surface() {
                return part;
            }
            local.hardness().into_iter().for_each(|hardness| hardness.fill(first, &mut caps[..gaps.len()], |cap| cap));
            local.law(Of::Traction, first, &[T::zero(); CHUNK][..gaps.len()], &mut pulls[..gaps.len()]);
            for (((&gap, depth), &cap), &pull) in gaps.iter().zip(depths).zip(&caps).zip(&pulls) {
                let deeper = (-gap).max(T::zero());
                *depth += deeper;
                let [deep, cap, pull] = [*depth, cap, pull].map(T::widen);
                part.min = part.min.min(-deep);
                part.sum[0] += count(deep > 0.0);
                part.sum[1] += deep;
                part.sum[2] += (cap - pull) * deep;
                part.sum[3] += pull * deeper.widen();
            }
            part
        });
        let ([yielded, sum, energy, pulled, ..], facing) = (total.sum, posed.facing());
        let figures = Plastic {
            hardness,
            fraction: yielded / facing,
            depth_max: (-total.min).max(0.0),
            depth_mean: sum / facing,
            energy: posed.flat.padding * energy / posed.nodes(),
        };
        Some((depth, figures, pulled))
    }
}
