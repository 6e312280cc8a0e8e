//! The accuracy that is asked for: its options, its plan, and what was reached.

use asperity::accuracy::{GridError, Plan, Quantity};
use asperity_scene::{Account, GIB, Goal, GridErrors, Reached};
use clap::{Args, ValueEnum};

use crate::allowed::positive;
use crate::numbers::percent;

/// The accuracy that is asked for, from which tolerance and grid follow.
#[derive(Args)]
pub struct AccuracyOptions {
    /// Relative error that is wanted, as 0.01: chooses the tolerance, solves on coarser grids too, and interpolates the
    /// surface on finer ones until the estimated error is as small; the results are on the finest grid
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = positive, help_heading = "Solver")]
    #[arg(conflicts_with_all = ["initial_gap", "nested", "no_nested", "stability", "leave"])]
    pub accuracy: Option<f64>,
    /// Quantity that has the accuracy [default: area]
    #[arg(long, value_enum, value_name = "QUANTITY", requires = "accuracy", help_heading = "Solver")]
    pub accuracy_of: Option<Of>,
    /// Memory that --accuracy may take, in GiB [default: all that is free]
    #[arg(long, value_name = "GIB", allow_hyphen_values = true, value_parser = positive, help_heading = "Solver")]
    #[arg(requires = "accuracy")]
    pub memory: Option<f64>,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum Of {
    /// Contact area, corrected for its edge
    Area,
    /// Mean gap
    Gap,
    /// Mean pressure
    Pressure,
    /// Contact stiffness
    Stiffness,
}

impl AccuracyOptions {
    /// The accuracy, if one is asked for.
    pub fn goal(&self) -> Option<Goal> {
        let of = match self.accuracy_of.unwrap_or(Of::Area) {
            Of::Area => Quantity::Area,
            Of::Gap => Quantity::Gap,
            Of::Pressure => Quantity::Pressure,
            Of::Stiffness => Quantity::Stiffness,
        };
        self.accuracy.map(|accuracy| Goal { accuracy, of, memory: self.memory })
    }
}

/// The plan of a goal in words, with the time in seconds.
pub fn announced(goal: Goal, plan: &Plan, time: f64) -> String {
    let waves = if plan.nodes_per_wave.is_finite() {
        format!("the shortest wave has {:.1} nodes; ", plan.nodes_per_wave)
    } else {
        String::new()
    };
    format!(
        "accuracy {} of the {}: {waves}likely {} x {} nodes, tolerance {:.0e}, about {}, {}",
        goal.accuracy,
        goal.of,
        plan.shape.0,
        plan.shape.1,
        plan.tolerance,
        seconds(time),
        bytes(plan.bytes)
    )
}

fn seconds(seconds: f64) -> String {
    match seconds {
        seconds if seconds < 0.1 => format!("{:.0} ms", 1e3 * seconds),
        seconds if seconds < 100.0 => format!("{seconds:.1} s"),
        seconds => format!("{:.0} min", seconds / 60.0),
    }
}

/// Bytes in words.
fn bytes(bytes: f64) -> String {
    if bytes < GIB { format!("{:.0} MiB", bytes * 1024.0 / GIB) } else { format!("{:.1} GiB", bytes / GIB) }
}

/// The reason why an accuracy was not reached, with a remedy.
pub fn reason(reached: &Reached) -> String {
    match reached.unaffordable {
        Some(((nx, ny), size)) => {
            format!("{nx} x {ny} nodes would be next, and take {}: raise --memory, or ask for less", bytes(size))
        }
        None if !reached.refinable => {
            "a single node, absent nodes, and a work of adhesion from a map are known on this grid alone: give a finer one"
                .to_owned()
        }
        None => "the solve has not converged".to_owned(),
    }
}

/// The estimated error of the grid in words: that of the quantity that has an accuracy; or that of the area, if it can
/// be told, and those that are sure; or why there is none, with a remedy where the waves of the surface are the reason.
pub fn estimate(account: &Account) -> String {
    let of_accuracy = account.accuracy.map(|reached| reached.of);
    let counts = |of: Quantity, error: &GridError| match of_accuracy {
        Some(wanted) => of == wanted,
        None => of == Quantity::Area || !error.rough,
    };
    let told = account.grid_error.iter().flat_map(GridErrors::all).filter_map(|(of, error)| {
        let error = error.filter(|error| counts(of, error))?;
        Some(format!("{} % of the {of}{}", percent(error.relative), if error.rough { ", roughly" } else { "" }))
    });
    let words: Vec<_> = told.collect();
    let least = GridError::LEAST_NODES_PER_WAVE;
    if !words.is_empty() {
        return words.join(", ");
    } else if of_accuracy.is_some() || account.nodes_per_wave >= least {
        return "unknown".to_owned();
    }
    // rounded down: 3.96 nodes are not the 4.0 that are needed
    let has = (10.0 * account.nodes_per_wave).floor() / 10.0;
    format!("unknown: the shortest wave has {has:.1} nodes and needs {least}: refine the map (--accuracy)")
}
