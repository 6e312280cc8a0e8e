//! Random scenes.
use common::Outcome;
pub fn tables(_: usize, _: u64, _: bool, _: &std::path::Path) -> Outcome<()> { Ok(()) }
