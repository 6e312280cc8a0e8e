use ndarray::Array2;

use super::Topography;
use crate::error::{Error, Result};

/// Stands for a neighbour beyond the edge of the map.
const NONE: usize = usize::MAX;

impl Topography {
    /// Gives missing points the smoothest values that fit their surroundings: those of a membrane on the edge of the hole.
    ///
    /// They obey the discrete Laplace equation
    ///
    /// ```math
    /// \frac{h_{i+1,j} - h_{ij}}{\Delta x^2} + \frac{h_{i-1,j} - h_{ij}}{\Delta x^2}
    /// + \frac{h_{i,j+1} - h_{ij}}{\Delta y^2} + \frac{h_{i,j-1} - h_{ij}}{\Delta y^2} = 0
    /// ```
    ///
    /// at every missing point, without the terms of neighbours that are beyond the edge of the map, which is not taken as
    /// periodic. There is one solution for any pattern of holes. It lies between the least and the greatest height around
    /// each hole: there are no new peaks, nor the roughness that was there. Measured heights stay as they are. A plane fills its
    /// own holes, but not at the edge of the map: [`detrend`](Self::detrend) first. Without side lengths cells are square.
    ///
    /// By conjugate gradients, to a residual of 1e-12.
    ///
    /// ```
    /// use asperity::Topography;
    /// let mut heights = ndarray::array![[1.0, 2.0, 3.0], [2.0, f64::NAN, 4.0], [3.0, 4.0, 5.0]];
    /// assert_eq!(Topography::new(heights).fill()?.heights[[1, 1]], 3.0);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Value`] if all heights are missing.
    pub fn fill(mut self) -> Result<Self> {
        let mean = self.mean();
        if !mean.is_finite() {
            let requirement = "at least 1: there is nothing to fill from";
            return Err(Error::Value { name: "number of measured heights", value: 0.0, requirement });
        }
        let holes = Holes::new(&self.heights, self.spacing(), mean);
        let values = holes.solve();
        for (node, value) in holes.nodes.iter().zip(values) {
            self.heights[*node] = mean + value;
        }
        Ok(self)
    }
}

/// The Laplace equation at the missing points: Σ w (h − h') = 0 over the neighbours h' of each.
struct Holes {
    nodes: Vec<(usize, usize)>,
    /// of each point, those of its neighbours that are missing too
    neighbours: Vec<[usize; 4]>,
    weights: [f64; 4],
    /// the sum of the weights of all neighbours that exist
    diagonal: Vec<f64>,
    /// what measured neighbours add, about the mean
    right: Vec<f64>,
}

impl Holes {
    fn new(heights: &Array2<f64>, (dx, dy): (f64, f64), mean: f64) -> Self {
        let (nx, ny) = heights.dim();
        let mut index = Array2::from_elem(heights.dim(), NONE);
        let mut nodes = Vec::new();
        for (node, _) in heights.indexed_iter().filter(|(_, h)| !h.is_finite()) {
            index[node] = nodes.len();
            nodes.push(node);
        }
        // relative, so that no unit leaves the range, nor the length that means nothing on a line
        let ratio = (dx / dy).powi(2).clamp(1e-12, 1e12);
        let weights = if ratio <= 1.0 { [1.0, 1.0, ratio, ratio] } else { [1.0 / ratio, 1.0 / ratio, 1.0, 1.0] };
        let mut holes = Self {
            neighbours: Vec::with_capacity(nodes.len()),
            weights,
            diagonal: Vec::new(),
            right: Vec::new(),
            nodes,
        };
        for &(i, j) in &holes.nodes {
            let around = [
                (i + 1 < nx).then(|| (i + 1, j)),
                (i > 0).then(|| (i - 1, j)),
                (j + 1 < ny).then(|| (i, j + 1)),
                (j > 0).then(|| (i, j - 1)),
            ];
            let (mut missing, mut diagonal, mut right) = ([NONE; 4], 0.0, 0.0);
            for (k, node) in around.into_iter().enumerate() {
                let Some(node) = node else { continue };
                diagonal += weights[k];
                missing[k] = index[node];
                if missing[k] == NONE {
                    right += weights[k] * (heights[node] - mean);
                }
            }
            holes.neighbours.push(missing);
            holes.diagonal.push(diagonal);
            holes.right.push(right);
        }
        holes
    }

    fn apply(&self, x: &[f64], y: &mut [f64]) {
        for (k, y) in y.iter_mut().enumerate() {
            let near = self.neighbours[k].iter().zip(self.weights).filter(|(at, _)| **at != NONE);
            *y = self.diagonal[k] * x[k] - near.map(|(at, w)| w * x[*at]).sum::<f64>();
        }
    }

    /// Conjugate gradients, scaled by the diagonal.
    fn solve(&self) -> Vec<f64> {
        let n = self.nodes.len();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut x = vec![0.0; n];
        let mut residual = self.right.clone();
        let scaled = |r: &[f64]| -> Vec<f64> { r.iter().zip(&self.diagonal).map(|(r, d)| r / d).collect() };
        let mut z = scaled(&residual);
        let (mut direction, mut product) = (z.clone(), vec![0.0; n]);
        let mut rho = dot(&residual, &z);
        let enough = 1e-24 * rho;
        // in exact arithmetic n steps are enough
        for _ in 0..10 * n {
            if rho <= enough || !rho.is_finite() {
                break;
            }
            self.apply(&direction, &mut product);
            let step = rho / dot(&direction, &product);
            x.iter_mut().zip(&direction).for_each(|(x, d)| *x += step * d);
            residual.iter_mut().zip(&product).for_each(|(r, p)| *r -= step * p);
            z = scaled(&residual);
            let next = dot(&residual, &z);
            let beta = next / rho;
            direction.iter_mut().zip(&z).for_each(|(d, z)| *d = z + beta * *d);
            rho = next;
        }
        x
    }
}
