//! The jumps of a curve: steps that stand out, and jumps of a fit.

use crate::curve::{Curve, Fit, Seen, Side, Sides};
use crate::squares::Prediction;
use crate::tip::Model;

/// A jump of less than so many deviations of the noise is followed as the equilibria have it.
const CLEAR: f64 = 5.0;
/// A step of more than so many deviations stands out.
const STEP: f64 = 8.0;

impl Curve {
    fn noise_or(&self, least: f64) -> f64 {
        self.noise.max(least)
    }

    /// Sides by the falls over z that stand out of noise and slope; none without any.
    pub(crate) fn steps(&self, least: f64) -> Option<Sides> {
        let mut sides = vec![Side::Free; self.z.len()];
        let mut found = false;
        for order in &self.order {
            let Some(count) = self.step(order, least) else { continue };
            found = true;
            order[..count].iter().for_each(|&i| sides[i] = Side::Apart);
            order[count..].iter().for_each(|&i| sides[i] = Side::Contact);
        }
        found.then(|| Sides { sides, seen: [Seen::default(); 2] })
    }

    /// The number of points before the greatest fall of a branch, if that stands out.
    fn step(&self, order: &[usize], least: f64) -> Option<usize> {
        let (z, force) = (|k: usize| self.z[order[k]], |k: usize| self.force[order[k]]);
        let falls = (4..order.len().saturating_sub(3)).map(|k| {
            // the slope of three intervals before and behind
            let rise = force(k - 1) - force(k - 4) + force(k + 3) - force(k);
            let run = z(k - 1) - z(k - 4) + z(k + 3) - z(k);
            let slope = if run > 0.0 { rise / run } else { 0.0 };
            (force(k - 1) - force(k) + slope * (z(k) - z(k - 1)), k)
        });
        let (fall, count) = falls.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (fall > STEP * self.noise_or(least)).then_some(count)
    }

    /// The sides of points by the jumps of a fit, where the points of both are most likely to meet.
    ///
    /// A jump that noise may hide has none: its points are where the equilibria have them.
    pub(crate) fn own_sides(&self, model: &Model, fit: &Fit, weigh: bool, least: f64, room: &mut Prediction) -> Sides {
        let noise = self.noise_or(least);
        self.predict(model, &fit.parameters, &fit.sides, room);
        if room.greatest_jump() < CLEAR * noise {
            return Sides::default();
        }
        let point = self.scales.point + self.scales.length * fit.parameters.point;
        // the baseline of the fit
        let rest: Vec<f64> = self.force.iter().zip(&room.load).map(|(force, load)| force - load).collect();
        let mut cleared = rest.clone();
        self.clear(&mut cleared);
        let two = usize::from(model.has_two_ways());
        let mut found = Sides { sides: vec![Side::Free; self.z.len()], seen: [Seen::default(); 2] };
        let mut any = false;
        for (branch, order) in self.order.iter().enumerate() {
            if order.len() < 2 {
                continue;
            }
            let load = |i: usize, side: Side| {
                let z = self.z[i] - point;
                let first = room.ways[0].end_position();
                let (way, place) = match side {
                    Side::Apart if branch == 1 && room.ways[1].end_position().is_some_and(|last| z <= last) => {
                        (1, room.ways[1].apart(z))
                    }
                    Side::Apart => (0, room.ways[0].apart(z)),
                    _ if branch == 0 && first.is_some_and(|first| z > first) => (0, room.ways[0].contact(z)),
                    _ => (1, room.ways[1].contact(z)),
                };
                Some(room.load_at(way * two, place?))
            };
            let sides = |&i: &usize| Some([load(i, Side::Apart)?, load(i, Side::Contact)?]);
            let Some(loads) = order.iter().map(sides).collect::<Option<Vec<_>>>() else { continue };
            // the residuals of both sides, with the baseline
            let squares: Vec<[f64; 2]> = order
                .iter()
                .zip(&loads)
                .map(|(&i, loads)| loads.map(|one| (room.load[i] + cleared[i] - one).powi(2)))
                .collect();
            let Some((count, seen, deviation)) = self.meet(order, &squares, noise) else { continue };
            let size = loads[count - 1..=count].iter().map(|[a, b]| (a - b).abs()).fold(0.0, f64::max);
            if size < CLEAR * noise {
                continue;
            }
            any = true;
            order[..count].iter().for_each(|&i| found.sides[i] = Side::Apart);
            order[count..].iter().for_each(|&i| found.sides[i] = Side::Contact);
            let scatter = self.mix(branch, order, &squares, &mut found.sides);
            let deviation = deviation.hypot(scatter).max(1e-8 * self.scales.length);
            found.seen[branch] = Seen { place: seen, weight: if weigh { noise / deviation } else { 0.0 } };
        }
        if any { found } else { Sides::default() }
    }

    /// Where the points of both sides are most likely to meet: how many are before, the place, and its deviation. None
    /// where all points are on one side.
    fn meet(&self, order: &[usize], squares: &[[f64; 2]], noise: f64) -> Option<(usize, f64, f64)> {
        let points = order.len();
        let mut sums = Vec::with_capacity(points + 1);
        let mut sum: f64 = squares.iter().map(|pair| pair[1]).sum();
        sums.push(sum);
        for pair in squares {
            sum += pair[0] - pair[1];
            sums.push(sum);
        }
        let (count, least) = sums.iter().copied().enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        if count == 0 || count == points {
            return None;
        }
        let (mut weight, mut mean, mut square) = (0.0, 0.0, 0.0);
        for (pair, sum) in order.windows(2).zip(&sums[1..]) {
            let likely = (-0.5 * (sum - least) / (noise * noise)).exp();
            let (low, high) = (self.z[pair[0]] - self.z[order[count]], self.z[pair[1]] - self.z[order[count]]);
            let middle = 0.5 * (low + high);
            weight += likely;
            mean += likely * middle;
            square += likely * (middle * middle + (high - low).powi(2) / 12.0);
        }
        let mean = mean / weight;
        Some((count, self.z[order[count]] + mean, (square / weight - mean * mean).max(0.0).sqrt()))
    }

    /// Where positions went back in time, gives points about a jump the side to which they are nearer, as the bodies jump
    /// once in time, too; returns how far positions scatter there.
    fn mix(&self, branch: usize, order: &[usize], squares: &[[f64; 2]], sides: &mut [Side]) -> f64 {
        let (start, end) = if branch == 0 { (0, self.turn) } else { (self.turn, self.z.len()) };
        let sign = if branch == 0 { 1.0 } else { -1.0 };
        let turns = self.z[start..end].windows(2).any(|pair| sign * (pair[1] - pair[0]) < 0.0);
        if !turns {
            return 0.0;
        }
        let mut by_time = vec![[0.0; 2]; end - start];
        order.iter().zip(squares).for_each(|(&i, pair)| by_time[i - start] = *pair);
        let (first, second) = if branch == 0 { (0, 1) } else { (1, 0) };
        let mut sum: f64 = by_time.iter().map(|pair| pair[second]).sum();
        let (mut count, mut least) = (0, sum);
        for (k, pair) in by_time.iter().enumerate() {
            sum += pair[first] - pair[second];
            if sum < least {
                (count, least) = (k + 1, sum);
            }
        }
        let mut mixed: Vec<f64> = Vec::new();
        for (k, pair) in by_time.iter().enumerate() {
            let side = if (k < count) == (branch == 0) { Side::Apart } else { Side::Contact };
            if sides[start + k] != side {
                sides[start + k] = if pair[0] < pair[1] { Side::Apart } else { Side::Contact };
                mixed.push(self.z[start + k]);
            }
        }
        let (low, high) = mixed.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &z| (a.min(z), b.max(z)));
        if mixed.is_empty() { 0.0 } else { high - low }
    }
}
