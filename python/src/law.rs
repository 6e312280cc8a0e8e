//! Adhesion laws: those of the library as classes, and any object of Python with the three functions of a law.

use std::sync::{Mutex, PoisonError};

use asperity::{AdhesionLaw, NoAdhesion, Real};
use numpy::PyArray1;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::numbers::{Numbers, mapped};
use crate::refusal::refusal;
use crate::table::Table;

/// A law of the library, which is given by work of adhesion and range, as a class.
macro_rules! class {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[pyclass(frozen, eq, module = "asperity")]
        #[derive(Clone, PartialEq)]
        pub struct $name(asperity::$name);

        #[pymethods]
        impl $name {
            #[new]
            fn new(work_of_adhesion: f64, range: f64) -> PyResult<Self> {
                asperity::$name::new(work_of_adhesion, range).map(Self).map_err(refusal)
            }
            /// Work of adhesion w, an energy per area.
            #[getter]
            fn work_of_adhesion(&self) -> f64 {
                self.0.work_of_adhesion()
            }
            /// Range ρ, a length.
            #[getter]
            fn range(&self) -> f64 {
                self.0.range()
            }
            /// Adhesive energy φ(g) per area, of the shape of the gaps.
            fn energy<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
                mapped(py, &gap, |gap| self.0.energy(gap))
            }
            /// Adhesive traction φ'(g), positive attracts, of the shape of the gaps.
            fn traction<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
                mapped(py, &gap, |gap| self.0.traction(gap))
            }
            /// Slope of the traction φ''(g), of the shape of the gaps.
            fn slope<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
                mapped(py, &gap, |gap| self.0.slope(gap))
            }
            fn __repr__(&self) -> String {
                let (work, range) = (self.0.work_of_adhesion(), self.0.range());
                format!(concat!(stringify!($name), "(work_of_adhesion={:?}, range={:?})"), work, range)
            }
            fn __getnewargs__(&self) -> (f64, f64) {
                (self.0.work_of_adhesion(), self.0.range())
            }
        }
    };
}

class! {
    /// The exponential law, φ(g) = −w exp(−g/ρ).
    ///
    /// Parameters
    /// ----------
    /// work_of_adhesion : float
    ///     Work of adhesion w ≥ 0, an energy per area.
    /// range : float
    ///     Range ρ > 0, a length.
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> law = asperity.Exponential(work_of_adhesion=0.05, range=2e-9)
    /// >>> law.energy(0.0)
    /// -0.05
    Exponential
}
class! {
    /// The law of Maugis and Dugdale: a constant traction w/ρ where the gap is below ρ.
    ///
    /// Parameters
    /// ----------
    /// work_of_adhesion : float
    ///     Work of adhesion w ≥ 0, an energy per area.
    /// range : float
    ///     Range ρ > 0, a length.
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> asperity.MaugisDugdale(work_of_adhesion=1e-4, range=2e-3).traction([0.0, 3e-3])
    /// array([0.05, 0.  ])
    MaugisDugdale
}

/// The law of an object: none of `None`, a class of the library, or a table of the functions that the object has.
pub fn law<T: Real>(object: &Bound<'_, PyAny>) -> PyResult<Box<dyn AdhesionLaw<T>>> {
    if object.is_none() {
        return Ok(Box::new(NoAdhesion));
    }
    if let Ok(law) = object.cast::<Exponential>() {
        return Ok(Box::new(law.get().0));
    }
    if let Ok(law) = object.cast::<MaugisDugdale>() {
        return Ok(Box::new(law.get().0));
    }
    Ok(Box::new(Table::of(&Functions::of(object)?)?))
}

/// The three functions of a law, in the order in which each is the derivative of the one before.
#[derive(Clone, Copy)]
pub enum Function {
    Energy,
    Traction,
    Slope,
}

impl Function {
    pub const ALL: [Self; 3] = [Self::Energy, Self::Traction, Self::Slope];

    /// The name of the method.
    fn method(self) -> &'static str {
        match self {
            Self::Energy => "energy",
            Self::Traction => "traction",
            Self::Slope => "slope",
        }
    }

    /// The name in messages, as the library has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Energy => "adhesive energy",
            Self::Traction => "adhesive traction",
            Self::Slope => "slope of the adhesive traction",
        }
    }
}

/// An object of Python with the methods `energy`, `traction` and `slope` of an array of gaps.
pub struct Functions<'py> {
    object: Bound<'py, PyAny>,
}

impl<'py> Functions<'py> {
    /// The functions of an object.
    ///
    /// # Errors
    /// `TypeError` if it lacks one.
    pub fn of(object: &Bound<'py, PyAny>) -> PyResult<Self> {
        for method in Function::ALL.map(Function::method) {
            if !object.getattr(method).is_ok_and(|method| method.is_callable()) {
                let class = object.get_type().name()?;
                return Err(PyTypeError::new_err(format!(
                    "law is a {class} without a method {method}(gap): it must have energy, traction and slope, each of \
                     an array of gaps, or be asperity.Exponential, asperity.MaugisDugdale or None"
                )));
            }
        }
        Ok(Self { object: object.clone() })
    }

    /// A function at many gaps, in one call.
    ///
    /// # Errors
    /// What the method raises, and `ValueError` if it returns another number of values.
    pub fn at(&self, function: Function, gaps: &[f64]) -> PyResult<Vec<f64>> {
        let method = function.method();
        let found: Numbers<'_> =
            self.object.call_method1(method, (PyArray1::from_slice(self.object.py(), gaps),))?.extract()?;
        let found = found.as_array();
        match found.len() {
            1 => Ok(vec![found.sum(); gaps.len()]),
            count if count == gaps.len() => Ok(found.iter().copied().collect()),
            _ => Err(PyValueError::new_err(format!(
                "law.{method} returned an array of shape {:?} for gaps of shape [{}]: it must return one value for \
                 each gap",
                found.shape(),
                gaps.len()
            ))),
        }
    }

    /// A number that the object may have as an attribute.
    pub fn number(&self, name: &str) -> PyResult<Option<f64>> {
        match self.object.getattr_opt(name)? {
            Some(value) if !value.is_none() => value.extract().map(Some),
            _ => Ok(None),
        }
    }
}

/// A law of Python, called for each gap; keeps the first exception.
struct Called {
    object: Py<PyAny>,
    raised: Mutex<Option<PyErr>>,
}

impl Called {
    fn at(&self, function: Function, gap: f64) -> f64 {
        let found = Python::attach(|py| Functions { object: self.object.bind(py).clone() }.at(function, &[gap]));
        found.map(|values| values[0]).unwrap_or_else(|error| {
            self.raised.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            f64::NAN
        })
    }
}

impl AdhesionLaw<f64> for Called {
    fn energy(&self, gap: f64) -> f64 {
        self.at(Function::Energy, gap)
    }
    fn traction(&self, gap: f64) -> f64 {
        self.at(Function::Traction, gap)
    }
    fn slope(&self, gap: f64) -> f64 {
        self.at(Function::Slope, gap)
    }
}

/// Tells whether the three functions of a law agree with one another.
///
/// Compares the traction with differences of the energy, and the slope with differences of the traction, at 200 gaps.
///
/// Parameters
/// ----------
/// law : object
///     With the methods energy(gap), traction(gap) and slope(gap) of an array of gaps g ≥ 0, each of which returns an
///     array of the same shape: the energy per area φ(g), its derivative φ'(g), positive where the surfaces attract
///     each other, and the traction's derivative φ''(g). Attributes `work_of_adhesion`, −φ(0) by default, and `range`,
///     the length over which the traction decays, w/φ'(0) by default, say how far the grid has to resolve it.
/// largest_gap : float
///     Largest gap, a length.
///
/// Raises
/// ------
/// ValueError
///     With the function that is wrong, the gap, and what it should be there.
///
/// Examples
/// --------
/// >>> import asperity
/// >>> class Linear:
/// ...     "A traction that falls linearly to zero at the range."
/// ...     work_of_adhesion, range = 1e-4, 2e-3
/// ...     def energy(self, gap):
/// ...         return -1e-4 * (1 - gap / 2e-3).clip(0) ** 2
/// ...     def traction(self, gap):
/// ...         return 0.1 * (1 - gap / 2e-3).clip(0)
/// ...     def slope(self, gap):
/// ...         return -50.0 * (gap < 2e-3)
/// >>> asperity.check_law(Linear(), largest_gap=0.01)
#[pyfunction]
pub fn check_law(law: &Bound<'_, PyAny>, largest_gap: f64) -> PyResult<()> {
    Functions::of(law)?;
    let called = Called { object: law.clone().unbind(), raised: Mutex::new(None) };
    let checked = asperity::check_law(&called, largest_gap);
    match called.raised.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(error),
        None => checked.map_err(refusal),
    }
}
