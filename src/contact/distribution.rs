//! The probability density of the pressure over the nodes.

use ndarray::ArrayView2;

use super::contact_map;
use crate::error::{Error, Result};
use crate::field::all_finite;
use crate::real::Real;
use crate::solver::Solution;

/// The distribution of the pressure over the surface: a histogram, as a probability density, of fields of the whole
/// surface ([`Grid::whole`](crate::Grid::whole) puts shared ones together).
///
/// The bins are equally wide; a bin has its lower edge, the last one its upper edge too. The density of a bin is its
/// share of the nodes, without absent ones, divided by its width, so Σ density · pressure · width is about the mean
/// pressure.
///
/// ```
/// use asperity::contact::PressureDistribution;
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let solution = Solver::default().solve(&mut problem, Control::MeanGap(0.0398))?;
/// let distribution = PressureDistribution::of_contact_pressure(&solution, 20)?;
/// assert!((distribution.integral() - solution.report.contact_fraction).abs() < 1e-15);
/// assert_eq!((distribution.edges.len(), distribution.edges[0]), (21, 0.0));
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PressureDistribution {
    /// The edges of the bins, from the lowest to the highest: one more than there are bins.
    pub edges: Vec<f64>,
    /// The density in each bin, per unit of pressure.
    pub density: Vec<f64>,
}

/// The most bins; more are a slip of the pen.
const MOST_BINS: usize = 1 << 24;

impl PressureDistribution {
    /// The distribution of the contact pressure over the nodes in contact, in bins from zero to the largest, or to 1
    /// without any; its integral is the contact fraction.
    ///
    /// # Errors
    /// [`Error::Value`] for no bins, or more than 2²⁴; [`Error::NotFinite`] if a pressure is not finite;
    /// [`Error::Shape`] if gap and contact pressure differ in shape.
    pub fn of_contact_pressure<T: Real>(solution: &Solution<T>, bins: usize) -> Result<Self> {
        Self::of_fields(solution.gap.view(), solution.contact_pressure.view(), bins)
    }

    /// The distribution of the contact pressure of fields from elsewhere; the gap of absent nodes is infinite or NaN.
    ///
    /// # Errors
    /// Those of [`PressureDistribution::of_contact_pressure`].
    pub fn of_fields<T: Real>(
        gap: ArrayView2<'_, T>,
        contact_pressure: ArrayView2<'_, T>,
        bins: usize,
    ) -> Result<Self> {
        checked("contact pressure", contact_pressure, bins)?;
        Error::shape("contact pressure", contact_pressure.dim(), gap.dim())?;
        let contact = contact_map(gap, contact_pressure);
        let counted = || contact.iter().zip(contact_pressure).filter(|(touches, _)| **touches).map(|(_, p)| p.widen());
        let high = counted().fold(0.0, f64::max);
        Ok(Self::count(counted(), (0.0, if high > 0.0 { high } else { 1.0 }), bins, facing(gap)))
    }

    /// The distribution of the full elastic pressure over all nodes, in bins from the least, which adhesion makes
    /// negative, to the largest; its integral is one. For a uniform pressure p the bins go from p/2 to 3p/2, and for
    /// none at all from −1/2 to 1/2.
    ///
    /// # Errors
    /// Those of [`PressureDistribution::of_contact_pressure`].
    pub fn of_pressure<T: Real>(solution: &Solution<T>, bins: usize) -> Result<Self> {
        let pressure = solution.pressure.view();
        checked("pressure", pressure, bins)?;
        Error::shape("pressure", pressure.dim(), solution.gap.dim())?;
        let counted = || pressure.iter().zip(&solution.gap).filter(|(_, gap)| gap.is_finite()).map(|(p, _)| p.widen());
        let (mut low, mut high) =
            counted().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        if low >= high {
            let half = if low == 0.0 { 0.5 } else { 0.5 * low.abs() };
            (low, high) = (low - half, high + half);
        }
        Ok(Self::count(counted(), (low, high), bins, facing(solution.gap.view())))
    }

    /// Σ density · width: the share of the nodes that are counted.
    pub fn integral(&self) -> f64 {
        self.edges.windows(2).zip(&self.density).map(|(edges, density)| density * (edges[1] - edges[0])).sum()
    }

    fn count(values: impl Iterator<Item = f64>, (low, high): (f64, f64), bins: usize, nodes: usize) -> Self {
        let mut counts = vec![0_usize; bins];
        for value in values {
            // a value may be below the lowest edge, or above the highest, by rounding
            let bin = (value - low) / (high - low) * bins as f64;
            counts[(bin.max(0.0) as usize).min(bins - 1)] += 1;
        }
        let edge = |k: usize| low + (high - low) * (k as f64 / bins as f64);
        let edges: Vec<f64> = (0..=bins).map(edge).collect();
        let density = counts
            .iter()
            .zip(edges.windows(2))
            .map(|(&count, edges)| if count == 0 { 0.0 } else { count as f64 / nodes as f64 / (edges[1] - edges[0]) });
        Self { density: density.collect(), edges }
    }
}

fn facing<T: Real>(gap: ArrayView2<'_, T>) -> usize {
    gap.iter().filter(|gap| gap.is_finite()).count()
}

fn checked<T: Real>(name: &'static str, pressure: ArrayView2<'_, T>, bins: usize) -> Result<()> {
    if !(1..=MOST_BINS).contains(&bins) {
        return Err(Error::Value { name: "number of bins", value: bins as f64, requirement: "from 1 to 16777216" });
    }
    all_finite(name, pressure)
}
