//! The values that options allow, for their parsers.

use std::str::FromStr;

use asperity_maps::io::LONGEST_UNIT;
use clap::builder::{PossibleValuesParser, TypedValueParser};

/// A value by one of its names.
pub fn by_name<T>(names: &'static [&'static str]) -> impl TypedValueParser<Value = T>
where
    T: FromStr<Err = String> + Clone + Send + Sync + 'static,
{
    PossibleValuesParser::new(names.iter().copied()).try_map(|name| name.parse::<T>())
}

/// A unit, which will be printed, and may come into a file.
pub fn unit(text: &str) -> Result<String, String> {
    let fits = text.chars().count() <= LONGEST_UNIT && !text.contains(char::is_control);
    let text = Some(text.to_owned()).filter(|_| fits);
    text.ok_or_else(|| format!("it must be a text of at most {LONGEST_UNIT} characters, without control characters"))
}

fn number(text: &str, allowed: fn(f64) -> bool, requirement: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(value) if allowed(value) => Ok(value),
        _ => Err(format!("it must be {requirement}")),
    }
}

/// A number that is positive.
pub fn positive(text: &str) -> Result<f64, String> {
    number(text, |v| v > 0.0 && v.is_finite(), "a number, positive and finite")
}

/// A number that is finite.
pub fn finite(text: &str) -> Result<f64, String> {
    number(text, f64::is_finite, "a number, and finite")
}

/// Poisson's ratio.
pub fn poisson(text: &str) -> Result<f64, String> {
    number(text, |v| v > -1.0 && v <= 0.5, "a number greater than -1 and at most 0.5")
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

/// An angle between 0 and 90 degrees.
pub fn acute(text: &str) -> Result<f64, String> {
    number(text, |v| v > 0.0 && v < 90.0, "a number of degrees, positive and below 90")
}
