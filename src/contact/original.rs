//! The original of a mirrored map, as a part of the solution on the whole map.

use ndarray::{Array2, ArrayView2, Axis, Slice};

use super::{Clusters, ContactStatistics, contact_map};
use crate::adhesion::AdhesionLaw;
use crate::elastic::Boundary;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::problem::Control;
use crate::real::Real;
use crate::solver::{Report, Solution};

/// The original of a mirrored map: the first nodes; all other nodes are their mirror images.
///
/// A map that [`mirror`](crate::surface::mirror) has made periodic is solved with its images. Gaps,
/// pressures, energies per area and shares are the same on the original as on the whole, if the solution has the
/// symmetry of the surface; numbers of nodes, forces, the perimeter and clusters are not. With adhesion a symmetric
/// state may be unstable: compare [`contact_nodes`](Self::contact_nodes) with its [`share`](Self::share) of all.
///
/// ```
/// use asperity::contact::Original;
/// use asperity::surface::mirror;
/// use asperity::{Control, Grid, NoAdhesion, Problem, SelfAffine, Solver, Surface, Westergaard};
/// let rough = SelfAffine::default().k_s(8.0).surface(Grid::square(32, 1.0)?)?;
/// let map = ndarray::Array2::from_shape_fn((20, 20), |(i, j)| rough.heights()[[i + 3, j + 5]]);
/// let surface = Surface::new(Grid::square(40, 2.0)?, mirror(&map))?;
/// let half_space = Westergaard::<f64>::new(*surface.grid(), 1.0)?;
/// let mut problem = Problem::new(&surface, half_space, NoAdhesion)?;
/// let whole = Solver::default().solve(&mut problem, Control::MeanPressure(0.01))?;
///
/// let original = Original::new(surface.grid(), (20, 20))?;
/// let part = original.of_solution(&whole)?;
/// assert_eq!((part.gap.dim(), original.grid().shape()), ((20, 20), (20, 20)));
/// assert_eq!(4 * part.report.contact_nodes, whole.report.contact_nodes);
/// assert_eq!(original.mirrored(&part.gap)?.dim(), whole.gap.dim());
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Original {
    grid: Grid,
    whole: Grid,
}

impl Original {
    /// The original with `nodes` along x and y, on `whole`.
    ///
    /// # Errors
    /// [`Error::Value`] for no nodes, [`Error::Shape`] for more than the map has, and [`Error::Shared`] if several
    /// processes share the grid.
    pub fn new(whole: &Grid, nodes: (usize, usize)) -> Result<Self> {
        whole.refuse_shared("the original of a mirrored map")?;
        let (shape, (dx, dy)) = (whole.shape(), whole.spacing());
        if nodes.0 > shape.0 || nodes.1 > shape.1 {
            return Err(Error::Shape { name: "original", found: nodes, expected: shape });
        }
        // the side of a line is no distance of nodes
        let ly = if whole.is_line() { whole.lengths().1 } else { nodes.1 as f64 * dy };
        Ok(Self { grid: Grid::new(nodes, (nodes.0 as f64 * dx, ly))?, whole: *whole })
    }

    /// The same part of the map on another grid, coarser or finer.
    ///
    /// # Errors
    /// As [`Original::new`].
    pub fn on(&self, whole: &Grid) -> Result<Self> {
        let (part, before, now) = (self.grid.shape(), self.whole.shape(), whole.shape());
        let scaled = |nodes: usize, before: usize, now: usize| (nodes * now).div_ceil(before);
        Self::new(whole, (scaled(part.0, before.0, now.0), scaled(part.1, before.1, now.1)))
    }

    /// The grid of the original.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The grid of the whole.
    pub fn whole(&self) -> &Grid {
        &self.whole
    }

    /// The share of the nodes that are the original's.
    pub fn share(&self) -> f64 {
        self.grid.nodes() as f64 / self.whole.nodes() as f64
    }

    /// The load on the whole that is a load on the original: a force, or a spring, acts on each image too.
    pub fn load(&self, control: Control) -> Control {
        control.of_share(1.0 / self.share())
    }

    /// A field of the whole on the original.
    ///
    /// # Errors
    /// [`Error::Shape`] if the field is not of the whole.
    pub fn crop<A: Clone>(&self, field: ArrayView2<'_, A>) -> Result<Array2<A>> {
        Error::shape("field", field.dim(), self.whole.shape())?;
        let (nx, ny) = self.grid.shape();
        Ok(field.slice_axis(Axis(0), Slice::from(..nx)).slice_axis(Axis(1), Slice::from(..ny)).to_owned())
    }

    /// A field of the original, continued by its mirror images to the whole; to a node, where the map was resampled.
    ///
    /// # Errors
    /// [`Error::Shape`] if the field is not of the original.
    pub fn mirrored<A: Clone>(&self, field: &Array2<A>) -> Result<Array2<A>> {
        Error::shape("field", field.dim(), self.grid.shape())?;
        let image = |i: usize, n: usize| {
            let place = i % (2 * n);
            if place < n { place } else { 2 * n - 1 - place }
        };
        let (nx, ny) = self.grid.shape();
        Ok(Array2::from_shape_fn(self.whole.shape(), |(i, j)| field[[image(i, nx), image(j, ny)]].clone()))
    }

    /// The number of nodes in contact on the original.
    ///
    /// # Errors
    /// [`Error::Shape`] if the solution is not one of the whole.
    pub fn contact_nodes<T: Real>(&self, solution: &Solution<T>) -> Result<usize> {
        Ok(number(&self.contact(solution.gap.view(), solution.contact_pressure.view())?))
    }

    fn contact<T: Real>(&self, gap: ArrayView2<'_, T>, pressure: ArrayView2<'_, T>) -> Result<Array2<bool>> {
        self.crop(contact_map(gap, pressure).view())
    }

    /// The solution on the original: its part of the fields, its nodes in contact, and its share of the force and of
    /// the load. Means, fractions, extremes and energies stay.
    ///
    /// # Errors
    /// [`Error::Shape`] if the solution is not one of the whole.
    pub fn of_solution<T: Real>(&self, solution: &Solution<T>) -> Result<Solution<T>> {
        let contact_nodes = self.contact_nodes(solution)?;
        let [gap, pressure, contact_pressure] =
            [&solution.gap, &solution.pressure, &solution.contact_pressure].map(|field| self.crop(field.view()));
        let gap = gap?;
        let report = Report {
            contact_nodes,
            absent_nodes: gap.iter().filter(|gap| !gap.is_finite()).count(),
            normal_force: self.share() * solution.report.normal_force,
            control: solution.report.control.of_share(self.share()),
            ..solution.report.clone()
        };
        let plastic_depth = solution.plastic_depth.as_ref().map(|depth| self.crop(depth.view())).transpose()?;
        let touched = solution.touched.as_ref().map(|touched| self.crop(touched.view())).transpose()?;
        let (pressure, contact_pressure) = (pressure?, contact_pressure?);
        Ok(Solution {
            gap,
            pressure,
            contact_pressure,
            plastic_depth,
            touched,
            grid: self.grid,
            report,
            law: solution.law.clone(),
        })
    }

    /// The statistics of the original, from a solution on the whole. Clusters end at its sides, which are
    /// no part of the perimeter.
    ///
    /// # Errors
    /// [`Error::Shape`] if the solution does not belong to the whole; otherwise as [`ContactStatistics::of`].
    pub fn statistics<T: Real>(&self, solution: &Solution<T>) -> Result<ContactStatistics> {
        let Solution { gap, contact_pressure, report, law, .. } = solution;
        self.statistics_of_fields(gap.view(), contact_pressure.view(), report.modulus, &**law)
    }

    /// The statistics from the gap and the contact pressure of the whole, and the contact modulus.
    ///
    /// # Errors
    /// [`Error::Shape`] if a field does not have the shape of the whole.
    pub fn statistics_of_fields<T: Real>(
        &self,
        gap: ArrayView2<'_, T>,
        contact_pressure: ArrayView2<'_, T>,
        modulus: f64,
        law: &dyn AdhesionLaw<T>,
    ) -> Result<ContactStatistics> {
        let body = (Boundary::Periodic, modulus);
        let whole = ContactStatistics::of_fields(gap, contact_pressure, &self.whole, body, law)?;
        let contact = self.contact(gap, contact_pressure)?;
        // each by its name, so that of a new statistic somebody has to say what it is on a part
        Ok(ContactStatistics {
            contact_nodes: number(&contact),
            contact_fraction: whole.contact_fraction,
            corrected_contact_fraction: whole.corrected_contact_fraction,
            perimeter: self.share() * whole.perimeter,
            cluster_sizes: Clusters::of_part(contact.view()).sizes,
            repulsive_fraction: whole.repulsive_fraction,
            attractive_fraction: whole.attractive_fraction,
            apart_fraction: whole.apart_fraction,
            patches: whole.patches,
        })
    }
}

fn number(contact: &Array2<bool>) -> usize {
    contact.iter().filter(|&&touches| touches).count()
}

#[cfg(test)]
mod tests {
    use ndarray::array;

    use super::*;
    use crate::adhesion::NoAdhesion;

    #[test]
    fn a_field_is_mirrored_and_found_again() {
        let field = array![[1, 2, 3], [4, 5, 6]];
        for (shape, wanted) in [((4, 6), array![1, 2, 3, 3, 2, 1]), ((3, 5), array![1, 2, 3, 3, 2])] {
            let original = Original::new(&Grid::new(shape, (1.0, 1.0)).unwrap(), (2, 3)).unwrap();
            let whole = original.mirrored(&field).unwrap();
            assert_eq!((whole.dim(), whole.row(0)), (shape, wanted.view()));
            assert_eq!(whole.row(2), whole.row(1));
            assert_eq!(original.crop(whole.view()).unwrap(), field);
            assert!(original.crop(field.view()).is_err() && original.mirrored(&whole).is_err());
        }
    }

    #[test]
    fn a_contact_at_the_side_goes_on_in_the_image() {
        let grid = Grid::new((8, 6), (8.0, 6.0)).unwrap();
        let original = Original::new(&grid, (4, 3)).unwrap();
        let mut pressure = Array2::zeros((4, 3));
        (pressure[[0, 1]], pressure[[2, 2]]) = (1.0, 1.0);
        let pressure = original.mirrored(&pressure).unwrap();
        let gap = pressure.mapv(|pressure| 1.0 - pressure);
        let found = original.statistics_of_fields(gap.view(), pressure.view(), 1.0, &NoAdhesion).unwrap();
        assert_eq!((found.contact_nodes, &found.cluster_sizes[..]), (2, &[1, 1][..]));
        assert_eq!(found.contact_fraction, 2.0 / 12.0);
        // of each three sides of a cell
        assert_eq!(found.perimeter, 6.0);
    }

    #[test]
    fn an_original_that_does_not_fit_is_refused() {
        let grid = Grid::new((8, 6), (1.0, 1.0)).unwrap();
        for nodes in [(9, 3), (4, 7), (0, 3)] {
            assert!(Original::new(&grid, nodes).is_err(), "{nodes:?}");
        }
    }
}
