//! The options that more than one command has.

use std::path::{Path, PathBuf};

use asperity::solver::Method;
use asperity::{Error, Surface};
use asperity_maps::io::read_field;
pub use asperity_scene::Scalar;
use asperity_scene::{Branches, Elastic, Precision, Scene};
use clap::{Args, ValueEnum};
use ndarray::Array2;

use crate::adhesion::{Adhesion, AdhesionOptions};
use crate::against::AgainstOptions;
use crate::allowed::{positive, threads};
use crate::body::BodyOptions;
use crate::boundary::BoundaryOptions;
use crate::heights::{self, Origin};
use crate::outcome::Outcome;
use crate::part::Part;
use crate::printing::in_options;
use crate::processes::Processes;
use crate::quantity::{LENGTH, PRESSURE, Quantity};
use crate::threads::use_threads;

/// The surface and the half-space.
#[derive(Args)]
pub struct SurfaceOptions {
    /// Heights of the rough surface, shape (Nx, Ny), peaks up: .npy, .npz, .gwy or .gsf (Gwyddion), .xyz, Gwyddion's
    /// text export, or a text matrix
    #[arg(long, value_name = "FILE", help_heading = "Surface")]
    pub heights: PathBuf,
    /// Side lengths of the map, in the unit of the heights; LX alone means square cells [default: the file's, else 1
    /// 1]
    #[arg(long, value_names = ["LX", "LY"], num_args = 1..=2, allow_negative_numbers = true)]
    #[arg(value_parser = LENGTH.positive(), help_heading = "Surface")]
    pub lengths: Option<Vec<Quantity>>,
    /// Contact modulus E*, a pressure: E/(1 - nu^2), with Young's modulus E and Poisson's ratio nu of the body that
    /// deforms
    #[arg(long, value_name = "E", default_value = "1", allow_hyphen_values = true, value_parser = PRESSURE.positive())]
    #[arg(help_heading = "Surface")]
    modulus: Quantity,
    #[command(flatten)]
    pub beyond: BoundaryOptions,
    #[command(flatten)]
    body: BodyOptions,
    #[command(flatten)]
    pub other: AgainstOptions,
    /// Results on all nodes of a map that asperity prepare has mirrored: without it, fields, pictures, contact and
    /// force are those of the original
    #[arg(long, help_heading = "Surface")]
    pub whole: bool,
}

/// The method, the accuracy and the start of a solve.
#[derive(Args)]
pub struct SolverOptions {
    /// Preconditioned conjugate gradients, or the algorithm of Rey et al. (2017)
    #[arg(long, value_enum, default_value_t = Iteration::Default, help_heading = "Solver")]
    pub method: Iteration,
    /// Certified relative error at which to stop [default: 1e-6, in f32 1e-4]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = positive, help_heading = "Solver")]
    pub tolerance: Option<f64>,
    /// Iterations after which to give up [default: 2000, with rey2017 20000]
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Solver")]
    pub max_iterations: Option<usize>,
    /// Precision of the solve, and of the fields it writes
    #[arg(long, value_enum, default_value_t = Precision::F64, help_heading = "Solver")]
    pub precision: Precision,
    /// Threads; the results do not depend on it [default: one per core]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = threads, help_heading = "Solver")]
    pub threads: Option<usize>,
    /// Equilibrium to find where adhesion has several: that of surfaces pressed together from afar, that of surfaces
    /// pressed flat before, or with solve both [default: loading; unloading under a tension or at a given mean gap]
    #[arg(long, value_enum, value_name = "BRANCH", help_heading = "Solver", conflicts_with = "initial_gap")]
    pub branch: Option<Branches>,
    /// Gap from which to start, of the shape of the heights; scaled to the mean gap where that is given
    #[arg(long, value_name = "FILE", help_heading = "Solver")]
    pub initial_gap: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub enum Iteration {
    Default,
    Rey2017,
}

impl Iteration {
    /// The method of the library.
    pub fn method(self) -> Method {
        if self == Self::Rey2017 { Method::Rey2017 } else { Method::Preconditioned }
    }
}

/// The options that choose a contact problem and its solver.
#[derive(Clone, Copy)]
pub struct ProblemOptions<'a> {
    pub surface: &'a SurfaceOptions,
    pub adhesion: &'a AdhesionOptions,
    pub solver: &'a SolverOptions,
}

/// The fields that the options name, read from their files.
pub struct Given {
    pub surface: Surface,
    pub adhesion: Adhesion,
    /// The entries of the file of the surface beside its heights
    pub origin: Origin,
    /// The part of the surface that results are of
    pub part: Part,
    /// The gap from which to start, if there is one
    pub start: Option<Array2<f64>>,
}

impl<'a> ProblemOptions<'a> {
    /// Checks the options, reads their files, with all in metres if numbers are in the SI, of fields the rows that this
    /// process holds, and starts the threads.
    pub fn read(self, si: bool, processes: &Processes) -> Outcome<Given> {
        self.adhesion.check()?;
        in_options(self.surface.elastic().check())?;
        let &SurfaceOptions { heights: ref path, ref lengths, ref beyond, whole, .. } = self.surface;
        let (surface, origin) = if processes.count() > 1 {
            heights::shared(path, lengths.as_deref(), si, beyond.absent_missing, processes)?
        } else {
            let (map, origin) = heights::map(path, lengths.as_deref(), si)?;
            (heights::surface_or_absent(path, map, beyond.absent_missing)?, origin)
        };
        let sides = (beyond.boundary, beyond.absent_missing);
        let surface = processes.agree(self.surface.other.between(surface, &origin, si, sides))?;
        let part = processes.agree(Part::of(&origin, *surface.grid(), beyond.boundary, whole))?;
        let adhesion = self.adhesion.read(surface.grid(), processes)?;
        let start = processes.agree(self.solver.start(&surface, &part))?;
        processes.agree(use_threads(self.solver.threads))?;
        Ok(Given { surface, adhesion, origin, part, start })
    }
}

impl SurfaceOptions {
    /// The contact modulus.
    pub fn modulus(&self) -> f64 {
        self.modulus.value
    }

    /// The elastic body.
    pub fn elastic(&self) -> Elastic {
        let body = self.body.elastic(self.beyond.boundary, self.modulus());
        Elastic { against_modulus: self.other.modulus(), ..body }
    }

    /// The pressure E* h'rms, of which a reduced pressure is a part; 1 where none is `wanted`.
    pub fn full_pressure(&self, surface: &Surface, wanted: bool) -> Outcome<f64> {
        if wanted { Ok(self.elastic().full_pressure(surface)?) } else { Ok(1.0) }
    }
}

impl<'a> ProblemOptions<'a> {
    /// The files of the problem: heights of both sides, law and works of adhesion.
    pub fn files(self) -> impl Iterator<Item = &'a Path> {
        let Self { surface, adhesion, .. } = self;
        let AdhesionOptions { law_table, work_of_adhesion_map, hardness_map, .. } = adhesion;
        let others = [&surface.other.against, law_table, work_of_adhesion_map, hardness_map];
        std::iter::once(&*surface.heights).chain(others.into_iter().filter_map(Option::as_deref))
    }

    /// The scene that the options describe.
    pub fn scene(self) -> Scene {
        let &SolverOptions { method, precision, tolerance, max_iterations, branch, .. } = self.solver;
        Scene {
            elastic: self.surface.elastic(),
            adhesion: self.adhesion.described(),
            method: method.method(),
            precision,
            tolerance,
            max_iterations,
            branch,
        }
    }
}

impl SolverOptions {
    /// The gap from which to start, if it is given, of the whole surface or of the `part` of which results are.
    fn start(&self, surface: &Surface, part: &Part) -> Outcome<Option<Array2<f64>>> {
        let Some(path) = &self.initial_gap else { return Ok(None) };
        let grid = surface.grid();
        // a mirrored map, which one process has as a whole, may start from the gap of its original
        let start = if part.has_original() {
            let start = part.whole_of(read_field(path)?)?;
            let (found, expected) = (start.dim(), grid.shape());
            if found != expected {
                return Err(Error::Shape { name: "--initial-gap", found, expected }.into());
            }
            start
        } else {
            heights::rows_on("--initial-gap", path, grid)?
        };
        let first = grid.rows().start;
        // the library refuses what is not finite, but for nodes without a gap
        let is_absent = |node: (usize, usize)| surface.absent().is_some_and(|absent| absent[node]);
        let unknown = |(node, gap): &((usize, usize), &f64)| !gap.is_finite() && !is_absent(*node);
        if let Some(((i, j), gap)) = start.indexed_iter().find(unknown) {
            return Err(format!(
                "{}: the gap at index [{}, {j}] is {gap}, where the surface has a height: only absent nodes may have none",
                path.display(),
                first + i
            )
            .into());
        }
        Ok(Some(start))
    }

    /// Refuses both branches of equilibria where each state starts from the one before.
    pub fn check_table(&self) -> Outcome<()> {
        match self.branch {
            Some(Branches::Both) => {
                Err("--branch both compares two solves under one load: use asperity solve, or give one branch".into())
            }
            _ => Ok(()),
        }
    }
}
