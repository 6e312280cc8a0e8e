//! The contact of a solution: its area and edge, its clusters, and the distribution of its pressure.
//!
//! A node is in contact as [`Solution::contact_map`] says. [`ContactStatistics`] has areas, counted and within the edge
//! between the nodes, and the perimeter; [`Clusters`] are the pieces that hang together; [`PressureDistribution`] is
//! the histogram of the pressure. [`Original`] is the part of a mirrored map that was measured.

use ndarray::{Array2, ArrayView2, Zip};

use crate::adhesion::{AdhesionLaw, Values, noticeable};
use crate::elastic::Boundary;
use crate::error::Result;
use crate::grid::Grid;
use crate::real::Real;
use crate::solver::Solution;

use outline::Outline;

mod area;
mod clusters;
mod distribution;
mod original;
mod outline;
mod patch;
mod places;

pub use area::ContactArea;
pub use clusters::Clusters;
pub use distribution::PressureDistribution;
pub use original::Original;
pub use patch::Patch;

/// What the two surfaces do to each other at a node.
///
/// As numbers these are the classes of [`Colouring::Contact`](crate::picture::Colouring::Contact): 1, −1, 0 and NaN.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// They touch, as [`Solution::contact_map`] says.
    Contact,
    /// They attract each other without contact, as [`ContactStatistics::attractive_fraction`] counts it.
    Attractive,
    /// They do not notice each other.
    Apart,
    /// There is no surface: the node is [absent](crate::Surface::with_absent).
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
    /// The region of each node: contact, attraction, neither, or no surface, under the law of the solution.
    ///
    /// # Errors
    /// [`Error::Value`](crate::Error::Value) if the law has another work of adhesion than that of the solution.
    ///
    /// ```
    /// use asperity::contact::{ContactStatistics, Region};
    /// use asperity::{Control, Exponential, Grid, Problem, Solver, Surface, Westergaard};
    /// let (grid, law) = (Grid::square(64, 1.0)?, Exponential::new(1e-4, 4e-3)?);
    /// let sphere = Surface::paraboloid(grid, 2.0)?;
    /// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, law)?;
    /// let solution = Solver::default().solve(&mut problem, Control::MeanGap(0.0398))?;
    /// let attracting = solution.regions(&law)?.iter().filter(|region| **region == Region::Attractive).count();
    /// let statistics = ContactStatistics::of(&solution, &law)?;
    /// assert_eq!(attracting as f64 / 4096.0, statistics.attractive_fraction);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn regions(&self, law: &impl AdhesionLaw<T>) -> Result<Array2<Region>> {
        self.check_law(law)?;
        let contact = self.contact_map();
        let attracts = attracting(&contact, self.gap.view(), &self.grid, law);
        let mut nodes = self.gap.iter().zip(&contact).zip(attracts);
        Ok(Array2::from_shape_simple_fn(self.gap.dim(), || match nodes.next() {
            Some(((_, true), _)) => Region::Contact,
            Some((_, true)) => Region::Attractive,
            Some(((gap, _), _)) if gap.is_finite() => Region::Apart,
            _ => Region::Absent,
        }))
    }

    /// The contact map: true at nodes without a gap (g ≤ 0) and at nodes with a contact pressure (λ > 0).
    ///
    /// This is what contact means everywhere: in [`Report::contact_nodes`](crate::Report::contact_nodes) and
    /// [`Iteration::contact_nodes`](crate::Iteration::contact_nodes), in [`ContactStatistics`] and its clusters, in
    /// [`PressureDistribution`], and in pictures. Under [`Projection`](crate::Projection) the nodes without a gap are
    /// all of them, and some may carry no pressure. Under a constraint that is a term of the energy all that
    /// interpenetrate are pressed, and those of [`Uzawa`](crate::Uzawa) may be pressed at a gap that is not quite
    /// zero.
    ///
    /// ```
    /// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
    /// let grid = Grid::square(64, 1.0)?;
    /// let sphere = Surface::paraboloid(grid, 2.0)?;
    /// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
    /// let contact = Solver::default().solve(&mut problem, Control::MeanGap(0.0398))?.contact_map();
    /// assert!(contact[[32, 32]] && !contact[[0, 0]]);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn contact_map(&self) -> Array2<bool> {
        contact_map(self.gap.view(), self.contact_pressure.view())
    }
}

/// Whether each node attracts without contact: whether its adhesive traction is noticeable.
fn attracting<T: Real>(
    contact: &Array2<bool>,
    gap: ArrayView2<'_, T>,
    grid: &Grid,
    law: &impl AdhesionLaw<T>,
) -> Vec<bool> {
    if law.hints().zero {
        return vec![false; gap.len()];
    }
    let least = T::lit(noticeable(law));
    let gaps: Vec<T> = gap.iter().map(|gap| gap.max(T::zero())).collect();
    let mut tractions = vec![T::zero(); gaps.len()];
    law.evaluate(grid.first_node(), &gaps, Values::one(1, &mut tractions));
    contact.iter().zip(tractions).map(|(&touches, traction)| !touches && traction > least).collect()
}

/// The contact map of a gap and a contact pressure of one shape.
fn contact_map<T: Real>(gap: ArrayView2<'_, T>, contact_pressure: ArrayView2<'_, T>) -> Array2<bool> {
    Zip::from(gap).and(contact_pressure).map_collect(|&gap, &pressure| (gap <= T::zero()) | (pressure > T::zero()))
}

/// Refuses fields that do not have the shape of the grid.
fn check<T: Real>(gap: ArrayView2<'_, T>, contact_pressure: ArrayView2<'_, T>, grid: &Grid) -> Result<()> {
    grid.fits("gap", gap.dim())?;
    grid.fits("contact pressure", contact_pressure.dim())
}

/// Contact statistics: the area and the clusters of contact, and the area that attracts without contact.
///
/// Fractions are of the nodes that are not [absent](crate::Surface::with_absent): without absent nodes, of the nominal
/// area Lx·Ly. Contact, attractive and apart fraction add up to one. With a free boundary opposite sides do not meet.
///
/// The corrected contact area is that within the edge of the contact, which contact pressure λ and gap g tell between
/// the nodes. Inside an edge the contact pressure grows like the root of the distance from it, outside the gap like its
/// power 3/2. While a straight edge moves across a grid from one row of nodes to the next, the pressure of the row
/// inside rises from zero, and the gap of the row outside falls to zero, both in proportion. So the edge runs at a
/// fixed distance from the contour on which
///
/// ```math
/// κλΔ = E* g ,   κ = 2e/π ,
/// ```
///
/// with linear interpolation between the nodes, and is inside of it by β = 0.190 spacings Δ. Both numbers follow from
/// the discrete half-space, for an edge along the nodes, by the method of Wiener and Hopf: E*/κΔ is the geometric mean
/// of the stiffness E*\|q\|/2 of the waves on the grid, and, with q in units of 1/Δ,
///
/// ```math
/// β = 1/4 − (1/4π) ∫_0^π ln(q / 2 sin(q/2)) / sin²(q/2) dq .
/// ```
///
/// Love's kernel of the [free half-space](crate::Boussinesq) has nearly the same κ, and β = 0.175.
///
/// The contour is a polygon, by marching squares on the rectangles between nodes, and the corrected area is
///
/// ```math
/// A = A_polygon − Δ ∫ (β − 0.0147 |sin 2θ|³) dL + 0.78 χ Δ² .
/// ```
///
/// The integral is along the polygon, at the angle θ to the axes; what β is less by for edges that are askew to the
/// nodes was measured on plane waves in ten directions. The last term is what a curved edge adds, with the number χ of
/// contacts less that of holes in them, by which the edge turns round; its factor is fitted to Hertz contacts. For Δx ≠
/// Δy length and area are taken with the spacings as units. On a line there are the ends alone, each β inside the
/// contour. Nodes at the end of a surface, beside absent ones or the end of a window, are counted as a whole, and so is
/// full contact. Where a wall gives, as that of [`Penalty`](crate::Penalty), the gap in contact counts as well, and β
/// falls with the cube of the share of the pressure in κλΔ − E\*g, to zero where the gap has no kink left. Where [the
/// law alone repels](crate::NoWall) contact nodes are apart, and the more so, the nearer the edge is to the middle
/// between the nodes: they are counted. Without a modulus, that is one that is not positive, the area is that of
/// [`ContactArea::of`].
///
/// The error is of second order. Straight edges of waves of 20 to 64 nodes, in several directions, are met to 0.013
/// spacings on the average over their places between the nodes, and of twice the nodes to 0.0065. Hertz contacts with
/// radii of 3 to 7 nodes have a root mean square error of 0.28 % of the area, with radii of 14 to 28 nodes of 0.025 %,
/// where counting nodes is wrong by 7.9 and 1.6 %. The page [`choosing`](crate::guide::choosing) has errors of rough
/// surfaces. With adhesion of a range that the grid does not resolve (μ_ρ above 0.5) the fields tell less, and the area
/// is as good as that of [`ContactArea::of`].
///
/// ```
/// use asperity::contact::ContactStatistics;
/// use asperity::{Control, Exponential, Grid, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let surface = Surface::wave_2d(grid, 0.01, 2)?; // eight peaks
/// let law = Exponential::new(1e-5, 2e-3)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, law)?;
/// let solution = Solver::default().solve(&mut problem, Control::MeanPressure(0.01))?;
/// let statistics = ContactStatistics::of(&solution, &law)?;
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
    /// The length of the edge of the contact, along the sides of the cells, across the periodic boundaries too: Δy for
    /// neighbours along x of which one is in contact, Δx for neighbours along y. Beyond a free boundary nothing is in
    /// contact. On a line the number of end points.
    pub perimeter: f64,
    /// The sizes of the clusters of contact in nodes, the largest first; neighbours along a side of their cells
    /// hang together, across the periodic boundaries too.
    pub cluster_sizes: Vec<usize>,
    /// The share of nodes that repel each other: those with a contact pressure. Nodes may touch without one.
    pub repulsive_fraction: f64,
    /// The share of nodes that attract each other without being in contact: those with an adhesive traction of more
    /// than 1 % of w/ρ. That is g < ρ for [`MaugisDugdale`](crate::MaugisDugdale), and g < 4.6 ρ for
    /// [`Exponential`](crate::Exponential).
    pub attractive_fraction: f64,
    /// The share of the other nodes, which do not notice each other.
    pub apart_fraction: f64,
    /// The same where the law [varies](crate::adhesion::Varying) over the surface, for the nodes of each work of
    /// adhesion, the least first; nodes are said to attract by the traction above, that of the strongest. Empty for a
    /// law that is the same everywhere, and for more than 16 works of adhesion.
    ///
    /// ```
    /// use asperity::contact::ContactStatistics;
    /// use asperity::adhesion::Varying;
    /// use asperity::{Control, Exponential, Grid, Problem, Solver, Surface, Westergaard};
    /// let grid = Grid::square(64, 1.0)?;
    /// let surface = Surface::wave_2d(grid, 0.01, 2)?;
    /// let work = grid.sample(|x, _| if x < 0.0 { 1e-6 } else { 1e-4 });
    /// let law = Varying::new(Exponential::new(1e-4, 4e-3)?, work.view())?;
    /// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, &law)?;
    /// let solution = Solver::default().solve(&mut problem, Control::MeanPressure(0.01))?;
    /// let statistics = ContactStatistics::of(&solution, &law)?;
    /// let [weak, strong] = statistics.patches[..] else { panic!("two works of adhesion") };
    /// assert!(strong.contact_fraction > weak.contact_fraction);
    /// assert_eq!((weak.area_fraction, strong.area_fraction), (0.5, 0.5));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub patches: Vec<Patch>,
}

impl ContactStatistics {
    /// The statistics of a solution, with the law with which it was found.
    ///
    /// Memory per node, until it returns: ten bytes, and with adhesion two scalars.
    ///
    /// # Errors
    /// [`Error::Value`](crate::Error::Value) if the law has another work of adhesion than that of the solution; [`Error::Shape`](crate::Error::Shape) if a field
    /// does not have the shape of the grid.
    pub fn of<T: Real>(solution: &Solution<T>, law: &impl AdhesionLaw<T>) -> Result<Self> {
        solution.check_law(law)?;
        let Solution { gap, contact_pressure, grid, report, .. } = solution;
        Self::of_fields(gap.view(), contact_pressure.view(), grid, (report.boundary, report.modulus), law)
    }

    /// The statistics of the gap and the contact pressure of a solution, as those that come from a file, on its grid,
    /// with the boundary and the contact modulus E* of the body. The gap of absent nodes is infinite.
    ///
    /// # Errors
    /// [`Error::Shape`](crate::Error::Shape) if a field does not have the shape of the grid.
    pub fn of_fields<T: Real>(
        gap: ArrayView2<'_, T>,
        contact_pressure: ArrayView2<'_, T>,
        grid: &Grid,
        (boundary, modulus): (Boundary, f64),
        law: &impl AdhesionLaw<T>,
    ) -> Result<Self> {
        check(gap, contact_pressure, grid)?;
        let contact = contact_map(gap, contact_pressure);
        let facing = grid.total(gap.iter().filter(|gap| gap.is_finite()).count());
        let periodic = boundary == Boundary::Periodic;
        let outline = Outline { gap, contact_pressure, map: contact.view(), grid, periodic, modulus };
        let ContactArea { contact_nodes, contact_fraction, corrected_contact_fraction, perimeter, .. } =
            ContactArea::within_edge(&outline, facing);
        let share = |count: usize| count as f64 / facing as f64;
        let attracts = attracting(&contact, gap, grid, law);
        let attracting = grid.total(attracts.iter().filter(|&&attracts| attracts).count());
        let nodes = gap.iter().zip(&contact).zip(&attracts);
        let nodes = nodes.map(|((gap, &touches), &attracts)| gap.is_finite().then_some([touches, attracts]));
        Ok(Self {
            contact_nodes,
            contact_fraction,
            corrected_contact_fraction,
            perimeter,
            cluster_sizes: Clusters::within(grid.whole(&contact).view(), boundary).sizes,
            repulsive_fraction: share(grid.total(contact_pressure.iter().filter(|&&p| p > T::zero()).count())),
            attractive_fraction: share(attracting),
            apart_fraction: share(facing - contact_nodes - attracting),
            patches: patch::patches(law, grid, nodes),
        })
    }
}
