//! The chart: curves over two axes.

use crate::frame::{
    Entry, LINE, MARGIN, NUMBERS, STEP_BELOW, STEP_BESIDE, Texts, dashed, draw_axis_below, draw_axis_beside, room,
};
use crate::scale::{Axis, Part};
use crate::shape::{Area, BLACK, Colour, Curve, GREY, HAIRLINE, Shape};
use crate::{Paper, Picture};
use asperity::Result;

/// Curves over two axes, such as the loads on a path over its mean gaps.
///
/// The axes reach over all points that are finite, and on a logarithmic one positive; other points break a curve. Where
/// no coloured curve has more than thirty points, each point of them has a dot. A curve without points is an entry of
/// the legend alone. Units are written as in a [`Map`](super::Map).
///
/// ```
/// use asperity_plot::{Chart, DPI};
/// let wave = (0..100).map(|i| (f64::from(i), (0.1 * f64::from(i)).sin())).collect();
/// let chart = Chart { x_label: "time", y_label: "height", curves: vec![("wave", wave)], ..Chart::default() };
/// chart.draw(DPI)?.write(&std::env::temp_dir().join("asperity-wave.svg"))?;
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
    /// Whether its axis is logarithmic.
    pub x_log: bool,
    /// The quantity y, upwards.
    pub y_label: &'a str,
    /// Its unit.
    pub y_unit: Option<&'a str>,
    /// Whether its axis is logarithmic.
    pub y_log: bool,
    /// The curves: their names, for the legend, and their points (x, y).
    pub curves: Vec<(&'a str, Vec<(f64, f64)>)>,
    /// The styles of the curves in their order; further curves are solid, each in a colour of its own.
    pub styles: Vec<Style>,
    /// Jumps between two points of curves, which are drawn as dashed lines.
    pub jumps: Vec<[(f64, f64); 2]>,
}

/// The style of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// The number of its colour, eight in turn; black if there is none.
    pub colour: Option<usize>,
    /// The number of its dashes, four in turn; 0 is a solid line.
    pub dashes: usize,
}

const SIZE: (f64, f64) = (360.0, 240.0);
/// Blue, red, green, violet: distinct also to eyes that confuse two of them, by their lightness. Then sky blue, ochre,
/// brown and grey.
pub(super) const COLOURS: [Colour; 8] = [
    [33, 74, 135],
    [214, 96, 30],
    [0, 140, 100],
    [150, 90, 170],
    [95, 175, 225],
    [225, 170, 30],
    [120, 60, 35],
    [125, 125, 125],
];
/// The width of a curve, and the diameter of its dots.
pub(super) const WIDTH: f64 = 1.0;
const DOT: f64 = 3.5;
/// The largest number of points on a curve of a chart with dots.
const MOST_DOTS: usize = 30;
/// The lengths of dashes and of the spaces behind them, in turn; none of a solid line.
const DASHES: [&[f64]; 4] = [&[], &[5.0, 3.5], &[0.5, 3.0], &[8.0, 3.5, 0.5, 3.5]];
/// The dashes of a jump.
const JUMP: &[f64] = &[3.0, 3.0];
/// The part of an axis beyond the points, as a share of their range.
const SLACK: f64 = 0.03;

/// The range of an axis, and the unit of its numbers.
#[derive(Clone, Copy)]
struct Range<'a> {
    low: f64,
    high: f64,
    logarithmic: bool,
    unit: Option<&'a str>,
}

impl Range<'_> {
    fn part(&self) -> Part {
        if self.logarithmic {
            Part::logarithmic(self.low, self.high, self.unit)
        } else {
            Part::new(self.low, self.high, self.unit)
        }
    }
}

impl Chart<'_> {
    /// Draws the curves on a [`Paper`], or for pixels per inch: [`DPI`](super::DPI), or more.
    ///
    /// # Errors
    /// [`Error::Value`](asperity::Error::Value) if these are below 36 or above 1200, or the paper is too narrow.
    pub fn draw(&self, paper: impl Into<Paper>) -> Result<Picture> {
        let paper = paper.into();
        let height = paper.width.map_or(SIZE.1, |width| 0.5 * width);
        let x = self.range(|point| point.0, self.x_log, self.x_unit);
        let y = self.range(|point| point.1, self.y_log, self.y_unit);
        let beside = Axis::new(&y.part(), self.y_label, (height / STEP_BESIDE) as i32);
        let left = room(&beside);
        let width = paper.across(5.0 * MARGIN + left, SIZE.0)?;
        let below = Axis::new(&x.part(), self.x_label, (width / STEP_BELOW) as i32);
        let entries = self.curves.iter().enumerate().map(|(k, (name, _))| {
            let (colour, dashes) = self.style(k);
            Entry { colour, line: Some(dashes), text: (*name).to_owned() }
        });
        let legend = entries.filter(|entry| !entry.text.is_empty()).collect();
        let texts = Texts::new([self.title, self.caption], legend, paper.width.map(|_| width + 2.0 * MARGIN));

        let plot = Area::new(2.0 * MARGIN + left, texts.above(), width, height);
        let bottom = plot.bottom() + NUMBERS + LINE + MARGIN;
        let across = (width + 3.0 * MARGIN).max(texts.widest() + MARGIN);
        let mut picture =
            Picture::new(self.title, ((plot.left + across).ceil(), bottom + texts.below(across)), paper.dpi)?;
        let (along, above) = (x.part(), y.part());
        if !y.logarithmic && y.low < 0.0 && y.high > 0.0 {
            let zero = plot.bottom() - plot.height * above.share(0.0);
            picture.fill(Area::new(plot.left, zero - 0.5 * HAIRLINE, plot.width, HAIRLINE), GREY);
        }
        let place = |&(x, y): &(f64, f64)| {
            (plot.left + plot.width * along.share(x), plot.bottom() - plot.height * above.share(y))
        };
        for jump in &self.jumps {
            let pieces = dashed(pieces(&jump.each_ref().map(place)), JUMP);
            picture.shapes.push(Shape::Curve(Curve { pieces, width: HAIRLINE, colour: BLACK, within: plot }));
        }
        let dots = |points: &[(f64, f64)]| points.iter().filter(|(x, y)| x.is_finite() && y.is_finite()).count();
        let curves: Vec<_> = self.curves.iter().enumerate().map(|(k, (_, points))| (points, self.style(k))).collect();
        let dotted = curves.iter().all(|(points, (colour, _))| *colour == BLACK || dots(points) <= MOST_DOTS);
        for (points, (colour, dashes)) in curves {
            let points: Vec<_> = points.iter().map(place).collect();
            let curve = |pieces, width| Shape::Curve(Curve { pieces, width, colour, within: plot });
            let pieces = pieces(&points);
            if dotted && colour != BLACK {
                let dots = pieces.iter().flatten().map(|point| vec![*point]).collect();
                picture.shapes.push(curve(dots, DOT));
            }
            picture.shapes.push(curve(dashed(pieces, dashes), WIDTH));
        }
        picture.outline(plot);
        draw_axis_below(&mut picture, &below, plot);
        draw_axis_beside(&mut picture, &beside, plot, -1.0, left);
        texts.draw(&mut picture, plot.left, bottom, across);
        Ok(picture)
    }

    /// The colour and the dashes of a curve by its number.
    fn style(&self, k: usize) -> (Colour, &'static [f64]) {
        let Style { colour, dashes } = self.styles.get(k).copied().unwrap_or(Style { colour: Some(k), dashes: 0 });
        (colour.map_or(BLACK, |colour| COLOURS[colour % COLOURS.len()]), DASHES[dashes % DASHES.len()])
    }

    /// From the least to the largest value that the axis can have, and a little beyond.
    fn range<'u>(&self, of: impl Fn(&(f64, f64)) -> f64, logarithmic: bool, unit: Option<&'u str>) -> Range<'u> {
        let values = self.curves.iter().flat_map(|(_, points)| points).map(of);
        let values = values.filter(|value| value.is_finite() && (!logarithmic || *value > 0.0));
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let (low, high) = if logarithmic {
            let slack = (high / low).powf(SLACK);
            match high / low {
                ratio if ratio > 1.0 && ratio.is_finite() => (low / slack, high * slack),
                _ if low.is_finite() => (low / 2.0, low * 2.0),
                _ => (0.1, 1.0),
            }
        } else {
            match high - low {
                span if span > 0.0 && span.is_finite() => (low - SLACK * span, high + SLACK * span),
                _ if low.is_finite() => (low - low.abs().max(1e-3), low + low.abs().max(1e-3)),
                _ => (0.0, 1.0),
            }
        };
        Range { low, high, logarithmic, unit }
    }
}

/// The pieces of a curve, which is broken where a point is not finite.
pub(super) fn pieces(points: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
    let finite = |point: &(f64, f64)| point.0.is_finite() && point.1.is_finite();
    points.split(|point| !finite(point)).filter(|piece| !piece.is_empty()).map(<[_]>::to_vec).collect()
}
