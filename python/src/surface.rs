//! Surfaces: random ones, measured ones made periodic, and their statistics.

use std::path::PathBuf;

use asperity::surface::Psd;
use asperity::{Amplitude, Grid, SelfAffine, Surface};
use asperity_maps::Topography;
use asperity_maps::io::check_memory;
use asperity_maps::warning::Warning;
use asperity_maps::{Form, RowAlignment, ScanAxis, Trend};
use asperity_scene::units::Units;
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_pyobject::to_pyobject;

use crate::numbers::{Field, afford};
use crate::pools::Pool;
use crate::refusal::refusal;

/// Heights, side lengths and unit of a map, the nodes of the original of a mirrored one, and the seed of a random one.
type Map<'py> = (Bound<'py, PyArray2<f64>>, Option<(f64, f64)>, Option<String>, Option<(usize, usize)>, Option<u64>);

/// Calls a function without the interpreter's lock, on the shared pool.
fn apart<R: Send>(py: Python<'_>, act: impl FnOnce() -> asperity::Result<R> + Send) -> PyResult<R> {
    let pool = Pool::of(None)?;
    py.detach(|| pool.get().install(act)).map_err(refusal)
}

fn map(py: Python<'_>, topography: Topography) -> Map<'_> {
    let Topography { heights, lengths, unit, original, seed, .. } = topography;
    (heights.into_pyarray(py), lengths, unit, original, seed)
}

fn surface(heights: Field<'_>, lengths: (f64, f64)) -> PyResult<Surface> {
    let heights = heights.to_array()?;
    Grid::new(heights.dim(), lengths).and_then(|grid| Surface::new(grid, heights)).map_err(refusal)
}

/// Reads a file of heights, of several channels the one of a number or title.
#[pyfunction]
#[pyo3(signature = (path, channel))]
pub fn read(py: Python<'_>, path: PathBuf, channel: Option<String>) -> PyResult<Map<'_>> {
    let read = || match &channel {
        Some(channel) => asperity_maps::io::read_channel(&path, channel),
        None => asperity_maps::io::read_topography(&path),
    };
    Ok(map(py, apart(py, read)?))
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
    let rough = SelfAffine::default()
        .hurst(hurst)
        .k_l(k_l)
        .k_r(k_r)
        .k_s(k_s)
        .amplitude(amplitude)
        .random_phase(random_phase)
        .seed(seed);
    check_memory("a random surface", shape, 32).map_err(refusal)?;
    let drawn = apart(py, || rough.surface(Grid::new(shape, lengths)?).map(Topography::from))?;
    Ok(drawn.heights.into_pyarray(py))
}

/// The statistics of heights, in the order of the library.
#[pyfunction]
pub fn statistics(py: Python<'_>, heights: Field<'_>, lengths: Option<(f64, f64)>) -> PyResult<[f64; 11]> {
    let mut map = Topography::new(heights.to_array()?);
    map.lengths = lengths;
    let found = apart(py, || map.statistics())?;
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

/// The power spectral density of heights, averaged over directions.
#[pyfunction]
pub fn spectrum<'py>(py: Python<'py>, heights: Field<'_>, lengths: (f64, f64)) -> PyResult<Density<'py>> {
    let surface = surface(heights, lengths)?;
    let Psd { wave_numbers, densities, waves, cell, .. } = apart(py, || Ok(surface.spectrum().radial_psd()))?;
    let waves: Vec<i64> = waves.into_iter().map(|count| count as i64).collect();
    Ok((wave_numbers.into_pyarray(py), densities.into_pyarray(py), waves.into_pyarray(py), cell))
}

/// Takes the steps from a measured map to a periodic surface, in the order of the tool.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by name")]
pub fn prepare<'py>(
    py: Python<'py>,
    heights: Field<'_>,
    lengths: Option<(f64, f64)>,
    unit: Option<String>,
    original: Option<(usize, usize)>,
    missing: Vec<f64>,
    scale: Option<f64>,
    crop: Option<(usize, usize, usize, usize)>,
    flip: bool,
    align_rows: Option<(&str, usize)>,
    scan_axis: &str,
    despike: Option<f64>,
    remove_form: Option<&str>,
    detrend: Option<(&str, usize)>,
    fill: bool,
    window: Option<f64>,
    mirror: bool,
    resample: Option<(usize, usize)>,
) -> PyResult<(Map<'py>, Bound<'py, PyAny>)> {
    let unknown = |name, value, expected| PyValueError::new_err(format!("{name} is {value}: it must be {expected}"));
    let trend = match detrend {
        None => None,
        Some(("mean", _)) => Some(Trend::Mean),
        Some(("plane", _)) => Some(Trend::Plane),
        Some(("quadric", _)) => Some(Trend::Quadric),
        Some(("polynomial", order)) => Some(Trend::Polynomial(order)),
        Some((other, _)) => return Err(unknown("detrend", other, "mean, plane, quadric or an order")),
    };
    let alignment = match align_rows {
        None => None,
        Some(("median", _)) => Some(RowAlignment::Median),
        Some(("median-difference", _)) => Some(RowAlignment::MedianDifference),
        Some(("polynomial", order)) => Some(RowAlignment::Polynomial(order)),
        Some((other, _)) => return Err(unknown("align_rows", other, "median, median-difference or an order")),
    };
    let along = match scan_axis {
        "x" => ScanAxis::X,
        "y" => ScanAxis::Y,
        other => return Err(unknown("scan_axis", other, "x or y")),
    };
    let form = match remove_form {
        None => None,
        Some("sphere") => Some(Form::Sphere),
        Some("cylinder") => Some(Form::Cylinder),
        Some(other) => return Err(unknown("remove_form", other, "sphere or cylinder")),
    };
    let mut measured = Topography::new(heights.to_array()?);
    (measured.lengths, measured.unit, measured.original) = (lengths, unit, original);
    let (prepared, warnings) = apart(py, move || {
        let mut warnings = Vec::new();
        let mut map = missing.into_iter().fold(measured, Topography::declare_missing);
        if let Some(factor) = scale {
            map.heights.mapv_inplace(|height| factor * height);
        }
        if let Some((x, y, nx, ny)) = crop {
            map = map.crop(x..x.saturating_add(nx), y..y.saturating_add(ny))?;
        }
        if flip {
            map = map.flip();
        }
        if let Some(alignment) = alignment {
            warnings.extend(Warning::of_lines(&map, along));
            map = map.align_rows(alignment, along)?;
        }
        if let Some(threshold) = despike {
            map = map.despike(threshold)?;
        }
        if let Some(form) = form {
            map = map.remove_form(form)?;
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
            let (nx, ny) = map.heights.dim();
            afford("a mirrored map", (2 * nx, 2 * ny))?;
            map = map.mirror();
        }
        if let Some(shape) = resample {
            map = map.resample(shape)?;
        }
        Ok((map, warnings))
    })?;
    let units = Units::of_map(prepared.unit.as_deref());
    let warnings: Vec<_> = warnings.iter().map(|found| units.told(found)).collect();
    let warnings = to_pyobject(py, &warnings)?;
    Ok((map(py, prepared), warnings))
}
