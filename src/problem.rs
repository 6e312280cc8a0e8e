//! The contact problem: surface, elastic operator and adhesion law, and the load control.

use ndarray::Array2;

use crate::adhesion::AdhesionLaw;
use crate::elastic::ElasticOperator;
use crate::error::{Error, Result};
use crate::field;
use crate::grid::Grid;
use crate::real::Real;
use crate::surface::Surface;

/// The compliance with which the jumps of a law are smoothed, in Δx/E*. A node alone has 1.1, the nodes along an
/// edge some 3 together.
const SMOOTHING: f64 = 5.0;

/// The control: the mean gap or the mean pressure that is held fixed while the energy is minimised.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(32, 1.0)?;
/// let surface = Surface::wave_2d(grid, 0.02, 1)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let by_gap = Solver::default().solve(&mut problem, Control::MeanGap(0.01))?.report;
/// let by_pressure = Solver::default().solve(&mut problem, Control::MeanPressure(by_gap.mean_pressure))?.report;
/// assert!((by_pressure.mean_gap / 0.01 - 1.0).abs() < 1e-5); // the same state, either way
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// The mean gap ḡ ≥ 0 is given; the external pressure follows.
    MeanGap(f64),
    /// The mean external pressure p̄ is given, compression positive; the mean gap follows.
    MeanPressure(f64),
}

/// A contact problem: a rough surface, an elastic operator and an adhesion law.
///
/// The surface enters only through the pressure K⁻¹h that would press it flat, which is computed here, once, in
/// `f64`; it may be dropped afterwards. A problem can be solved many times, under any [`Control`].
///
/// Memory per node: one scalar, beside those of the operator. [`Problem::new`] briefly needs more, but less than a
/// solve: for an operator of this crate one `f64` for the spectrum of the heights, and another where their mean
/// exceeds their rms value.
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
#[derive(Clone, Debug)]
pub struct Problem<T, O, L> {
    pub(crate) operator: O,
    pub(crate) law: L,
    pub(crate) flat: PressedFlat<T>,
}

/// The surface pressed flat: the pressure K⁻¹h and the figures of h that a solve needs.
#[derive(Clone, Debug)]
pub(crate) struct PressedFlat<T> {
    /// the pressure K⁻¹h
    pub(crate) pressure: Array2<T>,
    /// the mean of h·K⁻¹h
    pub(crate) work: f64,
    pub(crate) rms_height: f64,
    /// the stiffness that the surface meets as it is pressed flat: the rms pressure over the rms height
    pub(crate) stiffness: f64,
    /// the highest height less the mean
    pub(crate) peak: f64,
    /// the highest height less the lowest
    pub(crate) height_span: f64,
}

/// The parts of a problem, for a solve.
pub(crate) struct Parts<'a, T> {
    pub(crate) operator: &'a mut dyn ElasticOperator<T>,
    pub(crate) law: &'a dyn AdhesionLaw<T>,
    pub(crate) flat: &'a PressedFlat<T>,
}

/// A law with its jumps smoothed to the resolution of an operator's grid; `None` if it has no jumps.
pub(crate) fn smoothed_law<'a, T: Real>(
    operator: &dyn ElasticOperator<T>,
    law: &'a dyn AdhesionLaw<T>,
) -> Option<Box<dyn AdhesionLaw<T> + 'a>> {
    let compliance = SMOOTHING * operator.grid().largest_spacing() / operator.modulus();
    law.smoothed(T::lit(compliance))
}

impl<T: Real, O: ElasticOperator<T>, L: AdhesionLaw<T>> Problem<T, O, L> {
    /// The problem of pressing `surface` against the elastic body of `operator`. Takes one operator application.
    ///
    /// # Errors
    /// [`Error::Shape`] or [`Error::Value`] if the grids differ; [`Error::Law`] if the law is not finite at zero gap;
    /// [`Error::NotFinite`] if K⁻¹h leaves the range of T.
    pub fn new(surface: &Surface, mut operator: O, law: L) -> Result<Self> {
        let (grid, expected) = (surface.grid(), operator.grid());
        Error::shape("surface", grid.shape(), expected.shape())?;
        if grid.lengths() != expected.lengths() {
            let (name, value) = match grid.lengths() {
                (lx, _) if lx != expected.lengths().0 => ("side length Lx of the surface", lx),
                (_, ly) => ("side length Ly of the surface", ly),
            };
            return Err(Error::Value { name, value, requirement: "the same as of the elastic operator's grid" });
        }
        let at_zero = [("adhesive energy", law.energy(T::zero())), ("adhesive traction", law.traction(T::zero()))];
        if let Some((function, value)) = at_zero.into_iter().find(|(_, value)| !value.is_finite()) {
            return Err(Error::Law { function, gap: 0.0, value: value.widen(), expected: None });
        }
        let (mean, rms_height) = (surface.mean(), surface.rms_height());
        let (low, high) = surface.heights().iter().fold((mean, mean), |(low, high), &h| (low.min(h), high.max(h)));
        let (peak, height_span) = (high - mean, high - low);
        let mut surface_pressure = Array2::zeros(grid.shape());
        // a large datum would drown the heights in its rounding; a small one is not worth a copy
        let centred = (mean.abs() > rms_height).then(|| surface.heights().mapv(|h| h - mean));
        let heights = centred.as_ref().unwrap_or(surface.heights()).view();
        let surface_work = operator.surface_pressure(heights, surface_pressure.view_mut())?.max(0.0);
        drop(centred);
        Error::all_finite("pressure K⁻¹h of the surface pressed flat", surface_pressure.view())?;
        let stiffness = field::mean(surface_pressure.view(), |p: T| p.widen().powi(2)).sqrt() / rms_height;
        let flat =
            PressedFlat { pressure: surface_pressure, work: surface_work, rms_height, stiffness, peak, height_span };
        Ok(Self { operator, law, flat })
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        self.operator.grid()
    }

    /// The elastic operator.
    pub fn operator(&self) -> &O {
        &self.operator
    }

    /// The adhesion law.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// The operator and the law, for another problem on the same grid.
    ///
    /// ```
    /// use asperity::{Control, Exponential, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
    /// let grid = Grid::square(64, 1.0)?;
    /// let surface = Surface::wave_2d(grid, 0.02, 1)?;
    /// let mut bare = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
    /// let contact = Solver::default().solve(&mut bare, Control::MeanGap(0.01))?.report.contact_nodes;
    /// let (half_space, _) = bare.into_parts();
    /// let mut sticky = Problem::new(&surface, half_space, Exponential::new(1e-5, 4e-3)?)?;
    /// assert!(Solver::default().solve(&mut sticky, Control::MeanGap(0.01))?.report.contact_nodes > contact);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn into_parts(self) -> (O, L) {
        (self.operator, self.law)
    }

    /// The parts of the problem, for a solve.
    pub(crate) fn parts(&mut self) -> Parts<'_, T> {
        Parts { operator: &mut self.operator, law: &self.law, flat: &self.flat }
    }

    /// The measure of how the grid resolves the adhesive zone, μ_ρ = √(wΔx/E*)/ρ, with the larger of Δx and Δy.
    ///
    /// Below about 0.5 the zone is resolved. Above, contact edges are pinned to the grid, there are many equilibria,
    /// and which one is found depends on the start. Zero without adhesion.
    pub fn mu_rho(&self) -> f64 {
        mu_rho(&self.law, self.grid(), self.operator.modulus())
    }
}

/// The measure of [`Problem::mu_rho`], for a contact modulus.
pub(crate) fn mu_rho<T: Real>(law: &dyn AdhesionLaw<T>, grid: &Grid, modulus: f64) -> f64 {
    let (w, range) = (law.work_of_adhesion().widen(), law.range().widen());
    if law.is_zero() || w <= 0.0 || range <= 0.0 {
        return 0.0;
    }
    (w * grid.largest_spacing() / modulus).sqrt() / range
}
