//! The slope of heights between neighbours.

use std::ops::Range;

use ndarray::{Array1, ArrayView2, Axis, Zip};

use crate::par::along_sides;

/// The root mean square of (h(x + Δx) − h(x))/Δx, and likewise along y, over the sides that have neighbours of finite
/// height; NaN if neither has.
///
/// A `periodic` surface continues from the last node of a side to the first.
pub fn rms_slope(heights: ArrayView2<'_, f64>, spacing: (f64, f64), periodic: bool) -> f64 {
    let along = |axis: usize| {
        let (axis, spacing) = (Axis(axis), [spacing.0, spacing.1][axis]);
        let count = heights.len_of(axis);
        let part = |lines: Range<usize>| heights.slice_axis(axis, lines.into());
        let inside = (part(0..count.saturating_sub(1)), part(1.min(count)..count));
        let edge = periodic.then(|| (part(count - 1..count), part(0..1)));
        let both = [Some(inside), edge].into_iter().flatten();
        let sides: usize = both.clone().map(|(before, _)| before.len()).sum();
        let squares = both.clone().map(|(before, after)| squared_steps(before, after, Axis(0)).sum());
        let mean = squares.sum::<f64>() / sides as f64;
        // all heights are finite, and the squares that count in the range of `f64`
        if mean.is_finite() && mean * f64::EPSILON > f64::MIN_POSITIVE {
            return mean.sqrt() / spacing;
        }
        let pairs = both.map(|(before, after)| Zip::from(before).and(after));
        let step =
            |before: &f64, after: &f64| (before.is_finite() && after.is_finite()).then(|| (after - before).abs());
        // in units of the steepest: no square leaves the range of `f64`
        let most = |most: f64, a: &f64, b: &f64| step(a, b).filter(|step| *step > most).unwrap_or(most);
        let most: f64 = pairs.clone().fold(0.0, |found, pairs| pairs.fold(found, most)) / spacing;
        if most.is_infinite() {
            return most;
        }
        let square = |step: f64| if most > 0.0 { (step / spacing / most).powi(2) } else { 0.0 };
        let add = |(sum, count): (f64, f64), a: &f64, b: &f64| {
            step(a, b).map_or((sum, count), |step| (sum + square(step), count + 1.0))
        };
        let (sum, count) = pairs.fold((0.0, 0.0), |sums, pairs| pairs.fold(sums, add));
        most * f64::sqrt(sum / count)
    };
    let sides = along_sides(heights.len(), along).into_iter();
    sides.filter(|slope| !slope.is_nan()).reduce(f64::hypot).unwrap_or(f64::NAN)
}

/// The sums of the squared steps from the lines of a map to other lines of it, line by line along an axis.
pub fn squared_steps(from: ArrayView2<'_, f64>, to: ArrayView2<'_, f64>, axis: Axis) -> Array1<f64> {
    let (mut of_lines, mut of_row) = (Array1::zeros(to.len_of(axis)), Array1::zeros(to.ncols()));
    for (i, (to, from)) in to.rows().into_iter().zip(from.rows()).enumerate() {
        Zip::from(&mut of_row).and(to).and(from).for_each(|square, to, from| *square = (to - from).powi(2));
        match axis {
            Axis(0) => of_lines[i] = of_row.sum(),
            _ => of_lines += &of_row,
        }
    }
    of_lines
}
