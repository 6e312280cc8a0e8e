//! The row of a state in a table, and the columns of tables.

use std::path::Path;

use asperity::{Real, Status};
use serde::Serialize;
use serde_json::{Map, Value};

use crate::account::{Account, Answer, LIMIT, OUTCOME, PLASTIC, STATE, STIFFNESS, Step, interface};
use crate::key::{Adhesion, After, LENGTH, record};

record! {
    /// The row of a state in a table, with contacts of these sizes, after a mean gap at first touch: its account, and the
    /// figures that tables alone have.
    #[derive(Clone, Debug, Serialize)]
    Row of <T: Real>(
        found: &Answer<T>,
        account: &Account,
        sizes: &[usize],
        touch: Option<f64>,
        seed: Option<u64>,
    ) {
        /// The account, complete.
        #[serde(flatten)]
        account: Account = account.clone(),
        /// In tables of an interface, the approach of the mean planes since first touch.
        closure: Option<f64> [LENGTH] = touch.map(|touch| touch - account.mean_gap),
        /// Separate contacts.
        clusters: usize = sizes.len(),
        /// Nodes of the largest contact.
        largest_cluster: usize = sizes.first().copied().unwrap_or(0),
        /// Name of the file of the heights, in the place of its path.
        heights: Option<String> = account.inputs.heights.as_deref().and_then(file_name),
        /// Seed of a surface that asperity has made.
        seed: Option<u64> = seed,
        /// Contact fraction that was wanted, if its load was searched for.
        wanted_contact_fraction: Option<f64> as Share = account.search.map(|search| search.wanted),
        /// Whether the contact fraction was reached.
        reached: Option<bool> = account.search.map(|search| search.reached),
        /// The place on a cycle.
        #[serde(flatten)]
        step: Option<Step> = found.step.clone(),
        /// The cells of the columns for what is asked for after each state.
        #[serde(flatten)]
        after: Map<String, Value> = found.after.cells(),
    }
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

pub(crate) const INPUTS: &str = "modulus law work_of_adhesion range heights part seed";
const BALANCE: &str = "work dissipated imbalance work_error event energy_drop";
/// What a search for the pull-off found, before the last state that holds; its operator applications are of all solves.
const PULL_OFF: &str = "pull_off_pressure pull_off_force limit_pressure limit_force limit_error to_report lost_pressure reached \
                        branch solves";
impl Kind {
    /// The names of the columns, with what is asked for after each state, of surfaces with this adhesion, which may yield.
    pub fn columns(self, after: &After, adhesion: &Adhesion) -> Vec<&'static str> {
        let stiffness = if after.stiffness { STIFFNESS } else { "" };
        let (before, behind) = match self {
            Self::Interface => (vec![interface::COLUMNS], interface::OUTCOME),
            Self::Sweep => (vec![STATE, OUTCOME, INPUTS, stiffness], ""),
            Self::Search => (vec![STATE, OUTCOME, INPUTS, "wanted_contact_fraction reached", stiffness], ""),
            Self::PullOff => (vec![PULL_OFF, STATE, OUTCOME, INPUTS], ""),
            Self::Cycle => (vec!["leg direction", STATE, BALANCE, OUTCOME, INPUTS, stiffness], ""),
        };
        let limit = if adhesion.law().is_some_and(|law| law.of_grid) { LIMIT } else { "" };
        let plastic = if adhesion.yields() { PLASTIC } else { "" };
        let before = before.into_iter().chain([limit, plastic]).flat_map(str::split_whitespace);
        before.chain(after.columns()).chain(behind.split_whitespace()).collect()
    }
}

impl Row {
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

/// The name of the file of a path.
fn file_name(path: &str) -> Option<String> {
    Some(Path::new(path).file_name()?.to_string_lossy().into())
}
