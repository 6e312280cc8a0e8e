//! Heights without their short waves.

use std::f64::consts::TAU;

use ndarray::Array2;

use super::mean_of_finite;
use super::self_affine::SLACK;
use crate::error::{Error, Result};
use crate::fft::filtered;
use crate::field::all_finite;
use crate::grid::Grid;

/// Heights with side lengths `lengths` = (Lx, Ly) without the waves shorter than a `cut_off`, a wavelength in the unit
/// of the side lengths; waves of this length stay.
///
/// ```math
/// h(x) = Σ ĥ(q) exp(iq·x) ,   |q| ≤ 2π/λ_c
/// ```
///
/// over the waves of the grid. The other waves stay as they are, and the mean height does. Heights are taken as
/// periodic: edges that do not meet ring.
///
/// ```
/// use asperity::surface::low_pass;
/// use asperity::{Grid, Surface};
/// let grid = Grid::square(64, 1.0)?;
/// let long = Surface::wave(grid, 0.1, 4)?; // of length 1/4
/// let both = long.heights() + Surface::wave(grid, 0.02, 20)?.heights();
/// let left = low_pass(both, grid.lengths(), 0.25)?;
/// assert!(left.iter().zip(long.heights()).all(|(a, b)| (a - b).abs() < 1e-15));
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Value`] if the cut-off or a side length is not positive and finite; [`Error::Memory`] if the waves take more
/// memory than there is; [`Error::NotFinite`] if heights are missing.
pub fn low_pass(mut heights: Array2<f64>, lengths: (f64, f64), cut_off: f64) -> Result<Array2<f64>> {
    Error::positive("cut-off wavelength", cut_off)?;
    let grid = Grid::new(heights.dim(), lengths)?;
    grid.afford("a filtered map", 32)?;
    all_finite("heights", heights.view())?;
    // about the mean, so that a large datum costs no digits
    let mean = mean_of_finite(&heights);
    heights.mapv_inplace(|h| h - mean);
    // a wavelength may be below the cut-off by rounding
    let most = TAU / cut_off * (1.0 + SLACK);
    let mut left = filtered(heights.view(), |kx, ky| grid.wave_number_x(kx).hypot(grid.wave_number_y(ky)) <= most)?;
    left.mapv_inplace(|h| h + mean);
    Ok(left)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{SelfAffine, Surface};

    #[test]
    fn exactly_the_waves_that_are_shorter_go() {
        for (shape, lengths) in [((64, 48), (2.0, 1.5)), ((45, 64), (1.0, 1.3)), ((63, 1), (3.0, 3.0))] {
            let grid = Grid::new(shape, lengths).unwrap();
            let rough = SelfAffine::default().k_l(1.0).k_r(1.0).k_s(20.0).seed(5).surface(grid).unwrap();
            let cut_off = lengths.0 / 9.0;
            let left = low_pass(rough.heights().mapv(|h| h + 1e3), lengths, cut_off).unwrap();
            let left = Surface::new(grid, left.mapv(|h| h - 1e3)).unwrap();
            let (before, after) = (rough.spectrum(), left.spectrum());
            let scale = before.powers().iter().fold(0.0, |a: f64, b| a.max(*b));
            for ((ky, kx), power) in before.powers().indexed_iter() {
                let q = grid.wave_number_x(kx).hypot(grid.wave_number_y(ky));
                let expected = if q <= TAU / cut_off * (1.0 + 1e-9) { *power } else { 0.0 };
                // the rounding of heights of 1000
                assert!((after.powers()[[ky, kx]] - expected).abs() < 1e-9 * scale, "{kx} {ky}");
            }
            // nothing more goes the second time, and nothing at all below the shortest waves
            let again = low_pass(left.heights().clone(), lengths, cut_off).unwrap();
            assert!(again.iter().zip(left.heights()).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }

    #[test]
    fn what_has_no_waves_is_refused() {
        let heights = Array2::zeros((4, 4));
        for cut_off in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(low_pass(heights.clone(), (1.0, 1.0), cut_off), Err(Error::Value { .. })));
        }
        assert!(low_pass(heights.clone(), (0.0, 1.0), 1.0).is_err());
        let missing = heights.mapv(|_: f64| f64::NAN);
        assert!(matches!(low_pass(missing, (1.0, 1.0), 1.0), Err(Error::NotFinite { .. })));
    }
}
