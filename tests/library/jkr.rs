//! The law of JKR, with a range set by the grid: exact solutions in the limit of no range, on every body and grid.

use std::f64::consts::PI;

use asperity::accuracy::{GridError, Quantity};
use asperity::adhesion::{Formula, Varying, mu_rho};
use asperity::contact::ContactArea;
use asperity::elastic::{Base, Layer, Material};
use asperity::exact::{self, AdhesiveWavyLine, Sphere};
use asperity::pull_off::FoundPullOff;
use asperity::*;
use asperity_maps::surface_with_absent;
use ndarray::Array2;

/// The wave of Johnson: its amplitude, and the work of adhesion at α = 0.3.
const AMPLITUDE: f64 = 0.01;
const ALPHA: f64 = 0.3;

fn wave(wavelength: f64) -> AdhesiveWavyLine {
    let work = 0.5 * (ALPHA * PI * AMPLITUDE).powi(2) / wavelength;
    AdhesiveWavyLine::new(AMPLITUDE, wavelength, 1.0, work).unwrap()
}

fn law(wavelength: f64) -> Jkr {
    Jkr::new(0.5 * (ALPHA * PI * AMPLITUDE).powi(2) / wavelength).unwrap()
}

/// A sphere of radius 1 with work of adhesion 2e-3 on a free half-space, on so many nodes a side of 1.6.
const WORK: f64 = 2e-3;
const SIDE: f64 = 1.6;

fn sphere(n: usize) -> Problem<f64> {
    let grid = Grid::square(n, SIDE).unwrap();
    let surface = Surface::paraboloid(grid, 1.0).unwrap();
    Problem::new(&surface, Boussinesq::new(grid, 1.0).unwrap(), Jkr::new(WORK).unwrap()).unwrap()
}

fn find(problem: &mut Problem<f64>, tolerance: f64) -> FoundPullOff<f64> {
    let found = PullOff::default().tolerance(tolerance).find(&mut Solver::default(), problem).unwrap();
    assert!(found.reached);
    found
}

fn pull_off(problem: &mut Problem<f64>, tolerance: f64) -> Report {
    find(problem, tolerance).solution.report
}

/// The value to which those on a grid and on one of half its spacing converge in the first order.
fn extrapolated(coarse: f64, fine: f64) -> f64 {
    2.0 * fine - coarse
}

#[test]
fn the_range_is_as_short_as_the_nodes_can_follow() {
    let law = Jkr::new(1e-4).unwrap();
    let steepest = |problem: &Problem<f64>| {
        let law = problem.law_on_grid();
        let range = law.hints().range;
        (0..=1000).map(|i| -law.slope(1e-3 * f64::from(i) * range)).fold(0.0, f64::max)
    };
    let material = Material::new(2.0, 0.3).unwrap();
    for (shape, lengths) in [((64, 64), (1.0, 1.0)), ((64, 32), (1.0, 1.0)), ((1, 48), (1.0, 3.0))] {
        let grid = Grid::new(shape, lengths).unwrap();
        let spacing = (lengths.0 / shape.0 as f64 * f64::from(u8::from(shape.0 > 1)))
            .max(lengths.1 / shape.1 as f64 * f64::from(u8::from(shape.1 > 1)));
        let surface = Surface::from_fn(grid, |_, y| 0.01 * (2.0 * PI * y / lengths.1).cos()).unwrap();
        let mut bodies: Vec<Box<dyn ElasticOperator<f64>>> = vec![
            Box::new(Westergaard::new(grid, 2.0).unwrap()),
            // as thick as half a spacing
            Box::new(Spectral::of(grid, Layer::new(material, 0.5 * spacing, Base::Bonded).unwrap()).unwrap()),
        ];
        if shape.0 > 1 {
            bodies.push(Box::new(Boussinesq::new(grid, 2.0).unwrap()));
        }
        for body in bodies {
            let modulus = body.modulus();
            let problem = Problem::new(&surface, body, law).unwrap();
            assert!((steepest(&problem) * spacing / modulus - 3.75 / 13.0).abs() < 1e-5, "{shape:?} {modulus}");
            assert!((problem.mu_rho() - 13.0_f64.sqrt().recip()).abs() < 1e-12);
        }
    }
    // nothing attracts without a work of adhesion
    assert_eq!(mu_rho::<f64>(&Jkr::new(0.0).unwrap(), &Grid::square(8, 1.0).unwrap(), 1.0), 0.0);
}

#[test]
fn the_limit_of_no_range_attracts_in_contact_alone() {
    let law = Jkr::new(0.05).unwrap();
    assert_eq!((AdhesionLaw::<f64>::energy(&law, 0.0), AdhesionLaw::<f64>::energy(&law, 1e-12)), (-0.05, 0.0));
    assert_eq!((AdhesionLaw::<f64>::traction(&law, 1e-12), AdhesionLaw::<f64>::hints(&law).range), (0.0, 0.0));
    assert!(Jkr::new(-1.0).is_err() && Jkr::new(f64::NAN).is_err());
}

#[test]
fn a_sphere_has_the_contact_and_the_pull_offs_of_jkr() {
    let exact = exact::Jkr::new(1.0, 1.0, WORK).unwrap();
    let unloaded = exact.at_load(0.0).unwrap();
    // 12 and 24 nodes a radius
    let found = [64, 128].map(|n| {
        let mut problem = sphere(n);
        let [loading, unloading] = [Branch::Loading, Branch::Unloading].map(|branch| {
            let mut solver = Solver::new(Settings::default().branch(branch));
            solver.solve(&mut problem, Control::Force(0.0)).unwrap()
        });
        assert_eq!(loading.contact_map(), unloading.contact_map());
        let report = &loading.report;
        // as loading comes from the node that touches first
        assert!(report.operator_applications <= 90, "{}", report.operator_applications);
        let area = report.adhesive_contact_fraction.unwrap() * SIDE * SIDE;
        let radius = (area / PI).sqrt() / unloaded.contact_radius();
        let approach = report.approach.unwrap() / unloaded.approach();
        let force = pull_off(&mut problem, 5e-4).normal_force / exact.pull_off().load();
        [radius, approach, force]
    });
    let [coarse, fine] = found;
    let limit = [0, 1, 2].map(|i| extrapolated(coarse[i], fine[i]));
    println!("radius, approach, pull-off over those of JKR: {coarse:?} {fine:?}, extrapolated {limit:?}");
    // of first order: 3 % on one grid of 24 nodes, 1.1 % by two
    assert!(fine.iter().all(|ratio| (ratio - 1.0).abs() < 0.03), "{fine:?}");
    assert!(limit.iter().all(|ratio| (ratio - 1.0).abs() < 0.011), "{limit:?}");
    assert!(coarse.iter().zip(&fine).all(|(coarse, fine)| (fine - 1.0).abs() < 0.75 * (coarse - 1.0).abs()));
}

#[test]
fn a_sphere_that_is_held_comes_off_where_jkr_says() {
    // at a given approach contact ends where δ = −3a²/R, a³ = πwR²/8E*, under −5πwR/6
    let last = -3.0 * (PI * WORK / 8.0).powf(2.0 / 3.0);
    let found = [48, 96].map(|n| {
        let mut problem = sphere(n);
        let loads = (0..=80).map(|i| Control::Approach((0.6 + 0.01 * f64::from(i)) * last));
        let mut solver = Solver::new(Settings::default().branch(Branch::Unloading));
        let mut sweep = Sweep::default();
        let reports = loads.map(|load| sweep.next(&mut solver, &mut problem, load).unwrap().report);
        let held = reports.take_while(|report| report.contact_nodes > 0).last().unwrap();
        held.approach.unwrap() / last
    });
    let limit = extrapolated(found[0], found[1]);
    println!("last approach over that of JKR: {found:?}, extrapolated {limit:.3}");
    assert!((limit - 1.0).abs() < 0.03, "{found:?}");
}

#[test]
fn a_wave_follows_johnson_up_and_down_and_comes_off_at_his_pressure() {
    for (n, bound) in [(128, 7e-3), (512, 2e-3)] {
        let grid = Grid::line(n, 1.0).unwrap();
        let exact = wave(1.0);
        let surface = Surface::wave(grid, AMPLITUDE, 1).unwrap();
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law(1.0)).unwrap();
        let loads = [0.1, 0.2, 0.3, 0.35, 0.3, 0.2, 0.1, 0.0, -0.05];
        let pressures = loads.map(|load| load * exact.closing_pressure());
        let mut solver = Solver::new(Settings::default().branch(Branch::Loading));
        let mut sweep = Sweep::default();
        for pressure in pressures {
            let step = sweep.next(&mut solver, &mut problem, Control::MeanPressure(pressure)).unwrap();
            let area = step.report.adhesive_contact_fraction.unwrap();
            let expected = 2.0 * exact.at_mean_pressure(pressure).unwrap().half_width();
            let of_load = if pressure > 0.0 { bound } else { 3.0 * bound };
            assert!((area / expected - 1.0).abs() < of_load, "{n} {pressure}: {area} {expected}");
        }
        let preloaded = PullOff::default().tolerance(1e-3).preload(Some(0.3 * exact.closing_pressure()));
        let found = preloaded.find(&mut Solver::default(), &mut problem).unwrap().solution.report.mean_pressure;
        let ratio = found / exact.pull_off().unwrap().mean_pressure();
        assert!((ratio - 1.0).abs() < 0.011, "{n}: {ratio}");
    }
}

#[test]
fn a_front_peels_alike_along_x_and_y_and_the_diagonal() {
    // a wave along both axes of an oblong grid, and along the diagonal, of 64 nodes a wavelength and more
    let plane = |shape: (usize, usize), (i, j): (f64, f64), wavelength: f64| {
        let grid = Grid::new(shape, (1.0, 1.0)).unwrap();
        let surface = Surface::from_fn(grid, |x, y| AMPLITUDE * (2.0 * PI * (i * x + j * y)).cos()).unwrap();
        let half_space = Westergaard::<f64>::new(grid, 1.0).unwrap();
        let mut problem = Problem::new(&surface, half_space, law(wavelength)).unwrap();
        let exact = wave(wavelength);
        let preloaded = PullOff::default().tolerance(2e-3).preload(Some(0.3 * exact.closing_pressure()));
        let found = preloaded.find(&mut Solver::default(), &mut problem).unwrap().solution.report.mean_pressure;
        found / exact.pull_off().unwrap().mean_pressure()
    };
    let along_x = plane((128, 32), (1.0, 0.0), 1.0);
    let along_y = plane((32, 128), (0.0, 1.0), 1.0);
    let fine = plane((128, 128), (1.0, 0.0), 1.0);
    let diagonal = plane((128, 128), (1.0, 1.0), 0.5_f64.sqrt());
    println!("pull-off over Johnson's: along x {along_x}, along y {along_y}, {fine}, on the diagonal {diagonal}");
    assert!((along_x / along_y - 1.0).abs() < 2e-3);
    // the larger spacing is four times the spacing of the others
    assert!((along_x - 1.0).abs() < 0.05 && (fine - 1.0).abs() < 0.015 && (diagonal - 1.0).abs() < 0.02);
}

#[test]
fn a_flat_punch_and_a_cone_come_off_as_they_do_in_the_limit() {
    let work = 1e-3;
    let side = 1.0;
    let on = |n: usize, surface: &Surface| {
        let grid = Grid::square(n, side).unwrap();
        let half_space = Boussinesq::new(grid, 1.0).unwrap();
        find(&mut Problem::new(surface, half_space, Jkr::new(work).unwrap()).unwrap(), 3e-3)
    };
    let punch = [48, 96].map(|n| {
        let grid = Grid::square(n, side).unwrap();
        let heights = grid.sample(|x, y| if x.hypot(y) <= 0.25 { 0.0 } else { f64::NAN });
        let nodes = heights.iter().filter(|height| height.is_finite()).count() as f64;
        let radius = (nodes / PI).sqrt() * side / n as f64;
        // the pull-off of Kendall (1971), whether the punch has a foot or its nodes alone face the half-space
        let kendall = (8.0 * PI * work * radius.powi(3)).sqrt() / (side * side);
        let foot = Surface::new(grid, heights.mapv(|height| if height.is_nan() { -1.0 } else { height })).unwrap();
        let [_, alone] = [foot, surface_with_absent(grid, heights).unwrap()].map(|surface| {
            let found = on(n, &surface);
            let limit = found.limit().unwrap().unwrap() / kendall;
            assert!((limit - 1.0).abs() < 0.02, "{n} nodes: {limit}");
            found
        });
        -alone.solution.report.mean_pressure / kendall
    });
    // F = ½πE*m a² − √(8πwE*a³), least where a = 18w/(πE*m²)
    let slope = 0.2;
    let a = 18.0 * work / (PI * slope * slope);
    let exact = (8.0 * PI * work * a.powi(3)).sqrt() - exact::Cone::new(slope, 1.0).unwrap().load(a);
    let cone = [48, 96].map(|n| {
        let surface = Surface::from_fn(Grid::square(n, side).unwrap(), |x, y| -slope * x.hypot(y)).unwrap();
        -on(n, &surface).solution.report.normal_force / exact
    });
    println!("pull-off over that of the limit: punch {punch:?}, cone {cone:?}");
    let limit = extrapolated(cone[0], cone[1]);
    assert!((limit - 1.0).abs() < 0.02, "{cone:?}");
    let limit = extrapolated(punch[0], punch[1]);
    assert!((limit - 1.0).abs() < 0.04, "{punch:?}");
}

#[test]
fn pillars_that_repeat_have_a_limit_of_their_pull_off() {
    let grid = Grid::square(64, 1.0).unwrap();
    let heights = grid.sample(|x, y| if x.hypot(y) <= 0.15 { 0.0 } else { f64::NAN });
    let deep = Surface::new(grid, heights.mapv(|height| if height.is_nan() { -1.0 } else { height })).unwrap();
    let limits = [deep, surface_with_absent(grid, heights).unwrap()].map(|surface| {
        let half_space = Westergaard::new(grid, 1.0).unwrap();
        let mut problem = Problem::new(&surface, half_space, Jkr::new(1e-4).unwrap()).unwrap();
        // the area changes by a percent in the last thousandths of the tension
        find(&mut problem, 3e-4).limit().unwrap().unwrap()
    });
    assert!((limits[0] / limits[1] - 1.0).abs() < 0.01, "{limits:?}");
}

#[test]
fn each_work_of_adhesion_that_varies_has_its_range() {
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = Surface::paraboloid(grid, 2.0).unwrap();
    let works = grid.sample(|x, _| if x < 0.0 { 0.0 } else { 2e-4 });
    let solve = |law: Box<dyn AdhesionLaw<f64>>| {
        let mut problem = Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap();
        let range = problem.law_on_grid().hints().range;
        (range, Solver::default().solve(&mut problem, Control::MeanPressure(1e-4)).unwrap())
    };
    // the law that varies is of any work of adhesion
    let [(range, some), (other, same)] = [1e-4, 7e-3].map(|work| {
        let law = Jkr::new(work).unwrap();
        solve(Box::new(Varying::new(law, works.view()).unwrap()))
    });
    let (whole, all) = solve(Box::new(Jkr::new(2e-4).unwrap()));
    assert!((range / whole - 1.0).abs() < 1e-12 && (other / whole - 1.0).abs() < 1e-12);
    assert!((&some.gap - &same.gap).iter().all(|change| change.abs() < 1e-9));
    assert!(some.report.contact_nodes < all.report.contact_nodes);
    // the half without adhesion counts where it touches
    let [half, full] = [&some, &all].map(|found| found.report.adhesive_contact_fraction.unwrap());
    assert!(some.report.contact_fraction < half && half < full, "{half} {full}");
    let uniform = Varying::new(Jkr::new(1.0).unwrap(), Array2::from_elem((64, 64), 2e-4).view()).unwrap();
    let uniform = solve(Box::new(uniform)).1.report;
    assert_eq!(uniform.contact_nodes, all.report.contact_nodes);
    assert!((uniform.adhesive_contact_fraction.unwrap() / full - 1.0).abs() < 1e-9);
    // a node far from the contact that is a hundred times as sticky touches nothing, and changes nothing
    let mut works = Array2::from_elem((64, 64), 2e-4);
    works[[0, 0]] = 2e-2;
    let (longer, far) = solve(Box::new(Varying::new(Jkr::new(2e-4).unwrap(), works.view()).unwrap()));
    assert!((longer / whole - 10.0).abs() < 1e-12);
    assert!((&far.gap - &all.gap).iter().all(|change| change.abs() < 1e-9));
    let [far, all] = [far, all].map(|found| ContactArea::of_solution(&found).unwrap().jkr_contact_fraction.unwrap());
    assert!((far / all - 1.0).abs() < 1e-6, "{far} {all}");
}

#[test]
fn areas_and_errors_of_weak_adhesion_are_those_of_none() {
    let surface = SelfAffine::default().k_s(6.0).amplitude(Amplitude::RmsSlope(0.3)).seed(1);
    let surface = surface.surface(Grid::square(64, 1.0).unwrap()).unwrap();
    let told = |law: Formula| {
        let nested = Nested::default().coarsest(16).closed(1.0);
        let half_space = |grid: Grid| Westergaard::<f64>::new(grid, 1.0);
        let found =
            nested.solve(&mut Solver::default(), &surface, half_space, law, Control::MeanPressure(0.02)).unwrap();
        let waves = surface.nodes_per_wave(Boundary::Periodic);
        let error = |of| GridError::of(&found.levels, of, waves, found.solution.report.mu_rho).unwrap().relative;
        let area = found.levels.last().unwrap().area;
        (
            area.jkr_contact_fraction.unwrap_or(area.corrected_contact_fraction),
            error(Quantity::Area),
            error(Quantity::Gap),
        )
    };
    let (area, area_error, gap_error) = told(NoAdhesion.into());
    let mut before = area;
    for exponent in [-12, -10, -8, -7, -6] {
        let (found, of_area, of_gap) = told(Jkr::new(10_f64.powi(exponent)).unwrap().into());
        // the area grows by no leap
        assert!((found / before - 1.0).abs() < 0.05, "1e{exponent}: {found} after {before}");
        before = found;
        let like = |found: f64, of_none: f64| 0.5 * of_none < found && (exponent > -8 || found < 2.5 * of_none);
        assert!(
            like(of_area, area_error) && like(of_gap, gap_error),
            "1e{exponent}: {of_area} {area_error} {of_gap} {gap_error}"
        );
    }
}

#[test]
fn a_punch_wholly_in_contact_has_its_area() {
    let grid = Grid::square(48, 1.0).unwrap();
    let heights = grid.sample(|x, y| if x.hypot(y) <= 0.2 { 0.0 } else { -1.0 });
    let nodes = heights.iter().filter(|&&height| height == 0.0).count() as f64;
    let surface = Surface::new(grid, heights).unwrap();
    for work in [1e-9, 1e-5, 1e-3] {
        let mut problem =
            Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), Jkr::new(work).unwrap()).unwrap();
        let solution = Solver::default().solve(&mut problem, Control::Force(1e-3)).unwrap();
        let area = ContactArea::of_solution(&solution).unwrap().jkr_contact_fraction.unwrap();
        assert!((area * grid.nodes() as f64 / nodes - 1.0).abs() < 1e-6, "{work}: {area}");
    }
}

#[test]
fn the_area_of_a_contact_of_a_node_is_positive_on_long_cells() {
    let grid = Grid::new((16, 48), (1.0, 1.0)).unwrap();
    let surface = Surface::paraboloid(grid, 0.5).unwrap();
    let mut problem =
        Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), Jkr::new(1e-7).unwrap()).unwrap();
    let solution = Solver::default().solve(&mut problem, Control::MeanPressure(1e-5)).unwrap();
    assert!(ContactArea::of_solution(&solution).unwrap().jkr_contact_fraction.unwrap() > 0.0);
}

#[test]
fn results_depend_neither_on_units_nor_on_the_precision() {
    let solve = |length: f64, pressure: f64| {
        let grid = Grid::square(64, length).unwrap();
        let surface = Surface::wave_2d(grid, 0.02 * length, 2).unwrap();
        let half_space = Westergaard::<f64>::new(grid, pressure).unwrap();
        let law = Jkr::new(1e-4 * length * pressure).unwrap();
        let mut problem = Problem::new(&surface, half_space, law).unwrap();
        Solver::default().solve(&mut problem, Control::MeanPressure(0.01 * pressure)).unwrap().report
    };
    let [a, b] = [solve(1.0, 1.0), solve(3e-7, 7e10)];
    assert_eq!((a.contact_nodes, a.iterations), (b.contact_nodes, b.iterations));
    assert!((a.range.unwrap() / b.range.unwrap() * 3e-7 - 1.0).abs() < 1e-12);
    assert!((a.adhesive_contact_fraction.unwrap() / b.adhesive_contact_fraction.unwrap() - 1.0).abs() < 1e-6);
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = Surface::wave_2d(grid, 0.02, 2).unwrap();
    let half_space = Westergaard::<f32>::new(grid, 1.0).unwrap();
    let mut problem = Problem::new(&surface, half_space, Jkr::new(1e-4).unwrap()).unwrap();
    let single = Solver::default().solve(&mut problem, Control::MeanPressure(0.01)).unwrap().report;
    assert!((single.adhesive_contact_fraction.unwrap() / a.adhesive_contact_fraction.unwrap() - 1.0).abs() < 1e-3);
}

#[test]
fn surfaces_need_a_wall() {
    let grid = Grid::square(16, 1.0).unwrap();
    let surface = Surface::wave_2d(grid, 0.02, 1).unwrap();
    let half_space = Westergaard::<f64>::new(grid, 1.0).unwrap();
    let mut problem = Problem::new(&surface, half_space, Jkr::new(1e-4).unwrap()).unwrap();
    let mut solver = Solver { settings: Settings::default(), constraint: NoWall };
    assert!(matches!(solver.solve(&mut problem, Control::MeanGap(0.02)), Err(Error::Unsuited { what: "no wall", .. })));
}

#[test]
fn each_of_nested_grids_has_a_range_of_its_own() {
    let surface = SelfAffine::default().k_s(16.0).amplitude(Amplitude::RmsSlope(0.2)).seed(2);
    let surface = surface.surface(Grid::square(256, 1.0).unwrap()).unwrap();
    let law = Jkr::new(2e-6).unwrap();
    let control = Control::MeanPressure(0.005);
    let nested = Nested::default();
    assert!(nested.pays::<f64>(&Settings::default(), &surface, &law, control));
    assert!(!nested.pays::<f64>(&Settings::default(), &surface, &law, Control::MeanPressure(0.0)));
    let half_space = |grid: Grid| Westergaard::<f64>::new(grid, 1.0);
    let found = nested.solve(&mut Solver::default(), &surface, half_space, law, control).unwrap();
    assert_eq!(found.levels.len(), 3);
    let mut problem = Problem::new(&surface, half_space(*surface.grid()).unwrap(), law).unwrap();
    let alone = Solver::default().solve(&mut problem, control).unwrap();
    let differ = alone.contact_map().iter().zip(&found.solution.contact_map()).filter(|(a, b)| a != b).count();
    // fronts rest within the work of adhesion by which the grid holds them, 0.5 %
    assert!(differ * 200 <= alone.report.contact_nodes, "{differ} of {}", alone.report.contact_nodes);
    let [one, nested] = [alone.report.operator_applications as f64, found.equivalent_applications()];
    assert!(nested < 0.9 * one, "{nested} {one}");
}
