//! The functions that take long to compile, by name: they are compiled once for each precision, with this crate.
//!
//! Generic functions are compiled with each crate that calls them. Those of this table are called as functions of the
//! scalar, and call the generic one that stands beside them.

use asperity_fft::Transform;
use asperity_fft::num_complex::Complex;
use ndarray::{Array2, ArrayRef2, ArrayView2, ArrayViewMut2};

use crate::accuracy::{AccuratePullOff, AccurateSolution, Accuracy, Find};
use crate::adhesion::{self, AdhesionLaw};
use crate::constraint::ContactConstraint;
use crate::contact::{ContactStatistics, Edge, Outline};
use crate::elastic::{self, Boundary, ElasticOperator, Factor, Spectral, Stiffness};
use crate::error::Result;
use crate::fft::{Convolver, Layout, Sums};
use crate::grid::Grid;
use crate::nested::{Deformed, GridObserver, Level, Nested, OnPart, Part, Task, Touching};
use crate::path::{Bench, Path, PathStep};
use crate::problem::{Control, Load, Parts, PressedFlat, Problem, Window};
use crate::pull_off::{FoundPullOff, PullOff};
use crate::ranks::{Ranks, Shares};
use crate::real::Real;
use crate::search::{ContactSearch, FoundContact};
use crate::slab::Slab;
use crate::solver::{self, Job, Observer, Solution, Solved, Solver, Start};
use crate::stability::{ContactStiffness, Saddle, Stability, StabilityTest, Watch};
use crate::surface::Surface;
use crate::sweep::Sweep;
