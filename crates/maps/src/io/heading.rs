//! What the comments and the heading of a text tell: sizes, units and titles, as pairs of a name and a value.

use super::lines::unquoted;
use super::units::per_metre;
use super::{Parsed, quoted, refuse};

/// A pair of a name and a value.
#[derive(Clone)]
struct Pair {
    name: String,
    value: String,
}

impl Pair {
    /// The pair of a line: `name: value`, `name = value`, or fields of which the first is the name.
    fn of(line: &str) -> Option<Self> {
        let fields = || line.split_once("\",\"").filter(|_| line.starts_with('"'));
        let (name, value) = fields()
            .or_else(|| line.split_once([':', '=', '\u{ff1a}', '\u{ff1d}']))
            .or_else(|| line.split_once('\t'))
            .or_else(|| line.split_once(' ').filter(|(_, number)| number.trim().parse::<f64>().is_ok()))?;
        let plain = |text: &str| text.replace("\",\"", " ").replace('"', "").trim().to_owned();
        let (name, mut value) = (plain(name), plain(value));
        // the unit may stand behind the name, as in `Width (µm): 3`
        let within = name.split_once(['(', '[']).map(|(name, unit)| (name.trim().to_owned(), bare(unit).to_owned()));
        match within.filter(|(_, unit)| per_metre(unit).is_some()) {
            Some((name, unit)) => {
                value = format!("{value} {unit}");
                Some(Self { name, value })
            }
            None => Some(Self { name, value }),
        }
    }

    /// The number at the start of the value, and the unit behind it.
    fn quantity(&self) -> Option<(f64, &str)> {
        quantity(&self.value)
    }

    /// The quantities along x and y, of one number or of two, as `3 µm x 2 µm` and `512 x 512`.
    fn quantities(&self) -> Option<[(f64, &str); 2]> {
        let Some((x, y)) = self.value.split_once(['x', '\u{d7}', '*']) else {
            return self.quantity().map(|both| [both; 2]);
        };
        let (x, y) = (quantity(x)?, quantity(y)?);
        Some([if x.1.is_empty() { (x.0, y.1) } else { x }, y])
    }

    /// A positive length with its unit.
    fn length(&self) -> Option<(f64, &str)> {
        self.quantity().filter(|(number, unit)| *number > 0.0 && per_metre(unit).is_some())
    }

    fn is_length(&self) -> bool {
        self.length().is_some()
    }

    /// Whether it begins with a number and ends with a unit of length, whatever is between.
    fn is_like_length(&self) -> bool {
        let unit = self.value.split([' ', '\t']).next_back().unwrap_or_default();
        self.is_length() || self.quantity().is_some() && per_metre(bare(unit)).is_some()
    }
}

/// The number at the start of a text, and the unit behind it.
fn quantity(text: &str) -> Option<(f64, &str)> {
    let value = text.trim();
    let ends = value.char_indices().map(|(at, c)| at + c.len_utf8()).rev();
    let parsed = |end: usize| value[..end].parse().ok().filter(|number: &f64| number.is_finite());
    ends.filter_map(|end| Some((parsed(end)?, bare(&value[end..])))).next()
}

/// A unit without brackets around it.
fn bare(unit: &str) -> &str {
    unit.trim().trim_start_matches(['[', '(']).trim_end_matches([']', ')']).trim()
}

/// What a value is of.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Pixels,
    Side,
    Spacing,
    Unit,
    Factor,
    Missing,
}

/// What a value is along: x, y, both, or the heights.
#[derive(Clone, Copy, PartialEq)]
enum Along {
    X,
    Y,
    Both,
    Z,
}

impl Along {
    /// The places of x, y and the heights.
    fn axes(self) -> std::ops::Range<usize> {
        match self {
            Self::X => 0..1,
            Self::Y => 1..2,
            Self::Both => 0..2,
            Self::Z => 2..3,
        }
    }
}

/// What a name says, if all of its words are known; its value may say of what kind it is.
fn meaning(name: &str) -> Option<(Option<Kind>, Along)> {
    use {Along::*, Kind::*};
    let (mut kind, mut along, mut is_relative) = (None, None, false);
    let name = name.to_lowercase();
    for word in name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()) {
        let (of_kind, of_axis) = match word {
            "x" | "horizontal" => (None, Some(X)),
            "y" | "vertical" => (None, Some(Y)),
            "z" | "data" | "value" | "values" => (None, Some(Z)),
            "xy" | "lateral" => (None, Some(Both)),
            "width" => (Some(Side), Some(X)),
            "height" => (Some(Side), Some(Y)),
            "nx" | "xres" | "ncols" | "cols" | "columns" => (Some(Pixels), Some(X)),
            "ny" | "yres" | "nrows" | "rows" | "lines" => (Some(Pixels), Some(Y)),
            "xreal" => (Some(Side), Some(X)),
            "yreal" => (Some(Side), Some(Y)),
            "dx" => (Some(Spacing), Some(X)),
            "dy" => (Some(Spacing), Some(Y)),
            "cellsize" => (Some(Spacing), Some(Both)),
            "pixels" | "points" => (Some(Pixels), None),
            "length" | "size" | "range" => (Some(Side), None),
            "pixel" => (Some(Spacing), None),
            "scale" | "step" | "spacing" | "calibration" => {
                is_relative = true;
                (Some(Spacing), None)
            }
            "unit" | "units" => (Some(Unit), None),
            "nodata" => (Some(Missing), Some(Z)),
            "bit2nm" => (Some(Factor), Some(Z)),
            "scan" | "image" | "map" | "number" | "of" | "in" => (None, None),
            _ => return None,
        };
        // a pixel has a size, and a size has a unit
        if kind != Some(Spacing) || of_kind == Some(Unit) {
            kind = of_kind.or(kind);
        }
        along = of_axis.or(along);
    }
    match (kind, along) {
        (None, None) => None,
        (Some(Spacing), None) if is_relative => None,
        (Some(Unit), None) => Some((kind, Z)),
        (Some(Unit), Some(Y)) if name.contains("height") => Some((kind, Z)),
        (Some(Spacing), Some(Z)) => Some((Some(Factor), Z)),
        (_, along) => Some((kind, along.unwrap_or(Both))),
    }
}

/// The comments and the heading of a block of numbers.
#[derive(Clone, Default)]
pub(super) struct Heading {
    pairs: Vec<Pair>,
    /// The units of three columns x, y and z.
    columns: Option<[String; 3]>,
    /// Of the lines of words that are no comments the number of the last one, and why the first one is no row.
    words: Option<(usize, String)>,
}

/// The most lines of a heading.
const MOST_LINES: usize = 1000;

impl Heading {
    /// Takes a comment, or a line of words.
    pub fn read(&mut self, line: &str) {
        if self.pairs.len() < MOST_LINES {
            self.pairs.extend(Pair::of(line));
        }
        self.columns = self.columns.take().or_else(|| columns(line));
    }

    /// Takes a line of words, which are no row for a reason.
    pub fn read_words(&mut self, number: usize, line: &str, reason: String) -> Parsed<()> {
        self.read(line);
        let (last, _) = self.words.get_or_insert((number, reason));
        *last = number;
        if number > MOST_LINES { self.check_words(false) } else { Ok(()) }
    }

    /// Refuses lines of words, unless they are known for a heading.
    pub fn check_words(&self, is_known: bool) -> Parsed<()> {
        match &self.words {
            Some((last, reason)) if !is_known => refuse(format!(
                "{reason}; if it is a heading, leave it out by asperity prepare --skip-lines {last}, or put # before it"
            )),
            _ => Ok(()),
        }
    }

    /// Whether it says something of a block of numbers, so that one begins with it.
    pub fn tells(&self) -> bool {
        let is_told = |pair: &Pair| pair.is_length() || meaning(&pair.name).is_some_and(|(kind, _)| kind.is_some());
        self.words.is_some() || self.pairs.iter().any(is_told)
    }

    pub fn append(&mut self, other: Self) {
        self.pairs.extend(other.pairs);
        self.columns = self.columns.take().or(other.columns);
        self.words = self.words.take().or(other.words);
    }

    /// Whether three columns are named x, y and z.
    pub fn has_columns(&self) -> bool {
        self.columns.is_some()
    }

    /// The first value that is none of numbers.
    pub fn title(&self) -> String {
        let first = self.pairs.first().filter(|pair| pair.quantity().is_none());
        first.map(|pair| pair.value.clone()).unwrap_or_default()
    }

    /// The sizes and units that it tells of a block of numbers.
    pub fn sizes(&self, (rows, columns): (usize, usize)) -> Parsed<Sizes> {
        let nodes = [columns, rows];
        let (mut sizes, mut sides, mut spacings) = (Sizes::default(), [None, None], [None, None]);
        for pair in &self.pairs {
            let Some((kind, along)) = meaning(&pair.name) else {
                if pair.is_like_length() {
                    sizes.unread.push(format!("{}: {}", pair.name, pair.value));
                }
                continue;
            };
            let (axes, text) = (along.axes(), format!("{}: {}", pair.name, pair.value));
            match kind {
                Some(Kind::Unit) => {
                    // one for all is that of lengths where they have none of their own
                    let is_of_all = !axes.contains(&0) && !pair.name.to_lowercase().contains(['z', 'd', 'v', 'h']);
                    let unit = Some(bare(&pair.value).to_owned());
                    if is_of_all {
                        sizes.units[..2].iter_mut().for_each(|of| *of = of.take().or(unit.clone()));
                    }
                    sizes.units[axes].fill(unit);
                    continue;
                }
                Some(Kind::Missing) => {
                    sizes.missing = pair.quantity().map(|(code, _)| code);
                    continue;
                }
                Some(Kind::Factor) if along == Along::Z => {
                    let (factor, unit) = pair.quantity().unzip();
                    let unit = if pair.name.eq_ignore_ascii_case("bit2nm") { Some("nm") } else { unit };
                    sizes.factor = factor;
                    let unit = unit.filter(|unit| !unit.is_empty()).map(str::to_owned);
                    sizes.units[2] = unit.or(sizes.units[2].take());
                    continue;
                }
                _ if along == Along::Z => continue,
                _ => {}
            }
            let Some(found) = pair.quantities() else {
                sizes.unread.push(text);
                continue;
            };
            let is_size = pair.name.to_lowercase().contains("size");
            let is_count = axes.clone().all(|axis| found[axis] == (nodes[axis] as f64, ""));
            if is_size && axes == (0..2) && found == [(nodes[1] as f64, ""), (nodes[0] as f64, "")] && !is_count {
                // the shape of the array
                continue;
            }
            for axis in axes {
                let (number, unit) = found[axis];
                let is_pixels = ["px", "pixel", "pixels"].contains(&unit)
                    || unit.is_empty() && (matches!(kind, Some(Kind::Pixels) | None) || is_size && is_count);
                if unit.starts_with(',') {
                    return refuse(format!(
                        "has the comment {}, expected a number with a decimal point, and its unit",
                        quoted(&text)
                    ));
                } else if is_pixels && number >= 1.0 && number.fract() == 0.0 {
                    sizes.pixels[axis] = Some(number as usize);
                } else if number > 0.0 && !is_pixels && (unit.is_empty() || per_metre(unit).is_some()) {
                    let lengths = if kind == Some(Kind::Spacing) { &mut spacings } else { &mut sides };
                    lengths[axis] = Some((number, unit.to_owned()));
                } else if !sizes.unread.contains(&text) {
                    sizes.unread.push(text.clone());
                }
            }
        }
        // the text export of Gwyddion in any language: title, width, height, unit
        if let [_, width, height, unit, ..] = &self.pairs[..]
            && sides == [None, None]
            && [width, height].iter().all(|pair| pair.is_length() && meaning(&pair.name).is_none())
            && unit.quantity().is_none()
        {
            sides = [width, height].map(|pair| pair.length().map(|(length, unit)| (length, unit.to_owned())));
            sizes.units[2].get_or_insert_with(|| bare(&unit.value).to_owned());
            sizes.unread.clear();
        }
        if self.pairs.iter().any(|pair| pair.name.to_lowercase() == "datascaleneeded" && pair.value == "no") {
            sizes.factor = None;
        }
        if let Some(units) = &self.columns {
            sizes.units = units.clone().map(Some);
        }
        sizes.set_sides(sides, spacings, nodes, self.pairs.iter().any(|pair| pair.name == "x-length"))?;
        Ok(sizes)
    }
}

/// The sizes and units that a heading tells of a block of numbers.
#[derive(Default)]
pub(super) struct Sizes {
    /// The numbers of nodes along x and y.
    pub pixels: [Option<usize>; 2],
    /// The side lengths along x and y, with the unit of both.
    pub sides: Option<((f64, f64), String)>,
    /// The units along x and y, and of the heights.
    pub units: [Option<String>; 3],
    /// The factor of the heights.
    pub factor: Option<f64>,
    /// The number that stands for missing points.
    pub missing: Option<f64>,
    /// The lines that may tell sizes and are not understood.
    pub unread: Vec<String>,
}

/// A length with its unit, which may be empty.
type Length = (f64, String);

impl Sizes {
    fn set_sides(
        &mut self,
        sides: [Option<Length>; 2],
        spacings: [Option<Length>; 2],
        nodes: [usize; 2],
        is_of_spip: bool,
    ) -> Parsed<()> {
        let of = |axis: usize| {
            let spacing = spacings[axis].clone();
            let count = self.pixels[axis].unwrap_or(nodes[axis]) as f64;
            let (length, unit) = sides[axis].clone().or(spacing.map(|(spacing, unit)| (count * spacing, unit)))?;
            let told = [axis, 0].into_iter().find_map(|axis| self.units[axis].clone());
            let unit = if unit.is_empty() { told.unwrap_or_default() } else { unit };
            // SPIP writes lengths in nm
            Some((length, if unit.is_empty() && is_of_spip { "nm".to_owned() } else { unit }))
        };
        let (Some((lx, lateral)), Some((ly, other))) = (of(0), of(1)) else {
            let known = sides.iter().chain(&spacings).flatten();
            self.unread.extend(known.map(|(length, unit)| format!("{length} {unit}")));
            return Ok(());
        };
        let ly = match (per_metre(&lateral), per_metre(&other)) {
            _ if lateral == other => ly,
            (Some(x), Some(y)) => ly * (x / y),
            _ => {
                return refuse(format!(
                    "has sides in {} and {}, expected units of length",
                    quoted(&lateral),
                    quoted(&other)
                ));
            }
        };
        self.sides = Some(((lx, ly), lateral));
        Ok(())
    }

    /// Whether the lines of the block are those of an image, from the top.
    pub fn is_image(&self) -> bool {
        self.sides.is_some() || self.pixels.iter().all(Option::is_some)
    }
}

/// The units of three columns that are named x, y and z, as `X[um] Y[um] Z[nm]` or `x (µm), y (µm), z (nm)`.
fn columns(line: &str) -> Option<[String; 3]> {
    let (mut names, mut units, mut is_unit) = (String::new(), Vec::new(), false);
    for piece in line.split_inclusive(['[', '(', ']', ')']) {
        let text = piece.trim_end_matches(['[', '(', ']', ')']);
        if is_unit {
            units.push(text.trim().to_owned());
        } else {
            names.push_str(text);
            names.push(' ');
        }
        is_unit = piece.ends_with(['[', '(']);
    }
    let words: Vec<_> = names.split([' ', '\t', ',', ';']).map(unquoted).filter(|word| !word.is_empty()).collect();
    let divided: Vec<_> = words.iter().filter_map(|word| word.split_once('/')).collect();
    units.extend(divided.iter().map(|(_, unit)| (*unit).to_owned()));
    let names: Vec<_> = words.iter().map(|word| word.split('/').next().unwrap_or(word).to_lowercase()).collect();
    let is_points =
        names.len() == 3 && names[0] == "x" && names[1] == "y" && ["z", "h", "height"].contains(&&*names[2]);
    units.resize(if units.is_empty() { 3 } else { units.len() }, String::new());
    units.try_into().ok().filter(|_| is_points)
}
