//! The solve of a case: a file with its rows, its warnings next to it, and nothing else.

use std::ops::ControlFlow;
use std::path::PathBuf;

use asperity::Grid;
use asperity::solver::Iteration;
use asperity_maps::Topography;
use asperity_scene::output::write_text;
use asperity_scene::warnings::Warnings;
use asperity_scene::{
    Account, After, Format, Load, Outcome, Precision, Processes, Scalar, Skin, TableFile, Way, shortfalls,
};

use crate::options::{Problem, ProblemOptions};
use crate::printing::{Warn, in_options};
use crate::scene::SceneFile;
use crate::session::Strictness;

/// A case to solve, by a command.
pub struct Run<'a> {
    pub problem: ProblemOptions,
    pub scene: SceneFile,
    pub processes: &'a Processes,
    /// The file of the rows
    pub out: PathBuf,
    pub format: Format,
    /// Whether to start over
    pub force: bool,
}

impl Run<'_> {
    /// Solves the case, with heights that were `made`, if they were, and tells its warnings.
    pub fn solve(&self, made: Option<Topography>, warn: Warn<'_>) -> Outcome<()> {
        let Self { problem, scene, processes, .. } = self;
        let case = &problem.case;
        case.check_table()?;
        let loads = match scene.command {
            "solve" => vec![case.load()?],
            "pull-off" => Vec::new(),
            _ => case.loads()?,
        };
        let after = case.after(false)?;
        problem.check_after(&after, processes)?;
        let given = problem.with(made, processes)?;
        match case.scene().precision {
            Precision::F32 => self.rows::<f32>(given, &loads, after, warn),
            Precision::F64 => self.rows::<f64>(given, &loads, after, warn),
        }
    }

    fn rows<T: Scalar>(&self, given: Problem, loads: &[Load], after: After, warn: Warn<'_>) -> Outcome<()> {
        let Self { problem, scene, out, .. } = self;
        let Problem { posed, table: law_table, works } = given;
        let mut session = scene.keys::<Strictness>().session::<T>(posed, self.processes)?;
        let (full, start) = (session.full_pressure(loads)?, problem.start(&mut session, self.processes)?);
        // rows that have not converged are counted in the table
        let mut tell = |warnings: &mut Warnings, row: usize, account: Option<&Account>| {
            warnings.tell().iter().for_each(|told| warn(told.to_string()));
            let short = account.into_iter().flat_map(|account| shortfalls(account, Skin::Options));
            short.filter(|(what, _)| *what != "convergence").for_each(|(_, text)| warn(format!("row {row}: {text}")));
        };
        if let "sweep" | "cycle" = scene.command {
            let way = match scene.command {
                "cycle" => Way::cycle(loads, full, problem.case.given().path())?,
                _ => Way::sweep(loads, full),
            };
            if let (Way::Cycle(..), Some(goal)) = (&way, in_options(problem.case.given().cycle_goal())?) {
                session.refine(&way, goal, start.is_some(), &mut |_, _, _| ControlFlow::Continue(()))?;
            }
            let (out, format, force) = (out.clone(), Some(self.format), self.force);
            let file = TableFile { out, format, force, is_case: true, law_table, works, ..TableFile::default() };
            let mut rows = session.begin(way, after, false, start, Some(file))?;
            tell(rows.warnings(), 0, None);
            let has_rows = rows.count() > 0;
            rows.warnings().keep_beside(&self.out, has_rows)?;
            while let Some((_, row)) = rows.next(&mut |_| ControlFlow::Continue(()))? {
                let count = rows.count();
                tell(rows.warnings(), count, Some(&row.account));
            }
            // of an accuracy, which is known without a further cycle
            if rows.coarser_shape().is_none() {
                let limit = rows.cycle_limit(&mut |_| ControlFlow::Continue(()))?;
                limit.and_then(|limit| limit.shortfall(Skin::Options)).into_iter().for_each(warn);
            }
            return Ok(());
        }
        let start = start.map(T::field);
        let mut observe = |_: &Grid, _: &Iteration, _: f64| ControlFlow::Continue(());
        let (mut solved, pulled_off) = match loads.first() {
            Some(_) => {
                let asked = problem.case.request(full, start.is_some())?;
                (session.solve(&asked, start, &mut observe)?, None)
            }
            None => {
                let given = problem.case.given();
                let (asked, goal) = (given.pull_off(), in_options(given.goal())?);
                let (last, found) = session.pull_off(asked, goal, start, &mut observe)?;
                (last, Some(found))
            }
        };
        let text = solved.table(&after, pulled_off.as_ref(), self.format)?;
        tell(&mut solved.facts.warnings, 1, Some(&solved.account));
        let short = pulled_off.and_then(|found| found.shortfall(&solved.account, Skin::Options));
        solved.facts.warnings.keep_beside(out, false)?;
        write_text(out, &text)?;
        short.into_iter().for_each(warn);
        Ok(())
    }
}
