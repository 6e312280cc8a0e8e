//! The plan of a solve: the stages that lead to its solution, and the states that it seeks where surfaces come apart.

use super::Branch;
use super::tension::Hold;
use crate::degrees::{CLOSELY, LITTLE, ROUGHLY};

/// The law of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StageLaw {
    /// No adhesion.
    None,
    /// The law with its jumps smoothed.
    Smoothed,
    /// The law of the problem.
    Own,
}

/// A stage of a solve: the energy that one minimisation lowers, and the error at which it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stage {
    pub(super) law: StageLaw,
    /// whether a rigid wall stands for the constraint
    pub(super) rigid: bool,
    /// the tolerance of a state from which another stage continues; none of the solution
    pub(super) tolerance: Option<f64>,
}

impl Stage {
    /// The solution, to the tolerance of the settings, in rounds of the constraint.
    pub(super) const SOLUTION: Self = Self { law: StageLaw::Own, rigid: false, tolerance: None };
    /// A state that may hold a tensile load, at a mean gap or under no load.
    pub(super) const HOLD: Self = Self { law: StageLaw::Own, rigid: false, tolerance: Some(ROUGHLY) };
    /// A start for the law itself, by the law with its jumps smoothed.
    pub(super) const SMOOTHED: Self = Self { law: StageLaw::Smoothed, rigid: false, tolerance: Some(CLOSELY) };

    /// The gap that the wall alone leaves, without adhesion: a start on the branch of loading.
    const fn wall(rigid: bool) -> Self {
        // adhesion changes the gap by more
        Self { law: StageLaw::None, rigid, tolerance: Some(LITTLE) }
    }
}

/// What a plan depends on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Facts {
    /// whether a gap is given as the start
    pub(super) given: bool,
    /// the branch of a default start with adhesion
    pub(super) branch: Option<Branch>,
    /// whether the law has jumps, which are smoothed on the way
    pub(super) jumps: bool,
    /// whether the law itself keeps the surfaces apart, without a wall
    pub(super) repels: bool,
    /// whether springs end at a rigid wall, or are nearly as stiff as one
    pub(super) stiff: bool,
    /// whether the load pulls by more than the law can hold
    pub(super) torn: bool,
}

/// The plan of a solve.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plan {
    /// the stages before the solution
    pub(super) starts: Vec<Stage>,
    /// whether the surfaces are held apart before the solution, as no state holds the load
    pub(super) torn: bool,
    /// the states that may hold a load where the surfaces come apart, in the order in which they are sought
    pub(super) holds: &'static [Hold],
}

/// Plans a solve.
///
/// On the branch of loading the wall alone comes first, rigid in the place of none. A law that jumps is smoothed. Off
/// the branch of loading stiff springs begin, from a default start, as a rigid wall, which takes a fraction of their
/// iterations. Neither is done if no state holds the load. No state is sought from a given start, which is on a branch
/// that ends where the surfaces come apart, nor on the branch of loading.
pub(super) fn plan(facts: Facts) -> Plan {
    let Facts { given, branch, jumps, repels, stiff, torn } = facts;
    let from_afar = !given && branch == Some(Branch::Loading);
    let seeks = !given && !from_afar;
    let rigid = seeks && stiff && !torn;
    let law = if jumps { StageLaw::Smoothed } else { StageLaw::Own };
    let wall = from_afar.then_some(Stage::wall(repels));
    let start = (rigid || jumps && !torn).then_some(Stage { law, rigid, tolerance: Some(CLOSELY) });
    Plan { starts: wall.into_iter().chain(start).collect(), torn, holds: if seeks && !torn { &Hold::ALL } else { &[] } }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The facts of each row of the guide's table, with their words.
    fn rows() -> Vec<(&'static str, Facts)> {
        let facts = Facts::default();
        let [loading, unloading] =
            [Branch::Loading, Branch::Unloading].map(|branch| Facts { branch: Some(branch), ..facts });
        vec![
            ("no adhesion", facts),
            ("no adhesion, stiff springs", Facts { stiff: true, ..facts }),
            ("no adhesion, a given start", Facts { given: true, ..facts }),
            ("loading", loading),
            ("loading, a law that jumps", Facts { jumps: true, ..loading }),
            ("loading, a law that repels, no wall", Facts { repels: true, ..loading }),
            ("loading, stiff springs", Facts { stiff: true, ..loading }),
            ("loading, a law that jumps, a tension beyond it", Facts { jumps: true, torn: true, ..loading }),
            ("unloading", unloading),
            ("unloading, a law that jumps", Facts { jumps: true, ..unloading }),
            ("unloading, stiff springs", Facts { stiff: true, ..unloading }),
            ("unloading, a law that jumps, stiff springs", Facts { jumps: true, stiff: true, ..unloading }),
            ("unloading, a tension beyond the law", Facts { jumps: true, stiff: true, torn: true, ..unloading }),
            ("adhesion, a given start", Facts { given: true, ..facts }),
            ("adhesion, a given start, a law that jumps", Facts { given: true, jumps: true, ..facts }),
        ]
    }

    /// A stage in words.
    fn name(stage: &Stage) -> String {
        let wall = if stage.rigid { ", rigid wall" } else { "" };
        match stage.law {
            StageLaw::None => format!("wall alone{wall}"),
            StageLaw::Smoothed => format!("law smoothed{wall}"),
            StageLaw::Own => format!("law{wall}"),
        }
    }

    #[test]
    fn the_page_of_the_driver_has_the_plan_of_each_kind_of_solve() {
        let page = include_str!("../guide/driver.md");
        for (kind, facts) in rows() {
            let plan = plan(facts);
            let torn = plan.torn.then(|| "held apart".to_owned());
            let stages: Vec<_> = plan.starts.iter().map(name).chain(torn).chain(["solution".to_owned()]).collect();
            let holds: Vec<_> = plan.holds.iter().map(|hold| format!("`{hold:?}`")).collect();
            let row = format!("| {kind} | {} | {} |", stages.join(" → "), holds.join(", "));
            assert!(page.contains(&row), "the page lacks\n{row}");
        }
    }

    #[test]
    fn every_plan_sharpens_from_stage_to_stage_and_ends_with_the_problem_itself() {
        let branches = [None, Some(Branch::Loading), Some(Branch::Unloading)];
        for (branch, bits) in branches.into_iter().flat_map(|branch| (0..32).map(move |bits| (branch, bits))) {
            let [given, jumps, repels, stiff, torn] = [0, 1, 2, 3, 4].map(|bit| bits >> bit & 1 == 1);
            let plan = plan(Facts { given, branch, jumps, repels, stiff, torn });
            let tolerances: Vec<_> = plan.starts.iter().map(|stage| stage.tolerance.unwrap()).collect();
            assert!(tolerances.is_sorted_by(|a, b| a > b), "{plan:?}");
            // no stage is the solution, or the one before
            assert!(plan.starts.iter().all(|stage| *stage != Stage { tolerance: stage.tolerance, ..Stage::SOLUTION }));
            // without a law no state holds a tension
            let alone = plan.starts.iter().any(|stage| stage.law == StageLaw::None);
            assert!(!alone || plan.holds.is_empty());
            // a rigid wall in the place of springs has no solution under a load that tears
            assert!(!torn || plan.starts.iter().all(|stage| !stage.rigid || repels));
            assert!(!given || plan.holds.is_empty() && !alone);
        }
    }
}
