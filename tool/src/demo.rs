//! `asperity demo`: a rough contact with and without adhesion, from nothing.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use asperity::{Amplitude, Grid, SelfAffine, Status};
use asperity_maps::Topography;
use asperity_maps::io::write_npy;
use asperity_plot::{Colouring, Map};
use asperity_scene::{Kind, Map as HeightMap, Maps, Outcome, Processes, Solved, Units, keys};
use serde_json::json;

use crate::called;
use crate::command::Call;
use crate::heights::named;
use crate::options::ProblemOptions;
use crate::pictures::{self, FormatKeys, PaperOptions};
use crate::printing::{Printing, name, on_terminal};
use crate::progress::Progress;
use crate::results::Results;
use crate::scene::{self, SceneFile};
use crate::session::Strictness;
use crate::summary::{table, warn};
use crate::threads::{count, use_threads};

keys! {
    /// Press a built-in rough surface, without and with adhesion at the same load.
    ///
    /// Prints a table and writes maps of the heights, the contact and the pressure. Needs no files. Also writes scene.toml:
    /// asperity run repeats the case with adhesion from it, for you to change and try.
    ///
    /// # Examples
    ///   Then the case with adhesion at half the pressure, and what is left of it without adhesion:
    ///     asperity demo
    ///     asperity run asperity-demo/scene.toml --mean-pressure 2.5MPa --out lighter
    ///     asperity run asperity-demo/scene.toml --mean-pressure 2.5MPa --law none --out bare
    Options {
        "Output" {
            /// Folder for the maps; maps of an earlier demo are replaced
            out: PathBuf = Kind::folder().or("asperity-demo"),
            /// Threads; the results do not depend on it [default: one per core]
            threads: Option<usize> = Kind::threads(),
        }
    }
}

/// The contact, as people read it, and as options of `asperity solve`.
const TOLD: &str = "\
A rough surface of 1 µm by 1 µm (512 x 512 nodes, rms height 5 nm) pressed with 5 MPa
against a half-space of contact modulus 1 GPa, without adhesion and with a work of adhesion of 50 mJ/m².
";
const GIVEN: &str = "--lengths 1um --modulus 1GPa --mean-pressure 5MPa";

/// The two cases, with the options that one of them has more.
const CASES: [(&str, &str); 2] = [("without adhesion", ""), ("with adhesion", "--law jkr --work-of-adhesion 50mJ/m2")];

/// Runs the command; whether both solves converged.
pub fn run(&Call { scene, processes }: &Call<'_>) -> Outcome<bool> {
    let (Options { out, threads }, FormatKeys { picture_format }) = (scene.keys(), scene.keys());
    let (paper, printing) = (scene.keys::<PaperOptions>().paper(), scene.keys::<Printing>());
    let cases = CASES.map(|(name, _)| name.replace(' ', "-"));
    let map = |what: &str| cases.each_ref().map(|case| picture_format.file(&format!("{what}-{case}")));
    let (contacts, pressures, heights_map) = (map("contact"), map("pressure"), picture_format.file("heights"));
    let maps = [&heights_map].into_iter().chain(&contacts).chain(&pressures).cloned();
    let files: Vec<_> = maps.chain(["heights.npy", scene::NAME].map(str::to_owned)).collect();
    let [bare, sticky] = [called(arguments(&out, 0))?, called(arguments(&out, 1))?];
    let results = Results { out: &out, scene: &sticky, files, force: true };
    results.check([] as [&Path; 0])?;
    use_threads(threads)?;

    let (grid, units) = (Grid::square(512, 1e-6)?, Units::si());
    let spectrum = SelfAffine::default().k_l(3.0).k_r(3.0).k_s(40.0).amplitude(Amplitude::RmsHeight(5e-9)).seed(2017);
    let surface = spectrum.surface(grid)?;
    printing.say(TOLD);
    let heights = surface.heights().clone();
    let mut map = Topography::from(surface);
    map.unit = units.length.clone();
    let solved = |name, scene: &SceneFile| solved((name, scene), map.clone(), &printing, processes);
    let Solved { found: bare, account: without, .. } = solved("without adhesion", &bare)?;
    let Solved { found: sticky, account: with, .. } = solved("with adhesion", &sticky)?;

    results.write(results.folder()?, |folder| {
        let map = Map {
            title: "Rough surface",
            caption: "rms height 5 nm",
            length_unit: Some("m"),
            label: "height",
            unit: Some("m"),
            ..Map::new(heights.view(), grid, Colouring::Sequential)
        };
        map.draw(paper)?.write(folder.path(&heights_map))?;
        write_npy(folder.path("heights.npy"), &heights)?;
        for (k, solution) in [&bare.solution, &sticky.solution].into_iter().enumerate() {
            let [contact, pressure] = ["Contact", "Pressure"].map(|what| format!("{what} {}", CASES[k].0));
            let regions = solution.regions().mapv(f64::from);
            pictures::draw_contact(grid, &contact, &units, &regions, None, paper)?.write(folder.path(&contacts[k]))?;
            let (shown, titles) = (pictures::pressure_to_draw(solution, k == 1), (&*pressure, "mean 5 MPa"));
            let picture = pictures::draw_pressure(grid, titles, &units, shown, None, paper)?;
            picture.write(folder.path(&pressures[k]))?;
        }
        Ok(())
    })?;

    printing.say(&table(&["without adhesion", "with adhesion"], &[&without, &with], &units));
    printing.say(&format!("\nmaps in {}: {}\n", name(&out), results.files.join(", ")));
    let command: Vec<_> = arguments(&out, 1).iter().map(|word| quoted(word)).collect();
    let (command, file) = (command.join(" "), quoted(out.join(scene::NAME).as_os_str()));
    printing.say(&format!(
        "the case with adhesion again, by its options or by its scene:\n  {}\n  asperity run {}",
        on_terminal(&command),
        on_terminal(&file)
    ));
    printing.report(|| json!({ "command": "demo", "without_adhesion": without, "with_adhesion": with }));
    CASES.iter().zip([&without, &with]).for_each(|((name, _), account)| warn(name, account));
    Ok([without, with].iter().all(|account| account.status == Status::Converged))
}

/// A case on a map, with its name.
fn solved(
    (name, scene): (&str, &SceneFile),
    map: Topography,
    printing: &Printing,
    processes: &Processes,
) -> Outcome<Solved<f64>> {
    let ProblemOptions { case, files } = ProblemOptions::new(&scene.given)?;
    let nodes = map.heights.len();
    let map = HeightMap::whole(named(&files.heights), map);
    let posed = case.on(Maps::new(map), count(), processes)?;
    let mut progress = Progress::new(name, case.scene().tolerance(), nodes, printing.without_bars());
    let session = Strictness::default().session::<f64>(posed, processes)?;
    let mut solved = session.with_slopes().solve(&case.request(1.0, false)?, None, &mut progress.on_grids())?;
    solved.look()?;
    Ok(solved)
}

/// The arguments of `asperity solve` for a case, with the heights in `folder`.
fn arguments(folder: &Path, case: usize) -> Vec<OsString> {
    let (name, more) = CASES[case];
    let given = [GIVEN, more].into_iter().flat_map(str::split_whitespace).map(OsString::from);
    let heights = ["asperity".into(), "solve".into(), "--heights".into(), folder.join("heights.npy").into()];
    let out = ["--out".into(), folder.join(name.replace(' ', "-")).into()];
    heights.into_iter().chain(given).chain(out).collect()
}

/// A word with the quotation marks that a shell needs.
fn quoted(word: &OsStr) -> String {
    let word = word.to_string_lossy();
    let plain = word.chars().all(|c| c.is_alphanumeric() || "/._-+".contains(c));
    if plain { word.into_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}
