//! A cap on the contact pressure: its limits, exact solutions, a dense solution, and what remains after unloading.
//!
//! `cargo test --release --test library hardness::a_dense -- --nocapture` prints what the random scenes take; `CASES`
//! says on how many.

use std::f64::consts::PI;
use std::ops::ControlFlow::{Break, Continue};

use approx::assert_relative_eq;
use asperity::path::{Path, PathSettings};
use asperity::solver::Iteration;
use asperity::*;
use asperity_maps::surface_with_absent;
use ndarray::{Array2, Zip};
use oracles::dense::Dense;
use oracles::rough::rough as rough_surface;
use oracles::{Kept, followed, rough, sphere, swept};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

fn capped(hardness: f64, tolerance: f64) -> Solver<Hardness> {
    Solver { settings: Settings::default().tolerance(tolerance), constraint: Hardness::new(hardness).unwrap() }
}

fn greatest<T: Real>(solution: &Solution<T>) -> f64 {
    solution.contact_pressure.iter().fold(0.0, |most, p| most.max(p.widen()))
}

/// Solves with a rigid wall and with a hardness ten times the greatest pressure, and compares all bits.
fn has_the_bits_of_no_cap<T: Real>(problem: &mut Problem<T>, control: Control) {
    let rigid = Solver::default().solve(problem, control).unwrap();
    let constraint = Hardness::new(1e3 * greatest(&rigid)).unwrap();
    let hard = Solver { settings: Settings::default(), constraint }.solve(problem, control).unwrap();
    assert_eq!((&hard.gap, &hard.pressure), (&rigid.gap, &rigid.pressure), "{control:?}");
    assert_eq!(hard.contact_pressure, rigid.contact_pressure);
    let [a, b] = [&hard, &rigid].map(|solution| {
        let report = &solution.report;
        (report.iterations, report.operator_applications, report.relative_error.to_bits(), report.contact_nodes)
    });
    assert_eq!(a, b);
    let plastic = hard.report.plastic.unwrap();
    assert_eq!((plastic.fraction, plastic.depth_max, plastic.energy), (0.0, 0.0, 0.0));
    assert!(hard.plastic_depth.unwrap().iter().all(|depth| *depth == T::zero()));
}

#[test]
fn a_hardness_above_all_pressures_has_the_bits_of_none() {
    for control in [Control::MeanPressure(2e-4), Control::MeanGap(0.0398)] {
        has_the_bits_of_no_cap(&mut sphere::<f64>(64, NoAdhesion), control);
        has_the_bits_of_no_cap(&mut sphere::<f32>(64, NoAdhesion), control);
    }
    for control in [Control::MeanPressure(0.02), Control::MeanGap(0.03)] {
        has_the_bits_of_no_cap(&mut rough::<f64>(96, 8, NoAdhesion), control);
        has_the_bits_of_no_cap(&mut rough::<f64>(96, 8, Exponential::new(1e-5, 1e-2).unwrap()), control);
        has_the_bits_of_no_cap(&mut rough::<f32>(96, 8, MaugisDugdale::new(1e-5, 1e-2).unwrap()), control);
    }
    let grid = Grid::square(48, 1.0).unwrap();
    let surface = Surface::paraboloid(grid, 2.0).unwrap();
    let mut free = Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    for control in [Control::Force(5e-4), Control::Approach(0.003)] {
        has_the_bits_of_no_cap(&mut free, control);
    }
}

#[test]
fn pressures_are_at_most_the_hardness_and_depths_only_where_it_is_reached() {
    for (share, control) in [0.5, 0.2].into_iter().zip([Control::MeanPressure(0.02), Control::MeanGap(0.04)]) {
        let mut problem = rough::<f64>(96, 8, NoAdhesion);
        let rigid = Solver::default().solve(&mut problem, control).unwrap();
        let hardness = share * greatest(&rigid);
        let solution = capped(hardness, 1e-7).solve(&mut problem, control).unwrap();
        let (report, depth) = (&solution.report, solution.plastic_depth.as_ref().unwrap());
        assert_eq!(report.status, Status::Converged);
        let plastic = report.plastic.unwrap();
        for ((&p, &gap), &depth) in solution.contact_pressure.iter().zip(&solution.gap).zip(depth) {
            assert!((0.0..=hardness).contains(&p) && gap >= 0.0 && depth >= 0.0);
            assert!(depth == 0.0 || (p == hardness && gap == 0.0));
            assert!(p == 0.0 || gap == 0.0);
        }
        let yielded = depth.iter().filter(|&&depth| depth > 0.0).count() as f64;
        assert!(yielded > 0.0 && plastic.fraction == yielded / depth.len() as f64);
        assert_relative_eq!(plastic.depth_mean, depth.mean().unwrap(), max_relative = 1e-12);
        assert_relative_eq!(plastic.energy, hardness * plastic.depth_mean, max_relative = 1e-12);
        assert_relative_eq!(report.mean_gap, solution.gap.mean().unwrap(), max_relative = 1e-12);
        // a mean gap that is given is to the surface as it was made
        if let Control::MeanGap(gap) = control {
            assert_relative_eq!(report.mean_gap - plastic.depth_mean, gap, max_relative = 1e-12);
        }
    }
}

/// The contact of random heights with a dense body at a mean pressure, by the pressure: the least ½⟨λ, Kλ⟩ − ⟨λ, h⟩
/// with 0 ≤ λ ≤ H and its mean, by active sets. Returns pressure, and gap to the surface as it was.
fn dense_capped(body: &Dense, heights: &[f64], caps: &[f64], mean: f64) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = heights.len();
    let most = caps.iter().sum::<f64>() / n as f64;
    let mut pressure: Vec<f64> = caps.iter().map(|cap| cap * mean / most).collect();
    let gap = |pressure: &[f64], level: f64| -> Vec<f64> {
        body.displacement(pressure).iter().zip(heights).map(|(u, h)| u + level - h).collect()
    };
    let size = heights.iter().fold(0.0_f64, |most, h| most.max(h.abs()));
    // Karush, Kuhn and Tucker, by a projected coordinate descent over pairs, then elimination on what is found free
    for round in 0..400 {
        let free: Vec<usize> = match round {
            0 => (0..n).collect(),
            _ => (0..n).filter(|&i| pressure[i] > 0.0 && pressure[i] < caps[i]).collect(),
        };
        // K λ + level = h on the free nodes, with the given mean
        let m = free.len();
        let held: Vec<f64> = (0..n).map(|i| if free.contains(&i) { 0.0 } else { pressure[i] }).collect();
        let of_held = body.displacement(&held);
        let mut rows: Vec<Vec<f64>> =
            free.iter().map(|&i| free.iter().map(|&j| body.compliance[i * n + j]).chain([1.0]).collect()).collect();
        rows.push(vec![1.0; m].into_iter().chain([0.0]).collect());
        let mut right: Vec<f64> = free.iter().map(|&i| heights[i] - of_held[i]).collect();
        right.push(mean * n as f64 - held.iter().sum::<f64>());
        if m == 0 {
            return None;
        }
        let found = oracles::dense::eliminate(rows, right)?;
        let (wanted, level) = (&found[..m], found[m]);
        // as far as the bounds allow
        let mut step = 1.0_f64;
        for (&i, &to) in free.iter().zip(wanted) {
            let change = to - pressure[i];
            if to < 0.0 {
                step = step.min(pressure[i] / -change);
            } else if to > caps[i] {
                step = step.min((caps[i] - pressure[i]) / change);
            }
        }
        for (&i, &to) in free.iter().zip(wanted) {
            let next = pressure[i] + step * (to - pressure[i]);
            let at_bound = step < 1.0
                && ((to < 0.0 && next <= 1e-14 * caps[i]) || (to > caps[i] && next >= caps[i] * (1.0 - 1e-14)));
            pressure[i] = if at_bound { if to < 0.0 { 0.0 } else { caps[i] } } else { next };
        }
        if step < 1.0 {
            continue;
        }
        let gaps = gap(&pressure, level);
        let wrong = |i: usize| match pressure[i] {
            p if p <= 0.0 => -gaps[i],
            p if p >= caps[i] => gaps[i],
            _ => 0.0,
        };
        let worst = (0..n).max_by(|&a, &b| wrong(a).total_cmp(&wrong(b)))?;
        if wrong(worst) <= 1e-11 * size {
            return Some((pressure, gaps));
        }
        // one node leaves its bound
        pressure[worst] = if pressure[worst] <= 0.0 { 1e-13 * caps[worst] } else { caps[worst] * (1.0 - 1e-13) };
    }
    None
}

#[test]
fn a_dense_solution_is_met_on_random_scenes() {
    let cases = std::env::var("CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(1000);
    let (mut compared, mut applications, mut rigid_applications) = (0, 0, 0);
    let (mut worst, mut sharpest) = (0.0_f64, 0.0_f64);
    for seed in 0..cases {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let shape = (random.random_range(3..9), random.random_range(1..9));
        let lengths = (random.random_range(0.5..2.0), random.random_range(0.5..2.0));
        let grid = Grid::new(shape, lengths).unwrap();
        let size = 10f64.powi(random.random_range(-4..3));
        let heights = Array2::from_shape_simple_fn(shape, || size * random.random_range(-1.0..1.0));
        let modulus = 10f64.powi(random.random_range(-3..4));
        let surface = Surface::new(grid, heights.clone()).unwrap();
        let scale = modulus * size;
        let varies = random.random_bool(0.3);
        let hardness = scale * 10f64.powf(random.random_range(-2.0..1.5));
        let caps =
            Array2::from_shape_simple_fn(shape, || hardness * if varies { random.random_range(0.5..2.0) } else { 1.0 });
        let mean = caps.mean().unwrap() * 10f64.powf(random.random_range(-3.0..-0.01));
        let body = Dense::new(shape, lengths, modulus);
        let flat = |field: &Array2<f64>| field.iter().copied().collect::<Vec<_>>();
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, modulus).unwrap(), NoAdhesion).unwrap();
        let constraint = if varies { Hardness::varying(caps.clone()) } else { Hardness::new(hardness) }.unwrap();
        let mut solver = Solver { settings: Settings::default().tolerance(1e-8), constraint };
        let solution = solver.solve(&mut problem, Control::MeanPressure(mean)).unwrap();
        let report = &solution.report;
        assert!(matches!(report.status, Status::Converged | Status::Stalled), "{seed}: {:?}", report.status);
        applications += report.operator_applications;
        if let Ok(rigid) =
            Solver::new(Settings::default().tolerance(1e-8)).solve(&mut problem, Control::MeanPressure(mean))
        {
            rigid_applications += rigid.report.operator_applications;
        }
        assert!(report.status != Status::Converged || report.load_error <= 1e-8, "{seed}: {:e}", report.load_error);
        // the load that the state bears: a gap may change by much more than its load where most nodes yield
        let borne = solution.contact_pressure.mean().unwrap();
        let found = dense_capped(&body, &flat(&heights), &flat(&caps), borne);
        let Some((pressure, gap)) = found else { continue };
        compared += 1;
        // the certified distance in the norm of the elastic energy, next to the true one
        let depth = solution.plastic_depth.as_ref().unwrap();
        let difference: Vec<f64> =
            solution.gap.iter().zip(depth).zip(&gap).map(|((gap, depth), exact)| gap - depth - exact).collect();
        let u: Vec<f64> = gap.iter().zip(&heights).map(|(g, h)| g + h).collect();
        let error = (body.work(&difference) / body.work(&u)).sqrt();
        let claimed = report.relative_error;
        assert!(error <= 1.5 * claimed + 1e-9, "{seed}: {error:e} for {claimed:e}, {:?}", report.status);
        worst = worst.max(error);
        if error > 1e-12 {
            sharpest = sharpest.max(error / claimed);
        }
        let most = caps.iter().fold(0.0_f64, |a, &b| a.max(b));
        Zip::from(&solution.contact_pressure).and(&caps).for_each(|&p, &cap| assert!((0.0..=cap).contains(&p)));
        let off = solution.contact_pressure.iter().zip(&pressure).fold(0.0_f64, |a, (p, q)| a.max((p - q).abs()));
        assert!(off <= 1e-3 * most, "{seed}: pressures differ by {off:e} of {most:e}");
    }
    println!(
        "{compared} of {cases} compared; worst {worst:.1e}, at most {sharpest:.2} of the claim; {applications} applications, {rigid_applications} without a cap"
    );
    assert!(compared as f64 > 0.9 * cases as f64, "{compared}");
}

#[test]
fn a_sphere_first_yields_where_hertz_says_and_its_depth_grows() {
    // p₀ = H at P = π³R²H³/6E*²
    let (n, radius, length): (usize, f64, f64) = (256, 1.0, 0.2);
    let grid = Grid::square(n, length).unwrap();
    let surface = Surface::paraboloid(grid, radius).unwrap();
    let hardness: f64 = 0.03;
    let first = PI.powi(3) * radius * radius * hardness.powi(3) / 6.0;
    let mut problem = Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let mut yields = |share: f64| {
        let solution = capped(hardness, 1e-8).solve(&mut problem, Control::Force(share * first)).unwrap();
        assert_eq!(solution.report.status, Status::Converged);
        solution.report.plastic.unwrap()
    };
    // the pressure at the first node to yield is within 1 % of Hertz' at 48 nodes across the contact
    assert_eq!(yields(0.97).fraction, 0.0);
    let [a, b, c] = [1.03, 1.5, 3.0].map(&mut yields);
    assert!(a.fraction > 0.0 && a.fraction < b.fraction && b.fraction < c.fraction);
    assert!(a.depth_max < b.depth_max && b.depth_max < c.depth_max);
}

#[test]
fn a_soft_surface_carries_its_hardness_everywhere() {
    // H → 0: each node in contact has yielded, A/A₀ = p̄/H
    let mut problem = rough::<f64>(64, 8, NoAdhesion);
    for (hardness, share) in [(1e-4, 0.3), (1e-5, 0.1)] {
        let solution = capped(hardness, 1e-7).solve(&mut problem, Control::MeanPressure(share * hardness)).unwrap();
        assert_eq!(solution.report.status, Status::Converged);
        // but for contact nodes at the edge that have not, of a share about H/E* of the slopes
        let area = solution.report.contact_fraction;
        assert!(area >= share * (1.0 - 1e-6) && area - share < 5e-3, "{area}");
    }
}

#[test]
fn loads_close_to_the_hardness_close_the_contact_and_one_beyond_it_is_refused() {
    let mut problem = rough::<f64>(64, 8, NoAdhesion);
    for hardness in [0.02, 0.5] {
        let mut last = 0.0;
        for share in [0.9, 0.99, 0.999] {
            let control = Control::MeanPressure(share * hardness);
            let report = capped(hardness, 1e-6).solve(&mut problem, control).unwrap().report;
            assert_eq!(report.status, Status::Converged, "{share} of {hardness}");
            assert!(report.contact_fraction >= share && report.contact_fraction >= last);
            last = report.contact_fraction;
        }
        assert!(last > 0.999);
        for share in [1.0, 2.0] {
            let refused = capped(hardness, 1e-6).solve(&mut problem, Control::MeanPressure(share * hardness));
            assert!(matches!(refused, Err(Error::Value { name: "mean pressure", .. })));
        }
    }
}

#[test]
fn reloading_repeats_the_state_and_dissipates_nothing_more() {
    let mut problem = rough::<f64>(64, 8, NoAdhesion);
    let hardness = 0.2;
    let mut solver = capped(hardness, 1e-9);
    let loads = [0.02, 0.01, 0.004, 0.01, 0.02, 0.03].map(Control::MeanPressure);
    let states = swept(&mut Sweep::default(), &mut solver, &mut problem, &loads);
    let energy = |k: usize| states[k].report.plastic.unwrap().energy;
    assert!(energy(0) > 0.0);
    for k in 1..5 {
        assert_relative_eq!(energy(k), energy(0), max_relative = 1e-6);
    }
    assert!(energy(5) > 1.2 * energy(0));
    // the same state at the same load, and another one on the way up than without yielding
    let error = states[4].distance(&states[0]);
    assert!(error < 1e-7, "{error:e}");
    assert!(states[4].report.contact_nodes.abs_diff(states[0].report.contact_nodes) <= 1);
    // elastic unloading on the flattened surface leaves more contact than loading did
    let virgin =
        capped(hardness, 1e-9).solve(&mut rough::<f64>(64, 8, NoAdhesion), Control::MeanPressure(0.01)).unwrap();
    assert!(states[1].report.contact_fraction > 1.05 * virgin.report.contact_fraction);
    let reverse = states[3].distance(&states[1]);
    assert!(reverse < 1e-7, "{reverse:e}");
}

#[test]
fn the_energy_of_a_cycle_is_balanced_with_the_plastic_work() {
    let mut problem = rough::<f64>(48, 6, NoAdhesion);
    let mut solver = capped(0.2, 1e-9);
    let legs = [1e-4, 0.03, 1e-4, 0.03, 1e-4].map(Control::MeanPressure);
    let settings = PathSettings::default().steps(20);
    let steps = followed(Path::new(legs, settings).unwrap(), &mut solver, &mut problem);
    // the same cycle has the same bits
    let again =
        followed(Path::new(legs, settings).unwrap(), &mut capped(0.2, 1e-9), &mut rough::<f64>(48, 6, NoAdhesion));
    assert_eq!(steps.len(), again.len());
    for (one, other) in steps.iter().zip(&again) {
        let bits = [one, other].map(|step| [step.work, step.imbalance].map(f64::to_bits));
        assert!(bits[0] == bits[1] && one.solution.gap == other.solution.gap);
    }
    let ends: Vec<_> = (1..5).map(|leg| steps.iter().rfind(|step| step.leg == leg).unwrap()).collect();
    let plastic = |k: usize| ends[k].solution.report.plastic.unwrap().energy;
    assert!(plastic(0) > 0.0);
    // nothing yields after the first loading
    for k in 1..4 {
        assert_relative_eq!(plastic(k), plastic(0), max_relative = 1e-5);
    }
    assert!(steps.iter().all(|step| step.event.is_none()));
    // the work of a cycle is what yielding has dissipated, to the balance of its steps
    let range = ends[0].solution.report.elastic_energy + plastic(0);
    assert_relative_eq!(ends[1].work, plastic(0), epsilon = 3e-3 * range);
    assert!((ends[3].work - ends[1].work).abs() < 3e-3 * range, "{:e} {:e}", ends[3].work, ends[1].work);
    assert!(steps.iter().all(|step| step.imbalance.abs() < 3e-3 * range));
}

/// Adhesion that differs from node to node, with its tractions at contact, and a hardness that does.
fn both_vary(n: usize) -> (Problem<f64>, Array2<f64>, Array2<f64>) {
    let (grid, rho) = (Grid::square(n, 1.0).unwrap(), 2e-3);
    let works = Array2::from_shape_fn((n, n), |(i, j)| 2e-5 * (1 + (i + 3 * j) % 4) as f64 / 4.0);
    let caps = Array2::from_shape_fn((n, n), |(i, j)| 0.08 + 0.01 * ((2 * i + j) % 5) as f64);
    let law = adhesion::Varying::new(Exponential::new(2e-5, rho).unwrap(), works.view()).unwrap();
    let surface = SelfAffine::default().k_s(n as f64 / 4.0).amplitude(Amplitude::RmsSlope(0.2)).surface(grid).unwrap();
    let problem = Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap();
    (problem, works / rho, caps)
}

#[test]
fn yielding_dissipates_the_hardness_less_the_traction_of_the_law() {
    let (mut problem, pulls, caps) = both_vary(32);
    let constraint = Hardness::varying(caps.clone()).unwrap();
    let mut solver = Solver { settings: Settings::default(), constraint };
    let loads = [0.02, 0.03, 0.01].map(Control::MeanPressure);
    for solution in swept(&mut Sweep::default(), &mut solver, &mut problem, &loads) {
        let (plastic, depth) = (solution.report.plastic.unwrap(), solution.plastic_depth.unwrap());
        assert!(plastic.fraction > 0.0);
        assert_relative_eq!(plastic.energy, ((&caps - &pulls) * depth).mean().unwrap(), max_relative = 1e-12);
        // φ = −tρ exp(−g/ρ) at the gap to the surface as it is now
        let adhesive = -2e-3 * (&pulls * solution.gap.mapv(|gap| (-gap / 2e-3).exp())).mean().unwrap();
        assert_relative_eq!(solution.report.adhesive_energy, adhesive, max_relative = 1e-12);
    }
}

#[test]
fn the_energy_of_a_cycle_with_adhesion_is_balanced_without_jumps() {
    let (mut problem, pulls, caps) = both_vary(32);
    let legs = [1e-3, 0.03, 1e-3].map(Control::MeanPressure);
    let mut steps = |caps| {
        let mut solver = Solver { settings: Settings::default().tolerance(1e-8), constraint: caps };
        problem.flatten(Array2::zeros((32, 32)).view()).unwrap();
        followed(Path::new(legs, PathSettings::default().steps(12)).unwrap(), &mut solver, &mut problem)
    };
    let elastic = steps(Hardness::new(1e3).unwrap());
    for caps in [Hardness::varying(caps).unwrap(), Hardness::new(0.1).unwrap()] {
        let yields = steps(caps);
        assert!(yields.iter().all(|step| step.event.is_none()));
        assert!(yields.len() < 2 * elastic.len(), "{} for {}", yields.len(), elastic.len());
        let last = yields.last().unwrap();
        let plastic = last.solution.report.plastic.unwrap();
        // what the balance missed
        assert!(pulls.mean().unwrap() * plastic.depth_mean > 0.05 * last.work);
        let range = yields.iter().fold(0.0_f64, |most, step| most.max(step.work));
        assert!(last.imbalance.abs() < 3e-3 * range, "{:e} of {range:e}", last.imbalance);
    }
}

#[test]
fn a_load_that_has_not_converged_leaves_no_depth() {
    let mut solver = capped(0.05, 1e-9);
    let [low, high] = [1e-3, 0.02].map(Control::MeanPressure);
    let mut problem = rough::<f64>(48, 6, NoAdhesion);
    let alone = swept(&mut Sweep::default(), &mut solver, &mut problem, &[low, low]);
    problem.flatten(Array2::zeros((48, 48)).view()).unwrap();
    let mut sweep = Sweep::default();
    let first = sweep.next(&mut solver, &mut problem, low).unwrap();
    let stopped = |state: &Iteration| if state.iteration < 8 { Continue(()) } else { Break(()) };
    let second = sweep.next_observed(&mut solver, &mut problem, high, stopped).unwrap();
    assert!(
        second.report.status == Status::Stopped
            && second.plastic_depth.unwrap() != *first.plastic_depth.as_ref().unwrap()
    );
    assert_eq!(problem.plastic_depth(), first.plastic_depth);
    let third = sweep.next(&mut solver, &mut problem, low).unwrap();
    assert!(third.distance(&alone[1]) < 1e-8);
    // a path takes a state that cannot be reached by shorter steps as it is
    problem.flatten(Array2::zeros((48, 48)).view()).unwrap();
    solver.settings = solver.settings.max_iterations(8);
    let mut path = Path::new([high], PathSettings::default()).unwrap();
    let begun = path.next(&mut solver, &mut problem).unwrap().unwrap();
    assert!(
        begun.solution.report.status == Status::IterationLimit && begun.solution.plastic_depth.unwrap().sum() > 0.0
    );
    assert_eq!(problem.plastic_depth().unwrap().sum(), 0.0);
}

#[test]
fn any_share_of_contact_is_found_at_any_hardness() {
    let grid = Grid::square(32, 1.0).unwrap();
    let surface = SelfAffine::default().k_s(8.0).amplitude(Amplitude::RmsSlope(0.2)).surface(grid).unwrap();
    fn finds(mut problem: Problem<f64>, constraint: Hardness) {
        for fraction in [0.03, 0.3, 0.7, 0.97] {
            let mut solver = Solver { settings: Settings::default(), constraint: constraint.clone() };
            let found = ContactSearch::default().at(&mut solver, &mut problem, fraction).unwrap();
            let report = &found.solution.report;
            assert!(found.reached, "{fraction} at {}: {report:?}", constraint.mean());
            // to a node or 1 %
            assert!((report.contact_fraction - fraction).abs() <= (0.01 * fraction).max(1.0 / 1024.0));
        }
    }
    for hardness in [1e-3, 0.02, 0.1, 1.0] {
        let varying = Array2::from_shape_fn((32, 32), |(i, j)| hardness * (1 + (3 * i + j) % 7) as f64);
        for constraint in [Hardness::new(hardness).unwrap(), Hardness::varying(varying).unwrap()] {
            finds(
                Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), NoAdhesion).unwrap(),
                constraint.clone(),
            );
            finds(Problem::new(&surface, Boussinesq::new(grid, 1.0).unwrap(), NoAdhesion).unwrap(), constraint);
        }
    }
}

#[test]
fn a_path_and_a_sweep_with_depth_go_on_bit_for_bit() {
    let loads = [1e-3, 0.03, 1e-3, 0.04].map(Control::MeanPressure);
    let solver = || capped(0.2, 1e-6);
    let grid = Grid::square(24, 1.0).unwrap();
    let (periodic, free) = (Westergaard::<f64>::new(grid, 1.0).unwrap(), Boussinesq::<f64>::new(grid, 1.0).unwrap());
    for is_free in [false, true] {
        let new = || {
            let body: Box<dyn ElasticOperator<f64>> =
                if is_free { Box::new(free.clone()) } else { Box::new(periodic.clone()) };
            Problem::new(&rough_surface(grid, 4, 1), body, NoAdhesion).unwrap()
        };
        let (mut one, mut problem) = (solver(), new());
        let mut path = Path::new(loads, PathSettings::default().steps(4)).unwrap();
        let whole = followed(path.clone(), &mut solver(), &mut new());
        for (k, expected) in whole.iter().enumerate() {
            if k % 3 == 2 {
                let rest = followed(path.read_again(), &mut solver(), &mut new());
                assert!(rest == whole[k..], "{k}");
            }
            assert_eq!(path.next(&mut one, &mut problem).unwrap().as_ref(), Some(expected));
        }
        assert!(whole.iter().any(|step| step.solution.report.plastic.unwrap().fraction > 0.0));

        let (mut sweep, mut problem) = (Sweep::default(), new());
        let whole = swept(&mut sweep.clone(), &mut solver(), &mut new(), &loads);
        for (k, &load) in loads.iter().enumerate() {
            assert!(swept(&mut sweep.read_again(), &mut solver(), &mut new(), &loads[k..]) == whole[k..], "{k}");
            sweep.next(&mut one, &mut problem, load).unwrap();
        }

        let (mut search, mut problem) = (ContactSearch::default(), new());
        for fraction in [0.05, 0.2, 0.4] {
            let again = search.read_again().at(&mut solver(), &mut new(), fraction).unwrap();
            let expected = search.at(&mut one, &mut problem, fraction).unwrap();
            assert!(again.solution == expected.solution && again.solves == expected.solves, "{fraction}");
        }
    }
}

#[test]
fn every_law_control_body_and_precision_works_with_it() {
    let law = Exponential::new(1e-5, 1e-2).unwrap();
    for control in [Control::MeanPressure(0.02), Control::MeanGap(0.04)] {
        let double = capped(0.3, 1e-6).solve(&mut rough::<f64>(64, 8, law), control).unwrap();
        let single = capped(0.3, 1e-4).solve(&mut rough::<f32>(64, 8, law), control).unwrap();
        assert_eq!((double.report.status, single.report.status), (Status::Converged, Status::Converged), "{control:?}");
        let [a, b] = [double.report.plastic.unwrap(), single.report.plastic.unwrap()];
        assert_relative_eq!(a.energy, b.energy, max_relative = 2e-2, epsilon = 1e-12);
        assert!(greatest(&double) <= 0.3);
    }
    // absent nodes, and a free boundary
    let grid = Grid::square(48, 1.0).unwrap();
    let sphere = Surface::paraboloid(grid, 2.0).unwrap();
    let mut heights = sphere.heights().clone();
    heights.iter_mut().step_by(7).for_each(|h| *h = f64::NAN);
    let holes = surface_with_absent(grid, heights).unwrap();
    let mut problem = Problem::new(&holes, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let periodic = capped(0.05, 1e-6).solve(&mut problem, Control::MeanPressure(5e-4)).unwrap();
    let mut problem = Problem::new(&holes, Boussinesq::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    for control in [Control::Force(5e-4), Control::Approach(4e-3), Control::Spring { stiffness: 0.5, rest: 6e-3 }] {
        let free = capped(0.05, 1e-6).solve(&mut problem, control).unwrap();
        for solution in [&periodic, &free] {
            assert_eq!(solution.report.status, Status::Converged, "{control:?}");
            assert!(solution.report.plastic.unwrap().fraction == 0.0 || greatest(solution) == 0.05);
            assert!(greatest(solution) <= 0.05);
            let depth = solution.plastic_depth.as_ref().unwrap();
            assert!(solution.gap.iter().zip(depth).all(|(gap, depth)| gap.is_finite() || *depth == 0.0));
        }
    }
}

#[test]
fn nested_grids_find_the_same() {
    let grid = Grid::square(256, 1.0).unwrap();
    let surface = SelfAffine::default().k_s(32.0).surface(grid).unwrap();
    let control = Control::MeanPressure(0.01);
    let half_space = |grid: Grid| Westergaard::<f64>::new(grid, 1.0);
    let mut problem = Problem::new(&surface, half_space(grid).unwrap(), NoAdhesion).unwrap();
    let rigid = Solver::default().solve(&mut problem, control).unwrap();
    let hardness = 0.3 * greatest(&rigid);
    let alone = capped(hardness, 1e-7).solve(&mut problem, control).unwrap();
    let mut solver = capped(hardness, 1e-7);
    let nested = Nested::default().solve(&mut solver, &surface, half_space, NoAdhesion, control).unwrap();
    assert_eq!((nested.levels.len(), nested.solution.report.status), (3, Status::Converged));
    let error = nested.solution.distance(&alone);
    assert!(error <= 3e-7, "{error:e}");
    assert!(nested.solution.report.operator_applications <= alone.report.operator_applications);
    // a hardness above all pressures is none
    let mut above = capped(2.0 * greatest(&rigid), 1e-6);
    let above = Nested::default().solve(&mut above, &surface, half_space, NoAdhesion, control).unwrap().solution;
    let rigid =
        Nested::default().solve(&mut Solver::default(), &surface, half_space, NoAdhesion, control).unwrap().solution;
    assert_eq!((&above.gap, &above.pressure), (&rigid.gap, &rigid.pressure));
}

#[test]
fn the_certificate_is_between_the_error_and_some_twice_of_it() {
    let mut problem = rough::<f64>(96, 8, NoAdhesion);
    let gaps = [0.02, 0.04].map(Control::MeanGap);
    for (hardness, control) in [0.2, 0.1, 0.05].into_iter().flat_map(|hardness| gaps.map(|gap| (hardness, gap))) {
        let exact = capped(hardness, 1e-11).solve(&mut problem, control).unwrap();
        for tolerance in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
            let solution = capped(hardness, tolerance).solve(&mut problem, control).unwrap();
            let times = solution.report.relative_error / solution.distance(&exact);
            println!("hardness {hardness}, {control:?}, tolerance {tolerance:e}: {times:.2}");
            assert!((1.0..2.5).contains(&times), "{hardness} {control:?} {tolerance:e}: {times}");
        }
    }
}

#[test]
fn nested_grids_help_where_all_but_a_little_yields() {
    let grid = Grid::square(256, 1.0).unwrap();
    let surface = SelfAffine::default().k_s(32.0).surface(grid).unwrap();
    let (half_space, control) = (|grid: Grid| Westergaard::<f64>::new(grid, 1.0), Control::MeanPressure(0.001));
    for hardness in [0.0012, 0.001001] {
        let mut solver = capped(hardness, 1e-6);
        let nested = Nested::default().solve(&mut solver, &surface, half_space, NoAdhesion, control).unwrap();
        assert_eq!((nested.levels.len(), nested.solution.report.status), (3, Status::Converged));
        let applications = nested.equivalent_applications();
        println!("hardness {hardness}: {applications:.1}");
        assert!(applications < 90.0, "{applications}");
    }
}

#[test]
fn nested_grids_take_a_hardness_that_varies_also_with_a_free_boundary() {
    let grid = Grid::square(128, 1.0).unwrap();
    let surface = Surface::paraboloid(grid, 2.0).unwrap();
    let field = Array2::from_shape_fn((128, 128), |(i, _)| if i < 64 { 0.03 } else { 0.06 });
    let constraint = Hardness::varying(field).unwrap();
    let mut solver = Solver { settings: Settings::default().tolerance(1e-7), constraint };
    let half_space = |grid: Grid| Boussinesq::<f64>::new(grid, 1.0);
    let control = Control::Force(4e-3);
    let mut problem = Problem::new(&surface, half_space(grid).unwrap(), NoAdhesion).unwrap();
    let alone = solver.solve(&mut problem, control).unwrap();
    assert!(alone.report.plastic.unwrap().fraction > 0.0);
    // the contact is on a small part of the window
    assert!(alone.report.contact_fraction < 0.25);
    let nested = Nested::default().coarsest(32);
    let found = nested.solve(&mut solver, &surface, half_space, NoAdhesion, control).unwrap();
    assert!(found.levels.len() > 1 && found.solution.report.status == Status::Converged);
    let error = found.solution.distance(&alone);
    assert!(error <= 3e-7, "{error:e}");
}

#[test]
fn a_depth_in_any_order_in_memory_lowers_the_surface_of_a_free_half_space() {
    let grid = Grid::new((24, 16), (1.5, 1.0)).unwrap();
    let surface = Surface::paraboloid(grid, 2.0).unwrap();
    let mut problem = Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let depth = grid.sample(|x, y| (0.01 - x * x - 2.0 * y * y).max(0.0));
    for depth in [depth.clone(), depth.t().as_standard_layout().into_owned().reversed_axes()] {
        problem.flatten(depth.view()).unwrap();
        assert_eq!(problem.plastic_depth().unwrap(), depth);
    }
}

#[test]
fn what_has_no_meaning_is_refused_by_name() {
    assert!(matches!(Hardness::new(0.0), Err(Error::Value { name: "hardness", .. })));
    assert!(matches!(Hardness::new(f64::NAN), Err(Error::Value { name: "hardness", .. })));
    assert!(matches!(Hardness::varying(Array2::zeros((0, 3))), Err(Error::Shape { name: "hardness", .. })));
    let mut field = Array2::from_elem((32, 32), 0.2);
    field[[3, 4]] = -1.0;
    assert!(matches!(Hardness::varying(field), Err(Error::Value { name: "hardness", value, .. }) if value == -1.0));
    let mut problem = sphere::<f64>(64, NoAdhesion);
    let control = Control::MeanPressure(1e-4);
    let constraint = Hardness::varying(Array2::from_elem((48, 48), 0.2)).unwrap();
    let other = Solver { settings: Settings::default(), constraint }.solve(&mut problem, control);
    assert!(matches!(other, Err(Error::Shape { name: "hardness", .. })));
    let paper = Solver { settings: Settings::rey2017(), constraint: Hardness::new(0.1).unwrap() };
    assert!(matches!({ paper }.solve(&mut problem, control), Err(Error::Unsuited { .. })));
    // attraction that crushes each contact
    let law = Exponential::new(1e-3, 1e-3).unwrap();
    let crushed = capped(0.5, 1e-6).solve(&mut sphere::<f64>(64, law), control);
    assert!(matches!(crushed, Err(Error::Value { name: "adhesive traction at contact", value, .. }) if value == 1.0));
    // an equilibrium that is not one of an energy
    let solution = capped(0.02, 1e-6).solve(&mut problem, Control::MeanPressure(3e-4)).unwrap();
    let stable = stability::StabilityTest::default().run_with(&mut problem, &Hardness::new(0.02).unwrap(), &solution);
    assert!(matches!(stable, Err(Error::Unsuited { .. })));
    assert!(matches!(problem.flatten(Array2::from_elem((64, 64), -1.0).view()), Err(Error::Value { .. })));
    assert!(matches!(problem.flatten(Array2::zeros((64, 63)).view()), Err(Error::Shape { .. })));
}
