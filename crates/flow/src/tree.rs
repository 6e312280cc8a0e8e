//! A flow that is conserved at every vertex, to the last unit.

use crate::clusters::{Clusters, Joined};
use crate::gap::Axis;
use crate::network::{Edge, Network};

/// The greatest flow on an edge, in units of the flow: integers that are exact in `f64`.
pub(crate) const GREATEST: f64 = (1_u64 << 52) as f64;

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
        let vertices = network.vertices();
        // by powers of two: edges near each other then stay near each other in memory
        let key = |(k, edge): (usize, &Edge)| (!edge.conductance.to_bits() >> 52 << 32) | k as u64;
        let mut edges: Vec<u64> = network.edges.iter().enumerate().map(key).collect();
        edges.sort_unstable();
        let mut clusters = Clusters::new(vertices);
        // the number of edges at each vertex, and the exclusive or of their numbers: where one edge is left, this is
        // its number
        let (mut count, mut which) = (vec![0_u32; vertices], vec![0_u32; vertices]);
        for edge in edges.into_iter().map(|key| key as u32) {
            let Edge { hub, rim, .. } = network.edges[edge as usize];
            if let Joined::Clusters { .. } = clusters.join(hub as usize, rim as usize, [0; 2]) {
                for end in [hub, rim] {
                    count[end as usize] += 1;
                    which[end as usize] ^= edge;
                }
            }
        }
        let mut order = Vec::with_capacity(vertices);
        for first in 0..vertices {
            let mut vertex = first;
            while count[vertex] == 1 && vertex != network.ground() {
                let edge = which[vertex];
                let rest = network.edges[edge as usize].other(vertex as u32) as usize;
                order.push((vertex as u32, edge));
                count[vertex] = 0;
                count[rest] -= 1;
                which[rest] ^= edge;
                vertex = rest;
            }
        }
        Self { order }
    }

    /// The pressure of each vertex that drives nothing along the tree, while the pressure along an axis is held: it
    /// falls where the passages along the axis are narrowest.
    pub fn still(&self, network: &Network, axis: Axis) -> Vec<f64> {
        let mut pressure = vec![0.0; network.vertices()];
        for &(vertex, edge) in self.order.iter().rev() {
            let (ends, held) = (&network.edges[edge as usize], network.held(edge as usize, axis));
            let towards = if ends.hub == vertex { -held } else { held };
            pressure[vertex as usize] = pressure[ends.other(vertex) as usize] + towards;
        }
        pressure
    }

    /// The flow that a pressure drives, in integers, and conserved; the second is the flow of a unit. None if the
    /// numbers leave the range of integers, for a pressure far from the solution.
    pub fn conserved(&self, network: &Network, pressure: &[f64], axis: Axis) -> Option<(Vec<i64>, f64)> {
        let mut driven = Vec::with_capacity(network.edges.len());
        network.fall(pressure, axis, |_, edge, fall| driven.push(edge.conductance * fall));
        let unit = driven.iter().copied().map(f64::abs).fold(0.0, f64::max) / GREATEST;
        let mut flow: Vec<i64> = driven.into_iter().map(|driven| (driven / unit).round() as i64).collect();
        let mut gained = vec![0_i64; network.vertices()];
        for (edge, flow) in network.edges.iter().zip(&flow) {
            gained[edge.hub as usize] = gained[edge.hub as usize].checked_sub(*flow)?;
            gained[edge.rim as usize] = gained[edge.rim as usize].checked_add(*flow)?;
        }
        for &(vertex, edge) in &self.order {
            let ends = network.edges[edge as usize];
            let surplus = gained[vertex as usize];
            let sent = if ends.hub == vertex { surplus } else { surplus.checked_neg()? };
            flow[edge as usize] = flow[edge as usize].checked_add(sent)?;
            let rest = &mut gained[ends.other(vertex) as usize];
            *rest = rest.checked_add(surplus)?;
        }
        Some((flow, unit))
    }

    /// Shifts the pressure of each part of a network without ground such that it falls from 1 to 0 over the cell: its mean
    /// at the edges on which it is held, over the flow there, becomes ½.
    pub fn level(&self, network: &Network, flow: &[f64], pressure: &mut [f64], axis: Axis) {
        let mut root: Vec<u32> = (0..network.vertices() as u32).collect();
        for &(vertex, edge) in self.order.iter().rev() {
            root[vertex as usize] = root[network.edges[edge as usize].other(vertex) as usize];
        }
        let mut sums = vec![[0.0; 2]; root.len()];
        for (k, (edge, flow)) in network.edges.iter().zip(flow).enumerate() {
            let (hub, flow) = (edge.hub as usize, flow * network.held(k, axis));
            let [flows, means] = &mut sums[root[hub] as usize];
            *flows += flow;
            *means += flow * 0.5 * (pressure[hub] + pressure[edge.rim as usize]);
        }
        for (pressure, root) in pressure.iter_mut().zip(root) {
            let [flows, means] = sums[root as usize];
            if flows > 0.0 {
                *pressure += 0.5 - means / flows;
            }
        }
    }
}
