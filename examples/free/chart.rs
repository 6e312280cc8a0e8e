//! A chart of curves and points.

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
    Line,
    Thin,
    Dots,
}

/// Points, with a name for the legend, which may be empty.
pub struct Series {
    pub name: String,
    pub colour: RGBColor,
    pub style: Style,
    pub points: Vec<(f64, f64)>,
}

/// A chart, linear or logarithmic along both axes.
pub struct Chart {
    pub title: String,
    pub axes: [&'static str; 2],
    pub logarithmic: bool,
    pub labels: SeriesLabelPosition,
    pub series: Vec<Series>,
}

impl Chart {
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
            return (low / 1.15, high * 1.15);
        }
        let margin = 0.04 * (high - low);
        (low - margin, high + margin)
    }

    fn draw_on<C>(&self, area: &DrawingArea<SVGBackend<'_>, Shift>, x: C, y: C) -> Outcome<()>
    where
        C: AsRangedCoord<Value = f64>,
        C::CoordDescType: ValueFormatter<f64>,
    {
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
            let dot = colour.filled();
            let drawn = if *style == Style::Dots {
                chart.draw_series(points.iter().map(|&point| Circle::new(point, 4, dot)))?
            } else {
                chart.draw_series(LineSeries::new(points.iter().copied(), line))?
            };
            if name.is_empty() {
                continue;
            }
            drawn.label(name);
            if *style == Style::Dots {
                drawn.legend(move |(x, y)| Circle::new((x + 11, y), 4, dot));
            } else {
                drawn.legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], line));
            }
        }
        legend(&mut chart, self.labels.clone())?;
        Ok(())
    }
}

/// A number without the rounding of its steps, nor the sign of zero.
fn label(value: &f64) -> String {
    ((1e6 * value).round() / 1e6 + 0.0).to_string()
}
