//! The surface pressed flat, and the loads that a problem has.

use super::{Control, Held, Load, Window, Yielded};
use crate::adhesion::AdhesionLaw;
use crate::constraint::Wall;
use crate::elastic::{Boundary, ElasticOperator};
use crate::error::{Error, Result};
use crate::field::{Field, ordered};
use crate::grid::Grid;
use crate::real::Real;
use crate::surface::Surface;
use crate::vector::range;

/// The roundings of the rms height within which surfaces that just touch are apart, in units of ε.
const TOUCH: f64 = 16.0;

/// The surface pressed flat: the pressure K⁻¹h and the figures of h that a solve needs.
#[derive(Clone, Debug)]
pub struct PressedFlat<T> {
    pub(crate) pressure: Field<T>,
    /// the mean of h·K⁻¹h
    pub(crate) work: f64,
    pub(crate) rms_height: f64,
    /// the stiffness that the surface meets as it is pressed flat: the rms pressure over the rms height
    pub(crate) stiffness: f64,
    pub(crate) peak: f64,
    pub(crate) height_span: f64,
    /// where the surface faces the body; none if everywhere
    pub(crate) window: Option<Window>,
    pub(crate) boundary: Boundary,
    /// what the approach of a periodic body has besides the waves, over the mean pressure
    pub(crate) far_compliance: Option<f64>,
    /// the nominal area of the surface
    pub(crate) area: f64,
    /// the area of the operator's grid over it
    pub(crate) padding: f64,
    /// how far the surface has yielded, if it has; rms height, stiffness and span of the heights stay those before
    pub(crate) yielded: Option<Yielded<T>>,
}

/// Refuses a law that varies over another grid, or is not finite where the surfaces touch.
pub(super) fn check_law<T: Real>(law: &dyn AdhesionLaw<T>, grid: &Grid) -> Result<()> {
    let hints = law.hints();
    if let Some(shape) = hints.shape {
        Error::shape("adhesion law that varies over the surface", shape, grid.shape())?;
    }
    let at_zero = [("adhesive energy", law.energy(T::zero())), ("adhesive traction", law.traction(T::zero()))];
    let bounded = hints.rest.is_none_or(|rest| rest <= T::zero());
    match at_zero.into_iter().find(|(_, value)| bounded && !value.is_finite()) {
        Some((function, value)) => Err(Error::not_finite(function, 0.0, value.widen())),
        None => Ok(()),
    }
}

/// Refuses a surface, an operator and a law that are not on one grid.
fn check<T: Real>(surface: &Surface, operator: &dyn ElasticOperator<T>, law: &dyn AdhesionLaw<T>) -> Result<()> {
    let (boundary, grid) = (operator.boundary(), surface.grid());
    let expected = boundary.surface_grid(*operator.grid());
    Error::shape("surface", grid.shape(), expected.shape())?;
    if grid.is_shared() != operator.grid().is_shared() {
        let reason = "surface and operator have to be on one grid: make both on the shared one";
        return Err(Error::Shared { what: "contact", reason });
    }
    if !operator.takes_slabs() {
        operator.grid().refuse_shared("elastic operator")?;
    }
    check_law(law, grid)?;
    let ((nx, ny), whole) = (expected.shape(), operator.grid().shape());
    Error::shape("grid of the operator", whole, (whole.0.max(nx), whole.1.max(ny)))?;
    if !boundary.is_periodic() {
        Error::positive("mean compliance of the half-space", boundary.mean_compliance())?;
    }
    if grid.lengths() != expected.lengths() {
        let (name, value) = match grid.lengths() {
            (lx, _) if lx != expected.lengths().0 => ("side length Lx of the surface", lx),
            (_, ly) => ("side length Ly of the surface", ly),
        };
        return Err(Error::Value { name, value, requirement: "as on the grid of the elastic operator" });
    }
    Ok(())
}

/// The lowest and the highest height that faces the body.
fn extremes(surface: &Surface) -> (f64, f64) {
    let faces = |(&height, absent): (&f64, &bool)| (!absent).then_some(height);
    let (grid, heights) = (surface.grid(), surface.heights());
    let facing = surface.absent().map(|absent| heights.iter().zip(absent).filter_map(faces).collect());
    let (low, high) = range(&facing.unwrap_or_else(|| ordered(heights.view())));
    (grid.least(low), grid.greatest(high))
}

impl<T: Real> PressedFlat<T> {
    pub(crate) fn of(
        surface: &Surface,
        operator: &mut dyn ElasticOperator<T>,
        law: &dyn AdhesionLaw<T>,
    ) -> Result<Self> {
        check(surface, operator, law)?;
        let grid = surface.grid();
        // gap, pressure and K⁻¹h, and in f32 the other fields of a solve
        operator.grid().afford("a solve", 3 * size_of::<T>() + 16)?;
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
        let (low, high) = extremes(surface);
        let height_span = high - low;
        // a mean beyond the heights' own size is rounded more than the peak above it may be
        let peak = if mean.abs() > height_span { (high - datum) - above } else { high - mean };
        let mut pressure = Field::zeros(whole.grid().field_shape());
        // a large datum would drown the heights in its rounding; a small one is not worth a copy
        let centred = (mean.abs() > rms_height).then(|| whole.heights().mapv(|h| h - mean));
        let heights = centred.as_ref().unwrap_or(whole.heights()).view();
        let surface_work = operator.surface_pressure(heights, pressure.view_mut())?.max(0.0);
        drop(centred);
        let mean_square = operator.grid().mean(pressure.view(), |p: T| p.widen().powi(2));
        // squares may be beyond the range of finite pressures
        if !mean_square.is_finite() {
            operator.grid().finite("pressure K⁻¹h of the surface pressed flat", pressure.view())?;
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
            boundary: operator.boundary(),
            far_compliance: operator.far_compliance(),
            area: lx * ly,
            padding: whole.grid().nodes() as f64 / grid.nodes() as f64,
            yielded: None,
        })
    }

    /// The rms of K⁻¹h; zero for a flat surface, where the stiffness is no number.
    pub(crate) fn rms_pressure(&self) -> f64 {
        (self.stiffness * self.rms_height).max(0.0)
    }

    /// A control on the operator's grid, if the problem has it. A mean gap may only be negative without a wall.
    pub(crate) fn load(&self, mut control: Control, wall: Wall<'_, T>) -> Result<Load> {
        let refused = move |reason| Err(Error::Unsuited { what: control.name(), reason });
        let on_area = control.value_on(self.area);
        let (kind, name, &mut value) = control.quantity();
        let held = || Error::finite(name, value).map(|_| on_area);
        let (free, absent) = (!self.boundary.is_periodic(), !self.faces_all());
        let load = match kind {
            Held::MeanGap if free => {
                return refused("a free half-space has no mean gap to be held: give a force, an approach or a spring");
            }
            Held::MeanGap | Held::Spring(_) if absent && !free => {
                return refused(
                    "the mean gap of a periodic surface with absent nodes is not what the load works on: give a \
                     pressure or a force",
                );
            }
            Held::Approach if !free && (absent || self.far_compliance.is_none()) => {
                return refused(
                    "bodies in a periodic cell have no approach, but for a layer or a coating: give a mean gap, or take \
                     a free half-space",
                );
            }
            Held::MeanGap if !wall.keeps_apart() => Load::Gap(held()?),
            Held::MeanGap => Load::Gap(Error::non_negative(name, value)? + self.mean_depth()),
            Held::Load => Load::Pressure(held()? / self.padding),
            Held::Approach => self.load_at_approach(held()?),
            Held::Spring(stiffness) => {
                Error::positive("stiffness of the spring", stiffness)?;
                let rest = held()?;
                let compliance = self.padding * self.area / stiffness + self.boundary.mean_compliance();
                Load::Spring {
                    stiffness: compliance.recip(),
                    rest: if free { self.resting(rest) } else { rest + self.mean_depth() },
                }
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

    /// The mean gap at an approach without a load. Surfaces that touch within their rounding bear none: they are apart.
    fn resting(&self, approach: f64) -> f64 {
        let rounding = TOUCH * T::epsilon().widen() * self.rms_height;
        self.peak - if approach.abs() <= rounding { -rounding } else { approach }
    }

    /// An approach as a load: a spring, or a mean gap over a body that does not yield in the mean, as a bonded
    /// incompressible layer.
    fn load_at_approach(&self, approach: f64) -> Load {
        let (rest, compliance) = (self.resting(approach), self.approach_compliance());
        if compliance == 0.0 {
            return Load::Gap(rest + self.mean_depth());
        }
        Load::Spring { stiffness: compliance.recip(), rest }
    }

    /// What the mean pressure adds to an approach, over that pressure; zero for a body without one.
    fn approach_compliance(&self) -> f64 {
        if self.boundary.is_periodic() { self.far_compliance.unwrap_or(0.0) } else { self.boundary.mean_compliance() }
    }

    /// The approach at a mean gap and a mean pressure on the operator's grid; none in a periodic cell, where the energy
    /// does not have the compression of the whole.
    pub(crate) fn approach(&self, mean_gap: f64, pressure: f64) -> Option<f64> {
        let approach = self.peak - mean_gap + self.boundary.mean_compliance() * pressure;
        (!self.boundary.is_periodic()).then_some(approach)
    }
}
