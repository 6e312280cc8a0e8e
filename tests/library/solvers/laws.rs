//! How solves evaluate their laws.

use super::*;

#[test]
fn a_zero_law_is_no_law() {
    let mut none = rough::<f64>(64, 16, NoAdhesion);
    let mut zero = rough::<f64>(64, 16, Exponential::new(0.0, 1e-3).unwrap());
    let control = Control::MeanPressure(0.02);
    assert_eq!(solve(&mut none, control, 1e-6), solve(&mut zero, control, 1e-6));
}

/// A law of no energy that must not be evaluated, but where the surfaces touch.
struct Untouched;

impl AdhesionLaw<f64> for Untouched {
    fn energy(&self, gap: f64) -> f64 {
        assert_eq!(gap, 0.0);
        0.0
    }
    fn traction(&self, gap: f64) -> f64 {
        self.energy(gap)
    }
    fn slope(&self, gap: f64) -> f64 {
        self.energy(gap)
    }
    fn evaluate(&self, _: usize, _: &[f64], _: Values<'_, f64>) {
        unreachable!()
    }
    fn hints(&self) -> Hints<f64> {
        let mut hints = Hints::new(0.0, 0.0);
        hints.zero = true;
        hints
    }
}

#[test]
fn no_adhesion_is_not_evaluated() {
    for control in [Control::MeanPressure(0.02), Control::MeanGap(0.02)] {
        let mut problem = rough::<f64>(64, 16, Untouched);
        for settings in [Settings::default().tolerance(1e-8), Settings::rey2017().criterion(Criterion::Complementarity)]
        {
            let report = Solver::new(settings).solve(&mut problem, control).unwrap().report;
            assert!(report.iterations > 0);
        }
    }
}

/// An exponential law with its own share of the work of adhesion at each node.
struct ByNode(Exponential, Vec<f64>);

impl AdhesionLaw<f64> for ByNode {
    fn energy(&self, gap: f64) -> f64 {
        self.0.energy(gap)
    }
    fn traction(&self, gap: f64) -> f64 {
        self.0.traction(gap)
    }
    fn slope(&self, gap: f64) -> f64 {
        self.0.slope(gap)
    }
    fn evaluate(&self, first: usize, gaps: &[f64], values: Values<'_, f64>) {
        // one function after another, so that energies do not belong to tractions
        values.each(|order, values| {
            self.0.evaluate(first, gaps, Values::one(order, values));
            values.iter_mut().zip(&self.1[first..]).for_each(|(value, share)| *value *= share);
        });
    }
}

/// A law that counts the evaluations of its energy alone, and says that this is concave or does not.
struct Counting {
    law: Arc<dyn AdhesionLaw<f64>>,
    concave: bool,
    energies: AtomicUsize,
}

impl AdhesionLaw<f64> for Counting {
    fn energy(&self, gap: f64) -> f64 {
        self.law.energy(gap)
    }
    fn traction(&self, gap: f64) -> f64 {
        self.law.traction(gap)
    }
    fn slope(&self, gap: f64) -> f64 {
        self.law.slope(gap)
    }
    fn hints(&self) -> Hints<f64> {
        let mut hints = self.law.hints();
        hints.concave = self.concave;
        hints
    }
    fn adapted(&self, to: Discretisation<f64>) -> Option<Arc<dyn AdhesionLaw<f64>>> {
        Some(Arc::new(Counting { law: self.law.adapted(to)?, concave: self.concave, energies: AtomicUsize::new(0) }))
    }
    fn evaluate(&self, first: usize, gaps: &[f64], values: Values<'_, f64>) {
        if values.tractions.is_none() && values.energies.is_some() {
            self.energies.fetch_add(gaps.len(), Ordering::Relaxed);
        }
        // one function after another, so that energies do not belong to tractions
        values.each(|order, values| self.law.evaluate(first, gaps, Values::one(order, values)));
    }
}

/// A concave energy need not be evaluated before each step, and the solve is the same to the last bit: where its
/// tangent bounds it, the energy itself would have passed as well.
#[test]
fn a_concave_energy_is_not_searched_for_a_descent() {
    let (exponential, dugdale) = (Exponential::new(1e-4, 5e-3).unwrap(), MaugisDugdale::new(1e-4, 5e-3).unwrap());
    let laws: [Arc<dyn AdhesionLaw<f64>>; 2] = [Arc::new(exponential), Arc::new(dugdale)];
    for law in laws {
        for control in [Control::MeanPressure(0.01), Control::MeanGap(0.02)] {
            let solved = |concave| {
                let law = Arc::new(Counting { law: law.clone(), concave, energies: AtomicUsize::new(0) });
                let solution = Solver::default().solve(&mut rough::<f64>(64, 8, law.clone()), control).unwrap();
                (solution, law.energies.load(Ordering::Relaxed) / 64 / 64)
            };
            let ((bounded, few), (searched, many)) = (solved(true), solved(false));
            assert_eq!(bounded, searched);
            assert_eq!(bounded.report.status, Status::Converged);
            assert!(many >= 5 && few <= 2, "{few} {many}");
        }
    }
}

/// Heights and shares that are moved together move the answer with them, and a share that is the same everywhere is a
/// law of that work of adhesion. Contact nodes of different shares have different tractions, in the contact pressure
/// too.
#[test]
fn a_law_may_differ_from_node_to_node() {
    const N: usize = 48;
    let grid = Grid::square(N, 1.0).unwrap();
    let waves = Surface::wave_2d(grid, 5e-3, 2).unwrap();
    let law = Exponential::new(4e-5, 3e-3).unwrap();
    let share = |i: usize, j: usize| if 2 * i < N { 1.0 } else { 0.3 + 0.2 * (j % 5) as f64 };
    let moved = |by: (usize, usize)| {
        let from = |i: usize, j: usize| ((i + by.0) % N, (j + by.1) % N);
        let heights = Array2::from_shape_fn((N, N), |(i, j)| waves.heights()[from(i, j)]);
        let shares = (0..N * N).map(|node| from(node / N, node % N)).map(|(i, j)| share(i, j)).collect();
        let surface = Surface::new(grid, heights).unwrap();
        let half_space = Westergaard::<f64>::new(grid, 1.0).unwrap();
        let mut problem = Problem::new(&surface, half_space, ByNode(law, shares)).unwrap();
        let settings = Settings::default().tolerance(1e-9);
        Solver::new(settings).solve(&mut problem, Control::MeanPressure(2e-3)).unwrap()
    };
    let (here, there) = (moved((0, 0)), moved((17, 31)));
    assert_eq!((here.report.status, there.report.status), (Status::Converged, Status::Converged));
    let contact = here.report.contact_nodes;
    assert!(contact > 100 && contact == there.report.contact_nodes);
    let at = |i: usize, j: usize| ((i + 17) % N, (j + 31) % N);
    for ((i, j), &p) in there.contact_pressure.indexed_iter() {
        assert!((p - here.contact_pressure[at(i, j)]).abs() < 1e-5 * here.pressure[at(i, j)].abs().max(0.05));
    }
    // λ = p + p̄ + φ' with the traction of each node
    for ((i, j), &p) in here.contact_pressure.indexed_iter().filter(|(at, _)| here.gap[*at] == 0.0) {
        let expected = here.pressure[[i, j]] + share(i, j) * law.traction(0.0);
        assert!((p - expected.max(0.0)).abs() < 1e-12);
    }

    let solve = |law: Box<dyn AdhesionLaw<f64>>| {
        let half_space = Westergaard::<f64>::new(grid, 1.0).unwrap();
        let mut problem = Problem::new(&waves, half_space, law).unwrap();
        Solver::default().solve(&mut problem, Control::MeanGap(4e-3)).unwrap()
    };
    let half = solve(Box::new(ByNode(law, vec![0.5; N * N])));
    let weaker = solve(Box::new(Exponential::new(2e-5, 3e-3).unwrap()));
    // the one law by single nodes, the other by many at once: last digits of the exponential, which differ by processor
    assert!(half.report.operator_applications.abs_diff(weaker.report.operator_applications) <= SLACK);
    assert!((half.report.mean_pressure - weaker.report.mean_pressure).abs() < 1e-9);
}
