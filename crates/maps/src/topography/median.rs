//! The median of measured numbers.

/// The median of the values that are finite: of an even number, the mean of the two in the middle; none if there are
/// no such values.
pub(super) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    Ranks::default().median(values)
}

/// A room for medians, one after the other.
#[derive(Default)]
pub(super) struct Ranks(Vec<i64>);

impl Ranks {
    /// The median, as [`median`] finds it.
    pub(super) fn median(&mut self, values: impl Iterator<Item = f64>) -> Option<f64> {
        let Self(ranks) = self;
        ranks.clear();
        ranks.extend(values.map(rank));
        // most have no other ones
        if !ranks.iter().fold(true, |all, rank| all & is_finite(*rank)) {
            ranks.retain(|rank| is_finite(*rank));
        }
        if ranks.is_empty() {
            return None;
        }
        let (middle, even) = (ranks.len() / 2, ranks.len().is_multiple_of(2));
        let (below, upper, _) = ranks.select_nth_unstable(middle);
        let upper = *upper;
        let lower = below.iter().copied().filter(|_| even).max().unwrap_or(upper);
        let [lower, upper] = [lower, upper].map(of_rank);
        Some(lower + 0.5 * (upper - lower))
    }
}

/// A whole number that orders numbers as [`f64::total_cmp`] does.
fn rank(value: f64) -> i64 {
    let bits = value.to_bits().cast_signed();
    bits ^ ((bits >> 63) & i64::MAX)
}

/// Whether a rank is of a finite number: between the ranks of the infinite numbers, beyond which NaN is.
fn is_finite(place: i64) -> bool {
    (rank(f64::NEG_INFINITY) < place) & (place < rank(f64::INFINITY))
}

/// The number of a rank.
fn of_rank(rank: i64) -> f64 {
    f64::from_bits((rank ^ ((rank >> 63) & i64::MAX)).cast_unsigned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_in_the_middle_of_the_sorted_numbers() {
        for count in 0..70_u64 {
            let number = |k: u64| ((k * 0x9E37_79B9) % 97) as f64 - 48.0;
            let mut sorted: Vec<_> = (0..count).map(number).collect();
            sorted.sort_unstable_by(f64::total_cmp);
            let of = |place: u64| sorted[place as usize];
            let expected = (count > 0).then(|| 0.5 * of((count - 1) / 2) + 0.5 * of(count / 2));
            let missing = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
            assert_eq!(median((0..count).map(number).chain(missing)), expected, "{count}");
        }
    }

    #[test]
    fn ranks_are_in_the_order_of_their_numbers() {
        let numbers = [f64::MIN, -1.0, -f64::MIN_POSITIVE, -0.0, 0.0, 5e-324, 1.0, f64::MAX];
        let ranks = numbers.map(rank);
        assert!(ranks.is_sorted());
        assert_eq!(ranks.map(of_rank).map(f64::to_bits), numbers.map(f64::to_bits));
    }
}
