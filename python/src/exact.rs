//! Exact solutions and theories at many loads at once; what users see, with its words, is in the folder `asperity/exact`.

use asperity::exact::{self, Sphere};
use numpy::ndarray::{ArrayD, IxDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::numbers::{Numbers, mapped, returned, tried};
use crate::refusal::refusal;

/// A function of a state and a place, at all places of all states: the shape of the states, then the shape of the
/// places.
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

/// States of a solution, with their numbers as getters and their fields as functions of places.
macro_rules! states {
    ($class:ident { $($property:ident),* } { $($field:ident($place:ident)),* }) => {
        #[pyclass(frozen, module = "asperity.exact")]
        pub struct $class(ArrayD<exact::$class>);

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

states! {
    Contact { contact_radius, adhesion_radius, load, approach, radius_of_curvature, second_moment }
    { pressure(r), gap(r), displacement(r), deflection(r) }
}
states! { WaveContact { half_width, mean_pressure, mean_gap } { pressure(x), gap(x), displacement(x) } }

/// A solution as a class: its states at the likes of loads, single states, and numbers of its own.
macro_rules! solution {
    (
        $class:ident($($parameter:ident),*) -> $states:ident;
        at { $($at:ident($place:ident))* }
        one { $($one:ident($of:ident) $found:expr;)* }
        number { $($number:ident)* }
    ) => {
        #[pyclass(frozen, module = "asperity.exact")]
        pub struct $class(exact::$class);

        #[pymethods]
        impl $class {
            #[new]
            fn new($($parameter: f64),*) -> PyResult<Self> {
                exact::$class::new($($parameter),*).map(Self).map_err(refusal)
            }
            $(fn $at(&self, $place: Numbers<'_>) -> PyResult<$states> {
                tried($place.as_array(), |place| self.0.$at(place)).map($states)
            })*
            $(fn $one(&self) -> PyResult<$states> {
                let $of = &self.0;
                Ok($states(ArrayD::from_elem(IxDyn(&[]), $found)))
            })*
            $(#[getter]
            fn $number(&self) -> f64 {
                self.0.$number()
            })*
        }
    };
}

/// A solution for a sphere.
macro_rules! sphere {
    ($class:ident($($parameter:ident),*); $($number:ident)*) => {
        solution! {
            $class($($parameter),*) -> Contact;
            at { at_load(load) at_approach(approach) at_contact_radius(radius) }
            one { pull_off(sphere) sphere.pull_off(); }
            number { $($number)* }
        }
    };
}

sphere! { Hertz(radius, modulus); }
sphere! { Jkr(radius, modulus, work_of_adhesion); }
sphere! { MaugisDugdale(radius, modulus, work_of_adhesion, range); tabor_parameter }

/// A solution for a wave.
macro_rules! wave {
    ($class:ident($($parameter:ident),*); $one:tt $($number:ident)*) => {
        solution! {
            $class($($parameter),*) -> WaveContact;
            at { at_half_width(half_width) at_mean_pressure(mean_pressure) at_mean_gap(mean_gap) }
            one $one
            number { closing_pressure $($number)* }
        }
    };
}

wave! { WavyLine(amplitude, wavelength, modulus); {} }
wave! {
    AdhesiveWavyLine(amplitude, wavelength, modulus, work_of_adhesion);
    {
        pull_off(wave) wave.pull_off().map_err(refusal)?;
        jump_to_full_contact(wave) wave.jump_to_full_contact().map_err(refusal)?;
    }
    alpha
}

/// The mean pressure √2πE*h₀/λ that closes a wave h₀ cos(2πx/λ) cos(2πy/λ), without adhesion.
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

/// The wave numbers, densities, numbers of waves and area of a wave of a spectrum.
type Spectrum<'py> = (Numbers<'py>, Numbers<'py>, Numbers<'py>, f64);

/// Persson's theory.
#[pyclass(frozen, module = "asperity.exact")]
pub struct Persson(exact::Persson);

#[pymethods]
impl Persson {
    #[new]
    fn new(rms_slope: f64, modulus: f64, spectrum: Option<Spectrum<'_>>) -> PyResult<Self> {
        let parts = spectrum.iter().flat_map(|(wave_numbers, densities, waves, cell)| {
            let parts = densities.as_array().into_iter().zip(waves.as_array()).map(move |(d, waves)| d * waves * cell);
            wave_numbers.as_array().into_iter().copied().zip(parts)
        });
        exact::Persson::new(rms_slope, modulus, parts).map(Self).map_err(refusal)
    }

    fn contact_fraction<'py>(&self, py: Python<'py>, mean_pressure: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        returned(py, tried(mean_pressure.as_array(), |pressure| self.0.contact_fraction(pressure))?)
    }

    fn mean_gap<'py>(&self, py: Python<'py>, mean_pressure: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        returned(py, tried(mean_pressure.as_array(), |pressure| self.0.mean_gap(pressure))?)
    }
}

/// The theory of Greenwood and Williamson.
#[pyclass(frozen, module = "asperity.exact")]
pub struct GreenwoodWilliamson(exact::GreenwoodWilliamson);

#[pymethods]
impl GreenwoodWilliamson {
    #[new]
    fn new(rms_height: f64, rms_slope: f64, rms_curvature: f64, modulus: f64) -> PyResult<Self> {
        exact::GreenwoodWilliamson::new(rms_height, rms_slope, rms_curvature, modulus).map(Self).map_err(refusal)
    }

    /// The number of asperities per area, the radius of their curvature, and the rms of their heights.
    #[getter]
    fn asperities(&self) -> (f64, f64, f64) {
        (self.0.density, self.0.radius, self.0.height)
    }

    fn contact_fraction<'py>(&self, py: Python<'py>, mean_pressure: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        returned(py, tried(mean_pressure.as_array(), |pressure| self.0.contact_fraction(pressure))?)
    }
}
