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
    ($(#[$doc:meta])* $class:ident($state:ty) { $($property:ident,)* } { $($field:ident($place:ident),)* }) => {
        $(#[$doc])*
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

states! {
    /// Axisymmetric contacts of a paraboloid −r²/2R with a half-space; numbers have the shape of what they were found
    /// at.
    ///
    /// Attributes
    /// ----------
    /// contact_radius, adhesion_radius : float or ndarray
    ///     Radii up to which the surfaces touch, and attract each other.
    /// load : float or ndarray
    ///     Load P, compression positive.
    /// approach : float or ndarray
    ///     Approach δ of the half-space at infinity.
    /// radius_of_curvature, second_moment : float or ndarray
    ///     Radius R, and the integral of r²p.
    ///
    /// Notes
    /// -----
    /// pressure(r), gap(r), displacement(r), which is u = h + g, and deflection(r), which is u + δ, are fields at the
    /// distances r ≥ 0 from the axis: the shape of the contacts, then that of r.
    Contact(exact::Contact) {
        contact_radius, adhesion_radius, load, approach, radius_of_curvature, second_moment,
    } { pressure(r), gap(r), displacement(r), deflection(r), }
}

states! {
    /// Contacts of a wave h₀ cos(2πx/λ) with a half-space; numbers have the shape of what they were found at.
    ///
    /// Attributes
    /// ----------
    /// half_width : float or ndarray
    ///     Half-width a of the contact about each crest.
    /// mean_pressure, mean_gap : float or ndarray
    ///     Mean pressure p̄ and mean gap.
    ///
    /// Notes
    /// -----
    /// pressure(x), gap(x) and displacement(x) are fields at the distances x from a crest: the shape of the contacts,
    /// then that of x.
    WaveContact(exact::WaveContact) { half_width, mean_pressure, mean_gap, } {
        pressure(x), gap(x), displacement(x),
    }
}

/// A solution for a sphere as a class.
macro_rules! sphere {
    ($(#[$doc:meta])* $class:ident as $name:literal ($($parameter:ident),*) { $($more:tt)* }) => {
        $(#[$doc])*
        #[pyclass(frozen, name = $name, module = "asperity.exact")]
        pub struct $class(exact::$class);

        #[pymethods]
        impl $class {
            #[new]
            fn new($($parameter: f64),*) -> PyResult<Self> {
                exact::$class::new($($parameter),*).map(Self).map_err(refusal)
            }
            /// Stable contacts at loads P, compression positive.
            fn at_load(&self, load: Numbers<'_>) -> PyResult<Contact> {
                tried(load.as_array(), |load| self.0.at_load(load).map_err(refusal)).map(Contact)
            }
            /// Stable contacts at approaches δ.
            fn at_approach(&self, approach: Numbers<'_>) -> PyResult<Contact> {
                tried(approach.as_array(), |approach| self.0.at_approach(approach).map_err(refusal)).map(Contact)
            }
            /// Contacts of radii a ≥ 0.
            fn at_contact_radius(&self, radius: Numbers<'_>) -> PyResult<Contact> {
                tried(radius.as_array(), |radius| self.0.at_contact_radius(radius).map_err(refusal)).map(Contact)
            }
            /// Contact of least load: the pull-off force is minus its load.
            fn pull_off(&self) -> Contact {
                Contact(ArrayD::from_elem(IxDyn(&[]), self.0.pull_off()))
            }
            $($more)*
        }
    };
}

sphere! {
    /// Hertz' contact of a sphere, without adhesion: P = 4E*a³/(3R), δ = a²/R.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Radius of curvature R, a length.
    /// modulus : float
    ///     Contact modulus E*, a pressure.
    Hertz as "Hertz" (radius, modulus) {}
}
sphere! {
    /// The contact of Johnson, Kendall and Roberts, with adhesion of no range.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Radius of curvature R, a length.
    /// modulus : float
    ///     Contact modulus E*, a pressure.
    /// work_of_adhesion : float
    ///     Work of adhesion w, an energy per area.
    Jkr as "Jkr" (radius, modulus, work_of_adhesion) {}
}
sphere! {
    /// Maugis' contact of a sphere, with a constant traction w/ρ up to a gap ρ.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Radius of curvature R, a length.
    /// modulus : float
    ///     Contact modulus E*, a pressure.
    /// work_of_adhesion : float
    ///     Work of adhesion w, an energy per area.
    /// range : float
    ///     Range ρ, a length.
    MaugisDugdale as "MaugisDugdale" (radius, modulus, work_of_adhesion, range) {
    /// Tabor parameter: large for JKR, small for DMT.
    #[getter]
    fn tabor_parameter(&self) -> f64 {
        self.0.tabor_parameter()
    }
    }
}

/// A solution for a wave as a class.
macro_rules! wave {
    ($(#[$doc:meta])* $class:ident($($parameter:ident),*) { $($more:tt)* }) => {
        $(#[$doc])*
        #[pyclass(frozen, module = "asperity.exact")]
        pub struct $class(exact::$class);

        #[pymethods]
        impl $class {
            #[new]
            fn new($($parameter: f64),*) -> PyResult<Self> {
                exact::$class::new($($parameter),*).map(Self).map_err(refusal)
            }
            /// Mean pressure at which the contact closes without adhesion.
            #[getter]
            /// Mean pressure at which the contact closes without adhesion.
    fn closing_pressure(&self) -> f64 {
                self.0.closing_pressure()
            }
            /// Contacts of half-widths a.
            fn at_half_width(&self, half_width: Numbers<'_>) -> PyResult<WaveContact> {
                tried(half_width.as_array(), |a| self.0.at_half_width(a).map_err(refusal)).map(WaveContact)
            }
            /// Contacts at mean pressures p̄: the stable ones.
            fn at_mean_pressure(&self, mean_pressure: Numbers<'_>) -> PyResult<WaveContact> {
                tried(mean_pressure.as_array(), |p| self.0.at_mean_pressure(p).map_err(refusal)).map(WaveContact)
            }
            /// Contacts at mean gaps: the stable ones.
            fn at_mean_gap(&self, mean_gap: Numbers<'_>) -> PyResult<WaveContact> {
                tried(mean_gap.as_array(), |gap| self.0.at_mean_gap(gap).map_err(refusal)).map(WaveContact)
            }
            $($more)*
        }
    };
}

wave! {
    /// Westergaard's contact of a wave on a line, without adhesion.
    ///
    /// Parameters
    /// ----------
    /// amplitude, wavelength : float
    ///     Amplitude h₀ and wavelength λ, lengths.
    /// modulus : float
    ///     Contact modulus E*, a pressure.
    WavyLine(amplitude, wavelength, modulus) {}
}
wave! {
    /// Johnson's contact of a wave on a line, with adhesion of no range.
    ///
    /// Parameters
    /// ----------
    /// amplitude, wavelength : float
    ///     Amplitude h₀ and wavelength λ, lengths.
    /// modulus : float
    ///     Contact modulus E*, a pressure.
    /// work_of_adhesion : float
    ///     Work of adhesion w, an energy per area.
    AdhesiveWavyLine(amplitude, wavelength, modulus, work_of_adhesion) {
    /// Johnson's parameter √(2wλ/(π²E*h₀²)).
    #[getter]
    fn alpha(&self) -> f64 {
        self.0.alpha()
    }
    /// Partial contact of least mean pressure, from which it opens.
    fn pull_off(&self) -> PyResult<WaveContact> {
        Ok(WaveContact(ArrayD::from_elem(IxDyn(&[]), self.0.pull_off().map_err(refusal)?)))
    }
    /// Partial contact of largest mean pressure, from which it jumps to full contact.
    fn jump_to_full_contact(&self) -> PyResult<WaveContact> {
        Ok(WaveContact(ArrayD::from_elem(IxDyn(&[]), self.0.jump_to_full_contact().map_err(refusal)?)))
    }
    }
}

/// The mean pressure √2πE*h₀/λ that closes a wave h₀ cos(2πx/λ) cos(2πy/λ), without adhesion.
///
/// Parameters
/// ----------
/// amplitude : float or array_like
///     Amplitudes h₀, lengths.
/// wavelength : float
///     Wavelength λ, a length.
/// modulus : float
///     Contact modulus E*, a pressure.
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
