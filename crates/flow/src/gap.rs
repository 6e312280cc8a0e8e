//! The gap through which a fluid flows.

use asperity::{Error, Grid, Result};
use ndarray::ArrayView2;

use std::borrow::Cow;

/// An axis of the cell, along which a pressure falls or a channel runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The first index of fields.
    X,
    /// The second index of fields.
    Y,
}

impl Axis {
    /// Both axes.
    pub const BOTH: [Self; 2] = [Self::X, Self::Y];

    /// The name in reports, `"x"` or `"y"`.
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
        }
    }
}

/// A step from a node to one of its four neighbours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    /// The neighbour.
    pub to: usize,
    /// The cells that are left on the way, along x and along y: −1, 0 or 1 each.
    pub cells: [i32; 2],
}

/// How far surfaces overlap at most, over the greatest gap: as much as a solve in single precision may leave.
const OVERLAP: f64 = 1e-6;

/// The gap between two surfaces, at the nodes of a grid: where it is positive it is open, elsewhere it is closed.
///
/// A node is a cell of the size of the spacing, with the gap at its middle. In a periodic gap opposite sides meet;
/// otherwise a fluid flows from one side to the opposite side.
///
/// ```
/// use asperity::Grid;
/// use asperity_flow::{Axis, Gap};
/// let grid = Grid::square(4, 1.0)?;
/// let slot = ndarray::array![[1., 0., 0., 0.], [2., 0., 0., 0.], [3., 0., 0., 0.], [4., 0., 0., 0.]];
/// let percolation = Gap::new(slot.view(), grid)?.percolation();
/// let narrowest = percolation.along(Axis::X).unwrap();
/// assert_eq!((narrowest.gap, narrowest.node), (1.0, (0, 0)));
/// assert!(percolation.along(Axis::Y).is_none());
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Gap<'a> {
    /// In row-major order.
    values: Cow<'a, [f64]>,
    grid: Grid,
    periodic: bool,
    absent: f64,
}

impl<'a> Gap<'a> {
    /// A periodic gap. Nodes without a surface, where `values` are not finite, are closed.
    ///
    /// # Errors
    /// As [`of_solution`](Self::of_solution); [`Error::Value`] if a value is below -1e-6 of the greatest, as heights
    /// are.
    pub fn new(values: impl Into<ArrayView2<'a, f64>>, grid: Grid) -> Result<Self> {
        let values = values.into();
        let finite = || values.iter().copied().filter(|gap| gap.is_finite());
        let (least, greatest) = (finite().fold(0.0, f64::min), finite().fold(0.0, f64::max));
        if least < -OVERLAP * greatest {
            let requirement = "zero or positive. Is it a gap? A gap is the distance between the surfaces, as gap.npy of \
                               a solve: of heights solve first, and where surfaces overlap set it to zero";
            return Err(Error::Value { name: "least gap", value: least, requirement });
        }
        Self::of_solution(values, grid)
    }

    /// The periodic gap of a solve, in which surfaces overlap where a wall of springs lets them: such nodes are closed.
    ///
    /// # Errors
    /// [`Error::Shape`] if the values are not on the grid; [`Error::Value`] if there are more than 2³⁰ nodes;
    /// [`Error::Shared`] if several processes share the grid.
    pub fn of_solution(values: impl Into<ArrayView2<'a, f64>>, grid: Grid) -> Result<Self> {
        let values = values.into();
        if grid.is_shared() {
            let reason = "one process computes it: give it the whole gap, on a grid of its own";
            return Err(Error::Shared { what: "the flow through a gap", reason });
        }
        Error::shape("gap", values.dim(), grid.shape())?;
        if grid.nodes() > 1 << 30 {
            let (name, requirement) = ("number of nodes of a gap", "at most 2^30");
            return Err(Error::Value { name, value: grid.nodes() as f64, requirement });
        }
        Ok(Self { values: rows(values), grid, periodic: true, absent: 0.0 })
    }

    /// The gap on a part of a surface: opposite sides do not meet.
    #[must_use]
    pub fn free(mut self) -> Self {
        self.periodic = false;
        self
    }

    /// Opens the nodes without a surface to a depth, or closes them by zero.
    ///
    /// # Errors
    /// [`Error::Value`] if the depth is negative or not finite.
    pub fn absent(mut self, depth: f64) -> Result<Self> {
        self.absent = Error::non_negative("gap of absent nodes", depth)?;
        Ok(self)
    }

    /// The gap at every second node along both axes, from one near the first corner on.
    pub(crate) fn every_second(&self, first: usize) -> Result<Gap<'static>> {
        let (nx, ny) = self.grid.shape();
        let places = (first..nx).step_by(2).flat_map(|i| (first..ny).step_by(2).map(move |j| i * ny + j));
        let values = places.map(|node| self.values[node]).collect();
        Ok(Gap { values, grid: Grid::new((nx / 2, ny / 2), self.grid.lengths())?, ..*self })
    }

    /// The grid of the nodes.
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Whether opposite sides meet.
    pub(crate) fn is_periodic(&self) -> bool {
        self.periodic
    }

    /// The gap at a node, in row-major order; zero if it is closed.
    pub(crate) fn at(&self, node: usize) -> f64 {
        let gap = self.values[node];
        if gap.is_finite() { gap.max(0.0) } else { self.absent }
    }

    /// The greatest gap.
    pub(crate) fn greatest(&self) -> f64 {
        (0..self.grid.nodes()).map(|node| self.at(node)).fold(0.0, f64::max)
    }

    /// The indices of a node.
    pub(crate) fn place(&self, node: usize) -> (usize, usize) {
        let ny = self.grid.shape().1;
        (node / ny, node % ny)
    }

    /// The step from a node along an axis, forwards or backwards; none beyond the end of a free gap.
    pub(crate) fn step(&self, node: usize, axis: Axis, forward: bool) -> Option<Step> {
        let ((nx, ny), (i, j)) = (self.grid.shape(), self.place(node));
        let (k, n, stride) = if axis == Axis::X { (i, nx, ny) } else { (j, ny, 1) };
        let around = (n - 1) * stride;
        let (to, left) = match forward {
            true if k + 1 < n => (node + stride, 0),
            true => (node - around, 1),
            false if k > 0 => (node - stride, 0),
            false => (node + around, -1),
        };
        let cells = if axis == Axis::X { [left, 0] } else { [0, left] };
        (self.periodic || left == 0).then_some(Step { to, cells })
    }

    /// The steps from a node to its neighbours.
    pub(crate) fn steps(&self, node: usize) -> impl Iterator<Item = Step> + '_ {
        AROUND.into_iter().filter_map(move |(axis, forward)| self.step(node, axis, forward))
    }
}

/// The directions from a node to its neighbours: an axis, and whether forwards.
pub(crate) const AROUND: [(Axis, bool); 4] = [(Axis::X, true), (Axis::X, false), (Axis::Y, true), (Axis::Y, false)];

/// The values in row-major order, copied where they are in another one.
fn rows(values: ArrayView2<'_, f64>) -> Cow<'_, [f64]> {
    values.to_slice().map_or_else(|| values.iter().copied().collect(), Cow::Borrowed)
}
