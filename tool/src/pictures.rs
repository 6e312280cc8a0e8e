//! The pictures that commands draw: maps of contact and pressure, and charts of tables.

use asperity_scene::column::{APPROACH, CONTACT_FRACTION, MEAN_GAP, MEAN_PRESSURE, NORMAL_FORCE};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

use asperity::contact::Clusters;
use asperity::{Grid, Real, Solution};
use asperity_plot::{Chart, Colouring, DPI, Format, Map, Paper, Picture, Style};
use asperity_scene::allowed::Range;
use asperity_scene::legs::{Leg, abscissa, legs, logarithmic, value};
use asperity_scene::numbers::{percent, plain};
use asperity_scene::output::{OutputFile, check_free};
use asperity_scene::theories::{Curve, Theories};
use asperity_scene::{Account, Kind, LENGTH, Outcome, PRESSURE, Quantity, Scalar, Units, choice, key, keys};
use ndarray::{Array2, ArrayView2};
use serde_json::Value;

use crate::columns::Columns;
use crate::scene::SceneFile;

choice! {
    /// The format of pictures with names that the tool chooses.
    PictureFormat {
        /// Pixels
        Png = "png",
        /// Vectors for web pages and drawing programs, with the maps as images in them
        Svg = "svg",
        /// Vectors for print, with the maps as images in them, and with the font
        Pdf = "pdf",
    }
}

impl PictureFormat {
    /// The file of a picture of this name.
    pub fn file(self, name: &str) -> String {
        format!("{name}.{self}")
    }
}

keys! {
    /// The format of pictures.
    FormatKeys {
        "Output" {
            /// Format of the pictures
            picture_format: PictureFormat = Kind::word(PictureFormat::words, &["FORMAT"]).or("png"),
        }
    }
}

keys! {
    /// The resolution and the width of pictures.
    PaperOptions {
        "Output" {
            /// Pixels per inch of pictures, in .svg and .pdf of the maps in them; 300 to 600 for print
            dpi: Option<f64> = Kind::number(Range::RESOLUTION, &["N"]).or("144"),
            /// Width of pictures, such as 85mm for a column of print; the text keeps its size [default: as the map needs]
            width: Option<String> = Kind::text(|text| points(text).map(|_| ()), &["LENGTH"]),
        }
    }
}

impl PaperOptions {
    /// The paper of the pictures.
    pub fn paper(&self) -> Paper {
        Paper { dpi: self.dpi.unwrap_or(DPI), width: self.width.as_deref().and_then(|width| points(width).ok()) }
    }
}

/// The widths of pictures that are not refused, in metres.
const WIDTHS: std::ops::RangeInclusive<f64> = 0.065..=2.0;

/// A width in points of 1/72 inch, of a length with its unit.
fn points(text: &str) -> Result<f64, String> {
    let found = LENGTH.within(Range::POSITIVE)(text).ok();
    let found = found.filter(|found| found.has_unit && WIDTHS.contains(&found.value));
    let points = |found: Quantity| found.value / 0.0254 * 72.0;
    found.map(points).ok_or_else(|| "it must be a length with a unit, from 65mm to 2m, such as 85mm".to_owned())
}

keys! {
    /// The colours of the maps of contact and pressure.
    #[derive(Default)]
    MapColours {
        "Output" {
            /// Pressures at the ends of the colour bar, for pictures that are to be compared; with adhesion the largest
            /// tension, negative, and the largest compression [default: as far as most of the load is carried]
            colour_limits: Vec<f64> = Kind::quantity(PRESSURE, Range::FINITE, &["LOW", "HIGH"]).each(),
            /// Give each cluster of contact a colour of its own, nine in turn, the largest clusters first
            colour_clusters: bool = Kind::switch(),
        }
    }
}

impl MapColours {
    /// The pressures at the ends of the colour bar, where they are given.
    pub fn limits(&self) -> Option<(f64, f64)> {
        if let [low, high] = self.colour_limits[..] { Some((low, high)) } else { None }
    }

    /// Whether the clusters of contact are drawn, with what is said of them: whether the sides of the map meet.
    pub fn clusters(&self, sides_meet: bool) -> Option<bool> {
        self.colour_clusters.then_some(sides_meet)
    }

    /// Refuses limits that are no ends of a scale of pressures.
    pub fn check(&self) -> Outcome<()> {
        let Some((low, high)) = self.limits() else { return Ok(()) };
        let mistake = match () {
            () if low >= high => "the lower one must come first",
            () if low > 0.0 || high < 0.0 => {
                "the scale of pressures always has zero: give one at or below it, and one at or above it"
            }
            () => return Ok(()),
        };
        Err(format!("--colour-limits {} {}: {mistake}", plain(low), plain(high)).into())
    }
}

keys! {
    /// The chart of a table.
    PlotKeys {
        "Output" {
            /// File for a chart of the loads: of the contact fraction over the pressure or force, or of the mean pressure
            /// over the mean gap, or of the normal force over the approach; .png, .svg or .pdf
            plot: Option<PathBuf> = Kind::file(),
        }
    }
}

/// The chart of a table, and its paper.
pub struct PlotOptions {
    plot: Option<PathBuf>,
    paper: Paper,
}

impl PlotOptions {
    /// The chart that a command is to draw.
    pub fn new(scene: &SceneFile) -> Self {
        Self { plot: scene.keys::<PlotKeys>().plot, paper: scene.keys::<PaperOptions>().paper() }
    }

    /// Refuses a chart in no known format, or with a file that is there without the `table`, unless `force` replaces
    /// it.
    pub fn check(&self, table: &Path, force: bool) -> Outcome<()> {
        check_plot(self.plot.as_deref(), table, force)
    }

    /// Draws the chart of all `rows`, if it is wanted, with theories, if there are some.
    pub fn draw(&self, rows: &[Value], units: &Units, theories: Option<&Theories>) -> Outcome<()> {
        let Some(plot) = &self.plot else { return Ok(()) };
        write_picture(plot, &chart_of_loads(rows, units, theories, self.paper)?)
    }
}

/// Refuses a chart in no known format, or with a file that is there without the `table`, unless `force` replaces it.
pub fn check_plot(plot: Option<&Path>, table: &Path, force: bool) -> Outcome<()> {
    let Some(plot) = plot else { return Ok(()) };
    Format::from_path(plot)?;
    check_free(plot, force || table.exists(), "--plot")
}

/// Writes a picture over a file that may be there.
pub fn write_picture(path: &Path, picture: &Picture) -> Outcome<()> {
    Ok(OutputFile::create(path, true)?.complete(|path| picture.write(path))?)
}

/// The chart that says most of the loads in the rows of a table, or of what varies between cases of a row each; with
/// theories, if there are some, and then with both areas.
pub fn chart_of_loads(
    rows: &[Value],
    units: &Units,
    theories: Option<&Theories>,
    paper: Paper,
) -> asperity::Result<Picture> {
    let has = |column: &str| rows.iter().any(|row| !row[column].is_null());
    let area = CONTACT_FRACTION;
    let (x, y) = match rows.first().and_then(|row| row[key!(Account, control)].as_str()) {
        _ if has("wanted_contact_fraction") => (MEAN_PRESSURE, area),
        Some("approach" | "spring") if has(APPROACH) => (APPROACH, NORMAL_FORCE),
        Some("mean-gap" | "spring") => (MEAN_GAP, MEAN_PRESSURE),
        Some("normal-force") => (NORMAL_FORCE, area),
        _ => (MEAN_PRESSURE, area),
    };
    let (x, y) = match abscissa(rows) {
        Some(x) if has("pull_off_force") && has(APPROACH) => (x, "pull_off_force"),
        Some(x) if has("pull_off_pressure") => (x, "pull_off_pressure"),
        Some(x) => (x, if y == area && has("wanted_contact_fraction") { MEAN_PRESSURE } else { area }),
        None => (x, y),
    };
    let Some(theories) = theories else { return chart_of_columns(rows, x, y, units, paper) };
    let pressures = || rows.iter().map(|row| value(row, MEAN_PRESSURE));
    let high = pressures().fold(0.0, f64::max);
    let low = pressures().filter(|pressure| *pressure > 1e-3 * high).fold(high, f64::min);
    let areas = [("counted", area), ("corrected for the edge", "corrected_contact_fraction")];
    let ys = if y == area { &areas[..] } else { &[("solves", y)] };
    chart(rows, (x, &Columns::label(x)), ys, theories.curves((x, y), low, high), units, paper)
}

/// The chart of column `y` of a table over column `x`: a curve for each leg of a cycle, broken where the state jumps,
/// for each part of a sweep in which the loads rise or fall, and for what varies in a study. For its axes see
/// [`logarithmic`].
pub fn chart_of_columns(rows: &[Value], x: &str, y: &str, units: &Units, paper: Paper) -> asperity::Result<Picture> {
    chart(rows, (x, &Columns::label(x)), &[("", y)], Vec::new(), units, paper)
}

/// The chart of columns `ys` of one dimension, under their names if they have any, over column `x`, which has a name;
/// with curves of theories.
pub fn chart(
    rows: &[Value],
    (x, x_label): (&str, &str),
    ys: &[(&str, &str)],
    theories: Vec<Curve>,
    units: &Units,
    paper: Paper,
) -> asperity::Result<Picture> {
    let (mut jumps, mut curves) = (Vec::new(), Vec::new());
    let columns = Columns::new(rows, units);
    let (mut colours, mut dashes) = (Vec::new(), Vec::new());
    let legs = legs(rows, x, |column, value| columns.number(column, value));
    for (leg, (name, y)) in legs.iter().flat_map(|leg| ys.iter().map(move |y| (leg, y))) {
        let points = points_of(leg, |row| (columns.value(row, x), columns.value(row, y)), &mut jumps);
        let words: Vec<_> = [*name, &leg.colour].into_iter().filter(|word| !word.is_empty()).collect();
        let (colour, dashes) = (place(&mut colours, words.join(", ")), place(&mut dashes, leg.dash.clone()));
        curves.push(("", points, Style { colour: Some(colour), dashes }));
    }
    // the legend has both keys of what varies
    let colour = |(k, name)| (name, Vec::new(), Style { colour: Some(k), dashes: 0 });
    let dash = |(k, name)| (name, Vec::new(), Style { colour: None, dashes: k });
    let theory = |(k, (name, points))| (name, points, Style { colour: None, dashes: k });
    curves.extend(colours.iter().map(String::as_str).enumerate().map(colour));
    curves.extend(dashes.iter().map(String::as_str).enumerate().map(dash));
    curves.extend(theories.into_iter().enumerate().map(theory));
    let (curves, styles) = curves.into_iter().map(|(name, points, style)| ((name, points), style)).unzip();
    let y = ys[0].1;
    let [x_log, y_log] = logarithmic(rows, x, y);
    let [x_unit, y_unit] = [x, y].map(|column| columns.unit(column));
    // where there are several, their names say what tells them apart
    let label = Columns::label(y);
    let y_label = if ys.len() > 1 { label.split(" x ").next().unwrap_or_default() } else { &label };
    let title = format!("{}{} over {x_label}", y_label[..1].to_uppercase(), &y_label[1..]);
    let chart = Chart {
        title: &title,
        x_label,
        x_unit: x_unit.as_deref(),
        x_log,
        y_label,
        y_unit: y_unit.as_deref(),
        y_log,
        curves,
        styles,
        jumps,
        ..Chart::default()
    };
    chart.draw(paper)
}

/// The points of a leg, with gaps between its parts and where the state jumps; the jumps are added to others.
fn points_of(leg: &Leg<'_>, point: impl Fn(&Value) -> (f64, f64), jumps: &mut Vec<[(f64, f64); 2]>) -> Vec<(f64, f64)> {
    const GAP: (f64, f64) = (f64::NAN, f64::NAN);
    let mut points: Vec<(f64, f64)> = Vec::new();
    for part in &leg.parts {
        if !points.is_empty() {
            points.push(GAP);
        }
        for row in part {
            let point = point(row);
            if let (Some(&before), true) = (points.last(), value(row, "energy_drop") > 0.0) {
                jumps.push([before, point]);
                points.push(GAP);
            }
            points.push(point);
        }
    }
    points
}

/// The place of a name in a list, to which it is added if it is new.
fn place(names: &mut Vec<String>, name: String) -> usize {
    let known = names.iter().position(|known| *known == name);
    known.unwrap_or_else(|| {
        names.push(name);
        names.len() - 1
    })
}

/// Marks the nodes that have yielded by a plastic depth, by the number 2.
pub fn mark_yielded<T: Real>(regions: &mut Array2<f64>, depth: ArrayView2<'_, T>) {
    regions.zip_mut_with(&depth, |region, depth| *region = if *depth > T::zero() { 2.0 } else { *region });
}

/// Draws the nodes in contact, those that attract each other, and nodes apart, as numbers: 1 contact, -1 attraction, 0
/// apart, NaN no surface; and nodes that have yielded. Or draws the clusters of contact, on a map with opposite sides
/// that meet or do not.
pub fn draw_contact(
    grid: Grid,
    title: &str,
    units: &Units,
    regions: &Array2<f64>,
    clusters: Option<bool>,
    paper: Paper,
) -> asperity::Result<Picture> {
    let count = |of: fn(f64) -> bool| regions.iter().filter(|region| of(**region)).count();
    let facing = count(|region| !region.is_nan());
    let share = |part: usize, whole: usize| percent(part as f64 / whole as f64);
    let of_facing = |of| format!("{} %", share(count(of), facing));
    let (mut values, mut colouring) = (Cow::Borrowed(regions), Colouring::Contact);
    let caption = if let Some(sides_meet) = clusters {
        let contact = regions.mapv(|region| region > 0.0);
        let found = if sides_meet { Clusters::of(contact.view()) } else { Clusters::of_part(contact.view()) };
        let Clusters { sizes, labels, .. } = found;
        let absent = |region: &f64| if region.is_nan() { f64::NAN } else { 0.0 };
        values = Cow::Owned(labels.mapv(|label| label as f64) + regions.map(absent));
        colouring = Colouring::Clusters;
        let contact = of_facing(|region| region > 0.0);
        match (sizes.first(), sizes.len()) {
            (Some(_), 1) => format!("{contact} contact, in one cluster"),
            (Some(&largest), count) => {
                let largest = share(largest, sizes.iter().sum());
                format!("{contact} contact, in {count} clusters, the largest with {largest} % of it")
            }
            _ => "no contact".to_owned(),
        }
    } else {
        let some = |of: fn(f64) -> bool, word| match count(of) {
            0 => String::new(),
            _ => format!(", {} {word}", of_facing(of)),
        };
        let (yielded, attractive) = (some(|region| region > 1.0, "yielded"), some(|region| region < 0.0, "attractive"));
        format!("{} contact{yielded}{attractive}", of_facing(|region| region > 0.0))
    };
    let map = Map {
        title,
        caption: &caption,
        length_unit: units.length.as_deref(),
        ..Map::new(values.view(), grid, colouring)
    };
    map.draw(paper)
}

/// The pressure that a map should show. Without adhesion this is the contact pressure: the pressure outside of the
/// contact is a remainder of the error, and would look like attraction on a scale of its own.
pub fn pressure_to_draw<T: Real>(solution: &Solution<T>, adhesive: bool) -> &Array2<T> {
    if adhesive { &solution.pressure } else { &solution.contact_pressure }
}

/// Draws a pressure, compression red and attraction blue, up to `limits` where they are given.
pub fn draw_pressure<T: Scalar>(
    grid: Grid,
    (title, caption): (&str, &str),
    units: &Units,
    pressure: &Array2<T>,
    limits: Option<(f64, f64)>,
    paper: Paper,
) -> asperity::Result<Picture> {
    let pressure = pressure.mapv(T::widen);
    let map = Map {
        title,
        caption,
        length_unit: units.length.as_deref(),
        label: "pressure",
        unit: units.pressure.as_deref(),
        limits,
        signs: ["tension", "compression"],
        ..Map::new(pressure.view(), grid, Colouring::Diverging)
    };
    map.draw(paper)
}
