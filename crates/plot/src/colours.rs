//! Colours: from the values of a field to pixels.

use colorous::{RED_BLUE, TABLEAU10, VIRIDIS};
use ndarray::ArrayView2;

use crate::load::LoadScale;
use crate::scale::{TINY, drawable, three_digits};
use crate::shape::{BLACK, Colour, GREY, WHITE};

/// The colour of values that are not finite, which is on none of the colour maps.
pub(super) const MISSING: Colour = [201, 120, 199];

/// The colour of attraction without contact.
pub(super) const ATTRACTIVE: Colour = [107, 174, 214];

/// The colour of nodes that have yielded.
pub(super) const YIELDED: Colour = [213, 94, 0];

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
    /// Each sign has a scale and a colour bar of its own, so that a tension of 50 MPa is seen next to a compression of
    /// 5 GPa; [`Map::signs`](crate::Map::signs) has the names of the two. Only a
    /// sign that nowhere reaches 1e-6 of the other, mere rounding, is drawn as zero.
    ///
    /// A scale ends at the greatest magnitude, unless some nodes press far harder than the nodes that carry most of the
    /// load ([`LoadScale`]). The colour bar then has an arrow and the extreme value at this end, and the caption the
    /// share of the load that is carried beyond it.
    Diverging,
    /// Classes of contact: black where the value is positive (contact), orange where it exceeds 1 (yielded), blue where
    /// it is negative (attractive), and white where it is zero (apart), with a legend;
    /// [`Solution::regions`](asperity::Solution::regions) has them.
    ///
    /// On a map drawn with fewer pixels than nodes, the colours are mixed by the share of each.
    Contact,
    /// Clusters of contact, by the labels of [`Clusters`](asperity::contact::Clusters): nine colours in turn, the
    /// largest clusters first, white where the label is 0, and grey where it is not finite. Pixels are mixed as for
    /// contact.
    Clusters,
}

impl Colouring {
    /// Whether the values are classes, without a scale.
    pub(super) fn is_of_classes(self) -> bool {
        matches!(self, Self::Contact | Self::Clusters)
    }

    /// The colours of a scale in 256 steps, from the least value to the greatest; of contact the colours of nodes
    /// apart, in contact, attractive and yielded; of clusters the labels from 0 to 9.
    ///
    /// ```
    /// use asperity_plot::Colouring;
    /// assert_eq!(Colouring::Sequential.steps().len(), 256);
    /// assert_eq!(Colouring::Contact.steps()[..2], [[255; 3], [0; 3]]);
    /// ```
    pub fn steps(self) -> Vec<[u8; 3]> {
        let (gradient, at): (_, fn(f64) -> f64) = match self {
            Self::Sequential => (VIRIDIS, |share| share),
            Self::Diverging => (RED_BLUE, |share| 1.0 - share),
            Self::Contact => return vec![WHITE, BLACK, ATTRACTIVE, YIELDED],
            Self::Clusters => return (0..10).map(cluster_colour).collect(),
        };
        let colours = (0..=u8::MAX).map(|step| gradient.eval_continuous(at(f64::from(step) / f64::from(u8::MAX))));
        colours.map(|colour| [colour.r, colour.g, colour.b]).collect()
    }

    /// The colour of values that are not finite.
    pub const MISSING: [u8; 3] = MISSING;
}

/// The colour of the cluster of a label, counted from 1; white for 0, which is none. The same nine colours in turn.
pub(super) fn cluster_colour(label: usize) -> [u8; 3] {
    // the last of the ten is grey
    let colours = &TABLEAU10[..9];
    label.checked_sub(1).map_or(WHITE, |cluster| {
        let colour = colours[cluster % colours.len()];
        [colour.r, colour.g, colour.b]
    })
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
    /// The shares of the sum of the negative values, and of the positive ones, that are beyond these ends.
    shares: (f64, f64),
    /// The colour of values that are not finite.
    pub(super) missing: Colour,
    /// The colour between two signs.
    zero: Colour,
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
        let mut shares = (0.0, 0.0);
        let limits = match (colouring, limits) {
            (Colouring::Sequential, Some(limits)) => limits,
            (Colouring::Sequential, None) => widened(low, high),
            (Colouring::Diverging, limits) => {
                let noise = NOISE * high.max(-low);
                // each end has its own sign
                let scale = |sign, largest, end: Option<f64>| match largest > noise.max(TINY) {
                    true => LoadScale::of_sign(&values, sign, end),
                    false => LoadScale { end: end.unwrap_or(0.0), ..LoadScale::default() },
                };
                let tension = scale(-1.0, -low, limits.map(|(low, _)| (-low).max(0.0)));
                let compression = scale(1.0, high, limits.map(|(_, high)| high.max(0.0)));
                shares = (tension.beyond, compression.beyond);
                match (-tension.end, compression.end) {
                    (0.0, 0.0) if !given => (0.0, 1.0),
                    limits => limits,
                }
            }
            (Colouring::Contact | Colouring::Clusters, _) => (0.0, 1.0),
        };
        let middle = RED_BLUE.eval_continuous(0.5);
        let zero = [middle.r, middle.g, middle.b];
        Self { colouring, extremes: (low, high), limits, given, shares, missing: MISSING, zero }
    }

    /// A value, or NaN if it cannot be drawn.
    pub(super) fn shown(&self, value: f64) -> f64 {
        if drawable(value) { value } else { f64::NAN }
    }

    pub(super) fn colour(&self, value: f64) -> Colour {
        let (low, high) = self.limits;
        let colour = match self.colouring {
            Colouring::Clusters if value.is_nan() => return GREY,
            _ if value.is_nan() => return self.missing,
            Colouring::Clusters => return cluster_colour(value as usize),
            Colouring::Contact => {
                return match value {
                    0.0 => WHITE,
                    _ if value < 0.0 => ATTRACTIVE,
                    _ if value > 1.0 => YIELDED,
                    _ => BLACK,
                };
            }
            Colouring::Sequential => VIRIDIS.eval_continuous((value - low) / (high - low)),
            // most of many maps
            Colouring::Diverging if value == 0.0 => return self.zero,
            // A sign without a scale is noise.
            Colouring::Diverging => {
                let end = if value < 0.0 { -low } else { high };
                RED_BLUE.eval_continuous(if end > 0.0 { 0.5 - 0.5 * value / end } else { 0.5 })
            }
        };
        [colour.r, colour.g, colour.b]
    }

    /// The colour of a block of nodes, by the mean of their values, or for classes the mean of their colours.
    pub(super) fn of_block(&self, values: impl Iterator<Item = f64> + Clone) -> Colour {
        let count = values.clone().count() as f64;
        if !self.colouring.is_of_classes() {
            return self.colour(values.map(|value| self.shown(value)).sum::<f64>() / count);
        }
        let mut sums = [0.0; 3];
        for colour in values.map(|value| self.colour(self.shown(value))) {
            sums.iter_mut().zip(colour).for_each(|(sum, part)| *sum += f64::from(part));
        }
        sums.map(|sum| rounded(sum / count))
    }

    /// Whether values are below the lower end of the colour bar, and above the upper end.
    pub(super) fn beyond(&self) -> (bool, bool) {
        let ((min, max), (low, high)) = (self.extremes, self.limits);
        ((self.given || low != 0.0) && min < low, (self.given || high != 0.0) && max > high)
    }

    /// The shares of the load that are carried beyond the ends of the colour bar, with the names of the two signs.
    pub(super) fn load_beyond(&self, signs: [&str; 2], unit: Option<&str>) -> Option<String> {
        let ((below, above), both) = (self.beyond(), self.ranges().len() == 2);
        let ends = [(below, self.shares.0, "below", self.limits.0), (above, self.shares.1, "above", self.limits.1)];
        let told =
            ends.into_iter().zip(signs).filter(|((there, share, _, end), _)| *there && *share > 0.0 && *end != 0.0);
        let told = told.map(|((_, share, side, end), sign)| {
            let of = if both && side == "below" && !sign.is_empty() { sign } else { "load" };
            format!("{} of the {of} is carried {side} {}", percent(share), three_digits(end, unit))
        });
        Some(told.collect::<Vec<_>>().join(", ")).filter(|text| !text.is_empty())
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

/// The nearest whole number to a part of a colour, a half rounded up: `f64::round` is a call of a function.
pub(super) fn rounded(part: f64) -> u8 {
    let whole = part as u8;
    whole + u8::from(part - f64::from(whole) >= 0.5)
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

/// A share in per cent, to two digits or a tenth.
pub(super) fn percent(share: f64) -> String {
    match 100.0 * share {
        share if share < 0.1 => "less than 0.1 %".to_owned(),
        share if share < 10.0 => format!("{share:.1} %"),
        share => format!("{share:.0} %"),
    }
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
        let zero = colours.colour(0.0);
        assert!(zero.iter().all(|c| *c > 230));
        let (attraction, compression) = (colours.colour(-2.5e7), colours.colour(2e9));
        assert!(attraction[2] > attraction[0] + 80 && compression[0] > compression[2] + 60);
    }

    #[test]
    fn a_scale_ends_by_the_load_and_says_what_is_carried_beyond() {
        let mut values = Array2::from_elem((100, 100), 1.0);
        values[[3, 4]] = 50.0;
        let diverging = |values: &Array2<f64>, limits| Colours::new(values.view(), Colouring::Diverging, limits);
        let colours = diverging(&values, None);
        assert_eq!((colours.limits, colours.beyond()), ((0.0, 1.0), (false, true)));
        assert_eq!(colours.load_beyond([""; 2], Some("Pa")).unwrap(), "0.5 % of the load is carried above 1.00 Pa");
        // scars that carry less than half of the load, on nodes that are hardly any, do not hide the rest
        values.row_mut(50).fill(90.0);
        let colours = diverging(&values, None);
        assert_eq!((colours.limits, colours.beyond()), ((0.0, 1.0), (false, true)));
        let share = (9000.0 + 50.0) / (9899.0 + 9050.0);
        assert!((colours.shares.1 - share).abs() < 1e-12, "{}", colours.shares.1);
        // of 10 000 nodes, 5 are in contact: these, and not the noise, are the scale
        let mut values = Array2::from_elem((100, 100), -1e-9);
        values.iter_mut().step_by(2).for_each(|v| *v = 1e-9);
        values.iter_mut().take(5).for_each(|v| *v = 3.0);
        let colours = diverging(&values, None);
        assert_eq!((colours.limits, colours.beyond()), ((0.0, 3.0), (false, false)));
        assert_eq!((colours.colour(-1e-9), colours.load_beyond([""; 2], None)), (colours.colour(0.0), None));
        // at limits that are given it is said, too, of each sign
        let values = ndarray::array![[-2.0, -6.0, 3.0, 1.0]];
        let found = diverging(&values, Some((-4.0, 2.0))).load_beyond(["tension", "compression"], None);
        assert_eq!(
            found.unwrap(),
            "75 % of the tension is carried below −4.00, 75 % of the load is carried above 2.00"
        );
    }

    #[test]
    fn smooth_contacts_are_shown_to_their_greatest_pressure() {
        // Hertz: p = √(1 − r²); and the pressures of a rough contact, with the density p exp(−p²/2)
        let hertz = Array2::from_shape_fn((200, 200), |(i, j)| {
            f64::max(1.0 - 1.5e-4 * ((i as f64 - 99.5).powi(2) + (j as f64 - 99.5).powi(2)), 0.0).sqrt()
        });
        let rough = Array2::from_shape_fn((200, 200), |(i, j)| {
            (-2.0 * ((200 * i + j) as f64 / 40_000.0 + 0.5 / 40_000.0).ln()).sqrt()
        });
        for values in [hertz, rough] {
            let colours = Colours::new(values.view(), Colouring::Diverging, None);
            assert_eq!((colours.limits.1, colours.beyond()), (values.fold(0.0_f64, |a, b| a.max(*b)), (false, false)));
        }
    }
}
