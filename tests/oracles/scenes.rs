//! Random small scenes: every body, law, wall, control, start and precision of the library, each from a seed.
//!
//! [`Scene::new`] draws from all of them, [`Scene::with_features`] from those that [`Features`] name.

mod features;
mod law;
mod layers;
mod relief;

use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

use asperity::adhesion::{CutOff, Varying};
use asperity::elastic::{self, Base, Coating, HalfSpace, Layer, Material, Series};
use asperity::solver::Iteration;
use asperity::*;
use asperity_maps::surface_with_absent;
use ndarray::Array2;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

pub use features::Features;
pub use law::Law;
use law::law;
pub use layers::Layered;
use relief::{grid, punch, relief};

use super::dense::{Dense, Held};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    None,
    Exponential,
    MaugisDugdale,
    LennardJones,
    Morse,
    PowerLaw,
    Table,
    /// one of the others, cut off
    CutOff,
    /// one of the others with a work of adhesion that varies over the surface, cut off or not
    Varying,
    /// the law that has the range of the grid; not among [`Features::ALL`]
    Jkr,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Constraint {
    Hard,
    /// a hard wall by Algorithm 3 of the paper
    Paper,
    Penalty,
    Uzawa,
    /// the law alone keeps the surfaces apart
    None,
    /// a wall that yields; not among [`Features::ALL`]
    Hardness,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Precision {
    Single,
    /// `f64`
    Double,
    /// `f64` with corrections in `f32`
    Mixed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    Periodic,
    Free,
}

/// A scene: all that a solve is told.
#[derive(Clone, Debug)]
pub struct Scene {
    pub seed: u64,
    pub grid: Grid,
    pub body: Body,
    /// of the periodic body, if it is no half-space
    pub layers: Option<Layered>,
    pub modulus: f64,
    /// the shape of the surface by name
    pub relief: &'static str,
    /// NaN where the surface is absent
    pub heights: Array2<f64>,
    pub law: Law,
    pub constraint: Constraint,
    /// of the springs of a wall
    pub stiffness: f64,
    /// the most that a wall bears, at which it yields
    pub hardness: f64,
    pub control: Control,
    pub start: Option<Array2<f64>>,
    pub settings: Settings,
    pub precision: Precision,
}

impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seed, body, law, constraint, control, settings, precision, .. } = self;
        let (kind, base, tolerance) = (law.kind, law.base, settings.tolerance.unwrap_or_default());
        let (shape, absent) = (self.grid.shape(), self.heights.iter().filter(|h| h.is_nan()).count());
        write!(
            f,
            "scene {seed}: {body:?} {shape:?} without {absent}, {}, {kind:?} ({base:?}), {constraint:?}",
            self.relief
        )?;
        let start = if self.start.is_some() { ", with a start" } else { "" };
        write!(f, ", {control:?}, {precision:?} to {tolerance:.1e}{start}, {:?}", self.physics())
    }
}

impl Scene {
    /// One of all scenes.
    pub fn new(seed: u64) -> Self {
        Self::with_features(seed, &Features::ALL)
    }

    /// One of those with certain features: the seeds go through the combinations of law, wall and precision.
    pub fn with_features(seed: u64, features: &Features) -> Self {
        let combinations = features.combinations();
        let (kind, constraint, precision) = combinations[(seed % combinations.len() as u64) as usize];
        let random = &mut ChaCha8Rng::seed_from_u64(seed);
        let body = features.bodies[random.random_range(0..features.bodies.len())];
        // the paper's method knows periodic cells without absent nodes
        let body = if constraint == Constraint::Paper { Body::Periodic } else { body };
        let holes = features.absent && constraint != Constraint::Paper && random.random_bool(0.3);
        let grid = grid(random, body);
        let modulus = power(random, -3.0, 12.0);
        let layered = features.more && body == Body::Periodic && random.random_bool(0.6);
        let layers = layered.then(|| Layered::draw(random, grid.lengths().0.max(grid.lengths().1), modulus));
        let modulus = layers.map_or(modulus, |layers| elastic::Body::modulus_on(&layers, &grid));
        let height = power(random, -6.0, 0.5) * grid.lengths().0;
        let (relief, mut heights) = relief(random, grid.shape());
        heights.mapv_inplace(|h| h * height);
        if holes {
            punch(random, &mut heights);
        }
        let spacing = grid.spacing().0.max(grid.spacing().1);
        let range = height * power(random, -2.0, 1.0);
        let mut law = law(random, kind, constraint, grid.shape(), (range, modulus / spacing));
        if features.more && law.ends() {
            law.range = height * power(random, -2.0, 0.0);
            law.work = law.range.powi(2) * modulus / spacing * power(random, -3.5, 0.0);
            law.cut_off = law.cut_off.map(|_| law.range * random.random_range(2.0..10.0));
        }
        if law.base == Kind::Jkr {
            // there is none across a line
            let spacing = match (grid.shape(), grid.spacing()) {
                ((_, 1), (dx, _)) => dx,
                ((1, _), (_, dy)) => dy,
                (_, (dx, dy)) => dx.max(dy),
            };
            law.range = law.range_on(spacing / modulus);
        }
        let stiffness = modulus / spacing * power(random, -0.5, 3.0);
        let tolerance = power(random, -9.0, -2.0);
        let tolerance = if precision == Precision::Single { tolerance.max(1e-5) } else { tolerance };
        let settings = match constraint {
            Constraint::Paper => Settings::rey2017(),
            _ => Settings::default(),
        };
        let settings = settings.tolerance(tolerance);
        let control = Control::MeanGap(0.0);
        let mut scene = Self {
            seed,
            grid,
            body,
            layers,
            modulus,
            relief,
            heights,
            law,
            constraint,
            stiffness,
            hardness: f64::INFINITY,
            control,
            start: None,
            settings,
            precision,
        };
        scene.control = scene.load(random, height);
        scene.start = scene.begin(random, height);
        if features.more {
            scene.add(random, height);
        }
        scene
    }

    /// A tension of a law that ends, no load on a branch, and the hardness of a wall.
    fn add(&mut self, random: &mut ChaCha8Rng, height: f64) {
        let (tension, unloaded) = (random.random_bool(0.3), random.random_bool(0.15));
        let branch = if random.random_bool(0.5) { Branch::Loading } else { Branch::Unloading };
        if tension && self.law.ends() {
            self.control = Control::MeanPressure(-self.law.work / self.law.range * power(random, -4.0, 0.0));
        }
        if unloaded && !self.law.is_none() {
            (self.control, self.start) = (Control::MeanPressure(0.0), None);
            self.settings = self.settings.branch(branch);
        }
        if self.constraint == Constraint::Hardness {
            let (nodes, facing) = (self.heights.len() as f64, self.centred().len() as f64);
            let pressure = match self.held(&self.dense()) {
                Held::Pressure(pressure) => pressure.max(0.0) * nodes / facing,
                _ => 0.0,
            };
            let least = self.law.boxed::<f64>().traction(0.0) + pressure;
            self.hardness = least * (1.0 + power(random, -2.0, 1.0)) + self.flat(height) * power(random, -3.0, 0.3);
        }
    }

    /// What a scene has and the scenes of [`Features::ALL`] lack; for a wall that yields, the wall alone.
    pub fn physics(&self) -> Vec<&'static str> {
        if self.constraint == Constraint::Hardness {
            return vec![if self.law.is_none() { "hardness" } else { "hardness with adhesion" }];
        }
        let unloaded = matches!(self.control, Control::MeanPressure(0.0));
        let found = [
            ("layer", matches!(self.layers, Some(Layered::Layer(_)))),
            ("coating", matches!(self.layers, Some(Layered::Coating(_)))),
            ("pair", matches!(self.layers, Some(Layered::Pair(_)))),
            ("law that ends", self.law.ends()),
            ("no load, loading", unloaded && self.settings.branch == Some(Branch::Loading)),
            ("no load, unloading", unloaded && self.settings.branch == Some(Branch::Unloading)),
        ];
        found.into_iter().filter(|(_, has)| *has).map(|(name, _)| name).collect()
    }

    pub fn is_whole(&self) -> bool {
        self.body == Body::Periodic && !self.heights.iter().any(|h| h.is_nan())
    }

    /// Whether all heights are the same.
    pub fn is_flat(&self) -> bool {
        let largest = |heights: &[f64]| heights.iter().fold(0.0_f64, |most, h| most.max(h.abs()));
        largest(&self.centred()) <= 1e-12 * largest(&self.heights.iter().copied().collect::<Vec<_>>())
    }

    /// The pressure about which a surface of some height is pressed flat.
    fn flat(&self, height: f64) -> f64 {
        let ((nx, ny), (dx, dy)) = (self.grid.shape(), self.grid.spacing());
        let slope = |(i, j): (usize, usize), (k, l): (usize, usize), length: f64| {
            (self.heights[[i, j]] - self.heights[[k, l]]).abs() / length
        };
        let nodes = (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j)));
        let slopes = nodes.flat_map(|(i, j)| {
            [slope((i, j), ((i + 1) % nx, j), dx), slope((i, j), (i, (j + 1) % ny), dy)].map(|s| s.max(0.0))
        });
        let steep = 0.5 * self.modulus * slopes.fold(0.0, f64::max);
        steep.max(1e-3 * self.modulus * height / self.grid.lengths().0)
    }

    fn load(&self, random: &mut ChaCha8Rng, height: f64) -> Control {
        let Law { work, range, .. } = self.law;
        let area = self.grid.lengths().0 * self.grid.lengths().1;
        let tension = random.random_bool(if self.law.is_none() { 0.03 } else { 0.3 });
        let flat = self.flat(height);
        let share = power(random, -6.0, 0.7);
        let pressure = match tension {
            true if self.law.is_none() => -flat * share,
            true => -work / range * share.powf(0.3),
            false => flat * share,
        };
        // down to a contact of one node and beyond
        let exponent = random.random_range(-14.0..1.0);
        let light = random.random_bool(0.25);
        let pressure = if light { pressure.signum() * self.modulus * 10_f64.powf(exponent) } else { pressure };
        let (rest, stiffness) = (self.law.rest(), self.modulus * area.sqrt() * power(random, -3.0, 2.0));
        let gap = if random.random_bool(0.02) { rest } else { rest + height * share };
        let deep = height * random.random_range(-0.2..0.5) * if light { 1e-3 } else { 1.0 } - rest;
        let approach = if tension { -range * random.random_range(0.0..3.0) - rest } else { deep };
        let force = pressure * area;
        match (self.body, self.is_whole(), random.random_range(0..8)) {
            (Body::Periodic, true, 0..4) => Control::MeanGap(gap),
            (Body::Periodic, true, 4) if self.constraint != Constraint::Paper => {
                Control::Spring { stiffness, rest: gap - force / stiffness }
            }
            (Body::Free, _, 0..3) => Control::Approach(approach),
            (Body::Free, _, 3..5) => Control::Spring { stiffness, rest: approach + force / stiffness },
            (_, _, 5) => Control::Force(force),
            _ => Control::MeanPressure(pressure),
        }
    }

    fn begin(&self, random: &mut ChaCha8Rng, height: f64) -> Option<Array2<f64>> {
        let (shape, rest) = (self.grid.shape(), self.law.rest());
        let level = self.heights.mapv(|h| if h.is_nan() { 0.0 } else { h });
        match random.random_range(0..6) {
            0 => Some(Array2::from_shape_simple_fn(shape, || rest + height * random.random_range(0.0..1.0))),
            1 => Some(Array2::from_elem(shape, rest)),
            2 => Some(level.mapv(|h| rest + (0.3 * height - h).max(0.0))),
            _ => None,
        }
    }

    pub fn surface(&self) -> Surface {
        surface_with_absent(self.grid, self.heights.clone()).unwrap()
    }

    pub fn operator<T: Real>(&self) -> Box<dyn ElasticOperator<T>> {
        let single = self.precision != Precision::Double;
        let boxed = |mut operator: Box<dyn ElasticOperator<T>>| {
            operator.spectral().into_iter().for_each(|spectral| spectral.set_single(single));
            operator
        };
        match (self.body, self.layers) {
            (Body::Periodic, Some(layers)) => boxed(Box::new(Spectral::<T>::of(self.grid, layers).unwrap())),
            (Body::Periodic, None) => boxed(Box::new(Westergaard::<T>::new(self.grid, self.modulus).unwrap())),
            (Body::Free, _) => boxed(Box::new(Boussinesq::<T>::new(self.grid, self.modulus).unwrap())),
        }
    }

    pub fn problem<T: Real>(&self) -> Result<Problem<T>> {
        Problem::new(&self.surface(), self.operator(), self.law.boxed())
    }

    pub fn start_in<T: Real>(&self) -> Option<Array2<T>> {
        self.start.as_ref().map(|start| start.mapv(T::lit))
    }

    /// The solution by a rigid wall or one that yields, or none where the law keeps the surfaces apart.
    pub fn solution<T: Real>(&self) -> Result<Solution<T>> {
        let (mut problem, start) = (self.problem()?, self.start_in());
        let start = start.as_ref().map_or(Start::Default, |gap| Start::From(gap));
        let go_on = |_: &Iteration| std::ops::ControlFlow::Continue(());
        match self.constraint {
            Constraint::None => {
                let mut solver = Solver { settings: self.settings, constraint: NoWall };
                solver.solve_with(&mut problem, self.control, start, go_on)
            }
            Constraint::Hardness => {
                let mut solver = Solver { settings: self.settings, constraint: Hardness::new(self.hardness)? };
                solver.solve_with(&mut problem, self.control, start, go_on)
            }
            _ => Solver::new(self.settings).solve_with(&mut problem, self.control, start, go_on),
        }
    }

    /// The elastic body as a matrix between the nodes that face it.
    pub fn dense(&self) -> Dense {
        let faces: Vec<bool> = self.heights.iter().map(|h| !h.is_nan()).collect();
        let (shape, lengths) = (self.grid.shape(), self.grid.lengths());
        match (self.body, self.layers) {
            (Body::Periodic, Some(layers)) => {
                Dense::from_stiffness(shape, lengths, |qx, qy| elastic::Body::stiffness(&layers, qx, qy))
            }
            (Body::Periodic, None) => Dense::new(shape, lengths, self.modulus),
            (Body::Free, _) => Dense::free(&self.grid, self.modulus),
        }
        .facing(&faces)
    }

    /// The heights at the nodes that face the body, less their mean.
    pub fn centred(&self) -> Vec<f64> {
        let faces: Vec<f64> = self.heights.iter().copied().filter(|h| !h.is_nan()).collect();
        let mean = faces.iter().sum::<f64>() / faces.len() as f64;
        faces.iter().map(|h| h - mean).collect()
    }

    /// What holds the displacement of a dense body: the gap and the [centred](Self::centred) heights.
    pub fn held(&self, dense: &Dense) -> Held {
        let (heights, (lx, ly)) = (self.centred(), self.grid.lengths());
        let top = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let in_series = |stiffness: f64| 1.0 / (1.0 / stiffness + 1.0 / dense.rigid);
        match self.control {
            Control::MeanGap(gap) => Held::Shift(gap),
            Control::MeanPressure(pressure) => Held::Pressure(pressure),
            Control::Force(force) => Held::Pressure(force / (lx * ly)),
            Control::Approach(approach) => Held::Spring { stiffness: dense.rigid, rest: top - approach },
            Control::Spring { stiffness, rest } => {
                let rest = if self.body == Body::Free { top - rest } else { rest };
                Held::Spring { stiffness: in_series(stiffness / (lx * ly)), rest }
            }
            other => panic!("{other:?} is not a load of these scenes"),
        }
    }

    /// The same with a law so weak that the energy is convex: half of what the softest wave resists.
    pub fn convex(mut self) -> Self {
        if !self.law.is_none() {
            let (law, length) = (self.law.of_gap::<f64>(), 4.0 * self.law.range);
            let steepest = (0..4000).map(|i| -law.slope(self.law.rest() + length * f64::from(i) / 4000.0));
            self.law.work *= 0.5 * self.dense().softest / steepest.fold(0.0, f64::max);
        }
        self
    }
}

fn power(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    10_f64.powf(random.random_range(low..high))
}
