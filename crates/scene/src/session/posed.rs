//! The questions to a session before it is solved, and its pull-off.

use std::sync::Arc;

use asperity::accuracy::{Accuracy, NoEstimate, Plan, Quantity};
use asperity::solver::Iteration;
use asperity::{Branch, Control, ElasticOperator, Grid, PullOff, Real, Result, Start};
use asperity_maps::io::available_memory;
use asperity_maps::warning::Warning;
use ndarray::Array2;

use crate::account::{Answer, PulledOff};
use crate::clock::Instant;
use crate::key::{Goal, Load, Scalar};
use crate::outcome::Outcome;
use crate::session::fall::time;
use crate::session::{Observe, OneGrid, Session, Solved};

/// The operator applications of a search for the pull-off, with those on coarser grids; of rough surfaces 200 to 1200.
const PULL_OFF: f64 = 600.0;

impl<T: Scalar> Session<T> {
    /// The tolerance to which a solve is held, to an accuracy, if one is asked for.
    ///
    /// # Errors
    /// As [`Accuracy::tolerance`](asperity::accuracy::Accuracy::tolerance).
    pub fn tolerance(&self, goal: Option<Goal>) -> Result<f64> {
        let settings = self.facts.scene.settings();
        goal.map_or(Ok(settings.tolerance_in::<T>()), |goal| goal.wanted(false).tolerance(&settings))
    }

    /// Whether the surfaces attract each other.
    pub(super) fn adheres(&self) -> bool {
        !self.law.hints().zero
    }

    /// The seconds that an operator application takes here and now.
    ///
    /// # Errors
    /// Those of the body and the operator.
    pub(super) fn seconds_of_application(&self) -> Result<f64> {
        seconds_of(&mut self.facts.scene.elastic.operator::<T>(*self.grid())?)
    }

    /// The unit of a reduced pressure, if one is among `loads`.
    ///
    /// # Errors
    /// Those of [`Load::check`], and absent nodes next to a reduced pressure.
    pub fn full_pressure(&self, loads: &[Load]) -> Outcome<f64> {
        let elastic = &self.facts.scene.elastic;
        let check = |load: &Load| load.check(elastic.boundary, elastic.has_approach(), self.adheres());
        self.facts.worded(loads.iter().try_for_each(check))?;
        let reduced = loads.iter().any(|load| matches!(load, Load::Reduced(_)));
        if reduced { self.facts.worded(elastic.full_pressure(&self.surface)) } else { Ok(1.0) }
    }

    /// The gap from which solves under `loads` begin, if it is not the default; see
    /// [`Boundary::start_afar`](crate::Boundary::start_afar). On the branch of unloading it is.
    pub(super) fn start_afar(&self, loads: &[Control]) -> Option<Array2<f64>> {
        let scene = &self.facts.scene;
        let comes = scene.settings().branch != Some(Branch::Unloading);
        if comes { scene.elastic.boundary.start_afar(&self.surface, loads) } else { None }
    }

    /// The gap of undeformed bodies under a load that says how far they are.
    ///
    /// # Errors
    /// As [`Boundary::apart`](crate::Boundary::apart).
    pub fn apart(&self, load: Control) -> Outcome<Array2<f64>> {
        self.facts.worded(self.facts.scene.elastic.boundary.apart(&self.surface, load))
    }

    /// The gap from which to start, of the whole surface or of the original of a mirrored one.
    ///
    /// # Errors
    /// The remedy for another shape, and for nodes with a height that have no gap.
    pub fn start(&self, gap: Array2<f64>) -> Outcome<Array2<f64>> {
        let (grid, gap) = (self.grid(), self.facts.part.whole_of(gap)?);
        let (found, expected) = (gap.dim(), grid.field_shape());
        if found != expected {
            let ((nx, ny), (of_x, of_y)) = (found, grid.shape());
            return self.facts.worded(Err(format!(
                "{{initial_gap}} has {nx} x {ny} nodes, but the heights have {of_x} x {of_y}: give a gap at each node"
            )));
        }
        // the library refuses what is not finite, but for nodes without a gap
        let is_absent = |node: (usize, usize)| self.surface.absent().is_some_and(|absent| absent[node]);
        let unknown = |(node, gap): &((usize, usize), &f64)| !gap.is_finite() && !is_absent(*node);
        if let Some(((i, j), unknown)) = gap.indexed_iter().find(unknown) {
            let i = grid.rows().start + i;
            return self.facts.worded(Err(format!(
                "{{initial_gap}} is {unknown} at index [{i}, {j}], where the surface has a height: only absent nodes may \
                 have no gap"
            )));
        }
        Ok(gap)
    }

    /// The plan of a solve to an accuracy, and the seconds that it is likely to take, by the seconds of an operator
    /// application.
    ///
    /// # Errors
    /// Those of the operator and of [`Accuracy::plan`](asperity::accuracy::Accuracy::plan).
    pub fn plan(&self, control: Control, goal: Goal) -> Result<(Plan, f64)> {
        let (solver, control) = (self.facts.solver()?, self.facts.on_whole(control));
        let mut operator = self.facts.scene.elastic.operator::<T>(*self.grid())?;
        let plan = goal.wanted(false).plan(&solver, &self.surface, &mut operator, &self.law, control)?;
        Ok((plan, plan.applications * seconds_of(&mut operator)?))
    }

    /// The solves of a search for the pull-off, and the time that they are likely to take.
    ///
    /// # Errors
    /// Those of the body and the operator.
    pub fn announce_pull_off(&self, refines: bool) -> Result<String> {
        let ((nx, ny), of_grid) = (self.grid().shape(), self.law.hints().of_grid);
        let seconds = self.seconds_of_application()? * PULL_OFF;
        let (solves, coarse) = if of_grid { (9, ", after as many on each coarser grid") } else { (12, "") };
        let finer = if refines { ", and four times as long on each finer grid" } else { "" };
        Ok(format!("some {solves} solves on {nx} x {ny} nodes{coarse}: about {}{finer}", time(seconds)))
    }

    /// The pull-off, to an accuracy if one is asked for, from a gap or the default start, with the last state that holds.
    /// With a law that has the range of the grid a coarser grid tells the error, unless a start is given.
    ///
    /// # Errors
    /// As [`PullOff::find_from`], [`Accuracy::pull_off`](asperity::accuracy::Accuracy::pull_off) and [`Session::solve`].
    pub fn pull_off(
        mut self,
        asked: PullOff,
        goal: Option<Goal>,
        start: Option<Array2<T>>,
        observe: Observe<'_>,
    ) -> Outcome<(Solved<T>, PulledOff)> {
        let (clock, of_grid) = (Instant::now(), self.law.hints().of_grid);
        let tolerance = self.tolerance(None)?;
        if goal.is_some() || start.is_none() && of_grid {
            let told = || Accuracy::new(f64::INFINITY, Quantity::Area).memory(available_memory());
            let wanted = goal.map_or_else(told, |goal| goal.wanted(false));
            let observe = |grid: &Grid, state: &Iteration| observe(grid, state, tolerance);
            let elastic = |grid| self.facts.scene.elastic.operator(grid);
            let (law, mut solver) = (Arc::clone(&self.law), self.facts.solver()?);
            let found = wanted.pull_off_observed(&mut solver, &self.surface, elastic, law, &asked, observe)?;
            let last = self.facts.examine(found.found.solution.clone(), &self.law, clock)?;
            let pulled_off = PulledOff::record(asked, &found.found, &last.part()?.report, Ok(&found), goal);
            if let Err(NoEstimate::FewNodes { nodes, needed, bytes }) = found.error {
                let few = Warning::of_few_nodes(nodes, needed, bytes, wanted.memory);
                self.facts.warnings.add_of_input(vec![self.facts.units.describe(&few)])?;
            }
            let last = Answer { refined: goal.map(|_| found.surface), ..last };
            return Ok((self.facts.solved("pull-off", last)?, pulled_off));
        }
        let mut one = self.on_one_grid()?;
        let OneGrid { solver, problem, .. } = &mut one;
        let grid = *problem.grid();
        let start = start.as_ref().map_or(Start::Default, |gap| Start::From(gap));
        let found = asked.find_from(solver, problem, start, |state| observe(&grid, state, tolerance))?;
        let last = one.examine(found.solution.clone(), clock)?;
        let untold = if of_grid { "a coarser grid has no start: leave out the start" } else { PulledOff::OF_A_RANGE };
        let pulled_off = PulledOff::record(asked, &found, &last.part()?.report, Err(untold), None);
        Ok((one.facts.solved("pull-off", last)?, pulled_off))
    }
}

/// The seconds of an application of an operator, after a trial.
fn seconds_of<T: Real>(operator: &mut impl ElasticOperator<T>) -> Result<f64> {
    let mut fields = [(); 2].map(|()| Array2::<T>::zeros(operator.grid().field_shape()));
    let [u, p] = &mut fields;
    operator.pressure(u.view(), p.view_mut())?;
    let clock = Instant::now();
    operator.pressure(u.view(), p.view_mut())?;
    Ok(clock.elapsed().as_secs_f64())
}
