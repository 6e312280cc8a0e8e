//! The engine of the page: the library and the scene of the program, for JavaScript.
//!
//! Objects come and go as texts in JSON, by the names of reports; fields go as typed arrays. `web/worker.js` has the
//! messages.

mod drawn;
mod engine;
mod entries;
mod lines;
mod observed;
mod problem;
mod state;

pub use engine::Engine;
pub use problem::Observe;

use asperity::Error;
use asperity_scene::{GIB, Outcome};
use js_sys::Function;
use wasm_bindgen::prelude::*;

/// Makes of a fault of the program an error of JavaScript, after which the module is of no more use.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|fault| {
        let told = fault.to_string().replace('\n', " ");
        wasm_bindgen::throw_str(&format!("{FAULT}: {told}; please report this as a fault of asperity"));
    }));
}

/// The beginning of the message of a fault, by which `web/worker.js` knows it.
const FAULT: &str = "the engine has failed";

/// A value for JavaScript, or an error with its message.
fn to_js<T>(outcome: Outcome<T>) -> Result<T, JsError> {
    outcome.map_err(|error| JsError::new(&message(&*error)))
}

/// The message of an error; of memory that is not there with what helps in a browser.
fn message(error: &(dyn std::error::Error + 'static)) -> String {
    match error.downcast_ref() {
        Some(Error::Memory { what, bytes }) => format!(
            "{what} takes {:.1} GiB of memory, which a page cannot have: take fewer nodes, as by the steps crop and \
             resample, or the program, which may have more",
            bytes / GIB
        ),
        _ => error.to_string(),
    }
}

/// The version, the laws, and the colours of maps, as JSON.
#[wasm_bindgen]
pub fn about() -> String {
    drawn::about().to_string()
}

/// The chart of some curves as SVG; see `Chart` of the crate `asperity-plot`.
///
/// # Errors
/// The key that is missing.
#[wasm_bindgen]
pub fn chart(given: &str) -> Result<String, JsError> {
    to_js(drawn::chart(given))
}

/// The engine for JavaScript.
#[wasm_bindgen(js_name = Engine)]
#[derive(Default)]
pub struct Page(Engine);

#[wasm_bindgen(js_class = Engine)]
impl Page {
    /// An engine without a surface.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// See [`Engine::open`].
    pub fn open(&mut self, name: &str, bytes: &[u8], channel: Option<String>, masked: bool) -> Result<String, JsError> {
        to_js(self.0.open(name, bytes, channel, masked).map(|found| found.to_string()))
    }

    /// See [`Engine::make`].
    pub fn make(&mut self, given: &str) -> Result<String, JsError> {
        to_js(self.0.make(given).map(|found| found.to_string()))
    }

    /// See [`Engine::prepare`].
    pub fn prepare(&mut self, given: &str) -> Result<String, JsError> {
        to_js(self.0.prepare(given).map(|found| found.to_string()))
    }

    /// See [`Engine::heights`].
    pub fn heights(&self) -> Result<Vec<f32>, JsError> {
        to_js(self.0.heights())
    }

    /// See [`Engine::statistics`].
    pub fn statistics(&self) -> Result<String, JsError> {
        to_js(self.0.statistics().map(|found| found.to_string()))
    }

    /// See [`Engine::solve`]; `observe` is called now and then with the iteration, the error, the tolerance, the contact
    /// fraction and the nodes.
    pub fn solve(&mut self, given: &str, from_last: bool, observe: Option<Function>) -> Result<String, JsError> {
        observed::by(observe, |observe| to_js(self.0.solve(given, from_last, observe).map(|found| found.to_string())))
    }

    /// See [`Engine::gap`].
    pub fn gap(&self) -> Result<Vec<f64>, JsError> {
        to_js(self.0.gap())
    }

    /// See [`Engine::start_from`].
    pub fn start_from(&mut self, gap: Vec<f64>) -> Result<(), JsError> {
        to_js(self.0.start_from(gap))
    }

    /// See [`Engine::begin`].
    pub fn begin(&mut self, given: &str) -> Result<String, JsError> {
        to_js(self.0.begin(given).map(|found| found.to_string()))
    }

    /// See [`Engine::next`].
    pub fn next(&mut self, observe: Option<Function>) -> Result<Option<String>, JsError> {
        observed::by(observe, |observe| to_js(self.0.next(observe).map(|row| row.map(|row| row.to_string()))))
    }

    /// See [`Engine::cycle_limit`].
    pub fn cycle_limit(&mut self, observe: Option<Function>) -> Result<Option<String>, JsError> {
        observed::by(observe, |observe| {
            to_js(self.0.cycle_limit(observe).map(|limit| limit.map(|limit| limit.to_string())))
        })
    }

    /// A field of the last solution; the nodes by their contact as `regions`.
    pub fn field(&self, name: &str) -> Result<Vec<f32>, JsError> {
        to_js(self.0.problem().and_then(|problem| problem.field(name)))
    }

    /// The nodes of the last solution by their contact.
    pub fn regions(&self) -> Result<Vec<u8>, JsError> {
        to_js(self.0.problem().and_then(|problem| problem.regions()))
    }

    /// The histograms of the last solution.
    pub fn histograms(&self, bins: usize) -> Result<String, JsError> {
        to_js(self.0.problem().and_then(|problem| problem.histograms(bins)).map(|found| found.to_string()))
    }

    /// See [`Engine::file`].
    pub fn file(&self, name: &str) -> Result<Vec<u8>, JsError> {
        to_js(self.0.file(name))
    }

    /// See [`Engine::lines`].
    pub fn lines(&self) -> Result<String, JsError> {
        to_js(self.0.lines().map(|found| found.to_string()))
    }
}
