//! The table of a law of Python: read once, before a solve, which then needs the interpreter no more.

use std::sync::Arc;

use asperity::adhesion::{Discretisation, Hints, Values};
use asperity::{AdhesionLaw, Error, Real};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::functions::{Function, Functions};
use crate::jumps::{Jump, Smoothed};
use crate::refusal::refusal;
use crate::scales::{Scales, check_sign};

/// The powers of two of a gap in ranges ρ between which the table has intervals of its own. Below there is one
/// interval; above, the energy is constant.
const OCTAVES: (i32, i32) = (-8, 20);

/// The bits of the mantissa that number the intervals of an octave: 128 of them.
const BITS: u32 = 7;

/// The largest error of energy and traction in an interval, over the largest value of the function.
const TOLERANCE: f64 = 1e-11;

/// The least fall of the traction at one gap that is a jump, over the largest traction.
const JUMP: f64 = 1e-6;

/// The most pieces of a table.
const MOST_PIECES: usize = 1 << 16;

/// Energy, traction and slope where a law repels without bound.
const UNBOUNDED: [f64; 3] = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY];

/// The places in an interval at which the functions are read: its ends, and three more to compare with.
const PLACES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// A law as a table: pieces of the third degree for the traction, with traction and slope of the law at their ends. The
/// slope is their derivative and the energy their integral, from the energy of the law at the start of each.
///
/// Intervals are 1/128 of an octave of the gap over the range ρ, so that the bits of a gap number them, and are halved
/// until the table agrees with the law in between. A jump is enclosed between two neighbouring numbers.
#[derive(Clone, PartialEq)]
pub struct Table {
    range: f64,
    work_of_adhesion: f64,
    rest: Option<f64>,
    /// the gap from which intervals count
    origin: f64,
    /// the least gap of a law that repels, and energy, traction and slope there
    floor: Option<(f64, [f64; 3])>,
    /// the first piece of each interval, and the number of pieces
    first: Vec<u32>,
    pieces: Vec<Piece>,
    jumps: Vec<Jump>,
    /// the energy beyond the last interval
    far: f64,
}

/// The traction over one piece: Σ cₙ tⁿ with t from 0 to 1.
#[derive(Clone, Copy, PartialEq)]
struct Piece {
    /// the start, in ranges
    start: f64,
    /// one over the width, in ranges
    rate: f64,
    /// the energy at the start
    energy: f64,
    coefficients: [f64; 4],
}

/// An interval from `start` to `end`, in ranges, that is to become a piece.
struct Candidate {
    interval: usize,
    start: f64,
    end: f64,
}

/// The bits of the gap that number its interval.
fn key(gap: f64) -> usize {
    (gap.to_bits() >> (f64::MANTISSA_DIGITS - 1 - BITS)) as usize
}

/// The least gap of a key.
fn of_key(key: usize) -> f64 {
    f64::from_bits((key as u64) << (f64::MANTISSA_DIGITS - 1 - BITS))
}

impl Table {
    /// Reads the law.
    ///
    /// # Errors
    /// The exception of the functions; `ValueError` if one is not finite somewhere, or not the derivative of the one before,
    /// or rougher than a table can be.
    pub fn of(law: &Functions<'_>) -> PyResult<Self> {
        let Scales { work_of_adhesion, range, rest, least, goes_on } = Scales::of(law)?;
        let origin = least.unwrap_or(0.0);
        let (base, end) = (key(2f64.powi(OCTAVES.0)), key(2f64.powi(OCTAVES.1)));
        let mut open: Vec<Candidate> =
            (base..end).map(|k| Candidate { interval: k - base + 1, start: of_key(k), end: of_key(k + 1) }).collect();
        let intervals = 1 + open.len();
        let start = if least.is_some() { 0.0 } else { of_key(base) };
        if least.is_some() {
            open.insert(0, Candidate { interval: 0, start, end: of_key(base) });
        }

        let mut largest = [0.0_f64; 3];
        let (mut found, mut far) = (Vec::new(), 0.0);
        while !open.is_empty() {
            if found.len() + open.len() > MOST_PIECES {
                check_sign(law)?;
                return Err(too_rough(origin + open[0].start * range));
            }
            let gaps: Vec<f64> =
                open.iter().flat_map(|c| PLACES.map(|t| origin + (c.start + t * (c.end - c.start)) * range)).collect();
            let mut values = [const { Vec::new() }; 3];
            for (function, values) in Function::ALL.into_iter().zip(&mut values) {
                *values = law.at(function, &gaps)?;
                if let Some((&gap, &value)) = gaps.iter().zip(&*values).find(|(_, value)| !value.is_finite()) {
                    return Err(refusal(Error::not_finite(function.name(), gap, value)));
                }
            }
            if found.is_empty() {
                far = *values[0].last().unwrap_or(&0.0);
                // an energy counts from where it is at large gaps
                let datum = [far, 0.0, 0.0];
                // a repulsion without bound is no measure of the attraction
                let attracts = |gap: f64| rest.is_none_or(|rest| gap >= rest);
                largest = std::array::from_fn(|n| {
                    let beyond = gaps.iter().zip(&values[n]).filter(|&(&gap, _)| attracts(gap));
                    beyond.fold(0.0, |m: f64, (_, v)| m.max((v - datum[n]).abs()))
                });
                if values[1].last().is_some_and(|traction| traction.abs() > TOLERANCE * largest[1]) {
                    return Err(too_far(gaps.last().copied().unwrap_or_default(), range));
                }
            }
            let mut halves = Vec::new();
            for (k, candidate) in open.into_iter().enumerate() {
                let at = |place: usize| std::array::from_fn(|n| values[n][PLACES.len() * k + place]);
                let middle = 0.5 * (candidate.start + candidate.end);
                let narrow = middle <= candidate.start || middle >= candidate.end;
                let piece = Piece::between(&candidate, at(0), if narrow { at(0) } else { at(4) }, range);
                let sizes = if rest.is_some() { largest_of(largest, at(0)) } else { largest };
                let agrees = (1..PLACES.len()).all(|place| piece.agrees(PLACES[place], at(place), sizes, range));
                if agrees || narrow {
                    found.push((candidate.interval, piece));
                } else {
                    halves.push(Candidate { end: middle, ..candidate });
                    halves.push(Candidate { start: middle, ..candidate });
                }
            }
            open = halves;
        }
        found.sort_by(|(_, a), (_, b)| a.start.total_cmp(&b.start));
        let mut first = vec![0_u32; intervals + 1];
        found.iter().for_each(|(interval, _)| first[interval + 1] += 1);
        (0..intervals).for_each(|k| first[k + 1] += first[k]);
        let pieces: Vec<Piece> = found.into_iter().map(|(_, piece)| piece).collect();
        let falls = pieces.windows(2).map(|pair| Jump {
            place: origin / range + pair[1].start,
            fall: pair[0].traction(1.0) - pair[1].traction(0.0),
        });
        let attracts = |jump: &Jump| rest.is_none_or(|rest| jump.place * range >= rest);
        let jumps = falls.filter(|jump| jump.fall.abs() > JUMP * largest[1] && attracts(jump)).collect();
        let floor = match rest {
            None => None,
            Some(_) => Some((origin + start * range, if goes_on { law.all_at(origin)? } else { UNBOUNDED })),
        };
        Ok(Self { range, work_of_adhesion, rest, origin, floor, first, pieces, jumps, far })
    }

    /// Energy, traction and slope of a law that repels at a gap below its least: those of the tangent.
    fn below(&self, gap: f64) -> Option<[f64; 3]> {
        let (least, [energy, traction, slope]) = self.floor.filter(|&(least, _)| gap < least)?;
        let x = gap - least;
        Some([energy + x * (traction + 0.5 * x * slope), traction + x * slope, slope])
    }

    /// The piece of a gap and the place in it; none beyond the last.
    fn find(&self, gap: f64) -> Option<(&Piece, f64)> {
        let x = (gap - self.origin) / self.range;
        let base = key(2f64.powi(OCTAVES.0));
        let interval = if x < of_key(base) { 0 } else { key(x) - base + 1 };
        let end = *self.first.get(interval + 1)?;
        let pieces = self.pieces.get(self.first[interval] as usize..end as usize)?;
        let after = if let [_] = pieces { 1 } else { pieces.partition_point(|piece| piece.start <= x).max(1) };
        let piece = pieces.get(after - 1)?;
        Some((piece, (x - piece.start) * piece.rate))
    }

    pub fn range(&self) -> f64 {
        self.range
    }

    pub fn jumps(&self) -> &[Jump] {
        &self.jumps
    }

    /// Energy, traction and slope at a gap.
    pub fn at(&self, gap: f64) -> [f64; 3] {
        let of =
            |(piece, t): (&Piece, f64)| [piece.energy(t, self.range), piece.traction(t), piece.slope(t) / self.range];
        self.below(gap).or_else(|| self.find(gap).map(of)).unwrap_or([self.far, 0.0, 0.0])
    }
}

impl Piece {
    /// The piece with these energies, tractions and slopes at its ends.
    fn between(candidate: &Candidate, a: [f64; 3], b: [f64; 3], range: f64) -> Self {
        let width = candidate.end - candidate.start;
        let (first, last, rise) = (a[2] * width * range, b[2] * width * range, b[1] - a[1]);
        let coefficients = [a[1], first, 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise];
        Self { start: candidate.start, rate: width.recip(), energy: a[0], coefficients }
    }

    fn energy(&self, t: f64, range: f64) -> f64 {
        let [a, b, c, d] = self.coefficients;
        self.energy + range / self.rate * t * (a + t * (b / 2.0 + t * (c / 3.0 + t * d / 4.0)))
    }

    fn traction(&self, t: f64) -> f64 {
        let [a, b, c, d] = self.coefficients;
        a + t * (b + t * (c + t * d))
    }

    /// The slope, over a gap in ranges.
    fn slope(&self, t: f64) -> f64 {
        let [_, b, c, d] = self.coefficients;
        self.rate * (b + t * (2.0 * c + t * 3.0 * d))
    }

    /// Whether the piece agrees with the law at a place.
    fn agrees(&self, t: f64, law: [f64; 3], largest: [f64; 3], range: f64) -> bool {
        let found = [self.energy(t, range), self.traction(t)];
        (0..2).all(|n| (found[n] - law[n]).abs() <= TOLERANCE * largest[n])
    }
}

/// The largest values of the functions, or those here, if they are larger.
fn largest_of(largest: [f64; 3], here: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|n| largest[n].max(here[n].abs()))
}

/// The refusal of a law that goes on beyond its table.
fn too_far(gap: f64, range: f64) -> PyErr {
    PyValueError::new_err(format!(
        "the law still has a traction at a gap of {gap:e}, {:.0} times its range of {range:e}: give it an attribute range, \
         the length over which the traction decays",
        gap / range
    ))
}

/// The refusal of a law of which the table does not come to an end.
fn too_rough(gap: f64) -> PyErr {
    PyValueError::new_err(format!(
        "the functions of the law do not agree with one another, or are rough, at gaps from {gap:e} on: the traction must \
         be the derivative of the energy and the slope that of the traction; asperity.check_law(law) says which is not"
    ))
}

impl<T: Real> AdhesionLaw<T> for Table {
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
        let mut hints = Hints::new(T::lit(self.work_of_adhesion), T::lit(self.range));
        hints.rest = self.rest.map(T::lit);
        hints
    }
    fn evaluate(&self, _: usize, gaps: &[T], values: Values<'_, T>) {
        values.set(gaps, |gap| self.at(gap.widen()).map(T::lit));
    }
    fn adapted(&self, to: Discretisation<T>) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let Discretisation::Smooth(compliance) = to else { return None };
        let smoothed = Smoothed { table: self.clone(), compliance: compliance.widen() };
        (!self.jumps.is_empty()).then(|| Arc::new(smoothed) as Arc<dyn AdhesionLaw<T>>)
    }
}
