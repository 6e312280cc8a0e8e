//! The functions that take long to compile, by name: they are compiled once for each precision, with this crate.
//!
//! Generic functions are compiled with each crate that calls them. A function of this table is called as a function of
//! the scalar, `T::solve(…)`, and calls the function next to it: one for `f32` and `f64`, or one for each; with
//! `[within]` on one of the workers, as it has many short loops. As a table of contents it names functions of all
//! floors.

use asperity_fft::num_complex::Complex;
use asperity_fft::{Transform, double, single};
use ndarray::{Array2, ArrayView2, ArrayViewMut2};

use crate::accuracy::{Accuracy, AccuratePullOff, AccurateSolution};
use crate::adhesion::{AdhesionLaw, SharedLaw, exponentials_f32, exponentials_f64};
use crate::constraint::ContactConstraint;
use crate::contact::{ContactStatistics, Edge, Outline};
use crate::elastic::{Boundary, ElasticOperator, Factor, OnGrids, Spectral, Stiffness, waves};
use crate::error::Result;
use crate::fft::{Convolver, Layout, Products};
use crate::grid::Grid;
use crate::nested::{GridObserver, Heights, Level, Nested};
use crate::par;
use crate::path::{Bench, Path, PathStep};
use crate::problem::{Control, PressedFlat, Problem, ProblemMut};
use crate::pull_off::{FoundPullOff, PullOff};
use crate::ranks::{Ranks, Shares};
use crate::real::Real;
use crate::search::{ContactSearch, FoundContact};
use crate::slab::Slab;
use crate::solver::{Job, Observer, Solution, Solved, Solver, Start, in_double, in_single};
use crate::stability::{ContactStiffness, Departure, Near, Stability, StabilityTest};
use crate::surface::Surface;
use crate::sweep::Sweep;

macro_rules! heavy {
    ($($(#[$doc:meta])* fn $name:ident($($arg:ident: $of:ty),* $(,)?) -> $value:ty = $([$within:ident])? $both:path $(, $double:path)?;)*) => {
        /// The functions of a precision, each compiled once.
        pub trait Heavy: Sized {
            $($(#[$doc])* fn $name($($arg: $of),*) -> $value where Self: Real;)*
        }
        impl Heavy for f32 {
            $(fn $name($($arg: $of),*) -> $value { run!($([$within])? $both($($arg),*)) })*
        }
        impl Heavy for f64 {
            $(fn $name($($arg: $of),*) -> $value { run!($([$within])? last!($both $(, $double)?)($($arg),*)) })*
        }
    };
}

macro_rules! run {
    ($call:expr) => {
        $call
    };
    ([$within:ident] $call:expr) => {
        par::$within(|| $call)
    };
}

macro_rules! last {
    ($one:path) => {
        $one
    };
    ($one:path, $other:path) => {
        $other
    };
}

type AnySolver<T> = Solver<dyn ContactConstraint<T>>;

heavy! {
    /// The transform of a length.
    fn transform(len: usize) -> Transform<Self> = single, double;
    /// The convolution of a slab.
    fn convolver(slab: Slab, layout: Layout, rows: Transform<Self>, columns: Transform<Self>) -> Convolver<Self> =
        Convolver::planned;
    /// The exchange of a spectrum between processes.
    fn exchange(
        ranks: Ranks, from: &[Complex<Self>], sent: &Shares, into: &mut [Complex<Self>], received: &Shares,
    ) -> () = Ranks::exchange;
    /// Exponentials on vector instructions.
    fn exponentials(factor: Self, rate: Self, x: &[Self], results: &mut [Self]) -> () = exponentials_f32, exponentials_f64;
    /// The stiffness of the homogeneous half-space, and the stiffness of its softest and stiffest wave.
    fn half_space(grid: &Grid, modulus: f64) -> Result<(Stiffness<Self>, (f64, f64))> = waves;
    /// An application of a spectral operator.
    fn apply(
        operator: &mut Spectral<Self>, input: ArrayView2<'_, Self>, output: ArrayViewMut2<'_, Self>, factor: Factor<'_>,
    ) -> Result<Products> = Spectral::convolve;
    /// The pressure of heights in `f64`, and its work.
    fn press(operator: &mut Spectral<Self>, heights: ArrayView2<'_, f64>, pressure: ArrayViewMut2<'_, Self>) -> Result<Products> =
        Spectral::<f32>::press, Spectral::<f64>::press;
    /// The surface pressed flat against the body of an operator, if that and the law suit it.
    fn press_flat(
        surface: &Surface, operator: &mut dyn ElasticOperator<Self>, law: &dyn AdhesionLaw<Self>,
    ) -> Result<PressedFlat<Self>> = [within] PressedFlat::of;
    /// A solve.
    fn solve(operator: &mut dyn ElasticOperator<Self>, job: Job<'_, Self>) -> Result<Solved<Self>> = [within] in_single, in_double;
    /// The next load of a sweep.
    fn sweep(
        sweep: &mut Sweep<Self>, solver: &mut AnySolver<Self>, problem: &mut Problem<Self>, load: Control,
        observe: Observer<'_>,
    ) -> Result<Solution<Self>> = [within] Sweep::step;
    /// A search for a contact fraction.
    fn search(
        search: &mut ContactSearch<Self>, solver: &mut AnySolver<Self>, problem: &mut Problem<Self>, fraction: f64,
        observe: Observer<'_>,
    ) -> Result<FoundContact<Self>> = [within] ContactSearch::find;
    /// The next state of a path.
    fn follow(path: &mut Path<Self>, bench: &mut Bench<'_, Self>) -> Result<Option<PathStep<Self>>> = [within] Path::advance;
    /// A search for a pull-off.
    fn pull_off(
        search: PullOff, solver: &mut AnySolver<Self>, problem: &mut Problem<Self>, start: Start<'_, Self>,
        observe: Observer<'_>,
    ) -> Result<FoundPullOff<Self>> = [within] PullOff::search;
    /// A solve on nested grids.
    fn nested(
        nested: &Nested, solver: &mut AnySolver<Self>, heights: Heights<'_>, operators: &mut dyn OnGrids<Self>,
        law: &SharedLaw<Self>, control: Control, observe: GridObserver<'_>,
    ) -> Result<(Solved<Self>, Vec<Level>)> = Nested::run;
    /// A solve to an accuracy.
    fn refine(
        accuracy: &Accuracy, solver: &mut AnySolver<Self>, surface: &Surface, operators: &mut dyn OnGrids<Self>,
        law: &SharedLaw<Self>, control: Control, observe: GridObserver<'_>,
    ) -> Result<AccurateSolution<Self>> = Accuracy::refine;
    /// A search for a pull-off to an accuracy.
    fn refine_pull_off(
        accuracy: &Accuracy, solver: &mut AnySolver<Self>, surface: &Surface, operators: &mut dyn OnGrids<Self>,
        law: &SharedLaw<Self>, search: PullOff, observe: GridObserver<'_>,
    ) -> Result<AccuratePullOff<Self>> = Accuracy::refine_pull_off;
    /// A test of stability.
    fn stability(
        test: &StabilityTest, problem: ProblemMut<'_, Self>, constraint: &dyn ContactConstraint<Self>, control: Control,
        gap: (&Array2<Self>, Near<'_>), relative_error: f64,
    ) -> Result<Stability<Self>> = [within] StabilityTest::judge;
    /// The departure from a saddle.
    fn leave(
        stability: &Stability<Self>, solver: &mut AnySolver<Self>, problem: &mut Problem<Self>, from: &Solution<Self>,
        observe: Observer<'_>,
    ) -> Result<Option<Departure<Self>>> = [within] Stability::depart;
    /// The contact stiffness of a solution.
    fn stiffness(
        problem: ProblemMut<'_, Self>, constraint: &dyn ContactConstraint<Self>, solution: &Solution<Self>, tolerance: f64,
    ) -> Result<ContactStiffness> = [within] ContactStiffness::find;
    /// The edge of a contact.
    fn edge(outline: &Outline<'_, Self>) -> Edge = Outline::edge;
    /// The statistics of a contact.
    fn statistics(
        gap: ArrayView2<'_, Self>, contact_pressure: ArrayView2<'_, Self>, grid: &Grid, body: (Boundary, f64),
        law: &dyn AdhesionLaw<Self>,
    ) -> Result<ContactStatistics> = ContactStatistics::count;
}
