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

/// Draws errors, of the discretisation and of the solver added, in the energy norm (above) and of the contact area
/// (below) over the tolerance, over the time, and over the work: applications times nodes, those in `f32`, of half the
/// bytes, by half.
pub fn draw(path: &Path, scene: &Scene, grids: &[OnGrid]) -> Outcome<()> {
    let root = SVGBackend::new(path, (1500, 900)).into_drawing_area();
    root.fill(&WHITE)?;
    let panels = root.titled(scene.name, ("sans-serif", 20))?.split_evenly((2, 3));
    let costs = |grid: &OnGrid, row: &Row| {
        let share = if row.family.2 { 0.5 } else { 1.0 };
        [row.tolerance, row.seconds, 1e-6 * share * row.applications * (grid.n * grid.n) as f64]
    };
    let names = ["tolerance", "time / s", "work / applications of 10⁶ nodes in f64"];
    let parts = [(0, "error of the displacement, energy norm"), (2, "error of the contact area")];
    for ((part, name), panels) in parts.into_iter().zip(panels.chunks(3)) {
        for (k, (across, panel)) in names.into_iter().zip(panels).enumerate() {
            let series = FAMILIES.into_iter().zip(COLOURS).map(|(family, colour)| {
                let rows = grids.iter().flat_map(|grid| grid.rows.iter().map(move |row| (grid, row)));
                let well = rows.filter(|(_, row)| row.converged && row.family == family);
                let error = |grid: &OnGrid, row: &Row| grid.discretisation[part] + row.solver[part];
                let points = well.map(|(grid, row)| (costs(grid, row)[k], error(grid, row))).collect();
                Series { name: family.0.to_owned(), colour, style: Style::Dots, points }
            });
            let (axes, labels) = ([across, name], SeriesLabelPosition::UpperRight);
            Chart { title: String::new(), axes, logarithmic: true, labels, series: series.collect() }.draw(panel)?;
        }
    }
    root.present()?;
    Ok(())
}
