//! The gap through which a fluid flows.

use asperity::{Error, Grid, Result};
use ndarray::{ArrayView2, CowArray, Ix2};

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

/// The gap between two surfaces, at the nodes of a grid: where it is positive it is open, elsewhere it is closed.
///
/// A node is a cell of the size of the spacing, with the gap at its middle. In a periodic gap opposite sides meet, and
/// otherwise they are the sides from one to the other of which a fluid flows.
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
    values: CowArray<'a, f64, Ix2>,
    grid: Grid,
    periodic: bool,
    absent: f64,
}

impl<'a> Gap<'a> {
    /// A periodic gap. Nodes without a surface, where `values` are not finite, are closed.
    ///
    /// # Errors
    /// [`Error::Shape`] if the values are not on the grid; [`Error::Value`] if there are more than 2³⁰ nodes;
    /// [`Error::Shared`] if several processes share the grid.
    pub fn new(values: impl Into<ArrayView2<'a, f64>>, grid: Grid) -> Result<Self> {
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
        Ok(Self { values: to_rows(values), grid, periodic: true, absent: 0.0 })
    }

    /// The gap on a part of a surface, whose opposite sides do not meet.
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

    /// The grid of the nodes.
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Whether opposite sides meet.
    pub fn is_periodic(&self) -> bool {
        self.periodic
    }

    /// The gap at a node, in row-major order; zero if it is closed.
    pub(crate) fn at(&self, node: usize) -> f64 {
        let gap = self.values[self.place(node)];
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

    /// The step from a node forwards along an axis; none beyond the end of a free gap.
    pub(crate) fn forward(&self, node: usize, axis: Axis) -> Option<Step> {
        let ((nx, ny), (i, j)) = (self.grid.shape(), self.place(node));
        let (to, leaves) = match axis {
            Axis::X if i + 1 < nx => (node + ny, false),
            Axis::X => (j, true),
            Axis::Y if j + 1 < ny => (node + 1, false),
            Axis::Y => (i * ny, true),
        };
        self.step(to, axis, i32::from(leaves))
    }

    /// The step from a node backwards along an axis.
    pub(crate) fn backward(&self, node: usize, axis: Axis) -> Option<Step> {
        let ((nx, ny), (i, j)) = (self.grid.shape(), self.place(node));
        let (to, leaves) = match axis {
            Axis::X if i > 0 => (node - ny, false),
            Axis::X => ((nx - 1) * ny + j, true),
            Axis::Y if j > 0 => (node - 1, false),
            Axis::Y => (i * ny + ny - 1, true),
        };
        self.step(to, axis, -i32::from(leaves))
    }

    fn step(&self, to: usize, axis: Axis, left: i32) -> Option<Step> {
        let cells = if axis == Axis::X { [left, 0] } else { [0, left] };
        (self.periodic || left == 0).then_some(Step { to, cells })
    }

    /// The steps from a node to its neighbours.
    pub(crate) fn steps(&self, node: usize) -> impl Iterator<Item = Step> + '_ {
        let both = move |axis| [self.forward(node, axis), self.backward(node, axis)];
        Axis::BOTH.into_iter().flat_map(both).flatten()
    }
}

fn to_rows(values: ArrayView2<'_, f64>) -> CowArray<'_, f64, Ix2> {
    if values.is_standard_layout() { values.into() } else { values.as_standard_layout().into_owned().into() }
}
