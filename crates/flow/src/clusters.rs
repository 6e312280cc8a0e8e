//! Clusters of nodes that grow together: union–find with the cell in which each node lies.

/// Clusters of nodes, each in its tree; a node knows how many cells it is from its parent.
pub(crate) struct Clusters {
    parent: Vec<u32>,
    /// The cells from the parent to the node, along x and along y.
    cells: Vec<[i32; 2]>,
    size: Vec<u32>,
}

impl Clusters {
    /// As many nodes, each a cluster of its own.
    pub fn new(nodes: usize) -> Self {
        Self { parent: (0..nodes as u32).collect(), cells: vec![[0; 2]; nodes], size: vec![1; nodes] }
    }

    /// The root of the cluster of a node, and the cells from the root to the node. On the way there all become children of
    /// the root.
    pub fn root(&mut self, node: usize) -> (usize, [i32; 2]) {
        let (mut root, mut away) = (node, [0, 0]);
        while self.parent[root] as usize != root {
            away = sum(away, self.cells[root]);
            root = self.parent[root] as usize;
        }
        let (mut next, mut rest) = (node, away);
        while self.parent[next] as usize != root {
            let (after, own) = (self.parent[next] as usize, self.cells[next]);
            (self.parent[next], self.cells[next]) = (root as u32, rest);
            rest = difference(rest, own);
            next = after;
        }
        (root, away)
    }

    /// Makes one cluster of those of two nodes, the second of which is so many cells from the first.
    pub fn join(&mut self, first: usize, second: usize, cells: [i32; 2]) -> Joined {
        let ((a, to_first), (b, to_second)) = (self.root(first), self.root(second));
        let between = difference(sum(to_first, cells), to_second);
        if a == b {
            return Joined::Loop { root: a, cells: between };
        }
        let (root, child, from_root) =
            if self.size[a] >= self.size[b] { (a, b, between) } else { (b, a, between.map(|cells| -cells)) };
        (self.parent[child], self.cells[child]) = (root as u32, from_root);
        self.size[root] += self.size[child];
        Joined::Clusters { root, child }
    }
}

/// What a step between two nodes joins.
pub(crate) enum Joined {
    /// Two clusters: the root of one has become a child of that of the other.
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
