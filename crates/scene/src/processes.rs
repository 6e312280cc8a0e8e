//! The processes of a run: one, or with the feature `mpi` those that `mpiexec` started.

#[cfg(feature = "mpi")]
use std::sync::Arc;

#[cfg(feature = "mpi")]
use asperity::World;
use asperity::{Error, Grid};

use crate::outcome::Outcome;

/// The most nodes in whole fields of each of several processes: for pictures, for warnings, for the state of a table,
/// and for files that are not written in rows.
pub const WHOLE: usize = 4096 * 4096;

/// The processes that solve one problem, and which of them this one is.
#[derive(Clone)]
pub struct Processes {
    #[cfg(feature = "mpi")]
    world: Arc<World>,
}

impl Processes {
    /// Joins the processes that were started with this one.
    pub fn start() -> Outcome<Self> {
        Ok(Self {
            #[cfg(feature = "mpi")]
            world: Arc::new(World::start()?),
        })
    }

    /// The number of processes.
    pub fn count(&self) -> usize {
        #[cfg(feature = "mpi")]
        return self.world.size();
        #[cfg(not(feature = "mpi"))]
        1
    }

    /// Whether this is the first process, which prints and keeps tables.
    pub fn is_first(&self) -> bool {
        #[cfg(feature = "mpi")]
        return self.world.rank() == 0;
        #[cfg(not(feature = "mpi"))]
        true
    }

    /// Refuses more than one process.
    pub fn alone(&self, what: &str) -> Outcome<()> {
        match self.count() {
            1 => Ok(()),
            count => Err(format!("{what} has no form for several processes, and there are {count}: start one").into()),
        }
    }

    /// A grid that the processes share.
    pub fn share(&self, grid: Grid) -> asperity::Result<Grid> {
        #[cfg(feature = "mpi")]
        return self.world.share(grid);
        #[cfg(not(feature = "mpi"))]
        Ok(grid)
    }

    /// The outcome of this process; an error where another one has one. All processes have to ask.
    pub fn agree<T>(&self, outcome: Outcome<T>) -> Outcome<T> {
        #[cfg(feature = "mpi")]
        {
            // an error that another process has is none of this one's
            let own = if outcome.as_ref().is_err_and(|error| !is_elsewhere(&**error)) {
                Err(Error::Elsewhere { rank: self.world.rank() })
            } else {
                Ok(())
            };
            let rank = match self.world.agree(own) {
                Err(Error::Elsewhere { rank }) => rank,
                _ => return outcome,
            };
            if rank != self.world.rank() {
                return Err(Error::Elsewhere { rank }.into());
            }
        }
        outcome
    }

    /// The result of work of the first process, for which the others wait.
    pub fn first(&self, work: impl FnOnce() -> Outcome<()>) -> Outcome<()> {
        self.agree(if self.is_first() { work() } else { Ok(()) })
    }

    /// The text of the first process.
    pub fn broadcast(&self, text: String) -> String {
        #[cfg(feature = "mpi")]
        return self.world.broadcast(&text);
        #[cfg(not(feature = "mpi"))]
        text
    }
}

/// Whether an error belongs to another process, which tells of it.
pub fn is_elsewhere(error: &(dyn std::error::Error + 'static)) -> bool {
    matches!(error.downcast_ref(), Some(Error::Elsewhere { .. }))
}
