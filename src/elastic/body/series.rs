use super::Body;

/// Two bodies that both deform where they touch: their compliances add, 1/k = 1/k₁ + 1/k₂.
///
/// The surface between them has the sum of their heights, the second ones as they face the first:
/// [`Surface::against`](crate::Surface::against). Under the pressure p
/// the wave q moves by p/k₁ and p/k₂. Two half-spaces are one with 1/E* = 1/E₁* + 1/E₂*; Johnson, *Contact Mechanics*
/// (1985), section 4.1.
///
/// ```
/// use asperity::elastic::{Body, HalfSpace, Series};
/// let both = Series(HalfSpace::new(3.0)?, HalfSpace::new(6.0)?);
/// assert!((both.modulus() - 2.0).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Series<A, B>(pub A, pub B);

impl<A: Body, B: Body> Body for Series<A, B> {
    fn stiffness(&self, qx: f64, qy: f64) -> f64 {
        both(self.0.stiffness(qx, qy), self.1.stiffness(qx, qy))
    }

    fn modulus(&self) -> f64 {
        both(self.0.modulus(), self.1.modulus())
    }

    fn mean_compliance(&self) -> f64 {
        self.0.mean_compliance() + self.1.mean_compliance()
    }
}

/// The stiffness of two springs, one behind the other.
fn both(a: f64, b: f64) -> f64 {
    let (softer, harder) = if a < b { (a, b) } else { (b, a) };
    softer / (1.0 + softer / harder)
}
