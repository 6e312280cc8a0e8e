//! `asperity prepare`: a measured height map made into a periodic surface.

use std::path::{Path, PathBuf};

use asperity_maps::Topography;
use asperity_maps::io::{read_channel, read_topography, write_topography};
use asperity_maps::warning::{Warning, WarningCode};
use asperity_maps::{Form, FormFit, RowAlignment, ScanAxis, Trend};
use asperity_scene::Told;
use clap::{Args, ValueEnum};
use serde_json::json;

use crate::allowed::{finite, nodes, positive};
use crate::heights::{check_room, given, holes, sides, warn_of_unread};
use crate::numbers::plain;
use crate::outcome::Outcome;
use crate::output::OutputFile;
use crate::printing::{Printing, complain, name, say};
use crate::quantity::{LENGTH, PER_LENGTH, Quantity, power_of_length, times_ten_to};
use crate::scene::Scene;
use crate::units::{Units, unit};

/// Make a measured map into a surface that can be solved.
///
/// A measurement has missing points, a tilt, and edges that do not meet; a surface that is solved is complete and
/// periodic. Nothing is done that is not asked for, and each step prints a line; FILE.scene.toml beside the result
/// repeats the steps. Whatever the order of the options, the steps are: --lengths, --missing, --scale, --unit, --crop,
/// --flip, --align-rows, --despike, --remove-form, --detrend, --fill, --window or --mirror, --resample.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Options {
    /// The map: .npy, .npz, .gwy or .gsf (Gwyddion), .xyz, Gwyddion's text export, or a text matrix
    #[arg(value_name = "IN")]
    input: PathBuf,

    /// Channel of a .gwy file, by its number or its title, if several have heights
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,

    /// Side lengths, instead of the file's; LX alone means square cells. With a unit, as 20um, the result is in the
    /// --unit or the file's, or else in m
    #[arg(long, value_names = ["LX", "LY"], num_args = 1..=2, allow_negative_numbers = true)]
    #[arg(value_parser = LENGTH.positive())]
    lengths: Option<Vec<Quantity>>,
    /// Value that stands for missing points, in the unit of the heights as they are read; may be repeated
    #[arg(long, value_name = "CODE", value_delimiter = ',', allow_negative_numbers = true, value_parser = finite)]
    missing: Vec<f64>,
    /// Multiply the heights, as by 1e-9 for nm where the side lengths are in m
    #[arg(long, value_name = "F", allow_hyphen_values = true, value_parser = positive)]
    scale: Option<f64>,
    /// Unit of side lengths and heights as they are after that, instead of the file's; solve has it in tables and
    /// pictures
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    unit: Option<String>,
    /// Keep NX x NY nodes from index [X, Y] on
    #[arg(long, value_names = ["X", "Y", "NX", "NY"], num_args = 4, allow_negative_numbers = true)]
    crop: Option<Vec<usize>>,
    /// Turn peaks into valleys: for a replica
    #[arg(long)]
    flip: bool,
    /// Bring the scan lines of an AFM to one height: median (of each line), median-difference (from line to line, for
    /// large features) or polynomial:ORDER (of each line; ORDER is 1 if it is left out)
    #[arg(long, value_name = "METHOD", value_parser = alignment)]
    align_rows: Option<RowAlignment>,
    /// Direction of the scan lines of --align-rows [default: x]
    #[arg(long, value_enum, requires = "align_rows")]
    scan_axis: Option<Scan>,
    /// Give spikes the median of the 5 x 5 nodes around them, if they are farther from it than this many robust
    /// standard deviations of all nodes [default: 10 if --despike stands alone]
    #[arg(long, value_name = "THRESHOLD", num_args = 0..=1, default_missing_value = "10", value_parser = positive)]
    #[arg(allow_negative_numbers = true)]
    despike: Option<f64>,
    /// Subtract the sphere or the circular cylinder that fits all measured points best
    #[arg(long, value_enum, value_name = "FORM")]
    remove_form: Option<Body>,
    /// Subtract the least-squares fit to all measured points: mean, plane, quadric (as of a sphere or a cylinder), or a
    /// polynomial of this order, up to 12
    #[arg(long, value_name = "TREND", allow_hyphen_values = true, value_parser = trend)]
    detrend: Option<Trend>,
    /// Fill missing points smoothly from their surroundings, by Laplace's equation
    #[arg(long)]
    fill: bool,
    /// Make the map periodic: taper heights towards their mean within this share of the sides at each edge, up to 0.5.
    /// Fit for spectra; under load the flat frame may come into contact, where --mirror keeps all heights
    #[arg(long, value_name = "F", allow_hyphen_values = true, conflicts_with = "mirror")]
    window: Option<f64>,
    /// Make the map periodic: continue it by its mirror images, to twice the size along both sides. A .npz remembers
    /// its original, of which solve has results then
    #[arg(long)]
    mirror: bool,
    /// Interpolate on NX x NY nodes by Fourier series, finer or coarser; the map should be periodic by then
    #[arg(long, value_names = ["NX", "NY"], num_args = 2, allow_negative_numbers = true, value_parser = nodes)]
    resample: Option<Vec<usize>>,

    /// File for the result: .npz (with lengths and unit), .gsf (those too, for Gwyddion, in f32) or .npy (heights
    /// alone)
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: PathBuf,
    /// Replace a file that is there
    #[arg(long, help_heading = "Output")]
    force: bool,
    #[command(flatten)]
    printing: Printing,
}

const EXAMPLES: &str = "\
\u{1b}[1;4mExamples:\u{1b}[0m
  A measured map, tilted and with missing points, pressed against a half-space of 1 GPa:
    asperity prepare measured.gsf --detrend plane --fill --mirror --out surface.npz
    asperity solve --heights surface.npz --modulus 1GPa --mean-pressure 1MPa --out results
  An AFM map with offsets between its lines, and spikes:
    asperity prepare afm.gwy --align-rows median --despike --detrend plane --mirror \\
      --out scan.npz
  Heights in nm of a map of 5 by 4 micrometres, a sphere subtracted, on a finer grid:
    asperity prepare heights.txt --unit nm --lengths 5um 4um --detrend quadric --window 0.05 \\
      --resample 1024 1024 --out fine.npz";

#[derive(Clone, Copy, ValueEnum)]
enum Body {
    Sphere,
    Cylinder,
}

impl Body {
    fn form(self) -> Form {
        match self {
            Self::Sphere => Form::Sphere,
            Self::Cylinder => Form::Cylinder,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum Scan {
    X,
    Y,
}

impl Scan {
    fn axis(self) -> ScanAxis {
        match self {
            Self::X => ScanAxis::X,
            Self::Y => ScanAxis::Y,
        }
    }
}

/// The trends that have a name, and the alignments of scan lines.
pub const TRENDS: [&str; 3] = ["mean", "plane", "quadric"];
pub const ALIGNMENTS: [&str; 3] = ["median", "median-difference", "polynomial"];

/// A trend by its name or order.
fn trend(text: &str) -> Result<Trend, String> {
    match (text.trim(), order(text)) {
        ("mean", _) => Ok(Trend::Mean),
        ("plane", _) => Ok(Trend::Plane),
        ("quadric", _) => Ok(Trend::Quadric),
        (_, Some(order)) => Ok(Trend::Polynomial(order)),
        _ => Err(format!("it must be mean, plane, quadric, or an order from 0 to {}", Trend::MOST)),
    }
}

/// An alignment of scan lines by its name.
fn alignment(text: &str) -> Result<RowAlignment, String> {
    let (name, rest) = text.trim().split_once(':').unwrap_or((text.trim(), "1"));
    match (name, order(rest)) {
        ("median", _) if name == text.trim() => Ok(RowAlignment::Median),
        ("median-difference", _) if name == text.trim() => Ok(RowAlignment::MedianDifference),
        ("polynomial", Some(order)) => Ok(RowAlignment::Polynomial(order)),
        _ => Err(format!(
            "it must be median, median-difference, or polynomial:ORDER with an order from 0 to {}",
            Trend::MOST
        )),
    }
}

/// The order of a polynomial.
fn order(text: &str) -> Option<usize> {
    text.trim().parse().ok().filter(|order| *order <= Trend::MOST)
}

/// Runs the command; always successful if it ends.
pub fn run(options: &Options, scene: &Scene) -> Outcome<bool> {
    scene.check_beside(&options.out, options.force)?;
    let file = OutputFile::create(&options.out, options.force)?;
    let (mut lines, mut warnings) = (Vec::new(), Vec::new());
    let map = prepared(options, scene.is_si(), &mut lines, &mut warnings)?;
    file.write(|path| write_topography(path, &map))?;
    let scene_file = scene.written_beside(&options.out)?;
    scene_file.commit_after([file])?;
    options.printing.report(|| {
        json!({
            "command": "prepare",
            "input": options.input.to_string_lossy(),
            "out": options.out.to_string_lossy(),
            "shape": map.heights.dim(),
            "lengths": map.lengths,
            "length_unit": map.unit,
            "original": map.original,
            "steps": lines.iter().map(|(step, text)| json!({ "step": step, "what": text })).collect::<Vec<_>>(),
            "warnings": warnings,
            "version": env!("CARGO_PKG_VERSION"),
        })
    });
    if options.printing.for_people() {
        lines.push(("written", format!("{}{}", name(&options.out), left_out(&options.out, &map))));
        let width = lines.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        let lines = lines.iter().map(|(name, text)| format!("{name:width$}  {text}"));
        say(&lines.collect::<Vec<_>>().join("\n"));
    }
    Ok(true)
}

/// What a format has no place for, of all that is known of a map.
fn left_out(out: &Path, map: &Topography) -> String {
    let is = |ending: &str| out.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
    let lengths = (map.lengths.is_some() && is("npy")).then_some("without side lengths: give them again by --lengths");
    let mirror = "without its original: results will be of all nodes, and of the original alone from an .npz";
    let mirror = (map.original.is_some() && !is("npz")).then_some(mirror);
    lengths.into_iter().chain(mirror).map(|text| format!(", {text}")).collect()
}

/// Takes the steps, and tells them.
fn prepared(
    options: &Options,
    si: bool,
    lines: &mut Vec<(&'static str, String)>,
    warnings: &mut Vec<Told>,
) -> Outcome<Topography> {
    let mut map = match &options.channel {
        Some(channel) => read_channel(&options.input, channel)?,
        None => read_topography(&options.input)?,
    };
    check_room(map.heights.dim())?;
    let mut tell = |step: &'static str, text: String| lines.push((step, text));
    tell("read", described(&map));

    if let Some(mut lengths) = given(&map, options.lengths.as_deref()) {
        let before = map.lengths.map_or("unknown".to_owned(), |before| sides(before, map.unit.as_deref()));
        if si {
            let unit = options.unit.as_deref().or(map.unit.as_deref()).unwrap_or(LENGTH.si).to_owned();
            let power = power_of_length(&unit).ok_or_else(|| {
                format!("--lengths have a unit, but the map is in {unit}, which is none of length: give --unit, as nm")
            })?;
            lengths = (times_ten_to(-power, lengths.0), times_ten_to(-power, lengths.1));
            map.unit = Some(unit);
        }
        map.lengths = Some(lengths);
        tell("lengths", format!("{}, before {before}", sides(lengths, map.unit.as_deref())));
    }
    warn_of_unread(&options.input, &map, "stay unknown");
    for code in &options.missing {
        let before = map.missing();
        map = map.declare_missing(*code);
        let (found, nodes) = (map.missing() - before, map.heights.len());
        tell("missing", format!("{} stood at {found} of {nodes} points: rms height {}", plain(*code), rms(&map)));
    }
    let found = Warning::of_topography(&map).into_iter();
    let read = told(found.filter(|warning| warning.code == WarningCode::MissingCode), &map);
    let has_codes = !read.is_empty();
    warnings.extend(read);
    if let Some(factor) = options.scale {
        map.heights.mapv_inplace(|h| factor * h);
        tell("scale", format!("heights times {}: rms height {}", plain(factor), rms(&map)));
    }
    if let Some(unit) = &options.unit {
        let before = map.unit.replace(unit.clone()).unwrap_or("unknown".to_owned());
        tell("unit", format!("{unit}, before {before}"));
    }
    if let Some(&[x, y, nx, ny]) = options.crop.as_deref() {
        map = map.crop(x..x.saturating_add(nx), y..y.saturating_add(ny))?;
        tell("crop", format!("from index [{x}, {y}] on: {}", described(&map)));
    }
    if options.flip {
        map = map.flip();
        tell("flip", "peaks are valleys now".to_owned());
    }
    if let Some(alignment) = options.align_rows {
        let before = map.clone();
        let ((nx, ny), scan) = (map.heights.dim(), options.scan_axis.unwrap_or(Scan::X));
        warnings.extend(told(Warning::of_lines(&map, scan.axis()), &map));
        map = map.align_rows(alignment, scan.axis())?;
        let (axis, lines) = if scan.axis() == ScanAxis::X { ("x", ny) } else { ("y", nx) };
        let by = changed(&before, &map);
        tell("align-rows", format!("{lines} lines along {axis} {by}: rms height {} from {}", rms(&map), rms(&before)));
    }
    if let Some(threshold) = options.despike {
        let (spikes, before, nodes) = (map.spikes(threshold)?, rms(&map), map.heights.len());
        map = map.despike(threshold)?;
        let limit = quantity(spikes.limit, &map);
        let what = match spikes.worst {
            Some(((i, j), distance)) => format!(
                "{} of {nodes} points beyond {limit} from the median around them have it now, the worst by {} at index [{i}, {j}]",
                spikes.nodes.len(),
                quantity(distance, &map)
            ),
            None => format!("none of {nodes} points is beyond {limit} from the median around it"),
        };
        tell("despike", format!("{what}: rms height {} from {before}", rms(&map)));
    }
    if let Some(body) = options.remove_form {
        let (fit, before) = (map.fit_form(body.form())?, rms(&map));
        map = map.remove_form(body.form())?;
        tell("remove-form", format!("{} removed: rms height {} from {before}", described_form(&fit, &map), rms(&map)));
    }
    if let Some(trend) = options.detrend {
        let before = map.clone();
        map = map.detrend(trend)?;
        let what = removed(trend, &before, &map)?;
        tell("detrend", format!("{what}: rms height {} from {}", rms(&map), rms(&before)));
    }
    if options.fill {
        let (missing, nodes) = (map.missing(), map.heights.len());
        map = map.fill()?;
        tell("fill", format!("{missing} of {nodes} points filled: rms height {}", rms(&map)));
    }
    // what follows has no place for holes
    if map.missing() > 0 && (options.window.is_some() || options.resample.is_some()) {
        let (holes, nodes) = (holes(&map).unwrap_or_default(), map.heights.len());
        return Err(format!("{}: {nodes} heights, {holes}: add --fill", options.input.display()).into());
    }
    if let Some(fraction) = options.window {
        let before = rms(&map);
        map = map.window(fraction)?;
        let share = plain(100.0 * fraction);
        tell("window", format!("{share} % of the sides tapered at each edge: rms height {} from {before}", rms(&map)));
    }
    if options.mirror {
        check_room((2 * map.heights.nrows(), 2 * map.heights.ncols()))?;
        map = map.mirror();
        tell("mirror", described(&map));
    }
    if let Some(&[nx, ny]) = options.resample.as_deref() {
        let before = rms(&map);
        check_room((nx, map.heights.ncols().max(ny)))?;
        map = map.resample((nx, ny))?;
        tell("resample", format!("{}: rms height {} from {before}", described(&map), rms(&map)));
    }
    if let Some(holes) = holes(&map) {
        tell("left", format!("points are missing still, {holes}: add --fill before solving"));
    }
    // heights and lengths are in their units by now; where codes for missing points are among the heights, they alone
    // make the slope
    let found = Warning::of_topography(&map).into_iter();
    warnings.extend(told(found.filter(|warning| warning.code != WarningCode::MissingCode && !has_codes), &map));
    Ok(map)
}

/// Warnings about a map, which are printed.
fn told(found: impl IntoIterator<Item = Warning>, map: &Topography) -> Vec<Told> {
    let units = Units::of_map(map.unit.as_deref());
    let told: Vec<_> = found.into_iter().map(|warning| units.told(&warning)).collect();
    told.iter().for_each(|warning| complain("warning", &warning.to_string()));
    told
}

/// A sphere, or a cylinder and its direction.
fn described_form(fit: &FormFit, map: &Topography) -> String {
    let (radius, side) = (quantity(fit.radius.abs(), map), if fit.radius > 0.0 { "upwards" } else { "downwards" });
    match fit.axis {
        None => format!("sphere of radius {radius}, bulging {side},"),
        Some(axis) => {
            let degrees = plain(axis.to_degrees());
            format!("cylinder of radius {radius}, bulging {side}, its axis at {degrees} degrees from x,")
        }
    }
}

/// What a trend takes away.
fn removed(trend: Trend, before: &Topography, after: &Topography) -> Outcome<String> {
    let fit = before.fit(trend)?;
    let per = if before.lengths.is_some() { "" } else { " per spacing" };
    let (x, y) = fit.slopes;
    let tilt = format!("tilt {}{per} along x, {}{per} along y", plain(x), plain(y));
    Ok(match trend {
        Trend::Mean | Trend::Polynomial(0) => format!("mean {} removed", quantity(fit.height, before)),
        Trend::Plane | Trend::Polynomial(1) => format!("{tilt} removed"),
        Trend::Quadric | Trend::Polynomial(2) => {
            let (xx, xy, yy) = fit.curvatures;
            let units = Units::of_map(before.unit.as_deref().filter(|_| before.lengths.is_some()));
            let [xx, xy, yy] = [xx, xy, yy].map(|curvature| units.number(curvature, PER_LENGTH));
            format!("{tilt} removed, curvatures xx {xx}, xy {xy}, yy {yy}")
        }
        Trend::Polynomial(order) => format!("polynomial of order {order} removed, heights {}", changed(before, after)),
        _ => format!("trend removed, heights {}", changed(before, after)),
    })
}

/// By how much measured heights have changed.
fn changed(before: &Topography, after: &Topography) -> String {
    let changes = before.heights.iter().zip(&after.heights).map(|(before, after)| after - before);
    let (mut squares, mut most, mut count) = (0.0, 0.0, 0.0);
    for change in changes.filter(|change| change.is_finite()) {
        (squares, most, count) = (squares + change * change, f64::max(most, change.abs()), count + 1.0);
    }
    let rms = f64::sqrt(squares / f64::max(count, 1.0));
    format!("changed by {} rms, by {} at most", quantity(rms, after), quantity(most, after))
}

fn described(map: &Topography) -> String {
    let (nx, ny) = map.heights.dim();
    let lengths = map.lengths.map_or("unknown side lengths".to_owned(), |l| sides(l, map.unit.as_deref()));
    let missing = holes(map).unwrap_or("none missing".to_owned());
    format!("{nx} x {ny} heights, {missing}, {lengths}, rms height {}", rms(map))
}

fn rms(map: &Topography) -> String {
    quantity(map.rms_height(), map)
}

fn quantity(value: f64, map: &Topography) -> String {
    Units::of_map(map.unit.as_deref()).number(value, LENGTH)
}
