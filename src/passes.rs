//! The passes over fields that make an iteration.
//!
//! Their cost is memory traffic, so that each does all that can be done while its nodes are in cache. They are
//! compiled with this crate, once for each precision, for AVX2 too: the seams come in behind [`Local`], at one virtual
//! call for a chunk of nodes.

use ndarray::Array2;

use crate::field::{Partial, Reducer};
use crate::real::Real;

mod residual;
mod step;
mod tally;

pub(crate) use tally::Tally;

/// The fields of a solve.
#[derive(Debug)]
pub struct Fields<T> {
    pub(crate) reducer: Reducer,
    /// g
    pub(crate) gap: Array2<T>,
    /// K⁻¹(g + h), of zero mean
    pub(crate) pressure: Array2<T>,
    /// r', negative zero outside of the working set and never within; while a step is made, K⁻¹ of the change
    pub(crate) residual: Array2<T>,
    /// z = M r'; between two steps, that of the state before
    pub(crate) preconditioned: Array2<T>,
    /// the last step, up to a factor and, while the next one is made, up to the scale that restores the mean gap; the
    /// direction t of [`Method::Rey2017`](crate::Method)
    pub(crate) change: Array2<T>,
}

/// What each node feels by its own gap, of a chunk of nodes.
pub trait Local<T>: Sync {
    /// Whether there is nothing to evaluate.
    fn is_zero(&self) -> bool;
    /// Whether the gap is confined to g ≥ 0.
    fn projects(&self) -> bool;
    /// The energies, tractions or slopes of law and constraint at the nodes from `first` on.
    fn evaluate(&self, of: Of, first: usize, gaps: &[T], out: &mut [T]);
    /// Tractions and slopes at once.
    fn tractions_and_slopes(&self, first: usize, gaps: &[T], tractions: &mut [T], slopes: &mut [T]);
    /// The same of the law alone.
    fn law(&self, of: Of, gaps: &[T], out: &mut [T]);
    /// How many nodes are in contact under a constraint that does not project, and its energy.
    fn pressed(&self, first: usize, gaps: &[T]) -> [f64; 2];
}

/// Which derivative of an energy.
#[derive(Clone, Copy, Debug)]
pub enum Of {
    Energy,
    Traction,
    Slope,
}

/// Which nodes may move, and what their residual is.
#[derive(Clone, Copy, Debug)]
pub struct Working<T> {
    /// the mean pressure that is given, or zero
    pub(crate) offset: T,
    /// a node in contact is released where r is below it
    pub(crate) release: T,
    /// what r' is without
    pub(crate) level: T,
}

/// How a node follows the mean gap: v = √((g + least)/(g + half)).
#[derive(Clone, Copy, Debug)]
pub struct Follows<T> {
    pub(crate) half: T,
    pub(crate) least: T,
}

/// A step before it is clipped.
#[derive(Clone, Copy, Debug)]
pub struct Attempt<T> {
    /// how much of z to take
    pub(crate) length: T,
    /// the mean of z over the working set
    pub(crate) centre: T,
    /// how much of the last change to keep
    pub(crate) keep: T,
    /// its mean over the working set
    pub(crate) mean: T,
    /// whether the gap is confined to g ≥ 0
    pub(crate) projects: bool,
}

/// A step that is taken: `length` of scale·(g + change) − g.
#[derive(Clone, Copy, Debug)]
pub struct Advance<T> {
    pub(crate) length: T,
    pub(crate) scale: T,
    /// the mean pressure that is given, or zero
    pub(crate) offset: T,
    /// what r was without; nothing if r' is without nothing
    pub(crate) level: Option<T>,
}

/// The passes, as what a precision brings with it: so they are compiled with this crate, and not again with each that uses it.
pub trait Passes: Sized {
    /// Of the present gap and pressure; see [`Tally`].
    fn tally(fields: &mut Fields<Self>, local: &dyn Local<Self>, offset: Self, surface: &Array2<Self>) -> Partial;
    /// How many contact nodes are released, and Σ r over them, after a pass that took the tally.
    fn released(fields: &mut Fields<Self>, at_contact: Self, release: Self) -> Partial;
    /// r' from gap and pressure: Σ|g r'|, how many nodes may move, and Σ of the squares of what changed in r'.
    fn residual(fields: &mut Fields<Self>, local: &dyn Local<Self>, working: Working<Self>) -> Partial;
    /// r' from the r that a step has left in its place: Σ|g r'|, how many nodes may move, Σ r'·change, Σ r'·z with the
    /// z of the state before, and Σ change over the working set.
    fn release(fields: &mut Fields<Self>, projects: bool, working: Working<Self>) -> Partial;
    /// Σ v and Σ v·r' for how nodes follow the mean gap.
    fn lift_sums(fields: &mut Fields<Self>, follows: Follows<Self>) -> [f64; 2];
    /// Adds `scale`·v to z.
    fn lift(fields: &mut Fields<Self>, follows: Follows<Self>, scale: Self);
    /// Σ z outside of the working set, after a pass for r'.
    fn idle(fields: &mut Fields<Self>) -> f64;
    /// The change that a step makes, clipped: Σ change, how many nodes were clipped, and how many that the gradient drives
    /// into contact, Σ r'·change; of the local traction Σ traction·change, and of its slope Σ slope·change²; with the pressure of the surface
    /// also Σ r'·g, and its products with change and g, and Σ slope·change·g and Σ slope·g². The least is how many times the
    /// change a gap can take.
    fn trial(
        fields: &mut Fields<Self>,
        local: &dyn Local<Self>,
        attempt: Attempt<Self>,
        surface: Option<&Array2<Self>>,
    ) -> Partial;
    /// Σ of the local energy after a step.
    fn energy_after(fields: &mut Fields<Self>, local: &dyn Local<Self>, length: Self, scale: Self) -> f64;
    /// Takes a step: gap, pressure, r, and the tally of the new state. Beside it Σ change·r, less the level; under pressure control,
    /// where the level is zero, r' in the place of r, Σ|g r'|, how many nodes may move, Σ r'·change and Σ r'·z.
    fn advance(
        fields: &mut Fields<Self>,
        local: &dyn Local<Self>,
        step: Advance<Self>,
        surface: &Array2<Self>,
    ) -> Partial;
}

/// One if a condition holds, zero if not.
#[inline(always)]
fn count(condition: bool) -> f64 {
    if condition { 1.0 } else { 0.0 }
}

/// Whether a node is outside of the working set, by its residual.
#[inline(always)]
pub(crate) fn idles<T: Real>(residual: T) -> bool {
    (residual == T::zero()) & residual.is_sign_negative()
}

macro_rules! passes {
    ($($float:ty),*) => {$(
        impl Passes for $float {
            fn tally(fields: &mut Fields<Self>, local: &dyn Local<Self>, offset: Self, surface: &Array2<Self>) -> Partial {
                tally::tally(fields, local, offset, surface)
            }
            fn released(fields: &mut Fields<Self>, at_contact: Self, release: Self) -> Partial {
                tally::released(fields, at_contact, release)
            }
            fn residual(fields: &mut Fields<Self>, local: &dyn Local<Self>, working: Working<Self>) -> Partial {
                residual::residual(fields, local, working)
            }
            fn release(fields: &mut Fields<Self>, projects: bool, working: Working<Self>) -> Partial {
                residual::release(fields, projects, working)
            }
            fn lift_sums(fields: &mut Fields<Self>, follows: Follows<Self>) -> [f64; 2] {
                residual::lift_sums(fields, follows)
            }
            fn lift(fields: &mut Fields<Self>, follows: Follows<Self>, scale: Self) {
                residual::lift(fields, follows, scale)
            }
            fn idle(fields: &mut Fields<Self>) -> f64 {
                residual::idle(fields)
            }
            fn trial(
                fields: &mut Fields<Self>,
                local: &dyn Local<Self>,
                attempt: Attempt<Self>,
                surface: Option<&Array2<Self>>,
            ) -> Partial {
                step::trial(fields, local, attempt, surface)
            }
            fn energy_after(fields: &mut Fields<Self>, local: &dyn Local<Self>, length: Self, scale: Self) -> f64 {
                step::energy_after(fields, local, length, scale)
            }
            fn advance(
                fields: &mut Fields<Self>,
                local: &dyn Local<Self>,
                step: Advance<Self>,
                surface: &Array2<Self>,
            ) -> Partial {
                step::advance(fields, local, step, surface)
            }
        }
    )*};
}
passes!(f32, f64);
