//! The scale of an axis: ticks, numbers and prefixes of units.

/// Below this a magnitude counts as zero, and from its inverse on as infinite, so that none overflows.
pub(super) const TINY: f64 = 1e-280;

/// Units that take SI prefixes, alone or in front of a division such as "/m".
const PREFIXABLE: [&str; 7] = ["m", "Pa", "N", "J", "s", "V", "W"];
/// The prefixes from 1e-15 to 1e12.
const PREFIXES: [&str; 10] = ["f", "p", "n", "µ", "m", "", "k", "M", "G", "T"];

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
        // The rounding of the logarithm must not print 1 µm as 1000 nm.
        let decade = if largest > TINY { (largest.log10() + 1e-9).floor() as i32 } else { 0 };
        let power = decade.div_euclid(3);
        let symbol = unit.split_once('/').map_or(unit, |(symbol, _)| symbol);
        match usize::try_from(power + 5).ok().and_then(|i| PREFIXES.get(i)) {
            Some(prefix) if PREFIXABLE.contains(&symbol) => {
                Self { factor: 10f64.powi(3 * power), exponent: 0, unit: format!("{prefix}{unit}") }
            }
            _ => {
                let exponent = if (-2..4).contains(&decade) { 0 } else { decade };
                Self { factor: 10f64.powi(exponent), exponent, unit: unit.to_owned() }
            }
        }
    }

    /// "name (unit)".
    fn label(&self, name: &str) -> String {
        let unit = match self.exponent {
            0 => self.unit.clone(),
            exponent => format!("1e{exponent} {}", self.unit),
        };
        if unit.is_empty() { name.to_owned() } else { format!("{name} ({})", unit.trim_end()) }
    }

    /// A printed number with its unit and power of ten, for an axis whose label has none.
    fn with_unit(&self, number: &str) -> String {
        let text = match self.exponent {
            0 => format!("{number} {}", self.unit),
            exponent => format!("{number}e{exponent} {}", self.unit),
        };
        text.trim_end().to_owned()
    }
}

/// A value to three digits on its own scale, with its unit.
pub(super) fn three_digits(value: f64, unit: Option<&str>) -> String {
    let scale = Scale::new(value.abs(), unit);
    let number = value / scale.factor;
    let decimals = (2.0 - number.abs().max(1e-9).log10().floor()).max(0.0) as usize;
    scale.with_unit(&format!("{number:.decimals$}"))
}

/// A range of values on an axis, with the scale of its numbers.
#[derive(Clone, Debug)]
pub(super) struct Part {
    from: f64,
    to: f64,
    scale: Scale,
}

impl Part {
    pub(super) fn new(from: f64, to: f64, unit: Option<&str>) -> Self {
        Self { from, to, scale: Scale::new(from.abs().max(to.abs()), unit) }
    }

    /// The range from zero to `length`, printed like the `longest` of the sides.
    pub(super) fn side(length: f64, longest: f64, unit: Option<&str>) -> Self {
        Self { from: 0.0, to: length, scale: Scale::new(longest, unit) }
    }

    /// Round numbers on the range in steps of 1, 2 or 5, at most `most` steps, each with its text.
    fn ticks(&self, most: i32) -> Vec<(f64, String)> {
        let (from, to) = (self.from / self.scale.factor, self.to / self.scale.factor);
        let raw = (to - from) / f64::from(most);
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
}

/// The ticks of an axis, each at a fraction of its length, and its label.
#[derive(Debug)]
pub(super) struct Axis {
    pub(super) ticks: Vec<(f64, String)>,
    pub(super) label: String,
}

impl Axis {
    /// An axis of adjoining `parts` that share its length equally, with room for `most` ticks.
    ///
    /// Where the parts are printed on different scales, each number has its unit and the label has none.
    pub(super) fn new(parts: &[Part], name: &str, most: i32) -> Self {
        let shared = parts.iter().all(|part| part.scale == parts[0].scale);
        let count = parts.len();
        let mut ticks = Vec::new();
        for (k, part) in parts.iter().enumerate() {
            for (value, number) in part.ticks((most / count as i32).clamp(1, 8)) {
                let fraction = (value - part.from) / (part.to - part.from);
                // Where two parts meet, the first has the tick.
                if k == 0 || fraction > 1e-6 {
                    let text = if shared || value == 0.0 { number } else { part.scale.with_unit(&number) };
                    ticks.push(((k as f64 + fraction.clamp(0.0, 1.0)) / count as f64, text));
                }
            }
        }
        Self { ticks, label: if shared { parts[0].scale.label(name) } else { name.to_owned() } }
    }

    /// The number of characters of the longest number.
    pub(super) fn widest(&self) -> usize {
        self.ticks.iter().map(|(_, text)| text.chars().count()).max().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(from: f64, to: f64, unit: Option<&str>, most: i32) -> (String, String) {
        let axis = Axis::new(&[Part::new(from, to, unit)], "q", most);
        let texts: Vec<_> = axis.ticks.into_iter().map(|(_, text)| text).collect();
        (texts.join(" "), axis.label)
    }

    #[test]
    fn ticks_are_round_and_cover_the_range() {
        for (from, to) in [(0.0, 1.0), (-0.3, 0.7), (1.0, 1.0 + 1e-9), (-2.5e7, 2e9), (0.0, 9.99e-5), (17.0, 19.3)] {
            for most in 1..=8 {
                let part = Part::new(from, to, None);
                let ticks = part.ticks(most);
                assert!(ticks.len() <= most as usize + 1);
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
        assert_eq!(texts(-0.02, 0.02, None, 4).0, "-0.02 -0.01 0.00 0.01 0.02");
        assert_eq!(texts(0.0, 1000.0, None, 2).0, "0 500 1000");
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
            (1e-12, "m²", "q (1e-12 m²)"),
            (1e-30, "m", "q (1e-30 m)"),
            (20.0, "nm", "q (nm)"),
            (0.0, "Pa", "q (Pa)"),
            (3e-7, "", "q (1e-7)"),
            (0.02, "", "q"),
            (9999.0, "", "q"),
            (1e4, "", "q (1e4)"),
        ] {
            assert_eq!(Scale::new(largest, Some(unit)).label("q"), label, "{largest} {unit}");
        }
        assert_eq!(texts(0.0, 5e-7, Some("m"), 5), ("0 100 200 300 400 500".into(), "q (nm)".into()));
        assert_eq!(texts(0.0, 2e-4, None, 2), ("0 1 2".into(), "q (1e-4)".into()));
        assert_eq!(three_digits(-3.2e10, Some("Pa")), "-32.0 GPa");
        assert_eq!(three_digits(4.567e-5, None), "4.57e-5");
    }

    #[test]
    fn parts_on_different_scales_have_units_at_their_numbers() {
        let parts = [Part::new(-2.5e7, 0.0, Some("Pa")), Part::new(0.0, 2e9, Some("Pa"))];
        let axis = Axis::new(&parts, "pressure", 4);
        let texts: Vec<_> = axis.ticks.iter().map(|(_, text)| text.as_str()).collect();
        assert_eq!((texts, axis.label.as_str()), (vec!["-20 MPa", "0", "1 GPa", "2 GPa"], "pressure"));
        assert_eq!(axis.ticks[1].0, 0.5);
        assert_eq!(axis.ticks[3].0, 1.0);
    }

    #[test]
    fn the_ends_of_the_doubles_have_ticks_of_some_kind() {
        for length in [5e-324, 1e-300, 1e300, f64::MAX] {
            for unit in [None, Some("m")] {
                assert!(Axis::new(&[Part::side(length, length, unit)], "x", 6).ticks.len() < 8);
            }
        }
    }
}
