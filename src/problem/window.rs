//! The window of a surface on the grid of an operator.

use std::ops::Range;

use ndarray::{Array2, ArrayRef2, ArrayView2, CowArray, Ix2, Zip};

use crate::error::Result;
use crate::field::{Field, ordered};
use crate::grid::Grid;
use crate::ranks::Sent;
use crate::real::Real;
use crate::surface::Surface;

/// The nodes of the operator's grid that face a surface; the others have neither wall nor law. The surface is on the
/// first nodes along both axes; some of these may be absent. Work at the nodes of the surface is done in the rows of the
/// operator's grid, `held`.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    grid: Grid,
    /// the grid of the surface in the rows of the operator's grid
    held: Grid,
    /// the grid of the operator
    whole: Grid,
    /// the runs of nodes that face the surface, each within a row
    runs: Vec<Run>,
    /// the number of these nodes
    facing: usize,
}

/// Consecutive nodes of the operator's grid that face the surface.
#[derive(Clone, Debug)]
struct Run {
    nodes: Range<usize>,
    /// the first of them on the surface's grid
    first: usize,
}

impl Window {
    /// The window of a surface; none if every node of the operator's grid faces it.
    pub(crate) fn new(surface: &Surface, operator: &Grid) -> Option<Self> {
        let grid = *surface.grid();
        let (ny, width) = (grid.shape().1, operator.shape().1);
        if grid.shape() == operator.shape() && surface.absent().is_none() {
            return None;
        }
        let held = grid.held_by(operator);
        let absent = surface.absent().map(|absent| grid.moved(absent, &held));
        let first = held.rows().start;
        let faces = |i: usize, j: usize| absent.as_ref().is_none_or(|absent| !absent[[i - first, j]]);
        let mut runs: Vec<Run> = Vec::new();
        for i in held.rows() {
            let mut open = false;
            for j in 0..ny {
                let node = i * width + j;
                match runs.last_mut() {
                    Some(run) if open && faces(i, j) => run.nodes.end = node + 1,
                    _ if faces(i, j) => runs.push(Run { nodes: node..node + 1, first: i * ny + j }),
                    _ => {}
                }
                open = faces(i, j);
            }
        }
        let facing = grid.sum(runs.iter().map(|run| run.nodes.len()).sum());
        Some(Self { grid, held, whole: *operator, runs, facing })
    }

    pub(crate) fn grid(&self) -> &Grid {
        &self.grid
    }

    pub(crate) fn held(&self) -> &Grid {
        &self.held
    }

    pub(crate) fn facing(&self) -> usize {
        self.facing
    }

    /// The pieces of some nodes that all face the surface or all do not: their lengths, and places on the surface.
    pub(crate) fn pieces(&self, nodes: Range<usize>) -> impl Iterator<Item = (usize, Option<usize>)> {
        let mut runs = self.runs[self.runs.partition_point(|run| run.nodes.end <= nodes.start)..].iter().peekable();
        let mut at = nodes.start;
        std::iter::from_fn(move || {
            if at >= nodes.end {
                return None;
            }
            let (end, first) = match runs.peek() {
                Some(run) if run.nodes.start <= at => (run.nodes.end, Some(run.first + (at - run.nodes.start))),
                Some(run) => (run.nodes.start, None),
                None => (nodes.end, None),
            };
            if first.is_some() && end <= nodes.end {
                runs.next();
            }
            let len = end.min(nodes.end) - at;
            at += len;
            Some((len, first))
        })
    }

    /// Whether a node of the operator's grid faces the surface.
    pub(crate) fn faces(&self, node: usize) -> bool {
        self.runs
            .get(self.runs.partition_point(|run| run.nodes.end <= node))
            .is_some_and(|run| run.nodes.contains(&node))
    }

    /// A field of the surface's grid in the rows of the operator's grid.
    pub(crate) fn hold<'a, A: Sent>(&self, field: impl Into<CowArray<'a, A, Ix2>>) -> CowArray<'a, A, Ix2> {
        self.grid.moved(field, &self.held)
    }

    /// A field of the surface's grid, extended to the operator's grid: values not finite or beyond the window are
    /// interpolated, linearly along the rows, then between rows; opposite sides meet.
    pub(crate) fn extend<T: Real>(&self, field: ArrayView2<'_, T>) -> Array2<T> {
        self.extended(self.hold(field).view())
    }

    fn extended<T: Real>(&self, field: ArrayView2<'_, T>) -> Array2<T> {
        let (nx, width) = self.whole.shape();
        let mut held = Array2::from_elem((field.nrows(), width), T::nan());
        let mut known = vec![false; field.nrows()];
        for ((field, mut row), is_known) in field.rows().into_iter().zip(held.rows_mut()).zip(&mut known) {
            row.iter_mut().zip(field).for_each(|(to, &from)| *to = from);
            let known: Vec<usize> = (0..field.len()).filter(|&j| field[j].is_finite()).collect();
            *is_known = !known.is_empty();
            between(&known, width, |j, a, b, share| row[j] = row[a] + T::lit(share) * (row[b] - row[a]));
        }
        let known = self.held.lists(known);
        let known: Vec<usize> = (0..known.len()).filter(|&i| known[i]).collect();
        let mut sources: Vec<_> = (0..nx).map(|i| (i, i, 0.0)).collect();
        between(&known, nx, |i, a, b, share| sources[i] = (a, b, share));
        let rows = self.held.rows_for(held, &self.whole, |i| [sources[i].0, sources[i].1]);
        let mut extended = Array2::zeros(self.whole.field_shape());
        for (row, &(a, b, share)) in extended.rows_mut().into_iter().zip(&sources[self.whole.rows()]) {
            Zip::from(row).and(rows.row(a)).and(rows.row(b)).for_each(|to, &at_a, &at_b| {
                *to = if a == b { at_a } else { at_a + T::lit(share) * (at_b - at_a) };
            });
        }
        extended
    }

    /// A field of the operator's grid, cropped to the surface's grid.
    pub(crate) fn crop<T: Real>(&self, field: &ArrayRef2<T>, absent: T) -> Array2<T> {
        self.held.moved(self.cut(field, absent).into_array(), &self.grid).into_owned()
    }

    pub(crate) fn cut<A: Copy + Default + 'static>(&self, field: &ArrayRef2<A>, absent: A) -> Field<A> {
        let mut cut = Field::filled(self.held.field_shape(), absent);
        let field = ordered(field.view());
        for (nodes, own) in self.places() {
            cut.nodes_mut()[own].copy_from_slice(&field[nodes]);
        }
        cut
    }

    /// A field of the surface's grid, in the rows of the operator's grid, on the operator's grid.
    pub(crate) fn place<A: Copy + Default + 'static>(&self, field: &Field<A>, elsewhere: A) -> Field<A> {
        let mut placed = Field::filled(self.whole.field_shape(), elsewhere);
        for (nodes, own) in self.places() {
            placed.nodes_mut()[nodes].copy_from_slice(&field.nodes()[own]);
        }
        placed
    }

    /// A field of the surface's grid in its own rows, from the rows of the operator's grid.
    pub(crate) fn release<A: Sent>(&self, held: Field<A>) -> Field<A> {
        Field::of(self.held.moved(held.into_array(), &self.grid))
    }

    /// The places of the runs on the operator's grid and on the surface's.
    pub(crate) fn places(&self) -> impl Iterator<Item = (Range<usize>, Range<usize>)> {
        let [start, first] = [&self.whole, &self.held].map(Grid::first_node);
        self.runs.iter().map(move |run| {
            let own = run.first - first;
            (run.nodes.start - start..run.nodes.end - start, own..own + run.nodes.len())
        })
    }

    pub(crate) fn start<T: Real>(&self, gap: ArrayView2<'_, T>) -> Result<Array2<T>> {
        self.grid.fits("starting gap", gap.dim())?;
        let gap = self.hold(gap);
        let gap = ordered(gap.view());
        // with one value at absent nodes, then another
        let facing = |elsewhere: T| {
            let mut facing = Field::filled(self.held.field_shape(), elsewhere);
            self.places().for_each(|(_, own)| facing.nodes_mut()[own.clone()].copy_from_slice(&gap[own]));
            facing
        };
        self.held.finite("starting gap", facing(T::zero()).view())?;
        Ok(self.extended(facing(T::nan()).view()))
    }
}

/// Calls `f(k, a, b, share)` for each unknown k of n: `share` of the way from a to b, the known ones about it,
/// cyclically.
fn between(known: &[usize], n: usize, mut f: impl FnMut(usize, usize, usize, f64)) {
    for (k, &a) in known.iter().enumerate() {
        let b = known[(k + 1) % known.len()];
        let distance = if b > a { b - a } else { b + n - a };
        for step in 1..distance {
            f((a + step) % n, a, b, step as f64 / distance as f64);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A window of 3 × 4 nodes on 6 × 8, two of them absent.
    fn window() -> Window {
        let grid = Grid::new((3, 4), (3.0, 4.0)).unwrap();
        let absent = Array2::from_shape_fn((3, 4), |node| node == (0, 1) || node == (2, 0));
        let surface =
            Surface::new(grid, Array2::zeros((3, 4))).and_then(|surface| surface.with_absent(absent)).unwrap();
        Window::new(&surface, &Grid::new((6, 8), (1.0, 1.0)).unwrap()).unwrap()
    }

    #[test]
    fn pieces_are_all_nodes_in_their_order() {
        let window = window();
        let faces = |node: usize| node / 8 < 3 && node % 8 < 4 && ![1, 16].contains(&node);
        assert_eq!(window.facing(), 10);
        for (start, end) in (0..48).flat_map(|start| (start..=48).map(move |end| (start, end))) {
            let mut node = start;
            for (len, first) in window.pieces(start..end) {
                assert!(len > 0);
                for k in 0..len {
                    assert_eq!(first.map(|first| first + k), faces(node).then(|| node / 8 * 4 + node % 8));
                    assert_eq!(window.faces(node), faces(node));
                    node += 1;
                }
            }
            assert_eq!(node, end);
        }
    }

    #[test]
    fn an_extended_field_is_continuous_and_comes_back() {
        let window = window();
        let mut field = Array2::from_shape_fn((3, 4), |(i, j)| (2 * i + j) as f64);
        (field[[0, 1]], field[[2, 0]]) = (f64::NAN, f64::INFINITY);
        let extended = window.extend(field.view());
        assert_eq!(extended[[0, 1]], 1.0);
        // from 3 to 0 in five steps, and from 7 to 5 in six
        assert!((extended[[0, 6]] - 1.2).abs() < 1e-15 && (extended[[2, 7]] - (7.0 - 8.0 / 6.0)).abs() < 1e-15);
        assert!(extended.iter().all(|x| (0.0..=7.0).contains(x)));
        let cropped = window.crop(&extended, -1.0);
        (field[[0, 1]], field[[2, 0]]) = (-1.0, -1.0);
        assert_eq!(cropped, field);
        field[[1, 2]] = f64::NAN;
        assert!(matches!(window.start(field.view()), Err(crate::Error::NotFinite { first: (1, 2), .. })));
    }
}
