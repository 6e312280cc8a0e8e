//! The end of a solve.

use ndarray::Array2;

use super::passes::Fields;
use super::posed::Posed;
use super::report::{Plastic, Report, Solution, Solved, Status};
use super::state::State;
use crate::adhesion::{AdhesionLaw, mu_rho, noticeable};
use crate::elastic::Boundary;
use crate::error::Result;
use crate::field::{Field, Minimum, Sums, found, read, write};
use crate::grid::Grid;
use crate::par::Parts;
use crate::problem::{Load, PressedFlat, Window};
use crate::real::Real;
use crate::vector::sums;

/// The share of the largest traction above which one at the edge of the window matters.
const EDGE: f64 = 1e-3;

/// The share of a noticeable traction below which bodies that are apart hardly attract each other.
const LAST: f64 = 1e-4;

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

impl<T: Real, Lo: Real> State<'_, T, Lo> {
    pub(super) fn finish(mut self, status: Status) -> Result<Solved<T>> {
        self.certify_as_returned()?;
        let mean = self.external_pressure();
        let (contact_pressure, carried) = self.carry(mean);
        let net = carried.contact / self.posed.nodes() - self.mean_traction();
        let load_error = match self.posed.load {
            _ if self.sums.detached.is_some() => 1.0,
            Load::Gap(_) => self.load_error(),
            _ => self.load_error().max(self.share_of_load(net - mean)),
        };
        let yielded = self.yielded();
        if let Some((.., pulled)) = yielded {
            self.sums.tally.adhesive += pulled;
        }
        let (plastic_depth, plastic) = yielded.map(|(depth, figures, _)| (depth, figures)).unzip();
        let report = self.report(status, [mean, net, load_error], &carried, plastic);
        let (on_grid, flat, at_floor) = (self.posed.formula(), self.posed.flat, self.is_at_floor());
        let (touched, not_parted, touches) = (self.touched(), self.not_parted(), self.counters.touches);
        let (grid, yields, law) = (*self.posed.operators.state().grid(), plastic.is_some(), self.posed.given.clone());
        if flat.window.is_some() && report.status == Status::Converged {
            // the nodes that face no surface have their part of the residual: in balance the others bear the load
            let share = T::lit((mean * self.posed.nodes() - carried.pressure) / self.posed.facing());
            self.fields.pressure.nodes_mut().iter_mut().for_each(|p| *p += share);
        }
        let [gap, pressure] = [self.fields.gap, self.fields.pressure].map(Field::into_array);
        let touched =
            touched.map(|near| flat.window.as_ref().map_or(near.clone(), |window| window.release(near)).into_array());
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
        if flat.boundary != Boundary::Periodic {
            solution.watch_edge(on_grid, flat);
        }
        Ok(Solved { solution, whole: gap.map(|gap| (grid, gap)), not_parted, touches, at_floor })
    }

    /// The certificate and the work of the fields as they are.
    fn certify_as_returned(&mut self) -> Result<()> {
        if self.steps.age > 0 {
            self.refresh()?;
            self.sums.certificate = f64::INFINITY;
        }
        if self.sums.certificate.is_infinite() {
            self.residual();
            self.certify()?;
        }
        self.trust_work(T::epsilon().widen().sqrt())
    }

    /// Gives the elastic pressure its mean, and takes the contact pressure λ out of it. Returns Σ λ, Σ g and the sum of
    /// the pressure over the nodes that face the surface, and the least gap.
    fn carry(&mut self, mean: f64) -> (Array2<T>, Borne) {
        let shift = T::lit(mean - self.sums.drift);
        let Self { fields, posed, .. } = self;
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
    fn report(
        &self,
        status: Status,
        [mean, net, load_error]: [f64; 3],
        carried: &Borne,
        plastic: Option<Plastic>,
    ) -> Report {
        let Posed { flat, settings, .. } = self.posed;
        let (law, operator) = (self.posed.law(), self.posed.operators.state());
        let (hints, modulus, padding) = (law.hints(), operator.modulus(), flat.padding);
        let (nodes, facing) = (self.posed.nodes(), self.posed.facing());
        let nominal = flat.window.as_ref().map_or(nodes, |window| window.grid().nodes() as f64);
        let mu_rho = mu_rho(law, operator.grid(), modulus);
        let given = self.sums.detached.unwrap_or(mean);
        // the mean of the displacement is no wave; its pressure is that at which the energy is least
        let of_mean = 0.5 * flat.boundary.mean_compliance() * mean.powi(2);
        // the gap to the yielded surface, compared with the gap to the surface before the solve
        let facing_mean = if flat.window.is_some() { carried.gap / facing } else { self.mean_gap() };
        let deeper = plastic.map_or(0.0, |plastic| plastic.depth_mean - flat.mean_depth() * nodes / facing);
        Report {
            status: self.final_status(status, load_error),
            branch: self.posed.branch,
            relative_error: self.relative_error(),
            error_scale: padding * self.error_scale().energy,
            load_error,
            complementarity: self.scaled_complementarity(),
            iterations: self.counters.iterations,
            operator_applications: self.counters.applications,
            boundary: flat.boundary,
            modulus,
            control: self.posed.control,
            wall: self.posed.constraint.wall().name(),
            law: hints.known_as().into(),
            work_of_adhesion: hints.work_of_adhesion.widen(),
            mean_gap: facing_mean + deeper,
            mean_pressure: given * padding,
            normal_force: given * padding * flat.area,
            approach: flat.approach(self.mean_gap(), mean),
            net_pressure: net * padding,
            mean_contact_pressure: carried.contact / nodes * padding,
            contact_fraction: self.sums.tally.contact / facing,
            contact_nodes: self.sums.tally.contact as usize,
            absent_nodes: (nominal - facing) as usize,
            edge_traction: None,
            reaches_edge: false,
            min_gap: if plastic.is_some() { carried.least_gap.0.max(0.0) } else { carried.least_gap.0 },
            elastic_energy: padding * (0.5 * self.mean_work() + of_mean),
            adhesive_energy: padding * self.sums.tally.adhesive / nodes,
            range: hints.of_grid.then(|| hints.range.widen()),
            peak_traction: hints.of_grid.then(|| law.traction(T::zero()).widen()),
            adhesive_contact_fraction: self.adhesive_contact_fraction(carried.adhered / facing, plastic),
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
    fn adhesive_contact_fraction(&self, share: f64, plastic: Option<Plastic>) -> Option<f64> {
        let hints = self.posed.law().hints();
        // below a wall that gives the energy continues
        let hard = self.posed.projects() && plastic.is_none_or(|plastic| plastic.fraction == 0.0);
        (hints.of_grid && !hints.zero && hard).then_some(share)
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
        let [at_edge, largest] = tractions.map(|own| grid.each(own).into_iter().fold(0.0, f64::max));
        let share = if at_edge == 0.0 { 0.0 } else { at_edge / largest };
        // bodies that are apart say nothing here: only the last of their attraction, or rounding, reaches the edge
        let attract = !law.hints().zero && largest > LAST * noticeable(law);
        let apart = report.status == Status::Detached || report.contact_nodes == 0 && !attract;
        // what the tolerance leaves of the pressures
        let noise = report.tolerance * flat.stiffness * flat.rms_height;
        let touches = grid.each(edge(&self.gap, &grid).any(|gap| gap <= T::zero())).contains(&true);
        (report.edge_traction, report.reaches_edge) =
            (Some(share), !apart && (share > EDGE && at_edge > noise || touches));
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
