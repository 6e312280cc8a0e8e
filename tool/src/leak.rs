//! `asperity leak`: percolation of a gap, and what leaks through it.

use std::path::{Path, PathBuf};
use std::time::Instant;

use asperity::Grid;
use asperity_flow::{Axis, Flow, Gap, Leak};
use asperity_maps::Topography;
use asperity_maps::io::{read_field, write_npy};
use asperity_plot::{Colouring, Map, Paper, Picture};
use asperity_scene::{Boundary, Inputs, Kind, LENGTH, Leaked, Narrowest, Outcome, Skin, Units, key, keys};
use ndarray::Array2;
use serde_json::{Value, json};

use crate::command::Call;
use crate::heights::{self, check_room, converted, unread};
use crate::pictures::{FormatKeys, PaperOptions};
use crate::printing::{Printing, aligned, complain, in_options, name};
use crate::report;
use crate::results::{self, Contents, Results, write_report};
use crate::scene::SceneFile;
use crate::session;
use crate::solved::{GAP, Solved, units_of};

keys! {
    /// Find out whether a gap is open from side to side, and how much leaks through it.
    ///
    /// GAP is the folder of a solve, from which gap.npy, the side lengths and the boundary are read, or a file of gaps:
    /// open where they are positive, closed elsewhere. The flow obeys Reynolds' equation. Its transmissivity, the flow
    /// times the viscosity over the pressure, a length cubed, lies between two bounds: by any pressure, and by any
    /// conserved flow. The constriction along each axis is the narrowest place of the widest passage. Exits with 0 if the
    /// distance of the bounds is within --tolerance, 2 if not (they still hold), and 1 if the input is refused.
    ///
    /// # Examples
    ///   Through the gap of a solve, and with water:
    ///     asperity solve --heights heights.npy --lengths 1mm --modulus 1GPa --mean-pressure 30MPa \
    ///         --out pressed
    ///     asperity leak pressed
    ///     asperity leak pressed --viscosity 1mPas --out leakage
    ///   Through a gap from elsewhere, from side to side:
    ///     asperity leak gap.npy --lengths 2 1 --boundary free
    Options {
        "Output" {
            /// Folder of a solve, or a file of gaps, shape (Nx, Ny): .npy, .npz, .gwy or .gsf (Gwyddion), .xyz, or a text
            /// matrix. Gaps are distances of the surfaces; heights are refused because of their negative values
            gap: PathBuf = Kind::file().positional(&["GAP"]).required(),
            /// Folder for report.json, scene.toml, and for each axis along which the gap is open pressure_x.npy (relative
            /// to the pressure drop), flow_x.npy (per width, over the pressure and times the viscosity, a length squared),
            /// and flow_x.png with the widest passage
            out: Option<PathBuf> = Kind::folder(),
            /// Replace results that are there
            force: bool = Kind::switch(),
        }
    }
}

/// The fields along each axis, and the pictures.
const FIELDS: [[&str; 2]; 2] = [["pressure_x.npy", "flow_x.npy"], ["pressure_y.npy", "flow_y.npy"]];
const PICTURES: [&str; 2] = ["flow_x", "flow_y"];

/// The decades of the flow that a picture shows, below and above its mean.
const DECADES: (f64, f64) = (-3.0, 1.5);

/// Runs the command; whether the bounds are as close as the tolerance.
pub fn run(&Call { scene, .. }: &Call<'_>) -> Outcome<bool> {
    let (Options { gap, out, force }, printing) = (scene.keys(), scene.keys::<Printing>());
    let files = || results::files(FIELDS.as_flattened(), &PICTURES);
    let results = out.as_deref().map(|out| Results { out, scene, files: files(), force });
    let files_read = || if gap.is_dir() { Solved::files(&gap, &[GAP]) } else { vec![gap.clone()] };
    results.iter().try_for_each(|results| results.check(files_read()))?;
    let (map, boundary) = read(&gap, scene)?;
    check_room(map.heights.dim())?;
    let grid = Grid::new(map.heights.dim(), map.lengths.unwrap_or((1.0, 1.0)))?;
    let asked = scene.given.leak(boundary);
    let start = Instant::now();
    let values = map.heights.view();
    let found = if gap.is_dir() { Gap::of_solution(values, grid) } else { Gap::new(values, grid) };
    let (leak, leaked) = asked.find(found?)?;
    let seconds = start.elapsed().as_secs_f64();
    let units = if scene.is_si() { Units::si() } else { Units::of_map(map.unit.as_deref()) };
    let report = || {
        let inputs = json!({
            "gap": gap.to_string_lossy(),
            "shape": grid.shape(),
            "lengths": grid.lengths(),
            "length_unit": units.length,
            "max_iterations": asked.settings.max_iterations,
            "given": scene.quantities(),
            "seconds": seconds,
            "version": env!("CARGO_PKG_VERSION"),
        });
        report::report("leak", json!(leaked), &inputs)
    };
    let written = |results: &Results<'_>| write(results, (&leak, &map.heights, grid), &units, &report());
    let told = results.as_ref().map(written).transpose()?;
    printing.say(&aligned(&leaked.rows(&units)));
    told.iter().for_each(|told| printing.say(told));
    printing.report(report);
    if let Some(text) = leaked.shortfall(Skin::Options) {
        complain("warning", &text);
    }
    Ok(leaked.reached)
}

/// The gap, with the side lengths as far as they are known, and what is beyond it.
fn read(path: &Path, scene: &SceneFile) -> Outcome<(Topography, Boundary)> {
    let si = scene.is_si();
    if path.is_dir() {
        let solved = Solved::read(path)?;
        let (map, boundary) = (solved.map(GAP)?, solved.boundary());
        if scene.given.has("lengths") {
            return Err(format!("{}: the folder has the side lengths: leave --lengths out", name(path)).into());
        }
        let given = scene.quantities().filter(|_| map.unit.is_none());
        if let Some((key, value)) = given.as_ref().and_then(|given| given.as_object()?.iter().next()) {
            let (folder, value) = (name(path), value.as_str().unwrap_or_default());
            return in_options(Err(format!(
                "{folder}: was solved without units, but {{{key}}} is {value}: give a number in the units of the solve"
            )));
        }
        return Ok((if si { converted(path, map, LENGTH.si)? } else { map }, boundary));
    }
    let map = heights::map(path, &scene.given, si)?;
    session::say(&unread(&map).iter().map(|found| Units::default().describe(found)).collect::<Vec<_>>());
    Ok((map, Boundary::Periodic))
}

/// Writes all files, and tells their names.
fn write(
    results: &Results<'_>,
    (leak, gap, grid): (&Leak, &Array2<f64>, Grid),
    units: &Units,
    report: &Value,
) -> Outcome<String> {
    let FormatKeys { picture_format } = results.scene.keys();
    let paper = results.scene.keys::<PaperOptions>().paper();
    results.write(results.folder()?, |folder| {
        write_report(folder, report)?;
        for axis in Axis::BOTH.into_iter().filter(|axis| leak.percolation.along(*axis).is_some()) {
            let flow = leak.along(axis);
            let [pressure_name, flow_name] = FIELDS[axis as usize];
            let speed = speed(flow);
            write_npy(folder.path(pressure_name), &flow.pressure)?;
            write_npy(folder.path(flow_name), &speed)?;
            let picture_name = picture_format.file(PICTURES[axis as usize]);
            let found = leak.percolation.along(axis);
            let passage = (found.map(Narrowest::record), found.map_or(&[][..], |found| &found.path));
            let picture = drawn(axis, (gap, &speed), passage, grid, units, paper)?;
            picture.write(folder.path(&picture_name))?;
        }
        Ok(())
    })?;
    Ok(results.list())
}

/// The flow at the nodes, per width.
fn speed(flow: &Flow) -> Array2<f64> {
    let [x, y] = &flow.flow;
    ndarray::Zip::from(x).and(y).map_collect(|x, y| x.hypot(*y))
}

/// The contents of a folder of this command, with its report.
pub fn contents(folder: &Path, report: &Value, paper: Paper) -> Outcome<Contents> {
    let (leaked, units): (Leaked, _) = (serde_json::from_value(report.clone())?, units_of(report));
    let (shape, lengths) = serde_json::from_value(json!([report[key!(Inputs, shape)], report[key!(Inputs, lengths)]]))?;
    let grid = Grid::new(shape, lengths)?;
    let mut pictures = Vec::new();
    for axis in Axis::BOTH.into_iter().filter(|axis| *leaked.percolates.along(*axis)) {
        let [pressure, speed] = FIELDS[axis as usize].map(|name| read_field(folder.join(name)));
        // the pressure is known where the fluid is
        let open = pressure?.mapv(|pressure| if pressure.is_nan() { 0.0 } else { 1.0 });
        let speed = speed?;
        if [open.dim(), speed.dim()] != [grid.shape(); 2] {
            return Err("pressure and flow have not the shape of the report: they are of different runs".into());
        }
        let passage = (*leaked.constriction.along(axis), &[][..]);
        pictures.push(drawn(axis, (&open, &speed), passage, grid, &units, paper)?);
    }
    Ok(Contents { figures: leaked.rows(&units), shortfall: leaked.shortfall(Skin::Options), pictures })
}

/// The picture of the flow along an axis: by powers of ten, with the widest passage as far as it is known.
fn drawn(
    axis: Axis,
    (gap, speed): (&Array2<f64>, &Array2<f64>),
    (narrowest, path): (Option<Narrowest>, &[(usize, usize)]),
    grid: Grid,
    units: &Units,
    paper: Paper,
) -> asperity::Result<Picture> {
    let (open, sum) = speed.iter().filter(|speed| **speed > 0.0).fold((0, 0.0), |(n, sum), speed| (n + 1, sum + speed));
    let mean = sum / f64::from(open.max(1));
    let decades = ndarray::Zip::from(gap).and(speed).map_collect(|gap, speed| match *gap > 0.0 || *speed > 0.0 {
        true => (speed / mean).log10().clamp(DECADES.0, DECADES.1),
        false => f64::NAN,
    });
    let caption = narrowest.map(|found| {
        format!("the gap is {} at the constriction of the widest passage", units.number(found.gap, LENGTH))
    });
    let map = Map {
        title: &format!("Flow along {}", axis.name()),
        caption: caption.as_deref().unwrap_or_default(),
        length_unit: units.length.as_deref(),
        label: "power of ten of flow over mean flow",
        limits: Some(DECADES),
        without: Some("closed"),
        path,
        mark: narrowest.map(|found| found.node),
        ..Map::new(decades.view(), grid, Colouring::Sequential)
    };
    map.draw(paper)
}
