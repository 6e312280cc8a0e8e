//! The pull-off of a problem, with the sentences of its report.

use asperity::accuracy::AccuratePullOff;
use asperity::pull_off::FoundPullOff;
use asperity::{Branch, PullOff, Real, Report, Status};
use serde::Serialize;

use crate::account::Account;
use crate::account::sentences::UNREFINABLE;
use crate::key::{FORCE, Goal, LENGTH, PRESSURE, Skin, Units, record, worded};
use crate::numbers::percent;

record! {
    /// The pull-off of a problem, as its report has it next to the account of the last state that holds.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    PulledOff of <T: Real>(
        asked: PullOff,
        found: &FoundPullOff<T>,
        report: &Report,
        limit: Option<f64>,
        accurate: Option<&AccuratePullOff<T>>,
        goal: Option<Goal>,
    ) {
        /// The greatest tension that was borne, a pressure over the area of the map; none if no state under a tension was
        /// found.
        pull_off_pressure: Option<f64> = is_borne(report).then_some(-report.mean_pressure),
        /// The force of that tension.
        pull_off_force: Option<f64> = is_borne(report).then_some(-report.normal_force),
        /// The pull-off in the limit of no range that the state tells, a pressure, of a law that has the range of the grid.
        limit_pressure: Option<f64> = limit,
        /// The force of that tension.
        limit_force: Option<f64> = limit.map(|limit| limit * report.normal_force / report.mean_pressure),
        /// The estimated relative error of the limit, if a coarser grid tells it.
        limit_error: Option<f64> = accurate.and_then(|found| found.error).map(|error| error.relative),
        /// The relative error that was asked for, if one was.
        accuracy: Option<f64> = accurate.and(goal).map(|goal| goal.accuracy),
        /// Whether a finer grid could be taken.
        #[serde(skip)]
        refinable: bool = accurate.is_some_and(|found| found.refinable),
        /// The least tension under which the surfaces came apart.
        lost_pressure: Option<f64> = found.lost,
        /// Whether the two are as close as the tolerance.
        reached: bool = found.reached && accurate.is_none_or(|found| found.reached),
        /// The relative tolerance.
        rtol: f64 = asked.tolerance,
        /// The mean pressure to which the surfaces were pressed before; flat, or as the branch says, if there is none.
        preload: Option<f64> = asked.preload,
        /// The branch of the first solve, unless its start was given.
        branch: Option<Branch> = found.branch,
        /// The number of solves.
        solves: usize = found.solves,
        /// The operator applications of all of them.
        operator_applications: usize = found.operator_applications,
    }
}

/// Whether a state bears a tension.
fn is_borne(report: &Report) -> bool {
    report.mean_pressure < 0.0
}

impl PulledOff {
    /// The shortfall of a search that has not come to its end, with a remedy, in the words of a skin.
    pub fn shortfall(&self, last: &Account, skin: Skin) -> Option<String> {
        // a first state that is none says so itself
        if self.reached || last.status != Status::Converged {
            return None;
        }
        // where the search itself has come to its end, the grid falls short
        let ends = self.lost_pressure.zip(self.pull_off_pressure);
        let is_narrow = ends.is_some_and(|(lost, borne)| lost - borne <= self.rtol * lost);
        if self.accuracy.is_some() && is_narrow && self.limit_pressure.is_none() {
            let text = "the surfaces are closed, and their pull-off has no limit of no range: take a law with a range";
            return Some(text.to_owned());
        }
        if let Some(accuracy) = self.accuracy.filter(|_| is_narrow) {
            let estimate = self.limit_error.map_or("unknown".to_owned(), |error| format!("{} %", percent(error)));
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
            let error = self.limit_error.map_or(String::new(), |error| format!(", to {} %", percent(error)));
            let force = self.limit_force.map_or(String::new(), |force| format!(", {}", units.number(force, FORCE)));
            format!("{}{force}{error}", units.number(limit, PRESSURE))
        });
        let closed = (last.jkr_contact_fraction.and(self.pull_off_pressure).is_some())
            .then(|| "none: the surfaces are closed".to_owned());
        let limit = limit.or(closed).map(|text| ("in the limit of no range", text));
        let place = match last.approach {
            Some(approach) => ("approach at the pull-off", units.number(approach, LENGTH)),
            None => ("mean gap at the pull-off", units.number(last.mean_gap, LENGTH)),
        };
        let mut rows = vec![("pull-off pressure", pressure(self.pull_off_pressure)), ("pull-off force", force)];
        rows.extend(limit);
        rows.extend([
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
