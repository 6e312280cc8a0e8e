//! The chart: curves over two axes.

use std::path::Path;

use super::canvas::{Canvas, text_width};
use super::scale::{Axis, Part};
use super::{LABEL, LINE, MARGIN, NUMBERS, TITLE, area, draw_axis_below, draw_axis_beside, legend_entry, room};
use crate::error::Result;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::text::Alignment;

/// Curves over two linear axes, such as the loads on a path over its mean gaps.
///
/// The axes reach over all points that are finite; a curve is broken where they are not. Units are written as those of
/// a [`Map`](super::Map).
///
/// ```
/// use asperity::picture::Chart;
/// let wave = (0..100).map(|i| (f64::from(i), (0.1 * f64::from(i)).sin())).collect();
/// let chart = Chart { x_label: "time", y_label: "height", curves: vec![("wave", wave)], ..Chart::default() };
/// chart.write_png(&std::env::temp_dir().join("asperity-wave.png"))?;
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Chart<'a> {
    /// The title; may be empty.
    pub title: &'a str,
    /// A line below the title; may be empty.
    pub caption: &'a str,
    /// The quantity x, to the right.
    pub x_label: &'a str,
    /// Its unit.
    pub x_unit: Option<&'a str>,
    /// The quantity y, upwards.
    pub y_label: &'a str,
    /// Its unit.
    pub y_unit: Option<&'a str>,
    /// The curves: their names, for the legend, and their points (x, y).
    pub curves: Vec<(&'a str, Vec<(f64, f64)>)>,
}

const SIZE: (i32, i32) = (720, 480);
/// Blue, red, green, violet: distinct also to eyes that confuse two of them, by their lightness.
const COLOURS: [Rgb888; 4] =
    [Rgb888::new(33, 74, 135), Rgb888::new(214, 96, 30), Rgb888::new(0, 140, 100), Rgb888::new(150, 90, 170)];
/// The part of an axis beyond the points, as a share of their range.
const SLACK: f64 = 0.03;

impl Chart<'_> {
    /// Draws the curves and writes them to a PNG file, which it replaces.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if the file cannot be written.
    pub fn write_png(&self, path: &Path) -> Result<()> {
        let (width, height) = SIZE;
        let [x_range, y_range] = [|p: &(f64, f64)| p.0, |p: &(f64, f64)| p.1].map(|of| self.range(of));
        let x = Axis::new(&[Part::new(x_range.0, x_range.1, self.x_unit)], self.x_label, width / 90);
        let y = Axis::new(&[Part::new(y_range.0, y_range.1, self.y_unit)], self.y_label, height / 50);
        let lines = [self.title, self.caption].iter().filter(|text| !text.is_empty()).count() as i32;
        let (left, top) = (2 * MARGIN + room(&y), 2 * MARGIN + lines * LINE);
        let legend: i32 = self.curves.iter().map(|(name, _)| legend_entry(name)).sum();
        let widest =
            (width + 3 * MARGIN).max(text_width(self.caption).max(text_width(self.title)).max(legend) + MARGIN);
        let bottom = top + height + NUMBERS + LINE + MARGIN;
        let mut canvas = Canvas::new(left + widest, bottom + LINE + MARGIN / 2);
        let mut row = MARGIN + LINE / 2;
        for (text, font) in [(self.title, TITLE), (self.caption, LABEL)] {
            if !text.is_empty() {
                canvas.text(text, Point::new(left, row), font, Alignment::Left);
                row += LINE;
            }
        }
        let plot = area(left, top, width, height);
        let across = |v: f64| f64::from(left) + f64::from(width) * (v - x_range.0) / (x_range.1 - x_range.0);
        let above = |v: f64| f64::from(top) + f64::from(height) * (y_range.1 - v) / (y_range.1 - y_range.0);
        if y_range.0 < 0.0 && y_range.1 > 0.0 {
            canvas.fill(area(left, above(0.0) as i32, width, 1), Rgb888::CSS_LIGHT_GRAY);
        }
        let mut column = left;
        for ((name, points), colour) in self.curves.iter().zip(COLOURS.into_iter().cycle()) {
            let points: Vec<_> = points.iter().map(|&(x, y)| (across(x), above(y))).collect();
            let points: Vec<_> =
                points.into_iter().map(|(x, y)| if x.is_finite() { (x, y) } else { (0.0, f64::NAN) }).collect();
            canvas.curve(&points, plot, colour);
            canvas.fill(area(column, bottom + 5, 14, 3), colour);
            canvas.text(name, Point::new(column + 22, bottom + 6), LABEL, Alignment::Left);
            column += legend_entry(name);
        }
        canvas.frame(plot);
        draw_axis_below(&mut canvas, &x, plot);
        draw_axis_beside(&mut canvas, &y, plot, -1);
        canvas.write_png(path)
    }

    /// From the least to the largest finite value, and a little beyond.
    fn range(&self, of: impl Fn(&(f64, f64)) -> f64) -> (f64, f64) {
        let values = self.curves.iter().flat_map(|(_, points)| points).map(of).filter(|value| value.is_finite());
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        match high - low {
            span if span > 0.0 && span.is_finite() => (low - SLACK * span, high + SLACK * span),
            _ if low.is_finite() => (low - low.abs().max(1e-3), low + low.abs().max(1e-3)),
            _ => (0.0, 1.0),
        }
    }
}
