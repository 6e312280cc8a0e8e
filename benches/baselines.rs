//! Projection, penalty and Uzawa side by side, each with the settings that bring its pressures to the same error: on the
//! sphere of Table 2 of Rey, Anciaux and Molinari (2017) and on a rough surface, without adhesion and with it.
//!
//! `cargo bench --bench baselines`. At the end stands a table: the error of the pressures that each reaches, in L²
//! against a projection to 1e-10, its operator applications, the stiffness of a penalty over the stiffness of the
//! shortest wave, Uzawa's rounds, and times of the processor over the time of projection, as medians on one thread.
//! With `-- --test` each is solved once, and the table has no times.

mod common;

use std::cell::OnceCell;
use std::time::Duration;

use asperity::{
    ContactConstraint, Control, Exponential, Grid, Penalty, Projection, Settings, Solution, Solver, Status, Surface,
    Uzawa,
};
use common::{Make, group, none, problem};
use cpu_time::ProcessTime;
use criterion::{Criterion, criterion_group, criterion_main};
use ndarray::Array2;
use oracles::{authors, rough};

const NODES: usize = 256;
const ERRORS: [f64; 3] = [1e-2, 1e-3, 1e-4];
const METHODS: [Method; 3] = [Method::Projection, Method::Penalty, Method::Uzawa];

/// The share of an error that is left to the springs of a penalty; the rest is for the tolerance of the solve.
const OF_SPRINGS: f64 = 0.7;

#[derive(Clone, Copy, Debug)]
enum Method {
    Projection,
    Penalty,
    Uzawa,
}

struct Scene {
    name: &'static str,
    surface: Surface,
    law: Make<f64>,
    gap: f64,
    exact: OnceCell<Array2<f64>>,
}

/// The settings of a method, and what comes of them.
struct Run {
    stiffness: f64,
    tolerance: f64,
    error: f64,
    applications: usize,
    rounds: usize,
}

impl Scene {
    fn new(name: &'static str, surface: Surface, law: Make<f64>, gap: f64) -> Self {
        Self { name, surface, law, gap, exact: OnceCell::new() }
    }

    fn with<C: ContactConstraint<f64> + 'static>(&self, constraint: C, tolerance: f64) -> (Solution<f64>, C) {
        let mut solver = Solver { settings: Settings::default().tolerance(tolerance), constraint };
        let mut problem = problem(&self.surface, (self.law)());
        let solution = solver.solve(&mut problem, Control::MeanGap(self.gap)).expect("a good problem");
        assert_eq!(solution.report.status, Status::Converged);
        (solution, solver.constraint)
    }

    /// A solve with its rounds. The stiffness is given over the stiffness of the shortest wave.
    fn solve(&self, method: Method, stiffness: f64, tolerance: f64) -> (Solution<f64>, usize) {
        let k = stiffness * problem(&self.surface, none::<f64>()).operator().stiffness_range().1;
        match method {
            Method::Projection => (self.with(Projection, tolerance).0, 1),
            Method::Penalty => (self.with(Penalty::new(k).expect("a good stiffness"), tolerance).0, 1),
            Method::Uzawa => {
                let (solution, uzawa) = self.with(Uzawa::new(k).expect("a good stiffness"), tolerance);
                (solution, uzawa.rounds())
            }
        }
    }

    fn error(&self, solution: &Solution<f64>) -> f64 {
        let exact = self.exact.get_or_init(|| self.with(Projection, 1e-10).0.pressure);
        let norm = |field: &Array2<f64>| field.iter().map(|p| p * p).sum::<f64>().sqrt();
        norm(&(&solution.pressure - exact)) / norm(exact)
    }

    /// The method with the loosest tolerance, in steps of a quarter of a decade, that reaches an error of the pressures.
    fn run(&self, method: Method, error: f64) -> Run {
        let stiffness = match method {
            // the error of springs falls like one over their stiffness
            Method::Penalty => 10.0 * self.error(&self.solve(method, 10.0, 1e-7).0) / (OF_SPRINGS * error),
            _ => 1.0,
        };
        let tolerances: Vec<_> = (4..=28).map(|quarters| 10_f64.powf(-0.25 * f64::from(quarters))).collect();
        let enough = tolerances.partition_point(|&t| self.error(&self.solve(method, stiffness, t).0) > error);
        let tolerance = tolerances[enough.min(tolerances.len() - 1)];
        let (solution, rounds) = self.solve(method, stiffness, tolerance);
        let (error, applications) = (self.error(&solution), solution.report.operator_applications);
        Run { stiffness, tolerance, error, applications, rounds }
    }
}

fn scenes() -> [Scene; 4] {
    let grid = Grid::square(NODES, 1.0).expect("a good grid");
    let sphere = authors::surface(NODES).expect("a good surface");
    let slope_1 = rough::rough(grid, 32, 1);
    let rough = Surface::new(grid, slope_1.heights().mapv(|height| 0.1 * height)).expect("good heights");
    // the mean gap of the paper's load
    let (of_sphere, of_rough) = (0.03999459, 0.0035);
    [
        Scene::new("sphere", sphere.clone(), none, of_sphere),
        Scene::new("sphere, adhesion", sphere, || Box::new(Exponential::new(1e-4, 2e-3).expect("a law")), of_sphere),
        Scene::new("rough", rough.clone(), none, of_rough),
        Scene::new("rough, adhesion", rough, || Box::new(Exponential::new(2e-6, 3e-4).expect("a law")), of_rough),
    ]
}

const HEADINGS: [&str; 11] = [
    "error asked of the pressures",
    "projection: error",
    "projection: applications",
    "penalty: error",
    "penalty: applications",
    "penalty: k/κ",
    "Uzawa: error",
    "Uzawa: applications",
    "Uzawa: rounds",
    "penalty: time",
    "Uzawa: time",
];

/// The row of a scene and an error, if all methods have run.
fn row(title: String, runs: &mut [(Run, Vec<Duration>)]) -> Option<[String; HEADINGS.len()]> {
    let median = |times: &mut Vec<Duration>| {
        times.sort();
        times[times.len() / 2].as_secs_f64()
    };
    let [(projection, base), (penalty, of_penalty), (uzawa, of_uzawa)] = runs else { return None };
    let [base, of_penalty, of_uzawa] = [base, of_penalty, of_uzawa].map(median);
    Some([
        title,
        format!("{:.1e}", projection.error),
        projection.applications.to_string(),
        format!("{:.1e}", penalty.error),
        penalty.applications.to_string(),
        format!("{:.0}", penalty.stiffness),
        format!("{:.1e}", uzawa.error),
        uzawa.applications.to_string(),
        uzawa.rounds.to_string(),
        format!("{:.1}", of_penalty / base),
        format!("{:.1}", of_uzawa / base),
    ])
}

fn baselines(criterion: &mut Criterion) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("the first pool");
    let mut rows = vec![HEADINGS.map(str::to_owned), HEADINGS.map(|_| "---".to_owned())];
    for scene in scenes() {
        for error in ERRORS {
            let (title, mut runs) = (format!("{}, {error:.0e}", scene.name), Vec::new());
            let mut group = group(criterion, &title);
            for method in METHODS {
                let (mut run, mut times) = (None, Vec::new());
                group.bench_function(format!("{method:?}"), |b| {
                    let Run { stiffness, tolerance, .. } = *run.get_or_insert_with(|| scene.run(method, error));
                    b.iter_custom(|count| {
                        let clock = ProcessTime::now();
                        (0..count).for_each(|_| drop(scene.solve(method, stiffness, tolerance)));
                        let time = clock.elapsed();
                        times.push(time / count as u32);
                        time
                    });
                });
                runs.extend(run.map(|run| (run, times)));
            }
            group.finish();
            rows.extend(row(title, &mut runs));
        }
    }
    // one run of each has no median
    let columns = HEADINGS.len() - if std::env::args().any(|argument| argument == "--test") { 2 } else { 0 };
    for row in rows.iter().filter(|_| rows.len() > 2) {
        println!("| {} |", row[..columns].join(" | "));
    }
}

criterion_group!(benches, baselines);
criterion_main!(benches);
