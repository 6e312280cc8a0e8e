//! The scale of an axis: ticks, numbers and prefixes of units.

/// Below this a magnitude counts as zero, and from its inverse on as infinite, so that none overflows.
pub(super) const TINY: f64 = 1e-280;

/// Units that take SI prefixes, alone or in front of a division such as "/m".
const PREFIXABLE: [&str; 7] = ["m", "Pa", "N", "J", "s", "V", "W"];
/// The prefixes from 1e-18 to 1e12.
const PREFIXES: [&str; 11] = ["a", "f", "p", "n", "µ", "m", "", "k", "M", "G", "T"];

/// The least number on a logarithmic axis that is not written as a power of ten.
const PLAIN: f64 = 5e-4;

/// The factor by which the numbers of an axis are divided, in the prefix of the unit or written as a power of ten.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scale {
    factor: f64,
    exponent: i32,
    unit: String,
}

impl Scale {
    /// A scale on which numbers up to the magnitude `largest` are readable.
    fn new(largest: f64, unit: Option<&str>) -> Self {
        let unit = unit.unwrap_or("");
        // a stiffness is said over micrometres
        if unit == "Pa/m" && largest >= 1e12 {
            let scale = Self::new(1e-6 * largest, Some("Pa/µm"));
            return Self { factor: 1e6 * scale.factor, ..scale };
        }
        // The rounding of the logarithm must not print 1 µm as 1000 nm.
        let decade = if largest > TINY { (largest.log10() + 1e-9).floor() as i32 } else { 0 };
        let (symbol, power) = symbol(unit);
        // of µm² two decades lie below one, too
        let lowest = 2 * (1 - power.abs());
        let thousands = power.signum() * (decade - lowest).div_euclid(3 * power.abs());
        let prefix = usize::try_from(thousands + 6).ok().and_then(|i| PREFIXES.get(i));
        let prefix = prefix.filter(|_| PREFIXABLE.contains(&symbol));
        let shift = prefix.map_or(0, |_| 3 * power * thousands);
        let exponent = if (-2..4).contains(&(decade - shift)) { 0 } else { decade - shift };
        let unit = match (prefix, power) {
            (Some(prefix), -1) => format!("1/{prefix}{symbol}"),
            (prefix, _) => format!("{}{unit}", prefix.unwrap_or(&"")),
        };
        Self { factor: 10f64.powi(shift + exponent), exponent, unit }
    }

    /// "name (unit)".
    fn label(&self, name: &str) -> String {
        let unit = match self.exponent {
            0 => self.unit.clone(),
            exponent => format!("10{} {}", superscript(exponent), self.unit),
        };
        if unit.is_empty() { name.to_owned() } else { format!("{name} ({})", unit.trim_end()) }
    }

    /// A printed number with its unit and power of ten, for an axis with a label that has neither.
    fn with_unit(&self, number: &str) -> String {
        let text = match self.exponent {
            0 => format!("{number} {}", self.unit),
            exponent => format!("{number}·10{} {}", superscript(exponent), self.unit),
        };
        text.trim_end().to_owned()
    }
}

/// The symbol of a unit, which may take a prefix, and its power: of m²/s it is 2, and of 1/m it is -1.
fn symbol(unit: &str) -> (&str, i32) {
    let (above, below) = unit.split_once('/').unwrap_or((unit, ""));
    let powers = [('²', 2), ('³', 3), ('⁴', 4)];
    let raised = powers.into_iter().find_map(|(sign, power)| Some((above.strip_suffix(sign)?, power)));
    if above == "1" { (below, -1) } else { raised.unwrap_or((above, 1)) }
}

/// A value to three digits on its own scale, with its unit.
pub(super) fn three_digits(value: f64, unit: Option<&str>) -> String {
    // rounded first, so that 999.9 p is 1 n
    let value = format!("{value:.2e}").parse().unwrap_or(value);
    let scale = Scale::new(value.abs(), unit);
    let number = value / scale.factor;
    if number == 0.0 {
        return "0".to_owned();
    }
    let decimals = (2.0 - number.abs().max(1e-9).log10().floor()).max(0.0) as usize;
    scale.with_unit(&format!("{number:.decimals$}")).replace('-', "−")
}

/// An exponent as it is set behind a number.
fn superscript(exponent: i32) -> String {
    let digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    let raised = |c: char| c.to_digit(10).and_then(|digit| digits.chars().nth(digit as usize)).unwrap_or('⁻');
    exponent.to_string().chars().map(raised).collect()
}

/// A range of values on an axis, linear or logarithmic, with the scale of its numbers.
#[derive(Clone, Debug)]
pub(super) struct Part {
    from: f64,
    to: f64,
    scale: Scale,
    logarithmic: bool,
}

impl Part {
    pub(super) fn new(from: f64, to: f64, unit: Option<&str>) -> Self {
        Self { from, to, scale: Scale::new(from.abs().max(to.abs()), unit), logarithmic: false }
    }

    /// The range from zero to `length`, printed like the `longest` of the sides.
    pub(super) fn side(length: f64, longest: f64, unit: Option<&str>) -> Self {
        Self { from: 0.0, to: length, scale: Scale::new(longest, unit), logarithmic: false }
    }

    /// A logarithmic range between positive values.
    pub(super) fn logarithmic(from: f64, to: f64, unit: Option<&str>) -> Self {
        let mut scale = Scale::new(to, unit);
        // powers of ten are at the numbers, where these are not readable on one scale; a square has its prefix there, too
        if scale.exponent != 0 || from < PLAIN * scale.factor {
            let unit = unit.unwrap_or("");
            scale = match symbol(unit) {
                (_, 1) => Scale { factor: 1.0, exponent: 0, unit: unit.to_owned() },
                _ => Scale { factor: scale.factor / 10f64.powi(scale.exponent), exponent: 0, ..scale },
            };
        }
        Self { from, to, scale, logarithmic: true }
    }

    /// The place of a value, as a share of the range.
    pub(super) fn share(&self, value: f64) -> f64 {
        let Self { from, to, .. } = *self;
        if self.logarithmic { (value.ln() - from.ln()) / (to.ln() - from.ln()) } else { (value - from) / (to - from) }
    }

    /// Round numbers on the range, each with its text, or none next to one that has. There is room for `most` steps; at
    /// least three numbers are there, or two where there is no room for more.
    fn ticks(&self, most: i32) -> Vec<(f64, String)> {
        let least = if most < 3 { 2 } else { 3 };
        let found = if self.logarithmic { self.round_powers(most) } else { Vec::new() };
        if found.iter().filter(|(_, text)| !text.is_empty()).count() >= least {
            return found;
        }
        // more steps than there is room for, where there would be too few numbers
        let found = (2..=12).map(|halves| self.round_steps(0.5 * f64::from(halves * most)));
        found.fold(Vec::new(), |ticks, finer| if ticks.len() < least { finer } else { ticks })
    }

    /// Numbers in steps of 1, 2 or 5, at most `most` steps.
    fn round_steps(&self, most: f64) -> Vec<(f64, String)> {
        let (from, to) = (self.from / self.scale.factor, self.to / self.scale.factor);
        let raw = (to - from) / most;
        let decade = 10f64.powf(raw.log10().floor());
        let step = decade * [1.0, 2.0, 5.0].into_iter().find(|m| m * decade >= raw * (1.0 - 1e-9)).unwrap_or(10.0);
        let decimals = (-step.log10() - 1e-9).ceil().clamp(0.0, 17.0) as usize;
        let (first, last) = ((from / step - 1e-6).ceil() as i64, (to / step + 1e-6).floor() as i64);
        let tick = |i| {
            let number = i as f64 * step;
            (number * self.scale.factor, format!("{number:.decimals$}"))
        };
        // Lengths at the end of the doubles have no sensible step.
        (first..=last).take(most as usize + 1).map(tick).collect()
    }

    /// Powers of ten, and between few of them their double and fivefold; the other multiples have no text.
    fn round_powers(&self, most: i32) -> Vec<(f64, String)> {
        let (from, to) = (self.from / self.scale.factor, self.to / self.scale.factor);
        let (first, last) = (from.log10().floor() as i32, to.log10().floor() as i32);
        let within = |number: f64| number >= from * (1.0 - 1e-9) && number <= to * (1.0 + 1e-9);
        let powers = (first..=last).filter(|power| within(10f64.powi(*power))).count() as i32;
        let stride = (powers / most.max(3)).max(1);
        let plain = from >= PLAIN && to < 2e4;
        let multiples = (first..=last).flat_map(|power| (1..10).map(move |multiple| (multiple, power)));
        let ticks = multiples.filter_map(|(multiple, power)| {
            let number = f64::from(multiple) * 10f64.powi(power);
            let labelled = match multiple {
                1 => power.rem_euclid(stride) == 0,
                2 | 5 => powers < 3,
                _ => false,
            };
            let text = match multiple {
                _ if !labelled => String::new(),
                _ if plain => format!("{number:.*}", usize::try_from(-power).unwrap_or(0)),
                1 => format!("10{}", superscript(power)),
                _ => format!("{multiple}·10{}", superscript(power)),
            };
            (within(number) && (labelled || powers < 9)).then_some((number * self.scale.factor, text))
        });
        ticks.collect()
    }
}

/// The ticks of an axis, each at a fraction of its length and with its number, if it has one, and its label.
#[derive(Debug)]
pub(super) struct Axis {
    pub(super) ticks: Vec<(f64, String)>,
    pub(super) label: String,
}

impl Axis {
    /// An axis for a range of values, with room for `most` ticks.
    pub(super) fn new(part: &Part, name: &str, most: i32) -> Self {
        let tick = |(value, number): (f64, String)| (part.share(value).clamp(0.0, 1.0), number.replace('-', "−"));
        Self { ticks: part.ticks(most.clamp(1, 8)).into_iter().map(tick).collect(), label: part.scale.label(name) }
    }
}

/// Whether a value has a place on a scale: it is finite, and so are sums of it and its neighbours.
pub(super) fn drawable(value: f64) -> bool {
    value.abs() < 1.0 / TINY
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(from: f64, to: f64, unit: Option<&str>, most: i32) -> (String, String) {
        let axis = Axis::new(&Part::new(from, to, unit), "q", most);
        let texts: Vec<_> = axis.ticks.into_iter().map(|(_, text)| text).collect();
        (texts.join(" "), axis.label)
    }

    #[test]
    fn ticks_are_round_and_cover_the_range() {
        for (from, to) in [(0.0, 1.0), (-0.3, 0.7), (1.0, 1.0 + 1e-9), (-2.5e7, 2e9), (0.0, 9.99e-5), (17.0, 19.3)] {
            for most in 1..=8 {
                let part = Part::new(from, to, None);
                let ticks = part.ticks(most);
                let least = if most < 3 { 2 } else { 3 };
                assert!(ticks.len() >= least && ticks.len() <= 4 * most as usize + 2, "{from} {to} {most}: {ticks:?}");
                let slack = 1e-4 * (to - from);
                assert!(ticks.iter().all(|(v, _)| *v >= from - slack && *v <= to + slack), "{ticks:?}");
                if let [(a, _), (b, _), ..] = ticks[..] {
                    let step = b - a;
                    let mantissa = step / 10f64.powf((step.log10() + 1e-6).floor());
                    assert!([1.0, 2.0, 5.0].iter().any(|m| (mantissa - m).abs() < 1e-4), "{step}");
                    // neither end has room for one more
                    assert!(a - from < step && to - ticks[ticks.len() - 1].0 < step * (1.0 + 1e-4));
                }
                for (value, text) in &ticks {
                    let printed: f64 = text.parse().unwrap();
                    assert!((printed * part.scale.factor - value).abs() < slack, "{text} for {value}");
                }
            }
        }
        assert_eq!(texts(0.0, 1.0, None, 5).0, "0.0 0.2 0.4 0.6 0.8 1.0");
        assert_eq!(texts(-0.02, 0.02, None, 4).0, "−0.02 −0.01 0.00 0.01 0.02");
        assert_eq!(texts(0.0, 1000.0, None, 2).0, "0 500 1000");
    }

    #[test]
    fn logarithmic_axes_have_numbers_too() {
        let texts = |from: f64, to: f64, unit| {
            let axis = Axis::new(&Part::logarithmic(from, to, unit), "q", 8);
            let texts = axis.ticks.iter().map(|(_, text)| text.as_str()).filter(|text| !text.is_empty());
            (texts.collect::<Vec<_>>().join(" "), axis.label)
        };
        assert_eq!(texts(1e-3, 1.0, None), ("0.001 0.01 0.1 1".into(), "q".into()));
        assert_eq!(texts(1e-8, 1e-5, None), ("10⁻⁸ 10⁻⁷ 10⁻⁶ 10⁻⁵".into(), "q".into()));
        assert_eq!(texts(2e-2, 0.4, None), ("0.02 0.05 0.1 0.2".into(), "q".into()));
        assert_eq!(texts(1e6, 1e9, Some("Pa")), ("0.001 0.01 0.1 1".into(), "q (GPa)".into()));
        assert_eq!(texts(1e3, 1e9, Some("Pa")).1, "q (Pa)");
        assert_eq!(texts(1e-16, 1e-12, Some("m²")), ("10⁻⁴ 10⁻³ 10⁻² 10⁻¹ 10⁰".into(), "q (µm²)".into()));
        assert_eq!(texts(3.1, 3.3, None).0, "3.10 3.15 3.20 3.25 3.30");
        for (from, to) in [(1.0, 1.01), (1e-9, 1e-8), (0.7, 90.0), (1e-200, 1e200), (3e-7, 8e-5), (2.1, 3.9)] {
            // charts have room for eight
            for most in 3..=8 {
                let part = Part::logarithmic(from, to, None);
                let ticks = part.ticks(most);
                let numbers = ticks.iter().filter(|(_, text)| !text.is_empty()).count();
                assert!(numbers >= 3 && numbers <= 3 * most as usize + 3, "{from} {to} {most}: {ticks:?}");
                assert!(ticks.iter().all(|(v, _)| part.share(*v) > -1e-6 && part.share(*v) < 1.0 + 1e-6));
            }
        }
    }

    #[test]
    fn units_get_the_prefix_that_makes_numbers_readable() {
        for (largest, unit, label) in [
            (5e-7, "m", "q (nm)"),
            (1e-6, "m", "q (µm)"),
            (2.4e-4, "m", "q (µm)"),
            (1e7, "Pa", "q (MPa)"),
            (1e9, "Pa", "q (GPa)"),
            (0.05, "J/m²", "q (mJ/m²)"),
            (3.0, "N/m", "q (N/m)"),
            (1e-12, "m²", "q (µm²)"),
            (1e-13, "m²", "q (µm²)"),
            (4e-15, "m²", "q (nm²)"),
            (3e-20, "m³/(Pa·s)", "q (µm³/(Pa·s))"),
            (2e-33, "m⁴", "q (nm⁴)"),
            (2e7, "1/m", "q (1/µm)"),
            (2e-9, "1/Pa", "q (1/GPa)"),
            (1e-12, "1/um", "q (10⁻¹² 1/um)"),
            (4e15, "Pa/m", "q (GPa/µm)"),
            (1e-30, "m", "q (10⁻³⁰ m)"),
            (20.0, "nm", "q (nm)"),
            (0.0, "Pa", "q (Pa)"),
            (3e-7, "", "q (10⁻⁷)"),
            (0.02, "", "q"),
            (9999.0, "", "q"),
            (1e4, "", "q (10⁴)"),
        ] {
            assert_eq!(Scale::new(largest, Some(unit)).label("q"), label, "{largest} {unit}");
        }
        assert_eq!(texts(0.0, 5e-7, Some("m"), 5), ("0 100 200 300 400 500".into(), "q (nm)".into()));
        assert_eq!(texts(0.0, 2e-4, None, 2), ("0 1 2".into(), "q (10⁻⁴)".into()));
        assert_eq!(three_digits(-3.2e10, Some("Pa")), "−32.0 GPa");
        assert_eq!(three_digits(4.567e-5, None), "4.57·10⁻⁵");
        assert_eq!(three_digits(9.999e-10, Some("m")), "1.00 nm");
    }

    #[test]
    fn the_ends_of_the_doubles_have_ticks_of_some_kind() {
        for length in [5e-324, 1e-300, 1e300, f64::MAX] {
            for unit in [None, Some("m")] {
                assert!(Axis::new(&Part::side(length, length, unit), "x", 6).ticks.len() < 8);
            }
        }
    }
}
