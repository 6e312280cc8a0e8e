//! The augmented Lagrangian method: penalty springs with multipliers, updated in rounds (Uzawa).

use ndarray::ArrayView2;

use super::penalty::check_stiffness;
use super::{ContactConstraint, Springs, Update, Wall};
use crate::adhesion::Values;
use crate::degrees::{FAR, LITTLE, PARTLY};
use crate::error::Result;
use crate::field::{CHUNK, Field, Reducer, ordered, read, write};
use crate::grid::Grid;
use crate::par::{self, Parts};
use crate::real::Real;

/// The factor by which the springs stiffen after a round that leaves more than its reciprocal of the interpenetration.
const STIFFEN: f64 = 4.0;

/// The augmented Lagrangian of Uzawa: springs of stiffness k, and multipliers λ that take over the contact pressure
/// from them, λ ← ⟨λ − kg⟩₊, after each round.
///
/// The energy gains (⟨λ − kg⟩₊² − λ²)/2k at each node, and after a round the gap has the error s = (λ − ⟨λ − kg⟩₊)/k. If
/// more than a quarter of this error is left, the next springs are four times as stiff. The given stiffness, at most
/// ten times the stiffness of the shortest wave, therefore hardly matters. A round is solved to the error of the round
/// before, and the last round to the tolerance of the solve. Without a given start the first round has a rigid wall.
/// Its contact pressures are the first multipliers, of springs with ten times the stiffness of the shortest wave.
///
/// The rounds end when the error of the pressure p in the energy norm is at most the tolerance. With κ the stiffness of
/// the shortest wave, Δλ the change of λ, u the displacement, N the number of nodes and bars for means, the criterion is
///
/// ```math
/// κ Σ s² + k N s̄² ≤ tolerance² Σ u·p ,   s = −Δλ/k .
/// ```
///
/// Without adhesion the first term bounds the error, since ⟨u − u*, p − p*⟩ ≤ ⟨s, p* − p⟩. The second term is for the
/// mean pressure close to full contact. In this case, and with adhesion, the criterion is an estimate. The page
/// [`comparison`](crate::guide::comparison) has the cost of Uzawa. Memory per node: one scalar.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Problem, Settings, Solver, Surface, Uzawa, Westergaard};
/// let grid = Grid::square(32, 1.0)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let mut solver = Solver { settings: Settings::default(), constraint: Uzawa::new(200.0)? };
/// let report = solver.solve(&mut problem, Control::MeanGap(0.0398))?.report;
/// assert!(report.min_gap > -1e-8 && solver.constraint.rounds() > 1);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Uzawa<T> {
    /// The relative error that interpenetration may leave, if above the solve's tolerance; 1000 roundings by default.
    pub tolerance: f64,
    /// The rounds after which the solve ends without having converged; 100 unless changed.
    pub max_rounds: usize,
    softest: T,
    stiffness: T,
    /// the root of Σ s² after the round before
    off: f64,
    stiffest: f64,
    solved_to: f64,
    /// the relative error to which the present round is solved
    present: f64,
    multipliers: Field<T>,
    rounds: usize,
}

impl<T: Real> Uzawa<T> {
    /// Springs of stiffness k in the first round, pressure per length.
    ///
    /// # Errors
    /// [`Error::Value`](crate::Error::Value) if the stiffness is not positive and finite in the precision of T.
    pub fn new(stiffness: f64) -> Result<Self> {
        check_stiffness::<T>(stiffness)?;
        let stiffness = T::lit(stiffness);
        let tolerance = 1e3 * T::epsilon().widen();
        Ok(Self {
            tolerance,
            max_rounds: 100,
            softest: stiffness,
            stiffness,
            off: f64::INFINITY,
            stiffest: 0.0,
            solved_to: 0.0,
            present: 0.0,
            multipliers: Field::default(),
            rounds: 0,
        })
    }

    /// The number of rounds of the last solve.
    pub fn rounds(&self) -> usize {
        self.rounds
    }

    /// The multipliers of so many nodes; none before a solve.
    fn multipliers(&self, node: usize, count: usize) -> &[T] {
        self.multipliers.nodes().get(node..node + count).unwrap_or_default()
    }

    /// Energy, traction and slope at one node.
    #[inline(always)]
    fn values(&self, multiplier: T, gap: T) -> [T; 3] {
        let (pressure, stiffness) = ((multiplier - self.stiffness * gap).max(T::zero()), self.stiffness);
        let energy = T::lit(0.5) * (pressure - multiplier) * (pressure + multiplier) / stiffness;
        [energy, -pressure, if pressure > T::zero() { stiffness } else { T::zero() }]
    }

    fn at(&self, node: usize, gap: T) -> [T; 3] {
        self.values(self.multipliers(node, 1).first().copied().unwrap_or_default(), gap)
    }
}

impl<T: Real> ContactConstraint<T> for Uzawa<T> {
    fn wall(&self) -> Wall<'_, T> {
        Wall::Springs(self)
    }
    fn start(&mut self, grid: &Grid, stiffest: f64, tolerance: f64) -> Result<()> {
        // the error to which the first round with springs is solved
        (self.solved_to, self.present) = (tolerance, LITTLE);
        (self.multipliers, self.rounds) = (Field::zeros(grid.shape()), 1);
        (self.stiffness, self.off, self.stiffest) = (self.softest, f64::INFINITY, stiffest);
        if stiffest > 0.0 {
            // stiffer springs only cost iterations
            self.stiffness = self.stiffness.min(T::lit(FAR * stiffest));
        }
        Ok(())
    }
    fn round_tolerance(&self) -> f64 {
        self.present
    }
    fn ends_rigid(&self) -> bool {
        true
    }
    fn bear(&mut self, pressures: ArrayView2<'_, T>, error: f64) -> bool {
        (self.multipliers, self.present) = (Field::of(pressures), PARTLY * error);
        if self.stiffest > 0.0 {
            self.stiffness = T::lit(FAR * self.stiffest);
        }
        self.rounds += 1;
        true
    }
    fn update(&mut self, gap: ArrayView2<'_, T>, work: f64) -> Update {
        let stiffness = self.stiffness;
        let nodes = ordered(gap);
        let gaps = || par::chunks(&nodes, CHUNK);
        let next = move |multiplier: T, gap: T| (multiplier - stiffness * gap).max(T::zero());
        let mut reducer = Reducer::whole(gap.dim());
        let [change, change_squared, squared] =
            reducer.run(read(&self.multipliers).zip(gaps()), |_, (multipliers, gaps)| {
                let [mut sum, mut change_squared, mut squared] = [0.0; 3];
                for (&multiplier, &gap) in multipliers.iter().zip(gaps) {
                    let next = next(multiplier, gap);
                    let [change, next] = [next - multiplier, next].map(T::widen);
                    sum += change;
                    change_squared += change * change;
                    squared += next * next;
                }
                [sum, change_squared, squared]
            });
        let (nodes, k) = (gap.len() as f64, stiffness.widen());
        let off = change_squared.sqrt() / k;
        let left = self.stiffest * off.powi(2) + change * change / (nodes * k);
        let allowed = self.tolerance.max(self.solved_to).powi(2) * work;
        // under a uniform pressure rounding alone makes waves
        let rounding = (8.0 * T::epsilon().widen()).powi(2) * squared;
        if left <= allowed || self.stiffest * left <= rounding {
            return Update::Done;
        }
        if self.rounds >= self.max_rounds {
            return Update::Failed;
        }
        // only now: the gap was found with the multipliers before
        reducer.run(write(&mut self.multipliers).zip(gaps()), |_, (multipliers, gaps)| {
            multipliers.iter_mut().zip(gaps).for_each(|(multiplier, &gap)| *multiplier = next(*multiplier, gap));
        });
        if off > self.off / STIFFEN {
            self.stiffness = stiffness * T::lit(STIFFEN);
        }
        self.off = off;
        // rounds leave a larger share of the error
        self.present = (PARTLY * (left / work).sqrt()).min(LITTLE);
        self.rounds += 1;
        Update::Again
    }
}

impl<T: Real> Springs<T> for Uzawa<T> {
    fn energy(&self, node: usize, gap: T) -> T {
        self.at(node, gap)[0]
    }
    fn traction(&self, node: usize, gap: T) -> T {
        self.at(node, gap)[1]
    }
    fn slope(&self, node: usize, gap: T) -> T {
        self.at(node, gap)[2]
    }
    fn evaluate(&self, first: usize, gaps: &[T], values: Values<'_, T>) {
        values.each(|order, values| {
            let nodes = values.iter_mut().zip(gaps).zip(self.multipliers(first, gaps.len()));
            match order {
                0 => nodes.for_each(|((value, &gap), &multiplier)| *value = self.values(multiplier, gap)[0]),
                1 => nodes.for_each(|((value, &gap), &multiplier)| *value = self.values(multiplier, gap)[1]),
                _ => nodes.for_each(|((value, &gap), &multiplier)| *value = self.values(multiplier, gap)[2]),
            }
        });
    }
}
