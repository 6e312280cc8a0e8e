//! The solves of this example, the areas of their solutions, and the rows that it prints.

use asperity::contact::ContactArea;
use asperity::pull_off::FoundPullOff;
use asperity::{Branch, Problem, PullOff, Result, Settings, Solution, Solver};

/// A solver to a tolerance far below the error of the grid.
pub fn solver() -> Solver {
    Solver::new(Settings::default().tolerance(1e-5))
}

/// A solver that stays on the branch of loading.
pub fn loading() -> Solver {
    let mut solver = solver();
    solver.settings.branch = Some(Branch::Loading);
    solver
}

/// The areas of a contact, as shares of the nominal area: by adhesive energy, and less the process zone.
pub fn areas(solution: &Solution<f64>) -> Result<[f64; 2]> {
    let less_zone = ContactArea::of_solution(solution)?.jkr_contact_fraction;
    Ok([solution.report.adhesive_contact_fraction, less_zone].map(|area| area.unwrap_or(f64::NAN)))
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

/// The powers of two from a first one to a last one.
pub fn powers(first: usize, last: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(first), |n| Some(2 * n)).take_while(move |n| *n <= last)
}

/// Prints a title and the head of a table.
pub fn head(title: &str, columns: &[&str]) {
    println!("\n{title}\n\n| {} |\n|{}", columns.join(" | "), "---|".repeat(columns.len()));
}

/// Prints a row of a table: words, and ratios.
pub fn row(words: &[&str], ratios: &[f64]) {
    let ratios = ratios.iter().map(|ratio| format!("{ratio:.4}"));
    let cells: Vec<_> = words.iter().map(|word| (*word).to_owned()).chain(ratios).collect();
    println!("| {} |", cells.join(" | "));
}
