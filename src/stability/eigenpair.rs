//! The smallest eigenvalue, by locally optimal preconditioned conjugate gradients (Knyazev 2001).

use super::hessian::Hessian;
use crate::degrees::{ALIKE, LITTLE};
use crate::error::Result;
use crate::field::{Field, read};
use crate::par::Parts;
use crate::real::Real;

pub(super) struct Eigenpair<T> {
    /// the Rayleigh quotient
    pub(super) value: f64,
    /// the norm of the residual Hx − ρx
    pub(super) residual: f64,
    /// the rounding of the value
    pub(super) noise: f64,
    /// the mode x, of mean square 1
    pub(super) vector: Field<T>,
}

type Matrix = [[f64; 3]; 3];

/// The smallest eigenvalue with its mode, from a random start.
pub(super) fn lowest<T: Real>(hessian: &mut Hessian<'_, T>, tolerance: f64, most: usize) -> Result<Eigenpair<T>> {
    let mut random = hessian.random(0);
    hessian.weigh(&mut random);
    let mut start = Field::zeros(hessian.shape());
    hessian.precondition(&random, &mut start)?;
    drop(random);
    lowest_from(hessian, start, most, true, |hessian, found| {
        let scale = found.value.abs().max(hessian.softest());
        // the error of the eigenvalue is r²/gap, with the softest stiffness for the gap to the next one
        found.residual <= tolerance * scale && found.residual * found.residual <= LITTLE * found.value.abs() * scale
    })
}

pub(super) struct Estimate {
    pub(super) value: f64,
    pub(super) residual: f64,
    pub(super) noise: f64,
    pub(super) iteration: usize,
}

/// The eigenpair from an admissible start, until `Estimate` is accurate enough. If `confirmed`, one more application
/// computes the image Hx, which the iteration only updates.
pub(super) fn lowest_from<T: Real>(
    hessian: &mut Hessian<'_, T>,
    mut x: Field<T>,
    most: usize,
    confirmed: bool,
    enough: impl Fn(&Hessian<'_, T>, &Estimate) -> bool,
) -> Result<Eigenpair<T>> {
    let shape = hessian.shape();
    let [mut ax, mut w, mut aw, mut p, mut ap] = std::array::from_fn(|_| Field::<T>::zeros(shape));
    normalise(hessian, &mut x);
    hessian.apply(&x, &mut ax)?;
    let (mut directions, mut fresh, mut iteration) = (2, true, 0);
    loop {
        let value = hessian.product(&x, &ax);
        // w holds the residual for a while
        w.nodes_mut().copy_from_slice(ax.nodes());
        hessian.combine(1.0, &mut w, -value, &x);
        let residual = hessian.product(&w, &w).sqrt();
        let noise = noise::<T>(hessian, &ax, value);
        let done = residual <= noise || enough(hessian, &Estimate { value, residual, noise, iteration });
        if !residual.is_finite() || iteration >= most || done {
            if fresh || !confirmed {
                return Ok(Eigenpair { value, residual, noise, vector: x });
            }
            // the image was only updated: the reported numbers come from a fresh one
            normalise(hessian, &mut x);
            hessian.apply(&x, &mut ax)?;
            (fresh, directions) = (true, 2);
            continue;
        }
        aw.nodes_mut().copy_from_slice(w.nodes());
        hessian.precondition(&aw, &mut w)?;
        normalise(hessian, &mut w);
        hessian.apply(&w, &mut aw)?;
        let (gram, energy) = products(hessian, [&x, &w, &p], [&ax, &aw, &ap]);
        let [of_x, of_w, of_p] = ritz(&gram, &energy, directions);
        let size = (of_w * of_w * gram[1][1] + 2.0 * of_w * of_p * gram[1][2] + of_p * of_p * gram[2][2]).sqrt();
        if size.is_nan() || size <= 0.0 {
            // the best combination of the three is the present mode
            return Ok(Eigenpair { value, residual, noise, vector: x });
        }
        for (x, w, p) in [(&mut x, &w, &mut p), (&mut ax, &aw, &mut ap)] {
            hessian.combine(of_p / size, p, of_w / size, w);
            hessian.combine(of_x, x, size, p);
        }
        (directions, fresh) = (3, false);
        iteration += 1;
    }
}

fn noise<T: Real>(hessian: &mut Hessian<'_, T>, image: &Field<T>, value: f64) -> f64 {
    // the image is a sum K⁻¹x + φ''x of terms that may both be large
    let image = hessian.product(image, image).sqrt();
    8.0 * T::epsilon().widen() * (image.max(value.abs()) + 2.0 * hessian.least_slope().abs() + hessian.softest())
}

pub(super) fn normalise<T: Real>(hessian: &mut Hessian<'_, T>, field: &mut Field<T>) {
    let norm = hessian.product(field, field).sqrt();
    if norm > 0.0 {
        hessian.scale(field, 1.0 / norm);
    }
}

/// The mean products of three fields with one another, and with their images.
fn products<T: Real>(hessian: &mut Hessian<'_, T>, of: [&Field<T>; 3], images: [&Field<T>; 3]) -> (Matrix, Matrix) {
    let nodes = hessian.nodes();
    let [gram, energy] = [of, images].map(|others| {
        let ([a, b, c], [u, v, w]) = (of.map(read), others.map(read));
        let total = hessian.reducer.run(a.zip(b).zip(c).zip(u.zip(v).zip(w)), |_, (((a, b), c), ((u, v), w))| {
            let mut sums = [0.0; 6];
            for i in 0..a.len() {
                let ([a, b, c], [u, v, w]) = ([a[i], b[i], c[i]].map(T::widen), [u[i], v[i], w[i]].map(T::widen));
                for (sum, product) in sums.iter_mut().zip([a * u, b * v, c * w, a * v, a * w, b * w]) {
                    *sum += product;
                }
            }
            sums
        });
        let [aa, bb, cc, ab, ac, bc] = total.map(|sum| sum / nodes);
        [[aa, ab, ac], [ab, bb, bc], [ac, bc, cc]]
    });
    (gram, energy)
}

/// The combination of the first so many of three fields that has the least energy for its norm, of norm 1.
fn ritz(gram: &Matrix, energy: &Matrix, directions: usize) -> [f64; 3] {
    let mut basis: Vec<[f64; 3]> = Vec::with_capacity(3);
    for k in 0..directions {
        let mut next = [0.0; 3];
        next[k] = 1.0;
        // twice, as once is not enough for nearly parallel ones
        for _ in 0..2 {
            for of in &basis {
                let overlap = form(gram, of, &next);
                next.iter_mut().zip(of).for_each(|(next, of)| *next -= overlap * of);
            }
        }
        let left = form(gram, &next, &next);
        if left > ALIKE * gram[k][k] {
            basis.push(next.map(|c| c / left.sqrt()));
        }
    }
    let mut small = [[0.0; 3]; 3];
    for (i, a) in basis.iter().enumerate() {
        for (j, b) in basis.iter().enumerate() {
            small[i][j] = form(energy, a, b);
        }
    }
    let lowest = lowest_of(small, basis.len());
    let mut result = [0.0; 3];
    for (share, of) in lowest.iter().zip(&basis) {
        result.iter_mut().zip(of).for_each(|(result, of)| *result += share * of);
    }
    // the first field keeps its sign
    if result[0] < 0.0 { result.map(|c| -c) } else { result }
}

fn form(matrix: &Matrix, a: &[f64; 3], b: &[f64; 3]) -> f64 {
    matrix.iter().zip(a).map(|(row, a)| a * row.iter().zip(b).map(|(m, b)| m * b).sum::<f64>()).sum()
}

/// The eigenvector of the least eigenvalue of the leading part of a symmetric matrix, by Jacobi's rotations.
fn lowest_of(mut m: Matrix, size: usize) -> [f64; 3] {
    let mut vectors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..20 {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            if j >= size || m[i][j] == 0.0 {
                continue;
            }
            let half = 0.5 * (m[j][j] - m[i][i]) / m[i][j];
            let tangent = half.signum() / (half.abs() + half.hypot(1.0));
            let cos = tangent.hypot(1.0).recip();
            let sin = tangent * cos;
            let turn = |a: &mut f64, b: &mut f64| (*a, *b) = (cos * *a - sin * *b, sin * *a + cos * *b);
            for row in m.iter_mut().chain(vectors.iter_mut()) {
                let (head, tail) = row.split_at_mut(j);
                turn(&mut head[i], &mut tail[0]);
            }
            let (head, tail) = m.split_at_mut(j);
            head[i].iter_mut().zip(&mut tail[0]).for_each(|(a, b)| turn(a, b));
            (m[i][j], m[j][i]) = (0.0, 0.0);
        }
    }
    let least = (0..size).min_by(|&a, &b| m[a][a].total_cmp(&m[b][b])).unwrap_or(0);
    vectors.map(|row| row[least])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_of_three_combinations() {
        let (gram, energy) = (
            [[1.0, 0.2, 0.1], [0.2, 1.0, -0.3], [0.1, -0.3, 1.0]],
            [[2.0, 0.4, -1.0], [0.4, 3.0, 0.7], [-1.0, 0.7, 0.5]],
        );
        let found = ritz(&gram, &energy, 3);
        assert!((form(&gram, &found, &found) - 1.0).abs() < 1e-14);
        let least = form(&energy, &found, &found);
        for k in 0..3 {
            // stationary
            let mut unit = [0.0; 3];
            unit[k] = 1.0;
            assert!((form(&energy, &unit, &found) - least * form(&gram, &unit, &found)).abs() < 1e-14);
        }
        for i in 0..1000 {
            let [a, b] = [0.1, 0.37].map(|step: f64| (step * f64::from(i)).sin());
            let other = [a, b, 1.0 - a * b];
            assert!(form(&energy, &other, &other) >= least * form(&gram, &other, &other));
        }
        // a field that is in the span of the others is left out
        let twice = [[1.0, 1.0, 0.1], [1.0, 1.0, 0.1], [0.1, 0.1, 1.0]];
        let found = ritz(&twice, &energy, 2);
        assert_eq!(found, [1.0, 0.0, 0.0]);
    }
}
