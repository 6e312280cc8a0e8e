//! The distribution of values.

use asperity::contact::bulk_range;

use crate::colours::percent;
use crate::scale::three_digits;

/// The distribution of values, in classes over their [`bulk_range`].
///
/// ```
/// use asperity_plot::Distribution;
/// let values = [0.0, 1.0, 3.0, 4.0, f64::NAN];
/// assert_eq!(Distribution::from_values(values.into_iter(), 2, None).curve, [(1.0, 50.0), (3.0, 50.0)]);
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Distribution {
    /// The middles of the classes, which are equally wide, and the share of the values in each, in per cent. Empty
    /// without values.
    pub curve: Vec<(f64, f64)>,
    /// What is beyond the classes, in words, as "less than 0.1 % above 30.0 nm, up to 200 nm"; mostly empty.
    pub beyond: String,
}

impl Distribution {
    /// The distribution of the values that are finite, in so many classes; the values have a `unit`.
    pub fn from_values(values: impl Iterator<Item = f64> + Clone, classes: usize, unit: Option<&str>) -> Self {
        let values = values.filter(|value| value.is_finite());
        let Some((low, high)) = bulk_range(values.clone()) else { return Self::default() };
        let mut counts = vec![0_usize; classes.max(1)];
        let last = counts.len() - 1;
        let width = (high - low) / counts.len() as f64;
        let (mut below, mut above, mut least, mut greatest) = (0, 0, low, high);
        for value in values {
            if value < low {
                (below, least) = (below + 1, value.min(least));
            } else if value > high {
                (above, greatest) = (above + 1, value.max(greatest));
            } else {
                counts[if width > 0.0 { (((value - low) / width) as usize).min(last) } else { 0 }] += 1;
            }
        }
        let sum = (counts.iter().sum::<usize>() + below + above) as f64;
        let point = |(k, count)| (low + (k as f64 + 0.5) * width, 100.0 * count as f64 / sum);
        let told = |count: usize, side, end, way, extreme| {
            let [end, extreme] = [end, extreme].map(|value| three_digits(value, unit));
            (count > 0).then(|| format!("{} {side} {end}, {way} to {extreme}", percent(count as f64 / sum)))
        };
        let beyond = [told(below, "below", low, "down", least), told(above, "above", high, "up", greatest)];
        Self {
            curve: counts.into_iter().enumerate().map(point).collect(),
            beyond: beyond.into_iter().flatten().collect::<Vec<_>>().join("; "),
        }
    }
}
