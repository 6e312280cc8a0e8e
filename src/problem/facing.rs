//! What faces the surface: all nodes of the operator's grid, or the nodes of a window.

use ndarray::{Array2, CowArray, Ix2};

use super::{PressedFlat, Window};
use crate::error::Result;
use crate::field::Field;
use crate::grid::Grid;
use crate::ranks::Sent;
use crate::real::Real;

impl<T: Real> PressedFlat<T> {
    /// Whether all nodes of the operator's grid face the surface.
    pub(crate) fn faces_all(&self) -> bool {
        self.window.is_none()
    }

    /// Whether a node of the operator's grid faces the surface.
    pub(crate) fn faces(&self, node: usize) -> bool {
        self.window.as_ref().is_none_or(|window| window.faces(node))
    }

    /// The number of nodes that face the surface; the operator's grid has `nodes`.
    pub(crate) fn facing(&self, nodes: usize) -> usize {
        self.window.as_ref().map_or(nodes, Window::facing)
    }

    /// The grid of the surface; the operator's grid is the `whole`.
    pub(crate) fn grid<'a>(&'a self, whole: &'a Grid) -> &'a Grid {
        self.window.as_ref().map_or(whole, Window::grid)
    }

    /// The grid of the surface in the rows of the operator's grid, the `whole`.
    pub(crate) fn held<'a>(&'a self, whole: &'a Grid) -> &'a Grid {
        self.window.as_ref().map_or(whole, Window::held)
    }

    /// A field of the surface's grid in the rows of the operator's grid.
    pub(crate) fn hold<'a, A: Sent>(&self, field: impl Into<CowArray<'a, A, Ix2>>) -> CowArray<'a, A, Ix2> {
        let field = field.into();
        match &self.window {
            Some(window) => window.hold(field),
            None => field,
        }
    }

    /// A field of the surface's grid, in the rows of the operator's grid, on the operator's grid.
    pub(crate) fn place<A: Copy + Default + 'static>(&self, field: Field<A>, elsewhere: A) -> Field<A> {
        match &self.window {
            Some(window) => window.place(&field, elsewhere),
            None => field,
        }
    }

    /// A field of the surface's grid, continued over the operator's grid.
    pub(crate) fn extend<'a>(&self, field: impl Into<CowArray<'a, T, Ix2>>) -> Field<T> {
        let field = field.into();
        match &self.window {
            Some(window) => Field::of(window.extend(field.view())),
            None => Field::of(field),
        }
    }

    /// A starting gap of the surface's grid, continued over the operator's grid.
    pub(crate) fn start<'a>(&self, gap: CowArray<'a, T, Ix2>) -> Result<CowArray<'a, T, Ix2>> {
        match &self.window {
            Some(window) => Ok(window.start(gap.view())?.into()),
            None => Ok(gap),
        }
    }

    /// A field of the operator's grid on the surface's grid, in the rows of the operator's.
    pub(crate) fn cut<A: Copy + Default + 'static>(&self, field: &Array2<A>, absent: A) -> Field<A> {
        match &self.window {
            Some(window) => window.cut(field, absent),
            None => Field::of(field),
        }
    }

    /// A field of the operator's grid on the surface's grid.
    pub(crate) fn crop<'a>(&self, field: impl Into<CowArray<'a, T, Ix2>>, absent: T) -> CowArray<'a, T, Ix2> {
        let field = field.into();
        match &self.window {
            Some(window) => window.crop(&field, absent).into(),
            None => field,
        }
    }

    /// A field of the surface's grid in its own rows, from the rows of the operator's grid.
    pub(crate) fn release<A: Sent>(&self, held: Field<A>) -> Field<A> {
        match &self.window {
            Some(window) => window.release(held),
            None => held,
        }
    }
}
