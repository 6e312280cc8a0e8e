//! The ranges of numbers that keys and options allow.

use asperity_maps::io::LONGEST_UNIT;

/// A range of numbers.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    allowed: fn(f64) -> bool,
    /// The numbers in words, with their article.
    pub words: &'static str,
}

impl Range {
    /// All numbers that are finite.
    pub const FINITE: Self = Self { allowed: f64::is_finite, words: "a number, and finite" };
    /// Numbers above zero.
    pub const POSITIVE: Self = Self { allowed: |v| v > 0.0 && v.is_finite(), words: "a number, positive and finite" };
    /// Zero, and numbers above it.
    pub const NON_NEGATIVE: Self =
        Self { allowed: |v| v >= 0.0 && v.is_finite(), words: "a number, zero or positive and finite" };
    /// A share that is neither nothing nor all.
    pub const SHARE: Self = Self { allowed: |v| v > 0.0 && v < 1.0, words: "a share between 0 and 1" };
    /// Poisson's ratio.
    pub const POISSON: Self =
        Self { allowed: |v| v > -1.0 && v <= 0.5, words: "a number greater than -1 and at most 0.5" };
    /// An angle between 0 and 90 degrees.
    pub const ACUTE: Self =
        Self { allowed: |v| v > 0.0 && v < 90.0, words: "a number of degrees, positive and below 90" };
    /// A resolution in pixels per inch.
    pub const RESOLUTION: Self =
        Self { allowed: |v| (36.0..=1200.0).contains(&v), words: "a number of pixels per inch, from 36 to 1200" };

    /// Whether a number is in the range.
    pub fn has(self, number: f64) -> bool {
        (self.allowed)(number)
    }

    /// The number of a text.
    ///
    /// # Errors
    /// What it must be.
    pub fn number(self, text: &str) -> Result<f64, String> {
        let number = text.trim().parse().ok().filter(|number| self.has(*number));
        number.ok_or_else(|| format!("it must be {}", self.words))
    }
}

/// A unit, which will be printed, and may come into a file.
///
/// # Errors
/// What it must be.
pub fn unit(text: &str) -> Result<String, String> {
    let fits = text.chars().count() <= LONGEST_UNIT && !text.contains(char::is_control);
    let text = Some(text.to_owned()).filter(|_| fits);
    text.ok_or_else(|| format!("it must be a text of at most {LONGEST_UNIT} characters, without control characters"))
}

/// A number that is positive.
///
/// # Errors
/// What it must be.
pub fn positive(text: &str) -> Result<f64, String> {
    Range::POSITIVE.number(text)
}

/// A share that is neither nothing nor all.
///
/// # Errors
/// What it must be.
pub fn share(text: &str) -> Result<f64, String> {
    Range::SHARE.number(text)
}

/// A number of threads in words.
pub(crate) const THREADS: &str = "from 1 to 1024; leave the option out for one per core";
