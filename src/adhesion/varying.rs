use std::sync::Arc;

use ndarray::{Array2, ArrayView2};

use super::{AdhesionLaw, Discretisation, Hints, Values};
use crate::error::{Error, Result};
use crate::field::{all_finite_in, flat};
use crate::grid::Grid;
use crate::real::Real;
use crate::slab::Slab;

/// A law whose work of adhesion differs from node to node, w(x, y): energy, traction and slope in proportion to it.
///
/// Functions of one gap, such as μ_ρ, are those of the strongest node. Memory per node: one `f64`, which clones share.
///
/// ```
/// use asperity::adhesion::Varying;
/// use asperity::{Exponential, Grid};
/// let grid = Grid::square(64, 1.0)?;
/// // no adhesion on the left half
/// let work = grid.sample(|x, _| if x < 0.0 { 0.0 } else { 1e-5 });
/// let law = Varying::new(Exponential::new(1e-5, 2e-3)?, work.view())?;
/// assert_eq!(law.strongest(), (32, 0));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Varying<L> {
    law: L,
    slab: Slab,
    /// the work of adhesion at each node of the slab over that of the law
    shares: Arc<Array2<f64>>,
    largest: f64,
    repels: bool,
}

impl<L: AdhesionLaw<f64>> Varying<L> {
    /// The law with these works of adhesion at the nodes, shape (Nx, Ny), in place of its own.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::Value`] if a work of adhesion is negative, if none is positive, or if the law has
    /// none or varies already.
    pub fn new(law: L, works: ArrayView2<'_, f64>) -> Result<Self> {
        Self::in_slab(law, works, Slab::whole(works.dim()))
    }

    /// As [`Varying::new`], with the works of adhesion of the rows that this process holds, [`Grid::rows`], alone.
    ///
    /// # Errors
    /// Those of [`Varying::new`]; [`Error::Shape`] if the works of adhesion do not have the shape of the grid's fields.
    pub fn on(grid: &Grid, law: L, works: ArrayView2<'_, f64>) -> Result<Self> {
        grid.slab().agreed(Error::shape("work of adhesion", works.dim(), grid.field_shape()))?;
        Self::in_slab(law, works, grid.slab())
    }

    fn in_slab(law: L, works: ArrayView2<'_, f64>, slab: Slab) -> Result<Self> {
        all_finite_in(slab, "work of adhesion", works)?;
        let negative = works.iter().find(|&&work| work < 0.0).map_or(Ok(()), |&value| {
            let requirement = "zero or positive at every node";
            Err(Error::Value { name: "work of adhesion", value, requirement })
        });
        slab.agreed(negative)?;
        let hints = law.hints();
        let own = Error::positive("work of adhesion of the law that varies", hints.work_of_adhesion)?;
        if hints.shape.is_some() {
            let requirement = "one: give the law that the varying one is made of";
            return Err(Error::Value { name: "number of works of adhesion at a node", value: 2.0, requirement });
        }
        if slab.nodes() == 0 {
            return Err(Error::Value { name: "number of nodes", value: 0.0, requirement: "positive" });
        }
        let most = slab.most(works.iter().fold(0.0, |most: f64, &work| most.max(work)));
        Error::positive("largest work of adhesion", most)?;
        let shares = Arc::new(works.mapv(|work| work / own).as_standard_layout().into_owned());
        let repels = !slab.has(works.iter().any(|&work| work <= 0.0));
        Ok(Self { law, slab, shares, largest: most / own, repels })
    }
}

impl<L> Varying<L> {
    /// The node with the largest work of adhesion, (ix, iy); the first of several. Where several processes share the
    /// grid, all have to ask.
    pub fn strongest(&self) -> (usize, usize) {
        let own = flat(&self.shares).iter().position(|share| *share == self.largest);
        let node = own.map_or(f64::INFINITY, |node| (self.slab.first_node() + node) as f64);
        let (node, ny) = (self.slab.least(node) as usize, self.slab.shape().1);
        (node / ny, node % ny)
    }

    /// The law that varies.
    pub fn law(&self) -> &L {
        &self.law
    }

    fn scale<T: Real>(&self, first: usize, values: &mut [T]) {
        let own = first.checked_sub(self.slab.first_node());
        let shares = own.and_then(|own| flat(&self.shares).get(own..)).unwrap_or_default();
        // nodes of another slab have no answer here
        let (own, others) = values.split_at_mut(shares.len().min(values.len()));
        others.fill(T::nan());
        own.iter_mut().zip(shares).for_each(|(value, &share)| *value *= T::lit(share));
    }
}

impl<T: Real, L: AdhesionLaw<T> + Clone + 'static> AdhesionLaw<T> for Varying<L> {
    fn energy(&self, gap: T) -> T {
        T::lit(self.largest) * self.law.energy(gap)
    }
    fn traction(&self, gap: T) -> T {
        T::lit(self.largest) * self.law.traction(gap)
    }
    fn slope(&self, gap: T) -> T {
        T::lit(self.largest) * self.law.slope(gap)
    }
    fn hints(&self) -> Hints<T> {
        let hints = self.law.hints();
        let work_of_adhesion = T::lit(self.largest) * hints.work_of_adhesion;
        // a node without a work of adhesion does not repel
        let rest = hints.rest.filter(|_| self.repels);
        Hints { work_of_adhesion, rest, shape: Some(self.slab.shape()), ..hints }
    }
    fn evaluate(&self, first: usize, gaps: &[T], mut values: Values<'_, T>) {
        self.law.evaluate(first, gaps, values.reborrow());
        values.each(|_, values| self.scale(first, values));
    }
    fn on_nodes(&self, compliance: T) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let Self { slab, largest, repels, .. } = *self;
        let law = self.law.on_nodes(compliance * T::lit(largest))?;
        Some(Arc::new(Varying { law, slab, shares: self.shares.clone(), largest, repels }))
    }
    fn adapted(&self, to: Discretisation<T>) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let Self { slab, largest, repels, .. } = *self;
        Some(match to {
            Discretisation::Rows(grid) if !slab.is_shared() || slab == grid.slab() => return None,
            Discretisation::Rows(grid) => {
                let shares = Arc::new(slab.moved(self.shares.view().into(), &grid.slab()).into_owned());
                Arc::new(Varying { law: self.law.clone(), slab: grid.slab(), shares, largest, repels })
            }
            Discretisation::Coarse(nx, ny) => {
                let (rows, columns) = slab.shape();
                let coarse = slab.of((rows.div_ceil(nx), columns.div_ceil(ny)));
                let rows = slab.rows_for(self.shares.view(), &coarse, |row| [row * nx]);
                let first = coarse.rows().start;
                let share = |(ix, iy): (usize, usize)| rows.row((first + ix) * nx)[iy * ny];
                let shares = Arc::new(Array2::from_shape_fn(coarse.held(), share));
                Arc::new(Varying { law: self.law.clone(), slab: coarse, shares, largest, repels })
            }
            Discretisation::Smooth(compliance) => {
                // where the law is strongest its jumps are the largest
                let law = self.law.adapted(Discretisation::Smooth(compliance * T::lit(largest)))?;
                Arc::new(Varying { law, slab, shares: self.shares.clone(), largest, repels })
            }
        })
    }
}
