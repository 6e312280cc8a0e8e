//! The pull-off of spheres and of rough surfaces, against exact solutions and paths.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use asperity::accuracy::{Accuracy, Quantity};
use asperity::adhesion::Formula;
use asperity::exact::Sphere;
use asperity::path::{Path, PathSettings};
use asperity::{
    AdhesionLaw, Amplitude, Boussinesq, Branch, Control, Error, Exponential, Grid, Jkr, MaugisDugdale, NoAdhesion,
    Penalty, Problem, PullOff, SelfAffine, Settings, Solver, Start, Status, Surface, Sweep, Westergaard, exact,
};
use oracles::followed;

fn sphere(nodes: usize, side: f64, radius: f64, law: impl AdhesionLaw<f64> + 'static) -> Problem<f64> {
    let grid = Grid::square(nodes, side).unwrap();
    let surface = Surface::paraboloid(grid, radius).unwrap();
    Problem::new(&surface, Boussinesq::new(grid, 1.0).unwrap(), law).unwrap()
}

fn rough(law: impl AdhesionLaw<f64> + 'static) -> Problem<f64> {
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = SelfAffine::default().k_l(2.0).k_s(8.0).surface(grid).unwrap();
    Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap()
}

/// The force of a sphere to 0.2 %.
fn force(problem: &mut Problem<f64>) -> f64 {
    let found = PullOff::default().tolerance(2e-3).find(&mut Solver::default(), problem).unwrap();
    assert!(found.reached && found.branch == Some(Branch::Unloading) && !found.solution.report.reaches_edge);
    -found.solution.report.normal_force
}

#[test]
fn spheres_of_dugdale_come_off_as_maugis_says() {
    // from soft to stiff: Maugis' parameter is 1.6, 0.8 and 0.2
    for (range, side) in [(1e-3, 0.26), (2e-3, 0.26), (8e-3, 0.5)] {
        let (radius, work) = (2.0, 2e-5);
        let exact = -exact::MaugisDugdale::new(radius, 1.0, work, range).unwrap().pull_off().load();
        let found = force(&mut sphere(96, side, radius, MaugisDugdale::new(work, range).unwrap()));
        // the grid has 1 % of its own
        assert!((found / exact - 1.0).abs() < 0.012, "{range}: {found} {exact}");
    }
}

#[test]
fn a_stiff_sphere_comes_off_as_bradley_says() {
    // that the body hardly deforms
    let (radius, work, range) = (2.0, 1e-7, 2e-3);
    let found = force(&mut sphere(96, 0.7, radius, Exponential::new(work, range).unwrap()));
    let bradley = 2.0 * PI * radius * work;
    // Derjaguin's sum of all tractions; the window cuts 1e-3
    assert!((found / bradley - 1.0).abs() < 0.02, "{found} {bradley}");
}

#[test]
fn a_path_bears_no_more_and_hardly_less() {
    let law = Exponential::new(1e-4, 4e-3).unwrap();
    let found = PullOff::default().tolerance(1e-3).find(&mut Solver::default(), &mut rough(law)).unwrap();
    let (borne, lost) = (-found.solution.report.mean_pressure, found.lost.unwrap());
    assert!(found.reached && lost - borne <= 1e-3 * lost && found.solves <= 20, "{borne} {lost} {}", found.solves);
    let mut solver = Solver::new(Settings::default().branch(Branch::Unloading));
    let (mut problem, loads) = (rough(law), [5e-4, 0.03].map(Control::MeanGap));
    let settings = PathSettings::default().steps(100);
    let steps = followed(Path::new(loads, settings).unwrap(), &mut solver, &mut problem);
    let greatest = steps.iter().map(|step| -step.solution.report.mean_pressure).fold(0.0, f64::max);
    assert!(greatest <= lost && greatest >= borne * (1.0 - 2e-3), "{greatest}: {borne} to {lost}");
    assert!(found.operator_applications < 1000, "{}", found.operator_applications);
}

#[test]
fn what_was_before_matters_where_there_are_two_branches() {
    let grid = Grid::line(128, 1.0).unwrap();
    let wave = Surface::wave(grid, 0.02, 1).unwrap();
    let law = Exponential::new(4e-4, 4e-3).unwrap();
    let problem = || Problem::new(&wave, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let find = |pull_off: PullOff, branch: Option<Branch>| {
        let mut solver = Solver::new(Settings::default().branch(branch));
        let found = pull_off.find(&mut solver, &mut problem()).unwrap();
        assert!(found.reached);
        (-found.solution.report.mean_pressure, found.branch)
    };
    let (default, loading) = (PullOff::default(), Some(Branch::Loading));
    // pressed flat it takes a tension to open the first gap; not pressed, or a little, there are gaps already
    let (flat, _) = find(default, None);
    let (touched, branch) = find(default.preload(Some(0.0)), None);
    assert!(branch == loading && flat > 3.0 * touched, "{flat} {touched}");
    assert_eq!(find(default, loading), (touched, loading));
    let (pressed, _) = find(default.preload(Some(1.0)), None);
    assert!((pressed / flat - 1.0).abs() < 0.02, "{pressed} {flat}");

    let held = Solver::default().solve(&mut problem(), Control::MeanPressure(0.0)).unwrap();
    let (begin, go_on) = (Start::From(&held.gap), |_: &_| ControlFlow::Continue(()));
    let found = default.find_from(&mut Solver::default(), &mut problem(), begin, go_on).unwrap();
    assert!(found.reached && found.branch.is_none());
    assert!((-found.solution.report.mean_pressure / touched - 1.0).abs() < 0.02);
}

#[test]
fn what_bears_no_tension_is_refused_and_a_search_that_is_stopped_says_so() {
    let law = Exponential::new(1e-4, 4e-3).unwrap();
    let default = PullOff::default();
    let refused = default.find(&mut Solver::default(), &mut rough(NoAdhesion)).unwrap_err();
    assert!(matches!(refused, Error::Unsuited { what: "pull-off", .. }), "{refused}");
    let springs = &mut Solver { settings: Settings::default(), constraint: Penalty::new(100.0).unwrap() };
    assert!(matches!(default.find(springs, &mut rough(law)), Err(Error::Unsuited { what: "springs", .. })));
    for tolerance in [0.0, 1.0, f64::NAN] {
        let refused = default.tolerance(tolerance).find(&mut Solver::default(), &mut rough(law));
        assert!(matches!(refused, Err(Error::Value { name: "tolerance of the pull-off", .. })));
    }
    let stop = |_: &_| ControlFlow::Break(());
    let stopped = default.find_from(&mut Solver::default(), &mut rough(law), Start::Default, stop).unwrap();
    assert_eq!((stopped.reached, stopped.lost, stopped.solution.report.status), (false, None, Status::Stopped));
    let mut solver = Solver::new(Settings::default().max_iterations(2_usize));
    let short = default.find(&mut solver, &mut rough(law)).unwrap();
    assert!(!short.reached && short.solution.report.status == Status::IterationLimit);
}

#[test]
fn surfaces_that_were_pressed_hold_each_other_by_weak_adhesion() {
    let grid = Grid::square(32, 1.0).unwrap();
    for seed in [4, 5, 6] {
        let surface =
            SelfAffine::default().k_s(4.0).amplitude(Amplitude::RmsSlope(0.3)).seed(seed).surface(grid).unwrap();
        let laws: [Formula; 2] = [Jkr::new(2e-10).unwrap().into(), MaugisDugdale::new(2e-10, 1e-6).unwrap().into()];
        for law in laws {
            let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
            let mut find = |search: PullOff| {
                let found = search.find(&mut Solver::default(), &mut problem).unwrap();
                assert!(found.reached, "{seed}");
                -found.solution.report.mean_pressure
            };
            let (flat, pressed) = (find(PullOff::default()), find(PullOff::default().preload(Some(0.01))));
            // by the last node in both
            assert!((pressed / flat - 1.0).abs() < 0.05, "{seed}: {pressed} {flat}");
            let mut sweep = Sweep::default();
            let fall = [0.01, 1e-4, 0.0].map(Control::MeanPressure);
            let [.., last] = fall.map(|load| sweep.next(&mut Solver::default(), &mut problem, load).unwrap());
            assert!(last.report.contact_nodes > 0, "{seed}");
        }
    }
}

#[test]
fn a_search_goes_on_where_a_rough_state_lacks_a_part_of_a_light_load() {
    let grid = Grid::square(256, 1.0).unwrap();
    let surface = SelfAffine::default().k_s(32.0).seed(105).surface(grid).unwrap();
    let law = Jkr::new(0.03 * 0.1 * 0.1 * surface.rms_height()).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let found = PullOff::default().preload(Some(5e-3)).find(&mut Solver::default(), &mut problem).unwrap();
    assert!(found.reached, "{:?} after {} solves", found.solution.report.status, found.solves);
}

#[test]
fn coarser_grids_make_a_search_cheaper_and_leave_the_pull_off() {
    let (mut alone, mut led) = (0, 0);
    println!(
        "| slope, k_s, adhesion, preload | pull-off | applications | from coarser grids | applications |\n|---|---|---|---|---|"
    );
    for number in 0..8 {
        let [k_s, slope] = [[8.0, 16.0][number % 2], [0.02, 0.1, 0.3][number % 3]];
        let [adhesion, preload] = [[3e-3, 0.01, 0.03][number * 2 % 3], 0.1 * slope];
        let grid = Grid::square(128, 1.0).unwrap();
        let height = SelfAffine::default().k_s(k_s).seed(100 + number as u64).amplitude(Amplitude::RmsSlope(slope));
        let surface = height.surface(grid).unwrap();
        let law = Jkr::new(adhesion * slope * slope / k_s).unwrap();
        let body = |grid| Westergaard::<f64>::new(grid, 1.0);
        let search = PullOff::default().preload((number % 4 > 0).then_some(preload));
        let mut problem = Problem::new(&surface, body(grid).unwrap(), law).unwrap();
        let one = search.find(&mut Solver::default(), &mut problem).unwrap();
        let accuracy = Accuracy::new(f64::INFINITY, Quantity::Area);
        let other = accuracy.pull_off(&mut Solver::default(), &surface, body, law, &search).unwrap().found;
        let [tension, from_coarser] = [&one, &other].map(|found| -found.solution.report.mean_pressure);
        let costs = [&one, &other].map(|found| found.operator_applications);
        println!(
            "| {slope}, {k_s}, {adhesion}, {:?} | {tension:.3e} | {} | {from_coarser:.3e} | {} |",
            search.preload, costs[0], costs[1]
        );
        // both brackets are 2 % wide, and long steps may lose a contact more
        assert!(one.reached && other.reached && (from_coarser / tension - 1.0).abs() < 0.03);
        assert!(other.solution.report.relative_error <= Settings::default().tolerance_in::<f64>());
        (alone, led) = (alone + costs[0], led + costs[1]);
    }
    println!("{alone} applications, from coarser grids {led}");
    // 2742 and 2363; single scenes from 0.61 to 1.43
    assert!(led < alone && alone <= 2850 && led <= 2450, "{alone} {led}");
}
