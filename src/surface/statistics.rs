//! Statistics of a surface: moments of its heights, slopes and curvatures.

use ndarray::ArrayView1;

use super::spectrum::is_line;
use super::{Surface, rms_slope};

/// The statistics of a rough surface, in the unit of the heights: [`Surface::statistics`].
///
/// Spectral slopes and curvatures belong to the smooth periodic surface through the nodes. Finite differences, periodic
/// too, are smaller, by (qΔ)²/24 of a slope and (qΔ)²/12 of a curvature for a wave number q along an axis of spacing Δ.
/// If the two differ much, the grid does not resolve the surface, or its edges do not meet.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SurfaceStatistics {
    /// The mean height.
    #[cfg_attr(feature = "serde", serde(rename = "mean_height"))]
    pub mean: f64,
    /// The least height.
    pub lowest: f64,
    /// The greatest height.
    pub highest: f64,
    /// The root mean square of the heights about their mean.
    pub rms_height: f64,
    /// ⟨(h − ⟨h⟩)³⟩ over the cube of the rms height: zero for Gaussian heights; not a number for a flat surface.
    pub skewness: f64,
    /// ⟨(h − ⟨h⟩)⁴⟩ over the fourth power of the rms height: 3 for Gaussian heights; not a number for a flat surface.
    pub kurtosis: f64,
    /// The root mean square of the slope, √⟨|∇h|²⟩, from the spectrum.
    pub rms_slope: f64,
    /// The same from differences between neighbours, (h(x + Δx) − h(x))/Δx and likewise along y.
    pub rms_slope_differences: f64,
    /// The root mean square of the mean curvature ½∇²h, on a line of h'', from the spectrum; one over a length.
    pub rms_curvature: f64,
    /// The same from second differences, (h(x + Δx) − 2h(x) + h(x − Δx))/Δx² and likewise along y.
    pub rms_curvature_differences: f64,
    /// Nayak's parameter α = m₀m₄/m₂², from the spectrum; see [`Spectrum::nayak`](crate::surface::Spectrum::nayak).
    pub nayak: f64,
}

impl Surface {
    /// The statistics of the surface, of the whole of it where several processes share the grid.
    ///
    /// ```
    /// use asperity::{Grid, Surface};
    /// // h₀ cos qx has an rms height of h₀/√2, and q times that for its rms slope
    /// let statistics = Surface::wave(Grid::line(64, 1.0)?, 0.01, 3)?.statistics();
    /// let q = 6.0 * std::f64::consts::PI;
    /// assert!((statistics.rms_slope - q * statistics.rms_height).abs() < 1e-14);
    /// assert!((statistics.nayak - 1.0).abs() < 1e-12);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn statistics(&self) -> SurfaceStatistics {
        if self.grid.is_shared() {
            return self.whole().statistics();
        }
        let mean = self.mean();
        let rms_height = self.rms_about(mean);
        // of heights over the rms height: fourth powers stay in range
        let power = |n: i32| self.grid.mean(self.heights.view(), |h| ((h - mean) / rms_height).powi(n));
        let laplacian = self.rms_laplacian();
        let spectrum = self.spectrum();
        SurfaceStatistics {
            mean,
            lowest: self.heights.iter().copied().fold(f64::INFINITY, f64::min),
            highest: self.heights.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            rms_height,
            skewness: power(3),
            kurtosis: power(4),
            rms_slope: spectrum.rms_slope(),
            rms_slope_differences: rms_slope(self.heights.view(), self.grid.spacing(), true),
            rms_curvature: spectrum.rms_curvature(),
            rms_curvature_differences: if is_line(&self.grid) { laplacian } else { 0.5 * laplacian },
            nayak: spectrum.nayak(),
        }
    }

    fn rms_laplacian(&self) -> f64 {
        let ((nx, ny), (dx, dy)) = (self.grid.shape(), self.grid.spacing());
        let mut sum = 0.0;
        for i in 0..nx {
            let row = |i: usize| self.heights.row(i % nx);
            let [before, here, after]: [ArrayView1<'_, f64>; 3] = [row(i + nx - 1), row(i), row(i + 1)];
            let laplacian = |j: usize| {
                let (h, below, above) = (here[j], here[(j + ny - 1) % ny], here[(j + 1) % ny]);
                ((after[j] - h) / dx - (h - before[j]) / dx) / dx + ((above - h) / dy - (h - below) / dy) / dy
            };
            sum += (0..ny).map(|j| laplacian(j).powi(2)).sum::<f64>();
        }
        (sum / self.grid.nodes() as f64).sqrt()
    }
}
