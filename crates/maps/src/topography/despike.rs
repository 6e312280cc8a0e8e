//! Spikes of a height map: outliers from the median of their neighbourhood.

use super::{Topography, median};
use asperity::{Error, Result};

/// The nodes of a neighbourhood on either side of its middle: 5 × 5 nodes; spikes may have up to twelve of these.
const REACH: isize = 2;
/// The least pairs of opposite neighbours, as there are along an edge.
const PAIRS: usize = 2;
/// The standard deviation of Gaussian noise in medians of its magnitude, 1/Φ⁻¹(¾).
pub(super) const PER_MEDIAN: f64 = 1.482_602_218_505_602;
/// The same in means of its magnitude, √(π/2).
const PER_MEAN: f64 = 1.253_314_137_315_500_3;

/// The spikes of a map: the nodes farther than a limit from the median of their neighbourhood.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Spikes {
    /// Their nodes in row-major order, each with the median of its neighbourhood.
    pub nodes: Vec<((usize, usize), f64)>,
    /// The distance from the median beyond which a node is a spike: the threshold times the deviation of all nodes.
    pub limit: f64,
    /// The node that is farthest out, and its height above the median; none if there are no spikes.
    pub worst: Option<((usize, usize), f64)>,
}

impl Topography {
    /// The spikes of the map, by a median filter and a robust threshold (Hampel's identifier).
    ///
    /// A node is a spike if its height is farther than `threshold` standard deviations from the median of the 5 × 5
    /// nodes around it. The standard deviation belongs to such distances over the whole map, by their median magnitude,
    /// σ = 1.4826 median |h − ĥ|, which no spike carries; by their mean magnitude, if more than half of all distances
    /// are 0. Gaussian noise does not reach 6 on any map, while edges and grains of a real surface may: a threshold of
    /// 10 takes little of these.
    ///
    /// Neighbours count in pairs on opposite sides, so that a slope at the edge of the map is no spike. Where there are
    /// less than two pairs, as in a corner or next to a hole, all neighbours count, and a spike is also farther from
    /// their median than their highest is from their lowest.
    ///
    /// # Errors
    /// [`Error::Value`] if the threshold is not positive and finite.
    pub fn spikes(&self, threshold: f64) -> Result<Spikes> {
        Error::positive("threshold of spikes", threshold)?;
        let around = self.neighbourhoods();
        let distances =
            || self.heights.iter().zip(&around).map(|(h, (median, _))| h - median).filter(|d| d.is_finite());
        let typical = median(distances().map(f64::abs)).unwrap_or(0.0);
        let deviation = if typical > 0.0 {
            PER_MEDIAN * typical
        } else {
            PER_MEAN * distances().map(f64::abs).sum::<f64>() / distances().count().max(1) as f64
        };
        let mut spikes = Spikes { nodes: Vec::new(), limit: threshold * deviation, worst: None };
        for ((node, h), (median, range)) in self.heights.indexed_iter().zip(around) {
            let distance = h - median;
            if distance.is_finite() && distance.abs() > spikes.limit.max(range) {
                spikes.nodes.push((node, median));
                if spikes.worst.is_none_or(|(_, worst)| distance.abs() > worst.abs()) {
                    spikes.worst = Some((node, distance));
                }
            }
        }
        Ok(spikes)
    }

    /// Gives [`spikes`](Self::spikes) the median of their neighbourhood, as Hampel's filter does; all other heights
    /// stay as they are.
    ///
    /// Offsets between scan lines look like spikes: [`align_rows`](Self::align_rows) first. Spikes of more than twelve
    /// nodes are not seen.
    ///
    /// ```
    /// use asperity_maps::Topography;
    /// let mut map = Topography::new(ndarray::Array2::from_shape_fn((9, 9), |(i, j)| ((7 * i + 5 * j) as f64).sin()));
    /// map.heights[[4, 4]] = 1e3;
    /// assert_eq!(map.spikes(10.0)?.worst.map(|(node, _)| node), Some((4, 4)));
    /// assert!(map.despike(10.0)?.heights.iter().all(|h| h.abs() <= 1.0));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`spikes`](Self::spikes).
    pub fn despike(mut self, threshold: f64) -> Result<Self> {
        for (node, median) in self.spikes(threshold)?.nodes {
            self.heights[node] = median;
        }
        Ok(self)
    }

    /// For each node in row-major order the median around it, NaN if nothing is, and what a spike has to exceed besides
    /// the limit: the range of the neighbours, if neighbours are not in pairs.
    fn neighbourhoods(&self) -> Vec<(f64, f64)> {
        let (mut found, mut values) = (Vec::with_capacity(self.heights.len()), Vec::new());
        for ((i, j), h) in self.heights.indexed_iter() {
            let at = |(di, dj): (isize, isize)| {
                let node = [i.checked_add_signed(di)?, j.checked_add_signed(dj)?];
                self.heights.get(node).copied().filter(|h| h.is_finite())
            };
            let ahead =
                || (-REACH..=REACH).flat_map(|di| (-REACH..=REACH).map(move |dj| (di, dj))).filter(|d| *d > (0, 0));
            values.clear();
            for (di, dj) in ahead() {
                values.extend(at((di, dj)).zip(at((-di, -dj))).map(|(a, b)| [a, b]).into_iter().flatten());
            }
            if values.len() >= 2 * PAIRS {
                values.push(*h);
                found.push((median(values.iter().copied()).unwrap_or(f64::NAN), 0.0));
            } else {
                let all = || ahead().flat_map(|(di, dj)| [at((di, dj)), at((-di, -dj))]).flatten();
                let range = all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min);
                found.push((median(all()).unwrap_or(f64::NAN), range));
            }
        }
        found
    }
}
