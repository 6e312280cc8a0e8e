//! The grid: equidistant nodes on a periodic rectangle or line.

use std::f64::consts::TAU;
use std::ops::Range;

use ndarray::{Array2, ArrayView2, CowArray, Ix2};

use crate::error::{Error, Result};
use crate::field::{CHUNK, Reducer, all_finite_in, ordered};
use crate::par::{self, Parts};
use crate::ranks::{COUNTED, Sent};
use crate::real::Real;
use crate::slab::{Rows, Slab};

/// A periodic rectangle of Nx × Ny nodes on sides Lx × Ly; `Ny = 1` is a line, on which Ly has no influence.
///
/// Any sizes will do, odd and prime ones too. Fields have shape `(Nx, Ny)`, row-major. The origin is the node
/// `(Nx / 2, Ny / 2)` (integer division).
///
/// ```
/// use asperity::Grid;
/// let grid = Grid::new((4, 5), (1.0, 2.0))?;
/// assert_eq!(grid.spacing(), (0.25, 0.4));
/// assert_eq!((grid.x(0), grid.x(2)), (-0.5, 0.0));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(try_from = "Sides", into = "Sides"))]
pub struct Grid {
    slab: Slab,
    lengths: (f64, f64),
}

#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Sides {
    shape: (usize, usize),
    lengths: (f64, f64),
}

#[cfg(feature = "serde")]
impl From<Grid> for Sides {
    fn from(grid: Grid) -> Self {
        Self { shape: grid.shape(), lengths: grid.lengths }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Sides> for Grid {
    type Error = Error;

    fn try_from(Sides { shape, lengths }: Sides) -> Result<Self> {
        Self::new(shape, lengths)
    }
}

impl Grid {
    /// A grid of `shape = (Nx, Ny)` nodes on sides `lengths = (Lx, Ly)`, in any unit of length.
    ///
    /// # Errors
    /// [`Error::Value`] if a number of nodes is zero or beyond any memory, or a length is not positive and finite.
    pub fn new(shape: (usize, usize), lengths: (f64, f64)) -> Result<Self> {
        for (name, n) in [("number of nodes Nx", shape.0), ("number of nodes Ny", shape.1)] {
            if n == 0 {
                return Err(Error::Value { name, value: 0.0, requirement: "at least 1" });
            }
        }
        // a field on the grid must fit into an allocation
        if shape.0.checked_mul(shape.1).is_none_or(|nodes| nodes > isize::MAX as usize / 32) {
            let value = shape.0 as f64 * shape.1 as f64;
            return Err(Error::Value {
                name: "number of nodes",
                value,
                requirement: "such that fields fit into memory",
            });
        }
        Error::positive("side length Lx", lengths.0)?;
        Error::positive("side length Ly", lengths.1)?;
        Ok(Self { slab: Slab::whole(shape), lengths })
    }

    /// A square grid: `n` × `n` nodes on sides of `length`.
    ///
    /// # Errors
    /// As for [`Grid::new`].
    pub fn square(n: usize, length: f64) -> Result<Self> {
        Self::new((n, n), (length, length))
    }

    /// A line: `n` nodes on `length`, `Ny = 1`.
    ///
    /// # Errors
    /// As for [`Grid::new`].
    pub fn line(n: usize, length: f64) -> Result<Self> {
        Self::new((n, 1), (length, length))
    }

    /// The numbers of nodes `(Nx, Ny)`.
    pub fn shape(&self) -> (usize, usize) {
        self.slab.shape()
    }

    /// The rows of nodes, of `0..Nx`, that this process holds: all of them, unless several processes share the grid.
    pub fn rows(&self) -> Range<usize> {
        self.slab.rows()
    }

    /// The shape of a field in this process: (Nx, Ny), or the rows that [`Grid::rows`] names on a shared grid.
    pub fn field_shape(&self) -> (usize, usize) {
        self.slab.held()
    }

    /// Whether several processes share the grid.
    pub fn is_shared(&self) -> bool {
        self.slab.is_shared()
    }

    /// The value of each of the processes that share the grid, in their order. All of them have to ask.
    #[doc(hidden)]
    pub fn each<E: Sent>(&self, own: E) -> Vec<E> {
        self.slab.each(own)
    }

    /// Whether something is so anywhere on the grid, from whether it is so in the rows here. All processes have to ask.
    pub(crate) fn any(&self, here: bool) -> bool {
        self.each(here).contains(&true)
    }

    /// The number of some nodes on the grid, from their number in the rows here. All processes have to ask.
    pub(crate) fn sum(&self, here: usize) -> usize {
        self.each(here).iter().sum()
    }

    /// Adds the numbers of all rows to the numbers of the rows here. All processes have to ask.
    pub(crate) fn add_up(&self, here: &mut [u64]) {
        self.slab.ranks().add_up(here);
    }

    /// The least number on the grid, from the least one in the rows here. All processes have to ask.
    pub(crate) fn least(&self, here: f64) -> f64 {
        self.each(here).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The greatest number on the grid, from the greatest one in the rows here. All processes have to ask.
    pub(crate) fn greatest(&self, here: f64) -> f64 {
        self.each(here).into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// The result of the rows here, or an error of other rows. All processes have to ask.
    pub(crate) fn agreed<T>(&self, here: Result<T>) -> Result<T> {
        self.slab.agreed(here)
    }

    /// The rows of a field that the rows of another grid need, by `needs` for each row. All processes have to ask.
    pub(crate) fn rows_for<'a, A: Sent, I: IntoIterator<Item = usize>>(
        &self,
        field: impl Into<CowArray<'a, A, Ix2>>,
        to: &Self,
        needs: impl Fn(usize) -> I,
    ) -> Rows<'a, A> {
        self.slab.rows_for(field, &to.slab, needs)
    }

    /// The lists of all rows, one after the other, from the list of the rows here. All processes have to ask.
    pub(crate) fn lists<E: Sent>(&self, here: Vec<E>) -> Vec<E> {
        self.slab.ranks().lists(here)
    }

    /// A field in the rows of the same grid with another division. All processes have to ask.
    pub(crate) fn moved<'a, A: Sent>(&self, field: impl Into<CowArray<'a, A, Ix2>>, to: &Self) -> CowArray<'a, A, Ix2> {
        self.slab.moved(field.into(), &to.slab)
    }

    /// The whole of a field, on every one of the processes that share the grid. All of them have to ask.
    pub fn whole<'a, E: Sent>(&self, field: impl Into<CowArray<'a, E, Ix2>>) -> CowArray<'a, E, Ix2> {
        self.slab.whole_of(field)
    }

    /// The grid for this process alone, as for [whole](Self::whole) fields.
    #[doc(hidden)]
    pub fn alone(self) -> Self {
        Self { slab: Slab::whole(self.shape()), ..self }
    }

    /// Refuses a field that does not have the shape of the grid's. All processes have to ask.
    pub(crate) fn fits(&self, name: &'static str, shape: (usize, usize)) -> Result<()> {
        self.agreed(Error::shape(name, shape, self.field_shape()))
    }

    /// Refuses a field that is not finite somewhere. All processes have to ask.
    pub(crate) fn finite<T: Real>(&self, name: &'static str, field: ArrayView2<'_, T>) -> Result<()> {
        all_finite_in(self.slab, name, field)
    }

    /// Refuses what takes more memory than there is.
    pub(crate) fn afford(&self, what: &str, bytes_per_node: usize) -> Result<()> {
        self.slab.afford(what, bytes_per_node)
    }

    /// Refuses `what` where several processes share the grid.
    pub(crate) fn refuse_shared(&self, what: &'static str) -> Result<()> {
        self.slab.alone(what)
    }

    pub(crate) fn reducer(&self) -> Reducer {
        Reducer::new(self.slab)
    }

    /// The mean of a function over all nodes; the field has the nodes of this process, in any layout.
    pub(crate) fn mean<T: Copy + Sync>(&self, field: ArrayView2<'_, T>, of: impl Fn(T) -> f64 + Sync + Send) -> f64 {
        self.mean_of_both(field, field, |value, _| of(value))
    }

    pub(crate) fn mean_of_both<S: Copy + Sync, T: Copy + Sync>(
        &self,
        a: ArrayView2<'_, S>,
        b: ArrayView2<'_, T>,
        of: impl Fn(S, T) -> f64 + Sync + Send,
    ) -> f64 {
        let (a, b) = (ordered(a), ordered(b));
        let chunks = par::chunks(&a, CHUNK).zip(par::chunks(&b, CHUNK));
        let sum = self.reducer().run(chunks, |_, (a, b)| a.iter().zip(b).map(|(&a, &b)| of(a, b)).sum::<f64>());
        sum / self.nodes() as f64
    }

    pub(crate) fn slab(&self) -> Slab {
        self.slab
    }

    /// The number of the first node of the rows here: nodes count along the rows of the whole grid.
    pub(crate) fn first_node(&self) -> usize {
        self.slab.first_node()
    }

    /// A grid of `shape` nodes on sides of `lengths` that the processes of this one share.
    ///
    /// # Errors
    /// As [`Grid::new`] and [`Self::within`].
    pub(crate) fn sibling(&self, shape: (usize, usize), lengths: (f64, f64)) -> Result<Self> {
        Self::new(shape, lengths)?.within(self.slab.for_grid(shape))
    }

    /// This grid, on the first nodes of a `larger` one along both sides, with the rows that the larger one has here.
    pub(crate) fn held_by(&self, larger: &Self) -> Self {
        Self { slab: larger.slab.window(self.shape()), ..*self }
    }

    /// The grid with another division into slabs; [`Error::Value`] if a process would hold more nodes than MPI counts.
    pub(crate) fn within(self, slab: Slab) -> Result<Self> {
        // the half spectrum has one column more
        let most = (0..slab.ranks().count()).map(|rank| slab.rows_of(rank).len()).max();
        let nodes = most.unwrap_or_default() * (self.shape().1 + 2);
        if slab.is_shared() && nodes > COUNTED {
            let requirement = "at most 2^31: take more processes";
            return Err(Error::Value { name: "number of nodes of a process", value: nodes as f64, requirement });
        }
        Ok(Self { slab, ..self })
    }

    /// The side lengths `(Lx, Ly)`.
    pub fn lengths(&self) -> (f64, f64) {
        self.lengths
    }

    /// The number of nodes, Nx·Ny.
    pub fn nodes(&self) -> usize {
        self.slab.nodes()
    }

    /// Whether there is only one row of nodes, `Ny = 1`.
    pub fn is_line(&self) -> bool {
        self.shape().1 == 1
    }

    /// The distances between nodes `(Δx, Δy) = (Lx/Nx, Ly/Ny)`.
    pub fn spacing(&self) -> (f64, f64) {
        (self.lengths.0 / self.shape().0 as f64, self.lengths.1 / self.shape().1 as f64)
    }

    /// The larger of Δx and Δy; the spacing along the other side where one side has a single node.
    pub fn largest_spacing(&self) -> f64 {
        let (dx, dy) = self.spacing();
        match self.shape() {
            (_, 1) => dx,
            (1, _) => dy,
            _ => dx.max(dy),
        }
    }

    /// The coordinate of row `i` along x; zero at `i = Nx / 2`.
    pub fn x(&self, i: usize) -> f64 {
        coordinate(i, self.shape().0, self.lengths.0)
    }

    /// The coordinate of column `j` along y; zero at `j = Ny / 2`.
    pub fn y(&self, j: usize) -> f64 {
        coordinate(j, self.shape().1, self.lengths.1)
    }

    /// The wave number along x of line `k` of a spectrum: 2πk/Lx, 2π(k − Nx)/Lx above the (positive) Nyquist line.
    pub fn wave_number_x(&self, k: usize) -> f64 {
        wave_number(k, self.shape().0, self.lengths.0)
    }

    /// The wave number along y, as [`Grid::wave_number_x`] along x.
    pub fn wave_number_y(&self, k: usize) -> f64 {
        wave_number(k, self.shape().1, self.lengths.1)
    }

    /// The field of a function of the coordinates, `(x, y) → f`, of shape [`Grid::field_shape`].
    pub fn sample(&self, f: impl Fn(f64, f64) -> f64) -> Array2<f64> {
        let first = self.rows().start;
        Array2::from_shape_fn(self.field_shape(), |(i, j)| f(self.x(first + i), self.y(j)))
    }
}

fn coordinate(i: usize, n: usize, length: f64) -> f64 {
    (i as f64 - (n / 2) as f64) * (length / n as f64)
}

fn wave_number(k: usize, n: usize, length: f64) -> f64 {
    let k = if k > n / 2 { k as f64 - n as f64 } else { k as f64 };
    TAU / length * k
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wave_numbers_mirror_and_the_nyquist_line_is_positive() {
        let grid = Grid::new((6, 5), (1.0, 2.0)).unwrap();
        let x: Vec<_> = (0..6).map(|k| (grid.wave_number_x(k) / TAU).round()).collect();
        assert_eq!(x, [0.0, 1.0, 2.0, 3.0, -2.0, -1.0]);
        let y: Vec<_> = (0..5).map(|k| (grid.wave_number_y(k) * 2.0 / TAU).round()).collect();
        assert_eq!(y, [0.0, 1.0, 2.0, -2.0, -1.0]);
    }

    #[test]
    fn bad_grids_are_refused_by_name() {
        for (shape, lengths, text) in [
            ((0, 4), (1.0, 1.0), "Nx is 0"),
            ((4, 0), (1.0, 1.0), "Ny is 0"),
            ((4, 4), (f64::NAN, 1.0), "Lx is NaN"),
            ((4, 4), (1.0, f64::INFINITY), "Ly is inf"),
            ((4, 4), (0.0, 1.0), "Lx is 0"),
        ] {
            let message = Grid::new(shape, lengths).unwrap_err().to_string();
            assert!(message.contains(text), "{message}");
        }
    }
}
