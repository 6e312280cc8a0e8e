//! `asperity stats`: statistics and spectrum of a surface.

use std::path::PathBuf;

use asperity::Surface;
use asperity::surface::{Spectrum, SurfaceStatistics};
use asperity_maps::warning::Warning;
use asperity_maps::{Topography, knee_wavelength};
use asperity_scene::output::{OutputFile, check_apart, write_text};
use asperity_scene::{Kind, Outcome, Skin, Units, csv, keys, statistics};
use serde_json::Map;

use crate::command::Call;
use crate::heights::{self, check_complete, check_room, unread};
use crate::printing::{Printing, aligned, warn};
use crate::report;
use crate::session;

keys! {
    /// Print the statistics of a rough surface.
    ///
    /// Prints heights, slopes, curvatures and Nayak's parameter of the surface without any correction, continued
    /// periodically: a tilt, or edges that do not meet, count as roughness. Slopes and curvatures come from the Fourier
    /// spectrum and from differences between neighbours; if the two differ much, the map does not resolve the surface. If
    /// the spectrum flattens to a floor of noise, its knee is printed. Without side lengths there are no slopes, no
    /// curvatures and no Nayak's parameter.
    ///
    /// # Examples
    ///   asperity stats heights.npy
    ///   asperity stats asperity-demo/heights.npy --lengths 1um --psd psd.csv
    Options {
        "Output" {
            /// Heights, shape (Nx, Ny), peaks up: .npy, .npz, .gwy or .gsf (Gwyddion), .xyz, Gwyddion's text
            /// export, or a text matrix
            heights: PathBuf = Kind::file().positional(&["FILE"]).required(),
            /// File for the radially averaged power spectral density, comma-separated: the wave number in radians per
            /// length, the density, with the mean square height as its integral over both wave numbers, and the number of
            /// waves in its mean
            psd: Option<PathBuf> = Kind::file(),
            /// Replace a file that is there
            force: bool = Kind::switch(),
        }
    }
}

/// Runs the command; always successful if it ends.
pub fn run(&Call { scene, .. }: &Call<'_>) -> Outcome<bool> {
    let (Options { heights: path, psd, force }, printing) = (scene.keys(), scene.keys::<Printing>());
    let path = &*path;
    psd.iter().try_for_each(|psd| check_apart(psd, [path]))?;
    let psd = psd.map(|psd| OutputFile::create(&psd, force)).transpose()?;
    let map = heights::map(path, &scene.given, scene.is_si())?;
    check_room(map.heights.dim())?;
    if map.lengths.is_some() && !map.unread.is_empty() {
        warn(format!("{} also has {}", path.display(), map.unread.join(", ")));
    }
    let units = Units::of_map(map.unit.as_deref());
    let surface = map.lengths.filter(|_| map.missing() == 0).map(|_| map.clone().surface()).transpose()?;
    let found = surface.as_ref().map_or_else(|| Warning::of_topography(&map), Warning::of_surface);
    session::say(&unread(&map).iter().chain(&found).map(|found| units.describe(found)).collect::<Vec<_>>());
    check_complete(path, &map)?;
    if let Some(file) = psd {
        let Some(surface) = &surface else {
            let text = "the side lengths are unknown, and --psd is over wave numbers, which follow from them";
            return Err(format!("{}: {text}: give --lengths", path.display()).into());
        };
        let text = density_table(surface, None, map.unit.as_deref());
        file.complete(|path| write_text(path, &text))?;
    }
    let found = match &surface {
        Some(surface) => (surface.statistics(), knee_wavelength(surface)),
        None => (map.statistics()?, None),
    };
    printing.say(&table(&map, &found));
    printing.report(|| {
        let version = Map::from_iter([("version".to_owned(), env!("CARGO_PKG_VERSION").into())]);
        report::report("stats", statistics::figures(&map, &found, path), &version)
    });
    Ok(true)
}

/// The statistics of a map, one to a line.
pub fn table(map: &Topography, found: &(SurfaceStatistics, Option<f64>)) -> String {
    aligned(&statistics::rows(map, found, Skin::Options))
}

/// The radially averaged density of a surface as comma-separated values, next to the density of a target, with the
/// units of the columns if the unit of length is known.
pub fn density_table(surface: &Surface, target: Option<&Spectrum>, unit: Option<&str>) -> String {
    let psd = surface.spectrum().radial_psd();
    let target = target.map(|target| target.radial_psd().densities);
    // a square height over a wave number, or over both
    let power = if surface.grid().is_line() { 3 } else { 4 };
    let [of_wave_number, of_density] = match unit {
        Some(unit) => [format!(" [1/{unit}]"), format!(" [{unit}{power}]")],
        None => [const { String::new() }; 2],
    };
    let columns = [format!("wave_number{of_wave_number}"), format!("density{of_density}"), "waves".to_owned()];
    let aim = target.iter().map(|_| format!("target{of_density}"));
    let bins = psd.wave_numbers.iter().zip(&psd.densities).zip(&psd.waves).enumerate();
    let lines = bins.map(|(i, ((q, density), waves))| {
        let aim = target.as_ref().map_or_else(String::new, |target| format!(",{:e}", target[i]));
        format!("{q:e},{density:e},{waves}{aim}")
    });
    csv::table(columns.into_iter().chain(aim), lines)
}
