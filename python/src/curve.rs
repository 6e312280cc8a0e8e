//! Force curves: their least squares, for `asperity/curves`.

use asperity_curve::{
    Curve as Points, Fit, Model, Parameters, Prediction, Scale, Scales, Search, Sides, greatest_root,
};
use numpy::ndarray::{Array1, Array2, Array3, ArrayView2, ShapeError};
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3, ToPyArray,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Equilibria of the models of a tip: of each shapes, and knots of the approach and of the withdrawal.
#[pyclass(frozen, module = "asperity.curves")]
pub struct Equilibria(Vec<Model>);

/// Shapes and knots of a model.
type ModelKnots<'py> = (PyReadonlyArray1<'py, f64>, PyReadonlyArray3<'py, f64>, Option<PyReadonlyArray3<'py, f64>>);

#[pymethods]
impl Equilibria {
    #[new]
    fn new(models: Vec<ModelKnots<'_>>) -> PyResult<Self> {
        let knots = |way: &PyReadonlyArray3<'_, f64>| {
            let way = way.as_array();
            let rows =
                way.outer_iter().map(|row| row.outer_iter().map(|knot| std::array::from_fn(|i| knot[i])).collect());
            if way.shape()[2] == 4 { Ok(rows.collect()) } else { Err(PyValueError::new_err("a knot has four numbers")) }
        };
        let made = models.iter().map(|(shapes, approach, withdrawal)| {
            let withdrawal = withdrawal.as_ref().map_or(Ok(Vec::new()), knots)?;
            Model::new(shapes.as_array().to_vec(), knots(approach)?, withdrawal).map_err(PyValueError::new_err)
        });
        made.collect::<PyResult<_>>().map(Self)
    }
}

/// A force curve.
#[pyclass(frozen, module = "asperity.curves")]
pub struct Curve(Points);

/// Fits by their columns: numbers of models, parameters, which are free, squares, loads and their derivatives by the
/// parameters, how far jumps are off and the derivatives of that, and weights of the jumps.
type Columns<'py> = (
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<bool>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray3<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray3<f64>>,
    Bound<'py, PyArray3<f64>>,
);

#[pymethods]
impl Curve {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "numbers of one call of Python")]
    fn new(
        z: PyReadonlyArray1<'_, f64>,
        force: PyReadonlyArray1<'_, f64>,
        turn: usize,
        compliance: f64,
        baseline: PyReadonlyArray2<'_, f64>,
        noise: f64,
        scales: [f64; 5],
        size: f64,
        smooth: bool,
    ) -> PyResult<Self> {
        let (z, force) = (z.as_array().to_vec(), force.as_array().to_vec());
        let baseline: Vec<_> = baseline.as_array().columns().into_iter().map(|column| column.to_vec()).collect();
        if z.len() != force.len() || turn > z.len() || baseline.iter().any(|column| column.len() != z.len()) {
            return Err(PyValueError::new_err("z, force and baseline need as many points"));
        }
        let [modulus, work, floor, point, length] = scales;
        let scales = Scales { modulus, work, floor, point, length };
        let scale = if smooth { Scale::Paraboloid(size) } else { Scale::Table(size) };
        let (farthest, order) = Default::default();
        Ok(Self(Points { z, force, turn, compliance, baseline, noise, scales, scale, farthest, order }.ordered()))
    }

    /// The best fits of models, in the order of rows of a model and a logarithm of the Tabor parameter.
    #[expect(clippy::too_many_arguments, reason = "numbers of one call of Python")]
    fn search<'py>(
        &self,
        py: Python<'py>,
        equilibria: &Equilibria,
        rows: Vec<(usize, f64)>,
        adheres: Vec<bool>,
        full: Option<usize>,
        begins: Vec<(f64, f64)>,
        jumps: bool,
        least: f64,
    ) -> PyResult<Columns<'py>> {
        let models = equilibria.0.as_slice();
        known(models, rows.iter().map(|row| row.0).chain(full))?;
        if adheres.len() != models.len() {
            return Err(PyValueError::new_err("each model needs a word on its work of adhesion"));
        }
        let asked = Search { models, rows, adheres, full, begins, jumps, least };
        let found = py.detach(|| {
            let fits = asked.search(&self.0);
            predict(&self.0, models, &fits).map(|predictions| (fits, predictions))
        });
        let (fits, (load, load_by, off, off_by)) = found.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let table = |of: &dyn Fn(&Fit) -> [f64; 4]| Array2::from_shape_fn((fits.len(), 4), |(k, i)| of(&fits[k])[i]);
        let parameters = table(&|fit| {
            let Parameters { log_modulus, root_work, point, log_tabor } = fit.parameters;
            [log_modulus, root_work, point, log_tabor]
        });
        let seen = Array3::from_shape_fn((fits.len(), 2, 2), |(k, branch, i)| {
            let seen = fits[k].sides.seen[branch];
            [seen.place, seen.weight][i]
        });
        Ok((
            PyArray1::from_iter(py, fits.iter().map(|fit| fit.model as i64)),
            parameters.to_pyarray(py),
            Array2::from_shape_fn((fits.len(), 4), |(k, i)| fits[k].free[i]).to_pyarray(py),
            Array1::from_iter(fits.iter().map(|fit| fit.squares)).to_pyarray(py),
            load.into_pyarray(py),
            load_by.into_pyarray(py),
            off.into_pyarray(py),
            off_by.into_pyarray(py),
            seen.to_pyarray(py),
        ))
    }

    /// The greatest root of the work of adhesion with squares of at most `most`, from parameters of a fit on.
    fn greatest_root(
        &self,
        py: Python<'_>,
        equilibria: &Equilibria,
        model: usize,
        parameters: [f64; 4],
        most: f64,
        least: f64,
    ) -> PyResult<f64> {
        known(&equilibria.0, std::iter::once(model))?;
        let [log_modulus, root_work, point, log_tabor] = parameters;
        let parameters = Parameters { log_modulus, root_work, point, log_tabor };
        let fit = Fit { model, parameters, free: [true; 4], sides: Sides::default(), squares: 0.0 };
        Ok(py.detach(|| greatest_root(&self.0, &equilibria.0, fit, most, least)))
    }

    /// The loads of models with parameters, without sides of jumps.
    fn loads<'py>(
        &self,
        py: Python<'py>,
        equilibria: &Equilibria,
        models: Vec<usize>,
        parameters: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        known(&equilibria.0, models.iter().copied())?;
        let parameters: ArrayView2<'_, f64> = parameters.as_array();
        if parameters.dim() != (models.len(), 4) {
            return Err(PyValueError::new_err("each model needs four parameters"));
        }
        let mut found = Array2::zeros((models.len(), self.0.z.len()));
        let mut room = Prediction::default();
        for ((mut row, &model), of) in found.outer_iter_mut().zip(&models).zip(parameters.outer_iter()) {
            let of = Parameters { log_modulus: of[0], root_work: of[1], point: of[2], log_tabor: of[3] };
            self.0.predict(&equilibria.0[model], &of, &Sides::default(), &mut room);
            row.iter_mut().zip(&room.load).for_each(|(value, load)| *value = *load);
        }
        Ok(found.to_pyarray(py))
    }
}

fn known(models: &[Model], mut numbers: impl Iterator<Item = usize>) -> PyResult<()> {
    match numbers.find(|&number| number >= models.len()) {
        Some(number) => Err(PyValueError::new_err(format!("there is no model of number {number}"))),
        None => Ok(()),
    }
}

/// What fits predict: loads at the points and their derivatives, jumps off and their derivatives.
type Predictions = (Array2<f64>, Array3<f64>, Array2<f64>, Array3<f64>);

fn predict(curve: &Points, models: &[Model], fits: &[Fit]) -> Result<Predictions, ShapeError> {
    let (count, points) = (fits.len(), curve.z.len());
    let (mut load, mut load_by, mut off, mut off_by) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut room = Prediction::default();
    for fit in fits {
        curve.predict(&models[fit.model], &fit.parameters, &fit.sides, &mut room);
        load.extend_from_slice(&room.load);
        load_by.extend_from_slice(room.load_by.as_flattened());
        off.extend_from_slice(&room.off);
        off_by.extend_from_slice(room.off_by.as_flattened());
    }
    Ok((
        Array2::from_shape_vec((count, points), load)?,
        Array3::from_shape_vec((count, points, 4), load_by)?,
        Array2::from_shape_vec((count, 2), off)?,
        Array3::from_shape_vec((count, 2, 4), off_by)?,
    ))
}
