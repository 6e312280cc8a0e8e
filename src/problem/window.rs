//! The window of a surface on the grid of an operator: where a surface faces the half-space, and where nothing does.

use std::ops::Range;

use ndarray::{Array2, ArrayView2, Axis, Slice};

use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::real::Real;
use crate::slab::Slab;
use crate::surface::Surface;

/// The window of a surface: the nodes of the operator's grid that face it. On all others there is neither wall nor law.
///
/// The surface is on the first nodes along both axes; some of these may be absent.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    /// the grid of the surface
    grid: Grid,
    /// of the operator's grid
    slab: Slab,
    /// the runs of nodes that face the surface, within a row each, in their order
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
    pub(super) fn new(surface: &Surface, slab: Slab) -> Option<Self> {
        let grid = *surface.grid();
        let ((nx, ny), shape) = (grid.shape(), slab.shape());
        if (nx, ny) == shape && surface.absent().is_none() {
            return None;
        }
        let rows = slab.rows();
        let faces = |i: usize, j: usize| surface.absent().is_none_or(|absent| !absent[[i, j]]);
        let mut runs: Vec<Run> = Vec::new();
        for i in rows.start..rows.end.min(nx) {
            let mut open = false;
            for j in 0..ny {
                let node = (i - rows.start) * shape.1 + j;
                match runs.last_mut() {
                    Some(run) if open && faces(i, j) => run.nodes.end = node + 1,
                    _ if faces(i, j) => runs.push(Run { nodes: node..node + 1, first: i * ny + j }),
                    _ => {}
                }
                open = faces(i, j);
            }
        }
        let facing = grid.total(runs.iter().map(|run| run.nodes.len()).sum());
        Some(Self { grid, slab, runs, facing })
    }

    /// The grid of the surface.
    pub(crate) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The number of nodes that face the surface.
    pub(crate) fn facing(&self) -> usize {
        self.facing
    }

    /// The pieces of some nodes of the operator's grid of which all face the surface, or none: their numbers of nodes,
    /// and the first of them on the surface's grid, if they face it.
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

    /// A field of the surface's grid on that of the operator: what is not finite, and the nodes beyond the window, are
    /// interpolated, linearly along the rows, and the rows that have nothing between the others; opposite sides meet.
    pub(crate) fn extend<T: Real>(&self, field: ArrayView2<'_, T>) -> Array2<T> {
        let ((nx, ny), shape) = (self.grid.shape(), self.slab.shape());
        if self.slab.is_shared() {
            return self.extend_shared(field);
        }
        let mut extended = Array2::from_elem(shape, T::nan());
        field.indexed_iter().for_each(|(node, &value)| extended[node] = value);
        let mut rows = Vec::new();
        for i in 0..nx {
            let known: Vec<usize> = (0..ny).filter(|&j| extended[[i, j]].is_finite()).collect();
            if !known.is_empty() {
                rows.push(i);
            }
            between(&known, shape.1, |j, a, b, share| {
                let (a, b) = (extended[[i, a]], extended[[i, b]]);
                extended[[i, j]] = a + T::lit(share) * (b - a);
            });
        }
        between(&rows, shape.0, |i, a, b, share| {
            for j in 0..shape.1 {
                let (a, b) = (extended[[a, j]], extended[[b, j]]);
                extended[[i, j]] = a + T::lit(share) * (b - a);
            }
        });
        extended
    }

    /// As [`extend`](Self::extend), of fields without absent nodes, the rows that this process holds.
    fn extend_shared<T: Real>(&self, field: ArrayView2<'_, T>) -> Array2<T> {
        let ((nx, ny), (whole, width)) = (self.grid.shape(), self.slab.shape());
        // of the surface the rows of the slab, and the last and the first one for those beyond
        let wanted = |rank: usize| {
            let Range { start, end } = self.slab.rows_of(rank);
            let first = start.min(nx - 1);
            (first, if start == end { 0 } else { end.min(nx).max(first + 1) - first + usize::from(end > nx) })
        };
        let (first, _) = wanted(self.slab.ranks().rank());
        let known = self.grid.slab().fetch(field.mapv(T::widen).view(), wanted).mapv(T::lit);
        let mut rows = Array2::zeros((known.nrows(), width));
        for (mut row, known) in rows.rows_mut().into_iter().zip(known.rows()) {
            row.iter_mut().zip(known).for_each(|(to, from)| *to = *from);
            for step in 1..=width - ny {
                let (a, b, share) = (known[ny - 1], known[0], step as f64 / (width - ny + 1) as f64);
                row[ny - 1 + step] = a + T::lit(share) * (b - a);
            }
        }
        let start = self.slab.rows().start;
        Array2::from_shape_fn(self.slab.held(), |(i, j)| {
            let i = start + i;
            if i < nx {
                return rows[[i - first, j]];
            }
            let (a, b) = (rows[[nx - 1 - first, j]], rows[[nx - first, j]]);
            a + T::lit((i + 1 - nx) as f64 / (whole - nx + 1) as f64) * (b - a)
        })
    }

    /// A field of the operator's grid on that of the surface, with a value for the absent nodes.
    pub(crate) fn crop<T: Real>(&self, field: &Array2<T>, absent: T) -> Array2<T> {
        if self.slab.is_shared() {
            let surface = self.grid.slab();
            let wanted = |rank| (surface.rows_of(rank).start, surface.rows_of(rank).len());
            let rows = self.slab.fetch(field.mapv(T::widen).view(), wanted);
            return rows.slice_axis(Axis(1), Slice::from(0..self.grid.shape().1)).mapv(T::lit);
        }
        let mut cropped = Array2::from_elem(self.grid.shape(), absent);
        if let (Some(from), Some(to)) = (field.as_slice(), cropped.as_slice_mut()) {
            for Run { nodes, first } in &self.runs {
                to[*first..first + nodes.len()].copy_from_slice(&from[nodes.clone()]);
            }
        }
        cropped
    }

    /// A field of the surface's grid on that of the operator, with a value for the nodes that do not face it.
    pub(crate) fn place<T: Real>(&self, field: &Array2<T>, elsewhere: T) -> Array2<T> {
        let mut placed = Array2::from_elem(self.slab.shape(), elsewhere);
        if let (Some(from), Some(to)) = (field.as_slice(), placed.as_slice_mut()) {
            for Run { nodes, first } in &self.runs {
                to[nodes.clone()].copy_from_slice(&from[*first..first + nodes.len()]);
            }
        }
        placed
    }

    /// A gap of the surface's grid as one on that of the operator, whatever it has at absent nodes.
    pub(crate) fn start<T: Real>(&self, gap: ArrayView2<'_, T>) -> Result<Array2<T>> {
        let slab = self.grid.slab();
        Error::agreed(slab, Error::shape("starting gap", gap.dim(), slab.held()))?;
        if slab.is_shared() {
            Error::all_finite_in(slab, "starting gap", gap)?;
            return Ok(self.extend(gap));
        }
        let mut known = Array2::from_elem(gap.dim(), T::nan());
        let ny = gap.dim().1;
        for Run { nodes, first } in &self.runs {
            for node in *first..first + nodes.len() {
                let at = [node / ny, node % ny];
                known[at] = gap[at];
                if !gap[at].is_finite() {
                    return Err(Error::NotFinite {
                        name: "starting gap",
                        count: gap.iter().filter(|gap| !gap.is_finite()).count(),
                        nodes: gap.len(),
                        first: at.into(),
                        value: gap[at].widen(),
                    });
                }
            }
        }
        Ok(self.extend(known.view()))
    }
}

/// Calls `f(k, a, b, share)` for every index k of n that is not known: a and b are the known ones before and after it,
/// where the last is followed by the first, and `share` is how far it is from a to b.
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

    /// A window of 3 × 4 nodes on 6 × 8, of which two are absent.
    fn window() -> Window {
        let grid = Grid::new((3, 4), (3.0, 4.0)).unwrap();
        let mut heights = Array2::zeros((3, 4));
        (heights[[0, 1]], heights[[2, 0]]) = (f64::NAN, f64::NAN);
        Window::new(&Surface::with_absent(grid, heights).unwrap(), Slab::whole((6, 8))).unwrap()
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
        assert!(matches!(window.start(field.view()), Err(Error::NotFinite { first: (1, 2), .. })));
    }
}
