//! The pools of threads in which solves run.

use std::collections::HashMap;
use std::process;
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::refusal::refusal;

/// The idle pools by their number of threads, and the pool of all cores, which solves share.
///
/// Threads do not survive a fork: the pools belong to one process, and a child makes its own.
#[derive(Default)]
struct Stock {
    process: u32,
    shared: Option<Arc<ThreadPool>>,
    idle: HashMap<usize, Vec<Arc<ThreadPool>>>,
}

static STOCK: Mutex<Option<Stock>> = Mutex::new(None);

/// Does something with the stock of this process.
fn with_stock<R>(act: impl FnOnce(&mut Stock) -> R) -> R {
    let mut stock = STOCK.lock().unwrap_or_else(PoisonError::into_inner);
    if stock.as_ref().is_none_or(|stock| stock.process != process::id()) {
        // the threads of a parent process cannot be joined
        std::mem::forget(stock.replace(Stock { process: process::id(), ..Stock::default() }));
    }
    act(stock.get_or_insert_default())
}

/// The most threads of a solve, as in the tool: more are taken for a slip of the pen.
const MOST: usize = 1024;

/// A pool on loan: one of its own for each solve that asks for a number of threads, the shared one for the others.
pub struct Pool {
    /// The number that was asked for
    pub asked: Option<usize>,
    pool: Arc<ThreadPool>,
}

impl Pool {
    /// A pool of so many threads, or the pool of all cores.
    ///
    /// # Errors
    /// `ValueError` for no threads or too many, `RuntimeError` if they cannot be started.
    pub fn new(threads: Option<usize>) -> PyResult<Self> {
        if let Some(count) = threads.filter(|count| !(1..=MOST).contains(count)) {
            let message = format!("threads is {count}: it must be from 1 to {MOST}, or None for one per core");
            return Err(PyValueError::new_err(message));
        }
        let found = with_stock(|stock| match threads {
            None => stock.shared.clone(),
            Some(count) => stock.idle.get_mut(&count).and_then(Vec::pop),
        });
        if let Some(pool) = found {
            return Ok(Self { asked: threads, pool });
        }
        let built = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
        let pool = Arc::new(built.map_err(|error| PyRuntimeError::new_err(format!("no threads: {error}")))?);
        let pool = match threads {
            None => with_stock(|stock| stock.shared.get_or_insert(pool).clone()),
            Some(_) => pool,
        };
        Ok(Self { asked: threads, pool })
    }

    /// The number of its threads.
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// The pool itself.
    pub fn get(&self) -> &ThreadPool {
        &self.pool
    }

    /// Does something on its threads, without the lock of the interpreter.
    pub fn install<R: Send>(&self, py: Python<'_>, act: impl FnOnce() -> R + Send) -> R {
        py.detach(|| self.pool.install(act))
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        if let Some(count) = self.asked {
            with_stock(|stock| stock.idle.entry(count).or_default().push(self.pool.clone()));
        }
    }
}

/// Does something on the shared pool, without the lock of the interpreter.
pub fn apart<R: Send>(py: Python<'_>, act: impl FnOnce() -> asperity::Result<R> + Send) -> PyResult<R> {
    Pool::new(None)?.install(py, act).map_err(refusal)
}
