//! The analysis of a field into its modes, and the synthesis of a field from modes.

use asperity_fft::num_complex::Complex;
use ndarray::{Array2, ArrayView2};

use super::Convolver;
use super::layout::Layout;
use crate::error::Result;
use crate::field::Field;
use crate::grid::Grid;
use crate::par::{self, Parts};
use crate::slab::Slab;

/// The squared modulus of each mode, in the half spectrum `(n1/2 + 1, n0)`; the amplitude of a constant is its value.
pub(crate) fn powers(field: ArrayView2<'_, f64>) -> Array2<f64> {
    let (n0, n1) = field.dim();
    let mut convolver = Convolver::with(Slab::whole((n0, n1)), Layout::plain((n0, n1)));
    convolver.spectrum.take_memory();
    convolver.rows_forward(field);
    let Convolver { columns, spectrum, pool, .. } = &mut convolver;
    let norm = (n0 as f64 * n1 as f64).recip().powi(2);
    let mut powers = Field::zeros(spectrum.modes.dim());
    let pairs = par::chunks_mut(spectrum.modes.nodes_mut(), n0).zip(par::chunks_mut(powers.nodes_mut(), n0));
    par::for_each(pairs, |_, (z, power)| {
        columns.forward.process_with_scratch(z, &mut pool.get().scratch);
        power.iter_mut().zip(z).for_each(|(power, z)| *power = norm * z.norm_sqr());
    });
    powers.into_array()
}

/// The field of those modes of another that are kept, by their indices along the first and the second axis, the second
/// in the half spectrum.
pub(crate) fn filtered(
    field: ArrayView2<'_, f64>,
    keeps: impl Fn(usize, usize) -> bool + Sync + Send,
) -> Result<Array2<f64>> {
    let mut convolver = Convolver::with(Slab::whole(field.dim()), Layout::plain(field.dim()));
    let mut left = Array2::zeros(field.dim());
    convolver.convolve(field, left.view_mut(), |k1, column| {
        let gone = column.iter_mut().enumerate().filter(|(k0, _)| !keeps(*k0, k1));
        gone.for_each(|(_, z)| *z = Complex::default());
        [0.0; 3]
    })?;
    Ok(left)
}

/// The modes, real and even, of a plane that is even along both axes: of each column of the half spectrum that this
/// process transforms, laid out as in a convolver, the first half and the middle one.
pub(crate) fn even_modes(slab: Slab, field: ArrayView2<'_, f64>) -> Field<f64> {
    let mut convolver = Convolver::new(slab);
    convolver.spectrum.take_memory();
    if !field.is_empty() {
        convolver.rows_forward(convolver.layout.view(&field).view());
    }
    let Convolver { columns, spectrum, pool, layout, .. } = &mut convolver;
    spectrum.come();
    spectrum.each(pool, usize::MAX, |_, column, scratch| {
        columns.forward.process_with_scratch(column, scratch);
        [0.0; 3]
    });
    let shape = (spectrum.own.len(), layout.plane().0 / 2 + 1);
    Field::from_fn(shape, |(k, i)| spectrum.mode(spectrum.own.start + k, i).re)
}

/// The field of given modes on a grid, index zero along the first axis in the middle, and `fill`'s values summed in
/// order.
/// `fill` gets the column's index along the second axis, and zeros to overwrite by its modes along the first. Column 0
/// and the Nyquist column must be even with conjugation.
pub(crate) fn synthesise(
    grid: &Grid,
    fill: impl Fn(usize, &mut [Complex<f64>]) -> f64 + Sync + Send,
) -> (Array2<f64>, f64) {
    let mut convolver = Convolver::with(grid.slab(), Layout::plain(grid.shape()));
    convolver.spectrum.take_memory();
    let Convolver { columns, spectrum, pool, .. } = &mut convolver;
    spectrum.each(pool, usize::MAX, |k, column, scratch| {
        let sum = fill(k, column);
        columns.inverse.process_with_scratch(column, scratch);
        let half = column.len() / 2;
        column.rotate_right(half);
        [sum, 0.0, 0.0]
    });
    spectrum.go();
    let [sum, ..] = spectrum.sums();
    let mut field = Array2::zeros(grid.field_shape());
    if !field.is_empty() {
        convolver.rows_inverse(field.view_mut(), 1.0);
    }
    (field, sum)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_relative_eq;

    use super::super::tests::field;
    use super::*;

    #[test]
    fn fields_are_analysed_and_synthesised_in_every_shape() {
        for (n0, n1) in [(1, 1), (1, 7), (7, 1), (4, 6), (5, 6), (6, 5), (7, 3), (34, 5)] {
            let x = field((n0, n1));
            let sum: f64 = x.iter().map(|x| x * x).sum();
            let powers = powers(x.view());
            let weight = |k: usize| if k == 0 || 2 * k == n1 { 1.0 } else { 2.0 };
            let parseval: f64 = powers.outer_iter().enumerate().map(|(k, row)| weight(k) * row.sum()).sum();
            assert_relative_eq!(parseval, sum / x.len() as f64, max_relative = 1e-13);

            // one wave along both axes, where there is room for it
            let (k0, k1) = (n0.min(2) - 1, (n1 - 1) / 2);
            let amplitude = Complex::new(0.25, if k1 > 0 { -0.5 } else { 0.0 });
            let (wave, returned) = synthesise(&Grid::new((n0, n1), (1.0, 1.0)).unwrap(), |k, column| {
                if k == k1 {
                    column[k0] += amplitude;
                    if k1 == 0 {
                        column[(n0 - k0) % n0] += amplitude.conj();
                    }
                }
                k as f64
            });
            assert_eq!(returned, (0..=n1 / 2).sum::<usize>() as f64);
            for ((i, j), value) in wave.indexed_iter() {
                // what is at index zero is in the middle
                let i = (i + n0 - n0 / 2) % n0;
                let phase = TAU * ((i * k0) as f64 / n0 as f64 + (j * k1) as f64 / n1 as f64);
                let expected = 2.0 * (amplitude * Complex::from_polar(1.0, phase)).re;
                assert_relative_eq!(*value, expected, epsilon = 1e-13);
            }
        }
    }
}
