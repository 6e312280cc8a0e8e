//! Exact solutions, and theories of rough surfaces, to compare solves with.
//!
//! | contact | solution | adhesion |
//! |---|---|---|
//! | one paraboloid | [`Hertz`], [`Jkr`], [`MaugisDugdale`] | none; of no range; a constant traction up to a range |
//! | one paraboloid among its periodic images | [`Periodic`] | all three |
//! | a sphere with concentric waves | [`WavySphere`] | of no range |
//! | a paraboloid of two curvatures, a cone, a flat punch | [`EllipticHertz`], [`Cone`], [`FlatPunch`] | none |
//! | a wave on a line | [`WavyLine`], [`AdhesiveWavyLine`] | none; of no range |
//! | a two-dimensional wave, full contact | [`closing_pressure_2d`] | none |
//! | a rough surface, by a theory | [`Persson`], [`GreenwoodWilliamson`] | none |
//!
//! A solution gives states, [`Contact`], [`PeriodicContact`], [`WaveContact`], and a state its fields, centred like
//! [`Surface`](crate::Surface) on the origin of the grid. All in `f64`, in any consistent units.
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
//! assert!(error.iter().all(|e| e.abs() < 0.01 * exact.contact().approach()));
//! # Ok::<(), asperity::Error>(())
//! ```

mod cone;
mod contact;
mod ellipse;
mod greenwood_williamson;
mod hertz;
mod jkr;
mod johnson;
mod maugis_dugdale;
mod numerics;
mod periodic;
mod persson;
mod punch;
mod sphere;
mod wave;
mod wavy_sphere;
mod westergaard;

pub use cone::Cone;
pub use contact::Contact;
pub use ellipse::{EllipticContact, EllipticHertz};
pub use greenwood_williamson::GreenwoodWilliamson;
pub use hertz::Hertz;
pub use jkr::Jkr;
pub use johnson::AdhesiveWavyLine;
pub use maugis_dugdale::MaugisDugdale;
pub use periodic::{Periodic, PeriodicContact};
pub use persson::Persson;
pub use punch::FlatPunch;
pub use sphere::Sphere;
pub use wave::WaveContact;
pub use wavy_sphere::WavySphere;
pub use westergaard::{WavyLine, closing_pressure_2d};
