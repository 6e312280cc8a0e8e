//! Symmetries of the answer, and that the controls agree, on random small scenes. Two certified states differ by no
//! more than the sum of their certificates; nothing else is allowed, but for the rounding of the pressures.

use asperity::*;
use ndarray::Array2;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use oracles::dense::{Dense, mean_product};
use oracles::scenes::{Features, Kind, Law, Scene};

/// Hard walls, and laws that leave the problem convex.
const CONVEX: Features = Features {
    laws: &[Kind::None, Kind::Exponential, Kind::PowerLaw, Kind::LennardJones, Kind::Varying],
    ..Features::HARD
};

const CASES: u64 = 150;

/// The tolerances are well above the rounding of each precision.
const TOLERANCES: [f64; 2] = [1e-3, 1e-7];

/// A solution in `f64`, and how far it may be from the exact one, in the energy norm.
struct Solved {
    dense: Dense,
    gap: Array2<f64>,
    report: Report,
    promise: f64,
}

/// A scene in units of its own: sides, heights and modulus of about one.
fn scene(seed: u64) -> Option<Scene> {
    let scene = Scene { start: None, ..Scene::with_features(seed, &CONVEX) };
    let (heights, (lx, ly)) = (scene.centred(), scene.grid.lengths());
    let span = heights.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let held = matches!(scene.control, Control::MeanGap(_) | Control::MeanPressure(_));
    if !held || span <= 1e-9 * lx || scene.heights.len() < 2 {
        return None;
    }
    let unit = scaled(&scene, (1.0 / lx.max(ly), 0.05 / span, 1.0 / scene.modulus));
    Some(unit.convex())
}

/// The same scene in other units of length, height and modulus.
fn scaled(scene: &Scene, (length, height, modulus): (f64, f64, f64)) -> Scene {
    let pressure = modulus * height / length;
    let control = match scene.control {
        Control::MeanGap(gap) => Control::MeanGap(gap * height),
        Control::MeanPressure(p) => Control::MeanPressure(p * pressure),
        other => panic!("{other:?} is not checked here"),
    };
    let (lx, ly) = scene.grid.lengths();
    let law = Law {
        work: scene.law.work * pressure * height,
        range: scene.law.range * height,
        cut_off: scene.law.cut_off.map(|end| end * height),
        ..scene.law.clone()
    };
    Scene {
        grid: Grid::new(scene.grid.shape(), (lx * length, ly * length)).unwrap(),
        heights: scene.heights.mapv(|h| h * height),
        modulus: scene.modulus * modulus,
        law,
        control,
        ..scene.clone()
    }
}

/// The solution, unless rounding of heights and gaps leaves more than the tolerance of a contact so light.
fn solve<T: Real>(scene: &Scene, tolerance: f64) -> Option<Solved> {
    let (dense, centred) = (scene.dense(), scene.centred());
    let span = centred.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let settings = Settings::default().tolerance(tolerance);
    let Solution { gap, pressure, report, .. } = Scene { settings, ..scene.clone() }.solution::<T>().unwrap();
    let surface_work = dense.work(&centred);
    let rounded = surface_work + dense.stiffest * report.mean_gap * (report.mean_gap + span);
    let floor = T::epsilon().widen() * (rounded / report.elastic_energy).sqrt();
    if report.status != Status::Converged && (report.status == Status::Detached || floor >= 0.25 * tolerance) {
        return None;
    }
    assert_eq!(report.status, Status::Converged, "{report:?} in {scene}");
    let (law, nodes) = (scene.law.of_gap::<T>(), gap.len() as f64);
    let at_contact = |node: usize| scene.law.share(node) * law.traction(T::zero()).widen();
    let gap = gap.mapv(T::widen);
    let work = 2.0 * report.elastic_energy;
    let scale = if report.contact_nodes > 0 { work } else { work.max(surface_work) };
    // what rounding does to a pressure, and that to the certificate
    let largest = gap.iter().chain(&centred).fold(0.0_f64, |a, b| a.max(b.abs()));
    let noise = 16.0 * T::epsilon().widen() * dense.stiffest * largest / dense.softest.sqrt();
    let mut promise = report.relative_error * scale.sqrt() + noise;
    if let Control::MeanPressure(given) = scene.control {
        let load = report.load_error * given.abs().max(report.mean_contact_pressure);
        let tension = |(node, (&g, &p)): (usize, (&f64, &T))| {
            if g > 0.0 { 0.0 } else { (p.widen() + at_contact(node)).min(0.0) }
        };
        let released = gap.iter().zip(&pressure).enumerate().map(tension).sum::<f64>() / nodes;
        // the most that a mean gap changes for a change of unit energy norm that leaves a node where it is
        let reach = (nodes * dense.compliance[0]).sqrt();
        promise += (load - released + noise * dense.softest.sqrt()) * reach;
    }
    // the energy is convex by this much
    let convexity = if scene.law.is_none() { 1.0 } else { 0.5 };
    Some(Solved { dense, gap, report, promise: promise / convexity })
}

impl Solved {
    /// That another gap, of the same scene, is the same state.
    fn agrees(&self, gap: &Array2<f64>, promise: f64, scene: &Scene) {
        let off: Vec<f64> = self.gap.iter().zip(gap).map(|(a, b)| a - b).collect();
        let distance = mean_product(&off, &self.dense.pressure(&off)).max(0.0).sqrt();
        let allowed = self.promise + promise;
        assert!(distance <= allowed, "{distance:e} > {allowed:e} in {scene}: {:?}", self.report);
    }
}

/// Calls a check with every scene, and counts what it could compare.
fn every(check: impl Fn(&Scene, &mut ChaCha8Rng) -> [Option<()>; 2]) {
    let compared: usize = (0..CASES)
        .filter_map(|seed| Some(check(&scene(seed)?, &mut ChaCha8Rng::seed_from_u64(seed))))
        .map(|found| found.iter().flatten().count())
        .sum();
    assert!(compared as u64 > CASES / 2, "{compared}");
}

/// The same surface from elsewhere: moved by whole nodes, turned over the diagonal, and seen in mirrors.
fn symmetries<T: Real>(scene: &Scene, (a, b): (usize, usize), tolerance: f64) -> Option<()> {
    let (nx, ny) = scene.heights.dim();
    let moved = |field: &Array2<f64>| Array2::from_shape_fn((nx, ny), |(i, j)| field[[(i + a) % nx, (j + b) % ny]]);
    let turned = |field: &Array2<f64>| field.t().as_standard_layout().into_owned();
    let left = |field: &Array2<f64>| Array2::from_shape_fn((nx, ny), |(i, j)| field[[nx - 1 - i, j]]);
    let down = |field: &Array2<f64>| Array2::from_shape_fn((nx, ny), |(i, j)| field[[i, ny - 1 - j]]);
    let seen = |change: &dyn Fn(&Array2<f64>) -> Array2<f64>| {
        let law = Law { shares: scene.law.shares.as_ref().map(change), ..scene.law.clone() };
        Scene { heights: change(&scene.heights), law, ..scene.clone() }
    };
    let here = solve::<T>(scene, tolerance)?;
    for change in [&moved as &dyn Fn(&Array2<f64>) -> Array2<f64>, &left, &down] {
        solve::<T>(&seen(change), tolerance)?.agrees(&change(&here.gap), here.promise, scene);
    }
    let (lx, ly) = scene.grid.lengths();
    let there = Scene { grid: Grid::new((ny, nx), (ly, lx)).unwrap(), ..seen(&turned) };
    solve::<T>(&there, tolerance)?.agrees(&turned(&here.gap), here.promise, scene);
    Some(())
}

#[test]
fn a_surface_that_is_moved_mirrored_or_turned_is_the_same() {
    every(|scene, random| {
        let by = (random.random_range(0..9), random.random_range(0..9));
        [symmetries::<f32>(scene, by, TOLERANCES[0]), symmetries::<f64>(scene, by, TOLERANCES[1])]
    });
}

#[test]
fn any_units_give_the_same() {
    fn units<T: Real>(scene: &Scene, powers: [f64; 3], tolerance: f64) -> Option<()> {
        let [length, height, modulus] = powers.map(|power| 10_f64.powf(power));
        let other = scaled(scene, (length, height, modulus));
        let (here, there) = (solve::<T>(scene, tolerance)?, solve::<T>(&other, tolerance)?);
        let promise = there.promise / (height * modulus * height / length).sqrt();
        here.agrees(&there.gap.mapv(|g| g / height), promise, scene);
        Some(())
    }
    every(|scene, random| {
        let mut powers = |most: [f64; 3]| most.map(|most| random.random_range(-most..most));
        let (small, large) = (powers([4.0; 3]), powers([9.0, 12.0, 12.0]));
        [units::<f32>(scene, small, TOLERANCES[0]), units::<f64>(scene, large, TOLERANCES[1])]
    });
}

/// The state at a mean gap is that under the pressure that it takes, from afar and as a start.
#[test]
fn both_controls_agree() {
    fn controls<T: Real>(scene: &Scene, tolerance: f64) -> Option<()> {
        let Control::MeanGap(_) = scene.control else { return None };
        let held = solve::<T>(scene, tolerance)?;
        if held.report.contact_nodes == 0 {
            return None;
        }
        let pressed = Scene { control: Control::MeanPressure(held.report.mean_pressure), ..scene.clone() };
        // both have one residual but for a mean, from which the certificate is free
        let near = Scene { start: Some(held.gap.clone()), ..pressed.clone() };
        let same = solve::<T>(&near, 10.0 * tolerance)?;
        held.agrees(&same.gap, same.promise, scene);
        if scene.law.is_none() && held.report.mean_pressure > 0.0 {
            solve::<T>(&pressed, tolerance)?.agrees(&held.gap, held.promise, scene);
        }
        Some(())
    }
    every(|scene, _| [controls::<f32>(scene, TOLERANCES[0]), controls::<f64>(scene, TOLERANCES[1])]);
}
