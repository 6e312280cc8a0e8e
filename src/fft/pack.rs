//! Packing: two real rows in one complex line, and their two spectra in the spectrum of the line.

use asperity_fft::num_complex::Complex;
use ndarray::{ArrayView1, ArrayView2, ArrayViewMut2, Axis};

use super::SLACK;
use crate::field::contiguous;
use crate::real::Real;

pub(super) fn lines<T>(tile: &[Complex<T>], n: usize) -> impl Iterator<Item = &[Complex<T>]> {
    tile.chunks_exact(n + SLACK).map(move |line| &line[..n])
}

pub(super) fn lines_mut<T>(tile: &mut [Complex<T>], n: usize) -> impl Iterator<Item = &mut [Complex<T>]> {
    tile.chunks_exact_mut(n + SLACK).map(move |line| &mut line[..n])
}

fn columns_are_contiguous(strides: &[isize]) -> bool {
    strides[0] == 1 && strides[1] != 1
}

/// Rows `2j` and `2j + 1` become the real and the imaginary part of line `j`.
pub(super) fn pack<T: Real>(x: ArrayView2<'_, T>, tile: &mut [Complex<T>]) {
    if columns_are_contiguous(x.strides()) {
        return pack_columns(x, tile);
    }
    for (pair, line) in x.axis_chunks_iter(Axis(0), 2).zip(lines_mut(tile, x.ncols())) {
        let re = pair.row(0);
        if pair.nrows() == 1 {
            line.iter_mut().zip(re).for_each(|(z, &re)| *z = Complex::new(re, T::zero()));
            continue;
        }
        let im = pair.row(1);
        match (re.to_slice(), im.to_slice()) {
            (Some(re), Some(im)) => {
                line.iter_mut().zip(re).zip(im).for_each(|((z, &re), &im)| *z = Complex::new(re, im));
            }
            _ => line.iter_mut().zip(re).zip(im).for_each(|((z, &re), &im)| *z = Complex::new(re, im)),
        }
    }
}

/// Real and imaginary part of line `j` become rows `2j` and `2j + 1`, rounded to the precision of the field.
pub(super) fn unpack<T: Real, U: Real>(tile: &[Complex<T>], mut x: ArrayViewMut2<'_, U>) {
    let n = x.ncols();
    let part = |part: T| U::lit(part.widen());
    if columns_are_contiguous(x.strides()) {
        return unpack_columns(tile, x);
    }
    for (mut pair, line) in x.axis_chunks_iter_mut(Axis(0), 2).zip(lines(tile, n)) {
        for (i, mut row) in pair.rows_mut().into_iter().enumerate() {
            match (i, row.as_slice_mut()) {
                (0, Some(row)) => row.iter_mut().zip(line).for_each(|(x, z)| *x = part(z.re)),
                (_, Some(row)) => row.iter_mut().zip(line).for_each(|(x, z)| *x = part(z.im)),
                (_, None) => row.iter_mut().zip(line).for_each(|(x, z)| *x = part(if i == 0 { z.re } else { z.im })),
            }
        }
    }
}

fn pack_columns<T: Real>(x: ArrayView2<'_, T>, tile: &mut [Complex<T>]) {
    let stride = x.ncols() + SLACK;
    for (k, column) in x.columns().into_iter().enumerate() {
        let mut pairs = contiguous(column.to_slice()).chunks_exact(2);
        let mut lines = tile[k..].iter_mut().step_by(stride);
        pairs.by_ref().zip(lines.by_ref()).for_each(|(x, z)| *z = Complex::new(x[0], x[1]));
        pairs.remainder().iter().zip(lines).for_each(|(&x, z)| *z = Complex::new(x, T::zero()));
    }
}

fn unpack_columns<T: Real, U: Real>(tile: &[Complex<T>], mut x: ArrayViewMut2<'_, U>) {
    let stride = x.ncols() + SLACK;
    let part = |part: T| U::lit(part.widen());
    for (k, mut column) in x.columns_mut().into_iter().enumerate() {
        let mut pairs = contiguous(column.as_slice_mut()).chunks_exact_mut(2);
        let mut lines = tile[k..].iter().step_by(stride);
        pairs.by_ref().zip(lines.by_ref()).for_each(|(x, z)| (x[0], x[1]) = (part(z.re), part(z.im)));
        pairs.into_remainder().iter_mut().zip(lines).for_each(|(x, z)| *x = part(z.re));
    }
}

/// The spectra `A`, `B` of the two rows in each line, `Z = A + iB`, go to the columns of `z`.
pub(super) fn separate<T: Real>(tile: &[Complex<T>], n: usize, mut z: ArrayViewMut2<'_, Complex<T>>) {
    let half = T::lit(0.5);
    for (k, mut column) in z.rows_mut().into_iter().enumerate() {
        let mirror = (n - k) % n;
        let mut pairs = contiguous(column.as_slice_mut()).chunks_exact_mut(2);
        let mut lines = lines(tile, n);
        for (pair, line) in pairs.by_ref().zip(lines.by_ref()) {
            let (p, q) = (line[k], line[mirror]);
            pair[0] = Complex::new((p.re + q.re) * half, (p.im - q.im) * half);
            pair[1] = Complex::new((p.im + q.im) * half, (q.re - p.re) * half);
        }
        if let ([a], Some(line)) = (pairs.into_remainder(), lines.next()) {
            *a = line[k];
        }
    }
}

pub(super) fn join<T: Real>(z: ArrayView2<'_, Complex<T>>, n: usize, norm: T, tile: &mut [Complex<T>]) {
    for (k, column) in z.rows().into_iter().enumerate() {
        let mirror = (n - k) % n;
        let pairs = contiguous(ArrayView1::to_slice(&column)).chunks_exact(2);
        let last = pairs.remainder();
        let mut lines = lines_mut(tile, n);
        for (pair, line) in pairs.zip(lines.by_ref()) {
            let (a, b) = (pair[0].scale(norm), pair[1].scale(norm));
            // the mirror first: at k = 0 and k = n/2 the second store wins, and A, B are real there
            line[mirror] = Complex::new(a.re + b.im, b.re - a.im);
            line[k] = Complex::new(a.re - b.im, a.im + b.re);
        }
        if let ([a], Some(line)) = (last, lines.next()) {
            let a = a.scale(norm);
            line[mirror] = a.conj();
            line[k] = a;
        }
    }
}
