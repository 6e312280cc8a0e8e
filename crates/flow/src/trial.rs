//! A pressure and a flow that any gap has at no cost, with the bounds of means.

use crate::gap::{Axis, Gap};
use crate::network::Network;
use crate::tree::GREATEST;

/// The place of a node along an axis, and across it.
fn place(gap: &Gap<'_>, node: usize, axis: Axis) -> (usize, usize) {
    let (i, j) = gap.place(node);
    if axis == Axis::X { (i, j) } else { (j, i) }
}

impl Network {
    /// The pressure, of rims and ground, that is uniform across an axis, and falls at each place by the reciprocal of the
    /// sum of the cubes of the gap across it. It bounds the conductance by no more than the harmonic mean along the axis
    /// of arithmetic means across it.
    pub fn layered(&self, gap: &Gap<'_>, axis: Axis) -> Vec<f64> {
        let ((nx, ny), greatest) = (gap.grid().shape(), gap.greatest());
        let mut cubes = vec![0.0; if axis == Axis::X { nx } else { ny }];
        let nodes = (0..self.vertices()).filter_map(|vertex| self.node(vertex));
        nodes.for_each(|node| cubes[place(gap, node, axis).0] += (gap.at(node) / greatest).powi(3));
        let whole: f64 = cubes.iter().map(|cube| cube.recip()).sum();
        let mut passed = 0.0;
        let mut middle = |cube: f64| {
            let before = passed;
            passed += cube.recip();
            1.0 - 0.5 * (before + passed) / whole
        };
        let levels: Vec<f64> = cubes.into_iter().map(&mut middle).collect();
        let level = |vertex| self.node(vertex).map_or(0.0, |node| levels[place(gap, node, axis).0]);
        (0..=self.ground()).map(level).collect()
    }

    /// The flow along straight lines, of each as much as it conducts alone, in integers; the second is the flow of a unit.
    /// It bounds the conductance by the arithmetic mean across the axis of harmonic means along it, to rounding.
    pub fn lined(&self, gap: &Gap<'_>, axis: Axis) -> (Vec<i64>, f64) {
        let ((nx, ny), (dx, dy), greatest) = (gap.grid().shape(), gap.grid().spacing(), gap.greatest());
        let (lines, shape) = if axis == Axis::X { (ny, dy / dx) } else { (nx, dx / dy) };
        // infinite on a line with a closed node
        let mut resistances = vec![0.0; lines];
        (0..nx * ny).for_each(|node| resistances[place(gap, node, axis).1] += (greatest / gap.at(node)).powi(3));
        let least = resistances.iter().copied().fold(f64::INFINITY, f64::min);
        let units = |resistance: f64| {
            if resistance.is_finite() { (GREATEST * (least / resistance)).round() as i64 } else { 0 }
        };
        let mut flow = vec![0; self.edges.len()];
        for star in self.stars() {
            // the ends of a face are on one line
            let mut ends = self.edges[star.clone()].iter().flat_map(|edge| [edge.hub, edge.rim]);
            let line = ends.find_map(|end| self.node(end as usize)).map(|node| place(gap, node, axis).1);
            let along = line.map_or(0, |line| units(resistances[line]));
            star.for_each(|k| flow[k] = i64::from(self.ways[k].towards[axis as usize]) * along);
        }
        (flow, shape / (least * GREATEST))
    }
}
