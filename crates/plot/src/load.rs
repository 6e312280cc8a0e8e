//! The scale of a pressure: its ends, and the load on nodes beyond them.

use crate::scale::drawable;

/// The end of the scale of a pressure, in lower quartiles of the load: a Hertz contact presses up to 1.6 times the
/// pressure below which a quarter of the load is carried, and a rough contact of Gaussian heights up to some 4 times.
const QUARTILES: f64 = 4.0;

/// The greatest pressure, in ends of the scale, up to which the scale continues to it.
const SLACK: f64 = 4.0 / 3.0;

/// The most values that enter the quartile: a million tell enough of the distribution.
const MOST: usize = 1_000_000;

/// The scale of the pressures of one sign, which are tensions where they are negative: where it ends, and the share of
/// the load that is carried beyond.
///
/// A quarter of the load stands on pressures below its lower quartile, whatever the number of nodes that carry little.
/// The scale ends at the greatest of the pressures up to four times this quartile, or at the greatest of all where that
/// is no more than a third above. So scan lines or nodes that press many times harder than the contact do not hide it,
/// as long as it carries a quarter of the load.
///
/// ```
/// use asperity_plot::LoadScale;
/// let mut pressures = vec![1.0; 900];
/// pressures.extend([13.0; 10]);
/// let scale = LoadScale::from_values(&pressures, None);
/// assert_eq!((scale.end, scale.greatest), (1.0, 13.0));
/// assert!((scale.beyond - 130.0 / 1030.0).abs() < 1e-12);
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadScale {
    /// The pressure at which the scale ends; zero where no pressure is positive.
    pub end: f64,
    /// The greatest pressure.
    pub greatest: f64,
    /// The share of the load on nodes with more than the pressure at the end.
    pub beyond: f64,
}

impl LoadScale {
    /// The scale of the positive and finite values, to a given `end`, or by the lower quartile of the load.
    pub fn from_values<'a>(values: impl IntoIterator<Item = &'a f64, IntoIter: Clone>, end: Option<f64>) -> Self {
        Self::of_sign(values, 1.0, end)
    }

    /// The scale of the values that are positive, or that are negative with a `sign` of −1, as magnitudes.
    pub(super) fn of_sign<'a>(
        values: impl IntoIterator<Item = &'a f64, IntoIter: Clone>,
        sign: f64,
        end: Option<f64>,
    ) -> Self {
        let magnitudes = values.into_iter().map(|value| sign * value).filter(|v| *v > 0.0 && drawable(*v));
        let greatest = magnitudes.clone().fold(0.0, f64::max);
        let end = end.unwrap_or_else(|| {
            // the odd step avoids always the same columns
            let step = (magnitudes.clone().count() / MOST) | 1;
            let most = QUARTILES * quartile(magnitudes.clone().step_by(step).collect());
            let end = magnitudes.clone().filter(|value| *value <= most).fold(0.0, f64::max);
            if greatest > SLACK * most { end } else { greatest }
        });
        // relative to the greatest, so that no sum overflows
        let load =
            |least: f64| magnitudes.clone().filter(|value| *value > least).map(|value| value / greatest).sum::<f64>();
        Self { end, greatest, beyond: if greatest > end { load(end) / load(0.0) } else { 0.0 } }
    }
}

/// The pressure below which a quarter of the sum is; zero of none.
fn quartile(mut pressures: Vec<f64>) -> f64 {
    pressures.sort_unstable_by(f64::total_cmp);
    let Some(greatest) = pressures.last().copied() else { return 0.0 };
    let quarter = 0.25 * pressures.iter().map(|pressure| pressure / greatest).sum::<f64>();
    let mut below = 0.0;
    let found = pressures.iter().find(|pressure| {
        below += **pressure / greatest;
        below >= quarter
    });
    found.copied().unwrap_or(greatest)
}
