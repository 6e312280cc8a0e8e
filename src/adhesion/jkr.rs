use std::sync::Arc;

use super::{AdhesionLaw, Hints, Values};
use crate::error::{Error, Result};
use crate::real::Real;

/// The square of the range on a grid, in units of the work of adhesion times the compliance of a node.
const SQUARE: f64 = 13.0;

/// The law of Johnson, Kendall and Roberts (1971), without a range: as short on each grid as the nodes can follow.
///
/// ```math
/// φ(g) = −w (1 − x)⁴ (1 + 2x + 2x²) ,   φ'(g) = 2w/ρ (1 − x)³ (1 + 3x + 6x²) ,   x = g/ρ < 1 ,   0 beyond
/// ρ = √(13 w Δx/E*)
/// ```
///
/// The work of adhesion w is all that the limit of large Tabor numbers has. A [`Problem`](crate::Problem) gives the law
/// its range ρ, [`AdhesionLaw::on_nodes`], by the larger spacing Δx and the contact modulus E* of the shortest waves: the
/// traction falls no more steeply than 0.29 E*/Δx. So the process zone at the edge of a contact is some three nodes wide,
/// edges move with the load, and results converge with the first order of Δx to the limit. Each of [nested
/// grids](crate::Nested), and each node of a law that [varies](crate::adhesion::Varying), has a range of its own. Until
/// a grid sets the range, the law attracts in contact alone, with no bound.
///
/// The page [`choosing`](crate::guide::choosing) says how right it is. Take a law with a range where its range is
/// longer than the range on the grid.
///
/// ```
/// use asperity::{AdhesionLaw, Grid, Jkr, Problem, Surface, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let surface = Surface::paraboloid(grid, 2.0)?;
/// let problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, Jkr::new(1e-4)?)?;
/// let range = (13.0 * 1e-4 / 64.0_f64).sqrt();
/// assert!((problem.law_on_grid().hints().range / range - 1.0).abs() < 1e-12);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jkr {
    work_of_adhesion: f64,
    /// the range ρ on a grid; zero before
    range: f64,
    /// whether it attracts next to contacts alone
    touching: bool,
}

impl Jkr {
    /// The law with work of adhesion w (energy per area), in either precision.
    ///
    /// # Errors
    /// [`Error::Value`] if w is negative or not finite.
    pub fn new(work_of_adhesion: f64) -> Result<Self> {
        Error::non_negative("work of adhesion", work_of_adhesion)?;
        Ok(Self { work_of_adhesion, range: 0.0, touching: true })
    }

    /// A substitute for a law with a range, which attracts wherever the gap is below the range of the grid.
    pub(crate) fn with_range_of_grid(work_of_adhesion: f64) -> Result<Self> {
        Ok(Self { touching: false, ..Self::new(work_of_adhesion)? })
    }

    /// The work of adhesion w.
    pub fn work_of_adhesion(&self) -> f64 {
        self.work_of_adhesion
    }

    /// Energy, traction and slope at a gap.
    #[inline(always)]
    fn at<T: Real>(&self) -> impl Fn(T) -> [T; 3] + Copy + use<T> {
        let [w, range] = [self.work_of_adhesion, self.range].map(T::lit);
        let n = T::lit;
        move |gap| {
            let x = (gap / range).min(T::one());
            let left = T::one() - x;
            let (square, both) = (left * left, x * left);
            [
                -w * (square * square * (T::one() + n(2.0) * x * (T::one() + x))),
                n(2.0) * w / range * (square * left * (T::one() + n(3.0) * x * (T::one() + n(2.0) * x))),
                n(-60.0) * w / range / range * (both * both),
            ]
        }
    }

    /// The same without a range: all of the attraction in contact.
    fn in_contact<T: Real>(&self, gap: T) -> [T; 3] {
        let touches = gap <= T::zero() && self.work_of_adhesion > 0.0;
        if touches { [-T::lit(self.work_of_adhesion), T::infinity(), T::neg_infinity()] } else { [T::zero(); 3] }
    }

    fn values<T: Real>(&self, gap: T) -> [T; 3] {
        if self.range > 0.0 { self.at()(gap) } else { self.in_contact(gap) }
    }
}

impl<T: Real> AdhesionLaw<T> for Jkr {
    fn energy(&self, gap: T) -> T {
        self.values(gap)[0]
    }
    fn traction(&self, gap: T) -> T {
        self.values(gap)[1]
    }
    fn slope(&self, gap: T) -> T {
        self.values(gap)[2]
    }
    fn hints(&self) -> Hints<T> {
        let [w, range] = [self.work_of_adhesion, self.range].map(T::lit);
        Hints {
            zero: w == T::zero(),
            of_grid: true,
            touching: self.touching,
            ..Hints::new(w, range).with_name("jkr").concave()
        }
    }
    fn evaluate(&self, _: usize, gaps: &[T], values: Values<'_, T>) {
        if self.range > 0.0 {
            values.set(gaps, self.at());
        } else {
            values.set(gaps, |gap| self.in_contact(gap));
        }
    }
    fn on_nodes(&self, compliance: T) -> Option<Arc<dyn AdhesionLaw<T>>> {
        Some(Arc::new(Self { range: (SQUARE * self.work_of_adhesion * compliance.widen()).sqrt(), ..*self }))
    }
}
