//! Colours: from the values of a field to pixels.

use colorous::{RED_BLUE, VIRIDIS};
use ndarray::ArrayView2;

use super::scale::TINY;
use super::shape::{BLACK, Colour, WHITE};

/// The colour of values that are not finite, which is on none of the colour maps.
pub(super) const MISSING: Colour = [201, 120, 199];

/// The colour of attraction without contact.
pub(super) const ATTRACTIVE: Colour = [107, 174, 214];

/// Values of one sign that are all weaker than this share of the other sign's greatest are not shown.
const NOISE: f64 = 1e-6;

/// The colouring of the values of a [`Map`](crate::Map).
///
/// [`Map`](super::Map) has an example.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colouring {
    /// From dark blue at the least value to yellow at the greatest: heights, gaps.
    Sequential,
    /// Zero in light grey, positive values (compression) in red, negative ones (attraction) in blue.
    ///
    /// Each sign has a scale and a colour bar of its own, so that a tension of 50 MPa is seen beside a compression of
    /// 5 GPa; [`Map::signs`](crate::Map::signs) has the names of the two. Only a
    /// sign that nowhere reaches 1e-6 of the other, mere rounding, is drawn as zero.
    ///
    /// A scale ends at the greatest magnitude, unless a few nodes reach more than twice as far as all others
    /// (a singular peak). It then ends where the others do, and the colour bar has an arrow and the extreme
    /// value at this end.
    Diverging,
    /// Classes of contact: black where the value is positive (contact), blue where it is negative (attractive), and
    /// white where it is zero (apart), with a legend; [`Solution::regions`](asperity::Solution::regions) has them.
    ///
    /// On a map drawn with fewer pixels than nodes, the colours are mixed by the share of each.
    Contact,
}

/// The colours of a field: its colouring, and the range of values that the colours cover.
pub(super) struct Colours {
    colouring: Colouring,
    /// The extreme values; zero if there are none.
    pub(super) extremes: (f64, f64),
    /// The values at the ends of the colour bar.
    pub(super) limits: (f64, f64),
    /// Whether these were given.
    given: bool,
}

impl Colours {
    /// The colours of `values`, up to these `limits` where they are given.
    pub(super) fn new(values: ArrayView2<'_, f64>, colouring: Colouring, limits: Option<(f64, f64)>) -> Self {
        let of_all = values.iter().filter(|v| drawable(**v));
        let extremes = of_all.fold(None, |range: Option<(f64, f64)>, v| {
            Some(range.map_or((*v, *v), |(low, high)| (low.min(*v), high.max(*v))))
        });
        let (low, high) = extremes.unwrap_or((0.0, 0.0));
        let given = limits.is_some();
        let limits = match (colouring, limits) {
            (Colouring::Sequential, Some(limits)) => limits,
            // each end is that of its sign
            (Colouring::Diverging, Some((low, high))) => (low.min(0.0), high.max(0.0)),
            (Colouring::Sequential, None) => widened(low, high),
            (Colouring::Diverging, None) => {
                let noise = NOISE * high.max(-low);
                let end = |sign, largest| if largest > noise.max(TINY) { limit(values, sign, largest) } else { 0.0 };
                match (-end(-1.0, -low), end(1.0, high)) {
                    (0.0, 0.0) => (0.0, 1.0),
                    limits => limits,
                }
            }
            (Colouring::Contact, _) => (0.0, 1.0),
        };
        Self { colouring, extremes: (low, high), limits, given }
    }

    /// A value, or NaN if it cannot be drawn.
    pub(super) fn shown(&self, value: f64) -> f64 {
        if drawable(value) { value } else { f64::NAN }
    }

    pub(super) fn of(&self, value: f64) -> Colour {
        let (low, high) = self.limits;
        let colour = match self.colouring {
            _ if value.is_nan() => return MISSING,
            Colouring::Contact => {
                return match value {
                    0.0 => WHITE,
                    _ if value < 0.0 => ATTRACTIVE,
                    _ => BLACK,
                };
            }
            Colouring::Sequential => VIRIDIS.eval_continuous((value - low) / (high - low)),
            // A sign without a scale is noise.
            Colouring::Diverging => {
                let end = if value < 0.0 { -low } else { high };
                RED_BLUE.eval_continuous(if end > 0.0 { 0.5 - 0.5 * value / end } else { 0.5 })
            }
        };
        [colour.r, colour.g, colour.b]
    }

    /// The colour of a block of nodes: that of the mean of their values, or for classes the mean of their colours.
    pub(super) fn of_block(&self, values: impl Iterator<Item = f64> + Clone) -> Colour {
        let count = values.clone().count() as f64;
        if self.colouring != Colouring::Contact {
            return self.of(values.map(|value| self.shown(value)).sum::<f64>() / count);
        }
        let mut sums = [0.0; 3];
        for colour in values.map(|value| self.of(self.shown(value))) {
            sums.iter_mut().zip(colour).for_each(|(sum, part)| *sum += f64::from(part));
        }
        sums.map(|sum| (sum / count).round() as u8)
    }

    /// Whether values are below the lower end of the colour bar, and above the upper end.
    pub(super) fn beyond(&self) -> (bool, bool) {
        let ((min, max), (low, high)) = (self.extremes, self.limits);
        ((self.given || low != 0.0) && min < low, (self.given || high != 0.0) && max > high)
    }

    /// The ranges of values that share the colour bar equally.
    pub(super) fn ranges(&self) -> Vec<(f64, f64)> {
        match (self.colouring, self.limits) {
            (Colouring::Diverging, (low, high)) if low < 0.0 && high > 0.0 => vec![(low, 0.0), (0.0, high)],
            (_, limits) => vec![limits],
        }
    }

    /// The values on the axis of a curve.
    pub(super) fn range_of_curve(&self) -> (f64, f64) {
        if self.given {
            return self.limits;
        }
        let (low, high) = self.extremes;
        let signed = self.colouring == Colouring::Diverging;
        let (low, high) = if signed { widened(low.min(0.0), high.max(0.0)) } else { widened(low, high) };
        let space = 0.05 * (high - low);
        (low - space, high + space)
    }
}

/// Whether a value has a place on a scale: it is finite, and so are sums of it and its neighbours.
pub(super) fn drawable(value: f64) -> bool {
    value.abs() < 1.0 / TINY
}

/// A range that has some width.
fn widened(low: f64, high: f64) -> (f64, f64) {
    let largest = low.abs().max(high.abs());
    if largest < TINY {
        (-1.0, 1.0)
    } else if high - low < 1e-12 * largest {
        (low - 0.5 * largest, high + 0.5 * largest)
    } else {
        (low, high)
    }
}

/// The end of the scale of the values of one sign, as a magnitude; their greatest magnitude is `largest`.
///
/// The few nodes that may be left out are those that make 1 % of the sum of the roots of the magnitudes. A
/// share of the number of nodes would leave out a small contact among many nodes with rounding noise, and a
/// share of the sum itself would not leave out a peak that carries much of the load.
fn limit(values: ArrayView2<'_, f64>, sign: f64, largest: f64) -> f64 {
    // A million nodes tell enough of the distribution; the odd step avoids always the same columns.
    let some = values.iter().step_by((values.len() / 1_000_000) | 1).map(|v| sign * v);
    let mut magnitudes: Vec<f64> = some.filter(|v| *v > 0.0 && drawable(*v)).collect();
    magnitudes.sort_unstable_by(|a, b| b.total_cmp(a));
    let (total, mut stronger) = (magnitudes.iter().map(|v| v.sqrt()).sum::<f64>(), 0.0);
    let end_of_others = magnitudes.into_iter().find(|v| {
        stronger += v.sqrt();
        stronger > 0.01 * total
    });
    end_of_others.filter(|end| largest > 2.0 * end).unwrap_or(largest)
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::*;

    #[test]
    fn each_sign_has_its_own_scale_and_zero_is_neutral() {
        let values = Array2::from_shape_fn((10, 10), |(i, _)| if i < 5 { -2.5e7 } else { 2e9 });
        let colours = Colours::new(values.view(), Colouring::Diverging, None);
        assert_eq!((colours.limits, colours.beyond()), ((-2.5e7, 2e9), (false, false)));
        let zero = colours.of(0.0);
        assert!(zero.iter().all(|c| *c > 230));
        let (attraction, compression) = (colours.of(-2.5e7), colours.of(2e9));
        assert!(attraction[2] > attraction[0] + 80 && compression[0] > compression[2] + 60);
    }

    #[test]
    fn a_singular_peak_is_cut_and_a_tail_of_noise_is_not() {
        let mut values = Array2::from_elem((100, 100), 1.0);
        values[[3, 4]] = 50.0;
        let colours = Colours::new(values.view(), Colouring::Diverging, None);
        assert_eq!((colours.limits, colours.beyond()), ((0.0, 1.0), (false, true)));
        // Of 10 000 nodes, 5 are in contact: these, and not the noise, are the scale.
        let mut values = Array2::from_elem((100, 100), -1e-9);
        values.iter_mut().step_by(2).for_each(|v| *v = 1e-9);
        values.iter_mut().take(5).for_each(|v| *v = 3.0);
        let colours = Colours::new(values.view(), Colouring::Diverging, None);
        assert_eq!((colours.limits, colours.beyond()), ((0.0, 3.0), (false, false)));
        assert_eq!(colours.of(-1e-9), colours.of(0.0));
    }
}
