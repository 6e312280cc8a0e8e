//! Tests of the forms of bodies that are fitted and removed.

use approx::assert_relative_eq;

use super::super::{Form, Topography};
use super::{map, pierced, rough};
use asperity::Error;

/// The side of a sphere or a cylinder that faces up, or down if the radius is negative.
fn body(form: Form, radius: f64, (x0, y0): (f64, f64), angle: f64) -> impl Fn(f64, f64) -> f64 {
    move |i, j| {
        let (x, y) = (0.1 * (i - 19.5) - x0, 0.1 * (j - 14.5) - y0);
        let across = match form {
            Form::Sphere => x * x + y * y,
            Form::Cylinder => (y * angle.cos() - x * angle.sin()).powi(2),
        };
        -radius.signum() * across / (radius.abs() + (radius * radius - across).sqrt())
    }
}

#[test]
fn forms_are_found_and_removed_exactly_whatever_is_missing() {
    for (form, radius, apex, angle) in [
        (Form::Sphere, 3.5, (0.5, -0.3), 0.0),
        (Form::Sphere, -40.0, (9.0, 2.0), 0.0),
        (Form::Sphere, 1e6, (0.0, 0.0), 0.0),
        (Form::Cylinder, 4.0, (0.3, 0.2), 0.4),
        (Form::Cylinder, -30.0, (1.0, -2.0), -1.2),
        (Form::Cylinder, 5.0, (0.0, 0.0), 1.5),
    ] {
        let whole = map((40, 30), (4.0, 3.0), body(form, radius, apex, angle));
        let pierced = pierced(whole, |i, j| (3 * i + 5 * j).is_multiple_of(11) || i < 6 && j > 20);
        let fit = pierced.fit_form(form).unwrap();
        // rounding of the heights, relative to what the curvature makes of them
        assert_relative_eq!(fit.radius, radius, max_relative = 1e-9 * radius.abs().max(1.0));
        assert_eq!(fit.axis.is_some(), form == Form::Cylinder);
        if let Some(axis) = fit.axis {
            assert_relative_eq!(axis, angle, epsilon = 1e-8);
        }
        let flat = pierced.clone().remove_form(form).unwrap();
        assert!(flat.rms_height() < 1e-11 && flat.missing() == pierced.missing(), "{}", flat.rms_height());
        assert_relative_eq!(flat.rms_height(), fit.residual, epsilon = 1e-12);
    }
}

#[test]
fn a_rod_across_a_narrow_map_is_found_below_roughness_that_is_bent_more() {
    let along = |k: usize| (k as f64 - 31.5) / 64.0;
    let rod = |radius: f64| move |i: f64, _: f64| (radius * radius - along(i as usize).powi(2)).sqrt() - radius;
    let mut narrow = map((64, 6), (1.0, 0.1), rod(12.5));
    let ridge = |j: usize| 1e-3 * (1.5 * (j as f64 - 2.5)).cos();
    narrow.heights.indexed_iter_mut().for_each(|((_, j), h)| *h += ridge(j));
    let fit = narrow.fit_form(Form::Cylinder).unwrap();
    assert_relative_eq!(fit.axis.unwrap().abs(), std::f64::consts::FRAC_PI_2, epsilon = 1e-6);
    // what does not depend on x has no part in the rod
    assert_relative_eq!(fit.radius, 12.5, max_relative = 1e-6);
}

#[test]
fn a_fitted_form_has_the_least_squares_on_a_rough_body() {
    for form in [Form::Sphere, Form::Cylinder] {
        let roughness = rough((40, 30), 8.0);
        let mut bent = map((40, 30), (4.0, 3.0), body(form, 4.0, (0.4, -0.2), 0.7));
        bent.heights.zip_mut_with(&roughness.heights, |h, rough| *h += 0.02 * rough + 7.0);
        let flat = bent.clone().remove_form(form).unwrap();
        assert!(flat.rms_height() < 0.021 && flat.mean().abs() < 1e-9, "{}", flat.rms_height());
        // no body of the same form that is shifted, tilted or bent a little fits better
        let fit = bent.fit_form(form).unwrap();
        for (shape, angle) in [((0.0, 1e-3), 0.7), ((1e-3, 0.0), 0.7), ((0.0, 0.0), 0.7 + 1e-3)] {
            for sign in [-1.0, 1.0] {
                let step = |a: f64, b: f64| sign * (a - b);
                let (there, here) =
                    (body(form, 4.0, (0.4 + shape.0, -0.2 + shape.1), angle), body(form, 4.0, (0.4, -0.2), 0.7));
                let shifted = flat.heights.indexed_iter().map(|((i, j), h)| {
                    let (i, j) = (i as f64, j as f64);
                    h + step(there(i, j), here(i, j))
                });
                let (mean, count) = (shifted.clone().sum::<f64>() / 1200.0, 1200.0);
                let rms = (shifted.map(|h| (h - mean).powi(2)).sum::<f64>() / count).sqrt();
                // the step along the valley is not quite one between bodies of this radius: second order in 1e-3
                assert!(rms > fit.residual - 1e-6, "{form:?} {shape:?}: {rms} below {}", fit.residual);
            }
        }
    }
    // what has no curvature is a plane; without side lengths there is no form
    let plane = map((20, 20), (2.0, 2.0), |i, j| 0.3 * i - 0.1 * j);
    assert!(plane.fit_form(Form::Sphere).unwrap().radius.abs() > 1e6);
    assert!(plane.clone().remove_form(Form::Cylinder).unwrap().rms_height() < 1e-12);
    let unknown = Topography::new(plane.heights).remove_form(Form::Sphere);
    assert!(matches!(unknown, Err(Error::Value { name: "side length Lx", .. })));
    let line = map((50, 1), (5.0, 7.0), |i, _| (9.0 - (0.1 * (i - 24.5)).powi(2)).sqrt());
    assert_relative_eq!(line.fit_form(Form::Sphere).unwrap().radius, 3.0, max_relative = 1e-9);
}
