//! The error that the grid leaves at the edge of the contact.

use super::stiffness::Tangent;
use crate::grid::Grid;
use crate::real::Real;
use crate::solver::Solution;

/// The factors c of stiffness and gap, on a line, where they are that of a straight edge along the grid, and on a plane.
const ON_LINES: [f64; 2] = [1.73, 1.73];
const ON_PLANES: [f64; 2] = [0.9, 1.35];

/// The shares of the scatter, of stiffness and gap.
const SCATTER: [f64; 2] = [0.7, 0.5];

/// The estimated error that the grid leaves in a contact stiffness, and in the mean gap of the same solution.
///
/// On a grid the edge of the contact moves in steps, node by node. From one step to the next the stiffness of the grid
/// stays the same, while the true one grows: its error over the load is a sawtooth, and that of the mean gap its
/// integral, as the slope of the gap over the load is the inverse of the stiffness. Where in a step the solution is,
/// its fields and their change with the approach tell. With λ the contact pressure of a node on the edge and τ what it
/// gains per approach, the node came into contact an approach of a = λ/τ ago; with g the gap of a neighbour that is
/// apart and v what it loses per approach, that will touch in b = g/v. The step is T = a + b, of which t = a/T has
/// passed, and
///
/// ```math
/// δk = c ⟨Δ τ² (1/2 − t)⟩ / E* ,   δḡ = c ⟨Δ τ² T (t(1 − t)/2 − 1/12)⟩ / (E* k) ,
/// ```
///
/// means over all nodes of what those on the edge contribute, each the mean over its neighbours that are apart, at a
/// distance Δ. For by τ² the stiffness jumps where a node comes into contact, and over a whole step both errors have the
/// mean zero. On a line, and along an edge that is parallel to an axis, c is 1.73, by comparison with
/// [Westergaard's wave](crate::exact::WavyLine), and the errors are met closely. On a plane steps are not as regular: c is
/// 0.9 for δk and 1.35 for δḡ, fitted to rough surfaces, and so are the shares, 0.7 and 0.5, of the scatter of the terms
/// (the root of the sum of their squares), which is added in the root mean square for the case that they cancel.
///
/// ```
/// use asperity::exact::WavyLine;
/// use asperity::stability::ContactStiffness;
/// use asperity::{Control, Grid, NoAdhesion, Problem, Settings, Solver, Surface, Westergaard};
/// let grid = Grid::line(128, 1.0)?;
/// let mut problem = Problem::new(&Surface::wave(grid, 0.02, 1)?, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let mut solver = Solver::new(Settings { tolerance: Some(1e-10), ..Settings::default() });
/// let solution = solver.solve(&mut problem, Control::MeanPressure(0.02))?;
/// let edge = ContactStiffness::of(&mut problem, &solution)?.edge.unwrap();
/// let exact = WavyLine::new(0.02, 1.0, 1.0)?.at_load(0.02)?.mean_gap();
/// let error = (solution.report.mean_gap - exact).abs();
/// assert!(edge.gap > 0.5 * error && edge.gap < 2.0 * error);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeError {
    /// The error of the mean gap under the same load, or of the approach: a length.
    pub gap: f64,
    /// The error of the stiffness, a pressure per length.
    pub stiffness: f64,
}

impl EdgeError {
    /// The error of a solution in a periodic cell, by its tangent at a mean gap of 1 and its stiffness, pressure per
    /// length.
    pub(super) fn of<T: Real>(
        solution: &Solution<T>,
        tangent: &Tangent<T>,
        grid: &Grid,
        (modulus, stiffness): (f64, f64),
    ) -> Self {
        let (gap, pressure) = (&solution.gap, &solution.contact_pressure);
        let (mut jumps, mut waves) = (Terms::default(), Terms::default());
        for ((i, j), &touches) in gap.indexed_iter() {
            let gained = tangent.pressure[[i, j]].widen();
            if touches > T::zero() || gained <= 0.0 {
                continue;
            }
            let since = pressure[[i, j]].widen() / gained;
            let (mut jump, mut wave, mut sides) = (0.0, 0.0, 0.0);
            for (node, spacing) in neighbours((i, j), grid) {
                let (apart, closing) = (gap[node].widen(), tangent.opening[node].widen());
                if apart > 0.0 && closing > 0.0 {
                    let step = since + apart / closing;
                    let t = since / step;
                    jump += spacing * (0.5 - t);
                    wave += spacing * step * (0.5 * t * (1.0 - t) - 1.0 / 12.0);
                    sides += 1.0;
                }
            }
            if sides > 0.0 {
                let release = gained * gained / sides;
                jumps.add(release * jump);
                waves.add(release * wave);
            }
        }
        let [on_stiffness, on_gap] = if grid.is_line() { ON_LINES } else { ON_PLANES };
        let soft = modulus * grid.nodes() as f64;
        Self {
            gap: waves.size(on_gap, SCATTER[1]) / (soft * stiffness.abs()),
            stiffness: jumps.size(on_stiffness, SCATTER[0]) / soft,
        }
    }
}

/// The sum of some terms, and of their squares.
#[derive(Default)]
struct Terms {
    sum: f64,
    squares: f64,
}

impl Terms {
    fn add(&mut self, term: f64) {
        self.sum += term;
        self.squares += term * term;
    }

    /// A factor times the sum, together with a share of the scatter.
    fn size(&self, factor: f64, scatter: f64) -> f64 {
        (factor * self.sum).hypot(scatter * self.squares.sqrt())
    }
}

/// The neighbours of a node along the axes of a periodic grid, and the spacing to them.
fn neighbours((i, j): (usize, usize), grid: &Grid) -> impl Iterator<Item = ((usize, usize), f64)> {
    let ((nx, ny), (dx, dy)) = (grid.shape(), grid.spacing());
    let beside = |at: usize, n: usize| [(at + n - 1) % n, (at + 1) % n].into_iter().filter(move |&other| other != at);
    beside(i, nx).map(move |i| ((i, j), dx)).chain(beside(j, ny).map(move |j| ((i, j), dy)))
}
