//! The quantities that are asked of a solve.

use asperity::Control;
use asperity::path::PathSettings;
use asperity::solver::Method;

use crate::key::{Adhesion, After, Branches, Entries, FindingsKeys, Goal, Kind, Load, Range, SolverKeys, keys};

keys! {
    /// The grids of a solve.
    NestedKeys {
        "Solver" {
            /// Solve on coarser grids first, if these resolve the adhesion; the default if that is faster
            nested: Option<bool> = Kind::switch().excludes(&["initial_gap"]).replaces("no_nested"),
            /// Solve on the grid of the heights alone
            no_nested: Option<bool> = Kind::switch().replaces("nested"),
        }
    }
}

keys! {
    /// The steps of a cycle.
    PathKeys {
        "Loads" {
            /// Least number of steps between turning points
            steps: Option<usize> = Kind::whole(&["N"]).or("50"),
            /// Step to which jumps are located, as a share of the way between turning points [default: until the work
            /// of the step is known to a fifth of the energy that the jump dissipates]
            smallest_step: Option<f64> = Kind::number(Range::POSITIVE, &["SHARE"]),
            /// Imbalance of energy that a step may have, as a share of the change of the energy so far and of twenty
            /// times the energy dissipated in jumps; smaller jumps are not located one by one
            imbalance: Option<f64> = Kind::number(Range::POSITIVE, &["SHARE"]).or("1e-4"),
        }
        "Adhesion" {
            /// Do not smooth a law with jumps of the traction: the grid then pins the edge of the adhesive zone
            sharp: bool = Kind::switch(),
        }
    }
}

impl Entries {
    /// What is asked of a solve under a load where a reduced pressure of 1 is the `full` pressure.
    ///
    /// # Errors
    /// As [`Entries::after`] and [`Entries::goal`].
    pub fn request(&self, load: Load, full: f64) -> Result<Request, String> {
        let NestedKeys { nested, no_nested } = self.keys();
        let (FindingsKeys { leave, .. }, SolverKeys { branch, .. }) = (self.keys(), self.keys());
        Ok(Request {
            fraction: load.fraction(),
            nested: nested.or(no_nested.map(|denied| !denied)),
            other_branch: branch == Some(Branches::Both),
            stability: self.is_tested(),
            leave,
            after: self.after()?,
            goal: self.goal()?,
            ..Request::under(load.control(full))
        })
    }

    /// The steps of a cycle.
    pub fn path(&self) -> PathSettings {
        let usual = PathSettings::default();
        let PathKeys { steps, smallest_step, imbalance, sharp } = self.keys();
        let usual = usual.steps(steps.unwrap_or(usual.steps)).smallest_step(smallest_step);
        usual.imbalance(imbalance.unwrap_or(usual.imbalance)).smooth(!sharp)
    }
}

/// The load of a solve, and the findings that are asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// The load; of no meaning where a contact fraction is wanted.
    pub control: Control,
    /// The contact fraction for which a load is to be found, if one is.
    pub fraction: Option<f64>,
    /// Whether to solve on nested grids; if it is not said, where that is faster from the default start.
    pub nested: Option<bool>,
    /// Whether to solve on the other branch of equilibria, too.
    pub other_branch: bool,
    /// Whether to test the stability of the solution.
    pub stability: bool,
    /// Whether to continue from an unstable solution.
    pub leave: bool,
    /// The findings that are asked for after it.
    pub after: After,
    /// The accuracy, if one is asked for.
    pub goal: Option<Goal>,
}

impl Request {
    /// The solution under a load, and nothing else.
    pub fn under(control: Control) -> Self {
        let (fraction, nested, after, goal) = (None, None, After::default(), None);
        Self { control, fraction, nested, other_branch: false, stability: false, leave: false, after, goal }
    }

    /// Refuses what excludes each other, in a solve by a method with an adhesion and a wall, from a start that is given
    /// or the default.
    ///
    /// # Errors
    /// The reason and the remedy, for [`worded`](crate::worded).
    pub fn check(&self, adhesion: &Adhesion, method: Method, started: bool) -> Result<(), String> {
        self.check_branches(adhesion.adheres(), method)?;
        self.check_hardness(adhesion, method)?;
        let (fraction, nested, tested) = (self.fraction.is_some(), self.nested == Some(true), self.stability);
        let chosen = [
            ("{initial_gap}", started),
            ("{nested}", self.nested.is_some()),
            ("{leave}", self.leave),
            ("{stability}", tested && !self.leave),
        ];
        let chosen: Vec<_> = chosen.iter().filter(|(_, is_chosen)| *is_chosen).map(|(key, _)| *key).collect();
        let of_both = |what, key| {
            format!("{what} for a load that is given: leave out {key}, or give a load for {{contact_fraction}}")
        };
        Err(match self.goal {
            Some(_) if fraction => of_both("an accuracy is", "{accuracy}"),
            Some(_) if !chosen.is_empty() => {
                let chosen = chosen.join(" and ");
                format!("an accuracy makes its own start and chooses the grids: leave out {chosen}")
            }
            None if nested && fraction => of_both("nested grids are", "{nested}"),
            None if nested && (started || tested) => {
                "nested grids make their own start, and do not test stability: leave out {initial_gap}, {stability} \
                 and {leave}"
                    .to_owned()
            }
            _ => return Ok(()),
        })
    }

    /// Refuses what is known of elastic contact alone where the surface yields.
    fn check_hardness(&self, adhesion: &Adhesion, method: Method) -> Result<(), String> {
        let elastic = "its test and its tangent assume a surface that does not yield";
        let (key, reason) = match self {
            _ if !adhesion.yields() => return Ok(()),
            _ if method == Method::Rey2017 => ("{method=rey2017}", "it has no form for a surface that yields"),
            Self { leave: true, .. } => ("{leave}", elastic),
            Self { stability: true, .. } => ("{stability}", elastic),
            Self { after: After { stiffness: true, .. }, .. } => ("{stiffness}", elastic),
            Self { goal: Some(_), .. } => ("{accuracy}", "the error of the grid is known for elastic contact alone"),
            _ => return Ok(()),
        };
        Err(format!("{key} and {{hardness}}: {reason}: leave one of them out"))
    }

    /// Refuses both branches where there is nothing to be compared.
    fn check_branches(&self, adhesive: bool, method: Method) -> Result<(), String> {
        let reason = match self {
            _ if !self.other_branch => return Ok(()),
            _ if !adhesive => "without adhesion there is but one equilibrium",
            Self { fraction: Some(_), .. } => "each branch has a load of its own for a contact fraction: give a load",
            Self { goal: Some(_), .. } => "each branch has an accuracy of its own: give one branch",
            Self { leave: true, .. } => "leaving an equilibrium changes the branch: give one branch",
            _ if method == Method::Rey2017 => "rey2017 has one start: take the default method",
            _ => return Ok(()),
        };
        Err(format!("{{branch=both}}: {reason}"))
    }
}
