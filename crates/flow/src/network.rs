//! The network of conductances on which a fluid flows through the gap.

use asperity::{Error, Result};

use crate::gap::{AROUND, Axis, Gap};
use crate::percolation::Percolation;

/// The least open gap over the greatest one; the cubes of both are numbers of `f64`.
const LEAST: f64 = 1e-100;

/// No rim, or no node.
const NONE: u32 = u32::MAX;

/// An edge from a hub to a rim.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    /// The flow over the pressure that falls from hub to rim, in units of the cube of the greatest gap.
    pub conductance: f64,
    /// The vertex of the hub.
    pub hub: u32,
    /// The vertex of the rim, or the ground.
    pub rim: u32,
}

impl Edge {
    /// The other end.
    pub fn other(&self, vertex: u32) -> u32 {
        if vertex == self.hub { self.rim } else { self.hub }
    }
}

/// Where an edge leads, along x and along y.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    /// How often the pressure that is held along an axis falls from hub to rim: −1, 0 or 1.
    pub held: [i8; 2],
    /// The direction from hub to rim: −1, 0 or 1.
    pub towards: [i8; 2],
}

/// The network of the nodes through which a fluid flows along an axis, in stars: hubs, with edges to their rims.
///
/// A flow f on the edges is conserved at every vertex, and a pressure p at the vertices drives f = c (p_hub − p_rim +
/// e), where the pressure that is held falls e times. In a periodic gap the edges across the last side have e = 1, and
/// the held pressure falls by one over the cell; both axes have the same network. In a free gap the edges at the first
/// side have e = −1, and lead to the *ground*, which is both sides at once. The flow along the axis is Σ f e.
///
/// The hubs are the nodes of one colour of a checkerboard, and the rims the nodes of the other. Flow is conserved at a
/// hub with the mean pressure of its rims, weighted by conductances: the pressures of the rims suffice. Where two rims
/// are neighbours, the face between them is a hub, with twice the conductance to either.
///
/// The vertices are the rims, the ground and the hubs, one after the other.
pub(crate) struct Network {
    /// The node of each rim.
    rims: Vec<u32>,
    /// The node of each hub; none of a face.
    hubs: Vec<u32>,
    /// Where the edges of each hub begin.
    starts: Vec<usize>,
    pub edges: Vec<Edge>,
    pub ways: Vec<Way>,
    /// The cube of the greatest gap.
    pub unit: f64,
}

/// Whether a node is one of the checkerboard.
fn is_hub(gap: &Gap<'_>, node: usize) -> bool {
    let ((nx, ny), (i, j)) = (gap.grid().shape(), gap.place(node));
    // where opposite sides meet, an odd number of nodes ends the checkerboard
    let ends = |k, n: usize| gap.is_periodic() && !n.is_multiple_of(2) && k + 1 == n;
    (i + j).is_multiple_of(2) && !ends(i, nx) && !ends(j, ny)
}

impl Network {
    /// The network of a gap along an axis.
    ///
    /// # Errors
    /// [`Error::Value`] if the least open gap is below 1e-100 of the greatest.
    pub fn new(gap: &Gap<'_>, percolation: &Percolation, axis: Axis) -> Result<Self> {
        let (greatest, all) = (gap.greatest(), gap.grid().nodes());
        let carries = |node: usize| gap.at(node) > 0.0 && percolation.carries(node, axis);
        let least = (0..all).filter(|node| carries(*node)).map(|node| gap.at(node)).fold(greatest, f64::min);
        if least < LEAST * greatest {
            let (name, requirement) = ("least open gap over the greatest", "at least 1e-100: set lesser gaps to zero");
            return Err(Error::Value { name, value: least / greatest, requirement });
        }
        let rims: Vec<u32> =
            (0..all).filter(|node| carries(*node) && !is_hub(gap, *node)).map(|node| node as u32).collect();
        let mut rim = vec![NONE; all];
        rims.iter().enumerate().for_each(|(k, node)| rim[*node as usize] = k as u32);

        let ground = rims.len() as u32;
        let (dx, dy) = gap.grid().spacing();
        let half = |node: usize, way: Axis| {
            2.0 * (if way == Axis::X { dy / dx } else { dx / dy }) * (gap.at(node) / greatest).powi(3)
        };
        // the rim, or the ground, next to a node; the conductance on the way, the harmonic mean of both cubes; and the
        // way
        let link = |node: usize, way: Axis, forward: bool| {
            let mut towards = [0, 0];
            towards[way as usize] = if forward { 1 } else { -1 };
            let own = half(node, way);
            match gap.step(node, way, forward) {
                Some(step) if carries(step.to) => {
                    let other = half(step.to, way);
                    let held = step.cells.map(|cells| cells as i8);
                    Some((rim[step.to], own / (own + other) * other, Way { held, towards }))
                }
                None if way == axis => {
                    let held = if forward { [0, 0] } else { towards };
                    Some((ground, own, Way { held, towards }))
                }
                _ => None,
            }
        };
        let (open, mut edges, mut ways) = ((0..all).filter(|node| carries(*node)), Vec::new(), Vec::new());
        edges.reserve_exact(2 * open.clone().count());
        ways.reserve_exact(edges.capacity());
        let mut made = Self { rims, hubs: Vec::new(), starts: vec![0], edges, ways, unit: greatest.powi(3) };
        for node in open {
            let links = AROUND.into_iter().filter_map(|(way, forward)| link(node, way, forward));
            if rim[node] == NONE {
                made.star(node as u32, links);
                continue;
            }
            for (to, conductance, way) in links {
                // the same face is not met again from the other side
                let once = to == ground || way.towards.contains(&1);
                if once && to != NONE {
                    let back = Way { held: [0; 2], towards: way.towards.map(|towards| -towards) };
                    made.star(NONE, [(rim[node], 2.0 * conductance, back), (to, 2.0 * conductance, way)]);
                }
            }
        }
        Ok(made)
    }

    /// Adds a hub with its edges.
    fn star(&mut self, node: u32, links: impl IntoIterator<Item = (u32, f64, Way)>) {
        let hub = self.vertices() as u32;
        self.hubs.push(node);
        for (rim, conductance, way) in links {
            self.edges.push(Edge { conductance, hub, rim });
            self.ways.push(way);
        }
        self.starts.push(self.edges.len());
    }

    /// The number of rims; the vertex of the ground.
    pub fn ground(&self) -> usize {
        self.rims.len()
    }

    /// The number of vertices.
    pub fn vertices(&self) -> usize {
        self.rims.len() + 1 + self.hubs.len()
    }

    /// The node of a vertex; none of a face and of the ground.
    pub fn node(&self, vertex: usize) -> Option<usize> {
        let hub = || self.hubs.get(vertex.checked_sub(self.rims.len() + 1)?);
        self.rims.get(vertex).or_else(hub).filter(|node| **node != NONE).map(|node| *node as usize)
    }

    /// The edges of each hub, by their numbers.
    pub fn stars(&self) -> impl Iterator<Item = std::ops::Range<usize>> + Clone + '_ {
        self.starts.windows(2).map(|pair| pair[0]..pair[1])
    }

    /// How often the pressure that is held along an axis falls on an edge.
    pub fn held(&self, edge: usize, axis: Axis) -> f64 {
        f64::from(self.ways[edge].held[axis as usize])
    }

    /// The pressures of the hubs at which the flow is conserved.
    pub fn hubs<'a>(&'a self, pressure: &'a [f64], axis: Axis) -> impl Iterator<Item = f64> + 'a {
        self.stars().map(move |star| self.mean(star, pressure, |edge| self.held(edge, axis)))
    }

    /// The pressure of the hub of a star.
    fn mean(&self, star: std::ops::Range<usize>, pressure: &[f64], held: impl Fn(usize) -> f64) -> f64 {
        let (mut weighted, mut weights) = (0.0, 0.0);
        for (k, edge) in star.clone().zip(&self.edges[star]) {
            weighted += edge.conductance * (pressure[edge.rim as usize] - held(k));
            weights += edge.conductance;
        }
        weighted / weights
    }

    /// Visits each edge, by its number, with the pressure that falls along it.
    pub fn fall(&self, pressure: &[f64], axis: Axis, mut visit: impl FnMut(usize, &Edge, f64)) {
        for star in self.stars() {
            let hub = self.mean(star.clone(), pressure, |edge| self.held(edge, axis));
            for (k, edge) in star.clone().zip(&self.edges[star]) {
                visit(k, edge, hub - pressure[edge.rim as usize] + self.held(k, axis));
            }
        }
    }

    /// What each rim, and the ground, gains from the flow that a pressure drives.
    pub fn gained(&self, pressure: &[f64], axis: Axis, gained: &mut [f64]) {
        self.gather(pressure, |edge| self.held(edge, axis), gained);
    }

    /// What each rim, and the ground, gains from the flow of a pressure alone: less the product with the matrix.
    pub fn apply(&self, pressure: &[f64], gained: &mut [f64]) {
        self.gather(pressure, |_| 0.0, gained);
    }

    fn gather(&self, pressure: &[f64], held: impl Fn(usize) -> f64, gained: &mut [f64]) {
        gained.fill(0.0);
        for star in self.stars() {
            let hub = self.mean(star.clone(), pressure, &held);
            for (k, edge) in star.clone().zip(&self.edges[star]) {
                gained[edge.rim as usize] += edge.conductance * (hub - pressure[edge.rim as usize] + held(k));
            }
        }
    }

    /// An upper bound of the conductance by any pressure, Σ c (Δp)², by Dirichlet's principle.
    pub fn upper(&self, pressure: &[f64], axis: Axis) -> f64 {
        let mut power = Total::default();
        self.fall(pressure, axis, |k, edge, fall| {
            // the bound of what a driven fall may have lost to rounding, besides the relative error of all falls
            let lost = if self.held(k, axis) == 0.0 {
                0.0
            } else {
                f64::EPSILON * (2.0 + fall.abs() + 2.0 * pressure[edge.rim as usize].abs())
            };
            power.add(edge.conductance * (fall.abs() + lost).powi(2));
        });
        power.get() * (1.0 + ROUNDING)
    }

    /// A lower bound of the conductance by any conserved flow, F²/Σ(f²/c) with the flow F along the axis, by Thomson's
    /// principle. The flow is in integers, conserved to the last unit.
    pub fn lower(&self, flow: &[i64], axis: Axis) -> f64 {
        let ways = self.ways.iter().zip(flow);
        let along: i128 = ways.map(|(way, flow)| i128::from(way.held[axis as usize]) * i128::from(*flow)).sum();
        let mut power = Total::default();
        self.edges.iter().zip(flow).for_each(|(edge, flow)| power.add((*flow as f64).powi(2) / edge.conductance));
        let power = power.get();
        // a flow backwards bounds nothing
        let along = along.max(0) as f64;
        if power > 0.0 { along * along / power * (1.0 - ROUNDING) } else { 0.0 }
    }
}

/// A bound of the relative rounding error of a bound: some ten roundings in each conductance and term, two of the sum.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// A sum of numbers that are not negative, to two roundings (Neumaier).
#[derive(Default)]
struct Total {
    sum: f64,
    rest: f64,
}

impl Total {
    fn add(&mut self, term: f64) {
        let next = self.sum + term;
        self.rest += if self.sum >= term { (self.sum - next) + term } else { (term - next) + self.sum };
        self.sum = next;
    }

    fn get(&self) -> f64 {
        self.sum + self.rest
    }
}
