//! The error of the crate, and the checks that return it.

use std::fmt;
use std::path::{Path, PathBuf};

use ndarray::ArrayView2;

use crate::field::CHUNK;
use crate::real::Real;
use crate::slab::Slab;

/// The result of a function that can refuse its input.
///
/// ```
/// fn contact_radius(load: f64) -> asperity::Result<f64> {
///     use asperity::exact::{Hertz, Sphere};
///     Ok(Hertz::new(2.0, 1.0)?.at_load(load)?.contact_radius())
/// }
/// assert!(contact_radius(1e-4).is_ok() && contact_radius(-1e-4).is_err());
/// ```
pub type Result<T> = std::result::Result<T, Error>;

/// An input that was refused. Each variant names the value and what would have been accepted.
///
/// A solve that does not converge is not an error: it returns its fields with a
/// [`Status`](crate::Status) that says so.
///
/// ```
/// use asperity::{Error, Grid};
/// let error = Grid::new((64, 64), (1.0, -1.0)).unwrap_err();
/// assert!(matches!(error, Error::Value { name: "side length Ly", .. }));
/// assert_eq!(error.to_string(), "side length Ly is -1: it must be positive and finite");
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// A number that its quantity does not allow.
    Value {
        /// The quantity.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The allowed values, in words that follow "it must be".
        requirement: &'static str,
    },
    /// A field of another shape than the grid on which it is used.
    Shape {
        /// The field.
        name: &'static str,
        /// Its shape, `(Nx, Ny)`.
        found: (usize, usize),
        /// The shape that it must have.
        expected: (usize, usize),
    },
    /// A field that holds NaN or infinities.
    NotFinite {
        /// The field.
        name: &'static str,
        /// The number of its nodes that are not finite.
        count: usize,
        /// The number of its nodes.
        nodes: usize,
        /// The first such node in row-major order, `(ix, iy)`.
        first: (usize, usize),
        /// The value at that node.
        value: f64,
    },
    /// A function of an adhesion law or of springs that is not finite, or not the derivative of the one before it
    /// (energy, traction, slope of the traction).
    Law {
        /// The function.
        function: &'static str,
        /// The gap at which it is wrong.
        gap: f64,
        /// The value of the function at that gap.
        value: f64,
        /// The value that agrees with the function before; none if `value` is not finite.
        expected: Option<f64>,
    },
    /// An adhesion law whose traction rises with the gap, though it says that its energy is
    /// [concave](crate::Hints::concave).
    Concave {
        /// The gap before which the traction rises.
        gap: f64,
        /// The traction at that gap.
        traction: f64,
        /// The smaller traction at a smaller gap.
        nearer: f64,
    },
    /// An adhesion law whose traction jumps, without a [smoothed](crate::Discretisation::Smooth) law that does not.
    Jump {
        /// The gap at which it jumps.
        gap: f64,
        /// The traction by which it falls there.
        fall: f64,
    },
    /// A function of an adhesion law that differs between its functions of one gap and those of many.
    AtNode {
        /// The function.
        function: &'static str,
        /// The node, in row-major order.
        node: usize,
        /// The gap.
        gap: f64,
        /// The value at the node.
        value: f64,
        /// The value that agrees with the other functions of the law.
        expected: f64,
    },
    /// An elastic operator without a property of its contract; see [`check_operator`](crate::check_operator).
    Operator {
        /// The property.
        property: &'static str,
        /// The value found.
        found: f64,
        /// The value that the property requires.
        expected: f64,
    },
    /// A control, or what is solved for under it, that the problem does not have.
    Control {
        /// The control, by the name of [`Control::name`](crate::Control::name), or what else was asked for.
        control: &'static str,
        /// The reason, and a remedy.
        reason: &'static str,
    },
    /// A wall and an adhesion law that do not fit each other.
    Wall {
        /// The wall.
        wall: &'static str,
        /// The reason, and a remedy.
        reason: &'static str,
    },
    /// An accuracy that takes a grid that does not fit into memory.
    Unaffordable {
        /// The quantity, by the name of [`Quantity::name`](crate::accuracy::Quantity::name).
        quantity: &'static str,
        /// The accuracy that was asked for.
        accuracy: f64,
        /// The shape of the grid that is likely to reach it.
        shape: (usize, usize),
        /// The memory that the grid takes, in bytes.
        bytes: f64,
        /// The memory that there is, in bytes.
        available: f64,
        /// The accuracy that the finest affordable grid is likely to reach; infinite where it does not resolve the
        /// adhesion, so that nothing is known.
        affordable: f64,
    },
    /// Memory that the system does not have, or does not give to this process.
    Memory {
        /// What takes it, with its number of nodes or its file.
        what: String,
        /// The memory that it takes, in bytes.
        bytes: f64,
    },
    /// A surface with waves that are too short for the grid.
    Unresolved {
        /// The wave number k_s of the shortest waves, in units of 2π/Lx.
        k_s: f64,
        /// The wave number, in the same unit, that this grid no longer resolves.
        limit: f64,
        /// The grid's shape, `(Nx, Ny)`.
        shape: (usize, usize),
    },
    /// A grid that several processes share, where that has no form.
    Shared {
        /// The quantity, the solve, or the part of it, that was asked for.
        what: &'static str,
        /// The reason, and a remedy.
        reason: &'static str,
    },
    /// A refusal by another process of those that share a grid, which has the error.
    Elsewhere {
        /// The number of that process, from zero on.
        rank: usize,
    },
    /// A file that could not be read or written.
    File {
        /// The path of the file.
        path: PathBuf,
        /// The reason, and a remedy.
        reason: String,
    },
}

impl Error {
    /// A file that could not be read or written, for `reason`.
    pub fn file(path: &Path, reason: impl fmt::Display) -> Self {
        Self::File { path: path.to_owned(), reason: reason.to_string() }
    }

    /// The result of this process, unless one before it, of those that share a slab, has an error, or it has none
    /// itself and another one has: then that one is named. All processes of the slab have to call it.
    pub(crate) fn agreed<T>(slab: Slab, result: Result<T>) -> Result<T> {
        if !slab.is_shared() {
            return result;
        }
        let refused = slab.ranks().each(u8::from(result.is_err())).iter().position(|&refused| refused > 0);
        match refused {
            Some(rank) if rank != slab.ranks().rank() => Err(Self::Elsewhere { rank }),
            _ => result,
        }
    }

    /// Refuses a slab that several processes share.
    pub(crate) fn alone(what: &'static str, slab: Slab) -> Result<()> {
        let reason = "that has no form for slabs: take the whole grid in one process";
        if slab.is_shared() { Err(Self::Shared { what, reason }) } else { Ok(()) }
    }

    /// Passes `value` on if it is positive and finite.
    pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64> {
        if value > 0.0 && value.is_finite() {
            Ok(value)
        } else {
            Err(Self::Value { name, value, requirement: "positive and finite" })
        }
    }

    /// Passes `value` on if it is zero, or positive and finite.
    pub(crate) fn non_negative(name: &'static str, value: f64) -> Result<f64> {
        if value >= 0.0 && value.is_finite() {
            Ok(value)
        } else {
            Err(Self::Value { name, value, requirement: "zero, or positive and finite" })
        }
    }

    /// Passes `value` on if it is finite.
    pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64> {
        if value.is_finite() { Ok(value) } else { Err(Self::Value { name, value, requirement: "finite" }) }
    }

    /// Refuses a field of another shape than `expected`.
    pub(crate) fn shape(name: &'static str, found: (usize, usize), expected: (usize, usize)) -> Result<()> {
        if found == expected { Ok(()) } else { Err(Self::Shape { name, found, expected }) }
    }

    /// Refuses a field that holds NaN or infinities in some slab: the process that has the first of them has the error.
    pub(crate) fn all_finite_in<T: Real>(slab: Slab, name: &'static str, field: ArrayView2<'_, T>) -> Result<()> {
        let mut found = Self::all_finite(name, field);
        if let Err(Self::NotFinite { count, nodes, first, .. }) = &mut found {
            let mut all = [*count as u64];
            slab.add_up(&mut all);
            (*count, *nodes, first.0) = (all[0] as usize, slab.nodes(), first.0 + slab.rows().start);
        } else {
            slab.add_up(&mut [0]);
        }
        Self::agreed(slab, found)
    }

    /// Refuses a field that holds NaN or infinities.
    pub(crate) fn all_finite<T: Real>(name: &'static str, field: ArrayView2<'_, T>) -> Result<()> {
        // without places, and without an end within a chunk, the pass is many times as fast
        let all =
            |values: &[T]| values.chunks(CHUNK).all(|chunk| chunk.iter().fold(true, |all, v| all & v.is_finite()));
        if field.as_slice_memory_order().map_or_else(|| field.iter().all(|value| value.is_finite()), all) {
            return Ok(());
        }
        let mut wrong = field.indexed_iter().filter(|(_, value)| !value.is_finite());
        match wrong.next() {
            None => Ok(()),
            Some((first, value)) => {
                let value = value.widen();
                Err(Self::NotFinite { name, count: 1 + wrong.count(), nodes: field.len(), first, value })
            }
        }
    }
}

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
                    "fill missing points first, as by Topography::fill"
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
                 as `is_concave` says",
                Short(*nearer),
                Short(*traction),
                Short(*gap)
            ),
            Self::Jump { gap, fall } => write!(
                f,
                "the adhesive traction falls by {} at a gap of {}, and the edge of the adhesive zone would stay where an \
                 iteration left it: give the law without its jump as `smoothed`",
                Short(*fall),
                Short(*gap)
            ),
            Self::AtNode { function, node, gap, value, expected } => write!(
                f,
                "the {function} is {} at node {node} and a gap of {}, and {} by another function of the law: those of \
                 many gaps give what those of one gap do, or the law has a `shape` and those of one gap are of its \
                 strongest node",
                Short(*value),
                Short(*gap),
                Short(*expected)
            ),
            Self::Operator { property, found, expected } => {
                write!(f, "{property} is {}: it should be {}", Short(*found), Short(*expected))
            }
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
            Self::File { path, reason } => write!(f, "{}: {reason}", path.display()),
        }
    }
}

impl std::error::Error for Error {}

/// A number without rows of zeros.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = self;
        if *value == 0.0 || (1e-4..1e6).contains(&value.abs()) { write!(f, "{value}") } else { write!(f, "{value:e}") }
    }
}

/// An amount of memory, in bytes.
struct Bytes(f64);

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mebibytes = self.0 / 1_048_576.0;
        if mebibytes < 1024.0 { write!(f, "{mebibytes:.1} MiB") } else { write!(f, "{:.1} GiB", mebibytes / 1024.0) }
    }
}
