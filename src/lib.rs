//! How rough surfaces touch and stick: frictionless normal contact of an elastic half-space with a rigid rough
//! surface, with adhesion, by an FFT-based boundary element method.
//!
//! A half-space, periodic or free, with normal displacement u faces a rigid surface of heights h. At equilibrium the gap
//! g = u − h ≥ 0 minimises the energy per area
//!
//! ```math
//! e(g) = ½ ⟨u, K⁻¹u⟩ + ⟨φ(g)⟩ ,   u = g + h ,   K⁻¹u = ½ E* |q| û  for each wave q ,
//! ```
//!
//! with ⟨·⟩ the mean over the surface, E* the contact modulus and φ(g) ≤ 0 the adhesive energy. The mean gap is given,
//! or the mean pressure p̄, and then its work p̄⟨g⟩ is added. With p = K⁻¹u the elastic pressure, the contact pressure
//! λ = p + p̄ + φ'(g) is the multiplier of g ≥ 0:
//!
//! ```math
//! λ ≥ 0 ,   g ≥ 0 ,   λ g = 0 .
//! ```
//!
//! The method is due to Rey, Anciaux and Molinari, *Normal adhesive contact on rough surfaces: efficient algorithm for
//! FFT-based BEM resolution*, Computational Mechanics 60 (2017), with a preconditioner, a certificate of the error, and
//! the paper's misprints corrected: see [`guide::paper_checked`].
//!
//! # A sphere, without and with adhesion
//!
//! ```
//! use asperity::{Control, Grid, MaugisDugdale, NoAdhesion, Problem, Solver, Status, Surface, Westergaard};
//!
//! let grid = Grid::square(64, 1.0)?; // nodes, side length
//! let sphere = Surface::paraboloid(grid, 2.0)?; // radius of curvature
//! let half_space = Westergaard::<f64>::new(grid, 1.0)?; // contact modulus
//! let mut problem = Problem::new(&sphere, half_space, NoAdhesion)?;
//! let pressed = Solver::default().solve(&mut problem, Control::MeanGap(0.0398))?;
//! assert_eq!(pressed.report.status, Status::Converged);
//! assert!(pressed.report.relative_error < 1e-6); // a proven bound
//!
//! problem.set_law(MaugisDugdale::new(1e-4, 2e-3)?)?; // work of adhesion, range
//! let stuck = Solver::default().solve(&mut problem, Control::MeanGap(0.0398))?;
//! assert!(stuck.report.contact_nodes > pressed.report.contact_nodes);
//! # Ok::<(), asperity::Error>(())
//! ```
//!
//! The pages of the [`guide`] start with a [tour](guide::tour) from the gap to the certificate. Others are about laws,
//! bodies and constraints of your own, boundaries, branches, accuracy, cost, clusters and the solver.
//!
//! # Conventions
//!
//! Input is in any consistent units, and results are in the same units. Fields are [`ndarray`] arrays of shape (Nx, Ny).
//! Compression is positive. The report has two mean pressures: the external one p̄, and the mean contact pressure ⟨λ⟩ =
//! p̄ + ⟨φ'⟩. Everything is generic over `f32` and `f64`; sums accumulate in `f64`.
//!
//! # Parts that can be exchanged
//!
//! | trait | meaning | implementations |
//! |---|---|---|
//! | [`ElasticOperator`] | pressure of a displacement | [`Westergaard`] (periodic), [`Boussinesq`] (free), [`Spectral`] (any symbol) |
//! | [`AdhesionLaw`] | energy, traction, slope at a gap | [`NoAdhesion`], [`MaugisDugdale`], [`Exponential`] and more |
//! | [`ContactConstraint`] | the way to impose g ≥ 0 | [`Projection`], [`Hardness`], [`Penalty`], [`Uzawa`] |
//!
//! # Around a solve
//!
//! - Before it: the crate `asperity-maps` reads files of instruments, makes a [`Surface`] of a measured map with missing
//!   points, tilt, and edges that do not meet, and names probable mistakes in heights, adhesion and a solution.
//! - Many loads: [`Sweep`] solves under a sequence of loads, each from the last solutions. [`ContactSearch`] finds the
//!   load of a contact fraction, and [`PullOff`] the greatest tension that surfaces bear. [`path`] follows a branch of
//!   equilibria with adhesion and locates its jumps.
//! - Many grids: [`Nested`] solves on coarser grids first, and [`accuracy`] estimates and reduces the error of the grid.
//! - After it: [`contact`] has areas, clusters and pressures of the contact, and [`stability`] tells whether an
//!   equilibrium is stable.
//! - To compare: [`exact`] has closed forms: spheres by Hertz, JKR and Maugis, alone or among their periodic images,
//!   ellipses, cones and punches, and waves by Westergaard and Johnson.
//!
//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `parallel` (default) | threads, with the same results bit for bit |
//! | `mpi` | processes, with the same results bit for bit: the type `World`, which docs.rs lacks, as it has no MPI |
//! | `serde` | settings, controls, reports and statistics as data, with the names of the reports; sweeps, searches and paths, which continue bit for bit |
//!
//! Without any of them the library depends on libm, ndarray, num-traits, pulp and rustfft alone.
#![doc = include_str!("pages.html")]

pub mod accuracy;
pub mod adhesion;
pub mod constraint;
pub mod contact;
mod degrees;
mod derivatives;
pub mod elastic;
pub mod error;
pub mod exact;
mod fft;
mod field;
mod grid;
pub mod guide;
mod names;
pub mod nested;
mod par;
pub mod path;
mod problem;
pub mod pull_off;
mod ranks;
mod real;
pub mod search;
mod setters;
mod slab;
pub mod solver;
pub mod stability;
pub mod surface;
mod sweep;
mod vector;
#[cfg(feature = "mpi")]
mod world;

pub use ndarray;

#[doc(inline)]
pub use adhesion::{
    AdhesionLaw, Exponential, Jkr, LennardJones, MaugisDugdale, Morse, NoAdhesion, PowerLaw, Tabulated,
};
#[doc(inline)]
pub use constraint::{ContactConstraint, Hardness, NoWall, Penalty, Projection, Uzawa};
#[doc(inline)]
pub use elastic::{Boundary, Boussinesq, ElasticOperator, Spectral, Westergaard};
#[doc(inline)]
pub use error::{Error, ErrorKind, Result};
pub use grid::Grid;
#[doc(inline)]
pub use nested::Nested;
#[doc(hidden)]
pub use par::along_sides;
pub use problem::{Control, Held, Problem};
#[doc(inline)]
pub use pull_off::PullOff;
pub use real::Real;
#[doc(inline)]
pub use search::ContactSearch;
#[doc(inline)]
pub use solver::{Branch, Report, Settings, Solution, Solver, Start, Status};
#[doc(inline)]
pub use surface::{Amplitude, SelfAffine, Surface};
pub use sweep::Sweep;
#[cfg(feature = "mpi")]
pub use world::World;

/// Runs the code of the README as a test.
#[cfg(doctest)]
#[doc = include_str!("README.md")]
struct Readme;
