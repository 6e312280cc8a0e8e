//! What the edge of a contact tells of the error.

use super::*;

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
