//! Roots, maxima and integrals, among them the two elliptic integrals of Carlson.

use std::f64::consts::FRAC_PI_2;

use crate::Error;

/// Where `f`, not increasing on [low, high], passes `target`, f(low) ≥ `target` ≥ f(high), by bisection down to
/// neighbouring numbers: some sixty evaluations. NaN counts as below.
pub(super) fn falls_to(f: impl Fn(f64) -> f64, target: f64, mut low: f64, mut high: f64) -> f64 {
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return middle;
        }
        if f(middle) > target { low = middle } else { high = middle }
    }
}

/// An upper end for [`falls_to`]: the first of low + 1, + 2, + 4 … at which `f` is not above `target`.
pub(super) fn below(f: impl Fn(f64) -> f64, target: f64, low: f64) -> f64 {
    let mut step = 1.0;
    while f(low + step) > target && step < 512.0 {
        step *= 2.0;
    }
    low + step
}

/// Where `f` is largest on [low, high], to the root of rounding: golden sections about the best point of a scan.
pub(super) fn peak(f: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    const POINTS: usize = 512;
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let at = |i: usize| low + (high - low) * i as f64 / POINTS as f64;
    let mut best = (0, f(low));
    for i in 1..=POINTS {
        let value = f(at(i));
        if value > best.1 {
            best = (i, value);
        }
    }
    let (mut low, mut high) = (at(best.0.saturating_sub(1)), at((best.0 + 1).min(POINTS)));
    for _ in 0..80 {
        let span = GOLDEN * (high - low);
        if f(high - span) < f(low + span) { low = high - span } else { high = low + span }
    }
    0.5 * (low + high)
}

/// The integral of a smooth function over [low, high]: trapezoidal rule after the substitution tanh(½π sinh t).
pub(super) fn integral(f: impl Fn(f64) -> f64, low: f64, high: f64, points: usize) -> f64 {
    /// There the weights have fallen to rounding.
    const END: f64 = 3.2;
    let (middle, half, step) = (0.5 * (low + high), 0.5 * (high - low), 2.0 * END / points as f64);
    let terms = (0..=points).map(|i| {
        let t = step * i as f64 - END;
        let (inner, slope) = (FRAC_PI_2 * t.sinh(), FRAC_PI_2 * t.cosh());
        f(middle + half * inner.tanh()) * slope / inner.cosh().powi(2)
    });
    half * step * terms.sum::<f64>()
}

/// sin x − x cos x, without cancellation at small x.
pub(super) fn sin_minus_x_cos(x: f64) -> f64 {
    if x.abs() > 0.7 {
        return x.sin() - x * x.cos();
    }
    // x³/3 − x⁵/30 + x⁷/840 …: term k is (−1)^(k+1) 2k x^(2k+1)/(2k+1)!
    let (mut sum, mut power) = (0.0, x);
    for k in 1..=10 {
        let two_k = f64::from(2 * k);
        power *= -x * x / (two_k * (two_k + 1.0));
        sum -= two_k * power;
    }
    sum
}

/// t + (1 − t) ln(1 − t) for 0 ≤ t ≤ 1, without cancellation at small t.
pub(super) fn entropy_gap(t: f64) -> f64 {
    if t > 0.2 {
        return if t < 1.0 { t + (1.0 - t) * (-t).ln_1p() } else { 1.0 };
    }
    // Σ tᵏ/(k(k − 1)) from k = 2
    (2..=24).rev().fold(0.0, |sum, k| sum * t + 1.0 / f64::from(k * (k - 1))) * t * t
}

/// Carlson's R_F(x, y, z) by duplication, for x ≥ 0 and y, z > 0 (DLMF 19.36.1).
pub(super) fn carlson_rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    for _ in 0..400 {
        let mean = (x + y + z) / 3.0;
        let (dx, dy) = (1.0 - x / mean, 1.0 - y / mean);
        let dz = -dx - dy;
        if dx.abs().max(dy.abs()).max(dz.abs()) < 1e-3 {
            let (e2, e3) = (dx * dy - dz * dz, dx * dy * dz);
            return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / mean.sqrt();
        }
        let (sx, sy, sz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = sx * sy + sx * sz + sy * sz;
        (x, y, z) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda));
    }
    f64::NAN
}

/// Carlson's R_D(x, y, z) by duplication, for x ≥ 0 and y, z > 0 (DLMF 19.36.2).
pub(super) fn carlson_rd(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let (mut sum, mut factor) = (0.0, 1.0);
    for _ in 0..400 {
        let mean = (x + y + 3.0 * z) / 5.0;
        let (dx, dy) = (1.0 - x / mean, 1.0 - y / mean);
        let dz = -(dx + dy) / 3.0;
        if dx.abs().max(dy.abs()).max(dz.abs()) < 1e-3 {
            let (xy, zz) = (dx * dy, dz * dz);
            let (e2, e3, e4, e5) = (xy - 6.0 * zz, (3.0 * xy - 8.0 * zz) * dz, 3.0 * (xy - zz) * zz, xy * zz * dz);
            let series =
                1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 - 3.0 * e4 / 22.0 - 9.0 * e2 * e3 / 52.0
                    + 3.0 * e5 / 26.0;
            return 3.0 * sum + factor * series / (mean * mean.sqrt());
        }
        let (sx, sy, sz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = sx * sy + sx * sz + sy * sz;
        sum += factor / (sz * (z + lambda));
        factor *= 0.25;
        (x, y, z) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda));
    }
    f64::NAN
}

/// A mean pressure that is no tension.
pub(super) fn pressed(value: f64) -> crate::Result<f64> {
    let (name, requirement) = ("mean_pressure", "zero or more, as there is no adhesion");
    if value >= 0.0 { Ok(value) } else { Err(Error::Value { name, value, requirement }) }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn carlson_integrals_have_their_known_values() {
        // the values of Carlson (1995), section 3
        assert_relative_eq!(carlson_rf(1.0, 2.0, 1e-300), 1.311_028_777_146_059_9, max_relative = 1e-14);
        assert_relative_eq!(carlson_rf(2.0, 3.0, 4.0), 0.584_082_841_677_15, max_relative = 1e-13);
        assert_relative_eq!(carlson_rd(0.0, 2.0, 1.0), 1.797_210_352_103_388_3, max_relative = 1e-14);
        assert_relative_eq!(carlson_rd(2.0, 3.0, 4.0), 0.165_105_272_942_61, max_relative = 1e-13);
        // homogeneous, over many decades
        assert_relative_eq!(carlson_rf(1e20, 2e20, 3e20), 1e-10 * carlson_rf(1.0, 2.0, 3.0), max_relative = 1e-14);
        assert_relative_eq!(carlson_rd(7.0, 7.0, 7.0), 7f64.powf(-1.5), max_relative = 1e-14);
    }

    #[test]
    fn series_meet_the_formulas_where_they_take_over() {
        for x in [0.5f64, 0.7, 0.700_000_1] {
            assert_relative_eq!(sin_minus_x_cos(x), x.sin() - x * x.cos(), max_relative = 1e-14);
        }
        assert_relative_eq!(sin_minus_x_cos(1e-9), 1e-27 / 3.0, max_relative = 1e-14);
        for t in [0.15f64, 0.2, 0.200_000_1] {
            assert_relative_eq!(entropy_gap(t), t + (1.0 - t) * (1.0 - t).ln(), max_relative = 1e-13);
        }
        assert_relative_eq!(entropy_gap(1e-9), 0.5e-18, max_relative = 1e-8);
    }

    #[test]
    fn an_integral_is_exact_to_rounding() {
        assert_relative_eq!(integral(f64::exp, -1.0, 2.0, 64), 2f64.exp() - (-1f64).exp(), max_relative = 1e-14);
        // Struve's functions, DLMF 11.5.1: H₀(x) = 2/π ∫ sin(x sin θ) dθ
        let struve = |x: f64| integral(|t| (x * t.sin()).sin(), 0.0, FRAC_PI_2, 48 + 3 * x as usize) / FRAC_PI_2;
        assert_relative_eq!(struve(1.0), 0.568_656_627_048_287_9, max_relative = 1e-13);
        assert_relative_eq!(struve(10.0), 0.118_743_683_687_504_7, max_relative = 1e-12);
    }

    #[test]
    fn roots_and_peaks() {
        assert_relative_eq!(falls_to(|x| x.cos(), 0.0, 0.0, 3.0), 0.5 * PI, max_relative = 1e-15);
        assert_relative_eq!(peak(|x| -(x - 0.3).powi(2), -5.0, 5.0), 0.3, epsilon = 1e-7);
        assert!(below(|x| -x, -100.0, 0.0) >= 100.0);
    }
}
