//! The decomposition of a symmetric positive matrix by Cholesky, and the solution with it.
//!
//! A crate for it would be the largest dependency of the library.

use crate::vector::{LANES, vectorised};

/// Rows of a matrix that are decomposed together.
const ROWS: usize = 4;

/// The place of a row of a lower triangle, whose rows are stored one after the other.
pub(super) fn start(row: usize) -> usize {
    row * (row + 1) / 2
}

/// Decomposes a symmetric matrix by Cholesky, in its lower triangle; `false` if it is not positive.
pub(super) fn decompose(matrix: &mut [f64], dimension: usize) -> bool {
    for first in (0..dimension).step_by(ROWS) {
        let last = (first + ROWS).min(dimension);
        let (above, below) = matrix.split_at_mut(start(first));
        let block = &mut below[..start(last) - start(first)];
        for j in 0..first {
            let done = &above[start(j)..start(j + 1)];
            let sums = if last - first == ROWS {
                dots(&done[..j], std::array::from_fn(|i| &block[start(first + i) - start(first)..][..j]))
            } else {
                let mut sums = [0.0; ROWS];
                let rows = (first..last).map(|i| dot(&done[..j], &block[start(i) - start(first)..][..j]));
                sums.iter_mut().zip(rows).for_each(|(sum, product)| *sum = product);
                sums
            };
            for (i, sum) in (first..last).zip(sums) {
                let value = &mut block[start(i) - start(first) + j];
                *value = (*value - sum) / done[j];
            }
        }
        for i in first..last {
            let (before, row) = block.split_at_mut(start(i) - start(first));
            for j in first..i {
                let done = &before[start(j) - start(first)..][..=j];
                row[j] = (row[j] - dot(&row[..j], &done[..j])) / done[j];
            }
            let square = row[i] - dot(&row[..i], &row[..i]);
            if !(square > 0.0 && square.is_finite()) {
                return false;
            }
            row[i] = square.sqrt();
        }
    }
    true
}

/// Solves with the factor of [`decompose`].
pub(super) fn solve(factor: &[f64], x: &mut [f64]) {
    let row = |i: usize| &factor[start(i)..start(i + 1)];
    for i in 0..x.len() {
        x[i] = (x[i] - dot(&row(i)[..i], &x[..i])) / row(i)[i];
    }
    for i in (0..x.len()).rev() {
        let value = x[i] / row(i)[i];
        x[i] = value;
        x[..i].iter_mut().zip(row(i)).for_each(|(x, factor)| *x -= value * factor);
    }
}

/// The products of a vector with some others of its length.
fn dots<const N: usize>(vector: &[f64], others: [&[f64]; N]) -> [f64; N] {
    let whole = vector.len() - vector.len() % LANES;
    let rest = |other: &[f64]| other[whole..].iter().zip(&vector[whole..]).map(|(a, b)| a * b).sum::<f64>();
    let mut sums = others.map(rest);
    let total = &mut sums;
    vectorised(
        #[inline(always)]
        move || {
            let mut lanes = [[0.0; LANES]; N];
            for k in (0..whole).step_by(LANES) {
                let vector = &vector[k..k + LANES];
                for (lanes, other) in lanes.iter_mut().zip(others) {
                    let other = &other[k..k + LANES];
                    for l in 0..LANES {
                        lanes[l] += vector[l] * other[l];
                    }
                }
            }
            total.iter_mut().zip(lanes).for_each(|(total, lanes)| *total += lanes.iter().sum::<f64>());
        },
    );
    sums
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    dots(a, [b])[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_that_is_not_positive_is_told() {
        let mut matrix = vec![4.0, 2.0, 1.0, 0.0, 0.0, 1.0];
        assert!(!decompose(&mut matrix, 3));
        let mut x = [4.0, 4.0, 3.0];
        let mut matrix = vec![4.0, 2.0, 5.0, 0.0, 0.0, 9.0];
        assert!(decompose(&mut matrix, 3));
        solve(&matrix, &mut x);
        assert!(x.iter().zip([0.75, 0.5, 1.0 / 3.0]).all(|(x, y)| (x - y).abs() < 1e-15), "{x:?}");
    }
}
