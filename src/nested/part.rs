//! The part of a window that holds the contact, which is solved before the whole.

use std::ops::Range;

use ndarray::{Array2, ArrayRef2, ArrayView2, ArrayViewMut2, Slice};

use crate::adhesion::AdhesionLaw;
use crate::elastic::ElasticOperator;
use crate::error::Result;
use crate::grid::Grid;
use crate::problem::{Control, Problem};
use crate::real::Real;
use crate::surface::Surface;

/// The largest share of the window's nodes of a part that is worth a solve of its own.
const SMALL: f64 = 0.5;

/// The adhesive traction below which a node need not be in the part, as a share of w/ρ.
const REACH: f64 = 1e-6;

/// The margin about the contact: a share of its extent, and so many nodes at least.
const MARGIN: (f64, usize) = (0.25, 8);

/// A rectangle of nodes of a window on a free half-space, about the contact and what attracts.
///
/// Where nothing presses, the half-space beyond the part is as if it were absent: the compliance between nodes of the
/// part is that of the whole window.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Part {
    x: Range<usize>,
    y: Range<usize>,
}

impl Part {
    /// The part about the contact in a gap on the window or on a larger grid, if it is a small one.
    pub(super) fn of<T: Real>(window: (usize, usize), gap: &ArrayRef2<T>, law: &dyn AdhesionLaw<T>) -> Option<Self> {
        let least = T::lit(REACH) * law.work_of_adhesion() / law.range();
        let attracts = |gap: T| !law.is_zero() && (law.traction(gap) > least || !least.is_finite());
        let (mut x, mut y) = (window.0..0, window.1..0);
        for ((i, j), &gap) in Self::all(window).cut(gap).indexed_iter() {
            if gap <= T::zero() || attracts(gap) {
                (x, y) = (x.start.min(i)..x.end.max(i + 1), y.start.min(j)..y.end.max(j + 1));
            }
        }
        let widened = |side: Range<usize>, nodes: usize| {
            let margin = ((MARGIN.0 * side.len() as f64) as usize).max(MARGIN.1);
            side.start.saturating_sub(margin)..(side.end + margin).min(nodes)
        };
        if x.is_empty() {
            return None;
        }
        let part = Self { x: widened(x, window.0), y: widened(y, window.1) };
        let nodes = (part.x.len() * part.y.len()) as f64;
        (nodes <= SMALL * (window.0 * window.1) as f64).then_some(part)
    }

    /// The whole window.
    fn all(window: (usize, usize)) -> Self {
        Self { x: 0..window.0, y: 0..window.1 }
    }

    /// The part of a field.
    pub(super) fn cut<'a, T>(&self, field: &'a ArrayRef2<T>) -> ArrayView2<'a, T> {
        field.slice_each_axis(|axis| self.side(axis.axis.index()))
    }

    fn cut_mut<'a, T>(&self, field: &'a mut ArrayRef2<T>) -> ArrayViewMut2<'a, T> {
        field.slice_each_axis_mut(|axis| self.side(axis.axis.index()))
    }

    fn side(&self, axis: usize) -> Slice {
        Slice::from(if axis == 0 { self.x.clone() } else { self.y.clone() })
    }

    /// The part of a surface.
    pub(super) fn surface(&self, surface: &Surface) -> Result<Surface> {
        let (dx, dy) = surface.grid().spacing();
        let grid = Grid::new((self.x.len(), self.y.len()), (self.x.len() as f64 * dx, self.y.len() as f64 * dy))?;
        Surface::new(grid, self.cut(surface.heights()).to_owned())
    }

    /// The control of the part, whose highest node may be lower than that of the whole.
    pub(super) fn control(&self, control: Control, surface: &Surface) -> Control {
        let highest = |heights: ArrayView2<'_, f64>| heights.iter().fold(f64::NEG_INFINITY, |high, &h| high.max(h));
        let lower = highest(surface.heights().view()) - highest(self.cut(surface.heights()));
        let (lx, ly) = surface.grid().lengths();
        match control {
            Control::MeanPressure(pressure) => Control::Force(pressure * lx * ly),
            Control::Approach(approach) => Control::Approach(approach - lower),
            Control::Spring { stiffness, rest } => Control::Spring { stiffness, rest: rest - lower },
            control => control,
        }
    }

    /// The gap of the whole, on the grid of its operator, under the pressure found on the part: with the gap found
    /// there, and none that is negative on the window. Takes an application of the operator.
    pub(super) fn whole<T, O, L>(
        &self,
        problem: &mut Problem<T, O, L>,
        (gap, pressure): (&ArrayRef2<T>, &ArrayRef2<T>),
    ) -> Result<Array2<T>>
    where
        T: Real,
        O: ElasticOperator<T>,
        L: AdhesionLaw<T>,
    {
        let window = problem.grid().shape();
        // the displacement less the heights is K (p − K⁻¹h) and a constant
        let mut load = problem.flat.pressure.mapv(|p| -p);
        self.cut_mut(&mut load).zip_mut_with(pressure, |load, &p| *load += p);
        let mut whole = Array2::zeros(load.dim());
        problem.operator.displacement(load.view(), whole.view_mut())?;
        let differences = gap.iter().zip(self.cut(&whole)).map(|(gap, u)| gap.widen() - u.widen());
        let shift = T::lit(differences.sum::<f64>() / gap.len() as f64);
        whole.mapv_inplace(|gap| gap + shift);
        Self::all(window).cut_mut(&mut whole).mapv_inplace(|gap| gap.max(T::zero()));
        self.cut_mut(&mut whole).assign(gap);
        Ok(whole)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adhesion::{Exponential, NoAdhesion};

    #[test]
    fn a_part_has_all_that_touches_or_attracts_and_a_margin() {
        let gap = Array2::from_shape_fn((200, 100), |(i, j)| {
            let apart = i.abs_diff(60).saturating_sub(20).max(j.abs_diff(30).saturating_sub(4));
            if i < 100 && j < 80 { apart as f64 } else { 0.0 }
        });
        let part = Part::of((100, 80), &gap, &NoAdhesion).unwrap();
        assert_eq!(part, Part { x: 30..91, y: 18..43 });
        // to a gap of 6, as the traction of an exponential law falls to a millionth of w/ρ at 13.8ρ
        let part = Part::of((100, 80), &gap, &Exponential::new(1.0, 0.5).unwrap()).unwrap();
        assert_eq!(part, Part { x: 21..100, y: 12..49 });
        // more than half of the window, or nothing
        assert_eq!(Part::of((100, 50), &gap, &NoAdhesion), Some(Part { x: 30..91, y: 18..43 }));
        assert_eq!(Part::of((60, 50), &gap, &Exponential::new(1.0, 2.0).unwrap()), None);
        assert_eq!(Part::of((10, 10), &gap, &NoAdhesion), None);
    }
}
