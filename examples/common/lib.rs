//! What the examples share.

pub mod arguments;
pub mod chart;
pub mod legend;
pub mod memory;
pub mod sharp;

// what they share with the tests
#[path = "../../tests/common/authors.rs"]
pub mod authors;
#[path = "../../tests/common/outrun.rs"]
pub mod outrun;
#[path = "../../tests/common/published.rs"]
pub mod published;
#[path = "../../tests/common/rough.rs"]
pub mod rough;

/// What an example makes, or why it cannot.
pub type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;
