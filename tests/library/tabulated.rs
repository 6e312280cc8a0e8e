//! Tables of functions: the law that they have, and the functions that make none.

use std::io;

use asperity::adhesion::{Discretisation, Functions, check_functions, check_law};
use asperity::error::{Breach, Place};
use asperity::*;

const W: f64 = 2e-5;
const RANGE: f64 = 8e-3;

/// A law of the library as functions of one gap.
fn functions(law: impl AdhesionLaw<f64>) -> impl Fn(f64) -> [f64; 3] + Sync {
    move |gap| [law.energy(gap), law.traction(gap), law.slope(gap)]
}

/// The functions of Maugis and Dugdale.
fn dugdale(gap: f64) -> [f64; 3] {
    [-W * (1.0 - gap / RANGE).max(0.0), if gap < RANGE { W / RANGE } else { 0.0 }, 0.0]
}

/// Functions with a range that may fail at some gaps.
struct Named<F> {
    of: F,
    range: f64,
    defined: fn(f64) -> bool,
}

impl<F: Fn(f64) -> [f64; 3]> Functions for Named<F> {
    fn set(&self, order: usize, gaps: &[f64], values: &mut [f64]) -> Result<()> {
        if !gaps.iter().all(|&gap| (self.defined)(gap)) {
            return Err(Error::raised(io::Error::other("not defined")));
        }
        self.of.set(order, gaps, values)
    }
    fn range(&self) -> Option<f64> {
        Some(self.range)
    }
}

fn solved<L, C>(law: L, constraint: C, control: Control) -> Solution<f64>
where
    L: AdhesionLaw<f64> + 'static,
    C: ContactConstraint<f64> + 'static,
{
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = SelfAffine::default().k_s(16.0).amplitude(Amplitude::RmsSlope(0.1)).surface(grid).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let settings = Settings::default().tolerance(1e-8);
    let solution = Solver { settings, constraint }.solve(&mut problem, control).unwrap();
    assert_eq!(solution.report.status, Status::Converged);
    solution
}

fn off(a: &Solution<f64>, b: &Solution<f64>, shift: f64) -> f64 {
    a.gap.iter().zip(&b.gap).map(|(a, b)| (a - shift - b).abs()).fold(0.0, f64::max)
}

#[test]
fn a_table_of_functions_is_their_law() {
    let law = Exponential::new(W, RANGE).unwrap();
    let table = Tabulated::of(functions(law)).unwrap();
    let hints = AdhesionLaw::<f64>::hints(&table);
    assert_eq!((hints.work_of_adhesion, hints.rest), (W, None));
    assert!((hints.range / RANGE - 1.0).abs() < 1e-15);
    let gaps = (-400..100).map(|place| RANGE * (f64::from(place) / 12.0).exp2()).chain([0.0, f64::INFINITY]);
    for gap in gaps {
        let found = functions(table.clone())(gap);
        let expected = functions(law)(gap);
        for (n, size) in [1e-11 * W, 1e-11 * W / RANGE, 1e-7 * W / RANGE / RANGE].into_iter().enumerate() {
            assert!((found[n] - expected[n]).abs() <= size, "{n} at {gap:e}: {:e} {:e}", found[n], expected[n]);
        }
        let single = gap as f32;
        assert_eq!(table.traction(single), table.traction(f64::from(single)) as f32);
    }
    check_law::<f64>(&table, 0.1).unwrap();
    check_law::<f32>(&table, 0.1).unwrap();
    let control = Control::MeanPressure(0.01);
    let [own, built_in] = [solved(table, Projection, control), solved(law, Projection, control)];
    assert_eq!(own.report.contact_nodes, built_in.report.contact_nodes);
    assert!(off(&own, &built_in, 0.0) < 1e-7 * RANGE, "{:e}", off(&own, &built_in, 0.0));
}

#[test]
fn a_jump_of_functions_is_smoothed_as_that_of_maugis_and_dugdale() {
    let (law, table) = (MaugisDugdale::new(W, RANGE).unwrap(), Tabulated::of(dugdale).unwrap());
    check_law::<f64>(&table, 0.1).unwrap();
    assert_eq!((table.traction(RANGE.next_down()), table.traction(RANGE)), (W / RANGE, 0.0));
    for compliance in [0.1, 1.0, 10.0].map(|share| share * RANGE * RANGE / W) {
        let smooth = |law: &dyn AdhesionLaw<f64>| functions(law.adapted(Discretisation::Smooth(compliance)).unwrap());
        for gap in (0..=300).map(|place| RANGE * f64::from(place) / 97.0) {
            let [found, expected] = [smooth(&table)(gap), smooth(&law)(gap)];
            for (n, size) in [W, W / RANGE, W / RANGE / RANGE].into_iter().enumerate() {
                assert!((found[n] - expected[n]).abs() <= 1e-10 * size, "{n} at {gap:e}: {} {}", found[n], expected[n]);
            }
        }
    }
    let twice = Discretisation::Smooth(RANGE * RANGE / W);
    let smooth = AdhesionLaw::<f64>::adapted(&table, twice).unwrap();
    assert!(smooth.adapted(twice).is_none(), "it is as smooth already");
    let control = Control::MeanGap(0.012);
    let [own, built_in] = [solved(table, Projection, control), solved(law, Projection, control)];
    assert_eq!(own.report.contact_nodes, built_in.report.contact_nodes);
    assert!((own.report.mean_pressure / built_in.report.mean_pressure - 1.0).abs() < 1e-6);
}

#[test]
fn functions_that_repel_keep_the_surfaces_apart() {
    let control = Control::MeanPressure(0.01);
    let (morse, lennard_jones) = (Morse::new(W, RANGE).unwrap(), LennardJones::new(W, RANGE).unwrap());
    let morses = solved(morse, NoWall, control);
    for rest in [0.0, 2.0 * RANGE] {
        let of = functions(morse);
        let table = Tabulated::of(move |gap: f64| of(gap - rest)).unwrap();
        let hints = AdhesionLaw::<f64>::hints(&table);
        assert!(hints.rest.is_some_and(|found| (found - rest).abs() < 1e-12), "{hints:?}");
        // beyond what is read the law continues, and repels the more
        assert!(table.traction(-1.0) < table.traction(-0.5) && table.traction(-0.5) < -1e9 * W / RANGE);
        assert!(off(&solved(table, NoWall, control), &morses, rest) < 1e-6 * RANGE);
    }
    let table = Tabulated::of(functions(lennard_jones)).unwrap();
    assert_eq!(AdhesionLaw::<f64>::energy(&table, 0.0), f64::INFINITY);
    let [own, built_in] = [solved(table, NoWall, control), solved(lennard_jones, NoWall, control)];
    assert!(off(&own, &built_in, 0.0) < 1e-6 * RANGE);
    // functions that are not defined at negative gaps need a wall
    let strict = Named { of: functions(morse), range: RANGE, defined: |gap| gap >= 0.0 };
    assert_eq!(AdhesionLaw::<f64>::hints(&Tabulated::of(strict).unwrap()).rest, None);
}

/// Attraction by one power of the distance and repulsion by a higher one, at rest at a distance.
fn powers([rest, high, low]: [f64; 3], shift: f64) -> impl Fn(f64) -> [f64; 3] + Sync {
    move |gap| {
        let term = |power: f64, order: f64| (rest / (gap + shift)).powf(power + order);
        let sum = |order: f64, factor: f64| {
            let of = |power: f64| (0..order as u32).fold(1.0, |product, k| product * (power + f64::from(k)) / rest);
            W / (high - low) * factor * (low * of(high) * term(high, order) - high * of(low) * term(low, order))
        };
        [sum(0.0, 1.0), sum(1.0, -1.0), sum(2.0, 1.0)]
    }
}

#[test]
fn any_powers_are_a_law_with_the_gap_of_their_rest_in_any_unit() {
    let r = RANGE;
    for (given, shift) in [([r, 12.0, 6.0], 0.0), ([r, 3.0, 1.5], 0.0), ([r, 8.0, 2.0], r), ([3.7e-3, 5.0, 3.0], 0.0)] {
        for unit in [1e-9, 1.0, 1e3] {
            let of = powers([unit * given[0], given[1], given[2]], unit * shift);
            let table = Tabulated::of(&of).unwrap();
            let rest = AdhesionLaw::<f64>::hints(&table).rest.unwrap() / unit;
            assert!((rest - (given[0] - shift)).abs() < 1e-9 * r, "{given:?} {shift} in {unit}: {rest}");
            for gap in [0.9, 1.1, 3.0].map(|share| unit * (share * given[0] - shift)) {
                let (found, expected) = (table.traction(gap), of(gap)[1]);
                assert!((found / expected - 1.0).abs() < 1e-7, "{given:?} at {gap:e}: {found:e} {expected:e}");
            }
        }
        let of = powers(given, shift);
        for pressure in [1e-4, 0.01, 0.2] {
            let solution = solved(Tabulated::of(&of).unwrap(), NoWall, Control::MeanPressure(pressure));
            let traction = solution.gap.mapv(|gap| of(gap)[1]).mean().unwrap();
            assert!((traction / -pressure - 1.0).abs() < 1e-4, "{given:?} under {pressure}: {traction:e}");
        }
    }
}

#[test]
fn functions_that_are_no_law_are_refused_with_the_reason() {
    let law = Exponential::new(W, RANGE).unwrap();
    let breach = |found: Result<Tabulated>| match found {
        Err(Error::Contract { breach, place: Place::Gap(_), .. }) => breach,
        other => panic!("{other:?}"),
    };
    let changed = |signs: [f64; 3]| {
        let of = functions(law);
        move |gap: f64| std::array::from_fn(|n| signs[n] * of(gap)[n])
    };
    let wrong = changed([1.0, 1.0, 0.5]);
    assert_eq!(breach(Tabulated::of(&wrong)), Breach::Rough);
    let told = check_functions(&wrong, None);
    assert!(matches!(told, Err(Error::Contract { breach: Breach::Derivative(_), .. })), "{told:?}");
    assert!(matches!(breach(Tabulated::of(changed([-1.0, 1.0, 1.0]))), Breach::Sign(rise) if rise < 0.0));
    assert!(matches!(breach(Tabulated::of(changed([1.0, -1.0, -1.0]))), Breach::Sign(rise) if rise > 0.0));
    assert_eq!(breach(Tabulated::of(changed([-1.0; 3]))), Breach::Attract);
    // and of laws whose gap of rest has to be found
    for rest in [0.0, RANGE] {
        let of = functions(Morse::new(W, RANGE).unwrap());
        let changed = |signs: [f64; 3]| {
            let of = &of;
            move |gap: f64| std::array::from_fn(|n| signs[n] * of(gap - rest)[n])
        };
        for signs in [[-1.0, 1.0, 1.0], [1.0, -1.0, -1.0]] {
            let found = Tabulated::of(changed(signs));
            assert!(matches!(found, Err(Error::Contract { breach: Breach::Sign(_), .. })), "{signs:?}: {found:?}");
        }
    }
    let of = |gap: f64| [-1.0 / gap, gap.powi(-2), -2.0 * gap.powi(-3)];
    assert_eq!(breach(Tabulated::of(Named { of, range: RANGE, defined: |_| true })), Breach::Finite);
    let named = |range, defined| Named { of: functions(law), range, defined };
    assert_eq!(breach(Tabulated::of(named(1e-10, |_| true))), Breach::Decay(1e-10));
    for range in [0.0, -1.0, f64::NAN] {
        let found = Tabulated::of(named(range, |_| true));
        assert!(matches!(found, Err(Error::Value { name: "range of the law", .. })), "{found:?}");
    }
    for found in [
        Tabulated::of(named(RANGE, |gap| gap < 1.0)).err(),
        check_functions(named(RANGE, |gap| gap < 0.01), None).err(),
    ] {
        assert!(matches!(&found, Some(Error::Raised(_))), "{found:?}");
    }
    check_functions(dugdale, None).unwrap();
    check_functions(functions(law), Some(0.05)).unwrap();
}
