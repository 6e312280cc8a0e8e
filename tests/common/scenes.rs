//! Random scenes to hold one way of keeping the surfaces apart against another.

use asperity::*;
use ndarray::Array2;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

#[derive(Clone, Copy, Debug)]
pub enum Law {
    None,
    Exponential(f64, f64),
    MaugisDugdale(f64, f64),
}

/// A scene on the unit square, or beside it, of a half-space of unit modulus.
#[derive(Clone, Debug)]
pub struct Scene {
    pub surface: Surface,
    pub law: Law,
    pub control: Control,
    /// of the springs; in units of the shortest wave's, or of E*/L
    pub stiffness: f64,
    pub of_waves: bool,
    pub tolerance: f64,
    pub single: bool,
}

impl Scene {
    /// Rough, random, spherical, wavy and stepped surfaces of 8² to 48² nodes, or long and narrow; nearly apart to
    /// nearly flat; half of them hard walls.
    pub fn new(seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let n = [8, 12, 16, 24, 32, 48][random.random_range(0..6)];
        let ny = if random.random_bool(0.3) { [1, 2, 5, 9][random.random_range(0..4)] } else { n };
        let mut power = |low: f64, high: f64| 10_f64.powf(random.random_range(low..high));
        let aspect = if ny == n { 1.0 } else { power(-1.0, 1.0) };
        let (rms, rho, mu) = (power(-3.0, -0.7), power(-2.0, 0.3), power(-1.5, 0.3));
        let (gap, load, stiff) = (power(-4.0, 0.5), power(-5.0, 0.3), power(0.0, 3.0));
        let (double_tolerance, single_tolerance) = (power(-8.0, -3.0), power(-4.5, -3.0));
        let grid = Grid::new((n, ny), (1.0, aspect)).unwrap();
        let kind = random.random_range(0..6);
        let shape = match kind {
            0 | 1 if ny == n => {
                let k_s = (n / 2) as f64 / 1.01;
                let surface = SelfAffine { k_l: 1.0, k_r: 2.0, k_s, random_phase: true, seed, ..SelfAffine::default() };
                surface.surface(grid).unwrap().heights().clone()
            }
            2 => Surface::paraboloid(grid, 1.0).unwrap().heights().clone(),
            3 if ny > 4 => Surface::wave_2d(grid, 1.0, 1 + random.random_range(0..2)).unwrap().heights().clone(),
            4 => Array2::from_shape_fn((n, ny), |(i, _)| f64::from(u8::from(2 * i < n))),
            _ => Array2::from_shape_fn((n, ny), |_| random.random_range(0.0..1.0)),
        };
        let mean = shape.mean().unwrap();
        let size = shape.mapv(|h| (h - mean).powi(2)).mean().unwrap().sqrt();
        let surface = Surface::new(grid, shape.mapv(|h| (h - mean) / size * rms)).unwrap();
        let rho = rho * rms;
        let w = (mu * rho).powi(2) * n as f64;
        let law = match random.random_range(0..4) {
            0 | 1 => Law::None,
            2 => Law::Exponential(w, rho),
            _ => Law::MaugisDugdale(w, rho),
        };
        let control = match random.random_range(0..8) {
            0..4 => Control::MeanGap(rms * gap),
            4 if !matches!(law, Law::None) => Control::MeanPressure(-w / rho * load.sqrt()),
            _ => Control::MeanPressure(3.0 * rms * load * n as f64),
        };
        let (of_waves, single) = (random.random_bool(0.5), random.random_bool(0.3));
        let tolerance = if single { single_tolerance } else { double_tolerance };
        Self { surface, law, control, stiffness: stiff, of_waves, tolerance, single }
    }

    pub fn problem<T: Real>(&self) -> Problem<T, Westergaard<T>, Box<dyn AdhesionLaw<T>>> {
        let law: Box<dyn AdhesionLaw<T>> = match self.law {
            Law::None => Box::new(NoAdhesion),
            Law::Exponential(w, rho) => Box::new(Exponential::new(w, rho).unwrap()),
            Law::MaugisDugdale(w, rho) => Box::new(MaugisDugdale::new(w, rho).unwrap()),
        };
        Problem::new(&self.surface, Westergaard::new(*self.surface.grid(), 1.0).unwrap(), law).unwrap()
    }

    /// By projection, and by Uzawa, which took so many rounds.
    pub fn solve<T: Real>(&self) -> (Solution<T>, Solution<T>, usize) {
        let mut problem = self.problem::<T>();
        let settings = Settings { tolerance: Some(self.tolerance), ..Settings::default() };
        let projected = Solver::new(settings).solve(&mut problem, self.control).unwrap();
        let unit = if self.of_waves { problem.operator().stiffness_range().1 } else { 1.0 };
        let mut solver = Solver { settings, constraint: Uzawa::new(self.stiffness * unit).unwrap() };
        let solution = solver.solve(&mut problem, self.control).unwrap();
        (projected, solution, solver.constraint.rounds())
    }
}
