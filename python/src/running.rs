//! The run of a solve: without the interpreter's lock, open to Ctrl-C, and observed by a function of Python.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use asperity::solver::Iteration as State;
use asperity_scene::Watch;
use pyo3::exceptions::{PyRuntimeError, PyStopIteration};
use pyo3::prelude::*;

use crate::pools::Pool;

/// The time between two looks at the signals of the process.
const PATIENCE: Duration = Duration::from_millis(20);

/// The time for which a thread of a pool waits for an observer before it looks for other work.
const NAP: Duration = Duration::from_micros(200);

/// The numbers of an iteration as getters.
macro_rules! getters {
    ($($(#[$doc:meta])* $name:ident: $kind:ty,)*) => {
        #[pymethods]
        impl Iteration {
            $($(#[$doc])*
            #[getter]
            fn $name(&self) -> $kind {
                self.0.$name
            })*
            fn __repr__(&self) -> String {
                let State { iteration, relative_error, energy, mean_gap, contact_nodes, .. } = self.0;
                format!(
                    "Iteration({iteration}: relative_error={relative_error:.1e}, energy={energy:e}, \
                     mean_gap={mean_gap:e}, contact_nodes={contact_nodes})"
                )
            }
        }
    };
}

/// The state of an iteration, as an observer sees it.
#[pyclass(frozen, module = "asperity")]
pub struct Iteration(State);

getters! {
    /// Number of steps.
    iteration: usize,
    /// Number of operator applications of this solve so far.
    operator_applications: usize,
    /// Certified relative error in the energy norm.
    relative_error: f64,
    /// Relative error of the load.
    load_error: f64,
    /// Energy that is minimised, per area.
    energy: f64,
    /// Mean gap.
    mean_gap: f64,
    /// Number of nodes in contact.
    contact_nodes: usize,
    /// Number of changes of the minimised energy so far; the energy falls within a round.
    round: usize,
    /// Whether the solve is still on the way to its start, with the jumps of the law smoothed.
    smoothed: bool,
}

/// Whether work continues, as the library asks.
pub type GoesOn<'a> = &'a (dyn Fn() -> bool + Sync);

/// The place of a solve: the interpreter, a pool, and the observer.
pub struct At<'py> {
    pub py: Python<'py>,
    pub pool: Pool,
    pub observer: Option<Py<PyAny>>,
}

/// Does `work` on a thread of its own, with the shared pool, and returns its result; or at once the exception of a signal,
/// as by Ctrl-C, after which the work is told not to continue, and its result is dropped.
pub fn until_interrupted<R: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(GoesOn<'_>) -> R + Send + 'static,
) -> PyResult<R> {
    let (pool, stop) = (Pool::new(None)?, Arc::new(AtomicBool::new(false)));
    let (answer, answered) = mpsc::channel();
    let stopped = Arc::clone(&stop);
    let begun = thread::Builder::new().spawn(move || {
        let found = pool.get().install(|| work(&|| !stopped.load(Ordering::Relaxed)));
        // nobody hears it after an interruption
        let _ = answer.send(found);
    });
    begun.map_err(|error| PyRuntimeError::new_err(format!("no thread is to be had: {error}")))?;
    py.detach(move || {
        loop {
            match answered.recv_timeout(PATIENCE) {
                Ok(found) => return Ok(found),
                Err(RecvTimeoutError::Timeout) => {
                    Python::attach(|py| py.check_signals()).inspect_err(|_| stop.store(true, Ordering::Relaxed))?
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(PyRuntimeError::new_err("the work ended without a result"));
                }
            }
        }
    })
}

impl At<'_> {
    /// Runs `work` on a thread of the pool and returns its result, and the exception that stopped it, if one did.
    ///
    /// The lock of the interpreter is free meanwhile. This thread sleeps, wakes for signals, and calls the observer of
    /// Python, so that this sees its own thread. An observer stops the solve by `StopIteration`, which is no exception
    /// here.
    pub fn run<R: Send>(&self, work: impl FnOnce(Watch<'_>, GoesOn<'_>) -> R + Send) -> PyResult<(R, Option<PyErr>)> {
        let &Self { py, ref pool, ref observer } = self;
        let (stop, result) = (AtomicBool::new(false), Mutex::new(None));
        let (stop_flag, slot, observed) = (&stop, &result, observer.is_some());
        // of a progress that is shown to the patient alone
        let quiet = observer.as_ref().and_then(|observer| observer.getattr(py, "_after").ok()?.extract(py).ok());
        let (begin, quiet) = (Instant::now(), Duration::from_secs_f64(f64::max(quiet.unwrap_or(0.0), 0.0)));
        let raised = py.detach(|| {
            let (tell, told) = mpsc::channel::<Iteration>();
            let (answer, answered) = mpsc::channel::<()>();
            pool.get().in_place_scope(|scope| {
                scope.spawn(move |_| {
                    // the channels end with this closure, and the wait of the other thread with them
                    let goes_on = || !stop_flag.load(Ordering::Relaxed);
                    let mut observe = move |state: &State| {
                        if observed && begin.elapsed() >= quiet && tell.send(Iteration(*state)).is_ok() {
                            // the observer may solve, too, and on this pool: its thread must not stand idle
                            while let Err(RecvTimeoutError::Timeout) = answered.recv_timeout(NAP) {
                                rayon::yield_now();
                            }
                        }
                        if goes_on() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
                    };
                    let found = work(&mut observe, &goes_on);
                    *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(found);
                });
                let mut raised = None;
                loop {
                    let outcome = match told.recv_timeout(PATIENCE) {
                        Ok(state) => {
                            let outcome = Python::attach(|py| match observer {
                                Some(observer) if raised.is_none() => {
                                    observer.call1(py, (state,)).and_then(|_| py.check_signals())
                                }
                                _ => Ok(()),
                            });
                            stop.fetch_or(outcome.is_err(), Ordering::Relaxed);
                            let _ = answer.send(());
                            outcome
                        }
                        Err(RecvTimeoutError::Timeout) => Python::attach(|py| py.check_signals()),
                        Err(RecvTimeoutError::Disconnected) => return raised,
                    };
                    if let Err(error) = outcome {
                        stop.store(true, Ordering::Relaxed);
                        raised.get_or_insert(error);
                    }
                }
            })
        });
        let raised = raised.filter(|error| !error.is_instance_of::<PyStopIteration>(py));
        let found = result.into_inner().unwrap_or_else(PoisonError::into_inner);
        let found = found.ok_or_else(|| PyRuntimeError::new_err("the solve ended without a result"))?;
        Ok((found, raised))
    }
}
