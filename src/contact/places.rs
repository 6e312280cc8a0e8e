//! The places of a contact edge between the nodes.

/// The bins of a spacing, and how many of them are one bin of a coarser count.
const BINS: usize = 64;
const COARSER: usize = 4;

/// The histogram of the edge's place between neighbours.
#[derive(Clone, Debug)]
pub(super) struct Places {
    counts: [u64; BINS],
}

impl Places {
    pub fn new() -> Self {
        Self { counts: [0; BINS] }
    }

    /// Counts one between two neighbours, in spacings from the one in contact.
    pub fn add(&mut self, place: f64) {
        self.counts[((place * BINS as f64) as usize).min(BINS - 1)] += 1;
    }

    pub fn edges(&self) -> usize {
        self.counts.iter().sum::<u64>() as usize
    }

    /// The number of independent places, by how often two coincide: 1 if all are at the same place. Chance
    /// coincidences grow with the width of the bins, and equal places do not: bins of two widths tell them apart.
    pub fn independent(&self) -> f64 {
        let edges = self.edges() as f64;
        let square = |count: u64| (count as f64 / edges).powi(2);
        let fine: f64 = self.counts.iter().map(|&count| square(count)).sum();
        let coarse: f64 = self.counts.chunks(COARSER).map(|counts| square(counts.iter().sum())).sum();
        let same = (COARSER as f64 * fine - coarse) / (COARSER - 1) as f64;
        if edges > 0.0 { same.max(edges.recip()).recip() } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn independent(places: impl Iterator<Item = f64>) -> f64 {
        let mut counted = Places::new();
        places.for_each(|place| counted.add(place));
        counted.independent()
    }

    #[test]
    fn places_that_coincide_are_one() {
        assert_eq!(independent(std::iter::empty()), 0.0);
        assert_eq!(independent((0..500).map(|_| 0.3)), 1.0);
        assert_eq!(independent((0..500).map(|_| 1.0)), 1.0);
        // some, each many times
        for count in [2, 5, 10] {
            let found = independent((0..1000).map(|k| (f64::from(k % count) + 0.5) / f64::from(count)));
            assert!((found / f64::from(count) - 1.0).abs() < 1e-12, "{count}: {found}");
        }
    }

    #[test]
    fn places_that_fall_by_chance_are_as_many() {
        // the fractional parts of squares spread evenly, and of their roots unevenly
        for power in [1.0, 0.5] {
            for count in [30, 300, 3000] {
                let chance = (1..=count).map(|k| (f64::from(k).powi(2) * std::f64::consts::SQRT_2).fract().powf(power));
                let found = independent(chance) / f64::from(count);
                assert!((0.5..=1.0).contains(&found), "{power} {count}: {found}");
            }
        }
    }
}
