//! The findings of a solve: the solution, and all that was asked for with it.

use std::borrow::Cow;
use std::sync::Arc;

use asperity::accuracy::GridError;
use asperity::contact::{ContactArea, ContactStatistics, Original, PressureExtremes};
use asperity::elastic::Boundary;
use asperity::nested::Level;
use asperity::stability::ContactStiffness;
use asperity::{AdhesionLaw, Grid, Real, Report, Result, Solution, Surface};
use asperity_maps::warning::{Warning, WarningCode};
use ndarray::{Array2, ArrayView2};

use crate::account::{Findings, GridErrors, Left, OtherBranch, Refinement, Search, Steadiness, Step};
use crate::clock::Instant;
use crate::key::{Notice, record};

record! {
    /// The solution of a contact problem, with all that was asked for with it.
    Answer<T: Real> of (solution: Solution<T>, sight: Sight<T>, seconds: f64) {
        /// The solution, on all nodes that were solved.
        solution: Solution<T> = solution,
        /// The law and the grids of the solution, for a look at its fields.
        sight: Sight<T> = sight,
        /// The nested grids, if they were used.
        levels: Option<Vec<Level>> = None,
        /// The operator applications on all of them, in units of one on the finest.
        equivalent_applications: Option<f64> = None,
        /// The surface on the grid of the solution, if an accuracy was asked for.
        refined: Option<Surface> = None,
        /// The end of a solve to an accuracy, if one was asked for.
        accuracy: Option<Refinement> = None,
        /// The search for the load of a contact fraction, if there was one.
        search: Option<Search> = None,
        /// The equilibrium on the other branch, if both are asked for and the solution has a branch.
        other_branch: Option<OtherBranch> = None,
        /// The stability, if it was asked for.
        stability: Option<Steadiness> = None,
        /// The change of the gap along which the energy is softest, with the stability.
        mode: Option<Array2<T>> = None,
        /// The unstable equilibria on the way to the solution, in order, if they were to be left.
        departures: Option<Vec<Left>> = None,
        /// The contact stiffness, if it was asked for.
        stiffness: Option<ContactStiffness> = None,
        /// The findings that follow.
        after: Findings = Findings::default(),
        /// The place on a cycle, if there is one.
        step: Option<Step> = None,
        /// The time for setting up and solving, stability included, in seconds.
        seconds: f64 = seconds,
    }
}

/// The sight of a solution: all that a look at its fields needs besides them.
pub struct Sight<T: Real> {
    pub(crate) law: Arc<dyn AdhesionLaw<T>>,
    pub(crate) original: Option<Original>,
    pub(crate) grid: Grid,
    /// The report on the whole.
    pub(crate) report: Report,
    /// The contact area in the limit of no range, of a law that has the range of the grid.
    pub(crate) jkr_contact_fraction: Option<f64>,
    /// The nested grids; their errors are estimated with the first look.
    pub(crate) open: Option<(Waves, Vec<Level>)>,
    /// The errors that are known, and the nodes of the shortest wave.
    pub(crate) errors: Option<(GridErrors, f64)>,
    /// The findings of the first look.
    seen: Option<Seen>,
}

/// The nodes of the shortest wave of a surface, or the surface itself.
pub(crate) enum Waves {
    Known(f64),
    Of(Arc<Surface>),
}

impl Waves {
    pub(crate) fn nodes(&self, boundary: Boundary) -> f64 {
        match self {
            Self::Known(nodes) => *nodes,
            Self::Of(surface) => surface.nodes_per_wave(boundary),
        }
    }
}

/// The statistics of the contact, and the extremes of the elastic pressure.
pub(crate) type Seen = (ContactStatistics, PressureExtremes);

/// The name of a wall of springs in reports.
const SPRINGS: &str = "springs";

impl<T: Real> Answer<T> {
    /// A solution by a solve that began at a time; numbers are of the `original`, if there is one. Where springs press that
    /// end at a rigid wall, what their last round leaves of a gap is no opening.
    pub(crate) fn new(
        mut solution: Solution<T>,
        law: Arc<dyn AdhesionLaw<T>>,
        original: Option<Original>,
        clock: Instant,
    ) -> Result<Self> {
        let seconds = clock.elapsed().as_secs_f64();
        let original = original.map(|original| original.on(&solution.grid)).transpose()?;
        if solution.report.wall == SPRINGS {
            let pressed = solution.gap.iter_mut().zip(&solution.contact_pressure).filter(|(_, p)| **p > T::zero());
            pressed.for_each(|(gap, _)| *gap = gap.min(T::zero()));
        }
        let (grid, report) = (solution.grid, solution.report.clone());
        let by_energy = report.adhesive_contact_fraction.map(|_| ContactArea::of_solution(&solution)).transpose()?;
        let jkr_contact_fraction = by_energy.and_then(|area| area.jkr_contact_fraction);
        let sight = Sight { law, original, grid, report, jkr_contact_fraction, open: None, errors: None, seen: None };
        Ok(Self::record(solution, sight, seconds))
    }

    /// The same by nested grids, with the applications on all of them.
    pub(crate) fn by(self, mut levels: Vec<Level>, applications: f64) -> Self {
        if has_yielded(&self.solution.report) {
            levels.iter_mut().for_each(|level| level.area.corrected_contact_fraction = f64::NAN);
        }
        let stiffness = levels.last().and_then(|finest| finest.stiffness);
        Self { levels: Some(levels), equivalent_applications: Some(applications), stiffness, ..self }
    }

    /// The solution on the part of a mirrored map that has results.
    ///
    /// # Errors
    /// [`Error::Shape`](asperity::Error::Shape) if the solution is not one of the whole of an original.
    pub fn part(&self) -> Result<Cow<'_, Solution<T>>> {
        let part = self.sight.original.map(|original| original.of_solution(&self.solution)).transpose()?;
        Ok(part.map_or(Cow::Borrowed(&self.solution), Cow::Owned))
    }
}

impl<T: Real> Sight<T> {
    /// The findings of the first look at the fields.
    pub(crate) fn seen(&mut self, fields: [ArrayView2<'_, T>; 3]) -> Result<Seen> {
        let seen = match self.seen.take() {
            Some(seen) => seen,
            None => self.see(fields)?,
        };
        Ok(self.seen.insert(seen).clone())
    }

    fn see(&self, [gap, pressure, contact_pressure]: [ArrayView2<'_, T>; 3]) -> Result<Seen> {
        let (law, modulus) = (&self.law, self.report.modulus);
        let mut found = match &self.original {
            Some(original) => original.statistics_of_fields(gap, contact_pressure, modulus, law)?,
            None => {
                let body = (self.report.boundary, modulus);
                ContactStatistics::of_fields(gap, contact_pressure, &self.grid, body, law)?
            }
        };
        if has_yielded(&self.report) {
            found.corrected_contact_fraction = f64::NAN;
        }
        Ok((found, PressureExtremes::of(pressure, &self.grid, !law.hints().zero)))
    }

    /// Estimates the errors of nested grids of a surface, with the nodes of its shortest wave.
    pub(crate) fn estimate(&mut self, levels: &[Level], nodes_per_wave: f64) {
        self.errors =
            Some((GridErrors::record(GridError::of_all(levels, &self.report, nodes_per_wave)), nodes_per_wave));
    }
}

/// Whether a surface has yielded: gap and pressure then tell no edge of the contact between the nodes, unlike in an
/// elastic contact.
fn has_yielded(report: &Report) -> bool {
    report.plastic.is_some_and(|plastic| plastic.fraction > 0.0)
}

/// The probable mistakes that a solution shows; of the whole of an `original`, whether its images differ from it, and
/// of a surface that is steep by the warnings of its input, whether it lacks a hardness. From the heights scars may have
/// been removed beyond a threshold.
///
/// # Errors
/// [`Error::Shape`](asperity::Error::Shape) if the solution is not one of the whole of an original.
pub fn warnings_of<T: Real>(
    solution: &Solution<T>,
    original: Option<Original>,
    (of_input, scars_removed): (&[Notice], Option<f64>),
) -> Result<Vec<Warning>> {
    let mut found = Warning::of_solution(solution, scars_removed);
    let steep = of_input.iter().any(|told| told.code == WarningCode::Steep.name());
    found.extend(if steep { Warning::of_hardness(solution) } else { None });
    let images = original.map(|original| Warning::of_images(&original, solution)).transpose()?;
    found.extend(images.flatten());
    Ok(found)
}

/// Refuses a solution of a solve that has run away.
///
/// # Errors
/// The first field that is not finite, and a remedy, for [`worded`](crate::worded).
pub fn check_finite<T: Real>(solution: &Solution<T>) -> std::result::Result<(), String> {
    let Solution { gap, pressure, contact_pressure, grid, report, .. } = solution;
    // at absent nodes the gap is infinite
    let fields =
        [("gap", gap, report.absent_nodes), ("pressure", pressure, 0), ("contact pressure", contact_pressure, 0)];
    for (name, field, absent) in fields {
        // without a count the pass is many times as fast
        let is_finite = field.fold(true, |all, value| all & value.is_finite());
        let own = if is_finite { 0 } else { field.iter().filter(|value| !value.is_finite()).count() };
        let count: usize = grid.each(own).iter().sum();
        if count != absent {
            let other = if T::NAME == "f32" { "{precision=f64}" } else { "another {initial_gap}" };
            return Err(format!(
                "the solve ran away: after {} iterations in {} the {name} is not finite at {count} of {} nodes; use \
                 {other}, or units in which the numbers are moderate",
                report.iterations,
                T::NAME,
                grid.nodes()
            ));
        }
    }
    Ok(())
}
