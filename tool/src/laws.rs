//! `asperity laws`: the adhesion laws, and a picture of one.

use std::path::PathBuf;

use asperity::AdhesionLaw;
use asperity::adhesion::Hints;
use asperity_plot::{Chart, Format};
use asperity_scene::output::{OutputFile, check_apart};
use asperity_scene::{Kind, LAWS, Law, Outcome, Scalar, Skin, Word, keys, read_law};

use crate::command::Call;
use crate::pictures::PaperOptions;
use crate::printing::{bold, in_options, say};

keys! {
    /// List the adhesion laws, with formula, parameters and source.
    ///
    /// Tractions are over the gap g, attraction positive. Gaps count from the wall. Without a wall, gaps of lennard-jones
    /// count from its singularity, and gaps of morse from its equilibrium. With a law only this law is listed, and --plot
    /// draws it.
    ///
    /// # Examples
    ///   asperity laws
    ///   asperity laws exponential
    ///   asperity laws --law lennard-jones --work-of-adhesion 50mJ/m2 --range 0.3nm --wall none \
    ///     --plot law.png
    Options {
        "Output" {
            /// The only law to list, in the place of --law
            name: Option<String> =
                Kind::word(|| LAWS.iter().map(|law| Word { name: law.name, help: "" }).collect(), &[])
                    .positional(&["LAW"]).excludes(&["law"]),
            /// File for a picture of the traction over the gap, .png, .svg or .pdf
            plot: Option<PathBuf> = Kind::file(),
            /// Replace a file that is there
            force: bool = Kind::switch(),
        }
    }
}

/// The points of the curve, and how far it goes, in ranges of the law.
const POINTS: u32 = 400;
const REACH: f64 = 5.0;

/// Runs the command; always successful if it ends.
pub fn run(&Call { scene, .. }: &Call<'_>) -> Outcome<bool> {
    let (Options { name, plot, force }, mut adhesion) = (scene.keys(), scene.given.scene().adhesion);
    adhesion.law = name.unwrap_or(adhesion.law);
    in_options(adhesion.check_elastic("a law has none"))?;
    let units = in_options(scene.given.units(None, scene.is_si()))?;
    let chosen = Law::named(&adhesion.law).filter(|_| adhesion.adheres());
    let Some(path) = &plot else {
        match chosen {
            Some(law) => list(law),
            None => LAWS.iter().skip(1).for_each(list),
        }
        return Ok(true);
    };
    let Some(chosen) = chosen else {
        return Err("--plot needs a law: choose one by --law, with its parameters".into());
    };
    Format::from_path(path)?;
    in_options(adhesion.check())?;
    if chosen.of_grid {
        let name = chosen.name;
        return Err(format!("--law {name} has the range of a grid, so that there is no curve without one").into());
    }
    let table = scene.given.files().law_table;
    let tabulated = table.as_deref().map(read_law).transpose()?;
    let law = f64::law(adhesion.formula(tabulated.as_ref().map(|(law, _)| law))?);
    check_apart(path, table.as_deref())?;
    let file = OutputFile::create(path, force)?;
    list(chosen);
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
    let chart = Chart {
        title: "Adhesive traction over the gap",
        caption: chosen.formula,
        x_label: "gap",
        x_unit: units.length.as_deref(),
        y_label: "traction",
        y_unit: units.pressure.as_deref(),
        curves: vec![(chosen.name, gaps.map(|gap| (gap, law.traction(gap))).collect())],
        ..Chart::default()
    };
    let picture = chart.draw(scene.keys::<PaperOptions>().paper())?;
    file.complete(|path| picture.write(path))?;
    Ok(true)
}

fn list(law: &Law) {
    say(&format!("{}\n  {}\n  {}\n  {}", bold(law.name), law.formula, law.parameters(Skin::Options), law.source));
}
