//! The keys that are keywords of Python.

use crate::key::{
    AccuracyKeys, AdhesionKeys, ConductorKeys, CycleAccuracyKeys, FindingsKeys, FractionsKeys, Key, Keys, LeakageKeys,
    LoadKeys, LoadsKeys, NestedKeys, PathKeys, PullOffKeys, SolverKeys, StiffnessKeys, SurfaceKeys, Values,
};

/// Their lists: the name of each, what it is of, and its keys; the accuracies of a cycle and of a pull-off, which
/// have meanings of their own, come last.
pub static KEYWORDS: [(&str, &str, &[Key]); 15] = [
    ("Surface", "The surface, the bodies, and the boundary", SurfaceKeys::KEYS),
    ("Adhesion", "The adhesion between the surfaces, the wall, and the hardness", AdhesionKeys::KEYS),
    ("Solver", "The method and the accuracy of a solve", SolverKeys::KEYS),
    ("Load", "The load of a solve: one of these", LoadKeys::KEYS),
    ("Loads", "The loads of a table, a list of one kind", LoadsKeys::KEYS),
    ("Fractions", "The contact fractions of a table", FractionsKeys::KEYS),
    ("Nested", "The grids of a solve", NestedKeys::KEYS),
    ("Findings", "The findings after a solution", FindingsKeys::KEYS),
    ("Stiffness", "The contact stiffness of each row of a table", StiffnessKeys::KEYS),
    ("Conductor", "The conductors, for the conductance by the contact stiffness", ConductorKeys::KEYS),
    ("Leakage", "The leakage of a table", LeakageKeys::KEYS),
    ("Accuracy", "The accuracy to reach", AccuracyKeys::KEYS),
    ("Path", "The steps of a cycle", PathKeys::KEYS),
    ("CycleAccuracy", "The accuracy of a cycle", CycleAccuracyKeys::KEYS),
    ("PullOff", "The pull-off that is asked for", PullOffKeys::KEYS),
];

impl Key {
    /// Whether it is a keyword of Python: files are arrays and objects there, side lengths stand next to the heights, and
    /// a switch that denies another one is its value False.
    pub fn is_keyword(&self) -> bool {
        !matches!(self.kind.values, Values::File) && !["lengths", "no_nested", "sharp"].contains(&self.name)
    }
}
