//! A check that an energy, its traction and the traction's slope are each other's derivatives, for users' tests.

use crate::error::{Breach, Error, Place, Result};
use crate::real::Real;

pub(crate) const GAPS: usize = 200;

pub(crate) type Named<'a> = (&'static str, &'a dyn Fn(f64) -> f64);

/// Compares the second function with central differences of the first, and the third with differences of the second, at
/// gaps from `low` to `high`, in the precision T, to a hundredth of the largest value; gaps next to a jump are passed
/// over. `length` is the gap over which the functions vary. [`Error::Contract`] has the function and the first gap at
/// which it is not finite, or not the derivative, and what it should be there.
pub(crate) fn check<T: Real>(functions: [Named<'_>; 3], (low, high): (f64, f64), length: f64) -> Result<()> {
    // the step that balances truncation against rounding in a central difference
    let step = length * T::epsilon().widen().cbrt();
    let gaps = || (0..=GAPS).map(|i| low + 2.0 * step + (high - low - 2.0 * step) * i as f64 / GAPS as f64);
    for (function, f) in functions {
        if let Some(gap) = std::iter::once(low).chain(gaps()).find(|&g| !f(g).is_finite()) {
            return Err(Error::not_finite(function, gap, f(gap)));
        }
    }
    for pair in functions.windows(2) {
        let (f, (function, derivative)) = (pair[0].1, pair[1]);
        let chord = |a: f64, b: f64| {
            // the gaps as the functions see them
            let (a, b) = (T::lit(a).widen(), T::lit(b).widen());
            (f(b) - f(a)) / (b - a)
        };
        let rounding = 8.0 * T::epsilon().widen() * gaps().map(|g| f(g).abs()).fold(0.0, f64::max) / step;
        let size = gaps().map(|g| derivative(g).abs()).fold(0.0, f64::max);
        for gap in gaps() {
            let (nearer, farther) = (gap - 0.5 * step, gap + 0.5 * step);
            let (wide, narrow) = (chord(gap - step, gap + step), chord(nearer, farther));
            let differ = |a: f64, b: f64| (a - b).abs() > rounding + 0.2 * a.abs().max(b.abs());
            let jump = differ(wide, narrow) || differ(chord(nearer, gap), chord(gap, farther));
            let value = derivative(gap);
            if !jump && (narrow - value).abs() > rounding + 1e-2 * size {
                let (place, breach) = (Place::Gap(gap), Breach::Derivative(narrow));
                return Err(Error::Contract { function, value, place, breach });
            }
        }
    }
    Ok(())
}
