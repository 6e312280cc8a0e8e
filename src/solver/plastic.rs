//! How a surface yields in a solve, and how far it has yielded.

use ndarray::Array2;

use super::iterate::Iterate;
use super::passes::count;
use super::potential::{Of, Potential};
use super::report::Plastic;
use crate::field::{CHUNK, Field, Minimum, Sums, found, read, write};
use crate::par::Parts;
use crate::real::{Real, cast};
use crate::vector::sums;

impl<T: Real> Potential<'_, T> {
    pub(crate) fn is_capped(&self) -> bool {
        self.hardness().is_some()
    }

    /// Takes from tractions the hardness, and the slopes, where the surfaces touch and a change makes them yield.
    /// Returns the energy of nodes that pass zero beyond their tangents.
    pub(crate) fn yielding<Lo: Real>(
        &self,
        first: usize,
        gaps: &[T],
        change: &[Lo],
        tractions: &mut [T],
        slopes: &mut [T],
    ) -> f64 {
        let Some(hardness) = self.hardness() else { return 0.0 };
        let caps = hardness.caps(first, gaps.len());
        // a node that stops there is beyond it by no more than its rounding
        let rounding = T::lit(4.0) * cast(Lo::epsilon());
        sums!([gaps, change, caps], [tractions, slopes], |i| {
            let (gap, change, cap): (_, T, _) = (gaps[i], cast(change[i]), caps[i]);
            let falls = (gap == T::zero()) & (change < T::zero());
            tractions[i] = if falls { tractions[i] - cap } else { tractions[i] };
            slopes[i] = if falls { T::zero() } else { slopes[i] };
            let next = gap + change;
            let passes = (gap != T::zero()) & ((next < T::zero()) != (gap < T::zero()));
            let beyond = passes & (next.abs() > rounding * gap.abs());
            if beyond { (cap * next.abs()).widen() } else { 0.0 }
        })
    }

    /// Σ H d over nodes that touch after a step d from where they yield.
    pub(crate) fn landed<Lo: Real>(&self, first: usize, gaps: &[T], step: &[Lo]) -> f64 {
        let Some(hardness) = self.hardness() else { return 0.0 };
        let caps: [T; CHUNK] = hardness.caps(first, gaps.len());
        let nodes = gaps.iter().zip(step).zip(caps);
        let landed = nodes.filter(|((gap, step), _)| **gap == T::zero() && **step > Lo::zero());
        landed.map(|((_, step), cap)| step.widen() * cap.widen()).sum()
    }
}

found! {
    /// The sums over the plastic depth.
    struct Deepened {
        /// the number of nodes that have yielded
        yielded: f64,
        depth: f64,
        /// the least of minus the depth
        deepest: Minimum,
        energy: f64,
        /// the work of the law in this solve
        pulled: f64,
    }
}

/// The plastic depth on the operator's grid and its figures, with the depth that the surface had before; nothing if
/// the wall does not yield. The energy is over all nodes of the operator's grid. Last the work that the law has done
/// at nodes that yield, below the gap of touching surfaces.
pub(super) fn yielded<T: Real, Lo: Real>(iterate: &mut Iterate<'_, T, Lo>) -> Option<(Array2<T>, Plastic, f64)> {
    let Iterate { fields, posed, .. } = iterate;
    let hardness = posed.wall().hardness()?.mean();
    let mut depth =
        posed.flat.yielded.as_ref().map_or_else(|| Field::zeros(fields.gap.dim()), |before| before.depth.clone());
    let local = posed.potential();
    let chunks = read(&fields.gap).zip(write(&mut depth));
    let total = local.run(&mut fields.reducer, chunks, |local, first, (gaps, depths)| {
        let (mut pulls, mut found) = ([T::zero(); CHUNK], Deepened::NONE);
        if !local.is_surface() {
            return found;
        }
        let caps = local.caps(first, gaps.len());
        local.law(Of::Traction, first, &[T::zero(); CHUNK][..gaps.len()], &mut pulls[..gaps.len()]);
        for (((&gap, depth), cap), &pull) in gaps.iter().zip(depths).zip(caps).zip(&pulls) {
            let deeper = (-gap).max(T::zero());
            *depth += deeper;
            let [deep, cap, pull] = [*depth, cap, pull].map(T::widen);
            found.yielded += count(deep > 0.0);
            found.depth += deep;
            found.deepest.0 = found.deepest.0.min(-deep);
            found.energy += (cap - pull) * deep;
            found.pulled += pull * deeper.widen();
        }
        found
    });
    let facing = posed.facing();
    let figures = Plastic {
        hardness,
        fraction: total.yielded / facing,
        depth_max: (-total.deepest.0).max(0.0),
        depth_mean: total.depth / facing,
        energy: posed.flat.padding * total.energy / posed.nodes(),
    };
    Some((depth.into_array(), figures, total.pulled))
}
