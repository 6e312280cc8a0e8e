//! `asperity prepare`: a measured height map made into a periodic surface.

use std::path::{Path, PathBuf};

use asperity::Error;
use asperity_maps::Topography;
use asperity_maps::io::{Reading, write_topography};
use asperity_scene::output::OutputFile;
use asperity_scene::{Kind, Log, Outcome, Units, keys};
use serde_json::json;

use crate::command::Call;
use crate::heights::{check_room, unread};
use crate::printing::{Printing, aligned, in_options, name, say};
use crate::scene::SceneFile;
use crate::session;

keys! {
    /// Make a measured map into a surface that can be solved.
    ///
    /// A measurement has missing points, a tilt, and edges that do not meet; a surface that is solved is complete and
    /// periodic. Only the steps that you choose are done, and each prints a line. FILE.scene.toml next to the result
    /// repeats them. Whatever the order of the options, the order of the steps is --lengths, --missing, --scale, --unit,
    /// --crop, --flip, --align-rows, --remove-scars, --despike, --remove-form, --detrend, --fill, --window or --mirror,
    /// --cut-off-wavelength, --resample.
    ///
    /// # Examples
    ///   A measured map, tilted and with missing points, pressed against a half-space of 1 GPa:
    ///     asperity prepare measured.gsf --detrend plane --fill --mirror --out surface.npz
    ///     asperity solve --heights surface.npz --modulus 1GPa --mean-pressure 1MPa --out results
    ///   An AFM map with offsets between its lines, scars and spikes:
    ///     asperity prepare afm.gwy --align-rows median --remove-scars --despike --detrend plane \
    ///       --mirror --out scan.npz
    ///   Heights in nm of a map of 5 by 4 micrometres, a sphere subtracted, on a finer grid:
    ///     asperity prepare heights.txt --unit nm --lengths 5um 4um --detrend quadric --window 0.05 \
    ///       --resample 1024 1024 --out fine.npz
    Options {
        "" {
            /// The map: .npy, .npz, .gwy or .gsf (Gwyddion), points x y z, or a text matrix
            input: PathBuf = Kind::file().positional(&["IN"]).required(),
            /// Channel of a .gwy file, or of a text file with several blocks, by its number or its title, if several have
            /// heights
            channel: Option<String> = Kind::text(|_| Ok(()), &["NAME"]),
            /// Number of lines to skip at the start of a text file, such as a heading
            skip_lines: Option<usize> = Kind::whole(&["LINES"]),
            /// Word of a text file that stands for missing points, besides nan, NA, Bad, #N/A and the like; may be
            /// repeated
            missing_word: Vec<String> = Kind::text(|_| Ok(()), &["WORD"]).again(),
            /// Treat the points under the mask of a .gwy file as missing
            masked: bool = Kind::switch(),
        }
        "Output" {
            /// File for the result: .npz (with lengths and unit), .gsf (those too, for Gwyddion, in f32) or .npy (heights
            /// alone)
            out: PathBuf = Kind::file().required(),
            /// Replace a file that is there
            force: bool = Kind::switch(),
        }
    }
}

/// Runs the command; always successful if it ends.
pub fn run(&Call { scene, .. }: &Call<'_>) -> Outcome<bool> {
    let (options, printing) = (&scene.keys::<Options>(), scene.keys::<Printing>());
    scene.check_next_to(&options.out, options.force)?;
    let file = OutputFile::create(&options.out, options.force)?;
    let mut log = Log::default();
    let map = prepared(options, scene, &mut log)?;
    file.write(|path| write_topography(path, &map))?;
    let scene_file = scene.write_next_to(&options.out)?;
    scene_file.commit_after([file])?;
    printing.report(|| {
        json!({
            "command": "prepare",
            "input": options.input.to_string_lossy(),
            "out": options.out.to_string_lossy(),
            "shape": map.heights.dim(),
            "lengths": map.lengths,
            "length_unit": map.unit,
            "original": map.original,
            "steps": log.lines.iter().map(|(step, text)| json!({ "step": step, "what": text })).collect::<Vec<_>>(),
            "warnings": log.warnings,
            "version": env!("CARGO_PKG_VERSION"),
        })
    });
    if printing.for_people() {
        log.lines.push(("written", format!("{}{}", name(&options.out), left_out(&options.out, &map))));
        say(&aligned(&log.lines));
    }
    Ok(true)
}

/// The properties of a map that a format cannot hold.
fn left_out(out: &Path, map: &Topography) -> String {
    let is = |ending: &str| out.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
    let lengths = (map.lengths.is_some() && is("npy")).then_some("without side lengths: give them again by --lengths");
    let mirror = "without its original: results will be of all nodes, and of the original alone from an .npz";
    let mirror = (map.original.is_some() && !is("npz")).then_some(mirror);
    lengths.into_iter().chain(mirror).map(|text| format!(", {text}")).collect()
}

/// Takes the steps, and prints the warnings.
fn prepared(options: &Options, scene: &SceneFile, log: &mut Log) -> Outcome<Topography> {
    let mut reading = Reading::default();
    (reading.channel, reading.skip_lines) = (options.channel.clone(), options.skip_lines.unwrap_or_default());
    (reading.missing, reading.masked) = (options.missing_word.clone(), options.masked);
    let map = reading.read(&options.input)?;
    check_room(map.heights.dim())?;
    let steps = in_options(scene.given.steps(map.heights.dim(), scene.is_si(), map.unit.as_deref()))?;
    if steps.lengths.is_none() {
        session::say(&unread(&map).iter().map(|found| Units::default().describe(found)).collect::<Vec<_>>());
    }
    let map = steps.run(map, log);
    session::say(&log.warnings);
    map.map_err(|error| match error {
        Error::NotFinite { count, nodes, .. } => {
            format!("{}: {nodes} heights, {count} missing: add --fill", options.input.display()).into()
        }
        error => error.into(),
    })
}
