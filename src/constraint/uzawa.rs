use ndarray::{Array2, ArrayView2};

use super::{ContactConstraint, Outer};
use crate::error::{Error, Result};
use crate::field::{CHUNK, Partial, Reducer, flat, write};
use crate::grid::Grid;
use crate::par::{self, IndexedParallelIterator};
use crate::real::Real;

/// The springs are stiffened where an update leaves more than this share of the change of the last one, by this factor.
const SLOW: f64 = 0.25;
const STIFFEN: f64 = 4.0;

/// The augmented Lagrangian of Uzawa: springs of stiffness k, and multipliers λ that take over the contact pressure from
/// them, λ ← ⟨λ − kg⟩₊, after each solve.
///
/// The energy gains (⟨λ − kg⟩₊² − λ²)/2k at each node. The interpenetration falls with every outer iteration, whatever
/// k is; they end when an update changes no multiplier by more than `tolerance` of the largest. Adhesion goes on into
/// negative gaps as [`ContactConstraint`] says. Memory per node: one scalar.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Problem, Settings, Solver, Surface, Uzawa, Westergaard};
/// let grid = Grid::square(32, 1.0)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let mut solver = Solver { settings: Settings::default(), constraint: Uzawa::new(200.0)? };
/// let report = solver.solve(&mut problem, Control::MeanGap(0.0398))?.report;
/// assert!(report.min_gap > -1e-8 && solver.constraint.outer_iterations() > 1);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Uzawa<T> {
    /// The largest change of a multiplier, relative to the largest multiplier, with which the outer iterations end;
    /// 1e-6 unless changed, in `f32` a thousand times its rounding, 1.2e-4. A solve to a larger tolerance than this leaves the
    /// multipliers no more certain than itself: then its tolerance counts.
    pub tolerance: f64,
    /// How many outer iterations there may be before the solve ends without having converged; 100 unless changed.
    pub max_outer_iterations: usize,
    /// that of the first round
    softest: T,
    /// that of the present round
    stiffness: T,
    /// by how much the gap was off in the round before, as the root of a sum of squares
    off: f64,
    /// the stiffness of the shortest wave
    stiffest: f64,
    /// the tolerance of the solve
    solved_to: f64,
    multipliers: Array2<T>,
    outer_iterations: usize,
}

impl<T: Real> Uzawa<T> {
    /// Springs of stiffness k, pressure per length, and multipliers that start from zero.
    ///
    /// # Errors
    /// [`Error::Value`] if the stiffness is not positive and finite.
    pub fn new(stiffness: T) -> Result<Self> {
        Error::positive("penalty stiffness", stiffness.widen())?;
        let tolerance = (1e3 * T::epsilon().widen()).max(1e-6);
        let multipliers = Array2::zeros((0, 0));
        Ok(Self { tolerance, max_outer_iterations: 100, softest: stiffness, stiffness, off: f64::INFINITY, stiffest: 0.0, solved_to: 0.0, multipliers, outer_iterations: 0 })
    }

    /// How often the multipliers of the last solve were updated.
    pub fn outer_iterations(&self) -> usize {
        self.outer_iterations
    }

    /// ⟨λ − kg⟩₊
    fn pressure(&self, node: usize, gap: T) -> T {
        (self.multiplier(node) - self.stiffness * gap).max(T::zero())
    }

    fn multiplier(&self, node: usize) -> T {
        flat(&self.multipliers).get(node).copied().unwrap_or_default()
    }
}

impl<T: Real> ContactConstraint<T> for Uzawa<T> {
    fn projects(&self) -> bool {
        false
    }
    fn start(&mut self, grid: &Grid, stiffest: f64, tolerance: f64) -> Result<()> {
        self.solved_to = tolerance;
        self.multipliers = Array2::zeros(grid.shape());
        self.outer_iterations = 0;
        (self.stiffness, self.off, self.stiffest) = (self.softest, f64::INFINITY, stiffest);
        Ok(())
    }
    fn energy(&self, node: usize, gap: T) -> T {
        let (pressure, multiplier) = (self.pressure(node, gap), self.multiplier(node));
        T::lit(0.5) * (pressure - multiplier) * (pressure + multiplier) / self.stiffness
    }
    fn traction(&self, node: usize, gap: T) -> T {
        -self.pressure(node, gap)
    }
    fn slope(&self, node: usize, gap: T) -> T {
        if self.pressure(node, gap) > T::zero() { self.stiffness } else { T::zero() }
    }
    fn update(&mut self, gap: ArrayView2<'_, T>) -> Outer {
        self.outer_iterations += 1;
        let (nodes, stiffness) = (self.multipliers.len(), self.stiffness);
        let gap = gap.as_standard_layout();
        let gaps = par::chunks(gap.as_slice().unwrap_or_default(), CHUNK);
        let total = Reducer::new(nodes).run(write(&mut self.multipliers).zip(gaps), |_, (multipliers, gap)| {
            let mut part = Partial::NONE;
            for (multiplier, &gap) in multipliers.iter_mut().zip(gap) {
                let next = (*multiplier - stiffness * gap).max(T::zero());
                let [change, pressure] = [next - *multiplier, next].map(T::widen);
                part.sum[0] += change * change;
                part.sum[1] += pressure * pressure;
                part.sum[2] += pressure;
                *multiplier = next;
            }
            part
        });
        let [change, square, sum, ..] = total.sum;
        // what is left of the squares beside that of the mean, but for their rounding
        let waves = (square - sum * sum / nodes as f64 - 8.0 * f64::EPSILON * square).max(0.0);
        let allowed = (self.tolerance.max(self.solved_to) * waves.sqrt()).max(8.0 * T::epsilon().widen() * square.sqrt());
        let off = change.sqrt() / stiffness.widen();
        if self.stiffest * off <= allowed {
            return Outer::Done;
        }
        if self.outer_iterations >= self.max_outer_iterations {
            return Outer::Failed;
        }
        if off > SLOW * self.off {
            self.stiffness = stiffness * T::lit(STIFFEN);
        }
        self.off = off;
        Outer::Again
    }
}
