//! The solves of this example, the areas of their solutions, and the rows that it prints.

use asperity::contact::ContactArea;
use asperity::pull_off::FoundPullOff;
use asperity::{Branch, Problem, PullOff, Result, Settings, Solution, Solver};

/// The tolerance of solves, far below the error of the grid.
pub const TOLERANCE: f64 = 1e-5;

/// A solver to the tolerance of this example.
pub fn solver() -> Solver {
    Solver::new(Settings::default().tolerance(TOLERANCE))
}

/// A solver that stays on the branch of loading.
pub fn loading() -> Solver {
    let mut solver = solver();
    solver.settings.branch = Some(Branch::Loading);
    solver
}

/// The areas of a contact, as shares of the nominal area: by adhesive energy, less the process zone, and corrected.
pub fn areas(solution: &Solution<f64>) -> Result<[f64; 3]> {
    let area = ContactArea::of_solution(solution)?;
    let [by_energy, less_zone] = [solution.report.adhesive_contact_fraction, area.jkr_contact_fraction];
    Ok([by_energy.unwrap_or(f64::NAN), less_zone.unwrap_or(f64::NAN), area.corrected_contact_fraction])
}

/// The pull-off to a relative width of the bracket, after a preload or from flat.
pub fn pull_off(problem: &mut Problem<f64>, tolerance: f64, preload: Option<f64>) -> Result<FoundPullOff<f64>> {
    PullOff::default().tolerance(tolerance).preload(preload).find(&mut solver(), problem)
}

/// The middle of the bracket of a search for the pull-off, as a mean pressure.
pub fn tension(found: &FoundPullOff<f64>) -> f64 {
    let borne = -found.solution.report.mean_pressure;
    found.lost.map_or(borne, |lost| borne.midpoint(lost))
}

/// The value to which a grid and a grid of half as many nodes along the sides converge with the first order.
pub fn extrapolate(fine: f64, coarse: f64) -> f64 {
    2.0 * fine - coarse
}

/// Prints a title and the head of a table.
pub fn head(title: &str, columns: &[&str]) {
    println!("\n{title}\n");
    println!("| {} |", columns.join(" | "));
    println!("|{}", "---|".repeat(columns.len()));
}

/// Prints a row of a table.
pub fn row(cells: &[String]) {
    println!("| {} |", cells.join(" | "));
}

/// Cells of ratios.
pub fn ratios<const N: usize>(values: [f64; N]) -> [String; N] {
    values.map(|value| format!("{value:.4}"))
}
