//! The contact problem: surface, elastic operator and adhesion law, and the load control.

use std::fmt;
use std::sync::Arc;

use ndarray::{Array2, ArrayView2};

use crate::adhesion::{AdhesionLaw, Discretisation, SharedLaw, mu_rho, on_grid};
use crate::elastic::ElasticOperator;
use crate::error::Result;
use crate::field::Field;
use crate::grid::Grid;
use crate::real::{Real, once};
use crate::surface::Surface;

mod control;
mod facing;
mod flat;
mod window;
mod yielded;

pub(crate) use control::Load;
pub use control::{Control, Held};
pub(crate) use flat::PressedFlat;
use flat::check_law;
pub(crate) use window::Window;
pub(crate) use yielded::Yielded;

once! {
    /// The surface pressed flat against the body of an operator, if that and the law suit it.
    press_flat<'a, T>(
        surface: &'a Surface, operator: &'a mut dyn ElasticOperator<T>, law: &'a dyn AdhesionLaw<T>,
    ) -> Result<PressedFlat<T>> = [within] PressedFlat::of;
}

/// A contact problem: a rough surface, an elastic operator and an adhesion law.
///
/// A problem keeps the pressure K⁻¹h that would press the surface flat, not the heights. A problem can be solved many
/// times, under any [`Control`]. Memory per node: one scalar besides the operator's; [`Problem::new`] needs less than a
/// solve.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let surface = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let solution = Solver::default().solve(&mut problem, Control::MeanGap(0.0398))?;
/// assert_eq!(solution.report.contact_nodes, 61);
/// # Ok::<(), asperity::Error>(())
/// ```
pub struct Problem<T: Real> {
    pub(crate) operator: Box<dyn ElasticOperator<T>>,
    law: SharedLaw<T>,
    /// the law on the nodes of the operator, if it is another one there
    on_nodes: Option<Arc<dyn AdhesionLaw<T>>>,
    pub(crate) flat: PressedFlat<T>,
}

impl<T: Real> fmt::Debug for Problem<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { law, flat, .. } = self;
        f.debug_struct("Problem").field("law", law).field("flat", flat).finish_non_exhaustive()
    }
}

/// The parts of a problem, perhaps with another law for a solve.
pub struct ProblemMut<'a, T: Real> {
    pub(crate) operator: &'a mut dyn ElasticOperator<T>,
    pub(crate) law: &'a dyn AdhesionLaw<T>,
    /// the law of the problem, as it was given
    pub(crate) given: &'a SharedLaw<T>,
    pub(crate) flat: &'a PressedFlat<T>,
}

impl<T: Real> ProblemMut<'_, T> {
    /// The grid of the surface.
    pub(crate) fn grid(&self) -> &Grid {
        self.flat.grid(self.operator.grid())
    }
}

/// A law with its jumps smoothed to the resolution of an operator's grid; `None` if it has no jumps.
pub(crate) fn smoothed_law<T: Real>(
    operator: &dyn ElasticOperator<T>,
    law: &dyn AdhesionLaw<T>,
) -> Option<Arc<dyn AdhesionLaw<T>>> {
    let compliance = Discretisation::<T>::SMOOTHING * operator.grid().largest_spacing() / operator.modulus();
    law.adapted(Discretisation::Smooth(T::lit(compliance)))
}

impl<T: Real> Problem<T> {
    /// The problem of pressing `surface` against the elastic body of `operator`. Takes one operator application.
    ///
    /// # Errors
    /// [`Error::Shape`](crate::Error::Shape) or [`Error::Value`](crate::Error::Value) if the grids differ;
    /// [`Error::Contract`](crate::Error::Contract) if the law is not finite at zero gap;
    /// [`Error::NotFinite`](crate::Error::NotFinite) if K⁻¹h leaves the range of T;
    /// [`Error::Shared`](crate::Error::Shared) if only one of surface and operator is shared between processes, or the
    /// operator does not take slabs; [`Error::Memory`](crate::Error::Memory) if there is too little for a solve.
    pub fn new(
        surface: &Surface,
        operator: impl ElasticOperator<T> + 'static,
        law: impl AdhesionLaw<T> + 'static,
    ) -> Result<Self> {
        Self::of(surface, Box::new(operator), SharedLaw::new(law))
    }

    pub(crate) fn of(surface: &Surface, mut operator: Box<dyn ElasticOperator<T>>, law: SharedLaw<T>) -> Result<Self> {
        let on_nodes = on_grid(&*law, operator.grid(), operator.modulus());
        let flat = press_flat(surface, &mut *operator, on_nodes.as_deref().unwrap_or(&*law))?;
        Ok(Self { operator, law, on_nodes, flat })
    }

    /// Puts another law in the place of the adhesion law, without an operator application.
    ///
    /// # Errors
    /// [`Error::Contract`](crate::Error::Contract) if the law is not finite at zero gap;
    /// [`Error::Shape`](crate::Error::Shape) if it varies over another grid.
    pub fn set_law(&mut self, law: impl AdhesionLaw<T> + 'static) -> Result<()> {
        let law = SharedLaw::new(law);
        let on_nodes = on_grid(&*law, self.operator.grid(), self.operator.modulus());
        check_law(on_nodes.as_deref().unwrap_or(&*law), self.grid())?;
        (self.law, self.on_nodes) = (law, on_nodes);
        Ok(())
    }

    /// The grid of the surface, and of the fields of a solution.
    pub fn grid(&self) -> &Grid {
        self.flat.grid(self.operator.grid())
    }

    /// The elastic operator.
    pub fn operator(&self) -> &dyn ElasticOperator<T> {
        &*self.operator
    }

    /// The elastic operator, for another problem on the same grid.
    pub fn into_operator(self) -> Box<dyn ElasticOperator<T>> {
        self.operator
    }

    /// The adhesion law, as it was given.
    pub fn law(&self) -> &dyn AdhesionLaw<T> {
        &*self.law
    }

    /// The adhesion law of the energy that is minimised: on the nodes of the grid where the law has no range of its
    /// own, [`AdhesionLaw::on_nodes`], otherwise as it was given.
    pub fn law_on_grid(&self) -> &dyn AdhesionLaw<T> {
        self.on_nodes.as_deref().unwrap_or(&*self.law)
    }

    /// Whether the surfaces adhere.
    pub(crate) fn adheres(&self) -> bool {
        !self.law_on_grid().hints().zero
    }

    /// Lowers the surface, as it was made, by a plastic depth on its grid. With the depth of a
    /// [solution](crate::Solution::plastic_depth) at a [`Hardness`](crate::Hardness) the surface unloads elastically.
    /// Loads that are positions, and the approach, still refer to the surface as it was made.
    ///
    /// Takes one operator application, and keeps two fields.
    ///
    /// # Errors
    /// [`Error::Shape`](crate::Error::Shape), [`Error::NotFinite`](crate::Error::NotFinite) or
    /// [`Error::Value`](crate::Error::Value) of a depth that does not fit, is not finite, or is negative somewhere.
    ///
    /// ```
    /// use asperity::{Control, Grid, Hardness, NoAdhesion, Problem, Settings, Solver, Surface, Westergaard};
    /// let grid = Grid::square(64, 1.0)?;
    /// let sphere = Surface::paraboloid(grid, 2.0)?;
    /// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
    /// let mut solver = Solver { settings: Settings::default(), constraint: Hardness::new(0.02)? };
    /// let loaded = solver.solve(&mut problem, Control::MeanPressure(4e-4))?;
    /// problem.flatten(loaded.plastic_depth.as_ref().unwrap().view())?;
    /// let again = solver.solve(&mut problem, Control::MeanPressure(4e-4))?;
    /// let [before, after] = [loaded, again].map(|solution| solution.report.plastic.unwrap());
    /// assert!((after.energy / before.energy - 1.0).abs() < 1e-4); // nothing more has yielded
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn flatten(&mut self, depth: ArrayView2<'_, T>) -> Result<()> {
        let depth = self.flat.placed(&*self.operator, depth)?;
        self.flat.flatten(&mut *self.operator, depth)
    }

    /// The plastic depth by which the surface is lower than it was made, on its grid; none if it never was lowered.
    pub fn plastic_depth(&self) -> Option<Array2<T>> {
        let depth = self.yielded()?;
        Some(self.flat.crop(depth, T::zero()).into_owned())
    }

    /// As [`flatten`](Self::flatten), if the depth `stays`, with a gap of zero where the surface has yielded beyond its
    /// depth before. Returns by how much it is lower than before, on the operator's grid, as the gap is.
    pub(crate) fn lower(&mut self, depth: ArrayView2<'_, T>, stays: bool, gap: &mut Array2<T>) -> Result<Array2<T>> {
        let depth = self.flat.placed(&*self.operator, depth)?;
        let mut lowered = Array2::clone(&depth);
        self.flat.yielded.iter().for_each(|before| lowered -= &*before.depth);
        gap.zip_mut_with(&lowered, |gap, &lowered| *gap = if lowered > T::zero() { T::zero() } else { *gap });
        if stays {
            self.flat.flatten(&mut *self.operator, depth)?;
        } else {
            lowered.fill(T::zero());
        }
        Ok(lowered)
    }

    /// The plastic depth on the operator's grid.
    pub(crate) fn yielded(&self) -> Option<&Array2<T>> {
        self.flat.yielded.as_ref().map(|yielded| &*yielded.depth)
    }

    /// Lowers the surface to the plastic depth of a strategy, if it has one, on the operator's grid.
    pub(crate) fn yield_to(&mut self, depth: Option<&Array2<T>>) -> Result<()> {
        match depth {
            Some(depth) if self.operator.grid().any(self.yielded() != Some(depth)) => {
                self.flat.flatten(&mut *self.operator, Field::of(depth))
            }
            _ => Ok(()),
        }
    }

    pub(crate) fn parts(&mut self) -> ProblemMut<'_, T> {
        let law = self.on_nodes.as_deref().unwrap_or(&*self.law);
        ProblemMut { operator: &mut *self.operator, law, given: &self.law, flat: &self.flat }
    }

    /// The measure μ_ρ of how the grid resolves the adhesive zone: [`mu_rho`].
    pub fn mu_rho(&self) -> f64 {
        mu_rho(&*self.law, self.grid(), self.operator.modulus())
    }
}
