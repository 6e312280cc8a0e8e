//! Measured maps, files and warnings, as users see them.

mod texts;
mod warnings;
