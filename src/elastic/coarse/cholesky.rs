//! The decomposition of a symmetric positive matrix by Cholesky; a crate for it would be our largest dependency.

use crate::vector::{LANES, vectorised};

/// Rows of a matrix that are decomposed together.
pub(super) const ROWS: usize = 4;

/// The place of a row of a lower triangle that is stored row after row.
pub(super) fn start(row: usize) -> usize {
    row * (row + 1) / 2
}

/// Decomposes a symmetric matrix in its lower triangle; `false` if it is not positive. The workspace may be dirty.
pub(super) fn decompose(matrix: &mut [f64], workspace: &mut [[f64; ROWS]]) -> bool {
    let mut positive = false;
    vectorised(
        #[inline(always)]
        || positive = decomposes(matrix, workspace),
    );
    positive
}

#[inline(always)]
fn decomposes(matrix: &mut [f64], workspace: &mut [[f64; ROWS]]) -> bool {
    let dimension = workspace.len();
    for first in (0..dimension).step_by(ROWS) {
        let last = (first + ROWS).min(dimension);
        let (above, below) = matrix.split_at_mut(start(first));
        let (block, columns) = (&mut below[..start(last) - start(first)], &mut workspace[..first]);
        // the rows side by side, so that their products with another one are sums of vectors
        for (i, row) in (first..last).enumerate() {
            let row = &block[start(row) - start(first)..][..first];
            columns.iter_mut().zip(row).for_each(|(column, value)| column[i] = *value);
        }
        for j in 0..first {
            let done = &above[start(j)..start(j + 1)];
            let sums = dots(&done[..j], &columns[..j]);
            for (value, sum) in columns[j].iter_mut().zip(sums) {
                *value = (*value - sum) / done[j];
            }
        }
        for (i, row) in (first..last).enumerate() {
            let row = &mut block[start(row) - start(first)..][..first];
            row.iter_mut().zip(&*columns).for_each(|(value, column)| *value = column[i]);
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

pub(super) fn solve(factor: &[f64], x: &mut [f64]) {
    let row = |i: usize| &factor[start(i)..start(i + 1)];
    vectorised(
        #[inline(always)]
        || {
            for i in 0..x.len() {
                x[i] = (x[i] - dot(&row(i)[..i], &x[..i])) / row(i)[i];
            }
            for i in (0..x.len()).rev() {
                let value = x[i] / row(i)[i];
                x[i] = value;
                x[..i].iter_mut().zip(row(i)).for_each(|(x, factor)| *x -= value * factor);
            }
        },
    );
}

/// The products of a vector with some others of its length, which are side by side.
#[inline(always)]
fn dots<const N: usize>(vector: &[f64], others: &[[f64; N]]) -> [f64; N] {
    let add = |sums: &mut [f64; N], value: f64, others: &[f64; N]| {
        sums.iter_mut().zip(others).for_each(|(sum, other)| *sum += value * other);
    };
    let ((values, last_values), (whole, last)) = (vector.as_chunks::<LANES>(), others.as_chunks::<LANES>());
    let (mut sums, mut lanes) = ([0.0; N], [[0.0; N]; LANES]);
    for (&value, others) in last_values.iter().zip(last) {
        add(&mut sums, value, others);
    }
    for (values, others) in values.iter().zip(whole) {
        for l in 0..LANES {
            add(&mut lanes[l], values[l], &others[l]);
        }
    }
    let mut total = [0.0; N];
    for lane in &lanes {
        add(&mut total, 1.0, lane);
    }
    add(&mut sums, 1.0, &total);
    sums
}

#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    dots(a, b.as_chunks::<1>().0)[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_that_is_not_positive_is_told() {
        let mut matrix = vec![4.0, 2.0, 1.0, 0.0, 0.0, 1.0];
        assert!(!decompose(&mut matrix, &mut [[0.0; ROWS]; 3]));
        let mut x = [4.0, 4.0, 3.0];
        let mut matrix = vec![4.0, 2.0, 5.0, 0.0, 0.0, 9.0];
        assert!(decompose(&mut matrix, &mut [[0.0; ROWS]; 3]));
        solve(&matrix, &mut x);
        assert!(x.iter().zip([0.75, 0.5, 1.0 / 3.0]).all(|(x, y)| (x - y).abs() < 1e-15), "{x:?}");
    }
}
