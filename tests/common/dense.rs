//! The half-space as a dense matrix, and the contact problem without adhesion solved by direct elimination.

use std::f64::consts::TAU;

/// K⁻¹ and K, by their defining sums over waves; no transform, no iteration.
pub struct Dense {
    pub nodes: usize,
    pub stiffness: Vec<f64>,
    pub compliance: Vec<f64>,
    pub softest: f64,
    pub stiffest: f64,
}

impl Dense {
    pub fn new((nx, ny): (usize, usize), (lx, ly): (f64, f64), modulus: f64) -> Self {
        let nodes = nx * ny;
        let wave = |i: usize, n: usize, length: f64| {
            let signed = if 2 * i > n { i as f64 - n as f64 } else { i as f64 };
            TAU * signed / length
        };
        let (mut softest, mut stiffest) = (f64::INFINITY, 0.0_f64);
        let (mut stiff, mut soft) = (vec![0.0; nodes], vec![0.0; nodes]);
        let cosines = |n: usize| (0..n).map(|k| (TAU * k as f64 / n as f64).cos()).collect::<Vec<_>>();
        let sines = |n: usize| (0..n).map(|k| (TAU * k as f64 / n as f64).sin()).collect::<Vec<_>>();
        let (cx, sx, cy, sy) = (cosines(nx), sines(nx), cosines(ny), sines(ny));
        for (i, j) in (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))).skip(1) {
            let k = 0.5 * modulus * wave(i, nx, lx).hypot(wave(j, ny, ly));
            (softest, stiffest) = (softest.min(k), stiffest.max(k));
            for (a, b) in (0..nx).flat_map(|a| (0..ny).map(move |b| (a, b))) {
                let (x, y) = ((i * a) % nx, (j * b) % ny);
                let cosine = cx[x] * cy[y] - sx[x] * sy[y];
                stiff[a * ny + b] += k * cosine / nodes as f64;
                soft[a * ny + b] += cosine / k / nodes as f64;
            }
        }
        let spread = |kernel: &[f64]| {
            let mut matrix = Vec::with_capacity(nodes * nodes);
            for (i, j) in (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))) {
                for (a, b) in (0..nx).flat_map(|a| (0..ny).map(move |b| (a, b))) {
                    matrix.push(kernel[(i + nx - a) % nx * ny + (j + ny - b) % ny]);
                }
            }
            matrix
        };
        if nodes == 1 {
            softest = 0.0;
        }
        Self { nodes, stiffness: spread(&stiff), compliance: spread(&soft), softest, stiffest }
    }

    pub fn pressure(&self, u: &[f64]) -> Vec<f64> {
        product(&self.stiffness, u)
    }

    /// The mean of a·K a.
    pub fn compliant(&self, a: &[f64]) -> f64 {
        mean_product(a, &product(&self.compliance, a)).max(0.0)
    }

    /// The gap that solves the problem without adhesion, from a guess of the contact: at a mean gap, or under a
    /// pressure. Nothing if the elimination cycles.
    pub fn solve(&self, surface: &[f64], gap: Option<f64>, pressure: f64, guess: &[bool]) -> Option<Vec<f64>> {
        let n = self.nodes;
        let load = self.pressure(surface);
        let size = load.iter().fold(0.0_f64, |a, b| a.max(b.abs())).max(pressure.abs());
        let length = surface.iter().fold(0.0_f64, |a, b| a.max(b.abs())).max(gap.unwrap_or(0.0));
        let mut contact = guess.to_vec();
        for round in 0..400 {
            let free: Vec<usize> = (0..n).filter(|&i| !contact[i]).collect();
            let (mut g, mut level) = (vec![0.0; n], -pressure);
            if free.len() == n {
                let highest = (0..n).max_by(|&a, &b| surface[a].total_cmp(&surface[b]))?;
                let mean = surface.iter().sum::<f64>() / n as f64;
                match gap {
                    Some(gap) if gap >= surface[highest] - mean => {
                        return Some(surface.iter().map(|h| gap + mean - h).collect());
                    }
                    _ => contact[highest] = true,
                }
                continue;
            }
            if free.is_empty() && gap.is_some_and(|gap| gap > 0.0) {
                contact = (0..n).map(|i| surface[i] >= 0.0).collect();
                if contact.iter().all(|c| *c) {
                    return None;
                }
                continue;
            }
            let factor = self.factor(&free)?;
            let x = substitute(&factor, free.iter().map(|&i| -load[i]).collect());
            let y = substitute(&factor, vec![1.0; free.len()]);
            if let Some(gap) = gap {
                level = (n as f64 * gap - x.iter().sum::<f64>()) / y.iter().sum::<f64>();
            }
            free.iter().enumerate().for_each(|(k, &i)| g[i] = x[k] + level * y[k]);
            let r = self.pressure(&g);
            let wrong = |i: usize| {
                if contact[i] { r[i] + load[i] - level < -1e-11 * size } else { g[i] < -1e-12 * length }
            };
            let wrong: Vec<usize> = (0..n).filter(|&i| wrong(i)).collect();
            if wrong.is_empty() {
                return Some(g);
            }
            let flipped = if round < 40 { wrong.len() } else { 1 };
            wrong.iter().rev().take(flipped).for_each(|&i| contact[i] = !contact[i]);
        }
        None
    }

    /// The Cholesky factor of the rows and columns of these nodes.
    fn factor(&self, free: &[usize]) -> Option<Vec<Vec<f64>>> {
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(free.len());
        for (i, &a) in free.iter().enumerate() {
            let mut row = Vec::with_capacity(i + 1);
            for (j, &b) in free[..=i].iter().enumerate() {
                let above: &[f64] = if j < i { &rows[j][..j] } else { &row[..j] };
                let sum: f64 = row.iter().zip(above).map(|(x, y): (&f64, &f64)| x * y).sum();
                let left = self.stiffness[a * self.nodes + b] - sum;
                if i == j {
                    if left <= 0.0 {
                        return None;
                    }
                    row.push(left.sqrt());
                } else {
                    row.push(left / rows[j][j]);
                }
            }
            rows.push(row);
        }
        Some(rows)
    }
}

fn substitute(factor: &[Vec<f64>], mut b: Vec<f64>) -> Vec<f64> {
    for i in 0..b.len() {
        let sum: f64 = factor[i][..i].iter().zip(&b).map(|(l, x)| l * x).sum();
        b[i] = (b[i] - sum) / factor[i][i];
    }
    for i in (0..b.len()).rev() {
        b[i] /= factor[i][i];
        let x = b[i];
        b[..i].iter_mut().zip(&factor[i]).for_each(|(b, l)| *b -= l * x);
    }
    b
}

fn product(matrix: &[f64], x: &[f64]) -> Vec<f64> {
    matrix.chunks(x.len()).map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
}

pub fn mean_product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / a.len() as f64
}
