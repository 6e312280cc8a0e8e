//! Cycles of contact and adhesion on 25 surfaces: what the settings of a path cost, and how accurate they are.
//!
//! `cargo run --release -p asperity-examples --example loops`
//!
//! The first table has the cycles with the settings of the tool. The second one has other settings, each against cycles
//! of steps that are much more closely balanced: the sum of all operator applications, the greatest error of the
//! largest tension, and the root mean square and the median of the error of the work on the surfaces that dissipate more
//! than 0.2 % of the work of adhesion. On every other node of a surface along its sides an application counts as the
//! share of the nodes that are left.

use std::ops::ControlFlow;

use asperity::path::{Event, Path, PathSettings};
use asperity::surface::Amplitude;
use asperity::{Control, Exponential, Grid, Problem, SelfAffine, Settings, Solver, Surface, Westergaard};
use clap::Parser;
use common::{Outcome, arguments, quantile};
use ndarray::{Axis, Slice};

/// The least dissipated energy of a cycle with an error, as a share of the work of adhesion.
const HYSTERETIC: f64 = 2e-3;

#[derive(Parser)]
struct Options {
    /// Two small surfaces
    #[arg(long)]
    quick: bool,
}

struct Scene {
    name: String,
    surface: Surface,
    work: f64,
    range: f64,
    /// the mean gaps between which it goes
    far: f64,
    near: f64,
}

fn rough(grid: Grid, rms: f64, k_s: f64, hurst: f64, seed: u64) -> asperity::Result<Surface> {
    let amplitude = Amplitude::RmsHeight(rms);
    SelfAffine::default().k_s(k_s).hurst(hurst).seed(seed).amplitude(amplitude).surface(grid)
}

fn scenes(side: usize) -> asperity::Result<Vec<Scene>> {
    let square = Grid::square(side, 1.0)?;
    let line = Grid::line(16 * side, 1.0)?;
    let mut all = vec![("sphere".to_owned(), Surface::paraboloid(square, 2.0)?, 1e-4, 2e-3, 0.06, 0.03)];
    for of in 1..=4 {
        // so that its bumps do not break away at once
        let mut bumps = Surface::wave_2d(square, 0.005, 3)?.heights().clone();
        bumps += rough(square, 2e-4, 8.0, 0.8, 60 + of)?.heights();
        all.extend([
            (format!("rough {of}"), rough(square, 6e-3, 8.0, 0.8, 10 + of)?, 2e-4, 2.5e-3, 0.04, 0.002),
            (format!("Hurst exponent 0.5, {of}"), rough(square, 3e-3, 12.0, 0.5, 20 + of)?, 2e-4, 2.5e-3, 0.03, 0.001),
            (format!("strong adhesion {of}"), rough(square, 4e-3, 8.0, 0.8, 30 + of)?, 3e-4, 3e-3, 0.04, 0.002),
            (format!("light contact {of}"), rough(square, 4e-3, 6.0, 0.8, 40 + of)?, 2e-4, 2.5e-3, 0.03, 0.004),
            (format!("profile {of}"), rough(line, 6e-3, 32.0, 0.8, 50 + of)?, 1e-4, 1e-3, 0.04, 0.004),
            (format!("nine bumps {of}"), Surface::new(square, bumps)?, 2e-4, 2.5e-3, 0.03, 0.001),
        ]);
    }
    Ok(all
        .into_iter()
        .map(|(name, surface, work, range, far, near)| Scene { name, surface, work, range, far, near })
        .collect())
}

/// Every other node of a scene along its sides, and the share of the nodes that are left.
fn halved(scene: &Scene) -> asperity::Result<(Scene, f64)> {
    let (surface, heights) = (&scene.surface, scene.surface.heights());
    let [x, y] = [0, 1].map(|axis| if heights.len_of(Axis(axis)) > 1 { 2 } else { 1 });
    let every = |step| Slice::from(..).step_by(step);
    let few = heights.slice_axis(Axis(0), every(x)).slice_axis(Axis(1), every(y)).to_owned();
    let share = few.len() as f64 / heights.len() as f64;
    let surface = Surface::new(Grid::new(few.dim(), surface.grid().lengths())?, few)?;
    Ok((Scene { surface, name: scene.name.clone(), ..*scene }, share))
}

#[derive(Default)]
struct Cycle {
    states: usize,
    applications: usize,
    jumps: usize,
    tension: f64,
    /// over the cycle, of the load, with its error
    work: f64,
    error: f64,
    mu_rho: f64,
}

fn cycle(scene: &Scene, settings: PathSettings, tolerance: Option<f64>) -> asperity::Result<Cycle> {
    let grid = *scene.surface.grid();
    let law = Exponential::new(scene.work, scene.range)?;
    let mut problem = Problem::new(&scene.surface, Westergaard::<f64>::new(grid, 1.0)?, law)?;
    let mut solver = Solver::new(Settings::default().tolerance(tolerance));
    let mut path = Path::new([scene.far, scene.near, scene.far].map(Control::MeanGap), settings)?;
    let mut found = Cycle { mu_rho: problem.mu_rho(), ..Cycle::default() };
    // also of steps that are taken back
    let (mut applications, mut solve) = (0, 0);
    while let Some(step) = path.next_observed(&mut solver, &mut problem, |state| {
        applications += if state.operator_applications < solve { solve } else { 0 };
        solve = state.operator_applications;
        ControlFlow::Continue(())
    })? {
        found.states += 1;
        found.jumps += usize::from(step.event.as_ref().and_then(Event::jump).is_some());
        found.tension = found.tension.max(-step.solution.report.mean_pressure);
        (found.work, found.error) = (step.work, step.work_error);
    }
    found.applications = applications + solve;
    Ok(found)
}

fn main() -> Outcome<()> {
    let options: Options = arguments::read(include_str!("loops.rs"));
    let mut scenes = scenes(if options.quick { 32 } else { 128 })?;
    scenes.truncate(if options.quick { 2 } else { scenes.len() });
    let usual = PathSettings::default();
    let all = |settings: PathSettings, tolerance| -> asperity::Result<Vec<Cycle>> {
        scenes.iter().map(|scene| cycle(scene, settings, tolerance)).collect()
    };
    let on_half = |settings: PathSettings| -> asperity::Result<Vec<Cycle>> {
        let solved = |scene: &Scene| {
            let (few, share) = halved(scene)?;
            let found = cycle(&few, settings, None)?;
            Ok(Cycle { applications: (share * found.applications as f64) as usize, ..found })
        };
        scenes.iter().map(solved).collect()
    };
    let reference = all(usual.imbalance(1e-6).smallest_step(1e-5), Some(1e-6))?;

    println!(
        "| surface | μ_ρ | states | applications | jumps | largest tension / E* | work / w | its standard error / w | with small steps |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let found = all(usual, None)?;
    for ((scene, cycle), close) in scenes.iter().zip(&found).zip(&reference) {
        let Cycle { states, applications, jumps, tension, work, error, mu_rho } = cycle;
        let [work, error, close] = [*work, *error, close.work].map(|work| work / scene.work);
        let name = &scene.name;
        println!(
            "| {name} | {mu_rho:.2} | {states} | {applications} | {jumps} | {tension:.2e} | {work:.2e} | {error:.1e} | {close:.2e} |"
        );
    }

    println!("\n| settings | states | applications | error of the tension, % | error of the work, % | its median, % |");
    println!("|---|---|---|---|---|---|");
    let sum = |cycles: &[Cycle], of: fn(&Cycle) -> usize| cycles.iter().map(of).sum::<usize>();
    let tell = |name: &str, found: &[Cycle]| {
        let pairs = || scenes.iter().zip(found.iter().zip(&reference));
        let tension = pairs().map(|(_, (a, b))| (a.tension / b.tension - 1.0).abs()).fold(0.0, f64::max);
        let works = pairs().filter(|(scene, (_, b))| b.work > HYSTERETIC * scene.work);
        let mut errors: Vec<_> = works.map(|(_, (a, b))| (a.work / b.work - 1.0).abs()).collect();
        let median = quantile(&mut errors, 0.5);
        let work = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len().max(1) as f64).sqrt();
        let [states, applications] = [sum(found, |cycle| cycle.states), sum(found, |cycle| cycle.applications)];
        let [tension, work, median] = [tension, work, median].map(|error| 100.0 * error);
        println!("| {name} | {states} | {applications} | {tension:.1} | {work:.1} | {median:.1} |");
    };
    tell("default", &found);
    tell("`--steps 10`", &all(usual.steps(10), None)?);
    tell("`--imbalance 1e-3`", &all(usual.imbalance(1e-3), None)?);
    tell("`--imbalance 3e-4`", &all(usual.imbalance(3e-4), None)?);
    tell("`--imbalance 1e-5`", &all(usual.imbalance(1e-5), None)?);
    tell("`--tolerance 1e-6`", &all(usual, Some(1e-6))?);
    tell("`--smallest-step 1e-2`", &all(usual.smallest_step(1e-2), None)?);
    tell("half the nodes along the sides", &on_half(usual)?);
    tell("half the nodes, `--imbalance 1e-5`", &on_half(usual.imbalance(1e-5))?);
    tell("the reference", &reference);
    Ok(())
}
