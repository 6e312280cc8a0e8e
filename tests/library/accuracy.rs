//! Accuracies that are asked for, and how wrong grids are said to be.

use std::f64::consts::TAU;

use asperity::accuracy::{Accuracy, AccurateSolution, GridError, Quantity};
use asperity::contact::ContactArea;
use asperity::exact::WavyLine;
use asperity::nested::Level;
use asperity::solver::Iteration;
use asperity::*;
use asperity_maps::surface_with_absent;
use ndarray::Array2;

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

/// All grids of a map, up to one of 256² nodes or as many, with their stiffnesses.
fn truth_of(surface: &Surface, control: Control) -> Vec<Level> {
    let (wanted, settings) = (Accuracy::new(1e-5, Quantity::Area), Settings::default().tolerance(2e-7));
    let nested = wanted.nested.stiffness(1e-4);
    solve_to(settings, wanted.memory(7e6).nested(nested), surface, control).unwrap().levels
}

#[test]
fn the_edge_of_the_contact_tells_the_error_of_a_single_grid() {
    let [mut all, mut close] = [0; 2];
    for (seed, pressure) in [(1, 2e-3), (2, 5e-3), (3, 0.012)] {
        for (control, quantity) in [
            (Control::MeanPressure(pressure), Some(Quantity::Gap)),
            (Control::MeanPressure(pressure), None),
            (Control::MeanGap(0.01), Some(Quantity::Pressure)),
        ] {
            let truth = truth(seed, control);
            for n in [64, 128] {
                let levels = levels_of(Nested::default().coarsest(n).stiffness(1e-4), &surface(n, seed), control);
                assert_eq!(levels.len(), 1);
                let waves = surface(n, seed).nodes_per_wave(Boundary::Periodic);
                let estimate = match quantity {
                    Some(quantity) => {
                        GridError::of(&levels, quantity, waves, 0.0).filter(|error| !error.rough).unwrap().relative
                    }
                    None => levels[0].stiffness.unwrap().error().unwrap(),
                };
                let of = |level: &Level| match quantity {
                    Some(Quantity::Gap) => level.mean_gap,
                    Some(_) => level.mean_pressure,
                    None => level.stiffness.unwrap().pressure_per_length,
                };
                let ratio = estimate / (of(&levels[0]) / of(&truth) - 1.0).abs();
                assert!(ratio > 0.5, "{quantity:?} {seed} {n}: {ratio}");
                (all, close) = (all + 1, close + usize::from((1.0..8.0).contains(&ratio)));
            }
        }
    }
    // more than that over many scenes, as `--example tradeoff` counts
    assert!(4 * close > 3 * all, "{close} of {all}");
}

/// The amplitude of the waves of strips and lattices.
const HIGH: f64 = 0.01;

/// A wave of a wave vector, in periods along the sides, or two at a right angle.
fn strips(shape: (usize, usize), [kx, ky]: [f64; 2], lattice: bool) -> Surface {
    let wave = |along: f64| HIGH * (TAU * along + 0.7).cos();
    let height = |x, y| wave(kx * x + ky * y) + if lattice { wave(kx * y - ky * x) } else { 0.0 };
    Surface::from_fn(Grid::new(shape, (1.0, 1.0)).unwrap(), height).unwrap()
}

#[test]
fn the_edge_of_strips_and_lattices_is_at_few_places() {
    let area = |surface: Surface| {
        let mut problem = Problem::new(&surface, half_space(*surface.grid()).unwrap(), NoAdhesion).unwrap();
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(3e-3)).unwrap();
        ContactArea::of_solution(&solution).unwrap()
    };
    // along the sides two edges of a strip; at an angle each side of the cells has its own places
    for (vector, lattice, most) in [
        ([1.0, 0.0], false, 2.0),
        ([0.0, 8.0], false, 2.0),
        ([1.0, 1.0], false, 2.0),
        ([2.0, 1.0], false, 6.0),
        ([4.0, 0.0], true, 40.0),
    ] {
        let found = area(strips((64, 64), vector, lattice));
        assert!(found.edges >= 128 && found.places >= 1.0 && found.places < 1.01 * most, "{vector:?}: {found:?}");
    }
    let found = area(strips((64, 1), [3.0, 0.0], false));
    assert!(found.edges == 6 && (1.0..=6.0).contains(&found.places), "{found:?}");
    let rough = area(surface(64, 1));
    assert!(2.0 * rough.places > rough.edges as f64 && rough.places <= rough.edges as f64, "{rough:?}");
    // of a map alone nothing is known, and without an edge there are no places
    let map =
        ContactArea::of(ndarray::array![[true, true, false, false]].view(), &Grid::new((1, 4), (1.0, 1.0)).unwrap());
    let map = map.unwrap();
    assert_eq!((map.edges, map.places), (2, 2.0));
    let flat = area(Surface::from_fn(Grid::square(8, 1.0).unwrap(), |_, _| 0.3).unwrap());
    assert_eq!((flat.edges, flat.places), (0, 0.0));
}

#[test]
fn strips_diagonals_and_lattices_are_as_right_as_is_asked() {
    let mut scenes = Vec::new();
    let mut add = |shape: (usize, usize), vectors: &[[f64; 2]], shares: &[f64]| {
        for (&vector, &share) in vectors.iter().flat_map(|vector| shares.iter().map(move |share| (vector, share))) {
            let length = vector[0].hypot(vector[1]).recip();
            let exact = WavyLine::new(HIGH, length, 1.0).unwrap().at_half_width(0.5 * share * length).unwrap();
            let control = [Control::MeanPressure(exact.mean_pressure()), Control::MeanGap(exact.mean_gap())];
            scenes.push((strips(shape, vector, false), control[scenes.len() % 2], share));
        }
    };
    let shares = [0.04, 0.07, 0.11, 0.16, 0.23, 0.34, 0.48, 0.62, 0.75, 0.9];
    add((32, 1), &[[1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [4.0, 0.0]], &shares);
    let shares = [0.1, 0.15, 0.2, 0.27, 0.45, 0.7];
    add((32, 32), &[[2.0, 0.0], [0.0, 3.0], [1.0, 1.0], [2.0, -1.0], [4.0, 4.0]], &shares);
    // the area of a lattice is the area of one of its cells
    for (vector, pressure) in [([2.0, 0.0], 0.3), ([2.0, 1.0], 0.1), ([3.0, 3.0], 0.2), ([4.0, 0.0], 0.6)] {
        let control = Control::MeanPressure(pressure * TAU * HIGH * f64::hypot(vector[0], vector[1]));
        let of_cell = |n| {
            let cell = strips((n, n), [1.0, 0.0], true);
            let scaled = Control::MeanPressure(pressure * TAU * HIGH);
            levels_of(Nested::default(), &cell, scaled).pop().unwrap().area.corrected_contact_fraction
        };
        let [coarse, fine] = [of_cell(64), of_cell(128)];
        scenes.push((strips((32, 32), vector, true), control, fine + (fine - coarse) / 3.0));
    }
    for target in [0.05, 0.03, 0.02, 0.01] {
        let mut reached = Vec::new();
        for (surface, control, exact) in &scenes {
            let found = solve(Accuracy::new(target, Quantity::Area).memory(7e6), surface, *control);
            let area = found.levels.last().unwrap().area.corrected_contact_fraction;
            reached.extend(found.reached.then_some((area / exact - 1.0).abs()));
        }
        let right = reached.iter().filter(|error| **error <= target).count();
        assert!(
            100 * right >= 95 * reached.len() && 10 * reached.len() >= 9 * scenes.len(),
            "{target}: {right} of {}",
            reached.len()
        );
    }
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
fn grids_that_say_nothing_leave_the_error_unknown() {
    let estimate = |n, quantity, nodes_per_wave, mu_rho, coarse_tolerance| {
        let nested = Nested::default().coarsest(32).coarse_tolerance(coarse_tolerance);
        GridError::of(&levels_of(nested, &surface(n, 1), PRESSED), quantity, nodes_per_wave, mu_rho)
    };
    let waves = surface(128, 1).nodes_per_wave(Boundary::Periodic);
    assert!((15.0..19.0).contains(&waves), "{waves}");
    let error = estimate(128, Quantity::Area, waves, 0.0, 1e-3).unwrap();
    assert!(!error.rough && error.relative > 1e-3 && error.relative < 0.05, "{error:?}");
    // fewer than eight nodes on the coarser grid
    assert!(estimate(128, Quantity::Area, 12.0, 0.0, 1e-3).unwrap().rough);
    // the coarser grid has fewer than four, does not resolve the adhesion, was not solved, or is not there: the waves
    // tell the error of the area, and nothing tells the errors of the others
    for (n, nodes_per_wave, mu_rho, tolerance) in
        [(128, 7.9, 0.0, 1e-3), (128, waves, 0.36, 1e-3), (128, waves, 0.0, 1e-1), (32, waves, 0.0, 1e-3)]
    {
        let error = estimate(n, Quantity::Area, nodes_per_wave, mu_rho, tolerance).unwrap();
        assert!(error.rough && error.order.is_none() && error.relative > 0.3 / nodes_per_wave.powi(2), "{error:?}");
        assert_eq!(estimate(n, Quantity::Gap, nodes_per_wave, mu_rho, tolerance), None);
    }
    // a surface without waves tells nothing by them, and neither do they where the grid itself does not resolve them, or the adhesion
    assert_eq!(estimate(32, Quantity::Area, f64::INFINITY, 0.0, 1e-3), None);
    assert_eq!(estimate(128, Quantity::Area, 3.9, 0.0, 1e-3), None);
    assert_eq!(estimate(128, Quantity::Area, waves, 0.51, 1e-3), None);
}

#[test]
fn what_cannot_be_had_is_refused_by_name() {
    let (surface, control) = (surface(32, 1), PRESSED);
    let refused = |settings, wanted| solve_to(settings, wanted, &surface, control).unwrap_err();
    for target in [0.0, -0.01, 1.0, f64::NAN, f64::INFINITY] {
        let error = refused(Settings::default(), Accuracy::new(target, Quantity::Area));
        assert!(matches!(error, Error::Value { name: "accuracy", .. }), "{error}");
    }
    let error = refused(Settings::default(), Accuracy::new(0.01, Quantity::Pressure));
    assert!(matches!(error, Error::Unsuited { what: "accuracy of the pressure", .. }), "{error}");
    assert!(
        Quantity::Gap.check(Control::MeanGap(0.1)).is_err() && Quantity::Gap.check(Control::Approach(0.1)).is_err()
    );
    assert!(Quantity::Pressure.check(Control::Force(0.1)).is_err());
    // a tolerance that contradicts it, and one that does not
    let wanted = Accuracy::new(0.05, Quantity::Area);
    let error = refused(Settings::default().tolerance(1e-2), wanted);
    assert!(matches!(error, Error::Value { name: "tolerance", value: 1e-2, .. }), "{error}");
    let mut solver = Solver::new(Settings::default().tolerance(1e-5));
    let found = wanted.solve(&mut solver, &surface, half_space, NoAdhesion, control).unwrap();
    assert!(found.solution.report.tolerance == 1e-5 && found.levels[0].relative_error <= 1e-5);
    assert_eq!(solver.settings.tolerance, Some(1e-5));

    // no grid that fits, told before: which would, and its memory
    let small = Accuracy::new(1e-6, Quantity::Area).memory(1e6);
    let mut operator = half_space(*surface.grid()).unwrap();
    let error = small.plan(&Solver::default(), &surface, &mut operator, &NoAdhesion, control).unwrap_err();
    let Error::Unaffordable { shape, bytes, available, affordable, .. } = error else { panic!("{error}") };
    assert!(shape.0 >= 4096 && bytes > 1e9 && available == 1e6 && affordable > 1e-3, "{shape:?} {bytes} {affordable}");
    let text = error_text(&small, &surface);
    assert!(text.contains("an accuracy of 1e-6 of the area takes about") && text.contains("GiB"), "{text}");
    // and on the way
    let (small, mut made) = (Accuracy::new(2e-3, Quantity::Area).memory(1e6), 0);
    let operator = |grid: Grid| {
        made = made.max(grid.shape().0);
        half_space(grid)
    };
    let found = small.solve(&mut Solver::default(), &surface, operator, NoAdhesion, control).unwrap();
    let (shape, bytes) = found.unaffordable.unwrap();
    assert_eq!(made, found.surface.grid().shape().0);
    assert!(!found.reached && shape.0 == 2 * found.surface.grid().shape().0 && bytes > 1e6);
    assert!(found.error.unwrap().relative > 2e-3);
}

fn error_text(wanted: &Accuracy, surface: &Surface) -> String {
    let mut operator = half_space(*surface.grid()).unwrap();
    wanted.plan(&Solver::default(), surface, &mut operator, &NoAdhesion, PRESSED).unwrap_err().to_string()
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

#[test]
fn what_is_known_on_one_grid_alone_is_not_refined() {
    let grid = Grid::square(32, 1.0).unwrap();
    let punch = surface_with_absent(grid, grid.sample(|x, y| if x.hypot(y) < 0.3 { 0.0 } else { f64::NAN })).unwrap();
    let found = Accuracy::new(0.01, Quantity::Pressure)
        .solve(&mut Solver::default(), &punch, free, NoAdhesion, Control::Approach(0.01))
        .unwrap();
    assert!(!found.reached && found.unaffordable.is_none());
    assert_eq!(found.surface.grid().shape(), (32, 32));
    // an observer that stops it leaves no finer grid either
    let wanted = Accuracy::new(0.01, Quantity::Area);
    let stop = |_: &Grid, _: &Iteration| std::ops::ControlFlow::Break(());
    let found =
        wanted.solve_observed(&mut Solver::default(), &surface(32, 1), half_space, NoAdhesion, PRESSED, stop).unwrap();
    assert_eq!((found.reached, found.solution.report.status), (false, Status::Stopped));
}

#[test]
fn a_flat_surface_needs_no_fine_grid() {
    for shape in [(1, 1), (5, 1), (1, 5), (8, 8)] {
        let flat = Surface::from_fn(Grid::new(shape, (1.0, 1.0)).unwrap(), |_, _| 0.3).unwrap();
        let found = solve(Accuracy::new(0.01, Quantity::Area), &flat, PRESSED);
        assert!(found.levels.len() <= 2, "{shape:?}");
        assert_eq!(found.reached, shape != (1, 1), "{shape:?}");
        assert_eq!(found.solution.report.contact_fraction, 1.0);
    }
}
