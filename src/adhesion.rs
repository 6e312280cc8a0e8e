//! The adhesion law: energy, traction and slope of the attraction as functions of the gap.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use crate::degrees::LITTLE;
use crate::grid::Grid;
use crate::real::Real;
use crate::vector::vectors;

mod check;
mod cut_off;
mod exponential;
mod exponentials;
mod formula;
mod hints;
mod jkr;
mod lennard_jones;
mod maugis_dugdale;
mod morse;
mod none;
mod power_law;
mod tabulated;
mod touched;
mod values;
mod varying;

pub use check::check_law;
pub use cut_off::CutOff;
pub use exponential::Exponential;
pub use formula::{AnyLaw, Formula};
pub use hints::Hints;
pub use jkr::Jkr;
pub use lennard_jones::LennardJones;
pub use maugis_dugdale::MaugisDugdale;
pub use morse::Morse;
pub use none::NoAdhesion;
pub use power_law::PowerLaw;
pub use tabulated::{Functions, Tabulated, check_functions};
pub(crate) use touched::{Neighbourhood, Touched, Weakened};
pub use values::Values;
pub use varying::Varying;

/// An adhesion law: the energy per area by which two surfaces attract each other, a function of the gap.
///
/// A law is three functions of one gap `g ≥ 0`: the energy φ(g) ≤ 0, the adhesive traction φ'(g), positive where the
/// surfaces attract each other, and its slope φ''(g); all else has a default. The energy falls to zero, or to any
/// constant, at large gaps. Negative gaps are asked only of a law that repels by itself ([`Hints::rest`]); where a
/// [`ContactConstraint`](crate::ContactConstraint) lets surfaces interpenetrate, it says how the law continues.
///
/// [`check_law`] holds a law to this contract; the page [`own_law`](crate::guide::own_law) has one in a solve. A law
/// made of another one forwards [`hints`](Self::hints), [`evaluate`](Self::evaluate),
/// [`contact_shares`](Self::contact_shares), [`on_nodes`](Self::on_nodes) and [`adapted`](Self::adapted).
///
/// ```
/// use asperity::AdhesionLaw;
/// use asperity::adhesion::check_law;
/// /// φ = −(1 − g)³ for g < 1, 0 beyond.
/// struct Cubic;
/// impl AdhesionLaw<f64> for Cubic {
///     fn energy(&self, gap: f64) -> f64 { -(1.0 - gap).max(0.0).powi(3) }
///     fn traction(&self, gap: f64) -> f64 { 3.0 * (1.0 - gap).max(0.0).powi(2) }
///     fn slope(&self, gap: f64) -> f64 { -6.0 * (1.0 - gap).max(0.0) }
/// }
/// check_law(&Cubic, 5.0)?;
/// # Ok::<(), asperity::Error>(())
/// ```
pub trait AdhesionLaw<T: Real>: Send + Sync {
    /// The adhesive energy φ(g), energy per area; usually negative.
    fn energy(&self, gap: T) -> T;

    /// The adhesive traction φ'(g), force per area; positive attracts.
    fn traction(&self, gap: T) -> T;

    /// The slope of the traction φ''(g), traction per length; at a jump of the traction, the slope next to the jump.
    fn slope(&self, gap: T) -> T;

    /// Work of adhesion, range, and whatever else a solve may know beforehand; by default [`Hints::of`] the functions.
    fn hints(&self) -> Hints<T> {
        Hints::of(self)
    }

    /// Sets the values that are asked for at the nodes from `first` on, in row-major order (node ix·Ny + iy) on the
    /// whole grid, also where several processes share it. The default calls the functions of one gap.
    ///
    /// A solve asks for a few hundred nodes at once; the values must not depend on where the slices begin and end. A
    /// law that varies over the surface (as in `examples/patches/law.rs`) writes them by the node, has a
    /// [shape](Hints::shape), and answers to the functions of one gap for its strongest node.
    fn evaluate(&self, first: usize, gaps: &[T], values: Values<'_, T>) {
        let _ = first;
        let Values { energies, tractions, slopes } = values;
        if let Some(energies) = energies {
            vectors!([gaps], [energies], |i| {
                energies[i] = self.energy(gaps[i]);
            });
        }
        if let Some(tractions) = tractions {
            vectors!([gaps], [tractions], |i| {
                tractions[i] = self.traction(gaps[i]);
            });
        }
        if let Some(slopes) = slopes {
            vectors!([gaps], [slopes], |i| {
                slopes[i] = self.slope(gaps[i]);
            });
        }
    }

    /// Sets the share −φ(g)/w of the energy in contact for each node from `first` on: the contact area of the node in
    /// the theory of Johnson, Kendall and Roberts. A node without a work of adhesion has the share one where it
    /// touches.
    fn contact_shares(&self, first: usize, gaps: &[T], shares: &mut [T]) {
        let work = self.hints().work_of_adhesion;
        self.evaluate(first, gaps, Values::one(0, shares));
        shares.iter_mut().for_each(|share| *share = (T::zero() - *share) / work);
    }

    /// The law on nodes of this compliance, length per pressure: for a law without a range of its own, as [`Jkr`]: as
    /// short as the nodes can follow. None, the default, for a law that is the same on every grid.
    /// [`Problem::new`](crate::Problem::new) asks with Δx/E*, on each of nested grids.
    fn on_nodes(&self, compliance: T) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let _ = compliance;
        None
    }

    /// The law adapted to a discretisation; none if it is the same there, which is the default.
    fn adapted(&self, to: Discretisation<T>) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let _ = to;
        None
    }
}

/// A discretisation to which a law is [adapted](AdhesionLaw::adapted).
#[non_exhaustive]
#[derive(Clone, Copy, Debug)]
pub enum Discretisation<T> {
    /// The coarser grid of every nx-th and every ny-th node: for a law that varies over the surface.
    Coarse(usize, usize),
    /// The finer grid of nx times and ny times as many nodes, where every node stands for the nodes behind it: for a
    /// law that varies over the surface.
    Fine(usize, usize),
    /// Nodes of this compliance, length per pressure: for a law with jumps of the traction. Slopes of at most one over
    /// the compliance replace the jumps; the functions still agree, and the work of adhesion stays.
    ///
    /// At a jump a node is in equilibrium on both sides, and the edge of the adhesive zone stays where an iteration
    /// left it. A solve therefore goes through the equilibrium of the smoothed law, from whatever start. A law that is
    /// as smooth already is the same.
    Smooth(T),
}

impl<T> Discretisation<T> {
    /// The compliance with which solves and paths smooth a law, in Δx/E*: a node has 1.1, the nodes along an edge some 3.
    pub const SMOOTHING: f64 = 5.0;
}

macro_rules! forward {
    ($($type:ty),*) => {$(
        impl<T: Real, L: AdhesionLaw<T> + ?Sized> AdhesionLaw<T> for $type {
            fn energy(&self, gap: T) -> T { (**self).energy(gap) }
            fn traction(&self, gap: T) -> T { (**self).traction(gap) }
            fn slope(&self, gap: T) -> T { (**self).slope(gap) }
            fn hints(&self) -> Hints<T> { (**self).hints() }
            fn evaluate(&self, first: usize, gaps: &[T], values: Values<'_, T>) { (**self).evaluate(first, gaps, values) }
            fn contact_shares(&self, first: usize, gaps: &[T], shares: &mut [T]) { (**self).contact_shares(first, gaps, shares) }
            fn on_nodes(&self, compliance: T) -> Option<Arc<dyn AdhesionLaw<T>>> { (**self).on_nodes(compliance) }
            fn adapted(&self, to: Discretisation<T>) -> Option<Arc<dyn AdhesionLaw<T>>> { (**self).adapted(to) }
        }
    )*};
}
forward!(&L, Box<L>, Arc<L>);

/// The adhesion law of a problem and of its solutions.
#[derive(Clone)]
pub struct SharedLaw<T: Real>(pub(crate) Arc<dyn AdhesionLaw<T>>);

impl<T: Real> SharedLaw<T> {
    pub(crate) fn new(law: impl AdhesionLaw<T> + 'static) -> Self {
        Self(Arc::new(law))
    }
}

impl<T: Real> Deref for SharedLaw<T> {
    type Target = dyn AdhesionLaw<T>;
    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl<T: Real> fmt::Debug for SharedLaw<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.hints().known_as())
    }
}

/// The adhesive traction above which surfaces are said to attract each other; zero where w/ρ has no bound.
pub(crate) fn noticeable<T: Real>(law: &dyn AdhesionLaw<T>) -> f64 {
    let hints = law.hints();
    let scale = (hints.work_of_adhesion / hints.range).widen();
    if scale.is_finite() { LITTLE * scale } else { 0.0 }
}

/// The law on the nodes of a grid, on a body of contact `modulus` E*, if the law differs there.
pub(crate) fn on_grid<T: Real>(law: &dyn AdhesionLaw<T>, grid: &Grid, modulus: f64) -> Option<Arc<dyn AdhesionLaw<T>>> {
    law.on_nodes(T::lit(grid.largest_spacing() / modulus))
}

/// The measure of how a grid resolves the adhesive zone on a body of contact `modulus` E*, μ_ρ = √(wΔx/E*)/ρ, with the
/// larger of Δx and Δy.
///
/// Below about 0.5 the zone is resolved. Above, contact edges are pinned to the grid, and the equilibrium found
/// depends on the start. Zero without adhesion. [`Jkr`], with a range set by the grid, has 0.28 on every grid.
pub fn mu_rho<T: Real>(law: &dyn AdhesionLaw<T>, grid: &Grid, modulus: f64) -> f64 {
    let hints = on_grid(law, grid, modulus).map_or_else(|| law.hints(), |law| law.hints());
    let (w, range) = (hints.work_of_adhesion.widen(), hints.range.widen());
    if hints.zero || w <= 0.0 || range <= 0.0 {
        return 0.0;
    }
    (w * grid.largest_spacing() / modulus).sqrt() / range
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_evaluated_at_once_is_what_each_function_gives() {
        fn check<T: Real>(law: &dyn AdhesionLaw<T>) {
            let gaps: Vec<T> = (0..100).map(|i| T::lit(0.02 * f64::from(i))).collect();
            let [mut energies, mut tractions, mut slopes, mut again] = [(); 4].map(|()| vec![T::zero(); gaps.len()]);
            law.evaluate(0, &gaps, Values::energies_and_tractions(&mut energies, &mut tractions));
            law.evaluate(0, &gaps, Values::tractions_and_slopes(&mut again, &mut slopes));
            for (i, &gap) in gaps.iter().enumerate() {
                let found = [energies[i], tractions[i], again[i], slopes[i]].map(T::widen);
                let expected = [law.energy(gap), law.traction(gap), law.traction(gap), law.slope(gap)].map(T::widen);
                for ((found, expected), size) in found.into_iter().zip(expected).zip([2.0, 4.0, 4.0, 8.0]) {
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
    fn laws_refuse_what_is_not_a_law() {
        assert!(Exponential::new(-1.0, 1.0).is_err());
        assert!(Exponential::new(1.0, 0.0).is_err());
        assert!(MaugisDugdale::new(f64::NAN, 1.0).is_err());
        assert!(MaugisDugdale::new(1.0, f64::INFINITY).is_err());
    }
}
