//! The jumps of a law of Python, and the law without them.

use asperity::adhesion::Hints;
use asperity::{AdhesionLaw, Real};

use crate::table::Table;

/// A gap, in ranges, at which the traction falls at once.
#[derive(Clone, Copy, PartialEq)]
pub struct Jump {
    pub place: f64,
    pub fall: f64,
}

impl Jump {
    /// What energy, traction and slope gain at a gap, in ranges, where the traction falls evenly instead, over a width
    /// of fall·compliance about the jump, at most twice its gap.
    fn smoothing(self, place: f64, range: f64, compliance: f64) -> [f64; 3] {
        let width = (self.fall.abs() * compliance).min(2.0 * range * self.place);
        let beyond = range * (place - self.place);
        let left = 0.5 * width - beyond.abs();
        if left <= 0.0 {
            return [0.0; 3];
        }
        let traction = self.fall * left / width;
        [-0.5 * left * traction, if beyond < 0.0 { -traction } else { traction }, -self.fall / width]
    }
}

/// The table of a law with slopes no steeper than 1/`compliance` in the place of its jumps.
pub struct Smoothed {
    pub table: Table,
    pub compliance: f64,
}

impl Smoothed {
    fn at(&self, gap: f64) -> [f64; 3] {
        let (table, place) = (&self.table, gap / self.table.range());
        let of = |jump: &Jump| jump.smoothing(place, table.range(), self.compliance);
        table.jumps().iter().map(of).fold(table.at(gap), |sum, more| std::array::from_fn(|n| sum[n] + more[n]))
    }
}

impl<T: Real> AdhesionLaw<T> for Smoothed {
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
        self.table.hints()
    }
}
