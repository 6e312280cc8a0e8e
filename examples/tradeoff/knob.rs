//! The knob: accuracies of the area that are asked for on many rough scenes, and the best choice by hand.

use asperity::accuracy::{Accuracy, Quantity};
use asperity::contact::ContactArea;
use asperity::nested::Level;
use asperity::{
    AdhesionLaw, Amplitude, Control, Exponential, Grid, Nested, NoAdhesion, SelfAffine, Settings, Solver, Surface,
    Westergaard,
};

use common::Outcome;

/// The shortest wave, per side; the nodes of the given map along a side.
const SHORTEST: f64 = 8.0;
const GIVEN: usize = 32;
const LEVELS: [usize; 5] = [32, 64, 128, 256, 512];
const SLOPE: f64 = 0.1;
/// Work of adhesion and range: resolved on the given map.
const LAW: (f64, f64) = (4e-5, 3e-3);
const TARGETS: [f64; 5] = [0.05, 0.03, 0.02, 0.01, 0.005];
/// The choices by hand: nodes along a side, each with these tolerances.
const TOLERANCES: [f64; 2] = [1e-3, 1e-4];

/// Whether the law is adhesive, whether the pressure is given or the mean gap under it, and pressures over the slope.
const LOADS: [(bool, bool, &[f64]); 4] = [
    (false, true, &[0.003, 0.02, 0.08, 0.3]),
    (false, false, &[0.02, 0.08]),
    (true, true, &[0.0, 0.02]),
    (true, false, &[0.02, 0.1]),
];

/// A rough surface with its load and law.
struct Scene {
    seed: u64,
    hurst: f64,
    adhesive: bool,
    control: Control,
}

/// The corrected area, the mean gap, and the work.
type Found = (f64, f64, f64);

pub fn half_space(grid: Grid) -> asperity::Result<Westergaard<f64>> {
    Westergaard::new(grid, 1.0)
}

impl Scene {
    fn surface(&self, n: usize) -> Outcome<Surface> {
        let rough = SelfAffine::default().k_l(1.0).k_r(2.0).k_s(SHORTEST).hurst(self.hurst).seed(self.seed);
        let rough = rough.amplitude(Amplitude::RmsSlope(SLOPE)).random_phase(self.seed.is_multiple_of(2));
        Ok(rough.surface(Grid::square(n, 1.0)?)?)
    }

    fn law(&self) -> Outcome<Box<dyn AdhesionLaw<f64>>> {
        Ok(if self.adhesive { Box::new(Exponential::new(LAW.0, LAW.1)?) } else { Box::new(NoAdhesion) })
    }

    /// The solution as the tool finds it without an accuracy, with coarser grids where they pay.
    fn by_hand(&self, n: usize, tolerance: f64) -> Outcome<Found> {
        let (surface, law) = (self.surface(n)?, self.law()?);
        let (mut solver, mut nested) = (Solver::new(Settings::default().tolerance(tolerance)), Nested::default());
        if !nested.pays::<f64>(&solver.settings, &surface, &law, self.control) {
            nested.coarsest = n;
        }
        let found = nested.solve(&mut solver, &surface, half_space, law, self.control)?;
        let area = ContactArea::of_solution(&found.solution)?.corrected_contact_fraction;
        Ok((area, found.solution.report.mean_gap, work(&found.levels)))
    }
}

/// All scenes: seeds, Hurst exponents, laws and loads; a mean gap belongs to a pressure. The factors of the estimates
/// were fitted to other seeds and exponents, the factors of the area to these as well.
fn scenes(quick: bool) -> Outcome<Vec<Scene>> {
    let (seeds, hursts) = if quick { (11..12, &[0.8][..]) } else { (11..15, &[0.3, 0.6, 0.9][..]) };
    let mut all = Vec::new();
    for (seed, &hurst) in seeds.flat_map(|seed| hursts.iter().map(move |hurst| (seed, hurst))) {
        let of = |(adhesive, pressed, all): (_, _, &'static [f64])| all.iter().map(move |p| (adhesive, pressed, p));
        for (adhesive, pressed, pressure) in LOADS.into_iter().flat_map(of) {
            let mut scene = Scene { seed, hurst, adhesive, control: Control::MeanPressure(SLOPE * pressure) };
            if !pressed {
                scene.control = Control::MeanGap(scene.by_hand(4 * GIVEN, 1e-6)?.1);
            }
            all.push(scene);
        }
    }
    Ok(all)
}

/// The operator applications times the nodes that they are on, in millions.
fn work(levels: &[Level]) -> f64 {
    let of = |level: &Level| level.operator_applications as f64 * (level.shape.0 * level.shape.1) as f64;
    1e-6 * levels.iter().map(of).sum::<f64>()
}

/// Prints what becomes of an accuracy of the area that is asked for, next to what the same grids cost by hand.
pub fn measure(quick: bool) -> Outcome<()> {
    let scenes = scenes(quick)?;
    let finest = if quick { 256 } else { 1024 };
    println!("\n== knob: accuracies of the area of {} scenes on maps of {GIVEN}² nodes, and one choice", scenes.len());
    println!("by hand, right in nine of ten; work is operator applications times nodes\n");
    // the error of the area is of second order
    let truth = |scene: &Scene| -> Outcome<f64> {
        let [coarse, fine] = [scene.by_hand(finest / 2, 1e-6)?.0, scene.by_hand(finest, 1e-6)?.0];
        Ok(fine + (fine - coarse) / 3.0)
    };
    let truths = scenes.iter().map(truth).collect::<Outcome<Vec<_>>>()?;
    let all = || scenes.iter().zip(&truths);
    // by hand: one grid and tolerance for all scenes
    let mut by_hand = Vec::new();
    for n in LEVELS.into_iter().take(if quick { 3 } else { 5 }) {
        for tolerance in TOLERANCES {
            let found = all().map(|(scene, truth)| -> Outcome<(f64, f64)> {
                let (area, _, work) = scene.by_hand(n, tolerance)?;
                Ok((work, (area / truth - 1.0).abs()))
            });
            by_hand.push((n, found.collect::<Outcome<Vec<_>>>()?));
        }
    }
    println!("| asked for | right | true error: median | nine in ten | grid by hand | work over by hand |");
    println!("|{}", "---|".repeat(6));
    for target in TARGETS.into_iter().take(if quick { 1 } else { TARGETS.len() }) {
        let mut found = Vec::new();
        for (scene, truth) in all() {
            let (wanted, mut solver) = (Accuracy::new(target, Quantity::Area).memory(2e8), Solver::default());
            let surface = scene.surface(GIVEN)?;
            let solved = wanted.solve(&mut solver, &surface, half_space, scene.law()?, scene.control)?;
            let level = solved.levels.last().filter(|_| solved.reached);
            let error = |level: &Level| (level.area.corrected_contact_fraction / truth - 1.0).abs();
            found.extend(level.map(|level| (work(&solved.levels), error(level))));
        }
        let cost = |found: &[(f64, f64)]| found.iter().map(|(work, _)| work).sum::<f64>() / found.len() as f64;
        let share = |found: &[(f64, f64)]| found.iter().filter(|(_, error)| *error <= target).count() as f64;
        let right = |found: &[(f64, f64)]| 100.0 * share(found) / found.len() as f64;
        let good = by_hand.iter().filter(|(_, found)| right(found) >= 90.0);
        let best = good.min_by(|a, b| cost(&a.1).total_cmp(&cost(&b.1)));
        let hand = best.map(|(n, by_hand)| format!("{n}² | {:.1}", cost(&found) / cost(by_hand)));
        let mut errors: Vec<_> = found.iter().map(|(_, error)| *error).collect();
        errors.sort_by(f64::total_cmp);
        let at = |tenths: usize| 100.0 * errors.get(errors.len() * tenths / 10).copied().unwrap_or(f64::NAN);
        let (asked, hand) = (100.0 * target, hand.as_deref().unwrap_or("a finer grid | "));
        println!("| {asked} % | {:.0} % | {:.2} % | {:.2} % | {hand} |", right(&found), at(5), at(9));
    }
    Ok(())
}
