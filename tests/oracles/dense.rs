//! The elastic body as a dense matrix, and its equilibria by elimination: no transform, no gradient.

use std::f64::consts::{PI, TAU};

use asperity::Grid;

/// The body as the nodes feel it that face a surface: the others, and the rigid shift of a free body, give way.
pub struct Dense {
    /// the nodes of the surface, absent ones among them
    pub nodes: usize,
    /// those that face the body
    pub faces: Vec<usize>,
    /// the displacement of such a node by a unit pressure on another; in a periodic cell without its mean
    pub compliance: Vec<f64>,
    /// the pressure K⁻¹u of a displacement of these nodes, which a rigid shift does not change
    pub stiffness: Vec<f64>,
    /// the weight of each node in the displacement x on which a load works
    pub share: Vec<f64>,
    /// the mean pressure by a unit rigid shift; infinite in a periodic cell, which has none
    pub rigid: f64,
    /// of the softest and the stiffest wave; of a part of the nodes a bound from either side
    pub softest: f64,
    pub stiffest: f64,
}

/// What holds the displacement x on which the load works.
#[derive(Clone, Copy, Debug)]
pub enum Held {
    /// x itself
    Shift(f64),
    /// the mean pressure
    Pressure(f64),
    /// the mean pressure `stiffness`·(x − `rest`)
    Spring { stiffness: f64, rest: f64 },
}

impl Held {
    /// The mean pressure at a displacement; zero where that is held.
    pub fn pressure(self, x: f64) -> f64 {
        match self {
            Self::Shift(_) => 0.0,
            Self::Pressure(pressure) => pressure,
            Self::Spring { stiffness, rest } => stiffness * (x - rest),
        }
    }

    pub fn stiffness(self) -> f64 {
        if let Self::Spring { stiffness, .. } = self { stiffness } else { 0.0 }
    }
}

/// The energy of a node by its gap: traction and slope.
pub type Local<'a> = &'a dyn Fn(usize, f64) -> [f64; 2];

fn nodes_of((nx, ny): (usize, usize)) -> impl Iterator<Item = (usize, usize)> {
    (0..nx).flat_map(move |i| (0..ny).map(move |j| (i, j)))
}

impl Dense {
    /// A half-space in a periodic cell.
    pub fn new(shape: (usize, usize), lengths: (f64, f64), modulus: f64) -> Self {
        Self::from_stiffness(shape, lengths, |qx, qy| 0.5 * modulus * qx.hypot(qy))
    }

    /// A periodic cell of the stiffness of every wave: K⁻¹ and K by their defining sums over waves.
    pub fn from_stiffness((nx, ny): (usize, usize), (lx, ly): (f64, f64), stiffness: impl Fn(f64, f64) -> f64) -> Self {
        let nodes = nx * ny;
        let wave = |i: usize, n: usize, length: f64| {
            let signed = if 2 * i > n { i as f64 - n as f64 } else { i as f64 };
            TAU * signed / length
        };
        let (mut softest, mut stiffest) = (f64::INFINITY, 0.0_f64);
        let (mut stiff, mut soft) = (vec![0.0; nodes], vec![0.0; nodes]);
        let circle = |n: usize| (0..n).map(|k| (TAU * k as f64 / n as f64).sin_cos()).collect::<Vec<_>>();
        let (along_x, along_y) = (circle(nx), circle(ny));
        for (i, j) in nodes_of((nx, ny)).skip(1) {
            let k = stiffness(wave(i, nx, lx), wave(j, ny, ly));
            (softest, stiffest) = (softest.min(k), stiffest.max(k));
            for (a, b) in nodes_of((nx, ny)) {
                let ((sx, cx), (sy, cy)) = (along_x[(i * a) % nx], along_y[(j * b) % ny]);
                let cosine = cx * cy - sx * sy;
                stiff[a * ny + b] += k * cosine / nodes as f64;
                soft[a * ny + b] += cosine / k / nodes as f64;
            }
        }
        let spread = |kernel: &[f64]| {
            let pairs = nodes_of((nx, ny)).flat_map(|from| nodes_of((nx, ny)).map(move |to| (from, to)));
            pairs.map(|((i, j), (a, b))| kernel[(i + nx - a) % nx * ny + (j + ny - b) % ny]).collect()
        };
        let (faces, share) = ((0..nodes).collect(), vec![1.0 / nodes as f64; nodes]);
        softest = if nodes == 1 { 0.0 } else { softest };
        let (compliance, stiffness) = (spread(&soft), spread(&stiff));
        Self { nodes, faces, compliance, stiffness, share, rigid: f64::INFINITY, softest, stiffest }
    }

    /// A free half-space: Love's displacement of every node by a unit pressure on every cell, with logarithms.
    pub fn free(grid: &Grid, modulus: f64) -> Self {
        let ((nx, ny), (dx, dy)) = (grid.shape(), grid.spacing());
        let (a, b) = (0.5 * dx, 0.5 * dy);
        let kernel = |i: usize, j: usize| {
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
        };
        let kernel: Vec<f64> = nodes_of((nx, ny)).map(|(i, j)| kernel(i, j)).collect();
        let pairs = nodes_of((nx, ny)).flat_map(|from| nodes_of((nx, ny)).map(move |to| (from, to)));
        let compliance = pairs.map(|((i, j), (k, l))| kernel[i.abs_diff(k) * ny + j.abs_diff(l)]).collect();
        Self::pressed(nx * ny, (0..nx * ny).collect(), compliance, true)
    }

    /// The same body where a surface faces it at some nodes only.
    pub fn facing(self, faces: &[bool]) -> Self {
        if faces.iter().all(|faces| *faces) {
            return self;
        }
        let kept: Vec<usize> = (0..self.nodes).filter(|&node| faces[node]).collect();
        let n = self.faces.len();
        let compliance = kept.iter().flat_map(|&i| kept.iter().map(move |&j| (i, j)));
        let compliance = compliance.map(|(i, j)| self.compliance[i * n + j]).collect();
        Self::pressed(self.nodes, kept, compliance, self.rigid.is_finite())
    }

    /// Of the compliance between the nodes that face a surface.
    fn pressed(nodes: usize, faces: Vec<usize>, compliance: Vec<f64>, free: bool) -> Self {
        let n = faces.len();
        // a rigid shift is no deformation of a periodic cell: any compliance of the mean does
        let mean = if free { 0.0 } else { compliance[0] };
        let mut stiffness = inverse(compliance.iter().map(|value| value + mean).collect(), n);
        let punch: Vec<f64> = stiffness.chunks(n).map(|row| row.iter().sum()).collect();
        let total: f64 = punch.iter().sum();
        for (row, pressure) in stiffness.chunks_mut(n).zip(&punch) {
            row.iter_mut().zip(&punch).for_each(|(value, other)| *value -= pressure * other / total);
        }
        let largest = |matrix: &[f64]| {
            matrix.chunks(n).map(|row| row.iter().map(|value| value.abs()).sum::<f64>()).fold(0.0, f64::max)
        };
        let (softest, stiffest) = (1.0 / largest(&compliance), largest(&stiffness));
        let share = punch.iter().map(|pressure| pressure / total).collect();
        let rigid = if free { total / nodes as f64 } else { f64::INFINITY };
        Self { nodes, faces, compliance, stiffness, share, rigid, softest, stiffest }
    }

    pub fn displacement(&self, pressure: &[f64]) -> Vec<f64> {
        product(&self.compliance, pressure)
    }

    pub fn pressure(&self, u: &[f64]) -> Vec<f64> {
        // without the rounding of what is rigid
        let shift = self.shift(u);
        product(&self.stiffness, &u.iter().map(|u| u - shift).collect::<Vec<_>>())
    }

    /// The mean of a·K a.
    pub fn compliant(&self, a: &[f64]) -> f64 {
        dot(a, &self.displacement(a)).max(0.0) / self.nodes as f64
    }

    /// The mean of u·K⁻¹u.
    pub fn work(&self, u: &[f64]) -> f64 {
        let shift = self.shift(u);
        let u: Vec<f64> = u.iter().map(|u| u - shift).collect();
        dot(&u, &product(&self.stiffness, &u)).max(0.0) / self.nodes as f64
    }

    /// The displacement x on which a load works.
    pub fn shift(&self, u: &[f64]) -> f64 {
        dot(&self.share, u)
    }

    /// The full pressure at a displacement and a mean pressure.
    pub fn full(&self, u: &[f64], mean: f64) -> Vec<f64> {
        self.pressure(u).iter().zip(&self.share).map(|(p, share)| p + self.nodes as f64 * share * mean).collect()
    }

    /// The entries next to the second derivative where the shift is held, over the shares: as large as the stiffness, so
    /// that elimination takes its pivots by what they mean.
    fn border(&self) -> f64 {
        self.nodes as f64 * self.stiffest
    }

    /// The second derivative of the energy on some nodes, less a number, where the others do not move.
    pub fn hessian(&self, free: &[usize], held: Held, slopes: &[f64], less: f64) -> Vec<Vec<f64>> {
        let (n, mean) = (self.faces.len(), self.nodes as f64 * held.stiffness());
        let of = |i: usize, j: usize| self.stiffness[i * n + j] + mean * self.share[i] * self.share[j];
        let mut rows: Vec<Vec<f64>> = free.iter().map(|&i| free.iter().map(|&j| of(i, j)).collect()).collect();
        rows.iter_mut().enumerate().for_each(|(k, row)| row[k] += slopes[free[k]] - less);
        if let Held::Shift(_) = held {
            let border: Vec<f64> = free.iter().map(|&i| self.border() * self.share[i]).collect();
            rows.iter_mut().zip(&border).for_each(|(row, value)| row.push(*value));
            rows.push(border.into_iter().chain([0.0]).collect());
        }
        rows
    }

    /// How many eigenvalues of that second derivative are below a number.
    pub fn below(&self, free: &[usize], held: Held, slopes: &[f64], number: f64) -> usize {
        let border = usize::from(matches!(held, Held::Shift(_)));
        negative(self.hessian(free, held, slopes, number)).saturating_sub(border)
    }

    /// The gap in equilibrium, from one near by: K⁻¹u + traction + load vanish where nodes are apart, and press where
    /// they touch a wall at zero gap, if there is one, which yields where they press with more than `most`. Nothing if
    /// the elimination finds none.
    pub fn equilibrium(
        &self,
        heights: &[f64],
        held: Held,
        local: Local<'_>,
        most: Option<f64>,
        start: &[f64],
    ) -> Option<Vec<f64>> {
        let n = self.faces.len();
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        // above the wall, at it, and below where it yields
        let side = |gap: f64| if most.is_none() || gap > 0.0 { 1.0 } else { -f64::from(u8::from(gap < 0.0)) };
        let (mut gap, mut sides) = (start.to_vec(), start.iter().map(|&g| side(g)).collect::<Vec<f64>>());
        let local = |i: usize, gap: f64, side: f64| match most {
            Some(most) if side < 0.0 => [local(i, 0.0)[0] - most, 0.0],
            _ => local(i, gap),
        };
        let length = largest(heights).max(largest(start));
        let mut last = f64::INFINITY;
        for round in 0..300 {
            let locals: Vec<[f64; 2]> = (0..n).map(|i| local(i, gap[i], sides[i])).collect();
            let slopes: Vec<f64> = locals.iter().map(|[_, slope]| *slope).collect();
            let rigid = slopes.iter().all(|slope| *slope == 0.0) && matches!(held, Held::Pressure(_));
            if rigid && most.is_some() && !sides.contains(&0.0) {
                // nothing but a contact resists the load
                sides[(0..n).max_by(|&a, &b| heights[a].total_cmp(&heights[b]))?] = 0.0;
            }
            let free: Vec<usize> = (0..n).filter(|&i| sides[i] != 0.0).collect();
            let mut level = 0.0;
            let residual = |gap: &[f64], sides: &[f64], level: f64| -> Vec<f64> {
                let u: Vec<f64> = gap.iter().zip(heights).map(|(g, h)| g + h).collect();
                let mean = held.pressure(self.shift(&u)) + level;
                self.full(&u, mean).iter().enumerate().map(|(i, p)| p + local(i, gap[i], sides[i])[0]).collect()
            };
            let (r, before) = (residual(&gap, &sides, 0.0), gap.clone());
            if !free.is_empty() {
                let mut right: Vec<f64> = free.iter().map(|&i| -r[i]).collect();
                if let Held::Shift(x) = held {
                    let u: Vec<f64> = gap.iter().zip(heights).map(|(g, h)| g + h).collect();
                    right.push(self.border() * (x - self.shift(&u)));
                }
                let step = eliminate(self.hessian(&free, held, &slopes, 0.0), right)?;
                free.iter().zip(&step).for_each(|(&i, step)| gap[i] += step);
                level = if step.len() > free.len() { self.stiffest * step[free.len()] } else { 0.0 };
            }
            let (r, size) = (residual(&gap, &sides, level), largest(&self.pressure(heights)).max(level.abs()));
            let edge = 1e-11 * size.max(held.pressure(0.0).abs());
            // the side on which a node has to be
            let right = |i: usize| match most {
                Some(_) if sides[i] == 0.0 && r[i] < -edge => 1.0,
                Some(most) if sides[i] == 0.0 && r[i] > most + edge => -1.0,
                Some(_) if sides[i] * gap[i] < -1e-12 * length => 0.0,
                _ => sides[i],
            };
            let wrong: Vec<(usize, f64)> =
                (0..n).map(|i| (i, right(i))).filter(|&(i, side)| side != sides[i]).collect();
            let change = gap.iter().zip(&before).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            if wrong.is_empty() && (change <= 1e-13 * length || change <= 1e-9 * length && change >= 0.5 * last) {
                return gap.iter().all(|g| g.is_finite()).then_some(gap);
            }
            last = change;
            let flipped = if round < 40 { wrong.len() } else { 1 };
            wrong.iter().rev().take(flipped).for_each(|&(i, side)| sides[i] = side);
            (0..n).filter(|&i| sides[i] == 0.0).for_each(|i| gap[i] = 0.0);
        }
        None
    }
}

/// The inverse of a positive matrix, by Gauss and Jordan.
fn inverse(mut matrix: Vec<f64>, n: usize) -> Vec<f64> {
    for k in 0..n {
        let pivot = 1.0 / matrix[k * n + k];
        matrix[k * n + k] = 1.0;
        matrix[k * n..(k + 1) * n].iter_mut().for_each(|value| *value *= pivot);
        let row = matrix[k * n..(k + 1) * n].to_vec();
        for i in (0..n).filter(|&i| i != k) {
            let factor = std::mem::take(&mut matrix[i * n + k]);
            matrix[i * n..(i + 1) * n].iter_mut().zip(&row).for_each(|(value, other)| *value -= factor * other);
        }
    }
    matrix
}

/// The solution of a linear system by Gaussian elimination with pivots; nothing if it is singular.
pub fn eliminate(mut rows: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let n = rows.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs()))?;
        rows.swap(k, pivot);
        right.swap(k, pivot);
        let (above, rest) = rows[k..].split_first_mut()?;
        if above[k] == 0.0 || !above[k].is_finite() {
            return None;
        }
        for (i, row) in rest.iter_mut().enumerate() {
            let factor = row[k] / above[k];
            row[k..].iter_mut().zip(&above[k..]).for_each(|(value, above)| *value -= factor * above);
            right[k + 1 + i] -= factor * right[k];
        }
    }
    for k in (0..n).rev() {
        let known = dot(&rows[k][k + 1..], &right[k + 1..]);
        right[k] = (right[k] - known) / rows[k][k];
    }
    Some(right)
}

/// The number of negative eigenvalues of a symmetric matrix, by the signs of its pivots.
pub fn negative(mut rows: Vec<Vec<f64>>) -> usize {
    let mut count = 0;
    for k in 0..rows.len() {
        let Some((above, rest)) = rows[k..].split_first_mut() else { break };
        count += usize::from(above[k] < 0.0);
        for row in rest {
            let factor = row[k] / above[k];
            row[k..].iter_mut().zip(&above[k..]).for_each(|(value, above)| *value -= factor * above);
        }
    }
    count
}

fn product(matrix: &[f64], x: &[f64]) -> Vec<f64> {
    matrix.chunks(x.len()).map(|row| dot(row, x)).collect()
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn mean_product(a: &[f64], b: &[f64]) -> f64 {
    dot(a, b) / a.len() as f64
}
