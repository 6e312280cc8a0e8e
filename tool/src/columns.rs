//! The columns that the tables of `asperity sweep` and `asperity cycle` share: the state, and how its solve ended.

use asperity::Report;
use asperity::contact::ContactStatistics;
use asperity::stability::ContactStiffness;
use asperity_scene::Search;
use serde_json::Value;

use crate::loads::name_and_value;
use crate::options::ProblemOptions;
use crate::part::Part;
use crate::quantity::Quantity;

/// The content of a cell by the name of its column.
pub type Cell = (&'static str, Value);

/// The names of the cells of a state, in the order of [`state`].
pub const STATE: [&str; 18] = [
    "control",
    "control_value",
    "mean_pressure",
    "mean_contact_pressure",
    "mean_gap",
    "normal_force",
    "approach",
    "edge_traction",
    "contact_fraction",
    "corrected_contact_fraction",
    "perimeter",
    "clusters",
    "largest_cluster",
    "repulsive_fraction",
    "attractive_fraction",
    "elastic_energy",
    "adhesive_energy",
    "min_gap",
];

/// The names of the cells of an outcome, in the order of [`outcome`].
pub const OUTCOME: [&str; 5] = ["relative_error", "load_error", "iterations", "operator_applications", "status"];

/// The names of the cells of a contact stiffness, in the order of [`stiffness`].
pub const STIFFNESS: [&str; 2] = ["contact_stiffness", "normal_stiffness"];

/// The names of the cells of the inputs, the same in all rows of a table, so that tables can be put together.
pub const INPUTS: [&str; 7] = ["modulus", "law", "work_of_adhesion", "range", "heights", "part", "seed"];

/// The contact modulus, the adhesion, the name of the file of heights, the part of them that the row is of, and the
/// seed of a random surface.
pub fn inputs(
    ProblemOptions { surface, adhesion, .. }: ProblemOptions<'_>,
    part: &Part,
    seed: Option<u64>,
) -> impl Iterator<Item = Cell> {
    let number = |given: Option<Quantity>| given.map(|given| given.value).into();
    let values: [Value; INPUTS.len()] = [
        surface.modulus().into(),
        adhesion.law.to_string().into(),
        number(adhesion.work_of_adhesion),
        number(adhesion.range),
        surface.heights.file_name().map(|name| name.to_string_lossy()).into(),
        part.name().into(),
        seed.into(),
    ];
    INPUTS.into_iter().zip(values)
}

/// The names of the cells of a search for the load of a contact fraction.
pub const SEARCH: [&str; 2] = ["wanted_contact_fraction", "reached"];

/// The search for the load of a contact fraction.
pub fn search(found: &Search) -> impl Iterator<Item = Cell> {
    SEARCH.into_iter().zip([found.wanted.into(), found.reached.into()])
}

/// The load and the state under it. Nothing in it depends on the clock.
pub fn state(report: &Report, statistics: &ContactStatistics) -> impl Iterator<Item = Cell> {
    let (name, value) = name_and_value(report.control);
    let values: [Value; STATE.len()] = [
        name.into(),
        value.into(),
        report.mean_pressure.into(),
        report.mean_contact_pressure.into(),
        report.mean_gap.into(),
        report.normal_force.into(),
        report.approach.into(),
        report.edge_traction.into(),
        report.contact_fraction.into(),
        statistics.corrected_contact_fraction.into(),
        statistics.perimeter.into(),
        statistics.cluster_sizes.len().into(),
        statistics.cluster_sizes.first().copied().unwrap_or(0).into(),
        statistics.repulsive_fraction.into(),
        statistics.attractive_fraction.into(),
        report.elastic_energy.into(),
        report.adhesive_energy.into(),
        report.min_gap.into(),
    ];
    STATE.into_iter().zip(values)
}

/// How the solve ended.
pub fn outcome(report: &Report) -> impl Iterator<Item = Cell> {
    let values: [Value; OUTCOME.len()] = [
        report.relative_error.into(),
        report.load_error.into(),
        report.iterations.into(),
        report.operator_applications.into(),
        report.status.name().into(),
    ];
    OUTCOME.into_iter().zip(values)
}

/// The contact stiffness; the force is that of a `share` of the map.
pub fn stiffness(found: &ContactStiffness, share: f64) -> impl Iterator<Item = Cell> {
    STIFFNESS.into_iter().zip([found.pressure_per_length.into(), (share * found.force_per_length).into()])
}
