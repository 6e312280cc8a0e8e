//! The loads of a run, as options and keywords say them.

use asperity::Control;

use crate::key::boundary::Boundary;

/// The load of a solve: one that is held, or one that is to be found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// A load that is held.
    Held(Control),
    /// A mean pressure over the [full pressure](crate::Elastic::full_pressure).
    Reduced(f64),
    /// A contact fraction, for which a load is searched.
    Fraction(f64),
}

impl Load {
    /// The load of a key with its number; of a `spring` with two, the stiffness and the position at rest.
    pub fn of(key: &str, numbers: &[f64]) -> Option<Self> {
        Some(Self::Held(match (key, numbers) {
            ("mean_gap", &[gap]) => Control::MeanGap(gap),
            ("mean_pressure", &[pressure]) => Control::MeanPressure(pressure),
            ("normal_force", &[force]) => Control::Force(force),
            ("approach", &[approach]) => Control::Approach(approach),
            ("spring", &[stiffness, rest]) => Control::Spring { stiffness, rest },
            ("reduced_pressure", &[ratio]) => return Some(Self::Reduced(ratio)),
            ("contact_fraction", &[fraction]) => return Some(Self::Fraction(fraction)),
            _ => return None,
        }))
    }

    /// The load that is held where a reduced pressure of 1 is the `full` pressure; of no meaning for a contact
    /// fraction.
    pub fn control(self, full: f64) -> Control {
        match self {
            Self::Held(control) => control,
            Self::Reduced(ratio) => Control::MeanPressure(full * ratio),
            Self::Fraction(_) => Control::MeanPressure(0.0),
        }
    }

    /// The contact fraction, if it is one.
    pub fn fraction(self) -> Option<f64> {
        if let Self::Fraction(fraction) = self { Some(fraction) } else { None }
    }

    /// Refuses a load that a boundary does not have, and one that would act on the images of a `mirrored` map as well.
    ///
    /// # Errors
    /// The reason and the remedy, for [`worded`](crate::worded).
    pub fn check(self, boundary: Boundary, mirrored: bool) -> Result<(), String> {
        let Self::Held(control) = self else { return Ok(()) };
        let reason = match (boundary, control) {
            (Boundary::Periodic, Control::Approach(_)) => {
                "an approach needs {boundary=free}: in a periodic cell bodies have none, give a mean gap, a pressure or \
                 a force"
            }
            (Boundary::Free, Control::MeanGap(_)) => {
                "a mean gap needs {boundary=periodic}: a free half-space has none to be held, give an approach, a \
                 force, a pressure or a spring"
            }
            (_, Control::Force(_) | Control::Spring { .. }) if mirrored => {
                let name = control.name().replace('-', " ");
                return Err(format!(
                    "a {name} would act on the mirror images of the map as well: give a pressure or a mean gap, or \
                     {{whole=}} for the force on all of them"
                ));
            }
            _ => return Ok(()),
        };
        Err(reason.to_owned())
    }
}
