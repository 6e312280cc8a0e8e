//! A law whose work of adhesion varies over the surface.

use std::sync::Arc;

use ndarray::{Array2, ArrayView2};

use super::AdhesionLaw;
use crate::error::{Error, Result};
use crate::field::flat;
use crate::real::Real;

/// A law whose work of adhesion differs from node to node, w(x, y): energy, traction and slope in proportion to it.
///
/// Patterned, contaminated or partly wetted surfaces. The range is that of the law everywhere. What asks for one gap
/// alone, such as the resolution measure μ_ρ, gets the answer of the strongest node, [`Varying::strongest`]. Memory per
/// node: one `f64`, which clones share.
///
/// ```
/// use asperity::{Control, Exponential, Grid, Problem, Solver, Surface, Varying, Westergaard};
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
    /// the work of adhesion at each node over that of the law
    shares: Arc<Array2<f64>>,
    largest: f64,
    strongest: (usize, usize),
    /// whether the work of adhesion is positive at every node
    repels: bool,
}

impl<L: AdhesionLaw<f64>> Varying<L> {
    /// The law with these works of adhesion at the nodes, shape (Nx, Ny), in place of its own.
    ///
    /// # Errors
    /// [`Error::NotFinite`], or [`Error::Value`] if a work of adhesion is negative, if none is positive, or if the law
    /// has none that it could be scaled from.
    pub fn new(law: L, works: ArrayView2<'_, f64>) -> Result<Self> {
        Error::all_finite("work of adhesion", works)?;
        if let Some(&value) = works.iter().find(|&&work| work < 0.0) {
            return Err(Error::Value {
                name: "work of adhesion",
                value,
                requirement: "zero or positive at every node",
            });
        }
        let own = Error::positive("work of adhesion of the law that varies", law.work_of_adhesion())?;
        let (strongest, &most) = works
            .indexed_iter()
            .reduce(|most, next| if next.1 > most.1 { next } else { most })
            .ok_or(Error::Value { name: "number of nodes", value: 0.0, requirement: "positive" })?;
        Error::positive("largest work of adhesion", most)?;
        let shares = Arc::new(works.mapv(|work| work / own).as_standard_layout().into_owned());
        let repels = works.iter().all(|&work| work > 0.0);
        Ok(Self { law, shares, largest: most / own, strongest, repels })
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
        let shares = flat(&self.shares).get(first..).unwrap_or_default();
        values.iter_mut().zip(shares).for_each(|(value, &share)| *value *= T::lit(share));
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
    fn rest(&self) -> Option<T> {
        // where there is no work of adhesion nothing repels either
        if self.repels { self.law.rest() } else { None }
    }
    fn is_zero(&self) -> bool {
        self.law.is_zero()
    }
    fn shape(&self) -> Option<(usize, usize)> {
        Some(self.shares.dim())
    }
    fn coarsened(&self, (nx, ny): (usize, usize)) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        let (rows, columns) = self.shares.dim();
        let shape = (rows.div_ceil(nx), columns.div_ceil(ny));
        let shares = Arc::new(Array2::from_shape_fn(shape, |(ix, iy)| self.shares[[ix * nx, iy * ny]]));
        let Self { largest, strongest: (ix, iy), repels, .. } = *self;
        let law: &dyn AdhesionLaw<T> = &self.law;
        Some(Box::new(Varying { law, shares, largest, strongest: (ix / nx, iy / ny), repels }))
    }
    fn smoothed(&self, compliance: T) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        // where the law is strongest its jumps are the largest
        let law = self.law.smoothed(compliance * T::lit(self.largest))?;
        let Self { largest, strongest, repels, .. } = *self;
        Some(Box::new(Varying { law, shares: self.shares.clone(), largest, strongest, repels }))
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
    fn tractions_and_slopes(&self, first: usize, gaps: &[T], tractions: &mut [T], slopes: &mut [T]) {
        self.law.tractions_and_slopes(first, gaps, tractions, slopes);
        self.scale(first, tractions);
        self.scale(first, slopes);
    }
}
