//! Trends of a height map: least-squares polynomials, fitted and removed.

use super::Topography;
use crate::error::{Error, Result};

/// A trend, which [`Topography::detrend`] takes away.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trend {
    /// The mean height.
    Mean,
    /// The plane a + bx + cy.
    Plane,
    /// The quadric a + bx + cy + dx² + exy + fy², as of a sphere or a cylinder.
    Quadric,
}

/// The least-squares fit of a [`Trend`], about the centre of the map; terms that the trend does not have are 0.
///
/// Slopes and curvatures are in terms of the side lengths; if those are unknown, of spacings.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The height at the centre of the map.
    pub height: f64,
    /// The slopes ∂h/∂x and ∂h/∂y at the centre of the map.
    pub slopes: (f64, f64),
    /// The curvatures ∂²h/∂x², ∂²h/∂x∂y and ∂²h/∂y².
    pub curvatures: (f64, f64, f64),
    /// The root mean square of the heights about the fit: their rms height after [`Topography::detrend`].
    pub residual: f64,
}

/// Monomials up to the second order.
const TERMS: usize = 6;

type Polynomial = [f64; TERMS];

impl Trend {
    fn terms(self) -> usize {
        match self {
            Self::Mean => 1,
            Self::Plane => 3,
            Self::Quadric => TERMS,
        }
    }
}

impl Topography {
    /// The least-squares fit of a trend to the heights that are not missing.
    ///
    /// Polynomials that these points do not tell apart, as x² on two rows, or y on a line, have no share in it.
    ///
    /// # Errors
    /// [`Error::Value`] if all heights are missing.
    pub fn fit(&self, trend: Trend) -> Result<Fit> {
        let fitted = Fitted::new(self, trend)?;
        let ((nx, ny), (dx, dy)) = (self.heights.dim(), self.spacing());
        let (x, y) = (fitted.frame.0.scaled(0.5 * (nx as f64 - 1.0)), fitted.frame.1.scaled(0.5 * (ny as f64 - 1.0)));
        let (sx, sy) = (1.0 / (fitted.frame.0.half * dx), 1.0 / (fitted.frame.1.half * dy));
        let [_, b, c, d, e, f] = fitted.polynomial;
        Ok(Fit {
            height: fitted.mean + value(&fitted.polynomial, x, y),
            slopes: ((b + 2.0 * d * x + e * y) * sx, (c + e * x + 2.0 * f * y) * sy),
            curvatures: (2.0 * d * sx * sx, e * sx * sy, 2.0 * f * sy * sy),
            residual: fitted.residual,
        })
    }

    /// Takes away the least-squares fit of a trend; what remains has the mean 0.
    ///
    /// ```math
    /// h → h − p̂ ,   p̂ = arg min over p of  Σ (h − p)²
    /// ```
    ///
    /// over the polynomials p of the trend, with the sum over all points that are not missing. To see what goes, use
    /// [`fit`](Self::fit).
    ///
    /// ```
    /// use asperity::{Topography, Trend};
    /// let heights = ndarray::Array2::from_shape_fn((9, 7), |(i, j)| 5.0 + 0.5 * i as f64 - 2.0 * j as f64);
    /// let plane = Topography::new(heights);
    /// let tilt = plane.fit(Trend::Plane)?;
    /// assert!((tilt.slopes.0 - 0.5).abs() < 1e-14 && (tilt.slopes.1 + 2.0).abs() < 1e-14);
    /// assert!(plane.detrend(Trend::Plane)?.heights.iter().all(|h| h.abs() < 1e-13));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Value`] if all heights are missing.
    pub fn detrend(mut self, trend: Trend) -> Result<Self> {
        let Fitted { frame: (fx, fy), mean, polynomial, .. } = Fitted::new(&self, trend)?;
        self.heights.indexed_iter_mut().for_each(|((i, j), h)| {
            *h = (*h - mean) - value(&polynomial, fx.scaled(i as f64), fy.scaled(j as f64));
        });
        Ok(self)
    }
}

fn monomials(x: f64, y: f64) -> Polynomial {
    [1.0, x, y, x * x, x * y, y * y]
}

fn value(polynomial: &Polynomial, x: f64, y: f64) -> f64 {
    dot(polynomial, &monomials(x, y))
}

fn dot(a: &Polynomial, b: &Polynomial) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Indices between −1 and 1 over what is measured, so that monomials are about as large as each other.
#[derive(Clone, Copy)]
struct Frame {
    centre: f64,
    half: f64,
}

impl Frame {
    fn new(measured: impl Iterator<Item = usize>) -> Self {
        let (low, high) = measured.fold((usize::MAX, 0), |(low, high), i| (low.min(i), high.max(i)));
        let (low, high) = (low as f64, high as f64);
        Self { centre: 0.5 * (low + high), half: (0.5 * (high - low)).max(0.5) }
    }

    fn scaled(self, i: f64) -> f64 {
        (i - self.centre) / self.half
    }
}

/// A fit to the heights about their mean, in the coordinates of a frame.
struct Fitted {
    frame: (Frame, Frame),
    mean: f64,
    polynomial: Polynomial,
    residual: f64,
}

impl Fitted {
    fn new(map: &Topography, trend: Trend) -> Result<Self> {
        let mean = map.mean();
        if !mean.is_finite() {
            let requirement = "at least 1: give a map that is not all missing";
            return Err(Error::Value { name: "number of measured heights", value: 0.0, requirement });
        }
        let measured = || map.heights.indexed_iter().filter(|(_, h)| h.is_finite());
        let frame = (Frame::new(measured().map(|((i, _), _)| i)), Frame::new(measured().map(|((_, j), _)| j)));
        let mut fitted = Self { frame, mean, polynomial: [0.0; TERMS], residual: 0.0 };

        // Gram's matrix of the monomials, and polynomials that are orthonormal over what is measured
        let mut gram = [[0.0; TERMS]; TERMS];
        fitted.for_each_row(map, |nodes| {
            let mut part = [[0.0; TERMS]; TERMS];
            for (m, _) in nodes {
                part.iter_mut().zip(m).for_each(|(row, a)| row.iter_mut().zip(m).for_each(|(g, b)| *g += a * b));
            }
            gram.iter_mut().zip(part).for_each(|(row, part)| row.iter_mut().zip(part).for_each(|(g, p)| *g += p));
        });
        let product = |p: &Polynomial, q: &Polynomial| dot(p, &gram.map(|row| dot(&row, q)));
        let mut basis: Vec<Polynomial> = Vec::new();
        for term in 0..trend.terms() {
            let mut own = [0.0; TERMS];
            own[term] = 1.0;
            let whole = gram[term][term];
            for q in basis.iter().chain(&basis) {
                let share = product(q, &own);
                own.iter_mut().zip(q).for_each(|(own, q)| *own -= share * q);
            }
            let square = product(&own, &own);
            // beyond this it is made of rounding
            if square > 1e-12 * whole {
                own.iter_mut().for_each(|own| *own /= square.sqrt());
                basis.push(own);
            }
        }
        // the second time takes away what rounding left
        for _ in 0..2 {
            let mut right = [0.0; TERMS];
            fitted.for_each_row(map, |nodes| {
                let mut part = [0.0; TERMS];
                for (m, h) in nodes {
                    part.iter_mut().zip(m).for_each(|(p, m)| *p += m * h);
                }
                right.iter_mut().zip(part).for_each(|(r, p)| *r += p);
            });
            for q in &basis {
                let share = dot(q, &right);
                fitted.polynomial.iter_mut().zip(q).for_each(|(p, q)| *p += share * q);
            }
        }
        let (mut squares, mut count) = (0.0, 0);
        fitted.for_each_row(map, |nodes| {
            squares += nodes.iter().map(|(_, h)| h * h).sum::<f64>();
            count += nodes.len();
        });
        fitted.residual = (squares / count as f64).sqrt();
        Ok(fitted)
    }

    /// The monomials at the measured points of each row, and how much higher they are than the fit.
    fn for_each_row(&self, map: &Topography, mut f: impl FnMut(&[(Polynomial, f64)])) {
        let mut nodes = Vec::new();
        for (i, row) in map.heights.rows().into_iter().enumerate() {
            let x = self.frame.0.scaled(i as f64);
            nodes.clear();
            nodes.extend(row.iter().enumerate().filter(|(_, h)| h.is_finite()).map(|(j, h)| {
                let m = monomials(x, self.frame.1.scaled(j as f64));
                (m, (h - self.mean) - dot(&self.polynomial, &m))
            }));
            f(&nodes);
        }
    }
}
