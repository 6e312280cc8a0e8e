//! The exact solutions against each other, against quadrature of their own fields, and against known values.

mod images;
mod waves;

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};
use std::ops::ControlFlow;

use approx::assert_relative_eq;
use asperity::exact::*;
use asperity::{Control, Error, Grid, Problem, Settings, Solver, Start, Status, Surface, Westergaard};

/// The two spheres of the paper, work of adhesion, range and mean gap.
const PAPER: [(f64, f64, f64); 2] = [(1e-5, 3e-4, 0.0405), (1e-4, 2e-3, 0.0429)];

/// The integral of `f` from `a` to `b` by tanh-sinh quadrature, which takes square-root singularities at the ends;
/// singularities of 1/√ to 1e-8 only, as `f` knows the distance from the end only to rounding.
fn integral(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (step, half) = (1.0 / 16.0, 0.5 * (b - a));
    let mut sum = 0.0;
    for i in -56..=56 {
        let t = step * f64::from(i);
        let arc = FRAC_PI_2 * t.sinh();
        // the distance from the nearer end
        let part = 2.0 * half / (1.0 + (2.0 * arc.abs()).exp());
        let x = if t < 0.0 { a + part } else { b - part };
        if x > a && x < b {
            sum += f(x) * FRAC_PI_2 * t.cosh() / arc.cosh().powi(2);
        }
    }
    sum * half * step
}

/// The same over the pieces between `points`, which are in order.
fn pieces(f: impl Fn(f64) -> f64, points: &[f64]) -> f64 {
    points.windows(2).filter(|p| p[1] > p[0]).map(|p| integral(&f, p[0], p[1])).sum()
}

/// The deflection at the distance r by Boussinesq's kernel, in polar coordinates about that point: the kernel's 1/t and
/// the t of the area cancel, which leaves the integral over all chords of the pressure along them.
fn boussinesq(contact: &Contact, modulus: f64, r: f64) -> f64 {
    let circles = [contact.contact_radius(), contact.adhesion_radius()];
    let chord = |angle: f64| {
        let (across, along) = (r * angle.sin(), r * angle.cos());
        let mut points = vec![0.0];
        for circle in circles {
            if circle > across {
                let half = ((circle - across) * (circle + across)).sqrt();
                points.extend([along - half, along + half].into_iter().filter(|&t| t > 0.0));
            }
        }
        points.sort_by(f64::total_cmp);
        pieces(|t| contact.pressure((t - along).hypot(across)), &points)
    };
    let mut angles = vec![0.0, FRAC_PI_2, PI];
    for circle in circles {
        if circle < r {
            angles.extend([(circle / r).asin(), PI - (circle / r).asin()]);
        }
    }
    angles.sort_by(f64::total_cmp);
    2.0 * pieces(chord, &angles) / (PI * modulus)
}

/// Maugis' sphere of a Tabor parameter, R = 2 and E* = 1, w = 1e-5.
fn of_tabor(tabor: f64) -> MaugisDugdale {
    let sphere = MaugisDugdale::new(2.0, 1.0, 1e-5, 2e-10f64.cbrt() / tabor).unwrap();
    assert_relative_eq!(sphere.tabor_parameter(), tabor, max_relative = 1e-14);
    sphere
}

const TABOR: [f64; 9] = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0];

/// Contacts of all three solutions, from before the pull-off to large ones.
fn contacts() -> Vec<Contact> {
    let mut all = Vec::new();
    for a in [1e-3, 0.07, 0.5] {
        all.push(Hertz::new(2.0, 1.0).unwrap().at_contact_radius(a).unwrap());
        all.push(Jkr::new(2.0, 1.0, 1e-5).unwrap().at_contact_radius(a).unwrap());
        all.extend([0.01, 0.3, 1.36, 10.0, 100.0].map(|t| of_tabor(t).at_contact_radius(a).unwrap()));
    }
    all
}

#[test]
fn pressures_integrate_to_their_loads_and_moments() {
    for contact in contacts() {
        let (a, c) = (contact.contact_radius(), contact.adhesion_radius());
        let moment = |power: i32| pieces(|r| TAU * r.powi(power + 1) * contact.pressure(r), &[0.0, a, c]);
        // the sum of a pressure and a tension that may nearly balance, to the quadrature's error of the tension
        let hertz = 4.0 / 6.0 * a.powi(3);
        let size = hertz + (hertz - contact.load());
        assert!((moment(0) - contact.load()).abs() < 1e-7 * size, "{contact:?}");
        assert!((moment(2) - contact.second_moment()).abs() < 1e-7 * size * c * c, "{contact:?}");
        assert_eq!(contact.pressure(c), 0.0);
    }
}

#[test]
fn displacements_are_those_of_the_pressures() {
    for contact in contacts() {
        let (a, c) = (contact.contact_radius(), contact.adhesion_radius());
        let size = contact.approach().abs() + 2.0 * (0.5 * a * a - contact.approach());
        for r in [0.0, 0.5 * a, 0.99 * a, 1.01 * a, 0.5 * (a + c), 0.99 * c, 1.01 * c, 2.0 * c, 10.0 * c] {
            let exact = boussinesq(&contact, 1.0, r);
            assert!((contact.deflection(r) - exact).abs() < 2e-7 * size, "{r} {exact} {contact:?}");
            // the same in the datum of the surface, and as a gap
            let u = contact.deflection(r) - contact.approach();
            let rounding = 1e-14 * (size + r * r);
            assert!((contact.displacement(r) - u).abs() < rounding);
            assert!((contact.gap(r) - r * r / 4.0 - u).abs() < rounding || r <= a);
        }
        let far = 1e4 * c;
        let point = contact.load() / (PI * far);
        assert!((contact.deflection(far) - point).abs() < 1e-7 * size * c / far);
    }
}

#[test]
fn the_gap_is_the_range_where_dugdales_traction_ends() {
    for tabor in TABOR {
        let (sphere, range) = (of_tabor(tabor), 2e-10f64.cbrt() / tabor);
        for a in [0.0, 1e-6, 1e-3, 0.03, 0.3, 3.0] {
            let contact = sphere.at_contact_radius(a).unwrap();
            let c = contact.adhesion_radius();
            // c/a − 1 is as small as 1e-8, and c known only to rounding: an error of the gap by its slope there
            let slope = (contact.gap(c * (1.0 + 1e-6)) - contact.gap(c)) / (1e-6 * c);
            assert!((contact.gap(c) - range).abs() < 1e-12 * range + 1e-15 * c * slope.abs(), "{tabor} {a}");
            // no jump there: the two formulas meet, to the slope, which is up to some times as large on the inner side
            let jump = contact.gap(c * (1.0 - 1e-12)) - contact.gap(c * (1.0 + 1e-12));
            assert!(jump.abs() < 10.0 * 2e-12 * c * slope, "{tabor} {a} {jump:e}");
        }
    }
}

/// Maugis' sphere of radius R with E* = 1 by its equations in the ratio m = c/a of the radii (Maugis 1992, (6.20) to
/// (6.22)), which the library does not use: a, c, the load and the approach.
fn maugis(m: f64, radius: f64, work: f64, range: f64) -> [f64; 4] {
    let k: f64 = 4.0 / 3.0;
    let lambda = 2.0 * work / range * (radius / (PI * work * k * k)).cbrt();
    let (root, angle) = ((m * m - 1.0).sqrt(), m.recip().acos());
    // ½λA²(…) + ⁴⁄₃λ²A(…) = 1, a quadratic equation of the radius A in units of (πwR²/K)^⅓
    let square = 0.5 * lambda * (root + (m * m - 2.0) * angle);
    let linear = 4.0 / 3.0 * lambda * lambda * (root * angle - m + 1.0);
    let a = 2.0 / (linear + (linear * linear + 4.0 * square).sqrt());
    let load = a.powi(3) - lambda * a * a * (root + m * m * angle);
    let approach = a * a - 4.0 / 3.0 * lambda * a * root;
    let unit = (PI * work * radius * radius / k).cbrt();
    [a * unit, m * a * unit, PI * work * radius * load, unit * unit / radius * approach]
}

#[test]
fn maugis_by_the_ratio_of_the_radii() {
    for (w, range, _) in PAPER {
        let sphere = MaugisDugdale::new(2.0, 1.0, w, range).unwrap();
        for m in [1.001, 1.07, 1.24, 2.0, 10.0] {
            let [a, c, load, approach] = maugis(m, 2.0, w, range);
            let contact = sphere.at_contact_radius(a).unwrap();
            assert_relative_eq!(contact.adhesion_radius(), c, max_relative = 1e-9);
            assert_relative_eq!(contact.load(), load, max_relative = 1e-9, epsilon = 1e-9 * w);
            assert_relative_eq!(contact.approach(), approach, max_relative = 1e-9, epsilon = 1e-9 * range);
        }
    }
}

#[test]
fn maugis_pull_off_between_jkr_and_dmt() {
    let force = |tabor: f64| -of_tabor(tabor).pull_off().load() / (PI * 1e-5 * 2.0);
    for tabor in [27.144, 2.7144, 1.3572, 0.27144, 0.027144] {
        // the least load of all ratios c/a, by thirds of ln(c/a − 1)
        let load = |s: f64| maugis(1.0 + s.exp(), 2.0, 1e-5, 2e-10f64.cbrt() / tabor)[2] / (PI * 1e-5 * 2.0);
        let (mut low, mut high) = (-12.0, 12.0);
        for _ in 0..100 {
            let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if load(left) < load(right) { high = right } else { low = left }
        }
        assert_relative_eq!(force(tabor), -load(low), max_relative = 1e-9);
    }
    let forces = TABOR.map(force);
    assert!(forces.is_sorted_by(|a, b| a > b) && forces[0] < 2.0 && forces[8] > 1.5);
    // the correction to JKR is of second order in 1/μ_T
    assert_relative_eq!((force(30.0) - 1.5) / (force(100.0) - 1.5), 100.0f64.powi(2) / 900.0, max_relative = 0.02);
    assert!((force(1000.0) - 1.5).abs() < 2e-7);
    assert!((2.0 - force(1e-4)) < 1e-5);
}

#[test]
fn maugis_tends_to_jkr_and_dmt() {
    let jkr = Jkr::new(2.0, 1.0, 1e-5).unwrap();
    let unit = PI * 2e-5;
    for a in [0.04, 0.0521, 0.1, 0.3] {
        let limit = jkr.at_contact_radius(a).unwrap();
        let differences = [10.0, 100.0, 1e3, 1e4].map(|tabor| {
            let contact = of_tabor(tabor).at_contact_radius(a).unwrap();
            assert!(contact.contact_radius() == a || (contact.contact_radius() / a - 1.0).abs() < 1e-14);
            ((contact.load() - limit.load()) / unit).abs().max((contact.approach() - limit.approach()).abs() / (a * a))
        });
        // of first order in 1/μ_T at a given radius
        assert!(differences[0] < 0.5 && differences.windows(2).all(|d| d[1] < 0.2 * d[0]), "{differences:?}");
        // DMT: Hertz' load less 2πwR
        let dmt = Hertz::new(2.0, 1.0).unwrap().at_contact_radius(a).unwrap().load() - 2.0 * unit;
        let differences = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5]
            .map(|tabor| ((of_tabor(tabor).at_contact_radius(a).unwrap().load() - dmt) / unit).abs());
        assert!(differences[4] < 1e-2 * a && differences.windows(2).all(|d| d[1] < 0.2 * d[0]), "{differences:?}");
    }
    // a smaller contact at any load in between, and never an invalid state
    for tabor in TABOR {
        for i in -60..=20 {
            let contact = of_tabor(tabor).at_contact_radius(10f64.powf(0.1 * f64::from(i))).unwrap();
            assert!(contact.adhesion_radius() > contact.contact_radius() || tabor > 30.0);
            assert!(contact.load().is_finite() && contact.approach().is_finite());
        }
    }
}

#[test]
fn jkr_pulls_off_at_its_minima() {
    let (r, e, w) = (3e-6, 2e9, 0.05);
    let sphere = Jkr::new(r, e, w).unwrap();
    let pull_off = sphere.pull_off();
    assert_relative_eq!(pull_off.load(), -1.5 * PI * w * r, max_relative = 1e-14);
    let at = sphere.at_load(pull_off.load() * (1.0 - 1e-15)).unwrap();
    assert_relative_eq!(at.contact_radius(), pull_off.contact_radius(), max_relative = 1e-6);
    // the least approach, at a³ = πwR²/8E*: δ = −3a²/R
    let a = (PI * w * r * r / (8.0 * e)).cbrt();
    let least = -3.0 * a * a / r;
    assert_relative_eq!(sphere.at_contact_radius(a).unwrap().approach(), least, max_relative = 1e-13);
    assert_relative_eq!(sphere.at_approach(least * (1.0 - 1e-14)).unwrap().contact_radius(), a, max_relative = 1e-6);
    assert!(sphere.at_approach(1.000_001 * least).is_err() && sphere.at_load(1.000_001 * pull_off.load()).is_err());
}

/// Load, approach and radius lead back to one another.
fn round_trips(sphere: &impl Sphere, unit: f64) {
    for i in -12..=36 {
        let load = unit * 10f64.powf(0.25 * f64::from(i));
        for load in if -sphere.pull_off().load() > 0.0 { vec![load, -0.9 * unit, 0.0] } else { vec![load] } {
            let contact = sphere.at_load(load).unwrap();
            let a = contact.contact_radius();
            assert!((contact.load() - load).abs() <= 1e-13 * load.abs().max(unit), "{load} {contact:?}");
            let same = sphere.at_contact_radius(a).unwrap();
            assert_relative_eq!(same.contact_radius(), a, max_relative = 1e-14);
            assert!((same.load() - load).abs() <= 1e-13 * load.abs().max(unit), "{load} {same:?}");
            let same = sphere.at_approach(contact.approach()).unwrap();
            // δ of the unit load has an order of a² /R: there and above the slope of δ is as large
            assert_relative_eq!(same.contact_radius(), a, max_relative = 1e-11);
        }
    }
}

#[test]
fn loads_radii_and_approaches_lead_back_in_any_units() {
    for (length, modulus) in [(1.0, 1.0), (1e-9, 1e12), (1e6, 1e-6), (1e-12, 1e-20)] {
        let (r, w) = (2.0 * length, 1e-5 * modulus * length);
        let unit = 1.5 * PI * w * r;
        round_trips(&Hertz::new(r, modulus).unwrap(), unit);
        round_trips(&Jkr::new(r, modulus, w).unwrap(), unit);
        for tabor in TABOR {
            let sphere = MaugisDugdale::new(r, modulus, w, length * 2e-10f64.cbrt() / tabor).unwrap();
            round_trips(&sphere, unit);
            let load = sphere.pull_off().load() / (modulus * length * length);
            assert_relative_eq!(load, of_tabor(tabor).pull_off().load(), max_relative = 1e-12);
        }
    }
}

#[test]
fn the_contact_radius_of_maugis_grows_along_its_family() {
    for tabor in TABOR {
        let sphere = of_tabor(tabor);
        let loads: Vec<f64> =
            (-80..=20).map(|i| sphere.at_contact_radius(10f64.powf(0.1 * f64::from(i))).unwrap().load()).collect();
        // one minimum
        let turns = loads.windows(3).filter(|l| (l[1] - l[0]) * (l[2] - l[1]) < -1e-24).count();
        assert!(turns <= 1, "{tabor} {turns}");
    }
}

/// −Σ1/n over the square lattice without its origin, the mean removed, and a quarter of Σ1/n³.
const M1: f64 = 3.900_264_920_001_956;

const C2: f64 = 2.258_405_420_775_237_6;

#[test]
fn what_has_no_solution_is_refused_by_name() {
    let named = |error: Error, expected: &str| match error {
        Error::Value { name, .. } => assert_eq!(name, expected),
        other => panic!("{other}"),
    };
    named(Hertz::new(0.0, 1.0).unwrap_err(), "radius of curvature");
    named(Jkr::new(1.0, f64::NAN, 1.0).unwrap_err(), "contact modulus");
    named(Jkr::new(1.0, 1.0, -1.0).unwrap_err(), "work of adhesion");
    named(MaugisDugdale::new(1.0, 1.0, 1.0, 0.0).unwrap_err(), "range of adhesion");
    let (hertz, maugis) = (Hertz::new(2.0, 1.0).unwrap(), of_tabor(1.0));
    named(hertz.at_load(-1e-9).unwrap_err(), "load");
    named(hertz.at_approach(-1e-9).unwrap_err(), "approach");
    named(maugis.at_load(-1.0).unwrap_err(), "load");
    named(maugis.at_load(f64::NAN).unwrap_err(), "load");
    named(maugis.at_approach(-1.0).unwrap_err(), "approach");
    named(maugis.at_contact_radius(-1.0).unwrap_err(), "contact radius");
    let periodic = Periodic::new(hertz, 1.0).unwrap();
    named(Periodic::new(hertz, -1.0).unwrap_err(), "period");
    named(periodic.at_mean_gap(0.05, -1.0 / 24.0).unwrap_err(), "mean gap");
    named(periodic.at_mean_gap(0.001, -1.0 / 24.0).unwrap_err(), "mean gap");
    named(periodic.at_mean_gap(f64::NAN, 0.0).unwrap_err(), "mean gap");
    named(periodic.at_contact_radius(0.4).unwrap_err(), "contact radius");
    named(periodic.at_load(1.0).unwrap_err(), "load");
    let strong = Jkr::new(2.0, 1.0, 0.1).unwrap();
    named(Periodic::new(strong, 1.0).unwrap().pull_off().unwrap_err(), "period");
    named(Periodic::new(strong, 1.0).unwrap().at_mean_gap(0.04, 0.0).unwrap_err(), "mean gap");
    named(Periodic::new(maugis, 1e-3).unwrap().pull_off().unwrap_err(), "period");
    let state = periodic.at_load(1e-4).unwrap();
    named(state.pressure_field(&Grid::square(4, 2.0).unwrap()).unwrap_err(), "side length Lx");
    named(state.displacement_field(&Grid::new((4, 4), (1.0, 2.0)).unwrap()).unwrap_err(), "side length Ly");
    let wave = WavyLine::new(0.02, 1.0, 1.0).unwrap();
    named(WavyLine::new(-0.02, 1.0, 1.0).unwrap_err(), "amplitude");
    named(wave.at_mean_gap(0.03).unwrap_err(), "mean gap");
    named(wave.at_mean_pressure(-1.0).unwrap_err(), "mean pressure");
    named(wave.at_half_width(0.6).unwrap_err(), "half-width");
    let sticky = AdhesiveWavyLine::new(0.02, 1.0, 1.0, 1e-5).unwrap();
    named(sticky.at_mean_gap(1.0).unwrap_err(), "mean gap");
    named(sticky.at_mean_pressure(-1.0).unwrap_err(), "mean pressure");
    named(sticky.at_half_width(0.5).unwrap_err(), "half-width");
}

#[test]
fn a_wavy_sphere_is_that_of_its_parts() {
    use asperity::exact::WavySphere;
    let (radius, work) = (20.0, 1e-3);
    // without a wave it is the sphere of Johnson, Kendall and Roberts: its one branch ends where contact is lost
    let (plain, jkr) = (WavySphere::new(radius, 1.0, work, (0.0, 1.0)).unwrap(), Jkr::new(radius, 1.0, work).unwrap());
    for a in [0.1, 0.7, 2.0] {
        let contact = jkr.at_contact_radius(a).unwrap();
        assert!(
            (plain.load(a) - contact.load()).abs() < 1e-14 && (plain.approach(a) - contact.approach()).abs() < 1e-15
        );
    }
    let lost = plain.jumps(0.1, -1.0).unwrap();
    // dδ/da = 0: a³ = πwR²/8E*
    assert!(
        lost.len() == 1 && (lost[0][0] - (PI * work * radius * radius / 8.0).cbrt()).abs() < 1e-6 && lost[0][1] == 0.0
    );
    // F' = 2E*a δ' for what does not adhere
    let wavy = WavySphere::new(radius, 1.0, work, (0.012, 1.0)).unwrap();
    let sphere =
        |a: f64| (wavy.load(a) + (8.0 * PI * work * a.powi(3)).sqrt(), wavy.approach(a) + (2.0 * PI * work * a).sqrt());
    for a in [0.05, 0.3, 1.1, 2.9] {
        let step = 1e-4;
        let (low, high) = (sphere(a - step), sphere(a + step));
        let (load, approach) = (high.0 - low.0, high.1 - low.1);
        assert!((load - 2.0 * a * approach).abs() < 1e-5 * load.abs().max(1e-4), "{a}");
    }
    // each jump keeps the approach, and lets the force fall as the bodies come together and rise as they part
    let (far, near) = (-0.12, wavy.approach(3.0));
    for (from, to, count, sign) in [(far, near, 3, 1.0), (near, far, 3, -1.0)] {
        let jumps = wavy.jumps(from, to).unwrap();
        assert_eq!(jumps.len(), count, "{jumps:?}");
        for [before, after] in jumps {
            assert!(sign * (after - before) > 0.0);
            if after > 0.0 {
                assert!((wavy.approach(before) - wavy.approach(after)).abs() < 1e-9);
            }
            assert!(wavy.load(before) >= wavy.load(after) || sign < 0.0);
        }
    }
    assert!(wavy.jumps(f64::NAN, 0.0).is_err() && WavySphere::new(radius, 1.0, work, (-1.0, 1.0)).is_err());
}
