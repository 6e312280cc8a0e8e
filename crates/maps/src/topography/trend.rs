//! Trends of a height map: least-squares polynomials, fitted and removed.

use std::str::FromStr;

use ndarray::Array2;

use super::Topography;
use asperity::{Error, Result};

/// A trend, which [`Topography::detrend`] takes away.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trend {
    /// The mean height.
    Mean,
    /// The plane a + bx + cy.
    Plane,
    /// The quadric a + bx + cy + dx² + exy + fy², as for a sphere or a cylinder.
    Quadric,
    /// The polynomial of all terms xⁱyᵏ with i + k up to an order, at most [`Trend::HIGHEST_ORDER`]: orders 0, 1 and 2
    /// are the three above.
    Polynomial(usize),
}

/// The least-squares fit of a [`Trend`], about the centre of the map; terms that the trend does not have are 0.
///
/// For a polynomial of higher order they are its derivatives there. Slopes and curvatures are in terms of the side
/// lengths; if these are unknown, of spacings.
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

impl Trend {
    /// The highest order of a polynomial.
    pub const HIGHEST_ORDER: usize = 12;
    /// The names of trends; a polynomial goes by its order.
    pub const NAMES: [&str; 3] = ["mean", "plane", "quadric"];

    fn order(self) -> Result<usize> {
        match self {
            Self::Mean => Ok(0),
            Self::Plane => Ok(1),
            Self::Quadric => Ok(2),
            Self::Polynomial(order) if order <= Self::HIGHEST_ORDER => Ok(order),
            Self::Polynomial(order) => {
                let requirement = "at most 12: beyond, roughness is treated as a trend";
                Err(Error::Value { name: "order of the trend", value: order as f64, requirement })
            }
        }
    }
}

impl FromStr for Trend {
    type Err = String;

    /// A trend by its name, or a polynomial by its order.
    fn from_str(text: &str) -> std::result::Result<Self, String> {
        match (text.trim(), order(text)) {
            ("mean", _) => Ok(Self::Mean),
            ("plane", _) => Ok(Self::Plane),
            ("quadric", _) => Ok(Self::Quadric),
            (_, Some(order)) => Ok(Self::Polynomial(order)),
            _ => Err(format!("it must be {}, or an order from 0 to {}", Self::NAMES.join(", "), Self::HIGHEST_ORDER)),
        }
    }
}

/// The order of a polynomial.
pub(super) fn order(text: &str) -> Option<usize> {
    text.trim().parse().ok().filter(|order| *order <= Trend::HIGHEST_ORDER)
}

impl Topography {
    /// The least-squares fit of a trend to the heights that are not missing.
    ///
    /// Polynomials that these points do not tell apart, as x² on two rows, or y on a line, have no share in it.
    ///
    /// # Errors
    /// [`Error::Value`] if all heights are missing, or the order is above [`Trend::HIGHEST_ORDER`].
    pub fn fit(&self, trend: Trend) -> Result<Fit> {
        let fitted = Fitted::new(self, trend)?;
        let ((nx, ny), (dx, dy)) = (self.heights.dim(), self.spacing());
        let (x, y) = (fitted.frame.0.scaled(0.5 * (nx as f64 - 1.0)), fitted.frame.1.scaled(0.5 * (ny as f64 - 1.0)));
        let (sx, sy) = (1.0 / (fitted.frame.0.half * dx), 1.0 / (fitted.frame.1.half * dy));
        let (along_x, along_y) = (legendre(x, fitted.order), legendre(y, fitted.order));
        let derivative = |of_x: usize, of_y: usize| -> f64 {
            let terms = fitted.terms.iter().zip(&fitted.shares);
            terms.map(|((i, k), share)| share * along_x[*i][of_x] * along_y[*k][of_y]).sum()
        };
        Ok(Fit {
            height: fitted.mean + derivative(0, 0),
            slopes: (derivative(1, 0) * sx, derivative(0, 1) * sy),
            curvatures: (derivative(2, 0) * sx * sx, derivative(1, 1) * sx * sy, derivative(0, 2) * sy * sy),
            residual: fitted.residual,
        })
    }

    /// Removes the least-squares fit of a trend; the rest has the mean 0.
    ///
    /// ```math
    /// h → h − p̂ ,   p̂ = arg min over p of  Σ (h − p)²
    /// ```
    ///
    /// over the polynomials p of the trend, with the sum over all points that are not missing. To see what goes, use
    /// [`fit`](Self::fit).
    ///
    /// ```
    /// use asperity_maps::Trend;
    /// use asperity_maps::Topography;
    /// let heights = ndarray::Array2::from_shape_fn((9, 7), |(i, j)| 5.0 + 0.5 * i as f64 - 2.0 * j as f64);
    /// let plane = Topography::new(heights);
    /// let tilt = plane.fit(Trend::Plane)?;
    /// assert!((tilt.slopes.0 - 0.5).abs() < 1e-14 && (tilt.slopes.1 + 2.0).abs() < 1e-14);
    /// assert!(plane.detrend(Trend::Plane)?.heights.iter().all(|h| h.abs() < 1e-13));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Value`] if all heights are missing, or the order is above [`Trend::HIGHEST_ORDER`].
    pub fn detrend(mut self, trend: Trend) -> Result<Self> {
        let fitted = Fitted::new(&self, trend)?;
        for (i, mut row) in self.heights.rows_mut().into_iter().enumerate() {
            let shares = fitted.along_y(i);
            for (h, values) in row.iter_mut().zip(fitted.columns.rows()) {
                *h = (*h - fitted.mean) - shares.iter().zip(values).map(|(share, value)| share * value).sum::<f64>();
            }
        }
        Ok(self)
    }
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

/// Legendre's polynomials up to an order, each with its first two derivatives.
fn legendre(x: f64, order: usize) -> Vec<[f64; 3]> {
    let mut found: Vec<[f64; 3]> = vec![[1.0, 0.0, 0.0], [x, 1.0, 0.0]];
    for n in 1..order.max(1) {
        let (before, here, step) = (found[n - 1], found[n], 2.0 * n as f64 + 1.0);
        found.push([
            (step * x * here[0] - n as f64 * before[0]) / (n as f64 + 1.0),
            before[1] + step * here[0],
            before[2] + step * here[1],
        ]);
    }
    found.truncate(order + 1);
    found
}

/// A fit to the heights about their mean: the sum of shares · Pᵢ(x) Pₖ(y) over the terms (i, k), with Legendre's
/// polynomials in the coordinates of a frame.
struct Fitted {
    frame: (Frame, Frame),
    mean: f64,
    order: usize,
    terms: Vec<(usize, usize)>,
    shares: Vec<f64>,
    /// the polynomials at each column of the map
    columns: Array2<f64>,
    residual: f64,
}

impl Fitted {
    fn new(map: &Topography, trend: Trend) -> Result<Self> {
        let (mean, order) = (map.mean(), trend.order()?);
        if !mean.is_finite() {
            let requirement = "at least 1: give a map that is not all missing";
            return Err(Error::Value { name: "number of measured heights", value: 0.0, requirement });
        }
        let measured = || map.heights.indexed_iter().filter(|(_, h)| h.is_finite());
        let frame = (Frame::new(measured().map(|((i, _), _)| i)), Frame::new(measured().map(|((_, j), _)| j)));
        // x before y, and low orders before high ones: what cannot be told apart goes to the first
        let terms: Vec<_> = (0..=order).flat_map(|sum| (0..=sum).map(move |k| (sum - k, k))).collect();
        let columns = (0..map.heights.ncols()).flat_map(|j| legendre(frame.1.scaled(j as f64), order));
        let columns = Array2::from_shape_vec((map.heights.ncols(), order + 1), columns.map(|p| p[0]).collect())
            .unwrap_or_default();
        let shares = vec![0.0; terms.len()];
        let mut fitted = Self { frame, mean, order, terms, shares, columns, residual: 0.0 };

        let basis = fitted.basis(map);
        // the second time takes away what rounding left
        for _ in 0..2 {
            let (right, _) = fitted.products(map);
            for q in &basis {
                let share = dot(q, &right);
                fitted.shares.iter_mut().zip(q).for_each(|(p, q)| *p += share * q);
            }
        }
        let (_, squares) = fitted.products(map);
        fitted.residual = (squares / measured().count() as f64).sqrt();
        Ok(fitted)
    }

    /// Polynomials, as shares of the terms, that are orthonormal over what is measured; fewer than there are terms if
    /// the measured points do not tell these apart.
    fn basis(&self, map: &Topography) -> Vec<Vec<f64>> {
        let (n, orders) = (self.terms.len(), self.order + 1);
        // Gram's matrix of the terms, row by row of the map
        let mut gram = Array2::<f64>::zeros((n, n));
        for (i, row) in map.heights.rows().into_iter().enumerate() {
            let mut part = Array2::<f64>::zeros((orders, orders));
            for (_, values) in row.iter().zip(self.columns.rows()).filter(|(h, _)| h.is_finite()) {
                for (mut sums, a) in part.rows_mut().into_iter().zip(values) {
                    sums.iter_mut().zip(values).for_each(|(sum, b)| *sum += a * b);
                }
            }
            let along_x = self.along_x(i);
            for ((a, b), sum) in gram.indexed_iter_mut() {
                let ((ix, iy), (kx, ky)) = (self.terms[a], self.terms[b]);
                *sum += along_x[ix] * along_x[kx] * part[[iy, ky]];
            }
        }
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for term in 0..n {
            let mut own = vec![0.0; n];
            own[term] = 1.0;
            let image = |of: &[f64]| -> Vec<f64> {
                gram.rows().into_iter().map(|row| row.iter().zip(of).map(|(a, b)| a * b).sum()).collect()
            };
            for _ in 0..2 {
                for q in &basis {
                    let share = dot(q, &image(&own));
                    own.iter_mut().zip(q).for_each(|(own, q)| *own -= share * q);
                }
            }
            let square = dot(&own, &image(&own));
            // beyond this it is made of rounding
            if square > 1e-12 * gram[[term, term]] {
                own.iter_mut().for_each(|own| *own /= square.sqrt());
                basis.push(own);
            }
        }
        basis
    }

    /// The sums over the measured points of each term times the height above the fit, and of the square of that.
    fn products(&self, map: &Topography) -> (Vec<f64>, f64) {
        let (mut right, mut squares) = (vec![0.0; self.terms.len()], 0.0);
        for (i, row) in map.heights.rows().into_iter().enumerate() {
            let (mut part, mut part_squares) = (vec![0.0; self.order + 1], 0.0);
            let shares = self.along_y(i);
            for (h, values) in row.iter().zip(self.columns.rows()).filter(|(h, _)| h.is_finite()) {
                let fit: f64 = shares.iter().zip(values).map(|(share, value)| share * value).sum();
                let rest = (h - self.mean) - fit;
                part.iter_mut().zip(values).for_each(|(sum, value)| *sum += rest * value);
                part_squares += rest * rest;
            }
            let along_x = self.along_x(i);
            right.iter_mut().zip(&self.terms).for_each(|(sum, (i, k))| *sum += along_x[*i] * part[*k]);
            squares += part_squares;
        }
        (right, squares)
    }

    /// The polynomials of x at row `i`.
    fn along_x(&self, i: usize) -> Vec<f64> {
        legendre(self.frame.0.scaled(i as f64), self.order).into_iter().map(|p| p[0]).collect()
    }

    /// The shares of the polynomials of y in the fit along row `i`.
    fn along_y(&self, i: usize) -> Vec<f64> {
        let along_x = self.along_x(i);
        let mut shares = vec![0.0; self.order + 1];
        self.terms.iter().zip(&self.shares).for_each(|((i, k), share)| shares[*k] += share * along_x[*i]);
        shares
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
