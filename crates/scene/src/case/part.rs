//! The part of a map that results are of: the original of a mirrored one, or the whole.

use std::borrow::Cow;

use asperity::contact::Original;
use asperity::{Grid, Real, Result, Solution, elastic};
use ndarray::Array2;

use crate::outcome::Outcome;

/// The part of a map on its grid.
#[derive(Clone, Copy)]
pub struct Part {
    whole: Grid,
    is_mirrored: bool,
    is_whole: bool,
    /// The original, if the map was mirrored and this process has all of it
    original: Option<Original>,
}

impl Part {
    /// All of a map without mirror images.
    pub(crate) fn all(grid: Grid) -> Self {
        Self { whole: grid, is_mirrored: false, is_whole: true, original: None }
    }

    /// The original of a mirrored map, with its nodes, unless the whole is asked for.
    pub(super) fn new(original: Option<(usize, usize)>, grid: Grid, is_whole: bool) -> Outcome<Self> {
        let is_mirrored = original.is_some();
        if is_mirrored && !is_whole && grid.is_shared() {
            let text = "the original of a mirrored map has no form for several processes: give --whole for results on \
                        all nodes, or solve in one process";
            return Err(text.into());
        }
        let nodes = original.filter(|_| !grid.is_shared());
        let original = nodes.map(|nodes| Original::new(&grid, nodes)).transpose()?;
        Ok(Self { whole: grid, is_mirrored, is_whole, original })
    }

    /// The same part on another grid of the map.
    pub fn on(self, grid: Grid) -> Result<Self> {
        let original = self.original.map(|original| original.on(&grid)).transpose()?;
        Ok(Self { whole: grid, original, ..self })
    }

    /// The name in reports and tables; none where there is only one.
    pub fn name(&self) -> Option<&'static str> {
        self.is_mirrored.then_some(if self.is_whole { "whole" } else { "original" })
    }

    /// The original, if results are of it.
    pub fn wanted(&self) -> Option<Original> {
        self.original.filter(|_| !self.is_whole)
    }

    /// The grid of the results.
    pub fn grid(&self) -> Grid {
        self.wanted().map_or(self.whole, |original| *original.grid())
    }

    /// The nodes that are solved, if results are of fewer.
    pub fn solved(&self) -> Option<(usize, usize)> {
        self.wanted().map(|_| self.whole.shape())
    }

    /// Whether opposite sides of the part meet: sides of an original do not.
    pub fn sides_meet<T: Real>(&self, solution: &Solution<T>) -> bool {
        self.wanted().is_none() && solution.report.boundary == elastic::Boundary::Periodic
    }

    /// The solution on the part.
    pub fn of_solution<'a, T: Real>(&self, solution: &'a Solution<T>) -> Result<Cow<'a, Solution<T>>> {
        self.wanted().map_or(Ok(Cow::Borrowed(solution)), |original| Ok(Cow::Owned(original.of_solution(solution)?)))
    }

    /// A field on the part.
    pub fn of_field<A: Clone>(&self, field: Array2<A>) -> Result<Array2<A>> {
        match self.wanted() {
            Some(original) => original.crop(field.view()),
            None => Ok(field),
        }
    }

    /// A field of the shape of the map, from one that may be of the original alone.
    pub fn whole_of(&self, field: Array2<f64>) -> Result<Array2<f64>> {
        match self.original.filter(|original| field.dim() == original.grid().shape()) {
            Some(original) => original.mirrored(&field),
            None => Ok(field),
        }
    }
}
