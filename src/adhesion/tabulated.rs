use std::sync::Arc;

use super::{AdhesionLaw, Discretisation, Hints, Values};
use crate::real::Real;

mod adaptive;
mod functions;
mod jump;
mod piece;
mod points;
mod scales;

pub use functions::{Functions, check_functions};
use jump::Jump;
use piece::Piece;

/// The places up to which a table has one interval, and from which on the energy is constant.
const ENDS: (f64, f64) = (1.0 / 256.0, 1_048_576.0);

/// The bits of the mantissa that number the intervals of an octave: 128 of them.
const BITS: u32 = 7;

/// A law with a traction of cubic pieces, [through points](Self::new) or [of functions](Self::of).
///
/// The energy is the exact integral of the traction, and the slope its derivative.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    hints: Hints<f64>,
    /// the gap from which places count, and their unit
    origin: f64,
    unit: f64,
    /// the first piece of each interval, and the number of pieces; one interval where the unit is not the range
    first: Vec<u32>,
    pieces: Vec<Piece>,
    /// the place from which on nothing attracts, and the energy there
    end: f64,
    far: f64,
    jumps: Vec<Jump>,
    /// the compliance to which jumps are smoothed; zero for the law itself
    compliance: f64,
}

/// The number of the interval of a place, counted from zero.
fn key(place: f64) -> usize {
    (place.to_bits() >> (f64::MANTISSA_DIGITS - 1 - BITS)) as usize
}

/// The least place of a number.
fn of_key(key: usize) -> f64 {
    f64::from_bits((key as u64) << (f64::MANTISSA_DIGITS - 1 - BITS))
}

impl Tabulated {
    /// Energy, traction and slope at a gap.
    #[inline(always)]
    fn at(&self, gap: f64) -> [f64; 3] {
        let place = (gap - self.origin) / self.unit;
        if place >= self.end {
            return [self.far, 0.0, 0.0];
        }
        let interval = if place < ENDS.0 { 0 } else { (key(place) - key(ENDS.0) + 1).min(self.first.len() - 2) };
        let pieces = &self.pieces[self.first[interval] as usize..self.first[interval + 1] as usize];
        let after = if let [_] = pieces { 1 } else { pieces.partition_point(|piece| piece.start <= place).max(1) };
        let piece = &pieces[after - 1];
        let mut values = piece.at((place - piece.start) * piece.rate, self.unit);
        if self.compliance > 0.0 {
            for jump in &self.jumps {
                let [energy, traction, slope] = jump.smoothing(gap / self.unit, self.unit, self.compliance);
                values = [values[0] + energy, values[1] + traction, values[2] + slope];
            }
        }
        values
    }
}

impl<T: Real> AdhesionLaw<T> for Tabulated {
    fn energy(&self, gap: T) -> T {
        T::lit(self.at(gap.widen())[0])
    }
    fn traction(&self, gap: T) -> T {
        T::lit(self.at(gap.widen())[1])
    }
    fn slope(&self, gap: T) -> T {
        T::lit(self.at(gap.widen())[2])
    }
    fn hints(&self) -> Hints<T> {
        let Hints { work_of_adhesion, range, rest, concave, .. } = self.hints;
        Hints {
            rest: rest.map(T::lit),
            concave,
            ..Hints::new(T::lit(work_of_adhesion), T::lit(range)).with_name("table")
        }
    }
    fn evaluate(&self, _: usize, gaps: &[T], values: Values<'_, T>) {
        values.set(
            gaps,
            #[inline(always)]
            |gap| self.at(gap.widen()).map(T::lit),
        );
    }
    fn adapted(&self, to: Discretisation<T>) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let Discretisation::Smooth(compliance) = to else { return None };
        let compliance = compliance.widen();
        let falls = !self.jumps.is_empty() && compliance > self.compliance;
        falls.then(|| Arc::new(Self { compliance, ..self.clone() }) as Arc<dyn AdhesionLaw<T>>)
    }
}
