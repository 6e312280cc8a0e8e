//! The frame of a map or chart: title, caption, axes and legend.

use crate::Picture;
use crate::font;
use crate::font::width;
use crate::scale::Axis;
use crate::shape::{Anchor, Area, BLACK, Colour, Curve, HAIRLINE, INK, Shape};

/// The sizes of the font.
pub(super) const TITLE: f64 = 10.0;
pub(super) const LABEL: f64 = 9.0;
pub(super) const NUMBER: f64 = 8.0;
/// The height of a line of text, and of a row of ticks and numbers.
pub(super) const LINE: f64 = 13.0;
pub(super) const NUMBERS: f64 = 14.0;
pub(super) const MARGIN: f64 = 6.0;
const TICK: f64 = 3.0;
/// The distance between an axis and the next number, and that between two numbers below.
const SPACE: f64 = 2.0;
/// The side of a square in the legend, or the length of a line, which is longer if it is black; and the distance from it
/// to its text, and to the next one.
const SWATCH: f64 = 7.0;
const BLACK_LINE: f64 = 24.0;
const SWATCH_SPACE: f64 = 4.0;
const ENTRY_SPACE: f64 = 14.0;

/// How much of an axis a number takes, below and next to a plot.
pub(super) const STEP_BELOW: f64 = 45.0;
pub(super) const STEP_BESIDE: f64 = 25.0;

/// An entry of a legend: its colour, the dashes if that is the colour of a line and not of an area, and its text.
pub(super) struct Entry {
    pub(super) colour: Colour,
    pub(super) line: Option<&'static [f64]>,
    pub(super) text: String,
}

impl Entry {
    fn swatch(&self) -> f64 {
        if self.line.is_some() && self.colour == BLACK { BLACK_LINE } else { SWATCH }
    }

    fn width(&self) -> f64 {
        self.swatch() + SWATCH_SPACE + width(&self.text, LABEL) + ENTRY_SPACE
    }
}

/// The texts above and below a plot: lines of a size, and a legend.
pub(super) struct Texts {
    lines: Vec<(String, f64)>,
    legend: Vec<Entry>,
}

impl Texts {
    /// A title and a caption, in lines that are at most so wide where that is given, and a legend.
    pub(super) fn new([title, caption]: [&str; 2], legend: Vec<Entry>, across: Option<f64>) -> Self {
        let mut lines: Vec<(String, f64)> = Vec::new();
        for (text, size) in [(title, TITLE), (caption, LABEL)] {
            let first = lines.len();
            for word in text.split_whitespace() {
                match lines[first..].last_mut().map(|(line, _)| (format!("{line} {word}"), line)) {
                    Some((longer, line)) if across.is_none_or(|across| width(&longer, size) <= across) => {
                        *line = longer
                    }
                    _ => lines.push((word.to_owned(), size)),
                }
            }
        }
        Self { lines, legend }
    }

    /// The height of the lines above a plot, with the margins.
    pub(super) fn above(&self) -> f64 {
        2.0 * MARGIN + self.lines.len() as f64 * LINE
    }

    /// The height below the plot and its axis, for a legend of this width.
    pub(super) fn below(&self, across: f64) -> f64 {
        let rows = self.places(across).last().map_or(0, |&(_, row)| row + 1);
        if rows == 0 { 0.0 } else { rows as f64 * LINE + 0.5 * MARGIN }
    }

    /// The width of the longest line, where each entry of the legend may have a row of its own.
    pub(super) fn widest(&self) -> f64 {
        let legend = self.legend.iter().map(Entry::width).fold(0.0, f64::max);
        self.lines.iter().map(|(line, size)| width(line, *size)).fold(legend, f64::max)
    }

    /// The columns and rows of the entries in a legend of this width.
    fn places(&self, across: f64) -> Vec<(f64, usize)> {
        let (mut column, mut row) = (0.0, 0);
        let mut place = |entry: &Entry| {
            if column > 0.0 && column + entry.width() > across {
                (column, row) = (0.0, row + 1);
            }
            let place = (column, row);
            column += entry.width();
            place
        };
        self.legend.iter().map(&mut place).collect()
    }

    /// Draws the lines from the top, and the legend from `bottom` on, over the width `across`.
    pub(super) fn draw(&self, picture: &mut Picture, left: f64, bottom: f64, across: f64) {
        let mut row = MARGIN + 0.5 * LINE;
        for (line, size) in &self.lines {
            picture.text(line, (left, row), *size, Anchor::Start);
            row += LINE;
        }
        for (entry, (column, row)) in self.legend.iter().zip(self.places(across)) {
            let (column, top) = (left + column, bottom + row as f64 * LINE);
            let middle = top + 0.5 * SWATCH;
            let swatch = Area::new(column, top, entry.swatch(), SWATCH);
            if let Some(dashes) = entry.line {
                let pieces = dashed(vec![vec![(column, middle), (swatch.right(), middle)]], dashes);
                picture.shapes.push(Shape::Curve(Curve { pieces, width: 1.5, colour: entry.colour, within: swatch }));
            } else {
                picture.fill(swatch, entry.colour);
                picture.outline(swatch);
            }
            picture.text(&entry.text, (swatch.right() + SWATCH_SPACE, middle), LABEL, Anchor::Start);
        }
    }
}

/// The dashes of the pieces of a curve: lengths of dashes and of spaces alternate; the pieces themselves if there are
/// no lengths.
pub(super) fn dashed(pieces: Vec<Vec<(f64, f64)>>, lengths: &[f64]) -> Vec<Vec<(f64, f64)>> {
    if lengths.is_empty() {
        return pieces;
    }
    let mut dashes: Vec<Vec<(f64, f64)>> = Vec::new();
    for piece in pieces.iter().filter(|piece| piece.len() > 1) {
        let (mut turns, mut left, mut is_drawn) = (lengths.iter().enumerate().cycle(), 0.0, false);
        for (from, to) in piece.iter().zip(&piece[1..]) {
            let (across, up) = (to.0 - from.0, to.1 - from.1);
            let (length, mut at) = (across.hypot(up), 0.0);
            while length - at > left {
                at += left;
                let point = (from.0 + at / length * across, from.1 + at / length * up);
                dashes.last_mut().filter(|_| is_drawn).into_iter().for_each(|dash| dash.push(point));
                let Some((k, next)) = turns.next() else { break };
                (left, is_drawn) = (*next, k % 2 == 0);
                dashes.extend(is_drawn.then(|| vec![point]));
            }
            left -= length - at;
            dashes.last_mut().filter(|_| is_drawn).into_iter().for_each(|dash| dash.push(*to));
        }
    }
    dashes
}

/// Draws the numbers and the label of an axis below `plot`.
pub(super) fn draw_axis_below(picture: &mut Picture, axis: &Axis, plot: Area) {
    let bottom = plot.bottom();
    for (share, number) in &axis.ticks {
        let x = plot.left + share * plot.width;
        picture.fill(Area::new(x - 0.5 * HAIRLINE, bottom, HAIRLINE, length(number)), INK);
        picture.text(number, (x, bottom + TICK + SPACE + 0.4 * NUMBER), NUMBER, Anchor::Middle);
    }
    let middle = (plot.left + 0.5 * plot.width, bottom + NUMBERS + 0.5 * LINE);
    picture.text(&axis.label, middle, LABEL, Anchor::Middle);
}

/// Draws the numbers and the label of an axis at the left (`side = -1.0`) or the right (`1.0`) of `plot`, the label in
/// `room`, the width of all of them.
pub(super) fn draw_axis_beside(picture: &mut Picture, axis: &Axis, plot: Area, side: f64, room: f64) {
    let edge = if side < 0.0 { plot.left } else { plot.right() };
    for (share, number) in &axis.ticks {
        let (y, tick) = (plot.bottom() - share * plot.height, length(number));
        let start = if side < 0.0 { edge - tick } else { edge };
        picture.fill(Area::new(start, y - 0.5 * HAIRLINE, tick, HAIRLINE), INK);
        let anchor = if side < 0.0 { Anchor::End } else { Anchor::Start };
        picture.text(number, (edge + side * (TICK + SPACE), y), NUMBER, anchor);
    }
    let middle = edge + side * (room - 0.5 * LINE);
    picture.text_upwards(&axis.label, (middle, plot.bottom() - 0.5 * plot.height), LABEL);
}

/// The length of a tick, shorter where it has no number.
fn length(number: &str) -> f64 {
    if number.is_empty() { 0.5 * TICK } else { TICK }
}

/// The room next to a plot for the numbers and the label of an axis, in whole points.
pub(super) fn room(axis: &Axis) -> f64 {
    let widest = axis.ticks.iter().map(|(_, text)| font::width(text, NUMBER)).fold(0.0, f64::max);
    (TICK + MARGIN + widest + if axis.label.is_empty() { 0.0 } else { LINE }).ceil()
}

/// The length of an axis that has room for its label and a unit, and for enough numbers.
pub(super) fn label_length(label: &str) -> f64 {
    (width(label, LABEL) + 45.0).max(100.0).ceil()
}
