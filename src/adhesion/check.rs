//! A check of an adhesion law, for users' tests.

use super::{AdhesionLaw, Discretisation, Hints, Values};
use crate::degrees::{LITTLE, PARTLY, ROUNDINGS};
use crate::derivatives::{self, GAPS, Named};
use crate::error::{Breach, Error, Place, Result};
use crate::real::Real;

/// The functions, in the order in which each is the derivative of the one before.
pub(super) const NAMES: [&str; 3] = ["adhesive energy", "adhesive traction", "slope of the adhesive traction"];

const NODES: usize = 1024;

/// The number of nodes of a varying law at which functions are compared at many gaps.
const PLACES: usize = 16;

const ASKED: [[bool; 3]; 6] = [
    [true, false, false],
    [false, true, false],
    [false, false, true],
    [true, true, false],
    [false, true, true],
    [true, true, true],
];

/// A check of a law against the contract of [`AdhesionLaw`], for a test of yours.
///
/// Compares, at 200 gaps between 0 (or half the gap of rest) and `largest_gap`, the traction with central differences
/// of the energy and the slope with differences of the traction, in the precision of the law, to a hundredth of the
/// largest value of the function. Gaps next to a jump, where the differences grow as their step shrinks, are passed
/// over. It also holds the law to its [hints](AdhesionLaw::hints), [values](AdhesionLaw::evaluate) and
/// [adaptions](AdhesionLaw::adapted):
///
/// - a law without a range of its own is checked [on nodes](AdhesionLaw::on_nodes) on which its range ends before
///   `largest_gap`;
/// - a law that is zero has no traction, and the traction of a concave law does not rise with the gap;
/// - where the traction jumps, the [smoothed](Discretisation::Smooth) law has none, but the same work of adhesion and
///   shape, and its functions agree as well;
/// - values at many nodes equal the functions of one gap, for each choice of values and of slices;
/// - a law that has a shape has a [coarser](Discretisation::Coarse) one, with the values of every other node, and is
///   nowhere stronger than the functions of one gap.
///
/// # Errors
/// [`Error::Contract`] with the first function and gap that break it; [`Error::Shape`] of an adapted law;
/// [`Error::Value`] if `largest_gap` is not positive and finite, or the work of adhesion of the smoothed law is
/// another.
///
/// ```
/// use asperity::adhesion::check_law;
/// use asperity::MaugisDugdale;
/// check_law::<f32>(&MaugisDugdale::new(1e-4, 2e-3)?, 0.02)?;
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn check_law<T: Real>(law: &impl AdhesionLaw<T>, largest_gap: f64) -> Result<()> {
    Error::positive("largest gap", largest_gap)?;
    // of the nodes, for a law without a range
    let compliance = LITTLE * largest_gap.powi(2) / law.hints().work_of_adhesion.widen();
    let on_nodes = law.on_nodes(T::lit(compliance));
    let law: &dyn AdhesionLaw<T> = on_nodes.as_deref().unwrap_or(law);
    let hints = law.hints();
    let (gaps, length) = checked_gaps(&hints, largest_gap);
    let checked = Checked { law, hints, gaps, length };
    checked.functions()?;
    checked.smoothness()?;
    checked.bounds()?;
    checked.nodes()?;
    checked.coarseness()
}

/// The range of gaps at which a law is looked at, and the length over which it varies.
pub(super) fn checked_gaps<T: Real>(hints: &Hints<T>, largest_gap: f64) -> ((f64, f64), f64) {
    // closer than half its gap of rest a law may grow without bound
    let least = hints.rest.map_or(0.0, |rest| 0.5 * rest.widen());
    ((least, largest_gap), hints.range.widen().clamp(1e-3 * largest_gap, largest_gap))
}

/// A law, the range of gaps at which it is looked at, and the length over which it varies.
struct Checked<'a, T> {
    law: &'a dyn AdhesionLaw<T>,
    hints: Hints<T>,
    gaps: (f64, f64),
    length: f64,
}

impl<T: Real> Checked<'_, T> {
    fn gap(&self, i: usize) -> T {
        T::lit(self.gaps.0 + (self.gaps.1 - self.gaps.0) * i as f64 / GAPS as f64)
    }

    fn functions(&self) -> Result<()> {
        let law = self.law;
        let functions: [Named<'_>; 3] = [
            (NAMES[0], &|g| law.energy(T::lit(g)).widen()),
            (NAMES[1], &|g| law.traction(T::lit(g)).widen()),
            (NAMES[2], &|g| law.slope(T::lit(g)).widen()),
        ];
        derivatives::check::<T>(functions, self.gaps, self.length)
    }

    fn largest(&self) -> f64 {
        (0..=GAPS).map(|i| self.law.traction(self.gap(i)).abs().widen()).fold(0.0, f64::max)
    }

    /// The error of the first gap at which the traction jumps.
    fn jump(&self) -> Option<Error> {
        let (least, traction) = (LITTLE * self.largest(), |gap: T| self.law.traction(gap).widen());
        (0..GAPS).find_map(|i| {
            let (mut near, mut far) = (self.gap(i), self.gap(i + 1));
            loop {
                let middle = T::lit(0.5) * (near + far);
                let [a, b, c] = [near, middle, far].map(traction);
                if (a - c).abs() <= least {
                    return None;
                }
                if middle <= near || middle >= far {
                    return Some(broken(1, c, Place::Gap(far.widen()), Breach::Jump(a)));
                }
                // toward the half that changes more
                if (a - b).abs() > (b - c).abs() { far = middle } else { near = middle }
            }
        })
    }

    fn check_shape(&self, what: &'static str, hints: Hints<T>, expected: Option<(usize, usize)>) -> Result<()> {
        let [found, expected] = [hints.shape, expected].map(Option::unwrap_or_default);
        Error::shape(what, found, expected)
    }

    /// Checks the smoothed law of a law with jumps of the traction.
    fn smoothness(&self) -> Result<()> {
        let Some(jump) = self.jump() else { return Ok(()) };
        // a traction that jumps is let fall over a part of the range
        let compliance = T::lit(PARTLY * self.length / self.largest());
        let Some(smoothed) = self.law.adapted(Discretisation::Smooth(compliance)) else { return Err(jump) };
        let smooth = Checked { law: &*smoothed, hints: smoothed.hints(), ..*self };
        self.check_shape("smoothed adhesion law", smooth.hints, self.hints.shape)?;
        smooth.functions()?;
        let [work, left] = [self.hints, smooth.hints].map(|hints| hints.work_of_adhesion.widen());
        let keeps = (left - work).abs() <= LITTLE * work.abs();
        if !keeps {
            let requirement = "the work of adhesion of the law itself";
            return Err(Error::Value { name: "work of adhesion of the smoothed law", value: left, requirement });
        }
        if smooth.jump().is_some() { Err(jump) } else { smooth.nodes() }
    }

    /// Holds a law to being zero or concave, if it says so.
    fn bounds(&self) -> Result<()> {
        let gaps = (0..=GAPS).map(|i| self.gaps.1 * i as f64 / GAPS as f64);
        let tractions: Vec<_> = gaps.map(|gap| (gap, self.law.traction(T::lit(gap)).widen())).collect();
        let attracts = tractions.iter().find(|(_, traction)| self.hints.zero && *traction != 0.0);
        if let Some(&(gap, value)) = attracts {
            return Err(broken(1, value, Place::Gap(gap), Breach::Zero));
        }
        let rounding = ROUNDINGS * T::epsilon().widen() * self.law.traction(T::zero()).abs().widen();
        let rises = |pair: &&[(f64, f64)]| self.hints.concave && pair[1].1 > pair[0].1 + rounding;
        match tractions.windows(2).find(rises) {
            Some(&[(_, nearer), (gap, traction)]) => Err(broken(1, traction, Place::Gap(gap), Breach::Concave(nearer))),
            _ => Ok(()),
        }
    }

    fn at(&self, node: usize, gap: T) -> [T; 3] {
        let mut values = [[T::zero()]; 3];
        for (order, value) in values.iter_mut().enumerate() {
            self.law.evaluate(node, &[gap], Values::one(order, value));
        }
        values.map(|[value]| value)
    }

    /// Compares values at many nodes with the functions of one gap, or, for a law that varies, with one another.
    fn nodes(&self) -> Result<()> {
        let (law, shape) = (self.law, self.hints.shape);
        let nodes = shape.map_or(NODES, |(nx, ny)| nx * ny);
        let gaps: Vec<T> = (0..nodes.min(NODES)).map(|i| self.gap(i % (GAPS + 1))).collect();
        let expected: Vec<[T; 3]> = gaps
            .iter()
            .enumerate()
            .map(|(node, &gap)| match shape {
                Some(_) => self.at(node, gap),
                None => [law.energy(gap), law.traction(gap), law.slope(gap)],
            })
            .collect();
        for asked in ASKED {
            let [mut whole, mut parts] = [(); 2].map(|()| [(); 3].map(|()| vec![T::zero(); gaps.len()]));
            law.evaluate(0, &gaps, slices(&mut whole, asked));
            let middle = gaps.len() / 3;
            let mut values = slices(&mut parts, asked);
            law.evaluate(0, &gaps[..middle], values.part(0..middle));
            law.evaluate(middle, &gaps[middle..], values.part(middle..gaps.len()));
            for (order, (whole, parts)) in whole.iter().zip(&parts).enumerate().filter(|(order, _)| asked[*order]) {
                let size = expected.iter().map(|expected| expected[order].abs().widen()).fold(0.0, f64::max);
                for (node, (&value, &part)) in whole.iter().zip(parts).enumerate() {
                    let [value, part, one] = [value, part, expected[node][order]].map(T::widen);
                    // of the rows of another process nothing is known
                    let unknown = shape.is_some() && one.is_nan();
                    let [near, same] = [(value - one).abs() <= LITTLE * size, value == part];
                    if !(unknown || near && same) {
                        let (place, expected) = (Place::Node(node, gaps[node].widen()), if near { part } else { one });
                        return Err(broken(order, value, place, Breach::Alike(expected)));
                    }
                }
            }
        }
        let places = shape.map_or(0, |_| nodes);
        (0..places).step_by(places.div_ceil(PLACES).max(1)).try_for_each(|node| self.place(node))
    }

    /// Compares the functions of a node with one another, and with the strongest one.
    fn place(&self, node: usize) -> Result<()> {
        let rest = self.hints.rest.unwrap_or_else(T::zero);
        let [energy, ..] = self.at(node, rest);
        if energy.is_nan() {
            return Ok(());
        }
        let of = |of: usize| move |gap: f64| self.at(node, T::lit(gap))[of].widen();
        let functions: [Named<'_>; 3] = [(NAMES[0], &of(0)), (NAMES[1], &of(1)), (NAMES[2], &of(2))];
        derivatives::check::<T>(functions, self.gaps, self.length)?;
        let (value, expected) = (energy.widen(), self.law.energy(rest).widen());
        if value < expected - LITTLE * expected.abs() {
            return Err(broken(0, value, Place::Node(node, rest.widen()), Breach::Alike(expected)));
        }
        Ok(())
    }

    /// Compares a law that varies with itself on the coarser grid of every other node.
    fn coarseness(&self) -> Result<()> {
        let Some((nx, ny)) = self.hints.shape else { return Ok(()) };
        let (rows, columns) = (nx.div_ceil(2), ny.div_ceil(2));
        let coarse = self.law.adapted(Discretisation::Coarse(2, 2));
        let law = coarse.as_deref().unwrap_or(self.law);
        let coarse = Checked { law, hints: law.hints(), ..*self };
        self.check_shape("coarsened adhesion law", coarse.hints, Some((rows, columns)))?;
        for node in (0..rows * columns).step_by((rows * columns).div_ceil(NODES).max(1)) {
            let (fine, gap) = (2 * (node / columns * ny + node % columns), self.gap(node % (GAPS + 1)));
            let (found, expected) = (coarse.at(node, gap), self.at(fine, gap));
            let differs = (0..3).find(|&order| found[order] != expected[order] && !expected[order].is_nan());
            if let Some(order) = differs {
                let breach = Breach::Alike(expected[order].widen());
                return Err(broken(order, found[order].widen(), Place::Node(node, gap.widen()), breach));
            }
        }
        Ok(())
    }
}

fn broken(order: usize, value: f64, place: Place, breach: Breach) -> Error {
    Error::Contract { function: NAMES[order], value, place, breach }
}

fn slices<T>(values: &mut [Vec<T>; 3], asked: [bool; 3]) -> Values<'_, T> {
    let [energies, tractions, slopes] = values.each_mut().map(|values| Some(values.as_mut_slice()));
    let [energies, tractions, slopes] = [(energies, asked[0]), (tractions, asked[1]), (slopes, asked[2])]
        .map(|(values, asked)| values.filter(|_| asked));
    Values { energies, tractions, slopes }
}

#[cfg(test)]
mod tests;
