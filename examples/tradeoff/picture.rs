//! Pictures of the measured errors, times and counts.

use std::path::Path;

use plotters::prelude::*;

use crate::error::{OnGrid, Row};
use crate::scene::{FAMILIES, Scene};
use common::Outcome;
use common::chart::{Chart, Series, Style};

/// The colours of the families of choices.
const COLOURS: [RGBColor; 5] = [
    RGBColor(10, 40, 140),
    RGBColor(0, 130, 80),
    RGBColor(110, 160, 240),
    RGBColor(110, 200, 140),
    RGBColor(200, 30, 20),
];

/// Draws errors, of the discretisation and of the solver added, in the energy norm (left) and of the contact area
/// (right) over the tolerance, over the time, and over the work: applications times nodes, those in `f32`, of half the
/// bytes, by half.
pub fn draw(path: &Path, scene: &Scene, grids: &[OnGrid]) -> Outcome<()> {
    let root = SVGBackend::new(path, (760, 1120)).into_drawing_area();
    root.fill(&WHITE)?;
    let (head, panels) = root.split_vertically(36);
    head.draw(&Text::new(scene.name, (20, 10), ("sans-serif", 19)))?;
    for (x, (family, colour)) in (110..).step_by(130).zip(FAMILIES.into_iter().zip(COLOURS)) {
        head.draw(&Circle::new((x, 18), 4, colour.filled()))?;
        head.draw(&Text::new(family.0, (x + 12, 12), ("sans-serif", 15)))?;
    }
    let panels = panels.split_evenly((3, 2));
    let costs = |grid: &OnGrid, row: &Row| {
        let share = if row.family.2 { 0.5 } else { 1.0 };
        [row.tolerance, row.seconds, 1e-6 * share * row.applications * (grid.n * grid.n) as f64]
    };
    let names = ["tolerance", "time (s)", "work (applications × 10⁶ nodes)"];
    let parts = [(0, "displacement, energy norm"), (2, "contact area")];
    for (k, (across, panels)) in names.into_iter().zip(panels.chunks(2)).enumerate() {
        for ((part, name), panel) in parts.into_iter().zip(panels) {
            let series = FAMILIES.into_iter().zip(COLOURS).map(|(family, colour)| {
                let rows = grids.iter().flat_map(|grid| grid.rows.iter().map(move |row| (grid, row)));
                let well = rows.filter(|(_, row)| row.converged && row.family == family);
                let error = |grid: &OnGrid, row: &Row| grid.discretisation[part] + row.solver[part];
                let points = well.map(|(grid, row)| (costs(grid, row)[k], error(grid, row))).collect();
                Series { name: String::new(), colour, style: Style::Dots, points }
            });
            let (axes, labels) = ([across, "relative error"], SeriesLabelPosition::UpperRight);
            Chart { title: name.to_owned(), axes, logarithmic: true, labels, series: series.collect() }.draw(panel)?;
        }
    }
    root.present()?;
    Ok(())
}
