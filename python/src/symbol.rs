//! The stiffness of waves as a function of Python, asked of all waves of a grid at once.

use asperity::{Error, Result};
use asperity_scene::{Stiffness, Symbol};
use pyo3::prelude::*;

use crate::functions::at_arrays;

/// A function of Python: of the magnitudes of the wave numbers, or of their two components.
struct Called {
    function: Py<PyAny>,
    name: String,
    is_isotropic: bool,
}

/// The body of a function, by its name, that depends on the magnitude of the wave number alone, or not.
pub fn symbol((function, name, is_isotropic): (Py<PyAny>, String, bool)) -> Symbol {
    Symbol(std::sync::Arc::new(Called { function, name, is_isotropic }))
}

impl Stiffness for Called {
    fn name(&self) -> &str {
        &self.name
    }

    fn is_isotropic(&self) -> bool {
        self.is_isotropic
    }

    fn at(&self, qx: &[f64], qy: &[f64]) -> Result<Vec<f64>> {
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
