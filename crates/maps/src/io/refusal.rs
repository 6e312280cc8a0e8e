//! The refusal of malformed files, and of files that are larger than the memory.

use std::io;
use std::path::Path;

use asperity::Error;

use super::memory::{SMALL, is_there};

pub const TRUNCATED: &str = "ends too early: it is truncated or damaged, copy or save it again";
pub const DAMAGED: &str = "is damaged: copy or save it again";

/// The result of a reader.
pub type Parsed<T> = std::result::Result<T, Refusal>;

/// Why a file is not read.
pub enum Refusal {
    /// It is not as it should be
    Reason(String),
    /// The system does not read it
    System(String, io::Error),
    /// It takes more memory than there is, so many bytes
    Memory(usize),
}

impl<T: Into<String>> From<T> for Refusal {
    fn from(reason: T) -> Self {
        Self::Reason(reason.into())
    }
}

impl Refusal {
    /// The error, with the path of the file.
    pub fn in_file(self, path: &Path) -> Error {
        match self {
            Self::Reason(reason) => Error::file(path, reason),
            Self::System(reason, error) => Error::caused(path, reason, error),
            Self::Memory(bytes) => Error::Memory { what: path.display().to_string(), bytes: bytes as f64 },
        }
    }
}

/// Refuses a file for a reason.
pub fn refuse<T>(reason: impl Into<String>) -> Parsed<T> {
    Err(Refusal::Reason(reason.into()))
}

/// Makes room for `more` values, as they are read.
pub fn reserve<T>(values: &mut Vec<T>, more: usize) -> Parsed<()> {
    let (needed, room) = (values.len().saturating_add(more), values.capacity());
    if needed <= room {
        return Ok(());
    }
    // in steps that double it
    let size = needed.max(2 * room);
    let bytes = size.saturating_mul(size_of::<T>());
    check_room(bytes)?;
    values.try_reserve_exact(size - values.len()).map_err(|_| Refusal::Memory(bytes))
}

/// Refuses more bytes than the machine has, or gives to this process.
pub fn check_room(bytes: usize) -> Parsed<()> {
    let given = || bytes as f64 <= SMALL || Vec::<u8>::new().try_reserve_exact(bytes).is_ok();
    if is_there(bytes as f64) && given() { Ok(()) } else { Err(Refusal::Memory(bytes)) }
}

/// The refusal of a file that the system does not read.
pub fn unreadable(error: io::Error) -> Refusal {
    let reason = match error.kind() {
        io::ErrorKind::UnexpectedEof => TRUNCATED.to_owned(),
        io::ErrorKind::NotFound => "does not exist: check the path".to_owned(),
        _ => format!("cannot be read: {error}"),
    };
    Refusal::System(reason, error)
}

/// A piece of a file for a message: on one line, of a length that can be read.
pub fn quoted(text: &str) -> String {
    let mut short: String = text.chars().take(60).collect();
    if short.len() < text.len() {
        short.push_str("...");
    }
    format!("{short:?}")
}
