//! Branches of equilibria without a wall: jumps and stability of surfaces that the law itself keeps apart.

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;

use asperity::path::{Event, Jump, Path, PathSettings, PathStep};
use asperity::stability::{StabilityTest, Verdict};
use asperity::*;
use ndarray::Array2;

use oracles::dense::{Dense, Held};
use oracles::{Checkpoint, followed, swept};

fn without_wall(tolerance: f64) -> Solver<NoWall> {
    Solver { settings: Settings::default().tolerance(tolerance), constraint: NoWall }
}

#[track_caller]
fn follow(problem: &mut Problem<f64>, loads: impl IntoIterator<Item = Control>, tolerance: f64) -> Vec<PathStep<f64>> {
    let mut solver = without_wall(tolerance);
    let steps = followed(Path::new(loads, PathSettings::default().smallest_step(1e-4)).unwrap(), &mut solver, problem);
    for step in &steps {
        assert_eq!(step.solution.report.status, Status::Converged, "{:?} {:?}", step.solution.report, step.event);
    }
    steps
}

fn jump(step: &PathStep<f64>) -> Option<Jump> {
    step.event.as_ref().and_then(Event::jump).copied()
}

fn flats(law: impl AdhesionLaw<f64> + 'static) -> Problem<f64> {
    let grid = Grid::square(8, 1.0).unwrap();
    let flat = Surface::from_fn(grid, |_, _| 0.0).unwrap();
    Problem::new(&flat, Westergaard::new(grid, 1.0).unwrap(), law).unwrap()
}

#[test]
fn flats_on_a_spring_jump_where_its_stiffness_is_that_of_the_attraction() {
    // κ + φ'' = 0: 2e² − e = −κρ²/2w with e = exp(−g/ρ); the softest wave, πE*/L, is stiffer than any attraction
    let (work, range, stiffness) = (1e-3, 1e-2, 1.5);
    let law = Morse::new(work, range).unwrap();
    let springs = [0.1, -0.02, 0.1].map(|rest| Control::Spring { stiffness, rest });
    let steps = follow(&mut flats(law), springs, 1e-6);
    let jumps: Vec<_> = steps.iter().filter_map(|step| Some((step, jump(step)?))).collect();
    assert_eq!(jumps.len(), 2);
    assert_eq!([0, 1].map(|k| jumps[k].0.event.unwrap().name()), ["jump-in", "jump-out"]);
    let root = (1.0 - 4.0 * stiffness * range * range / work).sqrt();
    let width = 1e-4 * 0.12;
    for ((step, jump), e) in jumps.into_iter().zip([0.25 * (1.0 - root), 0.25 * (1.0 + root)]) {
        let gap = -range * f64::ln(e);
        let expected = gap + law.traction(gap) / stiffness;
        let Control::Spring { rest, .. } = step.solution.report.control else { panic!() };
        assert!((rest - expected).abs() < 3.0 * width, "{rest} {expected}");
        let energy = |g: f64| law.energy(g) + 0.5 * stiffness * (g - rest).powi(2);
        let drop = energy(jump.mean_gap.0) - energy(jump.mean_gap.1);
        // the load of the state before is of a spring that is a step behind
        assert!((jump.energy_drop / drop - 1.0).abs() < 2e-2, "{} {drop}", jump.energy_drop);
        let after = stiffness * (jump.mean_gap.1 - rest) + law.traction(jump.mean_gap.1);
        assert!(after.abs() < 1e-6 * work / range, "{after:e}");
    }
}

#[test]
fn flats_under_a_tension_have_their_limit_point_at_the_strongest_traction() {
    // x⁶ = 1/3, φ' = 16w/(9√3 z₀)
    let (work, range) = (2e-4, 1e-2);
    let law = LennardJones::new(work, range).unwrap();
    let steps = follow(&mut flats(law), [0.02, -0.05].map(Control::MeanPressure), 1e-6);
    let events: Vec<_> = steps.iter().filter_map(|step| step.event).collect();
    let [Event::LimitPoint { mean_gap, mean_pressure }] = events[..] else { panic!("{events:?}") };
    let strongest = 16.0 * work / (9.0 * 3.0_f64.sqrt() * range);
    assert!((mean_pressure / -strongest - 1.0).abs() < 2e-3, "{mean_pressure} {strongest}");
    assert!((mean_gap / (3.0_f64.powf(1.0 / 6.0) * range) - 1.0).abs() < 0.05, "{mean_gap}");
    // past it every state is on the law, and the surfaces come apart without a jump
    for step in &steps {
        let report = &step.solution.report;
        // to the tolerance of the load
        assert!((report.mean_pressure + law.traction(report.mean_gap)).abs() < 1e-6 * strongest);
    }
    let last = &steps[steps.len() - 1];
    assert!(last.solution.report.mean_gap > 10.0 * range && last.dissipated == 0.0);
}

/// A wave with a side crest, its dense half-space, and Lennard-Jones, which makes it jump.
fn waves() -> (Surface, Dense, LennardJones) {
    let (shape, lengths) = ((32, 4), (1.0, 0.125));
    let grid = Grid::new(shape, lengths).unwrap();
    let surface = Surface::from_fn(grid, |x, _| 0.03 * (TAU * x).cos() + 0.01 * (2.0 * TAU * x).sin()).unwrap();
    (surface, Dense::new(shape, lengths, 1.0), LennardJones::new(1e-3, 0.012).unwrap())
}

/// How many eigenvalues of K⁻¹ + φ'' over fields without mean are below a number.
fn below(dense: &Dense, law: &LennardJones, gap: &Array2<f64>, number: f64) -> usize {
    let slopes: Vec<f64> = gap.iter().map(|&g| law.slope(g)).collect();
    dense.below(&dense.faces, Held::Shift(0.0), &slopes, number)
}

#[test]
fn states_between_jumps_are_minima_of_the_dense_energy_and_jumps_are_where_they_cease() {
    let (surface, dense, law) = waves();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(*surface.grid(), 1.0).unwrap(), law).unwrap();
    let steps = follow(&mut problem, [0.12, 0.02, 0.12].map(Control::MeanGap), 1e-8);
    let mut last: Option<&PathStep<f64>> = None;
    let (mut jumps, first) = (0, &steps[0].solution.report);
    let largest = steps.iter().map(|step| step.work.abs()).fold(0.0, f64::max);
    for step in &steps {
        let Solution { gap, report, .. } = &step.solution;
        assert!(report.min_gap > 0.0);
        let u: Vec<f64> = gap.iter().zip(surface.heights()).map(|(g, h)| g + h).collect();
        let r: Vec<f64> = dense.pressure(&u).iter().zip(gap).map(|(p, &g)| p + law.traction(g)).collect();
        let mean = r.iter().sum::<f64>() / r.len() as f64;
        assert!(r.iter().all(|r| (r - mean).abs() < 1e-5), "{:?}", step.solution.report.control);
        assert!((mean + report.mean_pressure).abs() < 1e-6);
        assert_eq!(below(&dense, &law, gap, -1e-6), 0, "{:?}", step.solution.report.control);
        if let (Some(jump), Some(before)) = (jump(step), last) {
            assert!(jump.energy_drop > 0.0);
            // the softest eigenvalue has come down to a small share of the softest stiffness
            assert!(below(&dense, &law, &before.solution.gap, 0.1 * dense.softest) >= 1, "{jump:?}");
            jumps += 1;
        }
        let energy = |report: &Report| report.elastic_energy + report.adhesive_energy;
        let change = energy(report) - energy(first);
        assert!((step.work - step.dissipated + step.imbalance - change).abs() < 1e-9 * largest);
        last = Some(step);
    }
    assert!(jumps >= 2, "{jumps}");

    // interrupted and continued, it is the same path
    let mut solver = without_wall(1e-8);
    let mut path = Path::new([0.12, 0.02, 0.12].map(Control::MeanGap), PathSettings::default()).unwrap();
    for step in &steps[..20] {
        assert_eq!(path.next(&mut solver, &mut problem).unwrap().as_ref(), Some(step));
    }
    let next = path.read_again().next(&mut without_wall(1e-8), &mut problem).unwrap();
    assert_eq!(next.as_ref(), Some(&steps[20]));
}

#[test]
fn a_pressure_presses_surfaces_together_past_the_limit_point() {
    // the contact closes at once, and from there on any pressure is borne; a leg ends within a thousandth of itself
    let grid = Grid::line(64, 1.0).unwrap();
    let surface = Surface::wave(grid, 0.02, 1).unwrap();
    let work = 0.5 * (0.2 * std::f64::consts::PI * 0.02_f64).powi(2);
    let laws: [Box<dyn AdhesionLaw<f64>>; 2] =
        [Box::new(Morse::new(work, 1e-3).unwrap()), Box::new(LennardJones::new(work, 3e-3).unwrap())];
    for law in laws {
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
        let steps = follow(&mut problem, [6e-3, 0.12].map(Control::MeanPressure), 1e-8);
        assert_eq!(steps.iter().find_map(|step| step.event).unwrap().name(), "limit-point");
        let last = &steps[steps.len() - 1].solution.report;
        assert!((last.mean_pressure - 0.12).abs() < 2e-4 && last.contact_fraction > 0.9, "{last:?}");
    }
}

#[test]
fn a_saddle_is_left_for_a_minimum_of_lower_energy() {
    // flats at a uniform gap where φ'' is below −πE*/L
    let law = LennardJones::new(1e-3, 1e-2).unwrap();
    let mut problem = flats(law);
    let (mut solver, control) = (without_wall(1e-8), Control::MeanGap(0.014));
    let even = solver.solve(&mut problem, control).unwrap();
    let test = StabilityTest::default();
    let saddle = test.run_with(&mut problem, &NoWall, &even).unwrap();
    assert_eq!(saddle.verdict, Verdict::Unstable);
    let left = saddle.leave(&mut solver, &mut problem, &even, |_| ControlFlow::Continue(())).unwrap().unwrap();
    let gap = &left.solution.gap;
    assert!(left.energy_drop > 0.0 && left.solution.report.min_gap > 0.0);
    assert_eq!(test.run_with(&mut problem, &NoWall, &left.solution).unwrap().verdict, Verdict::Stable);
    let dense = Dense::new((8, 8), (1.0, 1.0), 1.0);
    let energy = |gap: &Array2<f64>| {
        let g: Vec<f64> = gap.iter().copied().collect();
        let elastic = 0.5 * dense.pressure(&g).iter().zip(&g).map(|(p, g)| p * g).sum::<f64>();
        (elastic + g.iter().map(|&g| law.energy(g)).sum::<f64>()) / g.len() as f64
    };
    let drop = energy(&even.gap) - energy(gap);
    assert!((left.energy_drop / drop - 1.0).abs() < 1e-9, "{} {drop}", left.energy_drop);
    assert_eq!(below(&dense, &law, gap, 0.0), 0);
}

#[test]
fn springs_and_laws_that_do_not_repel_are_refused_on_a_path() {
    let grid = Grid::line(16, 1.0).unwrap();
    let surface = Surface::wave(grid, 0.02, 1).unwrap();
    let half_space = Westergaard::<f64>::new(grid, 1.0).unwrap();
    let problem = Problem::new(&surface, half_space, Exponential::new(1e-4, 1e-2).unwrap()).unwrap();
    let path = Path::new([0.05, 0.02].map(Control::MeanGap), PathSettings::default()).unwrap();
    let springs = Solver { settings: Settings::default(), constraint: Penalty::new(10.0).unwrap() };
    let refused = path.check(&springs, &problem);
    assert!(matches!(refused, Err(Error::Unsuited { what: "springs", .. })), "{refused:?}");
    let refused = path.check(&without_wall(1e-6), &problem);
    assert!(matches!(refused, Err(Error::Unsuited { what: "no wall", .. })), "{refused:?}");
}

/// The pull-off force of a sphere with Lennard-Jones on a free half-space, over πwR.
fn pull_off(tabor: f64, n: usize) -> f64 {
    // R = E* = 1, and lengths of contact of 0.02; at the window's edge the gap is 25 z₀
    let (work, depth) = (8e-6, 4e-4);
    let rest = depth / tabor;
    let grid = Grid::square(n, 2.0 * (50.0 * rest).sqrt()).unwrap();
    let surface = Surface::paraboloid(grid, 1.0).unwrap();
    let law = LennardJones::new(work, rest).unwrap();
    let mut problem = Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    assert!(problem.mu_rho() < 0.5);
    let loads = [0.5 * depth - rest, -2.0 * depth - rest].map(Control::Approach);
    let settings = PathSettings::default().smallest_step(1e-2);
    let mut solver = without_wall(1e-5);
    let mut strongest = 0.0_f64;
    let mut path = Path::new(loads, settings).unwrap();
    while let Some(step) = path.next(&mut solver, &mut problem).unwrap() {
        let report = step.solution.report;
        assert_eq!(report.status, Status::Converged);
        let tension = -report.normal_force / (std::f64::consts::PI * work);
        if tension < 0.95 * strongest {
            break;
        }
        strongest = strongest.max(tension);
    }
    strongest
}

#[test]
fn a_sphere_pulls_off_between_dmt_and_jkr_and_above_maugis_and_dugdale() {
    use asperity::exact::{MaugisDugdale, Sphere};
    // as the example adhesion_map finds it on 256² nodes
    for (tabor, n, expected) in [(0.2, 32, 1.9174), (0.6, 48, 1.7528)] {
        let force = pull_off(tabor, n);
        assert!((force / expected - 1.0).abs() < 5e-3, "{tabor}: {force}");
        // of the same largest traction
        let dugdale = MaugisDugdale::new(1.0, 1.0, 8e-6, 4e-4 / tabor / 1.0264).unwrap();
        let theirs = -dugdale.pull_off().load() / (std::f64::consts::PI * 8e-6);
        assert!(theirs < force && force < 1.06 * theirs && force < 2.0, "{tabor}: {force} {theirs}");
    }
}

#[test]
fn a_mean_gap_below_the_separation_of_the_law_is_held_on_either_branch() {
    let law = LennardJones::new(1e-5, 4e-3).unwrap();
    let wave = Surface::wave_2d(Grid::square(16, 1.0).unwrap(), 1e-3, 1).unwrap();
    let mut wavy = Problem::new(&wave, Westergaard::new(*wave.grid(), 1.0).unwrap(), law).unwrap();
    for problem in [&mut flats(law), &mut wavy] {
        for (branch, held) in [Branch::Loading, Branch::Unloading].into_iter().flat_map(|b| [(b, 0.002), (b, 0.0041)]) {
            let mut solver = Solver { settings: Settings::default().branch(branch), constraint: NoWall };
            let report = solver.solve(problem, Control::MeanGap(held)).unwrap().report;
            assert_eq!((report.status, report.load_error), (Status::Converged, 0.0), "{branch} {held}");
            assert!((report.mean_gap / held - 1.0).abs() < 1e-13, "{branch} {held}: {}", report.mean_gap);
        }
    }
}

/// The largest tension that surfaces hold from contact on, at mean gaps or at approaches one after the other.
fn most_tension(problem: &mut Problem<f64>, loads: &[Control]) -> f64 {
    let mut solver = without_wall(1e-5);
    let steps = swept(&mut Sweep::default(), &mut solver, problem, loads);
    steps.iter().map(|step| -step.report.mean_pressure).fold(0.0, f64::max)
}

#[test]
fn a_tension_is_held_without_a_wall_as_it_is_beside_one() {
    let line = Surface::wave(Grid::line(64, 1.0).unwrap(), 0.02, 1).unwrap();
    let rough = SelfAffine::default().k_s(8.0);
    let rough = rough.surface(Grid::square(32, 1.0).unwrap()).unwrap();
    let sphere = Surface::paraboloid(Grid::square(32, 0.4).unwrap(), 2.0).unwrap();
    let (lennard_jones, morse) = (LennardJones::new(1e-4, 4e-3).unwrap(), Morse::new(1e-4, 2e-3).unwrap());
    let laws: [(Arc<dyn AdhesionLaw<f64>>, f64); 2] = [(Arc::new(lennard_jones), 4e-3), (Arc::new(morse), 0.0)];
    let (mut held, mut lost) = (0, Vec::new());
    for (surface, free) in [(&line, false), (&rough, false), (&sphere, false), (&sphere, true)] {
        for (law, rest) in laws.clone() {
            let grid = *surface.grid();
            let peak = surface.heights().fold(f64::NEG_INFINITY, |high, &h| high.max(h)) - surface.mean();
            let steps = (0..40).map(|k| 0.05 * f64::from(k));
            let (mut problem, loads): (_, Vec<_>) = if free {
                let approach = |step| Control::Approach(0.1 * peak - rest - 0.2 * peak * step);
                let half_space = Boussinesq::<f64>::new(grid, 1.0).unwrap();
                (Problem::new(surface, half_space, law).unwrap(), steps.map(approach).collect())
            } else {
                let gap = |step| Control::MeanGap(rest + 0.8 * peak * (0.5 + step));
                let half_space = Westergaard::<f64>::new(grid, 1.0).unwrap();
                (Problem::new(surface, half_space, law).unwrap(), steps.map(gap).collect())
            };
            let most = most_tension(&mut problem, &loads);
            assert!(most > 0.0);
            for share in [0.01, 0.1, 0.3, 0.6, 0.9, 0.95] {
                let control = Control::MeanPressure(-share * most);
                let report = without_wall(1e-6).solve(&mut problem, control).unwrap().report;
                let name = format!("{share} of {most:e} on {:?}, free {free}, rest {rest}", grid.shape());
                if report.status == Status::Detached {
                    lost.push(name);
                    continue;
                }
                assert_eq!(report.status, Status::Converged, "{name}: {report:?}");
                assert!(report.min_gap < rest + 2e-3 && report.load_error <= 1e-6, "{name}: {report:?}");
                held += 1;
            }
        }
    }
    // next to the pull-off a hold may lie between the mean gaps that are tried
    assert!(held >= 46 && lost.iter().all(|name| name.starts_with("0.95")), "{held}: {lost:#?}");
}

#[test]
fn the_error_without_a_wall_is_that_of_waves_and_of_nodes_that_the_law_holds() {
    let (surface, _, law) = waves();
    let grid = *surface.grid();
    let mut body = Westergaard::<f64>::new(grid, 1.0).unwrap();
    for control in [Control::MeanGap(0.02), Control::MeanPressure(0.02)] {
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
        let Solution { gap, pressure, report, .. } = without_wall(1e-3).solve(&mut problem, control).unwrap();
        assert_eq!(report.status, Status::Converged);
        let nodes = gap.len() as f64;
        let stiffest = 0.4 * body.stiffness_range().1;
        let kappa = gap.mapv(|g| law.slope(g).max(0.0));
        let share = kappa.mapv(|kappa| (1.0 + kappa / stiffest).powi(-2));
        let mut residual = &pressure + &gap.mapv(|g| law.traction(g));
        if let Control::MeanGap(_) = control {
            let weights = &share * &share;
            residual -= (&weights * &residual).sum() / weights.sum();
        }
        let waves = &share * &residual;
        let mut response = Array2::zeros(gap.dim());
        body.displacement(waves.view(), response.view_mut()).unwrap();
        let beside = residual.iter().zip(&share).zip(&kappa).filter(|(_, kappa)| **kappa > 0.0);
        let beside: f64 = beside.map(|((r, s), kappa)| ((1.0 - s) * r).powi(2) / kappa).sum();
        let bound = ((&waves * &response).sum() / nodes).sqrt() + (beside / nodes).sqrt();
        let error = bound / (2.0 * report.elastic_energy).sqrt();
        assert!((report.relative_error / error - 1.0).abs() < 1e-5, "{} {error}", report.relative_error);
        assert!(beside > 0.0 && report.relative_error > 1e-8);
    }
}
