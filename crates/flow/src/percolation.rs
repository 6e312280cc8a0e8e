//! Percolation: whether the open nodes connect opposite sides, and through which constriction.

use std::collections::VecDeque;

use crate::clusters::{Clusters, Joined, difference, sum};
use crate::gap::{Axis, Gap, Step};

/// The widest passage along an axis, at its narrowest place.
///
/// Every way through the cell has a gap of at most this one somewhere, and one way has no less anywhere.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Constriction {
    /// The gap at the constriction: a sphere of a lesser diameter passes.
    pub gap: f64,
    /// The node of the constriction, `(ix, iy)`.
    pub node: (usize, usize),
    /// The nodes of the shortest such way, neighbour by neighbour: around a periodic cell, from the first to the last side
    /// of a free one.
    pub path: Vec<(usize, usize)>,
}

/// Along which axes a gap lets something through.
///
/// Neighbours share a side of their cells, as in the network of the [leakage](crate::Leakage). A free gap percolates
/// along an axis if open nodes connect both sides; a periodic gap if a cluster of open nodes *winds* around the cell
/// along this axis, alone or along the other axis as well: M. E. J. Newman, R. M. Ziff, Phys. Rev. E 64, 016706 (2001).
/// The contact of self-affine surfaces closes the last channel at a contact fraction of some 0.42: B. N. J. Persson, C.
/// Yang, J. Phys.: Condens. Matter 20, 315011 (2008); W. B. Dapp et al., Phys. Rev. Lett. 108, 244301 (2012).
///
/// Memory per node: 33 bytes, besides the gap.
#[derive(Clone, Debug)]
pub struct Percolation {
    constrictions: [Option<Constriction>; 2],
    /// What the cluster of each node reaches.
    reach: Vec<u8>,
}

/// The bits of a cluster that reaches the first and the last side along an axis; a loop around the cell reaches both.
fn bits(axis: Axis) -> u8 {
    match axis {
        Axis::X => 0b0011,
        Axis::Y => 0b1100,
    }
}

impl Gap<'_> {
    /// Percolation of the gap: the widest passage along each axis.
    pub fn percolation(&self) -> Percolation {
        let nodes = self.grid().nodes();
        // the widest first, and of equal ones in row-major order: the bits of positive numbers are in their order
        let key = |node: usize| (u128::from(!self.at(node).to_bits()) << 32) | node as u128;
        let mut order: Vec<u128> = (0..nodes).filter(|node| self.at(*node) > 0.0).map(key).collect();
        order.sort_unstable();
        let (mut clusters, mut reach) = (Clusters::closed(nodes), vec![0_u8; nodes]);
        let mut last = [None; 2];
        for node in order.into_iter().map(|key| key as u32 as usize) {
            reach[node] |= self.sides(node);
            clusters.open(node);
            for step in self.steps(node) {
                if !clusters.is_open(step.to) {
                    continue;
                }
                match clusters.join(node, step.to, step.cells) {
                    Joined::Clusters { root, child } => reach[root] |= reach[child],
                    Joined::Loop { root, cells } => {
                        let around = Axis::BOTH.into_iter().filter(|axis| cells[*axis as usize] != 0);
                        around.for_each(|axis| reach[root] |= bits(axis));
                    }
                }
            }
            let (root, _) = clusters.root(node);
            for axis in Axis::BOTH {
                if last[axis as usize].is_none() && reach[root] & bits(axis) == bits(axis) {
                    last[axis as usize] = Some(node);
                }
            }
        }
        for node in 0..nodes {
            reach[node] = reach[clusters.root(node).0];
        }
        drop(clusters);
        let constriction = |axis: Axis| {
            let node = last[axis as usize]?;
            let path = self.path(node, axis).into_iter().map(|node| self.place(node)).collect();
            Some(Constriction { gap: self.at(node), node: self.place(node), path })
        };
        Percolation { constrictions: Axis::BOTH.map(constriction), reach }
    }

    /// Whether a node is opened before another node, or is that node, from the widest gap on.
    fn is_before(&self, node: usize, last: usize) -> bool {
        let (gap, least) = (self.at(node), self.at(last));
        gap > least || (gap == least && node <= last)
    }

    /// The sides of a free gap at which a node is.
    fn sides(&self, node: usize) -> u8 {
        let side = |axis| {
            let [first, last] = [false, true].map(|forward| u8::from(self.step(node, axis, forward).is_none()));
            ((bits(axis) & 0b0101) * first) | ((bits(axis) & 0b1010) * last)
        };
        side(Axis::X) | side(Axis::Y)
    }

    /// The shortest way along an axis through a node and nodes before it, without which there is none.
    fn path(&self, through: usize, axis: Axis) -> Vec<usize> {
        // the node from which each was found, and the cell in which it was
        let mut found: Vec<Option<(u32, [i32; 2])>> = vec![None; self.grid().nodes()];
        found[through] = Some((through as u32, [0; 2]));
        let back = |found: &[Option<(u32, [i32; 2])>], from: usize| {
            let before = |node: &usize| found[*node].map(|(before, _)| before as usize).filter(|before| before != node);
            std::iter::successors(Some(from), before).collect::<Vec<_>>()
        };
        let mut ends = [None; 2];
        let mut queue = VecDeque::from([through]);
        while let Some(node) = queue.pop_front() {
            let here = found[node].map_or([0; 2], |(_, cells)| cells);
            for (end, forward) in ends.iter_mut().zip([false, true]) {
                if end.is_none() && self.step(node, axis, forward).is_none() {
                    *end = Some(node);
                }
            }
            if let [Some(first), Some(last)] = ends {
                return joined(back(&found, first), back(&found, last));
            }
            for Step { to, cells } in self.steps(node).filter(|step| self.is_before(step.to, through)) {
                let there = sum(here, cells);
                match found[to] {
                    None => {
                        found[to] = Some((node as u32, there));
                        queue.push_back(to);
                    }
                    Some((_, other)) => {
                        let around = difference(there, other)[axis as usize];
                        if around != 0 {
                            let (a, b) = if around > 0 { (to, node) } else { (node, to) };
                            return joined(back(&found, a), back(&found, b));
                        }
                    }
                }
            }
        }
        Vec::new()
    }
}

/// The way from the end of one way back to where both begin, and from there on to the end of the other.
fn joined(first: Vec<usize>, mut last: Vec<usize>) -> Vec<usize> {
    last.pop();
    first.into_iter().chain(last.into_iter().rev()).collect()
}

impl Percolation {
    /// The widest passage along an axis; none if the gap is closed along it.
    pub fn along(&self, axis: Axis) -> Option<&Constriction> {
        self.constrictions[axis as usize].as_ref()
    }

    /// Whether the nodes with a gap above a size percolate along an axis.
    pub fn above(&self, size: f64, axis: Axis) -> bool {
        self.along(axis).is_some_and(|constriction| constriction.gap > size)
    }

    /// Whether it percolates along both axes, and each cluster along both or along none.
    pub(crate) fn is_alike(&self) -> bool {
        let along = |reach: &u8, axis: Axis| reach & bits(axis) == bits(axis);
        self.constrictions.iter().all(Option::is_some)
            && self.reach.iter().all(|reach| along(reach, Axis::X) == along(reach, Axis::Y))
    }

    /// Whether a node is in a cluster that percolates along an axis.
    pub(crate) fn carries(&self, node: usize, axis: Axis) -> bool {
        self.reach[node] & bits(axis) == bits(axis)
    }
}
