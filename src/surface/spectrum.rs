//! The power spectrum of a surface.

use std::f64::consts::TAU;

use asperity_fft::num_complex::Complex;
use ndarray::Array2;

use super::{Surface, centre};
use crate::fft::{powers, synthesise};
use crate::grid::Grid;

/// The share of the mean square slope that the waves shorter than the shortest have.
const SHORTEST: f64 = 0.05;

/// The power spectrum of a periodic surface: |ĥ(q)|² of each of its waves, ĥ(q) = ⟨h e^(−iq·x)⟩ over the nodes.
///
/// By Parseval ⟨h²⟩ = Σ|ĥ|², the mean height left out. The shortest wave along an even number of nodes, which is its
/// own mirror image there, counts with the power that it has at the nodes.
///
/// ```
/// use asperity::{Grid, SelfAffine};
/// let surface = SelfAffine::default().k_s(16.0).surface(Grid::square(64, 1.0)?)?;
/// let psd = surface.spectrum().radial_psd();
/// for (q, density) in psd.wave_numbers.iter().zip(&psd.densities) {
///     println!("{q} {density:e}"); // radians per length, length⁴
/// }
/// assert!((psd.total() / surface.rms_height().powi(2) - 1.0).abs() < 1e-12);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    grid: Grid,
    /// of each mode of the half spectrum, `(Ny/2 + 1, Nx)`
    powers: Array2<f64>,
}

/// A power spectral density over wave numbers of both signs, in radians per length, of each wave or averaged over
/// waves of like wave number.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Psd {
    /// The wave number |q| in radians per length, ascending: the mean over the waves of an entry.
    pub wave_numbers: Vec<f64>,
    /// The density at each wave number.
    pub densities: Vec<f64>,
    /// The number of waves in the mean of each entry, with their mirror images.
    pub waves: Vec<usize>,
    /// The area of one wave in the space of wave numbers: 4π²/(Lx·Ly), or 2π/L of a profile.
    pub cell: f64,
}

impl Psd {
    /// The sum of density × waves × cell: ⟨h²⟩, the variance of the heights.
    pub fn total(&self) -> f64 {
        self.cell * self.densities.iter().zip(&self.waves).map(|(density, waves)| density * *waves as f64).sum::<f64>()
    }
}

impl Surface {
    /// The power spectrum, by a Fourier transform.
    pub fn spectrum(&self) -> Spectrum {
        let whole = self.whole();
        let mean = whole.mean();
        let mut powers = powers(whole.heights.mapv(|h| h - mean).view());
        powers[[0, 0]] = 0.0;
        Spectrum::new(whole.grid, powers)
    }
}

impl Spectrum {
    pub(super) fn new(grid: Grid, powers: Array2<f64>) -> Self {
        Self { grid, powers }
    }

    #[cfg(test)]
    pub(super) fn powers(&self) -> &Array2<f64> {
        &self.powers
    }

    /// The grid of the surface.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The root mean square of the heights, √Σ|ĥ|².
    pub fn rms_height(&self) -> f64 {
        self.mean_square(0).sqrt()
    }

    /// The root mean square of the slope, √⟨|∇h|²⟩ = √Σ|q|²|ĥ|².
    pub fn rms_slope(&self) -> f64 {
        self.mean_square(1).sqrt()
    }

    /// The root mean square of the mean curvature, ½√⟨(∇²h)²⟩ = ½√Σ|q|⁴|ĥ|²; on a line of h'', without the ½.
    pub fn rms_curvature(&self) -> f64 {
        (if is_line(&self.grid) { 1.0 } else { 0.5 }) * self.mean_square(2).sqrt()
    }

    /// The spectral moments m₀, m₂ and m₄ of height, slope and curvature of a profile: mₙ = Σ|q|ⁿ|ĥ|² on a line, and
    /// m₂ = ½Σ|q|²|ĥ|², m₄ = ⅜Σ|q|⁴|ĥ|², the means over profiles in all directions, on a surface.
    pub fn moments(&self) -> [f64; 3] {
        let shares = if is_line(&self.grid) { [1.0; 3] } else { [1.0, 0.5, 0.375] };
        std::array::from_fn(|n| shares[n] * self.mean_square(n))
    }

    /// Nayak's parameter α = m₀m₄/m₂²: 1.5 for one wave number on a surface, 1 on a line; NaN for a flat surface.
    pub fn nayak(&self) -> f64 {
        let [m0, m2, m4] = self.moments();
        // one after the other, as the square of a moment leaves the range of the doubles first
        (m0 / m2) * (m4 / m2)
    }

    /// The radially averaged density Φ = |ĥ|² Lx·Ly/4π², a length⁴, with ⟨h²⟩ = ∫Φ dqx dqy over the whole plane.
    ///
    /// Rings are about the multiples of 2π/Lx or 2π/Ly, the larger, and as wide; empty ones are left out. On a line
    /// Φ = |ĥ|² L/2π, a length³, of each wave.
    pub fn radial_psd(&self) -> Psd {
        let ((nx, ny), (lx, ly)) = (self.grid.shape(), self.grid.lengths());
        let (width, cell) = match (nx, ny) {
            (_, 1) => (TAU / lx, TAU / lx),
            (1, _) => (TAU / ly, TAU / ly),
            _ => (TAU / lx.min(ly), TAU / lx * (TAU / ly)),
        };
        let mut rings = Rings::default();
        for (ky, row) in self.powers.outer_iter().enumerate() {
            let (weight, qy) = (self.weight(ky), self.grid.wave_number_y(ky));
            for (kx, power) in row.iter().enumerate().skip(usize::from(ky == 0)) {
                let q = self.grid.wave_number_x(kx).hypot(qy);
                rings.add((q / width).round() as usize, q, *power, weight);
            }
        }
        rings.psd(cell)
    }

    /// The autocorrelation R(Δx) = ⟨h(x) h(x + Δx)⟩ about the mean height, of shape (Nx, Ny). The lag Δx is the
    /// coordinate on the grid, zero at the node `(Nx / 2, Ny / 2)`.
    pub fn autocorrelation(&self) -> Array2<f64> {
        let (mut field, _) = synthesise(&self.grid, |ky, column| {
            column.iter_mut().zip(self.powers.row(ky)).for_each(|(z, power)| *z = Complex::from(*power));
            0.0
        });
        centre(&mut field);
        field
    }

    /// The autocorrelation averaged over directions, (lag, R) up to half of the shorter side: over rings about the
    /// multiples of the larger of Δx and Δy, the lag being the mean of a ring. On a line nothing is averaged.
    pub fn radial_autocorrelation(&self) -> Vec<(f64, f64)> {
        let ((lx, ly), (nx, ny), (dx, dy)) = (self.grid.lengths(), self.grid.shape(), self.grid.spacing());
        let (end, width) = match (nx, ny) {
            (_, 1) => (lx, dx),
            (1, _) => (ly, dy),
            _ => (lx.min(ly), dx.max(dy)),
        };
        let mut rings = Rings::default();
        for ((i, j), r) in self.autocorrelation().indexed_iter() {
            let lag = self.grid.x(i).hypot(self.grid.y(j));
            if lag <= 0.5 * end * (1.0 + 1e-12) {
                rings.add((lag / width).round() as usize, lag, *r, 1);
            }
        }
        let Psd { wave_numbers: lags, densities: means, .. } = rings.psd(1.0);
        lags.into_iter().zip(means).collect()
    }

    /// The number of nodes of the shortest wave, beyond which there is 5 % of the mean square slope, along the side
    /// where it is less; infinite for a flat surface.
    pub fn nodes_per_wave(&self) -> f64 {
        let (nx, ny) = self.grid.shape();
        // the waves by the larger of their shares of the shortest wave that the grid has along the sides
        let finest = nx.max(ny);
        let index = |k: usize, n: usize| (k as f64 / n as f64 * finest as f64).round() as usize;
        let along_x: Vec<_> =
            (0..nx).map(|kx| (index(kx.min(nx - kx), nx), self.grid.wave_number_x(kx).powi(2))).collect();
        let mut slopes = vec![0.0; finest + 1];
        for (ky, row) in self.powers.outer_iter().enumerate() {
            let (index_y, qy, weight) = (index(ky, ny), self.grid.wave_number_y(ky), self.weight(ky) as f64);
            for (power, &(index_x, qx2)) in row.iter().zip(&along_x) {
                slopes[index_x.max(index_y)] += weight * (power * (qx2 + qy * qy));
            }
        }
        let total: f64 = slopes.iter().sum();
        let mut beyond = 0.0;
        for (k, slope) in slopes.iter().enumerate().rev() {
            beyond += slope;
            if k > 0 && beyond > SHORTEST * total {
                return finest as f64 / k as f64;
            }
        }
        f64::INFINITY
    }

    /// Σ|q|²ⁿ|ĥ|² for n from 0 to 2.
    fn mean_square(&self, n: usize) -> f64 {
        let power = |q2: f64| match n {
            0 => 1.0,
            1 => q2,
            _ => q2 * q2,
        };
        let qx2: Vec<_> = (0..self.grid.shape().0).map(|kx| self.grid.wave_number_x(kx).powi(2)).collect();
        let rows = self.powers.outer_iter().enumerate().map(|(ky, row)| {
            let qy2 = self.grid.wave_number_y(ky).powi(2);
            let waves = row.iter().zip(&qx2).map(|(p, qx2)| p * power(qx2 + qy2));
            self.weight(ky) as f64 * waves.sum::<f64>()
        });
        rows.sum()
    }

    /// The number of waves for which a mode of the half spectrum stands.
    fn weight(&self, ky: usize) -> usize {
        if ky == 0 || 2 * ky == self.grid.shape().1 { 1 } else { 2 }
    }
}

pub(super) fn is_line(grid: &Grid) -> bool {
    grid.shape().0 == 1 || grid.shape().1 == 1
}

#[derive(Default)]
struct Rings(Vec<Ring>);

#[derive(Clone, Default)]
struct Ring {
    count: usize,
    position: f64,
    value: f64,
}

impl Rings {
    fn add(&mut self, index: usize, position: f64, value: f64, count: usize) {
        if self.0.len() <= index {
            self.0.resize(index + 1, Ring::default());
        }
        let ring = &mut self.0[index];
        ring.count += count;
        ring.position += count as f64 * position;
        ring.value += count as f64 * value;
    }

    fn psd(self, cell: f64) -> Psd {
        let rings = || self.0.iter().filter(|ring| ring.count > 0);
        let mean = |sum: f64, ring: &Ring| sum / ring.count as f64;
        Psd {
            wave_numbers: rings().map(|ring| mean(ring.position, ring)).collect(),
            densities: rings().map(|ring| mean(ring.value, ring) / cell).collect(),
            waves: rings().map(|ring| ring.count).collect(),
            cell,
        }
    }
}
