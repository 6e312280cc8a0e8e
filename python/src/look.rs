//! The look at a solution: what is found of its fields once it is asked for.

use std::sync::{Mutex, PoisonError};

use asperity_scene::{Account, Sight, Skin, rows};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use serde_pyobject::to_pyobject;

use crate::numbers::Scalar;
use crate::pools::Pool;
use crate::refusal::refusal;
use crate::report::reported;

/// A sight in either precision, with the fields.
trait Looks: Send + Sync {
    fn look<'py>(&self, py: Python<'py>) -> PyResult<Looked<'py>>;
    fn displacements<'py>(&self, py: Python<'py>) -> PyResult<Option<Both<'py>>>;
}

struct Seen<T: Scalar> {
    seen: Mutex<(Sight<T>, Account)>,
    threads: Option<usize>,
    fields: [Py<PyArray2<T>>; 3],
}

/// The look at a solution, whose fields it holds.
#[pyclass(frozen, module = "asperity._asperity")]
pub struct Look(Box<dyn Looks>);

impl Look {
    /// The look at gap, pressure and contact pressure, with the account of their solve.
    pub fn at<T: Scalar>(
        sight: Sight<T>,
        account: Account,
        threads: Option<usize>,
        fields: [Bound<'_, PyArray2<T>>; 3],
    ) -> Self {
        Self(Box::new(Seen { seen: Mutex::new((sight, account)), threads, fields: fields.map(Bound::unbind) }))
    }
}

#[pymethods]
impl Look {
    /// The statistics of the contact, the whole report, and the rows of the summary.
    fn found<'py>(&self, py: Python<'py>) -> PyResult<Looked<'py>> {
        self.0.look(py)
    }

    /// The displacements of both bodies on all nodes that were solved, if both are elastic.
    fn displacements<'py>(&self, py: Python<'py>) -> PyResult<Option<Both<'py>>> {
        self.0.displacements(py)
    }
}

impl<T: Scalar> Looks for Seen<T> {
    fn look<'py>(&self, py: Python<'py>) -> PyResult<Looked<'py>> {
        let fields = self.fields.each_ref().map(|field| field.bind(py).readonly());
        let fields = fields.each_ref().map(|field| field.as_array());
        let pool = Pool::of(self.threads)?;
        let look = || {
            // not on a thread of the pool, which may take up another look while it waits in this one
            let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
            let (sight, account) = &mut *seen;
            Ok((pool.get().install(|| sight.look(account, fields))?, account.clone()))
        };
        let (found, account) = py.detach(look).map_err(refusal)?;
        let rows = rows(&[&account], &account.inputs.units(), Skin::Keywords).into_iter();
        let rows = rows.map(|(name, texts)| (name, texts.concat())).collect();
        Ok((to_pyobject(py, &found)?, reported(py, &account)?, rows))
    }

    fn displacements<'py>(&self, py: Python<'py>) -> PyResult<Option<Both<'py>>> {
        let pressure = self.fields[1].bind(py).readonly();
        let pressure = pressure.as_array();
        let pool = Pool::of(self.threads)?;
        let find = || {
            let seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
            let (sight, account) = &*seen;
            pool.get().install(|| sight.displacements(&account.inputs.elastic, pressure))
        };
        let found = py.detach(find).map_err(refusal)?;
        Ok(found.map(|both| both.map(|field| field.into_pyarray(py)).into()))
    }
}

/// The displacements of the body that is pressed, and of the one on the other side.
type Both<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

/// The statistics, the report, and the name and the text of each row of the summary.
type Looked<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, Vec<(String, String)>);
