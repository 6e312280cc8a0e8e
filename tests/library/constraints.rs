//! Penalty and Uzawa against projection: the same solution, at the price that each of them asks.
//!
//! `cargo test --release --test library uzawa_on_random_scenes -- --ignored --nocapture` prints how Uzawa ends on 2000
//! random scenes for stiffnesses of all sizes, and what it costs; `CASES` says on how many.
//! `cargo test --release --test library constraints::figures -- --ignored --nocapture` prints the table of the guide.

mod adhesive;
mod uzawa;

use approx::assert_relative_eq;
use asperity::adhesion::Values;
use asperity::constraint::{Springs, Wall, check_constraint};
use asperity::*;
use oracles::outrun::Outrun;
use oracles::scenes::{Features, Kind, Precision, Scene};
use oracles::{energy_norms, rough, solve, sphere};

const WALLED: Features =
    Features { laws: &[Kind::None, Kind::None, Kind::Exponential, Kind::MaugisDugdale], ..Features::HARD };

/// The solution by projection, and by Uzawa from springs of a stiffness, which took so many rounds.
fn both<T: Real>(scene: &Scene, stiffness: f64) -> (Solution<T>, Solution<T>, usize) {
    let mut solver = Solver { settings: scene.settings, constraint: Uzawa::new(stiffness).unwrap() };
    let solution = solver.solve(&mut scene.problem::<T>().unwrap(), scene.control).unwrap();
    let projected = Scene { start: None, ..scene.clone() }.solution().unwrap();
    (projected, solution, solver.constraint.rounds())
}

fn with<T: Real, C: ContactConstraint<T> + 'static>(
    problem: &mut Problem<T>,
    constraint: C,
    control: Control,
    tolerance: f64,
) -> (Solution<T>, C) {
    let mut solver = Solver { settings: Settings::default().tolerance(tolerance), constraint };
    let solution = solver.solve(problem, control).unwrap();
    (solution, solver.constraint)
}

#[test]
fn a_penalty_interpenetrates_by_the_pressure_over_its_stiffness() {
    let control = Control::MeanGap(0.0398);
    let exact = solve(&mut sphere::<f64>(64, NoAdhesion), control, 1e-9).report;
    let mut last = f64::INFINITY;
    for stiffness in [50.0, 500.0, 5000.0] {
        let constraint = Penalty::new(stiffness).unwrap();
        let (solution, _) = with(&mut sphere(64, NoAdhesion), constraint, control, 1e-8);
        let report = &solution.report;
        assert_eq!(report.status, Status::Converged);
        let deepest = solution.contact_pressure.iter().copied().fold(0.0, f64::max);
        assert_relative_eq!(report.min_gap, -deepest / stiffness, max_relative = 1e-9);
        assert_eq!(report.contact_nodes, solution.gap.iter().filter(|&&g| g < 0.0).count());
        // the pressure is softer than the rigid one by about the springs' compliance compared with the contact's
        let error = (report.mean_pressure / exact.mean_pressure - 1.0).abs();
        assert!(error < last && error < 20.0 / stiffness, "{error}");
        last = error;
    }
}

#[test]
fn uzawa_removes_the_interpenetration_whatever_its_stiffness() {
    let control = Control::MeanGap(0.0398);
    let exact = solve(&mut sphere::<f64>(64, NoAdhesion), control, 1e-9).report;
    for stiffness in [50.0, 500.0] {
        let (solution, uzawa) = with(&mut sphere(64, NoAdhesion), Uzawa::new(stiffness).unwrap(), control, 1e-9);
        assert_eq!((solution.report.status, solution.report.contact_nodes), (Status::Converged, exact.contact_nodes));
        assert!(uzawa.rounds() > 2);
        // even if all that interpenetrates were in the shortest wave, its energy were less than the tolerance
        let stiffest = sphere::<f64>(64, NoAdhesion).operator().stiffness_range().1;
        let depth = solution.gap.mapv(|g: f64| g.min(0.0).powi(2)).mean().unwrap();
        assert!(depth > 0.0 && 0.5 * stiffest * depth <= 1e-18 * solution.report.elastic_energy);
        assert_relative_eq!(solution.report.mean_pressure, exact.mean_pressure, max_relative = 1e-6);
    }
}

#[test]
fn stiff_springs_take_hardly_more_applications_than_a_wall() {
    let law = || Exponential::new(2e-4, 2e-3).unwrap();
    for (mut problem, control, counted) in [
        (rough::<f64>(128, 32, NoAdhesion), Control::MeanPressure(0.02), [29, 45, 33, 38, 38]),
        (rough(128, 32, NoAdhesion), Control::MeanGap(0.02), [27, 45, 41, 30, 30]),
        (rough(128, 32, law()), Control::MeanGap(0.02), [35, 51, 63, 42, 42]),
    ] {
        let stiffest = problem.operator().stiffness_range().1;
        let walls: [Box<dyn ContactConstraint<f64>>; 5] = [
            Box::new(Projection),
            Box::new(Penalty::new(10.0 * stiffest).unwrap()),
            Box::new(Penalty::new(1000.0 * stiffest).unwrap()),
            Box::new(Uzawa::new(0.1 * stiffest).unwrap()),
            Box::new(Uzawa::new(stiffest).unwrap()),
        ];
        let taken = walls.map(|wall| {
            let report = with(&mut problem, wall, control, 1e-6).0.report;
            assert_eq!(report.status, Status::Converged);
            report.operator_applications
        });
        // rounding, which differs between processors, may add a few iterations
        assert!(
            taken.iter().zip(counted).all(|(&taken, counted)| taken <= counted + 6),
            "{taken:?} and not {counted:?}"
        );
    }
}

#[test]
fn springs_have_the_same_values_together_as_one_by_one() {
    let (solution, uzawa) =
        with(&mut sphere::<f64>(32, NoAdhesion), Uzawa::new(500.0).unwrap(), Control::MeanGap(0.0398), 1e-8);
    let penalty = Penalty::new(500.0).unwrap();
    let walls: [&dyn ContactConstraint<f64>; 2] = [&penalty, &uzawa];
    let nodes = 400..700;
    let gaps: Vec<_> = solution.gap.iter().skip(nodes.start).take(nodes.len()).map(|gap| gap - 1e-5).collect();
    for wall in walls {
        let Wall::Springs(springs) = wall.wall() else { unreachable!() };
        let [mut energies, mut tractions, mut slopes] = [(); 3].map(|()| vec![0.0; gaps.len()]);
        let values = [&mut energies, &mut tractions, &mut slopes];
        let [energies_of, tractions_of, slopes_of] = values.map(|all| Some(all.as_mut_slice()));
        let values = Values { energies: energies_of, tractions: tractions_of, slopes: slopes_of };
        springs.evaluate(nodes.start, &gaps, values);
        for (i, (node, &gap)) in nodes.clone().zip(&gaps).enumerate() {
            let one = [springs.energy(node, gap), springs.traction(node, gap), springs.slope(node, gap)];
            assert_eq!([energies[i], tractions[i], slopes[i]], one);
        }
        assert!(slopes.contains(&0.0) && slopes.iter().any(|&slope| slope >= 500.0));
    }
}

/// Springs that are content with any state, so that rounds need not be solved.
struct Content(Penalty, usize);

impl ContactConstraint<f64> for Content {
    fn wall(&self) -> Wall<'_, f64> {
        self.0.wall()
    }
    fn round_tolerance(&self) -> f64 {
        0.1
    }
    fn update(&mut self, _: ndarray::ArrayView2<'_, f64>, work: f64) -> constraint::Update {
        assert!(work > 0.0);
        self.1 += 1;
        constraint::Update::Done
    }
}

#[test]
fn a_constraint_that_is_met_early_is_solved_to_the_tolerance() {
    let (control, penalty) = (Control::MeanGap(0.0398), Penalty::new(500.0).unwrap());
    let (closely, _) = with(&mut sphere::<f64>(32, NoAdhesion), penalty, control, 1e-8);
    let (content, Content(_, asked)) = with(&mut sphere(32, NoAdhesion), Content(penalty, 0), control, 1e-8);
    assert_eq!((content.report.status, asked), (Status::Converged, 2));
    assert!(content.report.relative_error <= 1e-8);
    assert_relative_eq!(content.report.mean_pressure, closely.report.mean_pressure, max_relative = 1e-7);
}

#[test]
fn uzawa_that_may_not_update_enough_has_not_converged() {
    let mut constraint = Uzawa::<f64>::new(100.0).unwrap();
    constraint.max_rounds = 2;
    let (solution, uzawa) = with(&mut sphere(32, NoAdhesion), constraint, Control::MeanGap(0.0398), 1e-8);
    assert_eq!((solution.report.status, uzawa.rounds()), (Status::IterationLimit, 2));
    assert!(solution.report.min_gap < 0.0);
}

#[test]
fn every_law_control_and_precision_works_with_them() {
    let law = MaugisDugdale::new(1e-4, 4e-3).unwrap();
    let pull = Control::MeanPressure(-3e-4);
    let exact = solve(&mut sphere::<f64>(48, law), pull, 1e-8).report;
    let (uzawa, _) = with(&mut sphere(48, law), Uzawa::<f64>::new(300.0).unwrap(), pull, 1e-8);
    assert_eq!(uzawa.report.status, Status::Converged);
    assert_relative_eq!(uzawa.report.mean_gap, exact.mean_gap, max_relative = 1e-2);

    let press = Control::MeanPressure(0.1);
    let exact = solve(&mut rough::<f64>(64, 16, NoAdhesion), press, 1e-8).report;
    let (penalty, _) = with(&mut rough::<f64>(64, 16, NoAdhesion), Penalty::new(1e4).unwrap(), press, 1e-7);
    assert_eq!(penalty.report.status, Status::Converged);
    assert_relative_eq!(penalty.report.mean_gap, exact.mean_gap, max_relative = 1e-2);
    let (single, _) = with(&mut rough::<f32>(64, 16, NoAdhesion), Uzawa::new(500.0).unwrap(), press, 1e-4);
    assert_eq!(single.report.status, Status::Converged);
    assert_relative_eq!(single.report.mean_gap, exact.mean_gap, max_relative = 1e-3);
}

#[test]
fn bad_stiffnesses_are_refused() {
    for stiffness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Penalty::new(stiffness).is_err() && Uzawa::<f64>::new(stiffness).is_err());
    }
    // what only f64 can hold
    for stiffness in [1e-60, 1e60] {
        assert!(Uzawa::<f32>::new(stiffness).is_err());
        let mut penalty = Solver { settings: Settings::default(), constraint: Penalty::new(stiffness).unwrap() };
        let refused = penalty.solve(&mut rough::<f32>(16, 4, NoAdhesion), Control::MeanGap(0.01)).unwrap_err();
        assert!(matches!(refused, Error::Value { name: "penalty stiffness", .. }));
        assert!(penalty.solve(&mut rough::<f64>(16, 4, NoAdhesion), Control::MeanGap(0.01)).is_ok());
    }
}

#[test]
fn report_and_contact_map_count_the_same_nodes() {
    fn agree<T: Real>(solution: &Solution<T>, name: &str) {
        let map = solution.contact_map();
        let report = &solution.report;
        let count = map.iter().filter(|&&touches| touches).count();
        assert_eq!((report.contact_nodes, report.contact_fraction), (count, count as f64 / map.len() as f64), "{name}");
        // every contact pressure is in contact, and nothing else interpenetrates
        for ((&touches, &gap), &pressure) in map.iter().zip(&solution.gap).zip(&solution.contact_pressure) {
            assert_eq!(touches, gap <= T::zero() || pressure > T::zero(), "{name}");
        }
    }
    let mut rounds = 0;
    for seed in 0..60 {
        let scene = Scene::with_features(seed, &WALLED);
        let (projected, uzawa, outer) = both::<f64>(&scene, scene.stiffness);
        let penalty = Solver { settings: Settings::default(), constraint: Penalty::new(scene.stiffness).unwrap() }
            .solve(&mut scene.problem::<f64>().unwrap(), scene.control)
            .unwrap();
        for (solution, name) in [(projected, "projection"), (uzawa, "Uzawa"), (penalty, "penalty")] {
            agree(&solution, &format!("{seed} {name}"));
        }
        rounds += outer;
    }
    assert!(rounds > 120, "{rounds}");
    // a solve that ends early, and flats that touch without a pressure
    let mut early = Uzawa::new(100.0).unwrap();
    early.max_rounds = 2;
    agree(&with(&mut sphere::<f64>(32, NoAdhesion), early, Control::MeanGap(0.0398), 1e-8).0, "early");
    let grid = Grid::square(8, 1.0).unwrap();
    let flat = Surface::new(grid, ndarray::Array2::zeros((8, 8))).unwrap();
    let mut problem = Problem::new(&flat, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let (touching, _) = with(&mut problem, Penalty::new(100.0).unwrap(), Control::MeanGap(0.0), 1e-6);
    assert_eq!(touching.report.contact_nodes, 64);
    agree(&touching, "flats");
}

/// A figure of a table, to two digits.
pub fn short(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

/// Springs with one wrong function, or that give way.
struct Spoiled(f64, f64);

impl ContactConstraint<f64> for Spoiled {
    fn wall(&self) -> Wall<'_, f64> {
        Wall::Springs(self)
    }
}

impl Springs<f64> for Spoiled {
    fn energy(&self, _: usize, gap: f64) -> f64 {
        0.5 * self.0 * gap.min(0.0).powi(2)
    }
    fn traction(&self, _: usize, gap: f64) -> f64 {
        self.0 * self.1 * gap.min(0.0)
    }
    fn slope(&self, _: usize, gap: f64) -> f64 {
        if gap < 0.0 { self.0 * self.1 } else { 0.0 }
    }
}

#[test]
fn the_checker_of_constraints_names_the_function_that_is_wrong() {
    for depth in [1e-6, 1e-3, 1.0] {
        check_constraint::<f64>(&Penalty::new(50.0).unwrap(), 9, depth).unwrap();
        check_constraint::<f32>(&Penalty::new(50.0).unwrap(), 9, depth).unwrap();
        check_constraint::<f64>(&Uzawa::new(50.0).unwrap(), 9, depth).unwrap();
        check_constraint(&Spoiled(1.0, 1.0), 1, depth).unwrap();
        match check_constraint(&Spoiled(1.0, 1.1), 1, depth) {
            Err(error @ Error::Contract { function: "traction of the springs", .. }) => {
                assert!(error.to_string().contains("as the derivative of the energy"), "{error}");
            }
            other => panic!("{other:?}"),
        }
        let falling = check_constraint(&Spoiled(-1.0, 1.0), 1, depth);
        assert!(matches!(falling, Err(Error::Value { name: "slope of the springs", value: -1.0, .. })), "{falling:?}");
    }
}
