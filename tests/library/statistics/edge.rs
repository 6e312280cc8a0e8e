//! The edge of a contact between the nodes.

use super::*;

/// The error of the contact area by nodes and of the corrected one, each as mean and root mean square over loads,
/// relative to Hertz among periodic images.
fn area_errors(n: usize) -> [f64; 4] {
    let mut problem = sphere::<f64>(n, NoAdhesion);
    let periodic = Periodic::new(exact::Hertz::new(2.0, 1.0).unwrap(), 1.0).unwrap();
    let mut sums = [0.0; 4];
    for k in 0..24 {
        let load = 1e-4 * 1.1_f64.powi(k);
        let (_, found) = statistics(&mut problem, Control::MeanPressure(load));
        let area = PI * periodic.at_load(load).unwrap().contact().contact_radius().powi(2);
        let (nodes, corrected) = (found.contact_fraction / area - 1.0, found.corrected_contact_fraction / area - 1.0);
        let terms = [nodes, corrected, nodes * nodes, corrected * corrected];
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term / 24.0);
    }
    [sums[0], sums[1], sums[2].sqrt(), sums[3].sqrt()]
}

#[test]
fn the_fields_tell_the_area_of_hertz_between_the_nodes() {
    // radii of 3 to 7 nodes, and twice and four times as many: nodes are wrong in proportion to the spacing, the area
    // within the edge to its square or more closely
    for (n, bias, corrected) in [(64, 0.059, 3.2e-3), (128, 0.028, 8e-4), (256, 0.015, 3e-4)] {
        let errors = area_errors(n);
        assert!((errors[0] - bias).abs() < 1e-3, "{n}: {errors:?}");
        assert!(errors[1].abs() <= errors[3] && errors[3] < corrected, "{n}: {errors:?}");
        assert!(errors[3] < 0.04 * errors[2], "{n}: {errors:?}");
    }
}

/// The error of the position of straight edges, in spacings, as mean and largest over loads: waves along a direction of
/// the grid.
fn edge_errors(grid: Grid, (a, b): (u8, u8)) -> (f64, f64) {
    let [kx, ky] = [a, b].map(f64::from);
    let k = kx.hypot(ky);
    let height = |x: f64, y: f64| 0.02 / k * (2.0 * PI * (kx * x + ky * y + 0.013)).cos();
    let surface = Surface::from_fn(grid, height).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let wave = exact::WavyLine::new(0.02 / k, 1.0 / k, 1.0).unwrap();
    let edges = 2.0 * k * grid.shape().0 as f64;
    let errors = (0..10).map(|step| {
        let pressure = wave.closing_pressure() * (0.3 + 0.03 * f64::from(step));
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(pressure)).unwrap();
        let found = ContactStatistics::of(&solution).unwrap().corrected_contact_fraction;
        let exact = 2.0 * k * wave.at_mean_pressure(pressure).unwrap().half_width();
        (found - exact) * grid.nodes() as f64 / edges
    });
    errors.fold((0.0, 0.0), |(mean, most), error| (mean + 0.1 * error, f64::max(most, error.abs())))
}

#[test]
fn straight_edges_are_found_between_the_nodes_in_any_direction() {
    let [coarse, fine] = [64, 128].map(|n| Grid::square(n, 1.0).unwrap());
    let mut means = [0.0; 2];
    // a diagonal edge that were as far inside the contour as one along the nodes would be wrong by 0.015
    for (direction, mean_error, largest) in
        [((1, 0), 7e-3, 0.01), ((2, 1), 0.01, 0.015), ((1, 1), 6e-3, 0.02), ((1, 3), 0.015, 0.022)]
    {
        let (mean, most) = edge_errors(coarse, direction);
        assert!(mean.abs() < mean_error && most < largest, "{direction:?}: {mean} {most}");
        means = [means[0] + mean, means[1] + edge_errors(fine, direction).0];
    }
    // in spacings half as much: of second order
    assert!(means[1] < 0.65 * means[0], "{means:?}");
    let oblong = Grid::new((64, 40), (1.0, 1.0)).unwrap();
    let (mean, most) = edge_errors(oblong, (1, 0));
    assert!(most < 0.01, "{mean} {most}");
}

#[test]
fn lines_have_end_points_between_the_nodes() {
    let grid = Grid::line(256, 1.0).unwrap();
    let surface = Surface::wave(grid, 0.01, 3).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let (solution, found) = statistics(&mut problem, Control::MeanPressure(0.02));
    assert_eq!((found.perimeter, found.cluster_sizes.len()), (6.0, 3));
    let of_map = |solution: &Solution<f64>| ContactArea::of(solution.contact_map().view(), &grid).unwrap();
    assert_eq!(of_map(&solution).corrected_contact_fraction, found.contact_fraction);

    // what the nodes count too much at each end, and what is left of it
    let grid = Grid::line(128, 1.0).unwrap();
    let surface = Surface::wave(grid, 0.02, 1).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let wave = exact::WavyLine::new(0.02, 1.0, 1.0).unwrap();
    let excess = (0..100).map(|k| {
        let pressure = wave.closing_pressure() * (0.3 + 0.002 * f64::from(k));
        let (_, found) = statistics(&mut problem, Control::MeanPressure(pressure));
        let width = 2.0 * wave.at_mean_pressure(pressure).unwrap().half_width();
        let left = (found.corrected_contact_fraction - width) * 128.0 / found.perimeter;
        assert!(left.abs() < 6e-3, "{left}");
        (found.contact_fraction - width) * 128.0 / found.perimeter
    });
    let mean = excess.sum::<f64>() / 100.0;
    assert!((mean - 0.19).abs() < 0.02, "{mean}");
}

#[test]
fn the_edge_of_a_contact_with_a_wall_that_gives_is_found_between_the_nodes() {
    // from a wall that gives more than a spacing of the half-space to one that gives less
    for stiffness in [20.0, 200.0, 2000.0] {
        let width = |n: usize| {
            let grid = Grid::line(n, 1.0).unwrap();
            let surface = Surface::wave(grid, 0.02, 1).unwrap();
            let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
            let settings = Settings::default().tolerance(1e-8);
            let mut solver = Solver { settings, constraint: Penalty::new(stiffness).unwrap() };
            let solution = solver.solve(&mut problem, Control::MeanPressure(0.02)).unwrap();
            ContactStatistics::of(&solution).unwrap().corrected_contact_fraction
        };
        let exact = width(4096);
        for n in [60, 64, 68, 72] {
            let error = 0.5 * n as f64 * (width(n) - exact);
            assert!(error.abs() < 0.06, "{stiffness} {n}: {error}");
        }
    }
}
