//! The histogram of a field.

use serde::Serialize;

/// The probability density of values in bins of equal width; empty of no values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Histogram {
    /// The lower end of the first bin.
    pub from: f64,
    /// The upper end of the last one.
    pub to: f64,
    /// The density in each: its share of the values over its width.
    pub density: Vec<f64>,
}

impl Histogram {
    /// The histogram of the values that are finite.
    pub fn of(values: impl Iterator<Item = f64> + Clone, bins: usize) -> Self {
        let (Some(from), Some(to)) = extremes(values.clone()) else {
            return Self { from: 0.0, to: 0.0, density: Vec::new() };
        };
        let mut counts = vec![0_usize; bins.clamp(1, 1000)];
        let (last, mut count) = (counts.len() - 1, 0);
        let rate = if to > from { counts.len() as f64 / (to - from) } else { 0.0 };
        for value in values.filter(|value| value.is_finite()) {
            counts[(((value - from) * rate) as usize).min(last)] += 1;
            count += 1;
        }
        let density = counts.into_iter().map(|bin| bin as f64 * rate / f64::from(count)).collect();
        Self { from, to, density }
    }
}

/// The least and the greatest of the values that are finite; nothing of none.
pub fn extremes(values: impl Iterator<Item = f64>) -> (Option<f64>, Option<f64>) {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    (Some(low).filter(|low| low.is_finite()), Some(high).filter(|high| high.is_finite()))
}
