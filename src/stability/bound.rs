//! A lower bound of the smallest eigenvalue.
//!
//! The pair found is (ρ, x), with a residual of norm r. The lifted Hessian H' = H + τ⟨x, ·⟩x has a first eigenvalue no
//! larger than the second one of H. With H' ≥ b therefore b ≤ λ₂, and then
//!
//! - λ₁ ≥ ρ − r²/(b − ρ) if b > ρ (Temple);
//! - λ₁ ≥ c − τr²/(ρ − c)² for every c ≤ b, c < ρ: with v the first mode, ⟨v, x⟩ = ⟨v, residual⟩/(λ₁ − ρ) and λ₁ +
//!   τ⟨v, x⟩² ≥ b.
//!
//! For b, Lanczos' iteration on M½H'M½, with the compliance M as preconditioner. By Chebyshev's polynomials the least
//! Ritz value after k steps is too large by no more than
//!
//! ε + tan²∠(start, first eigenvector) · 4 ((1 − √ε)/(1 + √ε))^(2(k − 1))
//!
//! of the spread, for any ε and any spectrum (compare Kuczyński and Woźniakowski, *SIAM J. Matrix Anal. Appl.* 13
//! (1992)). The start is M½ times normal numbers: its component along a unit vector has a variance no less than the
//! least eigenvalue of M, and is below δ standard deviations with a probability below δ√(2/π). So is the component at
//! the other end, which bounds the spread.

use super::eigenpair::Eigenpair;
use super::hessian::Hessian;
use crate::error::Result;
use crate::real::Real;

/// The least component of the start along either end, in standard deviations: the chance of less at either is 1e-6.
const LEAST: f64 = 6.2e-7;

/// Steps after which the bound is computed again.
const EVERY: usize = 4;

/// A lower bound of the smallest eigenvalue, not above zero if none is found in `most` steps.
pub(super) fn below<T: Real>(hessian: &mut Hessian<'_, T>, pair: &Eigenpair<T>, most: usize) -> Result<f64> {
    let mode = &pair.vector;
    let mut z = mode.clone();
    hessian.precondition(mode, &mut z)?;
    let lift = 1.0 / hessian.product(mode, &z);

    let mut q = hessian.random(1);
    hessian.precondition(&q, &mut z)?;
    let start = hessian.product(&q, &z);
    let least_variance = 1.0 / (hessian.stiffest() + hessian.softest());
    let tangent = start * hessian.nodes() / least_variance / (LEAST * LEAST);
    let (mut before, mut image) = (q.clone(), q.clone());
    before.nodes_mut().fill(T::zero());
    let (mut diagonal, mut beside) = (Vec::new(), Vec::<f64>::new());
    let mut norm = start.sqrt();
    let best = |b: f64| lower_bound(pair, lift, b);
    let mut bound = f64::NEG_INFINITY;
    for step in 1..=most {
        // q of unit norm in M, and z = Mq
        hessian.scale(&mut q, 1.0 / norm);
        hessian.scale(&mut z, 1.0 / norm);
        hessian.apply(&z, &mut image)?;
        let along = hessian.product(mode, &z);
        hessian.combine(1.0, &mut image, lift * along, mode);
        let alpha = hessian.product(&image, &z);
        diagonal.push(alpha);
        hessian.combine(1.0, &mut image, -alpha, &q);
        if let Some(&beta) = beside.last() {
            hessian.combine(1.0, &mut image, -beta, &before);
        }
        std::mem::swap(&mut before, &mut q);
        std::mem::swap(&mut q, &mut image);
        // components outside the admissible fields, from rounding, would grow
        hessian.project(&mut q);
        hessian.precondition(&q, &mut z)?;
        norm = hessian.product(&q, &z).max(0.0).sqrt();
        let whole =
            norm <= 1e3 * T::epsilon().widen() * alpha.abs().max(f64::MIN_POSITIVE) || step >= hessian.dimension();
        if step % EVERY == 0 || whole || step == most {
            let [low, high] = ends(&diagonal, &beside);
            let error = if whole { 1e3 * T::epsilon().widen() } else { uncertainty(tangent, step) };
            if error < 0.5 {
                let spread = (high - low) / (1.0 - 2.0 * error);
                bound = f64::max(bound, best((low - error * spread) * hessian.softest()));
            }
            if bound > 0.0 || whole {
                break;
            }
        }
        beside.push(norm);
    }
    Ok(bound)
}

/// The lower bound of the smallest eigenvalue λ₁ by a lower bound b of the lifted Hessian H'.
fn lower_bound<T>(pair: &Eigenpair<T>, lift: f64, b: f64) -> f64 {
    let (value, square) = (pair.value, pair.residual * pair.residual);
    let lifted = |c: f64| c - lift * square / (value - c).powi(2);
    let temple = if b > value { value - square / (b - value) } else { f64::NEG_INFINITY };
    let shares = (1..10).map(|k| b.min(value * f64::from(k) / 10.0));
    shares.filter(|&c| c < value).map(lifted).fold(temple, f64::max)
}

/// The largest excess of the least Ritz value, as a share of the spread of the eigenvalues.
fn uncertainty(tangent: f64, steps: usize) -> f64 {
    let power = 2.0 * (steps as f64 - 1.0);
    let at = |epsilon: f64| {
        let root = epsilon.sqrt();
        epsilon + 4.0 * (tangent.ln() + power * ((1.0 - root) / (1.0 + root)).ln()).exp()
    };
    (1..400).map(|k| at(0.96_f64.powi(k))).fold(f64::INFINITY, f64::min)
}

/// The least and the largest eigenvalue of a symmetric tridiagonal matrix, by bisection.
fn ends(diagonal: &[f64], beside: &[f64]) -> [f64; 2] {
    let at = |k: Option<usize>| k.and_then(|k| beside.get(k)).map_or(0.0, |b| b.abs());
    let radius = |k: usize| if k + 1 < diagonal.len() { at(Some(k)) } else { 0.0 } + at(k.checked_sub(1));
    let low = diagonal.iter().enumerate().map(|(k, d)| d - radius(k)).fold(f64::INFINITY, f64::min);
    let high = diagonal.iter().enumerate().map(|(k, d)| d + radius(k)).fold(f64::NEG_INFINITY, f64::max);
    // the number of eigenvalues below a number
    let below = |number: f64| {
        let (mut count, mut pivot) = (0, 1.0);
        for (k, d) in diagonal.iter().enumerate() {
            let b = at(k.checked_sub(1));
            pivot = d - number - b * b / pivot;
            if pivot == 0.0 {
                pivot = f64::MIN_POSITIVE;
            }
            count += usize::from(pivot < 0.0);
        }
        count
    };
    [1, diagonal.len()].map(|wanted| {
        let (mut low, mut high) = (low, high);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if below(middle) < wanted { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Field;

    #[test]
    fn the_ends_of_a_chain_of_springs() {
        // 2 − 2 cos(kπ/(n + 1))
        for n in [1, 2, 9] {
            let [low, high] = ends(&vec![2.0; n], &vec![-1.0; n - 1]);
            let exact = |k: usize| 2.0 - 2.0 * (std::f64::consts::PI * k as f64 / (n as f64 + 1.0)).cos();
            assert!((low - exact(1)).abs() < 1e-14 && (high - exact(n)).abs() < 1e-14, "{low} {high}");
        }
    }

    #[test]
    fn a_bound_is_below_the_eigenvalue() {
        // a diagonal 2 by 2: eigenvalues e and 3, and a vector that is off by an angle
        for (e, angle) in [(0.01_f64, 0.01_f64), (1.0, 0.001), (2.9, 1e-4), (0.5, 0.1)] {
            let (sin, cos) = angle.sin_cos();
            let value = e * cos * cos + 3.0 * sin * sin;
            let residual = ((e - value).powi(2) * cos * cos + (3.0 - value).powi(2) * sin * sin).sqrt();
            let pair = Eigenpair { value, residual, noise: 0.0, vector: Field::<f64>::zeros((1, 1)) };
            let lift = 4.0;
            // the least eigenvalue of the lifted matrix
            let (a, b, c) = (e + lift * cos * cos, lift * sin * cos, 3.0 + lift * sin * sin);
            let lifted = 0.5 * (a + c) - (0.25 * (a - c).powi(2) + b * b).sqrt();
            for share in [0.1, 0.5, 1.0] {
                let bound = lower_bound(&pair, lift, share * lifted);
                assert!(bound <= e * (1.0 + 1e-12), "{bound} {e}");
                // and close to it, or to what was known, unless the vector is far off
                assert!(angle > 0.05 || bound > 0.05 * e.min(share * lifted), "{bound} {e} {share}");
            }
        }
    }

    #[test]
    fn more_steps_are_more_certain() {
        assert!(uncertainty(1e20, 5) > 0.9);
        let of: Vec<f64> = [20, 40, 80, 160].iter().map(|&k| uncertainty(1e20, k)).collect();
        assert!(of.windows(2).all(|pair| pair[1] < 0.6 * pair[0]), "{of:?}");
    }
}
