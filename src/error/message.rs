//! The message of an error: one line with the value, what would have been accepted, and a remedy.

use std::fmt;

use super::{Breach, Error, Place};

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value { name, value, requirement } => {
                write!(f, "{name} is {}: it must be {requirement}", Short(*value))
            }
            Self::Shape { name, found, expected } => {
                write!(f, "{name} has shape {} x {}: it must be {} x {}", found.0, found.1, expected.0, expected.1)
            }
            Self::NotFinite { name, count, nodes, first, value } => {
                let remedy = if value.is_nan() {
                    "fill missing points first, for example by asperity_maps::fill"
                } else {
                    "an infinite value is not a missing point; correct it where it comes from"
                };
                write!(
                    f,
                    "{name}: {count} of {nodes} nodes are not finite, the first ({value}) at index [{}, {}]: {remedy}",
                    first.0, first.1
                )
            }
            Self::Contract { function, value, place, breach } => breach.write(f, (function, *value), *place),
            Self::Raised(cause) => write!(f, "{}", cause.0),
            Self::Unsuited { what, reason } => write!(f, "{what}: {reason}"),
            Self::Unaffordable { quantity, accuracy, shape, bytes, available, affordable } => {
                write!(
                    f,
                    "an accuracy of {} of the {quantity} takes about {} x {} nodes and {}: there are {}, ",
                    Short(*accuracy),
                    shape.0,
                    shape.1,
                    Bytes(*bytes),
                    Bytes(*available)
                )?;
                match affordable.is_finite() {
                    true => write!(f, "enough for about {affordable:.1e}"),
                    false => f.write_str("too few to resolve the adhesion: take a longer range"),
                }
            }
            Self::Memory { what, bytes } => {
                write!(
                    f,
                    "{what} takes {} of memory, more than is free: take fewer nodes, or more memory",
                    Bytes(*bytes)
                )
            }
            Self::Unresolved { k_s, limit, shape } => write!(
                f,
                "k_s is {}: it must be below {} for {} x {} nodes to resolve it: use more nodes, or a smaller k_s",
                Short(*k_s),
                Short(*limit),
                shape.0,
                shape.1
            ),
            Self::Shared { what, reason } => write!(f, "{what} with several processes: {reason}"),
            Self::Elsewhere { rank } => write!(f, "process {rank} has refused its part: its own error says why"),
            Self::File { path, reason, .. } => write!(f, "{}: {reason}", path.display()),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Gap(gap) => write!(f, " at a gap of {}", Short(gap)),
            Self::Node(node, gap) => write!(f, " at node {node} and a gap of {}", Short(gap)),
            Self::Wave(qx, qy) => write!(f, " for the wave (qx, qy) = ({}, {})", Short(qx), Short(qy)),
            Self::Grid => Ok(()),
        }
    }
}

impl Breach {
    /// The message of the breach by a function that has a value at a place.
    fn write(self, f: &mut fmt::Formatter<'_>, (function, value): (&str, f64), place: Place) -> fmt::Result {
        match (self, place) {
            (Self::Attract, _) => {
                f.write_str("the traction of the law is positive at no gap: the law repels, and attracts nowhere")
            }
            (Self::Sign(rise), Place::Gap(gap)) => write!(
                f,
                "the traction of the law is {value:e} at a gap of {gap:e}, where the energy of the law {} with the gap: the \
                 traction is the derivative of the energy, and positive where the surfaces attract each other: change \
                 the sign of one of the two",
                if rise > 0.0 { "rises" } else { "falls" }
            ),
            (Self::Rough, Place::Gap(gap)) => write!(
                f,
                "the functions of the law do not agree with one another, or are rough, at gaps from {gap:e} on: the \
                 traction must be the derivative of the energy, the slope the derivative of the traction; check_functions \
                 says which is not"
            ),
            (Self::Decay(range), Place::Gap(gap)) => write!(
                f,
                "the law still has a traction at a gap of {gap:e}, {:.0} times its range of {range:e}: give it a range, \
                 the length over which the traction decays",
                gap / range
            ),
            _ => {
                write!(f, "the {function} is {}{place}", Short(value))?;
                let (other, rule) = self.words(function);
                other.map_or(Ok(()), |other| write!(f, ", and {}", Short(other)))?;
                f.write_str(rule)
            }
        }
    }

    /// The value that a function contradicts, and what follows it.
    fn words(self, function: &str) -> (Option<f64>, &'static str) {
        match self {
            Self::Finite => (None, ": it must be finite at every gap"),
            Self::Derivative(other) if function.starts_with("slope") => {
                (Some(other), " as the derivative of the traction: correct one of the two")
            }
            Self::Derivative(other) => (Some(other), " as the derivative of the energy: correct one of the two"),
            Self::Zero => (None, ": it must be 0, since the `hints` say that the law is zero"),
            Self::Concave(other) => (Some(other), " at a smaller gap: the energy is not concave, against its `hints`"),
            Self::Jump(other) => (
                Some(other),
                " just below, and the edge of the adhesive zone would stay where an iteration left it: give the law \
                 without its jump in `adapted`",
            ),
            Self::Alike(other) => (
                Some(other),
                " by another function of the law: functions of many gaps must agree with functions of one gap, or the \
                 `hints` have a `shape` and functions of one gap belong to the strongest node",
            ),
            Self::Sign(_) | Self::Attract | Self::Rough | Self::Decay(_) => (None, ", which breaks the contract"),
            Self::Operator(other) => (Some(other), " in an operator that keeps its contract"),
            Self::Stiff => (None, ": it must be positive and finite in the precision of the fields"),
            Self::Even(other) => (Some(other), " for the opposite wave: the two are one wave, with one stiffness"),
        }
    }
}

/// A number without rows of zeros.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = self;
        if *value == 0.0 || (1e-4..1e6).contains(&value.abs()) { write!(f, "{value}") } else { write!(f, "{value:e}") }
    }
}

struct Bytes(f64);

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mebibytes = self.0 / 1_048_576.0;
        if mebibytes < 1024.0 { write!(f, "{mebibytes:.1} MiB") } else { write!(f, "{:.1} GiB", mebibytes / 1024.0) }
    }
}
