//! Symmetries of the answer, and that the controls agree, on random small scenes. Two states of which each is certified
//! differ by no more than the sum of what is certified; nothing else is allowed, but for the rounding of the pressures.

use std::result::Result;

use asperity::*;
use ndarray::Array2;
use proptest::prelude::*;

use crate::common::dense::{Dense, mean_product};

/// The scene to solve: a surface, and an exponential law that leaves the problem convex, or none.
#[derive(Clone, Debug)]
struct Scene {
    heights: Array2<f64>,
    lengths: (f64, f64),
    modulus: f64,
    adhesive: bool,
    control: Control,
}

/// A solution in `f64`, and how far it may be from the exact one, in the energy norm.
struct Solved {
    scene: Scene,
    dense: Dense,
    gap: Array2<f64>,
    report: Report,
    promise: f64,
}

impl Scene {
    fn dense(&self) -> Dense {
        Dense::new(self.heights.dim(), self.lengths, self.modulus)
    }

    fn solve<T: Real>(&self, tolerance: f64, start: Option<&Array2<f64>>) -> Result<Solved, TestCaseError> {
        let grid = Grid::new(self.heights.dim(), self.lengths).unwrap();
        let surface = Surface::new(grid, self.heights.clone()).unwrap();
        let dense = self.dense();
        let span = self.heights.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let range = 0.5 * span;
        // half of what the softest wave resists
        let w = if self.adhesive { 0.5 * dense.softest * range * range } else { 0.0 };
        let law: Box<dyn AdhesionLaw<T>> = match self.adhesive {
            true => Box::new(Exponential::new(w, range).unwrap()),
            false => Box::new(NoAdhesion),
        };
        let operator = Westergaard::<T>::new(grid, self.modulus).unwrap();
        let mut problem = Problem::new(&surface, operator, law).unwrap();
        let start = start.map(|start| start.mapv(T::lit));
        let settings = Settings { tolerance: Some(tolerance), ..Settings::default() };
        let go_on = |_: &Iteration| std::ops::ControlFlow::Continue(());
        let start = start.as_ref().map_or(Start::Default, |start| Start::From(start));
        let solution = Solver::new(settings).solve_with(&mut problem, self.control, start, go_on);
        let Solution { gap, pressure, report, .. } = solution.unwrap();
        // a contact so light that rounding of heights and gaps leaves more than the tolerance says nothing of
        // symmetries
        let rounded = mean_product(&centred(&self.heights), &dense.pressure(&centred(&self.heights)))
            + dense.stiffest * report.mean_gap * (report.mean_gap + span);
        let floor = T::epsilon().widen() * (rounded / report.elastic_energy).sqrt();
        prop_assume!(report.status == Status::Converged || report.contact_nodes == 0 || floor < 0.25 * tolerance);
        prop_assert_eq!(report.status, Status::Converged, "{:?}", report);
        let at_contact = problem.law().traction(T::zero()).widen();
        let gap = gap.mapv(T::widen);
        let centred = centred(&self.heights);
        let surface_work = mean_product(&centred, &dense.pressure(&centred));
        let work = 2.0 * report.elastic_energy;
        let scale = if report.contact_nodes > 0 { work } else { work.max(surface_work) };
        // what rounding does to a pressure, and that to the certificate
        let largest = gap.iter().chain(&centred).fold(0.0_f64, |a, b| a.max(b.abs()));
        let noise = 16.0 * T::epsilon().widen() * dense.stiffest * largest / dense.softest.sqrt();
        let mut promise = report.relative_error * scale.sqrt() + noise;
        if let Control::MeanPressure(given) = self.control {
            let load = report.load_error * given.abs().max(report.mean_contact_pressure);
            let under_tension = |(&g, &p): (&f64, &T)| if g > 0.0 { 0.0 } else { (p.widen() + at_contact).min(0.0) };
            let released = gap.iter().zip(&pressure).map(under_tension).sum::<f64>() / gap.len() as f64;
            promise += (load - released + noise * dense.softest.sqrt()) * dense.reach();
        }
        // the energy is convex by this much
        let convexity = if self.adhesive { 0.5 } else { 1.0 };
        Ok(Solved { scene: self.clone(), dense, gap, report, promise: promise / convexity })
    }

    /// The same with other heights.
    fn with(&self, heights: Array2<f64>) -> Self {
        Self { heights, ..self.clone() }
    }
}

impl Dense {
    /// The most that a mean gap can change for a change of unit energy norm that leaves a node where it is: as the mean
    /// is minus what is left at that node without it.
    fn reach(&self) -> f64 {
        (self.nodes as f64 * self.compliance[0]).sqrt()
    }
}

fn centred(heights: &Array2<f64>) -> Vec<f64> {
    let mean = heights.mean().unwrap();
    heights.iter().map(|h| h - mean).collect()
}

impl Solved {
    /// That another gap, of the same scene, is the same state.
    fn agrees(&self, gap: &Array2<f64>, promise: f64) -> Result<(), TestCaseError> {
        let difference: Vec<f64> = self.gap.iter().zip(gap).map(|(a, b)| a - b).collect();
        let distance = mean_product(&difference, &self.dense.pressure(&difference)).max(0.0).sqrt();
        let allowed = self.promise + promise;
        prop_assert!(distance <= allowed, "{distance:e} > {allowed:e} in {:?} {:?}", self.scene, self.report);
        Ok(())
    }
}

fn scenes(adhesion: bool) -> impl Strategy<Value = Scene> {
    let noise = proptest::collection::vec(0.0..1.0, 81);
    (1..10_usize, 2..10_usize, noise, -0.5..0.5, 0.02..1.5, any::<bool>(), any::<bool>()).prop_map(
        move |(nx, ny, noise, aspect, load, adhesive, gap_controlled)| {
            let heights = Array2::from_shape_fn((nx, ny), |(i, j)| 0.05 * noise[9 * i + j]);
            let lengths = (1.0, 10_f64.powf(aspect));
            let adhesive = adhesion && adhesive;
            let mut scene = Scene { heights, lengths, modulus: 1.0, adhesive, control: Control::MeanGap(0.05 * load) };
            if !gap_controlled && !adhesive {
                let flat = scene.dense().pressure(&centred(&scene.heights));
                let flat = flat.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
                scene.control = Control::MeanPressure(0.5 * load * flat);
            }
            scene
        },
    )
}

/// The tolerances are well above the rounding of each precision.
const TOLERANCES: [f64; 2] = [1e-3, 1e-7];

/// The same surface from elsewhere: moved by whole nodes, turned over the diagonal, and seen in mirrors.
fn symmetries<T: Real>(scene: &Scene, (a, b): (usize, usize), tolerance: f64) -> Result<(), TestCaseError> {
    let (nx, ny) = scene.heights.dim();
    let moved = |field: &Array2<f64>| Array2::from_shape_fn((nx, ny), |(i, j)| field[[(i + a) % nx, (j + b) % ny]]);
    let turned = |field: &Array2<f64>| field.t().as_standard_layout().into_owned();
    let left = |field: &Array2<f64>| Array2::from_shape_fn((nx, ny), |(i, j)| field[[nx - 1 - i, j]]);
    let down = |field: &Array2<f64>| Array2::from_shape_fn((nx, ny), |(i, j)| field[[i, ny - 1 - j]]);
    let here = scene.solve::<T>(tolerance, None)?;
    for change in [&moved as &dyn Fn(&Array2<f64>) -> Array2<f64>, &left, &down] {
        let there = scene.with(change(&scene.heights)).solve::<T>(tolerance, None)?;
        there.agrees(&change(&here.gap), here.promise)?;
    }
    let (lx, ly) = scene.lengths;
    let there = Scene { lengths: (ly, lx), ..scene.with(turned(&scene.heights)) }.solve::<T>(tolerance, None)?;
    there.agrees(&turned(&here.gap), here.promise)
}

/// The same scene in other units.
fn units<T: Real>(
    scene: &Scene,
    (length, height, modulus): (f64, f64, f64),
    tolerance: f64,
) -> Result<(), TestCaseError> {
    let [length, height, modulus] = [length, height, modulus].map(|power| 10_f64.powf(power));
    let pressure = modulus * height / length;
    let control = match scene.control {
        Control::MeanGap(gap) => Control::MeanGap(gap * height),
        Control::MeanPressure(p) => Control::MeanPressure(p * pressure),
        other => panic!("{other:?} is not checked here"),
    };
    let (lx, ly) = scene.lengths;
    let other = Scene {
        heights: scene.heights.mapv(|h| h * height),
        lengths: (lx * length, ly * length),
        modulus: scene.modulus * modulus,
        control,
        ..*scene
    };
    let (here, there) = (scene.solve::<T>(tolerance, None)?, other.solve::<T>(tolerance, None)?);
    here.agrees(&there.gap.mapv(|g| g / height), there.promise / (height * pressure).sqrt())
}

/// The state at a mean gap is that under the pressure that it takes, from afar and as a start.
fn controls<T: Real>(scene: &Scene, tolerance: f64) -> Result<(), TestCaseError> {
    let Control::MeanGap(_) = scene.control else { return Ok(()) };
    let held = scene.solve::<T>(tolerance, None)?;
    if held.report.contact_nodes == 0 {
        return Ok(());
    }
    let pressed = Scene { control: Control::MeanPressure(held.report.mean_pressure), ..scene.clone() };
    // the residual of the one is that of the other but for a mean, of which the certificate is free
    let same = pressed.solve::<T>(10.0 * tolerance, Some(&held.gap))?;
    held.agrees(&same.gap, same.promise)?;
    if !scene.adhesive && held.report.mean_pressure > 0.0 {
        let again = pressed.solve::<T>(tolerance, None)?;
        again.agrees(&held.gap, held.promise)?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_surface_that_is_moved_mirrored_or_turned_is_the_same(
        scene in scenes(true), by in (0..9_usize, 0..9_usize)
    ) {
        symmetries::<f32>(&scene, by, TOLERANCES[0])?;
        symmetries::<f64>(&scene, by, TOLERANCES[1])?;
    }

    #[test]
    fn any_units_give_the_same(
        scene in scenes(true), small in (-4.0..4.0, -4.0..4.0, -4.0..4.0), large in (-9.0..9.0, -12.0..12.0, -12.0..12.0)
    ) {
        units::<f32>(&scene, small, TOLERANCES[0])?;
        units::<f64>(&scene, large, TOLERANCES[1])?;
    }

    #[test]
    fn both_controls_agree(scene in scenes(true)) {
        controls::<f32>(&scene, TOLERANCES[0])?;
        controls::<f64>(&scene, TOLERANCES[1])?;
    }
}
