//! The warnings about scan lines: offsets of lines, or of lines along the other axis.

use asperity::along_sides;
use ndarray::Array2;

use super::part::Part::{Figure, Length, Word};
use super::{Warning, WarningCode};
use crate::topography::{LineSteps, ScanAxis, Topography};

/// Fewer lines tell nothing: a few waves of a surface with a lay are steps from line to line like any others.
const LEAST: usize = 64;

/// The change from line to line of the steps that whole lines share, over the change along the other axis, from which
/// the offsets are by far the larger: long waves, which lines share as well, change little from line to line.
const FAR: f64 = 5.0;

/// The steps that whole lines share, in the rms step of single nodes beyond them, from which the lines are offset: of
/// long lines on isotropic heights it is a few tenths.
const STANDS_OUT: f64 = 0.5;

/// The same for lines with offsets, which are to be found among the steps of the surface.
const OFFSET: f64 = 0.1;

/// The change of the steps from one to the next, in the steps, of lines that are offset at random: √3 if the offsets
/// are independent, √2 if the steps are. The profile of a surface changes less, and a grating of few lines much more.
const RANDOM: std::ops::Range<f64> = 1.2..2.5;

/// The rms step of single nodes across the lines over that along them up to which the surface itself has no lay.
const ALIKE: f64 = 2.0;

const AXES: [(ScanAxis, &str); 2] = [(ScanAxis::X, "x"), (ScanAxis::Y, "y")];

/// The offsets of lines in the steps of single nodes, if these lines are offset at random, by more than this share, and
/// lines along the other axis are not.
fn offset(lines: &LineSteps<'_>, others: &LineSteps<'_>, share: f64) -> Option<f64> {
    let are_random = lines.change > FAR * others.change && RANDOM.contains(&(lines.change / lines.shared));
    let single = are_random.then(|| lines.single())?;
    (lines.shared > share * single && single <= ALIKE * others.single()).then(|| lines.shared / single)
}

/// Lines of heights, in a unit, that are offset from one another.
pub(super) fn offsets(heights: &Array2<f64>, unit: f64) -> Option<Warning> {
    let (nx, ny) = heights.dim();
    if nx.min(ny) < LEAST {
        return None;
    }
    let [x, y] = along_sides(heights.len(), |axis| LineSteps::measure(heights, AXES[axis].0));
    let found = [(&x, &y, "x"), (&y, &x, "y")].into_iter();
    let (lines, times, axis) =
        found.filter_map(|(lines, others, axis)| Some((lines, offset(lines, others, OFFSET)?, axis))).next()?;
    Some(Warning::new(
        WarningCode::LineOffsets,
        times,
        "lines along {} are offset by {}: use align-rows median, scan axis {}",
        [Word(axis.into()), Length(lines.shared * unit), Word(axis.into())],
    ))
}

impl Warning {
    /// A measured map that probably has its scan lines, which are to be brought to one height, along the other axis:
    /// [`ScanAxis`](WarningCode::ScanAxis). Lines along the other axis are offset from one another by more than half
    /// the rms step of their nodes, five times as irregularly as lines along this axis, neither as smoothly as the
    /// profile of a surface nor on one that is rougher across them. Nothing where there are fewer than 64 lines.
    ///
    /// ```
    /// use asperity_maps::ScanAxis;
    /// use asperity_maps::warning::Warning;
    /// use asperity_maps::Topography;
    /// // an image: rows are the scan lines, and drift moves each by some height
    /// let drift = |row: usize| ((row as f64 * 0.618).fract() - 0.5).powi(3);
    /// let grain = |row: usize, column: usize| 1e-3 * ((row * 7 + column * 13) as f64 * 0.414).fract();
    /// let image = ndarray::Array2::from_shape_fn((96, 96), |(row, column)| drift(row) + grain(row, column));
    /// let map = Topography::new(image);
    /// assert!(Warning::of_lines(&map, ScanAxis::X).is_some());
    /// assert!(Warning::of_lines(&map, ScanAxis::Y).is_none());
    /// ```
    pub fn of_lines(map: &Topography, along: ScanAxis) -> Option<Self> {
        let (nx, ny) = map.heights.dim();
        if nx.min(ny) < LEAST {
            return None;
        }
        let mut axes = AXES;
        axes.sort_by_key(|(axis, _)| *axis != along);
        let [asked, other] = axes.map(|(axis, _)| LineSteps::measure(&map.heights, axis));
        offset(&other, &asked, STANDS_OUT)?;
        let [along, across] = axes.map(|(_, name)| Word(name.to_owned()));
        let times =
            if asked.change > 0.0 { Figure(other.change / asked.change) } else { Word("infinitely many".into()) };
        Some(Self::new(
            WarningCode::ScanAxis,
            0.0,
            "lines along {} are offset {} times as much as lines along {}: choose scan axis {}",
            [across.clone(), times, along, across],
        ))
    }
}
