use std::f64::consts::{SQRT_2, TAU};

use asperity_fft::num_complex::Complex;

/// The moments of the contact map χ: the means of χ e^(−iq·x) for the waves q up to twice the highest of the space.
#[derive(Clone, Debug)]
pub(super) struct Moments {
    /// the first nodes of the blocks along both axes, as shares of the side
    pub(super) points: [Vec<f64>; 2],
    /// their factors e^(−iqx) for one wave length on a side, and for the wave number in hand
    turns: [[Vec<Complex<f64>>; 2]; 2],
    pub(super) highest: [usize; 2],
    rows: Vec<Complex<f64>>,
    /// the moments, for all wave numbers of both signs along x and from 0 on along y
    values: Vec<Complex<f64>>,
}

impl Moments {
    pub(super) fn new(shape: [usize; 2], block: [usize; 2], highest: [usize; 2]) -> Self {
        let highest = highest.map(|highest| 2 * highest);
        let points = [0, 1].map(|axis| {
            let n = shape[axis];
            (0..n).step_by(block[axis]).map(|first| first as f64 / n as f64).collect::<Vec<_>>()
        });
        let turns = [0, 1].map(|axis| {
            let once: Vec<_> = points[axis].iter().map(|x| Complex::from_polar(1.0, -TAU * x)).collect();
            [once.clone(), once]
        });
        let rows = vec![Complex::default(); points[0].len() * (highest[1] + 1)];
        let values = vec![Complex::default(); (2 * highest[0] + 1) * (highest[1] + 1)];
        Self { points, turns, highest, rows, values }
    }

    /// Takes the moments of a contact map, block by block in row-major order.
    pub(super) fn compute(&mut self, contact: &[f64]) {
        let Self { points: [_, y], turns: [turns_x, turns_y], highest, rows, values } = self;
        let along_y = highest[1] + 1;
        for k in 0..along_y {
            let turns = power(turns_y, k);
            for (row, contact) in rows.chunks_mut(along_y).zip(contact.chunks(y.len())) {
                row[k] = contact.iter().zip(turns).map(|(share, turn)| turn * share).sum();
            }
        }
        values.fill(Complex::default());
        for k in 0..=highest[0] {
            let turns = power(turns_x, k);
            let (back, forth) = values.split_at_mut(highest[0] * along_y);
            let forth = &mut forth[k * along_y..][..along_y];
            for (row, turn) in rows.chunks(along_y).zip(turns) {
                forth.iter_mut().zip(row).for_each(|(value, row)| *value += row * turn);
            }
            if k > 0 {
                let back = &mut back[(highest[0] - k) * along_y..][..along_y];
                for (row, turn) in rows.chunks(along_y).zip(turns) {
                    back.iter_mut().zip(row).for_each(|(value, row)| *value += row * turn.conj());
                }
            }
        }
    }

    pub(super) fn at(&self, a: isize, b: isize) -> Complex<f64> {
        let [x, y] = self.highest;
        let value = |a: isize, b: isize| self.values[(x as isize + a) as usize * (y + 1) + b as usize];
        if b < 0 { value(-a, -b).conj() } else { value(a, b) }
    }

    /// The means of χ √2 cos and χ √2 sin of a wave, by its numbers of wave lengths along both sides.
    pub(super) fn of_wave(&self, [a, b]: [isize; 2]) -> [f64; 2] {
        parts(self.at(a, b)).map(|part| SQRT_2 * part)
    }

    /// The means of χ times √2 cos and √2 sin of one wave times √2 cos and √2 sin of another.
    pub(super) fn of_waves(&self, [a, b]: [isize; 2], [c, d]: [isize; 2]) -> [[f64; 2]; 2] {
        let [cos, sin] = parts(self.at(a + c, b + d));
        let [cos_less, sin_less] = parts(self.at(a - c, b - d));
        [[cos_less + cos, sin - sin_less], [sin + sin_less, cos_less - cos]]
    }
}

/// The means of χ cos and χ sin by the moment of a wave.
fn parts(moment: Complex<f64>) -> [f64; 2] {
    [moment.re, -moment.im]
}

/// The powers of some factors, one after the other from the power 0 on.
fn power([once, turns]: &mut [Vec<Complex<f64>>; 2], k: usize) -> &[Complex<f64>] {
    for (turn, once) in turns.iter_mut().zip(once) {
        *turn = if k == 0 { Complex::new(1.0, 0.0) } else { *turn * *once };
    }
    turns
}
