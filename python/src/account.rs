//! The account of a solve, and the dictionary in which Python gets it.

use asperity::contact::ContactArea;
use asperity::stability::Stability;
use asperity::{Control, Grid, Real, Solution, Warning};
use numpy::ndarray::Array2;
use numpy::{Element, IntoPyArray};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::refusal::refusal;
use crate::report;

/// A scalar in which one can solve, and that numpy has.
pub trait Scalar: Real + Element {}
impl<T: Real + Element> Scalar for T {}

/// The account of a solve: all that the report and the solution of Python have.
pub struct Account<T> {
    pub solution: Solution<T>,
    pub contact: Array2<bool>,
    pub area: ContactArea,
    /// The least (most tensile) and the greatest elastic pressure.
    pub pressures: (f64, f64),
    pub control: Control,
    pub stability: Option<Stability<T>>,
    /// The eigenvalue, energy drop and distance of each unstable equilibrium that was left.
    pub departures: Option<Vec<(f64, f64, f64)>>,
    pub warnings: Vec<Warning>,
    pub seconds: f64,
}

impl<T: Scalar> Account<T> {
    /// The account of a solution, with the warnings of the answer alone.
    pub fn of(solution: Solution<T>, grid: &Grid, modulus: f64, control: Control) -> asperity::Result<Self> {
        let contact = || {
            let map = solution.contact_map();
            ContactArea::of_solution(&solution, map.view(), grid).map(|area| (map, area))
        };
        let (contact, pressures) = rayon::join(contact, || extremes(&solution.pressure));
        let (contact, area) = contact?;
        let warnings = Warning::of_solution(&solution, modulus);
        let (stability, departures, seconds) = (None, None, 0.0);
        Ok(Self { solution, contact, area, pressures, control, stability, departures, warnings, seconds })
    }
}

/// The dictionary of an account, and the exception that ended its solve early.
pub fn returned<'py, T: Scalar>(
    py: Python<'py>,
    found: (asperity::Result<Account<T>>, Option<PyErr>),
) -> PyResult<Bound<'py, PyDict>> {
    let (account, raised) = match found {
        (Ok(account), raised) => (account, raised),
        (Err(_), Some(raised)) => return Err(raised),
        (Err(error), None) => return Err(refusal(error)),
    };
    let found = PyDict::new(py);
    found.set_item("report", report::of(py, &account)?)?;
    found.set_item("bodies", report::of_bodies(py, &account)?)?;
    let Account { solution, contact, stability, .. } = account;
    found.set_item("gap", solution.gap.into_pyarray(py))?;
    found.set_item("pressure", solution.pressure.into_pyarray(py))?;
    found.set_item("contact_pressure", solution.contact_pressure.into_pyarray(py))?;
    found.set_item("contact", contact.into_pyarray(py))?;
    found.set_item("mode", stability.map(|stability| stability.mode.into_pyarray(py)))?;
    found.set_item("raised", raised)?;
    Ok(found)
}

/// The least and the greatest value of a field.
fn extremes<T: Scalar>(field: &Array2<T>) -> (f64, f64) {
    let join = |(a, b): (f64, f64), (c, d): (f64, f64)| (a.min(c), b.max(d));
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let of = |values: &[T]| values.iter().fold(none, |found, value| join(found, (value.widen(), value.widen())));
    let field = field.as_standard_layout();
    field.as_slice().unwrap_or_default().par_chunks(1 << 12).map(of).reduce(|| none, join)
}
