//! Surfaces from Fourier coefficients.

use std::f64::consts::TAU;

use asperity_fft::num_complex::Complex;
use ndarray::Array2;

use super::Surface;
use super::pair::SAME;
use crate::error::{Error, Result};
use crate::fft::synthesise;
use crate::grid::Grid;

/// A surface as a Fourier series, by the coefficients ĥ of its waves with m periods along x and n along y:
///
/// ```math
/// h(x, y) = Σ ĥₘₙ exp(2πi(mx/Lx + ny/Ly))
/// ```
///
/// Heights are real: a wave stands for its opposite, (−m, −n), too, which has the complex conjugate. A half spectrum is
/// hence enough, such as FFTW and `numpy.fft.rfft2` have it; where both are given they have to agree, and count once.
/// Coefficients are as FFTW's inverse transform takes them: results of its forward transform over the number of nodes.
/// Node (0, 0) is at x = y = 0.
///
/// ```
/// use asperity::Grid;
/// use asperity::surface::FourierSeries;
/// let mut series = FourierSeries::new(Grid::new((8, 4), (2.0, 1.0))?)?;
/// series.add((1.0, 0.0), (0.5, 0.0))?; // cos(πx)
/// let heights = series.surface(0.1)?.heights().clone();
/// assert!((heights[[0, 0]] - 0.1).abs() < 1e-15 && (heights[[4, 3]] + 0.1).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct FourierSeries {
    grid: Grid,
    /// of the waves in the half plane n > 0, or n = 0 and m ≥ 0, at [n, m modulo Nx]
    half: Array2<Complex<f64>>,
    /// whether a wave, and whether its opposite was given
    given: Array2<[bool; 2]>,
}

impl FourierSeries {
    /// A series without any wave, for a surface on a grid.
    ///
    /// # Errors
    /// [`Error::Memory`] if the memory does not suffice.
    pub fn new(grid: Grid) -> Result<Self> {
        // coefficients, and what the transform makes of them
        grid.afford("a surface from Fourier coefficients", 40)?;
        let (nx, ny) = grid.shape();
        let shape = (ny.div_ceil(2), nx);
        Ok(Self { grid, half: Array2::zeros(shape), given: Array2::from_elem(shape, [false; 2]) })
    }

    /// Adds a wave: its periods (m, n) along the sides, whole numbers of either sign, and the real and the imaginary
    /// part of its coefficient. Waves of coefficient zero are left out.
    ///
    /// # Errors
    /// [`Error::Value`] if a number is not finite, a number of periods is not whole or at least half the number of
    /// nodes along its side, the wave has a coefficient already, or the opposite wave's is not the complex conjugate.
    pub fn add(&mut self, (m, n): (f64, f64), (re, im): (f64, f64)) -> Result<()> {
        Error::finite("real part of the coefficient", re)?;
        Error::finite("imaginary part of the coefficient", im)?;
        let (nx, ny) = self.grid.shape();
        let zero = re == 0.0 && im == 0.0;
        for (name, value, nodes) in [("number of waves along x", m, nx), ("number of waves along y", n, ny)] {
            if value.fract() != 0.0 {
                return Err(Error::Value { name, value, requirement: "a whole number, of periods along the side" });
            }
            if !zero && 2.0 * value.abs() >= nodes as f64 {
                let requirement = "below half the number of nodes along the side: take more nodes";
                return Err(Error::Value { name, value, requirement });
            }
        }
        if zero {
            return Ok(());
        }
        let turned = n < 0.0 || (n == 0.0 && m < 0.0);
        let (m, n, value) = if turned { (-m, -n, Complex::new(re, -im)) } else { (m, n, Complex::new(re, im)) };
        let place = [n as usize, (m as i64).rem_euclid(nx as i64) as usize];
        let (given, known) = (&mut self.given[place], &mut self.half[place]);
        if given[usize::from(turned)] {
            let requirement = "1: leave the others out";
            return Err(Error::Value { name: "number of coefficients of the wave", value: 2.0, requirement });
        }
        // the mean is its own opposite
        let expected = if m == 0.0 && n == 0.0 { value.conj() } else { *known };
        let off = (value - expected).norm() / value.norm().max(expected.norm());
        if off > SAME && (given[usize::from(!turned)] || place == [0, 0]) {
            let name = "relative difference from the complex conjugate of the coefficient of the opposite wave";
            return Err(Error::Value { name, value: off, requirement: "at most 1e-6: leave one of the two out" });
        }
        given[usize::from(turned)] = true;
        *known = value;
        Ok(())
    }

    /// The surface, with heights in units of `unit`, or of the grid's lengths if `unit` is 1.
    ///
    /// # Errors
    /// [`Error::Value`] if the unit is not positive, or no wave has a coefficient; [`Error::NotFinite`] if heights
    /// overflow.
    pub fn surface(&self, unit: f64) -> Result<Surface> {
        Error::positive("unit of the coefficients", unit)?;
        if !self.given.iter().any(|given| given.contains(&true)) {
            let requirement = "at least 1";
            return Err(Error::Value { name: "number of coefficients other than zero", value: 0.0, requirement });
        }
        let nx = self.grid.shape().0;
        // the synthesis has index zero along x in the middle
        let turns: Vec<_> = (0..nx)
            .map(|m| {
                let (sine, cosine) = libm::sincos(TAU * (m * (nx / 2) % nx) as f64 / nx as f64);
                Complex::new(unit * cosine, unit * sine)
            })
            .collect();
        let (heights, _) = synthesise(&self.grid, |n, column| {
            let known = self.half.outer_iter().nth(n).into_iter().flatten();
            column.iter_mut().zip(known).zip(&turns).for_each(|((z, known), turn)| *z = known * turn);
            for m in (1..nx.div_ceil(2)).filter(|_| n == 0) {
                column[nx - m] = column[m].conj();
            }
            0.0
        });
        Surface::new(self.grid, heights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Amplitude, SelfAffine};

    /// The coefficients of heights, by their definition.
    fn coefficient(surface: &Surface, (m, n): (i64, i64)) -> Complex<f64> {
        let (nx, ny) = surface.grid().shape();
        let turns = |k: i64, i: usize, nodes: usize| (k * i as i64).rem_euclid(nodes as i64) as f64 / nodes as f64;
        let wave = |(i, j)| Complex::from_polar(1.0, -TAU * (turns(m, i, nx) + turns(n, j, ny)));
        surface.heights().indexed_iter().map(|(place, h)| wave(place) * h).sum::<Complex<f64>>() / (nx * ny) as f64
    }

    fn periods() -> impl Iterator<Item = (i64, i64)> {
        (-5..=5).flat_map(|m| (-5..=5).map(move |n| (m, n)))
    }

    fn refused(found: Result<()>, part: &str) {
        let message = found.unwrap_err().to_string();
        assert!(message.contains(part), "{part} not in {message}");
    }

    #[test]
    fn a_surface_comes_back_from_its_coefficients() {
        let rough = SelfAffine::default().k_l(1.0).k_s(5.0).amplitude(Amplitude::RmsHeight(1.0)).seed(5);
        for (shape, lengths) in [((12, 16), (1.0, 1.0)), ((15, 13), (1.0, 1.0)), ((14, 1), (2.0, 1.0))] {
            let rough = rough.surface(Grid::new(shape, lengths).unwrap()).unwrap();
            // half of the spectrum, all of it, and the half with column 0 as a whole
            for given in [|m, n| n > 0 || (n == 0 && m > 0), |_, _| true, |_, n| n >= 0] {
                let mut series = FourierSeries::new(*rough.grid()).unwrap();
                for (m, n) in periods().filter(|&(m, n)| given(m, n) && (n == 0 || shape.1 > 1)) {
                    let value = coefficient(&rough, (m, n));
                    // the mean of the heights is rounding
                    if value.norm() > 1e-12 {
                        series.add((m as f64, n as f64), (value.re, value.im)).unwrap();
                    }
                }
                let found = series.surface(2.0).unwrap();
                for (h, expected) in found.heights().iter().zip(rough.heights()) {
                    assert!((h - 2.0 * expected).abs() < 1e-13, "{shape:?}: {h} {expected}");
                }
            }
        }
    }

    #[test]
    fn finer_grids_have_the_same_heights_at_their_nodes() {
        let of = |n| {
            let mut series = FourierSeries::new(Grid::square(n, 1.0).unwrap()).unwrap();
            series.add((0.0, 0.0), (0.25, 0.0)).unwrap();
            series.add((2.0, -1.0), (0.5, 1.0)).unwrap();
            series.surface(1.0).unwrap().heights().clone()
        };
        let (coarse, fine) = (of(7), of(21));
        assert!(coarse.indexed_iter().all(|((i, j), h)| (h - fine[[3 * i, 3 * j]]).abs() < 1e-14));
        // by hand at the origin: the mean, and twice the real part
        assert!((coarse[[0, 0]] - 1.25).abs() < 1e-15);
    }

    #[test]
    fn what_is_no_series_is_refused() {
        let mut series = FourierSeries::new(Grid::square(8, 1.0).unwrap()).unwrap();
        assert!(series.surface(1.0).unwrap_err().to_string().contains("at least 1"));
        series.add((4.0, 9e99), (0.0, 0.0)).unwrap();
        assert!(series.surface(1.0).unwrap_err().to_string().contains("is 0"));
        series.add((3.0, -2.0), (1.0, 2.0)).unwrap();
        series.add((-3.0, 2.0), (1.0, -2.000001)).unwrap();
        refused(series.add((-3.0, 2.0), (1.0, -2.0)), "number of coefficients of the wave is 2");
        refused(series.add((12.5, 0.0), (1.0, 0.0)), "along x is 12.5: it must be a whole number");
        refused(series.add((0.0, f64::NAN), (1.0, 0.0)), "along y is NaN");
        refused(series.add((4.0, 0.0), (1.0, 0.0)), "along x is 4: it must be below half");
        refused(series.add((0.0, -5.0), (1.0, 0.0)), "along y is -5: it must be below half");
        refused(series.add((0.0, 1.0), (f64::INFINITY, 0.0)), "real part");
        refused(series.add((0.0, 0.0), (1.0, 1.0)), "complex conjugate");
        series.add((1.0, 0.0), (1.0, 1.0)).unwrap();
        refused(series.add((-1.0, 0.0), (1.0, 1.0)), "complex conjugate");
        assert!(series.surface(0.0).is_err());
    }
}
