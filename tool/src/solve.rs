//! `asperity solve`: the equilibrium at one load.

mod others;
mod written;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use asperity::{Solution, Status};
use asperity_maps::io::OutputFolder;
use asperity_scene::{
    Account, Boundary, Kind, Outcome, Part, Posed, Precision, Processes, Request, Scalar, Session, Solved, WHOLE, Word,
    choice, gap_to_write, keys, write_fields,
};
use ndarray::Array2;
use serde_json::json;

use self::others::{Named, OTHERS, other_fields};
use crate::command::Call;
use crate::options::ProblemOptions;
use crate::pictures::MapColours;
use crate::printing::{Printing, complain};
use crate::progress::Progress;
use crate::results::{self, Results};
use crate::session::{Strictness, say_new};
use crate::summary::{table, warn};

keys! {
    /// Solve a contact problem under one load.
    ///
    /// Either all numbers have units, such as 70GPa, 20um, 50mJ/m2, 5nN or 40N/m, or none has, and then any consistent
    /// units will do. With units all results are in SI units, and heights of a file that names no unit are in m. The folder
    /// gets gap.npy, pressure.npy (the full elastic pressure, compression positive) and contact_pressure.npy (its repulsive
    /// part), and with a hardness plastic_depth.npy; --format chooses other files. It also gets report.json, contact.png
    /// and pressure.png (or .svg, .pdf), and scene.toml, which repeats the run. Either all files are written or none. Exits
    /// with 0 if converged, 2 if not (the fields are still written), and 1 if the input is refused or the files cannot be
    /// written. Probable mistakes, such as a tilt, give warnings, one line each and in the report; --strict treats them as
    /// errors.
    ///
    /// # Examples
    ///   Press a map of 1 by 1, with a contact modulus of 1, to a mean gap of 0.04:
    ///     asperity solve --heights heights.npy --mean-gap 0.04 --out results
    ///   The surface of the demo (asperity-demo/heights.npy) in SI units, with adhesion:
    ///     asperity solve --heights heights.npy --lengths 1um --modulus 1GPa --mean-pressure 2.5MPa \
    ///       --law exponential --work-of-adhesion 50mJ/m2 --range 1nm --out sticky
    ///   The same load without adhesion, by way of coarser grids, which is the default where it is faster:
    ///     asperity solve --heights heights.npy --lengths 1um --modulus 1GPa --mean-pressure 2.5MPa \
    ///       --nested --out nested
    ///   A contact area that is right to 5 %, on a grid as fine as that takes:
    ///     asperity solve --heights heights.npy --mean-pressure 0.01 --accuracy 0.05 --out right
    ///   Continue from the case with adhesion to a tension:
    ///     asperity solve --heights heights.npy --lengths 1um --modulus 1GPa --mean-pressure -10kPa \
    ///       --law exponential --work-of-adhesion 50mJ/m2 --range 1nm --initial-gap sticky/gap.npy \
    ///       --out pulled
    Options {
        "Output" {
            /// Folder for the results, without which they are only printed; made if needed
            out: Option<PathBuf> = Kind::folder(),
            /// Replace results that are there
            force: bool = Kind::switch(),
            /// Fields to write besides gap and pressures. If the second body is rigid, displacement.npy is gap plus
            /// height, less a plastic depth. If both are elastic, it is the displacement of the first one, and
            /// against_displacement.npy the displacement of the second
            fields: Option<String> = Kind::word(|| Word::all(&["displacement"]), &["FIELD"]).needs(&["out"]),
            /// Write distribution.csv: the probability density of the contact pressure over the nodes, in this many bins
            /// from 0 to the largest pressure; its integral is the contact fraction [default: 50 if --distribution has no
            /// value]
            distribution: Option<usize> = Kind::bins(&["BINS"]).alone("50").needs(&["out"]),
            /// Files for the fields: .npy one each, all in fields.npz for NumPy, or in fields.vti for ParaView; may be
            /// repeated
            format: Vec<Format> = Kind::word(Format::words, &["FORMAT"]).or("npy").commas(),
            /// Write no pictures
            no_pictures: bool = Kind::switch(),
        }
    }
}

choice! {
    /// A format of the files of fields.
    Format {
        /// one file for each field
        Npy = "npy",
        /// one file, for NumPy
        Npz = "npz",
        /// one file, for ParaView
        Vti = "vti",
    }
}

/// The fields of a solution.
pub const FIELDS: [&str; 3] = ["gap.npy", "pressure.npy", "contact_pressure.npy"];
const NPZ: &str = "fields.npz";
const VTI: &str = "fields.vti";
const DISTRIBUTION: &str = "distribution.csv";
const PICTURES: [&str; 2] = ["contact", "pressure"];

/// All files that a solve may leave.
pub fn files() -> Vec<String> {
    results::files(&[&FIELDS[..], &OTHERS, &[NPZ, VTI, DISTRIBUTION]].concat(), &PICTURES)
}

/// Runs the command; whether it converged.
pub fn run(&Call { scene, processes }: &Call<'_>) -> Outcome<bool> {
    let problem = &ProblemOptions::new(&scene.given)?;
    let options = scene.keys::<Options>();
    options.check_asked(problem, processes)?;
    scene.keys::<MapColours>().check()?;
    let Options { ref out, force, .. } = options;
    let results = out.as_deref().map(|out| Results { out, scene, files: files(), force });
    processes.first(|| results.as_ref().map_or(Ok(()), |results| results.check(problem.files())))?;
    let posed = problem.read(processes)?.posed;
    let pictures = !options.no_pictures && results.is_some();
    let job = Job { options: &options, problem, results, processes, part: posed.part, pictures };
    match problem.case.scene().precision {
        Precision::F32 => job.run::<f32>(posed),
        Precision::F64 => job.run::<f64>(posed),
    }
}

/// Solves behind a bar of progress, and announces the grids of a wanted accuracy.
fn solve_with_progress<T: Scalar>(
    session: Session<T>,
    request: &Request,
    start: Option<Array2<T>>,
    printing: &Printing,
) -> Outcome<Solved<T>> {
    let tolerance = session.tolerance(request.goal)?;
    let mut progress = Progress::new("", tolerance, session.grid().nodes(), printing.without_bars());
    if let Some(goal) = request.goal {
        let (plan, time) = session.plan(request.control, goal)?;
        printing.say(&goal.announced(&plan, time));
    }
    session.solve(request, start, &mut progress.on_grids())
}

/// Whether all goals beside the convergence are reached: of an accuracy, of a search and of a leakage.
fn has_reached(account: &Account) -> bool {
    account.accuracy.as_ref().is_none_or(|reached| reached.reached)
        && account.search.as_ref().is_none_or(|search| search.reached)
        && account.transmissivity.is_none_or(|found| found.reached())
}

impl Options {
    fn writes(&self, format: Format) -> bool {
        self.format.contains(&format)
    }

    /// Refuses what excludes each other, and what has no form for several processes.
    fn check_asked(&self, problem: &ProblemOptions, processes: &Processes) -> Outcome<()> {
        let asked = problem.case.request(1.0, problem.files.initial_gap.is_some())?;
        if self.fields.is_some() && problem.case.scene().elastic.boundary == Boundary::Free {
            processes.alone("--fields displacement with a free boundary")?;
        }
        if asked.goal.is_some() {
            processes.alone("--accuracy")?;
        }
        problem.check_after(&asked.after, processes)
    }
}

/// A solve with all that was chosen for it.
struct Job<'a> {
    options: &'a Options,
    problem: &'a ProblemOptions,
    /// The folder of the results, if they are to be written
    results: Option<Results<'a>>,
    processes: &'a Processes,
    part: Part,
    pictures: bool,
}

impl Job<'_> {
    fn run<T: Scalar>(mut self, posed: Posed) -> Outcome<bool> {
        let (options, processes, mut grid) = (self.options, self.processes, *posed.surface.grid());
        let given = self.problem.case.given();
        let printing: Printing = given.keys();
        let fits = !grid.is_shared() || grid.nodes() <= WHOLE;
        if !fits {
            self.leave_out_what_takes_whole_fields()?;
        }
        let kept = options.fields.as_ref().map(|_| posed.surface.clone());
        let session = given.keys::<Strictness>().session::<T>(posed, processes)?;
        let mut session = session.with_slopes();
        let start = self.problem.start(&mut session, processes)?.map(T::field);
        let full = session.full_pressure(&[self.problem.case.load()?])?;
        let asked = self.problem.case.request(full, start.is_some())?;
        say_new(&mut session.facts.warnings);
        let mut solved = solve_with_progress(session, &asked, start, &printing)?;
        say_new(&mut solved.facts.warnings);
        let refined = solved.found.refined.take().map(Arc::new);
        if refined.is_some() {
            grid = solved.found.solution.grid;
            self.part = self.part.on(grid)?;
        }
        solved.look()?;
        let Solved { found, account, facts } = solved;
        let whole = fits.then(|| found.solution.whole());
        let surface = kept.map(|kept| refined.unwrap_or(kept));
        let mut beside = other_fields(&found, &self.problem.case.scene().elastic, surface.as_deref())?;

        let mut told = Vec::new();
        if let Some(results) = &self.results {
            let folder = processes.agree(processes.is_first().then(|| results.folder()).transpose())?;
            if options.writes(Format::Npy) {
                self.write_arrays((folder.as_ref(), results.out), &found.solution, &beside)?;
            }
            for (_, field) in beside.iter_mut().filter(|_| fits) {
                *field = grid.whole(std::mem::take(field)).into_owned();
            }
            let mut beyond = None;
            processes.first(|| {
                let Some(folder) = folder else { return Ok(()) };
                let write = |folder: &_| self.write(folder, &facts.units, whole.as_deref(), &beside, &account);
                beyond = results.write(folder, write)?;
                Ok(())
            })?;
            told.push(results.list());
            told.extend(beyond.map(|load| format!("beyond the colours of the pressure: {load}")));
        }

        printing.say(&table(&[], &[&account], &facts.units));
        told.iter().for_each(|line| printing.say(line));
        printing.report(|| json!(account));
        warn("", &account);
        Ok(account.status == Status::Converged && has_reached(&account))
    }

    /// Writes the fields of a solution, and fields beside them, as arrays; each process the rows that it holds.
    fn write_arrays<T: Scalar>(
        &self,
        (folder, out): (Option<&OutputFolder>, &Path),
        solution: &Solution<T>,
        beside: &[Named],
    ) -> Outcome<()> {
        let (shown, part) = (&*self.part.of_solution(solution)?, self.part.grid());
        let gap = gap_to_write(shown);
        let fields = [&*gap, &shown.pressure, &shown.contact_pressure];
        let named: Vec<_> = FIELDS.into_iter().map(str::to_owned).zip(fields).collect();
        write_fields(self.processes, folder, out, part, &named)?;
        for (name, field) in beside {
            let field = self.part.of_field(field.clone())?;
            write_fields(self.processes, folder, out, part, &[((*name).to_owned(), &field)])?;
        }
        Ok(())
    }

    /// Leaves out the pictures, and refuses files, for which one process would have to take the whole of the fields.
    fn leave_out_what_takes_whole_fields(&mut self) -> Outcome<()> {
        for (format, name) in [(Format::Npz, "--format npz"), (Format::Vti, "--format vti")] {
            if self.options.writes(format) {
                self.processes.alone(&format!("{name} of more than 4096 x 4096 nodes"))?;
            }
        }
        if self.options.distribution.is_some() {
            self.processes.alone("--distribution of more than 4096 x 4096 nodes")?;
        }
        if self.pictures {
            let text = "pictures, and a look for mistakes in the heights and in the answer, have no form for several \
                        processes and more than 4096 x 4096 nodes: there are none";
            complain("warning", text);
        }
        self.pictures = false;
        Ok(())
    }
}
