//! One problem in units from nanometres to kilometres.

use super::*;

/// A rough patch in units of one's own: lengths, heights and modulus, and the law at a share of the heights.
fn scaled<T: Real>(length: f64, height: f64, modulus: f64, offset: f64) -> Result<(Solution<T>, f64, f64)> {
    let grid = Grid::square(32, length)?;
    let wave = |i: usize, j: usize| {
        let (x, y) = (std::f64::consts::TAU * i as f64 / 32.0, std::f64::consts::TAU * j as f64 / 32.0);
        offset + height * (x.cos() + 0.6 * (y + 1.0).cos() + 0.3 * (2.0 * x + 3.0 * y).sin())
    };
    let surface = Surface::new(grid, Array2::from_shape_fn((32, 32), |(i, j)| wave(i, j)))?;
    let pressure = modulus * height / length;
    let law = Exponential::new(0.02 * pressure * height, 0.2 * height)?;
    let mut problem = Problem::new(&surface, Westergaard::<T>::new(grid, modulus)?, law)?;
    let settings = Settings::default().tolerance(1e-4);
    let solution = Solver::new(settings).solve(&mut problem, Control::MeanPressure(0.8 * pressure))?;
    Ok((solution, height, pressure))
}

/// The same scene from atoms to mountains gives the same answer, or is refused by name.
fn scales<T: Real>(tolerance: f64) -> usize {
    let unit = scaled::<T>(1.0, 0.1, 1.0, 0.0).unwrap();
    assert_eq!(unit.0.report.status, Status::Converged);
    let mut refused = 0;
    for length in [1e-9, 1e-3, 1.0, 1e3] {
        for slope in [1e-6, 1e-3, 0.1] {
            for modulus in [1e-3, 1.0, 1e6, 1e12] {
                let case = format!("{length:e} {slope} {modulus:e}");
                let (solution, height, pressure) = match scaled::<T>(length, slope * length, modulus, 0.0) {
                    Ok(scaled) => scaled,
                    Err(error) => {
                        assert_eq!(error.to_string().lines().count(), 1, "{case}: {error}");
                        refused += 1;
                        continue;
                    }
                };
                let report = &solution.report;
                assert_eq!(report.status, Status::Converged, "{case}");
                let agree = |a: f64, b: f64| (a - b).abs() <= tolerance * b.abs();
                assert!(agree(report.mean_gap / height, unit.0.report.mean_gap / unit.1), "{case}");
                let (here, there) =
                    (report.mean_contact_pressure / pressure, unit.0.report.mean_contact_pressure / unit.2);
                assert!(agree(here, there), "{case} {here} {there}");
                let points = report.contact_nodes.abs_diff(unit.0.report.contact_nodes);
                assert!(points <= 8, "{case}: {points}");
            }
        }
    }
    refused
}

#[test]
fn from_nanometres_to_kilometres_the_answer_is_the_same() {
    assert_eq!(scales::<f64>(1e-3), 0);
    assert_eq!(scales::<f32>(1e-3), 0);
}

#[test]
fn products_beyond_the_range_of_the_precision_are_refused_or_never_called_converged() {
    for (length, height, modulus) in
        [(1e-30, 1.0, 1e30), (1e-9, 1e2, 1e38), (1e3, 1e-42, 1e-3), (1e30, 1e-12, 1e-30), (1.0, 1e-20, 1e-12)]
    {
        match scaled::<f32>(length, height, modulus, 0.0) {
            Err(error) => assert_eq!(error.to_string().lines().count(), 1, "{error}"),
            Ok((solution, ..)) => {
                let report = &solution.report;
                let finite = solution.gap.iter().chain(&solution.pressure).all(|x| x.is_finite());
                assert!(finite || report.status != Status::Converged, "{length:e} {height:e} {modulus:e}");
                assert!(report.iterations <= 2000);
            }
        }
    }
}

#[test]
fn a_datum_a_billion_heights_away_costs_the_digits_that_it_takes_and_no_more() {
    let near = scaled::<f64>(1.0, 0.1, 1.0, 0.0).unwrap().0;
    // a height of 0.1 at 1e8 keeps seven digits
    let far = scaled::<f64>(1.0, 0.1, 1.0, 1e8).unwrap().0;
    assert_eq!(far.report.status, Status::Converged);
    assert!((far.report.mean_gap - near.report.mean_gap).abs() <= 1e-4 * near.report.mean_gap);
    let (shape, grid) = ((2, 3), Grid::new((2, 3), (1.0, 1.0)).unwrap());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut heights = Array2::zeros(shape);
        heights[[1, 2]] = bad;
        let error = Surface::new(grid, heights).unwrap_err();
        assert!(matches!(error, Error::NotFinite { count: 1, first: (1, 2), .. }), "{error}");
    }
    let mut tiny = problem::<f64>(shape, (1.0, 1.0), |i, j| [-0.0, 5e-324, 0.0][(i + j) % 3], bare());
    for control in [Control::MeanGap(0.1), Control::MeanPressure(0.1)] {
        assert_eq!(solve(&mut tiny, control, 1e-6).report.status, Status::Converged, "{control:?}");
    }
}
