use std::slice::from_mut;
use std::sync::Arc;

use super::{AdhesionLaw, Discretisation, Hints, Values};
use crate::degrees::LITTLE;
use crate::error::{Error, Result};
use crate::real::Real;

/// A law that ends at the gap g_c: zero from there on, with energy, traction and slope continuous.
///
/// ```math
/// φ_c(g) = φ(g) − q(s) ,   s = (g − g₀)/(g_c − g₀)   for g₀ < g < g_c ,   φ_c = 0 beyond
/// q(s) = s³ (a + b s + c s²) ,   q = φ , q' = φ' , q'' = φ''  at g_c
/// ```
///
/// The quintic q and its first two derivatives vanish at g₀, the equilibrium separation of a law that repels, and
/// contact for all others. So the work of adhesion w, the equilibrium separation, the traction and its slope in contact
/// and all of the repulsion stay; the energy of the tail is given back before g_c. A law that ends before g_c is not
/// changed. Cut off and [`Varying`](super::Varying) may be applied in either order.
///
/// The largest traction over the largest traction of the law, by the distance from g₀ to g_c over the range ρ:
///
/// | | 1 | 1.5 | 2 | 2.5 | 3 | 4 |
/// |---|---|---|---|---|---|---|
/// | exponential, power laws | 1.5 | 1 | 1 | 1 | 1 | 1 |
/// | Lennard-Jones | 1.57 | 1.10 | 1.03 | 1.01 | 1.01 | 1.00 |
/// | Morse | 3.63 | 2.35 | 1.71 | 1.35 | 1.16 | 1.04 |
///
/// ```
/// use asperity::adhesion::{CutOff, check_law};
/// use asperity::{AdhesionLaw, PowerLaw};
/// let whole = PowerLaw::van_der_waals(6e-20, 0.165e-9)?;
/// let law = CutOff::new(whole, 5e-9)?;
/// assert_eq!((law.traction(5e-9), law.energy(8e-9)), (0.0, 0.0));
/// check_law::<f64>(&law, 6e-9)?;
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutOff<L> {
    law: L,
    /// the gap g₀, below which nothing is changed
    start: f64,
    distance: f64,
    /// energy, traction and slope at g_c, of the strongest node
    end: [f64; 3],
    varies: bool,
}

impl<L> CutOff<L> {
    /// The law cut off at the gap g_c.
    ///
    /// # Errors
    /// [`Error::Value`] if g_c is not finite, or less than a range ρ beyond contact or the equilibrium separation; or
    /// if the energy in contact is not −w, because the law does not fall to zero.
    pub fn new(law: L, distance: f64) -> Result<Self>
    where
        L: AdhesionLaw<f64>,
    {
        Error::positive("cut-off distance", distance)?;
        let hints = law.hints();
        let start = hints.rest.unwrap_or(0.0);
        // numbers that were rounded on their way here
        if distance < (start + hints.range) * (1.0 - 4.0 * f64::EPSILON) {
            let requirement =
                "at least a range of the law beyond contact, or beyond its equilibrium separation: give a larger one";
            return Err(Error::Value { name: "cut-off distance", value: distance, requirement });
        }
        let (energy, work) = (law.energy(start), hints.work_of_adhesion);
        let falls = (energy + work).abs() <= LITTLE * work.abs();
        if !falls {
            return Err(Error::Value {
                name: "adhesive energy in contact, or at rest, of the law to be cut off",
                value: energy,
                requirement: "minus its work of adhesion: the law must fall to zero at large gaps",
            });
        }
        Ok(Self::between(law, start, distance))
    }

    /// The law that is cut off.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// The gap g_c at which the law ends.
    pub fn distance(&self) -> f64 {
        self.distance
    }

    fn between<T: Real>(law: L, start: f64, distance: f64) -> Self
    where
        L: AdhesionLaw<T>,
    {
        let gap = T::lit(distance);
        let end = [law.energy(gap), law.traction(gap), law.slope(gap)].map(T::widen);
        let varies = law.hints().shape.is_some();
        Self { law, start, distance, end, varies }
    }

    fn with<M>(&self, law: M) -> CutOff<M> {
        let Self { start, distance, end, varies, .. } = *self;
        CutOff { law, start, distance, end, varies }
    }

    /// Whether the law ends by itself before it is cut off.
    fn has_ended(&self) -> bool {
        self.end == [0.0; 3]
    }

    /// The coefficients a, b and c of a quintic that ends so.
    fn quintic<T: Real>(&self, [energy, traction, slope]: [T; 3]) -> [T; 3] {
        let (n, width) = (T::lit, T::lit(self.distance - self.start));
        let (traction, slope) = (width * traction, n(0.5) * width * (width * slope));
        [
            n(10.0) * energy - n(4.0) * traction + slope,
            n(7.0) * traction - n(15.0) * energy - n(2.0) * slope,
            n(6.0) * energy - n(3.0) * traction + slope,
        ]
    }

    /// The difference of a law and a quintic at a gap.
    fn less_quintic<T: Real>(
        &self,
        gap: T,
        value: T,
        of: impl Fn(T, T, [T; 3]) -> T,
        quintic: impl FnOnce() -> [T; 3],
    ) -> T {
        let [start, distance] = [self.start, self.distance].map(T::lit);
        if gap >= distance {
            T::zero()
        } else if gap <= start {
            value
        } else {
            let rate = (distance - start).recip();
            value - of((gap - start) * rate, rate, quintic())
        }
    }

    fn one<T: Real>(&self, gap: T, value: T, of: impl Fn(T, T, [T; 3]) -> T) -> T {
        self.less_quintic(gap, value, of, || self.quintic(self.end.map(T::lit)))
    }

    fn all<T: Real>(&self, first: usize, gaps: &[T], values: &mut [T], of: impl Fn(T, T, [T; 3]) -> T)
    where
        L: AdhesionLaw<T>,
    {
        let strongest = self.quintic(self.end.map(T::lit));
        for (node, (value, &gap)) in (first..).zip(values.iter_mut().zip(gaps)) {
            let quintic = || if self.varies { self.quintic(self.end_at(node)) } else { strongest };
            *value = self.less_quintic(gap, *value, &of, quintic);
        }
    }

    fn end_at<T: Real>(&self, node: usize) -> [T; 3]
    where
        L: AdhesionLaw<T>,
    {
        let (gap, mut end) = ([T::lit(self.distance)], [T::zero(); 3]);
        let [energy, traction, slope] = &mut end;
        let [energies, tractions, slopes] = [energy, traction, slope].map(|value| Some(from_mut(value)));
        self.law.evaluate(node, &gap, Values { energies, tractions, slopes });
        end
    }
}

/// The quintic at s, and its derivatives by the gap, of 1/(g_c − g₀).
fn energy<T: Real>(s: T, _: T, [a, b, c]: [T; 3]) -> T {
    s * s * s * (a + s * (b + s * c))
}
fn traction<T: Real>(s: T, rate: T, [a, b, c]: [T; 3]) -> T {
    rate * s * s * (T::lit(3.0) * a + s * (T::lit(4.0) * b + T::lit(5.0) * s * c))
}
fn slope<T: Real>(s: T, rate: T, [a, b, c]: [T; 3]) -> T {
    rate * rate * s * (T::lit(6.0) * a + s * (T::lit(12.0) * b + T::lit(20.0) * s * c))
}

impl<T: Real, L: AdhesionLaw<T>> AdhesionLaw<T> for CutOff<L> {
    fn energy(&self, gap: T) -> T {
        self.one(gap, self.law.energy(gap), energy)
    }
    fn traction(&self, gap: T) -> T {
        self.one(gap, self.law.traction(gap), traction)
    }
    fn slope(&self, gap: T) -> T {
        self.one(gap, self.law.slope(gap), slope)
    }
    fn hints(&self) -> Hints<T> {
        let hints = self.law.hints();
        // the quintic may bend the energy the other way
        Hints { concave: hints.concave && self.has_ended() && !self.varies, ..hints }
    }
    fn evaluate(&self, first: usize, gaps: &[T], mut values: Values<'_, T>) {
        self.law.evaluate(first, gaps, values.reborrow());
        values.each(|order, values| match order {
            0 => self.all(first, gaps, values, energy),
            1 => self.all(first, gaps, values, traction),
            _ => self.all(first, gaps, values, slope),
        });
    }
    fn contact_shares(&self, first: usize, gaps: &[T], shares: &mut [T]) {
        self.law.contact_shares(first, gaps, shares);
    }
    fn on_nodes(&self, compliance: T) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let law = self.law.on_nodes(compliance)?;
        Some(Arc::new(CutOff::between(law, self.start, self.distance)))
    }
    fn adapted(&self, to: Discretisation<T>) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let law = self.law.adapted(to)?;
        Some(match to {
            Discretisation::Smooth(_) if self.has_ended() => law,
            Discretisation::Smooth(_) => Arc::new(CutOff::between(law, self.start, self.distance)),
            _ => Arc::new(self.with(law)),
        })
    }
}
