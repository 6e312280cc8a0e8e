//! Functions of Python that are asked for arrays: of a law that is an object, and the stiffness of waves.

use std::sync::Arc;

use asperity::Error;
use asperity_scene::{Stiffness, Symbol};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::numbers::Numbers;

/// The methods of a law, in the order in which each is the derivative of the one before.
const METHODS: [&str; 3] = ["energy", "traction", "slope"];

/// An object of Python with the methods `energy`, `traction` and `slope` of an array of gaps.
pub struct Functions {
    object: Py<PyAny>,
    pub work_of_adhesion: Option<f64>,
    pub range: Option<f64>,
}

impl Functions {
    /// The functions of an object, with the scales that it has as attributes.
    ///
    /// # Errors
    /// `TypeError` if it lacks a function.
    pub fn from_object(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let scales = object.py().import("asperity.common.functions")?.call_method1("read_scales", (object,))?;
        let (work_of_adhesion, range) = scales.extract()?;
        Ok(Self { object: object.clone().unbind(), work_of_adhesion, range })
    }
}

impl asperity::adhesion::Functions for Functions {
    fn set(&self, order: usize, gaps: &[f64], values: &mut [f64]) -> asperity::Result<()> {
        // a function of one gap alone also takes an array of one
        let gaps = if let &[gap] = gaps { &[gap; 2] } else { gaps };
        let method = METHODS[order];
        let at = |py: Python<'_>| {
            at_arrays(&self.object.bind(py).getattr(method)?, &format!("law.{method}"), "gap", &[gaps], true)
        };
        let found: Vec<f64> = Python::attach(at).map_err(Error::raised)?;
        values.iter_mut().zip(found).for_each(|(value, found)| *value = found);
        Ok(())
    }

    fn work_of_adhesion(&self) -> Option<f64> {
        self.work_of_adhesion
    }

    fn range(&self) -> Option<f64> {
        self.range
    }
}

/// A function of arrays, by its name, at many of what it is a function `of`, in one call; `one_of_all` if one value may
/// stand for all.
///
/// # Errors
/// The exception of the function, `TypeError` if it returns complex values, and `ValueError` if it returns another number
/// of them.
pub fn at_arrays(
    function: &Bound<'_, PyAny>,
    name: &str,
    of: &str,
    arrays: &[&[f64]],
    one_of_all: bool,
) -> PyResult<Vec<f64>> {
    let py = function.py();
    let arrays: Vec<_> = arrays.iter().map(|array| PyArray1::from_slice(py, array)).collect();
    let called =
        py.import("asperity.common.functions")?.call_method1("evaluate", (function, name, of, arrays, one_of_all))?;
    Ok(called.extract::<Numbers<'_>>()?.as_array().iter().copied().collect())
}

/// A function of Python: of the magnitudes of the wave numbers, or of their two components.
struct Called {
    function: Py<PyAny>,
    name: String,
    is_isotropic: bool,
}

/// The body of a function, by its name, that depends on the magnitude of the wave number alone, or not.
pub fn symbol_of((function, name, is_isotropic): (Py<PyAny>, String, bool)) -> Symbol {
    Symbol(Arc::new(Called { function, name, is_isotropic }))
}

impl Stiffness for Called {
    fn name(&self) -> &str {
        &self.name
    }

    fn is_isotropic(&self) -> bool {
        self.is_isotropic
    }

    fn at(&self, qx: &[f64], qy: &[f64]) -> asperity::Result<Vec<f64>> {
        let magnitudes: Vec<f64>;
        let arrays = match self.is_isotropic {
            true => {
                magnitudes = qx.iter().zip(qy).map(|(qx, qy)| qx.hypot(*qy)).collect();
                vec![&*magnitudes]
            }
            false => vec![qx, qy],
        };
        Python::attach(|py| at_arrays(self.function.bind(py), &self.name, "wave", &arrays, false))
            .map_err(Error::raised)
    }
}
