//! `asperity demo`: a rough contact with and without adhesion, from nothing.

use std::ffi::{OsStr, OsString};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use asperity::{Amplitude, Grid, Jkr, NoAdhesion, SelfAffine, Status, Surface};
use asperity_maps::io::{OutputFolder, write_npy};
use asperity_plot::{Colouring, Map, Picture};
use asperity_scene::Inputs;
use clap::{Args, Command, FromArgMatches};
use ndarray::Array2;
use serde_json::json;

use crate::allowed::threads;
use crate::numbers::si;
use crate::outcome::Outcome;
use crate::output::{at_destination, write_text};
use crate::part::Part;
use crate::pictures::{self, PictureFormat, Resolution};
use crate::printing::{Printing, in_options, name, on_terminal};
use crate::progress::Progress;
use crate::report;
use crate::scene::{self, SceneFile};
use crate::solve;
use crate::summary::{table, warn};
use crate::threads::use_threads;
use crate::units::Units;

/// Press a built-in rough surface, without and with adhesion at the same load.
///
/// Prints a table and writes maps of the heights, the contact and the pressure. Needs no files. Beside the maps it
/// writes scene.toml, with which asperity run does the case with adhesion again: something to change and to try.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Options {
    /// Folder for the maps; those of an earlier demo are replaced
    #[arg(long, value_name = "DIR", default_value = "asperity-demo", help_heading = "Output")]
    out: PathBuf,
    /// Format of the maps
    #[arg(long, value_enum, value_name = "FORMAT", default_value = "png", help_heading = "Output")]
    picture_format: PictureFormat,
    #[command(flatten)]
    resolution: Resolution,
    #[command(flatten)]
    printing: Printing,
    /// Threads; the results do not depend on it [default: one per core]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = threads, help_heading = "Output")]
    threads: Option<usize>,
}

const EXAMPLES: &str = "\
\u{1b}[1;4mExamples:\u{1b}[0m
  Then the case with adhesion at half the pressure, and what is left of it without adhesion:
    asperity demo
    asperity run asperity-demo/scene.toml --mean-pressure 2.5MPa --out lighter
    asperity run asperity-demo/scene.toml --mean-pressure 2.5MPa --law none --out bare";

const SIDE: f64 = 1e-6;
const NODES: usize = 512;
const RMS_HEIGHT: f64 = 5e-9;
const MODULUS: f64 = 1e9;
const PRESSURE: f64 = 5e6;
const WORK_OF_ADHESION: f64 = 0.05;

/// The names of the maps, as yet without endings.
const MAPS: [&str; 5] = [
    "heights",
    "contact-without-adhesion",
    "contact-with-adhesion",
    "pressure-without-adhesion",
    "pressure-with-adhesion",
];

/// Runs the command; whether both solves converged.
pub fn run(options: &Options) -> Outcome<bool> {
    let &Options { ref out, printing, picture_format, resolution: Resolution { dpi }, .. } = options;
    let [ending] = picture_format.of([[".png"], [".svg"], [".pdf"]]);
    let maps = MAPS.map(|name| format!("{name}{ending}"));
    let names: Vec<_> = maps.iter().map(String::as_str).chain(["heights.npy", scene::NAME]).collect();
    let (bare_options, bare_scene) = solve_options(out, false)?;
    let (sticky_options, scene) = solve_options(out, true)?;
    scene.check(&out.join(scene::NAME))?;
    drop(OutputFolder::create(out, &names, true)?);
    use_threads(options.threads)?;

    let (grid, units) = (Grid::square(NODES, SIDE)?, Units::si());
    let surface = rough(grid)?;
    printing.say(&format!(
        "A rough surface of {side} by {side} ({NODES} x {NODES} nodes, rms height {}) pressed with {}\n\
         against a half-space of contact modulus {}, without adhesion and with a work of adhesion of {}.\n",
        si(RMS_HEIGHT, "m"),
        si(PRESSURE, "Pa"),
        si(MODULUS, "Pa"),
        si(WORK_OF_ADHESION, "J/m²"),
        side = si(SIDE, "m"),
    ));
    let heights = surface.heights().clone();
    let law = Jkr::new(WORK_OF_ADHESION)?;
    let part = Part::all(grid);
    let solved = |surface, law, name, options: &solve::Options, scene| -> Outcome<_> {
        let problem = options.problem()?;
        let tolerance = problem.scene.tolerance();
        let mut progress = Progress::new(name, tolerance, grid.nodes(), printing.without_bars());
        let asked = in_options(problem.given.load().and_then(|load| problem.given.asked(load, 1.0)))?;
        let mut posed = problem.scene.posed::<f64>(surface, law, None, part.wanted())?;
        let slopes = posed.slopes()?;
        let mut found = posed.solve_last(&asked, None, &mut |grid, state, tolerance| {
            progress.update_on(grid, state, tolerance);
            ControlFlow::Continue(())
        })?;
        let inputs = Inputs { slopes, ..report::inputs(&problem, &part, &units, scene) };
        let mut account = found.account("solve", &inputs, None, Vec::new())?;
        found.sight.look_at(&mut account, &found.solution)?;
        Ok((found.solution, account))
    };
    let none = Arc::new(NoAdhesion);
    let (bare, without) = solved(surface.clone(), none, "without adhesion", &bare_options, &bare_scene)?;
    let (sticky, with) = solved(surface, Arc::new(law), "with adhesion", &sticky_options, &scene)?;

    let folder = OutputFolder::create(out, &names, true)?;
    let draw = || {
        let path = |what: &str| folder.path(&format!("{what}{ending}"));
        draw_heights(grid, &heights, dpi)?.write(path("heights"))?;
        write_npy(folder.path("heights.npy"), &heights)?;
        write_text(&folder.path(scene::NAME), &scene.text(out))?;
        for (name, solution, adheres) in [("without adhesion", &bare, false), ("with adhesion", &sticky, true)] {
            let path = |what: &str| path(&format!("{what}-{}", name.replace(' ', "-")));
            let regions = solution.regions().mapv(f64::from);
            let contact = pictures::draw_regions(grid, &format!("Contact {name}"), &units, &regions, dpi)?;
            contact.write(path("contact"))?;
            let (caption, title) = (format!("mean {}", si(PRESSURE, "Pa")), format!("Pressure {name}"));
            let pressure = pictures::pressure_to_draw(solution, adheres);
            let pressure = pictures::draw_pressure(grid, (&title, &caption), &units, pressure, None, dpi)?;
            pressure.write(path("pressure"))?;
        }
        Ok(())
    };
    draw().map_err(|error| at_destination(error, out))?;
    folder.commit()?;

    printing.say(&table(&["without adhesion", "with adhesion"], &[&without, &with], &units));
    printing.say(&format!("\nmaps in {}: {}\n", name(out), names.join(", ")));
    let command: Vec<_> = arguments(out, true).iter().map(|word| quoted(word)).collect();
    let (command, file) = (command.join(" "), quoted(out.join(scene::NAME).as_os_str()));
    printing.say(&format!(
        "the case with adhesion again, by its options or by its scene:\n  {}\n  asperity run {}",
        on_terminal(&command),
        on_terminal(&file)
    ));
    printing.report(|| {
        json!({
            "command": "demo",
            "without_adhesion": without,
            "with_adhesion": with,
        })
    });
    warn("without adhesion", &without);
    warn("with adhesion", &with);
    Ok([without, with].iter().all(|account| account.status == Status::Converged))
}

/// The surface of the demo: one of a fixed seed, on any grid that resolves its waves.
fn rough(grid: Grid) -> asperity::Result<Surface> {
    let amplitude = Amplitude::RmsHeight(RMS_HEIGHT);
    SelfAffine::default().k_l(3.0).k_r(3.0).k_s(40.0).amplitude(amplitude).seed(2017).surface(grid)
}

fn draw_heights(grid: Grid, heights: &Array2<f64>, dpi: f64) -> asperity::Result<Picture> {
    let map = Map {
        title: "Rough surface",
        caption: &format!("rms height {}", si(RMS_HEIGHT, "m")),
        length_unit: Some("m"),
        label: "height",
        unit: Some("m"),
        ..Map::new(heights.view(), grid, Colouring::Sequential)
    };
    map.draw(dpi)
}

/// The arguments of `asperity solve` for one of the two cases, with the heights in `folder`.
fn arguments(folder: &Path, adhesive: bool) -> Vec<OsString> {
    let law = "--law jkr --work-of-adhesion 50mJ/m2";
    let given = format!("--lengths 1um --modulus 1GPa --mean-pressure 5MPa {}", if adhesive { law } else { "" });
    let mut arguments: Vec<OsString> = ["asperity", "solve", "--heights"].map(OsString::from).into();
    arguments.push(folder.join("heights.npy").into());
    arguments.extend(given.split_whitespace().map(OsString::from));
    arguments.extend(["--out".into(), folder.join(if adhesive { "with-adhesion" } else { "without-adhesion" }).into()]);
    arguments
}

/// The options of `asperity solve` for one of the two cases, and its scene.
fn solve_options(folder: &Path, adhesive: bool) -> Outcome<(solve::Options, SceneFile)> {
    let mut command = solve::Options::augment_args(Command::new("solve"));
    let matches = command.try_get_matches_from_mut(arguments(folder, adhesive).into_iter().skip(1));
    let parsed = matches.and_then(|matches| {
        let options = solve::Options::from_arg_matches(&matches)?;
        Ok((options, SceneFile::of(&command, &matches)))
    });
    parsed.map_err(|_| format!("--out {}: is no name that solve takes, choose another", folder.display()).into())
}

/// A word with the quotation marks that a shell needs.
fn quoted(word: &OsStr) -> String {
    let word = word.to_string_lossy();
    let plain = word.chars().all(|c| c.is_alphanumeric() || "/._-+".contains(c));
    if plain { word.into_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}
