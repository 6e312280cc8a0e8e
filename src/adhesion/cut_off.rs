//! A law that ends at a distance, smoothly.

use super::AdhesionLaw;
use crate::error::{Error, Result};
use crate::real::Real;

/// A law that ends at the gap g_c: zero from there on, with energy, traction and slope continuous.
///
/// ```math
/// φ_c(g) = φ(g) − φ(g_c) − φ'(g_c) (g − g_c) − ½ φ''(g_c) (g − g_c)²   for g < g_c
/// ```
///
/// The parabola takes a little off the work of adhesion: [`AdhesionLaw::work_of_adhesion`] says what is left.
///
/// ```
/// use asperity::{AdhesionLaw, CutOff, PowerLaw, check_law};
/// let law = CutOff::new(PowerLaw::van_der_waals(6e-20, 0.165e-9)?, 5e-9)?;
/// assert_eq!((law.traction(5e-9), law.energy(8e-9)), (0.0, 0.0));
/// check_law::<f64>(&law, 6e-9)?;
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutOff<L> {
    law: L,
    distance: f64,
}

impl<L> CutOff<L> {
    /// The law cut off at the gap g_c.
    ///
    /// # Errors
    /// [`Error::Value`] if g_c is not positive and finite.
    pub fn new(law: L, distance: f64) -> Result<Self> {
        Ok(Self { law, distance: Error::positive("cut-off distance", distance)? })
    }

    /// The gap g_c at which the law ends.
    pub fn distance(&self) -> f64 {
        self.distance
    }

    /// Energy, traction or slope less what the parabola takes off, if the gap is within reach.
    fn less<T: Real>(&self, gap: T, value: T, parabola: impl Fn(T) -> T) -> T {
        let distance = T::lit(self.distance);
        if gap < distance { value - parabola(gap - distance) } else { T::zero() }
    }
}

impl<L> CutOff<L> {
    /// φ, φ' and φ'' at the end.
    fn end<T: Real>(&self) -> [T; 3]
    where
        L: AdhesionLaw<T>,
    {
        let end = T::lit(self.distance);
        [self.law.energy(end), self.law.traction(end), self.law.slope(end)]
    }

    /// The energies, of those of the law itself.
    fn cut_energies<T: Real>(&self, gaps: &[T], energies: &mut [T])
    where
        L: AdhesionLaw<T>,
    {
        let [energy, traction, slope] = self.end();
        for (value, &gap) in energies.iter_mut().zip(gaps) {
            *value = self.less(gap, *value, |x| energy + x * (traction + T::lit(0.5) * slope * x));
        }
    }

    /// The tractions, of those of the law itself.
    fn cut_tractions<T: Real>(&self, gaps: &[T], tractions: &mut [T])
    where
        L: AdhesionLaw<T>,
    {
        let [_, traction, slope] = self.end();
        for (value, &gap) in tractions.iter_mut().zip(gaps) {
            *value = self.less(gap, *value, |x| traction + slope * x);
        }
    }
}

impl<T: Real, L: AdhesionLaw<T>> AdhesionLaw<T> for CutOff<L> {
    fn energy(&self, gap: T) -> T {
        let [energy, traction, slope] = self.end();
        self.less(gap, self.law.energy(gap), |x| energy + x * (traction + T::lit(0.5) * slope * x))
    }
    fn traction(&self, gap: T) -> T {
        let [_, traction, slope] = self.end();
        self.less(gap, self.law.traction(gap), |x| traction + slope * x)
    }
    fn slope(&self, gap: T) -> T {
        let [.., slope] = self.end();
        self.less(gap, self.law.slope(gap), |_| slope)
    }
    fn energies(&self, first: usize, gaps: &[T], energies: &mut [T]) {
        self.law.energies(first, gaps, energies);
        self.cut_energies(gaps, energies);
    }
    fn tractions(&self, first: usize, gaps: &[T], tractions: &mut [T]) {
        self.law.tractions(first, gaps, tractions);
        self.cut_tractions(gaps, tractions);
    }
    fn energies_and_tractions(&self, first: usize, gaps: &[T], energies: &mut [T], tractions: &mut [T]) {
        self.law.energies_and_tractions(first, gaps, energies, tractions);
        self.cut_energies(gaps, energies);
        self.cut_tractions(gaps, tractions);
    }
    fn slopes(&self, first: usize, gaps: &[T], slopes: &mut [T]) {
        let [.., slope] = self.end();
        self.law.slopes(first, gaps, slopes);
        slopes.iter_mut().zip(gaps).for_each(|(value, &gap)| *value = self.less(gap, *value, |_| slope));
    }
    fn work_of_adhesion(&self) -> T {
        -self.energy(self.law.rest().unwrap_or_else(T::zero))
    }
    fn range(&self) -> T {
        self.law.range()
    }
    fn rest(&self) -> Option<T> {
        self.law.rest()
    }
    fn is_zero(&self) -> bool {
        self.law.is_zero()
    }
}
