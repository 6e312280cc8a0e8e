//! The free half-space, absent nodes, and what is held: forces, approaches and springs.

use asperity::exact::{Hertz, Sphere};
use asperity::*;
use std::f64::consts::PI;

/// A paraboloid of radius 2 in a window of side 0.4 on a half-space of unit modulus.
fn sphere<L: AdhesionLaw<f64>>(n: usize, law: L) -> Problem<f64, Boussinesq<f64>, L> {
    let grid = Grid::square(n, 0.4).unwrap();
    Problem::new(&Surface::paraboloid(grid, 2.0).unwrap(), Boussinesq::new(grid, 1.0).unwrap(), law).unwrap()
}

#[test]
fn hertz_by_force_and_by_approach() {
    for n in [33, 64, 128] {
        let exact = Hertz::new(2.0, 1.0).unwrap().at_load(1e-3).unwrap();
        let mut problem = sphere(n, NoAdhesion);
        let by_force = Solver::default().solve(&mut problem, Control::Force(1e-3)).unwrap();
        let report = &by_force.report;
        let cell = 0.16 / (n * n) as f64;
        let area = (report.contact_nodes as f64 * cell / PI).sqrt();
        println!(
            "{n}: {} {} applications, δ {:.6} of {:.6}, a {:.5} of {:.5}, p {:.5} of {:.5}, F {:e} le {:e} edge {:?}",
            report.status,
            report.operator_applications,
            report.approach.unwrap(),
            exact.approach(),
            area,
            exact.contact_radius(),
            by_force.pressure.iter().fold(0.0f64, |a, &b| a.max(b)),
            exact.pressure(0.0),
            by_force.pressure.sum() * cell / 1e-3 - 1.0,
            report.load_error,
            report.edge_traction
        );
        let by = Solver::default().solve(&mut problem, Control::Approach(report.approach.unwrap())).unwrap().report;
        println!(
            "   by approach: {} {} F {:.8e} {:.2e}",
            by.status, by.operator_applications, by.normal_force, by.load_error
        );
        let k = 0.3;
        let by = Solver::default()
            .solve(&mut problem, Control::Spring { stiffness: k, rest: report.approach.unwrap() + 1e-3 / k })
            .unwrap()
            .report;
        println!(
            "   by spring: {} {} F {:.8e} {:.2e}",
            by.status, by.operator_applications, by.normal_force, by.load_error
        );
    }
}
