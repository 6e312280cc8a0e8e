//! An elastic body of a user's own, by the stiffness of its waves.

use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

use asperity::elastic::Body;
use asperity::error::{Breach, Place};
use asperity::{Error, Grid, Result};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::hash::Hash;

/// The stiffness of waves as a function of a user's own.
pub trait Stiffness: Send + Sync {
    /// The name of the function.
    fn name(&self) -> &str;

    /// Whether it depends on the magnitude of the wave number alone.
    fn is_isotropic(&self) -> bool;

    /// The stiffness k(qx, qy) of each of some waves, pressures per length, at their wave numbers in radians per length.
    ///
    /// # Errors
    /// [`Error::Raised`] with the error of the function.
    fn at(&self, qx: &[f64], qy: &[f64]) -> Result<Vec<f64>>;
}

/// An elastic body by the stiffness of its waves; as data the name of the function.
#[derive(Clone)]
pub struct Symbol(pub Arc<dyn Stiffness>);

/// The most waves for which the function is asked at once.
const MOST: usize = 1 << 20;

/// The difference between the stiffnesses of q and −q that is rounding, over the stiffness.
const ROUNDING: f64 = 1e-9;

/// The waves in a fingerprint.
const SAMPLES: usize = 512;

/// The waves of a grid, one of q and −q, by their numbers from one on.
#[derive(Clone, Copy)]
struct Waves {
    lengths: (f64, f64),
    highest: (i64, i64),
}

impl Waves {
    fn new(grid: &Grid) -> Self {
        let (nx, ny) = grid.shape();
        Self { lengths: grid.lengths(), highest: ((nx / 2) as i64, (ny / 2) as i64) }
    }

    fn count(self) -> usize {
        self.number_of((self.highest.0, self.highest.1))
    }

    fn number_of(self, (i, j): (i64, i64)) -> usize {
        (j * (2 * self.highest.0 + 1) + i).unsigned_abs() as usize
    }

    /// The number of a wave and of its opposite; the mean has zero.
    fn number(self, qx: f64, qy: f64) -> usize {
        self.number_of(((qx * self.lengths.0 / TAU).round() as i64, (qy * self.lengths.1 / TAU).round() as i64))
    }

    /// The wave of a number.
    fn wave(self, number: usize) -> (f64, f64) {
        let ((lx, ly), hx) = (self.lengths, self.highest.0);
        let j = (number as i64 + hx) / (2 * hx + 1);
        let i = number as i64 - j * (2 * hx + 1);
        (TAU / lx * i as f64, TAU / ly * j as f64)
    }
}

/// A symbol with a known stiffness for all waves of a grid.
struct Known {
    symbol: Symbol,
    waves: Waves,
    /// by the numbers of the waves, less one
    stiffness: Vec<f64>,
}

impl Symbol {
    /// The body for the waves of a grid; the function is asked for all at once.
    ///
    /// # Errors
    /// [`Error::Contract`] for a stiffness that is not positive and finite, or not even; errors of the function.
    pub(crate) fn on(&self, grid: &Grid) -> Result<impl Body + use<>> {
        let waves = Waves::new(grid);
        let mut known = Vec::with_capacity(waves.count());
        for first in (1..=waves.count()).step_by(MOST) {
            let last = waves.count().min(first + MOST - 1);
            let (qx, qy): (Vec<f64>, Vec<f64>) = (first..=last).map(|number| waves.wave(number)).unzip();
            let stiffness = self.0.at(&qx, &qy)?;
            let wrong = |k: usize, breach| {
                let place = Place::Wave(qx[k], qy[k]);
                Error::Contract { function: "stiffness", value: stiffness[k], place, breach }
            };
            if let Some(k) = stiffness.iter().position(|&k| !(k > 0.0 && k.is_finite())) {
                return Err(wrong(k, Breach::Stiff));
            }
            if !self.0.is_isotropic() {
                let [qx, qy] = [&qx, &qy].map(|q| q.iter().map(|q| -q).collect::<Vec<_>>());
                let opposite = self.0.at(&qx, &qy)?;
                let is_even = |(a, b): (&f64, &f64)| (a - b).abs() <= ROUNDING * a;
                if let Some(k) = stiffness.iter().zip(&opposite).position(|pair| !is_even(pair)) {
                    return Err(wrong(k, Breach::Even(opposite[k])));
                }
            }
            known.extend(stiffness);
        }
        Ok(Known { symbol: self.clone(), waves, stiffness: known })
    }

    /// The fingerprint of the function at some of the waves of a grid, by which a table tells it from others.
    pub(crate) fn fingerprint(&self, grid: &Grid) -> Hash {
        let waves = Waves::new(grid);
        let some = (1..=waves.count()).step_by(waves.count() / SAMPLES + 1);
        let (qx, qy): (Vec<f64>, Vec<f64>) = some.map(|number| waves.wave(number)).unzip();
        // a solve says what is wrong with it
        Hash::NEW.of_numbers(&self.0.at(&qx, &qy).unwrap_or_default())
    }
}

impl Body for Symbol {
    fn stiffness(&self, qx: f64, qy: f64) -> f64 {
        self.0.at(&[qx], &[qy]).ok().and_then(|found| found.first().copied()).unwrap_or(f64::NAN)
    }

    /// Unknown, as there is no shortest wave.
    fn modulus(&self) -> f64 {
        f64::NAN
    }
}

impl Body for Known {
    fn stiffness(&self, qx: f64, qy: f64) -> f64 {
        let number = self.waves.number(qx, qy);
        let wave = self.waves.wave(number);
        let known = (number > 0 && (wave == (qx, qy) || wave == (-qx, -qy))).then(|| self.stiffness.get(number - 1));
        known.flatten().copied().unwrap_or_else(|| self.symbol.stiffness(qx, qy))
    }

    fn modulus(&self) -> f64 {
        self.symbol.modulus()
    }
}

impl fmt::Debug for Symbol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Symbol").field(&self.0.name()).finish()
    }
}

impl PartialEq for Symbol {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Serialize for Symbol {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        serializer.serialize_str(self.0.name())
    }
}

impl<'de> Deserialize<'de> for Symbol {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Err(D::Error::custom(format!("symbol is {name}, a function, which data do not have: give the function itself")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_have_the_numbers_that_find_them() {
        for shape in [(8, 6), (7, 5), (9, 1), (1, 4), (2, 2), (1, 1)] {
            let grid = Grid::new(shape, (1.3, 0.7)).unwrap();
            let waves = Waves::new(&grid);
            for number in 1..=waves.count() {
                let (qx, qy) = waves.wave(number);
                assert_eq!((waves.number(qx, qy), waves.number(-qx, -qy)), (number, number), "{shape:?}");
            }
            let all = (0..shape.0).flat_map(|i| (0..shape.1).map(move |j| (i, j))).skip(1);
            for (i, j) in all {
                let (qx, qy) = (grid.wave_number_x(i), grid.wave_number_y(j));
                let (x, y) = waves.wave(waves.number(qx, qy));
                assert!((x, y) == (qx, qy) || (x, y) == (-qx, -qy), "{shape:?}: {i}, {j}");
            }
        }
    }
}
