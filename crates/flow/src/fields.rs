//! Pressure and flow of a network as fields on the grid.

use ndarray::Array2;

use crate::gap::{Axis, Gap};
use crate::leakage::Enclosed;
use crate::network::Network;

impl Network {
    /// The pressure at the nodes, and the flow there along x and along y, per width of a cell.
    pub(crate) fn fields(&self, gap: &Gap<'_>, axis: Axis, enclosed: &Enclosed) -> [Array2<f64>; 3] {
        let (grid, ground) = (gap.grid(), self.ground());
        let Enclosed { pressure, flow, .. } = enclosed;
        let mut field = vec![f64::NAN; grid.nodes()];
        self.nodes.iter().zip(pressure).for_each(|(node, pressure)| field[*node as usize] = *pressure);
        // nothing flows in dead ends: the pressure is that of the node to which they lead
        for (node, step) in &self.dead_ends {
            field[*node as usize] = field[step.to] - f64::from(step.cells[axis as usize]);
        }
        let (dx, dy) = grid.spacing();
        let mut flows = [Axis::X, Axis::Y].map(|_| vec![0.0; grid.nodes()]);
        for (edge, flow) in self.edges.iter().zip(flow) {
            let ends = [edge.tail as usize, edge.head as usize];
            let width = if edge.way == Axis::X { dy } else { dx };
            for end in ends.into_iter().filter(|end| *end < ground) {
                // each cell has two faces along an axis
                flows[edge.way as usize][self.nodes[end] as usize] += 0.5 * flow / width;
            }
        }
        let [x, y] = flows;
        [field, x, y]
            .map(|values| Array2::from_shape_vec(grid.shape(), values).unwrap_or_else(|_| Array2::zeros(grid.shape())))
    }
}
