//! Spheres, cones, punches and wavy spheres next to their exact solutions.

use super::*;

#[test]
fn hertz_is_met_to_half_a_node_in_any_window() {
    let exact = Hertz::new(2.0, 1.0).unwrap().at_load(1e-3).unwrap();
    for (n, side) in [(64, 0.4), (65, 0.4), (128, 0.4), (128, 0.8), (96, 0.3)] {
        let found = solve(&mut problem(&sphere(n, side), NoAdhesion), Control::Force(1e-3), 1e-6);
        let (report, spacing) = (&found.report, side / n as f64);
        let statistics = ContactStatistics::of(&found).unwrap();
        let radius = (statistics.corrected_contact_fraction * side * side / PI).sqrt();
        assert!((radius - exact.contact_radius()).abs() < 0.5 * spacing, "{n} {side}: {radius}");
        // of second order in the spacing
        let error = report.approach.unwrap() / exact.approach() - 1.0;
        assert!(error.abs() < 0.2 * (spacing / exact.contact_radius()).powi(2), "{n} {side}: {error:e}");
        assert!((largest(&found.pressure) / exact.pressure(0.0) - 1.0).abs() < 1e-3);
        assert!(!report.reaches_edge && report.edge_traction.unwrap() < 1e-6, "{:?}", report.edge_traction);
    }
    let ellipse = EllipticHertz::new((2.0, 0.8), 1.0).unwrap().at_load(1e-3).unwrap();
    let grid = Grid::new((128, 96), (0.4, 0.3)).unwrap();
    let body = Surface::from_fn(grid, |x, y| -x * x / 4.0 - y * y / 1.6).unwrap();
    let found = solve(&mut problem(&body, NoAdhesion), Control::Force(1e-3), 1e-6);
    assert!((found.report.approach.unwrap() / ellipse.approach - 1.0).abs() < 1e-3);
    assert!((largest(&found.pressure) / ellipse.largest_pressure - 1.0).abs() < 2e-3);
    let row = |nodes: usize| 0.5 * nodes as f64 * 0.4 / 128.0;
    let contact = found.contact_map();
    let along_x = row(contact.column(48).iter().filter(|touches| **touches).count());
    let along_y = row(contact.row(64).iter().filter(|touches| **touches).count());
    assert!((along_x - ellipse.semi_axes.0).abs() < 0.4 / 128.0 && (along_y - ellipse.semi_axes.1).abs() < 0.4 / 128.0);
}

#[test]
fn a_cone_and_a_flat_punch_are_met() {
    let (cone, grid) = (Cone::new(0.1, 1.0).unwrap(), Grid::square(129, 1.0).unwrap());
    let body = Surface::from_fn(grid, |x, y| -0.1 * x.hypot(y)).unwrap();
    let found = solve(&mut problem(&body, NoAdhesion), Control::Force(1e-2), 1e-6);
    let a = cone.contact_radius(1e-2).unwrap();
    let statistics = ContactStatistics::of(&found).unwrap();
    assert!(((statistics.corrected_contact_fraction / PI).sqrt() - a).abs() < 0.5 / 129.0);
    assert!((found.report.approach.unwrap() / cone.approach(a) - 1.0).abs() < 0.01);

    let a = 0.45;
    let heights = grid.sample(|x, y| if x.hypot(y) < a { 0.0 } else { f64::NAN });
    let cells = heights.iter().filter(|h| !h.is_nan()).count();
    let (punch, end) = (FlatPunch::new(a, 1.0).unwrap(), surface_with_absent(grid, heights).unwrap());
    let mut problem = problem(&end, NoAdhesion);
    for found in [Control::Approach(0.01), Control::Force(0.009)].map(|control| solve(&mut problem, control, 1e-6)) {
        let report = &found.report;
        let stiffness = report.normal_force / report.approach.unwrap();
        assert!((stiffness / punch.load(1.0) - 1.0).abs() < 0.01, "{stiffness}");
        assert_eq!((report.contact_nodes, report.contact_fraction), (cells, 1.0));
        assert_eq!(report.absent_nodes, 129 * 129 - cells);
        let centre = found.pressure[[64, 64]];
        assert!((centre / punch.pressure(report.normal_force, 0.0) - 1.0).abs() < 0.02, "{centre}");
    }
}

/// Maugis' pull-off, by force: from the state without load down to where no equilibrium is left.
#[test]
fn the_pull_off_of_an_adhesive_sphere_is_that_of_maugis() {
    for (work, range) in [(2e-5, 2e-3), (2e-5, 6e-4)] {
        let (side, n) = (0.24, 64);
        let exact = exact::MaugisDugdale::new(2.0, 1.0, work, range).unwrap();
        let law = MaugisDugdale::new(work, range).unwrap();
        let mut problem = problem(&sphere(n, side), law);
        assert!(problem.mu_rho() < 0.5);
        let pull_off = -exact.pull_off().load();
        let approaches = [0.002, -0.012].map(Control::Approach);
        let mut strongest = 0.0_f64;
        let path = Path::new(approaches, PathSettings::default()).unwrap();
        for step in followed(path, &mut Solver::default(), &mut problem) {
            strongest = strongest.max(-step.solution.report.normal_force);
        }
        assert!((strongest / pull_off - 1.0).abs() < 0.01, "{} {}", strongest / pull_off, exact.tabor_parameter());
    }
}

/// From small to large Tabor parameters, where the grid resolves the adhesive zone.
#[test]
#[ignore = "four paths on 256 x 256 nodes: cargo test --release --test library pull_offs_at_256 -- --ignored --nocapture"]
fn pull_offs_at_256_are_those_of_maugis_to_one_per_cent() {
    let work = 2e-5;
    for (tabor, side) in [(0.1, 0.5), (0.2, 0.45), (0.5, 0.35), (1.0, 0.25), (2.0, 0.2)] {
        let range = (work * work * 2.0_f64).cbrt() / tabor;
        let exact = exact::MaugisDugdale::new(2.0, 1.0, work, range).unwrap();
        let mut problem = problem(&sphere(256, side), MaugisDugdale::new(work, range).unwrap());
        assert!(problem.mu_rho() < 0.3);
        let pull_off = -exact.pull_off().load();
        let legs = [0.0, 2.0 * exact.pull_off().approach() - 1e-3].map(Control::Approach);
        let settings = PathSettings::default().steps(20).smallest_step(1e-2);
        let (mut strongest, mut edge) = (0.0_f64, 0.0_f64);
        let path = Path::new(legs, settings).unwrap();
        for PathStep { solution: Solution { report, .. }, .. } in followed(path, &mut Solver::default(), &mut problem) {
            strongest = strongest.max(-report.normal_force);
            edge = edge.max(if report.contact_nodes > 0 { report.edge_traction.unwrap() } else { 0.0 });
        }
        let ratio = strongest / pull_off;
        println!(
            "Tabor {tabor}: {ratio:.4} of {:.4} πwR, μ_ρ {:.2}, edge {edge:.1e}",
            pull_off / (PI * work * 2.0),
            problem.mu_rho()
        );
        assert!((ratio - 1.0).abs() < 0.01);
    }
}

/// The adhesion of a law of short range on what stays stuck of a sphere with waves, by approach.
#[test]
fn a_wavy_sphere_sticks_as_guduru_says() {
    let exact = exact::WavySphere::new(20.0, 1.0, 1e-3, (0.012, 1.0)).unwrap();
    let grid = Grid::square(96, 6.0).unwrap();
    let surface = Surface::from_fn(grid, |x, y| exact.height(x.hypot(y))).unwrap();
    let mut problem = problem(&surface, MaugisDugdale::new(1e-3, 2e-2).unwrap());
    for radius in [1.1_f64, 2.2] {
        let found = solve(&mut problem, Control::Approach(exact.approach(radius)), 1e-5);
        let statistics = ContactStatistics::of(&found).unwrap();
        let a = (statistics.corrected_contact_fraction * 36.0 / PI).sqrt();
        // Dugdale's zone, πE*ρ²/4w, is five nodes wide
        assert!((a - radius).abs() < 2.0 * 6.0 / 96.0, "{a} {radius}");
        let error = found.report.normal_force - exact.load(radius);
        assert!(error.abs() < 0.04, "{} {}", found.report.normal_force, exact.load(radius));
    }
}

#[test]
#[ignore = "a path on 256 x 256 nodes: cargo test --release --test library wavy_sphere_jumps -- --ignored --nocapture"]
fn a_wavy_sphere_jumps_where_guduru_says() {
    let exact = exact::WavySphere::new(20.0, 1.0, 1e-3, (0.012, 1.0)).unwrap();
    let grid = Grid::square(256, 8.0).unwrap();
    let surface = Surface::from_fn(grid, |x, y| exact.height(x.hypot(y))).unwrap();
    let mut problem = problem(&surface, MaugisDugdale::new(1e-3, 1.4e-2).unwrap());
    assert!(problem.mu_rho() < 0.41);
    let (far, near) = (-0.12, exact.approach(3.0));
    let start = -far - surface.heights();
    let settings = PathSettings::default().smallest_step(2e-3);
    let mut solver = Solver::new(Settings::default().tolerance(1e-5));
    let legs = [far, near, far].map(Control::Approach);
    let mut jumps = [Vec::new(), Vec::new(), Vec::new()];
    let path = Path::new(legs, settings).unwrap().starting_from(start);
    for step in followed(path, &mut solver, &mut problem) {
        if let Some(Event::Jump(jump)) = step.event {
            jumps[step.leg]
                .push((jump.approach.unwrap().0, [jump.mean_pressure.0, jump.mean_pressure.1].map(|p| 64.0 * p)));
        }
    }
    println!("{jumps:.4?}");
    for (leg, way) in [(1, [far, near]), (2, [near, far])] {
        let known = exact.jumps(way[0], way[1]).unwrap();
        // a law with a range jumps in before touch, which the last jumps do not feel
        let found = &jumps[leg][jumps[leg].len() - known.len()..];
        for (jump, (approach, forces)) in known.iter().zip(found).filter(|(jump, _)| jump[0] > 0.0) {
            let force = forces[0] - exact.load(jump[0]);
            assert!((approach - exact.approach(jump[0])).abs() < 0.01 && force.abs() < 0.02, "{approach} {forces:?}");
        }
    }
}
