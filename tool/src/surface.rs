//! `asperity surface`: a random self-affine surface, one of given Fourier coefficients, or a simple body with or without
//! roughness.

use std::path::PathBuf;

use asperity::{Grid, SelfAffine, Surface};
use asperity_maps::io::check_memory;
use asperity_maps::io::{read_fourier, write_npy, write_topography};
use asperity_maps::{Topography, knee_wavelength};
use asperity_scene::output::{OutputFile, check_apart, write_text};
use asperity_scene::{BodyForm, Entries, FormKeys, Kind, LENGTH, Outcome, RoughnessKeys, keys, statistics};
use serde_json::{Value, json};

use crate::command::Call;
use crate::printing::{Printing, in_options, name};
use crate::report;
use crate::scene;
use crate::stats::{density_table, table};
use crate::threads::use_threads;

keys! {
    /// Make a self-affine rough surface or a simple body, and print its statistics.
    ///
    /// A body has a --form, such as a sphere. A solve treats its missing parts as absent nodes by --absent-missing.
    /// --rms-height or --rms-slope adds roughness. The roughness is periodic and isotropic. Its power spectral density is
    /// constant from KL to KR, falls as k^(-2-2H) from KR to KS (on a line as k^(-1-2H)), and is zero elsewhere. Wave
    /// numbers count periods along x. A seed gives the same surface on every grid that resolves KS, with the given rms
    /// height or slope to rounding. --fourier reads the waves of the roughness from a file. asperity run FILE.scene.toml
    /// makes the heights again.
    ///
    /// # Examples
    ///   The surface of the paper's figures, with a slope that can be pressed:
    ///     asperity surface --size 1024 --rms-slope 0.1 --out heights.npy
    ///   A rectangle of a micrometre by two, with a plateau in the spectrum, and the spectrum:
    ///     asperity surface --shape 256 512 --lengths 1um 2um --rms-height 5nm --hurst 0.7 \
    ///       --k-l 2 --k-r 6 --k-s 50 --seed 7 --out rectangle.npy --psd psd.csv
    ///   A profile:
    ///     asperity surface --shape 4096 1 --rms-slope 0.1 --k-s 1000 --out profile.npy
    ///   A tip of 20 nm on a map of 32 nm by 32 nm, as a sphere and as a rough one:
    ///     asperity surface --form sphere --radius 20nm --size 128 --lengths 32nm --out tip.npz
    ///     asperity surface --form sphere --radius 20nm --size 128 --lengths 32nm --rms-height 0.2nm \
    ///       --k-s 32 --out rough-tip.npz
    ///   The surface of the contact-mechanics challenge (Mueser et al. 2017), where low values touch first:
    ///     asperity surface --fourier surface.Fourier.ASCII.dat --fourier-unit 0.1mm --size 2048 \
    ///       --lengths 0.1mm --out low.npz
    ///     asperity prepare low.npz --flip --out challenge.npz
    Options {
        "Output" {
            /// File for the heights: .npy, or with the side lengths .npz or .gsf (for Gwyddion, in f32)
            out: PathBuf = Kind::file().required(),
            /// File for the radially averaged power spectral density, as asperity stats writes it, and its target
            psd: Option<PathBuf> = Kind::file(),
            /// Replace files that are there
            force: bool = Kind::switch(),
            /// Threads; the surface does not depend on it [default: one per core]
            threads: Option<usize> = Kind::threads(),
        }
    }
}

/// The surface that options describe.
struct Described {
    grid: Grid,
    body: FormKeys,
    rough: Option<SelfAffine>,
    fourier: Option<(PathBuf, f64)>,
    unit: Option<&'static str>,
}

/// The map of the surface, without a file.
pub fn map(given: &Entries) -> Outcome<Topography> {
    Ok(described(given)?.make()?.1)
}

fn described(given: &Entries) -> Outcome<Described> {
    let is_si = given.quantities().is_si();
    let shape = in_options(given.shape())?;
    let (body, roughness): (FormKeys, RoughnessKeys) = (given.keys(), given.keys());
    let (form, fourier) = (body.form, given.fourier());
    in_options(body.check())?;
    let rough = roughness.self_affine();
    if rough.is_none() && fourier.is_none() && form == BodyForm::SelfAffine {
        return Err("--form self-affine lacks its roughness: give --rms-height or --rms-slope, or --fourier".into());
    }
    let unit = is_si.then_some(LENGTH.si);
    let sides = in_options(given.sides(shape, is_si))?;
    if let (Some(_), Some(key)) = (&fourier, given.first::<RoughnessKeys>()) {
        let text = format!("{{{key}}} is of random roughness, which {{fourier}} replaces: leave it out");
        return in_options(Err(text));
    }
    if unit.is_some() && fourier.is_some() && given.fourier_unit().is_none() {
        let text = "the numbers have units, but the coefficients have none: give --fourier-unit, such as 0.1mm";
        return Err(text.into());
    }
    let grid = Grid::new(shape, sides)?;
    let fourier = fourier.map(|path| (path, given.fourier_unit().unwrap_or(1.0)));
    Ok(Described { grid, body, rough, fourier, unit })
}

impl Described {
    /// The surface, and the same as a map.
    fn make(&self) -> Outcome<(Surface, Topography)> {
        let grid = self.grid;
        if self.rough.is_some() {
            check_memory("a random surface", grid.shape(), 32)?;
        }
        let roughness = match &self.fourier {
            Some((path, unit)) => Some(read_fourier(path, grid, *unit)?),
            None => self.rough.map(|rough| rough.surface(grid)).transpose()?,
        };
        let surface = self.body.surface(grid, roughness)?;
        let mut map = Topography::from(surface.clone());
        map.unit = self.unit.map(str::to_owned);
        map.seed = self.rough.map(|rough| rough.seed);
        Ok((surface, map))
    }

    /// The figures of the description, with the number of nodes without a height.
    fn figures(&self, absent: usize) -> Value {
        json!({
            "form": self.body.form.to_string(),
            "absent_nodes": absent,
            "hurst": self.rough.map(|rough| rough.hurst),
            "k_l": self.rough.map(|rough| rough.k_l),
            "k_r": self.rough.map(|rough| rough.k_r),
            "k_s": self.rough.map(|rough| rough.k_s),
            "random_phase": self.rough.map(|rough| rough.random_phase),
            "seed": self.rough.map(|rough| rough.seed),
            "fourier": self.fourier.as_ref().map(|(path, _)| path.to_string_lossy()),
            "version": env!("CARGO_PKG_VERSION"),
        })
    }
}

/// Runs the command; always successful if it ends.
pub fn run(&Call { scene, .. }: &Call<'_>) -> Outcome<bool> {
    let (options, printing) = (&scene.keys::<Options>(), scene.keys::<Printing>());
    let described = described(&scene.given)?;
    let &Described { grid, rough, unit, .. } = &described;
    let fourier = described.fourier.as_ref().map(|(path, _)| path.as_path());
    for written in [Some(&options.out), options.psd.as_ref()].into_iter().flatten() {
        check_apart(written, fourier)?;
    }
    let heights = OutputFile::create(&options.out, options.force)?;
    let psd = options.psd.as_deref().map(|path| OutputFile::create(path, options.force)).transpose()?;
    let others = [options.out.clone(), scene::path_for(&options.out)];
    if options.psd.as_deref().is_some_and(|psd| check_apart(psd, others.iter().map(PathBuf::as_path)).is_err()) {
        return Err(format!("--psd is {}, the same as --out: give it a name of its own", options.out.display()).into());
    }
    scene.check_next_to(&options.out, options.force)?;
    use_threads(options.threads)?;

    let (surface, map) = described.make()?;
    let absent = surface.absent_nodes();
    if psd.is_some() && absent > 0 {
        return Err(format!("the body has no height at {absent} nodes, and so no spectrum: leave --psd out").into());
    }
    heights.write(|path| match path.extension().map(|ending| ending.to_ascii_lowercase()) {
        Some(ending) if ending == "gsf" || ending == "npz" => write_topography(path, &map),
        _ => write_npy(path, &map.heights),
    })?;
    if let Some(file) = &psd {
        let target = rough.map(|rough| rough.spectrum(grid)).transpose()?;
        let text = density_table(&surface, target.as_ref(), unit);
        file.write(|path| write_text(path, &text))?;
    }
    scene.write_next_to(&options.out)?.commit_after(std::iter::once(heights).chain(psd))?;
    // what is absent has no statistics
    let ((nx, ny), found) = (grid.shape(), (absent == 0).then(|| (surface.statistics(), knee_wavelength(&surface))));
    printing.say(&match &found {
        Some(found) => table(&map, found),
        None => format!("{nx} x {ny} nodes, {absent} of them absent"),
    });
    printing.say(&format!("heights in {}", name(&options.out)));
    printing.report(|| {
        let figures = match &found {
            Some(found) => statistics::figures(&map, found, &options.out),
            None => json!({
                "heights": options.out.to_string_lossy(),
                "shape": grid.shape(),
                "lengths": grid.lengths(),
                "length_unit": unit,
            }),
        };
        report::report("surface", figures, &described.figures(absent))
    });
    Ok(true)
}
