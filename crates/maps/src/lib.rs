//! Measured height maps for the contact of rough surfaces with [`asperity`].
//!
//! | module | contents |
//! |---|---|
//! | [`io`] | files of instruments, of Gwyddion and of numpy; fields and heights written; folders of results |
//! | [`numbers`] | numbers as text for people |
//! | the root | [`Topography`]: a map with missing points, tilt and edges, on its way to a surface; [`fill()`] and [`surface_with_absent`] for missing points, and [`knee_wavelength`], at which noise begins |
//! | [`warning`] | probable mistakes in heights, in the law on them, and in an answer |

pub mod io;
mod knee;
pub mod numbers;
mod topography;
pub mod warning;

pub use knee::knee_wavelength;
pub use topography::{
    Fit, Form, FormFit, RowAlignment, ScanAxis, Scars, Spikes, Topography, Trend, fill, surface_with_absent,
};

/// Runs the code of the README as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
