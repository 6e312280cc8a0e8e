//! Which equilibrium is found where adhesion has several: the largest by loading, the smallest by unloading.

use asperity::adhesion::{Hints, Values};
use asperity::solver::Criterion;
use asperity::*;
use ndarray::Array2;

/// An adhesive traction that is given at each node, whatever the gap.
struct Held(Vec<f64>);

impl AdhesionLaw<f64> for Held {
    fn energy(&self, gap: f64) -> f64 {
        gap
    }
    fn traction(&self, _: f64) -> f64 {
        1.0
    }
    fn slope(&self, _: f64) -> f64 {
        0.0
    }
    fn hints(&self) -> Hints<f64> {
        Hints::of(self).with_range(1e30)
    }
    fn evaluate(&self, first: usize, gaps: &[f64], values: Values<'_, f64>) {
        values.each(|order, values| {
            for ((value, gap), traction) in values.iter_mut().zip(gaps).zip(&self.0[first..]) {
                *value = [traction * gap, *traction, 0.0][order];
            }
        });
    }
}

/// The equilibrium to which solutions under held tractions lead, each under the tractions at the gap before: down from
/// a gap above all equilibria to the largest, up from full contact to the smallest.
fn by_held_tractions(
    surface: &Surface,
    law: &impl AdhesionLaw<f64>,
    control: Control,
    mut gap: Array2<f64>,
) -> Array2<f64> {
    let settings = Settings::default().tolerance(1e-8);
    for _ in 0..2000 {
        let held = Held(gap.iter().map(|&gap| law.traction(gap)).collect());
        let half_space = Westergaard::new(*surface.grid(), 1.0).unwrap();
        let mut problem = Problem::new(surface, half_space, held).unwrap();
        let found = oracles::solve_to(&mut problem, control, settings, Start::From(&gap));
        let change = found.gap.iter().zip(&gap).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        gap = found.gap;
        if change < 1e-7 * law.hints().range {
            return gap;
        }
    }
    panic!("the tractions have not settled");
}

/// The solutions on both branches under a load.
fn both(surface: &Surface, law: impl AdhesionLaw<f64> + 'static, control: Control) -> [Solution<f64>; 2] {
    let half_space = Westergaard::new(*surface.grid(), 1.0).unwrap();
    let mut problem = Problem::new(surface, half_space, law).unwrap();
    [Branch::Loading, Branch::Unloading].map(|branch| {
        let settings = Settings::default().branch(branch).tolerance(1e-7);
        let found = oracles::solve_to(&mut problem, control, settings, Start::Default);
        assert_eq!((found.report.status, found.report.branch), (Status::Converged, Some(branch)));
        found
    })
}

/// The largest difference of two gaps, in ranges of adhesion.
fn apart(a: &Array2<f64>, b: &Array2<f64>, range: f64) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / range
}

/// The total energy under a mean pressure.
fn energy(report: &Report) -> f64 {
    report.elastic_energy + report.adhesive_energy + report.mean_pressure * report.mean_gap
}

#[test]
fn loading_finds_the_largest_equilibrium_and_unloading_the_smallest() {
    let wave = Surface::wave_2d(Grid::square(32, 1.0).unwrap(), 0.02, 1).unwrap();
    let line = Surface::wave(Grid::line(128, 1.0).unwrap(), 0.02, 1).unwrap();
    let rough = |seed| oracles::rough::rough(Grid::square(48, 1.0).unwrap(), 6, seed);
    let (mut several, mut one) = (0, 0);
    for (surface, w, range) in [
        (&line, 4e-4, 4e-3),
        (&wave, 3e-4, 4e-3),
        (&wave, 1e-4, 4e-3),
        (&rough(1), 2e-3, 2e-2),
        (&rough(2), 3e-3, 1.5e-2),
    ] {
        let law = Exponential::new(w, range).unwrap();
        for pressure in [2e-4, 2e-3, 2e-2] {
            let control = Control::MeanPressure(pressure);
            let [loading, unloading] = both(surface, law, control);
            // from far above all equilibria, and from full contact
            let far = &loading.gap + 100.0 * range;
            let largest = by_held_tractions(surface, &law, control, far);
            let smallest = by_held_tractions(surface, &law, control, Array2::zeros(loading.gap.dim()));
            let distances = [apart(&loading.gap, &largest, range), apart(&unloading.gap, &smallest, range)];
            assert!(distances.iter().all(|&distance| distance < 1e-3), "{w} {pressure}: {distances:?}");
            let below = loading.gap.iter().zip(&unloading.gap).map(|(a, b)| b - a).fold(0.0, f64::max);
            assert!(below <= 1e-4 * range, "{w} {pressure}: {below:e}");
            let (same, distance) = (loading.agrees_with(&unloading), loading.distance(&unloading));
            assert_eq!(same, apart(&loading.gap, &unloading.gap, range) < 1e-3, "{w} {pressure}: {distance:e}");
            let change = (energy(&loading.report) - energy(&unloading.report)).abs() / energy(&unloading.report).abs();
            assert!(!same || change < 1e-9, "{change:e}");
            *(if same { &mut one } else { &mut several }) += 1;
        }
    }
    assert!(several >= 2 && one >= 4, "{several} and {one}");
}

#[test]
fn pressing_from_afar_in_small_steps_ends_on_the_branch_of_loading() {
    let surface = Surface::wave(Grid::line(128, 1.0).unwrap(), 0.02, 1).unwrap();
    let law = Exponential::new(4e-4, 4e-3).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::new(*surface.grid(), 1.0).unwrap(), law).unwrap();
    let mut solver = Solver::new(Settings::default().tolerance(1e-7));
    let rising = (1..=12).map(|step| Control::MeanPressure(2e-4 * f64::from(step)));
    let far = 0.1 - surface.heights();
    let mut last = None;
    let mut sweep = Sweep::starting_from(far);
    for control in rising {
        let along = sweep.next(&mut solver, &mut problem, control).unwrap();
        let [loading, unloading] = both(&surface, law, control);
        assert!(apart(&along.gap, &loading.gap, 4e-3) < 1e-3, "{control:?}");
        last = Some((loading, unloading));
    }
    let (loading, unloading) = last.unwrap();
    // surfaces that were pressed flat stay so
    assert!(loading.report.contact_fraction < 0.9 && unloading.report.contact_fraction == 1.0);
}

#[test]
fn the_branch_follows_the_load_unless_it_is_given() {
    let grid = Grid::square(32, 1.0).unwrap();
    let surface = Surface::wave_2d(grid, 0.02, 1).unwrap();
    let law = Exponential::new(1e-5, 4e-3).unwrap();
    let (loading, unloading) = (Some(Branch::Loading), Some(Branch::Unloading));
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let mut free = Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let mut bare = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let pressure = Control::MeanPressure;
    let spring = |rest| Control::Spring { stiffness: 1.0, rest };
    for (control, expected) in [
        (pressure(0.01), loading),
        (pressure(0.0), loading),
        (pressure(-1e-4), unloading),
        (Control::MeanGap(0.01), unloading),
        // the surfaces just touch at a mean gap of 0.02
        (spring(0.019), loading),
        (spring(0.021), unloading),
    ] {
        let found = Solver::default().solve(&mut problem, control).unwrap();
        assert_eq!(found.report.branch, expected, "{control:?}");
    }
    for (control, expected) in [
        (Control::Force(1e-3), loading),
        (Control::Approach(1e-3), loading),
        (Control::Approach(-1e-3), unloading),
        (spring(1e-3), loading),
        (spring(-1e-3), unloading),
    ] {
        assert_eq!(Solver::default().solve(&mut free, control).unwrap().report.branch, expected, "{control:?}");
    }
    assert_eq!(Solver::default().solve(&mut bare, pressure(0.01)).unwrap().report.branch, None);
    let from =
        oracles::solve_to(&mut problem, pressure(0.01), Settings::default(), Start::From(&Array2::zeros((32, 32))));
    assert_eq!(from.report.branch, None);
    let mut springs = Solver { settings: Settings::default(), constraint: Penalty::new(100.0).unwrap() };
    assert_eq!(springs.solve(&mut problem, pressure(0.01)).unwrap().report.branch, unloading);
    let mut paper = Solver::new(Settings::rey2017().criterion(Criterion::Complementarity).tolerance(1e-6));
    assert_eq!(paper.solve(&mut problem, pressure(0.01)).unwrap().report.branch, None);
    paper.settings.branch = loading;
    assert!(matches!(paper.solve(&mut problem, pressure(0.01)), Err(Error::Unsuited { .. })));
    let found = ContactSearch::default().at(&mut Solver::default(), &mut problem, 0.2).unwrap();
    assert_eq!(found.solution.report.branch, loading);
    let half_space = |grid: Grid| Westergaard::<f64>::new(grid, 1.0);
    let nested = Nested::default().coarsest(16);
    let found = nested.solve(&mut Solver::default(), &surface, half_space, law, pressure(0.01)).unwrap();
    assert_eq!(found.solution.report.branch, loading);
}

#[test]
fn a_law_that_keeps_the_surfaces_apart_by_itself_has_both_branches() {
    let line = Grid::line(128, 1.0).unwrap();
    let surface = Surface::wave(line, 0.02, 1).unwrap();
    let law = Morse::new(4e-4, 4e-3).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(line, 1.0).unwrap(), law).unwrap();
    let mut found = [Branch::Loading, Branch::Unloading].map(|branch| {
        let settings = Settings::default().branch(branch);
        let mut solver = Solver { settings, constraint: NoWall };
        let report = solver.solve(&mut problem, Control::MeanPressure(0.0)).unwrap().report;
        assert_eq!((report.status, report.branch), (Status::Converged, Some(branch)));
        report
    });
    found.sort_by(|a, b| a.mean_gap.total_cmp(&b.mean_gap));
    assert_eq!(found[0].branch, Some(Branch::Unloading));
    assert!(found[1].mean_gap > 1.2 * found[0].mean_gap, "{} {}", found[0].mean_gap, found[1].mean_gap);
}

/// Tips on a free half-space with next to no load, the first scene of every approach: they neither fly apart nor take
/// long to settle.
#[test]
fn tips_under_next_to_no_load_find_the_force_that_holds_them() {
    for shape in [(16, 16), (32, 32), (5, 2)] {
        let grid = Grid::new(shape, (0.24, 0.24)).unwrap();
        let sphere = Surface::paraboloid(grid, 2.0).unwrap();
        let cone = Surface::from_fn(grid, |x, y| -0.1 * x.hypot(y)).unwrap();
        let bumps = sphere.heights() + &grid.sample(|x, y| 2e-4 * (90.0 * x).cos() * (80.0 * y + 1.0).cos());
        for tip in [&sphere, &cone, &Surface::new(grid, bumps).unwrap()] {
            for (w, range) in [(2e-5, 2e-3), (1e-4, 2e-3), (1e-5, 5e-4)] {
                let laws: [Box<dyn AdhesionLaw<f64>>; 5] = [
                    Box::new(Exponential::new(w, range).unwrap()),
                    Box::new(PowerLaw::new(w, range, 3.0).unwrap()),
                    Box::new(LennardJones::new(w, range).unwrap().cut()),
                    Box::new(Morse::new(w, range).unwrap()),
                    Box::new(Tabulated::new(&[0.0, range, 2.0 * range], &[w / range, 0.5 * w / range, 0.0]).unwrap()),
                ];
                let pull_off = 3.0 * std::f64::consts::PI * w;
                for law in laws {
                    let mut problem = Problem::new(tip, Boussinesq::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
                    for share in [0.0, 1e-4, 1e-6, -1e-6, -1e-4, -1e-2] {
                        let report =
                            Solver::default().solve(&mut problem, Control::Force(share * pull_off)).unwrap().report;
                        let ended = (report.status, report.iterations);
                        assert!(ended.0 == Status::Converged && ended.1 <= 150, "{shape:?} {w} {share}: {ended:?}");
                    }
                }
            }
        }
    }
}

/// The contact under pressures and adhesions of a rough surface, by loading, in the largest equilibrium and by
/// unloading, with the applications that they take. Prints them as a table.
#[test]
fn the_branch_of_loading_is_kept_where_the_grid_resolves_the_adhesion() {
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = oracles::rough::rough(grid, 5, 1);
    let (mut taken, mut scenes) = ([0; 2], 0);
    println!("mu_rho  pressure  loading  largest  unloading  applications");
    for (w, range) in [(1.42e-2, 2.9e-2), (6e-3, 1e-2), (3e-3, 4e-3), (2e-3, 2e-3), (1.42e-3, 1e-3)] {
        let law = Exponential::new(w, range).unwrap();
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
        for pressure in [2e-3, 2e-2, 0.2] {
            let control = Control::MeanPressure(pressure);
            let [loading, unloading] = [Branch::Loading, Branch::Unloading].map(|branch| {
                let settings = Settings::default().branch(branch);
                oracles::solve_to(&mut problem, control, settings, Start::Default)
            });
            let largest = by_held_tractions(&surface, &law, control, &loading.gap + 100.0 * range);
            let of_largest = largest.iter().filter(|&&gap| gap == 0.0).count() as f64 / 4096.0;
            let [counts, shares] = [
                [&loading, &unloading].map(|found| found.report.operator_applications as f64),
                [&loading, &unloading].map(|found| found.report.contact_fraction),
            ];
            println!(
                "{:6.2} {pressure:9.0e} {:8.4} {of_largest:8.4} {:10.4}  {:4} {:4}",
                problem.mu_rho(),
                shares[0],
                shares[1],
                counts[0],
                counts[1]
            );
            taken[0] += loading.report.operator_applications;
            taken[1] += unloading.report.operator_applications;
            scenes += 1;
            assert!(shares[0] >= of_largest - 1e-3 && shares[0] <= 1.12 * of_largest + 1e-3);
            if problem.mu_rho() < 1.0 {
                assert!(apart(&loading.gap, &largest, range) < 1e-3);
            }
        }
    }
    println!("{scenes} scenes: {} applications by loading, {} by unloading", taken[0], taken[1]);
}

#[test]
fn a_branch_that_is_not_found_agrees_with_none() {
    let surface = Surface::wave(Grid::line(128, 1.0).unwrap(), 0.02, 1).unwrap();
    let law = Exponential::new(4e-4, 4e-3).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(*surface.grid(), 1.0).unwrap(), law).unwrap();
    // a tension that holds surfaces which were pressed flat, and none that come together
    let [loading, unloading] = [Branch::Loading, Branch::Unloading].map(|branch| {
        let settings = Settings::default().branch(branch);
        oracles::solve_to(&mut problem, Control::MeanPressure(-0.02), settings, Start::Default)
    });
    assert_eq!((loading.report.status, unloading.report.status), (Status::Detached, Status::Converged));
    assert!(!loading.agrees_with(&unloading) && !loading.agrees_with(&loading));
    assert_eq!((Branch::Loading.other(), Branch::Unloading.other()), (Branch::Unloading, Branch::Loading));
}
