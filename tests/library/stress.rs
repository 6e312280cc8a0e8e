//! Random small scenes against dense matrices: every body, law, constraint, control, start and precision.
//!
//! `cargo test --release --test library all_scenes -- --ignored --nocapture` judges 20 000 of them, and prints how they
//! end besides what [`ENDS`] states; `SCENES` is another number, `FIRST` the seed of the first. A scene that fails says
//! its seed: `FIRST=seed SCENES=1` tries it alone, and prints all of it. `ENDS=Lost` lists the scenes with that [`End`].

mod account;
mod precision;

mod oracle;

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::result::Result;

use account::{Account, Tally};
use asperity::solver::Iteration;
use asperity::stability::Verdict;
use asperity::*;
use ndarray::Array2;
use oracle::Judge;
use oracles::scenes::{Body, Constraint, Features, Kind, Precision, Scene};

/// How a solve ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    Converged,
    /// apart under a tension that no state holds which a sweep over gaps finds
    Detached,
    /// stalled where rounding lets it come no farther
    Floor,
    /// stalled before
    Stalled,
    Limit,
    /// apart under a tension that a state holds
    Lost,
}

impl End {
    const ALL: [Self; 6] = [Self::Converged, Self::Detached, Self::Floor, Self::Stalled, Self::Limit, Self::Lost];
}

/// What became of a scene.
struct Judged {
    end: End,
    iterations: usize,
    /// how far from the exact equilibrium over how far it may be
    distance: Option<f64>,
    verdicts: Vec<Verdict>,
}

fn judge(scene: &Scene) -> Result<Judged, String> {
    if scene.precision == Precision::Single { in_precision::<f32>(scene) } else { in_precision::<f64>(scene) }
}

/// The same, or what is wrong with which scene.
fn caught(scene: &Scene) -> Result<Judged, String> {
    let judged = catch_unwind(AssertUnwindSafe(|| judge(scene))).unwrap_or_else(|_| Err("panic".into()));
    let judged = judged.map_err(|reason| format!("{reason} in {scene}"))?;
    if std::env::var("ENDS").is_ok_and(|end| end == format!("{:?}", judged.end)) {
        println!("{:?} after {} in {scene}", judged.end, judged.iterations);
    }
    Ok(judged)
}

fn in_precision<T: Real>(scene: &Scene) -> Result<Judged, String> {
    let refused = |error: Error| format!("refused: {error}");
    match scene.constraint {
        Constraint::Hard | Constraint::Paper => with::<T, _>(scene, Projection),
        Constraint::Penalty => with::<T, _>(scene, Penalty::new(scene.stiffness).map_err(refused)?),
        Constraint::Uzawa => with::<T, _>(scene, Uzawa::new(scene.stiffness).map_err(refused)?),
        Constraint::None => with::<T, _>(scene, NoWall),
        Constraint::Hardness => with::<T, _>(scene, Hardness::new(scene.hardness).map_err(refused)?),
    }
}

fn with<T: Real, C: ContactConstraint<T> + 'static>(scene: &Scene, constraint: C) -> Result<Judged, String> {
    let refused = |error: Error| format!("refused: {error}");
    let (mut problem, start) = (scene.problem::<T>().map_err(refused)?, scene.start_in::<T>());
    let mut solver = Solver { settings: scene.settings, constraint };
    let mut history = Vec::new();
    let start = start.as_ref().map_or(Start::Default, |gap| Start::From(gap));
    let observe = |iteration: &Iteration| {
        history.push(*iteration);
        ControlFlow::Continue(())
    };
    let solution = solver.solve_with(&mut problem, scene.control, start, observe).map_err(refused)?;
    let report = &solution.report;
    let judge = Judge::new(scene, &solution, solver.constraint.wall(), problem.operator());
    let distance = judge.all()?;
    if report.status != Status::Detached {
        falls::<T>(scene, &history, judge.magnitude())?;
    }
    let at_floor = judge.is_at_floor(problem.operator());
    let verdicts = judge.stability(&mut problem, &solver.constraint)?;
    let end = match report.status {
        Status::Converged => End::Converged,
        Status::Detached if holds(scene) => End::Lost,
        Status::Detached => End::Detached,
        Status::Stalled if at_floor => End::Floor,
        Status::Stalled => End::Stalled,
        _ => End::Limit,
    };
    Ok(Judged { end, iterations: report.iterations, distance, verdicts })
}

/// Checks that the energy never rises within a round, but for rounding, in `f64` the rounding of changes in `f32`.
fn falls<T: Real>(scene: &Scene, history: &[Iteration], magnitude: f64) -> Result<(), String> {
    if matches!(scene.constraint, Constraint::Uzawa | Constraint::Paper) {
        return Ok(());
    }
    let size = history.iter().map(|i| i.energy.abs()).fold(magnitude, f64::max);
    // of two sums of a change, its work and its elastic energy
    let allowed = (64.0 * T::epsilon().widen()).max(2.0 * f64::from(f32::EPSILON)) * size;
    let within = history.windows(2).filter(|pair| pair[0].round == pair[1].round);
    let rise = within.map(|pair| pair[1].energy - pair[0].energy).fold(0.0, f64::max);
    if rise <= allowed { Ok(()) } else { Err(format!("energy rises by {rise:e} of {size:e}")) }
}

/// Whether a state holds the tension of a scene: one that is found as the surfaces are taken apart by their mean gap,
/// or by their approach.
fn holds(scene: &Scene) -> bool {
    let area = scene.grid.lengths().0 * scene.grid.lengths().1;
    let load = match scene.control {
        Control::MeanPressure(pressure) => pressure,
        Control::Force(force) => force / area,
        _ => return false,
    };
    let free = scene.body == Body::Free;
    // from a given start a branch is followed to its end
    if scene.start.is_some() || scene.law.is_none() || !free && !scene.is_whole() {
        return false;
    }
    let heights = scene.centred();
    let span = heights.iter().fold(0.0_f64, |most, h| most.max(h.abs()));
    let mut last: Option<Array2<f64>> = None;
    (0..16).any(|step| {
        let far = f64::from(step) / 15.0;
        let control = match free {
            true => Control::Approach(0.5 * span - far * (0.5 * span + 3.0 * scene.law.range) - scene.law.rest()),
            false => Control::MeanGap(scene.law.rest() + far * (span + 3.0 * scene.law.range)),
        };
        let settings = Settings::default().tolerance(1e-5);
        let start = last.take();
        let here = Scene { control, settings, start, precision: Precision::Mixed, ..scene.clone() };
        let Ok(solution) = here.solution::<f64>() else { return false };
        let held = solution.report.status == Status::Converged && solution.report.mean_pressure <= 1.02 * load;
        last = Some(solution.gap.mapv(|gap| if gap.is_finite() { gap } else { 0.0 }));
        held
    })
}

/// Of a thousand scenes how many end solved (converged or detached), and how many solved or at the floor of rounding: in
/// `f32`, in `f64`, and in `f64` with corrections in `f32`.
type Rates = [[u32; 2]; 3];

/// What is held, by constraint and law.
const ENDS: &[(Constraint, Kind, Rates)] = &[
    (Constraint::Hard, Kind::None, [[714, 995], [977, 998], [976, 998]]),
    (Constraint::Hard, Kind::Exponential, [[843, 1000], [994, 1000], [1000, 1000]]),
    (Constraint::Hard, Kind::MaugisDugdale, [[831, 1000], [976, 991], [997, 997]]),
    (Constraint::Hard, Kind::LennardJones, [[837, 982], [1000, 1000], [997, 1000]]),
    (Constraint::Hard, Kind::Morse, [[811, 994], [994, 1000], [997, 997]]),
    (Constraint::Hard, Kind::PowerLaw, [[781, 1000], [997, 997], [991, 994]]),
    (Constraint::Hard, Kind::Table, [[758, 997], [991, 994], [1000, 1000]]),
    (Constraint::Hard, Kind::CutOff, [[778, 991], [994, 997], [994, 997]]),
    (Constraint::Hard, Kind::Varying, [[828, 994], [994, 1000], [994, 997]]),
    (Constraint::Paper, Kind::None, [[752, 946], [920, 929], [840, 867]]),
    (Constraint::Penalty, Kind::None, [[752, 991], [973, 1000], [955, 973]]),
    (Constraint::Penalty, Kind::Exponential, [[805, 1000], [991, 1000], [982, 991]]),
    (Constraint::Penalty, Kind::MaugisDugdale, [[787, 1000], [1000, 1000], [991, 1000]]),
    (Constraint::Penalty, Kind::LennardJones, [[787, 982], [991, 1000], [973, 1000]]),
    (Constraint::Penalty, Kind::Morse, [[778, 1000], [982, 982], [973, 1000]]),
    (Constraint::Penalty, Kind::PowerLaw, [[761, 1000], [991, 1000], [1000, 1000]]),
    (Constraint::Penalty, Kind::Table, [[823, 1000], [982, 1000], [991, 1000]]),
    (Constraint::Penalty, Kind::CutOff, [[752, 991], [982, 982], [982, 982]]),
    (Constraint::Penalty, Kind::Varying, [[778, 982], [991, 1000], [982, 982]]),
    (Constraint::Uzawa, Kind::None, [[654, 1000], [982, 1000], [938, 964]]),
    (Constraint::Uzawa, Kind::Exponential, [[814, 982], [982, 982], [973, 973]]),
    (Constraint::Uzawa, Kind::MaugisDugdale, [[734, 982], [982, 991], [1000, 1000]]),
    (Constraint::Uzawa, Kind::LennardJones, [[796, 973], [964, 973], [982, 1000]]),
    (Constraint::Uzawa, Kind::Morse, [[778, 991], [964, 973], [982, 982]]),
    (Constraint::Uzawa, Kind::PowerLaw, [[849, 991], [982, 982], [991, 991]]),
    (Constraint::Uzawa, Kind::Table, [[787, 1000], [1000, 1000], [955, 982]]),
    (Constraint::Uzawa, Kind::CutOff, [[787, 973], [964, 964], [991, 991]]),
    (Constraint::Uzawa, Kind::Varying, [[743, 991], [982, 982], [1000, 1000]]),
    (Constraint::None, Kind::LennardJones, [[707, 995], [995, 1000], [986, 991]]),
    (Constraint::None, Kind::Morse, [[756, 986], [986, 986], [995, 995]]),
    (Constraint::None, Kind::CutOff, [[725, 982], [995, 1000], [973, 995]]),
    (Constraint::None, Kind::Varying, [[734, 982], [982, 982], [1000, 1000]]),
];

/// What may be wrong with a solution, by name.
type Wrong = (&'static str, fn(&mut Solution<f64>));

/// What a solution may be wrong in is noticed.
#[test]
fn the_matrices_notice_what_is_wrong() {
    let features =
        Features { precisions: &[Precision::Mixed], laws: &[Kind::None, Kind::Exponential], ..Features::HARD };
    let wrongs: [Wrong; 8] = [
        ("fields", |solution| solution.report.mean_contact_pressure *= 1.0 + 1e-9),
        ("contact", |solution| solution.report.contact_nodes += 1),
        ("pressure", |solution| solution.pressure.mapv_inplace(|p| p * (1.0 + 1e-6))),
        ("elastic", |solution| solution.report.elastic_energy *= 1.01),
        ("certificate", |solution| solution.report.relative_error *= 0.5),
        ("load", |solution| solution.report.mean_pressure *= 1.01),
        ("status", |solution| solution.report.load_error += 0.1),
        ("gap", |solution| solution.gap.mapv_inplace(|gap| 1.001 * gap)),
    ];
    let mut noticed = [0; 8];
    let scenes = (0..200).map(|seed| Scene::with_features(seed, &features));
    for scene in scenes.filter(|scene| scene.body == Body::Periodic && scene.relief == "noise") {
        let (solution, problem) = (scene.solution::<f64>().unwrap(), scene.problem::<f64>().unwrap());
        if solution.report.status != Status::Converged || solution.report.contact_nodes == 0 {
            continue;
        }
        for (noticed, (_, wrong)) in noticed.iter_mut().zip(wrongs) {
            let mut solution = solution.clone();
            wrong(&mut solution);
            let judge = Judge::new(&scene, &solution, asperity::constraint::Wall::Rigid, problem.operator());
            *noticed += usize::from(judge.all().is_err());
        }
    }
    for (noticed, (name, _)) in noticed.into_iter().zip(wrongs) {
        assert!(noticed > 10, "{name}: {noticed}");
    }
}

fn variable(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |value| value.parse().expect("a number"))
}

#[test]
fn random_scenes_agree_with_dense_matrices_and_end_as_they_should() {
    Account::collect(0..885).check();
}

#[test]
fn scenes_of_the_law_that_has_the_range_of_the_grid_agree_with_dense_matrices() {
    let count = variable("SCENES", 360);
    let (mut ends, mut wrong) = (BTreeMap::<End, u64>::new(), Vec::new());
    for seed in 0..count {
        let scene = Scene::with_features(seed, &Features::JKR);
        match judge(&scene) {
            Ok(judged) => *ends.entry(judged.end).or_default() += 1,
            Err(what) => wrong.push(format!("{scene}: {what}")),
        }
    }
    println!("{ends:?}");
    assert!(wrong.is_empty(), "{wrong:#?}");
    let solved: u64 = [End::Converged, End::Detached, End::Floor].iter().filter_map(|end| ends.get(end)).sum();
    assert!(solved * 100 >= count * 98, "{ends:?}");
}

/// Of a thousand scenes of some physics how many end solved, or at the floor of rounding.
const MORE: [(&str, f64); 8] = [
    ("hardness", 997.0),
    ("hardness with adhesion", 997.0),
    ("layer", 991.0),
    ("coating", 998.0),
    ("pair", 995.0),
    ("law that ends", 995.0),
    ("no load, loading", 996.0),
    ("no load, unloading", 990.0),
];

/// More scenes: `SCENES=20000 cargo test --release --test library more_physics -- --nocapture`, from `FIRST` on.
#[test]
fn scenes_of_more_physics_agree_with_dense_matrices() {
    let (first, count) = (variable("FIRST", 0), variable("SCENES", 273));
    let (mut tallies, mut wrong) = (BTreeMap::<&str, Tally>::new(), Vec::new());
    for scene in (first..first + count).map(|seed| Scene::with_features(seed, &Features::MORE)) {
        if count == 1 {
            println!("{scene:#?}");
        }
        match caught(&scene) {
            Err(what) => wrong.push(what),
            Ok(judged) => scene.physics().into_iter().for_each(|name| {
                *tallies.entry(name).or_default().ends.entry(judged.end).or_default() += 1;
            }),
        }
    }
    let mut missed = Vec::new();
    for (name, rate) in MORE {
        let tally = tallies.remove(name).unwrap_or_default();
        let (bad, expected) = ((tally.all() - tally.good()[1]) as f64, tally.all() as f64 * (1.0 - 1e-3 * rate));
        println!("{name}: {} scenes, {:?}, {bad} bad and {expected:.1} held", tally.all(), tally.ends);
        if bad > expected + 3.0 * expected.sqrt() + 1.0 {
            missed.push(name);
        }
    }
    wrong.iter().take(100).for_each(|wrong| println!("{wrong}"));
    assert!(wrong.is_empty() && missed.is_empty(), "{} wrong; rates missed of {missed:?}", wrong.len());
}

/// Compared with the depths these mean gaps are hardly any.
#[test]
fn walls_that_yield_are_right_at_the_least_mean_gaps() {
    for seed in [5601, 6108, 7808, 8640, 9717, 10223, 11841, 15680, 15982, 19503] {
        caught(&Scene::with_features(seed, &Features::MORE)).unwrap();
    }
}

/// A constant of the driver, how scenes end that it decides, and these scenes with iterations that are enough.
type Decided = (&'static str, End, &'static [(u64, usize)]);

/// Scenes that a constant of the driver decides: without it they end otherwise, or take about twice as many iterations.
const DECIDED: &[Decided] = &[
    ("LEAST of a step", End::Converged, &[(3367, 40), (3622, 30), (4822, 40)]),
    ("FAR", End::Converged, &[(658, 40), (4939, 14), (1771, 24)]),
    ("HELD", End::Converged, &[(1232, 100), (2471, 60), (4939, 14)]),
    ("HALF of a gap", End::Converged, &[(4049, 60), (4246, 100), (4424, 30)]),
    ("HARDLY of a load", End::Converged, &[(773, 40), (802, 40), (2731, 25)]),
    ("HARDLY of a tension", End::Converged, &[(2363, 200), (3074, 170), (4999, 90)]),
    ("TWICE a rise", End::Detached, &[(1111, 90), (2745, 50), (3171, 80)]),
    ("REFRESH", End::Converged, &[(1329, 200), (3282, 300), (3498, 200)]),
    ("ROUNDINGS", End::Converged, &[(3869, 80), (4703, 60)]),
    ("ROUGHLY", End::Detached, &[(2076, 40), (3777, 60), (3984, 100)]),
    ("MOSTLY of a step", End::Converged, &[(1003, 90), (1503, 220), (3175, 55)]),
    ("STALL, the first", End::Converged, &[(656, 200), (1688, 190)]),
    ("STALL, the second", End::Stalled, &[(7425, 100), (14238, 100)]),
    ("CERTIFY", End::Converged, &[(1160, 20), (1337, 20), (1691, 20)]),
    ("PROGRESS of the error", End::Floor, &[(2121, 300), (7239, 300), (15099, 400)]),
    ("PROGRESS of a proof", End::Floor, &[(2112, 69), (16446, 52)]),
    ("PATIENCE", End::Converged, &[(1336, 250), (2576, 400)]),
    // the proof of the end that fails
    ("refute", End::Converged, &[(11144, 70)]),
    // the trial at full length after one that failed
    ("preconditioned_step", End::Converged, &[(523, 200), (660, 200), (3726, 50)]),
];

#[test]
fn a_constant_decides_scenes() {
    let mut otherwise = Vec::new();
    for &(constant, end, scenes) in DECIDED {
        for &(seed, enough) in scenes {
            let judged = judge(&Scene::new(seed)).unwrap();
            if judged.end != end || judged.iterations > enough {
                otherwise.push((constant, seed, judged.end, judged.iterations));
            }
        }
    }
    assert!(otherwise.is_empty(), "{otherwise:#?}");
}

#[test]
#[ignore = "some minutes; see above"]
fn all_scenes() {
    let (first, count) = (variable("FIRST", 0), variable("SCENES", 20_000));
    let account = Account::collect(first..first + count);
    if count == 1 {
        println!("{:#?}", Scene::new(first));
    }
    account.print();
    account.check();
}
