//! The observer of a solve in JavaScript, called some times a second.

use std::cell::RefCell;

use asperity::solver::Iteration;
use js_sys::{Date, Function};
use wasm_bindgen::JsValue;

use crate::problem::Observe;

/// The least time between two calls, in milliseconds.
const PAUSE: f64 = 80.0;

thread_local! {
    /// A function of JavaScript stays on its thread, and the observer of a solve has to be free of threads: it finds
    /// the function here.
    static OBSERVER: RefCell<Option<Function>> = const { RefCell::new(None) };
}

/// Does work that an observer sees.
pub fn by<R>(observer: Option<Function>, work: impl FnOnce(Observe<'_>) -> R) -> R {
    OBSERVER.set(observer);
    let mut before = 0.0;
    let done = work(&mut move |nodes, state, tolerance| {
        OBSERVER.with_borrow(|observer| {
            let Some(observer) = observer else { return };
            let now = Date::now();
            if now - before >= PAUSE {
                before = now;
                tell(observer, nodes, state, tolerance);
            }
        });
    });
    OBSERVER.take();
    done
}

/// Calls the function with the iteration, the error, the tolerance, the contact fraction, and the nodes.
fn tell(observer: &Function, nodes: usize, state: &Iteration, tolerance: f64) {
    let error = state.relative_error.max(state.load_error);
    let told = [state.iteration as f64, error, tolerance, state.contact_nodes as f64 / nodes as f64, nodes as f64];
    // an observer that fails does not end the solve
    let _ = observer.apply(&JsValue::NULL, &told.iter().map(|number| JsValue::from(*number)).collect());
}
