//! The lowest and the highest of heights, and codes for missing points among them.

use ndarray::Array2;

/// The distance of a repeated value from the rest of the heights, in heights of the rest from the lowest to the
/// highest: codes for missing points are chosen to be far away, levels of a real surface are not.
const FAR: f64 = 3.0;

/// Codes for missing points that are recognised where they stand once, too, as numbers of 4 bytes have them.
const CODES: [f32; 22] = [
    0.0,
    -1.0,
    -9.0,
    -99.0,
    99.0,
    255.0,
    999.0,
    -9999.0,
    -99999.0,
    -999.0,
    9999.0,
    99999.0,
    -32768.0,
    32767.0,
    65535.0,
    -2147483648.0,
    1000001.0,
    1e30,
    -1e30,
    1.70141e38,
    1.701_411_8e38,
    f32::MAX,
];

/// The distance of a single value from the rest, in interquartile ranges of all heights, from which it is a code whatever
/// it is.
const BEYOND: f64 = 1e4;

/// The lowest and the highest of some heights; ∞ and −∞ of none.
pub fn range(heights: impl Iterator<Item = f64>) -> (f64, f64) {
    heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high): (f64, f64), h| {
        (if h < low { h } else { low }, if h > high { h } else { high })
    })
}

/// The lowest and the highest of the heights that are not missing, their counts, and the range of all others.
#[derive(Clone, Copy)]
pub struct Extremes {
    pub low: f64,
    pub high: f64,
    /// At how many nodes the lowest and the highest stand.
    counts: [usize; 2],
    /// The lowest and the highest of the other heights; ∞ and −∞ if there are none.
    pub rest: (f64, f64),
    /// The interquartile range of all, where a single one is far from the rest.
    middle: f64,
}

impl Extremes {
    pub fn find(heights: &Array2<f64>) -> Self {
        let finite = || heights.iter().copied().filter(|h| h.is_finite());
        let (low, high) = range(finite());
        let mut counts = [0, 0];
        let rest = range(finite().filter(|&h| {
            let [is_low, is_high] = [h == low, h == high];
            counts = [counts[0] + usize::from(is_low), counts[1] + usize::from(is_high)];
            !is_low && !is_high
        }));
        let mut extremes = Self { low, high, counts, rest, middle: 0.0 };
        if [(low, counts[0]), (high, counts[1])].iter().any(|(value, count)| *count == 1 && extremes.is_far(*value)) {
            let mut sorted: Vec<f64> = finite().collect();
            let mut at = |quarter: usize| {
                let place = quarter * (sorted.len() - 1) / 4;
                *sorted.select_nth_unstable_by(place, f64::total_cmp).1
            };
            extremes.middle = at(3) - at(1);
        }
        extremes
    }

    /// How far a value is outside the rest, if there is a range of it.
    fn distance(&self, value: f64) -> Option<f64> {
        let (low, high) = self.rest;
        // of two or three levels none is a code
        (high > low).then(|| (low - value).max(value - high))
    }

    fn is_far(&self, value: f64) -> bool {
        self.distance(value).is_some_and(|distance| distance > FAR * (self.rest.1 - self.rest.0))
    }

    /// The highest less the lowest height; infinite if the difference is beyond `f64`.
    pub fn span(&self) -> f64 {
        self.high - self.low
    }

    /// The extreme values that stand for missing points, and at how many nodes: far outside the rest, and repeated,
    /// well known, or beyond all measure.
    pub fn codes(&self) -> Vec<(f64, usize)> {
        let is_known = |value: f64| CODES.contains(&(value as f32));
        let is_beyond = |value: f64| {
            self.middle > 0.0 && self.distance(value).is_some_and(|distance| distance > BEYOND * self.middle)
        };
        let is_code =
            |&(value, count): &(f64, usize)| self.is_far(value) && (count > 1 || is_known(value) || is_beyond(value));
        [self.low, self.high].into_iter().zip(self.counts).filter(is_code).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_are_those_of_the_sorted_heights() {
        // few levels, so that the extremes are repeated
        let level = |i: usize| ((i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) % 97;
        let bowl = |i: usize| if (3000..3500).contains(&i) { -1.0 } else { level(i) as f64 };
        let infinite =
            |i: usize| [bowl(i), f64::NAN, f64::INFINITY, f64::NEG_INFINITY][(level(i) as usize / 24).min(3)];
        let flat = |_| 2.0;
        let maps: [&dyn Fn(usize) -> f64; 4] = [&|i| level(i) as f64, &bowl, &infinite, &flat];
        for of in maps {
            for shape in [(1, 1), (3, 5), (40, 50), (150, 133)] {
                let heights = Array2::from_shape_fn(shape, |(i, j)| of(i * shape.1 + j));
                let mut sorted: Vec<f64> = heights.iter().copied().filter(|h| h.is_finite()).collect();
                sorted.sort_by(f64::total_cmp);
                let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else { continue };
                let count = |value: f64| sorted.iter().filter(|&&h| h == value).count();
                let rest: Vec<f64> = sorted.iter().copied().filter(|&h| h != low && h != high).collect();
                let found = Extremes::find(&heights);
                assert_eq!((found.low, found.high, found.counts), (low, high, [low, high].map(count)));
                let expected = rest.first().map_or(range([].into_iter()), |&first| (first, rest[rest.len() - 1]));
                assert_eq!(found.rest, expected, "{shape:?}");
            }
        }
    }
}
