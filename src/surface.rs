//! The surface: heights on a grid.

use std::borrow::Cow;
use std::f64::consts::TAU;

use ndarray::Array2;

use crate::error::{Error, Result};
use crate::field::{Field, contiguous};
use crate::grid::Grid;

mod fourier;
mod low_pass;
mod pair;
mod philox;
mod resample;
mod self_affine;
mod slope;
mod spectrum;
mod statistics;

pub use fourier::FourierSeries;
pub use low_pass::low_pass;
pub(crate) use philox::uniform;
pub(crate) use resample::refine;
pub use resample::{mirror, resample};
pub use self_affine::{Amplitude, SelfAffine};
pub use slope::rms_slope;
#[doc(hidden)]
pub use slope::squared_steps;
pub use spectrum::{Psd, Spectrum};
pub use statistics::SurfaceStatistics;

/// The heights of the rigid rough surface on a grid, peaks up, in `f64`; only their differences matter.
///
/// ```
/// use asperity::{Grid, Surface};
/// let grid = Grid::square(64, 1.0)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// assert_eq!(sphere.heights()[[32, 32]], 0.0);
/// assert_eq!(sphere.heights()[[0, 32]], -0.0625); // −r²/2R
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    grid: Grid,
    heights: Field<f64>,
    absent: Option<Field<bool>>,
}

impl Surface {
    /// A surface from heights of shape (Nx, Ny), in the unit of the grid's lengths; any memory layout.
    ///
    /// # Errors
    /// [`Error::Shape`] if they do not fit the grid, [`Error::NotFinite`] with the number and place of missing points.
    pub fn new(grid: Grid, heights: Array2<f64>) -> Result<Self> {
        grid.fits("heights", heights.dim())?;
        grid.finite("heights", heights.view())?;
        Ok(Self { grid, heights: Field::of(heights), absent: None })
    }

    /// The surface with absent nodes, of shape (Nx, Ny): they neither touch nor attract. The heights there count in
    /// statistics and in the scale of errors alone, and should continue the heights around them: `surface_with_absent`
    /// of `asperity-maps` makes such heights where they are missing.
    ///
    /// # Errors
    /// [`Error::Shape`] if they do not fit the grid, [`Error::Value`] if all nodes are absent.
    pub fn with_absent(self, absent: Array2<bool>) -> Result<Self> {
        self.grid.fits("absent nodes", absent.dim())?;
        let count = self.grid.sum(absent.iter().filter(|&&absent| absent).count());
        if count == self.grid.nodes() {
            let requirement = "at least 1: all nodes are absent";
            return Err(Error::Value { name: "number of nodes with a surface", value: 0.0, requirement });
        }
        Ok(Self { absent: (count > 0).then_some(Field::of(absent)), ..self })
    }

    /// A surface from a function of the coordinates, `(x, y) → h`.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if the function is not finite at a node, [`Error::Memory`] if the memory does not suffice.
    pub fn from_fn(grid: Grid, height: impl Fn(f64, f64) -> f64) -> Result<Self> {
        grid.afford("a surface", 8)?;
        Self::new(grid, grid.sample(height))
    }

    /// A paraboloid −r²/2R with its apex on the node at the origin; a cylinder on a line.
    ///
    /// # Errors
    /// [`Error::Value`] if the radius of curvature is not positive and finite.
    pub fn paraboloid(grid: Grid, radius: f64) -> Result<Self> {
        Error::positive("radius of curvature", radius)?;
        let line = grid.is_line();
        Self::from_fn(grid, |x, y| -(x * x + if line { 0.0 } else { y * y }) / (2.0 * radius))
    }

    /// A wave h₀ cos(2πmx/Lx) with `periods` m along x.
    ///
    /// # Errors
    /// [`Error::Value`] if the amplitude h₀ is not finite or the grid does not resolve the wave (2m > Nx).
    pub fn wave(grid: Grid, amplitude: f64, periods: usize) -> Result<Self> {
        Error::finite("amplitude", amplitude)?;
        resolved(periods, grid.shape().0)?;
        let q = TAU * periods as f64 / grid.lengths().0;
        Self::from_fn(grid, |x, _| amplitude * (q * x).cos())
    }

    /// A two-dimensional wave h₀ cos(2πmx/Lx) cos(2πmy/Ly) with `periods` m along both sides.
    ///
    /// # Errors
    /// [`Error::Value`] if the amplitude h₀ is not finite or the grid does not resolve the wave.
    pub fn wave_2d(grid: Grid, amplitude: f64, periods: usize) -> Result<Self> {
        Error::finite("amplitude", amplitude)?;
        resolved(periods, grid.shape().0.min(grid.shape().1))?;
        let (lx, ly) = grid.lengths();
        let q = TAU * periods as f64;
        Self::from_fn(grid, |x, y| amplitude * (q * x / lx).cos() * (q * y / ly).cos())
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The heights, of shape (Nx, Ny), row-major; on a shared grid of the rows that this process holds.
    pub fn heights(&self) -> &Array2<f64> {
        &self.heights
    }

    /// The whole surface, on every one of the processes that share its grid. All of them have to ask.
    pub fn whole(&self) -> Cow<'_, Self> {
        if !self.grid.is_shared() {
            return Cow::Borrowed(self);
        }
        let absent = self.absent.as_ref().map(|absent| Field::of(self.grid.whole(&**absent)));
        Cow::Owned(Self { grid: self.grid.alone(), heights: Field::of(self.grid.whole(&*self.heights)), absent })
    }

    /// The absent nodes, of the shape of the [heights](Self::heights); nothing if there are none.
    pub fn absent(&self) -> Option<&Array2<bool>> {
        self.absent.as_deref()
    }

    /// The number of absent nodes, of the whole surface. Where several processes share its grid, all have to ask.
    pub fn absent_nodes(&self) -> usize {
        let absent = |absent: &Array2<bool>| absent.iter().filter(|&&absent| absent).count();
        self.absent.as_ref().map_or(0, |own| self.grid.sum(absent(own)))
    }

    /// The mean height.
    pub fn mean(&self) -> f64 {
        let [datum, above] = self.datum_and_mean();
        datum + above
    }

    /// The first height, and the distance of the mean above it, which is not rounded to the digits of a large datum.
    pub(crate) fn datum_and_mean(&self) -> [f64; 2] {
        let datum = self.grid.each(self.heights.first().copied().unwrap_or_default())[0];
        [datum, self.grid.mean(self.heights.view(), |h| h - datum)]
    }

    /// The root mean square of the heights about their mean.
    pub fn rms_height(&self) -> f64 {
        self.rms_about(self.mean())
    }

    pub(crate) fn rms_about(&self, datum: f64) -> f64 {
        self.grid.mean(self.heights.view(), |h| (h - datum).powi(2)).sqrt()
    }
}

/// The mean of the heights that are not missing, which are finite; NaN if all are missing. Sums are about the first of
/// them, so that a large datum costs no digits.
#[doc(hidden)]
pub fn mean_of_finite(heights: &Array2<f64>) -> f64 {
    let mut known = heights.iter().copied().filter(|h| h.is_finite());
    let Some(datum) = known.next() else { return f64::NAN };
    let (sum, count) = known.fold((0.0, 1.0), |(sum, count), h| (sum + (h - datum), count + 1.0));
    datum + sum / count
}

/// Moves what is at index zero along y to the origin of the grid.
fn centre(field: &mut Array2<f64>) {
    let ny = field.ncols();
    field.rows_mut().into_iter().for_each(|row| contiguous(row.into_slice()).rotate_right(ny / 2));
}

fn resolved(periods: usize, nodes: usize) -> Result<()> {
    if periods > 0 && 2 * periods <= nodes {
        return Ok(());
    }
    let requirement = "at least 1, and at most half the number of nodes along the side";
    Err(Error::Value { name: "number of periods", value: periods as f64, requirement })
}
