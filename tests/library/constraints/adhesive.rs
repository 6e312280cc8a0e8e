//! Springs and Uzawa's method with adhesion.

use super::*;

/// A rough surface, and a law that attracts ten times its range deep into the peaks at the default start.
fn sticky() -> (Problem<f64>, Exponential, Control) {
    let law = Exponential::new(2e-4, 3e-3).unwrap();
    (rough(64, 8, law), law, Control::MeanGap(0.05))
}

#[test]
fn penalty_and_uzawa_find_the_adhesive_state_of_a_rough_surface() {
    let (mut problem, law, control) = sticky();
    assert!(problem.mu_rho() < 0.7);
    let exact = solve(&mut problem, control, 1e-8).report;
    let mut last = f64::INFINITY;
    for stiffness in [30.0, 300.0, 3000.0] {
        let (solution, _) = with(&mut problem, Penalty::new(stiffness).unwrap(), control, 1e-7);
        let report = &solution.report;
        assert_eq!(report.status, Status::Converged);
        // the springs carry the contact pressure, and the adhesion of contact
        let deepest = solution.contact_pressure.iter().copied().fold(0.0, f64::max);
        assert_relative_eq!(report.min_gap, -deepest / stiffness, max_relative = 1e-9);
        for ((&g, &p), &lambda) in solution.gap.iter().zip(&solution.pressure).zip(&solution.contact_pressure) {
            let balance = p + law.traction(g.max(0.0)) - lambda;
            assert!(balance.abs() < 1e-3 * deepest, "{g} {p} {lambda}");
        }
        let error = (report.mean_pressure / exact.mean_pressure - 1.0).abs();
        assert!(error < 0.2 * last, "{stiffness} {error}");
        last = error;
        let (solution, uzawa) = with(&mut problem, Uzawa::new(stiffness).unwrap(), control, 1e-8);
        assert_eq!((solution.report.status, uzawa.rounds() > 2), (Status::Converged, true));
        assert_eq!(solution.report.contact_nodes, exact.contact_nodes);
        assert_relative_eq!(solution.report.mean_pressure, exact.mean_pressure, max_relative = 1e-5);
    }
    assert!(last < 0.02, "{last}");
}

#[test]
fn an_exponential_evaluated_at_negative_gaps_diverges_and_is_not_called_converged() {
    let (mut problem, law, control) = sticky();
    for stiffness in [30.0, 300.0] {
        let diverged = [
            with(&mut problem, Outrun(Penalty::new(stiffness).unwrap(), law), control, 1e-6).0,
            with(&mut problem, Outrun(Uzawa::new(stiffness).unwrap(), law), control, 1e-6).0,
        ];
        for solution in diverged {
            assert_eq!(solution.report.status, Status::Stalled);
            // it is past the barrier that springs and law leave, where k|g| = φ'(g)
            assert!(stiffness * -solution.report.min_gap < law.traction(solution.report.min_gap));
            assert!(!solution.report.relative_error.is_nan() && solution.gap.iter().all(|g| g.is_finite()));
        }
    }
    // stiff springs leave a local minimum, which is found from next to it, where the law continues as its tangent
    let springs = Penalty::new(3000.0).unwrap();
    let (near, _) = with(&mut problem, springs, control, 1e-7);
    let mut solver = Solver { settings: Settings::default(), constraint: Outrun(springs, law) };
    let held = solver
        .solve_with(&mut problem, control, Start::From(&near.gap), |_| std::ops::ControlFlow::Continue(()))
        .unwrap();
    assert_eq!(held.report.status, Status::Converged);
    assert_relative_eq!(held.report.mean_pressure, near.report.mean_pressure, max_relative = 1e-2);
}

/// A law that is undefined, as it may be, where the surfaces interpenetrate.
struct Positive(Exponential);

impl AdhesionLaw<f64> for Positive {
    fn energy(&self, gap: f64) -> f64 {
        if gap < 0.0 { f64::NAN } else { self.0.energy(gap) }
    }
    fn traction(&self, gap: f64) -> f64 {
        if gap < 0.0 { f64::NAN } else { self.0.traction(gap) }
    }
    fn slope(&self, gap: f64) -> f64 {
        if gap < 0.0 { f64::NAN } else { self.0.slope(gap) }
    }
}

#[test]
fn no_law_is_asked_for_a_negative_gap() {
    let (mut problem, law, control) = sticky();
    let (expected, _) = with(&mut problem, Penalty::new(300.0).unwrap(), control, 1e-6);
    let mut problem = rough::<f64>(64, 8, Positive(law));
    let (found, _) = with(&mut problem, Penalty::new(300.0).unwrap(), control, 1e-6);
    assert!(found.report.status == Status::Converged && found.report.min_gap < 0.0);
    // the same steps, but for the last bits of the exponential, which the law computes for many gaps at once
    assert!(found.gap.iter().zip(&expected.gap).all(|(found, expected)| (found - expected).abs() < 1e-9));
    // nor where a start interpenetrates
    let mut solver = Solver { settings: Settings::default(), constraint: Penalty::new(300.0).unwrap() };
    let again = solver
        .solve_with(&mut problem, control, Start::From(&found.gap), |_| std::ops::ControlFlow::Continue(()))
        .unwrap();
    assert_eq!(again.report.status, Status::Converged);
}

#[test]
#[ignore = "prints the figures of the guide: cargo test --release --test library constraints::figures -- --ignored --nocapture"]
fn figures_of_penalty_and_uzawa_on_a_rough_surface() {
    let grid = Grid::square(128, 1.0).unwrap();
    let surface = SelfAffine::default().k_s(16.0).amplitude(Amplitude::RmsSlope(0.1));
    let surface = surface.surface(grid).unwrap();
    let control = Control::MeanPressure(0.01);
    let laws: [Box<dyn AdhesionLaw<f64>>; 2] = [Box::new(NoAdhesion), Box::new(Exponential::new(2e-5, 2e-3).unwrap())];
    for law in laws {
        let mut problem = Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap();
        let exact = Solver::default().solve(&mut problem, control).unwrap();
        let norm = |field: &ndarray::Array2<f64>| field.iter().map(|p| p * p).sum::<f64>().sqrt();
        let print = |name: &str, rounds: usize, solution: &Solution<f64>| {
            let report = &solution.report;
            assert_eq!(report.status, Status::Converged);
            let error = norm(&(&solution.contact_pressure - &exact.contact_pressure)) / norm(&exact.contact_pressure);
            let [gap, error] = [report.min_gap, error].map(short);
            let (applications, contact) = (report.operator_applications, 100.0 * report.contact_fraction);
            println!("| {name} | {rounds} | {applications} | {gap} | {error} | {contact:.2} |");
        };
        println!("\n| | rounds | applications | deepest gap | error of the pressure | contact, % |");
        println!("|---|---|---|---|---|---|");
        print("projection", 1, &exact);
        for k in [1e2, 1e3, 1e4, 1e5] {
            let solution = with(&mut problem, Penalty::new(k).unwrap(), control, 1e-6).0;
            print(&format!("penalty, k = {k:.0e}"), 1, &solution);
        }
        for k in [1.0, 1e1, 1e2, 1e3, 1e4] {
            let (solution, uzawa) = with(&mut problem, Uzawa::new(k).unwrap(), control, 1e-6);
            print(&format!("Uzawa, k = {k:.0e}"), uzawa.rounds(), &solution);
        }
    }
}
