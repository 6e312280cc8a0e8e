//! `asperity laws`: the adhesion laws, and a picture of one.

use std::path::PathBuf;

use asperity::AdhesionLaw;
use asperity::adhesion::Hints;
use asperity_plot::{Chart, Format};
use clap::{Args, ValueEnum};

use crate::adhesion::{AdhesionOptions, Law};
use crate::outcome::Outcome;
use crate::output::{OutputFile, check_apart};
use crate::pictures::Resolution;
use crate::printing::{bold, say};
use crate::scene::Scene;
use crate::units::UnitOptions;

/// List the adhesion laws, with formula, parameters and source.
///
/// Tractions are over the gap g, attraction positive. Gaps count from the wall; without one, for lennard-jones from
/// where the law is singular, and for morse from where it is at rest. With --law only that one is listed, and --plot
/// draws it.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Options {
    #[command(flatten)]
    adhesion: AdhesionOptions,
    /// File for a picture of the traction over the gap, .png, .svg or .pdf
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    resolution: Resolution,
    #[command(flatten)]
    units: UnitOptions,
    /// Replace a file that is there
    #[arg(long, help_heading = "Output")]
    force: bool,
}

const EXAMPLES: &str = "\
\u{1b}[1;4mExamples:\u{1b}[0m
  asperity laws
  asperity laws --law lennard-jones --work-of-adhesion 50mJ/m2 --range 0.3nm --wall none \\
    --plot law.png";

/// The points of the curve, and how far it goes, in ranges of the law.
const POINTS: u32 = 400;
const REACH: f64 = 5.0;

/// Runs the command; always successful if it ends.
pub fn run(options: &Options, scene: &Scene) -> Outcome<bool> {
    let units = options.units.units(None, scene.is_si())?;
    let chosen = options.adhesion.law;
    let listed =
        Law::value_variants().iter().filter(|&&law| if chosen == Law::None { law != Law::None } else { law == chosen });
    let Some(path) = &options.plot else {
        listed.for_each(|&law| list(law));
        return Ok(true);
    };
    if chosen == Law::None {
        return Err("--plot needs a law: choose one by --law, with its parameters".into());
    }
    Format::of(path)?;
    options.adhesion.check()?;
    let law = options.adhesion.uniform()?.law::<f64>()?;
    check_apart(path, options.adhesion.law_table.as_deref())?;
    let file = OutputFile::create(path, options.force)?;
    listed.for_each(|&law| list(law));
    let Hints { range, rest, .. } = law.hints();
    // from where the repulsion is as large as some attractions
    let singular = rest.is_some() && !law.energy(0.0).is_finite();
    let from = match rest {
        Some(rest) if singular => 0.9 * rest,
        Some(rest) => rest - 0.3 * range,
        None => 0.0,
    };
    let to = rest.unwrap_or(0.0) + REACH * range;
    let gaps = (0..=POINTS).map(|i| from + (to - from) * f64::from(i) / f64::from(POINTS));
    let name = chosen.to_string();
    let chart = Chart {
        title: "Adhesive traction over the gap",
        caption: chosen.description()[0],
        x_label: "gap",
        x_unit: units.length.as_deref(),
        y_label: "traction",
        y_unit: units.pressure.as_deref(),
        curves: vec![(&name, gaps.map(|gap| (gap, law.traction(gap))).collect())],
        ..Chart::default()
    };
    let picture = chart.draw(options.resolution.dpi)?;
    file.write(|path| picture.write(path))?;
    file.commit()?;
    Ok(true)
}

fn list(law: Law) {
    let [formula, parameters, source] = law.description();
    say(&format!("{}\n  {formula}\n  {parameters}\n  {source}", bold(&law.to_string())));
}
