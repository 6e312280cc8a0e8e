//! Exact solutions at many loads at once.

use asperity::exact::{self, Sphere};
use numpy::ndarray::{ArrayD, IxDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::numbers::{Numbers, mapped, returned, tried};
use crate::refusal::refusal;

/// A function of a state and a place, at all places of all states: the shape of the states, then that of the places.
fn fields<'py, S>(
    py: Python<'py>,
    states: &ArrayD<S>,
    places: &Numbers<'py>,
    of: impl Fn(&S, f64) -> f64,
) -> PyResult<Bound<'py, PyAny>> {
    let places = places.as_array();
    let shape: Vec<usize> = states.shape().iter().chain(places.shape()).copied().collect();
    let values = states.iter().flat_map(|state| places.iter().map(|&place| of(state, place)).collect::<Vec<_>>());
    let values = ArrayD::from_shape_vec(IxDyn(&shape), values.collect());
    returned(py, values.map_err(|error| PyValueError::new_err(error.to_string()))?)
}

/// A property of states, as a getter.
macro_rules! states {
    ($class:ident($state:ty) { $($property:ident,)* } { $($field:ident($place:ident),)* }) => {
        #[doc = concat!("States of the exact solution: `asperity::exact::", stringify!($class), "`.")]
        #[pyclass(frozen, module = "asperity.exact")]
        pub struct $class(ArrayD<$state>);

        #[pymethods]
        impl $class {
            $(#[getter]
            fn $property<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                returned(py, self.0.map(|state| state.$property()))
            })*
            $(fn $field<'py>(&self, py: Python<'py>, $place: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
                fields(py, &self.0, &$place, |state, place| state.$field(place))
            })*
        }
    };
}

states!(Contact(exact::Contact) {
    contact_radius, adhesion_radius, load, approach, radius_of_curvature, second_moment,
} { pressure(r), gap(r), displacement(r), deflection(r), });

states!(WaveContact(exact::WaveContact) { half_width, mean_pressure, mean_gap, } {
    pressure(x), gap(x), displacement(x),
});

/// A solution for a sphere as a class.
macro_rules! sphere {
    ($class:ident as $name:literal ($($parameter:ident),*) { $($more:tt)* }) => {
        #[doc = concat!("The exact solution `asperity::exact::", $name, "`.")]
        #[pyclass(frozen, name = $name, module = "asperity.exact")]
        pub struct $class(exact::$class);

        #[pymethods]
        impl $class {
            #[new]
            fn new($($parameter: f64),*) -> PyResult<Self> {
                exact::$class::new($($parameter),*).map(Self).map_err(refusal)
            }
            fn at_load(&self, load: Numbers<'_>) -> PyResult<Contact> {
                tried(load.as_array(), |load| self.0.at_load(load).map_err(refusal)).map(Contact)
            }
            fn at_approach(&self, approach: Numbers<'_>) -> PyResult<Contact> {
                tried(approach.as_array(), |approach| self.0.at_approach(approach).map_err(refusal)).map(Contact)
            }
            fn at_contact_radius(&self, radius: Numbers<'_>) -> PyResult<Contact> {
                tried(radius.as_array(), |radius| self.0.at_contact_radius(radius).map_err(refusal)).map(Contact)
            }
            fn pull_off(&self) -> Contact {
                Contact(ArrayD::from_elem(IxDyn(&[]), self.0.pull_off()))
            }
            $($more)*
        }
    };
}

sphere!(Hertz as "Hertz" (radius, modulus) {});
sphere!(Jkr as "Jkr" (radius, modulus, work_of_adhesion) {});
sphere!(MaugisDugdale as "MaugisDugdale" (radius, modulus, work_of_adhesion, range) {
    #[getter]
    fn tabor_parameter(&self) -> f64 {
        self.0.tabor_parameter()
    }
});

/// A solution for a wave as a class.
macro_rules! wave {
    ($class:ident($($parameter:ident),*) { $($more:tt)* }) => {
        #[doc = concat!("The exact solution `asperity::exact::", stringify!($class), "`.")]
        #[pyclass(frozen, module = "asperity.exact")]
        pub struct $class(exact::$class);

        #[pymethods]
        impl $class {
            #[new]
            fn new($($parameter: f64),*) -> PyResult<Self> {
                exact::$class::new($($parameter),*).map(Self).map_err(refusal)
            }
            #[getter]
            fn closing_pressure(&self) -> f64 {
                self.0.closing_pressure()
            }
            fn at_half_width(&self, half_width: Numbers<'_>) -> PyResult<WaveContact> {
                tried(half_width.as_array(), |a| self.0.at_half_width(a).map_err(refusal)).map(WaveContact)
            }
            fn at_mean_pressure(&self, mean_pressure: Numbers<'_>) -> PyResult<WaveContact> {
                tried(mean_pressure.as_array(), |p| self.0.at_mean_pressure(p).map_err(refusal)).map(WaveContact)
            }
            fn at_mean_gap(&self, mean_gap: Numbers<'_>) -> PyResult<WaveContact> {
                tried(mean_gap.as_array(), |gap| self.0.at_mean_gap(gap).map_err(refusal)).map(WaveContact)
            }
            $($more)*
        }
    };
}

wave!(WavyLine(amplitude, wavelength, modulus) {});
wave!(AdhesiveWavyLine(amplitude, wavelength, modulus, work_of_adhesion) {
    #[getter]
    fn alpha(&self) -> f64 {
        self.0.alpha()
    }
    fn pull_off(&self) -> PyResult<WaveContact> {
        Ok(WaveContact(ArrayD::from_elem(IxDyn(&[]), self.0.pull_off().map_err(refusal)?)))
    }
    fn jump_to_full_contact(&self) -> PyResult<WaveContact> {
        Ok(WaveContact(ArrayD::from_elem(IxDyn(&[]), self.0.jump_to_full_contact().map_err(refusal)?)))
    }
});

/// The mean pressure that closes a two-dimensional wave.
#[pyfunction]
pub fn closing_pressure_2d<'py>(
    py: Python<'py>,
    amplitude: Numbers<'py>,
    wavelength: f64,
    modulus: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let unit = exact::closing_pressure_2d(1.0, wavelength, modulus).map_err(refusal)?;
    mapped(py, &amplitude, |amplitude| amplitude * unit)
}
