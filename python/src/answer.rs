//! The answer to a solve: the dictionary in which Python gets what was found, and looks at its fields.

use std::sync::{Arc, Mutex, PoisonError};

use asperity::Solution;
use asperity::contact::ContactStatistics;
use asperity_maps::Topography;
use asperity_scene::{self as scene, Account, Answer, Outcome, Sight, Skin, rows, shortfalls};
use numpy::ndarray::ArrayView2;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyCFunction, PyDict};
use serde_pyobject::to_pyobject;

use crate::numbers::Scalar;
use crate::pools::Pool;
use crate::refusal::{refusal, refusal_of_session};
use crate::report::reported;
use crate::running::At;

/// The dictionary of what a solve found, and the exception that ended it early.
pub fn answer<'py, T: Scalar>(
    at: &At<'py>,
    found: Outcome<(Answer<T>, Account)>,
    raised: Option<PyErr>,
) -> PyResult<Bound<'py, PyDict>> {
    let (py, threads) = (at.py, at.pool.asked);
    let (Answer { solution, sight, mode, refined, .. }, account) = match (found, raised.as_ref()) {
        (Ok(found), _) => found,
        (Err(_), Some(raised)) => return Err(raised.clone_ref(py)),
        (Err(error), None) => return Err(refusal_of_session(error)),
    };
    let found = PyDict::new(py);
    // the numbers of the solution, which may be infinite; its report comes with the look
    found.set_item("told", to_pyobject(py, &account)?)?;
    found.set_item("shortfalls", shortfalls(&account, Skin::Keywords))?;
    let Solution { gap, pressure, contact_pressure, plastic_depth, .. } = solution;
    let fields = [gap, pressure, contact_pressure].map(|field| field.into_pyarray(py));
    for (name, field) in ["gap", "pressure", "contact_pressure"].into_iter().zip(&fields) {
        // what is found of them later is about what they are now
        field.readwrite().make_nonwriteable();
        found.set_item(name, field)?;
    }
    let depth = plastic_depth.map(|depth| depth.into_pyarray(py));
    depth.iter().for_each(|depth| drop(depth.readwrite().make_nonwriteable()));
    found.set_item("plastic_depth", depth)?;
    let fields = fields.map(Bound::unbind);
    let seen = Arc::new(Seen { seen: Mutex::new((sight, account)), threads, fields });
    let [looked, told] = [(); 2].map(|()| seen.clone());
    let look = PyCFunction::new_closure(py, None, None, move |given, _| looked.look(given.py()));
    found.set_item("look", look?)?;
    let tell = PyCFunction::new_closure(py, None, None, move |given, _| told.tell(given.py()));
    found.set_item("tell", tell?)?;
    let displacements = PyCFunction::new_closure(py, None, None, move |given, _| seen.displacements(given.py()));
    found.set_item("displacements", displacements?)?;
    found.set_item("mode", mode.map(|mode| mode.into_pyarray(py)))?;
    // the grids of an accuracy
    if let Some(surface) = refined {
        found.set_item("heights", Topography::from(surface).heights.into_pyarray(py))?;
    }
    found.set_item("raised", raised)?;
    Ok(found)
}

/// What a look at the fields of a solution needs.
struct Seen<T: Scalar> {
    seen: Mutex<(Sight<T>, Account)>,
    threads: Option<usize>,
    fields: [Py<PyArray2<T>>; 3],
}

impl<T: Scalar> Seen<T> {
    /// Does something with the fields, gap, pressure and contact pressure.
    fn at<R: Send>(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut Sight<T>, &mut Account, [ArrayView2<'_, T>; 3]) -> asperity::Result<R> + Send,
    ) -> PyResult<R> {
        let fields = self.fields.each_ref().map(|field| field.bind(py).readonly());
        let fields = fields.each_ref().map(|field| field.as_array());
        let pool = Pool::new(self.threads)?;
        let look = || {
            // not on a thread of the pool, which may take up another look while it waits in this one
            let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
            let (sight, account) = &mut *seen;
            pool.get().install(|| act(sight, account, fields))
        };
        py.detach(look).map_err(refusal)
    }

    /// The statistics of the contact, and the whole account.
    fn looked(&self, py: Python<'_>) -> PyResult<(ContactStatistics, Account)> {
        self.at(py, |sight, account, fields| Ok((sight.look(account, fields)?, account.clone())))
    }

    /// The statistics of the contact, and the whole report.
    fn look(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let (found, account) = self.looked(py)?;
        (to_pyobject(py, &found)?, reported(py, &account)?).into_py_any(py)
    }

    /// The rows of the summary.
    fn tell(&self, py: Python<'_>) -> PyResult<Vec<(String, String)>> {
        let (_, account) = self.looked(py)?;
        let rows = rows(&[&account], &account.inputs.units(), Skin::Keywords).into_iter();
        Ok(rows.map(|(name, texts)| (name, texts.concat())).collect())
    }

    /// The displacements of both bodies on all nodes that were solved, if both are elastic.
    fn displacements(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let found =
            self.at(py, |sight, account, [_, pressure, _]| sight.displacements(&account.inputs.elastic, pressure));
        found?.map(|both| both.map(|field| field.into_pyarray(py))).into_py_any(py)
    }
}

/// The warning of a cycle with a balance of energy that misses much of the work, if it does.
#[pyfunction]
pub fn unbalanced(greatest_work: f64, imbalance: f64) -> Option<String> {
    scene::unbalanced(greatest_work, imbalance, Skin::Keywords)
}
