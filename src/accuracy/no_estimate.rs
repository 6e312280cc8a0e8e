//! Why the error of a pull-off is not told.

/// Why the error of a pull-off is not told.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoEstimate {
    /// The law has a range of its own.
    Range,
    /// The search has not come to its end.
    Unreached,
    /// So few nodes bear the pull-off, in a contact: it is the pull-off of nodes, and tells no limit.
    FewNodes {
        /// The number of nodes.
        nodes: f64,
        /// The nodes (Nx, Ny) of a grid that is fine enough.
        needed: (usize, usize),
        /// The bytes that a solve takes there.
        bytes: f64,
    },
    /// This share of a periodic cell is in contact: the grid decides where closed surfaces begin to peel.
    Closed(f64),
    /// The adhesion of a rough surface is strong, with so much work of adhesion w over E\*h'²λ, of the rms slope h' and the
    /// shortest wave λ: contacts span several waves, and which of them peel first changes with the grid.
    Strong(f64),
    /// Contacts reach the edge of a free boundary's window: each grid has another edge.
    Edge,
    /// The shortest wave has so many nodes, and needs twice
    /// [`GridError::LEAST_NODES_PER_WAVE`](super::GridError::LEAST_NODES_PER_WAVE).
    Waves(f64),
    /// The grid of half as many nodes along the sides tells no pull-off.
    OneGrid,
    /// The pull-off is so many times the pull-off of the coarser grid.
    Growth(f64),
}

impl NoEstimate {
    /// Whether finer grids tell no error either.
    pub(super) fn stays(&self) -> bool {
        matches!(self, Self::Closed(_) | Self::Strong(_) | Self::Edge | Self::Unreached | Self::Range)
    }
}
