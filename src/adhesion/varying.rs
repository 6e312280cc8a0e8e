//! A law whose work of adhesion varies over the surface.

use std::sync::Arc;

use ndarray::{Array2, ArrayView2};

use super::AdhesionLaw;
use crate::error::{Error, Result};
use crate::field::{all_finite_in, flat};
use crate::grid::Grid;
use crate::real::Real;
use crate::slab::Slab;

/// A law whose work of adhesion differs from node to node, w(x, y): energy, traction and slope in proportion to it.
///
/// Patterned, contaminated or partly wetted surfaces. The range is that of the law everywhere. What asks for one gap
/// alone, such as the resolution measure μ_ρ, gets the answer of the strongest node, [`Varying::strongest`]. Memory per
/// node: one `f64`, which clones share.
///
/// ```
/// use asperity::adhesion::Varying;
/// use asperity::{Control, Exponential, Grid, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let surface = Surface::wave_2d(grid, 0.01, 2)?;
/// // no adhesion on the left half
/// let work = grid.sample(|x, _| if x < 0.0 { 0.0 } else { 1e-5 });
/// let law = Varying::new(Exponential::new(1e-5, 2e-3)?, work.view())?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, law)?;
/// let contact = Solver::default().solve(&mut problem, Control::MeanPressure(1e-3))?.contact_map();
/// let nodes = |half: usize| contact.rows().into_iter().skip(32 * half).take(32).flatten().filter(|&&c| c).count();
/// assert!(nodes(1) > nodes(0));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Varying<L> {
    law: L,
    /// of the grid of the map
    slab: Slab,
    /// the work of adhesion at each node of the slab over that of the law
    shares: Arc<Array2<f64>>,
    largest: f64,
    strongest: (usize, usize),
    /// whether the work of adhesion is positive at every node
    repels: bool,
}

impl<L: AdhesionLaw<f64>> Varying<L> {
    /// The law with these works of adhesion at the nodes, shape (Nx, Ny), in place of its own.
    ///
    /// Where several processes share the grid of the surface, each has all of these: [`Varying::on`] takes less memory.
    ///
    /// # Errors
    /// [`Error::NotFinite`], or [`Error::Value`] if a work of adhesion is negative, if none is positive, or if the law
    /// has none that it could be scaled from, or varies already.
    pub fn new(law: L, works: ArrayView2<'_, f64>) -> Result<Self> {
        Self::in_slab(law, works, Slab::whole(works.dim()))
    }

    /// As [`Varying::new`], on a grid that several processes may share: the works of adhesion are those of the rows that
    /// this one holds, [`Grid::rows`].
    ///
    /// ```
    /// use asperity::adhesion::Varying;
    /// use asperity::{Exponential, Grid};
    /// let grid = Grid::square(64, 1.0)?; // or a shared one
    /// let work = grid.sample(|x, y| 1e-5 * (1.0 + (x - y).powi(2)));
    /// let law = Varying::on(&grid, Exponential::new(1e-5, 2e-3)?, work.view())?;
    /// assert_eq!(law.strongest(), (0, 63));
    /// # Ok::<(), asperity::Error>(())
    /// ```
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
        let own = Error::positive("work of adhesion of the law that varies", law.work_of_adhesion())?;
        if law.shape().is_some() {
            let requirement = "one: give the law that the varying one is made of";
            return Err(Error::Value { name: "number of works of adhesion at a node", value: 2.0, requirement });
        }
        if slab.nodes() == 0 {
            return Err(Error::Value { name: "number of nodes", value: 0.0, requirement: "positive" });
        }
        let most = slab.most(works.iter().fold(0.0, |most: f64, &work| most.max(work)));
        Error::positive("largest work of adhesion", most)?;
        let (first, ny) = (slab.first_node(), slab.shape().1);
        let own_strongest = works.indexed_iter().find(|&(_, &work)| work == most);
        let node = own_strongest.map_or(f64::INFINITY, |((ix, iy), _)| (first + ix * ny + iy) as f64);
        let node = slab.least(node) as usize;
        let shares = Arc::new(works.mapv(|work| work / own).as_standard_layout().into_owned());
        let repels = !slab.has(works.iter().any(|&work| work <= 0.0));
        Ok(Self { law, slab, shares, largest: most / own, strongest: (node / ny, node % ny), repels })
    }
}

impl<L> Varying<L> {
    /// The node with the largest work of adhesion, (ix, iy); the first of several.
    pub fn strongest(&self) -> (usize, usize) {
        self.strongest
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

impl<T: Real, L: AdhesionLaw<T>> AdhesionLaw<T> for Varying<L> {
    fn energy(&self, gap: T) -> T {
        T::lit(self.largest) * self.law.energy(gap)
    }
    fn traction(&self, gap: T) -> T {
        T::lit(self.largest) * self.law.traction(gap)
    }
    fn slope(&self, gap: T) -> T {
        T::lit(self.largest) * self.law.slope(gap)
    }
    fn work_of_adhesion(&self) -> T {
        T::lit(self.largest) * self.law.work_of_adhesion()
    }
    fn range(&self) -> T {
        self.law.range()
    }
    fn is_concave(&self) -> bool {
        self.law.is_concave()
    }
    fn rest(&self) -> Option<T> {
        // where there is no work of adhesion nothing repels either
        if self.repels { self.law.rest() } else { None }
    }
    fn is_zero(&self) -> bool {
        self.law.is_zero()
    }
    fn shape(&self) -> Option<(usize, usize)> {
        Some(self.slab.shape())
    }
    fn in_rows_of(&self, grid: &Grid) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        if !self.slab.is_shared() || self.slab == grid.slab() {
            return None;
        }
        let shares = Arc::new(self.slab.moved(self.shares.view().into(), &grid.slab()).into_owned());
        let Self { largest, strongest, repels, .. } = *self;
        let law: &dyn AdhesionLaw<T> = &self.law;
        Some(Box::new(Varying { law, slab: grid.slab(), shares, largest, strongest, repels }))
    }
    fn coarsened(&self, (nx, ny): (usize, usize)) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        let (rows, columns) = self.slab.shape();
        let slab = self.slab.of((rows.div_ceil(nx), columns.div_ceil(ny)));
        let needed = |rank| slab.rows_of(rank).map(move |row| row * nx);
        let fetched = self.slab.is_shared().then(|| self.slab.fetch(self.shares.view(), needed));
        let (every, from) = fetched.as_ref().map_or((nx, &*self.shares), |fetched| (1, fetched));
        let shares = Arc::new(Array2::from_shape_fn(slab.held(), |(ix, iy)| from[[ix * every, iy * ny]]));
        let Self { largest, strongest: (ix, iy), repels, .. } = *self;
        let law: &dyn AdhesionLaw<T> = &self.law;
        Some(Box::new(Varying { law, slab, shares, largest, strongest: (ix / nx, iy / ny), repels }))
    }
    fn smoothed(&self, compliance: T) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        // where the law is strongest its jumps are the largest
        let law = self.law.smoothed(compliance * T::lit(self.largest))?;
        let Self { slab, largest, strongest, repels, .. } = *self;
        Some(Box::new(Varying { law, slab, shares: self.shares.clone(), largest, strongest, repels }))
    }
    fn energies(&self, first: usize, gaps: &[T], energies: &mut [T]) {
        self.law.energies(first, gaps, energies);
        self.scale(first, energies);
    }
    fn tractions(&self, first: usize, gaps: &[T], tractions: &mut [T]) {
        self.law.tractions(first, gaps, tractions);
        self.scale(first, tractions);
    }
    fn slopes(&self, first: usize, gaps: &[T], slopes: &mut [T]) {
        self.law.slopes(first, gaps, slopes);
        self.scale(first, slopes);
    }
    fn energies_and_tractions(&self, first: usize, gaps: &[T], energies: &mut [T], tractions: &mut [T]) {
        self.law.energies_and_tractions(first, gaps, energies, tractions);
        self.scale(first, energies);
        self.scale(first, tractions);
    }
    fn tractions_and_slopes(&self, first: usize, gaps: &[T], tractions: &mut [T], slopes: &mut [T]) {
        self.law.tractions_and_slopes(first, gaps, tractions, slopes);
        self.scale(first, tractions);
        self.scale(first, slopes);
    }
}
