//! Scars of a height map: pieces of scan lines that are higher or lower than the lines next to them.

use ndarray::{Array2, ArrayView2};

use asperity::contact::Clusters;
use asperity::{Error, Result};

use super::despike::PER_MEDIAN;
use super::{ScanAxis, Topography, fill, median};

/// The least number of nodes of a scar along its line, and the most lines that it has, as by default in Gwyddion.
const LENGTH: usize = 16;
const WIDTH: usize = 4;

/// The scars of a map.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Scars {
    /// The number of scars: of pieces that hang together.
    pub count: usize,
    /// Whether each node is on a scar.
    pub map: Array2<bool>,
    /// The threshold, in rms differences of neighbouring lines.
    pub threshold: f64,
    /// The threshold as a height beyond the neighbouring lines.
    pub limit: f64,
}

impl Topography {
    /// The scars along the scan lines of a map: pieces of one to four lines, of 16 nodes and more, with all nodes
    /// higher, or all lower, than both lines next to the piece, each node by more than `threshold` rms differences of
    /// neighbouring lines.
    ///
    /// On average the piece stands out by more than the two lines next to it differ from the next, taken together: a
    /// wave along the scan lines is steeper next to its crest.
    ///
    /// The tip of a microscope makes them where it sticks, or loses the surface, within a line. The rms follows from
    /// the median of the magnitudes, 1.4826 median \|Δh\| about the median of Δh, which no scar carries. Rough
    /// surfaces, even rounded ones, have no such pieces at a threshold of ⅔, which is Gwyddion's: a crest that follows
    /// a scan line is less steep across it than the surface is. The first and the last line have no two next to them,
    /// and missing points are on no scar and end it.
    ///
    /// # Errors
    /// [`Error::Value`] if the threshold is not positive and finite.
    pub fn scars(&self, threshold: f64, along: ScanAxis) -> Result<Scars> {
        Error::positive("threshold of scars", threshold)?;
        // along its lines, and across them
        let lines = match along {
            ScanAxis::X => self.heights.view(),
            ScanAxis::Y => self.heights.t(),
        };
        let steps = || lines.indexed_iter().filter(|((_, j), _)| *j > 0).map(|((i, j), h)| h - lines[[i, j - 1]]);
        let tilt = median(steps()).unwrap_or(0.0);
        let limit = threshold * PER_MEDIAN * median(steps().map(|step| (step - tilt).abs())).unwrap_or(0.0);
        let mut on_scar = Array2::from_elem(lines.dim(), false);
        for (width, sign) in (1..=WIDTH).flat_map(|width| [(width, 1.0), (width, -1.0)]) {
            mark(&mut on_scar, lines, (width, sign), limit);
        }
        let map = if along == ScanAxis::X { on_scar } else { on_scar.reversed_axes() };
        let count = Clusters::of_part(map.view()).sizes.len();
        Ok(Scars { count, map, threshold, limit })
    }

    /// Gives the nodes on [`scars`](Self::scars) the heights of a membrane between their neighbours, as
    /// [`fill`](Self::fill) does; all other heights stay as they are.
    ///
    /// Offsets between whole lines are scars, too, as far as they are of one to four lines:
    /// [`align_rows`](Self::align_rows) first.
    ///
    /// ```
    /// use asperity_maps::{ScanAxis, Topography};
    /// let smooth = ndarray::Array2::from_shape_fn((40, 30), |(i, j)| (0.2 * i as f64).sin() + (0.3 * j as f64).cos());
    /// let mut scanned = Topography::new(smooth.clone());
    /// (5..30).for_each(|i| scanned.heights[[i, 12]] += 3.0);
    /// assert_eq!(scanned.scars(0.7, ScanAxis::X)?.count, 1);
    /// let left = scanned.remove_scars(0.7, ScanAxis::X)?;
    /// assert!(left.heights.iter().zip(&smooth).all(|(a, b)| (a - b).abs() < 0.1));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`scars`](Self::scars).
    pub fn remove_scars(self, threshold: f64, along: ScanAxis) -> Result<Self> {
        let scars = self.scars(threshold, along)?;
        self.without(&scars)
    }

    /// The map with heights on scars by their neighbours, which [remembers](Self::scars_removed) the threshold.
    ///
    /// # Errors
    /// [`Error::Shape`] if the scars are of another map, [`Error::Value`] if all heights are missing or on scars.
    pub fn without(mut self, scars: &Scars) -> Result<Self> {
        Error::shape("map of scars", scars.map.dim(), self.heights.dim())?;
        self.scars_removed = Some(scars.threshold);
        if scars.count == 0 {
            return Ok(self);
        }
        let mut pierced = self.heights.clone();
        pierced.zip_mut_with(&scars.map, |h, on_scar| *h = if *on_scar { f64::NAN } else { *h });
        let filled = fill(pierced, self.spacing())?;
        for ((h, filled), _) in self.heights.iter_mut().zip(&filled).zip(&scars.map).filter(|(_, on_scar)| **on_scar) {
            *h = *filled;
        }
        Ok(self)
    }
}

/// Marks the pieces of so many neighbouring lines that stand out by more than a limit, upwards or downwards, with steps
/// that are greater than the steps of the lines beyond.
fn mark(on_scar: &mut Array2<bool>, lines: ArrayView2<'_, f64>, (width, sign): (usize, f64), limit: f64) {
    let (nodes, count) = lines.dim();
    for first in 1..count.saturating_sub(width) {
        let (before, after) = (first - 1, first + width);
        // how far the lowest of the lines is above both next to them; not a number where one is missing
        let above = |i: usize| {
            let height = |j: usize| sign * lines[[i, j]];
            if !(before..=after).all(|j| lines[[i, j]].is_finite()) {
                return f64::NAN;
            }
            (first..after).map(height).fold(f64::INFINITY, f64::min) - height(before).max(height(after))
        };
        let beyond = |i: usize| {
            let step = |from: usize, to: usize| (to < count).then(|| (lines[[i, to]] - lines[[i, from]]).abs());
            let steps = [before.checked_sub(1).and_then(|to| step(before, to)), step(after, after + 1)];
            steps.into_iter().flatten().filter(|step| step.is_finite()).sum::<f64>()
        };
        let mut start = None;
        for i in 0..=nodes {
            match (start, i < nodes && above(i) > limit) {
                (None, true) => start = Some(i),
                (Some(from), false) => {
                    let sum = |of: &dyn Fn(usize) -> f64| (from..i).map(of).sum::<f64>();
                    if i - from >= LENGTH && sum(&above) > sum(&beyond) {
                        (from..i).for_each(|i| (first..after).for_each(|j| on_scar[[i, j]] = true));
                    }
                    start = None;
                }
                _ => {}
            }
        }
    }
}
