//! Adhesion laws: those of the library as classes, and any object of Python with the three functions of a law.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use asperity::adhesion::{Discretisation, Hints, Values};
use asperity::{AdhesionLaw, NoAdhesion, Real};
use numpy::ndarray::ArrayD;
use numpy::{PyArray1, ToPyArray};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::functions::{self, Functions};
use crate::numbers::{Field, Numbers, mapped, returned};
use crate::refusal::{refusal, refusal_of_works};
use crate::table::Table;

/// A law in either precision.
#[derive(Clone, PartialEq)]
pub enum Form {
    Exponential(asperity::Exponential),
    MaugisDugdale(asperity::MaugisDugdale),
    LennardJones(asperity::LennardJones),
    Morse(asperity::Morse),
    PowerLaw(asperity::PowerLaw),
    Tabulated(asperity::Tabulated),
    CutOff(asperity::adhesion::CutOff<Box<Form>>),
    Varying(asperity::adhesion::Varying<Box<Form>>),
    /// That of an object of Python
    Table(Arc<Table>),
}

impl Form {
    /// The form of an object: that of a law of the library, or a table of the functions that it has.
    fn of(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        match object.cast::<Law>() {
            Ok(law) => Ok(law.get().0.clone()),
            Err(_) => Ok(Self::Table(Arc::new(Table::of(&Functions::of(object)?)?))),
        }
    }

    fn law<T: Real>(&self) -> &dyn AdhesionLaw<T> {
        match self {
            Self::Exponential(law) => law,
            Self::MaugisDugdale(law) => law,
            Self::LennardJones(law) => law,
            Self::Morse(law) => law,
            Self::PowerLaw(law) => law,
            Self::Tabulated(law) => law,
            Self::CutOff(law) => law,
            Self::Varying(law) => law,
            Self::Table(law) => law.as_ref(),
        }
    }
}

impl<T: Real> AdhesionLaw<T> for Form {
    fn energy(&self, gap: T) -> T {
        self.law().energy(gap)
    }
    fn traction(&self, gap: T) -> T {
        self.law().traction(gap)
    }
    fn slope(&self, gap: T) -> T {
        self.law().slope(gap)
    }
    fn hints(&self) -> Hints<T> {
        self.law().hints()
    }
    fn evaluate(&self, first: usize, gaps: &[T], values: Values<'_, T>) {
        self.law().evaluate(first, gaps, values);
    }
    fn adapted(&self, to: Discretisation<T>) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        self.law().adapted(to)
    }
}

/// The law of an object in the precision of a solve; no adhesion for `None`.
pub fn law<T: Real>(object: &Bound<'_, PyAny>) -> PyResult<Box<dyn AdhesionLaw<T>>> {
    if object.is_none() { Ok(Box::new(NoAdhesion)) } else { Ok(Box::new(Form::of(object)?)) }
}

/// The node at which the work of adhesion of an object is largest, if it varies.
pub fn strongest(object: &Bound<'_, PyAny>) -> Option<(usize, usize)> {
    let mut form = &object.cast::<Law>().ok()?.get().0;
    loop {
        match form {
            Form::Varying(law) => return Some(law.strongest()),
            Form::CutOff(law) => form = law.law(),
            _ => return None,
        }
    }
}

/// An adhesion law of the library: functions of the gap between the surfaces, a length.
#[pyclass(frozen, eq, subclass, module = "asperity")]
#[derive(Clone, PartialEq)]
pub struct Law(Form);

#[pymethods]
impl Law {
    /// Adhesive energy φ(g) per area, of the shape of the gaps.
    fn energy<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, &gap, 0)
    }
    /// Adhesive traction φ'(g), positive attracts, of the shape of the gaps.
    fn traction<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, &gap, 1)
    }
    /// Slope of the traction φ''(g), of the shape of the gaps.
    fn slope<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, &gap, 2)
    }
    /// The constructor's call, with its parameters by name.
    fn __repr__(law: &Bound<'_, Self>) -> PyResult<String> {
        let names: Vec<String> = law.getattr("__match_args__")?.extract()?;
        let values: Vec<Bound<'_, PyAny>> = law.call_method0("__getnewargs__")?.extract()?;
        let parameters = names.iter().zip(values).map(|(name, value)| Ok(format!("{name}={}", value.repr()?)));
        Ok(format!("{}({})", law.get_type().name()?, parameters.collect::<PyResult<Vec<_>>>()?.join(", ")))
    }
}

impl Law {
    /// Energies (0), tractions (1) or slopes (2) at gaps of any shape; where the work of adhesion varies, at one for each
    /// of its nodes or one for all.
    fn at<'py>(&self, py: Python<'py>, gap: &Numbers<'py>, order: usize) -> PyResult<Bound<'py, PyAny>> {
        let law: &dyn AdhesionLaw<f64> = self.0.law();
        let Some((nx, ny)) = law.hints().shape else {
            return mapped(py, gap, |gap| [law.energy(gap), law.traction(gap), law.slope(gap)][order]);
        };
        let gap = gap.as_array();
        let gap = if gap.len() == 1 { ArrayD::from_elem(vec![nx, ny], gap.sum()) } else { gap.to_owned() };
        if gap.len() != nx * ny {
            return Err(PyValueError::new_err(format!(
                "gap has shape {:?}: the work of adhesion varies, so that it must be [{nx}, {ny}], or one number",
                gap.shape()
            )));
        }
        let mut values = ArrayD::zeros(gap.shape());
        let gaps: Vec<f64> = gap.iter().copied().collect();
        law.evaluate(0, &gaps, Values::one(order, values.as_slice_mut().unwrap_or_default()));
        returned(py, values)
    }
}

/// The type of a parameter's name.
macro_rules! name {
    ($parameter:ident) => { &'static str };
}

/// Refuses keywords that a class does not have, with those that they may mean.
fn check_words(py: Python<'_>, class: &str, known: &[&str], other: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
    let Some(other) = other else { return Ok(()) };
    py.import("asperity._words")?.call_method1("check", (class, other, known)).map(|_| ())
}

/// The value of a parameter, refused if there is none.
fn given<V>(class: &str, parameter: &str, value: Option<V>) -> PyResult<V> {
    value.ok_or_else(|| PyTypeError::new_err(format!("{class}() is without {parameter}: give a number")))
}

/// A law of the library as a class: its parameters, and how it is made of them.
macro_rules! class {
    (
        $(#[$doc:meta])*
        $name:ident($($parameter:ident: $type:ty $(= $default:tt)?),*), $signature:literal, $make:expr
    ) => {
        $(#[$doc])*
        #[pyclass(frozen, extends = Law, module = "asperity")]
        pub struct $name { $($parameter: $type),* }

        #[pymethods]
        impl $name {
            #[classattr]
            #[expect(non_upper_case_globals, reason = "Python's name")]
            const __match_args__: ($(name!($parameter),)*) = ($(stringify!($parameter),)*);
            #[new]
            #[pyo3(signature = ($($parameter = None,)* **other), text_signature = $signature)]
            fn new(
                py: Python<'_>,
                $($parameter: Option<$type>,)*
                other: Option<&Bound<'_, PyDict>>,
            ) -> PyResult<PyClassInitializer<Self>> {
                let class = stringify!($name);
                check_words(py, class, &[$(stringify!($parameter)),*], other)?;
                $(let $parameter = given(class, stringify!($parameter), $parameter $(.or(Some($default)))?)?;)*
                let form: asperity::Result<Form> = $make;
                Ok(PyClassInitializer::from(Law(form.map_err(refusal)?)).add_subclass(Self { $($parameter),* }))
            }
            $(
                #[getter]
                fn $parameter(&self) -> $type {
                    self.$parameter
                }
            )*
            fn __getnewargs__(&self) -> ($($type,)*) {
                ($(self.$parameter,)*)
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
    Exponential(work_of_adhesion: f64, range: f64),
    "(work_of_adhesion, range)",
    asperity::Exponential::new(work_of_adhesion, range).map(Form::Exponential)
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
    MaugisDugdale(work_of_adhesion: f64, range: f64),
    "(work_of_adhesion, range)",
    asperity::MaugisDugdale::new(work_of_adhesion, range).map(Form::MaugisDugdale)
}
class! {
    /// The law of Lennard-Jones between two half-spaces, φ'(g) = 8w/3z₀ (x³ − x⁹) with x = z₀/g.
    ///
    /// It attracts beyond the equilibrium separation z₀, and repels below: for a solve with ``wall="none"``, where
    /// contact is where it repels. For one with ``wall="hard"`` it has to be cut at z₀, from which the gap counts then.
    ///
    /// Parameters
    /// ----------
    /// work_of_adhesion : float
    ///     Work of adhesion w > 0, an energy per area.
    /// range : float
    ///     Distance of rest z₀ > 0, a length.
    /// cut : bool
    ///     Leaves the repulsion to a wall at z₀: x = z₀/(z₀ + g).
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> law = asperity.LennardJones(work_of_adhesion=0.05, range=3e-10)
    /// >>> law.traction(3e-10), bool(law.traction(2.9e-10) < 0)
    /// (0.0, True)
    LennardJones(work_of_adhesion: f64, range: f64, cut: bool = false),
    "(work_of_adhesion, range, cut=False)",
    asperity::LennardJones::new(work_of_adhesion, range)
        .map(|law| Form::LennardJones(if cut { law.cut() } else { law }))
}
class! {
    /// The law of Morse, φ(g) = w (e² − 2e) with e = exp(−g/ρ): it attracts at g > 0, and repels at g < 0.
    ///
    /// With ``wall="none"`` it keeps the surfaces apart by itself; with a wall at g = 0 the attraction is what counts.
    ///
    /// Parameters
    /// ----------
    /// work_of_adhesion : float
    ///     Work of adhesion w > 0, an energy per area.
    /// range : float
    ///     Range ρ > 0, a length.
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> asperity.Morse(work_of_adhesion=0.05, range=5e-10).energy(0.0)
    /// -0.05
    Morse(work_of_adhesion: f64, range: f64),
    "(work_of_adhesion, range)",
    asperity::Morse::new(work_of_adhesion, range).map(Form::Morse)
}
class! {
    /// A power law, φ(g) = −w (1 + g/nρ)⁻ⁿ. Its tail reaches far: `CutOff` ends it.
    ///
    /// Parameters
    /// ----------
    /// work_of_adhesion : float
    ///     Work of adhesion w ≥ 0, an energy per area.
    /// range : float
    ///     Range ρ > 0, a length.
    /// exponent : float
    ///     Exponent n > 0 of the energy.
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> asperity.PowerLaw(work_of_adhesion=0.05, range=2e-9, exponent=3).traction(0.0)
    /// 25000000.0
    PowerLaw(work_of_adhesion: f64, range: f64, exponent: f64),
    "(work_of_adhesion, range, exponent)",
    asperity::PowerLaw::new(work_of_adhesion, range, exponent).map(Form::PowerLaw)
}
class! {
    /// The van der Waals attraction of two half-spaces, φ(g) = −A/12π(D₀ + g)². Its tail reaches far: `CutOff` ends it.
    ///
    /// Parameters
    /// ----------
    /// hamaker : float
    ///     Hamaker's constant A ≥ 0, an energy.
    /// range : float
    ///     Distance D₀ > 0 between the surfaces in contact, a length, often taken to be 0.165 nm.
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> law = asperity.VanDerWaals(hamaker=6e-20, range=0.165e-9)
    /// >>> f"work of adhesion {-law.energy(0.0):.4f} J/m²"
    /// 'work of adhesion 0.0585 J/m²'
    VanDerWaals(hamaker: f64, range: f64),
    "(hamaker, range)",
    asperity::PowerLaw::van_der_waals(hamaker, range).map(Form::PowerLaw)
}

/// A law of which the traction is a monotone cubic through the points of a table.
///
/// Parameters
/// ----------
/// gaps : array_like, shape (N,)
///     Gaps, lengths that rise from zero.
/// tractions : array_like, shape (N,)
///     Tractions, attraction positive; the last one is zero.
/// source : str, optional
///     File that they come from, as `read` sets it.
///
/// Examples
/// --------
/// >>> import asperity
/// >>> law = asperity.Tabulated([0.0, 1e-9, 2e-9], [50e6, 25e6, 0.0])
/// >>> f"{-law.energy(0.0):.3f}"
/// '0.050'
#[pyclass(frozen, extends = Law, module = "asperity")]
pub struct Tabulated {
    gaps: Vec<f64>,
    tractions: Vec<f64>,
    #[pyo3(get)]
    source: Option<String>,
}

#[pymethods]
impl Tabulated {
    #[classattr]
    #[expect(non_upper_case_globals, reason = "Python's name")]
    const __match_args__: (&str, &str, &str) = ("gaps", "tractions", "source");
    #[new]
    #[pyo3(signature = (gaps, tractions, source = None))]
    fn new(gaps: Numbers<'_>, tractions: Numbers<'_>, source: Option<String>) -> PyResult<PyClassInitializer<Self>> {
        let [gaps, tractions]: [Vec<f64>; 2] =
            [gaps, tractions].map(|values| values.as_array().iter().copied().collect());
        let law = Law(Form::Tabulated(asperity::Tabulated::new(&gaps, &tractions).map_err(refusal)?));
        Ok(PyClassInitializer::from(law).add_subclass(Self { gaps, tractions, source }))
    }
    /// The law of a file with a gap and a traction on each line.
    ///
    /// Parameters
    /// ----------
    /// path : str or path
    ///     A text of two columns, or ``.npy``.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Py<Self>> {
        Py::new(py, Self::of_file(&path).map_err(refusal)?)
    }
    #[getter]
    fn gaps<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.gaps.to_pyarray(py)
    }
    #[getter]
    fn tractions<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.tractions.to_pyarray(py)
    }
    fn __getnewargs__<'py>(
        &self,
        py: Python<'py>,
    ) -> (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Option<String>) {
        (self.gaps(py), self.tractions(py), self.source.clone())
    }
}

impl Tabulated {
    fn of_file(path: &Path) -> asperity::Result<PyClassInitializer<Self>> {
        let table = asperity_maps::io::read_field(path)?;
        let law = Law(Form::Tabulated(asperity_scene::tabulated(path, &table)?));
        let [gaps, tractions] = [0, 1].map(|column| table.column(column).to_vec());
        let source = Some(path.to_string_lossy().into_owned());
        Ok(PyClassInitializer::from(law).add_subclass(Self { gaps, tractions, source }))
    }
}

/// A law that ends at a gap, smoothly: zero from there on, with energy, traction and slope continuous.
///
/// It keeps its work of adhesion, its equilibrium separation, and its traction in contact; the energy that the tail had
/// is given back before the end.
///
/// Parameters
/// ----------
/// law : Law or an object of your own
///     Law that reaches further.
/// distance : float
///     Gap at which it ends, a length: at least a range of the law beyond contact, or beyond its equilibrium
///     separation.
///
/// Examples
/// --------
/// >>> import asperity
/// >>> law = asperity.CutOff(asperity.VanDerWaals(hamaker=6e-20, range=0.165e-9), distance=5e-9)
/// >>> law.traction(5e-9)
/// 0.0
#[pyclass(frozen, extends = Law, module = "asperity")]
pub struct CutOff {
    #[pyo3(get)]
    law: Py<PyAny>,
    #[pyo3(get)]
    distance: f64,
}

#[pymethods]
impl CutOff {
    #[classattr]
    #[expect(non_upper_case_globals, reason = "Python's name")]
    const __match_args__: (&str, &str) = ("law", "distance");
    #[new]
    fn new(law: &Bound<'_, PyAny>, distance: f64) -> PyResult<PyClassInitializer<Self>> {
        let form = Form::of(law)?;
        if matches!(form, Form::CutOff(_)) {
            return Err(PyValueError::new_err("the law is cut off already: give the law that it is made of"));
        }
        let form = asperity::adhesion::CutOff::new(Box::new(form), distance).map_err(refusal)?;
        let own = Self { law: law.clone().unbind(), distance };
        Ok(PyClassInitializer::from(Law(Form::CutOff(form))).add_subclass(own))
    }
    fn __getnewargs__(&self, py: Python<'_>) -> (Py<PyAny>, f64) {
        (self.law.clone_ref(py), self.distance)
    }
}

/// A law of which the work of adhesion differs from node to node: energy, traction and slope in proportion to it.
///
/// Parameters
/// ----------
/// law : Law or an object of your own
///     Law that varies; its own work of adhesion > 0 is replaced.
/// work_of_adhesion : array_like, shape (Nx, Ny) or (N,)
///     Works of adhesion ≥ 0 at the nodes of the heights, energies per area; x along the first axis, or that of the
///     dimensions x and y of a DataArray.
///
/// Examples
/// --------
/// >>> import numpy as np, asperity
/// >>> wetted = np.where(np.arange(64)[:, None] < 32, 0.07, 0.02) * np.ones((64, 64))
/// >>> law = asperity.Varying(asperity.Exponential(work_of_adhesion=0.07, range=2e-9), wetted)
/// >>> law.energy(0.0)[[0, 63], 0]
/// array([-0.07, -0.02])
#[pyclass(frozen, extends = Law, module = "asperity")]
pub struct Varying {
    #[pyo3(get)]
    law: Py<PyAny>,
    #[pyo3(get)]
    work_of_adhesion: Py<PyAny>,
}

#[pymethods]
impl Varying {
    #[classattr]
    #[expect(non_upper_case_globals, reason = "Python's name")]
    const __match_args__: (&str, &str) = ("law", "work_of_adhesion");
    #[new]
    fn new(law: &Bound<'_, PyAny>, work_of_adhesion: &Bound<'_, PyAny>) -> PyResult<PyClassInitializer<Self>> {
        let form = Form::of(law)?;
        if AdhesionLaw::<f64>::hints(&form).shape.is_some() {
            return Err(PyValueError::new_err("the law varies already: give the law that it is made of"));
        }
        let maps = law.py().import("asperity._topography")?;
        let (works, is_line): (Field<'_>, bool) =
            maps.call_method1("array_of", (work_of_adhesion, "works of adhesion"))?.extract()?;
        let works = works.to_array()?;
        let varying = asperity::adhesion::Varying::new(Box::new(form), works.view()).map_err(refusal_of_works)?;
        let works = if is_line { works.column(0).to_owned().into_dyn() } else { works.into_dyn() };
        let own = Self { law: law.clone().unbind(), work_of_adhesion: returned(law.py(), works)?.unbind() };
        Ok(PyClassInitializer::from(Law(Form::Varying(varying))).add_subclass(own))
    }
    fn __getnewargs__(&self, py: Python<'_>) -> (Py<PyAny>, Py<PyAny>) {
        (self.law.clone_ref(py), self.work_of_adhesion.clone_ref(py))
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
///     the length over which the traction decays, w/φ'(0) by default, say how far the grid has to resolve it. A law
///     that repels below some gap, at which it rests, keeps the surfaces apart with ``wall="none"``; by default it has
///     the work of adhesion −φ there, and the range w over its greatest attraction. It is asked for negative gaps, too,
///     unless its energy is infinite at zero gap.
/// largest_gap : float, optional
///     Largest gap, a length; ten ranges by default.
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
/// >>> asperity.check_law(Linear())
#[pyfunction]
#[pyo3(signature = (law, largest_gap = None))]
pub fn check_law(law: &Bound<'_, PyAny>, largest_gap: Option<f64>) -> PyResult<()> {
    match law.cast::<Law>() {
        Ok(law) => {
            let form = &law.get().0;
            asperity::adhesion::check_law::<f64>(form, largest_gap.unwrap_or_else(|| functions::far(form)))
                .map_err(refusal)
        }
        Err(_) => functions::check(law, largest_gap),
    }
}
