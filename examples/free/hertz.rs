//! A sphere by force on a free half-space and one in a periodic cell of the same window: accuracy and cost.

use std::time::Instant;

use asperity::exact::{Hertz, Sphere};
use asperity::{
    Boussinesq, Control, ElasticOperator, Error, Grid, NoAdhesion, Problem, Report, Result, Solver, Surface,
    Westergaard,
};

const RADIUS: f64 = 2.0;
const SIDE: f64 = 0.4;
const FORCE: f64 = 1e-3;

/// The report of a solve, and its time in seconds; the best of three.
fn solve(surface: &Surface, operator: impl ElasticOperator<f64> + 'static) -> Result<(Report, f64)> {
    let mut problem = Problem::new(surface, operator, NoAdhesion)?;
    let mut best: Option<(Report, f64)> = None;
    for _ in 0..3 {
        let start = Instant::now();
        let report = Solver::default().solve(&mut problem, Control::Force(FORCE))?.report;
        let seconds = start.elapsed().as_secs_f64();
        if best.as_ref().is_none_or(|(_, best)| seconds < *best) {
            best = Some((report, seconds));
        }
    }
    best.ok_or(Error::Value { name: "number of solves", value: 0.0, requirement: "positive" })
}

/// Prints the error of the approach, the applications, and the time over the time of the periodic solve.
pub fn table(largest: usize) -> Result<()> {
    let exact = Hertz::new(RADIUS, 1.0)?.at_load(FORCE)?;
    println!("sphere by force, against Hertz and the periodic solve of the same window");
    println!("{:>5} {:>12} {:>12} {:>10} {:>10} {:>6}", "n", "approach", "error", "free", "periodic", "time");
    for n in [64, 128, 256, 512, 1024].into_iter().filter(|&n| n <= largest) {
        let grid = Grid::square(n, SIDE)?;
        let sphere = Surface::paraboloid(grid, RADIUS)?;
        let (free, seconds) = solve(&sphere, Boussinesq::new(grid, 1.0)?)?;
        let (periodic, of_periodic) = solve(&sphere, Westergaard::new(grid, 1.0)?)?;
        let approach = free.approach.unwrap_or(f64::NAN);
        println!(
            "{n:>5} {approach:>12.8} {:>12.1e} {:>10} {:>10} {:>6.2}",
            approach / exact.approach() - 1.0,
            free.operator_applications,
            periodic.operator_applications,
            seconds / of_periodic
        );
    }
    Ok(())
}
