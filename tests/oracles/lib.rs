//! Problems with known solutions, and the properties that every solution must have.

pub mod authors;
pub mod dense;
pub mod outrun;
pub mod published;
pub mod rough;
pub mod scenes;

use std::iter;
use std::ops::ControlFlow;

use asperity::path::{Path, PathStep};
use asperity::solver::Iteration;
use asperity::*;
use ndarray::Array2;

/// Solves from the default start, watching that the energy falls, and checks the solution's invariants.
pub fn solve<T: Real>(problem: &mut Problem<T>, control: Control, tolerance: f64) -> Solution<T> {
    solve_from(problem, control, tolerance, None)
}

/// The same from a given start.
pub fn solve_from<T: Real>(
    problem: &mut Problem<T>,
    control: Control,
    tolerance: f64,
    start: Option<&Array2<T>>,
) -> Solution<T> {
    let settings = Settings::default().tolerance(tolerance);
    let mut history: Vec<Iteration> = Vec::new();
    let solution = Solver::new(settings)
        .solve_with(problem, control, start.map_or(Start::Default, |gap| Start::From(gap)), |iteration| {
            history.push(*iteration);
            ControlFlow::Continue(())
        })
        .expect("the input is good");
    falls(&history, T::epsilon().widen());
    assert_eq!(solution.report.control, control);
    check(&solution);
    solution
}

/// Solves with settings from a start.
pub fn solve_to<T: Real>(
    problem: &mut Problem<T>,
    control: Control,
    settings: Settings,
    start: Start<'_, T>,
) -> Solution<T> {
    Solver::new(settings).solve_with(problem, control, start, |_| ControlFlow::Continue(())).expect("the input is good")
}

/// The solutions of a sweep.
pub fn swept<T: Real>(
    sweep: &mut Sweep<T>,
    solver: &mut Solver<dyn ContactConstraint<T>>,
    problem: &mut Problem<T>,
    loads: &[Control],
) -> Vec<Solution<T>> {
    loads.iter().map(|&load| sweep.next(solver, problem, load).expect("the input is good")).collect()
}

/// The states of a path up to its end.
pub fn followed<T: Real>(
    mut path: Path<T>,
    solver: &mut Solver<dyn ContactConstraint<T>>,
    problem: &mut Problem<T>,
) -> Vec<PathStep<T>> {
    iter::from_fn(|| path.next(solver, problem).expect("the input is good")).collect()
}

/// A value that is its own checkpoint, by JSON.
pub trait Checkpoint: Sized {
    fn read_again(&self) -> Self;
}

impl<A: serde::Serialize + serde::de::DeserializeOwned> Checkpoint for A {
    fn read_again(&self) -> Self {
        serde_json::from_str(&serde_json::to_string(self).unwrap()).unwrap()
    }
}

/// The energy never rises by more than the rounding of its own sum, which in `f64` is the rounding of changes in `f32`.
pub fn falls(history: &[Iteration], epsilon: f64) {
    let size = history.iter().map(|i| i.energy.abs()).fold(0.0, f64::max);
    let allowed = (64.0 * epsilon).max(f64::from(f32::EPSILON)) * size;
    for pair in history.windows(2).filter(|pair| pair[0].round == pair[1].round) {
        let rise = pair[1].energy - pair[0].energy;
        assert!(rise <= allowed, "energy rises by {rise:e} of {size:e} in iteration {}", pair[1].iteration);
    }
}

/// Checks the invariants of every state that the solver returns, converged or not.
pub fn check<T: Real>(solution: &Solution<T>) {
    let Solution { gap, pressure, contact_pressure, report, .. } = solution;
    let (nodes, epsilon) = (gap.len() as f64, T::epsilon().widen());
    let mut contact = 0;
    for ((&g, &p), &lambda) in gap.iter().zip(pressure).zip(contact_pressure) {
        assert!(g >= T::zero() && lambda >= T::zero() && lambda * g == T::zero());
        assert!(p.is_finite());
        contact += usize::from(g == T::zero());
    }
    assert_eq!(report.contact_nodes, contact);
    assert_eq!(report.contact_fraction, contact as f64 / nodes);
    assert_eq!(report.min_gap, gap.iter().map(|g| g.widen()).fold(f64::INFINITY, f64::min));
    let values = |field: &Array2<T>| field.iter().map(|x| x.widen()).collect::<Vec<_>>();
    let mean = |field: &Array2<T>| sum(&values(field)) / nodes;
    assert!((report.mean_gap - mean(gap)).abs() <= 64.0 * epsilon * mean(gap));
    assert!((report.mean_contact_pressure - mean(contact_pressure)).abs() <= 64.0 * epsilon * mean(contact_pressure));
    match report.control {
        // a step of ten times the trial length carries ten times the rounding of the mean
        Control::MeanGap(given) => assert!((mean(gap) - given).abs() <= 1e3 * epsilon * given),
        Control::MeanPressure(given) => assert_eq!(report.mean_pressure, given),
        other => panic!("{other:?} is not checked here"),
    }
    if report.status == Status::Converged && contact > 0 {
        // the balance of forces: the criterion leaves the residual
        let traction = gap.iter().map(|&g| solution.law().traction(g).widen()).sum::<f64>() / nodes;
        let size = mean(&pressure.mapv(|p| p.abs())).max(traction);
        let balance = report.mean_contact_pressure - traction - report.mean_pressure;
        let allowed = 10.0 * report.relative_error.max(report.load_error) + 1e3 * epsilon;
        assert!(balance.abs() <= allowed * size, "forces are off by {balance:e} of {size:e}");
    }
}

/// In pairs, as long sums of equal numbers round badly.
fn sum(values: &[f64]) -> f64 {
    match values {
        [] => 0.0,
        [value] => *value,
        _ => {
            let (left, right) = values.split_at(values.len() / 2);
            sum(left) + sum(right)
        }
    }
}

/// A sphere of radius 2 on the unit square of a half-space of unit modulus, as in the paper.
pub fn sphere<T: Real>(n: usize, law: impl AdhesionLaw<T> + 'static) -> Problem<T> {
    let grid = Grid::square(n, 1.0).unwrap();
    Problem::new(&Surface::paraboloid(grid, 2.0).unwrap(), Westergaard::new(grid, 1.0).unwrap(), law).unwrap()
}

/// A rough surface of unit rms slope on the unit square of a half-space of unit modulus.
pub fn rough<T: Real>(n: usize, shortest: i32, law: impl AdhesionLaw<T> + 'static) -> Problem<T> {
    let grid = Grid::square(n, 1.0).unwrap();
    Problem::new(&rough::rough(grid, shortest, 1), Westergaard::new(grid, 1.0).unwrap(), law).unwrap()
}

/// The mean of u·K⁻¹u for the difference of two gaps, for the displacement of the second, and for the surface.
pub fn energy_norms(
    surface: &Surface,
    operator: &mut impl ElasticOperator<f64>,
    a: &Array2<f64>,
    b: &Array2<f64>,
) -> (f64, f64, f64) {
    let mut norm = |u: &Array2<f64>| {
        let mut p = Array2::zeros(u.dim());
        operator.pressure(u.view(), p.view_mut()).unwrap();
        (u * &p).sum() / u.len() as f64
    };
    (norm(&(a - b)), norm(&(b + surface.heights())), norm(surface.heights()))
}
