//! The state of a solve: its fields, and the sums over them on which the driver decides.

use ndarray::Array2;

use super::coarse::Coarse;
use super::minimisation::{Goal, Left, Made, Preconditioned, Progress, Residual};
use super::operators::Operators;
use super::passes::{self, Continued, Fields, Taken, Tally, Working};
use super::potential::Potential;
use super::report::Iteration;
use super::start::{Begin, given_start, uniform_start};
use super::work::{TRUSTED, Work};
use super::{Branch, Criterion, Method, Settings};
use crate::adhesion::AdhesionLaw;
use crate::constraint::ContactConstraint;
use crate::elastic::{Boundary, Foundation};
use crate::error::{Error, Result};
use crate::field::{Partial, read, write};
use crate::par::Parts;
use crate::problem::{Load, PressedFlat, Window};
use crate::real::Real;

/// Iterations after which the pressure, updated step by step, is computed anew.
const REFRESH: usize = 50;

/// The relative error of the mean gap, in units of the rounding of one number, that is worth a pass.
const SCALED: f64 = 64.0;

/// The iterations between two certificates of [`Method::Rey2017`], which needs them for the report only.
const CERTIFY: usize = 10;

/// The mean pressure, over the rms pressure that presses the surface flat, up to which the gap of undeformed surfaces
/// that touch is the better start without adhesion on a periodic grid.
const HARDLY: f64 = 1e-3;

/// The stiffness of one node among its neighbours, over that of the stiffest wave: the reciprocal of the mean
/// compliance of the waves of a square grid.
const HELD: f64 = 0.4;

/// The state of a solve: its fields, and the sums over them on which the driver decides.
pub(super) struct State<'a, T, L> {
    pub(super) operators: &'a mut dyn Operators<T, L>,
    pub(super) law: &'a dyn AdhesionLaw<T>,
    pub(super) flat: &'a PressedFlat<T>,
    pub(super) constraint: &'a mut dyn ContactConstraint<T>,
    pub(super) load: Load,
    /// the branch of equilibria on which the solve has started
    pub(super) branch: Option<Branch>,
    /// the given mean pressure p̄ of the present state, zero under gap control
    pub(super) given: f64,
    pub(super) settings: Settings,
    pub(super) goal: Goal,
    pub(super) fields: Fields<T, L>,
    pub(super) tally: Tally,
    /// Σ u·p, twice the elastic energy
    pub(super) work: Work,
    /// the mean of p, zero but for rounding
    pub(super) drift: f64,
    pub(super) left: Left,
    pub(super) residual: Residual,
    /// the mean of r'·K r'
    pub(super) certificate: f64,
    pub(super) preconditioned: Preconditioned,
    /// the last step, if the next one may use it
    pub(super) momentum: Option<Made>,
    pub(super) step_length: f64,
    pub(super) coarse: Option<Coarse>,
    /// whether the start is near the solution
    pub(super) near: bool,
    /// ⟨r', r'⟩ of the step before, for [`Method::Rey2017`]
    pub(super) residual_norm: Option<f64>,
    pub(super) progress: Progress,
    /// how often the function to be minimised has changed
    pub(super) rounds: usize,
    pub(super) iterations: usize,
    pub(super) applications: usize,
    /// steps since the pressure was last computed from the gap
    pub(super) age: usize,
    /// the sum of ⟨c, c⟩/N over these steps, with c their change
    pub(super) updates: f64,
    /// the load that has pulled the surfaces apart
    pub(super) detached: Option<f64>,
}

/// Prepares a constraint for a solve.
pub(super) fn prepare<T: Real, L: Real>(
    constraint: &mut dyn ContactConstraint<T>,
    operators: &dyn Operators<T, L>,
    flat: &PressedFlat<T>,
    settings: Settings,
) -> Result<()> {
    let operator = operators.state();
    if !constraint.takes_slabs() {
        Error::alone("contact constraint", operator.grid().slab())?;
    }
    let surface = flat.window.as_ref().map_or(operator.grid(), Window::held);
    constraint.start(surface, operator.stiffness_range().1, settings.tolerance_in::<T>())
}

impl<'a, T: Real, L: Real> State<'a, T, L> {
    pub(super) fn new(
        operators: &'a mut dyn Operators<T, L>,
        law: &'a dyn AdhesionLaw<T>,
        flat: &'a PressedFlat<T>,
        constraint: &'a mut dyn ContactConstraint<T>,
        (load, branch): (Load, Option<Branch>),
        begin: Begin<'_, T>,
        settings: Settings,
    ) -> Result<Self> {
        prepare(constraint, &*operators, flat, settings)?;
        let grid = operators.state().grid();
        let (slab, shape) = (grid.slab(), grid.field_shape());
        if settings.method == Method::Rey2017 && (flat.window.is_some() || load.stiffness() > 0.0) {
            let (control, reason) = (
                "Algorithm 3 of Rey, Anciaux and Molinari (2017)",
                "it knows neither springs nor \
                absent nodes nor a free boundary: take the default method",
            );
            return Err(Error::Control { control, reason });
        }
        let uniform = begin.is_default();
        let given = given_start(begin, slab, flat.window.as_ref(), load, constraint.wall().is_rigid())?;
        let (gap, pressure) = match given {
            Some(gap) => {
                let mut pressure = Array2::zeros(shape);
                operators.pressure(&gap, &mut pressure, &mut [])?;
                (gap, pressure)
            }
            None => (Array2::from_elem(shape, T::lit(uniform_start(law, flat, load))), flat.pressure.clone()),
        };
        let preconditioned = settings.method == Method::Preconditioned;
        let coarse = if preconditioned { Coarse::of(&*operators.corrections()) } else { None };
        let mut state = Self {
            operators,
            law,
            flat,
            constraint,
            load,
            branch,
            given: 0.0,
            settings,
            goal: Goal::Solution,
            fields: Fields::new(slab, gap, pressure),
            tally: Tally::default(),
            work: Work::default(),
            drift: 0.0,
            left: Left::Nothing,
            residual: Residual::default(),
            certificate: f64::INFINITY,
            preconditioned: Preconditioned::default(),
            momentum: None,
            step_length: 1.0,
            coarse,
            near: false,
            residual_norm: None,
            progress: Progress::NONE,
            rounds: 0,
            iterations: 0,
            applications: 0,
            age: 0,
            updates: 0.0,
            detached: None,
        };
        if uniform && state.law.is_zero() && (flat.boundary != Boundary::Periodic || state.is_hardly_pressed()) {
            state.start_undeformed()?;
        } else if uniform {
            state.work = state.count();
        } else {
            state.take_pressure(None)?;
        }
        state.check_start()?;
        Ok(state)
    }

    pub(super) fn nodes(&self) -> f64 {
        self.operators.state().grid().nodes() as f64
    }

    /// Whether the load on the way to the branch of loading hardly presses the surfaces together.
    fn is_hardly_pressed(&self) -> bool {
        let flat = self.flat.stiffness * self.flat.rms_height;
        self.branch.is_some() && matches!(self.load, Load::Pressure(pressure) if pressure <= HARDLY * flat)
    }

    /// Takes the gap of undeformed bodies that just touch: under no pressure.
    fn start_undeformed(&mut self) -> Result<()> {
        let Fields { gap, residual, preconditioned, change, .. } = &mut self.fields;
        self.operators.displacement(&self.flat.pressure, gap, [residual, preconditioned, change])?;
        self.applications += 1;
        let peak = T::lit(self.flat.peak);
        let local = Potential::new(self.law, &*self.constraint, self.flat.window.as_ref());
        let Fields { reducer, gap, pressure, .. } = &mut self.fields;
        local.run(reducer, write(gap).zip(write(pressure)), |local, _, (gap, pressure)| {
            for (gap, pressure) in gap.iter_mut().zip(pressure) {
                let apart = peak - *gap;
                (*gap, *pressure) = (if local.projects() { apart.max(T::zero()) } else { apart }, T::zero());
            }
            Partial::NONE
        });
        // nothing is deformed: the sums that would cancel need not be trusted
        self.count();
        self.work = Work::default();
        Ok(())
    }

    /// The mean gap, over all nodes of the operator's grid.
    pub(super) fn mean_gap(&self) -> f64 {
        self.tally.sum_gap / self.nodes()
    }

    /// The constant b in r = p + φ'(g) + b: the given mean pressure (zero under gap control) less the mean of p, which
    /// is rounding and no load.
    pub(super) fn offset(&self) -> f64 {
        self.given - self.drift
    }

    /// Whether the gap is confined to g ≥ 0.
    pub(super) fn projects(&self) -> bool {
        self.constraint.wall().is_rigid()
    }

    pub(super) fn is_gap_controlled(&self) -> bool {
        matches!(self.load, Load::Gap(_))
    }

    /// Computes the pressure from the gap, p = K⁻¹g + K⁻¹h, and takes the tally anew.
    pub(super) fn refresh(&mut self) -> Result<()> {
        if let Load::Gap(mean) = self.load {
            let (scale, present) = (mean * self.nodes() / self.tally.sum_gap, self.tally.sum_gap / self.nodes());
            // the rounding summed up in the mean gap, if it is worth a pass
            if self.projects() {
                if scale.is_finite() && (scale - 1.0).abs() > SCALED * T::epsilon().widen() {
                    let scale = T::lit(scale);
                    self.fields.reducer.run(write(&mut self.fields.gap), |_, gap| {
                        gap.iter_mut().for_each(|gap| *gap *= scale);
                        Partial::NONE
                    });
                }
            } else if self.tally.free > 0.0 && present != mean {
                // gaps of both signs may have hardly any mean
                let shift = T::lit(mean - present);
                self.fields.reducer.run(write(&mut self.fields.gap), |_, gap| {
                    gap.iter_mut().for_each(|gap| *gap += shift);
                    Partial::NONE
                });
            }
        }
        let made = match self.left {
            Left::Nothing => None,
            Left::Gradient(made) | Left::Residual(made) | Left::Renewed(made) => Some(made),
        };
        let Fields { gap, pressure, residual, preconditioned, change, .. } = &mut self.fields;
        // after a step its change and z are still of use, otherwise the residual before
        match made {
            Some(_) => self.operators.pressure(gap, pressure, &mut [residual])?,
            None => self.operators.pressure(gap, pressure, &mut [preconditioned, change])?,
        }
        self.take_pressure(made)
    }

    /// Makes the pressure K⁻¹g of the gap that of the state, after the step that was made, and takes the tally.
    fn take_pressure(&mut self, made: Option<Made>) -> Result<()> {
        self.applications += 1;
        (self.age, self.updates) = (0, 0.0);
        let Fields { reducer, pressure, .. } = &mut self.fields;
        reducer.run(write(pressure).zip(read(&self.flat.pressure)), |_, (p, surface)| {
            p.iter_mut().zip(surface).for_each(|(p, &surface)| *p += surface);
            Partial::NONE
        });
        self.work = self.count();
        self.left = made.map_or(Left::Nothing, Left::Renewed);
        self.trust_work(TRUSTED)
    }

    /// Takes the tally of the present gap and pressure; returns the elastic work ⟨u, p⟩ by its sums.
    pub(super) fn count(&mut self) -> Work {
        let offset = T::lit(self.offset());
        let local = Potential::new(self.law, &*self.constraint, self.flat.window.as_ref());
        let taken = passes::tally(&mut self.fields, &local, offset, &self.flat.pressure);
        let Taken { mut tally, gap_surface, sum_p } = taken;
        self.drift = sum_p / self.nodes();
        self.given = self.load.pressure_at(tally.sum_gap / self.nodes());
        tally.shift(T::lit(self.offset()).widen() - offset.widen());
        (self.tally, self.left) = (tally, Left::Nothing);
        self.summed_work(tally.sum_gp, gap_surface)
    }

    /// μ: the mean of r where the surfaces are apart, under gap control.
    pub(super) fn multiplier(&self) -> f64 {
        match self.load {
            Load::Pressure(_) | Load::Spring { .. } => 0.0,
            Load::Gap(_) if self.tally.free > 0.0 => self.tally.sum_r / self.tally.free,
            // no node is free: the least pressure that keeps them all in contact
            Load::Gap(_) => self.tally.min_r,
        }
    }

    /// r' on the working set: the nodes that are apart, and those in contact under tension.
    pub(super) fn residual(&mut self) {
        let (gradient, made) = match std::mem::replace(&mut self.left, Left::Nothing) {
            Left::Residual(made) => {
                self.momentum = Some(made);
                return;
            }
            Left::Gradient(made) => (true, Some(made)),
            Left::Renewed(made) => (false, Some(made)),
            Left::Nothing => (false, None),
        };
        let (offset, release) = (T::lit(self.offset()), T::lit(self.multiplier()));
        let centred = self.is_gap_controlled() && self.settings.method == Method::Preconditioned;
        let before = T::lit(self.residual.level);
        let Self { fields, law, constraint, tally, flat, .. } = self;
        let local = Potential::new(*law, &**constraint, flat.window.as_ref());
        let mut level = release.widen();
        if centred && tally.contact > 0.0 && local.projects() {
            let released = passes::released(fields, &local, offset, release);
            let working = tally.free + released.count;
            if working > 0.0 {
                level = (tally.sum_r + released.sum_r) / working;
            }
        }
        let (found, difference) = if gradient {
            // of the gradient less the level before; their difference is small
            let [release, level] = [release.widen(), level].map(|value| T::lit(value - before.widen()));
            let found = passes::release(fields, &local, Working { offset, release, level });
            (found, self.residual.difference)
        } else {
            passes::residual(fields, &local, Working { offset, release, level: T::lit(level) })
        };
        let Continued { orthogonality, working, descent, overlap, sum_change } = found;
        self.residual = Residual { level, working, orthogonality, difference };
        self.momentum = made.map(|made| Made { descent, overlap, sum: sum_change, ..made });
    }

    /// z = M r' and the certificate, from one application.
    pub(super) fn precondition(&mut self) -> Result<()> {
        if self.settings.method == Method::Rey2017 {
            let due = self.settings.criterion == Criterion::EnergyNorm && self.iterations.is_multiple_of(CERTIFY);
            if !due {
                self.certificate = f64::INFINITY;
                return Ok(());
            }
        }
        self.certify()
    }

    pub(super) fn certify(&mut self) -> Result<()> {
        self.renew_coarse();
        let (stiffness, mean_stiffness) = (self.foundation(), self.mean_stiffness());
        let centred = self.is_gap_controlled();
        let coarse = self.coarse.as_mut().and_then(Coarse::ready);
        let foundation = Foundation { stiffness, mean_stiffness, coarse };
        let local = Potential::new(self.law, &*self.constraint, self.flat.window.as_ref());
        let stiffest = self.operators.state().stiffness_range().1;
        let repels = local.repels() && stiffest > 0.0;
        let held = repels.then(|| passes::hold(&mut self.fields, &local, HELD * stiffest, centred));
        let Fields { residual, preconditioned, .. } = &mut self.fields;
        let found =
            self.operators.corrections().precondition(residual.view(), foundation, preconditioned.view_mut())?;
        let [mut sum, mut descent] = [found.mean, found.descent].map(|mean| mean * self.nodes());
        let mut certificate = found.error.max(0.0);
        if let Some(held) = held {
            sum = passes::release_held(&mut self.fields, &local, held);
            descent += held.descent;
            // two loads, of which the sum is the residual: their responses add up in the energy norm
            certificate = (certificate.sqrt() + (held.beside / self.nodes()).sqrt()).powi(2);
        }
        self.certificate = if found.error.is_nan() { f64::INFINITY } else { certificate };
        self.preconditioned = Preconditioned { descent, sum };
        self.applications += 1;
        Ok(())
    }

    /// One step of the chosen method; `false` if none is possible.
    pub(super) fn step(&mut self) -> Result<bool> {
        let moved = match self.settings.method {
            Method::Preconditioned => self.preconditioned_step()?,
            Method::Rey2017 => self.rey2017_step()?,
        };
        if moved {
            self.iterations += 1;
            if self.age >= REFRESH || self.has_lost_its_work() || self.has_lost_its_pressure() {
                self.refresh()?;
            }
        }
        Ok(moved)
    }

    pub(super) fn iteration(&self) -> Iteration {
        Iteration {
            iteration: self.iterations,
            operator_applications: self.applications,
            relative_error: self.relative_error(),
            load_error: self.load_error(),
            energy: self.energy(),
            mean_gap: self.mean_gap(),
            contact_nodes: self.tally.contact as usize,
            round: self.rounds,
            smoothed: self.goal == Goal::Start,
        }
    }
}
