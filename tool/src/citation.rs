//! How to cite the program and its method, as `CITATION.cff` in the repository says too; a test compares both.

/// The program.
pub const PROGRAM: &str = concat!("The asperity developers: asperity, version ", env!("CARGO_PKG_VERSION"), ".");

/// The paper with the method that the program builds on.
pub const PAPER: &str = "Rey, Anciaux, Molinari: Normal adhesive contact on rough surfaces: efficient algorithm for \
                         FFT-based BEM resolution, Computational Mechanics 60 (2017), doi:10.1007/s00466-017-1392-5.";
