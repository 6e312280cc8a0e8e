//! The ways along equilibria: where the bodies jump, and the places of positions between knots.

use crate::tip::Knot;

/// One way along equilibria, in the order of positions: the knots that bodies pass.
#[derive(Debug, Default)]
pub(crate) struct Way {
    /// positions of all knots
    pub positions: Vec<f64>,
    /// knots that are passed, in the order of their positions
    passed: Vec<usize>,
    /// the place in `passed` before the greatest jump
    jump: Option<usize>,
    /// the absolute change of the load there
    pub size: f64,
    withdraws: bool,
}

/// A place between a knot and the next one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub knot: usize,
    pub share: f64,
    /// a way ends before this position
    pub clamped: bool,
}

impl Way {
    /// Goes along knots from bodies apart up to a position, or back from there. Positions are the approach times a length,
    /// and the load times a compliance.
    pub fn follow(&mut self, knots: &[Knot], length: f64, compliance: f64, farthest: f64, withdraws: bool) {
        self.withdraws = withdraws;
        self.positions.clear();
        let position = |knot: &Knot| length * knot[0] + compliance * knot[1];
        // equilibria behind the farthest position are of no use
        let used = knots.iter().rposition(|knot| position(knot) <= farthest).map_or(0, |knot| knot + 1);
        self.positions.extend(knots[..(used + 1).clamp(3, knots.len())].iter().map(position));
        self.passed.clear();
        let positions = &self.positions;
        if withdraws {
            let mut low = f64::INFINITY;
            for (knot, &position) in positions.iter().enumerate().rev() {
                if position < low {
                    low = position;
                    self.passed.push(knot);
                }
            }
            self.passed.reverse();
        } else {
            let mut high = f64::NEG_INFINITY;
            for (knot, &position) in positions.iter().enumerate() {
                if position > high {
                    high = position;
                    self.passed.push(knot);
                }
            }
        }
        self.jump = None;
        self.size = 0.0;
        for (k, pair) in self.passed.windows(2).enumerate() {
            if pair[1] - pair[0] > 1 {
                let size = (knots[pair[1]][1] - knots[pair[0]][1]).abs();
                if size > self.size {
                    (self.size, self.jump) = (size, Some(k));
                }
            }
        }
    }

    /// The knot at which the equilibria before the jump end.
    pub fn end(&self) -> Option<usize> {
        self.jump.map(|k| self.passed[k + usize::from(self.withdraws)])
    }

    /// The position of the jump.
    pub fn end_position(&self) -> Option<f64> {
        self.end().map(|knot| self.positions[knot])
    }

    /// The place of a position, searched from a place in `passed` on.
    pub fn place(&self, position: f64, from: &mut usize) -> Place {
        let passed = &self.passed;
        let last = passed.len().saturating_sub(2);
        let mut k = (*from).min(last);
        while k < last && position > self.positions[passed[k + 1]] {
            k += 1;
        }
        *from = k;
        self.between(k, position)
    }

    /// The place of a position on the side of bodies apart, which ends at the jump.
    pub fn apart(&self, position: f64) -> Option<Place> {
        let (jump, end) = (self.jump?, self.end()?);
        // on the withdrawal the side goes on, so that the jump is where it begins
        if !self.withdraws && position >= self.positions[end] {
            return Some(self.stuck(end));
        }
        let k = self.passed[..=jump].partition_point(|&knot| self.positions[knot] < position).saturating_sub(1);
        Some(self.between(k, position))
    }

    /// The place of a position on the side of bodies in contact, which begins at the jump.
    pub fn contact(&self, position: f64) -> Option<Place> {
        let (jump, end) = (self.jump?, self.end()?);
        if self.withdraws && position <= self.positions[end] {
            return Some(self.stuck(end));
        }
        let behind = self.passed[jump + 1..].partition_point(|&knot| self.positions[knot] < position);
        Some(self.between((jump + behind).min(self.passed.len().saturating_sub(2)), position))
    }

    fn stuck(&self, end: usize) -> Place {
        let knot = end.min(self.positions.len() - 2);
        Place { knot, share: (end - knot) as f64, clamped: true }
    }

    /// The place on the segment behind a place in `passed`: a jump lands between knots.
    fn between(&self, k: usize, position: f64) -> Place {
        let (low, high) = (self.passed[k], self.passed[(k + 1).min(self.passed.len() - 1)]);
        let last = self.positions.len() - 2;
        let knot = if self.withdraws { low } else { high.saturating_sub(1) }.min(last);
        let (from, to) = (self.positions[knot], self.positions[knot + 1]);
        let first = self.positions[self.passed[0]];
        if position < first {
            return self.stuck(self.passed[0]);
        }
        let share = if to > from { (position - from) / (to - from) } else { 0.0 };
        Place { knot, share: share.max(0.0), clamped: false }
    }
}
