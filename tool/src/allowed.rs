//! The values that options allow, for their parsers.

fn number(text: &str, allowed: fn(f64) -> bool, requirement: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(value) if allowed(value) => Ok(value),
        _ => Err(format!("it must be {requirement}")),
    }
}

pub fn positive(text: &str) -> Result<f64, String> {
    number(text, |v| v > 0.0 && v.is_finite(), "a number, positive and finite")
}

pub fn finite(text: &str) -> Result<f64, String> {
    number(text, f64::is_finite, "a number, and finite")
}

/// A share that is neither nothing nor all.
pub fn share(text: &str) -> Result<f64, String> {
    number(text, |v| v > 0.0 && v < 1.0, "a share between 0 and 1")
}

/// A number of threads; more than 1024 are taken for a slip of the pen.
pub fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(threads @ 1..=1024) => Ok(threads),
        _ => Err("it must be from 1 to 1024; leave the option out for one per core".to_owned()),
    }
}

/// A number of nodes along a side; more than 2²⁴ are taken for a slip of the pen.
pub fn nodes(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(nodes @ 1..=16_777_216) => Ok(nodes),
        _ => Err("it must be a whole number from 1 to 16777216".to_owned()),
    }
}

/// A number of bins; more than a million are taken for a slip of the pen.
pub fn bins(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(bins @ 1..=1_000_000) => Ok(bins),
        _ => Err("it must be a whole number from 1 to 1000000".to_owned()),
    }
}

/// A resolution in pixels per inch.
pub fn resolution(text: &str) -> Result<f64, String> {
    number(text, |v| (36.0..=1200.0).contains(&v), "a number of pixels per inch, from 36 to 1200")
}
