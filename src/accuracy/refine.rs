use ndarray::{Axis, Slice};

use crate::error::Result;
use crate::grid::Grid;
use crate::surface::{Surface, mirror, refine};

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
