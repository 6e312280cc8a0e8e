//! Kinds of scenes: how often the true errors of area, gap, approach, pressure and pull-off are within the estimates.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use asperity::accuracy::{Accuracy, GridError, Quantity, Untold};
use asperity::adhesion::{Formula, Varying};
use asperity::nested::Level;
use asperity::{
    Amplitude, Boussinesq, Control, ElasticOperator, Grid, Jkr, Nested, PullOff, Result, SelfAffine, Settings, Solver,
    Surface, Westergaard,
};
use common::{Outcome, quantile};
use ndarray::Array2;

use crate::case::{extrapolated, head, row};
use crate::scene::Draw;

/// How many times as many nodes as the grid of an estimate the two grids of the truth have along their sides.
const FINER: [usize; 2] = [2, 4];

/// The tolerance of solves, far below the error of the grid.
const TOLERANCE: f64 = 1e-5;

/// The relative width of the bracket of a pull-off.
const BRACKET: f64 = 3e-3;

/// The nodes along a side of the coarsest grid on which a pull-off is found.
const SMALL: usize = 64;

/// The difference of the finer grids beyond that of the coarser ones, as a share, which is a jump.
const JUMP: f64 = 0.01;

/// Every so many scenes the pull-off is found.
const PULLED: usize = 4;

/// The kinds of scenes, by what is special about them.
const KINDS: [&str; 18] = [
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

type Heights = Box<dyn Fn(Grid) -> Result<Surface>>;

/// The errors that are told of quantities.
type Errors = Vec<(Quantity, Option<GridError>)>;

/// A scene of a kind.
struct Scene {
    n: usize,
    lengths: (f64, f64),
    /// The nodes along y over those along x.
    aspect: f64,
    heights: Heights,
    free: bool,
    work: f64,
    /// The work of adhesion over the greatest one.
    patches: Option<fn(f64, f64) -> f64>,
    pressure: f64,
    by_gap: bool,
}

impl Scene {
    fn drawn(kind: &str, draw: &mut Draw) -> Outcome<Self> {
        let n = 64;
        let has = |word: &str| kind.contains(word);
        let (seed, nodes_per_wave) = ((draw.share() * 1e9) as u64, draw.around(8.0, 16.0));
        let (slope, k_l) = (draw.around(0.05, 1.0), draw.between(1.0, 2.0));
        let hurst = if has("H 0.3") { 0.3 } else { 0.8 };
        let rough = move |k_s: f64, slope: f64| {
            let of = SelfAffine::default().k_l(k_l).k_r(k_l).k_s(k_s).hurst(hurst).seed(seed);
            of.amplitude(Amplitude::RmsSlope(slope))
        };
        // in units of E* h'² times the shortest wave, and of E* h'
        let adhesion = match kind {
            _ if has("strong") => draw.around(0.02, 0.1),
            _ if has("weak") => draw.around(1e-6, 1e-4),
            _ if has("next to none") => draw.around(1e-12, 1e-7),
            _ => draw.around(1e-3, 2e-2),
        };
        let load = match kind {
            _ if has("light") => draw.around(3e-4, 3e-3),
            _ if has("nearly closed") => draw.around(0.4, 0.9),
            _ => draw.around(3e-3, 0.1),
        };
        let k_s = n as f64 / nodes_per_wave;
        let periodic = |heights: Heights| Self {
            n,
            lengths: (1.0, 1.0),
            aspect: 1.0,
            heights,
            free: false,
            work: adhesion * slope * slope / k_s,
            patches: has("map of w").then_some(|x: f64, y: f64| match (x.floor() + y.floor()) as i64 % 3 {
                0 => 1.0,
                1 => 0.2,
                _ => 0.0,
            }),
            pressure: load * slope,
            by_gap: has("given gap"),
        };
        let of_rough = move |grid| rough(k_s, slope).surface(grid);
        Ok(match kind {
            "rough, one way" => {
                let stretch = draw.between(3.0, 6.0);
                let lengths = (1.0, stretch);
                Self {
                    lengths,
                    ..periodic(Box::new(move |grid| {
                        // the surface of a square, longer along y
                        let square = rough(k_s, slope).surface(Grid::new(grid.shape(), (1.0, 1.0))?)?;
                        Surface::new(grid, square.heights().clone())
                    }))
                }
            }
            "rough, cells 2:1" => Self { aspect: 0.5, ..periodic(Box::new(of_rough)) },
            "lattice" => {
                let periods = 1 + (3.0 * draw.share()) as usize;
                let amplitude = slope / (2.0 * PI * periods as f64);
                Self {
                    work: adhesion * slope * slope / periods as f64,
                    ..periodic(Box::new(move |grid| Surface::wave_2d(grid, amplitude, periods)))
                }
            }
            "ridges" => {
                let [a, b] = [draw.between(0.3, 1.0), draw.between(0.0, 0.5)];
                let phase = draw.between(0.0, 6.0);
                Self {
                    work: 0.3 * adhesion * slope * slope,
                    ..periodic(Box::new(move |grid| {
                        let (lx, _) = grid.lengths();
                        Surface::from_fn(grid, |x, _| {
                            let x = 2.0 * PI * x / lx;
                            slope / (2.0 * PI) * (a * x.cos() + b * (3.0 * x + phase).cos() / 3.0)
                        })
                    }))
                }
            }
            _ if has("sphere") || kind == "ellipsoid" => {
                let weak = has("weak");
                let (side, work) = (1.6, if weak { draw.around(1e-12, 1e-6) } else { draw.around(3e-5, 4e-3) });
                let ratio = if kind == "ellipsoid" { draw.between(1.3, 3.0) } else { 1.0 };
                let [x0, y0] = [(); 2].map(|()| draw.between(-0.5, 0.5) * side / 32.0);
                let roughness =
                    (kind == "rough sphere").then(|| rough(32.0 / draw.between(4.0, 8.0), draw.around(0.02, 0.1)));
                let pressure = (3.0 * (draw.share() - 0.5)).max(0.1) * 1.5 * PI * work / (side * side);
                let edge = kind == "sphere to the edge";
                let lengths = if edge { (0.5 * side, side) } else { (side, side) };
                Self {
                    n: 32,
                    lengths,
                    aspect: if edge { 2.0 } else { 1.0 },
                    free: true,
                    work,
                    pressure: if edge || weak { pressure + draw.around(1e-3, 0.1) } else { pressure },
                    by_gap: false,
                    ..periodic(Box::new(move |grid| {
                        // cells, not nodes, keep their places
                        let (dx, dy) = grid.spacing();
                        let [ox, oy] = [0.5 * dx - x0, 0.5 * dy - y0];
                        let shift = if edge { 0.25 * side } else { 0.0 };
                        let body = Surface::from_fn(grid, |x, y| {
                            -0.5 * ((x + ox - shift).powi(2) + (y + oy).powi(2) / ratio)
                        })?;
                        match &roughness {
                            None => Ok(body),
                            Some(of) => Surface::new(grid, body.heights() + of.surface(grid)?.heights()),
                        }
                    }))
                }
            }
            _ => periodic(Box::new(of_rough)),
        })
    }

    fn shape(&self, finer: usize) -> (usize, usize) {
        (finer * self.n, ((finer * self.n) as f64 * self.aspect) as usize)
    }

    fn surface(&self, finer: usize) -> Result<Surface> {
        (self.heights)(Grid::new(self.shape(finer), self.lengths)?)
    }

    fn law(&self, grid: &Grid) -> Result<Formula> {
        let law = Jkr::new(self.work)?;
        let Some(patches) = self.patches else { return Ok(law.into()) };
        let (nx, ny) = grid.shape();
        // of squares of an eighth of the side
        let works = Array2::from_shape_fn((nx, ny), |(i, j)| {
            self.work * patches(8.0 * i as f64 / nx as f64, 8.0 * j as f64 / ny as f64)
        });
        let law: Formula = law.into();
        Ok(std::sync::Arc::new(Varying::new(law, works.view())?))
    }

    fn body(&self, grid: Grid) -> Result<Box<dyn ElasticOperator<f64>>> {
        Ok(if self.free { Box::new(Boussinesq::new(grid, 1.0)?) } else { Box::new(Westergaard::new(grid, 1.0)?) })
    }

    /// The levels of nested grids, the errors of the finest, and the control.
    fn solve(&self, finer: usize, control: Control) -> Outcome<(Vec<Level>, Errors)> {
        let surface = self.surface(finer)?;
        let mut solver = Solver::new(Settings::default().tolerance(TOLERANCE));
        let nested = Nested::default().coarsest(16).closed(1.0).coarse_tolerance(GridError::COARSE_TOLERANCE);
        let law = self.law(surface.grid())?;
        let found = nested.solve(&mut solver, &surface, |grid| self.body(grid), law, control)?;
        let report = &found.solution.report;
        let waves = surface.nodes_per_wave(report.boundary);
        let errors = GridError::of_all(&found.levels, report, waves);
        Ok((found.levels, errors.into_iter().filter(|(of, _)| of.name() != "stiffness").collect()))
    }

    /// The pull-off, or nothing where there is none.
    fn pull_off(&self, finer: usize) -> Outcome<Option<Pulled>> {
        let surface = self.surface(finer)?;
        let told = Accuracy::new(f64::INFINITY, Quantity::Area);
        let preload = if self.free { 0.0 } else { self.pressure };
        let search = PullOff::default().tolerance(BRACKET).preload(Some(preload));
        let law = self.law(surface.grid())?;
        let found = told.pull_off(&mut Solver::default(), &surface, |grid| self.body(grid), law, &search);
        // surfaces that do not attract each other under no load have no pull-off
        let Ok(found) = found else { return Ok(None) };
        let tension = -found.found.solution.report.mean_pressure;
        let by_zone = found.found.limit()?.unwrap_or(tension);
        Ok(found.found.reached.then_some(Pulled {
            tension,
            by_zone,
            told: found.limit.zip(found.error.ok()).map(|(limit, error)| (limit, error.relative)),
        }))
    }
}

/// A pull-off: the greatest tension, what it tells of the limit, and the limit that is told with its error.
#[derive(Debug)]
struct Pulled {
    tension: f64,
    by_zone: f64,
    told: Option<Told>,
}

fn value(of: Quantity, level: &Level) -> f64 {
    match of {
        Quantity::Area => level.area.jkr_contact_fraction.unwrap_or(level.area.corrected_contact_fraction),
        Quantity::Gap => level.mean_gap,
        Quantity::Approach => level.approach.unwrap_or(f64::NAN),
        _ => level.mean_pressure,
    }
}

/// The true error and the estimate of a quantity of a scene.
type Told = (f64, f64);

/// The limit of a value on a grid and on two finer ones: that of the finer two, or the finest value where these differ by
/// more than the coarser two, as where the state jumps between them.
fn limit(here: f64, half: f64, fine: f64) -> f64 {
    let jumps = (fine - half).abs() > (half - here).abs() + JUMP * fine.abs();
    if jumps { fine } else { extrapolated(fine, half) }
}

/// The tables of all kinds, with the pull-off of each fourth scene; or of one kind, with the pull-off of each.
pub fn tables(count: usize, seed: u64, quick: bool, only: Option<&str>) -> Outcome<()> {
    let mut told: BTreeMap<(usize, usize), Vec<Told>> = BTreeMap::new();
    let mut missing: BTreeMap<usize, usize> = BTreeMap::new();
    let is_wanted = |kind: &str| only.is_none_or(|only| kind == only);
    for (number, kind) in KINDS.into_iter().enumerate().filter(|(_, kind)| is_wanted(kind)) {
        let mut draw = Draw::new(seed + 1000 * number as u64);
        for scene in 0..count.div_ceil(KINDS.len()) {
            let scene_of = Scene::drawn(kind, &mut draw)?;
            let mut control = Control::MeanPressure(scene_of.pressure);
            if scene_of.by_gap {
                control = Control::MeanGap(scene_of.solve(1, control)?.0.last().map_or(0.0, |level| level.mean_gap));
            }
            let (levels, errors) = scene_of.solve(1, control)?;
            let finer = FINER.map(|finer| scene_of.solve(finer, control));
            let [Ok((half, _)), Ok((fine, _))] = finer else { continue };
            let [Some(here), Some(half), Some(fine)] = [levels.last(), half.last(), fine.last()] else { continue };
            let say = |of: &str, off: f64, error: f64, words: &str| {
                let miss = if off > error { ", missed" } else { "" };
                if quick {
                    println!("{kind} {scene}: {of} {off:.4} of {error:.4}{miss}: {words}");
                }
            };
            for (at, (of, error)) in errors.iter().enumerate() {
                let [found, half, fine] = [here, half, fine].map(|level| value(*of, level));
                let truth = limit(found, half, fine);
                if let Some(error) = error {
                    let off = (found / truth - 1.0).abs();
                    say(of.name(), off, error.relative, &format!("{found:.5e} {truth:.5e}"));
                    told.entry((number, at)).or_default().push((off, error.relative));
                } else if *of == Quantity::Area {
                    *missing.entry(number).or_default() += 1;
                }
            }
            if only.is_some() || scene % PULLED == 0 {
                let small = Scene { n: SMALL, ..scene_of };
                let [on_grid, half, fine] = [1, 2, 4].map(|finer| small.pull_off(finer));
                if let (Some(Pulled { told: Some((limit, error)), .. }), Some(half), Some(fine)) =
                    (on_grid?, half?, fine?)
                {
                    let ends = [(fine.tension, half.tension), (fine.by_zone, half.by_zone)];
                    let [above, below] = ends.map(|(fine, half)| extrapolated(fine, half));
                    let off = (limit / above.midpoint(below) - 1.0).abs();
                    say("pull-off", off, error, &format!("{limit:.3e} {half:?} {fine:?}"));
                    told.entry((number, 5)).or_default().push((off, error));
                }
            }
        }
    }
    head(
        "Kinds of scenes: in how many the true error is within the estimate; medians of both in %; the estimates of zero \
         or below",
        &["kind", "area", "gap", "approach", "pressure", "pull-off", "no area"],
    );
    for (number, kind) in KINDS.into_iter().enumerate().filter(|(_, kind)| is_wanted(kind)) {
        let cell = |at: usize| {
            let all = told.get(&(number, at)).map_or(&[][..], |all| &all[..]);
            if all.is_empty() {
                return "–".to_owned();
            }
            let within = all.iter().filter(|(off, estimate)| off <= estimate).count();
            let none = all.iter().filter(|(_, estimate)| *estimate <= 0.0).count();
            let middle = |of: fn(&Told) -> f64| 100.0 * quantile(&mut all.iter().map(of).collect::<Vec<_>>(), 0.5);
            let none = if none > 0 { format!(", {none} ≤ 0") } else { String::new() };
            format!("{within}/{}, {:.2} of {:.2}{none}", all.len(), middle(|told| told.0), middle(|told| told.1))
        };
        let mut cells = vec![kind.to_owned()];
        cells.extend([0, 1, 2, 3, 5].map(cell));
        cells.push(missing.get(&number).copied().unwrap_or(0).to_string());
        row(&cells);
    }
    Ok(())
}

/// Spheres with contact radii, by the theory of Johnson, Kendall and Roberts, of a share of a node to several nodes:
/// how many have a pull-off within its error, and how many a reason for no error.
pub fn spheres(count: usize) -> Outcome<()> {
    let (side, nodes) = (1.6, 64);
    let [mut within, mut missed, mut few, mut others] = [0; 4];
    for sphere in 0..count {
        let radius = 0.1 * 60_f64.powf(sphere as f64 / (count - 1) as f64) * side / nodes as f64;
        let work = 8.0 * radius.powi(3) / (9.0 * PI);
        let surface = Surface::paraboloid(Grid::square(nodes, side)?, 1.0)?;
        let half_space = |grid| Boussinesq::<f64>::new(grid, 1.0);
        let search = PullOff::default().tolerance(BRACKET);
        let told = Accuracy::new(f64::INFINITY, Quantity::Area);
        let found = told.pull_off(&mut Solver::default(), &surface, half_space, Jkr::new(work)?, &search)?;
        match (found.limit, found.error) {
            (Some(limit), Ok(error)) => {
                let holds = (limit * side * side / (1.5 * PI * work) - 1.0).abs() <= error.relative;
                *(if holds { &mut within } else { &mut missed }) += 1;
            }
            (_, Err(Untold::FewNodes { .. })) => few += 1,
            _ => others += 1,
        }
    }
    println!(
        "\n{count} spheres of contact radii of 0.1 to 6 nodes: {within} pull-offs within the error, {missed} not, {few} of a \
         few nodes, {others} without an error for another reason"
    );
    Ok(())
}

/// Rough surfaces with works of adhesion from next to none on: the largest change of the area and of its error over a tenth
/// of the work, and the estimates of zero or below.
pub fn weak(count: usize, seed: u64) -> Outcome<()> {
    let mut draw = Draw::new(seed);
    let (mut area_step, mut error_step, mut none): (f64, f64, usize) = (0.0, 0.0, 0);
    for _ in 0..count {
        let mut scene = Scene::drawn("rough, H 0.8", &mut draw)?;
        let unit = scene.work;
        let mut before: Option<[f64; 2]> = None;
        for exponent in -12..=-4 {
            scene.work = unit * 100.0 * 10_f64.powi(exponent);
            let (levels, errors) = scene.solve(1, Control::MeanPressure(scene.pressure))?;
            none += errors.iter().flat_map(|(_, error)| error).filter(|error| error.relative <= 0.0).count();
            let area = levels.last().map_or(f64::NAN, |level| value(Quantity::Area, level));
            let error = errors[0].1.map_or(f64::NAN, |error| error.relative);
            if let Some([area_before, error_before]) = before.replace([area, error]) {
                area_step = area_step.max((area / area_before - 1.0).abs());
                error_step = error_step.max((error / error_before).ln().abs().exp());
            }
        }
    }
    println!(
        "\n{count} surfaces with works of adhesion from 1e-12 of strong ones on, tenfold each: the area changes by {:.1} % at \
         most, its error by a factor of {error_step:.1} at most, {none} estimates are zero or below",
        100.0 * area_step
    );
    Ok(())
}
