//! The keys of a scene: what a run may be asked, by the names that options, keywords and reports share.

pub(crate) mod accuracy;
pub(crate) mod adhesion;
pub(crate) mod after;
#[cfg(feature = "options")]
pub mod allowed;
pub(crate) mod asked;
pub(crate) mod body;
pub(crate) mod boundary;
pub(crate) mod elastic;
pub(crate) mod formula;
pub(crate) mod laws;
pub mod list;
pub(crate) mod load;
pub(crate) mod pair;
pub(crate) mod preparation;
pub mod quantity;
pub(crate) mod scalar;
pub(crate) mod scene;
pub(crate) mod symbol;
pub mod synonyms;
pub(crate) mod told;
pub mod units;
pub(crate) mod wall;
pub(crate) mod words;
