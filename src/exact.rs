//! Exact solutions: what a solve should come to.
//!
//! | contact | solution | adhesion |
//! |---|---|---|
//! | one paraboloid | [`Hertz`] | none |
//! | | [`Jkr`] | of no range |
//! | | [`MaugisDugdale`] | a constant traction up to a range |
//! | a sphere with concentric waves | [`WavySphere`] | of no range |
//! | a paraboloid of two curvatures | [`EllipticHertz`] | none |
//! | a cone, a flat punch | [`Cone`], [`FlatPunch`] | none |
//! | one paraboloid among its periodic images | [`Periodic`] | all three |
//! | a wave on a line | [`WavyLine`] | none |
//! | | [`AdhesiveWavyLine`] | of no range |
//! | a two-dimensional wave, full contact | [`closing_pressure_2d`] | none |
//!
//! A solution gives states, [`Contact`], [`PeriodicContact`], [`WaveContact`], at a given load, contact radius,
//! approach or mean gap, and a state gives its fields, centred like those of [`Surface`](crate::Surface) on the origin
//! of the grid. All in `f64`, in any consistent units.
//!
//! # The error of a solve
//!
//! ```
//! use asperity::exact::{self, Periodic};
//! use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
//!
//! let grid = Grid::square(128, 1.0)?;
//! let sphere = Surface::paraboloid(grid, 2.0)?;
//! let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
//! let found = Solver::default().solve(&mut problem, Control::MeanGap(0.0398))?;
//!
//! let exact = Periodic::new(exact::Hertz::new(2.0, 1.0)?, 1.0)?.at_mean_gap(0.0398, sphere.mean())?;
//! assert!((found.report.mean_pressure / exact.mean_pressure() - 1.0).abs() < 5e-3);
//! let error = &found.gap + sphere.heights() - exact.displacement_field(&grid)?;
//! let largest = error.iter().fold(0.0f64, |m, e| m.max(e.abs()));
//! assert!(largest < 0.01 * exact.contact().approach(), "{largest}");
//! # Ok::<(), asperity::Error>(())
//! ```

mod cone;
mod contact;
mod ellipse;
mod hertz;
mod jkr;
mod johnson;
mod maugis_dugdale;
mod numerics;
mod periodic;
mod punch;
mod sphere;
mod wave;
mod wavy_sphere;
mod westergaard;

pub use cone::Cone;
pub use contact::Contact;
pub use ellipse::{EllipticContact, EllipticHertz};
pub use hertz::Hertz;
pub use jkr::Jkr;
pub use johnson::AdhesiveWavyLine;
pub use maugis_dugdale::MaugisDugdale;
pub use periodic::{C2, M1, Periodic, PeriodicContact};
pub use punch::FlatPunch;
pub use sphere::Sphere;
pub use wave::WaveContact;
pub use wavy_sphere::WavySphere;
pub use westergaard::{WavyLine, closing_pressure_2d};
