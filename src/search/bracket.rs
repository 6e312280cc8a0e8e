//! The bracket of the wanted contact, which yields the trials of a search.

use super::axis::Axis;
use crate::constraint::Wall;
use crate::degrees::LITTLE;
use crate::error::{Error, Result};
use crate::problem::Problem;
use crate::real::Real;
use crate::solver::Branch;

/// The width of a bracket in which the contact jumps, in the logarithm of the load or relative to the approach.
const WIDTH: f64 = 1e-5;

/// The share of a bracket that a step leaves to both sides at least.
const MARGIN: f64 = 0.02;

/// The largest step outside of a bracket, in the same units, and the most that it grows to.
const STEP: (f64, f64) = (1.4, 8.0);

/// A result of a search.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Point {
    pub(super) x: f64,
    /// ln(−ln(1 − A)) of the contact fraction A
    pub(super) level: f64,
    pub(super) nodes: usize,
}

fn level(fraction: f64) -> f64 {
    (-(-fraction).ln_1p()).ln()
}

/// The contact that is wanted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    pub(super) fraction: f64,
    /// the number of nodes that face the surface
    pub(super) facing: f64,
    /// the number of nodes of its grid
    pub(super) nodes: f64,
}

impl Target {
    fn wanted(self) -> f64 {
        self.fraction * self.facing
    }

    /// The distance of a contact from the wanted one, in units of the tolerance.
    pub(super) fn off(self, nodes: usize) -> f64 {
        (nodes as f64 - self.wanted()).abs() / (LITTLE * self.wanted()).max(1.0)
    }

    pub(super) fn is_met_by(self, Point { nodes, .. }: Point) -> bool {
        nodes > 0 && (nodes as f64) < self.facing && self.off(nodes) <= 1.0
    }

    pub(super) fn point(self, x: f64, nodes: usize) -> Point {
        Point { x, level: level(nodes as f64 / self.facing), nodes }
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Bracket {
    pub(super) axis: Axis,
    pub(super) target: Target,
    /// the end of the axis
    end: f64,
    below: Option<Point>,
    above: Option<Point>,
    widths: [Option<f64>; 2],
    /// how often the end was sought outside of what is known
    widened: i32,
    /// whether the path comes from below
    from_below: Option<bool>,
}

impl Bracket {
    pub(super) fn of<T: Real>(problem: &Problem<T>, wall: Wall<'_, T>, fraction: f64) -> Result<Self> {
        let axis = Axis::of(&problem.flat, problem.adheres())?;
        let nodes = problem.grid().nodes();
        let target = Target { fraction, facing: problem.flat.facing(nodes) as f64, nodes: nodes as f64 };
        if !(target.wanted() >= 1.0 && fraction < 1.0) {
            let requirement = "at least one node, and less than 1";
            return Err(Error::Value { name: "contact fraction", value: fraction, requirement });
        }
        let (end, widths) = (axis.end(target, wall), [None; 2]);
        Ok(Self { axis, target, end, below: None, above: None, widths, widened: 0, from_below: None })
    }

    /// The first trial, from the last results of a search, or on a branch.
    pub(super) fn first(&mut self, points: &[Point], branch: Option<Branch>) -> f64 {
        self.from_below = branch.map(|branch| branch == Branch::Loading);
        let Some(&last) = points.last() else { return self.axis.first(self.target.fraction).min(self.end) };
        self.from_below = Some(self.is_below(last));
        self.add(last);
        self.next(points)
    }

    /// The next trial, from the last results; none where the contact jumps within the bracket, or the axis ends.
    pub(super) fn trial(&mut self, points: &[Point]) -> Option<f64> {
        let x = self.next(points);
        let ended = self.is_narrow() || self.below.is_some_and(|below| below.x == x);
        (!ended).then_some(x)
    }

    /// Takes a result in; `true` if the path goes on from it. With adhesion a state beyond the wanted one is on the way
    /// back already.
    pub(super) fn add(&mut self, point: Point) -> bool {
        let (width, below) = (self.width(), self.is_below(point));
        *(if below { &mut self.below } else { &mut self.above }) = Some(point);
        self.widths = [width, self.widths[0]];
        !self.axis.adheres() || *self.from_below.get_or_insert(below) == below
    }

    /// The contact fractions at its ends.
    pub(super) fn shares(&self) -> (Option<f64>, Option<f64>) {
        let share = |point: Point| point.nodes as f64 / self.target.facing;
        (self.below.map(share), self.above.map(share))
    }

    fn is_below(&self, point: Point) -> bool {
        (point.nodes as f64) < self.target.wanted()
    }

    fn width(&self) -> Option<f64> {
        Some(self.above?.x - self.below?.x)
    }

    /// Whether the contact jumps within it.
    fn is_narrow(&self) -> bool {
        let ends = self.below.zip(self.above);
        ends.is_some_and(|(below, above)| above.x - below.x <= WIDTH * self.axis.scale(above.x))
    }

    fn next(&mut self, points: &[Point]) -> f64 {
        let goal = level(self.target.fraction);
        let x = match (self.below, self.above) {
            (Some(below), Some(above)) => {
                let share = (goal - below.level) / (above.level - below.level);
                // a secant that does not halve the bracket in two steps gives way to the middle
                let slow = self.widths[1].zip(self.width()).is_some_and(|(before, now)| now > 0.5 * before);
                let share = if slow || !share.is_finite() { 0.5 } else { share.clamp(MARGIN, 1.0 - MARGIN) };
                below.x + share * (above.x - below.x)
            }
            (Some(end), None) | (None, Some(end)) => {
                let way = if self.below.is_some() { 1.0 } else { -1.0 };
                let most = self.axis.scale(end.x) * (STEP.0 * 2f64.powi(self.widened)).min(STEP.1);
                self.widened += 1;
                let step = ((goal - end.level) / self.axis.slope(points)).abs();
                end.x + way * if step.is_finite() { step.clamp(MARGIN * most, most) } else { most }
            }
            (None, None) => 0.0,
        };
        x.min(self.end)
    }
}
