//! The lock of a file, by which no two runs write into it.

use std::fs::{File, OpenOptions, TryLockError};
use std::io;
use std::path::Path;

use asperity::Error;

/// Opens a file, which is made if needed, and locks it until it is closed; whether it was made. A lock of another run is
/// refused, or waited for.
pub fn open_locked(path: &Path, waits: bool) -> asperity::Result<(File, bool)> {
    let mut options = OpenOptions::new();
    options.read(true).append(true);
    let (opened, made) = match options.clone().create_new(true).open(path) {
        Err(e) if e.kind() == io::ErrorKind::AlreadyExists => (options.create(true).open(path), false),
        opened => (opened, true),
    };
    let file = opened.map_err(|e| Error::unwritable(path, e))?;
    match if waits { file.lock().map_err(TryLockError::Error) } else { file.try_lock() } {
        Err(TryLockError::WouldBlock) => {
            let reason = "another run is writing there: wait until it has ended, or choose another --out";
            Err(Error::caused(path, reason.to_owned(), io::Error::from(io::ErrorKind::WouldBlock)))
        }
        // not every file system has locks
        Ok(()) | Err(TryLockError::Error(_)) => Ok((file, made)),
    }
}
