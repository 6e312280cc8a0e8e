//! The table that `asperity sweep` and `asperity cycle` fill: a row for each equilibrium, in the order of the loads.

use std::ops::ControlFlow;
use std::path::Path;

use asperity::{Control, Error, Surface};
use asperity_scene::numbers::percent;
use asperity_scene::output::{OutputFile, check_apart};
use asperity_scene::theories::Theories;
use asperity_scene::{
    Account, After, Boundary, CycleLimits, Entries, FORCE, Format, Kind, LENGTH, Load, Outcome, PRESSURE, Precision,
    Processes, Row, Rows, Scalar, Scene, Session, Skin, TableFile, WHOLE, Way, keys, shortfalls, warnings,
};
use serde_json::{Map, Value, json};

use crate::command::Call;
use crate::interruption;
use crate::options::{Problem, ProblemOptions};
use crate::printing::{Printing, complain, name};
use crate::progress::Progress;
use crate::report;
use crate::scene::SceneFile;
use crate::session::{Strictness, UNCONVERGED, say_new};

keys! {
    /// Whether a table is filled anew.
    ForceKeys {
        "Output" {
            /// Start over, and replace files that are there
            force: bool = Kind::switch(),
        }
    }
}

/// The options of a table.
pub struct TableOptions<'a> {
    pub problem: ProblemOptions,
    pub out: &'a Path,
    pub format: Format,
    /// The folder for the fields of the rows
    pub fields: Option<&'a Path>,
    pub scene: &'a SceneFile,
    pub processes: &'a Processes,
    /// Whether files that are there are replaced
    pub force: bool,
    pub printing: Printing,
    /// Whether the table belongs to an interface
    pub interface: bool,
}

impl<'a> TableOptions<'a> {
    /// The options of a call for a table in a format, with a folder for fields if they are wanted.
    pub fn new(call: &Call<'a>, out: &'a Path, format: Format, fields: Option<&'a Path>) -> Outcome<Self> {
        let &Call { scene, processes } = call;
        let (problem, ForceKeys { force }) = (ProblemOptions::new(&scene.given)?, scene.keys());
        let printing = scene.keys();
        Ok(Self { problem, out, format, fields, scene, processes, force, printing, interface: false })
    }
}

/// The format of a table by the ending of its name; `or` is what else than another name would do.
pub fn format_of(out: &Path, or: &str) -> Outcome<Format> {
    let refused = || Error::file(out, format!("does not end in .csv or .jsonl: rename it{or}"));
    Ok(Format::from_path(out).ok_or_else(refused)?)
}

/// The number of rows that there will be, if it is known, after a word.
fn of_rows<T: Scalar>(rows: &Rows<T>, word: &str) -> String {
    rows.of_rows().map_or(String::new(), |rows| format!("{word}{rows}"))
}

/// The work of a command on its table, in the precision of its solves; returns whether all rows converged.
pub trait Fill {
    /// The way through the loads.
    fn way(&self, loads: &[Load], full: f64, _: &Entries) -> Outcome<Way> {
        Ok(Way::sweep(loads, full))
    }

    /// Puts the session on the grid of the way, before its first row.
    fn refine<T: Scalar>(&self, _: &mut Session<T>, _: &Way, _: &TableOptions<'_>, _: bool) -> Outcome<()> {
        Ok(())
    }

    /// The theories to draw next to the rows, if there are to be some.
    fn theories(&self, _: &Surface, _: &Scene) -> Outcome<Option<Theories>> {
        Ok(None)
    }

    /// Fills the table.
    fn fill<T: Scalar>(&self, table: &mut Table<'_, T>) -> Outcome<bool>;
}

/// A table on disk, new or continued, with its rows.
pub struct Table<'a, T: Scalar> {
    pub options: TableOptions<'a>,
    pub rows: Rows<T>,
    pub theories: Option<Theories>,
    /// The kind of the loads
    control: Control,
    nodes: usize,
}

impl<'a> TableOptions<'a> {
    /// Reads the files of the problem, opens the table, and fills it.
    pub fn fill(self, by: &impl Fill) -> Outcome<bool> {
        let problem = &self.problem;
        let after = problem.case.after(self.interface)?;
        problem.case.check_table()?;
        let loads = problem.case.loads()?;
        problem.check_after(&after, self.processes)?;
        let given = problem.read(self.processes)?;
        match problem.case.scene().precision {
            Precision::F32 => by.fill(&mut self.open::<f32>(given, &loads, after, by)?),
            Precision::F64 => by.fill(&mut self.open::<f64>(given, &loads, after, by)?),
        }
    }

    /// Opens the table, writes the scene of the run next to it, and says the warnings so far.
    fn open<T: Scalar>(self, given: Problem, loads: &[Load], after: After, by: &impl Fill) -> Outcome<Table<'a, T>> {
        let Self { ref problem, out, scene, processes, force, printing, .. } = self;
        let (Problem { posed, table: law_table, works }, of_case) = (given, problem.case.scene());
        let grid = *posed.surface.grid();
        let theories = by.theories(&posed.surface, of_case)?;
        if grid.is_shared() && grid.nodes() > WHOLE {
            processes.alone("a table of more than 4096 x 4096 nodes")?;
        }
        let mut session = scene.keys::<Strictness>().session::<T>(posed, processes)?;
        let way = by.way(loads, session.full_pressure(loads)?, &scene.given)?;
        let control = way.control(of_case);
        // the softest mode of a path is on the grid of the surface
        if of_case.elastic.boundary == Boundary::Free && matches!(way, Way::Cycle(..)) {
            processes.alone("a cycle with --boundary free")?;
        }
        let start = problem.start(&mut session, processes)?;
        by.refine(&mut session, &way, &self, start.is_some())?;
        let mut scene_file = None;
        processes.first(|| {
            check_apart(out, problem.files().chain(problem.files.initial_gap.as_deref()))?;
            scene.check_next_to(out, force || out.exists())?;
            warnings::check_beside(out, force || out.exists())?;
            scene_file = Some(scene.write_next_to(out)?);
            Ok(())
        })?;
        let (path, format, fields) = (out.to_owned(), Some(self.format), self.fields.map(Path::to_owned));
        let file = TableFile { out: path, format, fields, force, law_table, works, ..TableFile::default() };
        let mut rows = session.begin(way, after, self.interface, start, Some(file))?;
        let count = rows.count();
        say_new(rows.warnings());
        processes.first(|| {
            scene_file.map_or(Ok(()), OutputFile::commit)?;
            rows.warnings().keep_beside(out, count > 0)
        })?;
        if count > 0 {
            printing.say(&format!("{} has {count}{} rows already", name(out), of_rows(&rows, " of ")));
        }
        let table = Table { options: self, rows, theories, control, nodes: grid.nodes() };
        table.stands();
        Ok(table)
    }
}

impl<T: Scalar> Table<'_, T> {
    /// Sets what an interruption says of the rows.
    fn stands(&self) {
        let TableOptions { out, force, .. } = &self.options;
        let command = if *force { "the same command without --force" } else { "the same command" };
        let (rows, of, out) = (self.rows.count(), of_rows(&self.rows, " of "), out.display());
        interruption::stands(format!("{rows}{of} rows are in {out}: {command} continues from there"));
    }

    /// Whether the boundary is free.
    pub fn is_free(&self) -> bool {
        self.options.problem.case.scene().elastic.boundary == Boundary::Free
    }

    /// Whether loads are searched for.
    pub fn searches(&self) -> bool {
        matches!(self.options.problem.case.given().loads().as_deref(), Ok([Load::Fraction(_), ..]))
    }

    /// Does something in the first process alone.
    pub fn first(&self, work: impl FnOnce() -> Outcome<()>) -> Outcome<()> {
        self.options.processes.first(work)
    }

    /// Says what is asked of a cycle and what that is likely to take, before its first row.
    pub fn announce(&self) {
        let asked = self.rows.pace().and_then(|pace| pace.forecast());
        asked.iter().for_each(|asked| self.options.printing.say(asked));
    }

    /// Solves the next row, while a bar has its number, and appends it. Refuses a solution that ran away, and says its
    /// warnings; returns no row at the end of the course.
    pub fn extend(&mut self) -> Outcome<Option<Row>> {
        let TableOptions { problem, printing, .. } = &self.options;
        if self.rows.of_rows() == Some(self.rows.count()) {
            return Ok(None);
        }
        let name = format!("{}{}", self.rows.count() + 1, of_rows(&self.rows, "/"));
        let tolerance = problem.case.scene().tolerance();
        let mut progress = Progress::new(&name, tolerance, self.nodes, printing.without_bars());
        progress.follow(self.rows.pace().copied());
        let found = self.rows.next(&mut |state| {
            progress.update(state);
            ControlFlow::Continue(())
        });
        drop(progress);
        say_new(self.rows.warnings());
        let Some((_, row)) = found? else { return Ok(None) };
        self.stands();
        Ok(Some(row))
    }

    /// The limits of no range of a complete cycle, where the same cycle on a coarser grid tells them, which a bar follows if
    /// it is ahead.
    pub fn limit(&mut self) -> Outcome<Option<CycleLimits>> {
        let TableOptions { problem, printing, .. } = &self.options;
        let ahead = self.rows.coarser_shape();
        if let Some((nx, ny)) = ahead {
            printing.say(&format!("the same on {nx} x {ny} nodes, for the error of the grid"));
        }
        let (tolerance, nodes) = (problem.case.scene().tolerance(), ahead.map_or(0, |(nx, ny)| nx * ny));
        let is_quiet = printing.without_bars() || ahead.is_none();
        let mut progress = Progress::new("coarser", tolerance, nodes, is_quiet);
        self.rows.cycle_limit(&mut |state| {
            progress.update(state);
            ControlFlow::Continue(())
        })
    }

    /// Solves all rows that are left, says each in a line, and returns the rows of the file.
    pub fn solve(&mut self) -> Outcome<Vec<Value>> {
        let (out, printing) = (self.options.out, self.options.printing);
        let count = self.rows.of_rows().unwrap_or_default();
        let width = count.to_string().len();
        while let Some(row) = self.extend()? {
            let (rows, account) = (self.rows.count(), &row.account);
            printing.say(&format!("{rows:>width$}/{count}  {}", self.brief(account)));
            // rows that have not converged are counted at the end
            let short = shortfalls(account, Skin::Options).into_iter().filter(|(what, _)| *what != "convergence");
            short.for_each(|(_, text)| complain("warning", &format!("row {rows}: {text}")));
        }
        printing.say(&format!("{count} rows in {}", name(out)));
        self.rows.read()
    }

    /// The row for people.
    pub fn brief(&self, account: &Account) -> String {
        let units = &self.rows.facts().units;
        let load = match account.approach {
            Some(approach) => {
                let (force, approach) = (units.number(account.normal_force, FORCE), units.number(approach, LENGTH));
                format!("normal force {force}  approach {approach}")
            }
            None => {
                let pressure = units.number(account.mean_pressure, PRESSURE);
                let gap = units.number(account.mean_gap, LENGTH);
                format!("mean pressure {pressure}  mean gap {gap}")
            }
        };
        format!("{load}  contact {} %  {}", percent(account.contact_fraction), account.status)
    }

    /// The report on the table: the number of its rows, the figures that a command `found` in them, and the inputs.
    pub fn report(&self, found: Value) -> Value {
        let (control, TableOptions { out, problem, .. }) = (self.control, &self.options);
        let mut outcome = Map::from_iter([
            ("control".to_owned(), control.name().into()),
            ("rows".to_owned(), self.rows.count().into()),
            ("unconverged".to_owned(), self.rows.unconverged().into()),
            ("out".to_owned(), out.to_string_lossy().into()),
            ("spring_stiffness".to_owned(), problem.case.given().spring_stiffness().into()),
        ]);
        outcome.extend(found.as_object().cloned().unwrap_or_default());
        outcome.insert("warnings".to_owned(), json!(self.rows.facts().warnings.all()));
        report::report(self.rows.command(), outcome.into(), &self.rows.facts().inputs)
    }

    /// Whether all rows converged; if not, a warning says so, with what else may help.
    pub fn converged(&self, remedy: &str) -> bool {
        let (count, rows) = (self.rows.unconverged(), self.rows.count());
        if count > 0 {
            let precise = match self.options.problem.case.scene().precision {
                Precision::F32 => "use --precision f64, ",
                Precision::F64 => "",
            };
            let text = format!(
                "{UNCONVERGED}: {count} of {rows} rows not converged: {precise}raise --max-iterations {remedy}"
            );
            complain("warning", &text);
        }
        count == 0
    }
}
