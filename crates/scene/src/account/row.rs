//! The row of a state in a table, and the columns of tables.

use std::ffi::OsStr;
use std::path::Path;

use asperity::{Real, Status};
use serde::Serialize;
use serde_json::{Map, Value};

use crate::account::{Account, Found, Step, interface};
use crate::key::After;

/// The row of a state in a table: its account, and the figures that tables alone have.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The account, complete.
    #[serde(flatten)]
    pub account: Account,
    /// The approach of the mean planes since first touch, in the table of an interface.
    pub closure: Option<f64>,
    /// The number of separate contacts.
    pub clusters: usize,
    /// The nodes of the largest one.
    pub largest_cluster: usize,
    /// The name of the file of the heights, in the place of its path.
    pub heights: Option<String>,
    /// The seed of a random surface.
    pub seed: Option<u64>,
    /// The contact fraction that was wanted, if its load was searched for.
    pub wanted_contact_fraction: Option<f64>,
    /// Whether it was reached.
    pub reached: Option<bool>,
    /// The place on a cycle.
    #[serde(flatten)]
    pub step: Option<Step>,
    /// The cells of the columns for what is asked for after each state.
    #[serde(flatten)]
    pub after: Map<String, Value>,
}

/// The kind of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Sweep,
    Search,
    Cycle,
    Interface,
    PullOff,
}

const STATE: &str = "control control_value mean_pressure mean_contact_pressure mean_gap normal_force approach \
                     edge_traction contact_fraction corrected_contact_fraction perimeter clusters largest_cluster \
                     repulsive_fraction attractive_fraction elastic_energy adhesive_energy min_gap";
const OUTCOME: &str = "relative_error load_error iterations operator_applications status";
pub(crate) const INPUTS: &str = "modulus law work_of_adhesion range heights part seed";
const BALANCE: &str = "work dissipated imbalance event energy_drop";
/// What a search for the pull-off found, before the last state that holds; its operator applications are of all solves.
const PULL_OFF: &str = "pull_off_pressure pull_off_force limit_pressure limit_force limit_error lost_pressure reached \
                        branch solves";
const PLASTIC: &str = "hardness plastic_fraction plastic_depth_max plastic_depth_mean plastic_energy";

/// The contact by the adhesive energy, and in the limit of no range, of a law that has the range of the grid.
const LIMIT: &str = "adhesive_contact_fraction jkr_contact_fraction";

impl Kind {
    /// The names of the columns, with what is asked for after each state, of a law that may have the range of the grid
    /// on a surface that may yield.
    pub fn columns(self, after: &After, of_grid: bool, yields: bool) -> Vec<&'static str> {
        let stiffness = if after.stiffness { "contact_stiffness normal_stiffness" } else { "" };
        let (before, behind) = match self {
            Self::Interface => (vec![interface::COLUMNS], interface::OUTCOME),
            Self::Sweep => (vec![STATE, OUTCOME, INPUTS, stiffness], ""),
            Self::Search => (vec![STATE, OUTCOME, INPUTS, "wanted_contact_fraction reached", stiffness], ""),
            Self::PullOff => (vec![PULL_OFF, STATE, OUTCOME, INPUTS], ""),
            Self::Cycle => (vec!["leg direction", STATE, BALANCE, OUTCOME, INPUTS, stiffness], ""),
        };
        let (limit, plastic) = (if of_grid { LIMIT } else { "" }, if yields { PLASTIC } else { "" });
        let before = before.into_iter().chain([limit, plastic]).flat_map(str::split_whitespace);
        before.chain(after.columns()).chain(behind.split_whitespace()).collect()
    }
}

impl Row {
    /// The row of a state with contacts of these sizes, after a mean gap at first touch.
    pub(crate) fn of<T: Real>(
        found: &Found<T>,
        account: Account,
        sizes: &[usize],
        touch: Option<f64>,
        seed: Option<u64>,
    ) -> Self {
        let heights = account.inputs.heights.as_deref().and_then(|path| Path::new(path).file_name());
        Self {
            closure: touch.map(|touch| touch - account.mean_gap),
            clusters: sizes.len(),
            largest_cluster: sizes.first().copied().unwrap_or(0),
            heights: heights.map(OsStr::to_string_lossy).map(Into::into),
            seed,
            wanted_contact_fraction: account.search.map(|search| search.wanted),
            reached: account.search.map(|search| search.reached),
            step: found.step.clone(),
            after: found.after.cells(),
            account,
        }
    }

    /// Whether the solve converged, and reached the contact fraction that was wanted.
    pub(crate) fn converged(&self) -> bool {
        self.account.status == Status::Converged && self.reached != Some(false)
    }

    /// The load, as it stands in the list of the loads.
    pub(crate) fn load(&self) -> f64 {
        self.wanted_contact_fraction.unwrap_or(self.account.control_value)
    }

    /// The cells of the columns of these names. None of them depends on the clock.
    pub fn cells(&self, names: &[&str]) -> Map<String, Value> {
        let all = serde_json::to_value(self).unwrap_or_default();
        names.iter().map(|&name| (name.to_owned(), all[name].clone())).collect()
    }
}
