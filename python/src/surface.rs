//! Surfaces: random ones, measured ones made periodic, and their statistics.

use std::path::PathBuf;

use asperity::surface::{FourierSeries, Psd};
use asperity::{Grid, Surface};
use asperity_maps::Topography;
use asperity_maps::io::{check_memory, read_fourier};
use asperity_scene::quantity::LENGTH;
use asperity_scene::{Body, Log, Preparation, Roughness, Skin, in_unit, worded};
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::inputs::keys;
use crate::numbers::Field;
use crate::pools::Pool;
use crate::refusal::refusal;
use crate::report::reported;

/// Heights, side lengths and unit of a map, the nodes of the original of a mirrored one, and the seed of a random one
/// with the threshold of the scars that were removed.
type Made<'py> =
    (Bound<'py, PyArray2<f64>>, Option<(f64, f64)>, Option<String>, Option<(usize, usize)>, (Option<u64>, Option<f64>));

/// Calls a function without the interpreter's lock, on the shared pool.
fn apart<R: Send>(py: Python<'_>, act: impl FnOnce() -> asperity::Result<R> + Send) -> PyResult<R> {
    let pool = Pool::of(None)?;
    py.detach(|| pool.get().install(act)).map_err(refusal)
}

fn map(py: Python<'_>, topography: Topography) -> Made<'_> {
    let Topography { heights, lengths, unit, original, seed, scars_removed, .. } = topography;
    (heights.into_pyarray(py), lengths, unit, original, (seed, scars_removed))
}

fn surface(heights: Field<'_>, lengths: (f64, f64)) -> PyResult<Surface> {
    let heights = heights.to_array()?;
    Grid::new(heights.dim(), lengths).and_then(|grid| Surface::new(grid, heights)).map_err(refusal)
}

/// Reads a file of heights, of several channels the one of a number or title.
#[pyfunction]
#[pyo3(signature = (path, channel))]
pub fn read(py: Python<'_>, path: PathBuf, channel: Option<String>) -> PyResult<Made<'_>> {
    let read = || match &channel {
        Some(channel) => asperity_maps::io::read_channel(&path, channel),
        None => asperity_maps::io::read_topography(&path),
    };
    Ok(map(py, apart(py, read)?))
}

/// The heights of a body of a simple form with self-affine roughness or without it, both by their keys; NaN beyond the
/// body.
#[pyfunction]
#[pyo3(signature = (shape, lengths, body, roughness))]
pub fn made<'py>(
    py: Python<'py>,
    shape: (usize, usize),
    lengths: (f64, f64),
    body: Bound<'py, PyAny>,
    roughness: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let body: Body = keys(body)?;
    let roughness = roughness.map(keys::<Roughness>).transpose()?;
    let rough = roughness.map(|roughness| {
        let one = || PyValueError::new_err("give rms_height or rms_slope, one of the two");
        roughness.self_affine().ok_or_else(one)
    });
    let rough = rough.transpose()?;
    check_memory("a surface", shape, if rough.is_some() { 32 } else { 16 }).map_err(refusal)?;
    let drawn = apart(py, || {
        let grid = Grid::new(shape, lengths)?;
        let roughness = rough.map(|rough| rough.surface(grid)).transpose()?;
        body.surface(grid, roughness).map(Topography::from)
    })?;
    Ok(drawn.heights.into_pyarray(py))
}

/// Fourier coefficients as Python passes them: a file, or rows of numbers.
#[derive(FromPyObject)]
pub enum Coefficients<'py> {
    File(PathBuf),
    Rows(Field<'py>),
}

/// The heights of a surface by its Fourier coefficients.
#[pyfunction]
pub fn fourier<'py>(
    py: Python<'py>,
    coefficients: Coefficients<'py>,
    shape: (usize, usize),
    lengths: (f64, f64),
    unit: f64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let grid = Grid::new(shape, lengths).map_err(refusal)?;
    let found = match coefficients {
        Coefficients::File(path) => apart(py, || read_fourier(path, grid, unit))?,
        Coefficients::Rows(rows) => {
            let mut series = FourierSeries::new(grid).map_err(refusal)?;
            for (index, row) in rows.as_array().outer_iter().enumerate() {
                let &[m, n, re, im] = &row.to_vec()[..] else {
                    let text = "coefficients have {} columns: they must be qX, qY, and the real and the imaginary part";
                    return Err(PyValueError::new_err(text.replace("{}", &row.len().to_string())));
                };
                let refused = |error| PyValueError::new_err(format!("coefficients[{index}]: {error}"));
                series.add((m, n), (re, im)).map_err(refused)?;
            }
            apart(py, || series.surface(unit))?
        }
    };
    Ok(Topography::from(found).heights.into_pyarray(py))
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

/// The wavelength of the knee of the spectrum of heights, if it has one.
#[pyfunction]
pub fn knee_wavelength(py: Python<'_>, heights: Field<'_>, lengths: (f64, f64)) -> PyResult<Option<f64>> {
    let surface = surface(heights, lengths)?;
    apart(py, || Ok(asperity_maps::knee_wavelength(&surface)))
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

/// A map as Python has it: heights, side lengths, unit, and the nodes of the original of a mirrored one.
pub type Map<'py> = (Field<'py>, Option<(f64, f64)>, Option<String>, Option<(usize, usize)>);

/// A map of the library from one of Python.
pub fn topography((heights, lengths, unit, original): Map<'_>) -> PyResult<Topography> {
    let mut map = Topography::new(heights.to_array()?);
    (map.lengths, map.unit, map.original) = (lengths, unit, original);
    Ok(map)
}

/// A map in metres.
#[pyfunction]
pub fn in_metres<'py>(py: Python<'py>, given: Map<'py>) -> PyResult<Made<'py>> {
    let found = in_unit(topography(given)?, LENGTH.si);
    let refused = |text: String| PyValueError::new_err(format!("heights: {}", worded(&text, Skin::Keywords)));
    Ok(map(py, found.map_err(refused)?))
}

/// A prepared map, the lines of its log, and the warnings.
type Prepared<'py> = (Made<'py>, Vec<String>, Bound<'py, PyAny>);

/// Takes the steps from a measured map to a periodic surface, by their keys.
#[pyfunction]
#[pyo3(signature = (given, new_lengths, cut_off_wavelength, in_metres, steps))]
pub fn prepare<'py>(
    py: Python<'py>,
    given: Map<'py>,
    new_lengths: Option<(f64, f64)>,
    cut_off_wavelength: Option<f64>,
    in_metres: bool,
    steps: Bound<'py, PyAny>,
) -> PyResult<Prepared<'py>> {
    let mut steps: Preparation = keys(steps)?;
    let measured = topography(given)?;
    let unit = measured.unit.as_deref();
    let lengths = new_lengths.map_or(Ok(()), |lengths| steps.set_lengths(lengths, in_metres, unit));
    let cut_off =
        |()| cut_off_wavelength.map_or(Ok(()), |cut_off| steps.set_cut_off_wavelength(cut_off, in_metres, unit));
    lengths.and_then(cut_off).map_err(|text| PyValueError::new_err(worded(&text, Skin::Keywords)))?;
    let mut log = Log::default();
    let prepared = apart(py, || steps.run(measured, &mut log))?;
    let lines = log.lines.iter().map(|(step, what)| format!("{step}: {what}")).collect();
    Ok((map(py, prepared), lines, reported(py, &log.warnings)?))
}
