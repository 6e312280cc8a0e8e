//! What the examples share.

pub mod arguments;
pub mod chart;
pub mod legend;
pub mod memory;
pub mod sharp;

// what they share with the tests
pub use oracles::{authors, outrun, published, rough};

/// What an example makes, or why it cannot.
pub type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;
