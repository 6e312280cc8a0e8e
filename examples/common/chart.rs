//! A chart of curves and points.

use std::path::Path;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

use crate::Outcome;
use crate::legend::legend;

/// The colours of what was computed; what is exact is black.
pub const COLOURS: [RGBColor; 3] = [RGBColor(10, 90, 200), RGBColor(225, 110, 20), RGBColor(0, 140, 100)];

/// How points are drawn.
#[derive(Clone, Copy, PartialEq)]
pub enum Style {
    /// A line.
    Line,
    /// A thin line.
    Thin,
    /// A dot each.
    Dots,
    /// A small dot each.
    Specks,
    /// A circle each.
    Rings,
}

impl Style {
    /// The radius of points, if that is what is drawn.
    fn radius(self) -> Option<i32> {
        match self {
            Self::Line | Self::Thin => None,
            Self::Dots | Self::Rings => Some(4),
            Self::Specks => Some(2),
        }
    }
}

/// Points, with a name for the legend, which may be empty.
pub struct Series {
    /// The name.
    pub name: String,
    /// The colour.
    pub colour: RGBColor,
    /// As a line or as points.
    pub style: Style,
    /// Their coordinates.
    pub points: Vec<(f64, f64)>,
}

/// A chart, linear or logarithmic along both axes.
pub struct Chart {
    /// The line above it.
    pub title: String,
    /// The names of the axes.
    pub axes: [&'static str; 2],
    /// Whether both axes are.
    pub logarithmic: bool,
    /// Where the legend is.
    pub labels: SeriesLabelPosition,
    /// What is drawn, the last one on top.
    pub series: Vec<Series>,
}

impl Chart {
    /// Writes it as SVG, in a folder that is made if it is not there.
    pub fn save(&self, path: &Path) -> Outcome<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let root = SVGBackend::new(path, (900, 640)).into_drawing_area();
        root.fill(&WHITE)?;
        self.draw(&root)?;
        root.present()?;
        Ok(())
    }

    /// Draws it on an area.
    pub fn draw(&self, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Outcome<()> {
        let area = area.titled(&self.title, ("sans-serif", 19))?;
        let [x, y] = [self.range(|point| point.0), self.range(|point| point.1)];
        if self.logarithmic {
            self.draw_on(&area, (x.0..x.1).log_scale(), (y.0..y.1).log_scale())
        } else {
            self.draw_on(&area, x.0..x.1, y.0..y.1)
        }
    }

    /// The least and the largest of the coordinates, and a little more.
    fn range(&self, coordinate: impl Fn(&(f64, f64)) -> f64) -> (f64, f64) {
        let all = self.series.iter().flat_map(|series| &series.points).map(coordinate);
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        if self.logarithmic {
            // labels begin at a power of ten
            let power = 10_f64.powf(low.log10().floor());
            return (if 10.0 * power > high { power } else { low } / 1.15, high * 1.15);
        }
        let margin = 0.04 * (high - low);
        (low - margin, high + margin)
    }

    fn draw_on<C>(&self, area: &DrawingArea<SVGBackend<'_>, Shift>, x: C, y: C) -> Outcome<()>
    where
        C: AsRangedCoord<Value = f64>,
        C::CoordDescType: ValueFormatter<f64>,
    {
        let label = if self.logarithmic { power } else { plain };
        let mut chart = ChartBuilder::on(area)
            .margin(14)
            .margin_right(26)
            .x_label_area_size(50)
            .y_label_area_size(80)
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .x_desc(self.axes[0])
            .y_desc(self.axes[1])
            .label_style(("sans-serif", 15))
            .x_label_formatter(&label)
            .y_label_formatter(&label)
            .draw()?;
        for Series { name, colour, style, points } in &self.series {
            let line = colour.stroke_width(if *style == Style::Line { 3 } else { 1 });
            let dot = if *style == Style::Rings { colour.stroke_width(1) } else { colour.filled() };
            let drawn = match style.radius() {
                Some(radius) => chart.draw_series(points.iter().map(|&point| Circle::new(point, radius, dot)))?,
                None => chart.draw_series(LineSeries::new(points.iter().copied(), line))?,
            };
            if name.is_empty() {
                continue;
            }
            drawn.label(name);
            match style.radius() {
                Some(radius) => drawn.legend(move |(x, y)| Circle::new((x + 11, y), radius, dot)),
                None => drawn.legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], line)),
            };
        }
        if self.series.iter().any(|series| !series.name.is_empty()) {
            legend(&mut chart, self.labels.clone())?;
        }
        Ok(())
    }
}

/// A number without the rounding of its steps, nor the sign of zero.
fn plain(value: &f64) -> String {
    ((1e6 * value).round() / 1e6 + 0.0).to_string()
}

/// A number of a logarithmic axis, far from one as a power of ten; 1, 2 and 5 of a decade.
fn power(value: &f64) -> String {
    let scientific = format!("{value:.0e}");
    if !scientific.starts_with(['1', '2', '5']) {
        return String::new();
    }
    if (1e-3..1e4).contains(value) { plain(value) } else { scientific }
}
