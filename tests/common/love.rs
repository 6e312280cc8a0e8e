//! Love's kernel as a dense matrix, and contact without adhesion solved by direct elimination.

use std::f64::consts::PI;

use asperity::Grid;
use ndarray::Array2;

/// The displacement of every node by a unit pressure on every cell, by the formula with logarithms; no transform.
pub struct Love {
    pub nodes: usize,
    pub matrix: Vec<f64>,
}

impl Love {
    pub fn new(grid: &Grid, modulus: f64) -> Self {
        let ((nx, ny), (dx, dy)) = (grid.shape(), grid.spacing());
        let (a, b) = (0.5 * dx, 0.5 * dy);
        let kernel = Array2::from_shape_fn((nx, ny), |(i, j)| {
            let (x, y) = (i as f64 * dx, j as f64 * dy);
            // the integral of 1/r over the cell: the primitive at its four corners
            let primitive = |x: f64, y: f64| {
                let r = x.hypot(y);
                let log = |t: f64, s: f64| if t == 0.0 { 0.0 } else { t * ((s + r) / t.abs()).ln() };
                log(x, y) + log(y, x)
            };
            let sum =
                primitive(x + a, y + b) + primitive(x - a, y - b) - primitive(x + a, y - b) - primitive(x - a, y + b);
            sum / (PI * modulus)
        });
        let nodes = nx * ny;
        let mut matrix = Vec::with_capacity(nodes * nodes);
        for (i, j) in (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))) {
            for (k, l) in (0..nx).flat_map(|k| (0..ny).map(move |l| (k, l))) {
                matrix.push(kernel[[i.abs_diff(k), j.abs_diff(l)]]);
            }
        }
        Self { nodes, matrix }
    }

    pub fn displacement(&self, pressure: &[f64]) -> Vec<f64> {
        self.matrix.chunks(self.nodes).map(|row| row.iter().zip(pressure).map(|(a, p)| a * p).sum()).collect()
    }

    /// The pressure that solves the problem without adhesion on the nodes that face the surface, at a rigid shift c:
    /// u = A p + c ≥ h, p ≥ 0, and one of them an equality. Nothing if the elimination cycles.
    pub fn pressure_at(&self, heights: &[f64], faces: &[bool], shift: f64) -> Option<Vec<f64>> {
        let mut contact: Vec<bool> = heights.iter().zip(faces).map(|(h, faces)| *faces && *h > shift).collect();
        for _ in 0..200 {
            let set: Vec<usize> = (0..self.nodes).filter(|&i| contact[i]).collect();
            let found = self.solve(&set, set.iter().map(|&i| heights[i] - shift).collect());
            let mut pressure = vec![0.0; self.nodes];
            set.iter().zip(found).for_each(|(&i, p)| pressure[i] = p);
            let u = self.displacement(&pressure);
            let wrong = |i: usize| match contact[i] {
                true => pressure[i] < 0.0,
                false => faces[i] && u[i] + shift - heights[i] < -1e-13,
            };
            let wrong: Vec<usize> = (0..self.nodes).filter(|&i| wrong(i)).collect();
            if wrong.is_empty() {
                return Some(pressure);
            }
            wrong.into_iter().for_each(|i| contact[i] = !contact[i]);
        }
        None
    }

    /// Cholesky's elimination on some rows and columns.
    fn solve(&self, set: &[usize], mut b: Vec<f64>) -> Vec<f64> {
        let n = set.len();
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(n);
        for (i, &at) in set.iter().enumerate() {
            let mut row = Vec::with_capacity(i + 1);
            for (j, &other) in set[..=i].iter().enumerate() {
                let above: &[f64] = if j < i { &rows[j] } else { &row };
                let sum: f64 = row.iter().zip(above).map(|(x, y): (&f64, &f64)| x * y).sum();
                let left = self.matrix[at * self.nodes + other] - sum;
                row.push(if i == j { left.sqrt() } else { left / rows[j][j] });
            }
            rows.push(row);
        }
        for i in 0..n {
            let sum: f64 = rows[i][..i].iter().zip(&b).map(|(l, x)| l * x).sum();
            b[i] = (b[i] - sum) / rows[i][i];
        }
        for i in (0..n).rev() {
            b[i] /= rows[i][i];
            let x = b[i];
            b[..i].iter_mut().zip(&rows[i]).for_each(|(b, l)| *b -= l * x);
        }
        b
    }
}
