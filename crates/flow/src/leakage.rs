//! Leakage: the transmissivity of a gap, between two bounds.

use asperity::{Error, Result};
use ndarray::Array2;

use crate::elimination::Elimination;
use crate::gap::{Axis, Gap};
use crate::network::Network;
use crate::percolation::Percolation;
use crate::tree::Tree;

/// The share of the tolerance from which on an error that brings the bounds no closer is rounding.
const LEAST_SHARE: f64 = 1e-7;

/// The share of the first error, squared, at which the residual is computed anew: its rounding is then small compared
/// with the flow, and not only with the flow of the first pressure through the widest gaps.
const STALE: f64 = 1e-8;

/// The memory that an open node and a closed one take at most, in bytes: a network, its cliques and its elimination,
/// and the fields along both axes.
const OPEN: f64 = 290.0;
const CLOSED: f64 = 64.0;

/// The leakage through a gap by Reynolds' equation, ∇·(g³∇p/12η) = 0, as settings.
///
/// The *transmissivity* along x is the flow, a volume per time, over the pressure Δp that falls from one side to the
/// other, times the viscosity η: Qη/Δp, a length³, g³/12 for a slot of a square cell. In a periodic cell Δp falls over
/// each period along x and nothing over the period along y, where the gap chooses the flow. A free gap is fed at one
/// side and drained at the opposite one, and the two other sides are tight.
///
/// On the grid the gap is a network: between two neighbours flows c Δp/12η with the conductance c = 2/(1/g₁³ + 1/g₂³), times
/// Δy/Δx for neighbours along x. The transmissivity of this network is enclosed. *Any* pressure p that falls by one has
/// Σ c (Δp)² ≥ 12 T (Dirichlet's principle), and *any* flow f that is conserved at each node, F over all, has
/// F²/Σ(f²/c) ≤ 12 T (Thomson's principle). The pressure comes from conjugate gradients, preconditioned by an approximate
/// elimination; the pressure drives the flow, in integers, with what is not conserved sent along a tree of the largest
/// conductances, so that conservation is exact. Both bounds are widened by the rounding of their sums. Where nothing
/// percolates, both bounds are zero.
///
/// The least upper bound and the greatest lower bound are kept. A pressure that is uniform across the axis gives the
/// harmonic mean along the axis of the arithmetic means of g³ across it; a flow along straight lines gives the
/// arithmetic mean across the axis of the harmonic means along it. So a gap of stripes needs no iteration.
///
/// The distance of the bounds does not contain the error of the grid: compare two grids.
///
/// Memory: see [`Leakage::memory`].
///
/// | field | default | meaning | range |
/// |---|---|---|---|
/// | `tolerance` | 1e-6 | distance of the bounds, relative to the upper one | positive, below 1 |
/// | `max_iterations` | 1000 | the most iterations of conjugate gradients along each axis | at least 1 |
///
/// ```
/// use asperity::Grid;
/// use asperity_flow::{Axis, Gap, Leakage};
/// let grid = Grid::square(64, 1.0)?;
/// let wavy = grid.sample(|x, _| 1.0 + 0.5 * (std::f64::consts::TAU * x).cos());
/// let leakage = Leakage::default().through(&Gap::new(wavy.view(), grid)?)?;
/// let [across, along] = Axis::BOTH.map(|axis| &leakage.along(axis).transmissivity);
/// assert!((12.0 * across.upper - 2.0 * 0.75_f64.powf(2.5) / 2.25).abs() < 1e-6); // 2(1 − ε²)^(5/2)/(2 + ε²)
/// assert!((12.0 * along.lower - 1.375).abs() < 1e-5); // 1 + 3ε²/2
/// assert!(leakage.reached());
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leakage {
    /// Distance of the bounds, relative to the upper one.
    pub tolerance: f64,
    /// The most iterations of conjugate gradients along each axis.
    pub max_iterations: usize,
}

impl Default for Leakage {
    fn default() -> Self {
        Self { tolerance: 1e-6, max_iterations: 1000 }
    }
}

/// Two numbers that enclose a third one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The lower bound.
    pub lower: f64,
    /// The upper bound.
    pub upper: f64,
}

impl Bounds {
    /// The distance of the bounds, relative to the upper one; zero if both are zero.
    pub fn width(&self) -> f64 {
        if self.upper > 0.0 { (self.upper - self.lower) / self.upper } else { 0.0 }
    }
}

/// The flow along one axis.
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct Flow {
    /// The bounds of the transmissivity, a length³.
    pub transmissivity: Bounds,
    /// The pressure, relative to the pressure that falls from side to side, of nodes in the flow and next to it; NaN
    /// elsewhere. With a periodic gap its mean over the flow through the last side is ½.
    pub pressure: Array2<f64>,
    /// The flow at the nodes along x and along y, times η/Δp: a volume per time and width, a length².
    pub flow: [Array2<f64>; 2],
    /// Whether the bounds are as close as the tolerance.
    pub reached: bool,
    /// The iterations of conjugate gradients.
    pub iterations: usize,
    /// The number of nodes through which the fluid may flow, dead ends among them.
    pub nodes: usize,
}

/// The flow along both axes.
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct Leak {
    /// The widest passages.
    pub percolation: Percolation,
    flows: [Flow; 2],
}

impl Leak {
    /// The flow along an axis.
    pub fn along(&self, axis: Axis) -> &Flow {
        &self.flows[axis as usize]
    }

    /// Whether the bounds along both axes are as close as the tolerance.
    pub fn reached(&self) -> bool {
        self.flows.iter().all(|flow| flow.reached)
    }
}

impl Leakage {
    /// Sets `tolerance`.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Sets `max_iterations`.
    #[must_use]
    pub fn max_iterations(mut self, max_iterations: usize) -> Self {
        self.max_iterations = max_iterations;
        self
    }

    /// The memory that the flow through a gap takes at most, in bytes: 290 for each open node, or twice as many for a
    /// free gap with a network for each axis, and 64 for each closed node. The results are included, the gap is not.
    pub fn memory(gap: &Gap<'_>) -> f64 {
        let open = if gap.is_periodic() { OPEN } else { 2.0 * OPEN };
        (0..gap.grid().nodes()).map(|node| if gap.at(node) > 0.0 { open } else { CLOSED }).sum()
    }

    /// The flow through a gap along both axes, each on a thread of its own.
    ///
    /// # Errors
    /// [`Error::Value`] for a setting out of its range, and for an open gap below 1e-100 of the greatest;
    /// [`Error::Memory`] if there is too little.
    pub fn through(&self, gap: &Gap<'_>) -> Result<Leak> {
        self.through_while(gap, &|| true)
    }

    /// The same, with no further preparation and iteration once `goes_on` is false: the bounds hold then, and are not as
    /// close as the tolerance.
    ///
    /// # Errors
    /// As [`Self::through`].
    pub fn through_while(&self, gap: &Gap<'_>, goes_on: &(dyn Fn() -> bool + Sync)) -> Result<Leak> {
        self.check()?;
        let ((nx, ny), bytes) = (gap.grid().shape(), Self::memory(gap));
        // requested as a whole and given back, since a failed allocation of a part would end the process
        if Vec::<u8>::new().try_reserve_exact(bytes as usize).is_err() {
            return Err(Error::Memory { what: format!("the leakage through {nx} x {ny} nodes"), bytes });
        }
        let percolation = gap.percolation();
        let [x, y] = if !gap.is_periodic() {
            at_once(|axis| self.along_while(gap, &percolation, axis, goes_on))
        } else if percolation.is_alike() {
            let prepared = Prepared::new(gap, &percolation, Axis::X, goes_on)?;
            at_once(|axis| self.with(gap, &prepared, axis, goes_on))
        } else {
            // a cluster winds along one axis alone: each has a network of its own, one after the other
            Axis::BOTH.map(|axis| self.along_while(gap, &percolation, axis, goes_on))
        };
        Ok(Leak { flows: [x?, y?], percolation })
    }

    /// The flow through a gap along an axis, with its percolation.
    ///
    /// # Errors
    /// As [`Self::through`].
    pub fn along(&self, gap: &Gap<'_>, percolation: &Percolation, axis: Axis) -> Result<Flow> {
        self.along_while(gap, percolation, axis, &|| true)
    }

    fn along_while(
        &self,
        gap: &Gap<'_>,
        percolation: &Percolation,
        axis: Axis,
        goes_on: &dyn Fn() -> bool,
    ) -> Result<Flow> {
        self.check()?;
        if percolation.along(axis).is_none() {
            let zero = Array2::zeros(gap.grid().shape());
            return Ok(Flow {
                transmissivity: Bounds { lower: 0.0, upper: 0.0 },
                pressure: Array2::from_elem(gap.grid().shape(), f64::NAN),
                flow: [zero.clone(), zero],
                reached: true,
                iterations: 0,
                nodes: 0,
            });
        }
        self.with(gap, &Prepared::new(gap, percolation, axis, goes_on)?, axis, goes_on)
    }

    fn check(&self) -> Result<()> {
        let Self { tolerance, max_iterations } = *self;
        if !(tolerance > 0.0 && tolerance < 1.0) {
            return Err(Error::Value { name: "tolerance", value: tolerance, requirement: "positive and below 1" });
        }
        if max_iterations == 0 {
            return Err(Error::Value { name: "max_iterations", value: 0.0, requirement: "at least 1" });
        }
        Ok(())
    }

    fn with(&self, gap: &Gap<'_>, prepared: &Prepared, axis: Axis, goes_on: &dyn Fn() -> bool) -> Result<Flow> {
        let network = &prepared.network;
        let mut enclosed = Enclosed::new(gap, prepared, axis, self, goes_on);
        let hubs: Vec<f64> = network.hubs(&enclosed.pressure, axis).collect();
        enclosed.pressure.extend(hubs);
        if gap.is_periodic() {
            prepared.tree.level(network, &enclosed.flow, &mut enclosed.pressure, axis);
        }
        let twelfth = network.unit / 12.0;
        let Bounds { lower, upper } = enclosed.bounds;
        let [pressure, x, y] = network.fields(gap, &enclosed);
        Ok(Flow {
            transmissivity: Bounds { lower: lower * twelfth, upper: upper * twelfth },
            pressure,
            flow: [x, y].map(|flow| flow * twelfth),
            reached: enclosed.bounds.width() <= self.tolerance,
            iterations: enclosed.iterations,
            nodes: (0..network.vertices()).filter_map(|vertex| network.node(vertex)).count(),
        })
    }
}

/// What is found along both axes, each on a thread of its own.
fn at_once<T: Send>(along: impl Fn(Axis) -> T + Sync) -> [T; 2] {
    std::thread::scope(|scope| {
        let first = scope.spawn(|| along(Axis::X));
        let second = along(Axis::Y);
        [first.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), second]
    })
}

/// A network with its preconditioner and its tree.
struct Prepared {
    network: Network,
    elimination: Elimination,
    tree: Tree,
}

impl Prepared {
    fn new(gap: &Gap<'_>, percolation: &Percolation, axis: Axis, goes_on: &dyn Fn() -> bool) -> Result<Self> {
        let network = Network::new(gap, percolation, axis)?;
        let (elimination, tree) = std::thread::scope(|scope| {
            let tree = scope.spawn(|| Tree::new(&network));
            let elimination = Elimination::new(&network, goes_on);
            (elimination, tree.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
        });
        Ok(Self { network, elimination, tree })
    }
}

/// The conductance of a network between bounds, by conjugate gradients.
pub(crate) struct Enclosed {
    pub bounds: Bounds,
    /// The pressure of each rim and of the ground.
    pub pressure: Vec<f64>,
    /// The conserved flow on each edge.
    pub flow: Vec<f64>,
    pub iterations: usize,
}

impl Enclosed {
    /// Iterates while it continues, until the bounds are as close as the tolerance, or rounding keeps them apart.
    fn new(gap: &Gap<'_>, prepared: &Prepared, axis: Axis, settings: &Leakage, goes_on: &dyn Fn() -> bool) -> Self {
        let Leakage { tolerance, max_iterations } = *settings;
        let Prepared { network, elimination, tree } = prepared;
        let n = network.ground();
        let mut best = Self {
            bounds: Bounds { lower: 0.0, upper: f64::INFINITY },
            pressure: Vec::new(),
            flow: Vec::new(),
            iterations: 0,
        };
        for mut start in [tree.still(network, axis), network.layered(gap, axis)] {
            // the pressure of the ground, behind the rims, is zero
            start.truncate(n + 1);
            best.keep_pressure(network, &start, axis);
        }
        best.keep_flow(network, network.lined(gap, axis), axis);
        if best.bounds.width() <= tolerance {
            return best;
        }
        // the pressure with the lesser bound is the nearer one to the solution
        let mut pressure = best.pressure.clone();
        let [mut residual, mut change, mut direction] = [(); 3].map(|()| vec![0.0; n + 1]);
        let [mut preconditioned, mut work] = [(); 2].map(|()| vec![0.0; n]);
        network.gained(&pressure, axis, &mut residual);
        // both bounds are computed when the square of the error in the energy norm, by the preconditioner, is below a
        // share of the tolerance of the upper bound, which each step lowers
        let (mut share, mut upper) = (0.1, best.bounds.upper);
        let (mut first, mut before) = (f64::INFINITY, f64::INFINITY);
        for iterations in 0.. {
            elimination.solve(&residual[..n], &mut preconditioned, &mut work);
            let error = dot(&preconditioned, &residual[..n]);
            if before.is_infinite() {
                first = error;
            }
            let again = error / before;
            direction.iter_mut().zip(&preconditioned).for_each(|(d, z)| *d = z + again * *d);
            network.apply(&direction, &mut change);
            let step = -error / dot(&direction[..n], &change[..n]);
            let last = iterations == max_iterations || !(error > 0.0 && step.is_finite()) || !goes_on();
            let mut stale = error <= STALE * first;
            if error <= share * tolerance * upper || last {
                let improved = best.look_at(network, tree, &pressure, axis);
                best.iterations = iterations;
                if last || best.bounds.width() <= tolerance || (!improved && share < LEAST_SHARE) {
                    break;
                }
                (share, stale) = (0.1 * share, true);
            }
            before = error;
            upper -= step * error;
            pressure.iter_mut().zip(&direction).for_each(|(p, d)| *p += step * d);
            if stale {
                network.gained(&pressure, axis, &mut residual);
                before = f64::INFINITY;
            } else {
                residual.iter_mut().zip(&change).for_each(|(r, c)| *r += step * c);
            }
        }
        best
    }

    /// Computes both bounds at a pressure, and keeps the better ones; whether one is better.
    fn look_at(&mut self, network: &Network, tree: &Tree, pressure: &[f64], axis: Axis) -> bool {
        let lowered = self.keep_pressure(network, pressure, axis);
        let conserved = tree.conserved(network, pressure, axis);
        conserved.is_some_and(|flow| self.keep_flow(network, flow, axis)) || lowered
    }

    /// Keeps a pressure if its upper bound is the least so far; whether it is.
    fn keep_pressure(&mut self, network: &Network, pressure: &[f64], axis: Axis) -> bool {
        let upper = network.upper(pressure, axis);
        let is_lower = upper < self.bounds.upper;
        if is_lower {
            self.bounds.upper = upper;
            self.pressure = pressure.to_vec();
        }
        is_lower
    }

    /// Keeps a flow, in integers of a unit, if its lower bound is the greatest so far; whether it is.
    fn keep_flow(&mut self, network: &Network, (flow, unit): (Vec<i64>, f64), axis: Axis) -> bool {
        let lower = network.lower(&flow, axis);
        let is_higher = lower > self.bounds.lower || self.flow.is_empty();
        if is_higher {
            self.bounds.lower = lower;
            self.flow = flow.into_iter().map(|flow| flow as f64 * unit).collect();
        }
        is_higher
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
