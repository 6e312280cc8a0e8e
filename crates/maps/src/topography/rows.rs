//! Scan lines of a height map, brought to one height.

use std::str::FromStr;

use ndarray::{Array1, Array2, ArrayView1, Axis, Zip};

use super::median::Ranks;
use super::trend::order;
use super::{Topography, Trend, median, named};
use asperity::Result;

/// The direction in which an instrument scans its lines.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScanAxis {
    /// Lines along x, as in the images of nearly all atomic force microscopes: the nodes of a line share their y.
    X,
    /// Lines along y.
    Y,
}

/// The way in which [`Topography::align_rows`] brings scan lines to one height.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowAlignment {
    /// Every line has the same median.
    Median,
    /// The differences of each line from the one before it have the median 0: for surfaces of large features, which
    /// medians of lines would flatten. The shifts add up along the map.
    MedianDifference,
    /// The least-squares polynomial of this order is taken from each line; 0 is its mean, 1 a tilt too, 2 a bow too.
    Polynomial(usize),
}

impl ScanAxis {
    /// The names of the directions.
    pub const NAMES: [&str; 2] = ["x", "y"];
}

impl FromStr for ScanAxis {
    type Err = String;

    /// A direction by its name.
    fn from_str(text: &str) -> std::result::Result<Self, String> {
        named(text, Self::NAMES, [Self::X, Self::Y])
    }
}

impl RowAlignment {
    /// The names of the ways; an order may follow `polynomial`, as in `polynomial:2`.
    pub const NAMES: [&str; 3] = ["median", "median-difference", "polynomial"];
}

impl FromStr for RowAlignment {
    type Err = String;

    /// An alignment by its name, for a polynomial with its order, 1 by default.
    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let text = text.trim();
        let refused = || {
            let most = Trend::HIGHEST_ORDER;
            format!("it must be median, median-difference, or polynomial:ORDER with an order from 0 to {most}")
        };
        match (text, text.split_once(':').unwrap_or((text, "1"))) {
            ("median", _) => Ok(Self::Median),
            ("median-difference", _) => Ok(Self::MedianDifference),
            (_, ("polynomial", of)) => order(of).map(Self::Polynomial).ok_or_else(refused),
            _ => Err(refused()),
        }
    }
}

impl Topography {
    /// Brings scan lines to one height: the offsets from line to line that the drift of an instrument leaves.
    ///
    /// Each line is shifted, or with [`RowAlignment::Polynomial`] straightened, on its own, by its measured points
    /// alone, and the mean height of the map stays. Heights along the line stay; across the lines, slopes of the
    /// surface that a whole line shares count as drift and go, too. Lines that are all missing stay so.
    ///
    /// ```
    /// use asperity_maps::{RowAlignment, ScanAxis};
    /// use asperity_maps::Topography;
    /// // three lines along x; the second is 3 too high
    /// let map = Topography::new(ndarray::array![[0.0, 3.0, 0.0], [1.0, 4.0, 1.0], [2.0, 5.0, 2.0]]);
    /// let aligned = map.align_rows(RowAlignment::Median, ScanAxis::X)?;
    /// assert_eq!(aligned.heights.row(0), ndarray::array![1.0, 1.0, 1.0]);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Value`](asperity::Error::Value) if the order of a polynomial is above [`Trend::HIGHEST_ORDER`].
    pub fn align_rows(mut self, alignment: RowAlignment, along: ScanAxis) -> Result<Self> {
        let (before, across) = (self.mean(), Axis(if along == ScanAxis::X { 1 } else { 0 }));
        let mut last: Option<Array1<f64>> = None;
        let mut drift = 0.0;
        for mut line in self.heights.axis_iter_mut(across) {
            match alignment {
                RowAlignment::Median => {
                    if let Some(level) = median(line.iter().copied()) {
                        line.mapv_inplace(|h| h - level);
                    }
                }
                RowAlignment::MedianDifference => {
                    let measured = line.to_owned();
                    if let Some(last) = &last {
                        drift += median(line.iter().zip(last).map(|(h, before)| h - before)).unwrap_or(0.0);
                    }
                    line.mapv_inplace(|h| h - drift);
                    if measured.iter().any(|h| h.is_finite()) {
                        last = Some(measured);
                    }
                }
                RowAlignment::Polynomial(order) => {
                    let straight = straightened(line.view(), order)?;
                    line.assign(&straight);
                }
            }
        }
        let shift = before - self.mean();
        self.heights.mapv_inplace(|h| h + shift);
        Ok(self)
    }
}

/// The steps between the lines of a map along an axis, each from one line to the next.
pub(crate) struct LineSteps<'a> {
    heights: &'a Array2<f64>,
    along: ScanAxis,
    /// The step that each whole line shares, of lines with measured points.
    of_lines: Vec<f64>,
    /// The median over the lines of the step that a whole line shares, about their tilt.
    pub shared: f64,
    /// The median change of the shared step from one step to the next.
    pub change: f64,
}

impl<'a> LineSteps<'a> {
    /// The steps of the measured points; NaN where none are.
    pub fn measure(heights: &'a Array2<f64>, along: ScanAxis) -> Self {
        let (mut ranks, mut of_lines) = (Ranks::default(), Vec::new());
        for_each_step(heights, along, |steps| of_lines.extend(ranks.median(steps.iter().copied())));
        let mut middle = |values: &mut dyn Iterator<Item = f64>| ranks.median(values).unwrap_or(f64::NAN);
        let tilt = middle(&mut of_lines.iter().copied());
        let shared = middle(&mut of_lines.iter().map(|step| (step - tilt).abs()));
        let change = middle(&mut of_lines.windows(2).map(|pair| (pair[1] - pair[0]).abs()));
        Self { heights, along, of_lines, shared, change }
    }

    /// The rms step of single nodes about the step of their line, the median over the lines.
    pub fn single(&self) -> f64 {
        let (mut of_lines, mut single) = (self.of_lines.iter(), Vec::new());
        for_each_step(self.heights, self.along, |steps| {
            let measured = || steps.iter().filter(|step| step.is_finite());
            if let Some(shared) = measured().next().and_then(|_| of_lines.next()) {
                let squares: f64 = measured().map(|step| (step - shared).powi(2)).sum();
                single.push(f64::sqrt(squares / measured().count() as f64));
            }
        });
        median(single.into_iter()).unwrap_or(f64::NAN)
    }
}

/// The lines from which steps are taken at once: the numbers of a cache line, in which lines across the rows of a map lie
/// side by side.
const AT_ONCE: usize = 8;

/// Does something with the steps of all nodes from each line to the next.
fn for_each_step(heights: &Array2<f64>, along: ScanAxis, mut act: impl FnMut(ArrayView1<'_, f64>)) {
    let across = usize::from(along == ScanAxis::X);
    let (lines, nodes) = (heights.len_of(Axis(across)), heights.len_of(Axis(1 - across)));
    let mut steps = Array2::zeros((AT_ONCE, nodes));
    for first in (1..lines).step_by(AT_ONCE) {
        let count = AT_ONCE.min(lines - first);
        let from = |line: usize| heights.slice_axis(Axis(across), (line..line + count).into());
        let mut found = steps.slice_axis_mut(Axis(0), (0..count).into());
        found.swap_axes(0, across);
        Zip::from(found).and(from(first)).and(from(first - 1)).for_each(|step, h, before| *step = h - before);
        steps.rows().into_iter().take(count).for_each(&mut act);
    }
}

/// A line less the polynomial that fits its measured points.
fn straightened(line: ArrayView1<'_, f64>, order: usize) -> Result<Array1<f64>> {
    let map = Topography::new(line.to_owned().insert_axis(Axis(1)));
    if map.missing() == map.heights.len() {
        return Ok(line.to_owned());
    }
    Ok(map.detrend(Trend::Polynomial(order))?.heights.remove_axis(Axis(1)))
}
