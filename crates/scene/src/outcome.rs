//! The outcome of a run or of one of its steps.

use std::error::Error;

/// A value, or an error of one line that names the cause and the remedy.
pub type Outcome<T> = Result<T, Box<dyn Error + Send + Sync>>;
