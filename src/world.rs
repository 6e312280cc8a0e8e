//! The processes of an MPI job, which share grids.

use std::fmt;

use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::ranks::{Job, Ranks};
use crate::slab::Slab;

/// The processes that `mpiexec` started (feature `mpi`), which solve one problem together.
///
/// All run the same program and make the same calls in the same order, with the same arguments but for the fields.
/// On a grid that they [share](Self::share), heights and fields have the rows of a process, [`Grid::rows`]. Answers
/// are the same, bit for bit, for any number of processes, and reports and errors on all of them. Where one refuses
/// its part, the others have [`Error::Elsewhere`]. A panic ends the job.
///
/// MPI ends where the value is dropped: keep it until the end of `main`.
///
/// ```no_run
/// use asperity::{Control, Grid, NoAdhesion, Problem, SelfAffine, Solver, Westergaard, World};
/// let world = World::start()?;
/// let grid = world.share(Grid::square(65536, 1.0)?)?;
/// let surface = SelfAffine::default().k_s(8192.0).surface(grid)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let solution = Solver::default().solve(&mut problem, Control::MeanPressure(0.01))?;
/// if world.rank() == 0 {
///     println!("{}", solution.report.contact_fraction); // of the whole surface
/// }
/// assert_eq!(solution.gap.dim(), (grid.rows().len(), 65536));
/// # Ok::<(), asperity::Error>(())
/// ```
pub struct World {
    job: Job,
    ranks: Ranks,
}

impl World {
    /// Joins the job, once in a process. A program that `mpiexec` has not started is alone.
    ///
    /// # Errors
    /// [`Error::Shared`] if this process has joined before, or if this MPI cannot be called by a program with threads.
    pub fn start() -> Result<Self> {
        let reason = "it was started before, or it cannot be called by a program with threads: start it once, and take \
                      another MPI";
        let job = Job::start().ok_or(Error::Shared { what: "MPI", reason })?;
        let ranks = job.ranks();
        Ok(Self { job, ranks })
    }

    /// The number of this process, from zero on.
    pub fn rank(&self) -> usize {
        self.ranks.rank()
    }

    /// The number of processes.
    pub fn size(&self) -> usize {
        self.ranks.count()
    }

    /// A grid, shared by all processes: each holds a slab of whole rows, in bands of 65 536 nodes or more, and the
    /// last ones nothing where they are more than the bands.
    ///
    /// # Errors
    /// [`Error::Value`] if a process would hold more than 2³¹ nodes.
    pub fn share(&self, grid: Grid) -> Result<Grid> {
        grid.within(Slab::new(grid.shape(), self.ranks))
    }

    /// The result of this process, or an error that names another process: if a process before it has an error, or this
    /// process has none and another has. All processes have to ask.
    ///
    /// # Errors
    /// The error of the result, or [`Error::Elsewhere`].
    pub fn agree<T>(&self, result: Result<T>) -> Result<T> {
        Slab::new((1, 1), self.ranks).agreed(result)
    }

    /// The text of the first process. All processes have to ask.
    pub fn broadcast(&self, text: &str) -> String {
        let own = if self.rank() == 0 { text.as_bytes().to_vec() } else { Vec::new() };
        String::from_utf8_lossy(&self.ranks.lists(own)).into_owned()
    }

    /// The bytes that this process has sent to others in exchanges of fields: with P processes, in each of the two
    /// exchanges of an operator application, about 16·Nx(Ny/2 + 1)/P·(1 − 1/P) in `f64`, and half of that in `f32`.
    pub fn bytes_sent(&self) -> u64 {
        self.job.bytes_sent()
    }

    /// Ends all processes, at once, with the exit code 1: for an error that the others do not know of.
    pub fn abort(&self) -> ! {
        self.job.abort()
    }
}

impl fmt::Debug for World {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("World").field("rank", &self.rank()).field("size", &self.size()).finish_non_exhaustive()
    }
}

impl Drop for World {
    fn drop(&mut self) {
        // the others would wait for a process that is gone
        if std::thread::panicking() {
            self.abort();
        }
    }
}
