//! The inputs of a command, as every report has them.

use asperity::solver::Method;
use serde::Serialize;
use serde_json::Value;

use crate::account::Slopes;
use crate::key::{Adhesion, Elastic, Precision, Scene, Units, record};

record! {
    /// The inputs of a command, by their names in every report.
    #[derive(Clone, Debug, Serialize)]
    Inputs of (scene: &Scene, shape: (usize, usize), lengths: (f64, f64), threads: usize) {
        /// File of the heights.
        heights: Option<String> = None,
        /// File of the heights on the other side, or a word for them.
        against: Option<String> = None,
        /// Shift of the heights on the other side along x and y.
        shift: Option<(f64, f64)> = None,
        /// File of the gap from which the solve started, or a word for it.
        initial_gap: Option<String> = None,
        /// Part of a mirrored map with results, `original` or `whole`.
        part: Option<String> = None,
        /// Nodes that were solved, if results are of fewer.
        solved_shape: Option<(usize, usize)> = None,
        /// Nodes of the results.
        shape: (usize, usize) = shape,
        /// Side lengths of the results.
        lengths: (f64, f64) = lengths,
        /// The rms slopes of the surface.
        #[serde(flatten)]
        slopes: Slopes = Slopes::default(),
        /// Unit of lengths.
        length_unit: Option<String> = None,
        /// Unit of pressures.
        pressure_unit: Option<String> = None,
        /// Quantities with units, as they were typed.
        given: Option<Value> = None,
        /// The elastic body.
        #[serde(flatten)]
        elastic: Elastic = scene.elastic.clone(),
        /// The adhesion and the wall.
        #[serde(flatten)]
        adhesion: Adhesion = scene.adhesion.clone(),
        /// Method of the solver.
        method: Method = scene.method,
        /// Precision of the solver.
        precision: Precision = scene.precision,
        /// Tolerance to which the solve was held.
        tolerance: f64 = scene.tolerance(),
        /// Iterations after which a solve gives up.
        max_iterations: usize = scene.settings().max_iterations,
        /// Threads.
        threads: usize = threads,
        /// Version of the program.
        version: &'static str = env!("CARGO_PKG_VERSION"),
    }
}

impl Scene {
    /// The inputs of a report as far as the scene has them, on a surface of a shape and side lengths.
    pub fn inputs(&self, shape: (usize, usize), lengths: (f64, f64), threads: usize) -> Inputs {
        Inputs::record(self, shape, lengths, threads)
    }
}

impl Inputs {
    /// The units of the numbers, as far as they are known.
    pub fn units(&self) -> Units {
        Units { length: self.length_unit.clone(), pressure: self.pressure_unit.clone(), force: None }
    }
}
