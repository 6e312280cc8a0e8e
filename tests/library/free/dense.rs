//! The states of the free half-space next to dense matrices.

use super::*;

/// Hard walls: every control finds the state of the dense matrix at the same rigid shift.
#[test]
fn contact_without_adhesion_is_that_of_the_dense_matrix_under_every_control() {
    for surface in [bumps((24, 20)), bumps((7, 19)), bumps_with_holes((24, 20))] {
        let (love, faces) = (Dense::free(surface.grid(), 1.0), faces(&surface));
        let pressed = Dense::free(surface.grid(), 1.0).facing(&faces);
        let heights = surface.heights().as_slice().unwrap();
        let facing: Vec<f64> = pressed.faces.iter().map(|&node| heights[node]).collect();
        let top = heights.iter().zip(&faces).filter(|(_, faces)| **faces).fold(f64::MIN, |top, (h, _)| top.max(*h));
        let cell = surface.grid().spacing().0 * surface.grid().spacing().1;
        for approach in [0.004, 0.03] {
            let held = Held::Spring { stiffness: pressed.rigid, rest: top - approach };
            let start: Vec<f64> = facing.iter().map(|h| (top - approach - h).max(0.0)).collect();
            let gap =
                pressed.equilibrium(&facing, held, &|_, _| [0.0; 2], Some(f64::INFINITY), &start).expect("no cycle");
            let u: Vec<f64> = gap.iter().zip(&facing).map(|(g, h)| g + h).collect();
            let mut expected = vec![0.0; heights.len()];
            let full = pressed.full(&u, held.pressure(pressed.shift(&u)));
            pressed.faces.iter().zip(full).for_each(|(&node, p)| expected[node] = p);
            let gap: Vec<f64> =
                love.displacement(&expected).iter().zip(heights).map(|(u, h)| u + top - approach - h).collect();
            let force = cell * expected.iter().sum::<f64>();
            let mut problem = problem(&surface, NoAdhesion);
            let area = surface.grid().lengths().0 * surface.grid().lengths().1;
            for control in [
                Control::Approach(approach),
                Control::Force(force),
                Control::MeanPressure(force / area),
                Control::Spring { stiffness: 0.2, rest: approach + force / 0.2 },
                Control::Spring { stiffness: 50.0, rest: approach + force / 50.0 },
            ] {
                let found = solve(&mut problem, control, 1e-9);
                for (((g, p), (expected_gap, expected)), faces) in
                    found.gap.iter().zip(&found.pressure).zip(gap.iter().zip(&expected)).zip(&faces)
                {
                    let gap = if *faces { *g } else { 0.0 };
                    let expected_gap = if *faces { *expected_gap } else { 0.0 };
                    assert!((gap - expected_gap).abs() < 1e-6 * approach, "{control:?}: {gap} {expected_gap}");
                    assert!((p - expected).abs() < 1e-5 * largest(&found.pressure), "{control:?}: {p} {expected}");
                    assert!(*faces || *p == 0.0 && *g == f64::INFINITY);
                }
                let report = &found.report;
                assert!((report.normal_force / force - 1.0).abs() < 1e-6, "{control:?}");
                assert!((report.approach.unwrap() / approach - 1.0).abs() < 1e-6, "{control:?}");
                assert!((report.mean_pressure * area / force - 1.0).abs() < 1e-6);
                assert!((report.net_pressure / report.mean_pressure - 1.0).abs() < 1e-6);
                assert_eq!(report.absent_nodes, faces.iter().filter(|faces| !**faces).count());
                let energy = 0.5 * cell / area
                    * love.displacement(&expected).iter().zip(&expected).map(|(u, p)| u * p).sum::<f64>();
                assert!((report.elastic_energy / energy - 1.0).abs() < 1e-5, "{control:?}");
            }
        }
    }
}

/// With adhesion there may be several equilibria: what is found is one of them, by the dense matrix.
#[test]
fn contact_with_adhesion_is_an_equilibrium_of_the_dense_matrix_under_every_control() {
    fn check(surface: &Surface, law: impl AdhesionLaw<f64> + Copy + 'static, traction: f64) {
        let (love, faces) = (Dense::free(surface.grid(), 1.0), faces(surface));
        let heights = surface.heights();
        let top = heights.iter().zip(&faces).filter(|(_, faces)| **faces).fold(f64::MIN, |top, (h, _)| top.max(*h));
        let mut problem = problem(surface, law);
        for control in [
            Control::Approach(0.01),
            Control::Approach(-0.02),
            Control::Force(5e-3),
            Control::Force(-1e-4),
            Control::Spring { stiffness: 0.1, rest: 0.01 },
        ] {
            let found = solve(&mut problem, control, 1e-9);
            let shift = top - found.report.approach.unwrap();
            let u = love.displacement(found.pressure.as_slice().unwrap());
            for ((((g, p), u), h), faces) in found.gap.iter().zip(&found.pressure).zip(&u).zip(heights).zip(&faces) {
                if *faces {
                    assert!((u + shift - h - g).abs() < 1e-6 * 0.05, "{control:?}: {} {g}", u + shift - h);
                    let excess = p + law.traction(*g);
                    assert!(
                        excess >= -1e-5 * traction && excess * g <= 1e-7 * traction,
                        "{control:?}: {excess} at {g}"
                    );
                }
            }
            let cell = surface.grid().spacing().0 * surface.grid().spacing().1;
            let carried = cell * found.pressure.sum();
            assert!((carried - found.report.normal_force).abs() < 1e-6 * cell * found.pressure.mapv(f64::abs).sum());
        }
    }
    for surface in [bumps((24, 20)), bumps_with_holes((24, 20))] {
        check(&surface, Exponential::new(1e-3, 2e-2).unwrap(), 5e-2);
        check(&surface, MaugisDugdale::new(1e-3, 2e-2).unwrap(), 5e-2);
    }
}

#[test]
fn springs_of_the_wall_come_to_the_same_contact() {
    for surface in [bumps((24, 20)), bumps_with_holes((24, 20))] {
        let control = Control::Force(4e-3);
        let rigid = solve(&mut problem(&surface, NoAdhesion), control, 1e-9);
        let mut solver = Solver { settings: Settings::default(), constraint: Uzawa::new(50.0).unwrap() };
        let augmented = solver.solve(&mut problem(&surface, NoAdhesion), control).unwrap();
        assert_eq!(augmented.report.status, Status::Converged);
        assert_eq!(augmented.report.contact_nodes, rigid.report.contact_nodes);
        let error = largest(&(&augmented.contact_pressure - &rigid.contact_pressure));
        assert!(error < 1e-3 * largest(&rigid.contact_pressure), "{error}");
        let mut solver = Solver { settings: Settings::default(), constraint: Penalty::new(5e4).unwrap() };
        let soft = solver.solve(&mut problem(&surface, NoAdhesion), control).unwrap();
        let error = largest(&(&soft.contact_pressure - &rigid.contact_pressure));
        assert!(error < 1e-2 * largest(&rigid.contact_pressure), "{error}");
    }
}
