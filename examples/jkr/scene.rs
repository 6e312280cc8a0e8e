//! Random scenes of kinds: a surface, a body, a work of adhesion and a load, and their solutions.

use std::f64::consts::PI;

use asperity::accuracy::{Accuracy, AccuratePullOff, GridError, Quantity};
use asperity::adhesion::{Formula, Varying};
use asperity::nested::Level;
use asperity::{
    Amplitude, Boussinesq, Control, ElasticOperator, Grid, Jkr, Nested, PullOff, Result, SelfAffine, Settings, Solver,
    Surface, Westergaard,
};
use common::Outcome;
use ndarray::Array2;

use crate::case::TOLERANCE;

/// The relative width of the bracket of a pull-off.
pub const BRACKET: f64 = 3e-3;

/// Asks for the error of the given grid.
pub fn on_grid() -> Accuracy {
    Accuracy::new(f64::INFINITY, Quantity::Area)
}

/// The side of the window of spheres of radius one.
pub const SIDE: f64 = 1.6;

/// Numbers drawn one after the other, by SplitMix64.
pub struct Draw(u64);

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x2545_f491_4f6c_dd1d))
    }

    /// From zero to one.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        (bits >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, (low, high): (f64, f64)) -> f64 {
        low + (high - low) * self.share()
    }

    /// A number with a uniform logarithm.
    fn around(&mut self, (low, high): (f64, f64)) -> f64 {
        low * (high / low).powf(self.share())
    }
}

/// What is special about the body of a kind of scenes.
#[derive(Clone, Copy, PartialEq)]
enum Shape {
    Rough,
    OneWay,
    LongCells,
    Lattice,
    Ridges,
    Sphere,
    WeakSphere,
    RoughSphere,
    Ellipsoid,
    SphereToEdge,
}

/// A kind of scenes.
#[derive(Clone, Copy)]
pub struct Kind {
    pub name: &'static str,
    shape: Shape,
    hurst: f64,
    /// Ends of the work of adhesion in units of E* h'² times the shortest wave, and of the load in units of E* h'.
    work: (f64, f64),
    load: (f64, f64),
    by_gap: bool,
    patches: bool,
}

const ROUGH: Kind = Kind {
    name: "rough, H 0.8",
    shape: Shape::Rough,
    hurst: 0.8,
    work: (1e-3, 2e-2),
    load: (3e-3, 0.1),
    by_gap: false,
    patches: false,
};

pub const KINDS: [Kind; 18] = [
    ROUGH,
    Kind { name: "rough, H 0.3", hurst: 0.3, ..ROUGH },
    Kind { name: "rough, one way", shape: Shape::OneWay, ..ROUGH },
    Kind { name: "rough, cells 2:1", shape: Shape::LongCells, ..ROUGH },
    Kind { name: "rough, strong adhesion", work: (0.02, 0.1), ..ROUGH },
    Kind { name: "rough, weak adhesion", work: (1e-6, 1e-4), ..ROUGH },
    Kind { name: "rough, next to none", work: (1e-12, 1e-7), ..ROUGH },
    Kind { name: "rough, light load", load: (3e-4, 3e-3), ..ROUGH },
    Kind { name: "rough, nearly closed", load: (0.4, 0.9), ..ROUGH },
    Kind { name: "rough, given gap", by_gap: true, ..ROUGH },
    Kind { name: "rough, map of w", patches: true, ..ROUGH },
    Kind { name: "lattice", shape: Shape::Lattice, ..ROUGH },
    Kind { name: "ridges", shape: Shape::Ridges, ..ROUGH },
    Kind { name: "sphere", shape: Shape::Sphere, ..ROUGH },
    Kind { name: "sphere, weak adhesion", shape: Shape::WeakSphere, ..ROUGH },
    Kind { name: "rough sphere", shape: Shape::RoughSphere, ..ROUGH },
    Kind { name: "ellipsoid", shape: Shape::Ellipsoid, ..ROUGH },
    Kind { name: "sphere to the edge", shape: Shape::SphereToEdge, ..ROUGH },
];

type Heights = Box<dyn Fn(Grid) -> Result<Surface>>;

/// The errors that the library tells of quantities.
type Errors = Vec<(Quantity, Option<GridError>)>;

/// A scene of a kind.
pub struct Scene {
    pub n: usize,
    lengths: (f64, f64),
    /// The nodes along y over those along x.
    aspect: f64,
    heights: Heights,
    pub free: bool,
    pub work: f64,
    /// Whether the work of adhesion varies by squares of an eighth of the side.
    patches: bool,
    pub pressure: f64,
    pub by_gap: bool,
}

impl Scene {
    pub fn drawn(kind: &Kind, draw: &mut Draw) -> Self {
        let n = 64;
        let (seed, nodes_per_wave) = ((draw.share() * 1e9) as u64, draw.around((8.0, 16.0)));
        let (slope, k_l) = (draw.around((0.05, 1.0)), draw.between((1.0, 2.0)));
        let (work, load, k_s) = (draw.around(kind.work), draw.around(kind.load), n as f64 / nodes_per_wave);
        let roughness = SelfAffine::default().k_l(k_l).k_r(k_l).k_s(k_s).hurst(kind.hurst).seed(seed);
        let rough = roughness.amplitude(Amplitude::RmsSlope(slope));
        let scene = Self {
            n,
            lengths: (1.0, 1.0),
            aspect: 1.0,
            heights: Box::new(move |grid| rough.surface(grid)),
            free: false,
            work: work * slope * slope / k_s,
            patches: kind.patches,
            pressure: load * slope,
            by_gap: kind.by_gap,
        };
        match kind.shape {
            Shape::Rough => scene,
            Shape::OneWay => {
                let heights: Heights = Box::new(move |grid| {
                    // the surface of a square, longer along y
                    let square = rough.surface(Grid::new(grid.shape(), (1.0, 1.0))?)?;
                    Surface::new(grid, square.heights().clone())
                });
                Self { lengths: (1.0, draw.between((3.0, 6.0))), heights, ..scene }
            }
            Shape::LongCells => Self { aspect: 0.5, ..scene },
            Shape::Lattice => {
                let periods = 1 + (3.0 * draw.share()) as usize;
                let amplitude = slope / (2.0 * PI * periods as f64);
                let heights: Heights = Box::new(move |grid| Surface::wave_2d(grid, amplitude, periods));
                Self { work: work * slope * slope / periods as f64, heights, ..scene }
            }
            Shape::Ridges => {
                let [a, b] = [(0.3, 1.0), (0.0, 0.5)].map(|ends| draw.between(ends));
                let phase = draw.between((0.0, 6.0));
                let heights: Heights = Box::new(move |grid| {
                    let (lx, _) = grid.lengths();
                    Surface::from_fn(grid, |x, _| {
                        let x = 2.0 * PI * x / lx;
                        slope / (2.0 * PI) * (a * x.cos() + b * (3.0 * x + phase).cos() / 3.0)
                    })
                });
                Self { work: 0.3 * work * slope * slope, heights, ..scene }
            }
            shape => scene.ball(shape, roughness, draw),
        }
    }

    /// A sphere, or an ellipsoid, on a free half-space.
    fn ball(self, shape: Shape, roughness: SelfAffine, draw: &mut Draw) -> Self {
        let (weak, edge) = (shape == Shape::WeakSphere, shape == Shape::SphereToEdge);
        let work = draw.around(if weak { (1e-12, 1e-6) } else { (3e-5, 4e-3) });
        let ratio = if shape == Shape::Ellipsoid { draw.between((1.3, 3.0)) } else { 1.0 };
        let [x0, y0] = [(); 2].map(|()| draw.between((-0.5, 0.5)) * SIDE / 32.0);
        let rough = (shape == Shape::RoughSphere).then(|| {
            let roughness = roughness.k_s(32.0 / draw.between((4.0, 8.0)));
            roughness.amplitude(Amplitude::RmsSlope(draw.around((0.02, 0.1))))
        });
        let pressure = (3.0 * (draw.share() - 0.5)).max(0.1) * 1.5 * PI * work / (SIDE * SIDE);
        let shift = if edge { 0.25 * SIDE } else { 0.0 };
        Self {
            n: 32,
            lengths: if edge { (0.5 * SIDE, SIDE) } else { (SIDE, SIDE) },
            aspect: if edge { 2.0 } else { 1.0 },
            free: true,
            work,
            pressure: if edge || weak { pressure + draw.around((1e-3, 0.1)) } else { pressure },
            heights: Box::new(move |grid| {
                // cells, not nodes, keep their places
                let (dx, dy) = grid.spacing();
                let [ox, oy] = [0.5 * dx - x0, 0.5 * dy - y0];
                let body = Surface::from_fn(grid, |x, y| -0.5 * ((x + ox - shift).powi(2) + (y + oy).powi(2) / ratio))?;
                match &rough {
                    None => Ok(body),
                    Some(rough) => Surface::new(grid, body.heights() + rough.surface(grid)?.heights()),
                }
            }),
            ..self
        }
    }

    fn surface(&self, finer: usize) -> Result<Surface> {
        let nx = finer * self.n;
        (self.heights)(Grid::new((nx, (nx as f64 * self.aspect) as usize), self.lengths)?)
    }

    fn law(&self, grid: &Grid) -> Result<Formula> {
        let law: Formula = Jkr::new(self.work)?.into();
        if !self.patches {
            return Ok(law);
        }
        let (nx, ny) = grid.shape();
        let works =
            Array2::from_shape_fn((nx, ny), |(i, j)| self.work * [1.0, 0.2, 0.0][(8 * i / nx + 8 * j / ny) % 3]);
        Ok(std::sync::Arc::new(Varying::new(law, works.view())?))
    }

    fn body(&self, grid: Grid) -> Result<Box<dyn ElasticOperator<f64>>> {
        Ok(if self.free { Box::new(Boussinesq::new(grid, 1.0)?) } else { Box::new(Westergaard::new(grid, 1.0)?) })
    }

    /// The levels of nested grids, and the errors of the finest.
    pub fn solve(&self, finer: usize, control: Control) -> Outcome<(Vec<Level>, Errors)> {
        let surface = self.surface(finer)?;
        let mut solver = Solver::new(Settings::default().tolerance(TOLERANCE));
        let nested = Nested::default().coarsest(16).closed(1.0).coarse_tolerance(GridError::COARSE_TOLERANCE);
        let law = self.law(surface.grid())?;
        let found = nested.solve(&mut solver, &surface, |grid| self.body(grid), law, control)?;
        let report = &found.solution.report;
        let errors = GridError::of_all(&found.levels, report, surface.nodes_per_wave(report.boundary));
        Ok((found.levels, errors.into_iter().filter(|(quantity, _)| quantity.name() != "stiffness").collect()))
    }

    /// The pull-off, or nothing where there is none.
    pub fn pull_off(&self, finer: usize) -> Outcome<Option<AccuratePullOff<f64>>> {
        let surface = self.surface(finer)?;
        let law = self.law(surface.grid())?;
        let preload = if self.free { 0.0 } else { self.pressure };
        let search = PullOff::default().tolerance(BRACKET).preload(Some(preload));
        let found = on_grid().pull_off(&mut Solver::default(), &surface, |grid| self.body(grid), law, &search);
        // surfaces that do not attract each other under no load have no pull-off
        Ok(found.ok().filter(|found| found.found.reached))
    }
}
