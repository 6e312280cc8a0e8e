//! Adhesion laws as one type, in both precisions.

use std::any::Any;
use std::path::Path;
use std::sync::Arc;

use asperity::adhesion::{CutOff, Varying};
use asperity::{AdhesionLaw, Error, Result, Tabulated};
use ndarray::{ArrayRef2, ArrayView2};

use crate::key::Scalar;

/// An adhesion law in both precisions, whichever it is; a clone shares it.
pub type Formula = Arc<dyn AnyLaw>;

/// An adhesion law in both precisions that can be compared with others. All laws of the library have this trait, and
/// every other type that is a law and has an equality.
pub trait AnyLaw: AdhesionLaw<f32> + AdhesionLaw<f64> + Any {
    /// Whether another law is of the same type and equal.
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
    /// The law in the precision of a solve.
    pub fn law<T: Scalar>(self: Arc<Self>) -> Arc<dyn AdhesionLaw<T>> {
        T::law(self)
    }

    /// The law, zero from a gap on.
    ///
    /// # Errors
    /// Those of [`CutOff::new`].
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
    /// Those of [`Varying::new`].
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
