use ndarray::{Array2, CowArray, Ix2};

use super::potential::Potential;
use super::report::{Iteration, Report, Solution, Status};
use super::start::{given_start, uniform_start};
use super::{Criterion, Method, Settings};
use crate::adhesion::AdhesionLaw;
use crate::constraint::{ContactConstraint, Outer};
use crate::elastic::ElasticOperator;
use crate::error::{Error, Result};
use crate::field::{Partial, Reducer, read, write};
use crate::par::IndexedParallelIterator;
use crate::passes::{Fields, Local, Tally, Working};
use crate::problem::{Control, Problem};
use crate::real::Real;

/// Iterations after which the pressure, updated step by step, is computed anew.
const REFRESH: usize = 50;

/// How often [`Method::Rey2017`] computes the certificate, which it needs for nothing else.
const CERTIFY: usize = 10;

/// The step from the state before.
#[derive(Clone, Copy)]
pub(super) struct Made {
    /// how many times the field of the change it is
    pub(super) factor: f64,
    /// ⟨d, y⟩ with y what it changed in r
    pub(super) curvature: f64,
    /// with c the field of the change, and z' that of the state before: ⟨r', c⟩, ⟨r', z'⟩, and Σ c over the working set
    pub(super) descent: f64,
    pub(super) overlap: f64,
    pub(super) sum: f64,
}

/// What a step has left in the place of r'.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) enum Left {
    /// nothing of use
    #[default]
    Nothing,
    /// r
    Gradient,
    /// r'
    Residual,
}

/// A solve under way: its fields, and what is known of them.
pub(super) struct State<'a, T, O, L, C> {
    pub(super) problem: &'a mut Problem<T, O, L>,
    pub(super) constraint: &'a mut C,
    pub(super) control: Control,
    pub(super) settings: Settings,
    pub(super) fields: Fields<T>,
    pub(super) tally: Tally,
    /// what the last step has left of the residual
    pub(super) left: Left,
    /// the mean of r over the working set, which r' is without; zero under pressure control
    pub(super) level: f64,
    /// how many nodes may move
    pub(super) working: f64,
    /// Σ|g r'|
    pub(super) orthogonality: f64,
    /// the mean of r'·K r'
    pub(super) certificate: f64,
    /// ⟨r', z⟩ and Σ z
    pub(super) preconditioned_descent: f64,
    pub(super) preconditioned_sum: f64,
    /// what the last pass for r' changed in it, squared and summed
    pub(super) residual_change: f64,
    pub(super) iterations: usize,
    pub(super) applications: usize,
    /// steps since the pressure was last computed from the gap
    pub(super) age: usize,
    /// the last step, if the next one may use it
    pub(super) momentum: Option<Made>,
    pub(super) step_length: f64,
    /// whether the start is near the solution
    pub(super) near: bool,
    /// ⟨r', r'⟩ of the step before, for [`Method::Rey2017`]
    pub(super) residual_norm: Option<f64>,
    pub(super) best_error: f64,
    pub(super) lowest_energy: f64,
    pub(super) idle: usize,
    /// whether the pressure was computed anew where rounding was all that was left
    pub(super) renewed: bool,
    /// whether the jumps of the law are smoothed
    pub(super) smoothed: bool,
    /// the load that pulled the surfaces apart
    pub(super) detached: Option<f64>,
}

impl<'a, T, O, L, C> State<'a, T, O, L, C>
where
    T: Real,
    O: ElasticOperator<T>,
    L: AdhesionLaw<T>,
    C: ContactConstraint<T>,
{
    pub(super) fn new(
        problem: &'a mut Problem<T, O, L>,
        constraint: &'a mut C,
        control: Control,
        start: Option<CowArray<'_, T, Ix2>>,
        settings: Settings,
    ) -> Result<Self> {
        let shape = problem.grid().shape();
        constraint.start(problem.grid(), problem.operator.stiffness_range().1, settings.tolerance)?;
        let (name, value) = match control {
            Control::MeanGap(gap) => ("mean gap", Error::non_negative("mean gap", gap)?),
            Control::MeanPressure(pressure) => ("mean pressure", Error::finite("mean pressure", pressure)?),
        };
        if !T::lit(value).is_finite() {
            return Err(Error::Value { name, value, requirement: "finite in the precision of the fields" });
        }
        let uniform = start.is_none();
        let gap = match start {
            Some(start) => given_start(start, shape, control, constraint.projects())?,
            None => Array2::from_elem(shape, T::lit(uniform_start(problem, control))),
        };
        let nodes = problem.grid().nodes();
        let field = || Array2::zeros(shape);
        let pressure = if uniform { problem.surface_pressure.clone() } else { field() };
        let nothing = Tally::new(&Partial::NONE);
        let mut state = Self {
            problem,
            constraint,
            control,
            settings,
            fields: Fields {
                reducer: Reducer::new(nodes),
                gap,
                pressure,
                residual: field(),
                preconditioned: field(),
                change: field(),
            },
            tally: nothing,
            left: Left::Nothing,
            level: 0.0,
            working: 0.0,
            orthogonality: 0.0,
            certificate: f64::INFINITY,
            preconditioned_descent: 0.0,
            preconditioned_sum: 0.0,
            residual_change: 0.0,
            iterations: 0,
            applications: 0,
            age: 0,
            momentum: None,
            step_length: 1.0,
            near: false,
            residual_norm: None,
            best_error: f64::INFINITY,
            lowest_energy: f64::INFINITY,
            idle: 0,
            renewed: false,
            smoothed: false,
            detached: None,
        };
        if uniform {
            state.count();
        } else {
            state.refresh()?;
        }
        state.check_start()?;
        Ok(state)
    }

    pub(super) fn nodes(&self) -> f64 {
        self.fields.gap.len() as f64
    }

    /// The mean pressure that is given, or zero.
    pub(super) fn offset(&self) -> f64 {
        match self.control {
            Control::MeanGap(_) => 0.0,
            Control::MeanPressure(pressure) => pressure,
        }
    }

    pub(super) fn is_gap_controlled(&self) -> bool {
        matches!(self.control, Control::MeanGap(_))
    }

    /// Computes the pressure from the gap, p = K⁻¹g + K⁻¹h, and counts anew.
    pub(super) fn refresh(&mut self) -> Result<()> {
        if let Control::MeanGap(mean) = self.control {
            let (scale, present) = (mean * self.nodes() / self.tally.sum_gap, self.tally.sum_gap / self.nodes());
            // what rounding has added up to, if it is worth a pass
            if self.constraint.projects() {
                if scale.is_finite() && (scale - 1.0).abs() > 64.0 * T::epsilon().widen() {
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
        self.problem.operator.pressure(self.fields.gap.view(), self.fields.pressure.view_mut())?;
        self.applications += 1;
        self.age = 0;
        let Fields { reducer, pressure, .. } = &mut self.fields;
        reducer.run(write(pressure).zip(read(&self.problem.surface_pressure)), |_, (p, surface)| {
            p.iter_mut().zip(surface).for_each(|(p, &surface)| *p += surface);
            Partial::NONE
        });
        self.count();
        Ok(())
    }

    /// Takes the tally of the present gap and pressure.
    pub(super) fn count(&mut self) {
        let offset = T::lit(self.offset());
        let Self { fields, problem, constraint, .. } = self;
        let local = Potential::new(&problem.law, &**constraint);
        self.tally = Tally::new(&T::tally(fields, &local, offset, &problem.surface_pressure));
        self.left = Left::Nothing;
    }

    /// μ: the mean of r where the surfaces are apart, under gap control.
    pub(super) fn multiplier(&self) -> f64 {
        match self.control {
            Control::MeanPressure(_) => 0.0,
            Control::MeanGap(_) if self.tally.free > 0.0 => self.tally.sum_r / self.tally.free,
            // no node is free: the least pressure that keeps them all in contact
            Control::MeanGap(_) => self.tally.min_r,
        }
    }

    /// r' and the working set: the nodes that are apart, and those in contact under tension.
    pub(super) fn residual(&mut self) {
        let left = std::mem::take(&mut self.left);
        if left == Left::Residual {
            return;
        }
        let (offset, release) = (T::lit(self.offset()), T::lit(self.multiplier()));
        let centred = self.is_gap_controlled() && self.settings.method == Method::Preconditioned;
        let Self { fields, problem, constraint, tally, .. } = self;
        let local = Potential::new(&problem.law, &**constraint);
        self.level = release.widen();
        if centred && tally.contact > 0.0 && local.projects() {
            // contact nodes have one and the same adhesive traction
            let released = T::released(fields, problem.law.traction(T::zero()) + offset, release);
            let working = tally.free + released.sum[0];
            if working > 0.0 {
                self.level = (tally.sum_r + released.sum[1]) / working;
            }
        }
        let working = Working { offset, release, level: T::lit(self.level) };
        if let (Left::Gradient, Some(made)) = (left, self.momentum) {
            let (descent, overlap, sum);
            [self.orthogonality, self.working, descent, overlap, sum, ..] =
                T::release(fields, local.projects(), working).sum;
            self.momentum = Some(Made { descent, overlap, sum, ..made });
        } else {
            [self.orthogonality, self.working, self.residual_change, ..] = T::residual(fields, &local, working).sum;
            self.momentum = None;
        }
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
        let (foundation, mean_stiffness) = (self.foundation(), self.mean_stiffness());
        let Fields { residual, preconditioned, .. } = &mut self.fields;
        let found = self.problem.operator.precondition(
            residual.view(),
            foundation,
            mean_stiffness,
            preconditioned.view_mut(),
        )?;
        self.certificate = if found.error.is_nan() { f64::INFINITY } else { found.error.max(0.0) };
        self.preconditioned_descent = found.descent * self.nodes();
        self.preconditioned_sum = found.mean * self.nodes();
        self.applications += 1;
        self.lift(foundation);
        Ok(())
    }

    pub(super) fn update_constraint(&mut self) -> Outer {
        let outer = self.constraint.update(self.fields.gap.view());
        if outer == Outer::Again {
            self.restart();
        }
        outer
    }

    /// Forgets what was known of an energy, or a gap, that has changed.
    pub(super) fn restart(&mut self) {
        (self.momentum, self.residual_norm) = (None, None);
        (self.best_error, self.lowest_energy, self.idle) = (f64::INFINITY, f64::INFINITY, 0);
        self.renewed = false;
        self.count();
    }

    /// One step of the chosen method; `false` if none is possible.
    pub(super) fn step(&mut self) -> Result<bool> {
        let moved = match self.settings.method {
            Method::Preconditioned => self.preconditioned_step()?,
            Method::Rey2017 => self.rey2017_step()?,
        };
        if moved {
            self.iterations += 1;
            if self.age >= REFRESH {
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
            mean_gap: self.tally.sum_gap / self.nodes(),
            contact_points: self.tally.contact as usize,
            smoothed: self.smoothed,
        }
    }

    /// The fields as they are returned, with the certificate of just these.
    pub(super) fn finish(mut self, status: Status) -> Result<Solution<T>> {
        if self.sharpen()? {
            self.residual();
            self.certificate = f64::INFINITY;
        }
        let status = if self.detached.is_some() && status != Status::Stopped { Status::Detached } else { status };
        if self.age > 0 {
            self.refresh()?;
            self.residual();
            self.certificate = f64::INFINITY;
        }
        if self.certificate.is_infinite() {
            self.certify()?;
        }
        let mean = match self.control {
            Control::MeanGap(_) => -self.multiplier(),
            Control::MeanPressure(pressure) => pressure,
        };
        let load_error = if self.detached.is_some() { 1.0 } else { self.load_error() };
        let mean_pressure = self.detached.unwrap_or(mean);
        let Self { fields: Fields { reducer, gap, pressure, preconditioned, .. }, problem, constraint, .. } = &mut self;
        let (mean, projects) = (T::lit(mean), constraint.projects());
        let at_contact = problem.law.traction(T::zero());
        let fields = read(gap).zip(write(pressure)).zip(write(preconditioned));
        let total = reducer.run(fields, |first, ((gap, pressure), contact)| {
            let mut part = Partial::NONE;
            for (i, ((&gap, p), contact)) in gap.iter().zip(pressure).zip(contact).enumerate() {
                *p += mean;
                *contact = match projects {
                    true if gap <= T::zero() => (*p + at_contact).max(T::zero()),
                    true => T::zero(),
                    false => -constraint.traction(first + i, gap),
                };
                part.sum[0] += contact.widen();
                part.min = part.min.min(gap.widen());
            }
            part
        });
        let mu_rho = self.problem.resolution();
        let report = Report {
            status,
            relative_error: self.relative_error(),
            load_error,
            orthogonality: self.scaled_orthogonality(),
            iterations: self.iterations,
            operator_applications: self.applications,
            mean_gap: self.tally.sum_gap / self.nodes(),
            mean_pressure,
            mean_contact_pressure: total.sum[0] / self.nodes(),
            contact_fraction: self.tally.contact / self.nodes(),
            contact_points: self.tally.contact as usize,
            min_gap: total.min,
            elastic_energy: 0.5 * self.work(),
            adhesive_energy: self.tally.adhesive / self.nodes(),
            mu_rho,
            under_resolved: mu_rho > 0.5,
            precision: T::NAME,
            method: self.settings.method,
        };
        let Fields { gap, pressure, preconditioned, .. } = self.fields;
        Ok(Solution { gap, pressure, contact_pressure: preconditioned, report })
    }
}
