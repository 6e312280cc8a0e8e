//! The settings of a solver.

use asperity::{Branch, Method, Settings};
use serde::{Deserialize, Serialize};

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

/// The settings of a method with its defaults, on the branch that is given, if it is one.
pub fn settings(
    method: Method,
    tolerance: Option<f64>,
    max_iterations: Option<usize>,
    branches: Option<Branches>,
) -> Settings {
    let default = if method == Method::Rey2017 { Settings::rey2017() } else { Settings::default() };
    let branch = match branches {
        Some(Branches::Loading) => Some(Branch::Loading),
        Some(Branches::Unloading) => Some(Branch::Unloading),
        Some(Branches::Both) | None => None,
    };
    default.tolerance(tolerance).max_iterations(max_iterations.unwrap_or(default.max_iterations)).branch(branch)
}
