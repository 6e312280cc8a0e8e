//! The lowest and the highest of heights, and codes for missing points among them.

use ndarray::Array2;

/// The distance of a repeated value from the rest of the heights, in heights of the rest from the lowest to the
/// highest: codes for missing points are chosen to be far away, levels of a real surface are not.
const FAR: f64 = 3.0;

/// Codes for missing points that are recognised where they stand once, too.
const CODES: [f64; 9] = [-9999.0, -99999.0, -999.0, 9999.0, 99999.0, -32768.0, 32767.0, 65535.0, -2147483648.0];

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
}

impl Extremes {
    pub fn of(heights: &Array2<f64>) -> Self {
        let finite = || heights.iter().copied().filter(|h| h.is_finite());
        let (low, high) = range(finite());
        let counts = finite().fold([0, 0], |[a, b], h| [a + usize::from(h == low), b + usize::from(h == high)]);
        Self { low, high, counts, rest: range(finite().filter(|h| *h != low && *h != high)) }
    }

    /// The highest less the lowest height; infinite if the difference is beyond `f64`.
    pub fn span(&self) -> f64 {
        self.high - self.low
    }

    /// The extreme values that stand for missing points, and at how many nodes: far outside the rest, and repeated or
    /// well known.
    pub fn codes(&self) -> Vec<(f64, usize)> {
        let (low, high) = self.rest;
        // of two or three levels none is a code
        let is_far = |value: f64| high > low && (low - value).max(value - high) > FAR * (high - low);
        let is_code = |&(value, count): &(f64, usize)| is_far(value) && (count > 1 || CODES.contains(&value));
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
                let found = Extremes::of(&heights);
                assert_eq!((found.low, found.high, found.counts), (low, high, [low, high].map(count)));
                let expected = rest.first().map_or(range([].into_iter()), |&first| (first, rest[rest.len() - 1]));
                assert_eq!(found.rest, expected, "{shape:?}");
            }
        }
    }
}
