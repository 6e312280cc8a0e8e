//! Conductance against the formulas of a circle and of an ellipse.

use approx::assert_relative_eq;
use asperity::stability::ContactStiffness;
use asperity::{Amplitude, Boussinesq, Control, Grid, NoAdhesion, Problem, SelfAffine, Solver, Surface, Westergaard};
use asperity_flow::Conductance;
use ndarray::Array2;

const MODULUS: f64 = 3.0;

/// Holm's conductance of the spot of a flat punch, where `inside` is below 1.
fn of_punch(n: usize, inside: impl Fn(f64, f64) -> f64) -> (Conductance, ContactStiffness) {
    let grid = Grid::square(n, 1.0).unwrap();
    // so far below that it stays apart
    let punch = Surface::from_fn(grid, |x, y| if inside(x, y) <= 1.0 { 0.0 } else { -1.0 }).unwrap();
    let mut problem = Problem::new(&punch, Boussinesq::<f64>::new(grid, MODULUS).unwrap(), NoAdhesion).unwrap();
    let solution = Solver::default().solve(&mut problem, Control::Approach(0.01)).unwrap();
    let stiffness = ContactStiffness::of(&mut problem, &solution).unwrap();
    (Conductance::from_stiffness(&stiffness, MODULUS, (0.4, 0.6)).unwrap(), stiffness)
}

#[test]
fn a_circle_conducts_as_holm_says_and_an_ellipse_by_its_integral() {
    // the outline is known to a part of a node: a radius by the area
    let n = 128;
    let area = |a: f64, b: f64| {
        let inside = |k: usize, c: f64| (k as f64 - (n / 2) as f64) / n as f64 / c;
        let nodes = (0..n * n).filter(|k| inside(k / n, a).powi(2) + inside(k % n, b).powi(2) <= 1.0).count();
        nodes as f64 / (n * n) as f64
    };
    let a = 0.3;
    let (circle, _) = of_punch(n, |x, y| (x * x + y * y) / (a * a));
    let radius = (area(a, a) / std::f64::consts::PI).sqrt();
    assert_relative_eq!(circle.whole, 4.0 * radius, max_relative = 0.01);
    assert_relative_eq!(circle.per_area, circle.whole, max_relative = 1e-12);

    let (a, b) = (0.4, 0.2);
    let (ellipse, _) = of_punch(n, |x, y| (x / a).powi(2) + (y / b).powi(2));
    // πa/K(e) with K(√(1 − b²/a²)) = K(√0.75) = 2.1565156474996432, over (ρ₁ + ρ₂)/2
    let shrunk = (area(a, b) / (std::f64::consts::PI * a * b)).sqrt();
    let exact = 2.0 * std::f64::consts::PI * a * shrunk / 2.156_515_647_499_643;
    assert_relative_eq!(ellipse.whole, exact, max_relative = 0.01);
}

#[test]
fn resistivities_and_moduli_are_checked() {
    let (_, stiffness) = of_punch(16, |x, y| (x * x + y * y) / 0.09);
    let refused = |modulus, resistivities| {
        Conductance::from_stiffness(&stiffness, modulus, resistivities).unwrap_err().to_string()
    };
    assert!(refused(0.0, (1.0, 1.0)).contains("contact modulus is 0"));
    assert!(refused(1.0, (-1.0, 1.0)).contains("resistivity of the first body is -1"));
    assert!(refused(1.0, (1.0, f64::NAN)).contains("resistivity of the second body"));
    assert!(refused(1.0, (0.0, 0.0)).contains("sum of both resistivities is 0"));
    // one body may conduct perfectly
    assert!(Conductance::from_stiffness(&stiffness, 1.0, (0.0, 1.0)).unwrap().whole > 0.0);
    let mut adhesive = stiffness;
    adhesive.pressure_per_length = -1.0;
    assert!(
        Conductance::from_stiffness(&adhesive, 1.0, (1.0, 1.0))
            .unwrap_err()
            .to_string()
            .contains("contact stiffness is -1")
    );
}

#[test]
fn spots_conduct_as_the_stiffness_of_their_solution_says() {
    let grid = Grid::square(64, 1.0).unwrap();
    let rough = SelfAffine::default().k_s(8.0).amplitude(Amplitude::RmsSlope(0.1)).seed(2).surface(grid).unwrap();
    let mut problem = Problem::new(&rough, Westergaard::<f64>::new(grid, MODULUS).unwrap(), NoAdhesion).unwrap();
    for pressure in [0.01, 0.1] {
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(pressure)).unwrap();
        let stiffness = ContactStiffness::of(&mut problem, &solution).unwrap();
        let of_stiffness = Conductance::from_stiffness(&stiffness, MODULUS, (1.0, 3.0)).unwrap();
        let contact = solution.gap.mapv(|gap| gap <= 0.0);
        let of_spots = Conductance::of_spots(contact.view(), grid, true, (1.0, 3.0)).unwrap();
        assert_relative_eq!(of_spots.per_area, of_stiffness.per_area, max_relative = 1e-5);
        // the grid leaves more than the solve
        assert!(of_spots.relative_error < 1e-5 && of_stiffness.relative_error > of_spots.relative_error);
    }
    // nothing, and all of it
    let none = Conductance::of_spots(Array2::from_elem((64, 64), false).view(), grid, true, (1.0, 3.0));
    let all = Conductance::of_spots(Array2::from_elem((64, 64), true).view(), grid, true, (1.0, 3.0));
    assert_eq!((none.unwrap().per_area, all.unwrap().per_area), (0.0, f64::INFINITY));
}

/// ∫ dA/r over a rectangle of sides `2a` and `2b` around a place at a distance of (x, y) from its middle.
fn potential((x, y): (f64, f64), (a, b): (f64, f64)) -> f64 {
    let part = |u: f64, v: f64| if u == 0.0 { 0.0 } else { u * (v / u.abs()).asinh() };
    let corner = |u: f64, v: f64| part(u, v) + part(v, u);
    corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b) + corner(x - a, y - b)
}

/// The conductance between two half-spaces through spots at one potential, by Gaussian elimination: a current density j
/// on the spots makes the potentials ρ/2π ∫ j dA/r in a body of resistivity ρ, of opposite signs in both.
fn of_laplace(contact: &Array2<bool>, grid: Grid, (first, second): (f64, f64)) -> f64 {
    let (dx, dy) = grid.spacing();
    let spots: Vec<_> = contact.indexed_iter().filter(|(_, contact)| **contact).map(|(node, _)| node).collect();
    let away = |a: usize, b: usize, spacing: f64| (a as f64 - b as f64) * spacing;
    let mut rows: Vec<Vec<f64>> = spots
        .iter()
        .map(|to| {
            let from = spots.iter().map(|from| (away(to.0, from.0, dx), away(to.1, from.1, dy)));
            let per_current = (first + second) / std::f64::consts::TAU;
            from.map(|away| per_current * potential(away, (dx / 2.0, dy / 2.0))).chain([1.0]).collect()
        })
        .collect();
    for k in 0..rows.len() {
        let (above, below) = rows.split_at_mut(k + 1);
        for row in below {
            let share = row[k] / above[k][k];
            row[k..].iter_mut().zip(&above[k][k..]).for_each(|(own, pivot)| *own -= share * pivot);
        }
    }
    let n = rows.len();
    let mut current = vec![0.0; n];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|i| rows[k][i] * current[i]).sum();
        current[k] = (rows[k][n] - known) / rows[k][k];
    }
    current.iter().sum::<f64>() * dx * dy
}

#[test]
fn the_stiffness_conducts_as_a_dense_solution_of_laplace_says() {
    let grid = Grid::new((24, 20), (1.2, 0.9)).unwrap();
    let resistivities = (0.7, 1.9);
    let rough = SelfAffine::default().k_s(6.0).amplitude(Amplitude::RmsSlope(0.2)).seed(4).surface(grid).unwrap();
    let mut problem = Problem::new(&rough, Boussinesq::<f64>::new(grid, MODULUS).unwrap(), NoAdhesion).unwrap();
    for pressure in [0.005, 0.05] {
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(pressure)).unwrap();
        let stiffness = ContactStiffness::of(&mut problem, &solution).unwrap();
        let conductance = Conductance::from_stiffness(&stiffness, MODULUS, resistivities).unwrap();
        let contact = solution.gap.mapv(|gap| gap <= 0.0);
        let spots = contact.iter().filter(|contact| **contact).count();
        assert!(spots > 10 && spots < 240, "{spots}");
        // both are of a constant density on each node, at the potential of its middle: what is left is the solver's
        assert_relative_eq!(conductance.whole, of_laplace(&contact, grid, resistivities), max_relative = 1e-5);
    }
}
