//! The two-dimensional real transform, as a convolution: forward, a factor per mode, inverse.

use std::fmt;

use asperity_fft::num_complex::Complex;
use asperity_fft::{Transform, double, single};
use ndarray::{Array2, ArrayView2, ArrayViewMut2};
use num_traits::Zero;

use crate::error::{Error, Result};
use crate::par::{self, Parts, Pool};
use crate::real::{Real, once};
use crate::slab::{Slab, TILE};

mod analysis;
mod columns;
mod layout;
mod pack;

pub(crate) use analysis::{even_modes, filtered, powers, synthesise};
pub(crate) use columns::HalfSpectrum;
pub(crate) use layout::Layout;
use layout::Twiddles;
use pack::{join, lines_mut, pack, separate, unpack};

once! {
    /// The transform of a length.
    transform<T>(len: usize) -> Transform<T> = single, double;
    /// The convolution of a slab.
    planned<T>(slab: Slab, layout: Layout, rows: Transform<T>, columns: Transform<T>) -> Convolver<T> =
        Convolver::planned;
}

/// Slack after each line of a tile: with a power-of-two stride a column of the tile would fall into one cache set.
const SLACK: usize = 8;

/// The transform of a real field, laid out as a plane `(n0, n1)`, and its half spectrum.
/// Two real rows ride in one complex transform. The half spectrum is transposed, `(n1/2 + 1, n0)`: a column is
/// transformed, multiplied and transformed back while it is in cache. Memory: the spectrum, one field's worth and `n0`
/// complex numbers more, a tile per worker, and the spectrum again where processes share the grid.
pub struct Convolver<T: Real> {
    slab: Slab,
    layout: Layout,
    twiddles: Option<Twiddles<T>>,
    rows: Transform<T>,
    columns: Transform<T>,
    spectrum: HalfSpectrum<T>,
    pool: Pool<Workspace<T>>,
}

pub(crate) type Products = [f64; 3];

struct Workspace<T> {
    tile: Vec<Complex<T>>,
    /// a column, where it comes in pieces from several processes
    column: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

impl<T: Real> fmt::Debug for Convolver<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Convolver").field("layout", &self.layout).finish_non_exhaustive()
    }
}

impl<T: Real> Clone for Convolver<T> {
    fn clone(&self) -> Self {
        planned(self.slab, self.layout, self.rows.clone(), self.columns.clone())
    }
}

impl<T: Real> Convolver<T> {
    pub(crate) fn new(slab: Slab) -> Self {
        Self::with(slab, Layout::new(slab.shape()))
    }

    fn with(slab: Slab, layout: Layout) -> Self {
        let (n0, n1) = layout.plane();
        planned(slab, layout, transform(n1), transform(n0))
    }

    pub(crate) fn planned(slab: Slab, layout: Layout, rows: Transform<T>, columns: Transform<T>) -> Self {
        let (n0, n1) = layout.plane();
        let (spectrum, scratch) = (HalfSpectrum::new(slab, layout), rows.scratch_len().max(columns.scratch_len()));
        let line = if spectrum.is_in_pieces() { n0 } else { 0 };
        let pool = Pool::new(|| Workspace {
            tile: vec![Complex::zero(); TILE.min(n0).div_ceil(2) * (n1 + SLACK)],
            column: vec![Complex::zero(); line],
            scratch: vec![Complex::zero(); scratch],
        });
        Self { slab, layout, twiddles: Twiddles::new(&layout), rows, columns, spectrum, pool }
    }

    /// Gives back the spectrum; the next convolution takes it anew.
    pub(crate) fn release_memory(&mut self) {
        self.spectrum.release_memory();
    }

    pub(crate) fn layout(&self) -> Layout {
        self.layout
    }

    /// Transforms `input`, hands every column of the half spectrum to `modify`, and transforms back into `output`.
    /// `modify` gets the column's index and its modes, unnormalised, at [`Layout::mode`], and returns numbers, which
    /// are summed in the order of the columns. The inverse is normalised.
    pub(crate) fn convolve<U: Real>(
        &mut self,
        input: ArrayView2<'_, T>,
        output: ArrayViewMut2<'_, U>,
        modify: impl Fn(usize, &mut [Complex<T>]) -> Products + Sync + Send,
    ) -> Result<Products> {
        self.convolve_after(input, output, 0, |_| (), |(), k, column| modify(k, column))
    }

    /// [`Convolver::convolve`] with a `look` at the half spectrum when the first `ahead` columns are transformed and
    /// none is modified; `modify` gets what it returns.
    pub(crate) fn convolve_after<U: Real, L: Sync>(
        &mut self,
        input: ArrayView2<'_, T>,
        output: ArrayViewMut2<'_, U>,
        ahead: usize,
        look: impl FnOnce(&HalfSpectrum<T>) -> L,
        modify: impl Fn(&L, usize, &mut [Complex<T>]) -> Products + Sync + Send,
    ) -> Result<Products> {
        let (held, shape, mut output) = (self.slab.held(), self.layout.shape(), output);
        Error::shape("operator input", input.dim(), held)?;
        Error::shape("operator output", output.dim(), held)?;
        let norm = T::lit(1.0 / (shape.0 as f64 * shape.1 as f64));
        self.spectrum.take_memory();
        if held.0 > 0 {
            self.rows_forward(self.layout.view(&input).view());
        }
        let Self { columns, spectrum, pool, twiddles, .. } = self;
        spectrum.come();
        let turn = |k: usize, column: &mut [_], back| twiddles.iter().for_each(|t| t.turn(k, column, back));
        let forward = |k: usize, column: &mut [_], scratch: &mut [_]| {
            turn(k, column, false);
            columns.forward.process_with_scratch(column, scratch);
        };
        if ahead > 0 {
            spectrum.each(pool, ahead, |k, column, scratch| {
                forward(k, column, scratch);
                [0.0; 3]
            });
        }
        let seen = look(spectrum);
        spectrum.each(pool, usize::MAX, |k, column, scratch| {
            if k >= ahead {
                forward(k, column, scratch);
            }
            let sums = modify(&seen, k, column);
            columns.inverse.process_with_scratch(column, scratch);
            turn(k, column, true);
            sums
        });
        spectrum.go();
        let sums = spectrum.sums();
        if held.0 == 0 {
            return Ok(sums);
        }
        if let Some(plane) = self.layout.view_mut(output.view_mut()) {
            self.rows_inverse(plane, norm);
        } else {
            let mut line = Array2::zeros(shape);
            if let Some(plane) = self.layout.view_mut(line.view_mut()) {
                self.rows_inverse(plane, norm);
            }
            output.assign(&line);
        }
        Ok(sums)
    }

    fn rows_forward(&mut self, input: ArrayView2<'_, T>) {
        let Self { rows, spectrum, pool, layout, .. } = self;
        let (_, n1) = layout.plane();
        par::for_each(
            par::tiles(input, 0, TILE).zip(par::tiles_mut(spectrum.modes.view_mut(), 1, TILE)),
            |_, (x, z)| {
                let Workspace { tile, scratch, .. } = &mut *pool.get();
                pack(x.0, tile);
                for line in lines_mut(tile, n1).take(x.0.nrows().div_ceil(2)) {
                    rows.forward.process_with_scratch(line, scratch);
                }
                separate(tile, n1, z.0);
            },
        );
    }

    fn rows_inverse<U: Real>(&mut self, output: ArrayViewMut2<'_, U>, norm: T) {
        let Self { rows, spectrum, pool, layout, .. } = self;
        let (_, n1) = layout.plane();
        par::for_each(par::tiles_mut(output, 0, TILE).zip(par::tiles(spectrum.modes.view(), 1, TILE)), |_, (x, z)| {
            let Workspace { tile, scratch, .. } = &mut *pool.get();
            join(z.0, n1, norm, tile);
            for line in lines_mut(tile, n1).take(x.0.nrows().div_ceil(2)) {
                rows.inverse.process_with_scratch(line, scratch);
            }
            unpack(tile, x.0);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use ndarray::{Array2, AxisDescription, ShapeBuilder, Slice};
    use std::f64::consts::TAU;

    pub(super) fn field(shape: (usize, usize)) -> Array2<f64> {
        Array2::from_shape_fn(shape, |(i, j)| ((i * 37 + j * 61 + i * j * 7) % 101) as f64 / 50.0 - 1.0)
    }

    fn oracle(x: &Array2<f64>, factor: impl Fn(usize, usize) -> f64) -> Array2<f64> {
        let (n0, n1) = x.dim();
        let turn = |a: usize, b: usize, n: usize| Complex::from_polar(1.0, TAU * ((a * b) % n) as f64 / n as f64);
        let mut y = Array2::zeros((n0, n1));
        for k0 in 0..n0 {
            for k1 in 0..n1 {
                let mode: Complex<f64> =
                    x.indexed_iter().map(|((i, j), &x)| turn(i, k0, n0).conj() * turn(j, k1, n1).conj() * x).sum();
                let mode = mode * factor(k0, k1) / (n0 * n1) as f64;
                for ((i, j), y) in y.indexed_iter_mut() {
                    *y += (mode * turn(i, k0, n0) * turn(j, k1, n1)).re;
                }
            }
        }
        y
    }

    #[test]
    fn convolution_is_the_defining_sum_for_every_parity_and_shape() {
        // planes, wide and narrow ones, and lines: of few nodes, of many divisors, and of none
        let planes =
            [(1, 1), (2, 2), (4, 6), (5, 6), (6, 5), (7, 3), (33, 2), (34, 5), (65, 3), (3, 65), (2, 33), (31, 32)];
        let lines = [2, 4, 7, 8, 9, 15, 22, 36, 37, 66, 105, 144, 1369].into_iter().flat_map(|n| [(n, 1), (1, n)]);
        for shape in planes.into_iter().chain(lines) {
            let x = field(shape);
            let even = |k: usize, n: usize| k.min(n - k) as f64;
            let factor = |k0: usize, k1: usize| 1.0 / (1.0 + even(k0, shape.0).hypot(2.0 * even(k1, shape.1)));
            let mut convolver = Convolver::new(Slab::whole(shape));
            let layout = convolver.layout();
            let mut y = Array2::from_elem(shape, f64::NAN);
            for _ in 0..2 {
                // the second time with a dirty workspace
                convolver
                    .convolve(x.view(), y.view_mut(), |k, column| {
                        column.iter_mut().enumerate().for_each(|(i, z)| {
                            let (k0, k1) = layout.mode(k, i);
                            *z = z.scale(factor(k0, k1));
                        });
                        [0.0; 3]
                    })
                    .unwrap();
            }
            for (y, expected) in y.iter().zip(&oracle(&x, factor)) {
                assert_relative_eq!(*y, *expected, epsilon = 1e-13);
            }
        }
    }

    #[test]
    fn any_memory_layout_will_do() {
        for shape in [(34, 9), (6, 9), (36, 1), (1, 36), (7, 1)] {
            let x = field(shape);
            let mut fortran = Array2::zeros(shape.f());
            fortran.assign(&x);
            // every third node of a larger field, backwards
            let mut spread = Array2::zeros((3 * shape.0, 3 * shape.1));
            let third = |_: AxisDescription| Slice::new(0, None, -3);
            spread.slice_each_axis_mut(third).assign(&x);
            let mut a = Array2::<f64>::zeros(shape);
            let (mut b, mut c) = (Array2::<f64>::zeros(shape.f()), Array2::<f64>::zeros(spread.dim()));
            let double = |_: usize, column: &mut [Complex<f64>]| {
                column.iter_mut().for_each(|z| *z = z.scale(2.0));
                [1.0, 0.0, -2.0]
            };
            let mut convolver = Convolver::new(Slab::whole(shape));
            let columns = convolver.layout().spectrum().0 as f64;
            let sums = convolver.convolve(x.view(), a.view_mut(), double);
            assert_eq!(sums, Ok([columns, 0.0, -2.0 * columns]));
            convolver.convolve(fortran.view(), b.view_mut(), double).unwrap();
            assert_eq!(a, b);
            convolver.convolve(spread.slice_each_axis(third), c.slice_each_axis_mut(third), double).unwrap();
            assert_eq!(a, c.slice_each_axis(third));
        }
    }

    #[test]
    fn a_line_is_half_a_spectrum_with_all_of_its_modes() {
        for n in [4, 9, 15, 36, 37, 105] {
            for shape in [(n, 1), (1, n)] {
                let layout = Layout::new(shape);
                let (columns, modes) = layout.spectrum();
                // a prime number of nodes has no half, and two nodes have both columns
                assert!([4, 37].contains(&n) || columns * modes <= n * 3 / 4, "{layout:?}");
                let mut found = vec![0; n];
                for (k, i) in (0..columns).flat_map(|k| (0..modes).map(move |i| (k, i))) {
                    let (k0, k1) = layout.mode(k, i);
                    let mode = k0 + k1;
                    found[mode] += 1;
                    if layout.weight(k) == 2.0 {
                        found[(n - mode) % n] += 1;
                    }
                }
                assert!(found.iter().all(|&found| found == 1), "{layout:?} {found:?}");
            }
        }
    }

    #[test]
    fn wrong_shapes_are_refused() {
        let mut convolver = Convolver::<f64>::new(Slab::whole((4, 4)));
        let (x, mut y) = (Array2::zeros((4, 5)), Array2::<f64>::zeros((4, 4)));
        assert!(convolver.convolve(x.view(), y.view_mut(), |_, _| [0.0; 3]).is_err());
    }
}
