//! Pictures: fields drawn as labelled maps ([`Map`]), and curves as charts ([`Chart`]), in PNG.

mod canvas;
mod chart;
mod colours;
mod scale;

use std::path::Path;

use embedded_graphics::mono_font::MonoFont;
use embedded_graphics::mono_font::iso_8859_1::{FONT_9X15, FONT_9X18, FONT_9X18_BOLD};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::Alignment;
use ndarray::ArrayView2;

use crate::error::{Error, Result};
use crate::grid::Grid;
use canvas::{CHARACTER, Canvas, text_width};
pub use chart::Chart;
pub use colours::Colouring;
use colours::{Colours, MISSING, drawable};
use scale::{Axis, Part, three_digits};

const TITLE: &MonoFont<'_> = &FONT_9X18_BOLD;
const LABEL: &MonoFont<'_> = &FONT_9X18;
const NUMBER: &MonoFont<'_> = &FONT_9X15;
/// The height of a line of text, and of a row of ticks and numbers.
const LINE: i32 = 24;
const NUMBERS: i32 = 26;
const MARGIN: i32 = 12;
const TICK: i32 = 5;
/// The width of the colour bar, its distance from the map, and the height of its arrows.
const BAR: i32 = 22;
const GAP: i32 = 30;
const ARROW: i32 = 18;
/// The colour of a curve.
const CURVE: Rgb888 = Rgb888::new(33, 74, 135);

/// A picture of a field on a periodic rectangle, with its title, axes and legend.
///
/// x runs to the right and y upwards, both from zero to the side length wherever the grid has its origin.
/// Each node is a cell of one or more pixels; more than 1000 nodes to a side are averaged in blocks. A value
/// that is not finite has a colour of its own. The picture keeps the aspect ratio of the rectangle up to
/// 5 : 1. A line (`Nx = 1` or `Ny = 1`) is drawn as a curve, on one linear scale whatever the colouring, or
/// as a strip if that is [`Colouring::Binary`].
///
/// Units such as "m", "Pa" or "N/m" get the SI prefix that makes the numbers readable; others, and pure
/// numbers (`None`), a power of ten where they are very large or small: "gap (1e-6)".
///
/// ```
/// use asperity::picture::{Colouring, Map};
/// use asperity::Grid;
/// let grid = Grid::square(64, 500e-9)?;
/// let heights = grid.sample(|x, y| 2e-9 * (2e7 * x).cos() * (2e7 * y).cos());
/// let map = Map {
///     title: "Egg box",
///     length_unit: Some("m"),
///     label: "height",
///     unit: Some("m"),
///     ..Map::new(heights.view(), grid, Colouring::Sequential)
/// };
/// map.write_png(&std::env::temp_dir().join("asperity-egg-box.png"))?;
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Map<'a> {
    /// The values at the nodes, of shape `(Nx, Ny)`.
    pub values: ArrayView2<'a, f64>,
    /// The grid of the nodes.
    pub grid: Grid,
    /// The colours of the values.
    pub colouring: Colouring,
    /// The title; may be empty.
    pub title: &'a str,
    /// A line below the title, such as "6.8 % contact"; may be empty.
    pub caption: &'a str,
    /// The unit of the side lengths.
    pub length_unit: Option<&'a str>,
    /// The quantity, such as "pressure"; may be empty.
    pub label: &'a str,
    /// The unit of the values.
    pub unit: Option<&'a str>,
}

impl<'a> Map<'a> {
    /// A map of `values` on `grid`, as yet without text or units.
    pub fn new(values: ArrayView2<'a, f64>, grid: Grid, colouring: Colouring) -> Self {
        Self { values, grid, colouring, title: "", caption: "", length_unit: None, label: "", unit: None }
    }

    /// Draws the map and writes it to a PNG file, which it replaces.
    ///
    /// # Errors
    /// [`Error::Shape`] if the values are not on the grid, and [`Error::File`] if the file cannot be
    /// written.
    pub fn write_png(&self, path: &Path) -> Result<()> {
        Error::shape("field to draw", self.values.dim(), self.grid.shape())?;
        self.draw().0.write_png(path)
    }

    /// The picture, and where in it the map or curve is.
    fn draw(&self) -> (Canvas, Rectangle) {
        let colours = Colours::new(self.values, self.colouring);
        let (width, height) = self.size();
        let (x, y, bar) = self.axes(&colours, width, height);
        let bar_height = bar.as_ref().map_or(0, |bar| bar.height);
        let legend = self.legend();

        let legend_width = legend.iter().map(|(_, text)| legend_entry(text)).sum::<i32>();
        let widest = text_width(self.title).max(text_width(self.caption)).max(legend_width) + MARGIN;
        let lines = [self.title, self.caption].iter().filter(|text| !text.is_empty()).count() as i32;
        let left = 2 * MARGIN + y.as_ref().map_or(0, room);
        let right = bar.as_ref().map_or(3 * MARGIN, |bar| GAP + BAR + room(&bar.axis) + MARGIN);
        let top = 2 * MARGIN + lines * LINE;
        let bottom = top + height.max(bar_height - NUMBERS - LINE) + NUMBERS + LINE + MARGIN;
        let mut canvas = Canvas::new(
            left + (width + right).max(widest),
            bottom + if legend.is_empty() { 0 } else { LINE + MARGIN / 2 },
        );
        let plot = area(left, top, width, height);

        let mut row = MARGIN + LINE / 2;
        for (text, font) in [(self.title, TITLE), (self.caption, LABEL)] {
            if !text.is_empty() {
                canvas.text(text, Point::new(left, row), font, Alignment::Left);
                row += LINE;
            }
        }
        if y.is_some() && self.is_line() {
            self.draw_curve(&mut canvas, plot, &colours);
        } else {
            self.draw_cells(&mut canvas, plot, &colours);
        }
        canvas.frame(plot);
        draw_axis_below(&mut canvas, &x, plot);
        if let Some(y) = y {
            draw_axis_beside(&mut canvas, &y, plot, -1);
        }
        if let Some(bar) = bar {
            bar.draw(&mut canvas, Point::new(left + width + GAP, top), &colours);
        }
        let mut column = left;
        for (colour, text) in legend {
            let swatch = area(column, bottom, 14, 14);
            canvas.fill(swatch, colour);
            canvas.frame(swatch);
            canvas.text(&text, Point::new(column + 22, bottom + 6), LABEL, Alignment::Left);
            column += legend_entry(&text);
        }
        (canvas, plot)
    }

    fn is_line(&self) -> bool {
        let (nx, ny) = self.grid.shape();
        nx == 1 || ny == 1
    }

    /// The width and height of the map or curve.
    fn size(&self) -> (i32, i32) {
        match (self.is_line(), self.colouring) {
            (true, Colouring::Binary) => (720, 60),
            (true, _) => (720, 360.max(label_width(self.label))),
            _ => map_size(self.grid.shape(), self.grid.lengths()),
        }
    }

    /// The axis below, the one at the left, and the colour bar.
    fn axes(&self, colours: &Colours, width: i32, height: i32) -> (Axis, Option<Axis>, Option<Bar>) {
        let (lx, ly) = self.grid.lengths();
        let across = |length: f64, longest: f64, name: &str| {
            Axis::new(&[Part::side(length, longest, self.length_unit)], name, width / 90)
        };
        let binary = self.colouring == Colouring::Binary;
        if self.is_line() {
            let (length, name) = if self.grid.is_line() { (lx, "x") } else { (ly, "y") };
            let (low, high) = colours.range_of_curve();
            let values = Axis::new(&[Part::new(low, high, self.unit)], self.label, height / 50);
            return (across(length, length, name), (!binary).then_some(values), None);
        }
        let y = Axis::new(&[Part::side(ly, lx.max(ly), self.length_unit)], "y", height / 50);
        let bar = (!binary).then(|| Bar::new(colours, height.max(label_width(self.label)), self.label, self.unit));
        (across(lx, lx.max(ly), "x"), Some(y), bar)
    }

    fn legend(&self) -> Vec<(Rgb888, String)> {
        let mut legend = Vec::new();
        if self.colouring == Colouring::Binary && !self.label.is_empty() {
            legend.push((Rgb888::BLACK, self.label.to_owned()));
            legend.push((Rgb888::WHITE, format!("no {}", self.label)));
        }
        if self.values.iter().any(|v| !drawable(*v)) {
            legend.push((MISSING, "not finite".to_owned()));
        }
        legend
    }

    /// Every pixel in the colour of its node, or of the mean of its nodes.
    fn draw_cells(&self, canvas: &mut Canvas, plot: Rectangle, colours: &Colours) {
        let (nx, ny) = self.grid.shape();
        // A line along y is drawn along x.
        let (values, nx, ny) = if nx == 1 { (self.values.reversed_axes(), ny, nx) } else { (self.values, nx, ny) };
        let (width, height) = (plot.size.width as usize, plot.size.height as usize);
        let nodes = |pixel: usize, pixels: usize, n: usize| {
            let first = pixel * n / pixels;
            first..((pixel + 1) * n / pixels).max(first + 1)
        };
        let pixels = (0..height).rev().flat_map(|row| {
            let across = nodes(row, height, ny);
            (0..width).map(move |column| {
                let along = nodes(column, width, nx);
                let count = along.len() * across.len();
                let cells = along.flat_map(|ix| across.clone().map(move |iy| colours.shown(values[[ix, iy]])));
                colours.of(cells.sum::<f64>() / count as f64)
            })
        });
        let Ok(()) = canvas.fill_contiguous(&plot, pixels);
    }

    /// The values on a line as a curve, periodically continued to the frame.
    fn draw_curve(&self, canvas: &mut Canvas, plot: Rectangle, colours: &Colours) {
        let (low, high) = colours.range_of_curve();
        let (left, top) = (f64::from(plot.top_left.x), f64::from(plot.top_left.y));
        let (width, height) = (f64::from(plot.size.width), f64::from(plot.size.height));
        let values: Vec<f64> = self.values.iter().map(|v| colours.shown(*v)).collect();
        let cell = width / values.len() as f64;
        let above = |v: f64| top + height * (high - v) / (high - low);
        if low < 0.0 && high > 0.0 {
            canvas.fill(area(plot.top_left.x, above(0.0) as i32, width as i32, 1), Rgb888::CSS_LIGHT_GRAY);
        }
        for (i, _) in values.iter().enumerate().filter(|(_, v)| v.is_nan()) {
            let (from, to) = ((i as f64 * cell) as i32, ((i + 1) as f64 * cell).ceil() as i32);
            canvas.fill(area(plot.top_left.x + from, plot.top_left.y, to - from, height as i32), MISSING);
        }
        let around = values.last().into_iter().chain(&values).chain(values.first());
        let points: Vec<_> = around.enumerate().map(|(i, v)| (left + (i as f64 - 0.5) * cell, above(*v))).collect();
        canvas.curve(&points, plot, CURVE);
    }
}

/// A colour bar with its numbers, and an arrow at each end beyond which there are values.
struct Bar {
    axis: Axis,
    height: i32,
    /// The room for the arrows at the lower and the upper end.
    arrows: (i32, i32),
}

impl Bar {
    fn new(colours: &Colours, height: i32, name: &str, unit: Option<&str>) -> Self {
        let parts: Vec<_> = colours.ranges().into_iter().map(|(from, to)| Part::new(from, to, unit)).collect();
        let mut axis = Axis::new(&parts, name, height / 50);
        let (below, above) = colours.beyond();
        let arrows = (if below { ARROW } else { 0 }, if above { ARROW } else { 0 });
        let tip = f64::from(ARROW) / f64::from(height - arrows.0 - arrows.1);
        if below {
            axis.ticks.push((-tip, format!("min {}", three_digits(colours.extremes.0, unit))));
        }
        if above {
            axis.ticks.push((1.0 + tip, format!("max {}", three_digits(colours.extremes.1, unit))));
        }
        Self { axis, height, arrows }
    }

    fn draw(&self, canvas: &mut Canvas, at: Point, colours: &Colours) {
        let height = self.height - self.arrows.0 - self.arrows.1;
        let body = area(at.x, at.y + self.arrows.1, BAR, height);
        let ranges = colours.ranges();
        canvas.frame(body);
        for row in 0..height {
            let along = (f64::from(height - row) - 0.5) / f64::from(height) * ranges.len() as f64;
            let (from, to) = ranges[along as usize];
            let colour = colours.of(from + (to - from) * along.fract());
            canvas.fill(area(at.x, body.top_left.y + row, BAR, 1), colour);
        }
        for (room, base, tip, end) in [
            (self.arrows.0, body.top_left.y + height, at.y + self.height, colours.limits.0),
            (self.arrows.1, body.top_left.y - 1, at.y - 1, colours.limits.1),
        ] {
            if room > 0 {
                let corners = [(-1, base), (BAR, base), (BAR / 2, tip)].map(|(x, y)| Point::new(at.x + x, y));
                canvas.triangle(corners, colours.of(end));
            }
        }
        draw_axis_beside(canvas, &self.axis, body, 1);
    }
}

/// Draws the numbers and the label of an axis below `plot`.
fn draw_axis_below(canvas: &mut Canvas, axis: &Axis, plot: Rectangle) {
    let (left, bottom) = (plot.top_left.x, plot.top_left.y + plot.size.height as i32);
    let width = f64::from(plot.size.width);
    for (fraction, number) in &axis.ticks {
        let x = left + (fraction * width).round() as i32;
        canvas.fill(area(x, bottom, 1, TICK), Rgb888::BLACK);
        canvas.text(number, Point::new(x, bottom + TICK + 10), NUMBER, Alignment::Center);
    }
    let middle = Point::new(left + (0.5 * width) as i32, bottom + NUMBERS + LINE / 2);
    canvas.text(&axis.label, middle, LABEL, Alignment::Center);
}

/// Draws the numbers and the label of an axis at the left (`side = -1`) or the right (`1`) of `plot`.
fn draw_axis_beside(canvas: &mut Canvas, axis: &Axis, plot: Rectangle, side: i32) {
    let height = plot.size.height as i32;
    let (bottom, edge) = (plot.top_left.y + height - 1, if side < 0 { -1 } else { plot.size.width as i32 });
    let edge = plot.top_left.x + edge;
    for (fraction, number) in &axis.ticks {
        let y = bottom - (fraction * f64::from(height)).round() as i32;
        canvas.fill(area(edge.min(edge + side * TICK), y, TICK + 1, 1), Rgb888::BLACK);
        let alignment = if side < 0 { Alignment::Right } else { Alignment::Left };
        canvas.text(number, Point::new(edge + side * (TICK + 4), y), NUMBER, alignment);
    }
    let middle = edge + side * (room(axis) - LINE / 2);
    canvas.text_upwards(&axis.label, Point::new(middle, bottom - height / 2), LABEL);
}

/// The room beside a plot for the numbers and the label of an axis.
fn room(axis: &Axis) -> i32 {
    TICK + MARGIN + axis.widest() as i32 * CHARACTER + if axis.label.is_empty() { 0 } else { LINE }
}

fn legend_entry(text: &str) -> i32 {
    text_width(text) + 6 * CHARACTER
}

/// The length of an axis that has room for its label and a unit, and for enough numbers.
fn label_width(label: &str) -> i32 {
    (text_width(label) + 10 * CHARACTER).max(200)
}

fn area(left: i32, top: i32, width: i32, height: i32) -> Rectangle {
    Rectangle::new(Point::new(left, top), Size::new(width.unsigned_abs(), height.unsigned_abs()))
}

/// The pixels of a map: the longer side has a whole number of pixels for each node, about 600 in all, or of
/// nodes for each pixel, at most 1000 pixels.
fn map_size((nx, ny): (usize, usize), (lx, ly): (f64, f64)) -> (i32, i32) {
    let aspect = (lx / ly).clamp(0.2, 5.0);
    let (long, short, aspect) = if aspect >= 1.0 { (nx, ny, aspect) } else { (ny, nx, 1.0 / aspect) };
    // Where the nodes are closer along the shorter side, that decides.
    let nodes = (long as f64).max(short as f64 * aspect).round();
    let pixels = if nodes > 1000.0 {
        (nodes / (nodes / 1000.0).ceil()).ceil()
    } else {
        nodes * (600.0 / nodes).round().max(1.0)
    };
    let (pixels, across) = (pixels as i32, (pixels / aspect).round() as i32);
    if lx >= ly { (pixels, across) } else { (across, pixels) }
}

#[cfg(test)]
mod tests;
