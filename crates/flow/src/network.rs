//! The network of conductances on which a fluid flows through the gap.

use asperity::{Error, Result};

use crate::gap::{Axis, Gap, Step};
use crate::percolation::Percolation;

/// The least open gap over the greatest one; the cubes of both are numbers of `f64`.
const LEAST: f64 = 1e-100;

/// No vertex, or no node.
pub(crate) const NONE: u32 = u32::MAX;

/// An edge between two vertices: the face of two cells, or the outer face of a cell at a side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    pub tail: u32,
    pub head: u32,
    /// The flow over the pressure that falls from tail to head, in units of the cube of the greatest gap.
    pub conductance: f64,
    /// The axis along which it leads.
    pub way: Axis,
    /// Whether the pressure that is held between the sides falls here, once.
    pub driven: bool,
}

/// The network of the nodes through which a fluid flows along an axis.
///
/// A flow f on the edges is conserved at every vertex, and a pressure p at the vertices drives f = c (p_tail − p_head +
/// e), where e = 1 on the driven edges: the pressure that is held falls by one over the cell. In a periodic gap the driven
/// edges are those across the last side; in a free one they lead to the first side from the *ground*, which is both sides
/// at once. The flow along the axis is that on the driven edges. Across the axis of a periodic cell no pressure is held.
///
/// Nodes at dead ends, to which a single open neighbour leads, are left out.
pub(crate) struct Network {
    /// The node of each vertex.
    pub nodes: Vec<u32>,
    pub edges: Vec<Edge>,
    /// Nodes of dead ends and the step from each towards the flow, which come after the nodes that they lead to.
    pub dead_ends: Vec<(u32, Step)>,
    /// The cube of the greatest gap.
    pub unit: f64,
}

impl Network {
    /// The network of a gap along an axis.
    ///
    /// # Errors
    /// [`Error::Value`] if the least open gap is below 1e-100 of the greatest.
    pub fn new(gap: &Gap<'_>, percolation: &Percolation, axis: Axis) -> Result<Self> {
        let (greatest, all) = (gap.greatest(), gap.grid().nodes());
        let (dx, dy) = gap.grid().spacing();
        let carries = |node: usize| gap.at(node) > 0.0 && percolation.carries(node, axis);
        let least = (0..all).filter(|node| carries(*node)).map(|node| gap.at(node)).fold(greatest, f64::min);
        if least < LEAST * greatest {
            let (name, requirement) = ("least open gap over the greatest", "at least 1e-100: set lesser gaps to zero");
            return Err(Error::Value { name, value: least / greatest, requirement });
        }
        // the number of steps that lead on from each node; those to a side count, and a node that is its own neighbour's too
        let outward = |node: usize| {
            usize::from(gap.forward(node, axis).is_none()) + usize::from(gap.backward(node, axis).is_none())
        };
        let onward = |node: usize| outward(node) + gap.steps(node).filter(|step| carries(step.to)).count();
        let mut left: Vec<u8> = (0..all).map(|node| if carries(node) { onward(node) as u8 } else { 0 }).collect();
        let mut dead_ends = Vec::new();
        for first in 0..all {
            let mut node = first;
            while left[node] == 1 && outward(node) == 0 {
                let Some(step) = gap.steps(node).find(|step| left[step.to] > 0) else { break };
                left[node] = 0;
                left[step.to] -= 1;
                dead_ends.push((node as u32, step));
                node = step.to;
            }
        }
        dead_ends.reverse();

        let nodes: Vec<u32> = (0..all as u32).filter(|node| left[*node as usize] > 0).collect();
        let ground = nodes.len() as u32;
        let mut vertex = vec![NONE; all];
        nodes.iter().enumerate().for_each(|(k, node)| vertex[*node as usize] = k as u32);
        let cube = |node: usize| (gap.at(node) / greatest).powi(3);
        let mut edges = Vec::with_capacity(2 * nodes.len());
        for (k, node) in nodes.iter().enumerate().map(|(k, node)| (k as u32, *node as usize)) {
            for (way, shape) in [(Axis::X, dy / dx), (Axis::Y, dx / dy)] {
                let half = 2.0 * shape * cube(node);
                match gap.forward(node, way) {
                    Some(Step { to, cells }) if vertex[to] != NONE => {
                        // the harmonic mean of both cubes
                        let other = 2.0 * shape * cube(to);
                        let conductance = half / (half + other) * other;
                        let driven = cells[axis as usize] != 0;
                        if driven || to != node {
                            edges.push(Edge { tail: k, head: vertex[to], conductance, way, driven });
                        }
                    }
                    None if way == axis => {
                        edges.push(Edge { tail: k, head: ground, conductance: half, way, driven: false });
                    }
                    _ => {}
                }
                if way == axis && gap.backward(node, way).is_none() {
                    edges.push(Edge { tail: ground, head: k, conductance: half, way, driven: true });
                }
            }
        }
        Ok(Self { nodes, edges, dead_ends, unit: greatest.powi(3) })
    }

    /// The number of vertices beside the ground; that of the ground.
    pub fn ground(&self) -> usize {
        self.nodes.len()
    }

    /// The pressure that falls along an edge.
    pub fn fall(&self, edge: &Edge, pressure: &[f64]) -> f64 {
        let fall = pressure[edge.tail as usize] - pressure[edge.head as usize];
        if edge.driven { fall + 1.0 } else { fall }
    }

    /// What each vertex, and the ground, gains from the flow that a pressure drives.
    pub fn gained(&self, pressure: &[f64]) -> Vec<f64> {
        self.gathered(|edge| self.fall(edge, pressure))
    }

    /// What each vertex, and the ground, loses by the flow of a pressure alone: the product with the network's matrix.
    pub fn apply(&self, pressure: &[f64]) -> Vec<f64> {
        self.gathered(|edge| pressure[edge.head as usize] - pressure[edge.tail as usize])
    }

    fn gathered(&self, fall: impl Fn(&Edge) -> f64) -> Vec<f64> {
        let mut gained = vec![0.0; self.ground() + 1];
        for edge in &self.edges {
            let flow = edge.conductance * fall(edge);
            gained[edge.tail as usize] -= flow;
            gained[edge.head as usize] += flow;
        }
        gained
    }

    /// An upper bound of the conductance: that of any pressure, by Dirichlet's principle, Σ c (Δp)².
    pub fn upper(&self, pressure: &[f64]) -> f64 {
        let power = |edge: &Edge| {
            // the bound of what a driven fall may have lost to rounding, beside the relative error of all falls
            let lost = if edge.driven {
                f64::EPSILON * (1.0 + pressure[edge.tail as usize].abs() + pressure[edge.head as usize].abs())
            } else {
                0.0
            };
            let fall = self.fall(edge, pressure).abs() + lost;
            edge.conductance * fall * fall
        };
        total(self.edges.iter().map(power)) * (1.0 + ROUNDING)
    }

    /// A lower bound of the conductance: that of any flow that is conserved, by Thomson's principle, F²/Σ(f²/c) with the
    /// flow F along the axis. The flow is in integers, so that what is conserved is conserved to the last unit.
    pub fn lower(&self, flow: &[i64]) -> f64 {
        let along: i128 =
            self.edges.iter().zip(flow).filter(|(edge, _)| edge.driven).map(|(_, flow)| i128::from(*flow)).sum();
        let power = total(self.edges.iter().zip(flow).map(|(edge, flow)| (*flow as f64).powi(2) / edge.conductance));
        // a flow backwards bounds nothing
        let along = along.max(0) as f64;
        if power > 0.0 { along * along / power * (1.0 - ROUNDING) } else { 0.0 }
    }
}

/// A bound of the relative rounding error of a bound: some ten roundings in each conductance and term, two of the sum.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// A sum of numbers that are not negative, to two roundings (Neumaier).
fn total(terms: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut rest) = (0.0_f64, 0.0);
    for term in terms {
        let next = sum + term;
        rest += if sum >= term { (sum - next) + term } else { (term - next) + sum };
        sum = next;
    }
    sum + rest
}
