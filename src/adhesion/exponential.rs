use super::exponentials::exponentials;
use super::{AdhesionLaw, Hints, Values};
use crate::error::{Error, Result};
use crate::real::Real;

/// The exponential law, of equations (37) and (38) of Rey, Anciaux and Molinari (2017), with w for their γ.
///
/// ```math
/// φ(g) = −w exp(−g/ρ) ,   φ'(g) = w/ρ exp(−g/ρ) ,   φ''(g) = −w/ρ² exp(−g/ρ)
/// ```
///
/// ```
/// use asperity::{AdhesionLaw, Exponential};
/// let law = Exponential::new(0.05, 2e-9)?; // 50 mJ/m² over 2 nm
/// assert_eq!((law.energy(0.0), law.traction(0.0)), (-0.05, 0.05 / 2e-9));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    work_of_adhesion: f64,
    range: f64,
}

impl Exponential {
    /// The law with work of adhesion w (energy per area) and range ρ (length), in either precision.
    ///
    /// # Errors
    /// [`Error::Value`] if w is negative, ρ not positive, or either not finite.
    pub fn new(work_of_adhesion: f64, range: f64) -> Result<Self> {
        Error::non_negative("work of adhesion", work_of_adhesion)?;
        Error::positive("range of adhesion", range)?;
        Ok(Self { work_of_adhesion, range })
    }

    /// The work of adhesion w.
    pub fn work_of_adhesion(&self) -> f64 {
        self.work_of_adhesion
    }

    /// The range ρ.
    pub fn range(&self) -> f64 {
        self.range
    }

    fn rounded<T: Real>(&self) -> (T, T) {
        (T::lit(self.work_of_adhesion), T::lit(self.range))
    }
}

impl<T: Real> AdhesionLaw<T> for Exponential {
    fn energy(&self, gap: T) -> T {
        let (w, range) = self.rounded::<T>();
        -w * (-gap / range).exp()
    }
    fn traction(&self, gap: T) -> T {
        let (w, range) = self.rounded::<T>();
        w / range * (-gap / range).exp()
    }
    fn slope(&self, gap: T) -> T {
        let (w, range) = self.rounded::<T>();
        -w / range / range * (-gap / range).exp()
    }
    fn hints(&self) -> Hints<T> {
        let (w, range) = self.rounded();
        Hints { zero: w == T::zero(), ..Hints::new(w, range).with_name("exponential").concave() }
    }
    fn evaluate(&self, _: usize, gaps: &[T], Values { energies, tractions, slopes }: Values<'_, T>) {
        let (w, range) = self.rounded::<T>();
        let rate = -range.recip();
        if let Some(tractions) = tractions {
            exponentials(w / range, rate, gaps, tractions);
            let scale = |values: Option<&mut [T]>, by: T| {
                values
                    .into_iter()
                    .for_each(|values| values.iter_mut().zip(&*tractions).for_each(|(v, t)| *v = *t * by));
            };
            scale(energies, -range);
            scale(slopes, rate);
            return;
        }
        energies.into_iter().for_each(|energies| exponentials(-w, rate, gaps, energies));
        slopes.into_iter().for_each(|slopes| exponentials(-w / range / range, rate, gaps, slopes));
    }
}
