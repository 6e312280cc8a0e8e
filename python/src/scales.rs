//! The scales of a law of Python: its work of adhesion, range and equilibrium separation, found where it does not name
//! them.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::functions::{Function, Functions};

/// The powers of two between which the equilibrium separation is looked for, in any unit of length, and the gaps in an
/// octave.
const OCTAVES: (i32, i32) = (-50, 20);
const GAPS: i32 = 8;

/// The repulsion, in the greatest attraction, down to which a law is read, and goes on as its tangent.
const STRONGEST: f64 = 1e9;

/// The halves of octaves of the range by which it is read below its equilibrium separation.
const DEPTHS: std::ops::RangeInclusive<i32> = -8..=24;

/// The scales of a law.
pub struct Scales {
    /// −φ in contact, or at the equilibrium separation.
    pub work_of_adhesion: f64,
    /// The length over which the traction decays: w over the traction in contact, or over the greatest attraction of a
    /// law that does not attract there.
    pub range: f64,
    /// The gap below which the law repels.
    pub rest: Option<f64>,
    /// The least gap at which the law is read; none if its energy has no bound at zero gap.
    pub least: Option<f64>,
    /// Whether a law that repels goes on below the least gap.
    pub goes_on: bool,
}

impl Scales {
    /// The scales of a law.
    ///
    /// # Errors
    /// The exception of its functions; `ValueError` if it has no range, or attracts nowhere, as with a wrong sign.
    pub fn of(law: &Functions<'_>) -> PyResult<Self> {
        let at = |function, gap: f64| law.at(function, &[gap; 2]).map(|values| values[0]);
        let in_contact = at(Function::Traction, 0.0)?;
        let (mut rest, attraction) = if in_contact > 0.0 { (None, in_contact) } else { rest(law, in_contact)? };
        let work = law.number("work_of_adhesion")?;
        let work_of_adhesion = work.map_or_else(|| at(Function::Energy, rest.unwrap_or(0.0)).map(|e| -e), Ok)?;
        let range = law.number("range")?.unwrap_or(work_of_adhesion / attraction);
        if !(range > 0.0 && range.is_finite()) {
            check_sign(law)?;
            return Err(PyValueError::new_err(format!(
                "range of the law is {range}: it must be positive and finite: give the law an attribute range, the \
                 length over which the traction decays (without one it is w/traction(0))"
            )));
        }
        let (mut least, mut goes_on) = (Some(0.0), false);
        if let Some(gap) = rest {
            if at(Function::Energy, 0.0)?.is_finite() {
                (least, goes_on) = deepest(law, gap, range, STRONGEST * attraction);
                // what does not repel below rests nowhere
                (rest, least) = (rest.filter(|_| least.is_some()), least.or(Some(0.0)));
            } else {
                least = None;
            }
        }
        Ok(Self { work_of_adhesion, range, rest, least, goes_on })
    }
}

/// Gaps of all sizes.
fn gaps() -> Vec<f64> {
    (GAPS * OCTAVES.0..=GAPS * OCTAVES.1).map(|place| (f64::from(place) / f64::from(GAPS)).exp2()).collect()
}

/// The gap where the traction turns from repulsion, or nothing, to attraction, and the greatest attraction.
fn rest(law: &Functions<'_>, in_contact: f64) -> PyResult<(Option<f64>, f64)> {
    check_sign(law)?;
    let gaps = gaps();
    let tractions = law.at(Function::Traction, &gaps)?;
    let attraction = tractions.iter().copied().filter(|traction| traction.is_finite()).fold(0.0, f64::max);
    let Some(first) = tractions.iter().position(|&traction| traction > 0.0) else {
        return match tractions.iter().any(|&traction| traction < 0.0) {
            true => {
                Err(PyValueError::new_err("law.traction is positive at no gap: the law repels, and attracts nowhere"))
            }
            false => Ok((None, attraction)),
        };
    };
    let Some(last) = tractions[..first].iter().rposition(|&traction| traction < 0.0) else {
        return Ok(((in_contact <= 0.0).then_some(0.0), attraction));
    };
    let (mut near, mut far) = (gaps[last], gaps[first]);
    loop {
        let middle = 0.5 * (near + far);
        let traction = law.at(Function::Traction, &[middle; 2])?[0];
        if traction == 0.0 || middle <= near || middle >= far {
            return Ok((Some(middle), attraction));
        }
        if traction > 0.0 { far = middle } else { near = middle }
    }
}

/// The least gap below that of rest down to which the law repels more and more, up to the strongest repulsion, and
/// whether it ends so, and not where it is no longer defined.
fn deepest(law: &Functions<'_>, rest: f64, range: f64, strongest: f64) -> (Option<f64>, bool) {
    let gaps = Vec::from_iter(DEPTHS.map(|half| rest - range * (0.5 * f64::from(half)).exp2()));
    // a law may refuse negative gaps
    let Ok(tractions) = law.at(Function::Traction, &gaps) else { return (None, false) };
    let (mut least, mut before) = (None, 0.0);
    for (gap, traction) in gaps.into_iter().zip(tractions) {
        if !(traction < before && traction.is_finite()) {
            return (least, false);
        }
        (least, before) = (Some(gap), traction);
        if -traction >= strongest {
            break;
        }
    }
    (least, true)
}

/// Tells whether the traction has the sign of the derivative of the energy, where that changes most.
///
/// # Errors
/// `ValueError` if it has not, with the gap.
pub fn check_sign(law: &Functions<'_>) -> PyResult<()> {
    let gaps = gaps();
    let [energies, tractions] = [law.at(Function::Energy, &gaps)?, law.at(Function::Traction, &gaps)?];
    let rises = energies.windows(2).map(|pair| pair[1] - pair[0]).enumerate().filter(|(_, rise)| rise.is_finite());
    let Some((place, rise)) = rises.max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs())) else { return Ok(()) };
    let opposite = rise * (tractions[place] + tractions[place + 1]) < 0.0;
    if !opposite {
        return Ok(());
    }
    Err(PyValueError::new_err(format!(
        "law.traction is {:e} at a gap of {:e}, where law.energy {} with the gap: the traction is the derivative of \
         the energy, and positive where the surfaces attract each other: change the sign of one of the two",
        tractions[place],
        gaps[place],
        if rise > 0.0 { "rises" } else { "falls" }
    )))
}
