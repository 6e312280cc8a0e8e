//! The accuracy that is planned, and the shortfalls of an answer, in words.

use asperity::Status;
use asperity::accuracy::{GridError, Plan};
use asperity::stability::Verdict;

use crate::account::{Account, Refinement, Search};
use crate::key::{Boundary, GIB, Goal, Precision, Skin, worded};
use crate::numbers::percent;

/// The imbalance of energy, as a share of the greatest work, from which a cycle is warned of.
const MOST_IMBALANCE: f64 = 0.05;

/// The shortfalls of an answer with their remedies, in the words of a skin: each with what was not reached, which is
/// `"convergence"`, `"contact fraction"`, `"accuracy"`, `"stability"` or `"leakage"`.
pub fn shortfalls(account: &Account, skin: Skin) -> Vec<(&'static str, String)> {
    let converged = account.status == Status::Converged;
    let search = account.search.as_ref().filter(|search| converged && !search.reached);
    let accuracy = account.accuracy.as_ref().filter(|reached| converged && !reached.reached);
    let apart = account.transmissivity.and_then(|found| found.apart());
    let leakage =
        apart.map(|apart| format!("{apart}: raise {{leakage}}, the share of the upper bound that may lie between"));
    let all = [
        ("convergence", (!converged).then(|| unconverged(account))),
        ("contact fraction", search.map(Search::jump)),
        ("accuracy", accuracy.map(|reached| inaccurate(account, reached))),
        ("stability", unstable(account)),
        ("leakage", leakage),
    ];
    all.into_iter().filter_map(|(what, text)| Some((what, worded(&text?, skin)))).collect()
}

/// The errors of a solve that has not converged, with a remedy.
fn unconverged(account: &Account) -> String {
    let Account { status, relative_error, load_error, iterations, ref inputs, .. } = *account;
    let tolerance = inputs.tolerance;
    let (held, path) = match inputs.elastic.boundary {
        Boundary::Periodic => ("a {mean_gap}", "{cycle:mean_gaps}"),
        Boundary::Free => ("an {approach}", "{cycle:approaches}"),
    };
    let remedy = match status {
        Status::Detached => format!(
            "no equilibrium under this tension was found from this start: use less tension, hold {held} and give its \
             gap as {{initial_gap}}, or follow the branch by {path}"
        ),
        Status::IterationLimit => {
            "the fields are not accurate: raise {max_iterations}, or give a gap nearby as {initial_gap}".to_owned()
        }
        Status::Stopped => "the fields are not accurate: it was stopped before its end".to_owned(),
        _ if load_error > tolerance && relative_error <= tolerance => {
            format!("the load is not carried: try another {{initial_gap}}, or hold {held}")
        }
        _ if inputs.precision == Precision::F32 => {
            "f32 reaches no smaller error: use {precision=f64}, or raise {tolerance}".to_owned()
        }
        _ => "no further progress is possible: raise {tolerance}, or give another {initial_gap}".to_owned(),
    };
    let errors = [("error", relative_error), ("load error", load_error)];
    let missed = errors.iter().filter(|(_, error)| *error > tolerance || error.is_nan());
    let mut missed: Vec<_> = missed.map(|(name, error)| format!("{name} {error:.1e}")).collect();
    if missed.is_empty() {
        missed.push(format!("error {relative_error:.1e}"));
    }
    let missed = missed.join(" and ");
    format!("not converged ({status}): {missed} after {iterations} iterations, tolerance {tolerance:e}; {remedy}")
}

/// Why a grid is not refined.
pub(super) const UNREFINABLE: &str = "a single node, absent nodes, steps and plateaus, and a work of adhesion that varies \
                                      are known on this grid alone: give a finer one";

/// The reason why an accuracy was not reached, with a remedy.
fn inaccurate(account: &Account, reached: &Refinement) -> String {
    reached.missed(&estimate(account), "the solve has not converged")
}

impl Refinement {
    /// An accuracy that was not reached, with the error that is estimated instead, and the reason, on a grid that could be
    /// refined the other one.
    pub(crate) fn missed(&self, estimate: &str, other: &str) -> String {
        let reason = match self.unaffordable {
            Some(((nx, ny), size)) => {
                format!("{nx} x {ny} nodes would be next, and take {}: raise {{memory}}, or ask for less", bytes(size))
            }
            None if !self.refinable => UNREFINABLE.to_owned(),
            None => other.to_owned(),
        };
        let Self { wanted, of, .. } = self;
        format!("the accuracy of {wanted} of the {of} is not reached: the estimate is {estimate}; {reason}")
    }
}

/// The remedy for an equilibrium that would not last, if it is one.
fn unstable(account: &Account) -> Option<String> {
    account.stability.as_ref().filter(|found| found.verdict == Verdict::Unstable)?;
    Some(match &account.departures {
        None => "the equilibrium is unstable, it would not last: {leave=} continues from it".to_owned(),
        Some(left) => format!("still unstable after {} departures: try another {{initial_gap}}", left.len()),
    })
}

impl Search {
    /// The end of a search that has not reached its contact fraction.
    pub fn jump(&self) -> String {
        let share = |share: f64| format!("{} %", percent(share));
        let found = match (self.below.map(share), self.above.map(share)) {
            (Some(below), Some(above)) => format!("it jumps from {below} to {above}, and the nearer one is taken"),
            (Some(most), None) => format!("it grows to {most} at most, which is taken: give a pressure"),
            (None, least) => format!("it falls to {} at least, which is taken", least.unwrap_or_default()),
        };
        format!("no load was found with {} contact: {found}", share(self.wanted))
    }
}

impl Goal {
    /// The plan of a solve to the accuracy in words, with the seconds that it is likely to take.
    pub fn announced(&self, plan: &Plan, seconds: f64) -> String {
        let waves = if plan.nodes_per_wave.is_finite() {
            format!("the shortest wave has {:.1} nodes; ", plan.nodes_per_wave)
        } else {
            String::new()
        };
        let time = match seconds {
            seconds if seconds < 0.1 => format!("{:.0} ms", 1e3 * seconds),
            seconds if seconds < 100.0 => format!("{seconds:.1} s"),
            seconds => format!("{:.0} min", seconds / 60.0),
        };
        let (Self { accuracy, of, .. }, (nx, ny), size) = (self, plan.shape, bytes(plan.bytes));
        format!(
            "accuracy {accuracy} of the {of}: {waves}likely {nx} x {ny} nodes, tolerance {:.0e}, about {time}, {size}",
            plan.tolerance
        )
    }
}

/// Bytes in words.
pub(crate) fn bytes(bytes: f64) -> String {
    if bytes < GIB { format!("{:.0} MiB", bytes * 1024.0 / GIB) } else { format!("{:.1} GiB", bytes / GIB) }
}

/// The estimated error of the grid in words; or why there is none, with a remedy where the waves of the surface are the
/// reason.
pub(crate) fn estimate(account: &Account) -> String {
    let of_accuracy = account.accuracy.map(|reached| reached.of);
    let coarse = of_accuracy.is_none() && account.nodes_per_wave < GridError::LEAST_NODES_PER_WAVE;
    let remedy = if coarse { ": refine the map ({accuracy})" } else { "" };
    let words = account.grid_error.and_then(|errors| errors.in_words(of_accuracy));
    words.unwrap_or_else(|| format!("unknown: {}{remedy}", missing_error(account)))
}

/// The reason for no error of the grid.
pub(crate) fn missing_error(account: &Account) -> String {
    let least = GridError::LEAST_NODES_PER_WAVE;
    if account.inputs.adhesion.yields() {
        "the surface yields".to_owned()
    } else if account.nodes_per_wave >= least {
        "the grids tell none".to_owned()
    } else {
        // rounded down: 3.96 nodes are not the 4.0 that are needed
        let has = (10.0 * account.nodes_per_wave).floor() / 10.0;
        format!("the shortest wave has {has:.1} nodes and needs {least}")
    }
}

/// The warning of a cycle with an imbalance of energy above 5 % of the greatest work.
pub fn unbalanced(greatest_work: f64, imbalance: f64, skin: Skin) -> Option<String> {
    let share = (imbalance / greatest_work).abs();
    let text = || {
        let missed = 100.0 * share;
        format!(
            "the balance of energy misses {missed:.1} % of the greatest work on the way: take more {{steps}}, or a smaller \
             {{imbalance}}"
        )
    };
    (share > MOST_IMBALANCE).then(|| worded(&text(), skin))
}
