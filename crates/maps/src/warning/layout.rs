//! The warnings about numbers that are no heights: coordinates on a first line or column, and bytes in the wrong order.

use ndarray::{Array2, ArrayView1, Axis};

use super::extremes::range;
use super::part::Part::{self, Figure, Word};
use super::{Warning, WarningCode};
use crate::io::coordinates;

/// The fewest numbers of an axis: of fewer, heights may be evenly spaced by chance.
const FEWEST: usize = 5;

/// The same of a profile with uneven steps.
const FEWEST_OF_PROFILE: usize = 8;

/// The difference between steps of an axis, in steps: coordinates are rounded.
const UNEVEN: f64 = 0.01;

/// The path of x along a traced profile, in the range of x: back and forth once at most.
const MOST_TURNS: f64 = 3.0;

/// The rms difference of two lines of a smooth surface, in the rms of one.
const LIKE: f64 = 0.1;

/// The most nodes of a grid for each point of a table; few or many points may be missing.
const MOST_NODES: f64 = 2.0;

/// The decades between the quartiles of magnitudes from which bytes are in the wrong order: heights have one or two,
/// exponents made of other bytes dozens.
const DECADES: f64 = 12.0;

/// The most magnitudes that are looked at.
const MOST: usize = 4096;

/// Whether the numbers of a line behind its first one, which may be a corner, rise or fall evenly.
fn is_even(line: ArrayView1<'_, f64>) -> bool {
    let steps = || line.iter().skip(1).zip(line.iter().skip(2)).map(|(a, b)| b - a);
    let mean = steps().sum::<f64>() / (line.len() - 2) as f64;
    mean != 0.0 && steps().all(|step| (step - mean).abs() <= UNEVEN * mean.abs())
}

/// Whether the first of two lines is x, and the second a profile over it: x is even, or hardly turns, as along a traced
/// line, and differs from the second line, unlike lines of a smooth surface.
fn is_profile(x: ArrayView1<'_, f64>, z: ArrayView1<'_, f64>) -> bool {
    let turns = |line: ArrayView1<'_, f64>| {
        let (low, high) = range(line.iter().copied());
        line.windows(2).into_iter().map(|pair| (pair[1] - pair[0]).abs()).sum::<f64>() / (high - low)
    };
    let [x, z] = [x, z].map(|line| &line - line.mean().unwrap_or_default());
    let (sum, difference, square) = ((&x + &z).pow2().sum(), (&x - &z).pow2().sum(), x.pow2().sum());
    turns(x.view()) <= MOST_TURNS && sum.min(difference) > LIKE * LIKE * square
}

/// Coordinates on the first line or column of a table, or in two columns of points.
pub(super) fn axes(heights: &Array2<f64>) -> Option<Warning> {
    let warning = |text, parts: [Part; 3]| Some(Warning::new(WarningCode::Axes, 0.0, text, parts));
    if let Some(columns) = coordinates(heights.view(), MOST_NODES) {
        let [first, second] = columns.map(|column| Figure(column as f64 + 1.0));
        let remedy = Word("write a file .xyz".into());
        return warning("columns {} and {} are the coordinates of a grid: {}", [first, second, remedy]);
    }
    let is_axis = |axis: Axis| {
        let (lines, line) = (heights.len_of(axis), |index| heights.index_axis(axis, index));
        let is_long = |fewest| lines > 1 && line(0).len() > fewest;
        is_long(FEWEST) && is_even(line(0)) && !is_even(line(1))
            || is_long(FEWEST_OF_PROFILE) && lines == 2 && is_profile(line(0), line(1))
    };
    const PROFILE: &str = "a profile? give the second alone";
    let remedy = |lines| Word(if lines == 2 { PROFILE } else { "leave out coordinates" }.into());
    let (what, numbers, lines) = match [Axis(0), Axis(1)].map(is_axis) {
        [false, false] => return None,
        [true, true] => ("first line and the first column run", heights.column(0), 0),
        [true, false] => ("first line runs", heights.row(0), heights.nrows()),
        [false, true] => ("first column runs", heights.column(0), heights.ncols()),
    };
    let last = Figure(numbers[numbers.len() - 1]);
    warning("the {} like coordinates, up to {}: {}", [Word(what.into()), last, remedy(lines)])
}

/// Numbers with bytes in the wrong order.
pub(super) fn byte_order(heights: &Array2<f64>) -> Option<Warning> {
    let stride = heights.len().div_ceil(MOST).max(1);
    let magnitudes = heights.iter().step_by(stride).map(|h| h.abs());
    let magnitudes = magnitudes.filter(|h| h.is_finite() && *h > 0.0);
    let (least, greatest) = range(magnitudes.clone());
    // the quartiles lie between
    if least >= f64::MIN_POSITIVE && greatest.log10() - least.log10() < DECADES {
        return None;
    }
    let mut magnitudes: Vec<f64> = magnitudes.collect();
    if magnitudes.len() < 4 {
        return None;
    }
    let [low, high] = [1, 3].map(|quarter| {
        let rank = quarter * (magnitudes.len() - 1) / 4;
        magnitudes.select_nth_unstable_by(rank, f64::total_cmp).1.log10()
    });
    // whole numbers become less than the least normal one
    if high - low < DECADES && high >= f64::MIN_POSITIVE.log10() {
        return None;
    }
    let power = |power: f64| Word(format!("1e{power:.0}"));
    let text = "half of the magnitudes are from {} to {}: swap the bytes";
    Some(Warning::new(WarningCode::ByteOrder, high - low, text, [power(low), power(high)]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rough(i: usize, j: usize) -> f64 {
        ((7 * i + 5 * j * j) as f64).sin()
    }

    fn find(heights: &Array2<f64>) -> Vec<String> {
        let both = axes(heights).into_iter().chain(byte_order(heights));
        both.map(|warning| warning.to_string()).collect()
    }

    #[test]
    fn coordinates_are_found_and_heights_are_not() {
        let heights = Array2::from_shape_fn((9, 12), |(i, j)| rough(i, j));
        assert!(find(&heights).is_empty());
        let mut table = heights.clone();
        table.row_mut(0).iter_mut().enumerate().for_each(|(j, h)| *h = 0.25 * j as f64);
        assert!(find(&table)[0].starts_with("axes: the first line runs like coordinates, up to 2.75"));
        table.column_mut(0).iter_mut().enumerate().for_each(|(i, h)| *h = 3.0 - i as f64);
        table[[0, 0]] = f64::NAN;
        assert!(find(&table)[0].contains("first line and the first column"));
        assert!(find(&table.t().to_owned())[0].contains("up to 2.75"));
        let profile = Array2::from_shape_fn((12, 2), |(i, j)| if j == 0 { 0.1 * i as f64 } else { rough(i, j) });
        assert!(find(&profile)[0].contains("a profile?"));
        // of uneven steps, back and forth once, and its lines in the place of columns
        let traced = Array2::from_shape_fn((40, 2), |(i, j)| match (i as f64, j) {
            (t, 0) => t + 0.3 * (3.0 * t).sin() + if i > 20 { 12.0 * (0.2 * (t - 20.0)).sin() } else { 0.0 },
            (t, _) => (0.4 * t).sin() + 0.01 * t,
        });
        assert!(find(&traced)[0].contains("first column runs like coordinates"), "{:?}", find(&traced));
        assert!(find(&traced.t().to_owned())[0].contains("a profile?"));
        // points in any order of columns, half of them missing
        let points = |i: usize| [(i % 6) as f64 * 0.4, rough(i, i), (i / 6) as f64 * 0.5, 1.0];
        let table = Array2::from_shape_fn((24, 4), |(i, j)| points(2 * i)[j]);
        assert!(find(&table)[0].starts_with("axes: columns 1 and 3 are the coordinates"), "{:?}", find(&table));
        // two lines of a smooth or a rough surface
        for of in
            [|i: usize, _: usize| (0.2 * i as f64).sin(), |i, j| (0.2 * i as f64).sin() * (1.0 - 2.0 * j as f64), rough]
        {
            assert!(find(&Array2::from_shape_fn((64, 2), |(i, j)| of(i, j))).is_empty());
        }
        // a plane, a wedge, a flat, a line of heights
        let made: [fn(usize, usize) -> f64; 3] = [|i, j| (2 * i + 3 * j) as f64, |i, _| i as f64, |_, _| 1.0];
        for of in made {
            assert!(find(&Array2::from_shape_fn((9, 12), |(i, j)| of(i, j))).is_empty());
        }
        assert!(find(&Array2::from_shape_fn((9, 1), |(i, _)| i as f64)).is_empty());
    }

    #[test]
    fn bytes_in_the_wrong_order_are_found() {
        let heights = Array2::from_shape_fn((20, 30), |(i, j)| 1e-9 * rough(i, j));
        let swapped = heights.mapv(|h| f64::from_bits(h.to_bits().swap_bytes()));
        assert!(find(&swapped)[0].starts_with("byte-order: half of the magnitudes"), "{:?}", find(&swapped));
        let single = heights.mapv(|h| f64::from(f32::from_bits((h as f32).to_bits().swap_bytes())));
        assert!(find(&single)[0].starts_with("byte-order"));
        // whole numbers become the least that there are
        let whole =
            Array2::from_shape_fn((20, 30), |(i, j)| f64::from_bits(((1 + i * j) as f64).to_bits().swap_bytes()));
        assert!(find(&whole)[0].starts_with("byte-order"));
        // heights of many magnitudes
        assert!(find(&Array2::from_shape_fn((20, 30), |(i, j)| (-((i + j) as f64) / 2.0).exp())).is_empty());
    }
}
