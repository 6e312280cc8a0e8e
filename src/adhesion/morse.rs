use super::exponentials::exponentials;
use super::{AdhesionLaw, Hints, Values};
use crate::error::{Error, Result};
use crate::real::Real;

/// The law of Morse, *Phys. Rev.* 34 (1929), with the gap measured from the equilibrium separation.
///
/// ```math
/// φ(g) = w (e² − 2e) ,   φ'(g) = 2w/ρ (e − e²) ,   φ''(g) = 2w/ρ² (2e² − e) ,   e = exp(−g/ρ)
/// ```
///
/// The surfaces attract each other at g > 0, by w/2ρ at most, at g = ρ ln 2, and repel each other at g < 0. A wall at
/// g = 0 leaves the attraction; with [`NoWall`](crate::NoWall) contact is where the law repels.
///
/// ```
/// use asperity::{AdhesionLaw, Morse};
/// let law = Morse::new(0.05, 0.5e-9)?;
/// assert_eq!((law.energy(0.0), law.traction(0.0)), (-0.05, 0.0));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Morse {
    work_of_adhesion: f64,
    range: f64,
}

impl Morse {
    /// The law with work of adhesion w (energy per area) and range ρ (length), in either precision.
    ///
    /// # Errors
    /// [`Error::Value`] if w or ρ is not positive and finite.
    pub fn new(work_of_adhesion: f64, range: f64) -> Result<Self> {
        Error::positive("work of adhesion", work_of_adhesion)?;
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

/// The energy in units of w, the traction of w/ρ, and its slope of w/ρ², of e.
fn energy<T: Real>(e: T) -> T {
    e * (e - T::lit(2.0))
}
fn traction<T: Real>(e: T) -> T {
    T::lit(2.0) * e * (T::one() - e)
}
fn slope<T: Real>(e: T) -> T {
    T::lit(2.0) * e * (T::lit(2.0) * e - T::one())
}

impl<T: Real> AdhesionLaw<T> for Morse {
    fn energy(&self, gap: T) -> T {
        let (w, range) = self.rounded::<T>();
        w * energy((-gap / range).exp())
    }
    fn traction(&self, gap: T) -> T {
        let (w, range) = self.rounded::<T>();
        w / range * traction((-gap / range).exp())
    }
    fn slope(&self, gap: T) -> T {
        let (w, range) = self.rounded::<T>();
        w / range / range * slope((-gap / range).exp())
    }
    fn hints(&self) -> Hints<T> {
        let (w, range) = self.rounded();
        Hints::new(w, range).with_name("morse").with_rest(T::zero())
    }
    fn evaluate(&self, _: usize, gaps: &[T], mut values: Values<'_, T>) {
        let (w, range) = self.rounded::<T>();
        let of = |order, e| match order {
            0 => w * energy(e),
            1 => w / range * traction(e),
            _ => w / range / range * slope(e),
        };
        let powers = |values: &mut [T]| exponentials(T::one(), -range.recip(), gaps, values);
        let Some(tractions) = values.tractions.take() else {
            return values.each(|order, values| {
                powers(values);
                values.iter_mut().for_each(|value| *value = of(order, *value));
            });
        };
        powers(tractions);
        values.each(|order, values| values.iter_mut().zip(&*tractions).for_each(|(value, &e)| *value = of(order, e)));
        tractions.iter_mut().for_each(|value| *value = of(1, *value));
    }
}
