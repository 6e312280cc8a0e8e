//! Laws that are given by functions.

use std::cell::OnceCell;

use super::scales::Scales;
use crate::adhesion::check::{NAMES, checked_gaps};
use crate::derivatives::{self, Named};
use crate::error::{Error, Result};

/// The functions of a law, which [`Tabulated::of`](crate::Tabulated::of) reads: energy, traction and slope at many gaps
/// at once.
///
/// A closure that returns the three values at one gap implements the trait. Write an implementation for functions that
/// may fail, for functions of many gaps, or to name work of adhesion and range.
///
/// ```
/// use asperity::adhesion::Functions;
/// use asperity::{AdhesionLaw, Result, Tabulated};
/// /// The law of Morse with w = ρ = 1.
/// struct Repulsive;
/// impl Functions for Repulsive {
///     fn set(&self, order: usize, gaps: &[f64], values: &mut [f64]) -> Result<()> {
///         for (value, gap) in values.iter_mut().zip(gaps) {
///             let (a, b) = ((-gap).exp(), (-2.0 * gap).exp());
///             *value = [b - 2.0 * a, 2.0 * (a - b), 4.0 * b - 2.0 * a][order];
///         }
///         Ok(())
///     }
///     fn range(&self) -> Option<f64> {
///         Some(1.0)
///     }
/// }
/// let law = Tabulated::of(Repulsive)?;
/// assert_eq!(AdhesionLaw::<f64>::hints(&law).rest, Some(0.0));
/// assert!((law.traction(2_f64.ln()) - 0.5).abs() < 1e-10);
/// # Ok::<(), asperity::Error>(())
/// ```
pub trait Functions {
    /// Sets the values at gaps: energies for order 0, tractions for 1, slopes for 2.
    ///
    /// # Errors
    /// Errors of the functions, as [`Error::raised`].
    fn set(&self, order: usize, gaps: &[f64], values: &mut [f64]) -> Result<()>;

    /// The work of adhesion; by default −φ in contact, or at the equilibrium separation of a law that repels.
    fn work_of_adhesion(&self) -> Option<f64> {
        None
    }

    /// The length over which the traction decays; by default the work of adhesion over the traction in contact, or
    /// over the greatest attraction of a law that does not attract there.
    fn range(&self) -> Option<f64> {
        None
    }
}

impl<F: Fn(f64) -> [f64; 3]> Functions for F {
    fn set(&self, order: usize, gaps: &[f64], values: &mut [f64]) -> Result<()> {
        values.iter_mut().zip(gaps).for_each(|(value, &gap)| *value = self(gap)[order]);
        Ok(())
    }
}

/// The values of a function at gaps.
pub(super) fn at(law: &impl Functions, order: usize, gaps: &[f64]) -> Result<Vec<f64>> {
    let mut values = vec![0.0; gaps.len()];
    law.set(order, gaps, &mut values)?;
    Ok(values)
}

/// The value of a function at a gap.
pub(super) fn one(law: &impl Functions, order: usize, gap: f64) -> Result<f64> {
    let mut value = [0.0];
    law.set(order, &[gap], &mut value)?;
    Ok(value[0])
}

/// A check that functions are each other's derivatives, for a test of yours, at gaps up to the largest one, by default
/// ten ranges.
///
/// It compares them as [`check_law`](crate::adhesion::check_law) does; gaps next to a jump are passed over.
///
/// # Errors
/// [`Error::Contract`] with the first function and gap that break it, [`Error::Value`] for a largest gap or a range that
/// is not positive and finite, and errors of the functions.
///
/// ```
/// use asperity::adhesion::check_functions;
/// let functions = |gap: f64| [-(-gap).exp(), (-gap).exp(), 0.5 * (-gap).exp()];
/// let error = check_functions(functions, None).unwrap_err();
/// assert!(error.to_string().starts_with("the slope of the adhesive traction is 0.49"));
/// ```
pub fn check_functions(functions: impl Functions, largest_gap: Option<f64>) -> Result<()> {
    let hints = Scales::of(&functions)?.hints;
    let largest_gap = Error::positive("largest gap", largest_gap.unwrap_or_else(|| hints.far()))?;
    let raised = OnceCell::new();
    let value = |order, gap| {
        one(&functions, order, gap).unwrap_or_else(|error| {
            raised.get_or_init(|| error);
            f64::NAN
        })
    };
    let named: [Named<'_>; 3] =
        [(NAMES[0], &|gap| value(0, gap)), (NAMES[1], &|gap| value(1, gap)), (NAMES[2], &|gap| value(2, gap))];
    let (gaps, length) = checked_gaps(&hints, largest_gap);
    let checked = derivatives::check::<f64>(named, gaps, length);
    raised.into_inner().map_or(checked, Err)
}
