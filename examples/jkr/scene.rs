//! A random scene: a surface, a body, a work of adhesion and a load, and its solutions on grids from coarse to fine.

use std::f64::consts::PI;

use asperity::stability::ContactStiffness;
use asperity::{Amplitude, Boussinesq, Branch, Control, Grid, Jkr, Problem, Projection, SelfAffine, Status, Surface};
use common::Outcome;
use ndarray::Array2;

use crate::case::{Areas, half_space, pull_off, secant, solve, tension};

/// The side of the window of spheres of radius one.
const SIDE: f64 = 1.6;
/// The relative error of the contact stiffness.
const STIFFNESS: f64 = 1e-4;
/// The relative width of the bracket of the pull-off.
const BRACKET: f64 = 0.003;
/// The preload of the search for it, over E* times the rms slope.
const PRELOAD: f64 = 0.02;

/// Numbers drawn one after the other, by SplitMix64.
pub struct Draw(u64);

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x2545_f491_4f6c_dd1d))
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// From zero to one.
    pub fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Its logarithm is uniform.
    pub fn around(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.share())
    }
}

/// What is pressed.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    /// A rough surface on a periodic half-space.
    Periodic,
    /// A sphere of radius one on a free half-space, with roughness or without.
    Sphere,
}

/// A random scene.
pub struct Scene {
    pub kind: Kind,
    /// Nodes along a side of the grid with an estimated error.
    pub n: usize,
    /// Over n, the finest grid.
    pub finest: usize,
    pub roughness: Option<SelfAffine>,
    pub slope: f64,
    pub nodes_per_wave: f64,
    pub work_of_adhesion: f64,
    /// The mean pressure; where the gap is given, that under which it is found on the grid of n² nodes.
    pub pressure: f64,
    pub by_gap: bool,
    /// Whether its pull-off is found.
    pub pulls: bool,
}

impl Scene {
    /// The scenes of a seed.
    pub fn all(count: usize, seed: u64, quick: bool) -> Vec<Self> {
        let mut draw = Draw::new(seed);
        (0..count).map(|id| Self::drawn(&mut draw, id, quick)).collect()
    }

    fn drawn(draw: &mut Draw, id: usize, quick: bool) -> Self {
        let sphere = draw.share() < 0.15;
        let large = draw.share() < 0.2 && !sphere && !quick;
        let n = if large { 128 } else { 64 };
        let nodes_per_wave = draw.around(4.05, 16.0);
        let (k_l, hurst) = (draw.between(1.0, 2.0), draw.between(0.5, 0.9));
        let k_s = n as f64 / nodes_per_wave;
        let slope = if sphere { draw.around(0.02, 0.15) } else { draw.around(0.05, 1.0) };
        let adhesion = if sphere { draw.around(5e-4, 4e-3) } else { draw.around(1e-3, 5e-2) };
        let load = draw.share();
        let surface = SelfAffine::default().k_l(k_l).k_r(k_l).k_s(k_s).hurst(hurst).seed(draw.bits() >> 20);
        let smooth = sphere && draw.share() < 0.33;
        let by_gap = draw.share() < 0.3 && !sphere && load > 0.4;
        let (work_of_adhesion, pressure) = if sphere {
            (adhesion, (3.0 * (load - 0.5)).max(0.0) * 1.5 * PI * adhesion / (SIDE * SIDE))
        } else {
            let pressure = if load < 0.2 { 0.0 } else { 1e-3 * 50_f64.powf((load - 0.2) / 0.8) };
            // the work of adhesion in units of E* h'² times the shortest wave
            (adhesion * slope * slope / k_s, pressure * slope)
        };
        Self {
            kind: if sphere { Kind::Sphere } else { Kind::Periodic },
            n,
            finest: if sphere || large || quick { 4 } else { 8 },
            roughness: (!smooth).then(|| surface.amplitude(Amplitude::RmsSlope(slope))),
            slope,
            nodes_per_wave,
            work_of_adhesion,
            pressure,
            by_gap,
            pulls: id % 10 < 3,
        }
    }

    /// Whether the shortest wave has at least four nodes on a grid.
    pub fn resolves(&self, n: usize) -> bool {
        self.roughness.is_none() || self.nodes_per_wave * n as f64 >= 4.0 * self.n as f64
    }

    fn side(&self) -> f64 {
        if self.kind == Kind::Sphere { SIDE } else { 1.0 }
    }

    /// The surface on a grid; on a coarser grid than n² nodes it has every second node of the n² nodes.
    fn surface(&self, n: usize) -> Outcome<Surface> {
        let fine = n.max(self.n);
        let grid = Grid::square(fine, self.side())?;
        let mut surface = match self.kind {
            Kind::Sphere => Surface::paraboloid(grid, 1.0)?,
            Kind::Periodic => Surface::from_fn(grid, |_, _| 0.0)?,
        };
        if let Some(roughness) = self.roughness {
            surface = Surface::new(grid, surface.heights() + roughness.surface(grid)?.heights())?;
        }
        let step = fine / n;
        let heights = Array2::from_shape_fn((n, n), |(i, j)| surface.heights()[[step * i, step * j]]);
        Ok(Surface::new(Grid::square(n, self.side())?, heights)?)
    }

    /// The solutions on grids from half the nodes along the sides on, the coarsest first.
    pub fn levels(&self) -> Outcome<Vec<Level>> {
        let mut control = Control::MeanPressure(self.pressure);
        if self.by_gap {
            control = Control::MeanGap(self.level(self.n, control)?.gap);
        }
        let sizes = (0..).map(|doubled| (self.n / 2) << doubled).take_while(|&n| n <= self.finest * self.n);
        sizes.map(|n| self.level(n, control)).collect()
    }

    fn level(&self, n: usize, control: Control) -> Outcome<Level> {
        let (surface, law) = (self.surface(n)?, Jkr::new(self.work_of_adhesion)?);
        let grid = *surface.grid();
        let mut problem = match self.kind {
            Kind::Periodic => Problem::new(&surface, half_space(grid)?, law)?,
            Kind::Sphere => Problem::new(&surface, Boussinesq::new(grid, 1.0)?, law)?,
        };
        let [loading, unloading] =
            [Branch::Loading, Branch::Unloading].map(|branch| solve(&mut problem, control, branch));
        let (loading, unloading) = (loading?, unloading?);
        let stiffness = ContactStiffness::of_constrained(&mut problem, &Projection, &loading, STIFFNESS)?;
        let preload = if self.kind == Kind::Sphere { self.pressure } else { PRELOAD * self.slope };
        let secant = secant(&mut problem, &loading)?;
        let pulled = self.pulls.then(|| pull_off(&mut problem, BRACKET, Some(preload))).transpose();
        // surfaces that do not attract each other under no load have no pull-off
        let pulled = pulled.ok().flatten();
        let report = &loading.report;
        Ok(Level {
            n: loading.grid.shape().0,
            rms_height: surface.rms_height(),
            areas: Areas::of(&loading)?,
            unloading: Areas::of(&unloading)?,
            statuses: [report.status, unloading.report.status],
            gap: report.mean_gap,
            approach: report.approach.unwrap_or(f64::NAN),
            pressure: report.mean_pressure,
            contact_pressure: report.mean_contact_pressure,
            elastic_energy: report.elastic_energy,
            stiffness: stiffness.pressure_per_length,
            secant,
            lost: pulled.as_ref().map(|found| Areas::of(&found.solution)).transpose()?,
            pull_off: pulled.as_ref().map_or(f64::NAN, tension),
            pulled: pulled.as_ref().is_some_and(|found| found.reached),
            applications: [
                report.operator_applications,
                unloading.report.operator_applications,
                stiffness.operator_applications,
                pulled.as_ref().map_or(0, |found| found.operator_applications),
            ],
        })
    }
}

/// What is found on a grid.
#[derive(Clone, Copy)]
pub struct Level {
    pub n: usize,
    pub rms_height: f64,
    pub areas: Areas,
    pub unloading: Areas,
    pub statuses: [Status; 2],
    pub gap: f64,
    pub approach: f64,
    pub pressure: f64,
    pub contact_pressure: f64,
    pub elastic_energy: f64,
    pub stiffness: f64,
    /// The stiffness between two loads.
    pub secant: f64,
    /// The areas under the greatest tension that was borne.
    pub lost: Option<Areas>,
    /// The mean tension; not a number where it was not asked for, or not found.
    pub pull_off: f64,
    pub pulled: bool,
    /// Of loading, unloading, stiffness, and pull-off.
    pub applications: [usize; 4],
}
