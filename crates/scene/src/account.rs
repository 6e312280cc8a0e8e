//! The answer to a solve: the list of its numbers, and what shows them in which order.
//!
//! A number stands once, in the record of its noun, with its meaning, its measure, and where it is found: the keys of
//! reports and the columns of tables come from there, and the types and attributes in Python and the tables of the
//! documents. The lists below [`Account`] say which tables, rows of summaries and headings of pages have it.

mod answer;
pub mod column;
pub mod contact;
mod displacement;
mod entries;
mod findings;
mod inputs;
pub mod interface;
mod leaked;
mod look;
mod numbers;
mod pulled_off;
pub(crate) mod row;
mod rows;
mod sentences;
mod slopes;
pub mod statistics;
pub mod theories;
mod warnings;
mod words;

use asperity::contact::Patch;
use asperity::solver::Criterion;
use asperity::{Branch, Control, Held, Real, Report, Status};
use asperity_flow::Axis;
use serde::Serialize;

pub use self::answer::{Answer, Sight, check_finite};
pub(crate) use self::answer::{Waves, warnings_of};
pub use self::entries::{GridErrors, GridLevel, Left, OtherBranch, Refinement, Search, Steadiness, Step};
pub use self::findings::{Conducted, Findings};
pub use self::inputs::Inputs;
pub use self::leaked::{Along, Enclosed, Leaked, Narrowest, Transmissivity};
pub use self::numbers::dimension_of_key;
pub use self::pulled_off::PulledOff;
pub(crate) use self::row::INPUTS;
pub use self::row::Row;
use self::rows::Line::{self, Alone, Of, OfAdhesion, Words};
pub use self::rows::rows;
pub(crate) use self::sentences::{bytes, estimate, missing_error};
pub use self::sentences::{shortfalls, unbalanced};
pub use self::slopes::Slopes;
pub(crate) use self::warnings::warnings_of_input;
pub use self::words::corrected;
use crate::key;
use crate::key::{
    ENERGY_PER_AREA, FORCE, FORCE_PER_LENGTH, LENGTH, Notice, PRESSURE, PRESSURE_PER_LENGTH, record, worded,
};
use crate::numbers::plain;

record! {
    /// The account of a solve: its outcome, then its inputs. Its fields are the keys of `report.json` and of the
    /// reports in Python, in their order; numbers are in the units of the input, energies per area.
    #[derive(Clone, Debug, Serialize)]
    Account of <T: Real> (
        command: &'static str,
        found: &Answer<T>,
        report: &Report,
        share: f64,
        inputs: Inputs,
        strongest: Option<(usize, usize)>,
        warnings: Vec<Notice>,
    ) {
        /// Command of the program.
        command: &'static str = command,
        /// End of the solve: `converged`, `stalled`, `iteration-limit`, `detached` or `stopped`.
        status: Status = report.status,
        /// With adhesion, the branch of the start.
        branch: Option<Branch> = report.branch,
        /// Equilibrium on the other branch, by `branch` `both`.
        other_branch: Option<OtherBranch> = found.other_branch.clone(),
        /// Certified relative error in the energy norm.
        relative_error: f64 as Error = report.relative_error,
        /// Relative error of the load or mean gap that is held.
        load_error: f64 as Error = report.load_error,
        /// Quantity compared with the tolerance: `energy-norm`, the certified error, or `complementarity`.
        criterion: Criterion = report.criterion,
        /// Iterations, on the finest of nested grids.
        iterations: usize = report.iterations,
        /// Operator applications, each a forward and an inverse transform, on the finest of nested grids.
        operator_applications: usize = report.operator_applications,
        /// Nested grids, the finest last.
        levels: Option<Vec<GridLevel>> = found.levels.as_ref().map(|all| all.iter().map(GridLevel::record).collect()),
        /// Operator applications on all nested grids, in units of one on the finest.
        equivalent_applications: Option<f64> = found.equivalent_applications,
        /// Estimated errors of the finest of nested grids.
        grid_error: Option<GridErrors> = None,
        /// Why `grid_error` has no error of the area, or of the quantity that has an accuracy.
        grid_error_reason: Option<String> = None,
        /// End of a solve to an accuracy.
        accuracy: Option<Refinement> = found.accuracy,
        /// Search for the load of a contact fraction.
        search: Option<Search> = found.search,
        /// Mean gap.
        mean_gap: f64 [LENGTH] = report.mean_gap,
        /// Mean external pressure p̄, the normal force over the nominal area, compression positive.
        mean_pressure: f64 [PRESSURE] = report.mean_pressure,
        /// Normal force F = p̄·Lx·Ly, compression positive.
        normal_force: f64 [FORCE] = report.normal_force,
        /// With a free boundary, or a given approach of a layer or a coating, the way of the bodies towards each other
        /// since first touch without deformation.
        approach: Option<f64> [LENGTH] = report.approach.or(held(report.control)),
        /// Stiffness of a spring as the load.
        spring_stiffness: Option<f64> [FORCE_PER_LENGTH] = stiffness(report.control),
        /// Load of the fields: mean contact pressure less mean adhesive traction.
        net_pressure: f64 [PRESSURE] = report.net_pressure,
        /// Mean contact pressure.
        mean_contact_pressure: f64 [PRESSURE] = report.mean_contact_pressure,
        /// Share of the nodes in contact, without absent nodes.
        contact_fraction: f64 as Share = report.contact_fraction,
        /// Nodes in contact.
        contact_nodes: usize = report.contact_nodes,
        /// Absent nodes, at which nothing faces the half-space.
        absent_nodes: usize = report.absent_nodes,
        /// With a free boundary, the largest traction on the outermost nodes over the largest anywhere: above 0.001 the map
        /// is too small, unless the body ends there.
        edge_traction: Option<f64> as Share = report.edge_traction,
        /// With `jkr`, the contact fraction by the adhesive energy, −E_adh/w, which is too large.
        adhesive_contact_fraction: Option<f64> as Share = report.adhesive_contact_fraction,
        /// With `jkr`, the area of the theory of JKR, to be reported: the contact fraction by the adhesive energy, less
        /// the process zone at the edges.
        jkr_contact_fraction: Option<f64> as Share = found.sight.jkr_contact_fraction,
        /// Share of the area within the contact edge, located between the nodes. On rough surfaces it is 5 to 12 % too large
        /// with 2 nodes in the shortest waves, and 2 to 4 % with 3.
        corrected_contact_fraction: f64 as Share = f64::NAN,
        /// Length of the contact edge along the sides of the cells; on a line the number of its ends.
        perimeter: f64 [LENGTH] = f64::NAN,
        /// Share of the nodes that push.
        repulsive_fraction: f64 as Share = f64::NAN,
        /// Share of the nodes that pull without contact.
        attractive_fraction: f64 as Share = f64::NAN,
        /// Contact on the nodes of each of at most 16 works of adhesion.
        patches: Option<Vec<Patch>> = None,
        /// Least gap.
        min_gap: f64 [LENGTH] = report.min_gap,
        /// Least (most tensile) elastic pressure.
        min_pressure: f64 [PRESSURE] = f64::NAN,
        /// Greatest elastic pressure.
        max_pressure: f64 [PRESSURE] = f64::NAN,
        /// How far the pressure is below zero without adhesion, as a share of the greatest one, after a look.
        #[serde(skip)]
        pressure_residue: f64 = 0.0,
        /// Elastic energy per area.
        elastic_energy: f64 [ENERGY_PER_AREA] = report.elastic_energy,
        /// Adhesive energy per area.
        adhesive_energy: f64 [ENERGY_PER_AREA] = report.adhesive_energy,
        /// With a hardness, the share of the nodes that have yielded.
        plastic_fraction: Option<f64> as Share = report.plastic.map(|plastic| plastic.fraction),
        /// With a hardness, the greatest plastic depth.
        plastic_depth_max: Option<f64> [LENGTH] = report.plastic.map(|plastic| plastic.depth_max),
        /// With a hardness, the mean plastic depth.
        plastic_depth_mean: Option<f64> [LENGTH] = report.plastic.map(|plastic| plastic.depth_mean),
        /// With a hardness, the energy per area that yielding has dissipated.
        plastic_energy: Option<f64> [ENERGY_PER_AREA] = report.plastic.map(|plastic| plastic.energy),
        /// Stability, by `stability` or `leave`.
        stability: Option<Steadiness> = found.stability,
        /// Contact stiffness dp̄/dδ, the slope of the mean pressure over the approach, or over minus the mean gap: the
        /// stiffness of a flat punch with the outline of the contact. Infinite in full contact; with adhesion it may be
        /// negative.
        contact_stiffness: Option<f64> [PRESSURE_PER_LENGTH] = found.stiffness.map(|found| found.pressure_per_length),
        /// Relative error of the contact stiffness, with the estimated error of the grid.
        stiffness_error: Option<f64> as Error = found.stiffness.and_then(|found| found.error()),
        /// Normal stiffness dF/dδ, with the contact stiffness.
        normal_stiffness: Option<f64> [FORCE_PER_LENGTH] = found.stiffness.map(|found| share * found.force_per_length),
        /// Conductance, by `resistivities` or `conductivities`.
        conductance: Option<Conducted> = found.after.conductance,
        /// Whether open nodes connect the sides, along `x` and `y`, with the percolation.
        percolates: Option<Along<bool>> = found.after.percolates,
        /// Narrowest place of the widest passage along `x` and `y`, with the percolation.
        constriction: Option<Along<Option<Narrowest>>> = found.after.constriction,
        /// Transmissivity along `x` and `y`.
        transmissivity: Option<Along<Transmissivity>> = found.after.transmissivity,
        /// Unstable equilibria that were left.
        departures: Option<Vec<Left>> = found.departures.clone(),
        /// With `jkr`, the traction in contact of the grid, 2w/ρ.
        peak_traction: Option<f64> [PRESSURE] = report.peak_traction,
        /// Resolution measure √(wΔx/E*)/ρ.
        mu_rho: f64 = report.mu_rho,
        /// Node (ix, iy) with the largest of varying works of adhesion.
        mu_rho_node: Option<(usize, usize)> = strongest,
        /// Whether `mu_rho` exceeds 0.5: the grid does not resolve the adhesion.
        under_resolved: bool = report.under_resolved,
        /// Warnings.
        warnings: Vec<Notice> = warnings,
        /// Time of the solve, without files and pictures.
        seconds: f64 as Seconds = found.seconds,
        /// Quantity that is held, for example `mean-gap`.
        control: &'static str = report.control.name(),
        /// Value that is held; for a spring its position.
        control_value: f64 = report.control.value(),
        /// The inputs.
        #[serde(flatten)]
        inputs: Inputs = inputs,
        /// The nodes of the shortest wave of the surface, for the errors of nested grids; zero where there are none.
        #[serde(skip)]
        nodes_per_wave: f64 = 0.0,
    }
}

/// The numbers that a solution in Python has as attributes.
pub const ATTRIBUTES: &str = "status boundary relative_error iterations operator_applications mean_gap mean_pressure normal_force \
                              approach mean_contact_pressure contact_fraction absent_nodes edge_traction elastic_energy \
                              adhesive_energy contact_stiffness normal_stiffness";

/// The columns of a state in a table.
pub(crate) const STATE: &str = "control control_value mean_pressure mean_contact_pressure mean_gap normal_force approach \
                                edge_traction contact_fraction corrected_contact_fraction perimeter clusters largest_cluster \
                                repulsive_fraction attractive_fraction elastic_energy adhesive_energy min_gap";
pub(crate) const OUTCOME: &str = "relative_error load_error iterations operator_applications status";
/// The contact by the adhesive energy, and in the limit of no range, of a law that has the range of the grid.
pub(crate) const LIMIT: &str = "adhesive_contact_fraction jkr_contact_fraction";
pub(crate) const PLASTIC: &str = "hardness plastic_fraction plastic_depth_max plastic_depth_mean plastic_energy";
pub(crate) const STIFFNESS: &str = "contact_stiffness normal_stiffness";

/// The numbers of reports and tables on a page, in the order in which one asks for them, by headings. Others are of the
/// surface and the settings.
pub const GROUPS: [(&str, &str); 8] = [
    (
        "Pull-off",
        "pull_off_pressure pull_off_force limit_pressure limit_force limit_error limit_reason to_report lost_pressure \
         preload solves",
    ),
    (
        "Load",
        "case leg direction control control_value mean_pressure normal_force net_pressure spring_stiffness branch \
         wanted_contact_fraction reached search",
    ),
    (
        "Contact",
        "contact_fraction jkr_contact_fraction corrected_contact_fraction adhesive_contact_fraction contact_nodes \
         absent_nodes perimeter clusters largest_cluster repulsive_fraction attractive_fraction plastic_fraction patches \
         contact_stiffness stiffness_error normal_stiffness",
    ),
    ("Gap", "mean_gap min_gap approach plastic_depth_max plastic_depth_mean"),
    ("Pressures", "hardness mean_contact_pressure min_pressure max_pressure peak_traction edge_traction"),
    (
        "Energies",
        "elastic_energy adhesive_energy plastic_energy work dissipated imbalance work_error event energy_drop stability \
         departures other_branch",
    ),
    ("Error", "status criterion relative_error load_error grid_error accuracy mu_rho mu_rho_node under_resolved"),
    ("Cost", "iterations operator_applications equivalent_applications seconds"),
];

/// The numbers of attraction, which say nothing of surfaces that do not adhere.
pub const OF_ADHESION: &str = "net_pressure min_pressure repulsive_fraction attractive_fraction adhesive_energy mu_rho \
                               mu_rho_node under_resolved";

/// The rows of a summary, in their order: their labels, and what they tell.
pub(crate) const SUMMARY: &[(&str, Line)] = &[
    ("part of the mirrored map", Words(words::part)),
    ("side lengths", Words(words::sides)),
    ("body", Words(|s, units, _| s.inputs.elastic.in_words(units))),
    ("contact", Of(key!(Account, contact_fraction))),
    ("corrected for its edge", Words(words::corrected_area)),
    ("by JKR", Of(key!(Account, jkr_contact_fraction))),
    ("nodes in contact", Words(words::nodes_in_contact)),
    ("", Alone(words::patches)),
    ("wanted", Words(words::wanted)),
    ("mean gap", Of(key!(Account, mean_gap))),
    ("mean pressure", Of(key!(Account, mean_pressure))),
    ("normal force", Of(key!(Account, normal_force))),
    ("approach", Of(key!(Account, approach))),
    ("traction at the edge", Of(key!(Account, edge_traction))),
    ("net pressure", Of(key!(Account, net_pressure))),
    ("mean contact pressure", Of(key!(Account, mean_contact_pressure))),
    ("least pressure", Words(words::least_pressure)),
    ("greatest pressure", Of(key!(Account, max_pressure))),
    ("elastic energy per area", Of(key!(Account, elastic_energy))),
    ("adhesive energy per area", OfAdhesion(key!(Account, adhesive_energy))),
    ("range of the grid", Words(words::range_of_the_grid)),
    ("mu_rho", OfAdhesion(key!(Account, mu_rho))),
    ("yielded", Of(key!(Account, plastic_fraction))),
    ("greatest plastic depth", Of(key!(Account, plastic_depth_max))),
    ("mean plastic depth", Of(key!(Account, plastic_depth_mean))),
    ("plastic work per area", Of(key!(Account, plastic_energy))),
    ("contact stiffness", Words(words::stiffness)),
    ("conductance per area", Words(words::conductance)),
    ("gap along x", Words(|s, units, _| words::narrowest(s, Axis::X, units))),
    ("transmissivity along x", Words(|s, units, _| words::transmissivity(s, Axis::X, units))),
    ("gap along y", Words(|s, units, _| words::narrowest(s, Axis::Y, units))),
    ("transmissivity along y", Words(|s, units, _| words::transmissivity(s, Axis::Y, units))),
    ("branch", OfAdhesion(key!(Account, branch))),
    ("", Alone(words::other_branch)),
    ("certified error", Words(|s, _, _| Some(format!("{:.1e}", s.relative_error)))),
    ("stability", Words(words::stability)),
    ("smallest eigenvalue", Words(|s, _, _| Some(plain(s.stability?.eigenvalue)))),
    ("its lower bound", Words(|s, _, _| Some(plain(s.stability?.lower_bound)))),
    ("energy drop in leaving", Words(words::energy_drop)),
    ("error bound", Words(words::error_bound)),
    ("iterations", Of(key!(Account, iterations))),
    ("operator applications", Of(key!(Account, operator_applications))),
    ("with coarser grids", Words(|s, _, _| Some(format!("{:.1}", s.equivalent_applications?)))),
    ("error of the grid", Words(|s, _, skin| s.levels.as_ref().map(|_| worded(&estimate(s), skin)))),
    ("time", Of(key!(Account, seconds))),
    ("status", Of(key!(Account, status))),
];

/// The approach that a load holds.
fn held(control: Control) -> Option<f64> {
    (control.holds() == Held::Approach).then(|| control.value())
}

/// The stiffness of a spring, if the load is one.
pub(crate) fn stiffness(control: Control) -> Option<f64> {
    if let Held::Spring(stiffness) = control.holds() { Some(stiffness) } else { None }
}
