//! The adhesion law: energy, traction and slope of the attraction as functions of the gap.

use std::sync::Arc;

use crate::grid::Grid;
use crate::real::Real;
use crate::vector::vectors;

mod check;
mod cut_off;
mod exponential;
mod exponentials;
mod lennard_jones;
mod maugis_dugdale;
mod morse;
mod none;
mod power_law;
mod tabulated;
mod varying;

pub use check::check_law;
pub use cut_off::CutOff;
pub use exponential::Exponential;
pub use lennard_jones::LennardJones;
pub use maugis_dugdale::MaugisDugdale;
pub use morse::Morse;
pub use none::NoAdhesion;
pub use power_law::PowerLaw;
pub use tabulated::Tabulated;
pub use varying::Varying;

/// The share of w/ρ that the adhesive traction must exceed where surfaces are said to attract each other.
const NOTICEABLE: f64 = 0.01;

/// An adhesion law: the energy per area by which two surfaces attract each other, a function of the gap alone.
///
/// A law is three functions of one gap `g ≥ 0`: the energy φ(g) ≤ 0, its derivative φ'(g), the
/// adhesive traction, positive where the surfaces attract each other, and the traction's slope φ''(g). Everything else
/// has a default. The energy falls to zero, or to any constant, at large gaps. No law is asked for a negative gap, but
/// for one that keeps the surfaces apart by itself ([`rest`](Self::rest)); what becomes of it where a
/// [`ContactConstraint`](crate::ContactConstraint) lets the surfaces interpenetrate is said there.
///
/// [`check_law`] tells whether the three functions agree with one another; call it in a test of your law.
///
/// ```
/// use asperity::adhesion::check_law;
/// use asperity::{AdhesionLaw, Real};
///
/// /// φ = −w (1 − g/ρ)³ for g < ρ, 0 beyond.
/// struct Cubic<T> { w: T, rho: T }
///
/// impl<T: Real> AdhesionLaw<T> for Cubic<T> {
///     fn energy(&self, gap: T) -> T {
///         let x = (T::one() - gap / self.rho).max(T::zero());
///         -self.w * x * x * x
///     }
///     fn traction(&self, gap: T) -> T {
///         let x = (T::one() - gap / self.rho).max(T::zero());
///         T::lit(3.0) * self.w / self.rho * x * x
///     }
///     fn slope(&self, gap: T) -> T {
///         let x = (T::one() - gap / self.rho).max(T::zero());
///         T::lit(-6.0) * self.w / (self.rho * self.rho) * x
///     }
/// }
///
/// check_law(&Cubic { w: 1e-4, rho: 2e-3 }, 1e-2)?;
/// # Ok::<(), asperity::Error>(())
/// ```
pub trait AdhesionLaw<T: Real>: Send + Sync {
    /// The adhesive energy φ(g), energy per area; usually negative.
    fn energy(&self, gap: T) -> T;

    /// The adhesive traction φ'(g), force per area; positive attracts.
    fn traction(&self, gap: T) -> T;

    /// The slope of the traction φ''(g), traction per length. Where the traction jumps, its slope beside the jump.
    fn slope(&self, gap: T) -> T;

    /// The work of adhesion w = −φ(0), energy per area.
    fn work_of_adhesion(&self) -> T {
        -self.energy(T::zero())
    }

    /// The length ρ over which the traction decays, for the resolution measure μ_ρ.
    ///
    /// The default is w/φ'(0), which is ρ for an exponential and for a constant traction. A law that attracts
    /// most at some distance from contact should say its own. A peak of the traction that is narrower than a hundredth
    /// of ρ may be overlooked where the solver asks whether the law can hold a tensile load at all.
    fn range(&self) -> T {
        let (w, traction) = (self.work_of_adhesion(), self.traction(T::zero()));
        if w > T::zero() && traction > T::zero() { w / traction } else { T::zero() }
    }

    /// Whether the law is zero at all gaps, so that it need not be evaluated. The default is that it is not.
    fn is_zero(&self) -> bool {
        false
    }

    /// Whether the energy is concave at all gaps: the traction nowhere rises with the gap. At a rigid wall its tangent
    /// then bounds the energy after a step, which need not be evaluated to know that it falls. The default, false, is
    /// safe for every law.
    fn is_concave(&self) -> bool {
        false
    }

    /// The gap of rest: below it the law repels, and keeps the surfaces apart by itself, above it attracts. Nothing,
    /// which is the default, for a law that only attracts.
    ///
    /// A law with a gap of rest can be solved with [`NoWall`](crate::NoWall). It says its own
    /// [`work_of_adhesion`](Self::work_of_adhesion) and [`range`](Self::range).
    fn rest(&self) -> Option<T> {
        None
    }

    /// The shape (Nx, Ny) of the only grid on which a law that varies over the surface can be used. Nothing, which is
    /// the default, for a law of the gap alone.
    fn shape(&self) -> Option<(usize, usize)> {
        None
    }

    /// A law that varies over the surface and knows the nodes of some rows alone, as a process does that shares the
    /// grid: the law of the rows of this grid, [`Grid::rows`], which may be others. Nothing, which is the default, if it
    /// knows these. All processes ask.
    fn in_rows_of(&self, grid: &Grid) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        let _ = grid;
        None
    }

    /// A law that varies over the surface, on the coarser grid that has every nx-th and every ny-th node of its own.
    /// Nothing, which is the default, for a law of the gap alone.
    fn coarsened(&self, stride: (usize, usize)) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        let _ = stride;
        None
    }

    /// The law with slopes no steeper than 1/`compliance` in the place of the jumps of its traction; nothing if it has
    /// none.
    ///
    /// Where the traction falls by Δ at one gap, a node with the traction and one without it are both in
    /// equilibrium over a whole range of the gap, Δ times the node's compliance: the edge of the adhesive zone is
    /// pinned to the nodes, and stays where an iteration happened to leave it. The default start of a solve therefore
    /// comes from the smoothed law, of which the equilibrium does not depend on the way there. Energy, traction
    /// and slope have to agree for the smoothed law too, and the work of adhesion stays the same. The default has no
    /// jumps.
    fn smoothed(&self, compliance: T) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        let _ = compliance;
        None
    }

    /// The energies at the nodes from `first` on, in row-major order (node ix·Ny + iy), which have these gaps. Nodes
    /// count on the whole grid, also where several processes share it.
    ///
    /// The five slice functions are what a solve calls, for a few hundred nodes at once. A law of which the gap is all
    /// that matters need not write them. A law that varies over the surface writes them by the node, as
    /// `examples/patches/law.rs` does, and answers to the functions of one gap for the node where it is strongest. A law
    /// that can use vector instructions writes them for speed. They must not depend on where the slices begin and end.
    fn energies(&self, first: usize, gaps: &[T], energies: &mut [T]) {
        let _ = first;
        vectors!([gaps], [energies], |i| {
            energies[i] = self.energy(gaps[i]);
        });
    }

    /// The tractions at the nodes from `first` on.
    fn tractions(&self, first: usize, gaps: &[T], tractions: &mut [T]) {
        let _ = first;
        vectors!([gaps], [tractions], |i| {
            tractions[i] = self.traction(gaps[i]);
        });
    }

    /// The slopes of the traction at the nodes from `first` on.
    fn slopes(&self, first: usize, gaps: &[T], slopes: &mut [T]) {
        let _ = first;
        vectors!([gaps], [slopes], |i| {
            slopes[i] = self.slope(gaps[i]);
        });
    }

    /// Energies and tractions at once, for a law of which one follows from the other.
    fn energies_and_tractions(&self, first: usize, gaps: &[T], energies: &mut [T], tractions: &mut [T]) {
        self.energies(first, gaps, energies);
        self.tractions(first, gaps, tractions);
    }

    /// Tractions and slopes at once, for a law of which one follows from the other.
    fn tractions_and_slopes(&self, first: usize, gaps: &[T], tractions: &mut [T], slopes: &mut [T]) {
        self.tractions(first, gaps, tractions);
        self.slopes(first, gaps, slopes);
    }
}

macro_rules! forward {
    ($($type:ty),*) => {$(
        impl<T: Real, L: AdhesionLaw<T> + ?Sized> AdhesionLaw<T> for $type {
            fn energy(&self, gap: T) -> T { (**self).energy(gap) }
            fn traction(&self, gap: T) -> T { (**self).traction(gap) }
            fn slope(&self, gap: T) -> T { (**self).slope(gap) }
            fn work_of_adhesion(&self) -> T { (**self).work_of_adhesion() }
            fn range(&self) -> T { (**self).range() }
            fn is_zero(&self) -> bool { (**self).is_zero() }
            fn is_concave(&self) -> bool { (**self).is_concave() }
            fn rest(&self) -> Option<T> { (**self).rest() }
            fn shape(&self) -> Option<(usize, usize)> { (**self).shape() }
            fn in_rows_of(&self, grid: &Grid) -> Option<Box<dyn AdhesionLaw<T> + '_>> { (**self).in_rows_of(grid) }
            fn coarsened(&self, stride: (usize, usize)) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
                (**self).coarsened(stride)
            }
            fn smoothed(&self, compliance: T) -> Option<Box<dyn AdhesionLaw<T> + '_>> { (**self).smoothed(compliance) }
            fn energies(&self, first: usize, gaps: &[T], energies: &mut [T]) {
                (**self).energies(first, gaps, energies)
            }
            fn tractions(&self, first: usize, gaps: &[T], tractions: &mut [T]) {
                (**self).tractions(first, gaps, tractions)
            }
            fn slopes(&self, first: usize, gaps: &[T], slopes: &mut [T]) {
                (**self).slopes(first, gaps, slopes)
            }
            fn energies_and_tractions(&self, first: usize, gaps: &[T], energies: &mut [T], tractions: &mut [T]) {
                (**self).energies_and_tractions(first, gaps, energies, tractions)
            }
            fn tractions_and_slopes(&self, first: usize, gaps: &[T], tractions: &mut [T], slopes: &mut [T]) {
                (**self).tractions_and_slopes(first, gaps, tractions, slopes)
            }
        }
    )*};
}
forward!(&L, Box<L>, Arc<L>);

/// The adhesive traction above which surfaces are said to attract each other: a share of w/ρ; zero where that has no
/// bound.
pub(crate) fn noticeable<T: Real>(law: &dyn AdhesionLaw<T>) -> f64 {
    let scale = (law.work_of_adhesion() / law.range()).widen();
    if scale.is_finite() { NOTICEABLE * scale } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_evaluated_at_once_is_what_each_function_gives() {
        fn check<T: Real>(law: &dyn AdhesionLaw<T>) {
            let gaps: Vec<T> = (0..100).map(|i| T::lit(0.02 * f64::from(i))).collect();
            let [mut energies, mut tractions, mut slopes, mut again] = [(); 4].map(|()| vec![T::zero(); gaps.len()]);
            law.energies_and_tractions(0, &gaps, &mut energies, &mut tractions);
            law.tractions_and_slopes(0, &gaps, &mut again, &mut slopes);
            for (i, &gap) in gaps.iter().enumerate() {
                let found = [energies[i], tractions[i], again[i], slopes[i]].map(T::widen);
                let expected = [law.energy(gap), law.traction(gap), law.traction(gap), law.slope(gap)].map(T::widen);
                for ((found, expected), size) in found.into_iter().zip(expected).zip([2.0, 4.0, 4.0, 8.0]) {
                    // of an exponential of up to one, and some products
                    let rounding = 4.0 * T::epsilon().widen() * size;
                    assert!((found - expected).abs() <= rounding, "{found} {expected} at {gap}");
                }
            }
        }
        let law = Exponential::new(2.0, 0.5).unwrap();
        check::<f32>(&law);
        let powers = [2.0, 3.5].map(|exponent| PowerLaw::new(2.0, 0.5, exponent).unwrap());
        let (cut_off, morse) = (CutOff::new(law, 1.0).unwrap(), Morse::new(2.0, 0.5).unwrap());
        for law in [&law as &dyn AdhesionLaw<f64>, &cut_off, &morse, &powers[0], &powers[1]] {
            check(law);
        }
    }

    #[test]
    fn a_boxed_law_is_the_law() {
        let law = Exponential::new(2.0, 0.5).unwrap();
        let boxed: Box<dyn AdhesionLaw<f64>> = Box::new(law);
        assert_eq!(AdhesionLaw::range(&boxed), 0.5);
        assert_eq!(AdhesionLaw::work_of_adhesion(&boxed), 2.0);
        assert!(!AdhesionLaw::is_zero(&boxed));
        let gaps = [0.0, 0.1, 3.0];
        let (mut a, mut b) = ([0.0; 3], [0.0; 3]);
        law.tractions(0, &gaps, &mut a);
        AdhesionLaw::tractions(&boxed, 0, &gaps, &mut b);
        assert_eq!(a, b);
    }

    #[test]
    fn laws_refuse_what_is_not_a_law() {
        assert!(Exponential::new(-1.0, 1.0).is_err());
        assert!(Exponential::new(1.0, 0.0).is_err());
        assert!(MaugisDugdale::new(f64::NAN, 1.0).is_err());
        assert!(MaugisDugdale::new(1.0, f64::INFINITY).is_err());
    }
}
