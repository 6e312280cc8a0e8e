//! Pictures of the measured errors, times and counts.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::choice::Choice;
use crate::error::{OnGrid, Part, Row};
use crate::front::front;
use crate::scene::Scene;
use crate::table::pairs;
use common::Outcome;

/// The families of choices and their colours.
const FAMILIES: [(&str, RGBColor); 7] = [
    ("default, f64", RGBColor(10, 40, 140)),
    ("nested, f64", RGBColor(0, 130, 80)),
    ("default, f32", RGBColor(110, 160, 240)),
    ("nested, f32", RGBColor(110, 200, 140)),
    ("default, f32 then f64", RGBColor(150, 90, 170)),
    ("nested, f32 then f64", RGBColor(225, 130, 20)),
    ("rey2017, f64", RGBColor(200, 30, 20)),
];
/// Of grids, from coarse to fine.
const GRIDS: [RGBColor; 5] = [
    RGBColor(170, 190, 230),
    RGBColor(110, 150, 220),
    RGBColor(50, 100, 200),
    RGBColor(10, 50, 150),
    RGBColor(0, 0, 60),
];
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Lines, or points, in a colour.
struct Series {
    name: String,
    colour: RGBColor,
    points: Vec<(f64, f64)>,
    line: bool,
}

/// Draws errors, of the discretisation and of the solver added, in the energy norm (above) and of the contact area
/// (below) over the tolerance, over the time, and over the work.
pub fn draw(path: &Path, scene: &Scene, grids: &[OnGrid]) -> Outcome<()> {
    let root = SVGBackend::new(path, (1500, 900)).into_drawing_area();
    root.fill(&WHITE)?;
    let titled = root.titled(scene.title, ("sans-serif", 20))?;
    let panels = titled.split_evenly((2, 3));
    let parts: [(&str, Part); 2] =
        [("error of the displacement, energy norm", |e| e.energy), ("error of the contact area", |e| e.area)];
    for ((name, part), panels) in parts.iter().zip(panels.chunks(3)) {
        panel(&panels[0], ("tolerance (default, f64)", name), &over_tolerance(grids, *part), true)?;
        panel(&panels[1], ("time / s", name), &over(grids, *part, |_, row| row.seconds), false)?;
        let work = over(grids, *part, |grid, row| row.work(grid));
        panel(&panels[2], ("work / applications of 10⁶ nodes in f64", name), &work, false)?;
    }
    root.present()?;
    Ok(())
}

/// One line for each grid, by the default in `f64`.
fn over_tolerance(grids: &[OnGrid], part: Part) -> Vec<Series> {
    let family = Choice::sharp(1.0).family();
    let lines = grids.iter().zip(GRIDS.into_iter().cycle()).map(|(grid, colour)| {
        let rows = grid.rows.iter().filter(|row| row.choice.family() == family);
        let points = rows.map(|row| (row.choice.tolerance, row.bound(grid, part))).collect();
        Series { name: format!("{} nodes", grid.n), colour, points, line: true }
    });
    lines.collect()
}

/// A cloud for each family, and the front of all that has converged.
fn over(grids: &[OnGrid], part: Part, cost: fn(&OnGrid, &Row) -> f64) -> Vec<Series> {
    let converged: Vec<_> = pairs(grids).into_iter().filter(|(_, row)| row.converged).collect();
    let point = |&(grid, row): &(&OnGrid, &Row)| (cost(grid, row), row.bound(grid, part));
    let all: Vec<_> = converged.iter().map(point).collect();
    let mut best: Vec<_> = all.iter().zip(front(&all)).filter(|(_, on)| *on).map(|(point, _)| *point).collect();
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    let front = Series { name: "Pareto front".to_owned(), colour: BLACK, points: best, line: true };
    let clouds = FAMILIES.iter().map(|&(name, colour)| {
        let points = converged.iter().filter(|(_, row)| row.choice.family() == name).map(point).collect();
        Series { name: name.to_owned(), colour, points, line: false }
    });
    std::iter::once(front).chain(clouds).collect()
}

/// A tick of a logarithmic axis; those between one, two and five of a decade would run into each other.
fn label(value: &f64) -> String {
    let text = format!("{value:.0e}");
    if text.starts_with(['1', '2', '5']) { text } else { String::new() }
}

fn panel(area: &Area<'_>, (across, upwards): (&str, &str), series: &[Series], reversed: bool) -> Outcome<()> {
    let all = || series.iter().flat_map(|series| &series.points).filter(|point| point.0 > 0.0 && point.1 > 0.0);
    let ends = |of: fn(&(f64, f64)) -> f64| {
        let (low, high) = all().map(of).fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        if low < high { (0.7 * low, 1.4 * high) } else { (1e-3, 1.0) }
    };
    let ((left, right), (low, high)) = (ends(|p| p.0), ends(|p| p.1));
    // room for the legend
    let high = high * (high / low).powf(0.5);
    let x = if reversed { right..left } else { left..right };
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(74)
        .build_cartesian_2d(x.log_scale(), (low..high).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc(across)
        .y_desc(upwards)
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .label_style(("sans-serif", 13))
        .axis_desc_style(("sans-serif", 15))
        .draw()?;
    for Series { name, colour, points, line } in series.iter().filter(|series| !series.points.is_empty()) {
        let colour = *colour;
        let points = points.iter().copied().filter(|point| point.1 > 0.0);
        if *line {
            chart
                .draw_series(LineSeries::new(points, colour.stroke_width(2)))?
                .label(name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
        } else {
            chart
                .draw_series(points.map(|point| Circle::new(point, 4, colour.filled())))?
                .label(name)
                .legend(move |(x, y)| Circle::new((x + 9, y), 4, colour.filled()));
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.8))
        .border_style(RGBColor(180, 180, 180))
        .label_font(("sans-serif", 12))
        .draw()?;
    Ok(())
}
