use std::sync::Arc;

use super::*;
use crate::adhesion::{Exponential, LennardJones, MaugisDugdale, Morse, PowerLaw, Tabulated, Varying};

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
fn a_law_is_smoothed_by_any_compliance_and_seen_from_near_and_far() {
    for (range, reach) in [(1e-9, 0.5), (1e-3, 5.0), (10.0, 50.0)] {
        let (w, far) = (1e-2, reach * range);
        let dugdale = MaugisDugdale::new(w, range).unwrap();
        check_law::<f64>(&dugdale, far).unwrap();
        for compliance in [1e-3, 0.7, 1e9] {
            let smoothed = dugdale.adapted(Discretisation::Smooth(compliance * range * range / w)).unwrap();
            check_law(&smoothed, far).unwrap();
            assert_eq!(smoothed.hints().work_of_adhesion, w);
        }
    }
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
            Err(Error::Contract { function, .. }) => assert_eq!(function, wrong),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn concave_are_the_laws_whose_traction_falls_everywhere() {
    let concave = |law: &dyn AdhesionLaw<f64>| law.hints().concave;
    let table = |tractions: [f64; 3]| Tabulated::new(&[0.0, 1.0, 3.0], &tractions).unwrap();
    let dugdale = MaugisDugdale::new(2.0, 0.5).unwrap();
    assert!(concave(&Exponential::new(2.0, 0.5).unwrap()) && concave(&PowerLaw::new(2.0, 0.5, 3.0).unwrap()));
    assert!(concave(&dugdale) && concave(&dugdale.adapted(Discretisation::Smooth(0.1)).unwrap()));
    assert!(concave(&table([2.0, 2.0, 0.0])) && !concave(&table([2.0, 2.5, 0.0])));
    assert!(!concave(&LennardJones::new(2.0, 0.5).unwrap()) && !concave(&Morse::new(2.0, 0.5).unwrap()));
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
    assert_eq!(error, broken(1, Humped.traction(0.025), Place::Gap(0.025), Breach::Concave(0.0)));
}

/// A law that varies, with a part of what it should say.
struct Part<L> {
    law: Varying<L>,
    shape: Option<(usize, usize)>,
    adapts: bool,
    share: f64,
}

impl<L: AdhesionLaw<f64> + Clone + 'static> AdhesionLaw<f64> for Part<L> {
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
    fn adapted(&self, to: Discretisation<f64>) -> Option<Arc<dyn AdhesionLaw<f64>>> {
        if self.adapts { self.law.adapted(to) } else { None }
    }
}

#[test]
fn the_checker_names_what_a_law_by_node_does_not_say() {
    fn part<L: AdhesionLaw<f64> + Clone + 'static>(law: L) -> Part<L> {
        let works = ndarray::Array2::from_shape_fn((8, 5), |(_, iy)| if iy % 2 == 0 { 1.0 } else { 0.25 });
        let law = Varying::new(law, works.view()).unwrap();
        Part { law, shape: Some((8, 5)), adapts: true, share: 1.0 }
    }
    let dugdale = || part(MaugisDugdale::new(1.0, 1.0).unwrap());
    let exponential = || part(Exponential::new(1.0, 1.0).unwrap());
    check_law(&dugdale(), 3.0).unwrap();
    // the edge of the adhesive zone would stay where an iteration left it
    let error = check_law(&Part { adapts: false, ..dugdale() }, 3.0).unwrap_err();
    assert_eq!(error, broken(1, 0.0, Place::Gap(1.0), Breach::Jump(1.0)));
    // it could not be solved on nested grids
    let error = check_law(&Part { adapts: false, ..exponential() }, 3.0).unwrap_err();
    assert!(matches!(error, Error::Shape { expected: (4, 3), .. }), "{error}");
    // it would be taken for the same everywhere
    let error = check_law(&Part { shape: None, ..exponential() }, 3.0).unwrap_err();
    let Error::Contract { value, place: Place::Node(1, _), breach: Breach::Alike(expected), .. } = error else {
        panic!("{error}")
    };
    assert!((value / expected - 0.25).abs() < 1e-12, "{value} {expected}");
    let weaker = check_law(&Part { share: 0.5, ..exponential() }, 3.0).unwrap_err();
    assert_eq!(weaker, broken(0, -1.0, Place::Node(0, 0.0), Breach::Alike(-0.5)));
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
    assert!(matches!(error, Error::Contract { place: Place::Node(0, _), .. }), "{error}");
}
