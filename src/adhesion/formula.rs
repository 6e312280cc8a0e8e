//! Adhesion laws as one type, in both precisions.

use std::any::Any;
use std::sync::Arc;

use ndarray::ArrayView2;

use super::{
    AdhesionLaw, CutOff, Exponential, Jkr, LennardJones, MaugisDugdale, Morse, NoAdhesion, PowerLaw, Tabulated, Varying,
};
use crate::error::Result;

/// An adhesion law in both precisions, whichever it is; a clone shares it.
///
/// `into` makes a formula of a law of the library, with loops over the nodes that are compiled with the library; any
/// other [`AnyLaw`] in an `Arc` is a formula.
///
/// ```
/// use asperity::adhesion::Formula;
/// use asperity::{AdhesionLaw, Exponential};
/// let law: Formula = Exponential::new(0.05, 2e-9)?.into();
/// let law = law.cut_off(20e-9)?;
/// assert_eq!((law.energy(30e-9_f32), law.energy(30e-9_f64)), (0.0, 0.0));
/// # Ok::<(), asperity::Error>(())
/// ```
pub type Formula = Arc<dyn AnyLaw>;

/// An adhesion law in both precisions that can be compared with others: every type that is a law and has an equality.
pub trait AnyLaw: AdhesionLaw<f32> + AdhesionLaw<f64> + Any {
    /// Whether another law is of the same type and equal.
    #[doc(hidden)]
    fn equals(&self, other: &dyn AnyLaw) -> bool;
}

impl<L: AdhesionLaw<f32> + AdhesionLaw<f64> + PartialEq + Any> AnyLaw for L {
    fn equals(&self, other: &dyn AnyLaw) -> bool {
        (other as &dyn Any).downcast_ref() == Some(self)
    }
}

impl PartialEq for dyn AnyLaw {
    fn eq(&self, other: &Self) -> bool {
        self.equals(other)
    }
}

impl dyn AnyLaw {
    /// The law, zero from a gap on.
    ///
    /// # Errors
    /// As [`CutOff::new`].
    pub fn cut_off(self: Arc<Self>, distance: f64) -> Result<Formula> {
        Ok(Arc::new(CutOff::new(self, distance)?))
    }

    /// Whether the law is a [`CutOff`].
    pub fn is_cut_off(&self) -> bool {
        (self as &dyn Any).is::<CutOff<Formula>>()
    }

    /// The law with works of adhesion at the nodes, shape (Nx, Ny).
    ///
    /// # Errors
    /// As [`Varying::new`].
    pub fn varied(self: Arc<Self>, works: ArrayView2<'_, f64>) -> Result<Formula> {
        Ok(Arc::new(Varying::new(self, works)?))
    }

    /// The node at which the work of adhesion is largest, if it varies.
    pub fn strongest(&self) -> Option<(usize, usize)> {
        let law: &dyn Any = self;
        match law.downcast_ref::<Varying<Formula>>() {
            Some(varying) => Some(varying.strongest()),
            None => law.downcast_ref::<CutOff<Formula>>()?.law().strongest(),
        }
    }
}

/// Not generic, so that the loops of the laws are compiled here, and not with each crate that has one.
macro_rules! formulas {
    ($($law:ty),*) => {$(
        impl From<$law> for Formula {
            #[inline(never)]
            fn from(law: $law) -> Self {
                Arc::new(law)
            }
        }
    )*};
}

formulas!(Exponential, Jkr, LennardJones, MaugisDugdale, Morse, NoAdhesion, PowerLaw, Tabulated);
