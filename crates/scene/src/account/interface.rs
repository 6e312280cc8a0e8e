//! The law of an interface over the load, as codes of finite elements read it.

use crate::account::column::{CONTACT_FRACTION, MEAN_PRESSURE};
use asperity::Surface;
use serde_json::Value;

use crate::key::{Conductors, LEAKAGE, Units, choice, peak};

/// The columns of a table of an interface, before those for what is asked for after each state.
pub(crate) const COLUMNS: &str = "mean_pressure mean_gap closure contact_fraction corrected_contact_fraction \
                                  contact_stiffness stiffness_error";
/// Those behind them.
pub(crate) const OUTCOME: &str = "branch relative_error status";

choice! {
    /// A code of finite elements.
    Code {
        /// Abaqus: a surface interaction, .inp
        Abaqus = "abaqus",
        /// COMSOL Multiphysics: interpolation functions, .txt
        Comsol = "comsol",
        /// MOOSE: data files of PiecewiseLinear, .csv
        Moose = "moose",
    }
}

/// The mean gap at which the undeformed surfaces first touch, from which the closure counts; of the nodes that are there,
/// which one process has to have.
pub fn touch(surface: &Surface) -> f64 {
    let Some(absent) = surface.absent() else { return peak(surface) - surface.mean() };
    let facing = surface.heights().iter().zip(absent).filter(|(_, absent)| !**absent);
    let facing: Vec<f64> = facing.map(|(height, _)| *height).collect();
    let peak = facing.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    facing.iter().map(|height| peak - height).sum::<f64>() / facing.len() as f64
}

/// A function of one argument, by points with growing arguments.
struct Function {
    /// The end of the name of its file.
    name: &'static str,
    /// The names of the columns: of the argument, and of the values.
    columns: Vec<&'static str>,
    points: Vec<Vec<f64>>,
}

impl Code {
    /// The ends of the names of all files that it may have.
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Abaqus => &[".inp"],
            Self::Comsol => &[".pressure.txt", ".conductance.txt", ".transmissivity.txt"],
            Self::Moose => &[".pressure.csv", ".conductance.csv", ".transmissivity.csv"],
        }
    }

    /// Whether a text belongs to such a file, of any rows: it begins with the names of its columns.
    pub fn wrote(text: &str) -> bool {
        let columns = match text.strip_prefix("*SURFACE INTERACTION, NAME=") {
            Some(rest) => rest.lines().nth(2).and_then(|line| line.strip_prefix("** ")),
            None => text.strip_prefix("% ").or(text.strip_prefix("# ")),
        };
        columns.is_some_and(|columns| ["closure", MEAN_PRESSURE].iter().any(|name| columns.starts_with(name)))
    }

    /// The files of the rows of a table, with or without adhesion: the ends of their names, and their texts. `name`
    /// belongs to the interface.
    ///
    /// Pressure over closure, conductance over pressure, and transmissivity over pressure, each a function by points.
    /// Closure and conductance count from no pressure: without adhesion from first touch, with adhesion between the
    /// rows around it.
    ///
    /// # Errors
    /// The reason why the rows are no function, and a remedy, for [`worded`](crate::worded).
    pub fn files(
        self,
        rows: &[Value],
        adhesive: bool,
        name: &str,
        units: &Units,
    ) -> Result<Vec<(&'static str, String)>, String> {
        let functions = functions(rows, adhesive)?;
        if self == Self::Abaqus {
            return Ok(vec![(self.endings()[0], abaqus(&functions, name, units))]);
        }
        let text = |function: &Function| {
            let named = units.columns(&function.columns, "", false);
            let (comment, between) = if self == Self::Comsol { ("%", " ") } else { ("#", ",") };
            let lines = function.points.iter().map(|point| {
                let numbers: Vec<_> = point.iter().map(|number| digits(*number)).collect();
                numbers.join(between) + "\n"
            });
            format!("{comment} {}\n{}", named.join(", "), lines.collect::<String>())
        };
        let ending = |function: &Function| self.endings().iter().find(|ending| ending.contains(function.name)).copied();
        Ok(functions.iter().filter_map(|function| Some((ending(function)?, text(function)))).collect())
    }
}

/// A number as all codes read it: at most twenty characters, with a decimal point.
fn digits(number: f64) -> String {
    format!("{number:.9e}")
}

/// The surface interaction of Abaqus: pressure over overclosure, and a conductance over pressure.
fn abaqus(functions: &[Function], name: &str, units: &Units) -> String {
    let mut text = format!("*SURFACE INTERACTION, NAME={}\n", label(name));
    for Function { columns, points, .. } in functions {
        let keyword = match columns[1] {
            MEAN_PRESSURE => "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR",
            "electrical_conductance" => "*GAP ELECTRICAL CONDUCTANCE, PRESSURE",
            "thermal_conductance" => "*GAP CONDUCTANCE, PRESSURE",
            // there is no keyword for a leakage
            _ => continue,
        };
        let named = units.columns(&[columns[1], columns[0]], "", false).join(", ");
        text.push_str(&format!("{keyword}\n** {named}\n"));
        text.extend(points.iter().map(|point| format!("{}, {}\n", digits(point[1]), digits(point[0]))));
    }
    text
}

/// A label of Abaqus: at most 80 letters, digits, hyphens and underscores, a letter first.
fn label(name: &str) -> String {
    let allowed = |c: char| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '_' };
    let name: String = name.chars().map(allowed).take(78).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("I_{name}") }
}

fn number(row: &Value, name: &str) -> Option<f64> {
    row[name].as_f64()
}

/// Closure, mean pressure, and a conductance.
type State = (f64, f64, Option<f64>);

/// The state without a pressure, on the line between a state under a tension and another one.
fn unloaded(below: State, above: State) -> State {
    let share = -below.1 / (above.1 - below.1);
    let between = |a: f64, b: f64| a + share * (b - a);
    let conductance = below.2.zip(above.2).map(|(a, b)| between(a, b));
    (between(below.0, above.0), 0.0, conductance)
}

/// The refusal of two states between which the pressure or the closure does not grow.
fn turns(rows: &[Value], two: &[State]) -> String {
    let full = rows.iter().filter(|row| number(row, CONTACT_FRACTION) == Some(1.0));
    let mut full: Vec<_> = full.filter_map(|row| number(row, MEAN_PRESSURE)).collect();
    full.sort_by(f64::total_cmp);
    if let [least, _, ..] = full[..] {
        return format!(
            "the contact is full at {least:e}, and from there on the closure grows no more: leave out the loads beyond it"
        );
    }
    format!(
        "the pressure is no function of the closure: {:e} at {:e} comes before {:e} at {:e}: give loads that grow, or \
         loads that fall",
        two[0].1, two[0].0, two[1].1, two[1].0
    )
}

/// The functions that the rows of a table are.
fn functions(rows: &[Value], adhesive: bool) -> Result<Vec<Function>, String> {
    let kind = Conductors::COLUMNS.into_iter().find(|kind| rows.iter().any(|row| number(row, kind).is_some()));
    let state = |row: &Value| {
        let at = (number(row, "closure")?, number(row, MEAN_PRESSURE)?);
        Some((at.0, at.1, kind.and_then(|kind| number(row, kind))))
    };
    let mut states: Vec<_> = rows.iter().filter_map(state).collect();
    if states.windows(2).all(|two| two[1].0 < two[0].0) {
        states.reverse();
    }
    if let Some(two) = states.windows(2).find(|two| two[1].0 <= two[0].0 || two[1].1 <= two[0].1) {
        return Err(turns(rows, two));
    }
    let first = states.iter().position(|state| state.1 > 0.0).ok_or("no row has a pressure: give {mean_pressures}")?;
    let origin = match first.checked_sub(1) {
        _ if !adhesive => (0.0, 0.0, kind.map(|_| 0.0)),
        None => {
            return Err("with adhesion surfaces touch without a pressure, and no row says where: add 0 to \
                        {mean_pressures}"
                .to_owned());
        }
        Some(before) => unloaded(states[before], states[first]),
    };
    let states: Vec<_> = std::iter::once(origin).chain(states.split_off(first)).collect();
    let pressure = Function {
        name: "pressure",
        columns: vec!["closure", MEAN_PRESSURE],
        points: states.iter().map(|state| vec![state.0, state.1]).collect(),
    };
    let mut all = vec![pressure];
    if let Some(kind) = kind {
        let points = states.iter().filter_map(|state| Some(vec![state.1, state.2?])).collect();
        all.push(Function { name: "conductance", columns: vec![MEAN_PRESSURE, kind], points });
    }
    let leak = |row: &Value| {
        let pressure = number(row, MEAN_PRESSURE).filter(|pressure| *pressure >= 0.0)?;
        let bounds = LEAKAGE.into_iter().map(|name| number(row, name));
        std::iter::once(Some(pressure)).chain(bounds).collect::<Option<Vec<_>>>()
    };
    let mut points: Vec<_> = rows.iter().filter_map(leak).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    if !points.is_empty() {
        let columns = std::iter::once(MEAN_PRESSURE).chain(LEAKAGE).collect();
        all.push(Function { name: "transmissivity", columns, points });
    }
    Ok(all)
}
