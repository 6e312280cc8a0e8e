//! The state of a solve: the problem that is posed, its fields, their sums, and the steps.

use super::Method;
use super::coarse::Coarse;
use super::minimisation::{Counters, Made, Next, Residual, Steps, Totals};
use super::passes::{self, Continued, Fields, Taken, Working};
use super::plan::StageLaw;
use super::posed::Posed;
use super::report::Iteration;
use super::start::{Begin, given_start, uniform_start};
use super::work::{TRUSTED, Work};
use crate::elastic::Boundary;
use crate::error::Result;
use crate::field::{Field, read, write};
use crate::par::Parts;
use crate::problem::Load;
use crate::real::Real;

/// Iterations after which the pressure, updated step by step, is computed anew.
const REFRESH: usize = 50;

/// The relative error of the mean gap, in units of the rounding of one number, that is worth a pass.
pub(super) const SCALED: f64 = 64.0;

pub(super) struct State<'a, T: Real, Lo> {
    pub(super) posed: Posed<'a, T, Lo>,
    pub(super) fields: Fields<T, Lo>,
    pub(super) sums: Totals,
    pub(super) steps: Steps,
    pub(super) counters: Counters,
}

impl<'a, T: Real, Lo: Real> State<'a, T, Lo> {
    pub(super) fn new(mut posed: Posed<'a, T, Lo>, mut begin: Begin<'_, T>, touches: bool) -> Result<Self> {
        posed.prepare()?;
        let (last, not_parted) = begin.last();
        let Posed { flat, load, .. } = posed;
        let grid = posed.operators.state().grid();
        let (grid, shape) = (*grid, grid.field_shape());
        let (uniform, nearness) = (begin.is_default(), begin.nearness());
        let given = given_start(begin, &grid, flat.window.as_ref(), load, posed.wall())?;
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
        let coarse = Coarse::of(posed.operators.corrections());
        let mut state = Self {
            posed,
            fields: Fields::new(&grid, gap, pressure),
            sums: Totals { certificate: f64::INFINITY, ..Totals::default() },
            steps: Steps { coarse, step_length: 1.0, ..Steps::default() },
            counters: Counters::default(),
        };
        if uniform
            && state.posed.law().hints().zero
            && (state.posed.flat.boundary != Boundary::Periodic || state.posed.is_hardly_pressed())
        {
            state.start_undeformed()?;
        } else if uniform {
            state.sums.work = state.count();
        } else {
            state.take_pressure()?;
        }
        state.check_start()?;
        state.begins(nearness);
        Ok(state)
    }

    /// The gap of undeformed bodies that touch.
    pub(super) fn start_undeformed(&mut self) -> Result<()> {
        let Fields { gap, residual, preconditioned, change, .. } = &mut self.fields;
        self.posed.operators.displacement(&self.posed.flat.pressure, gap, [residual, preconditioned, change])?;
        self.counters.applications += 1;
        let peak = T::lit(self.posed.flat.peak + self.posed.closest().widen());
        let local = self.posed.potential();
        let Fields { reducer, gap, pressure, .. } = &mut self.fields;
        local.run(reducer, write(gap).zip(write(pressure)), |local, _, (gap, pressure)| {
            for (gap, pressure) in gap.iter_mut().zip(pressure) {
                let apart = peak - *gap;
                (*gap, *pressure) = (if local.projects() { apart.max(T::zero()) } else { apart }, T::zero());
            }
        });
        // nothing is deformed: the sums that would cancel need not be trusted
        self.count();
        self.sums.work = Work::default();
        Ok(())
    }

    /// The mean gap, over all nodes of the operator's grid.
    pub(super) fn mean_gap(&self) -> f64 {
        self.sums.tally.sum_gap / self.posed.nodes()
    }

    /// The mean traction of the law.
    pub(super) fn mean_traction(&self) -> f64 {
        self.sums.tally.traction / self.posed.nodes()
    }

    /// The constant b in r = p + φ'(g) + b: the given mean pressure, zero under gap control, less the mean of p.
    pub(super) fn offset(&self) -> f64 {
        self.sums.given - self.sums.drift
    }

    /// Computes p = K⁻¹g + K⁻¹h and its tally anew, and forgets the last step.
    pub(super) fn refresh(&mut self) -> Result<()> {
        self.steps.momentum = None;
        self.renew_pressure()
    }

    /// Computes p = K⁻¹g + K⁻¹h and its tally anew.
    fn renew_pressure(&mut self) -> Result<()> {
        if let Load::Gap(mean) = self.posed.load {
            self.restore_mean(mean);
        }
        let Fields { gap, pressure, residual, preconditioned, change, .. } = &mut self.fields;
        match self.steps.momentum {
            Some(_) => self.posed.operators.pressure(gap, pressure, &mut [residual])?,
            None => self.posed.operators.pressure(gap, pressure, &mut [preconditioned, change])?,
        }
        self.take_pressure()
    }

    /// Removes from the gap the rounding that its mean has gathered, if that is worth a pass.
    fn restore_mean(&mut self, mean: f64) {
        let (nodes, sum, projects) = (self.posed.nodes(), self.sums.tally.sum_gap, self.posed.projects());
        let (scale, present) = (mean * nodes / sum, sum / nodes);
        if projects && !self.has_yielded() {
            if scale.is_finite() && (scale - 1.0).abs() > SCALED * T::epsilon().widen() {
                let scale = T::lit(scale);
                self.each_gap(|gap| scale * gap);
            }
        } else if self.sums.tally.free > 0.0 && present != mean {
            // gaps of both signs may have hardly any mean; where some yield, nodes that touch stay
            let apart = if projects { nodes - self.sums.tally.contact } else { nodes };
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

    /// Takes K⁻¹g as the pressure of the state.
    fn take_pressure(&mut self) -> Result<()> {
        self.counters.applications += 1;
        (self.steps.age, self.steps.updates) = (0, 0.0);
        let Fields { reducer, pressure, .. } = &mut self.fields;
        reducer.run(write(pressure).zip(read(&self.posed.flat.pressure)), |_, (p, surface)| {
            p.iter_mut().zip(surface).for_each(|(p, &surface)| *p += surface);
        });
        self.sums.work = self.count();
        self.trust_work(TRUSTED)
    }

    /// Takes the tally; returns the elastic work ⟨u, p⟩ by its sums.
    pub(super) fn count(&mut self) -> Work {
        let offset = T::lit(self.offset());
        let local = self.posed.potential();
        let taken = passes::tally(&mut self.fields, &local, offset, &self.posed.flat.pressure);
        let Taken { mut tally, gap_surface, sum_p } = taken;
        self.sums.drift = sum_p / self.posed.nodes();
        self.sums.given = self.posed.load.pressure_at(tally.sum_gap / self.posed.nodes());
        tally.shift(T::lit(self.offset()).widen() - offset.widen());
        self.sums.tally = tally;
        self.summed_work(tally.sum_gp, gap_surface)
    }

    /// The mean pressure p̄, given or of a given mean gap.
    pub(super) fn external_pressure(&self) -> f64 {
        if self.posed.is_gap_controlled() { -self.multiplier() } else { self.sums.given }
    }

    /// μ: the mean of r where the surfaces are apart, under gap control.
    pub(super) fn multiplier(&self) -> f64 {
        match self.posed.load {
            Load::Pressure(_) | Load::Spring { .. } => 0.0,
            Load::Gap(_) if self.sums.tally.free > 0.0 => self.sums.tally.sum_r / self.sums.tally.free,
            // no node is free: the least pressure that keeps all in contact
            Load::Gap(_) => self.sums.tally.min_r.0,
        }
    }

    /// Computes r' on the working set, and forgets the last step.
    pub(super) fn residual(&mut self) {
        self.steps.momentum = None;
        self.compute_residual();
    }

    pub(super) fn compute_residual(&mut self) {
        let working = self.working_set(0.0);
        let found = passes::residual(&mut self.fields, &self.posed.potential(), working);
        self.sums.residual.difference = found.difference;
        self.go_on_with(found);
    }

    /// Takes r' from the gradient r less the level before, which differs little from the level of the state.
    fn take_level(&mut self) {
        let working = self.working_set(T::lit(self.sums.residual.level).widen());
        let found = passes::release(&mut self.fields, &self.posed.potential(), working);
        self.go_on_with(found);
    }

    /// The working set of the gradient less a level `before`, and the level of the state.
    fn working_set(&mut self, before: f64) -> Working<T> {
        let (offset, multiplier) = (T::lit(self.offset()), T::lit(self.multiplier()));
        let centred = self.posed.is_gap_controlled() && self.posed.settings.method == Method::Preconditioned;
        let yielded = self.has_yielded();
        let Self { fields, posed, sums, .. } = self;
        let (local, tally) = (posed.potential(), &sums.tally);
        let (mut level, mut yields) = (multiplier.widen(), local.is_capped());
        if centred && tally.contact > 0.0 && local.projects() {
            let released = passes::released(fields, &local, offset, multiplier);
            let working = tally.free + released.count;
            if working > 0.0 {
                level = (tally.sum_r + released.sum_r) / working;
            }
            yields = yields && (released.yielding > 0.0 || yielded);
        }
        (sums.residual.level, sums.residual.yields) = (level, yields);
        // where some yield, both sides of the corner have one level
        let release = if yields { T::lit(level) } else { multiplier };
        let [release, level] = [release.widen(), level].map(|value| T::lit(value - before));
        Working { offset, release, level }
    }

    /// Notes the sums of r', those with the last step for the next one to be conjugate to it.
    pub(super) fn go_on_with(&mut self, found: Continued) {
        let Continued { complementarity, working, descent, overlap, sum_change: sum, .. } = found;
        self.sums.residual = Residual { working, complementarity, ..self.sums.residual };
        self.steps.momentum = self.steps.momentum.map(|made| Made { descent, overlap, sum, ..made });
    }

    /// A step; `false` if none is possible.
    pub(super) fn step(&mut self) -> Result<bool> {
        let Some(next) = self.preconditioned_step()? else { return Ok(false) };
        self.counters.iterations += 1;
        let stale = self.is_stale();
        if stale {
            self.renew_pressure()?;
        }
        match next {
            _ if stale => self.compute_residual(),
            Next::Compute => self.compute_residual(),
            Next::Level => self.take_level(),
            Next::Go => {}
        }
        Ok(true)
    }

    /// Whether the pressure has to be computed anew from the gap.
    pub(super) fn is_stale(&self) -> bool {
        self.steps.age >= REFRESH || self.sums.work.is_doubtful(TRUSTED) || self.has_lost_its_pressure()
    }

    pub(super) fn iteration(&self) -> Iteration {
        Iteration {
            iteration: self.counters.iterations,
            operator_applications: self.counters.applications,
            relative_error: self.relative_error(),
            load_error: self.load_error(),
            energy: self.energy(),
            mean_gap: self.mean_gap(),
            contact_nodes: self.sums.tally.contact as usize,
            round: self.counters.rounds,
            smoothed: self.posed.stage.law == StageLaw::Smoothed,
            control: self.posed.control,
        }
    }
}
