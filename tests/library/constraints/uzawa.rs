//! Uzawa's method on random scenes with a hard wall.

use super::*;

#[test]
fn uzawa_ends_on_random_hard_walls() {
    let [mut touched, mut otherwise] = [0; 2];
    for seed in 0..400 {
        let scene = Scene::with_features(seed, &Features { precisions: &[Precision::Mixed], ..Features::HARD });
        // nothing tells how far a plane is to fall
        if scene.is_flat() {
            continue;
        }
        let (projected, solution, rounds) = both::<f64>(&scene, scene.stiffness);
        // under the lightest loads springs stall where projection does not
        let same = solution.report.status == projected.report.status;
        otherwise += usize::from(!same);
        assert!(same || solution.report.status == Status::Stalled, "{rounds} rounds in {scene}");
        if solution.report.status == Status::Converged && projected.report.contact_nodes > 0 {
            // an error of the tolerance in projection, in the last round, and for what interpenetrates after it
            let (mut operator, surface) = (scene.operator::<f64>(), scene.surface());
            let (difference, size, _) = energy_norms(&surface, &mut operator, &solution.gap, &projected.gap);
            let (distance, tolerance) = ((difference / size).sqrt(), scene.settings.tolerance_in::<f64>());
            assert!(distance <= 3.0 * tolerance, "{distance:e} to {tolerance:e} in {scene}");
            touched += 1;
        }
    }
    assert!(touched > 250 && otherwise <= 12, "{touched} touch, {otherwise} end otherwise");
}

#[test]
#[ignore = "a measurement; see above"]
fn uzawa_on_random_scenes() {
    let cases = std::env::var("CASES").map_or(2000, |cases| cases.parse().unwrap());
    let mut rows = std::collections::BTreeMap::<(bool, i32), Vec<(Status, Status, f64)>>::new();
    for seed in 0..cases {
        let scene = Scene::with_features(seed, &WALLED);
        // in units of the shortest wave's, or of E*/L
        let of_waves = seed % 2 == 0;
        let unit = if of_waves { 1.0 } else { scene.grid.spacing().0 / scene.grid.lengths().0 };
        let stiffness = unit * scene.stiffness;
        let (projected, found) = if scene.precision == Precision::Single {
            let (projected, found, _) = both::<f32>(&scene, stiffness);
            (projected.report, found.report)
        } else {
            let (projected, found, _) = both::<f64>(&scene, stiffness);
            (projected.report, found.report)
        };
        let cost = found.operator_applications as f64 / projected.operator_applications as f64;
        let relative = scene.stiffness * scene.grid.spacing().0 / scene.modulus;
        let row = rows.entry((of_waves, relative.log10().floor() as i32)).or_default();
        row.push((projected.status, found.status, cost));
    }
    println!(
        "stiffness                  scenes  at limit  stalled  projection stalled  applications over projection's: median, 9 of 10"
    );
    let mut limited = 0;
    for ((of_waves, power), row) in &mut rows {
        let at_limit = row.iter().filter(|(_, found, _)| *found == Status::IterationLimit).count();
        let stalled = |status: &dyn Fn(&(Status, Status, f64)) -> Status| {
            row.iter().filter(|case| status(case) == Status::Stalled).count()
        };
        let (ours, theirs) = (stalled(&|case| case.1), stalled(&|case| case.0));
        let unit = if *of_waves { "of the shortest wave" } else { "E*/L" };
        let name = format!("1e{power}-1e{} {unit}", power + 1);
        row.sort_by(|a, b| a.2.total_cmp(&b.2));
        let [median, most] = [row.len() / 2, row.len() * 9 / 10].map(|i| row[i].2);
        println!("{name:<28} {:>4} {at_limit:>9} {ours:>8} {theirs:>19} {median:>8.1} {most:.1}", row.len());
        limited += at_limit;
    }
    println!("at the limit: {limited} of {cases}");
    assert!(limited as u64 * 50 <= cases);
}
