//! The tables that are printed.

use crate::choice::{Choice, Precision};
use crate::error::{OnGrid, Part, Row};
use crate::front::front;
use crate::scene::Scene;

/// Where a solver error no longer matters beside that of the discretisation.
const SHARE: f64 = 0.1;

fn percent(error: f64) -> String {
    let percent = 100.0 * error;
    let digits = (1.0 - percent.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    if percent == 0.0 { "0".to_owned() } else { format!("{percent:.digits$}") }
}

/// The discretisation error of each grid.
pub fn discretisation(scene: &Scene, grids: &[OnGrid]) {
    println!(
        "\nDiscretisation error: the solution converged on the grid against the truth, the displacement in the energy norm"
    );
    println!(
        "\n| nodes in the {} | nodes | μ_ρ | displacement, % | {}, % | nodes in contact, % | corrected area, % \
         | 2A(n) − A(n/2), % | the same, corrected, % |\n|{}",
        scene.length_name,
        scene.answer_name(),
        "---|".repeat(9)
    );
    for grid in grids {
        let e = &grid.discretisation;
        let [plain, corrected] = grid.extrapolated.map_or([const { String::new() }; 2], |both| both.map(percent));
        println!(
            "| {} | {} | {:.2} | {} | {} | {} | {} | {plain} | {corrected} |",
            (10.0 * grid.n as f64 * scene.length).round() / 10.0,
            grid.n,
            scene.resolution(grid.n),
            percent(e.energy),
            percent(e.answer),
            percent(e.counted),
            percent(e.area),
        );
    }
}

/// All that was measured, the points of the Pareto fronts marked.
pub fn rows(scene: &Scene, grids: &[OnGrid]) {
    println!(
        "\nErrors in %: of the solver (against what is converged on the grid) and true; area corrected for its edge."
    );
    println!(
        "On a Pareto front of energy (E) or area (A) error, both added, against time, or work (e, a); ! not converged"
    );
    println!(
        "{:>6} {:<22} {:>9} {:>12} {:>9} | {:>8} {:>8} | {:>8} {:>8} | {:>8} {:>8}",
        "nodes",
        "choice",
        "tolerance",
        "applications",
        "time/ms",
        "energy",
        "true",
        "area",
        "true",
        scene.answer_name().split(' ').next_back().unwrap_or_default(),
        "true"
    );
    let marks = marks(grids);
    let mut mark = marks.iter();
    for grid in grids {
        for row in &grid.rows {
            let applications = match row.choice.precision {
                Precision::Mixed => format!("{:.1} + {:.1}", row.applications[0], row.applications[1]),
                _ => format!("{:.1}", row.applications()),
            };
            println!(
                "{:>6} {:<22} {:>9.0e} {:>12} {:>9.2} | {:>8} {:>8} | {:>8} {:>8} | {:>8} {:>8}  {}{}",
                grid.n,
                row.choice.family(),
                row.choice.tolerance,
                applications,
                1e3 * row.seconds,
                percent(row.solver.energy),
                percent(row.whole.energy),
                percent(row.solver.area),
                percent(row.whole.area),
                percent(row.solver.answer),
                percent(row.whole.answer),
                mark.next().map_or("", String::as_str),
                if row.converged { "" } else { "!" },
            );
        }
    }
}

/// On which fronts each row is.
fn marks(grids: &[OnGrid]) -> Vec<String> {
    let all: Vec<(&OnGrid, &Row)> = pairs(grids);
    let mut marks = vec![String::new(); all.len()];
    let costs: [fn(&OnGrid, &Row) -> f64; 2] = [|_, row| row.seconds, |grid, row| row.work(grid)];
    let errors: [Part; 2] = [|e| e.energy, |e| e.area];
    for (cost, letters) in costs.iter().zip([["E", "A"], ["e", "a"]]) {
        for (error, letter) in errors.iter().zip(letters) {
            let point = |&(grid, row): &(&OnGrid, &Row)| {
                (cost(grid, row), if row.converged { row.bound(grid, *error) } else { f64::INFINITY })
            };
            let on = front(&all.iter().map(point).collect::<Vec<_>>());
            marks.iter_mut().zip(on).filter(|(_, on)| *on).for_each(|(mark, _)| mark.push_str(letter));
        }
    }
    marks
}

pub fn pairs(grids: &[OnGrid]) -> Vec<(&OnGrid, &Row)> {
    grids.iter().flat_map(|grid| grid.rows.iter().map(move |row| (grid, row))).collect()
}

/// The loosest tolerance whose solver error is a tenth of the discretisation error, on each grid, by the default in
/// `f64`.
pub fn worth(scene: &Scene, grids: &[OnGrid]) {
    let answer = scene.answer_name();
    println!(
        "\nTolerance worth using (default, f64): the loosest with a solver error of a tenth of the discretisation's"
    );
    println!("{:>6} {:>24} {:>24} {:>24} {:>9}", "nodes", "energy", "area", answer, "to 1e-6");
    for grid in grids {
        let family = Choice::sharp(1.0).family();
        let mut of: Vec<&Row> = grid.rows.iter().filter(|row| row.choice.family() == family && row.converged).collect();
        of.sort_by(|a, b| a.choice.tolerance.total_cmp(&b.choice.tolerance));
        let worth = |part: Part| {
            let enough = |row: &&&Row| part(&row.solver) <= SHARE * part(&grid.discretisation);
            let loosest = of.iter().take_while(enough).last();
            let tell = |row: &&Row| format!("{:.0e}, {:.0} applications", row.choice.tolerance, row.applications());
            loosest.map_or_else(|| "tighter".to_owned(), tell)
        };
        let default = of.iter().find(|row| row.choice.tolerance == 1e-6);
        println!(
            "{:>6} {:>24} {:>24} {:>24} {:>9}",
            grid.n,
            worth(|e| e.energy),
            worth(|e| e.area),
            worth(|e| e.answer),
            default.map_or_else(String::new, |row| format!("{:.0}", row.applications())),
        );
    }
}

/// The least work for a contact area.
pub fn targets(scene: &Scene, grids: &[OnGrid]) {
    println!("\nLeast work for the area corrected for its edge, by both errors added");
    for target in [0.05, 0.01, 0.001] {
        let fine_from = grids.iter().rposition(|grid| grid.discretisation.area > target).map_or(0, |last| last + 1);
        let rows = pairs(&grids[fine_from..]);
        let good = rows.into_iter().filter(|(grid, row)| row.converged && row.bound(grid, |e| e.area) <= target);
        let best = good.min_by(|a, b| a.1.work(a.0).total_cmp(&b.1.work(b.0)));
        let told = best.map_or_else(
            || "a finer grid".to_owned(),
            |(grid, row)| {
                format!(
                    "n = {} ({:.1} nodes per {}), {}, tolerance {:.0e}: {:.1} applications, {:.1} ms; error {} %",
                    grid.n,
                    grid.n as f64 * scene.length,
                    scene.length_name,
                    row.choice.family(),
                    row.choice.tolerance,
                    row.applications(),
                    1e3 * row.seconds,
                    percent(row.bound(grid, |e| e.area))
                )
            },
        );
        println!("{:>5} %: {told}", 100.0 * target);
    }
}
