//! Clusters of nodes that grow together: union–find with the cell in which each node lies.

/// Clusters of nodes, each in its tree.
pub(crate) struct Clusters(Vec<Member>);

/// A node of a cluster.
#[derive(Clone, Copy)]
struct Member {
    parent: u32,
    /// The number of nodes below a root; zero of a node without a cluster.
    size: u32,
    /// The cells from the parent to the node, along x and along y.
    cells: [i32; 2],
}

impl Clusters {
    /// As many nodes, each a cluster of its own.
    pub fn new(nodes: usize) -> Self {
        Self::alone(nodes, 1)
    }

    /// As many nodes, none in a cluster.
    pub fn closed(nodes: usize) -> Self {
        Self::alone(nodes, 0)
    }

    fn alone(nodes: usize, size: u32) -> Self {
        Self((0..nodes as u32).map(|parent| Member { parent, size, cells: [0; 2] }).collect())
    }

    /// Makes a node a cluster of its own.
    pub fn open(&mut self, node: usize) {
        self.0[node].size = 1;
    }

    /// Whether a node is in a cluster.
    pub fn is_open(&self, node: usize) -> bool {
        self.0[node].size > 0
    }

    /// The root of the cluster of a node, and the cells from the root to the node. On the way each other node becomes a
    /// child of its grandparent.
    pub fn root(&mut self, mut node: usize) -> (usize, [i32; 2]) {
        let mut away = [0, 0];
        loop {
            let Member { parent, cells, .. } = self.0[node];
            let above = self.0[parent as usize];
            let to_above = sum(above.cells, cells);
            if above.parent == parent {
                return (parent as usize, sum(away, to_above));
            }
            (self.0[node].parent, self.0[node].cells) = (above.parent, to_above);
            (node, away) = (above.parent as usize, sum(away, to_above));
        }
    }

    /// Joins the clusters of two nodes; the second node is so many cells from the first.
    pub fn join(&mut self, first: usize, second: usize, cells: [i32; 2]) -> Joined {
        let ((a, to_first), (b, to_second)) = (self.root(first), self.root(second));
        let between = difference(sum(to_first, cells), to_second);
        if a == b {
            return Joined::Loop { root: a, cells: between };
        }
        let (root, child, from_root) =
            if self.0[a].size >= self.0[b].size { (a, b, between) } else { (b, a, between.map(|cells| -cells)) };
        (self.0[child].parent, self.0[child].cells) = (root as u32, from_root);
        self.0[root].size += self.0[child].size;
        Joined::Clusters { root, child }
    }
}

/// What a step between two nodes joins.
pub(crate) enum Joined {
    /// Two clusters: one root has become a child of the other root.
    Clusters { root: usize, child: usize },
    /// A cluster with itself, to a loop that goes so many cells along x and along y.
    Loop { root: usize, cells: [i32; 2] },
}

pub(crate) fn sum(a: [i32; 2], b: [i32; 2]) -> [i32; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

pub(crate) fn difference(a: [i32; 2], b: [i32; 2]) -> [i32; 2] {
    [a[0] - b[0], a[1] - b[1]]
}
