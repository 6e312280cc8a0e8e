//! Comments and headings of texts: sizes, units and titles, as pairs of a name and a value.

use super::columns::Columns;
use super::units::{bare, per_metre, symbol};
use super::{Parsed, quoted, refuse};

/// A pair of a name and a value.
#[derive(Clone)]
struct Pair {
    name: String,
    value: String,
}

impl Pair {
    /// The pair of a line: `name: value`, `name = value`, or fields with the name first.
    fn read(line: &str) -> Option<Self> {
        let fields = line.split_once("\",\"").filter(|_| line.starts_with('"'));
        let (name, value) = fields
            .or_else(|| line.split_once([':', '=', '\u{ff1a}', '\u{ff1d}']))
            .or_else(|| line.split_once('\t'))
            .or_else(|| {
                line.split_once(' ').filter(|(_, number)| number.replace(',', ".").trim().parse::<f64>().is_ok())
            })?;
        let plain = |text: &str| text.replace("\",\"", " ").replace('"', "").trim().to_owned();
        let (name, value) = (plain(name), plain(value));
        // the unit may stand behind the name, as in `Width (µm): 3`
        match name.split_once(['(', '[']).filter(|(_, unit)| per_metre(bare(unit)).is_some()) {
            Some((name, unit)) => Some(Self { name: name.trim().to_owned(), value: format!("{value} {}", bare(unit)) }),
            None => Some(Self { name, value }),
        }
    }

    fn text(&self) -> String {
        format!("{}: {}", self.name, self.value)
    }

    /// The quantities along x and y, of one number or of two, as `3 µm x 2 µm` and `512 x 512`.
    fn quantities(&self) -> Option<[(f64, &str); 2]> {
        let (x, y) = self.value.split_once(['x', '\u{d7}', '*']).unwrap_or((&self.value, &self.value));
        let (x, y) = (quantity(x)?, quantity(y)?);
        Some([if x.1.is_empty() { (x.0, y.1) } else { x }, y])
    }

    /// Whether a comma is within a number.
    fn has_comma(&self) -> bool {
        self.value.as_bytes().windows(3).any(|of| of[1] == b',' && of[0].is_ascii_digit() && of[2].is_ascii_digit())
    }

    /// A positive length with its unit.
    fn length(&self) -> Option<(f64, String)> {
        let (number, unit) = quantity(&self.value)?;
        (number > 0.0 && per_metre(unit).is_some()).then(|| (number, unit.to_owned()))
    }

    /// Whether it begins with a number and ends with a unit of length, whatever is between.
    fn is_like_length(&self) -> bool {
        let unit = self.value.split([' ', '\t']).next_back().unwrap_or_default();
        self.length().is_some() || quantity(&self.value).is_some() && per_metre(bare(unit)).is_some()
    }
}

/// The number at the start of a text, and the unit behind it.
fn quantity(text: &str) -> Option<(f64, &str)> {
    let value = text.trim();
    let ends = value.char_indices().map(|(at, c)| at + c.len_utf8()).rev();
    let parsed = |end: usize| value[..end].parse().ok().filter(|number: &f64| number.is_finite());
    ends.filter_map(|end| Some((parsed(end)?, bare(&value[end..])))).next()
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

/// The words of names, with what a value is of and along: x, y or the heights.
const WORDS: [(&str, Option<Kind>, &[usize]); 17] = [
    ("x horizontal", None, &[0]),
    ("y vertical", None, &[1]),
    ("xy lateral", None, &[0, 1]),
    ("z data value values", None, &[2]),
    ("nx xres ncols cols columns", Some(Kind::Pixels), &[0]),
    ("ny yres nrows rows lines", Some(Kind::Pixels), &[1]),
    ("pixels points", Some(Kind::Pixels), &[]),
    ("width xreal", Some(Kind::Side), &[0]),
    ("height yreal", Some(Kind::Side), &[1]),
    ("length size range", Some(Kind::Side), &[]),
    ("dx", Some(Kind::Spacing), &[0]),
    ("dy", Some(Kind::Spacing), &[1]),
    ("cellsize", Some(Kind::Spacing), &[0, 1]),
    ("pixel scale step spacing calibration", Some(Kind::Spacing), &[]),
    ("unit units", Some(Kind::Unit), &[]),
    ("nodata", Some(Kind::Missing), &[2]),
    ("bit2nm", Some(Kind::Factor), &[2]),
];

/// Words that say nothing next to others.
const OTHERS: &str = "scan image map number of in";

/// What a name says, if all of its words are known; its value may say the kind, and a name without an axis is of all
/// axes.
fn meaning(name: &str) -> Option<(Option<Kind>, &'static [usize])> {
    let (mut kind, mut axes): (Option<Kind>, &[usize]) = (None, &[]);
    let name = name.to_lowercase();
    for word in name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()) {
        let is_in = |words: &str| words.split(' ').any(|other| other == word);
        if is_in(OTHERS) {
            continue;
        }
        let (_, of_kind, of_axes) = *WORDS.iter().find(|(words, ..)| is_in(words))?;
        // a pixel has a size, and a size has a unit
        if kind != Some(Kind::Spacing) || of_kind == Some(Kind::Unit) {
            kind = of_kind.or(kind);
        }
        axes = if of_axes.is_empty() { axes } else { of_axes };
    }
    match (kind, axes) {
        (None, []) => None,
        // heights have a range, a scale and steps too
        (Some(Kind::Side | Kind::Spacing), [])
            if !["scan", "size", "pixel", "spacing"].iter().any(|of| name.contains(of)) =>
        {
            None
        }
        (Some(Kind::Unit), _) if name.contains("height") => Some((kind, &[2])),
        (Some(Kind::Spacing), [2]) => Some((Some(Kind::Factor), axes)),
        _ => Some((kind, axes)),
    }
}

/// The comments and the heading of a block of numbers.
#[derive(Clone, Default)]
pub(super) struct Heading {
    pairs: Vec<Pair>,
    /// The columns, if x and y are among them.
    columns: Option<Columns>,
    /// The unit of heights in words, and whether x and y have this unit too.
    said: Option<(&'static str, bool)>,
    /// The first and the last number of lines of words that are no comments, and why the first line is no row.
    words: Option<(usize, usize, String)>,
}

/// The most lines of a heading.
const MOST_LINES: usize = 1000;

impl Heading {
    /// Takes a comment, or a line of words.
    pub fn read(&mut self, line: &str) {
        if self.pairs.len() < MOST_LINES {
            self.pairs.extend(Pair::read(line));
            self.said = self.said.or_else(|| unit_in_words(line));
        }
        match &mut self.columns {
            Some(columns) => columns.take_units(line),
            None => self.columns = Columns::read(line),
        }
    }

    /// Takes a line of words, which are no row for a reason.
    pub fn read_words(&mut self, number: usize, line: &str, reason: String) -> Parsed<()> {
        self.read(line);
        let (first, last, _) = self.words.get_or_insert((number, number, reason));
        *last = number;
        if *last - *first > MOST_LINES { self.check_words(false) } else { Ok(()) }
    }

    /// Refuses lines of words, unless they are known for a heading.
    pub fn check_words(&self, is_known: bool) -> Parsed<()> {
        match &self.words {
            Some((_, last, reason)) if !is_known => refuse(format!(
                "{reason}; if it is a heading, leave it out by asperity prepare --skip-lines {last}, or put # before it"
            )),
            _ => Ok(()),
        }
    }

    /// Whether it describes a block of numbers, so that a block begins with it.
    pub fn tells(&self) -> bool {
        let is_told =
            |pair: &Pair| pair.length().is_some() || meaning(&pair.name).is_some_and(|(kind, _)| kind.is_some());
        self.words.is_some() || self.said.is_some() || self.pairs.iter().any(is_told)
    }

    pub fn append(&mut self, other: Self) {
        self.pairs.extend(other.pairs);
        self.columns = self.columns.take().or(other.columns);
        self.said = self.said.or(other.said);
        self.words = self.words.take().or(other.words);
    }

    /// The columns, if x and y are among them.
    pub fn columns(&self) -> Option<&Columns> {
        self.columns.as_ref()
    }

    /// The first value without numbers.
    pub fn title(&self) -> Option<String> {
        let first = self.pairs.first().filter(|pair| quantity(&pair.value).is_none());
        first.map(|pair| pair.value.clone()).filter(|title| !title.is_empty())
    }

    /// The sizes and units of a block of numbers.
    pub fn sizes(&self, (rows, columns): (usize, usize)) -> Parsed<Sizes> {
        let (nodes, mut lengths) = ([columns, rows], [None, None]);
        let mut sizes = Sizes { said: self.said, ..Sizes::default() };
        for pair in &self.pairs {
            let found = quantity(&pair.value);
            match meaning(&pair.name) {
                Some((kind, axes))
                    if pair.has_comma()
                        && kind != Some(Kind::Unit)
                        && (axes != [2] || matches!(kind, Some(Kind::Factor | Kind::Missing))) =>
                {
                    let text = quoted(&pair.text());
                    return refuse(format!(
                        "has the comment {text}, expected a number with a decimal point, and its unit"
                    ));
                }
                None if pair.is_like_length() => sizes.unread.push(pair.text()),
                None => {}
                Some((Some(Kind::Unit), axes)) => sizes.take_units(pair, axes),
                Some((Some(Kind::Missing), _)) => sizes.missing = found.map(|(code, _)| code),
                Some((Some(Kind::Factor), _)) => {
                    sizes.factor = found.map(|(factor, _)| factor);
                    let unit = if pair.name.ends_with("nm") { "nm" } else { found.map_or("", |(_, unit)| unit) };
                    sizes.units[2] = Some(unit.to_owned()).filter(|unit| !unit.is_empty()).or(sizes.units[2].take());
                }
                Some((_, [2])) => {}
                Some((kind, axes)) => sizes.take(pair, kind, axes, nodes, &mut lengths)?,
            }
        }
        // the text export of Gwyddion in any language: title, width, height, unit
        if let [_, width, height, unit, ..] = &self.pairs[..]
            && lengths == [None, None]
            && [width, height].iter().all(|pair| pair.length().is_some() && meaning(&pair.name).is_none())
            && quantity(&unit.value).is_none()
        {
            lengths = [width, height].map(Pair::length);
            sizes.units[2].get_or_insert_with(|| bare(&unit.value).to_owned());
            sizes.unread.clear();
        }
        // of Nova, and of SPIP, which writes lengths in nm
        let is_said = |name: &str, value: &str| {
            self.pairs.iter().any(|pair| pair.name.eq_ignore_ascii_case(name) && pair.value.contains(value))
        };
        sizes.factor = sizes.factor.filter(|_| !is_said("DataScaleNeeded", "no"));
        if let Some(columns) = &self.columns {
            sizes.units = ["x", "y", "z"].map(|axis| columns.unit(axis));
        }
        sizes.take_sides(&lengths, if is_said("x-length", "") { "nm" } else { "" })?;
        Ok(sizes)
    }
}

/// The sizes and units of a block of numbers, by a heading.
#[derive(Default)]
pub(super) struct Sizes {
    /// The numbers of nodes along x and y.
    pub pixels: [Option<usize>; 2],
    /// The side lengths along x and y, with the unit of both.
    pub sides: Option<((f64, f64), String)>,
    /// The units along x and y, and of the heights.
    pub units: [Option<String>; 3],
    /// The unit of heights in words, and whether x and y have this unit too.
    pub said: Option<(&'static str, bool)>,
    /// The factor of the heights.
    pub factor: Option<f64>,
    /// The number that stands for missing points.
    pub missing: Option<f64>,
    /// The lines that may tell sizes and are not understood.
    pub unread: Vec<String>,
}

impl Sizes {
    /// Takes a unit along axes, or a default for all without one: one unit, or units of x, y and z.
    fn take_units(&mut self, pair: &Pair, axes: &[usize]) {
        let is_default = axes.is_empty();
        let each = units(&pair.value).filter(|_| is_default);
        let each = each.unwrap_or_else(|| [(); 3].map(|()| bare(&pair.value).to_owned()));
        for &axis in if is_default { &[0, 1, 2] } else { axes } {
            let unit = self.units[axis].take().filter(|_| is_default);
            self.units[axis] = unit.or_else(|| Some(each[axis].clone()));
        }
    }

    /// Takes lengths along x and y as sides in one unit; those without a unit are in the unit of their axis.
    fn take_sides(&mut self, lengths: &[Option<(f64, String)>; 2], default: &str) -> Parsed<()> {
        let [x, y] = [0, 1].map(|axis| {
            let (length, unit) = lengths[axis].clone()?;
            let told = self.units[axis].as_ref().or(self.units[0].as_ref());
            Some((length, if unit.is_empty() { told.map_or(default, |told| told).to_owned() } else { unit }))
        });
        match (x, y) {
            (Some((lx, x)), Some((ly, y))) => {
                let ratio = if x == y { Some(1.0) } else { per_metre(&x).zip(per_metre(&y)).map(|(x, y)| x / y) };
                let Some(ratio) = ratio else {
                    return refuse(format!("has sides in {} and {}, expected one unit", quoted(&x), quoted(&y)));
                };
                self.sides = Some(((lx, ratio * ly), x));
            }
            (x, y) => self.unread.extend(x.or(y).map(|(length, unit)| format!("{length} {unit}"))),
        }
        Ok(())
    }

    /// Takes numbers of nodes or lengths along axes, or along both axes if the name has none.
    fn take(
        &mut self,
        pair: &Pair,
        kind: Option<Kind>,
        axes: &[usize],
        nodes: [usize; 2],
        lengths: &mut [Option<(f64, String)>; 2],
    ) -> Parsed<()> {
        let Some(found) = pair.quantities() else {
            self.unread.push(pair.text());
            return Ok(());
        };
        // the shape of the array
        if axes.is_empty() && nodes[0] != nodes[1] && found == [(nodes[1] as f64, ""), (nodes[0] as f64, "")] {
            return Ok(());
        }
        let is_size = kind.is_none() || pair.name.to_lowercase().contains("size");
        for &axis in if axes.is_empty() { &[0, 1] } else { axes } {
            let (number, unit) = found[axis];
            let is_count = kind == Some(Kind::Pixels) || is_size && number == nodes[axis] as f64;
            let is_pixels = ["px", "pixel", "pixels"].contains(&unit) || unit.is_empty() && is_count;
            let is_told = kind.is_some() && (per_metre(unit).is_some() || unit.is_empty() && !axes.is_empty());
            if is_pixels {
                self.pixels[axis] = Some(number as usize);
            } else if number > 0.0 && is_told {
                let times = if kind == Some(Kind::Spacing) { nodes[axis] as f64 } else { 1.0 };
                lengths[axis] = Some((times * number, unit.to_owned()));
            } else if !unit.is_empty() && !self.unread.contains(&pair.text()) {
                self.unread.push(pair.text());
            }
        }
        Ok(())
    }

    /// Whether the lines of the block are lines of an image, from the top.
    pub fn is_image(&self) -> bool {
        self.sides.is_some() || self.pixels.iter().all(Option::is_some)
    }
}

/// The unit of heights that a comment ends with, in words, as `heights in nm`, `z [um]` or `x, y, z in nm`, and whether
/// x and y have this unit too.
fn unit_in_words(line: &str) -> Option<(&'static str, bool)> {
    const HEIGHTS: &str = " z height heights elevation topography unit units values data all ";
    const BESIDE: &str = " x y and axis lengths numbers are is given measured in of the map ";
    let is_in = |words: &str, word: &str| words.contains(&format!(" {} ", word.to_lowercase()));
    let of = |text: &str| {
        let words: Vec<_> = text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
        let (unit, words) = words.split_last()?;
        let known = words.iter().rev().take_while(|word| is_in(HEIGHTS, word) || is_in(BESIDE, word));
        let known = &words[words.len() - known.count()..];
        let has = |name: &str| known.iter().any(|word| word.eq_ignore_ascii_case(name));
        let is_of_others = (has("x") || has("y")) && !has("z");
        let is_whole = known.len() == words.len() || has("heights");
        let is_told = known.iter().any(|word| is_in(HEIGHTS, word)) && is_whole && !is_of_others;
        Some((symbol(unit).filter(|_| is_told)?, ["x", "all", "lengths"].into_iter().any(has)))
    };
    let parts = || line.split([',', ';']);
    let last = parts().filter_map(|part| Some(part.rsplit_once(':')?.1));
    std::iter::once(line).chain(parts()).chain(last).find_map(of)
}

/// The units of length of three columns, as `um,um,nm`.
fn units(line: &str) -> Option<[String; 3]> {
    let units: Vec<_> = line.split([' ', '\t', ',', ';', '"']).map(bare).filter(|unit| !unit.is_empty()).collect();
    let units = <[&str; 3]>::try_from(units).ok()?;
    units.iter().all(|unit| per_metre(unit).is_some()).then(|| units.map(str::to_owned))
}
