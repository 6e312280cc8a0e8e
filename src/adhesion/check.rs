//! A check that an adhesion law is one, for users' tests.

use super::{AdhesionLaw, Discretisation, Hints, Values};
use crate::derivatives::{self, GAPS, Named};
use crate::error::{Error, Result};
use crate::real::Real;

/// The functions, in the order in which each is the derivative of the one before.
const NAMES: [&str; 3] = ["adhesive energy", "adhesive traction", "slope of the adhesive traction"];

/// The share of the largest value of a function by which a value may be wrong, and by which a traction falls that jumps.
const SHARE: f64 = 1e-2;

/// The roundings, in units of the traction in contact, by which a traction that falls may seem to rise.
const ROUNDINGS: f64 = 4.0;

/// The most nodes that are asked at once.
const NODES: usize = 1024;

/// The most nodes of a law that varies whose functions are compared with one another at many gaps.
const PLACES: usize = 16;

/// The width over which a smoothed traction is let fall, in ranges.
const SMOOTHING: f64 = 0.1;

/// The stride of the coarser grid of a law that varies.
const STRIDE: usize = 2;

/// The functions that are asked for together: energies, tractions, slopes.
const ASKED: [[bool; 3]; 6] = [
    [true, false, false],
    [false, true, false],
    [false, false, true],
    [true, true, false],
    [false, true, true],
    [true, true, true],
];

/// Tells whether a law keeps the contract of [`AdhesionLaw`]; call it in a test of your law.
///
/// Compares, at 200 gaps between 0 (or half the gap of rest) and `largest_gap`, the traction with central differences
/// of the energy and the slope with central differences of the traction, in the precision of the law, to a hundredth of
/// the largest value of that function. A function may jump (as the traction of Maugis–Dugdale does at ρ): gaps beside a
/// jump, where the differences grow as their step shrinks, are passed over. Then it holds the law to its
/// [hints](AdhesionLaw::hints), its [values](AdhesionLaw::evaluate) at many nodes and its
/// [adaptions](AdhesionLaw::adapted):
///
/// - a law that is zero has no energy, and the traction of a concave one does not rise from one of the gaps to the next;
/// - where the traction jumps, the [smoothed](Discretisation::Smooth) law has none, but the same work of adhesion and the
///   same shape, and its functions agree as well;
/// - the values at many nodes are those of the functions of one gap, whichever of them are asked for together, and do
///   not depend on where the slices end. Of a law that has a shape they agree with one another, node by node, and no
///   node is stronger than the functions of one gap say;
/// - a law that has a shape has a [coarser](Discretisation::Coarse) one, which has the values of every other node.
///
/// # Errors
/// [`Error::Law`] with the function, the first gap at which it is not finite or is not the derivative of the one
/// before it, and what it should be there; [`Error::Jump`] with the gap at which the traction jumps;
/// [`Error::Concave`] with the gap to which the traction rises; [`Error::AtNode`] with the function that differs;
/// [`Error::Shape`] if an adapted law has another shape; [`Error::Value`] if `largest_gap` is not positive and finite, or
/// if the smoothed law has another work of adhesion.
///
/// ```
/// use asperity::{Exponential, MaugisDugdale, check_law};
/// check_law::<f64>(&Exponential::new(1e-4, 2e-3)?, 0.02)?;
/// check_law::<f32>(&MaugisDugdale::new(1e-4, 2e-3)?, 0.02)?;
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn check_law<T: Real>(law: &impl AdhesionLaw<T>, largest_gap: f64) -> Result<()> {
    Error::positive("largest gap", largest_gap)?;
    let hints = law.hints();
    // closer than half its gap of rest a law may grow without bound
    let least = hints.rest.map_or(0.0, |rest| 0.5 * rest.widen());
    let length = hints.range.widen().clamp(1e-3 * largest_gap, largest_gap);
    let checked = Checked { law, hints, gaps: (least, largest_gap), length };
    checked.functions()?;
    checked.smoothness()?;
    checked.bounds()?;
    checked.nodes()?;
    checked.coarseness()
}

/// A law, the gaps at which it is looked at, and the one over which it varies.
struct Checked<'a, T> {
    law: &'a dyn AdhesionLaw<T>,
    hints: Hints<T>,
    gaps: (f64, f64),
    length: f64,
}

impl<T: Real> Checked<'_, T> {
    /// A gap of the 200 intervals between the least and the largest.
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

    /// The largest traction.
    fn largest(&self) -> f64 {
        (0..=GAPS).map(|i| self.law.traction(self.gap(i)).abs().widen()).fold(0.0, f64::max)
    }

    /// The first gap at which the traction jumps, and by how much it falls there.
    fn jump(&self) -> Option<(f64, f64)> {
        let (least, traction) = (SHARE * self.largest(), |gap: T| self.law.traction(gap).widen());
        (0..GAPS).find_map(|i| {
            let (mut near, mut far) = (self.gap(i), self.gap(i + 1));
            loop {
                let middle = T::lit(0.5) * (near + far);
                let [a, b, c] = [near, middle, far].map(traction);
                if (a - c).abs() <= least {
                    return None;
                }
                if middle <= near || middle >= far {
                    return Some((far.widen(), a - c));
                }
                // toward the half that changes more
                if (a - b).abs() > (b - c).abs() { far = middle } else { near = middle }
            }
        })
    }

    /// Refuses another shape of an adapted law.
    fn check_shape(&self, what: &'static str, hints: Hints<T>, expected: Option<(usize, usize)>) -> Result<()> {
        let [found, expected] = [hints.shape, expected].map(Option::unwrap_or_default);
        Error::shape(what, found, expected)
    }

    /// Holds a law whose traction jumps to what its smoothed law has to be.
    fn smoothness(&self) -> Result<()> {
        let Some((gap, fall)) = self.jump() else { return Ok(()) };
        let jumps = Err(Error::Jump { gap, fall });
        let compliance = T::lit(SMOOTHING * self.length / self.largest());
        let Some(smoothed) = self.law.adapted(Discretisation::Smooth(compliance)) else { return jumps };
        let smooth = Checked { law: &*smoothed, hints: smoothed.hints(), ..*self };
        self.check_shape("smoothed adhesion law", smooth.hints, self.hints.shape)?;
        smooth.functions()?;
        let [work, left] = [self.hints, smooth.hints].map(|hints| hints.work_of_adhesion.widen());
        let keeps = (left - work).abs() <= SHARE * work.abs();
        if !keeps {
            let requirement = "that of the law, which a smoothed one keeps";
            return Err(Error::Value { name: "work of adhesion of the smoothed law", value: left, requirement });
        }
        if smooth.jump().is_some() { jumps } else { smooth.nodes() }
    }

    /// Holds a law to being zero or concave, if it says so.
    fn bounds(&self) -> Result<()> {
        let gaps = (0..=GAPS).map(|i| self.gaps.1 * i as f64 / GAPS as f64);
        let tractions: Vec<_> = gaps.map(|gap| (gap, self.law.traction(T::lit(gap)).widen())).collect();
        let attracts = tractions.iter().find(|(_, traction)| self.hints.zero && *traction != 0.0);
        if let Some(&(gap, value)) = attracts {
            return Err(Error::Law { function: NAMES[1], gap, value, expected: Some(0.0) });
        }
        let rounding = ROUNDINGS * T::epsilon().widen() * self.law.traction(T::zero()).abs().widen();
        let rises = |pair: &&[(f64, f64)]| self.hints.concave && pair[1].1 > pair[0].1 + rounding;
        match tractions.windows(2).find(rises) {
            Some(&[(_, nearer), (gap, traction)]) => Err(Error::Concave { gap, traction, nearer }),
            _ => Ok(()),
        }
    }

    /// Energy, traction and slope of one node.
    fn at(&self, node: usize, gap: T) -> [T; 3] {
        let mut values = [[T::zero()]; 3];
        for (order, value) in values.iter_mut().enumerate() {
            self.law.evaluate(node, &[gap], Values::one(order, value));
        }
        values.map(|[value]| value)
    }

    /// Compares the values of many nodes with those of one, or, where they differ from node to node, with one another.
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
            law.evaluate(0, &gaps, of(&mut whole, asked));
            let middle = gaps.len() / 3;
            let mut values = of(&mut parts, asked);
            law.evaluate(0, &gaps[..middle], values.part(0..middle));
            law.evaluate(middle, &gaps[middle..], values.part(middle..gaps.len()));
            for (order, (whole, parts)) in whole.iter().zip(&parts).enumerate().filter(|(order, _)| asked[*order]) {
                let size = expected.iter().map(|expected| expected[order].abs().widen()).fold(0.0, f64::max);
                for (node, (&value, &part)) in whole.iter().zip(parts).enumerate() {
                    let [value, part, one] = [value, part, expected[node][order]].map(T::widen);
                    // of the rows of another process nothing is known
                    let unknown = shape.is_some() && one.is_nan();
                    let [near, same] = [(value - one).abs() <= SHARE * size, value == part];
                    if !(unknown || near && same) {
                        let (gap, expected) = (gaps[node].widen(), if near { part } else { one });
                        return Err(Error::AtNode { function: NAMES[order], node, gap, value, expected });
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
        if value < expected - SHARE * expected.abs() {
            return Err(Error::AtNode { function: NAMES[0], node, gap: rest.widen(), value, expected });
        }
        Ok(())
    }

    /// Compares a law that varies with itself on the coarser grid of every other node.
    fn coarseness(&self) -> Result<()> {
        let Some((nx, ny)) = self.hints.shape else { return Ok(()) };
        let (rows, columns) = (nx.div_ceil(STRIDE), ny.div_ceil(STRIDE));
        let coarse = self.law.adapted(Discretisation::Coarse(STRIDE, STRIDE));
        let law = coarse.as_deref().unwrap_or(self.law);
        let coarse = Checked { law, hints: law.hints(), ..*self };
        self.check_shape("coarsened adhesion law", coarse.hints, Some((rows, columns)))?;
        for node in (0..rows * columns).step_by((rows * columns).div_ceil(NODES).max(1)) {
            let (fine, gap) = (STRIDE * (node / columns * ny + node % columns), self.gap(node % (GAPS + 1)));
            let (found, expected) = (coarse.at(node, gap), self.at(fine, gap));
            let differs = (0..3).find(|&order| found[order] != expected[order] && !expected[order].is_nan());
            if let Some(order) = differs {
                let (gap, value, expected) = (gap.widen(), found[order].widen(), expected[order].widen());
                return Err(Error::AtNode { function: NAMES[order], node, gap, value, expected });
            }
        }
        Ok(())
    }
}

/// The slices of the functions that are asked for.
fn of<T>(values: &mut [Vec<T>; 3], asked: [bool; 3]) -> Values<'_, T> {
    let [energies, tractions, slopes] = values.each_mut().map(|values| Some(values.as_mut_slice()));
    let [energies, tractions, slopes] = [(energies, asked[0]), (tractions, asked[1]), (slopes, asked[2])]
        .map(|(values, asked)| values.filter(|_| asked));
    Values { energies, tractions, slopes }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Exponential, LennardJones, MaugisDugdale, Morse, NoAdhesion, PowerLaw, Tabulated, Varying};

    /// An exponential of unit size with one of its functions spoiled.
    struct Spoiled(f64, f64, f64);

    impl AdhesionLaw<f64> for Spoiled {
        fn energy(&self, gap: f64) -> f64 {
            -self.0 * (-gap).exp()
        }
        fn traction(&self, gap: f64) -> f64 {
            self.1 * (-gap).exp()
        }
        fn slope(&self, gap: f64) -> f64 {
            -self.2 * (-gap).exp()
        }
    }

    #[test]
    fn the_checker_accepts_every_built_in_law_in_both_precisions() {
        for range in [1e-9, 1e-3, 10.0] {
            for reach in [0.5, 5.0, 50.0] {
                let (w, far) = (1e-2, reach * range);
                let (exponential, dugdale) =
                    (Exponential::new(w, range).unwrap(), MaugisDugdale::new(w, range).unwrap());
                check_law::<f64>(&exponential, far).unwrap();
                check_law::<f64>(&dugdale, far).unwrap();
                check_law::<f32>(&exponential, far).unwrap();
                check_law::<f32>(&dugdale, far).unwrap();
                for compliance in [1e-3, 0.7, 1e9] {
                    let compliance = Discretisation::Smooth(compliance * range * range / w);
                    let smoothed = dugdale.adapted(compliance).unwrap();
                    check_law(&smoothed, far).unwrap();
                    assert_eq!(smoothed.hints().work_of_adhesion, w);
                }
            }
        }
        check_law::<f64>(&NoAdhesion, 1.0).unwrap();
    }

    #[test]
    fn the_checker_names_the_function_that_is_wrong() {
        check_law(&Spoiled(1.0, 1.0, 1.0), 5.0).unwrap();
        for (law, wrong) in [
            (Spoiled(1.0, 1.1, 1.1), "adhesive traction"),
            (Spoiled(1.0, -1.0, -1.0), "adhesive traction"),
            (Spoiled(1.0, 1.0, 0.9), "slope of the adhesive traction"),
            (Spoiled(1.0, f64::NAN, 1.0), "adhesive traction"),
            (Spoiled(f64::INFINITY, 1.0, 1.0), "adhesive energy"),
        ] {
            match check_law(&law, 5.0) {
                Err(Error::Law { function, .. }) => assert_eq!(function, wrong),
                other => panic!("{other:?}"),
            }
        }
    }

    #[test]
    fn concave_are_the_laws_whose_traction_falls_everywhere() {
        fn concave<T: Real>(law: &dyn AdhesionLaw<T>) -> bool {
            check_law(&law, 10.0).unwrap();
            law.hints().concave
        }
        let dugdale = MaugisDugdale::new(2.0, 0.5).unwrap();
        assert!(concave::<f64>(&Exponential::new(2.0, 0.5).unwrap()) && concave::<f32>(&dugdale));
        assert!(concave(&*dugdale.adapted(Discretisation::Smooth(0.1_f64)).unwrap()));
        assert!(concave::<f64>(&PowerLaw::new(2.0, 0.5, 3.0).unwrap()));
        assert!(concave::<f64>(&Tabulated::new(&[0.0, 1.0, 3.0], &[2.0, 2.0, 0.0]).unwrap()));
        assert!(!concave::<f64>(&Tabulated::new(&[0.0, 1.0, 3.0], &[2.0, 2.5, 0.0]).unwrap()));
        assert!(
            !concave::<f64>(&LennardJones::new(2.0, 0.5).unwrap()) && !concave::<f64>(&Morse::new(2.0, 0.5).unwrap())
        );
    }

    #[test]
    fn a_law_that_is_not_concave_may_not_say_so() {
        /// A traction that rises to a gap of one, and falls again.
        struct Humped;
        impl AdhesionLaw<f64> for Humped {
            fn energy(&self, gap: f64) -> f64 {
                -(1.0 + gap) * (-gap).exp()
            }
            fn traction(&self, gap: f64) -> f64 {
                gap * (-gap).exp()
            }
            fn slope(&self, gap: f64) -> f64 {
                (1.0 - gap) * (-gap).exp()
            }
            fn hints(&self) -> Hints<f64> {
                Hints::of(self).with_range(1.0).concave()
            }
        }
        let error = check_law(&Humped, 5.0).unwrap_err();
        let Error::Concave { gap, traction, nearer } = error else { panic!("{error}") };
        assert_eq!((gap, traction, nearer), (0.025, Humped.traction(0.025), 0.0));
    }

    /// A law that varies, with a part of what it should say.
    struct Part<L> {
        law: Varying<L>,
        shape: Option<(usize, usize)>,
        adapts: bool,
        /// the share of the strongest node that the functions of one gap have
        share: f64,
    }

    impl<L: AdhesionLaw<f64>> AdhesionLaw<f64> for Part<L> {
        fn energy(&self, gap: f64) -> f64 {
            self.share * self.law.energy(gap)
        }
        fn traction(&self, gap: f64) -> f64 {
            self.share * self.law.traction(gap)
        }
        fn slope(&self, gap: f64) -> f64 {
            self.share * self.law.slope(gap)
        }
        fn hints(&self) -> Hints<f64> {
            Hints { shape: self.shape, ..self.law.hints() }
        }
        fn evaluate(&self, first: usize, gaps: &[f64], values: Values<'_, f64>) {
            self.law.evaluate(first, gaps, values);
        }
        fn adapted(&self, to: Discretisation<f64>) -> Option<Box<dyn AdhesionLaw<f64> + '_>> {
            if self.adapts { self.law.adapted(to) } else { None }
        }
    }

    #[test]
    fn the_checker_names_what_a_law_by_node_does_not_say() {
        fn part<L: AdhesionLaw<f64>>(law: L) -> Part<L> {
            let works = ndarray::Array2::from_shape_fn((8, 5), |(_, iy)| if iy % 2 == 0 { 1.0 } else { 0.25 });
            let law = Varying::new(law, works.view()).unwrap();
            Part { law, shape: Some((8, 5)), adapts: true, share: 1.0 }
        }
        let dugdale = || part(MaugisDugdale::new(1.0, 1.0).unwrap());
        let exponential = || part(Exponential::new(1.0, 1.0).unwrap());
        check_law(&dugdale(), 3.0).unwrap();
        // the edge of the adhesive zone would stay where an iteration left it
        let error = check_law(&Part { adapts: false, ..dugdale() }, 3.0).unwrap_err();
        assert!(matches!(error, Error::Jump { gap: 1.0, fall: 1.0 }), "{error}");
        // it could not be solved on nested grids
        let error = check_law(&Part { adapts: false, ..exponential() }, 3.0).unwrap_err();
        assert!(matches!(error, Error::Shape { expected: (4, 3), .. }), "{error}");
        // it would be taken for the same everywhere
        let error = check_law(&Part { shape: None, ..exponential() }, 3.0).unwrap_err();
        let Error::AtNode { node, value, expected, .. } = error else { panic!("{error}") };
        assert!(node == 1 && (value / expected - 0.25).abs() < 1e-12, "{node} {value} {expected}");
        let weaker = check_law(&Part { share: 0.5, ..exponential() }, 3.0).unwrap_err();
        assert!(matches!(weaker, Error::AtNode { node: 0, value: -1.0, expected: -0.5, .. }), "{weaker}");
    }

    #[test]
    fn the_checker_names_values_that_depend_on_where_the_slices_end() {
        struct Counted(Exponential);
        impl AdhesionLaw<f64> for Counted {
            fn energy(&self, gap: f64) -> f64 {
                self.0.energy(gap)
            }
            fn traction(&self, gap: f64) -> f64 {
                self.0.traction(gap)
            }
            fn slope(&self, gap: f64) -> f64 {
                self.0.slope(gap)
            }
            fn evaluate(&self, first: usize, gaps: &[f64], mut values: Values<'_, f64>) {
                self.0.evaluate(first, gaps, values.reborrow());
                values.each(|_, values| values.iter_mut().for_each(|value| *value += f64::EPSILON * gaps.len() as f64));
            }
        }
        let error = check_law(&Counted(Exponential::new(1.0, 1.0).unwrap()), 3.0).unwrap_err();
        assert!(matches!(error, Error::AtNode { node: 0, .. }), "{error}");
    }
}
