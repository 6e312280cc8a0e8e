//! The account of a solve, with the keys of its report.

use asperity::contact::Patch;
use asperity::{Branch, Control, Criterion, Method, Report, Status};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::entries::{GridErrors, GridLevel, Left, OtherBranch, Reached, Search, Steadiness, list};
use crate::half_space::Boundary;
use crate::told::Told;
use crate::wall::Wall;

/// The account of a solve: its outcome, then its inputs. Its fields are the keys of `report.json` and of the reports in
/// Python, in their order; numbers are in the units of the input, energies per area.
#[derive(Clone, Debug, Serialize)]
pub struct Account {
    /// The command.
    pub command: &'static str,
    /// The status.
    pub status: Status,
    /// The branch of the start, if it has one.
    pub branch: Option<Branch>,
    /// The equilibrium on the other branch, if both were asked for.
    pub other_branch: Option<OtherBranch>,
    /// The certified relative error.
    pub relative_error: f64,
    /// The error of the load.
    pub load_error: f64,
    /// The measure that was compared with the tolerance.
    pub criterion: Criterion,
    /// The number of steps.
    pub iterations: usize,
    /// The number of operator applications.
    pub operator_applications: usize,
    /// The nested grids, the finest last, if they were used.
    pub levels: Option<Vec<GridLevel>>,
    /// The operator applications on all of them, in units of one on the finest.
    pub equivalent_applications: Option<f64>,
    /// The estimated errors of the finest of nested grids, known after a look.
    pub grid_error: Option<GridErrors>,
    /// The end of a solve to an accuracy.
    pub accuracy: Option<Reached>,
    /// The search for the load of a contact fraction.
    pub search: Option<Search>,
    /// The mean gap.
    pub mean_gap: f64,
    /// The mean external pressure.
    pub mean_pressure: f64,
    /// The normal force.
    pub normal_force: f64,
    /// The approach, with a free boundary.
    pub approach: Option<f64>,
    /// The stiffness of a spring, if the load is one.
    pub spring_stiffness: Option<f64>,
    /// The mean pressure that the fields carry.
    pub net_pressure: f64,
    /// The mean contact pressure.
    pub mean_contact_pressure: f64,
    /// The share of the nodes in contact.
    pub contact_fraction: f64,
    /// The number of nodes in contact.
    pub contact_nodes: usize,
    /// The number of absent nodes.
    pub absent_nodes: usize,
    /// The largest traction at the edge of a free boundary over the largest anywhere.
    pub edge_traction: Option<f64>,
    /// The contact area within its edge between the nodes, known after a look.
    pub corrected_contact_fraction: Option<f64>,
    /// The length of the edge, known after a look.
    pub perimeter: Option<f64>,
    /// The share of the nodes with a contact pressure, known after a look.
    pub repulsive_fraction: Option<f64>,
    /// The share of the nodes that attract without contact, known after a look.
    pub attractive_fraction: Option<f64>,
    /// The contact by works of adhesion, known after a look.
    pub patches: Option<Vec<Patch>>,
    /// The smallest gap.
    pub min_gap: f64,
    /// The least (most tensile) elastic pressure, known after a look.
    pub min_pressure: Option<f64>,
    /// The greatest elastic pressure, known after a look.
    pub max_pressure: Option<f64>,
    /// The elastic energy.
    pub elastic_energy: f64,
    /// The adhesive energy.
    pub adhesive_energy: f64,
    /// The stability, if it was asked for.
    pub stability: Option<Steadiness>,
    /// The contact stiffness, a pressure per length, if it was asked for.
    pub contact_stiffness: Option<f64>,
    /// The normal stiffness, a force per length, with the contact stiffness.
    pub normal_stiffness: Option<f64>,
    /// The unstable equilibria that were left, if they were to be.
    pub departures: Option<Vec<Left>>,
    /// The resolution measure μ_ρ.
    pub mu_rho: f64,
    /// The node with the largest work of adhesion, where that varies.
    #[serde(serialize_with = "list")]
    pub mu_rho_node: Option<(usize, usize)>,
    /// Whether the grid does not resolve the adhesion.
    pub under_resolved: bool,
    /// The warnings.
    pub warnings: Vec<Told>,
    /// The time of the solve in seconds.
    pub seconds: f64,
    /// The kind of the load.
    pub control: &'static str,
    /// The value of the load.
    pub control_value: f64,
    /// The inputs.
    #[serde(flatten)]
    pub inputs: Inputs,
    /// The nodes of the shortest wave of the surface, for the errors of nested grids; zero where there are none.
    #[serde(skip)]
    pub nodes_per_wave: f64,
}

impl Account {
    /// The account of a report, with all that stands in it.
    pub(crate) fn of(command: &'static str, report: &Report, inputs: Inputs) -> Self {
        Self {
            command,
            status: report.status,
            branch: report.branch,
            other_branch: None,
            relative_error: report.relative_error,
            load_error: report.load_error,
            criterion: report.criterion,
            iterations: report.iterations,
            operator_applications: report.operator_applications,
            levels: None,
            equivalent_applications: None,
            grid_error: None,
            accuracy: None,
            search: None,
            mean_gap: report.mean_gap,
            mean_pressure: report.mean_pressure,
            normal_force: report.normal_force,
            approach: report.approach,
            spring_stiffness: match report.control {
                Control::Spring { stiffness, .. } => Some(stiffness),
                _ => None,
            },
            net_pressure: report.net_pressure,
            mean_contact_pressure: report.mean_contact_pressure,
            contact_fraction: report.contact_fraction,
            contact_nodes: report.contact_nodes,
            absent_nodes: report.absent_nodes,
            edge_traction: report.edge_traction,
            corrected_contact_fraction: None,
            perimeter: None,
            repulsive_fraction: None,
            attractive_fraction: None,
            patches: None,
            min_gap: report.min_gap,
            min_pressure: None,
            max_pressure: None,
            elastic_energy: report.elastic_energy,
            adhesive_energy: report.adhesive_energy,
            stability: None,
            contact_stiffness: None,
            normal_stiffness: None,
            departures: None,
            mu_rho: report.mu_rho,
            mu_rho_node: None,
            under_resolved: report.under_resolved,
            warnings: Vec::new(),
            seconds: 0.0,
            control: report.control.name(),
            control_value: report.control.value(),
            inputs,
            nodes_per_wave: 0.0,
        }
    }
}

/// The inputs of a command, by their names in every report.
#[derive(Clone, Debug, Serialize)]
pub struct Inputs {
    /// The file of the heights.
    pub heights: Option<String>,
    /// The file of the gap from which the solve started, or a word for it.
    pub initial_gap: Option<String>,
    /// The part of a mirrored map that results are of.
    pub part: Option<String>,
    /// The nodes that are solved, if results are of fewer.
    #[serde(serialize_with = "list")]
    pub solved_shape: Option<(usize, usize)>,
    /// The nodes of the results.
    #[serde(serialize_with = "list")]
    pub shape: (usize, usize),
    /// The side lengths of the results.
    #[serde(serialize_with = "list")]
    pub lengths: (f64, f64),
    /// The unit of lengths, if it is known.
    pub length_unit: Option<String>,
    /// The unit of pressures, if it is known.
    pub pressure_unit: Option<String>,
    /// The quantities as they were typed, if they have units.
    pub given: Option<Value>,
    /// The boundary.
    pub boundary: Boundary,
    /// The contact modulus.
    pub modulus: f64,
    /// The adhesion and the wall.
    #[serde(flatten)]
    pub adhesion: Adhesion,
    /// The method.
    pub method: Method,
    /// The precision.
    pub precision: &'static str,
    /// The tolerance to which the solve was held.
    pub tolerance: f64,
    /// The iterations after which to give up.
    pub max_iterations: usize,
    /// The number of threads.
    pub threads: usize,
    /// The version of the program.
    pub version: &'static str,
}

/// The adhesion and the wall, by their names in every report.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Adhesion {
    /// The name of the law.
    pub law: String,
    /// The work of adhesion, if it is a parameter.
    pub work_of_adhesion: Option<f64>,
    /// The range, if it is a parameter.
    pub range: Option<f64>,
    /// The exponent of a power law.
    pub exponent: Option<f64>,
    /// Hamaker's constant, if it is a parameter.
    pub hamaker: Option<f64>,
    /// The file of a table.
    pub law_table: Option<String>,
    /// The gap at which the law is cut off, if it is.
    pub cut_off: Option<f64>,
    /// The file of works of adhesion that vary.
    pub work_of_adhesion_map: Option<String>,
    /// The wall.
    pub wall: Wall,
}
