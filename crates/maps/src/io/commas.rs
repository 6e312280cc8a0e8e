//! The commas of a text: whether they separate numbers, or are within them.

use std::collections::BTreeSet;

/// The different numbers behind commas that tell whole numbers from decimal places: of so many decimal places some begin
/// with a zero.
const TELLING: usize = 60;

/// What the rows of a text tell of their commas.
#[derive(Default)]
pub(super) struct Commas {
    /// Whether in some row commas are between numbers for sure.
    separate: bool,
    /// Whether some number has a decimal point, an exponent, or a zero in front, as no whole number has.
    has_parts: bool,
    /// The different numbers before commas, three at most.
    before: BTreeSet<String>,
    /// The different numbers behind commas, of two digits or more, [`TELLING`] at most.
    behind: BTreeSet<String>,
    /// The most commas in a row.
    most: usize,
}

impl Commas {
    /// Takes a row.
    pub fn take(&mut self, row: &str) {
        if self.separate {
            return;
        }
        // commas that end a row, or have a blank next to them, are between numbers
        let parts = row.trim().trim_end_matches(',').split(", ").flat_map(|part| part.split(" ,"));
        for part in parts {
            let mut fields = part.trim().split(',');
            while let Some(before) = fields.next() {
                match fields.next() {
                    Some(behind) if is_one_number(before, behind) => self.take_pair(before, behind),
                    _ => {
                        self.separate = true;
                        return;
                    }
                }
            }
        }
        self.most = self.most.max(row.bytes().filter(|byte| *byte == b',').count());
    }

    /// Takes what may be one number with a comma.
    fn take_pair(&mut self, before: &str, behind: &str) {
        let before = before.trim_start_matches(SIGNS);
        let has_zero = |text: &str| text.len() > 1 && text.starts_with('0');
        self.has_parts |= !is_digits(before) || !is_digits(behind) || has_zero(before) || has_zero(behind);
        if self.before.len() < 3 && !self.before.contains(before) {
            self.before.insert(before.to_owned());
        }
        if self.behind.len() < TELLING && behind.len() > 1 && !self.behind.contains(behind) {
            self.behind.insert(behind.to_owned());
        }
    }

    /// Whether each comma may be within a number, and nothing tells that the numbers are whole ones.
    pub fn may_be_decimal(&self) -> bool {
        let are_whole = self.most > 1 && !self.has_parts && self.before.len() == 3 && self.behind.len() == TELLING;
        !self.separate && !are_whole
    }
}

/// The signs of numbers, of which one is that of typeset tables.
const SIGNS: [char; 3] = ['-', '+', '\u{2212}'];

/// Whether a text is of digits alone.
fn is_digits(text: &str) -> bool {
    text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Whether the texts before and behind a comma may be one number: `-1,5`, `1.234,5`, `1,2E-7` or `1,234.5`, and not `1.5,2`
/// or `1,-2`.
fn is_one_number(before: &str, behind: &str) -> bool {
    let mut groups = before.trim_start_matches(SIGNS).split('.');
    let is_whole = groups.next().is_some_and(is_digits) && groups.all(|group| group.len() == 3 && is_digits(group));
    let mantissa = behind.split(['e', 'E', 'd', 'D']).next().unwrap_or_default();
    let is_thousands = |(group, digits): (&str, &str)| group.len() == 3 && is_digits(group) && is_digits(digits);
    is_whole && !behind.is_empty() && (is_digits(mantissa) || mantissa.split_once('.').is_some_and(is_thousands))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn may_be_decimal(text: &str) -> bool {
        let mut commas = Commas::default();
        text.lines().for_each(|line| commas.take(line));
        commas.may_be_decimal()
    }

    #[test]
    fn commas_within_numbers_are_told_from_commas_between_numbers() {
        for text in [
            "1,5",
            "1,5,2,5",
            "-1,5,2,5",
            "1,5, 2,5",
            "1,5 ,2,5",
            "1,5,2,5,",
            "1.234,5,2,5",
            "1,2E-7,3,4e+2",
            "1,234.5,2,345.0",
            ",5,1,5",
            "1,05,2,50\n3,25,4,75",
        ] {
            assert!(may_be_decimal(text), "{text}");
        }
        for text in ["1.5,2", "1,-2", "1,5,2", "1,5,2,5\n1,5,-2,-5", "1, 5, 2, 5", "1,5.5,2,5", "1 2 3"] {
            assert!(!may_be_decimal(text), "{text}");
        }
    }

    #[test]
    fn many_numbers_without_a_zero_in_front_are_whole_ones() {
        let table = |number: &dyn Fn(usize) -> String| {
            let row = |i: usize| (0..8).map(|j| number(8 * i + j)).collect::<Vec<_>>().join(",");
            (0..40).map(row).collect::<Vec<_>>().join("\n")
        };
        assert!(!may_be_decimal(&table(&|k| (97 * k % 251).to_string())));
        // few values, values between two whole numbers, and decimal places
        assert!(may_be_decimal(&table(&|k| (k % 7 + 10).to_string())));
        assert!(may_be_decimal(&table(&|k| format!("0,{}", 97 * k % 251 + 100))));
        assert!(may_be_decimal(&table(&|k| format!("{},{:02}", k % 5, 37 * k % 100))));
    }
}
