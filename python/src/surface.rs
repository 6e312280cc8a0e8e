//! Surfaces: random ones, measured ones made periodic, and their statistics.

use std::path::PathBuf;

use asperity::surface::{FourierSeries, Psd};
use asperity::{Grid, Surface};
use asperity_maps::Topography;
use asperity_maps::io::{Reading, check_memory, read_fourier, write_topography};
use asperity_scene::output::OutputFile;
use asperity_scene::{FormKeys, Keys, LENGTH, Log, Preparation, RoughnessKeys, StepKeys, in_unit};
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_pyobject::to_pyobject;

use crate::inputs::Map;
use crate::keywords;
use crate::numbers::{Field, whole};
use crate::pools::apart;
use crate::refusal::{reason, refusal};
use crate::report::reported;

/// A map that Python gets, as a dictionary.
#[derive(IntoPyObject)]
pub struct OutputMap<'py> {
    heights: Bound<'py, PyArray2<f64>>,
    lengths: Option<(f64, f64)>,
    unit: Option<String>,
    original: Option<(usize, usize)>,
    seed: Option<u64>,
    scars_removed: Option<f64>,
    periodic: Option<bool>,
}

impl<'py> OutputMap<'py> {
    fn new(py: Python<'py>, topography: Topography) -> Self {
        let Topography { heights, lengths, unit, original, seed, scars_removed, periodic, .. } = topography;
        Self { heights: heights.into_pyarray(py), lengths, unit, original, seed, scars_removed, periodic }
    }
}

fn surface(heights: Field<'_>, lengths: (f64, f64)) -> PyResult<Surface> {
    let heights = heights.to_array()?;
    Grid::new(heights.dim(), lengths).and_then(|grid| Surface::new(grid, heights)).map_err(refusal)
}

/// Reads a file of heights, of several channels the one of a number or title, and tells what stands next to them.
#[pyfunction]
pub fn read(
    py: Python<'_>,
    path: PathBuf,
    channel: Option<String>,
    skip_lines: usize,
    missing: Vec<String>,
    masked: bool,
) -> PyResult<(OutputMap<'_>, Vec<String>)> {
    let mut reading = Reading::default();
    (reading.channel, reading.skip_lines) = (channel, skip_lines);
    (reading.missing, reading.masked) = (missing, masked);
    let mut map = apart(py, || reading.read(&path))?;
    let unread = std::mem::take(&mut map.unread);
    Ok((OutputMap::new(py, map), unread))
}

/// Writes a map to a file, in the format of its ending; with `force` over one that is there.
#[pyfunction]
pub fn write(given: Map<'_>, path: PathBuf, force: bool) -> PyResult<()> {
    let map = given.topography()?;
    let file = OutputFile::create(&path, force).map_err(|error| PyValueError::new_err(error.to_string()))?;
    file.complete(|path| write_topography(path, &map)).map_err(refusal)
}

/// The heights of a body of a simple form with self-affine roughness or without it, both by their keys; NaN beyond the
/// body.
#[pyfunction]
pub fn made<'py>(
    py: Python<'py>,
    shape: (usize, usize),
    lengths: (f64, f64),
    body: &Bound<'py, PyDict>,
    roughness: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let body: FormKeys = keywords::read(&[FormKeys::KEYS], body)?.keys();
    let one = || PyValueError::new_err("give rms_height or rms_slope, one of the two");
    let rough =
        |given| keywords::read(&[RoughnessKeys::KEYS], given)?.keys::<RoughnessKeys>().self_affine().ok_or_else(one);
    let rough = roughness.map(rough).transpose()?;
    check_memory("a surface", shape, if rough.is_some() { 32 } else { 16 }).map_err(refusal)?;
    let drawn = apart(py, || {
        let grid = Grid::new(shape, lengths)?;
        let roughness = rough.map(|rough| rough.surface(grid)).transpose()?;
        body.surface(grid, roughness).map(Topography::from)
    })?;
    Ok(drawn.heights.into_pyarray(py))
}

/// Fourier coefficients as Python passes them: a file, or rows of four numbers.
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
                let refused = |error| PyValueError::new_err(format!("coefficients[{index}]: {error}"));
                series.add((row[0], row[1]), (row[2], row[3])).map_err(refused)?;
            }
            apart(py, || series.surface(unit))?
        }
    };
    Ok(Topography::from(found).heights.into_pyarray(py))
}

/// The statistics of heights by the names of reports, in the order of the library.
#[pyfunction]
pub fn statistics<'py>(
    py: Python<'py>,
    heights: Field<'_>,
    lengths: Option<(f64, f64)>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut map = Topography::new(heights.to_array()?);
    map.lengths = lengths;
    Ok(to_pyobject(py, &apart(py, || map.statistics())?)?)
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
    Ok((wave_numbers.into_pyarray(py), densities.into_pyarray(py), whole(py, waves), cell))
}

/// A map in metres.
#[pyfunction]
pub fn in_metres<'py>(py: Python<'py>, given: Map<'py>) -> PyResult<OutputMap<'py>> {
    let found = in_unit(given.topography()?, LENGTH.si);
    Ok(OutputMap::new(py, found.map_err(|text| reason(format!("heights: {text}")))?))
}

/// A prepared map, the lines of its log, and the warnings.
type Prepared<'py> = (OutputMap<'py>, Vec<String>, Bound<'py, PyAny>);

/// Takes the steps from a measured map to a periodic surface, by their keys.
#[pyfunction]
pub fn prepare<'py>(
    py: Python<'py>,
    given: Map<'py>,
    new_lengths: Option<(f64, f64)>,
    cut_off_wavelength: Option<f64>,
    in_metres: bool,
    steps: &Bound<'py, PyDict>,
) -> PyResult<Prepared<'py>> {
    let steps = keywords::read(&[StepKeys::KEYS], steps)?.keys();
    let mut steps = Preparation { steps, ..Preparation::default() };
    let measured = given.topography()?;
    let unit = measured.unit.as_deref();
    let lengths = new_lengths.map_or(Ok(()), |lengths| steps.set_lengths(lengths, in_metres, unit));
    let cut_off =
        |()| cut_off_wavelength.map_or(Ok(()), |cut_off| steps.set_cut_off_wavelength(cut_off, in_metres, unit));
    lengths.and_then(cut_off).map_err(reason)?;
    let mut log = Log::default();
    let prepared = apart(py, || steps.run(measured, &mut log))?;
    let lines = log.lines.iter().map(|(step, what)| format!("{step}: {what}")).collect();
    Ok((OutputMap::new(py, prepared), lines, reported(py, &log.warnings)?))
}
