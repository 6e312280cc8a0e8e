//! The error of the crate, and the checks of numbers that return it.

mod message;

use std::error::Error as StdError;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The result of a function that can refuse its input.
pub type Result<T> = std::result::Result<T, Error>;

/// A refused input. Each variant names the value and the accepted ones.
///
/// A solve that does not converge is not an error: it returns its fields with a [`Status`](crate::Status).
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
    /// A function of an adhesion law, of springs or of an elastic operator that breaks its contract.
    Contract {
        /// The function, or the property of an operator.
        function: &'static str,
        /// Its value.
        value: f64,
        /// The place of the value.
        place: Place,
        /// The part of the contract.
        breach: Breach,
    },
    /// An error of a user's function, for example of a body or a law; it is the [source](StdError::source).
    Raised(Cause),
    /// A control, a wall, a method or a strategy that does not suit the problem.
    Unsuited {
        /// The control by its [name](crate::Control::name), or the other part.
        what: &'static str,
        /// The reason, and a remedy.
        reason: &'static str,
    },
    /// An accuracy that needs a grid beyond the memory.
    Unaffordable {
        /// The [`Quantity::name`](crate::accuracy::Quantity::name).
        quantity: &'static str,
        /// The accuracy that was asked for.
        accuracy: f64,
        /// The shape of the grid that is likely to reach it.
        shape: (usize, usize),
        /// The memory that the grid takes, in bytes.
        bytes: f64,
        /// The available memory, in bytes.
        available: f64,
        /// The accuracy that the finest affordable grid is likely to reach; infinite without resolved adhesion.
        affordable: f64,
    },
    /// Memory that is not available.
    Memory {
        /// The object that needs the memory, with its number of nodes or its file.
        what: String,
        /// The memory that it takes, in bytes.
        bytes: f64,
    },
    /// A surface with waves that are too short for the grid.
    Unresolved {
        /// The wave number k_s of the shortest waves, in units of 2π/Lx.
        k_s: f64,
        /// The least wave number that this grid does not resolve, in the same unit.
        limit: f64,
        /// The grid's shape, `(Nx, Ny)`.
        shape: (usize, usize),
    },
    /// A grid that several processes share, for a quantity or a solve without an implementation for it.
    Shared {
        /// The quantity, the solve, or the part of a solve.
        what: &'static str,
        /// The reason, and a remedy.
        reason: &'static str,
    },
    /// A refusal by another process that shares the grid and has the error.
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
        /// The error of the system or of a format, if there is one.
        cause: Option<Cause>,
    },
}

/// The place at which a function [breaks its contract](Error::Contract).
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// A gap.
    Gap(f64),
    /// A node, in row-major order, and the gap there.
    Node(usize, f64),
    /// A wave, by its wave numbers (qx, qy) in radians per length.
    Wave(f64, f64),
    /// The whole grid.
    Grid,
}

/// The part of a contract that a value [breaks](Error::Contract), with the value that it contradicts.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Breach {
    /// The functions of a law are finite.
    Finite,
    /// The traction is the derivative of the energy, and the slope the derivative of the traction.
    Derivative(f64),
    /// A law that [says](crate::adhesion::Hints) that it is zero has no traction.
    Zero,
    /// The traction of a law that [says](crate::adhesion::Hints::concave) that it is concave does not rise with the
    /// gap: at a smaller gap it is this value.
    Concave(f64),
    /// A traction that jumps, from this value, has a [smoothed](crate::adhesion::Discretisation::Smooth) law.
    Jump(f64),
    /// The traction has the sign of the derivative of the energy, which changes by this up to the next gap.
    Sign(f64),
    /// The traction attracts at some gap.
    Attract,
    /// The functions from a gap on are as smooth as a [table](crate::Tabulated::of) can be.
    Rough,
    /// The traction of a law of this range has decayed at large gaps.
    Decay(f64),
    /// The functions of one gap and of many agree.
    Alike(f64),
    /// [`check_operator`](crate::elastic::check_operator) finds what it expects.
    Operator(f64),
    /// The stiffness of a wave is positive and finite in the precision of the fields.
    Stiff,
    /// A wave and the opposite wave, (−qx, −qy), have one stiffness.
    Even(f64),
}

/// A wrapped error; two are equal where their messages are.
#[derive(Clone, Debug)]
pub struct Cause(Arc<dyn StdError + Send + Sync>);

impl PartialEq for Cause {
    fn eq(&self, other: &Self) -> bool {
        self.0.to_string() == other.0.to_string()
    }
}

/// The kind of an [`Error`], for programs that treat some of them in their own way.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ErrorKind {
    /// A number that its quantity does not allow.
    Value,
    /// A field of another shape than its grid.
    Shape,
    /// A field that holds NaN or infinities.
    NotFinite,
    /// An adhesion law or springs with functions that contradict one another.
    Law,
    /// An elastic operator that lacks a property of its contract, or an error of a function of a body or a law.
    Operator,
    /// A control, a wall, a method or a strategy that does not suit the problem.
    Unsuited,
    /// Memory that is not available.
    Memory,
    /// A grid that is too coarse for a surface.
    Resolution,
    /// A grid of several processes, or a refusal by another process.
    Shared,
    /// A file that could not be read or written.
    File,
}

impl Error {
    /// The kind of the error.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Value { .. } => ErrorKind::Value,
            Self::Shape { .. } => ErrorKind::Shape,
            Self::NotFinite { .. } => ErrorKind::NotFinite,
            Self::Contract { place: Place::Gap(_) | Place::Node(..), .. } => ErrorKind::Law,
            Self::Contract { .. } | Self::Raised(_) => ErrorKind::Operator,
            Self::Unsuited { .. } => ErrorKind::Unsuited,
            Self::Unaffordable { .. } | Self::Memory { .. } => ErrorKind::Memory,
            Self::Unresolved { .. } => ErrorKind::Resolution,
            Self::Shared { .. } | Self::Elsewhere { .. } => ErrorKind::Shared,
            Self::File { .. } => ErrorKind::File,
        }
    }

    /// A file that could not be read or written, for `reason`.
    #[doc(hidden)]
    pub fn file(path: impl AsRef<Path>, reason: impl Display) -> Self {
        Self::File { path: path.as_ref().to_owned(), reason: reason.to_string(), cause: None }
    }

    /// A file that could not be read, with the [source](StdError::source).
    #[doc(hidden)]
    pub fn unreadable(path: impl AsRef<Path>, cause: impl StdError + Send + Sync + 'static) -> Self {
        Self::caused(path.as_ref(), format!("cannot be read: {cause}"), cause)
    }

    /// A file that could not be written, with the [source](StdError::source).
    #[doc(hidden)]
    pub fn unwritable(path: impl AsRef<Path>, cause: impl StdError + Send + Sync + 'static) -> Self {
        Self::caused(path.as_ref(), format!("cannot be written: {cause}"), cause)
    }

    /// A file that is of no use for `reason`, with the [source](StdError::source).
    #[doc(hidden)]
    pub fn caused(path: &Path, reason: String, cause: impl StdError + Send + Sync + 'static) -> Self {
        Self::File { path: path.to_owned(), reason, cause: Some(Cause(Arc::new(cause))) }
    }

    /// An error of a user's function, as the [source](StdError::source).
    pub fn raised(cause: impl StdError + Send + Sync + 'static) -> Self {
        Self::Raised(Cause(Arc::new(cause)))
    }

    /// A function of a law or of springs that is not finite at a gap.
    pub(crate) fn not_finite(function: &'static str, gap: f64, value: f64) -> Self {
        Self::Contract { function, value, place: Place::Gap(gap), breach: Breach::Finite }
    }

    /// The value, if it is positive and finite.
    ///
    /// # Errors
    /// [`Error::Value`] with the name and the value, if it is not.
    pub fn positive(name: &'static str, value: f64) -> Result<f64> {
        if value > 0.0 && value.is_finite() {
            Ok(value)
        } else {
            Err(Self::Value { name, value, requirement: "positive and finite" })
        }
    }

    /// The value, if it is zero, or positive and finite.
    ///
    /// # Errors
    /// [`Error::Value`] with the name and the value, if it is neither.
    pub fn non_negative(name: &'static str, value: f64) -> Result<f64> {
        if value >= 0.0 && value.is_finite() {
            Ok(value)
        } else {
            Err(Self::Value { name, value, requirement: "zero, or positive and finite" })
        }
    }

    /// The value, if it is finite.
    ///
    /// # Errors
    /// [`Error::Value`] with the name and the value, if it is not.
    pub fn finite(name: &'static str, value: f64) -> Result<f64> {
        if value.is_finite() { Ok(value) } else { Err(Self::Value { name, value, requirement: "finite" }) }
    }

    /// Refuses an array of another shape than expected.
    ///
    /// # Errors
    /// [`Error::Shape`] with the name and both shapes, if they differ.
    pub fn shape(name: &'static str, found: (usize, usize), expected: (usize, usize)) -> Result<()> {
        if found == expected { Ok(()) } else { Err(Self::Shape { name, found, expected }) }
    }
}

impl StdError for Error {
    fn source(&self) -> Option<&(dyn StdError + 'static)> {
        match self {
            Self::File { cause: Some(Cause(cause)), .. } | Self::Raised(Cause(cause)) => Some(cause.as_ref()),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_of_the_system_is_the_source() {
        let cause = || std::io::Error::from(std::io::ErrorKind::PermissionDenied);
        let error = Error::unwritable("u.npy", cause());
        let source = error.source().and_then(|source| source.downcast_ref::<std::io::Error>()).unwrap();
        assert_eq!(source.kind(), std::io::ErrorKind::PermissionDenied);
        assert_eq!(error, Error::unwritable("u.npy", cause()));
        assert_eq!(error.kind(), ErrorKind::File);
        assert!(Error::file("u.npy", "is empty").source().is_none());
    }
}
