//! Contact statistics on solutions with a known contact.

mod edge;

use std::f64::consts::PI;

use asperity::adhesion::Varying;
use asperity::contact::{ContactArea, ContactStatistics, PressureDistribution};
use asperity::exact::{self, Periodic};
use asperity::*;
use asperity_maps::surface_with_absent;
use ndarray::Array2;
use oracles::{rough, sphere};

fn statistics<T: Real>(problem: &mut Problem<T>, control: Control) -> (Solution<T>, ContactStatistics) {
    let solution = Solver::default().solve(problem, control).unwrap();
    let statistics = ContactStatistics::of(&solution).unwrap();
    (solution, statistics)
}

/// A disc of contact, as nodes in it see it.
fn disc(grid: &Grid, radius: f64) -> Solution<f64> {
    let mut problem =
        Problem::new(&Surface::wave(*grid, 0.1, 1).unwrap(), Westergaard::new(*grid, 1.0).unwrap(), NoAdhesion)
            .unwrap();
    let settings = Settings::default().max_iterations(0);
    let mut solution = Solver::new(settings).solve(&mut problem, Control::MeanGap(1.0)).unwrap();
    solution.gap = grid.sample(|x, y| (x.hypot(y) - radius).max(0.0));
    solution.contact_pressure = grid.sample(|x, y| (radius - x.hypot(y)).max(0.0));
    solution
}

#[test]
fn the_perimeter_of_a_disc_is_that_of_its_square() {
    // along the sides of the cells a circle is 8 radii around
    for (shape, lengths) in [((256, 256), (1.0, 1.0)), ((256, 128), (1.0, 1.0)), ((200, 300), (2.0, 1.0))] {
        let grid = Grid::new(shape, lengths).unwrap();
        let solution = disc(&grid, 0.3);
        let found = ContactStatistics::of(&solution).unwrap();
        let (dx, dy) = grid.spacing();
        assert!((found.perimeter - 2.4).abs() <= 4.0 * dx.max(dy), "{}", found.perimeter);
        let area = found.contact_fraction * lengths.0 * lengths.1;
        assert!((area / (0.09 * PI) - 1.0).abs() < 0.01);
        // of a map alone the perimeter tells the excess
        let of_map = ContactArea::of(solution.contact_map().view(), &grid).unwrap();
        assert_eq!((of_map.contact_nodes, of_map.perimeter), (found.contact_nodes, found.perimeter));
        let share = (PI - 1.0 + 2.0_f64.ln()) / 24.0;
        let expected = share * found.perimeter * dx / (lengths.0 * lengths.1);
        if dx == dy {
            assert!((of_map.contact_fraction - of_map.corrected_contact_fraction - expected).abs() < 1e-9);
        }
        assert_eq!(found.cluster_sizes, [found.contact_nodes]);
    }
}

#[test]
fn the_nodes_in_contact_are_those_of_the_report_whatever_the_constraint() {
    let mut problem = rough::<f64>(64, 16, NoAdhesion);
    let control = Control::MeanPressure(0.1);
    let settings = Settings::default();
    let projected = Solver::new(settings).solve(&mut problem, control).unwrap();
    let constraint = Penalty::new(5000.0).unwrap();
    let soft = Solver { settings, constraint }.solve(&mut problem, control).unwrap();
    let hard = Solver { settings, constraint: Uzawa::new(500.0).unwrap() }.solve(&mut problem, control).unwrap();
    for solution in [projected, soft, hard] {
        let found = ContactStatistics::of(&solution).unwrap();
        assert_eq!(found.contact_nodes, solution.report.contact_nodes);
        assert_eq!(found.contact_fraction, solution.report.contact_fraction);
        assert_eq!(found.cluster_sizes.iter().sum::<usize>(), found.contact_nodes);
        assert!(found.cluster_sizes.is_sorted_by(|a, b| a >= b) && found.cluster_sizes.len() > 5);
        assert!(found.repulsive_fraction <= found.contact_fraction);
        assert!(found.repulsive_fraction > 0.99 * found.contact_fraction);
        assert_eq!(found.attractive_fraction, 0.0);
        let distribution = PressureDistribution::of_contact_pressure(&solution, 50).unwrap();
        assert!((distribution.integral() - found.contact_fraction).abs() < 1e-14);
        let middles = distribution.edges.windows(2).map(|edges| 0.5 * (edges[0] + edges[1]));
        let width = distribution.edges[1];
        let mean: f64 = middles.zip(&distribution.density).map(|(p, density)| p * density * width).sum();
        assert!((mean / solution.report.mean_contact_pressure - 1.0).abs() < 0.01);
    }
}

#[test]
fn adhesion_divides_the_surface_in_three() {
    let single = Exponential::new(2e-4, 4e-3).unwrap();
    let (solution, found) = statistics(&mut rough::<f32>(64, 16, single), Control::MeanGap(0.02));
    let reach = 4e-3 * 100.0_f32.ln();
    let near = solution.gap.iter().filter(|g| **g > 0.0 && **g < reach).count();
    assert!((found.attractive_fraction * 4096.0 - near as f64).abs() <= 1.0 && near > 100);

    let law = MaugisDugdale::new(1e-4, 4e-3).unwrap();
    let (solution, found) = statistics(&mut sphere::<f64>(128, law), Control::MeanGap(0.042));
    let near = solution.gap.iter().filter(|g| **g > 0.0 && **g < 4e-3).count();
    assert_eq!(found.attractive_fraction, near as f64 / 16384.0);
    let sum = found.contact_fraction + found.attractive_fraction + found.apart_fraction;
    assert!((sum - 1.0).abs() < 1e-15);
    // the ring c² − a² of the exact solution
    let exact = exact::MaugisDugdale::new(2.0, 1.0, 1e-4, 4e-3).unwrap();
    let contact = Periodic::new(exact, 1.0).unwrap().at_mean_gap(0.042, -1.0 / 24.0).unwrap();
    let (a, c) = (contact.contact().contact_radius(), contact.contact().adhesion_radius());
    assert!((found.attractive_fraction / (PI * (c * c - a * a)) - 1.0).abs() < 0.1);

    let distribution = PressureDistribution::of_pressure(&solution, 40).unwrap();
    assert!((distribution.integral() - 1.0).abs() < 1e-14);
    let least = solution.pressure.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(distribution.edges[0] == least && least < -1e-2);
    // all of the ring is under the law's traction, within a bin of it
    let traction = distribution.edges.iter().position(|edge| *edge > -1e-4 / 4e-3).unwrap();
    let width = distribution.edges[1] - distribution.edges[0];
    let there: f64 = distribution.density[traction.saturating_sub(2)..=traction].iter().map(|d| d * width).sum();
    assert!(there > 0.9 * found.attractive_fraction, "{there} {found:?}");
}

#[test]
fn where_the_law_alone_repels_the_area_is_that_of_the_nodes_that_it_presses() {
    // counted nodes are right in the mean over loads: pressure and gap have no kink there
    let law = LennardJones::new(1e-3, 4e-3).unwrap();
    let mut problem = sphere::<f64>(128, law);
    let loads: Vec<f64> = (0..12).map(|k| 2e-3 * 1.1_f64.powi(k)).collect();
    let excess = |load: &f64| {
        let mut solver = Solver { settings: Settings::default(), constraint: NoWall };
        let solution = solver.solve(&mut problem, Control::MeanPressure(*load)).unwrap();
        let area = ContactArea::of_solution(&solution).unwrap();
        assert!(area.contact_nodes > 100 && solution.report.status == Status::Converged);
        area.corrected_contact_fraction / area.contact_fraction - 1.0
    };
    let mean = loads.iter().map(excess).sum::<f64>() / loads.len() as f64;
    assert!(mean.abs() < 0.02, "{mean}");
}

#[test]
fn fields_that_no_solve_has_made_have_an_area_within_the_surface() {
    let grid = Grid::square(4, 1.0).unwrap();
    let area = |gap: &dyn Fn(usize) -> f64, pressure: f64| {
        let field = |of: &dyn Fn(usize) -> f64| Array2::from_shape_fn((4, 4), |(i, j)| of((i + j) % 2));
        let pressure = field(&|k| if k == 0 { pressure } else { 0.0 });
        let body = (Boundary::Periodic, 1.0);
        let of = ContactStatistics::of_fields(field(gap).view(), pressure.view(), &grid, body, &NoAdhesion).unwrap();
        of.corrected_contact_fraction
    };
    // every other node, deep in a wall that gives, far from one, and under a tension that no wall holds
    for (inside, outside, pressure) in [(-1.0, 1e-9, 1e-9), (0.0, 1.0, 1.0), (0.0, 1.0, -1.0), (0.0, 0.43, -1.0)] {
        let area = area(&|k| if k == 0 { inside } else { outside }, pressure);
        assert!((0.0..=1.0).contains(&area), "{inside} {outside} {pressure}: {area}");
    }
}

#[test]
fn the_area_is_the_same_bits_however_the_fields_lie() {
    // about a third of the nodes in contact, in clusters of all shapes that meet across diagonals, too
    let grid = Grid::new((48, 36), (1.0, 0.9)).unwrap();
    let level = grid.sample(|x, y| (74.0 * x).sin() * (58.0 * y).cos() + (61.0 * x * y + 3.0 * y).sin() - 0.3);
    let area = |level: &Array2<f64>, grid: &Grid| {
        let (gap, pressure) = (level.mapv(|l| (-l).max(0.0)), level.mapv(|l| 30.0 * l.max(0.0)));
        let body = (Boundary::Periodic, 1.0);
        let found = ContactStatistics::of_fields(gap.view(), pressure.view(), grid, body, &NoAdhesion).unwrap();
        assert!(found.corrected_contact_fraction < found.contact_fraction && found.cluster_sizes.len() > 10);
        found.corrected_contact_fraction
    };
    let expected = area(&level, &grid);
    let mirrored = |axis| {
        let mut other = level.clone();
        other.invert_axis(ndarray::Axis(axis));
        other
    };
    let rolled = Array2::from_shape_fn((48, 36), |(i, j)| level[[(i + 11) % 48, (j + 25) % 36]]);
    for other in [mirrored(0), mirrored(1), rolled] {
        assert_eq!(area(&other, &grid), expected);
    }
    let transposed = level.t().as_standard_layout().to_owned();
    assert_eq!(area(&transposed, &Grid::new((36, 48), (0.9, 1.0)).unwrap()), expected);
    // without a modulus the map alone tells it
    let (gap, pressure) = (level.mapv(|l| (-l).max(0.0)), level.mapv(|l| 30.0 * l.max(0.0)));
    let body = (Boundary::Periodic, 0.0);
    let found = ContactStatistics::of_fields(gap.view(), pressure.view(), &grid, body, &NoAdhesion).unwrap();
    let map = gap.mapv(|gap| gap <= 0.0);
    let of_map = ContactArea::of(map.view(), &grid).unwrap().corrected_contact_fraction;
    assert_eq!(found.corrected_contact_fraction, of_map);
    // where the surface ends, or the window, there is no edge
    let holed = surface_with_absent(grid, grid.sample(|x, y| if x.hypot(y) < 0.3 { 0.0 } else { f64::NAN })).unwrap();
    let mut punch = Problem::new(&holed, Boussinesq::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let solution = Solver::default().solve(&mut punch, Control::Approach(0.01)).unwrap();
    let found = ContactStatistics::of(&solution).unwrap();
    assert_eq!((found.contact_fraction, found.corrected_contact_fraction), (1.0, 1.0));
    let flat = Surface::from_fn(grid, |_, _| 0.0).unwrap();
    let mut window = Problem::new(&flat, Boussinesq::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let solution = Solver::default().solve(&mut window, Control::Approach(0.01)).unwrap();
    assert_eq!(ContactArea::of_solution(&solution).unwrap().corrected_contact_fraction, 1.0);
}

#[test]
fn full_contact_and_none_have_statistics() {
    let mut problem = rough::<f64>(32, 8, NoAdhesion);
    let (solution, full) = statistics(&mut problem, Control::MeanGap(0.0));
    assert_eq!((full.contact_fraction, full.corrected_contact_fraction, full.perimeter), (1.0, 1.0, 0.0));
    assert_eq!((&full.cluster_sizes[..], full.apart_fraction), (&[1024][..], 0.0));
    assert!((PressureDistribution::of_contact_pressure(&solution, 7).unwrap().integral() - 1.0).abs() < 1e-14);
    let (solution, none) = statistics(&mut problem, Control::MeanGap(1.0));
    assert_eq!((none.contact_fraction, none.corrected_contact_fraction, none.perimeter), (0.0, 0.0, 0.0));
    assert_eq!((none.cluster_sizes.len(), none.apart_fraction), (0, 1.0));
    let distribution = PressureDistribution::of_contact_pressure(&solution, 4).unwrap();
    assert_eq!((distribution.edges, distribution.density), (vec![0.0, 0.25, 0.5, 0.75, 1.0], vec![0.0; 4]));
}

#[test]
fn a_few_pressures_far_above_all_others_are_in_a_wider_bin() {
    let gap = Array2::zeros((64, 64));
    let mut pressure = Array2::from_shape_fn((64, 64), |(i, j)| (i * 64 + j + 1) as f64 / 4096.0);
    let density = |pressure: &Array2<f64>, bins| PressureDistribution::of_fields(gap.view(), pressure.view(), bins);
    let plain = density(&pressure, 8).unwrap();
    assert_eq!(plain.edges[..3], [0.0, 0.125, 0.25]);
    (pressure[[3, 5]], pressure[[40, 7]]) = (30.0, 100.0);
    let spiky = density(&pressure, 9).unwrap();
    assert!((spiky.integral() - 1.0).abs() < 1e-14);
    assert_eq!((spiky.edges.len(), spiky.edges[8], spiky.edges[9]), (10, 1.0, 100.0));
    assert!(plain.density.iter().zip(&spiky.density).all(|(one, other)| (one - other).abs() < 0.02 * one));
    assert_eq!(density(&pressure, 1).unwrap().edges, [0.0, 100.0]);
}

#[test]
fn statistics_refuse_what_does_not_fit() {
    let mut problem = sphere::<f64>(16, NoAdhesion);
    let mut solution = Solver::default().solve(&mut problem, Control::MeanGap(0.04)).unwrap();
    for bins in [0, usize::MAX] {
        let refused = PressureDistribution::of_pressure(&solution, bins);
        assert!(matches!(refused, Err(Error::Value { name: "number of bins", .. })));
    }
    solution.contact_pressure[[3, 4]] = f64::NAN;
    let refused = PressureDistribution::of_contact_pressure(&solution, 3);
    assert!(matches!(refused, Err(Error::NotFinite { name: "contact pressure", first: (3, 4), .. })));
    solution.contact_pressure = Array2::zeros((4, 4));
    assert!(ContactStatistics::of(&solution).is_err());
    assert!(PressureDistribution::of_contact_pressure(&solution, 3).is_err());
    // a uniform pressure has a bin around it
    solution.pressure.fill(-2.0);
    let uniform = PressureDistribution::of_pressure(&solution, 1).unwrap();
    assert_eq!((uniform.edges, uniform.density), (vec![-3.0, -1.0], vec![0.5]));
}

#[test]
fn patches_share_out_the_contact_by_their_work_of_adhesion() {
    fn patched<T: Real>(works: usize) {
        let grid = Grid::square(48, 1.0).unwrap();
        let surface = Surface::wave_2d(grid, 0.01, 2).unwrap();
        // stripes along y, stripes without adhesion first
        let work = grid.sample(|x, _| 2e-5 * ((works as f64 * (x + 0.5)).floor() / works as f64));
        let law = Varying::new(Exponential::new(2e-5, 3e-3).unwrap(), work.view()).unwrap();
        let mut problem = Problem::new(&surface, Westergaard::<T>::new(grid, 1.0).unwrap(), law).unwrap();
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(5e-3)).unwrap();
        let found = ContactStatistics::of(&solution).unwrap();
        if works > 16 {
            assert!(found.patches.is_empty());
            return;
        }
        assert_eq!(found.patches.len(), works);
        let contact = solution.contact_map();
        for (k, patch) in found.patches.iter().enumerate() {
            let expected = 2e-5 * k as f64 / works as f64;
            assert!((patch.work_of_adhesion - expected).abs() <= 4.0 * T::epsilon().widen() * 2e-5);
            let own = |&(at, _): &((usize, usize), &bool)| (work[at] - expected).abs() < 1e-9;
            let all = contact.indexed_iter().filter(own).count() as f64;
            let touching = contact.indexed_iter().filter(own).filter(|(_, touches)| **touches).count() as f64;
            assert_eq!((patch.area_fraction, patch.contact_fraction), (all / 2304.0, touching / all));
        }
        assert_eq!(found.patches[0].attractive_fraction, 0.0);
        let total = |share: fn(&contact::Patch) -> f64| -> f64 {
            found.patches.iter().map(|patch| patch.area_fraction * share(patch)).sum()
        };
        assert!((total(|patch| patch.contact_fraction) - found.contact_fraction).abs() < 1e-12);
        assert!((total(|patch| patch.attractive_fraction) - found.attractive_fraction).abs() < 1e-12);
    }
    patched::<f64>(2);
    patched::<f32>(3);
    patched::<f64>(16);
    patched::<f64>(17);
    // one work of adhesion for all has no patches
    let mut problem = sphere::<f64>(32, Exponential::new(1e-5, 1e-2).unwrap());
    assert!(statistics(&mut problem, Control::MeanGap(0.04)).1.patches.is_empty());
}

#[test]
fn the_order_of_the_fields_in_memory_makes_no_difference() {
    let mut problem = rough::<f64>(32, 8, Exponential::new(1e-3, 1e-2).unwrap());
    let (mut solution, found) = statistics(&mut problem, Control::MeanPressure(0.1));
    for field in [&mut solution.gap, &mut solution.contact_pressure] {
        *field = field.t().as_standard_layout().into_owned().reversed_axes();
    }
    assert_eq!(ContactStatistics::of(&solution), Ok(found));
}
