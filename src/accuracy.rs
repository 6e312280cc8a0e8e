//! The accuracy of a solve: the error of the grid, and a solve that refines the grid until this error is small enough.
//!
//! [`GridError`] estimates the error of the grid, next to the error of the solver; [`Accuracy`] chooses grid and
//! tolerance.

use crate::contact::ContactArea;
use crate::elastic::Boundary;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::names::names;
use crate::nested::Level;
use crate::problem::{Control, Held};
use crate::solver::Report;
use crate::stability::ContactStiffness;
#[cfg(doc)]
use crate::stability::EdgeError;
use crate::surface::{Surface, mirror};

mod bearing;
mod fitted;
mod goal;
mod loop_grid;
mod loops;
mod no_estimate;
mod pull_off;
mod refine;
mod refinement;
mod zone;

use fitted::{EDGE, Factors};

pub use goal::{Accuracy, AccurateSolution, Plan};
pub use loop_grid::LoopGrid;
pub use loops::{Limit, LoopLimit};
pub use no_estimate::NoEstimate;
pub use pull_off::AccuratePullOff;

/// The quantity that an accuracy is asked for.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Quantity {
    /// The contact area corrected for its edge,
    /// [`ContactArea::corrected_contact_fraction`](crate::contact::ContactArea::corrected_contact_fraction); with
    /// [`Jkr`](crate::Jkr) the area in the limit, [`ContactArea::jkr_contact_fraction`](crate::contact::ContactArea).
    Area,
    /// The mean gap, under a given pressure or force in a periodic cell.
    Gap,
    /// The approach, under a given force on a free boundary.
    Approach,
    /// The mean external pressure, where it is not given.
    Pressure,
    /// The work that a loop of loads takes, [`LoopLimit::work`].
    Work,
    /// The greatest tension on a loop of loads, [`LoopLimit::tension`].
    Tension,
}

names!(Quantity {
    Area = "area",
    Gap = "gap",
    Approach = "approach",
    Pressure = "pressure",
    Work = "work",
    Tension = "tension",
});

impl Quantity {
    /// The quantities of a solution.
    pub const ALL: [Self; 4] = [Self::Area, Self::Gap, Self::Approach, Self::Pressure];

    /// The quantities of a loop.
    pub const OF_LOOPS: [Self; 2] = [Self::Work, Self::Tension];

    /// Refuses a quantity that a control gives instead of finding it.
    ///
    /// # Errors
    /// [`Error::Unsuited`].
    #[doc(hidden)]
    pub fn check(self, control: Control) -> Result<()> {
        let (what, reason) = match (self, control.holds()) {
            (Self::Gap, Held::MeanGap) => {
                ("accuracy of the gap", "the mean gap is given: ask for that of the pressure, or of the area")
            }
            (Self::Gap, Held::Approach) => (
                "accuracy of the gap",
                "a free half-space has no mean gap: ask for that of the pressure, which is that of the force, or of the area",
            ),
            (Self::Approach, Held::MeanGap | Held::Approach) => (
                "accuracy of the approach",
                "bodies in a periodic cell have none, and a given one has no error: ask for that of the area",
            ),
            (Self::Pressure, Held::Load) => {
                ("accuracy of the pressure", "it is given: ask for that of the gap, or of the area")
            }
            (Self::Work | Self::Tension, _) => {
                ("accuracy of a loop", "a solution under one load has none: ask for the accuracy of the area")
            }
            _ => return Ok(()),
        };
        Err(Error::Unsuited { what, reason })
    }

    /// Refuses a quantity that there is not with a boundary.
    fn check_in(self, boundary: Boundary) -> Result<()> {
        if self == Self::Approach && boundary.is_periodic() {
            let reason = "bodies in a periodic cell have none: ask for that of the gap, or of the area";
            return Err(Error::Unsuited { what: "accuracy of the approach", reason });
        }
        Ok(())
    }

    fn of(self, level: &Level) -> Option<f64> {
        Some(match self {
            Self::Area => level.area.corrected_contact_fraction,
            Self::Gap => level.mean_gap,
            Self::Approach => level.approach?,
            Self::Pressure => level.mean_pressure,
            Self::Work | Self::Tension => return None,
        })
    }

    /// The relative error on a level by the edge of its contact, if its stiffness was found.
    fn by_edge(self, level: &Level) -> Option<f64> {
        let stiffness = level.stiffness?;
        let edge = stiffness.edge?;
        let error = match self {
            Self::Area | Self::Work | Self::Tension => return None,
            Self::Gap => edge.gap / level.mean_gap,
            Self::Approach => edge.gap / level.approach?,
            Self::Pressure => edge.gap * stiffness.pressure_per_length / level.mean_pressure,
        };
        Some(error.abs()).filter(|error| error.is_finite())
    }

    /// The relative error of the finer of two grids, with the errors at the edge of its area.
    fn by_coarser(self, fine: &Level, coarse: &Level, [places, adhesion]: [f64; 2]) -> Option<f64> {
        let (value, coarser) = (self.of(fine)?, self.of(coarse)?);
        let [counted, coarser_counted] = [fine, coarse].map(|level| level.area.contact_fraction);
        if (value, counted) == (coarser, coarser_counted) {
            // no contact, or nothing else
            return Some(0.0);
        }
        if !(value.is_finite() && coarser.is_finite()) || value == 0.0 {
            return None;
        }
        let factors = Factors::of(self, fine.shape.0 == 1 || fine.shape.1 == 1)?;
        let difference = factors.difference * ((value - coarser) / value);
        if self == Self::Area {
            return Some(difference.hypot(places).hypot(adhesion));
        }
        let edge = (counted - coarser_counted) / counted.max(coarser_counted).max(f64::MIN_POSITIVE);
        Some(difference.hypot(factors.edge * edge))
    }

    /// The relative error by the number of nodes in the shortest wave alone.
    fn by_waves(self, nodes_per_wave: f64, line: bool) -> f64 {
        Factors::of(self, line)
            .map_or(f64::INFINITY, |Factors { waves, order, .. }| waves * nodes_per_wave.powf(-order))
    }

    /// The estimate to be expected with so many nodes in the shortest wave, by the estimates of rough surfaces: with
    /// an adhesion in the limit of no range, by their median.
    fn expected(self, nodes_per_wave: f64, adhesion: f64, line: bool) -> f64 {
        let Some(factors) = Factors::of(self, line) else { return f64::INFINITY };
        let without = GridError::COVER * factors.expected / nodes_per_wave.powi(2);
        // the range over the gap that surfaces without adhesion have a node away from the edge
        let zone = ((13.0 * adhesion).sqrt() * nodes_per_wave).min(1.0);
        let with = factors.expected_with_range / nodes_per_wave;
        without + zone * (with - without)
    }
}

/// The relative errors of the corrected area by the places of its edge and by the adhesion there.
fn at_edge(area: &ContactArea, nodes_per_wave: f64, mu_rho: f64) -> [f64; 2] {
    let (edges, nodes) = (area.edges as f64, area.contact_nodes as f64);
    let beyond = (area.contact_fraction / area.corrected_contact_fraction - 1.0).abs();
    let adhesion = EDGE.adhesion * mu_rho * mu_rho.sqrt() * beyond;
    if area.edges == 0 {
        return [0.0, adhesion];
    }
    let [contact, apart] = [nodes, nodes / area.contact_fraction - nodes].map(|nodes| edges / nodes.max(1.0));
    let alike = (EDGE.alike * contact * (contact + 2.0 * apart)).hypot(EDGE.waves / nodes_per_wave.powi(2));
    [(EDGE.scatter * contact / area.places.sqrt()).hypot(alike / area.places), adhesion]
}

impl ContactStiffness {
    /// The relative error of the stiffness, with the estimated error of the grid, of which the [edge](EdgeError) has the
    /// size; none where that is not known.
    pub fn error(&self) -> Option<f64> {
        if self.pressure_per_length == 0.0 {
            return Some(self.relative_error);
        }
        Some(self.relative_error + GridError::COVER * (self.edge?.stiffness? / self.pressure_per_length).abs())
    }
}

impl Surface {
    /// The nodes of the shortest wave of the surface,
    /// [`Spectrum::nodes_per_wave`](crate::surface::Spectrum::nodes_per_wave); with a free boundary, of the surface
    /// continued by its mirror images. Where processes share the grid, it belongs to the whole surface, and all ask.
    pub fn nodes_per_wave(&self, boundary: Boundary) -> f64 {
        let mirrored = |whole: &Self| {
            let (heights, (lx, ly), (nx, ny)) = (mirror(whole.heights()), whole.grid().lengths(), whole.grid().shape());
            let (mx, my) = heights.dim();
            Self::new(Grid::new((mx, my), (lx * (mx / nx) as f64, ly * (my / ny) as f64))?, heights)
        };
        let of = |whole: &Self| match boundary.is_periodic() {
            true => whole.spectrum().nodes_per_wave(),
            // side lengths and heights of a surface
            false => mirrored(whole).map_or(0.0, |surface| surface.spectrum().nodes_per_wave()),
        };
        of(&self.whole())
    }
}

/// The work of adhesion over E*h'²λ, of the rms slope h' and the shortest wave λ of a surface, from w/E*.
fn adhesion(surface: &Surface, nodes_per_wave: f64, length: f64) -> f64 {
    let wave = nodes_per_wave * surface.grid().largest_spacing();
    length / (surface.whole().spectrum().rms_slope().powi(2) * wave)
}

/// The relative error of the solver on a coarser grid above which its difference to a finer one says nothing.
const SOLVED: f64 = 3e-3;

/// Whether a grid so many times finer than one with this resolution measure resolves the adhesion.
fn resolves_adhesion(mu_rho: f64, finer: f64) -> bool {
    mu_rho <= Report::RESOLVED_MU_RHO * finer.sqrt()
}

/// How far a coarser grid may be from half the nodes along a side, as for an odd number.
const HALVED: f64 = 0.02;

const ORDERS: (f64, f64) = (0.5, 3.0);

/// The estimated relative error of the grid, of one quantity.
///
/// With the contact stiffness k of the finest grid ([`Nested::stiffness`](crate::Nested::stiffness)) the errors of the
/// mean gap and the mean pressure follow from its edge, [`EdgeError`]: the error of the pressure under a given mean gap
/// is k times the error of the gap under a given pressure. To their squares are added those of 0.4/n³ and 1/n³, with n
/// the number of nodes in the shortest wave.
///
/// Otherwise, with δQ the relative difference of a quantity Q to the grid of half as many nodes along its sides, the
/// size of the error is the root of the sum of the squares of
///
/// | quantity | terms |
/// |---|---|
/// | corrected area A_c | δA_c/4, 0.03 κ/√M, 0.1 κ(κ + 2κ')/M, 4/(n² M), 0.1 μ_ρ^{3/2} ε |
/// | mean gap ḡ, mean pressure p̄ | 0.15 δḡ, 0.001 δA, and with p̄ likewise |
///
/// where A is the area as nodes count it, and ε = A/A_c − 1; κ and κ' are the neighbours between which the edge runs
/// ([`ContactArea::edges`]), over the nodes in contact and over those apart; M is the number of them that are
/// independent ([`ContactArea::places`]). On a line the factors are 1/2 for the area, and 1/3 and 0.02 for
/// gap and pressure. Without a coarser grid 0.6/n², on a line 5/n², takes the place of
/// δA_c/4, and the terms with M count twice.
///
/// κ and δA have the scale of all that depends on where between the nodes the edge falls; δQ alone may be small by
/// luck. The factors are fitted to rough surfaces, strips and lattices. The estimate is 2.4 times that size, which
/// covers 95 of 100 errors and no bound; the page [`choosing`](crate::guide::choosing) has how many on which surfaces.
///
/// With [`Jkr`](crate::Jkr) the [process zone](crate::contact::ContactArea::process_zone) b at the edge of the contact makes
/// the errors. With δ the difference of the quantities less their part of the zone to the grid of half as many nodes they are
///
/// | quantity | zone z | error | on one grid |
/// |---|---|---|---|
/// | area [by JKR](crate::contact::ContactArea) | b | √((0.7 s z)² + (1.4 δ)²) | 1.7 z |
/// | mean gap ḡ | wb/λ̄ | √((4 z)² + (4 δ)²) | 7.5 z |
/// | approach | wb/λ̄ | √((2.5 z)² + (1.5 δ)²) | 3.75 z |
/// | mean pressure | wb/ḡ | √((6 z)² + (3 δ)²) | 15 z |
///
/// with λ̄ the mean contact pressure, and s = 1 + 0.8 (1 − p̄/λ̄)², since adhesion that carries more than the load
/// makes more of the zone; the error of the area is 1 + A⁴ times as large, since the zone is narrower around holes; 4.5
/// times as large, and rough, where the area changes between the two grids by more than b/2 and the error without
/// adhesion, as where a patch of contact is on one of them alone; and rough on one grid. To the squares are added the
/// squares of an edge without adhesion: with M of the area above, on one grid twice, half of it for gap and pressure
/// and 1.2 times for the approach, and on one grid 0.6/n² or 0.4/n³. The weaker the adhesion, the nearer the factors of
/// δ are to the factors without adhesion. No estimate is zero.
///
/// A grid counts if it has the same waves, the shortest with at least four nodes ([`Surface::nodes_per_wave`]), a
/// μ_ρ ≤ 0.5, and, if it is a coarser one, was solved to 3e-3. Sure are gap and pressure by the edge;
/// and, with at least sixteen nodes in the shortest wave and on a grid of more than one row, the area by a coarser
/// grid. All others are [`rough`](Self::rough).
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GridError {
    /// The error, relative to the value on the finest grid: an estimate that most true errors are below, and no bound.
    pub relative: f64,
    /// The observed order of convergence of the quantity, where three grids have one between 0.5 and 3.
    pub order: Option<f64>,
    /// Whether the estimate may be far off.
    pub rough: bool,
}

impl GridError {
    /// A [`Nested::coarse_tolerance`](crate::Nested::coarse_tolerance) at which coarser grids tell the error.
    pub const COARSE_TOLERANCE: f64 = 1e-3;

    /// The factor from the size of an error, such as an [`EdgeError`], to an estimate that covers 95 of 100.
    pub(crate) const COVER: f64 = 2.4;

    /// The nodes that the shortest wave needs on a grid with a solution that tells the error.
    pub const LEAST_NODES_PER_WAVE: f64 = 4.0;

    /// The errors, as by [`GridError::of`], of all quantities that the control does not give.
    pub fn of_all(levels: &[Level], report: &Report, nodes_per_wave: f64) -> [(Quantity, Option<Self>); 4] {
        Quantity::ALL.map(|of| {
            let found = of.check(report.control).is_ok().then(|| Self::of(levels, of, nodes_per_wave, report.mu_rho));
            (of, found.flatten())
        })
    }

    /// The error of the finest of some nested grids, the coarsest first; none where they do not tell it.
    ///
    /// `nodes_per_wave` and the resolution measure `mu_rho` are those on the finest grid.
    pub fn of(levels: &[Level], quantity: Quantity, nodes_per_wave: f64, mu_rho: f64) -> Option<Self> {
        let finest = levels.last()?;
        let resolves = |factor: f64| {
            nodes_per_wave / factor >= Self::LEAST_NODES_PER_WAVE && resolves_adhesion(mu_rho, factor.recip())
        };
        if finest.range.is_some() {
            let resolves = |factor: f64| nodes_per_wave / factor >= Self::LEAST_NODES_PER_WAVE;
            return zone::error(levels, quantity, nodes_per_wave, resolves);
        }
        let value = |level: &Level| quantity.of(level).filter(|value| !value.is_nan());
        let mut values = vec![value(finest)?];
        let mut coarser = None;
        for level in levels.iter().rev().skip(1) {
            let factor = f64::from(1 << values.len());
            if !is_coarser(level, finest, factor) || !resolves(factor) {
                break;
            }
            values.push(value(level)?);
            coarser = coarser.or(Some(level));
        }
        let order = observed_order(&values);
        let fine = nodes_per_wave >= 4.0 * Self::LEAST_NODES_PER_WAVE;
        let line = finest.shape.0 == 1 || finest.shape.1 == 1;
        let waves = quantity.by_waves(nodes_per_wave, line);
        if let Some(size) = quantity.by_edge(finest).filter(|_| resolves(1.0)) {
            return Some(Self { relative: Self::COVER * size.hypot(waves), order, rough: false });
        }
        let at_edge @ [places, adhesion] = at_edge(&finest.area, nodes_per_wave, mu_rho);
        let (size, sure) = match coarser {
            Some(coarser) => (quantity.by_coarser(finest, coarser, at_edge)?, fine && !line),
            None if quantity == Quantity::Area && resolves(1.0) && nodes_per_wave.is_finite() => {
                (waves.hypot(2.0 * places).hypot(adhesion), false)
            }
            None => return None,
        };
        let rough = quantity != Quantity::Area || !sure || size == 0.0;
        Some(Self { relative: Self::COVER * size, order, rough }).filter(|error| error.relative.is_finite())
    }
}

/// Whether a level has so many times fewer nodes along the sides than the finest, and was solved well enough.
fn is_coarser(level: &Level, finest: &Level, factor: f64) -> bool {
    let [fine, coarse] = [finest, level].map(|level| level.shape.0.max(level.shape.1) as f64);
    (fine / coarse / factor - 1.0).abs() <= HALVED && level.relative_error <= SOLVED
}

/// The order of convergence of values on grids, the finest first, where three have one that is believed.
fn observed_order(values: &[f64]) -> Option<f64> {
    let &[fine, coarse, coarser, ..] = values else { return None };
    let order = ((coarse - coarser) / (fine - coarse)).log2();
    (ORDERS.0..=ORDERS.1).contains(&order).then_some(order)
}
