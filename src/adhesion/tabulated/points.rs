//! Tables of points, with a monotone cubic through them.

use super::{Hints, Piece, Tabulated};
use crate::error::{Error, Result};

impl Tabulated {
    /// The law through points of a gap (length), from zero on, and a traction (pressure; positive attracts), last zero.
    ///
    /// Slopes by Fritsch and Butland (*SIAM J. Sci. Stat. Comput.* 5 (1984)): no extremes that the points have not. The
    /// energy is zero from the last point on.
    ///
    /// # Errors
    /// [`Error::Value`] for fewer than three points, unequal numbers of gaps and tractions, a number that is not
    /// finite, gaps that do not rise from zero, a last traction that is not zero, or no attraction.
    ///
    /// ```
    /// use asperity::adhesion::check_law;
    /// use asperity::{AdhesionLaw, Tabulated};
    /// // a traction that falls evenly over 2 nm
    /// let law = Tabulated::new(&[0.0, 1e-9, 2e-9], &[50e6, 25e6, 0.0])?;
    /// assert!((AdhesionLaw::<f64>::hints(&law).work_of_adhesion - 0.05).abs() < 1e-15);
    /// check_law::<f64>(&law, 3e-9)?;
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn new(gaps: &[f64], tractions: &[f64]) -> Result<Self> {
        let wrong = |name, value, requirement| Err(Error::Value { name, value, requirement });
        if gaps.len() != tractions.len() {
            return wrong("number of tractions in the table", tractions.len() as f64, "the number of gaps");
        }
        if gaps.len() < 3 {
            return wrong("number of points in the table", gaps.len() as f64, "at least three");
        }
        for (name, values) in [("gap in the table", gaps), ("traction in the table", tractions)] {
            if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
                return wrong(name, value, "finite");
            }
        }
        if gaps[0] != 0.0 {
            return wrong("first gap in the table", gaps[0], "zero, the traction in contact");
        }
        if let Some(pair) = gaps.windows(2).find(|pair| pair[1] <= pair[0]) {
            return wrong("gap in the table", pair[1], "larger than the one before: sort the table by its gaps");
        }
        let last = gaps.len() - 1;
        if tractions[last] != 0.0 {
            let requirement = "zero: add the gap from which on nothing attracts";
            return wrong("last traction in the table", tractions[last], requirement);
        }
        let slopes = slopes(gaps, tractions);
        let (mut pieces, mut energy) = (Vec::new(), 0.0);
        for i in (0..last).rev() {
            let width = gaps[i + 1] - gaps[i];
            let chord = (tractions[i + 1] - tractions[i]) / width;
            let (a, b) = (slopes[i], slopes[i + 1]);
            let coefficients =
                [tractions[i], a, (3.0 * chord - 2.0 * a - b) / width, (a + b - 2.0 * chord) / (width * width)];
            let piece = Piece { start: gaps[i], rate: 1.0, energy: 0.0, coefficients };
            energy -= piece.at(width, 1.0)[0];
            pieces.push(Piece { energy, ..piece });
        }
        pieces.reverse();
        let (work, largest) = (-energy, tractions.iter().copied().fold(0.0, f64::max));
        if work <= 0.0 {
            return wrong("work of adhesion of the table", work, "positive: tractions that attract are positive");
        }
        // between the points there are no other extremes
        let concave = tractions.is_sorted_by(|nearer, farther| nearer >= farther);
        let (hints, first) = (Hints { concave, ..Hints::new(work, work / largest) }, vec![0, pieces.len() as u32]);
        let (end, jumps) = (gaps[last], Vec::new());
        Ok(Self { hints, origin: 0.0, unit: 1.0, first, pieces, end, far: 0.0, jumps, compliance: 0.0 })
    }
}

fn slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let widths: Vec<f64> = x.windows(2).map(|x| x[1] - x[0]).collect();
    let chords: Vec<f64> = y.windows(2).zip(&widths).map(|(y, width)| (y[1] - y[0]) / width).collect();
    let inner = |i: usize| {
        let (left, right) = (chords[i - 1], chords[i]);
        if left * right <= 0.0 {
            return 0.0;
        }
        let (a, b) = (2.0 * widths[i] + widths[i - 1], widths[i] + 2.0 * widths[i - 1]);
        (a + b) / (a / left + b / right)
    };
    let end = |near: usize, far: usize| {
        // of the parabola through three points, no steeper than three chords and of their sign
        let (h, k) = (widths[near], widths[far]);
        let slope = ((2.0 * h + k) * chords[near] - h * chords[far]) / (h + k);
        if slope * chords[near] <= 0.0 {
            0.0
        } else if chords[near] * chords[far] < 0.0 && slope.abs() > 3.0 * chords[near].abs() {
            3.0 * chords[near]
        } else {
            slope
        }
    };
    let last = x.len() - 1;
    (0..=last)
        .map(|i| match i {
            0 => end(0, 1),
            _ if i == last => end(last - 1, last - 2),
            _ => inner(i),
        })
        .collect()
}
