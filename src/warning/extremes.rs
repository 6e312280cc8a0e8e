//! The lowest and the highest of heights, and codes for missing points among them.

use ndarray::Array2;

use crate::field::flat;
use crate::par;
use crate::vector::{LANES, NOTHING, range, vectorised};

/// The distance of a repeated value from the rest of the heights, in heights of the rest from the lowest to the
/// highest: codes for missing points are chosen to be far away, levels of a real surface are not.
const FAR: f64 = 3.0;

/// Codes for missing points that are recognised where they stand once, too.
const CODES: [f64; 9] = [-9999.0, -99999.0, -999.0, 9999.0, 99999.0, -32768.0, 32767.0, 65535.0, -2147483648.0];

/// Nodes that a thread takes at once.
const CHUNK: usize = 1 << 14;

/// Nodes that are looked at once for heights beyond all others.
const LOOK: usize = 1 << 10;

/// The lowest and the highest of the heights that are not missing, their counts, and the range of all others.
#[derive(Clone, Copy)]
pub struct Extremes {
    pub low: f64,
    pub high: f64,
    pub low_count: usize,
    pub high_count: usize,
    /// The lowest and the highest of the other heights; ∞ and −∞ if there are none.
    pub rest: (f64, f64),
}

/// The lowest of some values, how often it is there, and the lowest of the others.
#[derive(Clone, Copy)]
struct End {
    value: f64,
    count: usize,
    next: f64,
}

impl End {
    const NONE: Self = Self { value: f64::INFINITY, count: 0, next: f64::INFINITY };

    /// That of one more value, which is there so often.
    fn with(self, value: f64, count: usize) -> Self {
        if value < self.value {
            Self { value, count, next: self.value }
        } else if value == self.value {
            Self { count: self.count + count, ..self }
        } else if value < self.next {
            Self { next: value, ..self }
        } else {
            self
        }
    }

    /// That of the values of both.
    fn join(self, other: Self) -> Self {
        self.with(other.value, other.count).with(other.next, 0)
    }

    /// Those of some heights of this range and of the heights with their signs changed, the missing ones left out.
    fn of(heights: &[f64], (lowest, highest): (f64, f64)) -> [Self; 2] {
        let bounded = lowest.is_finite() && highest.is_finite();
        let (whole, rest) = if bounded { heights.as_chunks::<LANES>() } else { (&[][..], heights) };
        let mut ends = [(lowest, 1.0), (highest, -1.0)].map(|(end, sign)| {
            let (mut count, mut next) = ([0.0; LANES], [f64::INFINITY; LANES]);
            let (counts, nexts) = (&mut count, &mut next);
            vectorised(
                #[inline(always)]
                move || {
                    let (mut count, mut next) = ([0.0; LANES], [f64::INFINITY; LANES]);
                    for heights in whole {
                        for l in 0..LANES {
                            let value = sign * heights[l];
                            count[l] += if heights[l] == end { 1.0 } else { 0.0 };
                            let value = if heights[l] == end { f64::INFINITY } else { value };
                            next[l] = if value < next[l] { value } else { next[l] };
                        }
                    }
                    (*counts, *nexts) = (count, next);
                },
            );
            let count = count.iter().sum::<f64>() as usize;
            Self {
                value: if bounded { sign * end } else { f64::INFINITY },
                count,
                next: next.into_iter().fold(f64::INFINITY, f64::min),
            }
        });
        for &h in rest.iter().filter(|h| h.is_finite()) {
            ends = [ends[0].with(h, 1), ends[1].with(-h, 1)];
        }
        ends
    }
}

impl Extremes {
    pub fn of(heights: &Array2<f64>) -> Self {
        let none = [End::NONE; 2];
        let mut ends = vec![none; heights.len().div_ceil(CHUNK)];
        par::update(par::chunks(flat(heights), CHUNK), &mut ends, |_, chunk, ends| {
            for heights in chunk.chunks(LOOK) {
                let ([low, high], (lowest, highest)) = (*ends, range(heights));
                // most heights are within those that were there before
                if lowest < low.next || -highest < high.next {
                    let [least, greatest] = End::of(heights, (lowest, highest));
                    *ends = [low.join(least), high.join(greatest)];
                }
            }
        });
        let [low, high] = ends.into_iter().fold(none, |[low, high], [a, b]| [low.join(a), high.join(b)]);
        // of two levels nothing is left
        let rest = if low.next < -high.value { (low.next, -high.next) } else { NOTHING };
        Self { low: low.value, high: -high.value, low_count: low.count, high_count: high.count, rest }
    }

    /// The highest less the lowest height; infinite if the difference is beyond `f64`.
    pub fn span(&self) -> f64 {
        self.high - self.low
    }

    /// The extreme values that stand for missing points, and at how many nodes.
    pub fn codes(&self) -> Vec<(f64, usize)> {
        let ends = [(self.low, self.low_count), (self.high, self.high_count)];
        ends.into_iter().filter(|&(value, count)| self.is_code(value, count)).collect()
    }

    /// Whether an extreme value stands for missing points: far outside the rest, and repeated or well known.
    fn is_code(&self, value: f64, count: usize) -> bool {
        let (low, high) = self.rest;
        let (span, distance) = (high - low, (low - value).max(value - high));
        // of two or three levels none is a code
        span > 0.0 && distance > FAR * span && (count > 1 || CODES.contains(&value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_are_those_of_the_sorted_heights() {
        // few levels, so that the extremes are repeated, and the range of a look is that of another one
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
                assert_eq!(
                    (found.low, found.low_count, found.high, found.high_count),
                    (low, count(low), high, count(high))
                );
                let expected = rest.first().map_or(NOTHING, |&first| (first, rest[rest.len() - 1]));
                assert_eq!(found.rest, expected, "{shape:?}");
            }
        }
    }
}
