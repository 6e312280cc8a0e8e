//! The end of a solve.

use ndarray::Array2;

use super::minimisation::Left;
use super::passes::Fields;
use super::plastic::to_the_yielded;
use super::report::{Plastic, Report, Solution, Solved, Status};
use super::state::State;
use crate::adhesion::{mu_rho, noticeable};
use crate::elastic::Boundary;
use crate::error::Result;
use crate::field::{Partial, read, write};
use crate::grid::Grid;
use crate::par::Parts;
use crate::problem::Load;
use crate::real::Real;
use crate::vector::sums;

/// The share of the largest traction above which one at the edge of the window matters.
const EDGE: f64 = 1e-3;

impl<T: Real, Lo: Real> State<'_, T, Lo> {
    pub(super) fn finish(mut self, status: Status) -> Result<Solved<T>> {
        if self.steps.age > 0 {
            self.refresh(Left::Nothing)?;
            self.sums.certificate = f64::INFINITY;
        }
        if self.sums.certificate.is_infinite() {
            self.residual(Left::Nothing);
            self.certify()?;
        }
        self.trust_work(T::epsilon().widen().sqrt())?;
        let mean = if self.posed.is_gap_controlled() { -self.multiplier() } else { self.sums.given };
        let shift = T::lit(mean - self.sums.drift);
        let (law, flat) = (self.posed.law, self.posed.flat);
        let Self { fields, posed, .. } = &mut self;
        let Fields { reducer, gap, pressure, residual, preconditioned, change, .. } = fields;
        for correction in [residual, preconditioned, change] {
            *correction = Array2::zeros((0, 0));
        }
        let mut contact_pressure = Array2::zeros(gap.dim());
        let local = posed.potential();
        let fields = read(gap).zip(write(pressure)).zip(write(&mut contact_pressure));
        let total = local.run(reducer, fields, |local, first, ((gap, pressure), contact)| {
            pressure.iter_mut().for_each(|p| *p += shift);
            local.contact_pressures(first, gap, pressure, contact);
            if !local.is_surface() {
                return Partial::NONE;
            }
            sums!(3, [gap, contact, pressure], [], least low, |i| {
                low[i] = gap[i].widen();
                [contact[i].widen(), gap[i].widen(), pressure[i].widen()]
            })
        });
        let mean_contact_pressure = total.sum[0] / self.posed.nodes();
        let net_pressure = mean_contact_pressure - self.sums.tally.traction / self.posed.nodes();
        let load_error = match self.posed.load {
            _ if self.sums.detached.is_some() => 1.0,
            Load::Gap(_) => self.load_error(),
            _ => self.load_error().max(self.share_of_load(net_pressure - mean)),
        };
        let plastic = self.plastic();
        let modulus = self.posed.operators.state().modulus();
        let mu_rho = mu_rho(law, self.posed.operators.state().grid(), modulus);
        let facing = flat.window.as_ref().map_or(self.posed.nodes(), |window| window.facing() as f64);
        let (given, padding) = (self.sums.detached.unwrap_or(mean), flat.padding);
        // the mean of the displacement is no wave
        let of_mean = 0.5 * flat.boundary.mean_compliance() * net_pressure.powi(2);
        let nominal = flat.window.as_ref().map_or(self.posed.nodes(), |window| window.grid().nodes() as f64);
        // to the surface as it is now, beside that as it was before the solve
        let facing_mean = if flat.window.is_some() { total.sum[1] / facing } else { self.mean_gap() };
        let deeper = plastic
            .as_ref()
            .map_or(0.0, |(_, plastic)| plastic.depth_mean - flat.mean_depth() * self.posed.nodes() / facing);
        let mut report = Report {
            status: self.final_status(status, load_error),
            branch: self.posed.branch,
            relative_error: self.relative_error(),
            error_scale: padding * self.error_scale().0,
            load_error,
            complementarity: self.scaled_complementarity(),
            iterations: self.counters.iterations,
            operator_applications: self.counters.applications,
            boundary: flat.boundary,
            modulus,
            control: self.posed.asked.0,
            wall: self.posed.asked.1,
            law: law.hints().known_as().into(),
            work_of_adhesion: law.hints().work_of_adhesion.widen(),
            mean_gap: facing_mean + deeper,
            mean_pressure: given * padding,
            normal_force: given * padding * flat.area,
            approach: flat.approach(self.mean_gap(), mean),
            net_pressure: net_pressure * padding,
            mean_contact_pressure: mean_contact_pressure * padding,
            contact_fraction: self.sums.tally.contact / facing,
            contact_nodes: self.sums.tally.contact as usize,
            absent_nodes: (nominal - facing) as usize,
            edge_traction: None,
            reaches_edge: false,
            min_gap: if plastic.is_some() { total.min.max(0.0) } else { total.min },
            elastic_energy: padding * (0.5 * self.mean_work() + of_mean),
            adhesive_energy: padding * self.sums.tally.adhesive / self.posed.nodes(),
            range: law.hints().of_grid.then(|| law.hints().range.widen()),
            peak_traction: law.hints().of_grid.then(|| law.traction(T::zero()).widen()),
            adhesive_contact_fraction: self.adhesive_contact_fraction(facing, plastic.as_ref().map(|(_, found)| found)),
            mu_rho,
            under_resolved: mu_rho > Report::RESOLVED_MU_RHO,
            precision: T::NAME,
            method: self.posed.settings.method,
            criterion: self.posed.settings.criterion,
            tolerance: self.posed.settings.tolerance_in::<T>(),
            plastic: plastic.as_ref().map(|(_, figures)| *figures),
        };
        let (grid, at_floor) = (*self.posed.operators.state().grid(), self.is_at_floor());
        let missing = mean * self.posed.nodes() - total.sum[2];
        let Fields { mut gap, mut pressure, .. } = self.fields;
        let plastic_depth = plastic.map(|(depth, _)| depth);
        let Some(window) = &flat.window else {
            let whole = plastic_depth.is_some().then(|| (grid, gap.clone()));
            if whole.is_some() {
                to_the_yielded(&mut gap);
            }
            let solution = Solution { gap, pressure, contact_pressure, plastic_depth, grid, report };
            return Ok(Solved { solution, whole, at_floor });
        };
        let (whole, grid) = ((grid, gap), *window.grid());
        let mut gap = window.crop(&whole.1, T::infinity());
        if plastic_depth.is_some() {
            to_the_yielded(&mut gap);
        }
        let plastic_depth = plastic_depth.map(|depth| window.crop(&depth, T::zero()));
        // the nodes that face no surface have their part of the residual: in balance the others bear the load
        if report.status == Status::Converged {
            let share = T::lit(missing / facing);
            pressure.mapv_inplace(|p| p + share);
        }
        let pressure = window.crop(&pressure, T::zero());
        let contact_pressure = window.crop(&contact_pressure, T::zero());
        if flat.boundary != Boundary::Periodic {
            let [at_edge, largest] = [largest(edge(&pressure, &grid)), largest(pressure.iter().copied())]
                .map(|own| grid.each(own).into_iter().fold(0.0, f64::max));
            let share = if at_edge == 0.0 { 0.0 } else { at_edge / largest };
            report.edge_traction = Some(share);
            // bodies that are apart say nothing here: only the last of their attraction, or rounding, reaches the edge
            let attract = !law.hints().zero && largest > noticeable(law);
            let apart = report.status == Status::Detached || report.contact_nodes == 0 && !attract;
            let touches = grid.each(edge(&gap, &grid).any(|gap| gap <= T::zero())).contains(&true);
            report.reaches_edge = !apart && (share > EDGE || touches);
        }
        Ok(Solved {
            solution: Solution { gap, pressure, contact_pressure, plastic_depth, grid, report },
            whole: Some(whole),
            at_floor,
        })
    }

    /// The share of contact that the adhesive energy tells, of a law whose range is that of the grid.
    fn adhesive_contact_fraction(&self, facing: f64, plastic: Option<&Plastic>) -> Option<f64> {
        let hints = self.posed.law.hints();
        // below a wall that gives the energy goes on
        let hard = self.posed.projects() && plastic.is_none_or(|plastic| plastic.fraction == 0.0);
        let tells = hints.of_grid && !hints.zero && hints.shape.is_none() && hard;
        tells.then(|| (0.0 - self.sums.tally.adhesive) / hints.work_of_adhesion.widen() / facing)
    }

    fn final_status(&self, status: Status, load_error: f64) -> Status {
        let good = self.meets(load_error);
        match status {
            Status::Stopped => status,
            _ if self.sums.detached.is_some() => Status::Detached,
            Status::Converged if !good => Status::Stalled,
            // the last pressure may have met the tolerance; rounds of a constraint end by its own word
            Status::Stalled if good && self.posed.projects() => Status::Converged,
            _ => status,
        }
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
