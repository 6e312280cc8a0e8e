//! Random scenes of kinds: a surface, a body, a work of adhesion and a load, and their solutions.

use std::f64::consts::PI;

use asperity::accuracy::{Accuracy, AccuratePullOff, GridError, Quantity};
use asperity::adhesion::{Formula, Varying};
use asperity::nested::Level;
use asperity::{
    Amplitude, Boussinesq, Control, ElasticOperator, Grid, Jkr, Nested, PullOff, Result, SelfAffine, Solver, Surface,
    Westergaard,
};
use common::{Draw, Outcome};
use ndarray::Array2;

use crate::case::solver;
use crate::sphere::SIDE;

/// Asks for the error of the given grid.
pub fn on_grid() -> Accuracy {
    Accuracy::new(f64::INFINITY, Quantity::Area)
}

/// The kinds of scenes: rough surfaces on a periodic half-space, and from the lattice on others, balls on a free one.
pub const KINDS: [&str; 18] = [
    "rough, H 0.8",
    "rough, H 0.3",
    "rough, one way",
    "rough, cells 2:1",
    "rough, strong adhesion",
    "rough, weak adhesion",
    "rough, next to none",
    "rough, light load",
    "rough, nearly closed",
    "rough, given gap",
    "rough, map of w",
    "lattice",
    "ridges",
    "sphere",
    "sphere, weak adhesion",
    "rough sphere",
    "ellipsoid",
    "sphere to the edge",
];

/// The errors that the library tells of quantities.
type Errors = Vec<(Quantity, Option<GridError>)>;

type Heights = Box<dyn Fn(Grid) -> Result<Surface>>;

/// A scene of a kind.
pub struct Scene {
    kind: &'static str,
    /// The nodes along x, and the nodes along y over them.
    pub n: usize,
    aspect: f64,
    lengths: (f64, f64),
    heights: Heights,
    pub free: bool,
    work: f64,
    pressure: f64,
}

impl Scene {
    pub fn drawn(kind: &'static str, draw: &mut Draw) -> Self {
        let n = 64;
        let (seed, nodes_per_wave) = ((draw.share() * 1e9) as u64, draw.around((8.0, 16.0)));
        let (slope, k_l) = (draw.around((0.05, 1.0)), draw.between((1.0, 2.0)));
        // in units of E* h'² times the shortest wave, and of E* h'
        let work = draw.around(match kind {
            "rough, strong adhesion" => (0.02, 0.1),
            "rough, weak adhesion" => (1e-6, 1e-4),
            "rough, next to none" => (1e-12, 1e-7),
            _ => (1e-3, 2e-2),
        });
        let load = draw.around(match kind {
            "rough, light load" => (3e-4, 3e-3),
            "rough, nearly closed" => (0.4, 0.9),
            _ => (3e-3, 0.1),
        });
        let (k_s, hurst) = (n as f64 / nodes_per_wave, if kind == "rough, H 0.3" { 0.3 } else { 0.8 });
        let roughness = SelfAffine::default().k_l(k_l).k_r(k_l).k_s(k_s).hurst(hurst).seed(seed);
        let rough = roughness.amplitude(Amplitude::RmsSlope(slope));
        let scene = Self {
            kind,
            n,
            aspect: 1.0,
            lengths: (1.0, 1.0),
            heights: Box::new(move |grid| rough.surface(grid)),
            free: false,
            work: work * slope * slope / k_s,
            pressure: load * slope,
        };
        match kind {
            "rough, one way" => {
                let heights: Heights = Box::new(move |grid| {
                    // the surface of a square, longer along y
                    let square = rough.surface(Grid::new(grid.shape(), (1.0, 1.0))?)?;
                    Surface::new(grid, square.heights().clone())
                });
                Self { lengths: (1.0, draw.between((3.0, 6.0))), heights, ..scene }
            }
            "rough, cells 2:1" => Self { aspect: 0.5, ..scene },
            "lattice" => {
                let periods = 1 + (3.0 * draw.share()) as usize;
                let amplitude = slope / (2.0 * PI * periods as f64);
                let heights: Heights = Box::new(move |grid| Surface::wave_2d(grid, amplitude, periods));
                Self { work: work * slope * slope / periods as f64, heights, ..scene }
            }
            "ridges" => {
                let [a, b, phase] = [(0.3, 1.0), (0.0, 0.5), (0.0, 6.0)].map(|ends| draw.between(ends));
                let heights: Heights = Box::new(move |grid| {
                    let (lx, _) = grid.lengths();
                    Surface::from_fn(grid, |x, _| {
                        let x = 2.0 * PI * x / lx;
                        slope / (2.0 * PI) * (a * x.cos() + b * (3.0 * x + phase).cos() / 3.0)
                    })
                });
                Self { work: 0.3 * work * slope * slope, heights, ..scene }
            }
            ball if ball.contains("sphere") || ball == "ellipsoid" => scene.ball(roughness, draw),
            _ => scene,
        }
    }

    /// A sphere, or an ellipsoid, on a free half-space.
    fn ball(self, roughness: SelfAffine, draw: &mut Draw) -> Self {
        let (weak, edge) = (self.kind == "sphere, weak adhesion", self.kind == "sphere to the edge");
        let work = draw.around(if weak { (1e-12, 1e-6) } else { (3e-5, 4e-3) });
        let ratio = if self.kind == "ellipsoid" { draw.between((1.3, 3.0)) } else { 1.0 };
        let [x0, y0] = [(); 2].map(|()| draw.between((-0.5, 0.5)) * SIDE / 32.0);
        let rough = (self.kind == "rough sphere").then(|| {
            let roughness = roughness.k_s(32.0 / draw.between((4.0, 8.0)));
            roughness.amplitude(Amplitude::RmsSlope(draw.around((0.02, 0.1))))
        });
        let pressure = (3.0 * (draw.share() - 0.5)).max(0.1) * 1.5 * PI * work / (SIDE * SIDE);
        let (shift, width, aspect) = if edge { (0.25 * SIDE, 0.5 * SIDE, 2.0) } else { (0.0, SIDE, 1.0) };
        Self {
            n: 32,
            aspect,
            lengths: (width, SIDE),
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

    /// The law, by squares of an eighth of the side on a map of the work of adhesion.
    fn law(&self, grid: &Grid) -> Result<Formula> {
        let law: Formula = Jkr::new(self.work)?.into();
        if self.kind != "rough, map of w" {
            return Ok(law);
        }
        let (nx, ny) = grid.shape();
        let share = |(i, j)| [1.0, 0.2, 0.0][(8 * i / nx + 8 * j / ny) % 3];
        Ok(std::sync::Arc::new(Varying::new(law, Array2::from_shape_fn((nx, ny), |at| self.work * share(at)).view())?))
    }

    fn body(&self, grid: Grid) -> Result<Box<dyn ElasticOperator<f64>>> {
        Ok(if self.free { Box::new(Boussinesq::new(grid, 1.0)?) } else { Box::new(Westergaard::new(grid, 1.0)?) })
    }

    /// The load of all grids.
    pub fn control(&self) -> Outcome<Control> {
        let control = Control::MeanPressure(self.pressure);
        if self.kind != "rough, given gap" {
            return Ok(control);
        }
        Ok(Control::MeanGap(self.solve(1, control)?.0.mean_gap))
    }

    /// The finest level of nested grids, and its errors.
    pub fn solve(&self, finer: usize, control: Control) -> Outcome<(Level, Errors)> {
        let surface = self.surface(finer)?;
        let nested = Nested::default().coarsest(16).closed(1.0).coarse_tolerance(GridError::COARSE_TOLERANCE);
        let law = self.law(surface.grid())?;
        let found = nested.solve(&mut solver(), &surface, |grid| self.body(grid), law, control)?;
        let report = &found.solution.report;
        let errors = GridError::of_all(&found.levels, report, surface.nodes_per_wave(report.boundary));
        let errors = errors.into_iter().filter(|(quantity, _)| quantity.name() != "stiffness").collect();
        Ok((found.levels.last().cloned().ok_or("no grid")?, errors))
    }

    /// The pull-off, or nothing where there is none.
    pub fn pull_off(&self, finer: usize) -> Outcome<Option<AccuratePullOff<f64>>> {
        let surface = self.surface(finer)?;
        let law = self.law(surface.grid())?;
        let preload = if self.free { 0.0 } else { self.pressure };
        let search = PullOff::default().tolerance(3e-3).preload(Some(preload));
        let found = on_grid().pull_off(&mut Solver::default(), &surface, |grid| self.body(grid), law, &search);
        // surfaces that do not attract each other under no load have no pull-off
        Ok(found.ok().filter(|found| found.found.reached))
    }
}
