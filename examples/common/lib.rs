//! What the examples share.

pub mod arguments;
pub mod chart;
mod draw;
pub mod legend;
pub mod memory;
pub mod sharp;

pub use draw::Draw;
// what they share with the tests
pub use oracles::{authors, outrun, published, rough};

/// The value below which a share of all values lies, NaN of none. The values are sorted.
pub fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get((share * values.len() as f64) as usize).copied().unwrap_or(f64::NAN)
}

/// What an example makes, or why it cannot.
pub type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;
