//! Adhesion laws as one type, in both precisions.

use std::any::Any;
use std::path::Path;
use std::sync::Arc;

use asperity::adhesion::{CutOff, Discretisation, Hints, Values, Varying};
use asperity::{
    AdhesionLaw, Error, Exponential, Grid, LennardJones, MaugisDugdale, Morse, NoAdhesion, PowerLaw, Real, Result,
    Tabulated,
};
use ndarray::{ArrayRef2, ArrayView2};

use crate::compiled::compiled;

/// An adhesion law of the library, perhaps cut off or varied, or a law of one's own.
#[derive(Clone, PartialEq)]
pub enum Formula {
    /// No adhesion.
    None,
    /// A traction that decays exponentially.
    Exponential(Exponential),
    /// A constant traction up to the range.
    MaugisDugdale(MaugisDugdale),
    /// The law of Lennard-Jones between half-spaces.
    LennardJones(LennardJones),
    /// The law of Morse.
    Morse(Morse),
    /// A power law, the van der Waals attraction among them.
    PowerLaw(PowerLaw),
    /// A cubic through the points of a table.
    Tabulated(Tabulated),
    /// A law that ends at a gap.
    CutOff(CutOff<Box<Formula>>),
    /// A law whose work of adhesion varies over the surface.
    Varying(Varying<Box<Formula>>),
    /// A law that is not of the library.
    Own(Arc<dyn OwnLaw>),
}

/// A law that is not of the library, in both precisions. Every type that is one, and can be compared, has the trait.
pub trait OwnLaw: AdhesionLaw<f32> + AdhesionLaw<f64> + Any {
    /// Whether another law is of the same type and equal.
    fn equals(&self, other: &dyn OwnLaw) -> bool;
}

impl<L: AdhesionLaw<f32> + AdhesionLaw<f64> + PartialEq + Any> OwnLaw for L {
    fn equals(&self, other: &dyn OwnLaw) -> bool {
        (other as &dyn Any).downcast_ref() == Some(self)
    }
}

impl PartialEq for dyn OwnLaw {
    fn eq(&self, other: &Self) -> bool {
        self.equals(other)
    }
}

compiled!(Shared: &'a Formula => Arc<dyn AdhesionLaw<T>> = |law: &Formula| Arc::new(law.clone()));

impl Formula {
    /// The law, zero from a gap on.
    ///
    /// # Errors
    /// Those of [`CutOff::new`].
    pub fn cut_off(self, distance: f64) -> Result<Self> {
        CutOff::new(Box::new(self), distance).map(Self::CutOff)
    }

    /// The law with works of adhesion at the nodes of a grid, of which this process gives its rows.
    ///
    /// # Errors
    /// Those of [`Varying::on`].
    pub fn varied_on(self, grid: &Grid, works: ArrayView2<'_, f64>) -> Result<Self> {
        Varying::on(grid, Box::new(self), works).map(Self::Varying)
    }

    /// The law with works of adhesion at all nodes, shape (Nx, Ny).
    ///
    /// # Errors
    /// Those of [`Varying::new`].
    pub fn varied(self, works: ArrayView2<'_, f64>) -> Result<Self> {
        Varying::new(Box::new(self), works).map(Self::Varying)
    }

    /// The node at which the work of adhesion is largest, if it varies. All processes that share the grid have to ask.
    pub fn strongest(&self) -> Option<(usize, usize)> {
        match self {
            Self::Varying(law) => Some(law.strongest()),
            Self::CutOff(law) => law.law().strongest(),
            _ => None,
        }
    }

    /// The law in the precision of a solve; works of adhesion that vary are shared with it.
    pub fn law<T: Real>(&self) -> Arc<dyn AdhesionLaw<T>> {
        T::call::<Shared<'_>>(self)
    }
}

/// The formula as a law, compiled with this crate for each of the two precisions.
macro_rules! law_in {
    ($($real:ty),*) => {$(
        impl<'a> From<&'a Formula> for &'a dyn AdhesionLaw<$real> {
            fn from(formula: &'a Formula) -> Self {
                match formula {
                    Formula::None => &NoAdhesion,
                    Formula::Exponential(law) => law,
                    Formula::MaugisDugdale(law) => law,
                    Formula::LennardJones(law) => law,
                    Formula::Morse(law) => law,
                    Formula::PowerLaw(law) => law,
                    Formula::Tabulated(law) => law,
                    Formula::CutOff(law) => law,
                    Formula::Varying(law) => law,
                    Formula::Own(law) => law.as_ref(),
                }
            }
        }

        impl AdhesionLaw<$real> for Formula {
            fn energy(&self, gap: $real) -> $real {
                <&dyn AdhesionLaw<$real>>::from(self).energy(gap)
            }
            fn traction(&self, gap: $real) -> $real {
                <&dyn AdhesionLaw<$real>>::from(self).traction(gap)
            }
            fn slope(&self, gap: $real) -> $real {
                <&dyn AdhesionLaw<$real>>::from(self).slope(gap)
            }
            fn hints(&self) -> Hints<$real> {
                <&dyn AdhesionLaw<$real>>::from(self).hints()
            }
            fn evaluate(&self, first: usize, gaps: &[$real], values: Values<'_, $real>) {
                <&dyn AdhesionLaw<$real>>::from(self).evaluate(first, gaps, values);
            }
            fn adapted(&self, to: Discretisation<$real>) -> Option<Box<dyn AdhesionLaw<$real> + '_>> {
                <&dyn AdhesionLaw<$real>>::from(self).adapted(to)
            }
        }
    )*};
}
law_in!(f32, f64);

/// The law of a table of gaps and tractions, which was read from a file.
///
/// # Errors
/// [`Error::File`] unless the table has two columns that make a law.
pub fn tabulated(path: &Path, table: &ArrayRef2<f64>) -> Result<Tabulated> {
    if table.ncols() != 2 {
        let columns = table.ncols();
        return Err(Error::file(
            path,
            format!("has {columns} columns, not two: put a gap and a traction on each line"),
        ));
    }
    let [gaps, tractions] = [0, 1].map(|column| table.column(column).to_vec());
    Tabulated::new(&gaps, &tractions).map_err(|error| Error::file(path, format!("is no law: {error}")))
}
