use super::{AdhesionLaw, Hints};
use crate::error::{Error, Result};
use crate::real::Real;

/// The law of Lennard-Jones between two half-spaces, of powers 9 and 3.
///
/// ```math
/// φ(g) = w (x⁸/3 − 4x²/3) ,   φ'(g) = 8w/(3z₀) (x³ − x⁹) ,   φ''(g) = 8w/z₀² (3x¹⁰ − x⁴) ,   x = z₀/g
/// ```
///
/// The surfaces attract each other beyond z₀, by 1.03 w/z₀ at most, and repel each other below, without bound. The law
/// is solved with [`NoWall`](crate::NoWall), contact being where it repels; [`LennardJones::cut`] leaves the repulsion
/// to a wall at z₀, from which the gap then counts.
///
/// Yu and Polycarpou, *J. Tribol.* 126 (2004); Greenwood, *Proc. R. Soc. A* 453 (1997), for the sphere.
///
/// ```
/// use asperity::{AdhesionLaw, LennardJones};
/// let law = LennardJones::new(0.05, 0.3e-9)?;
/// assert!(law.traction(0.29e-9) < 0.0 && law.traction(0.31e-9) > 0.0);
/// assert!((law.cut().energy(0.0_f64) + 0.05).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LennardJones {
    work_of_adhesion: f64,
    range: f64,
    /// whether the gap counts from the equilibrium separation, z₀
    cut: bool,
}

impl LennardJones {
    /// The law with work of adhesion w (energy per area) and equilibrium separation z₀ (length), in either precision.
    ///
    /// # Errors
    /// [`Error::Value`] if w or z₀ is not positive and finite.
    pub fn new(work_of_adhesion: f64, range: f64) -> Result<Self> {
        Error::positive("work of adhesion", work_of_adhesion)?;
        Error::positive("range of adhesion", range)?;
        Ok(Self { work_of_adhesion, range, cut: false })
    }

    /// The attraction alone, for a wall at z₀, as a function of the gap beyond that distance.
    #[must_use]
    pub fn cut(self) -> Self {
        Self { cut: true, ..self }
    }

    /// The work of adhesion w.
    pub fn work_of_adhesion(&self) -> f64 {
        self.work_of_adhesion
    }

    /// The equilibrium separation z₀.
    pub fn range(&self) -> f64 {
        self.range
    }

    /// w and z₀, rounded to the precision of the fields, and x = z₀/g.
    #[inline(always)]
    fn at<T: Real>(&self, gap: T) -> (T, T, T) {
        let (w, range) = (T::lit(self.work_of_adhesion), T::lit(self.range));
        (w, range, range / if self.cut { range + gap } else { gap })
    }
}

impl<T: Real> AdhesionLaw<T> for LennardJones {
    fn energy(&self, gap: T) -> T {
        let (w, _, x) = self.at(gap);
        let square = x * x;
        w / T::lit(3.0) * square * (square * square * square - T::lit(4.0))
    }
    fn traction(&self, gap: T) -> T {
        let (w, range, x) = self.at(gap);
        let cube = x * x * x;
        T::lit(8.0) * w / (T::lit(3.0) * range) * cube * (T::one() - cube * cube)
    }
    fn slope(&self, gap: T) -> T {
        let (w, range, x) = self.at(gap);
        let fourth = x * x * x * x;
        T::lit(8.0) * w / range / range * fourth * (T::lit(3.0) * fourth * x * x - T::one())
    }
    fn hints(&self) -> Hints<T> {
        let (w, range) = (T::lit(self.work_of_adhesion), T::lit(self.range));
        Hints { rest: (!self.cut).then_some(range), ..Hints::new(w, range).with_name("lennard-jones") }
    }
}
