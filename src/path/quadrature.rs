//! The work of a load along a few states.

/// The integral between two points, each abscissa and value, by the trapezoid rule.
pub(super) fn trapezoid((a, before): (f64, f64), (b, after): (f64, f64)) -> f64 {
    0.5 * (before + after) * (b - a)
}

/// The integral from one abscissa to another of the polynomial through points, at most four.
pub(super) fn integral(points: &[(f64, f64)], (a, b): (f64, f64)) -> f64 {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    // Gauss: exact up to the third degree
    let at = |x: f64| -> f64 {
        let term = |i: usize| {
            let others = points.iter().enumerate().filter(|(j, _)| *j != i);
            others.map(|(_, (xj, _))| (x - xj) / (points[i].0 - xj)).product::<f64>() * points[i].1
        };
        (0..points.len()).map(term).sum()
    };
    let offset = half / 3f64.sqrt();
    half * (at(middle - offset) + at(middle + offset))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quadrature_is_exact_for_a_polynomial_through_its_points() {
        let of = |x: f64| (x, 1.0 - 2.0 * x + 0.5 * x * x - 3.0 * x * x * x);
        let primitive = |x: f64| x - x * x + x * x * x / 6.0 - 0.75 * x.powi(4);
        let points = [0.1, 0.15, 0.3, 0.7].map(of);
        assert!((integral(&points, (0.3, 0.7)) - (primitive(0.7) - primitive(0.3))).abs() < 1e-14);
        let line = [(1.0, 2.0), (0.5, 4.0)];
        assert_eq!(integral(&line, (1.0, 0.5)), -1.5);
    }
}
