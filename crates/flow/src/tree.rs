//! A flow that is conserved at every vertex, to the last unit.

use crate::clusters::{Clusters, Joined};
use crate::network::{Edge, Network};

/// The greatest flow on an edge, in units of the flow: integers that are exact in `f64`.
const GREATEST: f64 = (1_u64 << 52) as f64;

/// A tree of the edges with the largest conductances, over all vertices and the ground.
///
/// What a flow loses or gains at a vertex is sent along the tree, from the leaves on, so that it is conserved everywhere.
/// All is done in integers, which makes conservation exact.
pub(crate) struct Tree {
    /// The vertices from the leaves on, and the edge of each to the rest of the tree.
    order: Vec<(u32, u32)>,
}

impl Tree {
    /// The tree of a network.
    pub fn new(network: &Network) -> Self {
        let vertices = network.ground() + 1;
        let conductance = |edge: u32| network.edges[edge as usize].conductance;
        let mut edges: Vec<u32> = (0..network.edges.len() as u32).collect();
        edges.sort_unstable_by(|a, b| conductance(*b).total_cmp(&conductance(*a)).then(a.cmp(b)));
        let mut clusters = Clusters::new(vertices);
        // the number of edges at each vertex, and the exclusive or of their numbers: where one is left, it is that one
        let (mut count, mut which) = (vec![0_u32; vertices], vec![0_u32; vertices]);
        let ends = |edge: u32| {
            let Edge { tail, head, .. } = network.edges[edge as usize];
            [tail as usize, head as usize]
        };
        for edge in edges {
            let [tail, head] = ends(edge);
            if let Joined::Clusters { .. } = clusters.join(tail, head, [0; 2]) {
                for end in [tail, head] {
                    count[end] += 1;
                    which[end] ^= edge;
                }
            }
        }
        let mut order = Vec::with_capacity(network.ground());
        for first in 0..network.ground() {
            let mut vertex = first;
            while count[vertex] == 1 && vertex != network.ground() {
                let edge = which[vertex];
                let [tail, head] = ends(edge);
                let rest = tail + head - vertex;
                order.push((vertex as u32, edge));
                count[vertex] = 0;
                count[rest] -= 1;
                which[rest] ^= edge;
                vertex = rest;
            }
        }
        Self { order }
    }

    /// The flow that a pressure drives, in integers, and conserved; the second is the flow of a unit. None if the numbers
    /// leave the range of integers, as of a pressure that has nothing of the solution.
    pub fn conserved(&self, network: &Network, pressure: &[f64]) -> Option<(Vec<i64>, f64)> {
        let driven = |edge: &Edge| edge.conductance * network.fall(edge, pressure);
        let unit = network.edges.iter().map(|edge| driven(edge).abs()).fold(0.0, f64::max) / GREATEST;
        let mut flow: Vec<i64> = network.edges.iter().map(|edge| (driven(edge) / unit).round() as i64).collect();
        let mut gained = vec![0_i64; network.ground() + 1];
        for (edge, flow) in network.edges.iter().zip(&flow) {
            gained[edge.tail as usize] = gained[edge.tail as usize].checked_sub(*flow)?;
            gained[edge.head as usize] = gained[edge.head as usize].checked_add(*flow)?;
        }
        for &(vertex, edge) in &self.order {
            let Edge { tail, head, .. } = network.edges[edge as usize];
            let surplus = gained[vertex as usize];
            let (rest, sent) = if tail == vertex { (head, surplus) } else { (tail, surplus.checked_neg()?) };
            flow[edge as usize] = flow[edge as usize].checked_add(sent)?;
            gained[rest as usize] = gained[rest as usize].checked_add(surplus)?;
        }
        Some((flow, unit))
    }

    /// Shifts the pressure of each part of a network without ground such that it falls from 1 to 0 over the cell: its mean
    /// at the driven edges, over the flow there, becomes ½.
    pub fn level(&self, network: &Network, flow: &[f64], pressure: &mut [f64]) {
        let mut root: Vec<u32> = (0..=network.ground() as u32).collect();
        for &(vertex, edge) in self.order.iter().rev() {
            let Edge { tail, head, .. } = network.edges[edge as usize];
            root[vertex as usize] = root[(tail + head - vertex) as usize];
        }
        let mut sums = vec![[0.0; 2]; root.len()];
        for (edge, flow) in network.edges.iter().zip(flow).filter(|(edge, _)| edge.driven) {
            let mean = 0.5 * (pressure[edge.tail as usize] + pressure[edge.head as usize]);
            let [flows, means] = &mut sums[root[edge.tail as usize] as usize];
            *flows += flow;
            *means += flow * mean;
        }
        for (pressure, root) in pressure.iter_mut().zip(root) {
            let [flows, means] = sums[root as usize];
            if flows > 0.0 {
                *pressure += 0.5 - means / flows;
            }
        }
    }
}
