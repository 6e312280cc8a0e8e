//! Adhesion laws: those that repel by themselves, those that vary over the surface, and their costs.

mod counts;
mod dense;
mod varying;

use std::f64::consts::PI;
use std::sync::Arc;

use asperity::adhesion::{CutOff, Hints, Values, Varying};
use asperity::stability::{StabilityTest, Verdict};
use asperity::*;
use ndarray::Array2;

use crate::constraints::short;
use oracles::dense::Dense;
use oracles::rough::rough;

#[test]
#[ignore = "figures of the guide: cargo test --release --test library laws::walls -- --ignored --nocapture"]
fn walls_in_figures() {
    fn solve(law: impl AdhesionLaw<f64> + 'static, constraint: impl ContactConstraint<f64> + 'static) -> Solution<f64> {
        let (grid, half_space) = unit(128);
        let mut problem = Problem::new(&rough(grid, 16, 1), half_space, law).unwrap();
        let settings = Settings::default();
        Solver { settings, constraint }.solve(&mut problem, Control::MeanPressure(0.05)).unwrap()
    }
    let norm = |field: &Array2<f64>| field.iter().map(|p| p * p).sum::<f64>().sqrt();
    println!("\n| law and wall | applications | error of the pressure | contact, % |\n|---|---|---|---|");
    let show = |name: &str, solution: &Solution<f64>, exact: &Solution<f64>| {
        let error = norm(&(&solution.contact_pressure - &exact.contact_pressure)) / norm(&exact.contact_pressure);
        let Report { status, operator_applications, contact_fraction, .. } = &solution.report;
        println!("| {name} | {operator_applications} | {} | {:.2} |", short(error), 100.0 * contact_fraction);
        assert_eq!(*status, Status::Converged);
    };
    let (work, range) = (2e-4, 4e-3);
    let (lennard_jones, morse) = (LennardJones::new(work, range).unwrap(), Morse::new(work, range).unwrap());
    let (hard, rigid) = (solve(lennard_jones.cut(), Projection), solve(morse, Projection));
    show("Lennard-Jones, wall at z₀", &hard, &hard);
    show("Lennard-Jones, no wall", &solve(lennard_jones, NoWall), &hard);
    show("Morse, wall", &rigid, &rigid);
    show("Morse, no wall", &solve(morse, NoWall), &rigid);
    for k in [1.0, 10.0, 100.0, 1e3, 1e4] {
        show(&format!("Lennard-Jones, Uzawa, k = {k:e}"), &solve(lennard_jones.cut(), Uzawa::new(k).unwrap()), &hard);
    }
    for k in [100.0, 1e3, 1e4] {
        show(
            &format!("Lennard-Jones, penalty, k = {k:e}"),
            &solve(lennard_jones.cut(), Penalty::new(k).unwrap()),
            &hard,
        );
    }
}

fn unit(n: usize) -> (Grid, Westergaard<f64>) {
    let grid = Grid::square(n, 1.0).unwrap();
    (grid, Westergaard::new(grid, 1.0).unwrap())
}

fn without_wall(tolerance: f64) -> Solver<NoWall> {
    Solver { settings: Settings::default().tolerance(tolerance), constraint: NoWall }
}

#[test]
fn the_van_der_waals_attraction_has_the_work_and_the_traction_of_its_constant() {
    let (hamaker, distance) = (6e-20, 0.165e-9);
    let law = PowerLaw::van_der_waals(hamaker, distance).unwrap();
    let work = hamaker / (12.0 * PI * distance * distance);
    for gap in [0.0, 0.1e-9, 2e-9] {
        let separation = distance + gap;
        let energy = -work * (distance / separation).powi(2);
        let traction = hamaker / (6.0 * PI * separation.powi(3));
        assert!((AdhesionLaw::<f64>::energy(&law, gap) / energy - 1.0).abs() < 1e-14, "{gap}");
        assert!((AdhesionLaw::<f64>::traction(&law, gap) / traction - 1.0).abs() < 1e-14, "{gap}");
    }
}

#[test]
fn laws_rest_at_their_work_of_adhesion_and_are_the_same_for_many_gaps() {
    let (w, range) = (0.05, 2e-9);
    let laws: [Box<dyn AdhesionLaw<f64>>; 7] = [
        Box::new(LennardJones::new(w, range).unwrap()),
        Box::new(LennardJones::new(w, range).unwrap().cut()),
        Box::new(Morse::new(w, range).unwrap()),
        Box::new(PowerLaw::new(w, range, 3.5).unwrap()),
        Box::new(PowerLaw::van_der_waals(6e-20, 0.165e-9).unwrap()),
        Box::new(CutOff::new(PowerLaw::new(w, range, 2.0).unwrap(), 6e-9).unwrap()),
        Box::new(Tabulated::new(&[0.0, 1e-9, 2e-9, 5e-9], &[20e6, 30e6, 5e6, 0.0]).unwrap()),
    ];
    let gaps: Vec<f64> = (0..40).map(|i| 1.5e-9 + 3e-10 * f64::from(i)).collect();
    for law in &laws {
        let Hints { work_of_adhesion: work, rest, .. } = law.hints();
        assert!((work + law.energy(rest.unwrap_or(0.0))).abs() <= 1e-15 * work);
        let mut found = [(); 3].map(|()| vec![0.0; gaps.len()]);
        let [energies, tractions, slopes] = found.each_mut().map(|values| Some(&mut values[..]));
        law.evaluate(0, &gaps, Values { energies, tractions, slopes });
        for (i, &gap) in gaps.iter().enumerate() {
            let expected = [law.energy(gap), law.traction(gap), law.slope(gap)];
            for (order, size) in [1e-15 * w, 1e-14 * w / range, 1e-13 * w / range / range].into_iter().enumerate() {
                assert!((found[order][i] - expected[order]).abs() <= size, "{order} {gap}");
            }
        }
    }
}

#[test]
fn a_table_of_a_law_is_the_law_between_its_points() {
    let law = Exponential::new(1.0, 1.0).unwrap();
    let error = |points: u32| {
        let gaps: Vec<f64> = (0..=points).map(|i| 12.0 * f64::from(i) / f64::from(points)).collect();
        let mut tractions: Vec<f64> = gaps.iter().map(|&g| law.traction(g)).collect();
        *tractions.last_mut().unwrap() = 0.0;
        let table = Tabulated::new(&gaps, &tractions).unwrap();
        // never more than the table has
        let sampled = (0..2400).map(|i| table.traction(5e-3 * f64::from(i)));
        let (least, most) = sampled.fold((1.0_f64, 0.0_f64), |(a, b), t| (a.min(t), b.max(t)));
        assert!(least >= -1e-15 && most <= 1.0 + 1e-15, "{least:e} {most}");
        (0..1000)
            .map(|i| 1e-2 * f64::from(i))
            .map(|g| (table.energy(g) - law.energy(g) + law.energy(12.0)).abs())
            .fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(60), error(120));
    // the monotone slopes are of second order, so that the tractions are of third, and so the energies
    assert!(coarse < 1e-4 && fine < coarse / 6.0, "{coarse:e} {fine:e}");
}

#[test]
fn tables_that_are_no_laws_are_refused() {
    let refused = |gaps: &[f64], tractions: &[f64], name: &str| match Tabulated::new(gaps, tractions) {
        Err(Error::Value { name: found, .. }) => assert_eq!(found, name),
        other => panic!("{other:?}"),
    };
    refused(&[0.0, 1.0], &[1.0, 0.0], "number of points in the table");
    refused(&[0.0, 1.0, 2.0], &[1.0, 0.0], "number of tractions in the table");
    refused(&[0.0, 2.0, 1.0], &[1.0, 0.5, 0.0], "gap in the table");
    refused(&[0.1, 1.0, 2.0], &[1.0, 0.5, 0.0], "first gap in the table");
    refused(&[0.0, f64::NAN, 2.0], &[1.0, 0.5, 0.0], "gap in the table");
    refused(&[0.0, 1.0, 2.0], &[1.0, f64::INFINITY, 0.0], "traction in the table");
    refused(&[0.0, 1.0, 2.0], &[1.0, 0.5, 0.1], "last traction in the table");
    refused(&[0.0, 1.0, 2.0], &[-1.0, -0.5, 0.0], "work of adhesion of the table");
}

#[test]
fn flats_that_a_law_keeps_apart_are_stable_by_its_slope() {
    // πE*/L + φ''(g) at a uniform gap, over the softest waves; every node may move
    let (grid, half_space) = unit(16);
    let flat = Surface::from_fn(grid, |_, _| 0.0).unwrap();
    let (work, range) = (1e-3, 1e-2);
    let law = Morse::new(work, range).unwrap();
    let mut problem = Problem::new(&flat, half_space, law).unwrap();
    for gap in [-0.5 * range, 0.2 * range, 1.4 * range] {
        let control = Control::MeanGap(gap);
        let solution = without_wall(1e-8).solve(&mut problem, control).unwrap();
        let test = StabilityTest::default().tolerance(1e-4);
        let found = test.run_with(&mut problem, &NoWall, &solution).unwrap();
        let exact = std::f64::consts::PI + AdhesionLaw::<f64>::slope(&law, gap);
        assert_eq!(found.verdict, if exact > 0.0 { Verdict::Stable } else { Verdict::Unstable });
        assert!((found.eigenvalue - exact).abs() < 1e-3, "{} {exact}", found.eigenvalue);
        assert!(matches!(test.run(&mut problem, &solution), Err(Error::Unsuited { what: "rigid", .. })));
    }
}

#[test]
fn laws_walls_and_grids_that_do_not_fit_are_refused_by_name() {
    let (grid, half_space) = unit(16);
    let surface = Surface::paraboloid(grid, 2.0).unwrap();
    let control = Control::MeanPressure(1e-3);
    let wall = |found: Result<Solution<f64>>| match found {
        Err(Error::Unsuited { what: wall, .. }) => wall,
        other => panic!("{other:?}"),
    };
    let mut plain = Problem::new(&surface, half_space.clone(), Exponential::new(1e-4, 1e-2).unwrap()).unwrap();
    assert_eq!(wall(without_wall(1e-6).solve(&mut plain, control)), "no wall");
    let mut soft = Problem::new(&surface, half_space.clone(), LennardJones::new(1e-4, 1e-2).unwrap()).unwrap();
    assert_eq!(wall(Solver::default().solve(&mut soft, control)), "a wall at zero gap");
    // where a law has no work of adhesion it does not repel
    let works = grid.sample(|x, _| if x < 0.0 { 0.0 } else { 1e-4 });
    let bare = Varying::new(Morse::new(1e-4, 1e-2).unwrap(), works.view()).unwrap();
    let mut bare = Problem::new(&surface, half_space.clone(), bare).unwrap();
    assert_eq!(wall(without_wall(1e-6).solve(&mut bare, control)), "no wall");
    let works = Array2::from_elem((8, 16), 1e-4);
    let law = Varying::new(Exponential::new(1e-4, 1e-2).unwrap(), works.view()).unwrap();
    assert!(matches!(Problem::new(&surface, half_space, law), Err(Error::Shape { found: (8, 16), .. })));
    for work in [-1.0, f64::NAN] {
        let works = Array2::from_elem((16, 16), work);
        assert!(Varying::new(Exponential::new(1e-4, 1e-2).unwrap(), works.view()).is_err());
    }
    assert!(Varying::new(NoAdhesion, Array2::from_elem((16, 16), 1e-4).view()).is_err());
}

#[test]
fn a_problem_with_another_law_is_a_new_problem_with_that_law() {
    let grid = Grid::square(32, 1.0).unwrap();
    let surface = rough(grid, 8, 1);
    let works = grid.sample(|x, _| if x < 0.0 { 1e-4 } else { 3e-4 });
    let exponential = Exponential::new(3e-4, 5e-3).unwrap();
    let laws: [Arc<dyn AdhesionLaw<f64>>; 5] = [
        Arc::new(NoAdhesion),
        Arc::new(exponential),
        Arc::new(MaugisDugdale::new(1e-4, 5e-3).unwrap()),
        Arc::new(Jkr::new(1e-4).unwrap()),
        Arc::new(Varying::new(exponential, works.view()).unwrap()),
    ];
    let solve = |problem: &mut Problem<f64>, control| {
        let solution = Solver::default().solve(problem, control).unwrap();
        (problem.mu_rho(), solution)
    };
    let bodies: [(Box<dyn ElasticOperator<f64>>, _); 2] = [
        (Box::new(Westergaard::new(grid, 1.0).unwrap()), Control::MeanGap(0.02)),
        (Box::new(Boussinesq::new(grid, 1.0).unwrap()), Control::Approach(0.01)),
    ];
    for (body, control) in bodies {
        let mut one = Problem::new(&surface, body, PowerLaw::new(1e-4, 5e-3, 3.0).unwrap()).unwrap();
        for law in &laws {
            one.set_law(law.clone()).unwrap();
            let found = solve(&mut one, control);
            let mut new = Problem::new(&surface, one.into_operator(), law.clone()).unwrap();
            assert_eq!(solve(&mut new, control), found);
            one = new;
        }
        // what is refused leaves the law
        let before = solve(&mut one, control);
        let elsewhere = Varying::new(exponential, Array2::from_elem((16, 32), 1e-4).view()).unwrap();
        assert!(matches!(one.set_law(elsewhere), Err(Error::Shape { found: (16, 32), .. })));
        assert!(one.set_law(Unbounded).is_err());
        assert_eq!(solve(&mut one, control), before);
    }
}

/// A law without a value at a wall.
struct Unbounded;

impl AdhesionLaw<f64> for Unbounded {
    fn energy(&self, gap: f64) -> f64 {
        -1e-6 / gap
    }
    fn traction(&self, gap: f64) -> f64 {
        1e-6 / (gap * gap)
    }
    fn slope(&self, gap: f64) -> f64 {
        -2e-6 / gap.powi(3)
    }
}
