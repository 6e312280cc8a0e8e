//! Contacts that springs hold and pull.

use super::*;

/// Energies of loosely solved states are wrong by the second order of their errors alone.
#[test]
fn a_withdrawal_of_a_tip_in_contact_has_no_jumps_of_noise() {
    let problem = || problem(&sphere(64, 0.36), Exponential::new(1e-4, 3e-3).unwrap());
    let withdrawn = |settings: Settings| {
        let path = Path::new([4e-3, -2e-2].map(Control::Approach), PathSettings::default()).unwrap();
        followed(path, &mut Solver::new(settings), &mut problem())
    };
    let [loose, close] = [withdrawn(Settings::default()), withdrawn(Settings::default().tolerance(1e-7))];
    let jumps = |steps: &[PathStep<f64>]| steps.iter().filter_map(|step| step.event.as_ref()?.jump()).count();
    // the snap at its end may be a jump, or a steep branch
    assert!([&loose, &close].iter().all(|steps| steps.len() < 100 && jumps(steps) <= 1));
    let [loose, close] = [loose, close].map(|steps| steps.last().unwrap().work);
    assert!((loose / close - 1.0).abs() < 0.01, "{loose:e} {close:e}");
    let [loose, close] = [1e-4, 1e-9].map(|tolerance| {
        let report = solve(&mut problem(), Control::Approach(4e-3), tolerance).report;
        report.elastic_energy + report.adhesive_energy
    });
    assert!((loose / close - 1.0).abs() < 1e-6, "{loose:e} {close:e}");
}

/// The jump of a tip into contact and out of it needs a soft spring, and is missed by a stiff one.
#[test]
fn a_soft_spring_jumps_and_a_stiff_one_does_not() {
    let (surface, law) = (sphere(32, 0.24), Exponential::new(2e-5, 2e-3).unwrap());
    let mut solver = Solver::new(Settings::default().tolerance(1e-7));
    let mut jumps = |stiffness: f64| {
        let mut problem = problem(&surface, law);
        let legs = [-0.02, 0.004, -0.03].map(|rest| Control::Spring { stiffness, rest });
        let far = Array2::from_shape_fn((32, 32), |node| 0.02 - surface.heights()[node]);
        let settings = PathSettings::default().steps(20).smallest_step(1e-3);
        let path = Path::new(legs, settings).unwrap().starting_from(far);
        let steps = followed(path, &mut solver, &mut problem);
        for step in &steps {
            let (report, Control::Spring { rest, .. }) = (&step.solution.report, step.solution.report.control) else {
                panic!("a spring")
            };
            let force = stiffness * (rest - report.approach.unwrap());
            assert!((force - report.normal_force).abs() < 1e-9, "{force} {}", report.normal_force);
        }
        // all of the work is dissipated, but for what the quadrature misses
        let energies = steps.iter().map(|step| &step.solution.report).map(|r| r.elastic_energy + r.adhesive_energy);
        let (deepest, last) = (energies.fold(0.0, f64::min), steps.last().unwrap());
        assert!(last.imbalance.abs() < -1e-3 * deepest && (last.work - last.dissipated).abs() < -1e-3 * deepest);
        let jumps: Vec<_> = steps.iter().filter_map(|step| step.event).collect();
        assert!(jumps.iter().all(|event| event.jump().is_none_or(|jump| jump.approach.is_some())));
        jumps.iter().filter(|event| matches!(event, Event::Jump(_))).count()
    };
    assert_eq!((jumps(0.01), jumps(10.0)), (2, 0));
}

#[test]
fn stability_depends_on_the_spring() {
    let (surface, law) = (sphere(32, 0.24), Exponential::new(2e-5, 2e-3).unwrap());
    let mut problem = problem(&surface, law);
    // before contact, where the attraction grows faster than a soft spring
    let far = Array2::from_shape_fn((32, 32), |node| 4e-3 - surface.heights()[node]);
    let mut solver = Solver::default();
    let held = solver
        .solve_with(&mut problem, Control::Approach(-4e-3), Start::From(&far), |_| ControlFlow::Continue(()))
        .unwrap();
    assert_eq!((held.report.status, held.report.contact_nodes), (Status::Converged, 0));
    let (force, approach) = (held.report.normal_force, held.report.approach.unwrap());
    let slope = PI * 2.0 * 2.0 * 2e-5 / 2e-3 * (-4e-3_f64 / 2e-3).exp(); // of a rigid paraboloid, 2πRw/ρ e^(−d/ρ)
    for (factor, verdict) in [(0.3, Verdict::Unstable), (3.0, Verdict::Stable)] {
        let stiffness = factor * slope;
        let control = Control::Spring { stiffness, rest: approach + force / stiffness };
        let found = StabilityTest::under(control).run(&mut problem, &held).unwrap();
        assert_eq!((found.verdict, found.mode.dim()), (verdict, (32, 32)), "{}", found.eigenvalue);
    }
    for (control, verdict) in
        [(Control::Approach(approach), Verdict::Stable), (Control::Force(force), Verdict::Unstable)]
    {
        assert_eq!(StabilityTest::under(control).run(&mut problem, &held).unwrap().verdict, verdict);
    }
}

#[test]
fn a_leg_can_be_ended_on_the_way() {
    let surface = sphere(32, 0.4);
    let (mut solver, mut problem) = (Solver::default(), problem(&surface, NoAdhesion));
    let legs = [0.002, -0.02, 0.001].map(Control::Approach);
    let mut path = Path::new(legs, PathSettings::default()).unwrap();
    let mut last = (0, 0.0);
    while let Some(step) = path.next(&mut solver, &mut problem).unwrap() {
        last = (step.leg, step.solution.report.approach.unwrap());
        if step.leg == 1 && step.solution.report.contact_nodes == 0 {
            // before half of the way
            assert!(last.1 > -0.01, "{last:?}");
            path.end_leg();
        }
    }
    assert!(last.0 == 2 && (last.1 - 0.001).abs() < 1e-9, "{last:?}");
}

#[test]
fn bodies_apart_follow_the_softest_spring_to_its_rest() {
    fn check<T: Real>(surface: &Surface, free: bool, (stiffness, distance): (f64, f64), tolerance: f64) {
        let grid = *surface.grid();
        let peak = surface.heights().fold(f64::NEG_INFINITY, |high, &h| high.max(h)) - surface.mean();
        let rest = if free { -distance } else { peak + distance };
        let control = Control::Spring { stiffness, rest };
        let report = if free {
            let body = Boussinesq::<T>::new(grid, 1.0).unwrap();
            Solver::default().solve(&mut Problem::new(surface, body, NoAdhesion).unwrap(), control).unwrap().report
        } else {
            let body = Westergaard::<T>::new(grid, 1.0).unwrap();
            Solver::default().solve(&mut Problem::new(surface, body, NoAdhesion).unwrap(), control).unwrap().report
        };
        let found = report.approach.unwrap_or(report.mean_gap);
        let name = format!("{free} {stiffness:e} {distance} {}: {report:?}", T::NAME);
        assert!(report.status == Status::Converged && report.iterations < 100, "{name}");
        assert!((found - rest).abs() <= tolerance * (peak + distance), "{name}");
    }
    for surface in [sphere(64, 0.4), bumps((48, 40))] {
        for (free, stiffness) in [false, true].into_iter().flat_map(|free| (0..9).map(move |k| (free, 0.1_f64.powi(k))))
        {
            for distance in [1e-3, 1e-2, 0.1, 1.0] {
                check::<f64>(&surface, free, (stiffness, distance), 4e-15);
                if distance < 0.5 {
                    check::<f32>(&surface, free, (stiffness, distance), 2e-6);
                }
            }
        }
    }
}
