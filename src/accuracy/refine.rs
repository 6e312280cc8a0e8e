use ndarray::{Axis, Slice};

use super::fitted::INTERPOLATION;
use crate::degrees::PARTLY;
use crate::error::Result;
use crate::field::ordered;
use crate::grid::Grid;
use crate::nested::Level;
use crate::solver::Status;
use crate::surface::{Surface, mirror, refine};
use crate::vector::range;

/// The surface on twice as many nodes along its sides, by Fourier interpolation; unless periodic, mirrored.
pub(super) fn refined(surface: &Surface, periodic: bool) -> Result<Surface> {
    let shape = twice(surface.grid().shape());
    let fine = if periodic {
        refine(surface.heights().clone(), shape)?
    } else {
        let mirrored = mirror(surface.heights());
        let whole = twice(mirrored.dim());
        let mut fine = refine(mirrored, whole)?;
        fine.slice_axis_inplace(Axis(0), Slice::from(..shape.0));
        fine.slice_axis_inplace(Axis(1), Slice::from(..shape.1));
        fine
    };
    Surface::new(Grid::new(shape, surface.grid().lengths())?, fine)
}

/// Whether interpolated heights exceed the heights of a surface, as they do next to steps.
pub(super) fn overshoots(fine: &Surface, surface: &Surface) -> bool {
    let [(_, fine), (low, high)] = [fine, surface].map(|surface| range(&ordered(surface.heights().view())));
    fine - high > PARTLY * (high - low)
}

/// Whether the contact on a refined grid is of the interpolation and not of the given surface.
pub(super) fn is_of_interpolation(fine: &Level, given: &Level) -> bool {
    let ratio = given.area.corrected_contact_fraction / fine.area.corrected_contact_fraction;
    let most = INTERPOLATION.ratio.max(1.0 + INTERPOLATION.scatter / (given.area.contact_nodes as f64).sqrt());
    fine.status == Status::Converged && ratio > most
}

/// Twice as many nodes along both sides, or along the only one.
pub(super) fn twice((nx, ny): (usize, usize)) -> (usize, usize) {
    let twice = |n: usize| if n == 1 { 1 } else { 2 * n };
    (twice(nx), twice(ny))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elastic::Boundary;

    #[test]
    fn old_nodes_keep_their_heights() {
        let grid = Grid::new((12, 8), (3.0, 2.0)).unwrap();
        let surface = Surface::from_fn(grid, |x, y| (1.7 * x + 0.3 * y * y).sin()).unwrap();
        for periodic in [true, false] {
            let fine = refined(&surface, periodic).unwrap();
            assert_eq!((fine.grid().shape(), fine.grid().lengths()), ((24, 16), (3.0, 2.0)));
            for ((i, j), h) in surface.heights().indexed_iter() {
                assert!((fine.heights()[[2 * i, 2 * j]] - h).abs() < 1e-14, "{periodic}");
            }
        }
        assert_eq!(twice((7, 1)), (14, 1));
    }

    #[test]
    fn a_wave_has_the_nodes_of_its_length() {
        let grid = Grid::square(64, 1.0).unwrap();
        let wave = Surface::wave_2d(grid, 0.02, 4).unwrap();
        assert_eq!(wave.nodes_per_wave(Boundary::Periodic), 16.0);
        assert_eq!(refined(&wave, true).unwrap().nodes_per_wave(Boundary::Periodic), 32.0);
    }
}
