//! The height map: measured heights on the way to a periodic surface.

use std::f64::consts::PI;
use std::ops::Range;

use ndarray::{Array2, Axis};

use asperity::surface::{SurfaceStatistics, low_pass, mean_of_finite, mirror, resample, rms_slope};
use asperity::{Error, Grid, Result, Surface};

mod despike;
mod fill;
mod form;
mod median;
mod missing;
mod rows;
mod scars;
#[cfg(test)]
mod tests;
mod trend;

pub use despike::Spikes;
pub use fill::{fill, surface_with_absent};
pub use form::{Form, FormFit};
use median::median;
pub(crate) use rows::LineSteps;
pub use rows::{RowAlignment, ScanAxis};
pub use scars::Scars;
pub use trend::{Fit, Trend};

/// A measured map of heights on its way to a [`Surface`]: points may be missing, side lengths and unit unknown.
///
/// A surface is periodic and complete; a measurement is neither. Each step between the two is a method of its own, and
/// nothing is done unasked: take codes for [`missing`](Self::declare_missing) points, [`align_rows`](Self::align_rows)
/// of a scan, [`remove_scars`](Self::remove_scars), [`despike`](Self::despike), [`remove_form`](Self::remove_form),
/// [`detrend`](Self::detrend), [`fill`](Self::fill) missing points, make the map periodic by [`window`](Self::window)
/// or [`mirror`](Self::mirror), leave out short waves by [`low_pass`](Self::low_pass), [`crop`](Self::crop) it,
/// [`flip`](Self::flip) it, and [`resample`](Self::resample) it. Heights that are NaN or infinite are missing: all
/// methods leave them missing, and out of their sums, but for `fill`, which gives them values, and `window`, `low_pass`
/// and `resample`, which refuse them.
///
/// ```
/// use asperity_maps::{Topography, Trend};
/// use ndarray::Array2;
///
/// // tilted, with a hole
/// let mut heights = Array2::from_shape_fn((41, 31), |(i, j)| 0.02 * i as f64 + (0.5 * j as f64).sin());
/// heights[[20, 10]] = f64::NAN;
/// let mut measured = Topography::new(heights);
/// measured.lengths = Some((4.1, 3.1));
/// assert_eq!(measured.missing(), 1);
/// assert!(measured.clone().surface().is_err()); // incomplete
///
/// let surface = measured.detrend(Trend::Plane)?.fill()?.window(0.1)?.surface()?;
/// assert_eq!(surface.grid().lengths(), (4.1, 3.1));
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Topography {
    /// The heights, of shape (Nx, Ny), peaks up; what is not finite is missing.
    pub heights: Array2<f64>,
    /// The side lengths (Lx, Ly) = (Nx Δx, Ny Δy), in the unit of the heights, if they are known.
    pub lengths: Option<(f64, f64)>,
    /// The unit of heights and side lengths, if it is known.
    pub unit: Option<String>,
    /// The nodes along x and y of the original, if the map consists of an original and its mirror images: see
    /// [`mirror`](Self::mirror).
    pub original: Option<(usize, usize)>,
    /// The seed of the [`SelfAffine`](asperity::SelfAffine) surface from which the map was made, if there is one.
    pub seed: Option<u64>,
    /// The threshold of the scars that were [removed](Self::remove_scars), if that was done.
    pub scars_removed: Option<f64>,
    /// Whether opposite edges meet, if that is known.
    pub periodic: Option<bool>,
    /// Contents of a file that were not read: arrays, channels, a mask, and lines that may tell a size.
    pub unread: Vec<String>,
}

impl Topography {
    /// A map of shape (Nx, Ny) with unknown side lengths and unit.
    pub fn new(heights: Array2<f64>) -> Self {
        let (lengths, unit, original, seed, scars_removed, periodic) = (None, None, None, None, None, None);
        Self { heights, lengths, unit, original, seed, scars_removed, periodic, unread: Vec::new() }
    }

    /// The number of missing heights: NaN or infinite.
    pub fn missing(&self) -> usize {
        self.heights.iter().filter(|h| !h.is_finite()).count()
    }

    /// The mean of the heights that are not missing; NaN if all are.
    pub fn mean(&self) -> f64 {
        mean_of_finite(&self.heights)
    }

    /// The root mean square about their mean of the heights that are not missing; NaN if all are.
    pub fn rms_height(&self) -> f64 {
        let mean = self.mean();
        let known = self.heights.iter().filter(|h| h.is_finite());
        let (sum, count) = known.fold((0.0, 0.0), |(sum, count), h| (sum + (h - mean).powi(2), count + 1.0));
        f64::sqrt(sum / count)
    }

    /// The root mean square slope between neighbours that are not missing, if the side lengths are known: along the
    /// sides that have such neighbours, and NaN if neither has. [`Surface::statistics`] has the slope of a periodic
    /// surface.
    ///
    /// ```
    /// # use asperity_maps::Topography;
    /// let mut map = Topography::new(ndarray::Array2::from_shape_fn((8, 6), |(i, j)| (3 * i + 4 * j) as f64));
    /// map.heights[[3, 2]] = f64::NAN;
    /// map.lengths = Some((8.0, 6.0));
    /// assert!((map.rms_slope().unwrap() - 5.0).abs() < 1e-12);
    /// map.heights.column_mut(1).fill(f64::NAN);
    /// map.heights.column_mut(3).fill(f64::NAN);
    /// map.heights.column_mut(5).fill(f64::NAN);
    /// assert!((map.rms_slope().unwrap() - 3.0).abs() < 1e-12);
    /// ```
    pub fn rms_slope(&self) -> Option<f64> {
        self.lengths.map(|_| rms_slope(self.heights.view(), self.spacing(), false))
    }

    /// The part of the map with the nodes `x` × `y`; the nodes keep their distances. A part of a mirrored map has no
    /// original.
    ///
    /// ```
    /// # use asperity_maps::Topography;
    /// let mut map = Topography::new(ndarray::Array2::from_shape_fn((8, 6), |(i, j)| (10 * i + j) as f64));
    /// map.lengths = Some((4.0, 3.0));
    /// let part = map.crop(2..6, 1..3)?;
    /// assert_eq!((part.heights.dim(), part.heights[[0, 0]], part.lengths), ((4, 2), 21.0, Some((2.0, 1.0))));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Value`] if a range is empty or leaves the map.
    pub fn crop(mut self, x: Range<usize>, y: Range<usize>) -> Result<Self> {
        let (nx, ny) = self.heights.dim();
        for (name, range, n) in [("end of the crop along x", &x, nx), ("end of the crop along y", &y, ny)] {
            if range.start >= range.end || range.end > n {
                let requirement = "after its start, and within the map";
                return Err(Error::Value { name, value: range.end as f64, requirement });
            }
        }
        let share = |length: f64, range: &Range<usize>, n: usize| length / n as f64 * range.len() as f64;
        // on a line, Ly is nothing's distance but goes with Lx
        self.lengths = self.lengths.map(|(lx, ly)| (share(lx, &x, nx), share(ly, &y, ny)));
        self.heights = self.heights.slice_axis(Axis(0), x.into()).slice_axis(Axis(1), y.into()).to_owned();
        self.original = None;
        self.periodic = self.periodic.map(|_| false);
        Ok(self)
    }

    /// Peaks become valleys: h → −h, as between a surface and its replica.
    #[must_use]
    pub fn flip(mut self) -> Self {
        self.heights.mapv_inplace(|h| -h);
        self
    }

    /// Tapers the map towards its edges, so that it becomes periodic; mean height and number of nodes stay.
    ///
    /// ```math
    /// h → ⟨h⟩ + w(x) w(y) (h − c) ,   c = ⟨wh⟩/⟨w⟩ ,
    /// w(x) = ½(1 − cos(πd/(fL))) for d < fL, 1 elsewhere
    /// ```
    ///
    /// with d the distance from the nearer edge of the side L, half a spacing beyond the outermost node, and `fraction`
    /// f the share of the side that is tapered at each of its two ends (Tukey's window). In the middle, heights are
    /// only shifted by a common constant; in the tapered strips they shrink towards the mean, and with them the rms
    /// height of the whole, by √⟨w²⟩ where heights do not know of the window. Remove a tilt first. On a line only x is
    /// tapered.
    ///
    /// The window is made for spectra. In contact, the frame is a flat piece at the mean height that the surface does
    /// not have: it touches under loads that bring the mean height close, or where long waves are deep. Look at the
    /// contact map, or use [`mirror`](Self::mirror), which leaves all heights as they are.
    ///
    /// # Errors
    /// [`Error::Value`] if the fraction is not from 0 to 0.5, [`Error::NotFinite`] if heights are missing.
    pub fn window(mut self, fraction: f64) -> Result<Self> {
        if !(fraction > 0.0 && fraction <= 0.5) {
            return Err(Error::Value { name: "window", value: fraction, requirement: "more than 0, and at most 0.5" });
        }
        self.complete()?;
        let taper = |n: usize| -> Vec<f64> {
            let distance = |i: usize| (i.min(n - 1 - i) as f64 + 0.5) / n as f64 / fraction;
            (0..n)
                .map(|i| if distance(i) < 1.0 && n > 1 { 0.5 - 0.5 * (PI * distance(i)).cos() } else { 1.0 })
                .collect()
        };
        let (nx, ny) = self.heights.dim();
        let (along_x, along_y) = (taper(nx), taper(ny));
        let mean = self.mean();
        let (mut weights, mut sum) = (0.0, 0.0);
        for (row, wx) in self.heights.rows().into_iter().zip(&along_x) {
            weights += wx * along_y.iter().sum::<f64>();
            sum += wx * row.iter().zip(&along_y).map(|(h, wy)| wy * (h - mean)).sum::<f64>();
        }
        let level = mean + sum / weights;
        for (mut row, wx) in self.heights.rows_mut().into_iter().zip(&along_x) {
            row.iter_mut().zip(&along_y).for_each(|(h, wy)| *h = mean + wx * wy * (*h - level));
        }
        self.periodic = self.periodic.map(|_| true);
        Ok(self)
    }

    /// Continues the map by its mirror image along both axes: 2Nx × 2Ny nodes on sides twice as long, periodic and
    /// continuous, with the same mean and rms height. A line becomes twice as long.
    ///
    /// Row Nx + i is a copy of row Nx − 1 − i, and columns likewise, so that the outermost nodes have copies of
    /// themselves for neighbours. Heights stay as they are; slopes across the seams jump to their opposite, and all
    /// that is found on the result, as contact clusters or spectra, has the symmetry of the mirrors. The map remembers
    /// its [`original`](Self::original), and [`Original`](asperity::contact::Original) finds it again in solutions.
    #[must_use]
    pub fn mirror(mut self) -> Self {
        let ((nx, ny), heights) = (self.heights.dim(), mirror(&self.heights));
        let (mx, my) = heights.dim();
        self.lengths = self.lengths.map(|(lx, ly)| (lx * (mx / nx) as f64, ly * (my / ny) as f64));
        self.heights = heights;
        self.periodic = self.periodic.map(|_| true);
        // an original is forgotten where the map is not whole images of it, as after resampling
        self.original = self.original.filter(|&(x, y)| nx % x == 0 && ny % y == 0).or(Some((nx, ny)));
        self
    }

    /// Gives missing points the heights of a membrane that spans the hole from its edge: [`fill()`]. Without side lengths
    /// cells are square.
    ///
    /// ```
    /// use asperity_maps::Topography;
    /// let heights = ndarray::array![[1.0, 2.0, 3.0], [2.0, f64::NAN, 4.0], [3.0, 4.0, 5.0]];
    /// assert_eq!(Topography::new(heights).fill()?.heights[[1, 1]], 3.0);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Value`] if all heights are missing.
    pub fn fill(mut self) -> Result<Self> {
        let spacing = self.spacing();
        self.heights = fill(self.heights, spacing)?;
        Ok(self)
    }

    /// The map without the waves shorter than a `cut_off`, a length, which may be noise alone: [`low_pass`].
    ///
    /// Edges that do not meet ring: use [`window`](Self::window) or [`mirror`](Self::mirror) first.
    ///
    /// # Errors
    /// [`Error::Value`] if the side lengths are unknown or no lengths, or the cut-off is not positive;
    /// [`Error::Memory`] if the waves take more memory than there is; [`Error::NotFinite`] if heights are missing.
    pub fn low_pass(mut self, cut_off: f64) -> Result<Self> {
        let lengths = self.grid()?.lengths();
        self.heights = low_pass(self.heights, lengths, cut_off)?;
        Ok(self)
    }

    /// The map on `nodes` = (Mx, My) nodes of the same sides, finer or coarser, by Fourier interpolation: [`resample`].
    ///
    /// Edges that do not meet make it ring: use [`window`](Self::window) or [`mirror`](Self::mirror) first. The
    /// original of a mirrored map keeps its sides.
    ///
    /// # Errors
    /// [`Error::Value`] if a number of nodes is zero, or on a mirrored map odd; [`Error::Memory`] if they take more
    /// than there is; [`Error::NotFinite`] if heights are missing.
    pub fn resample(mut self, nodes: (usize, usize)) -> Result<Self> {
        let before = self.heights.dim();
        if let Some((x, y)) = self.original {
            let sides = [("nodes along x", x, before.0, nodes.0), ("nodes along y", y, before.1, nodes.1)];
            let [x, y] = sides.map(|(name, part, before, now)| {
                let share = part.saturating_mul(now);
                let requirement = "even, or resampled before the mirror: the original would change its sides";
                let odd = Error::Value { name, value: now as f64, requirement };
                if share.is_multiple_of(before) { Ok(share / before) } else { Err(odd) }
            });
            self.original = Some((x?, y?));
        }
        self.heights = resample(self.heights, nodes)?;
        Ok(self)
    }

    /// The statistics of the map as a surface, periodic as it stands; slopes, curvatures and Nayak's parameter are NaN
    /// where the side lengths are unknown.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if heights are missing, [`Error::Value`] if the side lengths are no lengths.
    pub fn statistics(&self) -> Result<SurfaceStatistics> {
        let mut map = self.clone();
        let (nx, ny) = map.heights.dim();
        map.lengths.get_or_insert((nx as f64, ny as f64));
        let mut found = map.surface()?.statistics();
        if self.lengths.is_some() {
            return Ok(found);
        }
        for unknown in [
            &mut found.rms_slope,
            &mut found.rms_slope_differences,
            &mut found.rms_curvature,
            &mut found.rms_curvature_differences,
            &mut found.nayak,
        ] {
            *unknown = f64::NAN;
        }
        Ok(found)
    }

    /// The surface, periodic as it stands.
    ///
    /// # Errors
    /// [`Error::Value`] if the side lengths are unknown or no lengths, [`Error::NotFinite`] if heights are missing.
    pub fn surface(self) -> Result<Surface> {
        Surface::new(self.grid()?, self.heights)
    }

    /// The surface, periodic as it stands, with the missing points as absent nodes: [`surface_with_absent`]. Infinite
    /// heights are missing, too.
    ///
    /// # Errors
    /// [`Error::Value`] if the side lengths are unknown or no lengths, or if all heights are missing.
    pub fn surface_with_absent(mut self) -> Result<Surface> {
        self.heights.mapv_inplace(|h| if h.is_finite() { h } else { f64::NAN });
        surface_with_absent(self.grid()?, self.heights)
    }

    /// Refuses missing heights.
    fn complete(&self) -> Result<()> {
        let mut missing = self.heights.indexed_iter().filter(|(_, height)| !height.is_finite());
        let Some((first, &value)) = missing.next() else { return Ok(()) };
        Err(Error::NotFinite { name: "heights", count: 1 + missing.count(), nodes: self.heights.len(), first, value })
    }

    fn grid(&self) -> Result<Grid> {
        let requirement = "known: set Topography::lengths";
        let missing = Error::Value { name: "side length Lx", value: f64::NAN, requirement };
        Grid::new(self.heights.dim(), self.lengths.ok_or(missing)?)
    }

    /// The distances between nodes; square cells of 1 if the side lengths are unknown.
    fn spacing(&self) -> (f64, f64) {
        let (nx, ny) = self.heights.dim();
        self.lengths.map_or((1.0, 1.0), |(lx, ly)| (lx / nx as f64, ly / ny as f64))
    }
}

impl From<Surface> for Topography {
    /// The heights and side lengths of a surface; absent nodes are missing points.
    fn from(surface: Surface) -> Self {
        let lengths = Some(surface.grid().lengths());
        let mut heights = surface.heights().clone();
        if let Some(absent) = surface.absent() {
            heights.zip_mut_with(absent, |height, &absent| *height = if absent { f64::NAN } else { *height });
        }
        Self { lengths, ..Self::new(heights) }
    }
}

/// The value of a name.
fn named<V, const N: usize>(text: &str, names: [&str; N], values: [V; N]) -> std::result::Result<V, String> {
    let found = names.iter().zip(values).find(|(name, _)| **name == text);
    found.map(|(_, value)| value).ok_or_else(|| format!("it must be {}", names.join(" or ")))
}
