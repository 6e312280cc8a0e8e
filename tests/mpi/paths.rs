//! Stability and paths in slabs.

use super::*;

/// The stability, the stiffness and a departure, and a load for a contact fraction.
pub(super) fn equilibria_are_judged_alike(world: &World, shape: (usize, usize)) -> Result<()> {
    let law = Exponential::new(1e-4, 2e-3)?;
    let alone = Grid::new(shape, (1.0, shape.1 as f64 / shape.0 as f64))?;
    let shared = world.share(alone)?;
    let judge = |grid: Grid| {
        let mut problem = Problem::new(&rough(grid)?, Westergaard::<f64>::new(grid, 1.0)?, law)?;
        let (mut solver, control) = (Solver::default(), Control::MeanPressure(2e-3));
        let solution = solver.solve(&mut problem, control)?;
        let test = stability::StabilityTest::default().max_iterations(30);
        let stability = test.run(&mut problem, &solution)?;
        let left = stability.leave(&mut solver, &mut problem, &solution, |_| ControlFlow::Continue(()))?;
        let stiffness = stability::ContactStiffness::of(&mut problem, &solution)?;
        let mut bare = Problem::new(&rough(grid)?, Boussinesq::<f64>::new(grid, 1.0)?, NoAdhesion)?;
        let found = ContactSearch::default().at(&mut solver, &mut bare, 0.05)?;
        let free = stability::ContactStiffness::of(&mut bare, &found.solution)?;
        Ok::<_, Error>((stability, left, (stiffness, free), found))
    };
    let ((of_one, left, stiffness, found), (of_all, left_by_all, shared_stiffness, found_by_all)) =
        (judge(alone)?, judge(shared)?);
    same("mode", &shared, &of_all.mode, &of_one.mode);
    let figures = |s: &stability::Stability<f64>| {
        let numbers = [s.eigenvalue, s.residual, s.lower_bound, s.error_bound.unwrap_or_default()].map(f64::to_bits);
        (s.verdict, numbers, s.operator_applications, s.bound_applications)
    };
    assert_eq!(figures(&of_all), figures(&of_one));
    assert!(of_one.operator_applications > 10);
    let (Some(left), Some(left_by_all)) = (left, left_by_all) else { panic!("there is a mode") };
    same_solutions("departure", &shared, &left_by_all.solution, &left.solution);
    let figures = |d: &stability::Departure<f64>| [d.energy_drop, d.distance, d.direction].map(f64::to_bits);
    assert_eq!(figures(&left_by_all), figures(&left));
    assert_eq!(shared_stiffness, stiffness);
    assert!(stiffness.0.operator_applications > 5 && stiffness.0.edge.is_some());
    same_solutions("contact fraction", &shared, &found_by_all.solution, &found.solution);
    assert_eq!(
        (found_by_all.solution.report.control, found_by_all.solves),
        (found.solution.report.control, found.solves)
    );
    say(
        world,
        &format!("{} by {} applications, stiffness, contact fraction", of_one.verdict, of_one.operator_applications),
    );
    Ok(())
}

pub(super) fn paths_are_shared(world: &World) -> Result<()> {
    use path::{Path, PathSettings};
    let law = Exponential::new(1e-3, 4e-3)?;
    let legs = [0.03, 0.012].map(Control::MeanGap);
    let settings = PathSettings::default().steps(4).smallest_step(0.02);
    let alone = Grid::new((300, 256), (1.0, 1.0))?;
    let shared = world.share(alone)?;
    let follow = |grid: Grid| {
        let surface = Surface::wave_2d(grid, 0.02, 1)?;
        let problem = || Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, law);
        let (mut path, mut steps) = (Path::new(legs, settings)?, Vec::new());
        // each step at a problem made anew
        while let Some(step) = path.next(&mut Solver::default(), &mut problem()?)? {
            steps.push(step);
        }
        Ok::<_, Error>(steps)
    };
    let (of_one, of_all) = (follow(alone)?, follow(shared)?);
    assert_eq!(of_all.len(), of_one.len());
    for (step, expected) in of_all.iter().zip(&of_one) {
        same_solutions("path", &shared, &step.solution, &expected.solution);
        let figures =
            |s: &path::PathStep<f64>| (s.leg, [s.work, s.dissipated, s.imbalance, s.work_error].map(f64::to_bits));
        assert_eq!(figures(step), figures(expected));
        assert_eq!(step.event, expected.event);
    }
    // a saddle is left on the way
    assert!(of_one.iter().any(|step| step.event.is_some()));
    say(world, &format!("path of {} states", of_one.len()));
    Ok(())
}
