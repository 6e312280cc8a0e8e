//! Contacts that yield next to dense matrices, and their certificates.

use super::*;

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
