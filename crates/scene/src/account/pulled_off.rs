//! The pull-off of a problem, with the sentences of its report.

use asperity::accuracy::{AccuratePullOff, GridError, NoEstimate};
use asperity::pull_off::FoundPullOff;
use asperity::{Branch, PullOff, Real, Report, Status};
use serde::Serialize;

use crate::account::Account;
use crate::account::sentences::UNREFINABLE;
use crate::key::{FORCE, Goal, LENGTH, PRESSURE, Skin, Units, record, worded};
use crate::numbers::percent;

record! {
    /// The pull-off of a problem, as its report has it next to the account of the last state that holds.
    #[derive(Clone, Debug, PartialEq, Serialize)]
    PulledOff of <T: Real>(
        asked: PullOff,
        found: &FoundPullOff<T>,
        report: &Report,
        accurate: Result<&AccuratePullOff<T>, &str>,
        goal: Option<Goal>,
    ) {
        /// Greatest tension that the surfaces bore, over the area of the map; none without a state under a tension.
        pull_off_pressure: Option<f64> [PRESSURE] = is_borne(report).then_some(-report.mean_pressure),
        /// Force of the greatest tension.
        pull_off_force: Option<f64> [FORCE] = is_borne(report).then_some(-report.normal_force),
        /// With `jkr`, the pull-off in the limit of no range.
        limit_pressure: Option<f64> [PRESSURE] = accurate.ok().and_then(|found| found.limit),
        /// Force of the pull-off in the limit of no range.
        limit_force: Option<f64> [FORCE] = accurate.ok()
            .and_then(|found| Some(found.limit? * report.normal_force / report.mean_pressure)),
        /// Estimated relative error of the limit, by a coarser grid.
        limit_error: Option<f64> as Error = accurate.ok().and_then(|found| found.error.ok()).map(|error| error.relative),
        /// Why the limit has no error.
        limit_reason: Option<String> = reason(accurate),
        /// Key of the pull-off to report: the limit if it has an error, otherwise the pull-off pressure; none where a few
        /// nodes bear the tension.
        to_report: Option<&'static str> = to_report(accurate, report),
        /// Relative error that was asked for.
        accuracy: Option<f64> = accurate.ok().and(goal).map(|goal| goal.accuracy),
        /// Whether a finer grid could be taken.
        #[serde(skip)]
        refinable: bool = accurate.is_ok_and(|found| found.refinable),
        /// Least tension under which the surfaces came apart.
        lost_pressure: Option<f64> [PRESSURE] = found.lost,
        /// Whether both tensions are within `rtol` of each other, and an `accuracy` that was wanted is reached.
        reached: bool = found.reached && accurate.map_or(true, |found| found.reached),
        /// Relative tolerance.
        rtol: f64 = asked.tolerance,
        /// Mean pressure before the pull-off; none after full contact, or as `branch` says.
        preload: Option<f64> = asked.preload,
        /// Branch of the first solve, unless its start was given.
        branch: Option<Branch> = found.branch,
        /// Solves.
        solves: usize = found.solves,
        /// Operator applications of all solves.
        operator_applications: usize = found.operator_applications,
    }
}

/// Whether a state bears a tension.
fn is_borne(report: &Report) -> bool {
    report.mean_pressure < 0.0
}

/// The reason why a pull-off has no error.
fn reason<T: Real>(accurate: Result<&AccuratePullOff<T>, &str>) -> Option<String> {
    let untold = match accurate {
        Ok(found) => found.error.err()?,
        Err(reason) => return Some(reason.to_owned()),
    };
    Some(match untold {
        NoEstimate::Range => PulledOff::OF_A_RANGE.to_owned(),
        NoEstimate::Unreached => "the search has not come to its end".to_owned(),
        NoEstimate::FewNodes { nodes, needed: (nx, ny), .. } => {
            let nodes = if nodes < 1.5 { "one node bears".to_owned() } else { format!("{nodes:.0} nodes bear") };
            format!("{nodes} it: its contacts need {nx} x {ny} nodes")
        }
        NoEstimate::Closed(share) => format!(
            "the surfaces are closed, {} % of them in contact: the grid decides where they begin to peel",
            percent(share)
        ),
        NoEstimate::Strong(adhesion) => format!(
            "the adhesion is strong, w is {adhesion:.3} E*h'^2 times the shortest wave: the grid decides which contacts \
             peel first"
        ),
        NoEstimate::Edge => "contacts reach the edge of the map, where each grid ends elsewhere".to_owned(),
        NoEstimate::Waves(nodes) => {
            format!("the shortest wave has {nodes:.1} nodes and needs {}", 2.0 * GridError::LEAST_NODES_PER_WAVE)
        }
        NoEstimate::Growth(times) => format!("it is {times:.2} times the pull-off on the coarser grid"),
        _ => "the grid of half as many nodes tells no pull-off".to_owned(),
    })
}

/// The key of the pull-off to report.
fn to_report<T: Real>(accurate: Result<&AccuratePullOff<T>, &str>, report: &Report) -> Option<&'static str> {
    match accurate.map(|found| found.error) {
        Ok(Ok(_)) => Some("limit_pressure"),
        Ok(Err(NoEstimate::FewNodes { .. })) => None,
        _ => is_borne(report).then_some("pull_off_pressure"),
    }
}

impl PulledOff {
    /// The reason why the pull-off by a law with a range has no error.
    pub(crate) const OF_A_RANGE: &str = "a coarser grid tells no error of a law with a range: compare finer grids";

    /// The shortfall of a search that has not come to its end, with a remedy, in the words of a skin.
    pub fn shortfall(&self, last: &Account, skin: Skin) -> Option<String> {
        // a first state that is none says so itself
        if self.reached || last.status != Status::Converged {
            return None;
        }
        // where the search itself has come to its end, the grid falls short
        let ends = self.lost_pressure.zip(self.pull_off_pressure);
        let is_narrow = ends.is_some_and(|(lost, borne)| lost - borne <= self.rtol * lost);
        if let Some(accuracy) = self.accuracy.filter(|_| is_narrow) {
            let reason = || format!("unknown, since {}", self.limit_reason.as_deref().unwrap_or_default());
            let estimate = self.limit_error.map_or_else(reason, |error| format!("{} %", percent(error)));
            let remedy =
                if self.refinable { "give {memory} for a finer grid, or a larger {accuracy}" } else { UNREFINABLE };
            let text = format!(
                "the accuracy of {accuracy} of the pull-off is not reached: the estimate is {estimate}: {remedy}"
            );
            return Some(worded(&text, skin));
        }
        let lost = self.lost_pressure.map_or("no bound".to_owned(), |lost| lost.to_string());
        let text = format!(
            "the pull-off is not found to {} %: a tension of {} is borne, {lost} is not, and a solve in between has not \
             converged: raise {{max_iterations}} or {{rtol}}",
            percent(self.rtol),
            self.pull_off_pressure.unwrap_or_default()
        );
        Some(worded(&text, skin))
    }

    /// The rows of its summary, with the last state that holds.
    pub fn rows(&self, last: &Account, units: &Units) -> Vec<(&'static str, String)> {
        let pressure = |value: Option<f64>| value.map_or("none".to_owned(), |value| units.number(value, PRESSURE));
        let before = match (self.preload, self.branch) {
            (Some(preload), _) => format!("pressed to {}", units.number(preload, PRESSURE)),
            (None, Some(Branch::Loading)) => "together from afar".to_owned(),
            (None, Some(Branch::Unloading)) => "pressed flat".to_owned(),
            (None, None) => "as given".to_owned(),
        };
        let force = self.pull_off_force.map_or("none".to_owned(), |force| units.number(force, FORCE));
        let limit = self.limit_pressure.map(|limit| {
            let force = self.limit_force.map_or(String::new(), |force| format!(", {}", units.number(force, FORCE)));
            ("in the limit of no range", format!("{}{force}", units.number(limit, PRESSURE)))
        });
        let error = self.limit_error.map(|error| format!("{} % of the limit", percent(error)));
        let error = error.or_else(|| Some(format!("unknown: {}", self.limit_reason.as_ref()?)));
        let to_report = match (self.to_report, self.limit_error) {
            (Some("limit_pressure"), Some(error)) => format!("the limit, ± {} %", percent(error)),
            (Some(_), _) => "the pull-off pressure, without an error of the grid".to_owned(),
            _ => "neither: refine the grid".to_owned(),
        };
        let place = match last.approach {
            Some(approach) => ("approach at the pull-off", units.number(approach, LENGTH)),
            None => ("mean gap at the pull-off", units.number(last.mean_gap, LENGTH)),
        };
        let mut rows = vec![("pull-off pressure", pressure(self.pull_off_pressure)), ("pull-off force", force)];
        rows.extend(limit);
        rows.extend(error.map(|error| ("error of the grid", error)));
        rows.extend([
            ("to report", to_report),
            ("comes apart under", pressure(self.lost_pressure)),
            ("history", before),
            place,
            ("contact at the pull-off", format!("{} %", percent(last.contact_fraction))),
            ("solves", self.solves.to_string()),
            ("operator applications", self.operator_applications.to_string()),
        ]);
        rows
    }
}
