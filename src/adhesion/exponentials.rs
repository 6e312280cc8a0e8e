//! Exponentials of many numbers on vector instructions.

use crate::real::once;
use crate::vector::{BLOCK, vectorised};

once! {
    /// `factor·exp(rate·x)` for many x, to two units in the last place; zero where it would be subnormal.
    ///
    /// Without branches and tables, so that it runs on vector instructions, with the same bits on every platform.
    pub(super) exponentials<'a, T>(factor: T, rate: T, x: &'a [T], results: &'a mut [T]) -> () =
        exponentials_f32, exponentials_f64;
}

/// exp x = 2ᵏ exp r with |r| ≤ ½ ln 2: a Taylor series of r, and k into the bits of the exponent.
macro_rules! exponentials {
    ($name:ident, $float:ty, $mantissa:literal, $bias:literal, $magic:expr, $ln2:expr, $low:expr, $high:expr, $series:expr) => {
        fn $name(factor: $float, rate: $float, x: &[$float], results: &mut [$float]) {
            vectorised(
                #[inline(always)]
                || {
                    let mut powers = [0.0; BLOCK];
                    for (results, x) in results.chunks_mut(BLOCK).zip(x.chunks(BLOCK)) {
                        // in two loops, each short enough that a processor works on several of its numbers at once
                        for ((r, power), &x) in results.iter_mut().zip(&mut powers).zip(x) {
                            let x = rate * x;
                            let held = if x < $low { $low } else { x };
                            let held = if held > $high { $high } else { held };
                            // adding it rounds to an integer, which stays in the last bits
                            let shifted = held * <$float as num_traits::FloatConst>::LOG2_E() + $magic;
                            let k = shifted - $magic;
                            let exact = <$float>::from_bits(shifted.to_bits().wrapping_add($bias) << $mantissa);
                            let bounded = if x > $high { <$float>::INFINITY } else { exact };
                            *power = if x < $low { 0.0 } else { bounded };
                            *r = held - k * $ln2.0 - k * $ln2.1;
                        }
                        for (result, &power) in results.iter_mut().zip(&powers) {
                            *result = factor * ($series(*result) * power);
                        }
                    }
                },
            );
        }
    };
}

const fn reciprocal_factorials<const N: usize>() -> [f64; N] {
    let mut terms = [1.0; N];
    let mut k = 1;
    while k < N {
        terms[k] = terms[k - 1] / k as f64;
        k += 1;
    }
    terms
}

// The terms are summed in pairs, and the pairs in pairs (Estrin), so that few operations wait for one another; the
// first two, which carry the rounding, come last.

#[inline(always)]
fn series_f64(r: f64) -> f64 {
    const C: [f64; 14] = reciprocal_factorials();
    let r2 = r * r;
    let r4 = r2 * r2;
    let low = (C[2] + C[3] * r) + (C[4] + C[5] * r) * r2;
    let middle = (C[6] + C[7] * r) + (C[8] + C[9] * r) * r2;
    let high = (C[10] + C[11] * r) + (C[12] + C[13] * r) * r2;
    1.0 + (r + r2 * (low + r4 * (middle + r4 * high)))
}

#[inline(always)]
fn series_f32(r: f32) -> f32 {
    const C: [f64; 8] = reciprocal_factorials();
    let c = |k: usize| C[k] as f32;
    let r2 = r * r;
    let low = (c(2) + c(3) * r) + (c(4) + c(5) * r) * r2;
    let high = c(6) + c(7) * r;
    1.0 + (r + r2 * (low + r2 * r2 * high))
}

exponentials!(
    exponentials_f32,
    f32,
    23,
    127,
    12_582_912.0,
    (0.693_359_4_f32, -2.121_944_4e-4_f32),
    -87.0,
    88.0,
    series_f32
);
exponentials!(
    exponentials_f64,
    f64,
    52,
    1023,
    6_755_399_441_055_744.0,
    (0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10),
    -708.0,
    709.0,
    series_f64
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_are_right_to_two_units_in_the_last_place() {
        let x: Vec<f64> =
            (0..200_000).map(|i| -720.0 + 1.44e3 * f64::from(i) / 2e5 + 1e-3 * f64::from(i).sin()).collect();
        let mut found = vec![0.0; x.len()];
        exponentials(1.0, 1.0, &x, &mut found);
        for (&x, &found) in x.iter().zip(&found) {
            let exact = if x < -708.0 {
                0.0
            } else if x > 709.0 {
                f64::INFINITY
            } else {
                x.exp()
            };
            assert!(found == exact || (found - exact).abs() <= 2.0 * f64::EPSILON * exact, "{x} {found:e} {exact:e}");
        }
        let x: Vec<f32> = (0..200_000).map(|i| (-89.0 + 179.0 * f64::from(i) / 2e5) as f32).collect();
        let mut found = vec![0.0; x.len()];
        exponentials(1.0, 1.0, &x, &mut found);
        for (&x, &found) in x.iter().zip(&found) {
            let exact = if x < -87.0 {
                0.0
            } else if x > 88.0 {
                f64::INFINITY
            } else {
                f64::from(x).exp()
            };
            let error = (f64::from(found) - exact).abs();
            assert!(
                f64::from(found) == exact || error <= 2.0 * f64::from(f32::EPSILON) * exact,
                "{x} {found:e} {exact:e}"
            );
        }
    }

    #[test]
    fn exponentials_of_what_is_not_finite() {
        let mut found = [0.0; 3];
        exponentials(2.0, -1.0, &[f64::INFINITY, f64::NAN, 0.0], &mut found);
        assert!(found[0] == 0.0 && found[1].is_nan() && found[2] == 2.0);
    }
}
