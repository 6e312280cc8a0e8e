//! The part of a window that holds the contact, which is solved before the whole.

use std::ops::Range;

use ndarray::{Array2, ArrayRef2, ArrayView1, ArrayViewMut1, Axis, Slice, Zip};

use crate::adhesion::{AdhesionLaw, SharedLaw};
use crate::constraint::ContactConstraint;
use crate::degrees::HALF;
use crate::elastic::{ElasticOperator, OnGrids};
use crate::error::Result;
use crate::grid::Grid;
use crate::problem::{Control, Problem, ProblemMut};
use crate::real::Real;
use crate::solver::{Begin, Observer, Solution, Solved, Solver, Start, Status};
use crate::surface::Surface;

/// The adhesive traction below which a node need not be in the part, as a share of w/ρ.
const REACH: f64 = 1e-6;

/// The margin about the contact: a share of its extent, and so many nodes at least.
const MARGIN: (f64, usize) = (0.25, 8);

/// A rectangle of nodes about the contact on a free half-space's window, of the same compliance if nothing else
/// presses.
#[derive(Clone, Debug, PartialEq)]
struct Part {
    x: Range<usize>,
    y: Range<usize>,
}

impl Part {
    /// The part about the contact, if it has at most half of the window's nodes, in a gap on the window or a larger grid.
    fn of<T: Real>(window: (usize, usize), grid: &Grid, gap: &ArrayRef2<T>, law: &dyn AdhesionLaw<T>) -> Option<Self> {
        let hints = law.hints();
        let least = T::lit(REACH) * hints.work_of_adhesion / hints.range;
        let attracts = |gap: T| !hints.zero && (law.traction(gap) > least || !least.is_finite());
        let (mut x, mut y) = (window.0..0, window.1..0);
        for (i, row) in grid.rows().zip(gap.rows()).filter(|(i, _)| *i < window.0) {
            for (j, &gap) in row.iter().take(window.1).enumerate() {
                if gap <= T::zero() || attracts(gap) {
                    (x, y) = (x.start.min(i)..x.end.max(i + 1), y.start.min(j)..y.end.max(j + 1));
                }
            }
        }
        let of_all = |side: Range<usize>| {
            let (starts, ends) = (grid.each(side.start), grid.each(side.end));
            starts.into_iter().min().unwrap_or_default()..ends.into_iter().max().unwrap_or_default()
        };
        let (x, y) = (of_all(x), of_all(y));
        let widened = |side: Range<usize>, nodes: usize| {
            let margin = ((MARGIN.0 * side.len() as f64) as usize).max(MARGIN.1);
            side.start.saturating_sub(margin)..(side.end + margin).min(nodes)
        };
        if x.is_empty() {
            return None;
        }
        let part = Self { x: widened(x, window.0), y: widened(y, window.1) };
        let nodes = (part.x.len() * part.y.len()) as f64;
        (nodes <= HALF * (window.0 * window.1) as f64).then_some(part)
    }

    fn cut<T: Real>(&self, field: &ArrayRef2<T>, from: &Grid, to: &Grid) -> Array2<T> {
        let rows = from.rows_for(field.view(), to, |row| [self.x.start + row]);
        let mut cut = Array2::zeros(to.field_shape());
        for (row, mut cut) in to.rows().zip(cut.rows_mut()) {
            cut.assign(&rows.row(self.x.start + row).slice_axis_move(Axis(0), Slice::from(self.y.clone())));
        }
        cut
    }

    /// Calls `f` with the rows of a field that are in the part, and the rows of a field of the part.
    fn meet<T: Real>(
        &self,
        (whole, to): (&mut Array2<T>, &Grid),
        (field, from): (&Array2<T>, &Grid),
        f: impl Fn(ArrayViewMut1<'_, T>, ArrayView1<'_, T>),
    ) {
        let of = |row: usize| self.x.contains(&row).then(|| row - self.x.start);
        let rows = from.rows_for(field, to, of);
        for (row, mut whole) in to.rows().zip(whole.rows_mut()) {
            if let Some(own) = of(row) {
                f(whole.slice_axis_mut(Axis(0), Slice::from(self.y.clone())), rows.row(own));
            }
        }
    }

    fn surface(&self, surface: &Surface) -> Result<Surface> {
        let (dx, dy) = surface.grid().spacing();
        let lengths = (self.x.len() as f64 * dx, self.y.len() as f64 * dy);
        let shape = (self.x.len(), self.y.len());
        let grid = surface.grid().sibling(shape, lengths)?;
        Surface::new(grid, self.cut(surface.heights(), surface.grid(), &grid))
    }

    /// The control of the part: its highest node may be lower than the highest node of the whole.
    fn control(control: Control, whole: &Surface, part: &Surface) -> Control {
        let highest = |surface: &Surface| {
            let own = surface.heights().iter().fold(f64::NEG_INFINITY, |high, &h| high.max(h));
            surface.grid().greatest(own)
        };
        control.on_part(whole.grid().lengths(), highest(whole) - highest(part))
    }
}

pub(super) struct OnPart<T: Real> {
    part: Part,
    solution: Solution<T>,
    /// the operator applications, in units of one on the whole
    pub(super) applications: usize,
}

impl<T: Real> OnPart<T> {
    /// Whether the solution leads to the solution of the whole: contact at the end of the part may continue beyond it,
    /// and a stalled solve may lead to another equilibrium, if there are several.
    pub(super) fn leads(&self, unique: bool) -> bool {
        let report = &self.solution.report;
        let found = report.status == Status::Converged || (unique && report.status == Status::Stalled);
        found && !report.reaches_edge
    }

    /// The gap of the whole under the pressure of the part, not negative on the window. Takes an operator application.
    pub(super) fn whole(self, problem: ProblemMut<'_, T>) -> Result<Array2<T>> {
        let Self { part, solution: Solution { gap, pressure, grid, .. }, .. } = self;
        let (window, to) = (problem.grid().shape(), *problem.operator.grid());
        // displacement less heights: K (p − K⁻¹h), and a constant
        let mut load = problem.flat.pressure.mapv(|p| -p);
        part.meet((&mut load, &to), (&pressure, &grid), |load, p| {
            Zip::from(load).and(p).for_each(|load, &p| *load += p)
        });
        let mut whole = Array2::zeros(load.dim());
        problem.operator.displacement(load.view(), whole.view_mut())?;
        let found = part.cut(&whole, &to, &grid);
        let shift = grid.mean_of_both(gap.view(), found.view(), |gap, u| gap.widen() - u.widen());
        whole.mapv_inplace(|gap| gap + T::lit(shift));
        for (_, mut row) in to.rows().zip(whole.rows_mut()).filter(|(row, _)| *row < window.0) {
            row.slice_axis_mut(Axis(0), Slice::from(..window.1)).mapv_inplace(|gap| gap.max(T::zero()));
        }
        part.meet((&mut whole, &to), (&gap, &grid), |mut whole, gap| whole.assign(&gap));
        Ok(whole)
    }
}

/// The solution on a small part of a free half-space's window, if it has all contact of a prolonged gap.
pub(super) fn solve_part<T: Real>(
    solver: &mut Solver<dyn ContactConstraint<T>>,
    surface: &Surface,
    (half_space, operators): (&mut dyn ElasticOperator<T>, &mut dyn OnGrids<T>),
    law: &SharedLaw<T>,
    control: Control,
    gap: &Array2<T>,
    observe: Observer<'_>,
) -> Result<Option<OnPart<T>>> {
    let whole = *half_space.grid();
    let fits = !half_space.boundary().is_periodic()
        && surface.absent().is_none()
        && law.hints().shape.is_none()
        && solver.constraint.wall().hardness().is_none_or(|hardness| !hardness.varies());
    let part = if fits { Part::of(surface.grid().shape(), &whole, gap, &**law) } else { None };
    let Some(part) = part else { return Ok(None) };
    let small = part.surface(surface)?;
    let mut problem = Problem::of(&small, operators.on(*small.grid())?, law.clone())?;
    let share = problem.operator.grid().nodes() as f64 / half_space.grid().nodes() as f64;
    let tolerance = HALF * solver.settings.tolerance_in::<T>();
    let start = Begin::At(Start::Near(part.cut(gap, &whole, small.grid())));
    let control = Part::control(control, surface, &small);
    let Solved { solution, .. } =
        solver.to(tolerance, |solver| solver.run(problem.parts(), control, start, observe))?;
    let applications = (share * (solution.report.operator_applications + 1) as f64).ceil() as usize;
    Ok(Some(OnPart { part, solution, applications }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adhesion::{Exponential, NoAdhesion};

    fn of(window: (usize, usize), gap: &Array2<f64>, law: &dyn AdhesionLaw<f64>) -> Option<Part> {
        Part::of(window, &Grid::new(gap.dim(), (1.0, 1.0)).unwrap(), gap, law)
    }

    #[test]
    fn a_part_has_all_that_touches_or_attracts_and_a_margin() {
        let gap = Array2::from_shape_fn((200, 100), |(i, j)| {
            let apart = i.abs_diff(60).saturating_sub(20).max(j.abs_diff(30).saturating_sub(4));
            if i < 100 && j < 80 { apart as f64 } else { 0.0 }
        });
        let part = of((100, 80), &gap, &NoAdhesion).unwrap();
        assert_eq!(part, Part { x: 30..91, y: 18..43 });
        // the traction of an exponential law falls to a millionth of w/ρ at 13.8ρ, a gap of 6
        let part = of((100, 80), &gap, &Exponential::new(1.0, 0.5).unwrap()).unwrap();
        assert_eq!(part, Part { x: 21..100, y: 12..49 });
        // more than half of the window, or nothing
        assert_eq!(of((100, 50), &gap, &NoAdhesion), Some(Part { x: 30..91, y: 18..43 }));
        assert_eq!(of((60, 50), &gap, &Exponential::new(1.0, 2.0).unwrap()), None);
        assert_eq!(of((10, 10), &gap, &NoAdhesion), None);
    }
}
