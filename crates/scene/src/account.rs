//! The account of a solve, with the keys of its report.

pub mod contact;
mod dimensions;
mod displacement;
mod entries;
mod findings;
mod found;
pub mod interface;
mod leaked;
mod pulled_off;
pub(crate) mod row;
mod rows;
mod sentences;
mod slopes;
pub mod statistics;
pub mod theories;
mod warnings;

use asperity::contact::{ContactStatistics, Patch};
use asperity::solver::{Criterion, Method};
use asperity::{Branch, Control, Real, Report, Result, Solution, Status};
use ndarray::ArrayView2;
use serde::Serialize;
use serde_json::Value;

pub use self::dimensions::{dimension_of, dimension_of_key};
pub use self::entries::{GridErrors, GridLevel, Left, OtherBranch, Reached, Search, Steadiness, Step};
pub use self::findings::{Conducted, Findings};
pub use self::found::{Found, Sight, check_finite};
pub(crate) use self::found::{Waves, warnings_of};
pub use self::leaked::{Along, Enclosed, Leaked, Narrowest, Transmissivity};
pub use self::pulled_off::PulledOff;
pub(crate) use self::row::INPUTS;
pub use self::row::Row;
pub use self::rows::{corrected, rows};
pub(crate) use self::sentences::{estimate, untold};
pub use self::sentences::{shortfalls, unbalanced};
pub use self::slopes::Slopes;
pub(crate) use self::warnings::warnings_of_input;
use crate::key::{
    Adhesion, ENERGY_PER_AREA, Elastic, FORCE, FORCE_PER_LENGTH, LENGTH, PRESSURE, PRESSURE_PER_LENGTH, Precision,
    Scene, Told, Units, record,
};

/// The approach that a load holds.
fn held(control: Control) -> Option<f64> {
    if let Control::Approach(approach) = control { Some(approach) } else { None }
}

record! {
    /// The account of a solve: its outcome, then its inputs. Its fields are the keys of `report.json` and of the
    /// reports in Python, in their order; numbers are in the units of the input, energies per area.
    #[derive(Clone, Debug, Serialize)]
    Account of <T: Real> (
        command: &'static str,
        found: &Found<T>,
        report: &Report,
        share: f64,
        inputs: Inputs,
        strongest: Option<(usize, usize)>,
        warnings: Vec<Told>,
    ) {
        /// The command.
        command: &'static str = command,
        /// The status.
        status: Status = report.status,
        /// The branch of the start, if it has one.
        branch: Option<Branch> = report.branch,
        /// The equilibrium on the other branch, if both were asked for.
        other_branch: Option<OtherBranch> = found.other_branch.clone(),
        /// The certified relative error.
        relative_error: f64 = report.relative_error,
        /// The error of the load.
        load_error: f64 = report.load_error,
        /// The measure that was compared with the tolerance.
        criterion: Criterion = report.criterion,
        /// The number of steps.
        iterations: usize = report.iterations,
        /// The number of operator applications.
        operator_applications: usize = report.operator_applications,
        /// The nested grids, the finest last, if they were used.
        levels: Option<Vec<GridLevel>> = found.levels.as_ref().map(|all| all.iter().map(GridLevel::of).collect()),
        /// The operator applications on all of them, in units of one on the finest.
        equivalent_applications: Option<f64> = found.equivalent_applications,
        /// The estimated errors of the finest of nested grids, known after a look.
        grid_error: Option<GridErrors> = None,
        /// The reason why the error of the area, or of the quantity that has an accuracy, is not told, after a look.
        grid_error_reason: Option<String> = None,
        /// The end of a solve to an accuracy.
        accuracy: Option<Reached> = found.accuracy,
        /// The search for the load of a contact fraction.
        search: Option<Search> = found.search,
        /// The mean gap.
        mean_gap: f64 [LENGTH] = report.mean_gap,
        /// The mean external pressure.
        mean_pressure: f64 [PRESSURE] = report.mean_pressure,
        /// The normal force.
        normal_force: f64 [FORCE] = report.normal_force,
        /// The approach, with a free boundary, and where one is held over a layer or a coating.
        approach: Option<f64> [LENGTH] = report.approach.or(held(report.control)),
        /// The stiffness of a spring, if the load is one.
        spring_stiffness: Option<f64> [FORCE_PER_LENGTH] = stiffness(report.control),
        /// The mean pressure that the fields carry.
        net_pressure: f64 [PRESSURE] = report.net_pressure,
        /// The mean contact pressure.
        mean_contact_pressure: f64 [PRESSURE] = report.mean_contact_pressure,
        /// The share of the nodes in contact.
        contact_fraction: f64 = report.contact_fraction,
        /// The number of nodes in contact.
        contact_nodes: usize = report.contact_nodes,
        /// The number of absent nodes.
        absent_nodes: usize = report.absent_nodes,
        /// The largest traction at the edge of a free boundary over the largest anywhere.
        edge_traction: Option<f64> = report.edge_traction,
        /// The contact area by the adhesive energy, of a law that has the range of the grid.
        adhesive_contact_fraction: Option<f64> = report.adhesive_contact_fraction,
        /// That of the limit of no range, less the process zone at the edge.
        jkr_contact_fraction: Option<f64> = found.sight.jkr_contact_fraction,
        /// The contact area within its edge between the nodes, known after a look.
        corrected_contact_fraction: Option<f64> = None,
        /// The length of the edge, known after a look.
        perimeter: Option<f64> [LENGTH] = None,
        /// The share of the nodes with a contact pressure, known after a look.
        repulsive_fraction: Option<f64> = None,
        /// The share of the nodes that attract without contact, known after a look.
        attractive_fraction: Option<f64> = None,
        /// The contact by works of adhesion, known after a look.
        patches: Option<Vec<Patch>> = None,
        /// The smallest gap.
        min_gap: f64 [LENGTH] = report.min_gap,
        /// The least (most tensile) elastic pressure, known after a look.
        min_pressure: Option<f64> [PRESSURE] = None,
        /// The greatest elastic pressure, known after a look.
        max_pressure: Option<f64> [PRESSURE] = None,
        /// How far the pressure is below zero without adhesion, as a share of the greatest one, after a look.
        #[serde(skip)]
        pressure_residue: f64 = 0.0,
        /// The elastic energy.
        elastic_energy: f64 [ENERGY_PER_AREA] = report.elastic_energy,
        /// The adhesive energy.
        adhesive_energy: f64 [ENERGY_PER_AREA] = report.adhesive_energy,
        /// The share of the nodes that have yielded, at a hardness.
        plastic_fraction: Option<f64> = report.plastic.map(|plastic| plastic.fraction),
        /// The greatest plastic depth.
        plastic_depth_max: Option<f64> [LENGTH] = report.plastic.map(|plastic| plastic.depth_max),
        /// The mean plastic depth.
        plastic_depth_mean: Option<f64> [LENGTH] = report.plastic.map(|plastic| plastic.depth_mean),
        /// The energy that yielding has dissipated.
        plastic_energy: Option<f64> [ENERGY_PER_AREA] = report.plastic.map(|plastic| plastic.energy),
        /// The stability, if it was asked for.
        stability: Option<Steadiness> = found.stability,
        /// The contact stiffness, a pressure per length, if it was asked for.
        contact_stiffness: Option<f64> [PRESSURE_PER_LENGTH] = found.stiffness.map(|found| found.pressure_per_length),
        /// The relative error of the contact stiffness, the estimated one of the grid included; none where that is unknown.
        stiffness_error: Option<f64> = found.stiffness.and_then(|found| found.error()),
        /// The normal stiffness, a force per length, with the contact stiffness.
        normal_stiffness: Option<f64> [FORCE_PER_LENGTH] = found.stiffness.map(|found| share * found.force_per_length),
        /// The conductance per area, if it was asked for.
        conductance: Option<Conducted> = found.after.conductance,
        /// Whether open nodes connect the sides, if the percolation was asked for.
        percolates: Option<Along<bool>> = found.after.percolates,
        /// The widest passages, with the percolation.
        constriction: Option<Along<Option<Narrowest>>> = found.after.constriction,
        /// The transmissivity, if it was asked for.
        transmissivity: Option<Along<Transmissivity>> = found.after.transmissivity,
        /// The unstable equilibria that were left, if they were to be.
        departures: Option<Vec<Left>> = found.departures.clone(),
        /// The traction in contact, of a law that has the range of the grid.
        peak_traction: Option<f64> [PRESSURE] = report.peak_traction,
        /// The resolution measure μ_ρ.
        mu_rho: f64 = report.mu_rho,
        /// The node with the largest work of adhesion, where that varies.
        mu_rho_node: Option<(usize, usize)> = strongest,
        /// Whether the grid does not resolve the adhesion.
        under_resolved: bool = report.under_resolved,
        /// The warnings.
        warnings: Vec<Told> = warnings,
        /// The time of the solve in seconds.
        seconds: f64 = found.seconds,
        /// The kind of the load.
        control: &'static str = report.control.name(),
        /// The value of the load.
        control_value: f64 = report.control.value(),
        /// The inputs.
        #[serde(flatten)]
        inputs: Inputs = inputs,
        /// The nodes of the shortest wave of the surface, for the errors of nested grids; zero where there are none.
        #[serde(skip)]
        nodes_per_wave: f64 = 0.0,
    }
}

/// The stiffness of a spring, if the load is one.
pub(crate) fn stiffness(control: Control) -> Option<f64> {
    if let Control::Spring { stiffness, .. } = control { Some(stiffness) } else { None }
}

impl<T: Real> Found<T> {
    /// The account of the solve by a command, of which [`Sight::look`] adds the keys that are found of the fields.
    ///
    /// # Errors
    /// [`Error::Shape`](asperity::Error::Shape) if the solution is not one of the whole of an original.
    pub fn account(
        &self,
        command: &'static str,
        inputs: &Inputs,
        strongest: Option<(usize, usize)>,
        warnings: Vec<Told>,
    ) -> Result<Account> {
        let (original, part) = (self.sight.original, self.part()?);
        let (grid, report) = (&part.grid, &part.report);
        let share = original.map_or(1.0, |original| original.share());
        let inputs = Inputs {
            solved_shape: original.map(|_| self.solution.grid.shape()),
            shape: grid.shape(),
            lengths: grid.lengths(),
            tolerance: report.tolerance,
            adhesion: Adhesion {
                range: inputs.adhesion.range.or(report.range),
                hardness: report.plastic.map(|plastic| plastic.hardness),
                ..inputs.adhesion.clone()
            },
            ..inputs.clone()
        };
        let mut account = Account::of(command, self, report, share, inputs, strongest, warnings);
        self.sight.tell(&mut account);
        Ok(account)
    }
}

impl<T: Real> Sight<T> {
    /// Looks at the fields of the solution, as [`Sight::look`].
    ///
    /// # Errors
    /// Those of [`Sight::look`].
    pub fn look_at(&mut self, account: &mut Account, solution: &Solution<T>) -> Result<ContactStatistics> {
        let Solution { gap, pressure, contact_pressure, .. } = solution;
        self.look(account, [gap.view(), pressure.view(), contact_pressure.view()])
    }

    /// Looks at gap, pressure and contact pressure: fills in the keys of the account that are found of them, and
    /// returns the statistics of the contact. All processes that share the grid have to look.
    ///
    /// # Errors
    /// [`Error::Shape`](asperity::Error::Shape) if a field does not have the shape of the grid.
    pub fn look(&mut self, account: &mut Account, fields: [ArrayView2<'_, T>; 3]) -> Result<ContactStatistics> {
        let (found, pressures) = self.seen(fields)?;
        if let Some((waves, levels)) = self.open.take() {
            self.estimate(&levels, waves.nodes(self.report.boundary));
        }
        self.tell(account);
        account.corrected_contact_fraction = Some(found.corrected_contact_fraction);
        account.perimeter = Some(found.perimeter);
        account.repulsive_fraction = Some(found.repulsive_fraction);
        account.attractive_fraction = Some(found.attractive_fraction);
        account.patches = Some(found.patches.clone());
        account.min_pressure = Some(pressures.least);
        account.max_pressure = Some(pressures.greatest);
        account.pressure_residue = pressures.residue;
        Ok(found)
    }

    /// Puts the errors that are known into an account.
    fn tell(&self, account: &mut Account) {
        if let Some((errors, nodes_per_wave)) = self.errors {
            (account.grid_error, account.nodes_per_wave) = (Some(errors), nodes_per_wave);
            let is_told = errors.in_words(account.accuracy.map(|reached| reached.of)).is_some();
            account.grid_error_reason = (!is_told || errors.area.is_none()).then(|| untold(account));
        }
    }
}

record! {
    /// The inputs of a command, by their names in every report.
    #[derive(Clone, Debug, Serialize)]
    Inputs of (scene: &Scene, shape: (usize, usize), lengths: (f64, f64), threads: usize) {
        /// The file of the heights.
        heights: Option<String> = None,
        /// The file of the heights on the other side, or a word for them, if there are any.
        against: Option<String> = None,
        /// The shift of these along both axes.
        shift: Option<(f64, f64)> = None,
        /// The file of the gap from which the solve started, or a word for it.
        initial_gap: Option<String> = None,
        /// The part of a mirrored map that results are of.
        part: Option<String> = None,
        /// The nodes that are solved, if results are of fewer.
        solved_shape: Option<(usize, usize)> = None,
        /// The nodes of the results.
        shape: (usize, usize) = shape,
        /// The side lengths of the results.
        lengths: (f64, f64) = lengths,
        /// The rms slopes of the surface.
        #[serde(flatten)]
        slopes: Slopes = Slopes::default(),
        /// The unit of lengths, if it is known.
        length_unit: Option<String> = None,
        /// The unit of pressures, if it is known.
        pressure_unit: Option<String> = None,
        /// The quantities as they were typed, if they have units.
        given: Option<Value> = None,
        /// The elastic body.
        #[serde(flatten)]
        elastic: Elastic = scene.elastic.clone(),
        /// The adhesion and the wall.
        #[serde(flatten)]
        adhesion: Adhesion = scene.adhesion.clone(),
        /// The method.
        method: Method = scene.method,
        /// The precision.
        precision: Precision = scene.precision,
        /// The tolerance to which the solve was held.
        tolerance: f64 = scene.tolerance(),
        /// The iterations after which to give up.
        max_iterations: usize = scene.settings().max_iterations,
        /// The number of threads.
        threads: usize = threads,
        /// The version of the program.
        version: &'static str = env!("CARGO_PKG_VERSION"),
    }
}

impl Scene {
    /// The inputs of a report as far as they are those of the scene, on a surface of a shape and side lengths.
    pub fn inputs(&self, shape: (usize, usize), lengths: (f64, f64), threads: usize) -> Inputs {
        Inputs::of(self, shape, lengths, threads)
    }
}

impl Inputs {
    /// The units of the numbers, as far as they are known.
    pub fn units(&self) -> Units {
        Units { length: self.length_unit.clone(), pressure: self.pressure_unit.clone(), force: None }
    }
}
