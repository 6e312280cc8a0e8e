//! The coarser grids of a surface.

use super::transfer::coarsen;
use crate::error::Result;
use crate::surface::Surface;

/// The shape of the next coarser grid, if it has `coarsest` nodes along its sides; without `odd` only of even sizes.
pub(super) fn coarser((nx, ny): (usize, usize), coarsest: usize, odd: bool) -> Option<(usize, usize)> {
    let half = |n: usize| match n {
        1 => Some(1),
        n => Some(n.div_ceil(2)).filter(|&half| (odd || n.is_multiple_of(2)) && half >= coarsest.max(4)),
    };
    Some((half(nx)?, half(ny)?)).filter(|&coarse| coarse != (nx, ny))
}

/// The surface on all coarser grids, the coarsest last.
pub(crate) fn coarsened(surface: &Surface, coarsest: usize, odd: bool) -> Result<Vec<Surface>> {
    let odd = odd && surface.absent().is_none();
    let mut surfaces: Vec<Surface> = Vec::new();
    loop {
        let finer = surfaces.last().unwrap_or(surface);
        let Some(shape) = coarser(finer.grid().shape(), coarsest, odd) else { break };
        let Some(coarse) = coarsen(finer, shape)? else { break };
        surfaces.push(coarse);
    }
    Ok(surfaces)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shapes of the coarser grids.
    fn shapes(mut shape: (usize, usize), odd: bool) -> Vec<(usize, usize)> {
        std::iter::from_fn(|| coarser(shape, 64, odd).inspect(|&next| shape = next)).collect()
    }

    #[test]
    fn sizes_are_halved() {
        let squares = |n| shapes((n, n), false).len();
        assert_eq!([64, 96, 127, 128, 192, 256, 1023, 1024, 1536].map(squares), [0, 0, 0, 1, 1, 2, 0, 4, 4]);
        assert_eq!(shapes((512, 1), false), [(256, 1), (128, 1), (64, 1)]);
        assert_eq!(shapes((1, 512), false), [(1, 256), (1, 128), (1, 64)]);
        assert_eq!(shapes((1, 1), true), []);
        assert_eq!(shapes((512, 192), false), [(256, 96)]);
        assert_eq!(shapes((512, 95), false), []);
        assert_eq!(shapes((650, 480), true), [(325, 240), (163, 120)]);
        assert_eq!(shapes((1023, 1), true), [(512, 1), (256, 1), (128, 1), (64, 1)]);
    }
}
