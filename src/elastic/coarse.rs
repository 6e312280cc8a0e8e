use std::f64::consts::{PI, SQRT_2};
use std::ops::Range;

use asperity_fft::num_complex::Complex;

use crate::fft::{HalfSpectrum, Layout, Products};
use crate::grid::Grid;
use crate::real::Real;

mod cholesky;
mod moments;

use cholesky::{ROWS, decompose, dot, solve, start};
use moments::Moments;

/// Blocks of the contact map for each length of the shortest wave: a product of two waves has half that length, and two
/// blocks resolve a wave.
const BLOCKS: usize = 4;

/// The most nodes of a block along a side: the sum of the places of so many has 32 bits.
const LARGEST: usize = 1 << 16;

/// The longest waves of a grid on a foundation that holds the surface where it is in contact.
///
/// With k the stiffness of the waves, α the stiffness of the foundation, and χ(x) the share of contact near x, the
/// response z to a load r is the Galerkin solution of
///
/// ```math
/// (k + α χ(x)) z = r
/// ```
///
/// in the orthonormal basis 1, √2 cos q·x, √2 sin q·x, by Cholesky.
///
/// A [`Spectral`](super::Spectral) operator makes it and preconditions with it; the solver tells it where the contacts
/// are.
#[derive(Clone, Debug)]
pub struct CoarseSpace {
    /// the mean, and one wave of each pair ±q, sorted by their columns
    waves: Vec<Wave>,
    columns: Vec<Range<usize>>,
    /// the nodes of a block of the contact map along both axes; the last block may have fewer
    block: (usize, usize),
    moments: Moments,
    factor: Vec<f64>,
    workspace: Vec<[f64; ROWS]>,
    apart: [Vec<f64>; 2],
    /// whether the response has no mean over the nodes that are apart
    held: bool,
    load: Vec<Complex<f64>>,
    response: Vec<Complex<f64>>,
    vector: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Wave {
    column: usize,
    row: usize,
    /// the row, in the same column, of the conjugate mode
    mirror: Option<usize>,
    /// the number of wave lengths along both sides
    number: [isize; 2],
    stiffness: f64,
}

impl CoarseSpace {
    /// The space of the longest waves, of about so many dimensions; `None` if there is none but the mean.
    pub(super) fn new(grid: &Grid, layout: Layout, symbol: &dyn Fn(f64, f64) -> f64, dimension: usize) -> Option<Self> {
        let (waves, shape) = (waves(grid, layout, symbol, dimension), grid.shape());
        if waves.len() < 2 {
            return None;
        }
        let highest = [0, 1].map(|axis| waves.iter().map(|wave| wave.number[axis].unsigned_abs()).max().unwrap_or(0));
        let block = (block(shape.0, highest[0]), block(shape.1, highest[1]));
        let columns = waves.last().map_or(0, |wave| wave.column + 1);
        let until = |column| waves.partition_point(|wave| wave.column < column);
        let (columns, count) = ((0..columns).map(|k| until(k)..until(k + 1)).collect(), waves.len());
        let dimension = 2 * count - 1;
        Some(Self {
            waves,
            columns,
            block,
            moments: Moments::new([shape.0, shape.1], [block.0, block.1], highest),
            factor: vec![0.0; start(dimension)],
            workspace: vec![[0.0; ROWS]; dimension],
            apart: [vec![0.0; dimension], vec![0.0; dimension]],
            held: false,
            load: vec![Complex::default(); count],
            response: vec![Complex::default(); count],
            vector: vec![0.0; dimension],
        })
    }

    /// The nodes of a block of the contact map along both axes, and the blocks. The last may be smaller.
    pub(crate) fn blocks(&self) -> [(usize, usize); 2] {
        [self.block, (self.moments.points[0].len(), self.moments.points[1].len())]
    }

    /// Takes the contact map: for the first node of each block, in row-major order, the share of all nodes in contact
    /// about it, each counted for the first nodes around it by linear interpolation.
    ///
    /// `mean_stiffness`, which must be small compared with the foundation's `stiffness`, keeps the mean from being
    /// free. With `held` a response has no mean over the nodes that are apart: the mean gap is given. Returns `false`
    /// if the rounded matrix is not positive.
    pub(crate) fn renew(&mut self, contact: &[f64], stiffness: f64, mean_stiffness: f64, held: bool) -> bool {
        let Self { waves, moments, factor, workspace, apart: [load, response], vector, .. } = self;
        moments.compute(contact);
        let dimension = vector.len();
        factor[0] = moments.at(0, 0).re;
        for (k, wave) in waves.iter().enumerate().skip(1) {
            let (cosine, sine) = factor[start(2 * k - 1)..start(2 * k + 1)].split_at_mut(2 * k);
            [cosine[0], sine[0]] = moments.of_wave(wave.number);
            let pairs = cosine[1..].chunks_mut(2).zip(sine[1..].chunks_mut(2));
            for ((cosine, sine), other) in pairs.zip(&waves[1..]) {
                let [with_cosine, with_sine] = moments.of_waves(wave.number, other.number);
                sine.copy_from_slice(&with_sine);
                cosine.copy_from_slice(&with_cosine[..cosine.len()]);
            }
        }
        for i in 0..dimension {
            let row = &mut factor[start(i)..start(i + 1)];
            load[i] = f64::from(u8::from(i == 0)) - row[0];
            row.iter_mut().for_each(|value| *value *= stiffness);
            row[i] += if i == 0 { mean_stiffness } else { waves[i.div_ceil(2)].stiffness };
        }
        let positive = decompose(factor, workspace);
        if held && positive {
            response.copy_from_slice(load);
            solve(factor, response);
        }
        self.held = held;
        positive
    }

    /// Finds the response to a load, given by its half spectrum.
    pub(super) fn respond<T: Real>(&mut self, spectrum: &HalfSpectrum<T>) {
        let Self { waves, factor, apart, held, load, response, vector, .. } = self;
        spectrum.read(waves.iter().map(|wave| (wave.column, wave.row)), load);
        for (i, load) in load.iter().enumerate() {
            if i == 0 {
                vector[0] = load.re;
            } else {
                (vector[2 * i - 1], vector[2 * i]) = (SQRT_2 * load.re, -SQRT_2 * load.im);
            }
        }
        solve(factor, vector);
        if *held {
            let [apart, lift] = apart;
            let share = dot(apart, vector) / dot(apart, lift);
            if share.is_finite() {
                vector.iter_mut().zip(lift).for_each(|(value, lift)| *value -= share * *lift);
            }
        }
        for (i, response) in response.iter_mut().enumerate() {
            *response = match i {
                0 => Complex::new(vector[0], 0.0),
                _ => Complex::new(vector[2 * i - 1], -vector[2 * i]) / SQRT_2,
            };
        }
    }

    /// Puts the response into a column of the half spectrum, over the response z of the uniform foundation; `sums` are
    /// sums over the column, the second of r·z and the third of z.
    pub(super) fn put<T: Real>(&self, k: usize, column: &mut [Complex<T>], sums: &mut Products) {
        for i in self.columns.get(k).cloned().unwrap_or_default() {
            let (wave, load, response) = (self.waves[i], self.load[i], self.response[i]);
            let places = [Some((wave.row, 1.0)), wave.mirror.map(|row| (row, -1.0))];
            for (row, sign) in places.into_iter().flatten() {
                let mode = Complex::new(T::lit(response.re), T::lit(sign * response.im));
                let change = [mode.re - column[row].re, mode.im - column[row].im].map(T::widen);
                sums[1] += load.re * change[0] + sign * load.im * change[1];
                column[row] = mode;
            }
            if i == 0 {
                sums[2] = response.re;
            }
        }
    }

    pub(super) fn columns(&self) -> usize {
        self.columns.len()
    }
}

/// The nodes of a block along a side of n, a divisor of n unless that takes many more blocks: the map of a surface that
/// repeats within the cell then does so too.
fn block(n: usize, highest: usize) -> usize {
    let most = (n / (BLOCKS * highest + 1)).clamp(1, LARGEST);
    let divides = (most.div_ceil(BLOCKS)..=most).rev().find(|&block| n.is_multiple_of(block));
    divides.unwrap_or(most)
}

/// The mean, and one wave of each pair ±q with |q| up to a radius, sorted by their columns in the half spectrum.
fn waves(grid: &Grid, layout: Layout, symbol: &dyn Fn(f64, f64) -> f64, dimension: usize) -> Vec<Wave> {
    let ((nx, ny), (lx, ly)) = (grid.shape(), grid.lengths());
    // modes per area of the wave numbers, or per length: on a narrow grid, too, only waves along it are long
    let along = |length: f64| PI * dimension as f64 / length;
    let radius = match (nx, ny) {
        (1, _) => along(ly),
        (_, 1) => along(lx),
        _ => (4.0 * PI * dimension as f64 / (lx * ly)).sqrt().min(along(lx.max(ly))),
    };
    let signed = |i: usize, n: usize| if 2 * i < n { i as isize } else { i as isize - n as isize };
    let (columns, rows) = layout.spectrum();
    let wave_numbers = |(i, j): (usize, usize)| (grid.wave_number_x(i), grid.wave_number_y(j));
    // the first mode of a column is its longest wave
    let longest = |column: usize| {
        let (qx, qy) = wave_numbers(layout.mode(column, 0));
        qx.hypot(qy)
    };
    let columns = (0..columns).take_while(|&column| longest(column) <= radius);
    let mut waves = Vec::new();
    for (column, row) in columns.flat_map(|column| (0..rows).map(move |row| (column, row))) {
        let (i, j) = layout.mode(column, row);
        let (qx, qy) = wave_numbers((i, j));
        let nyquist = 2 * i == nx || 2 * j == ny;
        // in the columns that hold both waves of a pair: the second of them
        let second = layout.weight(column) == 1.0 && (column > 0 || 2 * row > rows);
        if qx.hypot(qy) <= radius && !nyquist && !second {
            let mirror = (column == 0 && row > 0).then(|| rows - row);
            let stiffness = if (i, j) == (0, 0) { 0.0 } else { symbol(qx, qy) };
            waves.push(Wave { column, row, mirror, number: [signed(i, nx), signed(j, ny)], stiffness });
        }
    }
    waves
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use ndarray::Array2;

    use super::*;
    use crate::elastic::{ElasticOperator, Foundation, Spectral};

    const SHAPES: [(usize, usize); 6] = [(16, 16), (15, 21), (24, 10), (5, 40), (90, 1), (1, 64)];
    const STIFFNESS: f64 = 3.0;

    fn random(shape: (usize, usize), seed: u32) -> Array2<f64> {
        Array2::from_shape_fn(shape, |(i, j)| crate::surface::uniform([i as u32, j as u32, seed, 0], [7, 0])[0] - 0.5)
    }

    fn body(shape: (usize, usize)) -> Spectral<f64> {
        let grid = Grid::new(shape, (1.0, 0.8)).unwrap();
        Spectral::new(grid, 1.0, |qx, qy| 0.5 * (qx * qx + 2.0 * qy * qy).sqrt()).unwrap()
    }

    fn held_where(body: &mut Spectral<f64>, held: bool) -> (CoarseSpace, Array2<f64>) {
        let shape = body.grid().shape();
        let contact = random(shape, 1).mapv(|x| f64::from(u8::from(x > 0.2)));
        let mut space = body.coarse_space(contact.len() * 3 / 5).unwrap();
        assert_eq!(space.blocks(), [(1, 1), shape]);
        let shares: Vec<f64> = contact.iter().map(|x| x / contact.len() as f64).collect();
        assert!(space.renew(&shares, STIFFNESS, 1e-3, held));
        (space, contact)
    }

    fn precondition(body: &mut Spectral<f64>, space: &mut CoarseSpace, r: &Array2<f64>) -> Array2<f64> {
        let mut z = r.clone();
        let foundation = Foundation { coarse: Some(space), ..Foundation::uniform(0.7, 0.9) };
        let found = body.precondition(r.view(), foundation, z.view_mut()).unwrap();
        let product = product(r, &z);
        assert!((found.descent - product).abs() < 1e-13, "{} {product}", found.descent);
        assert!((found.mean - mean(&z)).abs() < 1e-13);
        z
    }

    fn basis(space: &CoarseSpace, shape: (usize, usize)) -> Vec<Array2<f64>> {
        let mut basis = vec![Array2::ones(shape)];
        for wave in &space.waves[1..] {
            let phase = |(i, j): (usize, usize)| {
                let [a, b] = wave.number.map(|number| number as f64);
                TAU * (a * i as f64 / shape.0 as f64 + b * j as f64 / shape.1 as f64)
            };
            basis.push(Array2::from_shape_fn(shape, |node| SQRT_2 * phase(node).cos()));
            basis.push(Array2::from_shape_fn(shape, |node| SQRT_2 * phase(node).sin()));
        }
        basis
    }

    fn product(a: &Array2<f64>, b: &Array2<f64>) -> f64 {
        (a * b).mean().unwrap()
    }

    fn mean(field: &Array2<f64>) -> f64 {
        field.mean().unwrap()
    }

    #[test]
    fn the_longest_waves_solve_the_galerkin_equations() {
        for shape in SHAPES {
            let mut body = body(shape);
            let (mut space, contact) = held_where(&mut body, false);
            let basis = basis(&space, shape);
            assert!((shape.0 * shape.1 / 4..shape.0 * shape.1).contains(&basis.len()), "{} {shape:?}", basis.len());
            let r = random(shape, 2);
            let z = precondition(&mut body, &mut space, &r);
            let low = basis.iter().fold(Array2::zeros(shape), |low, wave| low + wave * product(wave, &z));
            let mut image = low.clone();
            body.pressure(low.view(), image.view_mut()).unwrap();
            image += &(STIFFNESS * &contact * &low);
            image += 1e-3 * mean(&low);
            for wave in &basis {
                assert!((product(wave, &image) - product(wave, &r)).abs() < 1e-12, "{shape:?}");
            }
            let mut uniform = r.clone();
            body.precondition(r.view(), Foundation::uniform(0.7, 0.9), uniform.view_mut()).unwrap();
            let waves = basis.iter().fold(uniform.clone(), |rest, wave| rest - wave * product(wave, &uniform));
            assert!((&z - &low - &waves).iter().all(|x| x.abs() < 1e-12), "{shape:?}");
        }
    }

    #[test]
    fn the_preconditioner_stays_symmetric_and_positive() {
        for (shape, held) in SHAPES.into_iter().flat_map(|shape| [(shape, false), (shape, true)]) {
            let mut body = body(shape);
            let (mut space, contact) = held_where(&mut body, held);
            let [a, b] = [3, 4].map(|seed| {
                let field = random(shape, seed);
                // under a given mean gap residuals have no mean
                let mean = if held { mean(&field) } else { 0.0 };
                field - mean
            });
            let [of_a, of_b] = [&a, &b].map(|field| precondition(&mut body, &mut space, field));
            assert!((product(&a, &of_b) - product(&of_a, &b)).abs() < 1e-13, "{shape:?} {held}");
            assert!(product(&a, &of_a) > 0.0);
            if held {
                let basis = basis(&space, shape);
                let low = basis.iter().fold(Array2::zeros(shape), |low, wave| low + wave * product(wave, &of_a));
                assert!(product(&(1.0 - &contact), &low).abs() < 1e-13, "{shape:?}");
            }
        }
    }

    #[test]
    fn a_narrow_grid_has_no_more_waves_than_a_square() {
        for shape in [(256, 256), (16384, 4), (4, 16384), (4096, 16), (65536, 1)] {
            let (long, sides) = (shape.0.max(shape.1) as f64, (shape.0 as f64, shape.1 as f64));
            let grid = Grid::new(shape, (sides.0 / long, sides.1 / long)).unwrap();
            let body = Spectral::<f64>::new(grid, 1.0, |qx, qy| 0.5 * qx.hypot(qy)).unwrap();
            let found = body.coarse_space(40).unwrap().vector.len();
            assert!((20..=60).contains(&found), "{found} of 40 on {shape:?}");
        }
    }

    #[test]
    fn blocks_cover_the_grid_and_resolve_the_waves() {
        let mut whole = 0;
        for shape in [(128, 128), (101, 67), (500, 1), (100, 144)] {
            let body = body(shape);
            let mut space = body.coarse_space(20).unwrap();
            let [block, blocks] = space.blocks();
            assert!(block.0 * blocks.0 >= shape.0 && block.1 * blocks.1 >= shape.1 && block != (1, 1));
            assert!(block.0 * (blocks.0 - 1) < shape.0 && block.1 * (blocks.1 - 1) < shape.1);
            if shape.0.is_multiple_of(block.0) && shape.1.is_multiple_of(block.1) {
                let shares = vec![1.0 / (blocks.0 * blocks.1) as f64; blocks.0 * blocks.1];
                assert!(space.renew(&shares, STIFFNESS, 1e-3, false));
                assert!((space.moments.at(0, 0).re - 1.0).abs() < 1e-13);
                let [x, y] = space.moments.highest.map(|highest| highest as isize);
                let waves = (-x..=x).flat_map(|a| (-y..=y).map(move |b| (a, b))).filter(|&wave| wave != (0, 0));
                waves.for_each(|(a, b)| assert!(space.moments.at(a, b).norm() < 1e-13));
                whole += 1;
            }
        }
        assert!(whole > 1);
    }
}
