//! The accuracy to reach, and its plan.

use asperity::PullOff;
use asperity::accuracy::{Accuracy, Quantity};
use asperity::stability::ContactStiffness;
use asperity_maps::io::available_memory;

use crate::key::{Entries, Kind, PRESSURE, Range, Word, keys};

/// The bytes of a GiB.
pub const GIB: f64 = 1_073_741_824.0;

keys! {
    /// The accuracy to reach, from which tolerance and grid follow.
    AccuracyKeys {
        "Solver" {
            /// Relative error to reach, such as 0.01: chooses the tolerance, and interpolates the surface on finer
            /// grids until the estimated error is small enough; the results are on the finest grid
            accuracy: Option<f64> = Kind::number(Range::POSITIVE, &["A"])
                .excludes(&["initial_gap", "nested", "no_nested", "stability", "leave"]),
            /// Quantity that has the accuracy [default: area]
            accuracy_of: Option<String> = Kind::word(|| words(&Quantity::ALL), &["QUANTITY"]).needs(&["accuracy"]),
            /// Memory for {accuracy}, in GiB [default: all that is free]
            memory: Option<f64> = Kind::number(Range::POSITIVE, &["GIB"]).needs(&["accuracy"]),
        }
    }
}

keys! {
    /// The search for a pull-off.
    PullOffKeys {
        "Load" {
            /// Mean pressure to which surfaces from afar were pressed before; without it they were pressed flat, unless
            /// {branch} or {initial_gap} says otherwise
            preload: Option<f64> = Kind::quantity(PRESSURE, Range::FINITE, &["P"]),
            /// Relative tolerance of the pull-off
            rtol: Option<f64> = Kind::number(Range::SHARE, &["T"]).or("0.02"),
        }
        "Solver" {
            /// Relative error of the pull-off to reach, such as 0.05, with the law jkr: interpolates the surface on
            /// finer grids until the estimated error is small enough
            accuracy: Option<f64> = Kind::number(Range::POSITIVE, &["A"]).excludes(&["initial_gap"]),
            /// Memory for {accuracy}, in GiB [default: all that is free]
            memory: Option<f64> = Kind::number(Range::POSITIVE, &["GIB"]).needs(&["accuracy"]),
        }
    }
}

keys! {
    /// The accuracy of a cycle.
    CycleAccuracyKeys {
        "Solver" {
            /// Relative error of the limit of no range to reach, such as 0.1, with the law jkr: solves the cycle on
            /// finer and finer grids until the expected error is small enough
            accuracy: Option<f64> = Kind::number(Range::POSITIVE, &["A"]).excludes(&["initial_gap"]),
            /// Quantity that has the accuracy [default: work]
            accuracy_of: Option<String> = Kind::word(|| words(&Quantity::OF_LOOPS), &["QUANTITY"]).needs(&["accuracy"]),
            /// Memory for {accuracy}, in GiB [default: all that is free]
            memory: Option<f64> = Kind::number(Range::POSITIVE, &["GIB"]).needs(&["accuracy"]),
        }
    }
}

fn words(quantities: &[Quantity]) -> Vec<Word> {
    let help = |quantity| match quantity {
        Quantity::Area => "Contact area, corrected for its edge",
        Quantity::Gap => "Mean gap",
        Quantity::Approach => "Approach, with a free boundary",
        Quantity::Pressure => "Mean pressure",
        Quantity::Work => "Work done by the load, over a closed cycle the energy that it dissipates",
        Quantity::Tension => "Greatest tension",
        _ => "",
    };
    quantities.iter().map(|quantity| Word { name: quantity.name(), help: help(*quantity) }).collect()
}

/// The accuracy to reach, from which tolerance and grid follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// The relative error that is wanted, between 0 and 1.
    pub accuracy: f64,
    /// The quantity that has it.
    pub of: Quantity,
    /// The memory that it may take, in GiB; all that is free if none is given.
    pub memory: Option<f64>,
}

impl Entries {
    /// The accuracy of a solution, if one is asked for.
    ///
    /// # Errors
    /// A quantity or a memory without an accuracy, and a memory that is none, for [`worded`](crate::worded).
    pub fn goal(&self) -> Result<Option<Goal>, String> {
        let AccuracyKeys { accuracy, accuracy_of, memory } = self.keys();
        goal_of(&Quantity::ALL, accuracy, accuracy_of, memory)
    }

    /// The accuracy of a cycle, if one is asked for.
    ///
    /// # Errors
    /// As [`Entries::goal`].
    pub fn cycle_goal(&self) -> Result<Option<Goal>, String> {
        let CycleAccuracyKeys { accuracy, accuracy_of, memory } = self.keys();
        goal_of(&Quantity::OF_LOOPS, accuracy, accuracy_of, memory)
    }

    /// The search for a pull-off.
    pub fn pull_off(&self) -> PullOff {
        let usual = PullOff::default();
        let PullOffKeys { rtol, preload, .. } = self.keys();
        usual.tolerance(rtol.unwrap_or(usual.tolerance)).preload(preload)
    }
}

impl Goal {
    /// The accuracy, with the contact stiffness if that is asked for.
    pub fn wanted(&self, stiffness: bool) -> Accuracy {
        let mut wanted = Accuracy::new(self.accuracy, self.of);
        wanted.memory = self.memory.map_or_else(available_memory, |memory| memory * GIB);
        wanted.nested.stiffness = stiffness.then_some(ContactStiffness::TOLERANCE);
        wanted
    }
}

/// The accuracy of one of some quantities, by default of the first.
fn goal_of(
    all: &[Quantity],
    accuracy: Option<f64>,
    of: Option<String>,
    memory: Option<f64>,
) -> Result<Option<Goal>, String> {
    let wanted = *all.iter().find(|quantity| Some(quantity.name()) == of.as_deref()).unwrap_or(&all[0]);
    match (accuracy, memory) {
        (None, _) if memory.is_some() || of.is_some() => {
            Err("{accuracy_of} and {memory} require {accuracy}: give it, such as 0.01 for 1 %".to_owned())
        }
        (_, Some(memory)) if memory <= 0.0 || memory.is_nan() => {
            Err(format!("{{memory}} is {memory}: it must be positive, in GiB"))
        }
        (accuracy, memory) => Ok(accuracy.map(|accuracy| Goal { accuracy, of: wanted, memory })),
    }
}
