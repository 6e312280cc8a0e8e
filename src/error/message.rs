//! The message of an error: one line with the value, what would have been accepted, and a remedy.

use std::fmt;

use super::Error;

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
                    "fill missing points first, as by surface::fill"
                } else {
                    "an infinite value is not a missing point; correct it where it comes from"
                };
                write!(
                    f,
                    "{name}: {count} of {nodes} nodes are not finite, the first ({value}) at index [{}, {}]: {remedy}",
                    first.0, first.1
                )
            }
            Self::Law { function, gap, value, expected: None } => {
                write!(f, "the {function} is {value} at a gap of {}: it must be finite at every gap", Short(*gap))
            }
            Self::Law { function, gap, value, expected: Some(expected) } => write!(
                f,
                "the {function} is {} at a gap of {}, where the {} has the derivative {}: correct one of the two",
                Short(*value),
                Short(*gap),
                if function.starts_with("slope") { "traction" } else { "energy" },
                Short(*expected)
            ),
            Self::Concave { gap, traction, nearer } => write!(
                f,
                "the adhesive traction rises with the gap, from {} to {} at a gap of {}: the energy is not concave, \
                 as its `hints` say",
                Short(*nearer),
                Short(*traction),
                Short(*gap)
            ),
            Self::Jump { gap, fall } => write!(
                f,
                "the adhesive traction falls by {} at a gap of {}, and the edge of the adhesive zone would stay where an \
                 iteration left it: give the law without its jump in `adapted`",
                Short(*fall),
                Short(*gap)
            ),
            Self::AtNode { function, node, gap, value, expected } => write!(
                f,
                "the {function} is {} at node {node} and a gap of {}, and {} by another function of the law: those of \
                 many gaps give what those of one gap do, or the law has a `shape` in its `hints` and those of one gap are \
                 of its strongest node",
                Short(*value),
                Short(*gap),
                Short(*expected)
            ),
            Self::Operator { property, found, expected } => {
                write!(f, "{property} is {}: it should be {}", Short(*found), Short(*expected))
            }
            Self::Wave { wave: (qx, qy), stiffness, opposite: None } => write!(
                f,
                "the stiffness of the wave (qx, qy) = ({}, {}) is {}: it must be positive and finite in the precision of \
                 the fields",
                Short(*qx),
                Short(*qy),
                Short(*stiffness)
            ),
            Self::Wave { wave: (qx, qy), stiffness, opposite: Some(opposite) } => write!(
                f,
                "the stiffness of the wave (qx, qy) = ({}, {}) is {}, and that of ({}, {}) is {}: the two are the same \
                 wave, and have one stiffness",
                Short(*qx),
                Short(*qy),
                Short(*stiffness),
                Short(-qx),
                Short(-qy),
                Short(*opposite)
            ),
            Self::Raised(cause) => write!(f, "{}", cause.0),
            Self::Control { control, reason } => write!(f, "{control}: {reason}"),
            Self::Wall { wall, reason } => write!(f, "{wall}: {reason}"),
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
                    "{what} takes {} of memory, which there is not: take fewer nodes, or more memory",
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
