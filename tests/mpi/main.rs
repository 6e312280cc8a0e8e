//! Solves that several processes share, against the same solves in one: every bit of every field and report. Run by
//! `.ci/mpi`, under `mpiexec`; by itself it is one process. With the argument `quick` it runs a part of them, some on
//! three processes alone.

mod laws;
mod paths;

use std::fmt::Debug;
use std::ops::ControlFlow;

use asperity::adhesion::Varying;
use asperity::elastic::check_operator;
use asperity::ndarray::{Array2, Axis, Slice};
use asperity::solver::Iteration;
use asperity::*;

use laws::{
    absent_nodes_are_shared, laws_that_vary_are_shared, other_symbols_are_shared,
    springs_under_free_half_spaces_are_shared,
};
use paths::{equilibria_are_judged_alike, paths_are_shared};

type Outcome = std::result::Result<(), Box<dyn std::error::Error>>;

/// The bits of a number.
trait Bits: Real {
    fn bits(self) -> u64;
}

impl Bits for f32 {
    fn bits(self) -> u64 {
        u64::from(self.to_bits())
    }
}

impl Bits for f64 {
    fn bits(self) -> u64 {
        self.to_bits()
    }
}

/// Whether this process has its rows of a field, to the bit.
fn same<T: Bits>(name: &str, grid: &Grid, slab: &Array2<T>, whole: &Array2<T>) {
    let rows = whole.slice_axis(Axis(0), Slice::from(grid.rows()));
    assert_eq!(slab.dim(), rows.dim(), "{name}");
    let wrong = slab.iter().zip(rows).filter(|(a, b)| a.bits() != b.bits()).count();
    assert_eq!(wrong, 0, "{name}: {wrong} of {} nodes differ", slab.len());
}

fn same_solutions<T: Bits>(name: &str, grid: &Grid, shared: &Solution<T>, alone: &Solution<T>) {
    same(&format!("{name}: gap"), grid, &shared.gap, &alone.gap);
    same(&format!("{name}: pressure"), grid, &shared.pressure, &alone.pressure);
    same(&format!("{name}: contact pressure"), grid, &shared.contact_pressure, &alone.contact_pressure);
    assert_eq!(shared.report, alone.report, "{name}");
}

fn rough(grid: Grid) -> Result<Surface> {
    SelfAffine::default().k_s(40.0).amplitude(Amplitude::RmsSlope(0.1)).seed(3).surface(grid)
}

/// Solves alone and shared, with a law, a wall and a load.
fn solves<T, L, C>(world: &World, name: &str, shape: (usize, usize), law: L, wall: C, control: Control) -> Result<()>
where
    T: Bits,
    L: AdhesionLaw<T> + Clone + 'static,
    C: ContactConstraint<T> + Clone + 'static,
{
    let name = format!("{name}, {} on {shape:?}", T::NAME);
    let solve = |grid: Grid| {
        let mut problem = Problem::new(&rough(grid)?, Westergaard::<T>::new(grid, 1.0)?, law.clone())?;
        let settings = Settings::default().max_iterations(60);
        Solver { settings, constraint: wall.clone() }.solve(&mut problem, control)
    };
    let alone = Grid::new(shape, (1.0, shape.1 as f64 / shape.0 as f64))?;
    let shared = world.share(alone)?;
    let (of_one, of_all) = (solve(alone)?, solve(shared)?);
    assert!(of_one.report.iterations > 5, "{name}: {:?}", of_one.report);
    same_solutions(&name, &shared, &of_all, &of_one);
    assert!(*of_all.whole() == of_one, "{name}");
    let statistics = contact::ContactStatistics::of(&of_one)?;
    assert_eq!(contact::ContactStatistics::of(&of_all)?, statistics, "{name}");
    say(world, &format!("{name}: {} applications", of_one.report.operator_applications));
    Ok(())
}

fn say(world: &World, line: &str) {
    if world.rank() == 0 {
        println!("{line}");
    }
}

/// Four bands; an odd number of columns and a short last band; an odd number of rows; one band, and a line.
const SHAPES: [(usize, usize); 5] = [(512, 512), (1000, 257), (999, 260), (120, 90), (6000, 1)];

fn main() -> Outcome {
    let world = World::start()?;
    if let Err(error) = run(&world) {
        // the others would wait
        eprintln!("process {}: {error}", world.rank());
        world.abort();
    }
    Ok(())
}

fn run(world: &World) -> Outcome {
    let quick = std::env::args().any(|argument| argument == "quick");
    say(world, &format!("{} processes", world.size()));
    for shape in if quick { &SHAPES[2..] } else { &SHAPES[..] } {
        let shape = *shape;
        surfaces_are_made_in_slabs(world, shape)?;
        shortest_waves_are_those_of_the_whole(world, shape)?;
        operators_apply_to_slabs::<f64>(world, shape)?;
        operators_apply_to_slabs::<f32>(world, shape)?;
        let pressure = Control::MeanPressure(0.02);
        solves::<f64, _, _>(world, "pressure", shape, NoAdhesion, Projection, pressure)?;
        solves::<f32, _, _>(world, "pressure", shape, NoAdhesion, Projection, pressure)?;
    }
    let (square, odd) = (SHAPES[0], SHAPES[1]);
    let (exponential, dugdale) = (Exponential::new(1e-4, 2e-3)?, MaugisDugdale::new(1e-4, 2e-3)?);
    let spring = Control::Spring { stiffness: 1.0, rest: 0.01 };
    let jkr = Jkr::new(1e-4)?;
    solves::<f64, _, _>(world, "JKR", odd, jkr, Projection, Control::MeanPressure(1e-3))?;
    solves::<f64, _, _>(world, "exponential", square, exponential, Projection, Control::MeanPressure(1e-3))?;
    nested_grids_are_shared::<f64>(world, odd, Control::MeanPressure(0.01))?;
    free_half_spaces_are_shared::<f64>(world, (256, 256), Control::Force(1e-4))?;
    if !quick || world.size() == 3 {
        laws_that_vary_are_shared::<f64>(world, (300, 257))?;
        absent_nodes_are_shared::<f64>(world, (320, 257))?;
        equilibria_are_judged_alike(world, (280, 256))?;
    }
    clusters_hang_together_across_slabs(world)?;
    exchanges_are_what_the_formula_says(world)?;
    what_has_no_slabs_is_refused(world)?;
    if quick {
        say(world, "all the same");
        return Ok(());
    }
    solves::<f64, _, _>(world, "gap", square, NoAdhesion, Projection, Control::MeanGap(0.003))?;
    solves::<f32, _, _>(world, "gap", odd, NoAdhesion, Projection, Control::MeanGap(0.003))?;
    solves::<f64, _, _>(world, "spring", odd, NoAdhesion, Projection, spring)?;
    solves::<f32, _, _>(world, "Maugis-Dugdale", odd, dugdale, Projection, Control::MeanGap(0.004))?;
    solves::<f64, _, _>(world, "tension", square, exponential, Projection, Control::MeanPressure(-1e-4))?;
    solves::<f64, _, _>(world, "penalty", square, exponential, Penalty::new(500.0)?, Control::MeanPressure(0.01))?;
    solves::<f64, _, _>(world, "Uzawa", odd, NoAdhesion, Uzawa::new(500.0)?, Control::MeanPressure(0.01))?;
    solves::<f64, _, _>(world, "hardness", odd, NoAdhesion, Hardness::new(0.06)?, Control::MeanPressure(0.01))?;
    let lennard_jones = LennardJones::new(1e-3, 4e-3)?;
    solves::<f64, _, _>(world, "Lennard-Jones", square, lennard_jones, NoWall, Control::MeanPressure(0.01))?;
    starts_and_sweeps_are_shared(world)?;
    nested_grids_are_shared::<f32>(world, (1024, 1024), Control::MeanPressure(0.01))?;
    nested_grids_are_shared::<f64>(world, square, Control::MeanGap(0.003))?;
    free_half_spaces_are_shared::<f64>(world, (400, 257), Control::Approach(2e-3))?;
    free_half_spaces_are_shared::<f32>(world, (520, 512), Control::Force(1e-3))?;
    other_symbols_are_shared(world)?;
    laws_that_vary_are_shared::<f32>(world, (300, 257))?;
    absent_nodes_are_shared::<f32>(world, (320, 257))?;
    springs_under_free_half_spaces_are_shared(world, (300, 257))?;
    paths_are_shared(world)?;
    say(world, "all the same");
    Ok(())
}

fn surfaces_are_made_in_slabs(world: &World, shape: (usize, usize)) -> Result<()> {
    let alone = Grid::new(shape, (1.0, 0.7))?;
    let shared = world.share(alone)?;
    let (whole, slab) = (rough(alone)?, rough(shared)?);
    same("heights", &shared, slab.heights(), whole.heights());
    assert_eq!(*slab.whole(), whole);
    assert_eq!((slab.mean(), slab.rms_height()), (whole.mean(), whole.rms_height()));
    assert_eq!(slab.statistics(), whole.statistics());
    let (whole, slab) = (Surface::paraboloid(alone, 2.0)?, Surface::paraboloid(shared, 2.0)?);
    same("paraboloid", &shared, slab.heights(), whole.heights());
    Ok(())
}

fn operators_apply_to_slabs<T: Bits>(world: &World, shape: (usize, usize)) -> Result<()> {
    let alone = Grid::new(shape, (1.0, 0.7))?;
    let shared = world.share(alone)?;
    let apply = |grid: Grid| {
        let mut body = Westergaard::<T>::new(grid, 1.0)?;
        let u = grid.sample(|x, y| (7.0 * x + 3.0 * y * y).sin() + 0.1 * x).mapv(T::lit);
        let (mut p, mut z) = (u.clone(), u.clone());
        body.pressure(u.view(), p.view_mut())?;
        body.displacement(u.view(), z.view_mut())?;
        Ok::<_, Error>((p, z))
    };
    let ((p, z), (ps, zs)) = (apply(alone)?, apply(shared)?);
    same("pressure", &shared, &ps, &p);
    same("displacement", &shared, &zs, &z);
    Ok(())
}

/// The shortest wave of a surface is the wave of the whole, also where there are more processes than bands.
fn shortest_waves_are_those_of_the_whole(world: &World, shape: (usize, usize)) -> Result<()> {
    let alone = Grid::new(shape, (1.0, 0.7))?;
    let shared = world.share(alone)?;
    // shorter waves in the last rows
    let chirp = |grid: Grid| Surface::from_fn(grid, |x, y| 1e-3 * ((40.0 * x * x).sin() + (9.0 * y).cos()));
    let (whole, slab) = (chirp(alone)?, chirp(shared)?);
    // a line has no free boundary
    let free = (!alone.is_line()).then(|| Boussinesq::<f64>::new(alone, 1.0)).transpose()?;
    for boundary in free.iter().map(Boussinesq::boundary).chain([Boundary::Periodic]) {
        assert_eq!(slab.nodes_per_wave(boundary), whole.nodes_per_wave(boundary), "{shape:?} {boundary:?}");
    }
    Ok(())
}

fn starts_and_sweeps_are_shared(world: &World) -> Result<()> {
    let loads = [0.01, 0.02, 0.03].map(Control::MeanPressure);
    let sweep = |grid: Grid| -> Result<Vec<Solution<f64>>> {
        let mut problem = Problem::new(&rough(grid)?, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
        let (mut solver, mut sweep) = (Solver::default(), Sweep::default());
        let mut found = Vec::new();
        for load in loads {
            found.push(sweep.next(&mut solver, &mut problem, load)?);
        }
        let near = Start::Near(found[0].gap.clone());
        found.push(solver.solve_with(&mut problem, loads[1], near, |_| ControlFlow::Continue(()))?);
        Ok(found)
    };
    let alone = Grid::square(512, 1.0)?;
    let shared = world.share(alone)?;
    for (shared_one, alone_one) in sweep(shared)?.iter().zip(&sweep(alone)?) {
        same_solutions("sweep", &shared, shared_one, alone_one);
    }
    say(world, "sweep");
    Ok(())
}

fn nested_grids_are_shared<T: Bits>(world: &World, shape: (usize, usize), control: Control) -> Result<()> {
    let solve = |grid: Grid| {
        let half_space = |grid: Grid| Westergaard::<T>::new(grid, 1.0);
        let nested = Nested::default().stiffness(1e-3);
        nested.solve(&mut Solver::default(), &rough(grid)?, half_space, NoAdhesion, control)
    };
    let alone = Grid::new(shape, (1.0, shape.1 as f64 / shape.0 as f64))?;
    let shared = world.share(alone)?;
    let (of_one, of_all) = (solve(alone)?, solve(shared)?);
    same_solutions("nested", &shared, &of_all.solution, &of_one.solution);
    assert_eq!(of_all.levels, of_one.levels);
    assert!(of_one.levels.len() > 2, "{shape:?}");
    say(world, &format!("{} nested grids, {} on {shape:?}", of_one.levels.len(), T::NAME));
    Ok(())
}

fn free_half_spaces_are_shared<T: Bits>(world: &World, shape: (usize, usize), control: Control) -> Result<()> {
    let solve = |grid: Grid, law: Option<Exponential>| {
        let sphere =
            Surface::from_fn(grid, |x, y| -(x * x + y * y) / 4.0 + 1e-3 * (40.0 * x).sin() * (33.0 * y).cos())?;
        let body = Boussinesq::<T>::new(grid, 1.0)?;
        let law: Box<dyn AdhesionLaw<T>> = match law {
            Some(law) => Box::new(law),
            None => Box::new(NoAdhesion),
        };
        let solution = Solver::default().solve(&mut Problem::new(&sphere, body, law)?, control)?;
        let half_space = |grid: Grid| Boussinesq::<T>::new(grid, 1.0);
        let nested = Nested::default().solve(&mut Solver::default(), &sphere, half_space, NoAdhesion, control)?;
        let statistics = contact::ContactStatistics::of(&solution)?;
        Ok::<_, Error>((solution, nested, statistics))
    };
    let alone = Grid::new(shape, (0.4, 0.4))?;
    let shared = world.share(alone)?;
    let law = (T::NAME == "f64").then(|| Exponential::new(1e-6, 1e-4)).transpose()?;
    let (of_one, of_all) = (solve(alone, law)?, solve(shared, law)?);
    same_solutions("free", &shared, &of_all.0, &of_one.0);
    same_solutions("free, nested", &shared, &of_all.1.solution, &of_one.1.solution);
    assert_eq!((of_all.1.levels, of_all.2), (of_one.1.levels, of_one.2));
    assert!(of_one.0.report.contact_nodes > 10);
    say(world, &format!("free half-space, {} on {shape:?}", T::NAME));
    Ok(())
}

/// Solves on a grid alone and on the same grid shared, which have to find the same.
fn compare<T: Bits>(
    world: &World,
    name: &str,
    alone: Grid,
    solve: impl Fn(Grid) -> Result<(Solution<T>, contact::ContactStatistics)>,
) -> Result<Solution<T>> {
    let shared = world.share(alone)?;
    let ((of_one, statistics), (of_all, shared_statistics)) = (solve(alone)?, solve(shared)?);
    let name = format!("{name}, {} on {:?}", T::NAME, alone.shape());
    same_solutions(&name, &shared, &of_all, &of_one);
    assert_eq!(shared_statistics, statistics, "{name}");
    assert!(of_one.report.iterations > 5 && of_one.report.contact_nodes > 10, "{name}: {:?}", of_one.report);
    say(world, &format!("{name}: {} applications", of_one.report.operator_applications));
    Ok(of_all)
}

fn clusters_hang_together_across_slabs(world: &World) -> Result<()> {
    // pieces of every width, along both sides; some go around the cell
    let maps: [fn(f64, f64) -> bool; 4] = [
        |x, y| (40.0 * x + 5.0 * (9.0 * y).sin()).sin() > 0.3,
        |x, y| (40.0 * y + 5.0 * (9.0 * x).sin()).sin() > 0.3,
        |x, y| (60.0 * (x * x - 0.7 * y)).sin() * (50.0 * y + 11.0 * x).sin() > 0.2,
        |_, _| true,
    ];
    for (shape, map) in SHAPES[..4].iter().flat_map(|&shape| maps.map(|map| (shape, map))) {
        let alone = Grid::new(shape, (1.0, 1.0))?;
        let shared = world.share(alone)?;
        let statistics = |grid: &Grid| {
            let gap = grid.sample(|x, y| if map(x, y) { 0.0 } else { 1.0 });
            let (pressure, body) = (gap.mapv(|g| 1.0 - g), (Boundary::Periodic, 1.0));
            contact::ContactStatistics::of_fields(gap.view(), pressure.view(), grid, body, &NoAdhesion)
        };
        assert_eq!(statistics(&shared)?, statistics(&alone)?, "{shape:?}");
    }
    Ok(())
}

fn exchanges_are_what_the_formula_says(world: &World) -> Result<()> {
    let grid = world.share(Grid::square(512, 1.0)?)?;
    let mut body = Westergaard::<f64>::new(grid, 1.0)?;
    let u = grid.sample(|x, y| x * y);
    let mut p = u.clone();
    body.pressure(u.view(), p.view_mut())?;
    let before = world.bytes_sent();
    body.pressure(u.view(), p.view_mut())?;
    let sent = world.bytes_sent() - before;
    let held = grid.rows().len();
    // of 257 columns others have all but a share like the rows' share
    let others = |own: usize| 257 - own;
    let own = (257 * (grid.rows().start + held) / 512) - 257 * grid.rows().start / 512;
    let expected = if world.size() == 1 { 0 } else { 16 * (held * others(own) + own * (512 - held)) };
    assert_eq!(sent, expected as u64, "{:?}", grid.rows());
    let share = 2.0 * 16.0 * 512.0 * 257.0 / world.size() as f64 * (1.0 - 1.0 / world.size() as f64);
    if 4 % world.size() == 0 && world.size() > 1 {
        assert!((sent as f64 / share - 1.0).abs() < 0.01, "{sent} {share}");
    }
    say(world, &format!("{sent} bytes sent by an application, {share:.0} by the formula"));
    Ok(())
}

fn what_has_no_slabs_is_refused(world: &World) -> Result<()> {
    fn refused<R: Debug>(what: &str, result: Result<R>) {
        let error = result.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains("several processes"), "{what}: {error}");
    }
    let grid = world.share(Grid::square(512, 1.0)?)?;
    let surface = rough(grid)?;
    // one process that refuses its part is known to all
    let wrong = grid.sample(|x, _| if x < -0.499 { f64::NAN } else { 0.0 });
    match Surface::new(grid, wrong) {
        Err(Error::NotFinite { .. }) if world.rank() == 0 => {}
        Err(Error::Elsewhere { rank: 0 }) if world.rank() > 0 => {}
        other => panic!("{other:?}"),
    }
    if world.size() == 1 {
        return Ok(());
    }
    // a map of its rows is none of the whole grid
    let work = grid.sample(|x, _| if x < 0.0 { 1e-6 } else { 1e-4 });
    if let Ok(varying) = Varying::new(Exponential::new(1e-4, 4e-3)?, work.view()) {
        let refused = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, varying).err();
        assert!(matches!(refused, Some(Error::Shape { .. } | Error::Elsewhere { .. })), "{refused:?}");
    }
    let alone = Grid::square(512, 1.0)?;
    refused("mixed grids", Problem::new(&surface, Westergaard::<f64>::new(alone, 1.0)?, NoAdhesion));
    let mut body = Westergaard::<f64>::new(grid, 1.0)?;
    refused("check of an operator", check_operator(&mut body));
    Ok(())
}
