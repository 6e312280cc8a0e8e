//! The table that `asperity sweep` and `asperity cycle` fill: a row for each equilibrium, in the order of the loads.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use asperity::{Control, Status};
use asperity_scene::interface::touch;
use asperity_scene::{
    Account, After, Asked, Boundary, Course, Fields, Format, Inputs, Load, Opening, Posed, Precision, Row, Way,
};
use clap::Args;
use serde_json::{Map, Value, json};

use crate::fields::check_finite;
use crate::interruption;
use crate::numbers::percent;
use crate::options::{Problem, ProblemOptions, Scalar};
use crate::outcome::Outcome;
use crate::output::{OutputFile, check_apart};
use crate::part::Part;
use crate::printing::{Printing, complain, in_options, name};
use crate::processes::{Processes, WHOLE};
use crate::progress::Progress;
use crate::quantity::{FORCE, LENGTH, PRESSURE};
use crate::report;
use crate::scene::{self, SceneFile};
use crate::study;
use crate::units::Units;
use crate::warnings::{self, Strictness, Warnings};

/// The code of the warning that rows have not converged; it stands before the message, as those of all warnings do.
pub const UNCONVERGED: &str = "unconverged";

/// The replacements, refusals and prints of a run that fills a table.
#[derive(Args)]
pub struct Manner {
    /// Start over, and replace files that are there
    #[arg(long, help_heading = "Output")]
    pub force: bool,
    #[command(flatten)]
    strictness: Strictness,
    #[command(flatten)]
    pub printing: Printing,
}

/// The options of a table.
#[derive(Clone, Copy)]
pub struct TableOptions<'a> {
    pub problem: &'a ProblemOptions,
    pub out: &'a Path,
    pub format: Format,
    /// The folder for the fields of the rows
    pub fields: Option<&'a Path>,
    pub scene: &'a SceneFile,
    pub processes: &'a Processes,
    pub manner: &'a Manner,
    /// The findings that are asked for after each row
    pub after: After,
    /// Whether the table is that of an interface
    pub interface: bool,
}

/// The work of a command on its table, in the precision of its solves; returns whether all rows converged.
pub trait Fill {
    /// The way through the loads.
    fn way<T: Scalar>(&self, loads: &[Load], full: f64) -> Outcome<Way>;

    /// Fills the table.
    fn fill<T: Scalar>(&self, table: &mut Table<'_, T>) -> Outcome<bool>;
}

/// A table on disk, new or continued, with the course of its rows, and the warnings of its run.
pub struct Table<'a, T: Scalar> {
    options: TableOptions<'a>,
    /// The kind of the loads
    control: Control,
    pub units: Units,
    part: Part,
    inputs: Inputs,
    seed: Option<u64>,
    posed: Posed<T>,
    course: Course<T>,
    rows: asperity_scene::Table,
    warnings: Warnings,
}

impl<'a> TableOptions<'a> {
    /// Reads the files of the problem, opens the table, and fills it.
    pub fn fill(self, by: &impl Fill) -> Outcome<bool> {
        let problem = self.problem;
        problem.check_table()?;
        let loads = in_options(problem.given.loads())?;
        problem.check_loads(&loads)?;
        problem.check_after(&self.after, self.processes)?;
        let given = problem.read(self.scene.is_si(), self.processes)?;
        match problem.scene.precision {
            Precision::F32 => by.fill(&mut self.open::<f32>(given, &loads, by)?),
            Precision::F64 => by.fill(&mut self.open::<f64>(given, &loads, by)?),
        }
    }

    /// Opens the table, writes the scene of the run beside it, and says the warnings so far.
    fn open<T: Scalar>(self, given: Problem, loads: &[Load], by: &impl Fill) -> Outcome<Table<'a, T>> {
        let Problem { surface, adhesion, origin, part, start } = given;
        let Self { problem, out, scene, processes, manner, .. } = self;
        let &Manner { force, strictness, printing } = manner;
        let full = problem.full_pressure(&surface, loads)?;
        let way = by.way::<T>(loads, full)?;
        let control = way.control(&problem.scene);
        part.check(control)?;
        let units = processes.agree(in_options(problem.given.units(origin.unit.as_deref(), scene.is_si())))?;
        let inputs = report::inputs(problem, &part, &units, scene);
        in_options(Asked { after: self.after, ..Asked::under(control) }.check(&inputs.adhesion, inputs.method, false))?;
        let course = Course::new(way.clone(), self.after)?.with(&inputs.adhesion);
        let mut course = if self.interface { course.of_interface(touch(&surface)) } else { course };
        let surface = Arc::new(surface);
        let mut posed =
            problem.scene.posed::<T>(surface.clone(), adhesion.law(), adhesion.hardness(), part.wanted())?;
        let afar = if start.is_none() { posed.start_afar(way.loads()) } else { None };
        if !printing.is_quiet() {
            course.expect(&posed)?;
        }
        let nodes = *posed.parts()?.1.operator().grid();
        course.check(&mut posed)?;
        let grid = *surface.grid();
        if grid.is_shared() && grid.nodes() > WHOLE {
            processes.alone("a table of more than 4096 x 4096 nodes")?;
        }
        // the softest mode of a path is on the grid of the surface
        if course.pace().is_some() && nodes.shape() != grid.shape() {
            processes.alone("a cycle with --boundary free")?;
        }
        let opening = Opening {
            out: out.to_owned(),
            format: self.format,
            names: Vec::new(),
            header: units.columns(&course.columns(), control.name(), grid.is_line()),
            fields: self.fields.map(Path::to_owned),
            force,
            // a study has the lock of its case: a former run of that is about to end
            is_case: study::is_worker(),
            beside: vec![scene::beside(out), warnings::beside(out)],
            identity: Map::new(),
            loads: None,
        };
        let (first, whole) = (start.as_ref().map(|start| grid.whole(start)), surface.whole());
        let warnings =
            Warnings::of_input::<T>(strictness, (&whole, &origin), &adhesion, &problem.scene.elastic, &units);
        let mut warnings = processes.agree(warnings)?;
        let mut opened = None;
        processes.first(|| {
            check_apart(out, problem.files().chain(problem.files.initial_gap.as_deref()))?;
            scene.check_beside(out, force || out.exists())?;
            warnings::check_beside(out, force || out.exists())?;
            let fields = Fields {
                surface: &whole,
                law_table: adhesion.table.as_deref(),
                works: adhesion.works.as_deref(),
                hardness: adhesion.hardness.as_deref(),
                start: first.as_deref(),
                law_differs: false,
            };
            let identity = posed.identity(&inputs, &units.of_table(), fields);
            let scene_file = (!study::is_worker()).then(|| scene.written_beside(out)).transpose()?;
            opened = Some((identity, scene_file));
            Ok(())
        })?;
        let (identity, scene_file) = opened.unzip();
        let opening = Opening { identity: identity.unwrap_or_default(), ..opening };
        let (rows, course) = course.open(opening, start.or(afar).map(T::field), &nodes, processes)?;
        let count = rows.rows();
        processes.first(|| {
            scene_file.flatten().map_or(Ok(()), OutputFile::commit)?;
            warnings.keep_beside(out, count > 0)
        })?;
        if count > 0 {
            let of = rows.of_rows().map_or(String::new(), |loads| format!(" of {loads}"));
            printing.say(&format!("{} has {count}{of} rows already", name(out)));
        }
        let table =
            Table { options: self, control, units, part, inputs, seed: origin.seed, posed, course, rows, warnings };
        table.stands();
        Ok(table)
    }
}

impl<T: Scalar> Table<'_, T> {
    /// Sets what an interruption says of the rows.
    fn stands(&self) {
        let TableOptions { out, manner, .. } = self.options;
        let of = self.rows.of_rows().map_or(String::new(), |loads| format!(" of {loads}"));
        let command = if manner.force { "the same command without --force" } else { "the same command" };
        let (rows, out) = (self.rows(), out.display());
        interruption::stands(format!("{rows}{of} rows are in {out}: {command} goes on from there"));
    }

    /// Whether the surfaces attract each other.
    pub fn adheres(&self) -> bool {
        self.options.problem.scene.adhesion.adheres()
    }

    /// Whether the boundary is free.
    pub fn is_free(&self) -> bool {
        self.options.problem.scene.elastic.boundary == Boundary::Free
    }

    /// Whether loads are searched for.
    pub fn searches(&self) -> bool {
        matches!(self.options.problem.given.loads().as_deref(), Ok([Load::Fraction(_), ..]))
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.rows.rows()
    }

    /// The number of rows when the table is complete, where that is known before.
    pub fn of_rows(&self) -> Option<usize> {
        self.rows.of_rows()
    }

    /// Does something in the first process alone.
    pub fn first(&self, work: impl FnOnce() -> Outcome<()>) -> Outcome<()> {
        self.options.processes.first(work)
    }

    /// All rows of the file.
    pub fn read(&self) -> Outcome<Vec<Value>> {
        self.rows.read(self.options.processes)
    }

    /// Says what is asked of a cycle and what that is likely to take, before its first row.
    pub fn announce(&self) {
        let asked = self.course.pace().and_then(|pace| pace.asked(self.posed.adheres()));
        asked.iter().for_each(|asked| self.options.manner.printing.say(asked));
    }

    /// Solves the next row, while a bar has its number, and appends it. Refuses a solution that ran away, and says its
    /// warnings; returns no row at the end of the course.
    pub fn extend(&mut self) -> Outcome<Option<Row>> {
        let TableOptions { problem, manner, processes, .. } = self.options;
        let of = self.rows.of_rows();
        if of == Some(self.rows()) {
            return Ok(None);
        }
        let name = format!("{}{}", self.rows() + 1, of.map_or(String::new(), |loads| format!("/{loads}")));
        let (tolerance, grid) = (problem.scene.tolerance(), *self.posed.parts()?.1.grid());
        let mut progress = Progress::new(&name, tolerance, grid.nodes(), manner.printing.without_bars());
        progress.follow(self.course.pace().copied());
        let found = self.course.next(&mut self.posed, &mut |state| {
            progress.update(state);
            ControlFlow::Continue(())
        });
        drop(progress);
        let Some(mut found) = found? else { return Ok(None) };
        check_finite(&found.solution)?;
        processes.agree(self.warnings.look_at(&found.solution.whole(), &self.part))?;
        let account = found.account(self.course.command(), &self.inputs, None, Vec::new())?;
        let row = self.course.row(&mut found, account, self.seed)?;
        let nodes = *self.posed.parts()?.1.operator().grid();
        self.course.append(&mut self.rows, (&found, &row), &nodes, processes)?;
        self.stands();
        Ok(Some(row))
    }

    /// Solves all rows that are left, says each in a line, and returns those of the file.
    pub fn solve(&mut self, out: &Path, printing: Printing) -> Outcome<Vec<Value>> {
        let count = self.of_rows().unwrap_or_default();
        let width = count.to_string().len();
        while let Some(row) = self.extend()? {
            let (rows, account) = (self.rows(), &row.account);
            printing.say(&format!("{rows:>width$}/{count}  {}", self.brief(account)));
            let converged = account.status == Status::Converged;
            if let Some(searched) = account.search.filter(|searched| converged && !searched.reached) {
                complain("warning", &format!("row {rows}: {}", searched.jump()));
            }
        }
        printing.say(&format!("{count} rows in {}", name(out)));
        self.read()
    }

    /// The row for people.
    pub fn brief(&self, account: &Account) -> String {
        let units = &self.units;
        let load = match account.approach {
            Some(approach) => {
                let (force, approach) = (units.number(account.normal_force, FORCE), units.number(approach, LENGTH));
                format!("normal force {force}  approach {approach}")
            }
            None => {
                let (pressure, gap) =
                    (units.number(account.mean_pressure, PRESSURE), units.number(account.mean_gap, LENGTH));
                format!("mean pressure {pressure}  mean gap {gap}")
            }
        };
        format!("{load}  contact {} %  {}", percent(account.contact_fraction), account.status)
    }

    /// The report on the table: the number of its rows, the figures that a command `found` in them, and the inputs.
    pub fn report(&self, found: Value) -> Value {
        let (control, TableOptions { out, problem, .. }) = (self.control, self.options);
        let mut outcome = Map::from_iter([
            ("control".to_owned(), control.name().into()),
            ("rows".to_owned(), self.rows().into()),
            ("unconverged".to_owned(), self.rows.unconverged().into()),
            ("out".to_owned(), out.to_string_lossy().into()),
            ("spring_stiffness".to_owned(), problem.given.spring_stiffness().into()),
        ]);
        outcome.extend(found.as_object().cloned().unwrap_or_default());
        outcome.insert("warnings".to_owned(), json!(self.warnings.found()));
        report::report(self.course.command(), outcome.into(), &self.inputs)
    }

    /// Whether all rows converged; if not, a warning says so, with what else may help.
    pub fn converged(&self, remedy: &str) -> bool {
        let (count, rows, path) = (self.rows.unconverged(), self.rows(), self.options.out.display());
        if count > 0 {
            let precise = match self.options.problem.scene.precision {
                Precision::F32 => "use --precision f64, as f32 ends where its rounding does, ",
                Precision::F64 => "",
            };
            let text = format!(
                "{UNCONVERGED}: {count} of {rows} rows not converged, their status and errors are in {path}: {precise}\
                 raise --max-iterations, {remedy}"
            );
            complain("warning", &text);
        }
        count == 0
    }
}
