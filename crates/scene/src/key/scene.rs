//! The scene of a run: its problem except for surface and loads, and the settings of its solves.

use std::path::{Path, PathBuf};

use asperity::solver::Method;
use asperity::{Branch, Settings};
use serde::{Deserialize, Serialize};

use crate::key::{Adhesion, AdhesionKeys, Elastic, Entries, Kind, Range, SurfaceKeys, Word, choice, keys, readable};

/// The scene of a run, as options and keywords describe it: the body, the adhesion, the wall and the solver. As data it
/// has the keys of a report, which are left out where they have their defaults.
///
/// ```
/// let scene: asperity_scene::Scene =
///     serde_json::from_str(r#"{"modulus": 2.0, "law": "exponential", "work_of_adhesion": 1e-4, "range": 4e-3}"#)?;
/// assert_eq!((scene.elastic.modulus, scene.tolerance()), (2.0, 1e-6));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Scene {
    /// The elastic body.
    #[serde(flatten)]
    pub elastic: Elastic,
    /// The adhesion and the wall.
    #[serde(flatten)]
    pub adhesion: Adhesion,
    /// The method.
    pub method: Method,
    /// The precision.
    pub precision: Precision,
    /// The certified relative error at which to stop, if it is not the default of the precision.
    pub tolerance: Option<f64>,
    /// The iterations after which to give up, if they are not the default of the method.
    pub max_iterations: Option<usize>,
    /// The branches of equilibria to solve on, if they do not follow from the load.
    pub branch: Option<Branches>,
}

choice! {
    /// The precision of a solve, and of its fields.
    Precision {
        /// 64 bits
        F64 = "f64",
        /// 32 bits
        F32 = "f32",
    }
}

choice! {
    /// The branches of equilibria to solve on.
    Branches {
        /// the equilibrium of surfaces pressed together from afar
        Loading = "loading",
        /// the equilibrium of surfaces pressed flat before
        Unloading = "unloading",
        /// one after the other
        Both = "both",
    }
}

keys! {
    /// The method, the accuracy and the start of a solve.
    SolverKeys {
        "Solver" {
            /// Preconditioned conjugate gradients, or the algorithm of Rey et al. (2017)
            method: Option<Method> = Kind::word(|| Word::all(&["default", "rey2017"]), &["METHOD"]).or("default"),
            /// Certified relative error at which to stop [default: 1e-6, in f32 and in cycles 1e-4]
            tolerance: Option<f64> = Kind::number(Range::POSITIVE, &["T"]),
            /// Iterations after which to give up [default: 2000, with rey2017 20000]
            max_iterations: Option<usize> = Kind::whole(&["N"]),
            /// Precision of the solve, and of the fields it writes
            precision: Option<Precision> = Kind::word(Precision::words, &["PRECISION"]).or("f64"),
            /// Threads; the results do not depend on it [default: one per core]
            threads: Option<usize> = Kind::threads(),
            /// Equilibrium to find where adhesion has several: of surfaces that come from afar, of surfaces pressed
            /// flat before, or with solve both [default: loading; unloading under a tension or at a given mean gap]
            branch: Option<Branches> = Kind::word(Branches::words, &["BRANCH"]).excludes(&["initial_gap"]),
            /// Gap from which to start, in the shape of the heights; scaled to a given mean gap
            initial_gap: Option<PathBuf> = Kind::file(),
        }
    }
}

readable! {
    Option<Method>: Word = |value| serde_json::from_value(value?.clone()).ok();
}

/// The files of a problem.
#[derive(Clone, Debug, Default)]
pub struct Files {
    /// The heights.
    pub heights: PathBuf,
    /// The heights on the other side.
    pub against: Option<PathBuf>,
    /// The table of the law.
    pub law_table: Option<PathBuf>,
    /// The works of adhesion at the nodes.
    pub work_of_adhesion_map: Option<PathBuf>,
    /// The hardness at the nodes.
    pub hardness_map: Option<PathBuf>,
    /// The gap from which to start.
    pub initial_gap: Option<PathBuf>,
}

impl Files {
    /// All but the gap from which to start.
    pub fn of_problem(&self) -> impl Iterator<Item = &Path> {
        let Self { against, law_table, work_of_adhesion_map, hardness_map, .. } = self;
        let others = [against, law_table, work_of_adhesion_map, hardness_map];
        std::iter::once(&*self.heights).chain(others.into_iter().filter_map(Option::as_deref))
    }
}

impl Entries {
    /// The scene, without what files hold.
    pub fn scene(&self) -> Scene {
        let SolverKeys { method, tolerance, max_iterations, precision, branch, .. } = self.keys();
        let (method, precision) = (method.unwrap_or_default(), precision.unwrap_or_default());
        let (elastic, adhesion) = (Elastic::record(self.keys()), Adhesion::record(self.keys()));
        Scene { elastic, adhesion, method, precision, tolerance, max_iterations, branch }
    }

    /// The files of the problem.
    pub fn files(&self) -> Files {
        let SurfaceKeys { heights, against, .. } = self.keys();
        let AdhesionKeys { law_table, work_of_adhesion_map, hardness_map, .. } = self.keys();
        let SolverKeys { initial_gap, .. } = self.keys();
        let heights = heights.unwrap_or_default();
        Files { heights, against, law_table, work_of_adhesion_map, hardness_map, initial_gap }
    }

    /// The shift of the surface on the other side, if it is given.
    pub fn shift(&self) -> Option<(f64, f64)> {
        match self.keys::<SurfaceKeys>().shift[..] {
            [x, y, ..] => Some((x, y)),
            [x] => Some((x, 0.0)),
            [] => None,
        }
    }

    /// Whether missing points stand for absent nodes.
    pub fn absent_missing(&self) -> bool {
        self.keys::<SurfaceKeys>().absent_missing
    }

    /// Whether results are on all nodes of a mirrored map.
    pub fn whole(&self) -> bool {
        self.keys::<SurfaceKeys>().whole
    }

    /// The number of threads, if it is given.
    pub fn threads(&self) -> Option<usize> {
        self.keys::<SolverKeys>().threads
    }
}

impl Scene {
    /// The settings of the solver, with the defaults of the method, on the branch that is given, if it is one.
    pub fn settings(&self) -> Settings {
        let default = if self.method == Method::Rey2017 { Settings::rey2017() } else { Settings::default() };
        let branch = match self.branch {
            Some(Branches::Loading) => Some(Branch::Loading),
            Some(Branches::Unloading) => Some(Branch::Unloading),
            Some(Branches::Both) | None => None,
        };
        let max_iterations = self.max_iterations.unwrap_or(default.max_iterations);
        default.tolerance(self.tolerance).max_iterations(max_iterations).branch(branch)
    }

    /// The tolerance to which a solve is held.
    pub fn tolerance(&self) -> f64 {
        match self.precision {
            Precision::F32 => self.settings().tolerance_in::<f32>(),
            Precision::F64 => self.settings().tolerance_in::<f64>(),
        }
    }
}
