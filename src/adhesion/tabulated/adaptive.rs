//! Tables of functions, as fine as these need.

use super::functions::{Functions, at, one};
use super::scales::{Scales, broken, check_sign};
use super::{ENDS, Jump, Piece, Tabulated, key, of_key};
use crate::adhesion::check::NAMES;
use crate::error::{Breach, Error, Result};

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

/// An interval from `start` to `end`, in ranges, that is to become a piece.
struct Candidate {
    interval: usize,
    start: f64,
    end: f64,
}

impl Candidate {
    fn middle(&self) -> f64 {
        0.5 * (self.start + self.end)
    }

    /// The piece between the ends, if it agrees with all values, or the interval cannot be halved.
    fn piece(&self, values: &[[f64; 3]], sizes: [f64; 3], range: f64) -> Option<Piece> {
        let (start, middle, end) = (self.start, self.middle(), self.end);
        let narrow = middle <= start || middle >= end;
        let piece = Piece::between((start, end), values[0], values[if narrow { 0 } else { 4 }], range);
        let agrees = |k: usize| {
            let found = piece.at(PLACES[k], range);
            (0..2).all(|n| (found[n] - values[k][n]).abs() <= TOLERANCE * sizes[n])
        };
        (narrow || (1..PLACES.len()).all(agrees)).then_some(piece)
    }

    fn halves(&self) -> [Self; 2] {
        let Self { interval, start, end } = *self;
        let middle = self.middle();
        [Self { interval, start, end: middle }, Self { interval, start: middle, end }]
    }
}

impl Tabulated {
    /// The law of functions, read once, to 10⁻¹¹ of their largest values: for functions that are slow, written in
    /// another language, or jump.
    ///
    /// Work of adhesion (energy per area), range (length) and equilibrium separation are found where the
    /// [functions](Functions) do not name them. Intervals of 1/128 of an octave of the gap, from 1/256 to 2²⁰ ranges,
    /// are halved until they agree with the law. Where the traction jumps, the law has a
    /// [smoothed](crate::adhesion::Discretisation::Smooth) one. Below an equilibrium separation it is read until it
    /// repels by 10⁹ times its greatest attraction, and continues as its tangent, or up to where it is not defined.
    ///
    /// # Errors
    /// [`Error::Contract`] for functions that are not finite, too rough for a table, or not each other's derivatives
    /// ([`check_functions`](crate::adhesion::check_functions) says which), for a traction of the wrong sign, that
    /// nowhere attracts, or that is there beyond the table. [`Error::Value`] for a range that is not positive and
    /// finite. Errors of the functions.
    ///
    /// ```
    /// use asperity::adhesion::check_law;
    /// use asperity::{AdhesionLaw, Tabulated};
    /// // a short attraction and a long one
    /// let law = Tabulated::of(|gap: f64| {
    ///     let [short, long] = [0.04 * (-gap / 1e-9).exp(), 0.01 * (-gap / 5e-9).exp()];
    ///     [-short - long, short / 1e-9 + long / 5e-9, -short / 1e-18 - long / 25e-18]
    /// })?;
    /// assert_eq!(AdhesionLaw::<f64>::hints(&law).work_of_adhesion, 0.05);
    /// check_law::<f64>(&law, 2e-8)?;
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn of(functions: impl Functions) -> Result<Self> {
        let law = &functions;
        let Scales { hints, least, goes_on } = Scales::of(law)?;
        let (range, rest, origin) = (hints.range, hints.rest, least.unwrap_or(0.0));
        let (base, end) = (key(ENDS.0), key(ENDS.1));
        let below = least.map(|_| Candidate { interval: 0, start: 0.0, end: ENDS.0 });
        let above = (base..end).map(|k| Candidate { interval: k - base + 1, start: of_key(k), end: of_key(k + 1) });
        let mut open: Vec<Candidate> = below.into_iter().chain(above).collect();

        let (mut largest, mut far, mut found) = ([0.0; 3], 0.0, Vec::new());
        while !open.is_empty() {
            let first = origin + open[0].start * range;
            if found.len() + open.len() > MOST_PIECES {
                check_sign(law)?;
                return Err(broken(one(law, 1, first)?, first, Breach::Rough));
            }
            let places = open.iter().flat_map(|c| PLACES.map(|t| c.start + t * (c.end - c.start)));
            let gaps: Vec<f64> = places.map(|place| origin + place * range).collect();
            let values = read(law, &gaps)?;
            if let (true, Some(&[energy, traction, _]), Some(&gap)) = (found.is_empty(), values.last(), gaps.last()) {
                far = energy;
                // an energy counts from where it is at large gaps, and a repulsion is no measure of the attraction
                let attracts = gaps.iter().zip(&values).filter(|&(&gap, _)| rest.is_none_or(|rest| gap >= rest));
                let sizes = attracts.map(|(_, &[energy, traction, slope])| [energy - far, traction, slope]);
                largest = sizes.fold([0.0; 3], larger);
                if traction.abs() > TOLERANCE * largest[1] {
                    return Err(broken(traction, gap, Breach::Decay(range)));
                }
            }
            let mut halves = Vec::new();
            for (candidate, values) in open.into_iter().zip(values.chunks_exact(PLACES.len())) {
                let sizes = if rest.is_some() { larger(largest, values[0]) } else { largest };
                match candidate.piece(values, sizes, range) {
                    Some(piece) => found.push((candidate.interval, piece)),
                    None => halves.extend(candidate.halves()),
                }
            }
            open = halves;
        }
        found.sort_by(|(_, a), (_, b)| a.start.total_cmp(&b.start));
        let jump = |pair: &[(usize, Piece)]| {
            let [[_, before, _], [_, after, _]] = [pair[0].1.at(1.0, range), pair[1].1.at(0.0, range)];
            Jump { place: origin / range + pair[1].1.start, fall: before - after }
        };
        let attracts = |jump: &Jump| rest.is_none_or(|rest| jump.place * range >= rest);
        let jumps = found.windows(2).map(jump).filter(|jump| jump.fall.abs() > JUMP * largest[1] && attracts(jump));
        let jumps = jumps.collect();
        if rest.is_some() {
            let [energy, traction, slope] =
                if goes_on { [one(law, 0, origin)?, one(law, 1, origin)?, one(law, 2, origin)?] } else { UNBOUNDED };
            let coefficients = [traction, slope * range, 0.0, 0.0];
            found.insert(0, (0, Piece { start: found[0].1.start, rate: 1.0, energy, coefficients }));
        }
        let mut first = vec![0; end - base + 2];
        found.iter().for_each(|(interval, _)| first[interval + 1] += 1);
        (1..first.len()).for_each(|k| first[k] += first[k - 1]);
        let pieces = found.into_iter().map(|(_, piece)| piece).collect();
        Ok(Self { hints, origin, unit: range, first, pieces, end: ENDS.1, far, jumps, compliance: 0.0 })
    }
}

/// Energy, traction and slope at some gaps.
fn read(law: &impl Functions, gaps: &[f64]) -> Result<Vec<[f64; 3]>> {
    let mut values = vec![[0.0; 3]; gaps.len()];
    for order in 0..3 {
        for ((all, value), &gap) in values.iter_mut().zip(at(law, order, gaps)?).zip(gaps) {
            if !value.is_finite() {
                return Err(Error::not_finite(NAMES[order], gap, value));
            }
            all[order] = value;
        }
    }
    Ok(values)
}

/// The larger magnitude of each value.
fn larger(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|n| f64::max(a[n], b[n].abs()))
}
