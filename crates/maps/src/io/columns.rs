//! The names and units of the columns of a text.

use super::units::{bare, per_metre};
use super::{Parsed, quoted, refuse};

/// The names and units of columns, x and y among them.
#[derive(Clone)]
pub(super) struct Columns(Vec<[String; 2]>);

/// Names of a column of heights.
const NAMES_OF_HEIGHTS: [&str; 6] = ["z", "height", "heights", "h", "elevation", "topography"];

impl Columns {
    /// The columns of a line, as `X[um] Y[um] Z[nm]`, `x (µm), y (µm), z (nm)` or `# columns: i;x;y;z`.
    pub fn read(line: &str) -> Option<Self> {
        let line = line.rsplit([':', '\u{ff1a}']).next()?.replace(" [", "[").replace(" (", "(");
        let mut columns: Vec<[String; 2]> = Vec::new();
        for field in fields(&line) {
            if field.contains(" in ") {
                return None;
            }
            let ends = |separator| field.rsplit_once(separator).filter(|(_, unit)| per_metre(bare(unit)).is_some());
            match (field.split_once(['[', '(', '/']).or_else(|| ends(' ')).or_else(|| ends('_')), columns.last_mut()) {
                // a unit behind a blank
                (None, Some([_, unit])) if unit.is_empty() && per_metre(field).is_some() => unit.push_str(field),
                (Some((name, unit)), _) => columns.push([name.trim().to_lowercase(), bare(unit).to_owned()]),
                (None, _) => columns.push([field.to_lowercase(), String::new()]),
            }
        }
        let columns = Self(columns);
        (columns.0.len() > 2 && columns.place("x").and(columns.place("y")).is_some()).then_some(columns)
    }

    /// Takes the units of length in a line below the names, if it has one for each of x, y and z.
    pub fn take_units(&mut self, line: &str) {
        let units: Vec<_> = fields(line).map(bare).collect();
        let has_none = self.0.iter().all(|[_, unit]| unit.is_empty());
        let of_points = ["x", "y", "z"].map(|axis| self.place(axis).and_then(|place| units.get(place)));
        let is_length = |unit: &Option<&&str>| unit.is_some_and(|unit| per_metre(unit).is_some());
        if has_none && units.len() == self.0.len() && of_points.iter().all(is_length) {
            self.0.iter_mut().zip(units).for_each(|([_, of], unit)| unit.clone_into(of));
        }
    }

    /// The place of x, y or z, if it is the only one.
    fn place(&self, axis: &str) -> Option<usize> {
        let is_named = |name: &str| name == axis || axis == "z" && NAMES_OF_HEIGHTS.contains(&name);
        let mut places = self.0.iter().enumerate().filter(|(_, [name, _])| is_named(name)).map(|(place, _)| place);
        places.next().filter(|_| places.next().is_none())
    }

    /// The unit of x, y or z, if it is the only one; empty where none is told.
    pub fn unit(&self, axis: &str) -> Option<String> {
        Some(self.0[self.place(axis)?][1].clone())
    }

    /// The places of x, y and z among so many columns.
    pub fn places(&self, count: usize) -> Parsed<[usize; 3]> {
        let names: Vec<_> = self.0.iter().map(|[name, _]| name.as_str()).collect();
        let names = quoted(&names.join(" "));
        match ["x", "y", "z"].map(|axis| self.place(axis)) {
            _ if count != self.0.len() => refuse(format!(
                "names {} columns, {names}, but has {count} numbers on a line: name each column, or leave the names out",
                self.0.len()
            )),
            [Some(x), Some(y), Some(z)] => Ok([x, y, z]),
            _ => refuse(format!("names the columns {names}: name one of heights z, or leave the names out")),
        }
    }
}

/// The fields of a line of names or units: between semicolons, commas or tabs, or else between blanks.
fn fields(line: &str) -> impl Iterator<Item = &str> {
    let separator = [';', ',', '\t'].into_iter().find(|separator| line.contains(*separator));
    let is_end = move |c: char| separator.map_or(c.is_whitespace(), |separator| c == separator);
    let fields = line.trim_matches(' ').split(is_end).map(|field| field.trim().trim_matches('"').trim());
    fields.filter(move |field| separator.is_some() || !field.is_empty())
}
