//! Random self-affine surfaces of a given spectrum.

use std::f64::consts::TAU;

use asperity_fft::num_complex::Complex;
use ndarray::Array2;

use super::philox::uniform;
use super::spectrum::is_line;
use super::{Spectrum, Surface, centre};
use crate::error::{Error, Result};
use crate::fft::synthesise;
use crate::grid::Grid;
use crate::setters::setters;

/// Relative slack at the ends of the spectrum, so that the rounding of Lx/Ly decides on no wave.
pub(super) const SLACK: f64 = 1e-12;

/// The amplitude of the roughness of a [`SelfAffine`] surface.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amplitude {
    /// The root mean square of the heights, a length.
    RmsHeight(f64),
    /// The root mean square of the slope, √⟨|∇h|²⟩.
    RmsSlope(f64),
}

/// A generator of periodic, isotropic, self-affine rough surfaces, by Fourier filtering of white noise.
///
/// The power spectral density is, with the wave number k in units of 2π/Lx,
///
/// ```math
/// Φ(k) = C₀                      for k_l ≤ k ≤ k_r   (plateau)
/// Φ(k) = C₀ (k/k_r)^(−2(1+H))    for k_r ≤ k ≤ k_s   (self-affine)
/// Φ(k) = 0                       otherwise,
/// ```
///
/// and (k/k_r)^(−1−2H) in the second branch on a line, `Ny = 1`, for the same Hurst exponent. With periodic waves
/// q = (2πm/Lx, 2πn/Ly) and k = |q| Lx/2π, k_l, k_r and k_s count periods along x, whatever the direction. C₀ is such
/// that the rms height or slope of the surface drawn is the given one, to rounding.
///
/// The amplitude of a wave is drawn by (m, n) and the seed, from Philox 4×32-10, with the same bits on every platform.
/// All grids of the same Lx/Ly that resolve k_s hence have the same heights at the same x/Lx and y/Ly, to rounding.
///
/// ```
/// use asperity::{Amplitude, Grid, SelfAffine};
/// let rough = SelfAffine::default().amplitude(Amplitude::RmsSlope(0.1)).seed(7);
/// let coarse = rough.surface(Grid::square(150, 1.0)?)?;
/// let fine = rough.surface(Grid::square(300, 1.0)?)?;
/// assert!((coarse.statistics().rms_slope / 0.1 - 1.0).abs() < 1e-12);
/// assert!((coarse.heights()[[10, 20]] - fine.heights()[[20, 40]]).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfAffine {
    /// The Hurst exponent H, from 0 to 1. Default 0.8.
    pub hurst: f64,
    /// The wave number of the longest waves, in units of 2π/Lx; positive. Default 4.
    pub k_l: f64,
    /// The wave number of the roll-off, where the plateau ends; at least k_l, which means no plateau. Default 4.
    pub k_r: f64,
    /// The wave number of the shortest waves; at least k_r. The grid must have more than 2k_s nodes along x, and more
    /// than 2k_s Ly/Lx along y. Default 64.
    pub k_s: f64,
    /// The rms height or the rms slope; positive. Default an rms slope of 0.1.
    pub amplitude: Amplitude,
    /// Whether only phases are random, with moduli √Φ; otherwise (default) complex amplitudes are Gaussian.
    pub random_phase: bool,
    /// Seed of the random numbers: each makes another surface. Default 0.
    pub seed: u64,
}

impl Default for SelfAffine {
    fn default() -> Self {
        Self {
            hurst: 0.8,
            k_l: 4.0,
            k_r: 4.0,
            k_s: 64.0,
            amplitude: Amplitude::RmsSlope(0.1),
            random_phase: false,
            seed: 0,
        }
    }
}

impl SelfAffine {
    setters! { hurst: f64, k_l: f64, k_r: f64, k_s: f64, amplitude: Amplitude, random_phase: bool, seed: u64 }

    /// Draws the surface on a grid.
    ///
    /// # Errors
    /// [`Error::Value`] if a parameter is not as its field says, or no wave is between k_l and k_s;
    /// [`Error::Unresolved`] if the grid does not resolve k_s; [`Error::Memory`] if the memory does not suffice.
    pub fn surface(&self, grid: Grid) -> Result<Surface> {
        let band = Band::new(self, &grid)?;
        // heights, spectrum, and what is made of them
        grid.afford("a random surface", 32)?;
        let (nx, _) = grid.shape();
        let (mut heights, sum) = synthesise(&grid, |ky, column| {
            let mut sum = 0.0;
            for wave in band.waves(ky) {
                let amplitude = self.draw(wave.kx, ky).scale(wave.density.sqrt());
                sum += 2.0 * amplitude.norm_sqr() * self.measure(&wave);
                column[wave.kx.rem_euclid(nx as i64) as usize] = amplitude;
                if ky == 0 {
                    column[nx - wave.kx as usize] = amplitude.conj();
                }
            }
            sum
        });
        let scale = self.scale(&grid, sum)?;
        heights.mapv_inplace(|h| scale * h);
        centre(&mut heights);
        Surface::new(grid, heights)
    }

    /// The target spectrum: |ĥ|² of a wave has an exponential distribution about it if amplitudes are Gaussian.
    ///
    /// # Errors
    /// As for [`SelfAffine::surface`].
    pub fn spectrum(&self, grid: Grid) -> Result<Spectrum> {
        let band = Band::new(self, &grid)?;
        let (nx, ny) = grid.shape();
        let (mut powers, mut sum) = (Array2::zeros((ny / 2 + 1, nx)), 0.0);
        for (ky, mut row) in powers.outer_iter_mut().enumerate() {
            for wave in band.waves(ky) {
                sum += 2.0 * wave.density * self.measure(&wave);
                row[wave.kx.rem_euclid(nx as i64) as usize] = wave.density;
                if ky == 0 {
                    row[nx - wave.kx as usize] = wave.density;
                }
            }
        }
        let scale = self.scale(&grid, sum)?.powi(2);
        powers.mapv_inplace(|power| scale * power);
        Ok(Spectrum::new(grid, powers))
    }

    /// The complex amplitude of a wave, of unit mean square.
    fn draw(&self, kx: i64, ky: usize) -> Complex<f64> {
        let [radius, turn] = uniform([kx as u32, ky as u32, 0, 0], [self.seed as u32, (self.seed >> 32) as u32]);
        let modulus = if self.random_phase { 1.0 } else { (-libm::log(1.0 - radius)).sqrt() };
        let (sine, cosine) = libm::sincos(TAU * turn);
        Complex::new(modulus * cosine, modulus * sine)
    }

    /// The contribution of a wave to the given mean square: its power, or its power times k².
    fn measure(&self, wave: &Wave) -> f64 {
        match self.amplitude {
            Amplitude::RmsHeight(_) => 1.0,
            Amplitude::RmsSlope(_) => wave.k2,
        }
    }

    /// The factor that turns a surface with a mean square of `sum` into a surface with the given mean square.
    fn scale(&self, grid: &Grid, sum: f64) -> Result<f64> {
        if sum == 0.0 {
            let requirement = "at least 1: move k_l and k_s further apart";
            return Err(Error::Value { name: "number of waves from k_l to k_s", value: 0.0, requirement });
        }
        Ok(match self.amplitude {
            Amplitude::RmsHeight(height) => height / sum.sqrt(),
            Amplitude::RmsSlope(slope) => slope / sum.sqrt() * (grid.lengths().0 / TAU),
        })
    }
}

struct Wave {
    kx: i64,
    /// the square of the wave number, in units of 2π/Lx
    k2: f64,
    /// Φ/C₀
    density: f64,
}

/// The waves of the spectrum on a rectangle; each stands for its mirror image too.
struct Band {
    /// squares of k_l, k_r and k_s
    ends: [f64; 3],
    /// of k², in Φ
    exponent: f64,
    /// (Lx/Ly)²
    aspect2: f64,
    /// the largest kx
    last: i64,
}

impl Band {
    fn new(parameters: &SelfAffine, grid: &Grid) -> Result<Self> {
        let &SelfAffine { hurst, k_l, k_r, k_s, amplitude, .. } = parameters;
        if !(0.0..=1.0).contains(&hurst) {
            return Err(Error::Value { name: "Hurst exponent", value: hurst, requirement: "from 0 to 1" });
        }
        Error::positive("k_l", k_l)?;
        for (name, value, least, requirement) in [
            ("k_r", Error::finite("k_r", k_r)?, k_l, "at least k_l"),
            ("k_s", Error::finite("k_s", k_s)?, k_r, "at least k_r"),
        ] {
            if value < least {
                return Err(Error::Value { name, value, requirement });
            }
        }
        match amplitude {
            Amplitude::RmsHeight(height) => Error::positive("rms height", height)?,
            Amplitude::RmsSlope(slope) => Error::positive("rms slope", slope)?,
        };
        let ((nx, ny), (lx, ly)) = (grid.shape(), grid.lengths());
        // On a line Ly has no influence.
        let aspect = if grid.is_line() { f64::INFINITY } else { lx / ly };
        let limit = (0.5 * nx as f64).min(0.5 * ny as f64 * aspect);
        if k_s >= limit * (1.0 - SLACK) {
            return Err(Error::Unresolved { k_s, limit, shape: (nx, ny) });
        }
        let longest = k_s * (1.0 + SLACK);
        Ok(Self {
            ends: [(k_l * (1.0 - SLACK)).powi(2), k_r * k_r, longest * longest],
            exponent: if is_line(grid) { -0.5 - hurst } else { -1.0 - hurst },
            aspect2: aspect * aspect,
            last: longest as i64,
        })
    }

    /// The waves with `ky` periods along y, in the half plane ky > 0, or ky = 0 and kx > 0.
    fn waves(&self, ky: usize) -> impl Iterator<Item = Wave> + '_ {
        let [k_l2, k_r2, k_s2] = self.ends;
        let (first, across) = if ky == 0 { (1, 0.0) } else { (-self.last, (ky * ky) as f64 * self.aspect2) };
        (first..=self.last).filter_map(move |kx| {
            let k2 = (kx * kx) as f64 + across;
            (k_l2 <= k2 && k2 <= k_s2).then(|| {
                let density = if k2 <= k_r2 { 1.0 } else { libm::pow(k2 / k_r2, self.exponent) };
                Wave { kx, k2, density }
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fft::Convolver;
    use crate::slab::Slab;

    /// White noise filtered on the nodes, as the paper does it; `root` takes the root of Φ/S.
    fn filtered(root: bool) -> (Spectrum, Spectrum) {
        let n = 128;
        let grid = Grid::square(n, 1.0).unwrap();
        let target = SelfAffine { k_s: 48.0, amplitude: Amplitude::RmsSlope(1.0), ..SelfAffine::default() };
        let target = target.spectrum(grid).unwrap();
        let gauss = |i, j| {
            let [radius, turn] = uniform([i as u32, j as u32, 1, 0], [0; 2]);
            (-2.0 * (1.0 - radius).ln()).sqrt() * (TAU * turn).cos()
        };
        let noise = Array2::from_shape_fn((n, n), |(i, j)| gauss(i, j));
        // ⟨η²⟩ = 1, shared by n² waves
        let flat = ((n * n) as f64).recip();
        let mut heights = Array2::zeros((n, n));
        let filter = |k: usize, column: &mut [Complex<f64>]| {
            for (z, power) in column.iter_mut().zip(target.powers().row(k)) {
                *z = z.scale(if root { (power / flat).sqrt() } else { power / flat });
            }
            [0.0; 3]
        };
        Convolver::new(Slab::whole((n, n))).convolve(noise.view(), heights.view_mut(), filter).unwrap();
        (Surface::new(grid, heights).unwrap().spectrum(), target)
    }

    /// The exponent of the density between two wave numbers, in units of 2π/L.
    fn exponent(spectrum: &Spectrum) -> f64 {
        let psd = spectrum.radial_psd();
        let points = psd.wave_numbers.iter().zip(&psd.densities).map(|(q, c)| ((q / TAU).ln(), c.ln()));
        let points: Vec<_> = points.filter(|(k, _)| (8_f64.ln()..40_f64.ln()).contains(k)).collect();
        let count = points.len() as f64;
        let mean = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / count, sum.1 + p.1 / count));
        let (xx, xy) = points
            .iter()
            .fold((0.0, 0.0), |sum, p| (sum.0 + (p.0 - mean.0).powi(2), sum.1 + (p.0 - mean.0) * (p.1 - mean.1)));
        xy / xx
    }

    #[test]
    fn equation_34_needs_the_root_of_the_ratio_of_densities() {
        let (right, target) = filtered(true);
        assert!((exponent(&right) + 3.6).abs() < 0.1, "{}", exponent(&right));
        assert!((right.rms_slope() / target.rms_slope() - 1.0).abs() < 0.03, "{}", right.rms_slope());
        // as printed, the density comes out squared
        let (printed, _) = filtered(false);
        assert!((exponent(&printed) + 7.2).abs() < 0.2, "{}", exponent(&printed));
        assert!(printed.rms_slope() / target.rms_slope() > 10.0 || printed.rms_slope() / target.rms_slope() < 0.1);
    }
}
