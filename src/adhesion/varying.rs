use std::ops::Range;
use std::sync::Arc;

use ndarray::ArrayView2;

use super::{AdhesionLaw, Discretisation, Hints, Values};
use crate::error::{Error, Result};
use crate::field::{CHUNK, Field, all_finite};
use crate::real::Real;

/// A law with a work of adhesion w(x, y) at each node: energy, traction and slope are proportional to w.
///
/// With [`Jkr`](crate::Jkr) each node has the range of its own work of adhesion. Functions of one gap, such as μ_ρ, are
/// functions of the strongest node. Memory per node: one `f64`, which clones share; where several processes share a
/// grid, each has the law at all nodes.
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
    /// the work of adhesion at each node over the work of adhesion of the law
    shares: Arc<Field<f64>>,
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
        all_finite("work of adhesion", works)?;
        if let Some(&value) = works.iter().find(|&&work| work < 0.0) {
            let requirement = "zero or positive at every node";
            return Err(Error::Value { name: "work of adhesion", value, requirement });
        }
        let hints = law.hints();
        let own = Error::positive("work of adhesion of the law that varies", hints.work_of_adhesion)?;
        if hints.shape.is_some() {
            let requirement = "one: give the law before it varies";
            return Err(Error::Value { name: "number of works of adhesion at a node", value: 2.0, requirement });
        }
        if works.is_empty() {
            return Err(Error::Value { name: "number of nodes", value: 0.0, requirement: "positive" });
        }
        let most = works.iter().fold(0.0, |most: f64, &work| most.max(work));
        Error::positive("largest work of adhesion", most)?;
        let shares = Arc::new(Field::of(works.mapv(|work| work / own)));
        let repels = works.iter().all(|&work| work > 0.0);
        Ok(Self { law, shares, largest: most / own, repels })
    }
}

impl<L> Varying<L> {
    /// The node with the largest work of adhesion, (ix, iy); the first of several.
    pub fn strongest(&self) -> (usize, usize) {
        let node = self.shares.nodes().iter().position(|share| *share == self.largest).unwrap_or_default();
        (node / self.shares.ncols(), node % self.shares.ncols())
    }

    /// The law that varies.
    pub fn law(&self) -> &L {
        &self.law
    }

    fn shares_from(&self, first: usize) -> &[f64] {
        self.shares.nodes().get(first..).unwrap_or_default()
    }
}

impl<L> Varying<L> {
    /// The range of a node over the range of the law: a range set by the grid grows with the root of the work of
    /// adhesion.
    fn stretch<T: Real>(&self, share: f64) -> T
    where
        L: AdhesionLaw<T>,
    {
        if self.law.hints().of_grid { T::lit(share.sqrt()) } else { T::one() }
    }

    /// Visits pieces of the nodes with the gaps, in ranges of the law, that they have there; a node without a range has
    /// none where it touches, and an infinite one elsewhere.
    fn each_piece<T: Real>(&self, first: usize, gaps: &[T], mut visit: impl FnMut(Range<usize>, &[T]))
    where
        L: AdhesionLaw<T>,
    {
        if !self.law.hints().of_grid {
            return visit(0..gaps.len(), gaps);
        }
        let mut own = [T::zero(); CHUNK];
        for (piece, gaps) in gaps.chunks(CHUNK).enumerate() {
            let start = piece * CHUNK;
            for ((own, &gap), &share) in own.iter_mut().zip(gaps).zip(self.shares_from(first + start)) {
                *own = if gap > T::zero() { gap / T::lit(share.sqrt()) } else { gap };
            }
            visit(start..start + gaps.len(), &own[..gaps.len()]);
        }
    }
}

impl<T: Real, L: AdhesionLaw<T> + Clone + 'static> AdhesionLaw<T> for Varying<L> {
    fn energy(&self, gap: T) -> T {
        T::lit(self.largest) * self.law.energy(gap / self.stretch(self.largest))
    }
    fn traction(&self, gap: T) -> T {
        let stretch = self.stretch(self.largest);
        T::lit(self.largest) / stretch * self.law.traction(gap / stretch)
    }
    fn slope(&self, gap: T) -> T {
        let stretch = self.stretch(self.largest);
        T::lit(self.largest) / (stretch * stretch) * self.law.slope(gap / stretch)
    }
    fn hints(&self) -> Hints<T> {
        let hints = self.law.hints();
        let work_of_adhesion = T::lit(self.largest) * hints.work_of_adhesion;
        let range = self.stretch::<T>(self.largest) * hints.range;
        // a node without a work of adhesion does not repel
        let rest = hints.rest.filter(|_| self.repels);
        Hints { work_of_adhesion, range, rest, shape: Some(self.shares.dim()), ..hints }
    }
    fn evaluate(&self, first: usize, gaps: &[T], mut values: Values<'_, T>) {
        self.each_piece(first, gaps, |nodes, gaps| {
            self.law.evaluate(first + nodes.start, gaps, values.part(nodes));
        });
        let of_grid = AdhesionLaw::<T>::hints(&self.law).of_grid;
        values.each(|order, values| {
            for (value, &share) in values.iter_mut().zip(self.shares_from(first)) {
                *value *= T::lit(match order {
                    1 if of_grid => share.sqrt(),
                    2 if of_grid => 1.0,
                    _ => share,
                });
            }
        });
    }
    fn contact_shares(&self, first: usize, gaps: &[T], shares: &mut [T]) {
        self.each_piece(first, gaps, |nodes, gaps| {
            self.law.contact_shares(first + nodes.start, gaps, &mut shares[nodes]);
        });
    }
    fn on_nodes(&self, compliance: T) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let Self { largest, repels, .. } = *self;
        let law = self.law.on_nodes(compliance)?;
        Some(Arc::new(Varying { law, shares: self.shares.clone(), largest, repels }))
    }
    fn adapted(&self, to: Discretisation<T>) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let Self { largest, repels, .. } = *self;
        Some(match to {
            Discretisation::Coarse(nx, ny) => {
                let (rows, columns) = self.shares.dim();
                let coarse = (rows.div_ceil(nx), columns.div_ceil(ny));
                let shares = Field::from_fn(coarse, |(ix, iy)| self.shares[[ix * nx, iy * ny]]);
                Arc::new(Varying { law: self.law.clone(), shares: Arc::new(shares), largest, repels })
            }
            Discretisation::Fine(nx, ny) => {
                let (rows, columns) = self.shares.dim();
                let shares = Field::from_fn((rows * nx, columns * ny), |(ix, iy)| self.shares[[ix / nx, iy / ny]]);
                Arc::new(Varying { law: self.law.clone(), shares: Arc::new(shares), largest, repels })
            }
            Discretisation::Smooth(compliance) => {
                // where the law is strongest its jumps are the largest
                let law = self.law.adapted(Discretisation::Smooth(compliance * T::lit(largest)))?;
                Arc::new(Varying { law, shares: self.shares.clone(), largest, repels })
            }
        })
    }
}
