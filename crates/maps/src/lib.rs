//! Measured height maps for the contact of rough surfaces with [`asperity`].
//!
//! | module | contents |
//! |---|---|
//! | [`io`] | files of instruments, of Gwyddion and of numpy; fields and heights written |
//! | root | [`Topography`], a map on its way to a surface; [`fill()`], [`surface_with_absent`], [`knee_wavelength`] |
//! | [`warning`] | probable mistakes in heights, in the law on them, and in an answer |

pub mod io;
mod knee;
#[doc(hidden)]
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
