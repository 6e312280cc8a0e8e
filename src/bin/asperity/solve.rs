use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use asperity::io::{OutputFolder, read_field, write_npy};
use asperity::{
    AdhesionLaw, Control, Criterion, Error, Exponential, Grid, MaugisDugdale, NoAdhesion, Settings, Status, Surface,
};
use clap::{ArgGroup, Args, ValueEnum};
use ndarray::Array2;
use serde_json::{Value, json};

use crate::progress::Progress;
use crate::report::{Style, table, warn};
use crate::run::{self, Account, Case, Scalar, Units};
use crate::{Outcome, say};

/// Solve a contact problem given by files.
///
/// All quantities are in any consistent units, as m, Pa and J/m². Writes gap.npy, pressure.npy (the full elastic
/// pressure, compression positive), contact_pressure.npy (its repulsive part), report.json, contact.png and
/// pressure.png, all or none. Exits with 0 if converged, 2 if not (the fields are written all the same), and 1 if
/// the input is refused or the files cannot be written (then there are none).
#[derive(Args)]
#[command(after_help = EXAMPLES, group(ArgGroup::new("load").required(true).args(["mean_gap", "mean_pressure"])))]
pub struct Options {
    /// Heights of the rough surface, shape (Nx, Ny), peaks up: .npy, .npz with one array, or a text matrix
    #[arg(long, value_name = "FILE", help_heading = "Surface")]
    heights: PathBuf,
    /// Side lengths of the map, in the unit of the heights; LX alone means square cells [default: 1 1]
    #[arg(long, value_names = ["LX", "LY"], num_args = 1..=2, allow_negative_numbers = true, value_parser = positive)]
    #[arg(help_heading = "Surface")]
    lengths: Option<Vec<f64>>,
    /// Contact modulus E*, a pressure
    #[arg(long, value_name = "E", default_value = "1", allow_hyphen_values = true, value_parser = positive)]
    #[arg(help_heading = "Surface")]
    modulus: f64,

    /// Mean gap that is held, a length
    #[arg(long, value_name = "G", allow_hyphen_values = true, value_parser = non_negative, help_heading = "Load")]
    mean_gap: Option<f64>,
    /// Mean external pressure that is held, compression positive
    #[arg(long, value_name = "P", allow_hyphen_values = true, value_parser = finite, help_heading = "Load")]
    mean_pressure: Option<f64>,

    /// Adhesion law
    #[arg(long, value_enum, default_value_t = Law::None, help_heading = "Adhesion")]
    law: Law,
    /// Work of adhesion, an energy per area
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = non_negative, help_heading = "Adhesion")]
    work_of_adhesion: Option<f64>,
    /// Range of adhesion, a length
    #[arg(long, value_name = "RHO", allow_hyphen_values = true, value_parser = positive, help_heading = "Adhesion")]
    range: Option<f64>,

    /// Preconditioned conjugate gradients, or the algorithm of Rey et al. (2017)
    #[arg(long, value_enum, default_value_t = Iteration::Default, help_heading = "Solver")]
    method: Iteration,
    /// Certified relative error at which to stop [default: 1e-6, in f32 1e-5]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = positive, help_heading = "Solver")]
    tolerance: Option<f64>,
    /// Iterations after which to give up [default: 2000, with rey2017 20000]
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Solver")]
    max_iterations: Option<usize>,
    /// Precision of the solve, and of the fields it writes
    #[arg(long, value_enum, default_value_t = Precision::F64, help_heading = "Solver")]
    precision: Precision,
    /// Threads; the results do not depend on it [default: one per core]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = threads, help_heading = "Solver")]
    threads: Option<usize>,
    /// Gap from which to start, of the shape of the heights; scaled to --mean-gap if that is given
    #[arg(long, value_name = "FILE", help_heading = "Solver")]
    initial_gap: Option<PathBuf>,

    /// Folder for the results, made if needed
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    out: PathBuf,
    /// Replace results that are there
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print no table and no progress
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Write no .png files
    #[arg(long, help_heading = "Output")]
    no_pictures: bool,
    /// Unit of the lengths, on pictures only; m gets prefixes
    #[arg(long, value_name = "UNIT", help_heading = "Output")]
    length_unit: Option<String>,
    /// Unit of the pressures, on pictures only; Pa gets prefixes
    #[arg(long, value_name = "UNIT", help_heading = "Output")]
    pressure_unit: Option<String>,
}

const EXAMPLES: &str = "\
Examples:
  Press a map of 1 by 1, with a contact modulus of 1, to a mean gap of 0.04:
    asperity solve --heights heights.npy --mean-gap 0.04 --out results
  The surface of the demo (asperity-demo/heights.npy) in SI units, with adhesion:
    asperity solve --heights heights.npy --lengths 1e-6 1e-6 --modulus 1e9 \\
      --law exponential --work-of-adhesion 0.05 --range 1e-9 \\
      --mean-pressure 2.5e6 --length-unit m --pressure-unit Pa --out sticky
  On from there to a tension:
    asperity solve --heights heights.npy --lengths 1e-6 1e-6 --modulus 1e9 \\
      --law exponential --work-of-adhesion 0.05 --range 1e-9 \\
      --mean-pressure -1e4 --initial-gap sticky/gap.npy --out pulled";

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Law {
    /// no adhesion
    None,
    /// constant traction W/RHO up to a gap of RHO
    MaugisDugdale,
    /// traction W/RHO exp(-gap/RHO)
    Exponential,
}

#[derive(Clone, Copy, ValueEnum)]
enum Iteration {
    Default,
    Rey2017,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Precision {
    F32,
    F64,
}

const FIELDS: [&str; 4] = ["gap.npy", "pressure.npy", "contact_pressure.npy", "report.json"];
const PICTURES: [&str; 2] = ["contact.png", "pressure.png"];

/// Runs the command; whether it converged.
pub fn run(options: &Options) -> Outcome<bool> {
    options.check_law()?;
    let names: Vec<_> = FIELDS.iter().chain(PICTURES.iter().filter(|_| !options.no_pictures)).copied().collect();
    // Only a trial: a solve that is interrupted leaves nothing behind.
    drop(OutputFolder::create(&options.out, &names, options.force)?);
    let surface = options.surface()?;
    let start = options.start(surface.grid())?;
    let job = Job { options, names, threads: run::use_threads(options.threads)?, case: options.case() };
    match options.precision {
        Precision::F32 => job.with_law::<f32>(surface, start),
        Precision::F64 => job.with_law::<f64>(surface, start),
    }
}

impl Options {
    /// Refuses a law without its parameters, and parameters without a law.
    fn check_law(&self) -> Outcome<()> {
        let parameters =
            [("--work-of-adhesion", self.work_of_adhesion, "an energy per area"), ("--range", self.range, "a length")];
        for (name, value, what) in parameters {
            match (self.law, value) {
                (Law::None, Some(value)) => {
                    let remedy = "choose --law exponential or --law maugis-dugdale, or leave it out";
                    return Err(format!("{name} is {value}, but there is no adhesion: {remedy}").into());
                }
                (Law::None, None) | (_, Some(_)) => {}
                (law, None) => return Err(format!("--law {law} lacks {name}: give it, {what}").into()),
            }
        }
        Ok(())
    }

    fn surface(&self) -> Outcome<Surface> {
        let heights = read_field(&self.heights)?;
        Ok(Surface::new(run::grid(heights.dim(), self.lengths.as_deref())?, heights)?)
    }

    fn start(&self, grid: &Grid) -> Outcome<Option<Array2<f64>>> {
        let Some(path) = &self.initial_gap else { return Ok(None) };
        let start = read_field(path)?;
        if start.dim() != grid.shape() {
            return Err(Error::Shape { name: "--initial-gap", found: start.dim(), expected: grid.shape() }.into());
        }
        Ok(Some(start))
    }

    fn case(&self) -> Case {
        let control = match (self.mean_gap, self.mean_pressure) {
            (Some(gap), _) => Control::MeanGap(gap),
            (None, pressure) => Control::MeanPressure(pressure.unwrap_or_default()),
        };
        let default = match self.method {
            Iteration::Default => Settings::default(),
            Iteration::Rey2017 => Settings { criterion: Criterion::EnergyNorm, ..Settings::rey2017() },
        };
        let reachable = if self.precision == Precision::F32 { 1e-5 } else { 1e-6 };
        let settings = Settings {
            tolerance: self.tolerance.unwrap_or(reachable),
            max_iterations: self.max_iterations.unwrap_or(default.max_iterations),
            ..default
        };
        Case { modulus: self.modulus, control, settings }
    }
}

/// A solve with all that was chosen for it.
struct Job<'a> {
    options: &'a Options,
    names: Vec<&'static str>,
    threads: usize,
    case: Case,
}

impl Job<'_> {
    fn with_law<T: Scalar>(&self, surface: Surface, start: Option<Array2<f64>>) -> Outcome<bool> {
        let parameter = |value: Option<f64>| T::lit(value.unwrap_or_default());
        let (work, range) = (parameter(self.options.work_of_adhesion), parameter(self.options.range));
        match self.options.law {
            Law::None => self.run::<T, _>(surface, start, NoAdhesion),
            Law::MaugisDugdale => self.run(surface, start, MaugisDugdale::new(work, range)?),
            Law::Exponential => self.run(surface, start, Exponential::new(work, range)?),
        }
    }

    fn run<T: Scalar, L: AdhesionLaw<T>>(&self, surface: Surface, start: Option<Array2<f64>>, law: L) -> Outcome<bool> {
        let Options { out, force, quiet, .. } = self.options;
        let grid = *surface.grid();
        // In place, if the precision is that of the file.
        let start = start.map(|gap| gap.mapv_into_any(T::lit));
        let progress = Progress::new("", self.case.settings.tolerance, grid.nodes(), *quiet);
        let (solution, account) = run::solve(surface, law, &self.case, start, progress)?;

        let folder = OutputFolder::create(out, &self.names, *force)?;
        let written = self.write(&folder, grid, &solution, &account);
        written.map_err(|error| run::at_destination(error, out))?;
        folder.commit()?;

        if !quiet {
            say(&table(&[], &[&account], Style::Plain));
            say(&format!("results in {}: {}", out.display(), self.names.join(", ")));
        }
        warn("", &account, &self.case, self.options.range.unwrap_or_default());
        Ok(account.report.status == Status::Converged)
    }

    fn write<T: Scalar>(
        &self,
        folder: &OutputFolder,
        grid: Grid,
        solution: &asperity::Solution<T>,
        account: &Account,
    ) -> asperity::Result<()> {
        let path = |name: &str| folder.path(name);
        write_npy(&path("gap.npy"), &solution.gap)?;
        write_npy(&path("pressure.npy"), &solution.pressure)?;
        write_npy(&path("contact_pressure.npy"), &solution.contact_pressure)?;
        write_text(&path("report.json"), &format!("{:#}\n", self.report(grid, account)))?;
        if !self.options.no_pictures {
            let Options { length_unit, pressure_unit, .. } = self.options;
            let units = Units { length: length_unit.as_deref(), pressure: pressure_unit.as_deref() };
            run::draw_contact(&path("contact.png"), grid, "Contact", units, &solution.gap)?;
            let pressure = run::pressure_to_draw(solution, self.options.law != Law::None);
            run::draw_pressure(&path("pressure.png"), grid, "Pressure", "", units, pressure)?;
        }
        Ok(())
    }

    /// All that one needs for understanding a run later; numbers that are not finite become null.
    fn report(&self, grid: Grid, account: &Account) -> Value {
        let Self { options, case, .. } = self;
        let report = &account.report;
        let (control, held) = match case.control {
            Control::MeanGap(gap) => ("mean-gap", gap),
            Control::MeanPressure(pressure) => ("mean-pressure", pressure),
        };
        json!({
            "status": report.status.name(),
            "relative_error": report.relative_error,
            "load_error": report.load_error,
            "iterations": report.iterations,
            "operator_applications": report.operator_applications,
            "mean_gap": report.mean_gap,
            "mean_pressure": report.mean_pressure,
            "mean_contact_pressure": report.mean_contact_pressure,
            "contact_fraction": report.contact_fraction,
            "contact_points": report.contact_points,
            "min_gap": report.min_gap,
            "min_pressure": account.pressures.0,
            "max_pressure": account.pressures.1,
            "elastic_energy": report.elastic_energy,
            "adhesive_energy": report.adhesive_energy,
            "mu_rho": report.mu_rho,
            "under_resolved": report.under_resolved,
            "precision": report.precision,
            "method": report.method.name(),
            "seconds": account.seconds,
            "threads": self.threads,
            "heights": options.heights.to_string_lossy(),
            "initial_gap": options.initial_gap.as_deref().map(Path::to_string_lossy),
            "shape": grid.shape(),
            "lengths": grid.lengths(),
            "modulus": case.modulus,
            "law": options.law.to_string(),
            "work_of_adhesion": options.work_of_adhesion,
            "range": options.range,
            "control": control,
            "control_value": held,
            "tolerance": case.settings.tolerance,
            "max_iterations": case.settings.max_iterations,
            "version": env!("CARGO_PKG_VERSION"),
        })
    }
}

pub fn write_text(path: &Path, text: &str) -> asperity::Result<()> {
    fs::write(path, text).map_err(|e| Error::file(path, format!("cannot be written: {e}")))
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "none",
            Self::MaugisDugdale => "maugis-dugdale",
            Self::Exponential => "exponential",
        })
    }
}

fn number(text: &str, allowed: fn(f64) -> bool, requirement: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(value) if allowed(value) => Ok(value),
        _ => Err(format!("it must be {requirement}")),
    }
}

pub fn positive(text: &str) -> Result<f64, String> {
    number(text, |v| v > 0.0 && v.is_finite(), "a number, positive and finite")
}

fn non_negative(text: &str) -> Result<f64, String> {
    number(text, |v| v >= 0.0 && v.is_finite(), "a number, zero or positive and finite")
}

fn finite(text: &str) -> Result<f64, String> {
    number(text, f64::is_finite, "a number, and finite")
}

/// How many threads; far more than there are cores are a slip of the pen.
pub fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(threads @ 1..=1024) => Ok(threads),
        _ => Err("it must be from 1 to 1024; leave the option out for one per core".to_owned()),
    }
}
