//! The scales of a law of functions, found where it does not name them.

use super::functions::{Functions, at, one};
use crate::adhesion::Hints;
use crate::adhesion::check::NAMES;
use crate::error::{Breach, Error, Place, Result};

/// The powers of two between which the equilibrium separation is looked for, in any unit of length, and the gaps in an
/// octave.
const OCTAVES: (i32, i32) = (-50, 20);
const GAPS: i32 = 8;

/// The repulsion, in the greatest attraction, down to which a law is read, and continues as its tangent.
const STRONGEST: f64 = 1e9;

/// The halves of octaves of the range by which it is read below its equilibrium separation.
const DEPTHS: std::ops::RangeInclusive<i32> = -8..=24;

/// The scales of a law.
pub(super) struct Scales {
    pub hints: Hints<f64>,
    /// The least gap at which the law is read; none if its energy has no bound at zero gap.
    pub least: Option<f64>,
    /// Whether a law that repels continues below the least gap.
    pub goes_on: bool,
}

impl Scales {
    /// The scales of a law; [`Error::Value`] if it has no range, and [`Error::Contract`] if it attracts nowhere.
    pub fn of(law: &impl Functions) -> Result<Self> {
        let in_contact = one(law, 1, 0.0)?;
        let (mut rest, attraction) = if in_contact > 0.0 { (None, in_contact) } else { rest(law, in_contact)? };
        let work = law.work_of_adhesion();
        let work_of_adhesion = work.map_or_else(|| one(law, 0, rest.unwrap_or(0.0)).map(|energy| -energy), Ok)?;
        let range = law.range().unwrap_or(work_of_adhesion / attraction);
        if !(range > 0.0 && range.is_finite()) {
            check_sign(law)?;
            let requirement = "positive and finite: give the law a range, the length over which the traction decays \
                               (without one it is w/traction(0))";
            return Err(Error::Value { name: "range of the law", value: range, requirement });
        }
        let (mut least, mut goes_on) = (Some(0.0), false);
        if let Some(gap) = rest {
            if one(law, 0, 0.0)?.is_finite() {
                (least, goes_on) = deepest(law, gap, range, STRONGEST * attraction);
                // what does not repel below rests nowhere
                (rest, least) = (rest.filter(|_| least.is_some()), least.or(Some(0.0)));
            } else {
                least = None;
            }
        }
        Ok(Self { hints: Hints { rest, ..Hints::new(work_of_adhesion, range) }, least, goes_on })
    }
}

/// Gaps of all sizes.
fn gaps() -> Vec<f64> {
    (GAPS * OCTAVES.0..=GAPS * OCTAVES.1).map(|place| (f64::from(place) / f64::from(GAPS)).exp2()).collect()
}

/// The gap where the traction turns from repulsion, or nothing, to attraction, and the greatest attraction.
fn rest(law: &impl Functions, in_contact: f64) -> Result<(Option<f64>, f64)> {
    check_sign(law)?;
    let gaps = gaps();
    let tractions = at(law, 1, &gaps)?;
    let attraction = tractions.iter().copied().filter(|traction| traction.is_finite()).fold(0.0, f64::max);
    let Some(first) = tractions.iter().position(|&traction| traction > 0.0) else {
        return match tractions.iter().any(|&traction| traction < 0.0) {
            true => Err(broken(in_contact, 0.0, Breach::Attract)),
            false => Ok((None, attraction)),
        };
    };
    let Some(last) = tractions[..first].iter().rposition(|&traction| traction < 0.0) else {
        return Ok(((in_contact <= 0.0).then_some(0.0), attraction));
    };
    let (mut near, mut far) = (gaps[last], gaps[first]);
    loop {
        let middle = 0.5 * (near + far);
        let traction = one(law, 1, middle)?;
        if traction == 0.0 || middle <= near || middle >= far {
            return Ok((Some(middle), attraction));
        }
        if traction > 0.0 { far = middle } else { near = middle }
    }
}

/// The least gap below rest down to which repulsion grows, up to the strongest repulsion, and whether the strongest
/// repulsion ends the range, not an undefined law.
fn deepest(law: &impl Functions, rest: f64, range: f64, strongest: f64) -> (Option<f64>, bool) {
    let gaps = Vec::from_iter(DEPTHS.map(|half| rest - range * (0.5 * f64::from(half)).exp2()));
    // a law may refuse negative gaps
    let Ok(tractions) = at(law, 1, &gaps) else { return (None, false) };
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

/// Refuses a traction without the sign of the derivative of the energy, where that changes most.
pub(super) fn check_sign(law: &impl Functions) -> Result<()> {
    let gaps = gaps();
    let [energies, tractions] = [at(law, 0, &gaps)?, at(law, 1, &gaps)?];
    let rises = energies.windows(2).map(|pair| pair[1] - pair[0]).enumerate().filter(|(_, rise)| rise.is_finite());
    match rises.max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs())) {
        Some((place, rise)) if rise * (tractions[place] + tractions[place + 1]) < 0.0 => {
            Err(broken(tractions[place], gaps[place], Breach::Sign(rise)))
        }
        _ => Ok(()),
    }
}

/// The error of a traction at a gap.
pub(super) fn broken(traction: f64, gap: f64, breach: Breach) -> Error {
    Error::Contract { function: NAMES[1], value: traction, place: Place::Gap(gap), breach }
}
