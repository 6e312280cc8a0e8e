//! The session of a problem: it is posed, solved under one load or along many, and stopped.

pub(crate) mod course;
pub mod fall;
pub mod pace;
pub(crate) mod plan;
pub(crate) mod posed;
pub(crate) mod way;
