//! Hardness: a cap on the contact pressure, at which the surface yields.

use ndarray::Array2;

use super::{ContactConstraint, Wall};
use crate::error::{Error, Result};
use crate::field::{CHUNK, Field};
use crate::grid::Grid;
use crate::real::Real;
use crate::vector::vectors;

/// A rigid wall that yields where the contact pressure reaches a hardness H: perfectly plastic asperities, 0 ≤ λ ≤ H.
///
/// The energy of a node that yields by a depth d is H d, linear, with a corner where the surfaces touch:
///
/// ```math
/// ψ(g) = H ⟨−g⟩₊ ,   λ = H where g < 0 ,   0 ≤ λ ≤ H where g = 0 ,   λ = 0 where g > 0
/// ```
///
/// A law that pulls with a traction t where the surfaces touch does a part of this work, and H − t is dissipated per
/// depth. Where the surface has yielded, the gap g to the surface before is negative, by the plastic depth −g. A
/// [`Solution`](crate::Solution) has the gap to the yielded surface, zero there, and the
/// [depth](crate::Solution::plastic_depth). A solve is monotonic loading of its problem's surface;
/// [`Problem::flatten`](crate::Problem::flatten) keeps a depth, so that unloading from there is elastic, as
/// [`Sweep`](crate::Sweep) and [`Path`](crate::path::Path) do from load to load.
///
/// The function ψ is convex, so that the certificate of a solve holds as for a rigid wall, and no spring regularises
/// its corners. The model leaves out hardening, the volume of what is displaced, and yielding below the surface.
///
/// The contact area corrected for its edge ([`ContactStatistics`](crate::contact::ContactStatistics)) and the error of
/// the grid ([`GridError`](crate::accuracy::GridError)) hold for elastic contact: use neither for a surface that has
/// yielded.
///
/// ```
/// use asperity::{Control, Grid, Hardness, NoAdhesion, Problem, Settings, Solver, Surface, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let mut solver = Solver { settings: Settings::default(), constraint: Hardness::new(0.02)? };
/// let solution = solver.solve(&mut problem, Control::MeanPressure(2e-4))?;
/// let plastic = solution.report.plastic.unwrap();
/// assert!(plastic.fraction > 0.0 && plastic.depth_max > 0.0);
/// assert_eq!(solution.contact_pressure.iter().copied().fold(0.0, f64::max), 0.02);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Hardness {
    mean: f64,
    least: f64,
    /// H at every node of the surface; empty if it is the same everywhere
    field: Field<f64>,
    /// H at the nodes of the solve's grid
    held: Field<f64>,
}

impl Hardness {
    /// The same hardness H everywhere, a pressure.
    ///
    /// # Errors
    /// [`Error::Value`] if it is not positive and finite.
    pub fn new(hardness: f64) -> Result<Self> {
        let mean = Error::positive("hardness", hardness)?;
        Ok(Self { mean, least: mean, field: Field::default(), held: Field::default() })
    }

    /// A hardness H at each node of the surface, of shape (Nx, Ny). On coarser grids each node takes the hardness of
    /// the nearest node.
    ///
    /// # Errors
    /// [`Error::Value`] for a value that is not positive and finite; [`Error::Shape`] of an empty field, and from a
    /// solve on another grid.
    pub fn varying(hardness: Array2<f64>) -> Result<Self> {
        if hardness.is_empty() {
            return Err(Error::Shape { name: "hardness", found: hardness.dim(), expected: (1, 1) });
        }
        let mut least = f64::INFINITY;
        for &value in &hardness {
            least = least.min(Error::positive("hardness", value)?);
        }
        let field = Field::of(hardness);
        Ok(Self { mean: field.sum() / field.len() as f64, least, field, held: Field::default() })
    }

    /// The hardness H, in the mean over the nodes.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Whether it is given node by node.
    pub(crate) fn varies(&self) -> bool {
        !self.field.is_empty()
    }

    /// The least hardness.
    pub(crate) fn least(&self) -> f64 {
        self.least
    }

    /// The mean pressure over all nodes that a share of them bears at most.
    pub(crate) fn bears(&self, share: f64) -> f64 {
        if !self.varies() {
            return share * self.mean;
        }
        let mut hardest: Vec<f64> = self.field.iter().copied().collect();
        hardest.sort_by(|a, b| b.total_cmp(a));
        let nodes = hardest.len() as f64;
        let borne = hardest.iter().enumerate().map(|(i, cap)| cap * (share * nodes - i as f64).clamp(0.0, 1.0));
        borne.sum::<f64>() / nodes
    }

    /// The hardness at so many nodes of the solve's grid, from the node `first` on; infinite at nodes without one.
    pub(crate) fn caps<T: Real>(&self, first: usize, count: usize) -> [T; CHUNK] {
        let mut caps = [if self.varies() { T::infinity() } else { T::lit(self.mean) }; CHUNK];
        if let Some(held) = self.held.nodes().get(first..first + count) {
            caps.iter_mut().zip(held).for_each(|(cap, &held)| *cap = T::lit(held));
        }
        caps
    }

    /// Adds the energy ψ = −H g of nodes with a negative gap, or its derivative of an order.
    pub(crate) fn add<T: Real>(&self, order: usize, first: usize, gaps: &[T], out: &mut [T]) {
        let (linear, constant) = match order {
            0 => (T::one(), T::zero()),
            1 => (T::zero(), T::one()),
            _ => return,
        };
        let caps = self.caps::<T>(first, gaps.len());
        vectors!([gaps, caps], [out], |i| {
            let (gap, cap) = (gaps[i], caps[i]);
            out[i] = if gap < T::zero() { out[i] - cap * (linear * gap + constant) } else { out[i] };
        });
    }
}

impl<T: Real> ContactConstraint<T> for Hardness {
    fn wall(&self) -> Wall<'_, T> {
        Wall::Capped(self)
    }
    fn start(&mut self, grid: &Grid, _: f64, _: f64) -> Result<()> {
        for value in [self.least, self.mean] {
            let rounded = T::lit(value);
            if !(rounded > T::zero() && rounded.is_finite()) {
                let requirement = "positive and finite in the precision of the fields";
                return Err(Error::Value { name: "hardness", value, requirement });
            }
        }
        let ((fx, fy), (nx, ny)) = (self.field.dim(), grid.shape());
        if self.field.is_empty() {
            return Ok(());
        }
        let coarser = |fine: usize, coarse: usize| fine == coarse || 2 * coarse <= fine + 1;
        if !(coarser(fx, nx) && coarser(fy, ny)) {
            return Err(Error::Shape { name: "hardness", found: (fx, fy), expected: (nx, ny) });
        }
        let nearest = |i: usize, fine: usize, coarse: usize| ((2 * i * fine + coarse) / (2 * coarse)).min(fine - 1);
        self.held = Field::from_fn((nx, ny), |(i, j)| self.field[[nearest(i, fx, nx), nearest(j, fy, ny)]]);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_without_a_hardness_have_no_cap() {
        let caps = |hardness: &Hardness, first| hardness.caps::<f64>(first, 2)[..2].to_vec();
        let mut hardness = Hardness::varying(Array2::from_shape_fn((2, 2), |(i, j)| (1 + 2 * i + j) as f64)).unwrap();
        assert_eq!(caps(&hardness, 0), [f64::INFINITY; 2]);
        ContactConstraint::<f64>::start(&mut hardness, &Grid::square(2, 1.0).unwrap(), 0.0, 0.0).unwrap();
        assert_eq!(
            [caps(&hardness, 1), caps(&hardness, 2), caps(&hardness, 3)],
            [[2.0, 3.0], [3.0, 4.0], [f64::INFINITY; 2]]
        );
        assert_eq!(caps(&Hardness::new(5.0).unwrap(), 7), [5.0; 2]);
    }
}
