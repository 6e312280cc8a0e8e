use std::path::{Path, PathBuf};

use asperity::io::{OutputFolder, write_npy};
use asperity::{
    Amplitude, Colouring, Control, Exponential, Grid, Map, NoAdhesion, SelfAffine, Settings, Status, Surface,
};
use clap::Args;
use ndarray::Array2;

use crate::options::threads;
use crate::progress::Progress;
use crate::report::{Style, si, table, warn};
use crate::run::{self, Case, Units};
use crate::{Outcome, say};

/// Press a built-in rough surface, without and with adhesion at the same load.
///
/// Prints a table and writes maps of the heights, the contact and the pressure. Needs no files.
#[derive(Args)]
pub struct Options {
    /// Folder for the maps; those of an earlier demo are replaced
    #[arg(long, value_name = "DIR", default_value = "asperity-demo")]
    out: PathBuf,
    /// Threads; the results do not depend on it [default: one per core]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = threads)]
    threads: Option<usize>,
}

const SIDE: f64 = 1e-6;
const NODES: usize = 512;
const RMS_HEIGHT: f64 = 5e-9;
const MODULUS: f64 = 1e9;
const PRESSURE: f64 = 5e6;
const WORK_OF_ADHESION: f64 = 0.05;
const RANGE: f64 = 1e-9;
const UNITS: Units<'static> = Units { length: Some("m"), pressure: Some("Pa") };

const NAMES: [&str; 6] = [
    "heights.png",
    "contact-without-adhesion.png",
    "contact-with-adhesion.png",
    "pressure-without-adhesion.png",
    "pressure-with-adhesion.png",
    "heights.npy",
];

/// Runs the command; whether both solves converged.
pub fn run(options: &Options) -> Outcome<bool> {
    let out = &options.out;
    drop(OutputFolder::create(out, &NAMES, true)?);
    run::use_threads(options.threads)?;

    let grid = Grid::square(NODES, SIDE)?;
    let surface = rough(grid)?;
    say(&format!(
        "A rough surface of {side} by {side} ({NODES} x {NODES} nodes, rms height {}) pressed with {}\n\
         against a half-space of contact modulus {}, without and with adhesion (exponential law, {} over {}).\n",
        si(RMS_HEIGHT, "m"),
        si(PRESSURE, "Pa"),
        si(MODULUS, "Pa"),
        si(WORK_OF_ADHESION, "J/m²"),
        si(RANGE, "m"),
        side = si(SIDE, "m"),
    ));
    let heights = surface.heights().clone();
    let case = Case {
        modulus: MODULUS,
        control: Control::MeanPressure(PRESSURE),
        settings: Settings::default(),
        stability: false,
    };
    let progress = |name| Progress::new(name, case.settings.tolerance, grid.nodes(), false);
    let law = Exponential::new(WORK_OF_ADHESION, RANGE)?;
    let (bare, without) = run::solve::<f64, _>(surface.clone(), NoAdhesion, &case, None, progress("without adhesion"))?;
    let (sticky, with) = run::solve::<f64, _>(surface, law, &case, None, progress("with adhesion"))?;

    let folder = OutputFolder::create(out, &NAMES, true)?;
    let draw = || {
        draw_heights(&folder.path("heights.png"), grid, &heights)?;
        write_npy(&folder.path("heights.npy"), &heights)?;
        for (name, solution, adhesive) in [("without adhesion", &bare, false), ("with adhesion", &sticky, true)] {
            let path = |what: &str| folder.path(&format!("{what}-{}.png", name.replace(' ', "-")));
            run::draw_contact(&path("contact"), grid, &format!("Contact {name}"), UNITS, &solution.gap)?;
            let (caption, title) = (format!("mean {}", si(PRESSURE, "Pa")), format!("Pressure {name}"));
            let pressure = run::pressure_to_draw(solution, adhesive);
            run::draw_pressure(&path("pressure"), grid, &title, &caption, UNITS, pressure)?;
        }
        Ok(())
    };
    draw().map_err(|error| run::at_destination(error, out))?;
    folder.commit()?;

    say(&table(&["without adhesion", "with adhesion"], &[&without, &with], Style::Si));
    say(&format!("\nmaps in {}: {}\n", out.display(), NAMES.join(", ")));
    say(&format!("the case with adhesion again, from its file:\n  {}", command(out)));
    warn("without adhesion", &without, &case, 0.0);
    warn("with adhesion", &with, &case, RANGE);
    Ok([without, with].iter().all(|account| account.report.status == Status::Converged))
}

/// The same every time, and on every grid that resolves its waves.
fn rough(grid: Grid) -> asperity::Result<Surface> {
    let amplitude = Amplitude::RmsHeight(RMS_HEIGHT);
    SelfAffine { k_l: 3.0, k_r: 3.0, k_s: 40.0, amplitude, seed: 2017, ..SelfAffine::default() }.surface(grid)
}

fn draw_heights(path: &Path, grid: Grid, heights: &Array2<f64>) -> asperity::Result<()> {
    let map = Map {
        title: "Rough surface",
        caption: &format!("rms height {}", si(RMS_HEIGHT, "m")),
        length_unit: UNITS.length,
        label: "height",
        unit: UNITS.length,
        ..Map::new(heights.view(), grid, Colouring::Sequential)
    };
    map.write_png(path)
}

/// How to solve the case with adhesion from the heights in `folder`.
fn command(folder: &Path) -> String {
    let quoted = |path: PathBuf| {
        let path = path.display().to_string();
        let plain = path.chars().all(|c| c.is_alphanumeric() || "/._-+".contains(c));
        if plain { path } else { format!("'{}'", path.replace('\'', r"'\''")) }
    };
    format!(
        "asperity solve --heights {} --lengths {SIDE:e} {SIDE:e} --modulus {MODULUS:e} --mean-pressure {PRESSURE:e} \
         --law exponential --work-of-adhesion {WORK_OF_ADHESION} --range {RANGE:e} --length-unit m --pressure-unit Pa \
         --out {}",
        quoted(folder.join("heights.npy")),
        quoted(folder.join("with-adhesion")),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_surface_has_its_rms_height_and_the_adhesion_is_resolved() {
        let surface = rough(Grid::square(128, SIDE).unwrap()).unwrap();
        assert!((surface.rms_height() / RMS_HEIGHT - 1.0).abs() < 1e-12);
        let spacing = SIDE / NODES as f64;
        assert!((WORK_OF_ADHESION * spacing / MODULUS).sqrt() / RANGE < 0.5);
    }
}
