//! The contact problem: surface, elastic operator and adhesion law, and the load control.

use ndarray::Array2;

use crate::adhesion::{AdhesionLaw, Discretisation};
use crate::constraint::Wall;
use crate::elastic::{self, Boundary, ElasticOperator};
use crate::error::{Error, Result};
use crate::field::{all_finite_in, flat};
use crate::grid::Grid;
use crate::real::Real;
use crate::surface::Surface;
use crate::vector::range;

mod window;

pub(crate) use window::Window;

/// The compliance with which the jumps of a law are smoothed, in Δx/E*. A node alone has 1.1, the nodes along an
/// edge some 3 together.
const SMOOTHING: f64 = 5.0;

/// The control: what is held fixed while the energy is minimised.
///
/// | control | periodic | free | what follows |
/// |---|---|---|---|
/// | [`MeanGap`](Self::MeanGap) | yes | no | the pressure |
/// | [`MeanPressure`](Self::MeanPressure), [`Force`](Self::Force) | yes | yes | mean gap and approach |
/// | [`Approach`](Self::Approach) | no | yes | the force |
/// | [`Spring`](Self::Spring) | yes | yes | force and position |
///
/// The [`Boundary`] is that of the operator. A control that it does not have is refused, and so are mean gap and spring
/// for a periodic surface with [absent nodes](Surface::with_absent), where the mean gap over the others is not what the
/// load works on.
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
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Control {
    /// The mean gap ḡ ≥ 0 is given; the external pressure follows.
    MeanGap(f64),
    /// The mean external pressure p̄ is given, the force over the nominal area Lx·Ly, compression positive; the mean
    /// gap follows.
    MeanPressure(f64),
    /// The normal force F = p̄·Lx·Ly is given, compression positive.
    #[cfg_attr(feature = "serde", serde(rename = "normal-force"))]
    Force(f64),
    /// The approach δ is given: how far the bodies have moved towards each other since they would first touch
    /// undeformed. Negative before that.
    Approach(f64),
    /// A spring in series, as the stiffness of a machine or of a cantilever, is held at its far end.
    ///
    /// With a free boundary F = k (rest − δ); in a periodic cell, where bodies have no approach, F = k (ḡ − rest).
    Spring {
        /// The stiffness k, force per length.
        stiffness: f64,
        /// The approach δ at which the spring is relaxed; in a periodic cell the mean gap.
        rest: f64,
    },
}

impl Control {
    /// The name that the tool and `report.json` use: `"mean-gap"`, `"mean-pressure"`, `"normal-force"`, `"approach"` or
    /// `"spring"`.
    pub fn name(self) -> &'static str {
        match self {
            Self::MeanGap(_) => "mean-gap",
            Self::MeanPressure(_) => "mean-pressure",
            Self::Force(_) => "normal-force",
            Self::Approach(_) => "approach",
            Self::Spring { .. } => "spring",
        }
    }

    /// The value that is held: a length, pressure or force; of a spring its rest.
    pub fn value(self) -> f64 {
        match self {
            Self::MeanGap(value) | Self::MeanPressure(value) | Self::Force(value) | Self::Approach(value) => value,
            Self::Spring { rest, .. } => rest,
        }
    }
}

/// The control on the operator's grid: what its mean gap m, over all nodes, is held by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Load {
    /// m itself
    Gap(f64),
    /// the mean pressure on the operator's grid
    Pressure(f64),
    /// the mean pressure `stiffness`·(m − `rest`) on the operator's grid
    Spring { stiffness: f64, rest: f64 },
}

impl Load {
    /// The mean pressure at a mean gap; zero where that is given.
    pub(crate) fn pressure_at(self, mean_gap: f64) -> f64 {
        match self {
            Self::Gap(_) => 0.0,
            Self::Pressure(pressure) => pressure,
            Self::Spring { stiffness, rest } => stiffness * (mean_gap - rest),
        }
    }

    /// The load on the wall alone, of gaps that are counted from the equilibrium separation: nothing would hold a
    /// tension.
    pub(crate) fn of_wall(self, separation: f64) -> Self {
        match self {
            Self::Gap(gap) => Self::Gap((gap - separation).max(0.0)),
            Self::Pressure(pressure) => Self::Pressure(pressure.max(0.0)),
            Self::Spring { stiffness, rest } => Self::Spring { stiffness, rest: rest - separation },
        }
    }

    /// The energy of the load over its pressure times the mean gap from its rest.
    pub(crate) fn share(self) -> f64 {
        if let Self::Spring { .. } = self { 0.5 } else { 1.0 }
    }

    /// The stiffness of the mean gap, zero without a spring.
    pub(crate) fn stiffness(self) -> f64 {
        if let Self::Spring { stiffness, .. } = self { stiffness } else { 0.0 }
    }

    /// The mean gap at which a spring is relaxed, zero without one.
    pub(crate) fn rest(self) -> f64 {
        if let Self::Spring { rest, .. } = self { rest } else { 0.0 }
    }
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
    /// where the surface faces the body; nothing if that is everywhere
    pub(crate) window: Option<Window>,
    pub(crate) boundary: Boundary,
    /// the nominal area of the surface
    pub(crate) area: f64,
    /// the area of the operator's grid over it
    pub(crate) padding: f64,
}

impl<T: Real> PressedFlat<T> {
    /// Presses the surface flat against the body of the operator, if that and the law suit it.
    fn of(surface: &Surface, operator: &mut dyn ElasticOperator<T>, law: &dyn AdhesionLaw<T>) -> Result<Self> {
        let abilities = operator.abilities();
        let (boundary, slabs) = (abilities.boundary, abilities.slabs);
        let (grid, expected) = match boundary {
            Boundary::Periodic => (surface.grid(), *operator.grid()),
            Boundary::Free { window, .. } => (surface.grid(), window),
        };
        Error::shape("surface", grid.shape(), expected.shape())?;
        let (slab, one) =
            (operator.grid().slab(), "surface and operator have to be on one grid: make both on the shared one");
        if grid.is_shared() != slab.is_shared() {
            return Err(Error::Shared { what: "contact", reason: one });
        }
        if !slabs {
            slab.alone("elastic operator")?;
        }
        if let Some(shape) = law.hints().shape {
            Error::shape("adhesion law that varies over the surface", shape, grid.shape())?;
        }
        let ((nx, ny), whole) = (expected.shape(), operator.grid().shape());
        Error::shape("grid of the operator", whole, (whole.0.max(nx), whole.1.max(ny)))?;
        if boundary != Boundary::Periodic {
            Error::positive("mean compliance of the half-space", boundary.mean_compliance())?;
        }
        if grid.lengths() != expected.lengths() {
            let (name, value) = match grid.lengths() {
                (lx, _) if lx != expected.lengths().0 => ("side length Lx of the surface", lx),
                (_, ly) => ("side length Ly of the surface", ly),
            };
            return Err(Error::Value { name, value, requirement: "the same as of the elastic operator's grid" });
        }
        let at_zero = [("adhesive energy", law.energy(T::zero())), ("adhesive traction", law.traction(T::zero()))];
        let bounded = law.hints().rest.is_none_or(|rest| rest <= T::zero());
        if let Some((function, value)) = at_zero.into_iter().find(|(_, value)| bounded && !value.is_finite()) {
            return Err(Error::Law { function, gap: 0.0, value: value.widen(), expected: None });
        }
        // gap, pressure and K⁻¹h, and in f32 the other fields of a solve
        slab.afford("a solve", 3 * size_of::<T>() + 16)?;
        let window = Window::new(surface, operator.grid());
        let extended = window.as_ref().map(|window| window.extend(surface.heights().view()));
        let padded;
        let whole = match extended {
            Some(heights) => {
                padded = Surface::new(*operator.grid(), heights)?;
                &padded
            }
            None => surface,
        };
        let [datum, above] = whole.datum_and_mean();
        let mean = datum + above;
        let rms_height = whole.rms_about(mean);
        // where nothing faces the body there is no height: those that stand there do not exceed the others
        let (low, high) = surface.grid().extremes(range(flat(surface.heights())));
        let height_span = high - low;
        // a mean beyond the heights' own size is rounded more than the peak above it may be
        let peak = if mean.abs() > height_span { (high - datum) - above } else { high - mean };
        let mut pressure = Array2::zeros(whole.grid().field_shape());
        // a large datum would drown the heights in its rounding; a small one is not worth a copy
        let centred = (mean.abs() > rms_height).then(|| whole.heights().mapv(|h| h - mean));
        let heights = centred.as_ref().unwrap_or(whole.heights()).view();
        let surface_work = elastic::surface_pressure(operator, heights, pressure.view_mut())?.max(0.0);
        drop(centred);
        let mean_square = operator.grid().mean(pressure.view(), |p: T| p.widen().powi(2));
        // squares may be beyond the range of finite pressures
        if !mean_square.is_finite() {
            all_finite_in(slab, "pressure K⁻¹h of the surface pressed flat", pressure.view())?;
        }
        let stiffness = mean_square.sqrt() / rms_height;
        let (lx, ly) = grid.lengths();
        Ok(Self {
            pressure,
            work: surface_work,
            rms_height,
            stiffness,
            peak,
            height_span,
            window,
            boundary,
            area: lx * ly,
            padding: whole.grid().nodes() as f64 / grid.nodes() as f64,
        })
    }

    /// A control on the operator's grid; refused if the problem does not have it. A mean gap may only be negative
    /// without a wall.
    pub(crate) fn load(&self, control: Control, wall: Wall<'_, T>) -> Result<Load> {
        let refused = |reason| Err(Error::Control { control: control.name(), reason });
        let name = match control {
            Control::MeanGap(_) => "mean gap",
            Control::MeanPressure(_) => "mean pressure",
            Control::Force(_) => "normal force",
            Control::Approach(_) => "approach",
            Control::Spring { .. } => "rest of the spring",
        };
        let held = || Error::finite(name, control.value());
        let (free, absent) = (self.boundary != Boundary::Periodic, self.window.is_some());
        let on_grid = |pressure: f64| pressure / self.padding;
        let load = match control {
            Control::MeanGap(_) if free => {
                return refused("a free half-space has no mean gap to be held: give a force, an approach or a spring");
            }
            Control::MeanGap(_) | Control::Spring { .. } if absent && !free => {
                return refused(
                    "the mean gap of a periodic surface with absent nodes is not what the load works on: give a \
                     pressure or a force",
                );
            }
            Control::Approach(_) if !free => {
                return refused(
                    "bodies in a periodic cell have no approach: give a mean gap, or take a free half-space",
                );
            }
            Control::MeanGap(_) if matches!(wall, Wall::None) => Load::Gap(held()?),
            Control::MeanGap(gap) => Load::Gap(Error::non_negative(name, gap)?),
            Control::MeanPressure(_) => Load::Pressure(on_grid(held()?)),
            Control::Force(_) => Load::Pressure(on_grid(held()? / self.area)),
            Control::Approach(_) => {
                let rest = self.peak - held()?;
                Load::Spring { stiffness: self.boundary.mean_compliance().recip(), rest }
            }
            Control::Spring { stiffness, rest } => {
                Error::positive("stiffness of the spring", stiffness)?;
                held()?;
                let compliance = self.padding * self.area / stiffness + self.boundary.mean_compliance();
                Load::Spring { stiffness: compliance.recip(), rest: if free { self.peak - rest } else { rest } }
            }
        };
        let values = match load {
            Load::Gap(value) | Load::Pressure(value) => [value, 0.0],
            Load::Spring { stiffness, rest } => [stiffness, rest],
        };
        if let Some(&value) = values.iter().find(|&&value| !T::lit(value).is_finite()) {
            let requirement = "finite in the precision of the fields";
            return Err(Error::Value { name, value, requirement });
        }
        Ok(load)
    }

    /// The approach of the bodies at a mean gap and a mean pressure on the operator's grid; nothing in a periodic cell.
    pub(crate) fn approach(&self, mean_gap: f64, pressure: f64) -> Option<f64> {
        let Boundary::Free { mean_compliance, .. } = self.boundary else { return None };
        Some(self.peak - mean_gap + mean_compliance * pressure)
    }
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
    law.adapted(Discretisation::Smooth(T::lit(compliance)))
}

impl<T: Real, O: ElasticOperator<T>, L: AdhesionLaw<T>> Problem<T, O, L> {
    /// The problem of pressing `surface` against the elastic body of `operator`. Takes one operator application.
    ///
    /// # Errors
    /// [`Error::Shape`] or [`Error::Value`] if the grids differ; [`Error::Law`] if the law is not finite at zero gap;
    /// [`Error::NotFinite`] if K⁻¹h leaves the range of T; [`Error::Shared`] where several processes share the grid and
    /// the operator does not take slabs, or only one of surface and operator is shared; [`Error::Memory`] if a solve
    /// takes more memory than there is.
    pub fn new(surface: &Surface, mut operator: O, law: L) -> Result<Self> {
        let flat = PressedFlat::of(surface, &mut operator, &law)?;
        Ok(Self { operator, law, flat })
    }

    /// The grid of the surface, and of the fields of a solution.
    pub fn grid(&self) -> &Grid {
        self.flat.window.as_ref().map_or(self.operator.grid(), Window::grid)
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
    let hints = law.hints();
    let (w, range) = (hints.work_of_adhesion.widen(), hints.range.widen());
    if hints.zero || w <= 0.0 || range <= 0.0 {
        return 0.0;
    }
    (w * grid.largest_spacing() / modulus).sqrt() / range
}
