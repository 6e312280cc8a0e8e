//! The limit of no range of a cycle, by the same cycle on the grid of half as many nodes along the sides.

use std::ops::ControlFlow;
use std::sync::Arc;

use asperity::accuracy::LoopLimit;
use asperity::adhesion::Discretisation;
use asperity::path::PathSettings;
use asperity::solver::Iteration;
use asperity::{Control, Solver, Status};
use serde::Serialize;

use crate::case::Part;
use crate::key::{After, ENERGY_PER_AREA, PRESSURE, Scalar, record};
use crate::outcome::Outcome;
use crate::session::course::Course;
use crate::session::posed::Body;
use crate::session::way::Way;
use crate::session::{Facts, Session};
use crate::table::warnings::Warnings;

record! {
    /// The limits of no range of what a cycle tells.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    CycleLimit of (limit: LoopLimit) {
        /// With `law` `jkr`, the limit of no range of the work done by the load, per area of the map.
        work_limit: f64 [ENERGY_PER_AREA] = limit.work.value,
        /// Estimated error of the limit of the work.
        work_limit_error: f64 [ENERGY_PER_AREA] = limit.work.error,
        /// With `law` `jkr`, the limit of no range of the greatest tension.
        tension_limit: f64 [PRESSURE] = limit.tension.value,
        /// Estimated error of the limit of the tension.
        tension_limit_error: f64 [PRESSURE] = limit.tension.error,
    }
}

impl<T: Scalar> Session<T> {
    /// The same cycle on the coarser grid, before the first solve: by laws that attract next to contacts alone, where there
    /// is such a grid and neither a start nor a hardness is given node by node.
    pub(super) fn coarser(&self, loads: &[Control], settings: PathSettings) -> Outcome<Option<Box<Self>>> {
        if !self.law.hints().touches() || self.facts.hardness.is_some() {
            return Ok(None);
        }
        let surface = self.surface()?;
        let Some(surface) = LoopLimit::coarser(&surface, &*self.law)?.map(Arc::new) else { return Ok(None) };
        let ((nx, ny), (cx, cy)) = (self.grid.shape(), surface.grid().shape());
        let law = self.law.adapted(Discretisation::Coarse(nx / cx, ny / cy)).unwrap_or_else(|| Arc::clone(&self.law));
        let solver = Solver { settings: self.solver.settings, constraint: self.facts.scene.adhesion.constraint(None)? };
        let loads: Vec<_> = loads.iter().map(|load| self.on_whole(*load)).collect();
        let (part, strongest, hardness, scars_removed) = (Part::all(*surface.grid()), None, None, None);
        let mut coarser = Self {
            inputs: self.inputs.clone(),
            seed: None,
            warnings: Warnings::new(Vec::new(), false)?,
            facts: Facts { part, strongest, hardness, scars_removed, ..self.facts.clone() },
            surface: Arc::downgrade(&surface),
            grid: *surface.grid(),
            last: false,
            course: None,
            table: None,
            coarser: None,
            body: Body::Surface(surface),
            law,
            solver,
        };
        let start = coarser.start_afar(&loads).map(T::field);
        let course = Course::new(Way::Cycle(loads, settings), After::default(), None, |load| load)?;
        coarser.course = Some(course.starting_from(start));
        Ok(Some(Box::new(coarser)))
    }

    /// The number of nodes along the sides of the coarser grid that tells the limit of the cycle, if one does.
    pub fn coarser_shape(&self) -> Option<(usize, usize)> {
        self.coarser.as_ref().map(|coarser| coarser.grid.shape())
    }

    /// The limit of no range of a cycle whose last state is kept; none where no coarser grid tells it, and if an observer
    /// ends a solve. It is told once.
    ///
    /// # Errors
    /// Errors of the solvers of the library.
    pub fn cycle_limit(
        &mut self,
        observe: &mut (dyn FnMut(&Iteration) -> ControlFlow<()> + Send),
    ) -> Outcome<Option<CycleLimit>> {
        let Some(mut coarser) = self.coarser.take() else { return Ok(None) };
        while let Some((found, _)) = coarser.next(&mut *observe)? {
            if found.solution.report.status == Status::Stopped {
                return Ok(None);
            }
        }
        let [fine, coarse] = [&*self, &*coarser].map(|session| session.course.as_ref().and_then(|course| course.end()));
        Ok(fine.zip(coarse).map(|(fine, coarse)| CycleLimit::of(LoopLimit::of(&fine, &coarse))))
    }
}
