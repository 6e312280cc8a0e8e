use std::fmt;

use rustfft::num_complex::Complex;

use super::*;
use crate::fft::Convolver;

/// What a wave with wave numbers (qx, qy) needs: pressure per displacement.
type Symbol = Box<dyn Fn(f64, f64) -> f64 + Send + Sync>;

/// An elastic operator that multiplies each wave by a factor, its stiffness k(qx, qy): p̂ = k û.
///
/// A layered or an anisotropic half-space is one closure away. For the homogeneous one, k = E*|q|/2, see
/// [`Westergaard`].
///
/// Memory per node, in units of one scalar: 1 for the spectrum and ½ for the stiffness. On `f32` grids the
/// constructor of a [`Problem`](crate::Problem) briefly needs 6 more, to transform the heights in `f64`.
///
/// ```
/// use asperity::{ElasticOperator, Grid, Spectral};
/// // a layer of thickness t on a rigid, frictionless base: stiffer for long waves, the half-space for short ones
/// let (modulus, t) = (1.0, 0.1);
/// let layer = Spectral::<f64>::isotropic(Grid::square(32, 1.0)?, modulus, move |q| {
///     let x = 2.0 * q * t;
///     0.5 * modulus * q * (x.sinh() + x) / (x.cosh() - 1.0)
/// })?;
/// assert!(layer.stiffness_range().0 > 5.0);
/// # Ok::<(), asperity::Error>(())
/// ```
pub struct Spectral<T: Real> {
    grid: Grid,
    modulus: f64,
    symbol: Symbol,
    /// the stiffness of each mode, in the layout of the spectrum
    stiffness: Array2<T>,
    range: (f64, f64),
    convolver: Convolver<T>,
}

impl<T: Real> fmt::Debug for Spectral<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Spectral").field("grid", &self.grid).field("modulus", &self.modulus).finish_non_exhaustive()
    }
}

impl<T: Real> Spectral<T> {
    /// The operator with stiffness `symbol(qx, qy)`, pressure per length, for wave numbers in radians per length.
    ///
    /// `modulus` is the contact modulus E* to which the operator tends for short waves; it serves only to tell whether
    /// adhesion is resolved. The symbol must be even, k(−q) = k(q), and positive; it is not asked for q = 0. Where the
    /// Nyquist wave number has no sign, the mean of both signs is taken.
    ///
    /// # Errors
    /// [`Error::Value`] if the modulus or the symbol at any mode is not positive and finite, in the precision of T.
    pub fn new(grid: Grid, modulus: f64, symbol: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) -> Result<Self> {
        Error::positive("contact modulus", modulus)?;
        let symbol: Symbol = Box::new(symbol);
        let stiffness = stiffness(&grid, &symbol)?;
        let modes = || stiffness.iter().skip(1).map(|k: &T| k.widen());
        let range = if grid.nodes() == 1 {
            (0.0, 0.0)
        } else {
            (modes().fold(f64::INFINITY, f64::min), modes().fold(0.0, f64::max))
        };
        Ok(Self { grid, modulus, symbol, stiffness, range, convolver: Convolver::new(grid.shape()) })
    }

    /// The operator with a stiffness that depends on the wave number's magnitude alone.
    ///
    /// # Errors
    /// As for [`Spectral::new`].
    pub fn isotropic(grid: Grid, modulus: f64, symbol: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Result<Self> {
        Self::new(grid, modulus, move |qx, qy| symbol(qx.hypot(qy)))
    }
}

/// The symbol at every mode of the half spectrum, transposed as the convolver stores it: `(Ny/2 + 1, Nx)`.
fn stiffness<T: Real>(grid: &Grid, symbol: &Symbol) -> Result<Array2<T>> {
    let (nx, ny) = grid.shape();
    let mut wrong = None;
    let modes = Array2::from_shape_fn((ny / 2 + 1, nx), |(j, i)| {
        if (i, j) == (0, 0) {
            return T::zero();
        }
        let (qx, qy) = (grid.wave_number_x(i), grid.wave_number_y(j));
        let nyquist = (2 * i == nx && j > 0) || (2 * j == ny && i > 0);
        let value = if nyquist { 0.5 * (symbol(qx, qy) + symbol(-qx, qy)) } else { symbol(qx, qy) };
        let rounded = T::lit(value);
        if !(rounded > T::zero() && rounded.is_finite()) {
            wrong.get_or_insert(value);
        }
        rounded
    });
    match wrong {
        Some(value) => Err(Error::Value {
            name: "stiffness of a wave",
            value,
            requirement: "positive and finite in the precision of the fields",
        }),
        None => Ok(modes),
    }
}

/// Multiplies the modes of one column by their stiffness.
fn stiffen<T: Real>(column: &mut [Complex<T>], stiffness: &[T]) -> f64 {
    column.iter_mut().zip(stiffness).for_each(|(z, &k)| *z = z.scale(k));
    0.0
}

/// The row of the stiffness that belongs to column `k` of the spectrum.
fn row<T>(stiffness: &Array2<T>, k: usize) -> &[T] {
    stiffness.row(k).to_slice().unwrap_or_default()
}

impl<T: Real> ElasticOperator<T> for Spectral<T> {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn pressure(&mut self, displacement: ArrayView2<'_, T>, pressure: ArrayViewMut2<'_, T>) -> Result<()> {
        let stiffness = &self.stiffness;
        self.convolver.convolve(displacement, pressure, |k, column| stiffen(column, row(stiffness, k)))?;
        Ok(())
    }

    fn displacement(&mut self, pressure: ArrayView2<'_, T>, displacement: ArrayViewMut2<'_, T>) -> Result<()> {
        let stiffness = &self.stiffness;
        self.convolver.convolve(pressure, displacement, |k, column| {
            for (z, &k) in column.iter_mut().zip(row(stiffness, k)) {
                *z = if k > T::zero() { z.scale(k.recip()) } else { Complex::default() };
            }
            0.0
        })?;
        Ok(())
    }

    fn stiffness_range(&self) -> (f64, f64) {
        self.range
    }

    fn modulus(&self) -> f64 {
        self.modulus
    }

    fn surface_pressure(&mut self, heights: ArrayView2<'_, f64>, mut pressure: ArrayViewMut2<'_, T>) -> Result<f64> {
        Error::shape("pressure", pressure.dim(), self.grid.shape())?;
        let stiffness = stiffness::<f64>(&self.grid, &self.symbol)?;
        let mut precise = Array2::zeros(self.grid.shape());
        Convolver::new(self.grid.shape())
            .convolve(heights, precise.view_mut(), |k, column| stiffen(column, row(&stiffness, k)))?;
        Zip::from(&mut pressure).and(&precise).for_each(|p, &precise| *p = T::lit(precise));
        Ok(mean_product(heights, precise.view()))
    }

    /// M has the symbol 1/(k + s), s the foundation; the returned product comes from the same transform.
    fn precondition(
        &mut self,
        residual: ArrayView2<'_, T>,
        foundation: f64,
        preconditioned: ArrayViewMut2<'_, T>,
    ) -> Result<f64> {
        let (stiffness, ny, foundation) = (&self.stiffness, self.grid.shape().1, T::lit(foundation));
        let sum = self.convolver.convolve(residual, preconditioned, |k, column| {
            let mut sum = 0.0;
            for (z, &k) in column.iter_mut().zip(row(stiffness, k)) {
                if k > T::zero() {
                    sum += (z.re.widen().powi(2) + z.im.widen().powi(2)) / k.widen();
                }
                *z = z.scale((k + foundation).recip());
            }
            // each stored mode stands for its mirror image too, but on the axis and the Nyquist line
            if k == 0 || 2 * k == ny { sum } else { 2.0 * sum }
        })?;
        Ok(sum / (self.grid.nodes() as f64).powi(2))
    }
}
