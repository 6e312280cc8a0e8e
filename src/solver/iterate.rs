//! The iterate: the gap and its pressure, their sums, the residual, and the last step.

use super::Method;
use super::minimisation::{Made, Next, Residual, Step};
use super::passes::{self, Advance, Continued, Fields, FullTally, Tally, Working};
use super::posed::Posed;
use super::start::{Begin, check_start, given_start, uniform_start};
use super::work::Work;
use crate::degrees::HARDLY;
use crate::error::Result;
use crate::field::{Field, Minimum, read, write};
use crate::par::Parts;
use crate::problem::Load;
use crate::real::Real;

mod energy;
mod foundation;

/// Iterations after which the pressure, updated step by step, is computed anew.
const REFRESH: usize = 50;

/// The relative error of the mean gap, in units of the rounding of one number, that is worth a pass.
pub(super) const SCALED: f64 = 64.0;

pub(super) struct Iterate<'a, T: Real, Lo> {
    pub(super) posed: Posed<'a, T, Lo>,
    pub(super) fields: Fields<T, Lo>,
    tally: Tally,
    /// Σ u·p, twice the elastic energy
    work: Work,
    /// the mean of p, rounding only
    drift: f64,
    /// the given mean pressure p̄, zero under gap control
    given: f64,
    residual: Residual,
    /// the last step, if the next one may use it
    momentum: Option<Made>,
    /// steps since the pressure was last computed from the gap
    age: usize,
    /// the sum of ⟨c, c⟩/N over these steps, with c their change
    updates: f64,
    applications: usize,
}

impl<'a, T: Real, Lo: Real> Iterate<'a, T, Lo> {
    pub(super) fn new(mut posed: Posed<'a, T, Lo>, mut begin: Begin<'_, T>, touches: bool) -> Result<Self> {
        posed.prepare()?;
        let (last, not_parted) = begin.last();
        let Posed { flat, load, .. } = posed;
        let grid = posed.operators.state().grid();
        let (grid, shape) = (*grid, grid.field_shape());
        let uniform = begin.is_default();
        let given = given_start(begin, &grid, flat, load, posed.wall())?;
        let (gap, pressure) = match given {
            Some(gap) => {
                let mut pressure = Field::zeros(shape);
                posed.operators.pressure(&gap, &mut pressure, &mut [])?;
                (gap, pressure)
            }
            None => (Field::filled(shape, T::lit(uniform_start(posed.law(), flat, load))), flat.pressure.clone()),
        };
        if touches {
            posed.touch(last.unwrap_or(&gap), not_parted.as_deref());
        }
        let mut iterate = Self {
            posed,
            fields: Fields::new(&grid, gap, pressure),
            tally: Tally::default(),
            work: Work::default(),
            drift: 0.0,
            given: 0.0,
            residual: Residual::default(),
            momentum: None,
            age: 0,
            updates: 0.0,
            applications: 0,
        };
        if uniform
            && !iterate.posed.adheres()
            && (!iterate.posed.flat.boundary.is_periodic() || iterate.posed.is_hardly_pressed())
        {
            iterate.start_undeformed()?;
        } else if uniform {
            iterate.work = iterate.count();
        } else {
            iterate.take_pressure()?;
        }
        check_start(&iterate)?;
        Ok(iterate)
    }

    /// The gap of undeformed bodies that touch.
    pub(super) fn start_undeformed(&mut self) -> Result<()> {
        let Fields { gap, residual, preconditioned, change, .. } = &mut self.fields;
        self.posed.operators.displacement(&self.posed.flat.pressure, gap, [residual, preconditioned, change])?;
        self.applications += 1;
        let peak = T::lit(self.posed.flat.peak + self.posed.closest().widen());
        let local = self.posed.potential();
        let Fields { reducer, gap, pressure, .. } = &mut self.fields;
        local.run(reducer, write(gap).zip(write(pressure)), |local, _, (gap, pressure)| {
            for (gap, pressure) in gap.iter_mut().zip(pressure) {
                let apart = peak - *gap;
                (*gap, *pressure) = (apart.max(local.touching()), T::zero());
            }
        });
        // nothing is deformed: the sums that would cancel need not be trusted
        self.count();
        self.work = Work::default();
        Ok(())
    }

    /// The mean gap, over all nodes of the operator's grid.
    pub(super) fn mean_gap(&self) -> f64 {
        self.tally.sum_gap / self.posed.nodes()
    }

    /// The mean traction of the law.
    pub(super) fn mean_traction(&self) -> f64 {
        self.tally.traction / self.posed.nodes()
    }

    pub(super) fn tally(&self) -> &Tally {
        &self.tally
    }

    /// The given mean pressure p̄, zero under gap control.
    pub(super) fn given(&self) -> f64 {
        self.given
    }

    /// The sums of r'.
    pub(super) fn sums_of_residual(&self) -> Residual {
        self.residual
    }

    /// Steps since the pressure was last computed from the gap.
    pub(super) fn age(&self) -> usize {
        self.age
    }

    pub(super) fn applications(&self) -> usize {
        self.applications
    }

    /// Counts an application of the operator.
    pub(super) fn applied(&mut self) {
        self.applications += 1;
    }

    /// The last step, if the next one may use it, which then makes another one.
    pub(super) fn take_momentum(&mut self) -> Option<Made> {
        self.momentum.take()
    }

    /// The constant by which the elastic pressure lacks its mean.
    pub(super) fn shift(&self) -> T {
        T::lit(self.external_pressure() - self.drift)
    }

    /// Adds energy of adhesion below the gap of touching surfaces.
    pub(super) fn add_adhesive(&mut self, energy: f64) {
        self.tally.adhesive += energy;
    }

    /// The constant b in r = p + φ'(g) + b: the given mean pressure, zero under gap control, less the mean of p.
    pub(super) fn offset(&self) -> f64 {
        self.given - self.drift
    }

    /// Computes p = K⁻¹g + K⁻¹h and its tally anew, and forgets the last step.
    pub(super) fn refresh(&mut self) -> Result<()> {
        self.momentum = None;
        self.renew_pressure()
    }

    /// Computes p = K⁻¹g + K⁻¹h and its tally anew.
    fn renew_pressure(&mut self) -> Result<()> {
        if let Load::Gap(mean) = self.posed.load {
            self.restore_mean(mean);
        }
        let Fields { gap, pressure, residual, preconditioned, change, .. } = &mut self.fields;
        match self.momentum {
            Some(_) => self.posed.operators.pressure(gap, pressure, &mut [residual])?,
            None => self.posed.operators.pressure(gap, pressure, &mut [preconditioned, change])?,
        }
        self.take_pressure()
    }

    /// Removes from the gap the rounding that its mean has gathered, if that is worth a pass.
    fn restore_mean(&mut self, mean: f64) {
        let (nodes, sum, projects) = (self.posed.nodes(), self.tally.sum_gap, self.posed.projects());
        let (scale, present) = (mean * nodes / sum, sum / nodes);
        if projects && !self.has_yielded() {
            if scale.is_finite() && (scale - 1.0).abs() > SCALED * T::epsilon().widen() {
                let scale = T::lit(scale);
                self.each_gap(|gap| scale * gap);
            }
        } else if self.tally.free > 0.0 && present != mean {
            // gaps of both signs may have hardly any mean; where some yield, nodes that touch stay
            let apart = if projects { nodes - self.tally.contact } else { nodes };
            let shift = T::lit((mean - present) * nodes / apart);
            self.each_gap(|gap| match projects {
                true if gap > T::zero() => (gap + shift).max(T::zero()),
                true => gap,
                false => gap + shift,
            });
        }
    }

    /// Gives every node the gap that follows from its present one.
    pub(super) fn each_gap(&mut self, next: impl Fn(T) -> T + Sync + Send) {
        let Fields { reducer, gap, .. } = &mut self.fields;
        reducer.run(write(gap), |_, gap| {
            gap.iter_mut().for_each(|gap| *gap = next(*gap));
        });
    }

    /// Lets surfaces touch that a load brings together and hardly presses, as rounding may leave a gap between them.
    pub(super) fn close_up(&mut self) {
        let local = self.posed.potential();
        let Fields { reducer, gap, .. } = &mut self.fields;
        let least = local.run(reducer, read(gap), |local, _, gap| {
            let least = gap.iter().fold(T::infinity(), |least, &gap| least.min(gap));
            Minimum(if local.is_surface() { least.widen() } else { f64::INFINITY })
        });
        let least = T::lit(least.0);
        if least > T::zero() {
            self.each_gap(|gap| gap - least);
        }
    }

    /// Takes K⁻¹g as the pressure of the state.
    fn take_pressure(&mut self) -> Result<()> {
        self.applications += 1;
        (self.age, self.updates) = (0, 0.0);
        let Fields { reducer, pressure, .. } = &mut self.fields;
        reducer.run(write(pressure).zip(read(&self.posed.flat.pressure)), |_, (p, surface)| {
            p.iter_mut().zip(surface).for_each(|(p, &surface)| *p += surface);
        });
        self.work = self.count();
        self.trust_work(HARDLY)
    }

    /// Takes the tally; returns the elastic work ⟨u, p⟩ by its sums.
    pub(super) fn count(&mut self) -> Work {
        let offset = T::lit(self.offset());
        let local = self.posed.potential();
        let taken = passes::tally(&mut self.fields, &local, offset, &self.posed.flat.pressure);
        let FullTally { mut tally, gap_surface, sum_p } = taken;
        self.drift = sum_p / self.posed.nodes();
        self.given = self.posed.load.pressure_at(tally.sum_gap / self.posed.nodes());
        tally.shift(T::lit(self.offset()).widen() - offset.widen());
        self.tally = tally;
        self.summed_work(tally.sum_gp, gap_surface)
    }

    /// The mean pressure p̄, given or of a given mean gap.
    pub(super) fn external_pressure(&self) -> f64 {
        if self.posed.is_gap_controlled() { -self.multiplier() } else { self.given }
    }

    /// μ: the mean of r where the surfaces are apart, under gap control.
    pub(super) fn multiplier(&self) -> f64 {
        match self.posed.load {
            Load::Pressure(_) | Load::Spring { .. } => 0.0,
            Load::Gap(_) if self.tally.free > 0.0 => self.tally.sum_r / self.tally.free,
            // no node is free: the least pressure that keeps all in contact
            Load::Gap(_) => self.tally.min_r.0,
        }
    }

    /// Computes r' on the working set, and forgets the last step.
    pub(super) fn residual(&mut self) {
        self.momentum = None;
        self.compute_residual();
    }

    pub(super) fn compute_residual(&mut self) {
        let working = self.working_set(0.0);
        let found = passes::residual(&mut self.fields, &self.posed.potential(), working);
        self.residual.difference = found.difference;
        self.go_on_with(found);
    }

    /// Takes r' from the gradient r less the level before, which differs little from the level of the state.
    fn take_level(&mut self) {
        let working = self.working_set(T::lit(self.residual.level).widen());
        let found = passes::release(&mut self.fields, &self.posed.potential(), working);
        self.go_on_with(found);
    }

    /// The working set of the gradient less a level `before`, and the level of the state.
    fn working_set(&mut self, before: f64) -> Working<T> {
        let (offset, multiplier) = (T::lit(self.offset()), T::lit(self.multiplier()));
        let centred = self.posed.is_gap_controlled() && self.posed.settings.method == Method::Preconditioned;
        let yielded = self.has_yielded();
        let Self { fields, posed, tally, .. } = self;
        let local = posed.potential();
        let (mut level, mut yields) = (multiplier.widen(), local.is_capped());
        if centred && tally.contact > 0.0 && local.projects() {
            let released = passes::released(fields, &local, offset, multiplier);
            let working = tally.free + released.count;
            if working > 0.0 {
                level = (tally.sum_r + released.sum_r) / working;
            }
            yields = yields && (released.yielding > 0.0 || yielded);
        }
        (self.residual.level, self.residual.yields) = (level, yields);
        // where some yield, both sides of the corner have one level
        let release = if yields { T::lit(level) } else { multiplier };
        let [release, level] = [release.widen(), level].map(|value| T::lit(value - before));
        Working { offset, release, level }
    }

    /// Notes the sums of r', those with the last step for the next one to be conjugate to it.
    pub(super) fn go_on_with(&mut self, found: Continued) {
        let Continued { complementarity, working, descent, overlap, sum_change: sum, .. } = found;
        self.residual = Residual { working, complementarity, ..self.residual };
        self.momentum = self.momentum.map(|made| Made { descent, overlap, sum, ..made });
    }

    /// Takes a step, with the tally of the new state. Returns what is left to do for its residual.
    pub(super) fn advance(&mut self, step: Step) -> Next {
        let Step { length, scale, slope, square, change, work, elastic, spring } = step;
        self.given = self.posed.load.pressure_at((self.tally.sum_gap + length * change) / self.posed.nodes());
        let level = self.posed.is_gap_controlled().then_some(T::lit(self.residual.level));
        let advance = Advance { length: T::lit(length), scale: T::lit(scale), offset: T::lit(self.offset()), level };
        let Self { fields, posed, .. } = self;
        let local = posed.potential();
        let advanced = passes::advance(fields, &local, advance, &posed.flat.pressure);
        // `change` holds d after a scaled step, and c = d otherwise
        let curvature = if local.is_straight() {
            length * length * (elastic + spring)
        } else {
            length * (advanced.product - slope)
        };
        self.tally = advanced.tally;
        let change = length * (2.0 * work + length * elastic);
        self.work = self.work.after(change, self.update_noise() * change.abs());
        self.momentum = Some(Made { factor: length, curvature, descent: 0.0, overlap: 0.0, sum: 0.0 });
        self.updates += (length * scale).powi(2) * square / self.posed.nodes();
        self.age += 1;
        if level.is_some() {
            return Next::Level;
        }
        self.go_on_with(advanced.residual);
        Next::Go
    }

    /// Takes a step that has changed gap and pressure alike.
    pub(super) fn advance_both(&mut self) {
        self.age += 1;
        self.work = self.count();
    }

    /// The residual after a step, computed anew where the pressure has to be; of a certificate of the state before.
    pub(super) fn follow(&mut self, next: Next, certificate: f64) -> Result<()> {
        let stale = self.is_stale(certificate);
        if stale {
            self.renew_pressure()?;
        }
        match next {
            _ if stale => self.compute_residual(),
            Next::Compute => self.compute_residual(),
            Next::Level => self.take_level(),
            Next::Go => {}
        }
        Ok(())
    }

    /// Whether the pressure has to be computed anew from the gap.
    pub(super) fn is_stale(&self, certificate: f64) -> bool {
        self.age >= REFRESH || self.work.is_doubtful(HARDLY) || self.has_lost_its_pressure(certificate)
    }

    /// Whether some nodes yield in the present state.
    pub(super) fn has_yielded(&self) -> bool {
        let yields = self.posed.wall().hardness().is_some();
        // these are in contact, and free
        yields && self.tally.contact + self.tally.free > self.posed.nodes()
    }

    /// Takes in the neighbourhood of contacts, as [`Posed::take_in`].
    pub(super) fn take_in(&mut self, everywhere: bool) -> bool {
        self.posed.take_in(&self.fields.gap, everywhere)
    }
}
