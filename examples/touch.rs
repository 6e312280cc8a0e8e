//! What closed loops of approach and withdrawal dissipate in the limit of no range: a sphere, with a known loop, and
//! random surfaces, grid by grid.
//!
//! `cargo run --release -p asperity-examples --example touch -- --surfaces 20`
//!
//! With `--solves 40` it counts the operator applications of solves under a pressure on as many random surfaces with
//! moderate and with strong adhesion: by attraction on all nodes, by touch, and by touch on nested grids, with the
//! surfaces on which these end within 1 % of the area.
//!
//! Each grid has the energy that a loop dissipates, and the limit that the grid and the next coarser one give, with the
//! error of the limit. The energies of the sphere are in units of the exact one, others in 1e-6 E* times the side. The last
//! lines compare grids to the finest one.

use std::path::PathBuf;
use std::sync::Arc;

use asperity::accuracy::{Limit, LoopLimit};
use asperity::adhesion::{Hints, Values};
use asperity::path::{Path, PathEnd, PathSettings};
use asperity::surface::Amplitude;
use asperity::{
    AdhesionLaw, Boussinesq, Branch, Control, ElasticOperator, Grid, Jkr, Nested, Problem, SelfAffine, Settings,
    Solver, Surface, Westergaard,
};
use clap::Parser;
use common::chart::{COLOURS, Chart, Series, Style};
use common::{Outcome, arguments, quantile};
use plotters::prelude::SeriesLabelPosition;

#[derive(Parser)]
struct Options {
    /// Number of random surfaces
    #[arg(long, default_value_t = 2)]
    surfaces: u64,
    /// Seed of the first surface
    #[arg(long, default_value_t = 200)]
    seed: u64,
    /// Nodes along a side of the grids of random surfaces, each half of the next
    #[arg(long, value_delimiter = ',', default_value = "64,128,256")]
    nodes: Vec<usize>,
    /// Nodes along a side of the grids of the sphere, each half of the next
    #[arg(long, value_delimiter = ',', default_value = "32,64,128")]
    sphere: Vec<usize>,
    /// Number of random surfaces to solve under a pressure, with moderate and with strong adhesion
    #[arg(long, default_value_t = 0)]
    solves: u64,
    /// Nodes along a side of these surfaces
    #[arg(long, default_value_t = 256)]
    size: usize,
    /// Folder for a picture of the energies
    #[arg(long)]
    out: Option<PathBuf>,
}

/// The law without a range, which attracts on all nodes, from as far as its range on the grid.
struct Everywhere(Arc<dyn AdhesionLaw<f64>>);

impl AdhesionLaw<f64> for Everywhere {
    fn energy(&self, gap: f64) -> f64 {
        self.0.energy(gap)
    }
    fn traction(&self, gap: f64) -> f64 {
        self.0.traction(gap)
    }
    fn slope(&self, gap: f64) -> f64 {
        self.0.slope(gap)
    }
    fn hints(&self) -> Hints<f64> {
        let mut hints = self.0.hints();
        hints.touching = false;
        hints
    }
    fn evaluate(&self, first: usize, gaps: &[f64], values: Values<'_, f64>) {
        self.0.evaluate(first, gaps, values);
    }
    fn on_nodes(&self, compliance: f64) -> Option<Arc<dyn AdhesionLaw<f64>>> {
        Some(Arc::new(Self(self.0.on_nodes(compliance)?)))
    }
}

/// The end of a path through loads.
fn follow<O: ElasticOperator<f64> + 'static>(
    surface: &Surface,
    elastic: O,
    work: f64,
    touching: bool,
    loads: [Control; 3],
) -> asperity::Result<PathEnd> {
    let law: Arc<dyn AdhesionLaw<f64>> = Arc::new(Jkr::new(work)?);
    let law = if touching { law } else { Arc::new(Everywhere(law)) };
    let mut problem = Problem::new(surface, elastic, law)?;
    let mut path = Path::new(loads, PathSettings::default())?;
    let mut solver = Solver::default();
    while path.next(&mut solver, &mut problem)?.is_some() {}
    Ok(path.end())
}

/// A loop on nested grids.
struct Loop {
    name: String,
    nodes: Vec<usize>,
    /// of the energies, in the unit in which they are told
    unit: f64,
    ends: Vec<PathEnd>,
    /// by the law that attracts on all nodes, where it is asked for
    everywhere: Vec<PathEnd>,
}

impl Loop {
    fn energy(&self, k: usize) -> f64 {
        self.ends[k].work / self.unit
    }

    /// The limit on a grid that has a coarser one.
    fn limit(&self, k: usize) -> Option<Limit> {
        let (n, coarse) = (self.nodes[k], &self.ends[k.checked_sub(1)?]);
        let mut limit = LoopLimit::of((n, n), &self.ends[k], coarse).work;
        limit.value /= self.unit;
        limit.error /= self.unit;
        Some(limit)
    }

    fn print(&self) {
        let told = |k: usize| {
            let limit =
                self.limit(k).map_or(String::new(), |limit| format!(" → {:.4} ± {:.4}", limit.value, limit.error));
            format!("{}²: {:.4}{limit}", self.nodes[k], self.energy(k))
        };
        println!("{}: {}", self.name, (0..self.ends.len()).map(told).collect::<Vec<_>>().join("; "));
    }
}

/// The sphere at fixed grips: radius 2 µm, contact modulus 1 GPa, work of adhesion 50 mJ/m².
fn sphere(nodes: &[usize], everywhere: bool) -> asperity::Result<Loop> {
    const SIDE: f64 = 0.7e-6;
    /// What it dissipates: 1097.5 aJ as the surfaces touch, and 115.2 as they part, by the curve of JKR.
    const EXACT: f64 = 1212.7e-18;
    let loads = [-8e-9, 6e-9, -20e-9].map(Control::Approach);
    let on = |touching: bool| {
        let on = |&n: &usize| {
            let grid = Grid::square(n, SIDE)?;
            follow(&Surface::paraboloid(grid, 2e-6)?, Boussinesq::new(grid, 1e9)?, 0.05, touching, loads)
        };
        nodes.iter().map(on).collect::<asperity::Result<Vec<_>>>()
    };
    let everywhere = if everywhere { on(false)? } else { Vec::new() };
    Ok(Loop { name: "sphere".into(), nodes: nodes.to_vec(), unit: EXACT / (SIDE * SIDE), ends: on(true)?, everywhere })
}

/// A random surface of slope 0.5 at given mean gaps: from apart to 1 to 1.5 rms heights and back.
fn rough(seed: u64, nodes: &[usize], everywhere: bool) -> asperity::Result<Loop> {
    let k_s = [8.0, 16.0][seed as usize % 2];
    // of a sequence of low discrepancy
    let [of_work, of_gap] = [0.754_877_666, 0.569_840_291].map(|step: f64| (step * seed as f64).fract());
    let work = 3e-4 * 10_f64.powf(of_work);
    let spectrum = SelfAffine::default().k_s(k_s).seed(seed).amplitude(Amplitude::RmsSlope(0.5));
    let on = |touching: bool| {
        let on = |&n: &usize| {
            let surface = spectrum.surface(Grid::square(n, 1.0)?)?;
            let heights = surface.heights();
            let mean = heights.mean().unwrap_or_default();
            let rms = heights.iter().map(|height| (height - mean).powi(2)).sum::<f64>().sqrt() / n as f64;
            let far = 1.15 * heights.iter().fold(f64::MIN, |highest, &height| highest.max(height - mean));
            let loads = [far, (1.0 + 0.5 * of_gap) * rms, 3.0 * far].map(Control::MeanGap);
            follow(&surface, Westergaard::new(*surface.grid(), 1.0)?, work, touching, loads)
        };
        nodes.iter().map(on).collect::<asperity::Result<Vec<_>>>()
    };
    let everywhere = if everywhere { on(false)? } else { Vec::new() };
    let name = format!("seed {seed}, k_s {k_s}, w {work:.1e}");
    Ok(Loop { name, nodes: nodes.to_vec(), unit: 1e-6, ends: on(true)?, everywhere })
}

/// What grids say of the energy on the finest one.
fn compare(loops: &[Loop], nodes: &[usize]) {
    let finest = nodes.len() - 1;
    println!("\n| nodes | error, median % | greatest | of the limit, median % | greatest | inside its error |");
    println!("|---|---|---|---|---|---|");
    for (k, n) in nodes[..finest].iter().enumerate() {
        let true_value = |found: &Loop| found.limit(finest).map_or(found.energy(finest), |limit| limit.value);
        let mut of_grid: Vec<_> =
            loops.iter().map(|found| 100.0 * (found.energy(k) / true_value(found) - 1.0).abs()).collect();
        let limits: Vec<_> = loops.iter().filter_map(|found| Some((found.limit(k)?, true_value(found)))).collect();
        let mut of_limit: Vec<_> =
            limits.iter().map(|(limit, value)| 100.0 * (limit.value / value - 1.0).abs()).collect();
        let inside = limits.iter().filter(|(limit, value)| (limit.value - value).abs() <= limit.error).count();
        let [grid, limit] = [&mut of_grid, &mut of_limit].map(|errors| {
            let greatest = errors.iter().copied().fold(f64::NAN, f64::max);
            format!("{:.1} | {greatest:.1}", quantile(errors, 0.5))
        });
        println!("| {n}² | {grid} | {limit} | {inside} of {} |", limits.len());
    }
}

/// The operator applications of solves on random surfaces of slope 0.3 that come from afar under a pressure: by attraction
/// on all nodes, by touch, and by touch on nested grids.
fn count(surfaces: u64, size: usize) -> asperity::Result<()> {
    println!(
        "\n| adhesion | on all nodes | by touch | ratio, sum | worst | nested | ratio, sum | within 1 % of the area |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (name, least) in [("moderate", 1e-4), ("strong", 5e-4)] {
        let (mut sums, mut worst, mut same) = ([0.0; 3], 0.0, 0);
        for seed in 0..surfaces {
            // of sequences of low discrepancy
            let [of_k, of_work, of_load] =
                [0.819_172_513, 0.671_043_607, 0.549_700_478].map(|step: f64| (step * (seed + 1) as f64).fract());
            let (k_s, work, load) = (4.0 + 12.0 * of_k, least * 2.0_f64.powf(of_work), 3e-4 * 100.0_f64.powf(of_load));
            let spectrum = SelfAffine::default().k_s(k_s).seed(seed).amplitude(Amplitude::RmsSlope(0.3));
            let surface = spectrum.surface(Grid::square(size, 1.0)?)?;
            let pressure = Control::MeanPressure(load);
            let by = |touching: bool| -> asperity::Result<_> {
                let law: Arc<dyn AdhesionLaw<f64>> = Arc::new(Jkr::new(work)?);
                let law = if touching { law } else { Arc::new(Everywhere(law)) };
                let mut problem = Problem::new(&surface, Westergaard::new(*surface.grid(), 1.0)?, law)?;
                Solver::new(Settings::default().branch(Branch::Loading)).solve(&mut problem, pressure)
            };
            let elastic = |grid: &Grid| Westergaard::<f64>::new(*grid, 1.0);
            let nested = Nested::default().solve(
                &mut Solver::default(),
                surface.clone(),
                |grid| elastic(&grid),
                Jkr::new(work)?,
                pressure,
            )?;
            let (everywhere, touch) = (by(false)?, by(true)?);
            let applications = [
                everywhere.report.operator_applications as f64,
                touch.report.operator_applications as f64,
                nested.equivalent_applications(),
            ];
            worst = f64::max(worst, applications[1] / applications[0]);
            // with the energy −w of each area in contact
            let area = nested.solution.report.adhesive_energy / touch.report.adhesive_energy;
            same += u64::from((area - 1.0).abs() < 0.01);
            sums = std::array::from_fn(|k| sums[k] + applications[k]);
        }
        let [everywhere, touch, nested] = sums;
        let [ratio, of_nested] = [touch, nested].map(|sum| sum / everywhere);
        println!(
            "| {name} | {everywhere:.0} | {touch:.0} | {ratio:.2} | {worst:.2} | {nested:.0} | {of_nested:.2} | {same} of {surfaces} |"
        );
    }
    Ok(())
}

/// The energies over the nodes, by both laws, in units of the limit.
fn picture(sphere: &Loop, rough: &Loop) -> Chart {
    let mut series = Vec::new();
    let of_rough = rough.limit(rough.ends.len() - 1).map_or(1.0, |limit| limit.value);
    for (name, found, unit, colour, beside) in
        [("sphere", sphere, 1.0, COLOURS[0], -0.04), ("rough surface", rough, of_rough, COLOURS[1], 0.04)]
    {
        let points = |energies: Vec<f64>| {
            found.nodes.iter().zip(energies).map(|(&n, energy)| ((n as f64).log2(), energy / unit)).collect::<Vec<_>>()
        };
        let everywhere = points(found.everywhere.iter().map(|end| end.work / found.unit).collect());
        let by_touch = points((0..found.ends.len()).map(|k| found.energy(k)).collect());
        let name = |law: &str| format!("{name}, {law}");
        series.push(Series { name: name("attraction on all nodes"), colour, style: Style::Rings, points: everywhere });
        series.push(Series { name: name("where surfaces have touched"), colour, style: Style::Dots, points: by_touch });
        for k in 1..found.ends.len() {
            let Some(limit) = found.limit(k) else { continue };
            let x = (found.nodes[k] as f64).log2() + beside;
            let bar = [-1.0, 1.0].map(|sign| (x, (limit.value + sign * limit.error) / unit));
            series.push(Series { name: String::new(), colour, style: Style::Line, points: bar.to_vec() });
        }
    }
    let title = "Energy that a loop dissipates, in units of its limit; bars: limits from two grids".to_owned();
    let axes = ["log₂ of the nodes along a side", "energy"];
    Chart { title, axes, logarithmic: false, labels: SeriesLabelPosition::MiddleLeft, series }
}

fn main() -> Outcome<()> {
    let options: Options = arguments::read(include_str!("touch.rs"));
    if options.solves > 0 {
        return Ok(count(options.solves, options.size)?);
    }
    let draws = options.out.is_some();
    let sphere = sphere(&options.sphere, draws)?;
    sphere.print();
    let mut loops = Vec::new();
    for seed in options.seed..options.seed + options.surfaces {
        let found = rough(seed, &options.nodes, draws && loops.is_empty())?;
        found.print();
        loops.push(found);
    }
    compare(&loops, &options.nodes);
    if let (Some(out), Some(first)) = (&options.out, loops.first()) {
        picture(&sphere, first).save(&out.join("touch.svg"))?;
    }
    Ok(())
}
