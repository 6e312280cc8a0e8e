//! The contact of a solution: its area and edge, its clusters, and the distribution of its pressure.
//!
//! [`ContactStatistics`] has areas and the perimeter, [`Clusters`] the pieces that hang together,
//! [`PressureDistribution`] the histogram of the pressure, and [`Original`] the measured part of a mirrored map.

use ndarray::{Array2, ArrayView2, CowArray, Ix2, Zip};

use crate::adhesion::{AdhesionLaw, Neighbourhood, Values, noticeable, on_grid};
use crate::elastic::Boundary;
use crate::error::Result;
use crate::grid::Grid;
use crate::real::{Real, once};
use crate::solver::Solution;

use outline::Outline;

mod area;
mod clusters;
mod distribution;
mod extremes;
mod original;
mod outline;
mod patch;
mod places;

pub use area::ContactArea;
pub use clusters::Clusters;
pub use distribution::{PressureDistribution, bulk_range};
pub use extremes::PressureExtremes;
pub use original::Original;
pub use patch::Patch;

once! {
    /// The statistics of a contact.
    statistics<'a, T>(
        gap: ArrayView2<'a, T>, contact_pressure: ArrayView2<'a, T>, grid: &'a Grid, body: (Boundary, f64),
        law: &'a dyn AdhesionLaw<T>,
    ) -> Result<ContactStatistics> = ContactStatistics::count;
}

/// The region of a node, by what the surfaces do to each other there. As numbers 1, −1, 0 and NaN.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// The surfaces touch, as [`Solution::contact_map`] says.
    Contact,
    /// The surfaces attract each other without contact, as [`ContactStatistics::attractive_fraction`] counts it.
    Attractive,
    /// The surfaces are apart, without a noticeable attraction.
    Apart,
    /// No surface: the node is [absent](crate::Surface::with_absent).
    Absent,
}

impl From<Region> for f64 {
    fn from(region: Region) -> Self {
        match region {
            Region::Contact => 1.0,
            Region::Attractive => -1.0,
            Region::Apart => 0.0,
            Region::Absent => Self::NAN,
        }
    }
}

impl<T: Real> Solution<T> {
    /// The region of each node.
    pub fn regions(&self) -> Array2<Region> {
        let contact = self.contact_map();
        let on_grid = on_grid(&*self.law, &self.grid, self.report.modulus);
        let periodic = self.report.boundary.is_periodic();
        let law = on_grid.as_deref().unwrap_or(&*self.law);
        let attracts = attracting(&contact, self.gap.view(), (&self.grid, periodic), law);
        let mut nodes = self.gap.iter().zip(&contact).zip(attracts);
        Array2::from_shape_simple_fn(self.gap.dim(), || match nodes.next() {
            Some(((_, true), _)) => Region::Contact,
            Some((_, true)) => Region::Attractive,
            Some(((gap, _), _)) if gap.is_finite() => Region::Apart,
            _ => Region::Absent,
        })
    }

    /// The contact map: true at nodes without a gap (g ≤ 0) and at nodes with a contact pressure (λ > 0).
    ///
    /// This is the contact of reports, statistics, clusters, distributions and pictures. Under
    /// [`Projection`](crate::Projection) some nodes in contact may carry no pressure, and under
    /// [`Uzawa`](crate::Uzawa) some are pressed at a gap that is not quite zero.
    pub fn contact_map(&self) -> Array2<bool> {
        contact_map(self.gap.view(), self.contact_pressure.view())
    }
}

type Whole<'a, T> = CowArray<'a, T, Ix2>;

/// Whether each node attracts without contact: whether its adhesive traction is noticeable, and for a law that attracts
/// next to contacts alone, whether the node is next to a contact.
fn attracting<T: Real>(
    contact: &Array2<bool>,
    gap: ArrayView2<'_, T>,
    (grid, periodic): (&Grid, bool),
    law: &dyn AdhesionLaw<T>,
) -> Vec<bool> {
    if law.hints().zero {
        return vec![false; gap.len()];
    }
    let least = T::lit(noticeable(law));
    let gaps: Vec<T> = gap.iter().map(|gap| gap.max(T::zero())).collect();
    let mut tractions = vec![T::zero(); gaps.len()];
    law.evaluate(grid.first_node(), &gaps, Values::one(1, &mut tractions));
    let mut attracts: Vec<_> =
        contact.iter().zip(tractions).map(|(&touches, traction)| !touches && traction > least).collect();
    if law.hints().touches() {
        let mut neighbourhood = Neighbourhood::none(grid, periodic);
        neighbourhood.contact.nodes_mut().iter_mut().zip(contact).for_each(|(own, &touches)| *own = touches);
        neighbourhood.grow();
        attracts.iter_mut().zip(neighbourhood.near().nodes()).for_each(|(attracts, &near)| *attracts &= near);
    }
    attracts
}

fn contact_map<T: Real>(gap: ArrayView2<'_, T>, contact_pressure: ArrayView2<'_, T>) -> Array2<bool> {
    Zip::from(gap).and(contact_pressure).map_collect(|&gap, &pressure| (gap <= T::zero()) | (pressure > T::zero()))
}

/// Gap and contact pressure on the whole of their grid, and that grid.
fn whole<'a, T: Real>(
    gap: ArrayView2<'a, T>,
    contact_pressure: ArrayView2<'a, T>,
    grid: &Grid,
) -> Result<(Whole<'a, T>, Whole<'a, T>, Grid)> {
    grid.fits("gap", gap.dim())?;
    grid.fits("contact pressure", contact_pressure.dim())?;
    Ok((grid.whole(gap), grid.whole(contact_pressure), grid.alone()))
}

/// The contact statistics of a solution: the area and the clusters of contact, and the area that attracts without it.
///
/// Fractions are of the nodes that are not [absent](crate::Surface::with_absent): without absent nodes, of the nominal
/// area Lx·Ly. Contact, attractive and apart fraction add up to one. With a free boundary opposite sides do not meet.
///
/// The corrected contact area is the area within the edge of the contact between the nodes. As a straight edge moves
/// from one row of nodes to the next, the contact pressure λ of the row inside rises from zero, and the gap g of the
/// row outside falls to zero, both in proportion. So the edge is a fixed number β of spacings Δ inside the contour on
/// which
///
/// ```math
/// κλΔ = E* g ,   κ = 2e/π ,   β = 1/4 − (1/4π) ∫_0^π ln(q / 2 sin(q/2)) / sin²(q/2) dq = 0.190 ,
/// ```
///
/// by linear interpolation. Both numbers follow from the discrete half-space, for an edge along the nodes, by the
/// method of Wiener and Hopf: E*/κΔ is the geometric mean of the stiffness E*\|q\|/2 of the waves on the grid, with q
/// in units of 1/Δ. Love's kernel of the [free half-space](crate::Boussinesq) has nearly the same κ, and β = 0.175.
/// With the contour as a polygon, by marching squares on the rectangles between nodes, the corrected area is
///
/// ```math
/// A = A_polygon − Δ ∫ (β − 0.0147 |sin 2θ|³) dL + 0.78 χ Δ² ,
/// ```
///
/// along the polygon, at the angle θ to the axes, with χ the number of contacts less the number of their holes. The
/// correction for askew edges was measured on plane waves in ten directions, the correction for curved edges fitted to
/// Hertz contacts. For Δx ≠ Δy length and area are taken with the spacings as units; on a line each end is β inside the
/// contour. Nodes at the end of a surface, next to absent ones or the end of a window, are counted as a whole, and so
/// is full contact. Where a wall gives, as [`Penalty`](crate::Penalty) does, the gap in contact counts as well, and β
/// falls with the cube of the share of the pressure in κλΔ − E\*g. Where [the law alone repels](crate::NoWall) the edge
/// is the nearer to the middle between the nodes the more contact nodes are apart. Without a positive modulus the area
/// is [`ContactArea::of`].
///
/// The error is of second order: 0.28 % of the area of Hertz contacts with radii of 3 to 7 nodes (7.9 % by counting
/// nodes), 0.025 % with 14 to 28 (1.6 %). The page [`choosing`](crate::guide::choosing) has rough surfaces. With
/// adhesion of a range that the grid does not resolve (μ_ρ above 0.5) it is as good as [`ContactArea::of`].
///
/// ```
/// use asperity::contact::ContactStatistics;
/// use asperity::{Control, Exponential, Grid, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let surface = Surface::wave_2d(grid, 0.01, 2)?; // eight peaks
/// let law = Exponential::new(1e-5, 2e-3)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, law)?;
/// let solution = Solver::default().solve(&mut problem, Control::MeanPressure(0.01))?;
/// let statistics = ContactStatistics::of(&solution)?;
/// assert_eq!(statistics.cluster_sizes.len(), 8);
/// assert!((statistics.corrected_contact_fraction / statistics.contact_fraction - 1.0).abs() < 0.1);
/// let all = statistics.contact_fraction + statistics.attractive_fraction + statistics.apart_fraction;
/// assert!((all - 1.0).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactStatistics {
    /// The number of nodes in contact, by [`Solution::contact_map`].
    pub contact_nodes: usize,
    /// The share of nodes in contact.
    pub contact_fraction: f64,
    /// The contact area within the edge between the nodes, as a share of the nominal area.
    pub corrected_contact_fraction: f64,
    /// The length of the edge of the contact, along the sides of the cells, across periodic boundaries too: Δy for
    /// neighbours along x with one in contact, Δx for neighbours along y. Beyond a free boundary nothing is in contact,
    /// so that its sides count. On a line the number of end points.
    pub perimeter: f64,
    /// The sizes of the [`Clusters`] of contact in nodes, the largest first.
    pub cluster_sizes: Vec<usize>,
    /// The share of nodes with a contact pressure. Nodes may touch without one.
    pub repulsive_fraction: f64,
    /// The share of nodes out of contact with an adhesive traction of more than 1 % of w/ρ: g < ρ for
    /// [`MaugisDugdale`](crate::MaugisDugdale), and g < 4.6 ρ for [`Exponential`](crate::Exponential).
    pub attractive_fraction: f64,
    /// The share of the other nodes.
    pub apart_fraction: f64,
    /// The patches of a law that [varies](crate::adhesion::Varying), the least work of adhesion first; the traction
    /// above belongs to the strongest. Empty for a uniform law, and for more than 16 works of adhesion.
    pub patches: Vec<Patch>,
}

impl ContactStatistics {
    /// The statistics of a solution. Memory per node: ten bytes, and with adhesion two scalars. Where several processes
    /// share the grid, each takes the whole of gap and contact pressure, two scalars more.
    ///
    /// # Errors
    /// [`Error::Shape`](crate::Error::Shape) if a field does not have the shape of the grid.
    pub fn of<T: Real>(solution: &Solution<T>) -> Result<Self> {
        let Solution { gap, contact_pressure, grid, report, law, .. } = solution;
        Self::of_fields(gap.view(), contact_pressure.view(), grid, (report.boundary, report.modulus), &**law)
    }

    /// The statistics of a gap, infinite at absent nodes, and a contact pressure, as from a file, on their grid, with
    /// the boundary and the contact modulus E* of the body.
    ///
    /// # Errors
    /// [`Error::Shape`](crate::Error::Shape) if a field does not have the shape of the grid.
    pub fn of_fields<T: Real>(
        gap: ArrayView2<'_, T>,
        contact_pressure: ArrayView2<'_, T>,
        grid: &Grid,
        (boundary, modulus): (Boundary, f64),
        law: &dyn AdhesionLaw<T>,
    ) -> Result<Self> {
        statistics(gap, contact_pressure, grid, (boundary, modulus), law)
    }

    fn count<T: Real>(
        gap: ArrayView2<'_, T>,
        contact_pressure: ArrayView2<'_, T>,
        grid: &Grid,
        (boundary, modulus): (Boundary, f64),
        law: &dyn AdhesionLaw<T>,
    ) -> Result<Self> {
        let (gap, contact_pressure, grid) = &whole(gap, contact_pressure, grid)?;
        let (gap, contact_pressure) = (gap.view(), contact_pressure.view());
        let on_grid = on_grid(law, grid, modulus);
        let law = on_grid.as_deref().unwrap_or(law);
        let contact = contact_map(gap, contact_pressure);
        let facing = gap.iter().filter(|gap| gap.is_finite()).count();
        let periodic = boundary.is_periodic();
        let outline = Outline { gap, contact_pressure, map: contact.view(), grid, periodic, modulus };
        let ContactArea { contact_nodes, contact_fraction, corrected_contact_fraction, perimeter, .. } =
            ContactArea::within_edge(&outline, facing);
        let share = |count: usize| count as f64 / facing as f64;
        let attracts = attracting(&contact, gap, (grid, periodic), law);
        let attracting = attracts.iter().filter(|&&attracts| attracts).count();
        let nodes = gap.iter().zip(&contact).zip(&attracts);
        let nodes = nodes.map(|((gap, &touches), &attracts)| gap.is_finite().then_some([touches, attracts]));
        Ok(Self {
            contact_nodes,
            contact_fraction,
            corrected_contact_fraction,
            perimeter,
            cluster_sizes: Clusters::within(contact.view(), boundary).sizes,
            repulsive_fraction: share(contact_pressure.iter().filter(|&&p| p > T::zero()).count()),
            attractive_fraction: share(attracting),
            apart_fraction: share(facing - contact_nodes - attracting),
            patches: patch::patches(law, nodes),
        })
    }
}
