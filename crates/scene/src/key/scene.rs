//! The scene of a run: its problem except for surface and loads, and the settings of its solves.

use asperity::solver::Method;
use asperity::{Branch, Settings};
use serde::{Deserialize, Serialize};

use crate::key::adhesion::Adhesion;
use crate::key::elastic::Elastic;

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

/// The precision of a solve, and of its fields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "options", derive(clap::ValueEnum))]
pub enum Precision {
    /// 32 bits.
    #[cfg_attr(feature = "options", value(help = None::<&str>))]
    F32,
    /// 64 bits.
    #[default]
    #[cfg_attr(feature = "options", value(help = None::<&str>))]
    F64,
}

/// The branches of equilibria to solve on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "options", derive(clap::ValueEnum))]
pub enum Branches {
    /// That of surfaces pressed together from afar.
    #[cfg_attr(feature = "options", value(help = None::<&str>))]
    Loading,
    /// That of surfaces pressed flat before.
    #[cfg_attr(feature = "options", value(help = None::<&str>))]
    Unloading,
    /// One after the other.
    #[cfg_attr(feature = "options", value(help = None::<&str>))]
    Both,
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
