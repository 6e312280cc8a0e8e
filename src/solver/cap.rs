//! The cap on the contact pressure where a surface yields at a hardness, as the passes take it.

use super::potential::{Of, Potential};
use crate::constraint::Hardness;
use crate::field::CHUNK;
use crate::real::{Real, cast};
use crate::vector::{sums, vectors};

/// The cap on the contact pressure at a node, or none: passes are compiled for either.
pub(crate) trait Cap<T>: Copy {
    const CAPPED: bool;
    fn at(self) -> T;
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Uncapped;

impl<T: Real> Cap<T> for Uncapped {
    const CAPPED: bool = false;
    #[inline(always)]
    fn at(self) -> T {
        T::infinity()
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Capped<T>(pub(crate) T);

impl<T: Real> Cap<T> for Capped<T> {
    const CAPPED: bool = true;
    #[inline(always)]
    fn at(self) -> T {
        self.0
    }
}

/// Calls a pass over `count` nodes with their caps, compiled with caps and without.
macro_rules! with_caps {
    ($local:expr, $first:expr, $count:expr, |$caps:ident| $pass:expr) => {
        if $local.is_capped() {
            let mut caps = [Capped(T::zero()); CHUNK];
            let $caps = $local.caps($first, &mut caps[..$count]);
            $pass
        } else {
            let $caps = &[Uncapped; CHUNK][..$count];
            $pass
        }
    };
}
pub(crate) use with_caps;

impl<T: Real> Potential<'_, T> {
    pub(crate) fn is_capped(&self) -> bool {
        self.hardness().is_some()
    }

    /// The caps on the contact pressure at nodes from `first` on, without bound if there are none.
    pub(crate) fn caps<'b>(&self, first: usize, caps: &'b mut [Capped<T>]) -> &'b [Capped<T>] {
        match self.hardness() {
            Some(hardness) => hardness.fill(first, caps, Capped),
            None => caps.fill(Capped(T::infinity())),
        }
        caps
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
        if !self.is_capped() {
            return 0.0;
        }
        let mut caps = [Capped(T::zero()); CHUNK];
        let caps = self.caps(first, &mut caps[..gaps.len()]);
        // a node that stops there is beyond it by no more than its rounding
        let rounding = T::lit(4.0) * cast(Lo::epsilon());
        sums!(1, [gaps, change, caps], [tractions, slopes], |i| {
            let (gap, change, cap): (_, T, _) = (gaps[i], cast(change[i]), caps[i].at());
            let falls = (gap == T::zero()) & (change < T::zero());
            tractions[i] = if falls { tractions[i] - cap } else { tractions[i] };
            slopes[i] = if falls { T::zero() } else { slopes[i] };
            let next = gap + change;
            let passes = (gap != T::zero()) & ((next < T::zero()) != (gap < T::zero()));
            let beyond = passes & (next.abs() > rounding * gap.abs());
            [if beyond { (cap * next.abs()).widen() } else { 0.0 }]
        })
        .sum[0]
    }

    /// Σ H d over nodes that touch after a step d from where they yield.
    pub(crate) fn landed<Lo: Real>(&self, first: usize, gaps: &[T], step: &[Lo]) -> f64 {
        if !self.is_capped() {
            return 0.0;
        }
        let mut caps = [Capped(T::zero()); CHUNK];
        let caps = self.caps(first, &mut caps[..gaps.len()]);
        let nodes = gaps.iter().zip(step).zip(caps);
        let landed = nodes.filter(|((gap, step), _)| **gap == T::zero() && **step > Lo::zero());
        landed.map(|((_, step), cap)| step.widen() * cap.at().widen()).sum()
    }
}

/// Adds what a surface that yields at a hardness H adds where the gap is negative: ψ = −H g.
pub(super) fn below<T: Real>(hardness: &Hardness, of: Of, first: usize, gaps: &[T], out: &mut [T]) {
    let mut caps = [T::zero(); CHUNK];
    let caps = &mut caps[..gaps.len()];
    hardness.fill(first, caps, |cap| cap);
    let (linear, constant) = match of {
        Of::Energy => (T::one(), T::zero()),
        Of::Traction => (T::zero(), T::one()),
        Of::Slope => return,
    };
    vectors!([gaps, caps], [out], |i| {
        let (gap, cap) = (gaps[i], caps[i]);
        out[i] = if gap < T::zero() { out[i] - cap * (linear * gap + constant) } else { out[i] };
    });
}
