//! The knee of a power spectrum: the wavelength at which it flattens to a floor of noise.

use std::f64::consts::PI;

use asperity::Surface;
use asperity::surface::Psd;

/// The classes of wave numbers to an octave.
const CLASSES: f64 = 8.0;
/// The classes before the shortest waves of a grid that are flat where there is a floor: half an octave.
const LAST: usize = 4;
/// The least number of independent waves in these classes: with fewer, the slope of the spectrum is not known to 0.25.
const LEAST_WAVES: f64 = 1600.0;
/// The slopes of the logarithm of the density up to which a profile and a surface are flat: half of the self-affine
/// slopes, −1 − 2H and −2 − 2H, at a Hurst exponent H of 0.
const FLAT: [f64; 2] = [0.5, 1.0];
/// The least rms of the noise over the rms height: rounding to `f32` makes some 1e-7.
const LEAST: f64 = 1e-6;
/// The density at the knee over the density of the floor, where noise and surface have one density.
const ABOVE: f64 = 2.0;
/// The least excess of a density over the floor, in standard deviations of a mean over so many waves of noise.
const SURE: f64 = 5.0;

/// A class of wave numbers.
#[derive(Clone, Copy, Default)]
struct Class {
    /// The number of independent waves: a wave and its mirror image are one.
    waves: f64,
    wave_number: f64,
    density: f64,
}

/// The wavelength of the knee of the spectrum of a surface, at which it flattens to a floor of noise; none where there
/// is no floor.
///
/// White noise of an instrument has the same density at all wave numbers, and a surface less and less towards the
/// short waves. There is a floor if the density of the last half octave before the shortest waves of the grid falls
/// with less than the wave number, or its square root for a profile, half the slope of a self-affine surface with a
/// Hurst exponent of 0, and the waves of the floor make more than 1e-6 of the rms height. At the knee the surface has
/// the density of the floor, and the spectrum twice this density. Shorter waves are noise:
/// [`Topography::low_pass`](crate::Topography::low_pass) leaves them out.
///
/// The densities are means over eighths of an octave. Fewer than 1600 independent waves in the last half octave, as
/// on 90 × 90 nodes or a profile of 10 000, are too few to tell.
///
/// ```
/// use asperity::{Grid, SelfAffine, Surface};
/// use asperity_maps::knee_wavelength;
/// let grid = Grid::square(128, 1.0)?;
/// let rough = SelfAffine::default().k_s(60.0).surface(grid)?;
/// assert_eq!(knee_wavelength(&rough), None);
/// let mut state = 1_u64;
/// let noisy = rough.heights().mapv(|height| {
///     state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
///     height + 2.0 * rough.rms_height() * ((state >> 40) as f64 / 2_f64.powi(24) - 0.5)
/// });
/// let knee = knee_wavelength(&Surface::new(grid, noisy)?).unwrap();
/// assert!(knee > 2.0 / 128.0 && knee < 0.2);
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn knee_wavelength(surface: &Surface) -> Option<f64> {
    let spectrum = surface.spectrum();
    let (nx, ny) = spectrum.grid().shape();
    let (dx, dy) = spectrum.grid().spacing();
    let spacing = match (nx, ny) {
        (_, 1) => dx,
        (1, _) => dy,
        _ => dx.max(dy),
    };
    let psd = spectrum.radial_psd();
    let classes = classes(&psd, PI / spacing);
    let last = classes.get(..LAST)?;
    let waves: f64 = last.iter().map(|class| class.waves).sum();
    let floor = last.iter().map(|class| class.waves * class.density).sum::<f64>() / waves;
    let all: usize = psd.waves.iter().sum();
    let noise = (floor * psd.cell * all as f64).sqrt();
    if waves < LEAST_WAVES
        || slope(last).abs() > FLAT[usize::from(nx > 1 && ny > 1)]
        || noise <= LEAST * spectrum.rms_height()
    {
        return None;
    }
    let rest = &classes[last.len()..];
    let stands_out = |class: &Class| class.density > floor * ABOVE.max(1.0 + SURE / class.waves.sqrt());
    let first = rest.iter().position(|class| class.waves > 0.0 && stands_out(class))?;
    // between that and the last one of shorter waves
    let shorter = classes[..last.len() + first].iter().rev().find(|class| class.waves > 0.0)?;
    let [above, below] = [&rest[first], shorter].map(|class| ((ABOVE * floor / class.density).ln(), class.wave_number));
    let share = above.0 / (above.0 - below.0);
    let wave_number = above.1 * (below.1 / above.1).powf(share.clamp(0.0, 1.0));
    Some(2.0 * PI / wave_number)
}

/// The means of a density over eighths of an octave, from the shortest waves along the sides on.
fn classes(psd: &Psd, end: f64) -> Vec<Class> {
    let mut classes: Vec<Class> = Vec::new();
    for ((&q, density), waves) in psd.wave_numbers.iter().zip(&psd.densities).zip(&psd.waves) {
        let below = CLASSES * (end / q).log2();
        // the shortest waves along a side are at the end, to rounding
        if below < -1e-9 {
            continue;
        }
        let index = below.max(0.0) as usize;
        if classes.len() <= index {
            classes.resize(index + 1, Class::default());
        }
        let (class, waves) = (&mut classes[index], 0.5 * *waves as f64);
        class.waves += waves;
        class.wave_number += waves * q;
        class.density += waves * density;
    }
    for class in classes.iter_mut().filter(|class| class.waves > 0.0) {
        class.wave_number /= class.waves;
        class.density /= class.waves;
    }
    classes
}

/// The slope of the logarithm of the density over the logarithm of the wave number, by least squares, each class by its
/// waves.
fn slope(classes: &[Class]) -> f64 {
    let filled = || classes.iter().filter(|class| class.waves > 0.0);
    let mean = |of: &dyn Fn(&Class) -> f64| {
        filled().map(|class| class.waves * of(class)).sum::<f64>() / filled().map(|class| class.waves).sum::<f64>()
    };
    let (x, y) = (mean(&|class| class.wave_number.ln()), mean(&|class| class.density.ln()));
    let products = mean(&|class| (class.wave_number.ln() - x) * (class.density.ln() - y));
    products / mean(&|class| (class.wave_number.ln() - x).powi(2))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use ndarray::Array2;

    use asperity::{Amplitude, Grid, SelfAffine};

    use super::*;

    /// White noise of unit variance.
    fn white(shape: (usize, usize)) -> Array2<f64> {
        let mut state = 7_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / 2_f64.powi(53)
        };
        Array2::from_shape_simple_fn(shape, || {
            let [a, b] = [uniform(), uniform()];
            (-2.0 * (1.0 - a).ln()).sqrt() * (TAU * b).cos()
        })
    }

    fn rough(grid: Grid, hurst: f64, longest: f64) -> Surface {
        let shape = SelfAffine::default().hurst(hurst).k_l(longest).k_r(longest).k_s(0.5 * grid.shape().0 as f64 - 1.0);
        shape.amplitude(Amplitude::RmsHeight(1.0)).seed(3).random_phase(true).surface(grid).unwrap()
    }

    #[test]
    fn the_knee_is_where_noise_and_surface_have_one_density() {
        for (n, hurst, noise) in [(256, 0.8, 0.4), (256, 0.5, 0.8), (512, 0.5, 0.5), (512, 0.8, 0.25)] {
            let grid = Grid::square(n, 2.0).unwrap();
            let clean = rough(grid, hurst, 2.0);
            assert_eq!(knee_wavelength(&clean), None, "{n} {hurst}");
            let noisy = clean.heights() + noise * white(grid.shape());
            let found = knee_wavelength(&Surface::new(grid, noisy).unwrap()).unwrap();
            // the density of the surface falls through the density of the noise, σ² Δx Δy/4π²
            let floor = (noise * grid.spacing().0 / TAU).powi(2);
            let psd = clean.spectrum().radial_psd();
            let last = psd.densities.iter().rposition(|density| *density > floor).unwrap();
            let expected = TAU / psd.wave_numbers[last];
            assert!((found / expected).log2().abs() < 0.125, "{n} {hurst}: {found} for {expected}");
        }
    }

    #[test]
    fn without_a_floor_there_is_no_knee() {
        let grid = Grid::square(256, 1.0).unwrap();
        // a surface that ends at some wave, with flat rounding; in f32 too; and noise alone, or on few nodes
        let ends = SelfAffine::default().k_s(40.0).surface(grid).unwrap();
        let single = ends.heights().mapv(|height| f64::from(height as f32));
        let knee = |grid: Grid, heights: Array2<f64>| knee_wavelength(&Surface::new(grid, heights).unwrap());
        assert_eq!(knee(grid, ends.heights().clone()), None);
        assert_eq!(knee(grid, single), None);
        assert_eq!(knee(grid, white(grid.shape())), None);
        assert_eq!(knee(grid, Array2::zeros(grid.shape())), None);
        let few = Grid::square(16, 1.0).unwrap();
        assert_eq!(knee(few, rough(few, 0.8, 1.0).heights() + 0.3 * white((16, 16))), None);
    }

    #[test]
    fn profiles_have_a_knee_of_many_nodes() {
        let grid = Grid::line(16384, 1.0).unwrap();
        let clean = rough(grid, 0.8, 4.0);
        assert_eq!(knee_wavelength(&clean), None);
        let noise = 0.03;
        let noisy = Surface::new(grid, clean.heights() + noise * white(grid.shape())).unwrap();
        let psd = clean.spectrum().radial_psd();
        let floor = noise * noise * grid.spacing().0 / TAU;
        let last = psd.densities.iter().rposition(|density| *density > floor).unwrap();
        let (found, expected) = (knee_wavelength(&noisy).unwrap(), TAU / psd.wave_numbers[last]);
        // single waves of noise scatter by their mean: a class of 40 by a sixth
        assert!((found / expected).log2().abs() < 0.25, "{found} for {expected}");
    }
}
