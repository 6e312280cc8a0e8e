//! Pressure and flow of a network as fields on the grid.

use ndarray::Array2;

use crate::gap::Gap;
use crate::leakage::Enclosed;
use crate::network::Network;

impl Network {
    /// The pressure at the nodes, and the flow there along x and along y, per width of a cell.
    pub(crate) fn fields(&self, gap: &Gap<'_>, enclosed: &Enclosed) -> [Array2<f64>; 3] {
        let (dx, dy) = gap.grid().spacing();
        let mut field = vec![f64::NAN; gap.grid().nodes()];
        for (vertex, pressure) in enclosed.pressure.iter().enumerate() {
            self.node(vertex).into_iter().for_each(|node| field[node] = *pressure);
        }
        let mut flows = [dy, dx].map(|_| vec![0.0; gap.grid().nodes()]);
        for ((edge, way), flow) in self.edges.iter().zip(&self.ways).zip(&enclosed.flow) {
            for end in [edge.hub, edge.rim].into_iter().filter_map(|end| self.node(end as usize)) {
                // each cell has two faces along an axis
                for ((along, towards), width) in flows.iter_mut().zip(way.towards).zip([dy, dx]) {
                    along[end] += f64::from(towards) * 0.5 * flow / width;
                }
            }
        }
        let [x, y] = flows;
        let shape = gap.grid().shape();
        [field, x, y].map(|values| Array2::from_shape_vec(shape, values).unwrap_or_else(|_| Array2::zeros(shape)))
    }
}
