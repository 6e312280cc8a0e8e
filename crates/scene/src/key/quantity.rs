//! Quantities: numbers with a unit or without one, as options take them, and their dimensions.

use std::fmt;

use crate::key::Range;

/// A number in SI units if it was given with a unit, and otherwise in whatever units its user thinks in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// The number.
    pub value: f64,
    /// Whether it had a unit, and is in SI units.
    pub has_unit: bool,
    /// Whether it is a share or a ratio, which needs none.
    is_number: bool,
}

impl Quantity {
    /// Whether it says nothing of units: zero is zero in all of them.
    pub fn is_bare(self) -> bool {
        !self.has_unit && !self.is_number && self.value != 0.0
    }

    /// A number of a dimension, without a unit.
    pub fn bare(value: f64) -> Self {
        Self { value, has_unit: false, is_number: false }
    }

    /// A number without a dimension.
    pub fn number(value: f64) -> Self {
        Self { value, has_unit: false, is_number: true }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value.fmt(f)
    }
}

/// A dimension: a product of powers of force, length, time, electric current and temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dimension {
    /// In words, with an example as options take it.
    pub what: &'static str,
    /// The unit of the SI.
    pub si: &'static str,
    /// The powers of force, length, time, electric current and temperature.
    pub(crate) powers: [i32; 5],
}

const fn dimension(what: &'static str, si: &'static str, force: i32, length: i32) -> Dimension {
    Dimension { what, si, powers: [force, length, 0, 0, 0] }
}

/// A length.
pub const LENGTH: Dimension = dimension("length, such as 20um", "m", 0, 1);
/// An area.
pub const AREA: Dimension = dimension("area", "m²", 0, 2);
/// A wave number.
pub const PER_LENGTH: Dimension = dimension("wave number, such as 2/um", "1/m", 0, -1);
/// A pressure.
pub const PRESSURE: Dimension = dimension("pressure, such as 70GPa", "Pa", 1, -2);
/// A density over the pressure.
pub const PER_PRESSURE: Dimension = dimension("density over the pressure, such as 2/GPa", "1/Pa", -1, 2);
/// A pressure per length.
pub const PRESSURE_PER_LENGTH: Dimension = dimension("pressure per length, such as 1GPa/um", "Pa/m", 1, -3);
/// A force.
pub const FORCE: Dimension = dimension("force, such as 5nN", "N", 1, 0);
/// A force per length.
pub const FORCE_PER_LENGTH: Dimension = dimension("force per length, such as 40N/m", "N/m", 1, -1);
/// An energy.
pub const ENERGY: Dimension = dimension("energy, such as 60zJ", "J", 1, 1);
/// An energy per area.
pub const ENERGY_PER_AREA: Dimension = dimension("energy per area, such as 50mJ/m2", "J/m²", 1, -1);

/// A dynamic viscosity.
pub const VISCOSITY: Dimension = Dimension { what: "viscosity, such as 1mPas", si: "Pa·s", powers: [1, -2, 1, 0, 0] };
/// An electrical resistivity.
pub const RESISTIVITY: Dimension =
    Dimension { what: "resistivity, such as 17nOhm·m", si: "Ω·m", powers: [1, 2, -1, -2, 0] };
/// A thermal conductivity.
pub const CONDUCTIVITY: Dimension =
    Dimension { what: "thermal conductivity, such as 400W/mK", si: "W/(m·K)", powers: [1, 0, -1, 0, -1] };
/// An electrical conductance per area.
pub const ELECTRICAL_CONDUCTANCE: Dimension =
    Dimension { what: "electrical conductance per area", si: "S/m²", powers: [-1, -3, 1, 2, 0] };
/// A thermal conductance per area.
pub const THERMAL_CONDUCTANCE: Dimension =
    Dimension { what: "thermal conductance per area", si: "W/(m²·K)", powers: [1, -1, -1, 0, -1] };
/// The transmissivity of a gap, a flow times viscosity over pressure.
pub const TRANSMISSIVITY: Dimension = dimension("transmissivity", "m³", 0, 3);

impl Dimension {
    /// The parser of quantities of this dimension within a range.
    pub fn within(self, range: Range) -> impl Fn(&str) -> Result<Quantity, String> + Clone + Send + Sync + 'static {
        move |text| match self.parse(text.trim()) {
            Some(found) if range.has(found.value) => Ok(found),
            found => {
                let mistake = if found.is_none() { self.mistaken_unit(text.trim()) } else { None }.unwrap_or_default();
                Err(format!("{mistake}it must be {}, alone or with a unit of {}", range.words, self.what))
            }
        }
    }

    /// The fault of the unit behind a number, if it has one.
    fn mistaken_unit(self, text: &str) -> Option<String> {
        let (_, unit) = number_and_unit(text).filter(|(_, unit)| !unit.is_empty())?;
        let mistake = match Unit::parse(unit) {
            None => "no unit that is known",
            Some(found) if !self.has(found) => "a unit of something else",
            Some(_) => return None,
        };
        let mut meant = self.respelled(unit).join(" or ");
        if !meant.is_empty() {
            meant = format!(" (did you mean {meant}?)");
        }
        Some(format!("{unit} is {mistake}{meant}, "))
    }

    /// The units of this dimension that differ from a text by capital letters alone, those with the fewest of them first.
    fn respelled(self, text: &str) -> Vec<String> {
        let mut begun = vec![String::new()];
        for part in text.split_inclusive(SEPARATORS) {
            let (symbol, _) = powers(part.trim_end_matches(SEPARATORS));
            let (names, rest) = (respellings(symbol), &part[symbol.len()..]);
            let with = |begun: &String| names.iter().map(|name| format!("{begun}{name}{rest}")).collect::<Vec<_>>();
            begun = begun.iter().flat_map(with).take(MOST_RESPELLED).collect();
        }
        begun.retain(|text| Unit::parse(text).is_some_and(|unit| self.has(unit)));
        begun.sort_by_key(|found| found.chars().zip(text.chars()).filter(|(one, other)| one != other).count());
        begun
    }

    /// Whether a unit is of this dimension.
    fn has(self, unit: Unit) -> bool {
        unit.powers == self.powers
    }

    fn parse(self, text: &str) -> Option<Quantity> {
        if let Ok(value) = text.parse() {
            return Some(Quantity::bare(value));
        }
        let (number, unit) = number_and_unit(text)?;
        let unit = Unit::parse(unit).filter(|unit| self.has(*unit))?;
        Some(Quantity { value: unit.in_si(number)?, has_unit: true, is_number: false })
    }
}

/// A number, as much of a text as can be read as one, and the unit that follows, if there is one: 1e5Pa is no 1 of a
/// unit e5Pa.
pub fn number_and_unit(text: &str) -> Option<(&str, &str)> {
    let ends = text.char_indices().map(|(at, _)| at).chain([text.len()]);
    let mut splits = ends.rev().map(|at| text.split_at(at));
    splits.find(|(number, _)| number.parse::<f64>().is_ok()).map(|(number, unit)| (number, unit.trim()))
}

/// The power of ten that a unit of length is in metres; nothing if it is no unit of length.
pub fn power_of_length(unit: &str) -> Option<i32> {
    let unit = Unit::parse(unit).filter(|unit| LENGTH.has(*unit))?;
    Some(unit.ten)
}

/// A value times a power of ten. Powers of ten are whole numbers, by which a division rounds only once.
pub fn times_ten_to(power: i32, value: f64) -> f64 {
    let ten = 10f64.powi(power.abs());
    if power < 0 { value / ten } else { value * ten }
}

/// A unit: its powers, and how much it is in SI units.
#[derive(Clone, Copy, Debug)]
struct Unit {
    /// The powers of force, length, time, electric current and temperature.
    powers: [i32; 5],
    /// The power of ten,
    ten: i32,
    /// and what is left besides it.
    factor: f64,
}

/// The symbols of units: their powers, the power of ten, and a factor. Metre and kelvin come before millikelvin.
const SYMBOLS: [(&str, [i32; 5], i32, f64); 30] = [
    ("m", [0, 1, 0, 0, 0], 0, 1.0),
    ("s", [0, 0, 1, 0, 0], 0, 1.0),
    ("Pa", [1, -2, 0, 0, 0], 0, 1.0),
    ("Pas", [1, -2, 1, 0, 0], 0, 1.0),
    ("bar", [1, -2, 0, 0, 0], 5, 1.0),
    ("psi", [1, -2, 0, 0, 0], 3, PSI),
    ("ksi", [1, -2, 0, 0, 0], 6, PSI),
    ("N", [1, 0, 0, 0, 0], 0, 1.0),
    ("dyn", [1, 0, 0, 0, 0], -5, 1.0),
    ("J", [1, 1, 0, 0, 0], 0, 1.0),
    ("erg", [1, 1, 0, 0, 0], -7, 1.0),
    ("eV", [1, 1, 0, 0, 0], -19, 1.602176634),
    ("micron", [0, 1, 0, 0, 0], -6, 1.0),
    ("microns", [0, 1, 0, 0, 0], -6, 1.0),
    ("Å", [0, 1, 0, 0, 0], -10, 1.0),
    ("\u{212b}", [0, 1, 0, 0, 0], -10, 1.0),
    ("Angstrom", [0, 1, 0, 0, 0], -10, 1.0),
    ("W", [1, 1, -1, 0, 0], 0, 1.0),
    ("mK", [0, 1, 0, 0, 1], 0, 1.0),
    ("K", [0, 0, 0, 0, 1], 0, 1.0),
    ("A", [0, 0, 0, 1, 0], 0, 1.0),
    ("V", [1, 1, -1, -1, 0], 0, 1.0),
    ("S", [-1, -1, 1, 2, 0], 0, 1.0),
    ("Ohm", [1, 1, -1, -2, 0], 0, 1.0),
    ("Ohmm", [1, 2, -1, -2, 0], 0, 1.0),
    ("Ohmcm", [1, 2, -1, -2, 0], -2, 1.0),
    ("Ω", [1, 1, -1, -2, 0], 0, 1.0),
    ("Ωm", [1, 2, -1, -2, 0], 0, 1.0),
    ("Ωcm", [1, 2, -1, -2, 0], -2, 1.0),
    ("\u{2126}", [1, 1, -1, -2, 0], 0, 1.0),
];

/// A pound-force per square inch, 0.45359237 kg times 9.80665 m/s² over (0.0254 m)², in kPa.
const PSI: f64 = 6.894757293168361;

/// The prefixes; of µ the micro sign, the Greek letter, and what stands for them.
const PREFIXES: [(&str, i32); 15] = [
    ("", 0),
    ("z", -21),
    ("a", -18),
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("µ", -6),
    ("\u{3bc}", -6),
    ("m", -3),
    ("c", -2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// What stands between the symbols of a unit.
const SEPARATORS: [char; 6] = [' ', '·', '*', '/', '(', ')'];

/// The most spellings of a unit that are looked at.
const MOST_RESPELLED: usize = 64;

/// The symbols with prefixes that differ from one by capital letters alone; itself where there is none.
fn respellings(symbol: &str) -> Vec<String> {
    let names =
        SYMBOLS.iter().flat_map(|(symbol, ..)| PREFIXES.iter().map(move |(prefix, _)| format!("{prefix}{symbol}")));
    let mut found: Vec<_> = names.filter(|name| name.to_lowercase() == symbol.to_lowercase()).collect();
    found.sort_unstable();
    found.dedup();
    if found.is_empty() { vec![symbol.to_owned()] } else { found }
}

impl Unit {
    /// A product of units with powers, as `mJ/m2`, `N/m²`, `MPa µm`, `W/(m·K)` or `W m-1 K-1`.
    fn parse(text: &str) -> Option<Self> {
        let (above, below) = text.split_once('/').map_or((text, None), |(above, below)| (above, Some(below)));
        let below = below.map(|below| below.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).unwrap_or(below));
        // as 2/µm
        let is_one = below.is_some() && ["", "1"].contains(&above);
        let above = Some(above).filter(|_| !is_one);
        let mut unit = Self { powers: [0; 5], ten: 0, factor: 1.0 };
        for (part, sign) in [(above, 1), (below, -1)] {
            for factor in part.into_iter().flat_map(|part| part.split([' ', '·', '*'])) {
                let (symbol, power) = powers(factor);
                let found = Self::symbol(symbol)?;
                let power = sign * power;
                unit.powers.iter_mut().zip(found.powers).for_each(|(own, other)| *own += power * other);
                unit.ten += power * found.ten;
                unit.factor *= found.factor.powi(power);
            }
        }
        Some(unit)
    }

    /// A symbol with a prefix or without one.
    fn symbol(text: &str) -> Option<Self> {
        SYMBOLS.iter().find_map(|&(symbol, powers, ten, factor)| {
            let prefix = text.strip_suffix(symbol)?;
            let (_, power) = PREFIXES.iter().find(|(name, _)| *name == prefix)?;
            Some(Self { powers, ten: ten + power, factor })
        })
    }

    /// The number with this unit, as near to it as one can be: 2.5 nm is the number that 2.5e-9 is.
    fn in_si(self, number: &str) -> Option<f64> {
        let (digits, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
        let exponent = exponent.parse::<i32>().ok()?.checked_add(self.ten)?;
        Some(format!("{digits}e{exponent}").parse::<f64>().ok()? * self.factor)
    }
}

/// A symbol, and its power behind it: m2, m^2, m², and of negative ones m-1, m^-1, m⁻¹.
fn powers(factor: &str) -> (&str, i32) {
    let digits = [('1', 1), ('¹', 1), ('2', 2), ('²', 2), ('3', 3), ('³', 3)];
    let power = digits.into_iter().find_map(|(digit, power)| Some((factor.strip_suffix(digit)?, power)));
    let Some((base, power)) = power else { return (factor, 1) };
    match base.strip_suffix(['-', '\u{2212}', '⁻']) {
        Some(base) => (base.strip_suffix('^').unwrap_or(base), -power),
        // one is not written
        None if power == 1 => (factor, 1),
        None => (base.strip_suffix('^').unwrap_or(base), power),
    }
}
