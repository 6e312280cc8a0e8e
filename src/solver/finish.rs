//! The end of a solve.

use ndarray::Array2;

use super::descent::Descent;
use super::driver::Aim;
use super::iterate::Iterate;
use super::passes::Fields;
use super::plastic::yielded;
use super::posed::Posed;
use super::report::{Plastic, Report, Solution, Solved, Status};
use crate::adhesion::{AdhesionLaw, mu_rho, noticeable};
use crate::degrees::HARDLY;
use crate::error::Result;
use crate::field::{Field, Minimum, Sums, found, read, write};
use crate::grid::Grid;
use crate::par::Parts;
use crate::problem::{Load, PressedFlat, Window};
use crate::real::Real;
use crate::vector::sums;

found! {
    /// The sums over the fields of a solution.
    struct Borne {
        contact: f64,
        gap: f64,
        pressure: f64,
        adhered: f64,
        least_gap: Minimum,
    }
}

pub(super) fn finish<T: Real, Lo: Real>(mut descent: Descent<'_, T, Lo>, status: Status) -> Result<Solved<T>> {
    let has_come_apart = descent.iterate.posed.detached.is_some();
    if descent.iterate.posed.aim == Aim::Solution || !has_come_apart && status != Status::Converged {
        descent.certify_as_returned()?;
    }
    let iterate = &mut descent.iterate;
    let (mean, nodes) = (iterate.external_pressure(), iterate.posed.nodes());
    let (contact_pressure, carried) = carry(iterate);
    let (net, proof) = (carried.contact / nodes - iterate.mean_traction(), descent.proof());
    let load_error = match descent.iterate.posed.load {
        _ if descent.iterate.posed.detached.is_some() => 1.0,
        Load::Gap(_) => proof.load_error(),
        _ => proof.load_error().max(proof.share_of_load(net - mean)),
    };
    let yielded = yielded(&mut descent.iterate);
    if let Some((.., pulled)) = yielded {
        descent.iterate.add_adhesive(pulled);
    }
    let (plastic_depth, plastic) = yielded.map(|(depth, figures, _)| (depth, figures)).unzip();
    let report = report(&descent, status, [mean, net, load_error], &carried, plastic);
    let at_floor = descent.proof().is_at_floor();
    let Iterate { posed, mut fields, .. } = descent.iterate;
    let (on_grid, flat, touches) = (posed.formula(), posed.flat, posed.touches);
    let (touched, not_parted) = (posed.near(), posed.not_parted(&fields.gap));
    let (grid, yields, law) = (*posed.operators.state().grid(), plastic.is_some(), posed.given.clone());
    if !flat.faces_all() && report.status == Status::Converged {
        // the nodes that face no surface have their part of the residual: in balance the others bear the load
        let share = T::lit((mean * nodes - carried.pressure) / posed.facing());
        fields.pressure.nodes_mut().iter_mut().for_each(|p| *p += share);
    }
    let [gap, pressure] = [fields.gap, fields.pressure].map(Field::into_array);
    let touched = touched.map(|near| flat.release(near).into_array());
    let solution = Solution { gap, pressure, contact_pressure, plastic_depth, touched, grid, report, law };
    let (mut solution, gap) = match &flat.window {
        None => (solution, None),
        Some(window) => solution.through(window),
    };
    let gap = gap.or_else(|| yields.then(|| solution.gap.clone()));
    if yields {
        // the gap to the yielded surface
        solution.gap.mapv_inplace(|gap| gap.max(T::zero()));
    }
    if !flat.boundary.is_periodic() {
        solution.watch_edge(on_grid, flat);
    }
    Ok(Solved { solution, whole: gap.map(|gap| (grid, gap)), not_parted, touches, at_floor })
}

/// Gives the elastic pressure its mean, and takes the contact pressure λ out of it. Returns Σ λ, Σ g and the sum of
/// the pressure over the nodes that face the surface, and the least gap.
fn carry<T: Real, Lo: Real>(iterate: &mut Iterate<'_, T, Lo>) -> (Array2<T>, Borne) {
    let shift = iterate.shift();
    let Iterate { fields, posed, .. } = iterate;
    let Fields { reducer, gap, pressure, residual, preconditioned, change, .. } = fields;
    for correction in [residual, preconditioned, change] {
        *correction = Field::default();
    }
    let mut contact_pressure = Field::zeros(gap.dim());
    let local = posed.potential();
    let fields = read(gap).zip(write(pressure)).zip(write(&mut contact_pressure));
    let carried = local.run(reducer, fields, |local, first, ((gap, pressure), contact)| {
        pressure.iter_mut().for_each(|p| *p += shift);
        local.contact_pressures(first, gap, pressure, contact);
        if !local.is_surface() {
            return Borne::NONE;
        }
        let shares = local.shares(first, gap);
        sums!([gap, contact, pressure, shares], [], |i| {} => Borne {
            contact: contact[i].widen(), gap: gap[i].widen(), pressure: pressure[i].widen(),
            adhered: shares[i].widen();
            least least_gap: gap[i].widen()
        })
    });
    (contact_pressure.into_array(), carried)
}

/// The report, of a mean pressure, the net pressure ⟨λ⟩ − ⟨φ'⟩, and the error of the load.
fn report<T: Real, Lo: Real>(
    descent: &Descent<'_, T, Lo>,
    status: Status,
    [mean, net, load_error]: [f64; 3],
    carried: &Borne,
    plastic: Option<Plastic>,
) -> Report {
    let (proof, iterate) = (descent.proof(), &descent.iterate);
    let (posed, Posed { flat, settings, .. }) = (&iterate.posed, &iterate.posed);
    let (law, operator) = (posed.law(), posed.operators.state());
    let (hints, modulus, padding) = (law.hints(), operator.modulus(), flat.padding);
    let (nodes, facing) = (posed.nodes(), posed.facing());
    let mu_rho = mu_rho(law, operator.grid(), modulus);
    let given = posed.detached.unwrap_or(mean);
    // the mean of the displacement is no wave; its pressure is that at which the energy is least
    let of_mean = 0.5 * flat.boundary.mean_compliance() * mean.powi(2);
    // the gap to the yielded surface, compared with the gap to the surface before the solve
    let facing_mean = if flat.faces_all() { iterate.mean_gap() } else { carried.gap / facing };
    let deeper = plastic.map_or(0.0, |plastic| plastic.depth_mean - flat.mean_depth() * nodes / facing);
    Report {
        status: final_status(descent, status, load_error),
        branch: posed.branch,
        relative_error: proof.relative_error(),
        error_scale: padding * proof.error_scale().energy,
        load_error,
        complementarity: proof.scaled_complementarity(),
        iterations: descent.iterations(),
        operator_applications: iterate.applications(),
        boundary: flat.boundary,
        modulus,
        control: posed.control,
        wall: posed.constraint.wall().name(),
        law: hints.known_as().into(),
        work_of_adhesion: hints.work_of_adhesion.widen(),
        mean_gap: facing_mean + deeper,
        mean_pressure: given * padding,
        normal_force: given * padding * flat.area,
        approach: flat.approach(iterate.mean_gap(), mean),
        net_pressure: net * padding,
        mean_contact_pressure: carried.contact / nodes * padding,
        contact_fraction: iterate.tally().contact / facing,
        contact_nodes: iterate.tally().contact as usize,
        absent_nodes: flat.grid(operator.grid()).nodes() - facing as usize,
        edge_traction: None,
        reaches_edge: false,
        min_gap: if plastic.is_some() { carried.least_gap.0.max(0.0) } else { carried.least_gap.0 },
        elastic_energy: padding * (0.5 * iterate.mean_work() + of_mean),
        adhesive_energy: padding * iterate.tally().adhesive / nodes,
        range: hints.of_grid.then(|| hints.range.widen()),
        peak_traction: hints.of_grid.then(|| law.traction(T::zero()).widen()),
        adhesive_contact_fraction: adhesive_contact_fraction(posed, carried.adhered / facing, plastic),
        mu_rho,
        under_resolved: mu_rho > Report::RESOLVED_MU_RHO,
        precision: T::NAME,
        method: settings.method,
        criterion: settings.criterion,
        tolerance: settings.tolerance_in::<T>(),
        plastic,
    }
}

/// The share of contact by adhesive energy, for a law with a range set by the grid.
fn adhesive_contact_fraction<T: Real, Lo: Real>(
    posed: &Posed<'_, T, Lo>,
    share: f64,
    plastic: Option<Plastic>,
) -> Option<f64> {
    let hints = posed.law().hints();
    // below a wall that gives the energy continues
    let hard = posed.projects() && plastic.is_none_or(|plastic| plastic.fraction == 0.0);
    (hints.takes_range_of_grid() && hard).then_some(share)
}

fn final_status<T: Real, Lo: Real>(descent: &Descent<'_, T, Lo>, status: Status, load_error: f64) -> Status {
    let (good, posed) = (descent.proof().meets(load_error), &descent.iterate.posed);
    match status {
        Status::Stopped => status,
        _ if posed.detached.is_some() => Status::Detached,
        Status::Converged if !good => Status::Stalled,
        // the last pressure may have met the tolerance; rounds of a constraint end by its own word
        Status::Stalled if good && posed.projects() => Status::Converged,
        _ => status,
    }
}

impl<T: Real> Solution<T> {
    /// The part in a window, and the gap of all nodes.
    fn through(self, window: &Window) -> (Self, Option<Array2<T>>) {
        let part = |field: &Array2<T>| window.crop(field, T::zero());
        let [pressure, contact_pressure] = [&self.pressure, &self.contact_pressure].map(part);
        let (gap, plastic_depth) = (window.crop(&self.gap, T::infinity()), self.plastic_depth.as_ref().map(part));
        (Self { gap, pressure, contact_pressure, plastic_depth, grid: *window.grid(), ..self }, Some(self.gap))
    }

    /// Notes the traction at the edge of the window, and whether the contact reaches it.
    fn watch_edge(&mut self, law: &dyn AdhesionLaw<T>, flat: &PressedFlat<T>) {
        let (grid, report) = (self.grid, &mut self.report);
        let tractions = [largest(edge(&self.pressure, &grid)), largest(self.pressure.iter().copied())];
        let [at_edge, largest] = tractions.map(|own| grid.greatest(own));
        let share = if at_edge == 0.0 { 0.0 } else { at_edge / largest };
        // bodies that are apart say nothing here: only the last of their attraction, or rounding, reaches the edge
        let attract = !law.hints().zero && largest > HARDLY * noticeable(law);
        let apart = report.status == Status::Detached || report.contact_nodes == 0 && !attract;
        // what the tolerance leaves of the pressures
        let noise = report.tolerance * flat.stiffness * flat.rms_height;
        let touches = grid.any(edge(&self.gap, &grid).any(|gap| gap <= T::zero()));
        (report.edge_traction, report.reaches_edge) =
            (Some(share), !apart && (share > HARDLY && at_edge > noise || touches));
    }
}

/// The outermost nodes of a field; corners come twice.
fn edge<T: Real>(field: &Array2<T>, grid: &Grid) -> impl Iterator<Item = T> {
    let (rows, columns) = (grid.rows(), field.ncols());
    let ends = [0, grid.shape().0 - 1].into_iter().filter(move |row| rows.contains(row));
    let first = grid.rows().start;
    let sides = ends.map(move |row| field.row(row - first));
    let sides = sides.chain([0, columns - 1].map(|column| field.column(column)));
    sides.flat_map(|side| side.to_vec())
}

fn largest<T: Real>(tractions: impl Iterator<Item = T>) -> f64 {
    tractions.fold(0.0, |largest, traction| largest.max(traction.widen().abs()))
}
