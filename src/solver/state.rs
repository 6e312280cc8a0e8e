//! The state of a solve: the problem that is posed, its fields, their sums, and the steps.

use ndarray::Array2;

use super::Method;
use super::coarse::Coarse;
use super::minimisation::{Counters, Goal, Left, Made, Residual, Steps, Sums};
use super::passes::{self, Continued, Fields, Taken, Working};
use super::posed::Posed;
use super::report::Iteration;
use super::start::{Begin, given_start, uniform_start};
use super::work::{TRUSTED, Work};
use crate::elastic::Boundary;
use crate::error::Result;
use crate::field::{read, write};
use crate::par::Parts;
use crate::problem::Load;
use crate::real::Real;

/// Iterations after which the pressure, updated step by step, is computed anew.
const REFRESH: usize = 50;

/// The relative error of the mean gap, in units of the rounding of one number, that is worth a pass.
pub(super) const SCALED: f64 = 64.0;

pub(super) struct State<'a, T, Lo> {
    pub(super) posed: Posed<'a, T, Lo>,
    pub(super) fields: Fields<T, Lo>,
    pub(super) sums: Sums,
    pub(super) steps: Steps,
    pub(super) counters: Counters,
}

impl<'a, T: Real, Lo: Real> State<'a, T, Lo> {
    pub(super) fn new(mut posed: Posed<'a, T, Lo>, begin: Begin<'_, T>) -> Result<Self> {
        posed.prepare()?;
        let Posed { operators, law, flat, constraint, load, settings, .. } = &mut posed;
        let grid = operators.state().grid();
        let (grid, shape) = (*grid, grid.field_shape());
        let uniform = begin.is_default();
        let given = given_start(begin, &grid, flat.window.as_ref(), *load, constraint.wall())?;
        let (gap, pressure) = match given {
            Some(gap) => {
                let mut pressure = Array2::zeros(shape);
                operators.pressure(&gap, &mut pressure, &mut [])?;
                (gap, pressure)
            }
            None => (Array2::from_elem(shape, T::lit(uniform_start(*law, flat, *load))), flat.pressure.clone()),
        };
        let preconditioned = settings.method == Method::Preconditioned;
        let coarse = if preconditioned { Coarse::of(operators.corrections()) } else { None };
        let mut state = Self {
            posed,
            fields: Fields::new(&grid, gap, pressure),
            sums: Sums::default(),
            steps: Steps::new(coarse),
            counters: Counters::default(),
        };
        if uniform
            && state.posed.law.hints().zero
            && (state.posed.flat.boundary != Boundary::Periodic || state.posed.is_hardly_pressed())
        {
            state.start_undeformed()?;
        } else if uniform {
            state.sums.work = state.count();
        } else {
            state.take_pressure(None)?;
        }
        state.check_start()?;
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

    /// The constant b in r = p + φ'(g) + b: the given mean pressure, zero under gap control, less the mean of p.
    pub(super) fn offset(&self) -> f64 {
        self.sums.given - self.sums.drift
    }

    /// Computes p = K⁻¹g + K⁻¹h and its tally anew; returns what the step has `left` of the residual.
    pub(super) fn refresh(&mut self, left: Left) -> Result<Left> {
        if let Load::Gap(mean) = self.posed.load {
            let (scale, present) =
                (mean * self.posed.nodes() / self.sums.tally.sum_gap, self.sums.tally.sum_gap / self.posed.nodes());
            // the rounding summed up in the mean gap, if it is worth a pass
            if self.posed.projects() && !self.has_yielded() {
                if scale.is_finite() && (scale - 1.0).abs() > SCALED * T::epsilon().widen() {
                    let scale = T::lit(scale);
                    self.fields.reducer.run(write(&mut self.fields.gap), |_, gap| {
                        gap.iter_mut().for_each(|gap| *gap *= scale);
                    });
                }
            } else if self.sums.tally.free > 0.0 && present != mean {
                // gaps of both signs may have hardly any mean; where some yield, nodes that touch stay
                let (projects, nodes) = (self.posed.projects(), self.posed.nodes());
                let apart = if projects { nodes - self.sums.tally.contact } else { nodes };
                let shift = T::lit((mean - present) * nodes / apart);
                self.fields.reducer.run(write(&mut self.fields.gap), |_, gap| {
                    let moves = gap.iter_mut().filter(|gap| !projects || **gap > T::zero());
                    moves.for_each(|gap| *gap = if projects { (*gap + shift).max(T::zero()) } else { *gap + shift });
                });
            }
        }
        let made = match left {
            Left::Nothing => None,
            Left::Gradient(made) | Left::Residual(made) | Left::Renewed(made) => Some(made),
        };
        let Fields { gap, pressure, residual, preconditioned, change, .. } = &mut self.fields;
        match made {
            Some(_) => self.posed.operators.pressure(gap, pressure, &mut [residual])?,
            None => self.posed.operators.pressure(gap, pressure, &mut [preconditioned, change])?,
        }
        self.take_pressure(made)
    }

    /// Takes K⁻¹g as the pressure of the state, after the step that was made, with its tally.
    fn take_pressure(&mut self, made: Option<Made>) -> Result<Left> {
        self.counters.applications += 1;
        (self.steps.age, self.steps.updates) = (0, 0.0);
        let Fields { reducer, pressure, .. } = &mut self.fields;
        reducer.run(write(pressure).zip(read(&self.posed.flat.pressure)), |_, (p, surface)| {
            p.iter_mut().zip(surface).for_each(|(p, &surface)| *p += surface);
        });
        self.sums.work = self.count();
        let overwritten = self.trust_work(TRUSTED)?;
        Ok(made.filter(|_| !overwritten).map_or(Left::Nothing, Left::Renewed))
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

    /// μ: the mean of r where the surfaces are apart, under gap control.
    pub(super) fn multiplier(&self) -> f64 {
        match self.posed.load {
            Load::Pressure(_) | Load::Spring { .. } => 0.0,
            Load::Gap(_) if self.sums.tally.free > 0.0 => self.sums.tally.sum_r / self.sums.tally.free,
            // no node is free: the least pressure that keeps all in contact
            Load::Gap(_) => self.sums.tally.min_r.0,
        }
    }

    /// r' on the working set, from what a step has left in its field.
    pub(super) fn residual(&mut self, left: Left) {
        let (gradient, made) = match left {
            Left::Residual(made) => {
                self.steps.momentum = Some(made);
                return;
            }
            Left::Gradient(made) => (true, Some(made)),
            Left::Renewed(made) => (false, Some(made)),
            Left::Nothing => (false, None),
        };
        let (offset, release) = (T::lit(self.offset()), T::lit(self.multiplier()));
        let centred = self.posed.is_gap_controlled() && self.posed.settings.method == Method::Preconditioned;
        let before = T::lit(self.sums.residual.level);
        let yielded = self.has_yielded();
        let Self { fields, posed, sums, .. } = self;
        let (local, tally) = (posed.potential(), &sums.tally);
        let (mut level, mut yields) = (release.widen(), local.is_capped());
        if centred && tally.contact > 0.0 && local.projects() {
            let released = passes::released(fields, &local, offset, release);
            let working = tally.free + released.count;
            if working > 0.0 {
                level = (tally.sum_r + released.sum_r) / working;
            }
            yields = yields && (released.yielding > 0.0 || yielded);
        }
        // where some yield, both sides of the corner have one level
        let release = if yields { T::lit(level) } else { release };
        let found = if gradient {
            // of the gradient less the level before; their difference is small
            let [release, level] = [release.widen(), level].map(|value| T::lit(value - before.widen()));
            let found = passes::release(fields, &local, Working { offset, release, level });
            Continued { difference: self.sums.residual.difference, ..found }
        } else {
            passes::residual(fields, &local, Working { offset, release, level: T::lit(level) })
        };
        let Continued { complementarity, working, descent, overlap, sum_change, difference } = found;
        self.sums.residual = Residual { level, working, complementarity, difference, yields };
        self.steps.momentum = made.map(|made| Made { descent, overlap, sum: sum_change, ..made });
    }

    /// A step of the chosen method; `false` if none is possible.
    pub(super) fn step(&mut self) -> Result<bool> {
        let moved = match self.posed.settings.method {
            Method::Preconditioned => self.preconditioned_step()?,
            Method::Rey2017 => self.rey2017_step()?,
        };
        let Some(mut left) = moved else { return Ok(false) };
        self.counters.iterations += 1;
        if self.steps.age >= REFRESH || self.has_lost_its_work() || self.has_lost_its_pressure() {
            left = self.refresh(left)?;
        }
        self.residual(left);
        Ok(true)
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
            smoothed: self.posed.goal == Goal::Start,
        }
    }
}
