//! Laws that vary, absent nodes, springs and other symbols, in slabs.

use super::*;

pub(super) fn laws_that_vary_are_shared<T: Bits>(world: &World, shape: (usize, usize)) -> Result<()> {
    let work = |x: f64, y: f64| if (9.0 * x).sin() * (7.0 * y).cos() > 0.2 { 1e-4 } else { 2e-5 };
    // each process has the whole map
    let law = |grid: &Grid| Varying::new(Exponential::new(1e-4, 2e-3)?, grid.alone().sample(work).view());
    let control = Control::MeanPressure(2e-3);
    let alone = Grid::new(shape, (1.0, shape.1 as f64 / shape.0 as f64))?;
    let shared = world.share(alone)?;
    let found = compare::<T>(world, "varying law", alone, |grid| {
        let mut problem = Problem::new(&rough(grid)?, Westergaard::<T>::new(grid, 1.0)?, law(&grid)?)?;
        let solution = Solver::default().solve(&mut problem, control)?;
        let statistics = contact::ContactStatistics::of(&solution)?;
        assert_eq!(statistics.patches.len(), 2);
        Ok((solution, statistics))
    })?;
    let regions = found.whole().regions();
    assert_eq!(found.regions(), regions.slice_axis(Axis(0), Slice::from(shared.rows())));
    // the jumps of the law are smoothed, and it is made coarser
    let jumps = |grid: &Grid| Varying::new(MaugisDugdale::new(1e-4, 2e-3)?, grid.alone().sample(work).view());
    compare::<T>(world, "varying law with jumps, nested", alone, |grid| {
        let half_space = |grid: Grid| Westergaard::<T>::new(grid, 1.0);
        let (nested, law) = (Nested::default().coarsest(32), jumps(&grid)?);
        let nested = nested.solve(&mut Solver::default(), &rough(grid)?, half_space, law, control)?;
        let statistics = contact::ContactStatistics::of(&nested.solution)?;
        Ok((nested.solution, statistics))
    })?;
    compare::<T>(world, "varying law under a free half-space", alone, |grid| {
        let mut problem = Problem::new(&rough(grid)?, Boussinesq::<T>::new(grid, 1.0)?, law(&grid)?)?;
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(5e-3))?;
        let statistics = contact::ContactStatistics::of(&solution)?;
        Ok((solution, statistics))
    })?;
    Ok(())
}

/// A rough surface with holes: some nodes, whole rows, and an edge.
fn perforated(grid: Grid) -> Result<Surface> {
    let (holes, rows) = (grid.sample(|x, y| (23.0 * x).sin() * (31.0 * y).sin()), grid.rows().start);
    let absent = Array2::from_shape_fn(holes.dim(), |(i, j)| {
        holes[[i, j]] > 0.7 || (100..103).contains(&(rows + i)) || rows + i >= 250 || j < 3
    });
    rough(grid)?.with_absent(absent)
}

pub(super) fn absent_nodes_are_shared<T: Bits>(world: &World, shape: (usize, usize)) -> Result<()> {
    let alone = Grid::new(shape, (1.0, shape.1 as f64 / shape.0 as f64))?;
    let shared = world.share(alone)?;
    let (whole, slab) = (perforated(alone)?, perforated(shared)?);
    assert_eq!(slab.absent_nodes(), whole.absent_nodes());
    assert_eq!(*slab.whole(), whole);
    let periodic = compare::<T>(world, "absent nodes", alone, |grid| {
        let mut problem = Problem::new(&perforated(grid)?, Westergaard::<T>::new(grid, 1.0)?, NoAdhesion)?;
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(0.02))?;
        assert!(solution.report.absent_nodes > 1000);
        let statistics = contact::ContactStatistics::of(&solution)?;
        Ok((solution, statistics))
    })?;
    assert!(slab.absent_nodes() == periodic.report.absent_nodes);
    compare::<T>(world, "absent nodes, from a start", alone, |grid| {
        let mut problem = Problem::new(&perforated(grid)?, Westergaard::<T>::new(grid, 1.0)?, NoAdhesion)?;
        let mut gap = grid.sample(|x, y| 0.01 * (1.0 + (x - y).sin())).mapv(T::lit);
        if let Some(absent) = perforated(grid)?.absent() {
            gap.zip_mut_with(absent, |gap, &absent| *gap = if absent { T::nan() } else { *gap });
        }
        let observe = |_: &Iteration| ControlFlow::Continue(());
        let start = Start::From(&gap);
        let solution = Solver::default().solve_with(&mut problem, Control::MeanPressure(0.02), start, observe)?;
        let statistics = contact::ContactStatistics::of(&solution)?;
        Ok((solution, statistics))
    })?;
    let law = Exponential::new(1e-5, 1e-3)?;
    compare::<T>(world, "absent nodes under a free half-space, nested", alone, |grid| {
        let nested = Nested::default().coarsest(32);
        let half_space = |grid: Grid| Boussinesq::<T>::new(grid, 1.0);
        let control = Control::MeanPressure(0.01);
        let nested = nested.solve(&mut Solver::default(), &perforated(grid)?, half_space, law, control)?;
        let statistics = contact::ContactStatistics::of(&nested.solution)?;
        Ok((nested.solution, statistics))
    })?;
    Ok(())
}

pub(super) fn springs_under_free_half_spaces_are_shared(world: &World, shape: (usize, usize)) -> Result<()> {
    fn solve<C>(grid: Grid, constraint: C) -> Result<(Solution<f64>, contact::ContactStatistics)>
    where
        C: ContactConstraint<f64> + 'static,
    {
        let mut problem = Problem::new(&perforated(grid)?, Boussinesq::<f64>::new(grid, 1.0)?, NoAdhesion)?;
        let mut solver = Solver { settings: Settings::default().tolerance(1e-3), constraint };
        let mut solution = solver.solve(&mut problem, Control::MeanPressure(0.01))?;
        let statistics = contact::ContactStatistics::of(&solution)?;
        let test = stability::StabilityTest::under(Control::Force(0.01)).max_iterations(5);
        let stability = test.run_with(&mut problem, &solver.constraint, &solution)?;
        // the mode is compared in the place of the pressure
        solution.pressure = stability.mode;
        Ok((solution, statistics))
    }
    let alone = Grid::new(shape, (1.0, shape.1 as f64 / shape.0 as f64))?;
    compare(world, "penalty under a free half-space", alone, |grid| solve(grid, Penalty::new(500.0)?))?;
    compare(world, "Uzawa under a free half-space", alone, |grid| solve(grid, Uzawa::new(500.0)?))?;
    Ok(())
}

pub(super) fn other_symbols_are_shared(world: &World) -> Result<()> {
    let solve = |grid: Grid| {
        let body = Spectral::<f64>::new(grid, 1.0, |qx, qy| 0.5 * (qx * qx + 2.0 * qy * qy).sqrt() + 0.1)?;
        Solver::default().solve(&mut Problem::new(&rough(grid)?, body, NoAdhesion)?, Control::MeanPressure(0.02))
    };
    let alone = Grid::square(512, 1.0)?;
    let shared = world.share(alone)?;
    same_solutions("symbol", &shared, &solve(shared)?, &solve(alone)?);
    say(world, "symbol");
    Ok(())
}
