//! The probability density of the pressure over the nodes.

use ndarray::ArrayView2;

use super::contact_map;
use crate::degrees::LITTLE;
use crate::error::{Error, Result};
use crate::field::all_finite;
use crate::real::Real;
use crate::solver::Solution;

/// The distribution of the pressure over the surface: a histogram, as a probability density.
///
/// It is found of the fields of the whole surface ([`Grid::whole`](crate::Grid::whole) puts shared ones together).
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

/// The most bins; more are a mistake.
const MOST_BINS: usize = 1 << 24;

impl PressureDistribution {
    /// The distribution of the contact pressure over the nodes in contact, in bins from zero to the largest, or to 1
    /// without any; its integral is the contact fraction. Where some pressures, as on spikes, are above the [`bulk_range`],
    /// the last of several bins is wider and has these pressures.
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
    /// As [`PressureDistribution::of_contact_pressure`].
    pub fn of_fields<T: Real>(
        gap: ArrayView2<'_, T>,
        contact_pressure: ArrayView2<'_, T>,
        bins: usize,
    ) -> Result<Self> {
        checked("contact pressure", contact_pressure, bins)?;
        Error::shape("contact pressure", contact_pressure.dim(), gap.dim())?;
        let contact = contact_map(gap, contact_pressure);
        let counted = || contact.iter().zip(contact_pressure).filter(|(touches, _)| **touches).map(|(_, p)| p.widen());
        let (_, high) = bulk_range(counted()).filter(|(_, high)| *high > 0.0).unwrap_or((0.0, 1.0));
        Ok(Self::count(counted(), (0.0, high), bins, facing(gap)))
    }

    /// The distribution of the full elastic pressure over all nodes, in bins from the least, which adhesion makes
    /// negative, to the largest; its integral is one. For a uniform pressure p the bins go from p/2 to 3p/2, and for
    /// none at all from −1/2 to 1/2.
    ///
    /// # Errors
    /// As [`PressureDistribution::of_contact_pressure`].
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

    /// Counts the values in bins over a range. The last bin is wider where there are values above.
    fn count(values: impl Iterator<Item = f64> + Clone, (low, high): (f64, f64), bins: usize, nodes: usize) -> Self {
        let greatest = values.clone().fold(high, f64::max);
        let (high, inner) = match greatest > high {
            true if bins > 1 => (high, bins - 1),
            _ => (greatest, bins),
        };
        let mut counts = vec![0_usize; bins];
        for value in values {
            let bin = (value - low) / (high - low) * inner as f64;
            counts[if value > high { bins - 1 } else { (bin as usize).min(inner - 1) }] += 1;
        }
        let edge = |k: usize| low + (high - low) * (k as f64 / inner as f64);
        let mut edges: Vec<f64> = (0..=inner).map(edge).collect();
        edges.resize(bins + 1, greatest);
        let density = counts
            .iter()
            .zip(edges.windows(2))
            .map(|(&count, edges)| if count == 0 { 0.0 } else { count as f64 / nodes as f64 / (edges[1] - edges[0]) });
        Self { density: density.collect(), edges }
    }
}

/// The most values that enter the quantiles: a million tell enough of the distribution.
const MOST: usize = 1_000_000;

/// The range of values without spikes and scars: from the least to the greatest value that is no farther from the inner
/// 98 % than the inner 98 % are wide.
///
/// All values count where the inner values are equal, and below 100 values; values that are not finite are left out.
/// None without values.
///
/// ```
/// use asperity::contact::bulk_range;
/// let mut heights: Vec<f64> = (0..1000).map(|k| f64::from(k).sin()).collect();
/// let range = bulk_range(heights.iter().copied());
/// heights.push(40.0);
/// assert_eq!(bulk_range(heights.iter().copied()), range);
/// ```
pub fn bulk_range(values: impl Iterator<Item = f64> + Clone) -> Option<(f64, f64)> {
    let values = values.filter(|value| value.is_finite());
    // the odd step avoids always the same columns
    let step = (values.clone().count() / MOST) | 1;
    let mut some: Vec<_> = values.clone().step_by(step).collect();
    let last = some.len().checked_sub(1)?;
    // spikes and scars at either end
    let out = (LITTLE * some.len() as f64) as usize;
    let mut quantile = |place| *some.select_nth_unstable_by(place, f64::total_cmp).1;
    let (low, high) = (quantile(out), quantile(last - out));
    let most = if out > 0 && high > low { high - low } else { f64::INFINITY };
    let near = values.filter(|value| low - value <= most && value - high <= most);
    Some(near.fold((low, high), |(low, high), value| (low.min(value), high.max(value))))
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
