//! Surfaces: random ones, measured ones made periodic, and their statistics.

use std::path::PathBuf;

use asperity::{Amplitude, Error, Grid, Psd, SelfAffine, Surface, Topography, Trend};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::pools::Pool;
use crate::refusal::refusal;

/// Heights, side lengths and unit of a map.
type Map<'py> = (Bound<'py, PyArray2<f64>>, Option<(f64, f64)>, Option<String>);

/// Calls a function without the interpreter's lock, on the shared pool.
fn apart<R: Send>(py: Python<'_>, act: impl FnOnce() -> asperity::Result<R> + Send) -> PyResult<R> {
    let pool = Pool::of(None)?;
    py.detach(|| pool.get().install(act)).map_err(refusal)
}

fn map(py: Python<'_>, topography: Topography) -> Map<'_> {
    (topography.heights.into_pyarray(py), topography.lengths, topography.unit)
}

fn surface(heights: PyReadonlyArray2<'_, f64>, lengths: (f64, f64)) -> PyResult<Surface> {
    let heights = heights.as_array().to_owned();
    Grid::new(heights.dim(), lengths).and_then(|grid| Surface::new(grid, heights)).map_err(refusal)
}

/// Reads a file of heights.
#[pyfunction]
pub fn read(py: Python<'_>, path: PathBuf) -> PyResult<Map<'_>> {
    Ok(map(py, apart(py, || asperity::io::read_topography(&path))?))
}

/// Draws a self-affine surface.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by name")]
pub fn self_affine<'py>(
    py: Python<'py>,
    shape: (usize, usize),
    lengths: (f64, f64),
    rms_height: Option<f64>,
    rms_slope: Option<f64>,
    hurst: f64,
    k_l: f64,
    k_r: Option<f64>,
    k_s: f64,
    random_phase: bool,
    seed: u64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let amplitude = match (rms_height, rms_slope) {
        (Some(height), None) => Amplitude::RmsHeight(height),
        (None, Some(slope)) => Amplitude::RmsSlope(slope),
        _ => return Err(PyValueError::new_err("give rms_height or rms_slope, one of the two")),
    };
    let k_r = k_r.unwrap_or(k_l);
    let rough = SelfAffine { hurst, k_l, k_r, k_s, amplitude, random_phase, seed };
    let drawn = apart(py, || rough.surface(Grid::new(shape, lengths)?).map(Topography::from))?;
    Ok(drawn.heights.into_pyarray(py))
}

/// The statistics of heights, in the order of the library.
#[pyfunction]
pub fn statistics(py: Python<'_>, heights: PyReadonlyArray2<'_, f64>, lengths: (f64, f64)) -> PyResult<[f64; 11]> {
    let surface = surface(heights, lengths)?;
    let found = apart(py, || Ok(surface.statistics()))?;
    Ok([
        found.mean,
        found.lowest,
        found.highest,
        found.rms_height,
        found.skewness,
        found.kurtosis,
        found.rms_slope,
        found.rms_slope_differences,
        found.rms_curvature,
        found.rms_curvature_differences,
        found.nayak,
    ])
}

/// Wave numbers, densities, numbers of waves, and the area of one wave.
type Density<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<i64>>, f64);

/// The power spectral density of heights: radial, or of profiles along x or y.
#[pyfunction]
pub fn spectrum<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'_, f64>,
    lengths: (f64, f64),
    along: &str,
) -> PyResult<Density<'py>> {
    let surface = surface(heights, lengths)?;
    let of = match along {
        "radial" => asperity::Spectrum::radial_psd,
        "x" => asperity::Spectrum::profile_psd_x,
        "y" => asperity::Spectrum::profile_psd_y,
        other => return Err(PyValueError::new_err(format!("along is {other}: it must be radial, x or y"))),
    };
    let Psd { wave_numbers, densities, waves, cell, .. } = apart(py, || Ok(of(&surface.spectrum())))?;
    let waves: Vec<i64> = waves.into_iter().map(|count| count as i64).collect();
    Ok((wave_numbers.into_pyarray(py), densities.into_pyarray(py), waves.into_pyarray(py), cell))
}

/// Takes the steps from a measured map to a periodic surface, in the order of the tool.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by name")]
pub fn prepare<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'_, f64>,
    lengths: Option<(f64, f64)>,
    unit: Option<String>,
    scale: Option<f64>,
    crop: Option<(usize, usize, usize, usize)>,
    flip: bool,
    detrend: Option<&str>,
    fill: bool,
    window: Option<f64>,
    mirror: bool,
    resample: Option<(usize, usize)>,
) -> PyResult<Map<'py>> {
    let trend = match detrend {
        None => None,
        Some("mean") => Some(Trend::Mean),
        Some("plane") => Some(Trend::Plane),
        Some("quadric") => Some(Trend::Quadric),
        Some(other) => {
            return Err(PyValueError::new_err(format!("detrend is {other}: it must be mean, plane or quadric")));
        }
    };
    let scaled: Array2<f64> = match scale {
        Some(factor) => heights.as_array().mapv(|height| factor * height),
        None => heights.as_array().to_owned(),
    };
    let mut measured = Topography::new(scaled);
    (measured.lengths, measured.unit) = (lengths, unit);
    let prepared = apart(py, move || -> Result<Topography, Error> {
        let mut map = measured;
        if let Some((x, y, nx, ny)) = crop {
            map = map.crop(x..x.saturating_add(nx), y..y.saturating_add(ny))?;
        }
        if flip {
            map = map.flip();
        }
        if let Some(trend) = trend {
            map = map.detrend(trend)?;
        }
        if fill {
            map = map.fill()?;
        }
        if let Some(fraction) = window {
            map = map.window(fraction)?;
        }
        if mirror {
            map = map.mirror();
        }
        match resample {
            Some(shape) => map.resample(shape),
            None => Ok(map),
        }
    })?;
    Ok(map(py, prepared))
}
