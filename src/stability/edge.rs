//! The error that the grid leaves at the edge of the contact.

use ndarray::{CowArray, Ix2};

use super::tangent::Tangent;
use crate::contact::ContactArea;
use crate::error::Result;
use crate::grid::Grid;
use crate::real::Real;
use crate::solver::Solution;

/// The weights of the sum over the edge, of the root of the sum of squares, and of the release of nodes in contact.
struct Factors {
    sum: f64,
    scatter: f64,
    excess: f64,
}

const STIFFNESS: Factors = Factors { sum: 1.2, scatter: 0.6, excess: 0.063 };
const GAP: Factors = Factors { sum: 1.59, scatter: 0.8, excess: 0.0 };

/// The sum has the local stiffness of the grid, over E*/Δ, at an edge parallel to an axis.
const ON_LINES: Factors = Factors { sum: 1.73, scatter: 0.5, excess: 0.0 };

/// The estimated error that the grid leaves in a contact stiffness, and in the mean gap of the same solution.
///
/// The contact edge moves node by node. From one step to the next the stiffness of the grid stays the same, while the
/// true one grows: its error over the load is a sawtooth, and the error of the mean gap the integral of the sawtooth. A
/// node on the edge with the contact pressure λ, which gains τ per approach, came into contact an approach of a = λ/τ
/// ago; a neighbour with the gap g, which loses v per approach, will touch in b = g/v. The step is T = a + b, and the
/// share t = a/T has passed. Means over the neighbours across the edge give each node its T and t, and means over the
/// nodes of the grid
///
/// ```math
/// δk = c ⟨R (1/2 − t)₊⟩ − c ⟨R' (t − 1/2)₊⟩ ,   δḡ = c ⟨(R + R') T (t(1 − t)/2 − 1/12)⟩ / 2k ,
/// ```
///
/// with R = Δ τ²/E* of nodes in contact and R' = E* v²/(3 Δ) of those apart the jump of k where the edge passes a
/// node. On a line c is 1.73, the root of 3, and the errors are met closely, against [Westergaard's
/// wave](crate::exact::WavyLine). On a plane c is 1.2 for δk, less 0.063 ⟨R⟩, and 1.59 for δḡ, fitted to rough
/// surfaces. So is the scatter, added in the root mean square: 0.6 and 0.8 times the root of the sum of the squares of
/// the terms, and 0.5 times on a line.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeError {
    /// The error of the mean gap under a given load, a length; times the stiffness, the error of the mean pressure
    /// under a given mean gap.
    pub gap: f64,
    /// The error of the stiffness, a pressure per length. None with adhesion, by which edges move, and of strips on a
    /// plane, where fewer than half of the neighbours across the edge are at [places](ContactArea::places) of their own.
    pub stiffness: Option<f64>,
}

impl EdgeError {
    /// The error of a solution in a periodic cell, by its tangent at a mean gap of 1 and its stiffness.
    pub(super) fn of<T: Real>(
        solution: &Solution<T>,
        tangent: &Tangent<T>,
        (stiffness, is_adhesive): (f64, bool),
    ) -> Result<Self> {
        let (grid, modulus) = (&solution.grid, solution.report.modulus);
        let (nx, ny) = grid.shape();
        let fields = [&solution.gap, &solution.contact_pressure, &tangent.opening, &tangent.pressure];
        let [gap, pressure, opening, lost] = fields.map(|field| grid.whole(field));
        let at = |field: &CowArray<'_, T, Ix2>, node: (usize, usize)| field[node].widen();
        // the approach since a node came into contact, or until it will
        let distance = |node| {
            let apart = at(&gap, node);
            let (value, rate) =
                if apart > 0.0 { (apart, at(&opening, node)) } else { (at(&pressure, node), at(&lost, node)) };
            (apart > 0.0, value / rate, rate)
        };
        // of each node at the edge its jump, what it releases in contact, and its wave
        let mut sums = [0.0; 5];
        for node in (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))) {
            let (apart, own, rate) = distance(node);
            let (mut release, mut passed, mut wave, mut sides) = (0.0, 0.0, 0.0, 0.0);
            for (other, spacing) in neighbours(node, grid) {
                let (other_apart, others, other_rate) = distance(other);
                if apart == other_apart || rate <= 0.0 || other_rate <= 0.0 {
                    continue;
                }
                let step = own + others;
                let t = if apart { others } else { own } / step;
                passed += t;
                wave += step * (0.5 * t * (1.0 - t) - 1.0 / 12.0);
                let (soft, stiff) = (spacing / modulus, ON_LINES.sum);
                release += rate * rate * if apart { (soft * stiff * stiff).recip() } else { soft };
                sides += 1.0;
            }
            if sides > 0.0 {
                let (release, late) = (release / sides, passed / sides - 0.5);
                let jump = if apart { -late.max(0.0) } else { (-late).max(0.0) };
                let (jump, wave) = (release * jump, 0.5 * release * wave / sides);
                let own = [jump, jump * jump, if apart { 0.0 } else { release }, wave, wave * wave];
                sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
            }
        }
        let [jump, jumps, excess, wave, waves] = sums;
        let line = grid.shape().0 == 1 || grid.is_line();
        let [of_stiffness, of_gap] = if line { [&ON_LINES; 2] } else { [&STIFFNESS, &GAP] };
        let nodes = grid.nodes() as f64;
        let area = ContactArea::of_solution(solution)?;
        let is_strip = !line && 2.0 * area.places < area.edges as f64;
        let is_told = !is_adhesive && !is_strip;
        Ok(Self {
            gap: of_gap.size(wave, waves, 0.0) / (nodes * stiffness.abs()),
            stiffness: is_told.then(|| of_stiffness.size(jump, jumps, excess) / nodes),
        })
    }
}

impl Factors {
    fn size(&self, sum: f64, squares: f64, excess: f64) -> f64 {
        (self.sum * sum - self.excess * excess).hypot(self.scatter * squares.sqrt())
    }
}

/// The neighbours of a node along the axes of a periodic grid, and the spacing to them.
fn neighbours((i, j): (usize, usize), grid: &Grid) -> impl Iterator<Item = ((usize, usize), f64)> {
    let ((nx, ny), (dx, dy)) = (grid.shape(), grid.spacing());
    let beside = |at: usize, n: usize| [(at + n - 1) % n, (at + 1) % n].into_iter().filter(move |&other| other != at);
    beside(i, nx).map(move |i| ((i, j), dx)).chain(beside(j, ny).map(move |j| ((i, j), dy)))
}
