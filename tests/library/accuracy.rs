//! Accuracies that are asked for, and how wrong grids are said to be.

mod edge;
mod refusal;

use std::f64::consts::TAU;

use asperity::accuracy::{Accuracy, AccurateSolution, GridError, Quantity};
use asperity::contact::ContactArea;
use asperity::exact::WavyLine;
use asperity::nested::Level;
use asperity::solver::Iteration;
use asperity::*;
use asperity_maps::surface_with_absent;
use ndarray::Array2;

/// All grids of a map, up to one of 256² nodes or as many, with their stiffnesses.
fn truth_of(surface: &Surface, control: Control) -> Vec<Level> {
    let (wanted, settings) = (Accuracy::new(1e-5, Quantity::Area), Settings::default().tolerance(2e-7));
    let nested = wanted.nested.stiffness(1e-4);
    solve_to(settings, wanted.memory(7e6).nested(nested), surface, control).unwrap().levels
}

fn half_space(grid: Grid) -> Result<Westergaard<f64>> {
    Westergaard::new(grid, 1.0)
}

fn free(grid: Grid) -> Result<Boussinesq<f64>> {
    Boussinesq::new(grid, 1.0)
}

/// A surface with a shortest wave of an eighth of the side, the same on every grid.
fn surface(n: usize, seed: u64) -> Surface {
    let amplitude = Amplitude::RmsSlope(0.1);
    let rough = SelfAffine::default().k_l(1.0).k_r(2.0).k_s(8.0).amplitude(amplitude).random_phase(true).seed(seed);
    rough.surface(Grid::square(n, 1.0).unwrap()).unwrap()
}

const PRESSED: Control = Control::MeanPressure(5e-3);

fn levels_of(nested: Nested, surface: &Surface, control: Control) -> Vec<Level> {
    nested.solve(&mut Solver::default(), surface, half_space, NoAdhesion, control).unwrap().levels
}

fn solve(wanted: Accuracy, surface: &Surface, control: Control) -> AccurateSolution<f64> {
    solve_to(Settings::default(), wanted, surface, control).unwrap()
}

fn solve_to(
    settings: Settings,
    wanted: Accuracy,
    surface: &Surface,
    control: Control,
) -> Result<AccurateSolution<f64>> {
    wanted.solve(&mut Solver::new(settings), surface, half_space, NoAdhesion, control)
}

fn truth(seed: u64, control: Control) -> Level {
    levels_of(Nested::default().stiffness(1e-5), &surface(512, seed), control).pop().unwrap()
}

/// Plateaus of radius 0.1, with flanks of a few cells: interpolation between the nodes has ripples.
fn plateau(flank: f64) -> Surface {
    let height = |x: f64, y: f64| -0.01 * ((x.hypot(y) - 0.1) / flank).clamp(0.0, 1.0);
    Surface::from_fn(Grid::square(64, 1.0).unwrap(), height).unwrap()
}

#[test]
fn plateaus_are_not_refined_to_ripples() {
    for flank in [1e-9, 0.03, 0.06, 0.12] {
        let surface = plateau(flank);
        let load = Control::MeanPressure(5e-5);
        let given = levels_of(Nested::default(), &surface, load).pop().unwrap().area;
        assert!(given.contact_fraction > 0.02, "{flank}");
        let found = solve(Accuracy::new(0.01, Quantity::Area), &surface, load);
        assert_eq!((found.reached, found.refinable, found.unaffordable), (false, false, None), "{flank}");
        assert_eq!(found.levels.last().unwrap().area.contact_nodes, given.contact_nodes, "{flank}");
    }
    let law = Jkr::new(1e-6).unwrap();
    let wanted = Accuracy::new(0.01, Quantity::Area);
    let found = wanted.pull_off(&mut Solver::default(), &plateau(1e-9), half_space, law, &PullOff::default()).unwrap();
    assert_eq!((found.reached, found.refinable, found.surface.grid().shape()), (false, false, (64, 64)));
}

#[test]
fn an_accuracy_of_each_quantity_is_reached_and_true() {
    for (seed, target) in [(1, 0.02), (2, 0.015)] {
        for (quantity, control) in
            [(Quantity::Area, PRESSED), (Quantity::Gap, PRESSED), (Quantity::Pressure, Control::MeanGap(0.01))]
        {
            let found = solve(Accuracy::new(target, quantity), &surface(32, seed), control);
            let error = found.error.unwrap();
            assert!(found.reached && error.relative < target && found.unaffordable.is_none(), "{quantity}: {error:?}");
            // a finer grid, twice as fine each time, and the answer on it
            let shapes: Vec<_> = found.levels.iter().map(|level| level.shape.0).collect();
            assert!(shapes.windows(2).all(|pair| pair[1] == 2 * pair[0]) && shapes.len() > 1, "{shapes:?}");
            assert_eq!(found.surface.grid().shape().0, *shapes.last().unwrap());
            assert_eq!(found.solution.gap.dim(), found.surface.grid().shape());
            let (level, truth) = (found.levels.last().unwrap(), truth(seed, control));
            let of = |level: &Level| match quantity {
                Quantity::Gap => level.mean_gap,
                Quantity::Pressure => level.mean_pressure,
                _ => level.area.corrected_contact_fraction,
            };
            assert!((of(level) / of(&truth) - 1.0).abs() < target, "{quantity} {seed}: {level:?} {truth:?}");
        }
    }
}

#[test]
fn nearly_closed_contacts_have_an_estimate_on_their_own_grid() {
    for (seed, pressure) in [(1, 0.09), (2, 0.09), (2, 0.12)] {
        let control = Control::MeanPressure(pressure);
        let found = solve(Accuracy::new(0.01, Quantity::Area), &surface(128, seed), control);
        let (finest, truth) = (found.levels.last().unwrap().area, truth(seed, control).area);
        assert!(truth.contact_fraction > 0.8 && truth.contact_fraction < 1.0, "{truth:?}");
        // no finer grid was needed to tell the error
        assert_eq!((found.reached, found.surface.grid().shape()), (true, (128, 128)));
        let (estimate, error) =
            (found.error.unwrap().relative, finest.corrected_contact_fraction / truth.corrected_contact_fraction - 1.0);
        assert!(estimate > error.abs() / 3.0 && error.abs() < 0.01, "{seed} {pressure}: {estimate:e} {error:e}");
    }
}

/// A map through a few random heights, which has no shorter waves than they tell, on square cells.
fn band_limited(few: (usize, usize), shape: (usize, usize), seed: usize) -> Surface {
    let random = |(i, j): (usize, usize)| ((1 + i + 37 * j + 1009 * seed) as f64 * 0.754_877_666).fract().powi(2);
    let heights = asperity::surface::resample(Array2::from_shape_fn(few, random), shape).unwrap();
    let longest = shape.0.max(shape.1) as f64;
    let surface =
        Surface::new(Grid::new(shape, (shape.0 as f64 / longest, shape.1 as f64 / longest)).unwrap(), heights).unwrap();
    let slope = surface.spectrum().rms_slope();
    Surface::new(*surface.grid(), surface.heights() * (0.1 / slope)).unwrap()
}

#[test]
fn estimates_cover_95_of_100_errors_of_strips_white_noise_and_smooth_maps() {
    let [mut all, mut covered] = [[0; 4]; 2];
    for (few, shape) in [((16, 16), (16, 16)), ((128, 4), (128, 4)), ((5, 6), (32, 32)), ((64, 1), (64, 1))] {
        for (seed, pressure) in [(1, 1e-3), (2, 3e-3), (3, 8e-3), (4, 2e-2), (5, 4e-2)] {
            let surface = band_limited(few, shape, seed);
            let gap = truth_of(&surface, Control::MeanPressure(pressure)).last().unwrap().mean_gap;
            for control in [Control::MeanPressure(pressure), Control::MeanGap(gap)] {
                let levels = truth_of(&surface, control);
                let (finest, given) = (levels.last().unwrap(), levels.iter().position(|level| level.shape == shape));
                for at in (given.unwrap()..levels.len()).filter(|&at| 8 * levels[at].shape.0 <= finest.shape.0) {
                    let finer = (levels[at].shape.0 / shape.0) as f64;
                    let waves = finer * surface.nodes_per_wave(Boundary::Periodic);
                    let told = |quantity: Quantity| {
                        let estimate = GridError::of(&levels[..=at], quantity, waves, 0.0).map(|error| error.relative);
                        estimate.filter(|_| quantity.check(control).is_ok())
                    };
                    let values = |level: &Level| {
                        let stiffness = level.stiffness.unwrap().pressure_per_length;
                        [level.area.corrected_contact_fraction, level.mean_gap, level.mean_pressure, stiffness]
                    };
                    let estimates = [
                        told(Quantity::Area),
                        told(Quantity::Gap),
                        told(Quantity::Pressure),
                        levels[at].stiffness.unwrap().error(),
                    ];
                    for (k, (found, truth)) in values(&levels[at]).into_iter().zip(values(finest)).enumerate() {
                        let Some(estimate) = estimates[k] else { continue };
                        all[k] += 1;
                        covered[k] += usize::from((found / truth - 1.0).abs() <= estimate);
                    }
                }
            }
        }
    }
    assert!(
        all.iter().zip(covered).all(|(&all, covered)| all >= 40 && 100 * covered >= 95 * all),
        "{covered:?} of {all:?}"
    );
}

#[test]
fn the_refined_surface_is_the_same_one() {
    let found = solve(Accuracy::new(0.02, Quantity::Area), &surface(32, 1), PRESSED);
    let n = found.surface.grid().shape().0;
    let same = surface(n, 1);
    assert!(n > 32);
    let worst = found.surface.heights() - same.heights();
    let mean = worst.mean().unwrap();
    assert!(worst.iter().all(|h| (h - mean).abs() < 1e-12 * 0.1), "{n}");
}

#[test]
fn an_accuracy_that_the_given_grid_has_ends_there() {
    for seed in 1..5 {
        let found = solve(Accuracy::new(0.1, Quantity::Area), &surface(32, seed), PRESSED);
        let truth = solve(Accuracy::new(2e-3, Quantity::Area), &surface(32, seed), PRESSED);
        let area = |found: &AccurateSolution<f64>| found.levels.last().unwrap().area.corrected_contact_fraction;
        let (error, estimate) = (area(&found) / area(&truth) - 1.0, found.error.unwrap());
        assert!(found.reached && estimate.rough && found.surface.grid().shape() == (32, 32), "{seed}: {estimate:?}");
        assert!(truth.reached && truth.surface.grid().shape().0 >= 128, "{seed}");
        assert!(error.abs() < 0.1 && estimate.relative > error.abs() / 3.0, "{seed}: {error} {estimate:?}");
    }
}

#[test]
fn a_plan_says_the_grid_that_is_taken() {
    let (surface, wanted) = (surface(32, 1), Accuracy::new(0.02, Quantity::Area));
    let mut operator = half_space(*surface.grid()).unwrap();
    let plan = wanted.plan(&Solver::default(), &surface, &mut operator, &NoAdhesion, PRESSED).unwrap();
    assert!((3.9..5.0).contains(&plan.nodes_per_wave) && plan.tolerance == 1e-3, "{plan:?}");
    assert!([64, 128].contains(&plan.shape.0) && plan.bytes > 0.0 && plan.applications >= 40.0, "{plan:?}");
    // in the limit of no range next to no adhesion takes the grid of a hard wall, and more adhesion a finer one
    let mut in_the_limit = |work: f64| {
        let law = Jkr::new(work).unwrap();
        wanted.plan(&Solver::default(), &surface, &mut operator, &law, PRESSED).unwrap().shape
    };
    assert_eq!(in_the_limit(1e-15), plan.shape);
    assert!(in_the_limit(2.5e-5).0 > 2 * plan.shape.0);
    // an adhesion that the grid does not resolve takes a finer one: μ_ρ is to be halved twice, which is 16 times as fine
    let mut with = |mu_rho: f64| {
        let law = Exponential::new(32.0 * (1e-3 * mu_rho).powi(2), 1e-3).unwrap();
        wanted.plan(&Solver::default(), &surface, &mut operator, &law, PRESSED)
    };
    assert_eq!(with(2.0).unwrap().shape, (512, 512));
    let error = with(1e3).unwrap_err();
    assert!(matches!(error, Error::Unaffordable { affordable: f64::INFINITY, .. }), "{error}");
    assert!(error.to_string().ends_with("too few to resolve the adhesion: take a longer range"), "{error}");
}

#[test]
fn a_free_sphere_an_adhesive_one_and_a_line_have_accuracies_too() {
    let sphere = Surface::paraboloid(Grid::square(48, 0.8).unwrap(), 1.0).unwrap();
    let found = Accuracy::new(0.03, Quantity::Area)
        .solve(&mut Solver::default(), &sphere, free, NoAdhesion, Control::Approach(0.04))
        .unwrap();
    let exact = std::f64::consts::PI * 0.04 / 0.64; // πRδ
    let area = found.levels.last().unwrap().area.corrected_contact_fraction;
    assert!(found.reached && (area / exact - 1.0).abs() < 0.03, "{area} {exact}");

    let law = || Exponential::new(4e-5, 3e-3).unwrap();
    let found = Accuracy::new(0.03, Quantity::Pressure).solve(
        &mut Solver::default(),
        &surface(32, 2),
        half_space,
        law(),
        Control::MeanGap(0.01),
    );
    assert!(found.unwrap().reached);

    let wave = Surface::wave(Grid::line(32, 1.0).unwrap(), 0.02, 1).unwrap();
    let control = Control::MeanPressure(0.02);
    let found = solve(Accuracy::new(5e-3, Quantity::Gap), &wave, control);
    let s: f64 = 0.02 / (std::f64::consts::PI * 0.02);
    let exact = 0.02 * (1.0 - s + s * s.ln());
    let error = found.solution.report.mean_gap / exact - 1.0;
    assert!(found.reached && error.abs() < 5e-3, "{error} {:?}", found.error);
}
