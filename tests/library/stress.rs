//! Random small scenes against dense matrices: both precisions and controls, every law, constraint and kind of start.
//!
//! `STRESS_CASES=20000 cargo test --release --test library stress:: -- --nocapture` runs more of them, `STRESS_FIRST`
//! says from which seed on.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};

use std::result::Result;

use crate::common::dense::{Dense, mean_product};
use asperity::*;
use ndarray::Array2;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Law {
    None,
    Exponential(f64, f64),
    MaugisDugdale(f64, f64),
}

impl Law {
    fn boxed<T: Real>(self) -> Box<dyn AdhesionLaw<T>> {
        match self {
            Self::None => Box::new(NoAdhesion),
            Self::Exponential(w, rho) => Box::new(Exponential::new(w, rho).unwrap()),
            Self::MaugisDugdale(w, rho) => Box::new(MaugisDugdale::new(w, rho).unwrap()),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Constraint {
    Projection,
    Penalty(f64),
    Uzawa(f64),
}

#[derive(Clone, Debug)]
struct Scene {
    shape: (usize, usize),
    lengths: (f64, f64),
    modulus: f64,
    kind: &'static str,
    heights: Array2<f64>,
    law: Law,
    constraint: Constraint,
    control: Control,
    start: Option<Array2<f64>>,
    settings: Settings,
    single: bool,
}

fn given<T>(start: &Option<Array2<T>>) -> Start<'_, T> {
    start.as_ref().map_or(Start::Default, |start| Start::From(start))
}

impl Scene {
    fn new(seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut power = |low: f64, high: f64| 10_f64.powf(random.random_range(low..high));
        let (modulus, lx, aspect, steep, tolerance) =
            (power(-3.0, 12.0), power(-9.0, 3.0), power(-1.5, 1.5), power(-6.0, 0.5), power(-9.0, -2.0));
        let (load, w, rho, stiff) = (power(-6.0, 0.7), power(-2.0, 0.5), power(-2.0, 1.0), power(0.0, 3.0));
        let shape = match random.random_range(0..20) {
            0 => (1, random.random_range(1..40)),
            1 => (random.random_range(1..300), 1),
            2 => (random.random_range(60..120), random.random_range(2..4)),
            3 | 4 => (random.random_range(12..22), random.random_range(12..22)),
            _ => (random.random_range(1..10), random.random_range(1..10)),
        };
        let lengths = (lx, lx * aspect);
        let height = steep * lx;
        let kinds = ["noise", "smooth", "levels", "spike", "step", "board", "flat"];
        let kind = kinds[[0, 0, 0, 1, 1, 1, 2, 2, 3, 4, 5, 6][random.random_range(0..12)]];
        let phases: [f64; 3] = std::array::from_fn(|_| random.random_range(0.0..7.0));
        let heights = Array2::from_shape_fn(shape, |(i, j)| {
            let wave = |i: usize, n: usize, phase: f64| (std::f64::consts::TAU * i as f64 / n as f64 + phase).cos();
            let (noise, level) = (random.random_range(0.0..1.0), f64::from(random.random_range(0..3_u8)));
            height
                * match kind {
                    "noise" => noise,
                    "smooth" => {
                        wave(i, shape.0, phases[0]) + wave(j, shape.1, phases[1]) + wave(2 * i + j, shape.0, phases[2])
                    }
                    "levels" => 0.5 * level,
                    "spike" => f64::from(u8::from((i, j) == (shape.0 / 2, shape.1 / 3))),
                    "step" => f64::from(u8::from(2 * i < shape.0)),
                    "board" => f64::from(u8::from((i + j) % 2 == 0)),
                    _ => 0.25,
                }
        });
        let dense = Dense::new(shape, lengths, modulus);
        let centred = centred(&heights);
        let flat = dense.pressure(&centred).iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let flat = if flat > 1e-12 * modulus * steep { flat } else { 1e-3 * modulus * steep };
        let spacing = (lengths.0 / shape.0 as f64).max(lengths.1 / shape.1 as f64);
        let rho = rho * height;
        let w = (w * rho).powi(2) * modulus / spacing;
        let law = match random.random_range(0..5) {
            0 | 1 => Law::None,
            2 | 3 => Law::Exponential(w, rho),
            _ => Law::MaugisDugdale(w, rho),
        };
        let gap_control = random.random_bool(0.5);
        let tension = random.random_bool(if law == Law::None { 0.03 } else { 0.3 });
        let control = match (gap_control, tension) {
            (true, _) if random.random_bool(0.02) => Control::MeanGap(0.0),
            (true, _) => Control::MeanGap(height * load),
            (false, true) if law == Law::None => Control::MeanPressure(-flat * load),
            (false, true) => Control::MeanPressure(-w / rho * load.powf(0.3)),
            (false, false) => Control::MeanPressure(flat * load),
        };
        let constraint = match random.random_range(0..8) {
            0 => Constraint::Penalty(stiff * dense.stiffest.max(modulus / lx)),
            1 => Constraint::Uzawa(stiff.sqrt() * dense.stiffest.max(modulus / lx)),
            _ => Constraint::Projection,
        };
        let start = match random.random_range(0..6) {
            0 => Some(Array2::from_shape_fn(shape, |_| height * random.random_range(0.0..1.0))),
            1 => Some(Array2::zeros(shape)),
            2 => Some(heights.mapv(|h| (0.3 * height - h).max(0.0))),
            _ => None,
        };
        let single = random.random_bool(0.4);
        let paper = law == Law::None && constraint == Constraint::Projection && random.random_bool(0.1);
        let tolerance = if single { tolerance.max(1e-5) } else { tolerance };
        // light and heavy loads, down to a contact of one node and beyond; surfaces that are their own mirror images
        let (light, mirrored) = (random.random_bool(0.25), random.random_bool(0.15));
        let exponent = random.random_range(-14.0..1.0);
        let control = match control {
            Control::MeanPressure(pressure) if light => {
                Control::MeanPressure(pressure.signum() * modulus * 10_f64.powf(exponent))
            }
            control => control,
        };
        let heights = if mirrored {
            Array2::from_shape_fn(shape, |(i, j)| heights[[i.min((shape.0 - i) % shape.0), j]])
        } else {
            heights
        };
        let settings = if paper {
            Settings { criterion: Criterion::EnergyNorm, tolerance: Some(tolerance), ..Settings::rey2017() }
        } else {
            Settings { tolerance: Some(tolerance), ..Settings::default() }
        };
        Self { shape, lengths, modulus, kind, heights, law, constraint, control, start, settings, single }
    }

    fn run(&self) -> Result<Report, String> {
        if self.single { self.with_precision::<f32>() } else { self.with_precision::<f64>() }
    }

    fn with_precision<T: Real>(&self) -> Result<Report, String> {
        match self.constraint {
            Constraint::Projection => self.with::<T, _>(Projection),
            Constraint::Penalty(k) => self.with::<T, _>(Penalty::new(k).map_err(|e| e.to_string())?),
            Constraint::Uzawa(k) => self.with::<T, _>(Uzawa::new(k).map_err(|e| e.to_string())?),
        }
    }

    fn with<T: Real, C: ContactConstraint<T>>(&self, constraint: C) -> Result<Report, String> {
        let grid = Grid::new(self.shape, self.lengths).map_err(|e| e.to_string())?;
        let surface = Surface::new(grid, self.heights.clone()).map_err(|e| e.to_string())?;
        let operator = Westergaard::<T>::new(grid, self.modulus).map_err(|e| e.to_string())?;
        let mut problem = Problem::new(&surface, operator, self.law.boxed::<T>()).map_err(|e| e.to_string())?;
        let start = self.start.as_ref().map(|start| start.mapv(T::lit));
        let mut solver = Solver { settings: self.settings, constraint };
        let mut history = Vec::new();
        let solution = solver
            .solve_with(&mut problem, self.control, given(&start), |iteration| {
                history.push(*iteration);
                ControlFlow::Continue(())
            })
            .map_err(|e| e.to_string())?;
        self.check(&solution, &history, &self.law.boxed::<T>(), &solver.constraint)?;
        Ok(solution.report)
    }

    /// The solution by projection without adhesion.
    fn solution<T: Real>(&self) -> asperity::Result<Solution<T>> {
        let grid = Grid::new(self.shape, self.lengths)?;
        let surface = Surface::new(grid, self.heights.clone())?;
        let mut problem = Problem::new(&surface, Westergaard::<T>::new(grid, self.modulus)?, NoAdhesion)?;
        let start = self.start.as_ref().map(|start| start.mapv(T::lit));
        let go_on = |_: &Iteration| ControlFlow::Continue(());
        Solver::new(self.settings).solve_with(&mut problem, self.control, given(&start), go_on)
    }

    /// The certified error of a gap as it is, in `f64`.
    fn certified(&self, gap: &Array2<f64>) -> f64 {
        let settings = Settings { max_iterations: 0, tolerance: Some(1e-30), ..Settings::default() };
        let (control, start) = (Control::MeanGap(gap.mean().unwrap()), Some(gap.clone()));
        Self { settings, control, start, ..self.clone() }.solution::<f64>().unwrap().report.relative_error
    }

    fn is_plane(&self) -> bool {
        self.heights.iter().all(|&h| h == self.heights[[0, 0]])
    }

    fn check<T: Real, C: ContactConstraint<T>>(
        &self,
        solution: &Solution<T>,
        history: &[Iteration],
        law: &dyn AdhesionLaw<T>,
        constraint: &C,
    ) -> Result<(), String> {
        let report = &solution.report;
        let epsilon = T::epsilon().widen();
        let dense = Dense::new(self.shape, self.lengths, self.modulus);
        let nodes = dense.nodes as f64;
        let wide = |field: &Array2<T>| field.iter().map(|x| x.widen()).collect::<Vec<f64>>();
        let [gap, pressure, contact] = [&solution.gap, &solution.pressure, &solution.contact_pressure].map(wide);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / nodes;
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let projects = self.constraint == Constraint::Projection;
        let surface = centred(&self.heights);
        let need = |good: bool, what: String| if good { Ok(()) } else { Err(what) };
        let close = |name: &str, found: f64, expected: f64, allowed: f64| {
            need((found - expected).abs() <= allowed, format!("{name}: {found:e} is not {expected:e} (± {allowed:e})"))
        };

        // fields
        need(gap.iter().chain(&pressure).chain(&contact).all(|x| x.is_finite()), "a field is not finite".into())?;
        need(contact.iter().all(|&p| p >= 0.0), "a contact pressure is negative".into())?;
        if projects {
            need(gap.iter().all(|&g| g >= 0.0), "a gap is negative".into())?;
            need(gap.iter().zip(&contact).all(|(g, p)| g * p == 0.0), "complementarity".into())?;
            let touching = gap.iter().filter(|g| **g == 0.0).count();
            need(report.contact_nodes == touching, format!("{} points, not {touching}", report.contact_nodes))?;
        }
        need(report.contact_fraction == report.contact_nodes as f64 / nodes, "contact fraction".into())?;
        let lowest = gap.iter().copied().fold(f64::INFINITY, f64::min);
        need(report.min_gap == lowest, format!("least gap {:e} is not {lowest:e}", report.min_gap))?;
        let size = mean(&gap.iter().map(|g| g.abs()).collect::<Vec<_>>());
        close("mean gap", report.mean_gap, mean(&gap), 64.0 * epsilon * size)?;
        close("mean contact pressure", report.mean_contact_pressure, mean(&contact), 64.0 * epsilon * mean(&contact))?;
        let detached = report.status == Status::Detached;
        match self.control {
            Control::MeanGap(given) => close("given gap", mean(&gap), given, 1e3 * epsilon * size)?,
            Control::MeanPressure(given) => {
                need(report.mean_pressure == T::lit(given).widen() || report.mean_pressure == given, "load".into())?;
            }
            other => panic!("{other:?} is not checked here"),
        }

        // sums against those of the returned fields
        let u: Vec<f64> = gap.iter().zip(&surface).map(|(g, h)| g + h).collect();
        let p = dense.pressure(&u);
        let external = if detached { mean(&pressure) } else { report.mean_pressure };
        let rounding = 64.0 * epsilon * nodes.sqrt() * dense.stiffest * largest(&surface).max(largest(&gap))
            + 64.0 * epsilon * external.abs();
        for (found, p) in pressure.iter().zip(&p) {
            close("pressure", *found, p + external, rounding)?;
        }
        let work = mean_product(&u, &p);
        let surface_work = mean_product(&surface, &dense.pressure(&surface));
        let magnitude = surface_work
            + mean_product(
                &gap.iter().map(|g| g.abs()).collect::<Vec<_>>(),
                &vec![rounding / epsilon / 64.0; gap.len()],
            );
        // as far as the matrix itself is right
        let digits = largest(&surface).max(largest(&gap)).max(self.heights[[0, 0]].abs()) * f64::EPSILON;
        let by_matrix = (64.0 * nodes * digits + 64.0 * largest(&surface) * f64::EPSILON) * digits * dense.stiffest
            + 8.0 * f64::EPSILON * dense.stiffest * largest(&surface).powi(2);
        close("elastic energy", report.elastic_energy, 0.5 * work, 256.0 * epsilon * magnitude + by_matrix)?;
        let at = |f: &dyn Fn(T) -> T| -> Vec<f64> {
            solution.gap.iter().map(|&g| f(g.max(T::zero())).widen()).collect::<Vec<f64>>()
        };
        let (mut energies, tractions) = (at(&|g| law.energy(g)), at(&|g| law.traction(g)));
        let at_contact = law.traction(T::zero()).widen();
        energies.iter_mut().zip(&gap).for_each(|(e, g)| *e += at_contact * g.min(0.0));
        let adhesive = mean(&energies);
        let decay = largest(&gap) / law.range().widen().max(f64::MIN_POSITIVE);
        let exponent =
            64.0 * epsilon * (1.0 + decay.min(100.0)) * mean(&energies.iter().map(|e| e.abs()).collect::<Vec<_>>());
        close("adhesive energy", report.adhesive_energy, adhesive, exponent + T::min_positive_value().widen())?;

        // energies
        if self.settings.method == Method::Preconditioned && !detached {
            let size = history.iter().map(|i| i.energy.abs()).fold(magnitude.max(adhesive.abs()), f64::max);
            let same = |pair: &&[Iteration]| pair[0].round == pair[1].round;
            // in f64 the energy is summed of changes in f32
            let summed = (64.0 * epsilon).max(f64::from(f32::EPSILON));
            if !matches!(self.constraint, Constraint::Uzawa(_)) {
                for pair in history.windows(2).filter(same) {
                    let rise = pair[1].energy - pair[0].energy;
                    need(rise <= summed * size, format!("energy rises by {rise:e} of {size:e}"))?;
                }
            }
            if projects && let Some(last) = history.last().filter(|last| !last.smoothed) {
                let load = if let Control::MeanPressure(p) = self.control { p } else { 0.0 };
                let energy = 0.5 * work + adhesive + load * mean(&gap);
                let allowed =
                    (256.0 * epsilon).max(f64::from(f32::EPSILON)) * (size + magnitude + (load * mean(&gap)).abs());
                close("last energy", last.energy, energy, allowed + by_matrix)?;
            }
        }

        // the residual and what bounds the error
        let offset = if let Control::MeanPressure(p) = self.control { p } else { 0.0 };
        let springs = |i: usize| match constraint.wall() {
            Wall::Springs(springs) => springs.traction(i, solution.gap.iter().copied().nth(i).unwrap()).widen(),
            _ => 0.0,
        };
        let r: Vec<f64> =
            (0..gap.len()).map(|i| p[i] + tractions[i] + if detached { 0.0 } else { offset } + springs(i)).collect();
        let free: Vec<bool> = gap.iter().map(|&g| !projects || g > 0.0).collect();
        let apart = free.iter().filter(|f| **f).count() as f64;
        let sum = |keep: &dyn Fn(usize) -> bool| (0..r.len()).filter(|&i| keep(i)).map(|i| r[i]).sum::<f64>();
        let centred_control = detached || matches!(self.control, Control::MeanGap(_));
        let release = match (centred_control, apart > 0.0) {
            (false, _) => 0.0,
            (true, true) => sum(&|i| free[i]) / apart,
            (true, false) => r.iter().copied().fold(f64::INFINITY, f64::min),
        };
        let edge = rounding + 64.0 * epsilon * largest(&tractions);
        let clear = (0..r.len()).all(|i| free[i] || (r[i] - release).abs() > edge);
        let working: Vec<bool> = (0..r.len()).map(|i| free[i] || r[i] < release).collect();
        let count = working.iter().filter(|w| **w).count() as f64;
        let level = match centred_control {
            true if count > 0.0 && self.settings.method == Method::Preconditioned => sum(&|i| working[i]) / count,
            true => release,
            false => 0.0,
        };
        let residual: Vec<f64> = (0..r.len()).map(|i| if working[i] { r[i] - level } else { 0.0 }).collect();
        let certificate = dense.compliant(&residual);
        // without the cancellation of large sums that the product of the matrix has
        let work = if projects && report.contact_nodes > 0 { 2.0 * report.elastic_energy } else { work };
        let scale = if report.contact_nodes > 0 { work } else { work.max(surface_work) };
        let relative = (certificate / scale).sqrt();
        let noise = if dense.softest > 0.0 { edge / (dense.softest * scale).sqrt() } else { 0.0 };
        let uzawa = matches!(self.constraint, Constraint::Uzawa(_));
        let bounded = report.relative_error * (1.0 + 1e-3) + 4.0 * noise;
        let flats = surface_work <= 1e-20 * dense.stiffest * self.heights[[0, 0]].powi(2);
        if clear && !uzawa && !flats && scale > 0.0 && relative.is_finite() {
            need(relative <= bounded, format!("certificate {:e} is less than {relative:e}", report.relative_error))?;
            let allowed = 0.05 * relative + 8.0 * noise;
            let not_much = report.relative_error <= relative + allowed.max(self.settings.tolerance_in::<f64>())
                || work < 1e3 * epsilon * surface_work;
            need(not_much, format!("certificate {:e} is far more than {relative:e}", report.relative_error))?;
        }
        if report.status == Status::Converged && projects {
            // the balance of the load, and the elastic energy of the tractions that the fields carry
            let carried = mean(&contact) - mean(&tractions);
            let load = if let Control::MeanPressure(p) = self.control { p } else { report.mean_pressure };
            let size = load.abs().max(mean(&contact));
            let own = 64.0 * epsilon * mean(&contact).max(mean(&tractions));
            if let Control::MeanPressure(_) = self.control {
                close("carried load", carried, load, 1.01 * self.settings.tolerance_in::<f64>() * size + own)?;
            }
            let p: Vec<f64> = (0..contact.len()).map(|i| contact[i] - tractions[i] - carried).collect();
            let twice = dense.compliant(&p);
            if !flats && mean(&gap) > 0.0 && self.settings.method == Method::Preconditioned {
                let (reported, carried) = ((2.0 * report.elastic_energy).sqrt(), twice.sqrt());
                let floor = 4.0 * epsilon * magnitude.sqrt();
                let allowed = 1.01 * report.relative_error * scale.sqrt() + floor + epsilon.sqrt() * carried;
                let off = (reported - carried).abs();
                need(off <= allowed, format!("root of the work: {reported:e} is not {carried:e} (± {allowed:e})"))?;
            }
        }
        if report.status == Status::Converged {
            let good = report.relative_error <= self.settings.tolerance_in::<f64>()
                && report.load_error <= self.settings.tolerance_in::<f64>();
            need(good, format!("converged with {:e}, {:e}", report.relative_error, report.load_error))?;
        }

        // the exact solution without adhesion
        if self.law == Law::None && projects && !flats && !detached && mean(&gap) > 0.0 && scale > 0.0 {
            let guess: Vec<bool> = gap.iter().map(|g| *g == 0.0).collect();
            if let Some(exact) = dense.solve(&surface, Some(mean(&gap)), 0.0, &guess) {
                let y: Vec<f64> = gap.iter().zip(&exact).map(|(a, b)| a - b).collect();
                let truth = (mean_product(&y, &dense.pressure(&y)).max(0.0) / scale).sqrt();
                if report.status == Status::Converged {
                    // twice the claim, and what the elimination itself can tell
                    let own = 64.0 * f64::EPSILON * (dense.stiffest / scale).sqrt() * largest(&surface);
                    let twice = 2.0 * report.relative_error + own;
                    need(truth <= twice, format!("claims {:e} and is wrong by {truth:e}", report.relative_error))?;
                }
                need(
                    truth <= bounded,
                    format!("certificate {:e} below the true error {truth:e}", report.relative_error),
                )?;
            }
            let given = matches!(self.control, Control::MeanPressure(p) if p > 0.0);
            if given
                && report.status == Status::Converged
                && let Some(exact) = dense.solve(&surface, None, offset, &guess)
            {
                let span = largest(&surface);
                let allowed = (100.0 * self.settings.tolerance_in::<f64>() + 1e4 * epsilon) * span.max(mean(&exact));
                close("mean gap under the pressure", mean(&gap), mean(&exact), allowed)?;
            }
        }
        Ok(())
    }

    /// The work ⟨u, p⟩ of which rounding makes a share ε².
    fn rounded_work(&self, mean_gap: f64) -> f64 {
        let surface = centred(&self.heights);
        let dense = Dense::new(self.shape, self.lengths, self.modulus);
        let rms = mean_product(&surface, &surface).sqrt();
        mean_product(&surface, &dense.pressure(&surface)) + dense.stiffest * mean_gap * (mean_gap + rms)
    }

    /// Whether the scene has to be solved: it is convex, and its tolerance well above rounding.
    fn is_easy(&self) -> bool {
        let method = self.settings.method == Method::Preconditioned;
        // a plane far away falls under a load with nothing to measure its steps by
        let falls = self.is_plane() && self.start.is_some() && matches!(self.control, Control::MeanPressure(_));
        method
            && !falls
            && self.law == Law::None
            && self.constraint == Constraint::Projection
            && !self.single
            && self.settings.tolerance_in::<f64>() >= 1e-8
    }
}

fn centred(heights: &Array2<f64>) -> Vec<f64> {
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    heights.iter().map(|h| h - mean).collect()
}

fn variable(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

/// Light loads leave a displacement that is the small difference of heights and gap. The error of a gap in `f32`,
/// computed in `f64`, is no larger than certified where the solve has converged, and where it has stalled hardly larger
/// than that of the exact gap rounded to `f32`.
#[test]
fn f32_is_as_good_as_it_says_and_is_given_up_at_its_floor() {
    let (first, cases) = (variable("STRESS_FIRST").unwrap_or(0), variable("STRESS_CASES").unwrap_or(400));
    let (mut wrong, mut solved) = (Vec::new(), [0; 2]);
    for seed in first..first + cases {
        let scene = Scene::new(seed);
        let settings = Settings { tolerance: Some(1e-5), ..Settings::default() };
        let mut scene = Scene { law: Law::None, constraint: Constraint::Projection, settings, ..scene };
        if scene.is_plane() || matches!(scene.control, Control::MeanPressure(p) if p < 0.0) {
            continue;
        }
        let Ok(Solution { gap, report, .. }) = scene.solution::<f32>() else { continue };
        let reached = scene.certified(&gap.mapv(f64::from));
        let (said, load, iterations) = (report.relative_error, report.load_error, report.iterations);
        let what = format!(
            "{seed}: {:?} {} {:?} {} with {said:.1e}, {load:.1e} after {iterations}",
            scene.shape, scene.kind, scene.control, report.status
        );
        if report.status == Status::Converged && reached > 3.0 * (said + f64::from(f32::EPSILON)) {
            wrong.push(format!("{reached:.1e} in {what}"));
        }
        solved[usize::from(report.status == Status::Stalled)] += 1;
        // heights of few levels round alike, or not at all
        let levels = matches!(scene.kind, "step" | "board" | "levels");
        if report.status == Status::Stalled && said.is_finite() && !levels {
            scene.settings.tolerance = Some(1e-12);
            scene.start = None;
            let exact = scene.solution::<f64>().unwrap();
            let floor = scene.certified(&exact.gap.mapv(|g| f64::from(g as f32)));
            // the exact gap of a few nodes may happen to round to hardly any error
            let usual = f64::from(f32::EPSILON) * (scene.rounded_work(report.mean_gap) / report.elastic_energy).sqrt();
            if reached > 40.0 * floor.max(usual).max(f64::from(f32::EPSILON)) {
                wrong.push(format!("{reached:.1e}, and {floor:.1e} is possible, in {what}"));
            }
        }
    }
    let [converged, stalled] = solved;
    println!("{converged} converged, {stalled} stalled");
    wrong.iter().take(100).for_each(|wrong| println!("{wrong}"));
    assert!(wrong.is_empty() && converged > 2 * stalled, "{} of {cases} scenes are wrong", wrong.len());
}

#[test]
fn random_scenes_agree_with_dense_matrices() {
    let (first, cases) = (variable("STRESS_FIRST").unwrap_or(0), variable("STRESS_CASES").unwrap_or(400));
    let (mut wrong, mut ends): (Vec<String>, BTreeMap<String, (usize, usize)>) = Default::default();
    for seed in first..first + cases {
        let scene = Scene::new(seed);
        let start = scene.start.is_some();
        let Scene { shape, kind, law, constraint, control, settings, single, .. } = &scene;
        let what = format!(
            "{seed}: {shape:?} {kind} {law:?} {constraint:?} {control:?} start {start} {:?} {:.1e} f32 {single}",
            settings.method,
            settings.tolerance_in::<f64>()
        );
        let law = format!("{law:?}");
        let law = law.split('(').next().unwrap_or_default();
        match catch_unwind(AssertUnwindSafe(|| scene.run())) {
            Err(_) => wrong.push(format!("panic in {what}")),
            Ok(Err(reason)) => wrong.push(format!("{reason} in {what}")),
            Ok(Ok(report)) => {
                let (constraint, loose) = (format!("{constraint:?}"), settings.tolerance_in::<f64>() >= 1e-3);
                let constraint = constraint.split('(').next().unwrap_or_default();
                let (method, status) = (settings.method, report.status);
                let end = format!("{law} {constraint} {method:?} f32 {single} loose {loose} {status}");
                let end = ends.entry(end).or_default();
                *end = (end.0 + 1, end.1.max(report.iterations));
                let solved = matches!(report.status, Status::Converged | Status::Detached);
                // rounding of the heights and gaps, in the energy norm, which no iteration goes below
                let floor = f64::EPSILON * (scene.rounded_work(report.mean_gap) / report.elastic_energy).sqrt();
                let honest = status == Status::Stalled && report.relative_error < 40.0 * floor;
                if scene.is_easy() && !solved && !honest {
                    let (e, l, i) = (report.relative_error, report.load_error, report.iterations);
                    wrong.push(format!("{} with {e:.1e}, {l:.1e} after {i} in {what}", report.status));
                }
            }
        }
    }
    for (end, (count, iterations)) in ends {
        println!("{count:6} {end}, at most {iterations} iterations");
    }
    if cases == 1 {
        println!("{:#?}", Scene::new(first));
    }
    wrong.iter().take(100).for_each(|wrong| println!("{wrong}"));
    assert!(wrong.is_empty(), "{} of {cases} scenes are wrong", wrong.len());
}
