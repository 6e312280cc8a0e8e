//! The form of a body: a sphere or a cylinder, fitted to a height map and removed.

use std::str::FromStr;

use super::{Topography, Trend, named};
use asperity::{Error, Result};

/// The form of a body under its roughness, which [`Topography::remove_form`] removes.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A sphere, its apex anywhere.
    Sphere,
    /// A circular cylinder, its axis in any direction and at any tilt.
    Cylinder,
}

impl Form {
    /// The names of the forms.
    pub const NAMES: [&str; 2] = ["sphere", "cylinder"];
}

impl FromStr for Form {
    type Err = String;

    /// A form by its name.
    fn from_str(text: &str) -> std::result::Result<Self, String> {
        named(text, Self::NAMES, [Self::Sphere, Self::Cylinder])
    }
}

/// The least-squares fit of a [`Form`].
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormFit {
    /// The radius: positive of a ball or a rod, negative of a cup or a groove; infinite if there is no curvature.
    pub radius: f64,
    /// The angle in radians, from −π/2 to π/2, between x and the axis of a cylinder, seen from above; none of a sphere.
    pub axis: Option<f64>,
    /// The root mean square of the heights about the fit: their rms height after [`Topography::remove_form`].
    pub residual: f64,
}

/// The most iterations of a fit.
const MOST_ITERATIONS: usize = 200;
/// The step of the central differences of a fit, in its own units.
const STEP: f64 = 1e-5;
/// The parameters of a form: height and slopes above the centre of the map, curvature there, and the direction of the
/// axis.
const PARAMETERS: usize = 5;

type Parameters = [f64; PARAMETERS];

impl Topography {
    /// The least-squares fit of a form to the heights that are not missing.
    ///
    /// # Errors
    /// [`Error::Value`] if the side lengths are unknown, all heights are missing, or no such form lies under all of
    /// them.
    pub fn fit_form(&self, form: Form) -> Result<FormFit> {
        let fitted = Fitted::new(self, form)?;
        let [.., curvature, axis] = fitted.parameters;
        // from −π/2 to π/2
        let axis = axis.sin().atan2(axis.cos());
        let axis = if axis.cos() < 0.0 { axis - std::f64::consts::PI.copysign(axis) } else { axis };
        Ok(FormFit {
            radius: -fitted.unit / curvature,
            axis: (form == Form::Cylinder).then_some(axis),
            residual: fitted.unit * (fitted.squares / fitted.points.len() as f64).sqrt(),
        })
    }

    /// Removes the least-squares fit of a sphere or a cylinder, with its tilt.
    ///
    /// ```math
    /// h → h − ẑ ,   ẑ = arg min over z of  Σ (h − z)²
    /// ```
    ///
    /// over all spheres, or circular cylinders, with z(x, y) the side that faces up or down, with the sum over all
    /// points that are not missing. Distances are taken along z. A part of a sphere that is much smaller than its
    /// radius is nearly a [`Trend::Quadric`], which fits two curvatures freely; a form has one.
    ///
    /// By Levenberg and Marquardt's method, from the quadric; for a cylinder from both principal curvatures, since
    /// across a narrow map the curvature of the roughness may be the greater.
    ///
    /// ```
    /// use asperity_maps::Form;
    /// use asperity::{Grid, Surface};
    /// use asperity_maps::Topography;
    /// let grid = Grid::square(32, 1.0)?;
    /// let ball = Topography::from(Surface::from_fn(grid, |x, y| (4.0 - x * x - y * y).sqrt() - 2.0)?);
    /// assert!((ball.fit_form(Form::Sphere)?.radius - 2.0).abs() < 1e-9);
    /// assert!(ball.remove_form(Form::Sphere)?.rms_height() < 1e-12);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`fit_form`](Self::fit_form).
    pub fn remove_form(mut self, form: Form) -> Result<Self> {
        let fitted = Fitted::new(&self, form)?;
        let known = self.heights.iter_mut().filter(|h| h.is_finite());
        for (h, [x, y, z]) in known.zip(&fitted.points) {
            *h = fitted.unit * (z - fitted.height(&fitted.parameters, *x, *y).unwrap_or(*z));
        }
        Ok(self)
    }
}

/// A fit in units of half the longer side.
struct Fitted {
    form: Form,
    unit: f64,
    /// x, y and height of each measured point, from the centre of the map and about the mean
    points: Vec<[f64; 3]>,
    parameters: Parameters,
    squares: f64,
}

impl Fitted {
    fn new(map: &Topography, form: Form) -> Result<Self> {
        let requirement = "known, in the unit of the heights: set Topography::lengths";
        let unknown = Error::Value { name: "side length Lx", value: f64::NAN, requirement };
        map.lengths.ok_or(unknown)?;
        let (quadric, mean) = (map.fit(Trend::Quadric)?, map.mean());
        let ((nx, ny), (dx, dy)) = (map.heights.dim(), map.spacing());
        // a line has no width
        let side = |n: usize, spacing: f64| if n > 1 { n as f64 * spacing } else { 0.0 };
        let unit = 0.5 * f64::max(side(nx, dx), side(ny, dy)).max(dx);
        let place = |i: usize, n: usize, spacing: f64| (i as f64 - 0.5 * (n as f64 - 1.0)) * spacing / unit;
        let measured = map.heights.indexed_iter().filter(|(_, h)| h.is_finite());
        let points = measured.map(|((i, j), h)| [place(i, nx, dx), place(j, ny, dy), (h - mean) / unit]).collect();

        let (xx, xy, yy) = quadric.curvatures;
        // the mean curvature, and the two principal curvatures, each with the direction across it
        let (turn, spread) = (0.5 * (2.0 * xy).atan2(xx - yy), 0.5 * (xx - yy).hypot(2.0 * xy));
        let mean_curvature = 0.5 * (xx + yy);
        let mut bends = match form {
            Form::Sphere => vec![(mean_curvature, 0.0)],
            Form::Cylinder => {
                vec![(mean_curvature + spread, turn + std::f64::consts::FRAC_PI_2), (mean_curvature - spread, turn)]
            }
        };
        bends.sort_by(|(a, _), (b, _)| b.abs().total_cmp(&a.abs()));
        let (sx, sy) = quadric.slopes;
        let mut fitted = Self { form, unit, points, parameters: [0.0; PARAMETERS], squares: f64::INFINITY };
        for &(curvature, axis) in &bends {
            let before = (fitted.parameters, fitted.squares);
            // the quadric may be bent more than any form below all points
            let starts = [1.0, 0.5, 0.25, 0.0]
                .map(|share| [(quadric.height - mean) / unit, sx, sy, share * curvature * unit, axis]);
            if let Some((start, squares)) = starts.iter().find_map(|start| Some((*start, fitted.squares_of(start)?))) {
                (fitted.parameters, fitted.squares) = (start, squares);
                fitted.descend();
            }
            // one minimum, found twice, differs by rounding
            if before.1 <= fitted.squares * (1.0 + 1e-9) {
                (fitted.parameters, fitted.squares) = before;
            }
        }
        if !fitted.squares.is_finite() {
            let requirement = "such that a form is below all heights: take a plane or a quadric";
            return Err(Error::Value { name: "curvature of the map", value: bends[0].0, requirement });
        }
        Ok(fitted)
    }

    /// The height of the form at a point, in its own units; nothing beyond its side.
    ///
    /// With u the way from the point of the form above the centre of the map, n the normal there, κ the curvature, and
    /// t the direction of the axis (nothing of a sphere), the points of the form have
    ///
    /// ```math
    /// κ/2 (|u|² − (t·u)²) = n·u
    /// ```
    ///
    /// a quadratic equation for the height, which knows no apex and no centre, so that planes are forms like any other.
    fn height(&self, &[level, sx, sy, curvature, axis]: &Parameters, x: f64, y: f64) -> Option<f64> {
        let normal = (1.0 + sx * sx + sy * sy).sqrt().recip();
        let (sin, cos) = axis.sin_cos();
        let climb = sx * cos + sy * sin;
        let length = if self.form == Form::Cylinder { (1.0 + climb * climb).sqrt().recip() } else { 0.0 };
        let (along, up) = (length * (cos * x + sin * y), length * climb);
        let square = 0.5 * curvature * (1.0 - up * up);
        let linear = normal + curvature * along * up;
        let constant = 0.5 * curvature * (x * x + y * y - along * along) + normal * (sx * x + sy * y);
        let root = linear * linear - 4.0 * square * constant;
        (root > 0.0 && linear > 0.0).then(|| level + 2.0 * constant / (linear + root.sqrt()))
    }

    /// The sum of the squares of the heights above the form; nothing if it does not reach below all points.
    fn squares_of(&self, parameters: &Parameters) -> Option<f64> {
        self.points.iter().try_fold(0.0, |sum, [x, y, z]| {
            let height = self.height(parameters, *x, *y)?;
            Some(sum + (z - height).powi(2))
        })
    }

    /// Descends to the least squares.
    fn descend(&mut self) {
        let free = if self.form == Form::Cylinder { PARAMETERS } else { PARAMETERS - 1 };
        let mut damping = 1e-3;
        for _ in 0..MOST_ITERATIONS {
            let (matrix, right) = self.normal_equations(free);
            let mut damped = matrix;
            for (k, row) in damped.iter_mut().enumerate() {
                // a parameter of no influence, as a slope across a line, stays
                row[k] = if k < free && row[k] > 0.0 { row[k] * (1.0 + damping) } else { 1.0 };
            }
            let step = solved(damped, right);
            let mut trial = self.parameters;
            trial.iter_mut().zip(&step).for_each(|(parameter, step)| *parameter += step);
            let shift: f64 = (0..free).map(|k| step[k] * (0..free).map(|l| matrix[k][l] * step[l]).sum::<f64>()).sum();
            match self.squares_of(&trial) {
                Some(squares) if squares <= self.squares => {
                    (self.parameters, self.squares) = (trial, squares);
                    damping *= 0.1;
                }
                _ => damping *= 10.0,
            }
            // the form moves by less than this share of the residual, or of the rounding of the points
            let rounding = self.points.len() as f64 * f64::EPSILON * f64::EPSILON;
            if shift <= 1e-20 * self.squares + rounding || !shift.is_finite() || damping > 1e12 {
                break;
            }
        }
    }

    /// The normal equations of the linear fit about the form, by central differences.
    fn normal_equations(&self, free: usize) -> ([Parameters; PARAMETERS], Parameters) {
        let moved = |k: usize, by: f64| {
            let mut moved = self.parameters;
            moved[k] += by;
            moved
        };
        let pairs: Vec<_> = (0..free).map(|k| [moved(k, STEP), moved(k, -STEP)]).collect();
        let (mut matrix, mut right) = ([[0.0; PARAMETERS]; PARAMETERS], [0.0; PARAMETERS]);
        for [x, y, z] in &self.points {
            let Some(height) = self.height(&self.parameters, *x, *y) else { continue };
            let mut slopes = [0.0; PARAMETERS];
            for (slope, [above, below]) in slopes.iter_mut().zip(&pairs) {
                let ends = self.height(above, *x, *y).zip(self.height(below, *x, *y));
                *slope = ends.map_or(0.0, |(above, below)| (above - below) / (2.0 * STEP));
            }
            for (k, slope) in slopes.iter().enumerate() {
                right[k] += slope * (z - height);
                matrix[k].iter_mut().zip(&slopes).for_each(|(sum, other)| *sum += slope * other);
            }
        }
        (matrix, right)
    }
}

/// The solution of a symmetric positive definite system, by elimination.
fn solved(mut matrix: [Parameters; PARAMETERS], mut right: Parameters) -> Parameters {
    for k in 0..PARAMETERS {
        let pivot = matrix[k];
        for l in k + 1..PARAMETERS {
            let factor = matrix[l][k] / pivot[k];
            matrix[l].iter_mut().zip(&pivot).for_each(|(entry, pivot)| *entry -= factor * pivot);
            right[l] -= factor * right[k];
        }
    }
    for k in (0..PARAMETERS).rev() {
        let known: f64 = (k + 1..PARAMETERS).map(|l| matrix[k][l] * right[l]).sum();
        right[k] = (right[k] - known) / matrix[k][k];
    }
    right
}
