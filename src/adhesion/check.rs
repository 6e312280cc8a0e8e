//! A check that an adhesion law is one, for users' tests.

use super::AdhesionLaw;
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

/// Tells whether the functions of a law agree with one another.
///
/// Compares, at 200 gaps between 0 (or half the gap of rest) and `largest_gap`, the traction with central differences
/// of the energy and the slope with central differences of the traction, in the precision of the law, to a hundredth of
/// the largest value of that function. A function may jump (as the traction of Maugis–Dugdale does at ρ): gaps beside a
/// jump, where the differences grow as their step shrinks, are passed over. Then it holds the law to what else it says:
///
/// - where the traction jumps, the law has a [smoothed](AdhesionLaw::smoothed) one that does not, with the same work of
///   adhesion, whose functions agree as well;
/// - where the energy is [concave](AdhesionLaw::is_concave), the traction does not rise from one of the gaps to the next;
/// - the functions of many gaps give what those of one gap do. Of a law that has a [shape](AdhesionLaw::shape) they
///   agree with one another, node by node, and no node is stronger than the functions of one gap say.
///
/// # Errors
/// [`Error::Law`] with the function, the first gap at which it is not finite or is not the derivative of the one
/// before it, and what it should be there; [`Error::Jump`] with the gap at which the traction jumps;
/// [`Error::Concave`] with the gap to which the traction rises; [`Error::AtNode`] with the function that differs;
/// [`Error::Value`] if `largest_gap` is not positive and finite, or if the smoothed law has another work of adhesion.
///
/// ```
/// use asperity::adhesion::check_law;
/// use asperity::{Exponential, MaugisDugdale};
/// check_law::<f64>(&Exponential::new(1e-4, 2e-3)?, 0.02)?;
/// check_law::<f32>(&MaugisDugdale::new(1e-4, 2e-3)?, 0.02)?;
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn check_law<T: Real>(law: &impl AdhesionLaw<T>, largest_gap: f64) -> Result<()> {
    Error::positive("largest gap", largest_gap)?;
    // closer than half its gap of rest a law may grow without bound
    let least = law.rest().map_or(0.0, |rest| 0.5 * rest.widen());
    let length = law.range().widen().clamp(1e-3 * largest_gap, largest_gap);
    let checked = Checked { law, gaps: (least, largest_gap), length };
    checked.functions()?;
    checked.smoothness()?;
    checked.concavity()?;
    checked.nodes()
}

/// A law, the gaps at which it is looked at, and the one over which it varies.
struct Checked<'a, T> {
    law: &'a dyn AdhesionLaw<T>,
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

    /// Holds a law whose traction jumps to what its smoothed law has to be.
    fn smoothness(&self) -> Result<()> {
        let Some((gap, fall)) = self.jump() else { return Ok(()) };
        let jumps = Err(Error::Jump { gap, fall });
        let compliance = SMOOTHING * self.length / self.largest();
        let Some(smoothed) = self.law.smoothed(T::lit(compliance)) else { return jumps };
        let smooth = Checked { law: &*smoothed, ..*self };
        smooth.functions()?;
        let [work, left] = [self.law, smooth.law].map(|law| law.work_of_adhesion().widen());
        let keeps = (left - work).abs() <= SHARE * work.abs();
        if !keeps {
            let requirement = "that of the law, which a smoothed one keeps";
            return Err(Error::Value { name: "work of adhesion of the smoothed law", value: left, requirement });
        }
        if smooth.jump().is_some() { jumps } else { Ok(()) }
    }

    fn concavity(&self) -> Result<()> {
        if !self.law.is_concave() {
            return Ok(());
        }
        let gaps = (0..=GAPS).map(|i| self.gaps.1 * i as f64 / GAPS as f64);
        let tractions: Vec<_> = gaps.map(|gap| (gap, self.law.traction(T::lit(gap)).widen())).collect();
        let rounding = ROUNDINGS * T::epsilon().widen() * self.law.traction(T::zero()).abs().widen();
        let rises = |pair: &&[(f64, f64)]| pair[1].1 > pair[0].1 + rounding;
        match tractions.windows(2).find(rises) {
            Some(&[(_, nearer), (gap, traction)]) => Err(Error::Concave { gap, traction, nearer }),
            _ => Ok(()),
        }
    }

    /// Energy, traction and slope of one node.
    fn at(&self, node: usize, gap: T) -> [T; 3] {
        let [mut energy, mut traction, mut slope] = [[T::zero()]; 3];
        self.law.energies(node, &[gap], &mut energy);
        self.law.tractions(node, &[gap], &mut traction);
        self.law.slopes(node, &[gap], &mut slope);
        [energy[0], traction[0], slope[0]]
    }

    /// Compares the functions of many gaps with those of one, or, where they differ from node to node, with one another.
    fn nodes(&self) -> Result<()> {
        let (law, shape) = (self.law, self.law.shape());
        let nodes = shape.map_or(NODES, |(nx, ny)| nx * ny);
        let gaps: Vec<T> = (0..nodes.min(NODES)).map(|i| self.gap(i % (GAPS + 1))).collect();
        let mut values = [(); 7].map(|()| vec![T::zero(); gaps.len()]);
        let [e, t, s, also_e, also_t, t_again, also_s] = &mut values;
        law.energies(0, &gaps, e);
        law.tractions(0, &gaps, t);
        law.slopes(0, &gaps, s);
        law.energies_and_tractions(0, &gaps, also_e, also_t);
        law.tractions_and_slopes(0, &gaps, t_again, also_s);
        let expected: Vec<[T; 3]> = gaps
            .iter()
            .enumerate()
            .map(|(node, &gap)| match shape {
                Some(_) => self.at(node, gap),
                None => [law.energy(gap), law.traction(gap), law.slope(gap)],
            })
            .collect();
        for (values, of) in values.iter().zip([0, 1, 2, 0, 1, 1, 2]) {
            let size = expected.iter().map(|expected| expected[of].abs().widen()).fold(0.0, f64::max);
            for (node, (value, expected)) in values.iter().zip(&expected).enumerate() {
                let (value, expected) = (value.widen(), expected[of].widen());
                // of the rows of another process nothing is known
                let unknown = shape.is_some() && expected.is_nan();
                let agrees = unknown || (value - expected).abs() <= SHARE * size;
                if !agrees {
                    let gap = gaps[node].widen();
                    return Err(Error::AtNode { function: NAMES[of], node, gap, value, expected });
                }
            }
        }
        let places = shape.map_or(0, |_| nodes);
        (0..places).step_by(places.div_ceil(PLACES).max(1)).try_for_each(|node| self.place(node))
    }

    /// Compares the functions of a node with one another, and with the strongest one.
    fn place(&self, node: usize) -> Result<()> {
        let rest = self.law.rest().unwrap_or_else(T::zero);
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adhesion::Varying;
    use crate::{Exponential, LennardJones, MaugisDugdale, Morse, NoAdhesion, PowerLaw, Tabulated};

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
                    // a reference to a law has its jumps too
                    let reference: &dyn AdhesionLaw<f64> = &dugdale;
                    let smoothed = reference.smoothed(compliance * range * range / w).unwrap();
                    check_law(&smoothed, far).unwrap();
                    assert_eq!(smoothed.work_of_adhesion(), w);
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
            law.is_concave()
        }
        let dugdale = MaugisDugdale::new(2.0, 0.5).unwrap();
        assert!(concave::<f64>(&Exponential::new(2.0, 0.5).unwrap()) && concave::<f32>(&dugdale));
        assert!(concave(&*AdhesionLaw::<f64>::smoothed(&dugdale, 0.1).unwrap()));
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
            fn range(&self) -> f64 {
                1.0
            }
            fn is_concave(&self) -> bool {
                true
            }
        }
        let error = check_law(&Humped, 5.0).unwrap_err();
        let Error::Concave { gap, traction, nearer } = error else { panic!("{error}") };
        assert_eq!((gap, traction, nearer), (0.025, Humped.traction(0.025), 0.0));
    }

    /// A law of Maugis and Dugdale by node, with a part of what it should say.
    struct Part<'a> {
        law: MaugisDugdale,
        shares: &'a [f64],
        shape: Option<(usize, usize)>,
        smoothed: bool,
        largest: f64,
    }

    impl Part<'_> {
        fn scale(&self, first: usize, values: &mut [f64]) {
            values.iter_mut().zip(&self.shares[first..]).for_each(|(value, share)| *value *= share);
        }
    }

    impl AdhesionLaw<f64> for Part<'_> {
        fn energy(&self, gap: f64) -> f64 {
            self.largest * self.law.energy(gap)
        }
        fn traction(&self, gap: f64) -> f64 {
            self.largest * self.law.traction(gap)
        }
        fn slope(&self, gap: f64) -> f64 {
            self.largest * self.law.slope(gap)
        }
        fn shape(&self) -> Option<(usize, usize)> {
            self.shape
        }
        fn smoothed(&self, compliance: f64) -> Option<Box<dyn AdhesionLaw<f64> + '_>> {
            self.smoothed.then(|| AdhesionLaw::<f64>::smoothed(&self.law, compliance)).flatten()
        }
        fn energies(&self, first: usize, gaps: &[f64], energies: &mut [f64]) {
            self.law.energies(first, gaps, energies);
            self.scale(first, energies);
        }
        fn tractions(&self, first: usize, gaps: &[f64], tractions: &mut [f64]) {
            self.law.tractions(first, gaps, tractions);
            self.scale(first, tractions);
        }
        fn slopes(&self, first: usize, gaps: &[f64], slopes: &mut [f64]) {
            self.law.slopes(first, gaps, slopes);
            self.scale(first, slopes);
        }
    }

    #[test]
    fn the_checker_names_what_a_law_by_node_does_not_say() {
        let shares: Vec<f64> = (0..40).map(|node| if node % 2 == 0 { 1.0 } else { 0.25 }).collect();
        let whole = || {
            let law = MaugisDugdale::new(1.0, 1.0).unwrap();
            Part { law, shares: &shares, shape: Some((8, 5)), smoothed: true, largest: 1.0 }
        };
        check_law(&whole(), 3.0).unwrap();
        let found = |part: Part<'_>| check_law(&part, 3.0).unwrap_err();
        // the edge of the adhesive zone would stay where an iteration left it
        let Error::Jump { gap, fall } = found(Part { smoothed: false, ..whole() }) else { panic!() };
        assert_eq!((gap, fall), (1.0, 1.0));
        // it would be taken for the same everywhere
        let Error::AtNode { node, value, expected, .. } = found(Part { shape: None, ..whole() }) else { panic!() };
        assert_eq!((node, value), (1, 0.25 * expected));
        let longer = MaugisDugdale::new(1.0, 5.0).unwrap();
        let weaker = found(Part { law: longer, largest: 0.5, ..whole() });
        assert!(matches!(weaker, Error::AtNode { node: 0, value: -1.0, expected: -0.5, .. }), "{weaker}");
        let law = Varying::new(Morse::new(1.0, 1.0).unwrap(), ndarray::array![[0.0, 2.0], [1.0, 0.5]].view()).unwrap();
        check_law::<f64>(&law, 5.0).unwrap();
        check_law::<f32>(&law, 5.0).unwrap();
    }
}
