//! Adhesion laws: laws of the library as classes, and any object of Python with the three functions of a law.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use asperity::adhesion::{Formula, Values, check_functions};
use asperity::{AdhesionLaw, adhesion};
use asperity_scene::numbers::plain;
use asperity_scene::{Adhesion, Key, Quantities, QuantityEntry, Scalar, Skin, Wall, dimension_of_key, key};
use numpy::ndarray::ArrayD;
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::functions::Functions;
use crate::inputs::{keys, quantity};
use crate::numbers::{Field, Numbers, mapped, returned};
use crate::refusal::{refusal, refusal_of_works};

/// A number as it is typed: as one, or as a text with a unit.
#[derive(FromPyObject)]
pub enum Measure {
    #[pyo3(transparent, annotation = "float")]
    Number(f64),
    #[pyo3(transparent, annotation = "str")]
    Text(String),
}

/// The numbers of a law as they were typed, by their names in reports: all with units, or none.
#[derive(Clone, Default)]
pub struct LawNumbers {
    /// Those with a unit
    pub texts: Vec<(String, String)>,
    /// The first one without, if it has a dimension
    pub bare: Option<(String, f64)>,
}

impl LawNumbers {
    /// The number that was typed, in SI units if it has a unit.
    pub fn read(&mut self, key: &str, typed: Measure) -> PyResult<f64> {
        let value = match typed {
            Measure::Number(value) => {
                // zero is zero in all units
                if value != 0.0 && dimension_of_key(key).is_some() {
                    self.bare.get_or_insert_with(|| (key.to_owned(), value));
                }
                value
            }
            Measure::Text(text) => {
                let value = quantity(key, &text)?;
                self.texts.push((key.to_owned(), text));
                value
            }
        };
        self.quantities().check(Skin::Keywords).map_err(PyValueError::new_err)?;
        Ok(value)
    }

    /// The quantities among them.
    pub fn quantities(&self) -> Quantities {
        let of = |(key, text): (&String, String)| {
            let numbers = Key::named(key)?.any_value(&text).ok()?.numbers;
            Some(QuantityEntry::new(key, vec![text], &numbers, false))
        };
        let texts = self.texts.iter().map(|(key, text)| (key, text.clone()));
        texts.chain(self.bare.iter().map(|(key, value)| (key, plain(*value)))).filter_map(of).collect()
    }
}

/// An adhesion law of the library: functions of the gap between the surfaces, a length.
#[pyclass(frozen, eq, subclass, module = "asperity")]
#[derive(Clone)]
pub struct Law {
    pub formula: Formula,
    /// Its part of a report; of the wall it says no more than whether the law is made for one
    pub adhesion: Adhesion,
    pub given: LawNumbers,
}

impl PartialEq for Law {
    fn eq(&self, other: &Self) -> bool {
        *self.formula == *other.formula
    }
}

#[pymethods]
impl Law {
    #[new]
    fn new(law: &Bound<'_, Self>) -> Self {
        law.get().clone()
    }
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
    /// The numbers that were given with a unit, as texts by their names in reports, and the first one that has none.
    #[getter]
    fn given(&self) -> (HashMap<String, String>, Option<(String, f64)>) {
        (self.given.texts.iter().cloned().collect(), self.given.bare.clone())
    }
}

impl Law {
    /// The law of an object: one of the library, a table of the functions that it has, or no adhesion for `None`.
    pub fn from_object(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        if object.is_none() {
            return Self::of_library(Adhesion::default());
        }
        Self::some(object)
    }

    /// The law of an object that is one.
    fn some(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(law) = object.cast::<Self>() {
            return Ok(law.get().clone());
        }
        let functions = Functions::from_object(object)?;
        let Functions { work_of_adhesion, range, .. } = functions;
        let formula: Formula = asperity::Tabulated::of(functions).map_err(refusal)?.into();
        let law = object.get_type().name()?.to_string();
        let adhesion = Adhesion { law, work_of_adhesion, range, ..Adhesion::default() };
        Ok(Self { formula, adhesion, given: LawNumbers::default() })
    }

    /// The law of the library that a description has.
    pub fn of_library(adhesion: Adhesion) -> PyResult<Self> {
        Ok(Self { formula: adhesion.formula(None).map_err(refusal)?, adhesion, given: LawNumbers::default() })
    }

    /// Energies (0), tractions (1) or slopes (2) at gaps of any shape; where the work of adhesion varies, at one for each
    /// of its nodes or one for all.
    fn at<'py>(&self, py: Python<'py>, gap: &Numbers<'py>, order: usize) -> PyResult<Bound<'py, PyAny>> {
        let law = f64::law(self.formula.clone());
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

/// The law of the library of a name and numbers as they were typed, with these; one that is cut leaves the repulsion to
/// a wall.
#[pyfunction]
pub fn law(name: &str, typed: &Bound<'_, PyDict>, cut: Option<bool>) -> PyResult<(Law, Vec<f64>)> {
    let (mut given, mut numbers, described) = (LawNumbers::default(), Vec::new(), PyDict::new(typed.py()));
    described.set_item("law", name)?;
    for (key, value) in typed {
        let key: String = key.extract()?;
        let number = given.read(&key, value.extract()?)?;
        described.set_item(key, number)?;
        numbers.push(number);
    }
    let mut adhesion: Adhesion = keys(described.into_any())?;
    if let Some(cut) = cut {
        adhesion.wall = if cut { Wall::Hard } else { Wall::None };
    }
    Ok((Law { given, ..Law::of_library(adhesion)? }, numbers))
}

/// A law by a table, with its gaps and tractions and their source.
type Table<'py> = (Law, (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Option<String>));

fn table(
    py: Python<'_>,
    law: asperity::Tabulated,
    [gaps, tractions]: [Vec<f64>; 2],
    source: Option<String>,
) -> Table<'_> {
    let law_table = source.clone().or_else(|| Some("array".to_owned()));
    let adhesion = Adhesion { law: "table".to_owned(), law_table, ..Adhesion::default() };
    let law = Law { formula: Arc::new(law), adhesion, given: LawNumbers::default() };
    (law, (gaps.into_pyarray(py), tractions.into_pyarray(py), source))
}

/// The law of gaps and tractions.
#[pyfunction]
pub fn tabulated<'py>(
    py: Python<'py>,
    gaps: Numbers<'py>,
    tractions: Numbers<'py>,
    source: Option<String>,
) -> PyResult<Table<'py>> {
    let columns = [gaps, tractions].map(|values| values.as_array().iter().copied().collect::<Vec<_>>());
    let law = asperity::Tabulated::new(&columns[0], &columns[1]).map_err(refusal)?;
    Ok(table(py, law, columns, source))
}

/// The law of a file with a gap and a traction on each line.
#[pyfunction]
pub fn read_law(py: Python<'_>, path: PathBuf) -> PyResult<Table<'_>> {
    let (law, read) = asperity_scene::read_law(&path).map_err(refusal)?;
    let columns = [0, 1].map(|column| read.column(column).to_vec());
    Ok(table(py, law, columns, Some(path.to_string_lossy().into_owned())))
}

/// A law that ends at a distance, and the distance as a number.
#[pyfunction]
pub fn cut_off(law: &Bound<'_, PyAny>, distance: Measure) -> PyResult<(Law, f64)> {
    let Law { formula, adhesion, mut given } = Law::some(law)?;
    let distance = given.read(key!(Adhesion, cut_off), distance)?;
    if formula.is_cut_off() {
        return Err(PyValueError::new_err("the law is cut off already: give the law itself"));
    }
    let formula = formula.cut_off(distance).map_err(refusal)?;
    // the innermost of several
    let adhesion = Adhesion { cut_off: adhesion.cut_off.or(Some(distance)), ..adhesion };
    Ok((Law { formula, adhesion, given }, distance))
}

/// A law with a work of adhesion that differs from node to node.
#[pyfunction]
pub fn varied(law: &Bound<'_, PyAny>, works: Field<'_>) -> PyResult<Law> {
    let Law { formula, adhesion, mut given } = Law::some(law)?;
    given.texts.retain(|(key, _)| key != key!(Adhesion, work_of_adhesion));
    if AdhesionLaw::<f64>::hints(&formula).shape.is_some() {
        return Err(PyValueError::new_err("the law varies already: give the law itself"));
    }
    let formula = formula.varied(works.as_array()).map_err(refusal_of_works)?;
    let work_of_adhesion_map = Some("array".to_owned());
    Ok(Law { formula, adhesion: Adhesion { work_of_adhesion: None, work_of_adhesion_map, ..adhesion }, given })
}

/// Tells whether the three functions of a law agree with one another.
///
/// Compares the traction with differences of the energy, and the slope with differences of the traction, at 200 gaps.
///
/// Parameters
/// ----------
/// law : object
///     With the methods energy(gap), traction(gap) and slope(gap) of an array of gaps g ≥ 0, which return arrays of the
///     same shape: the energy per area φ(g), its derivative φ'(g), positive where the surfaces attract each other, and
///     the traction's derivative φ''(g). Attributes `work_of_adhesion`, −φ(0) by default, and `range`, the length over
///     which the traction decays, w/φ'(0) by default, say how far the grid has to resolve it. A law that repels below
///     some gap, at which it rests, keeps the surfaces apart with ``wall="none"``; by default it has the work of
///     adhesion −φ there, and the range w over its greatest attraction. It is asked for negative gaps, too, unless its
///     energy is infinite at zero gap.
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
    let checked = match law.cast::<Law>() {
        Ok(law) => {
            let law = f64::law(law.get().formula.clone());
            adhesion::check_law(&law, largest_gap.unwrap_or_else(|| law.hints().far()))
        }
        Err(_) => check_functions(Functions::from_object(law)?, largest_gap),
    };
    checked.map_err(refusal)
}
