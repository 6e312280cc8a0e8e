//! The paper's own convention for its Hertz tables: where the nodes are, and how errors are summed.

use asperity::exact::{Hertz, Sphere};
use asperity::{Grid, Result, Surface};
use ndarray::Array2;

/// The radius of the sphere, in units of the side length.
pub const RADIUS: f64 = 2.0;

/// Nodes from one side to the other with both ends, on a grid that counts one end.
fn coordinate(i: usize, n: usize) -> f64 {
    i as f64 / (n - 1) as f64 - 0.5
}

/// The sphere as the authors sample it.
pub fn surface(n: usize) -> Result<Surface> {
    let heights = Array2::from_shape_fn((n, n), |(i, j)| {
        let (x, y) = (coordinate(i, n), coordinate(j, n));
        -(x * x + y * y) / (2.0 * RADIUS)
    });
    Surface::new(Grid::square(n, 1.0)?, heights)
}

/// The paper's η² and θ², equations (24) and (25): sums over the nodes, against the Hertz contact of a single sphere
/// under the load.
pub fn errors(surface: &Surface, load: f64, gap: &Array2<f64>, pressure: &Array2<f64>) -> Result<(f64, f64)> {
    let exact = Hertz::new(RADIUS, 1.0)?.at_load(load)?;
    let n = gap.nrows();
    let [mut eta, mut theta, mut work, mut square] = [0.0; 4];
    for ((i, j), &g) in gap.indexed_iter() {
        let r = coordinate(i, n).hypot(coordinate(j, n));
        let (u, p) = (g + surface.heights()[[i, j]], pressure[[i, j]]);
        let (u_exact, p_exact) = (exact.displacement(r), exact.pressure(r));
        eta += (u - u_exact) * (p - p_exact);
        theta += (u - u_exact).powi(2);
        work += u_exact * p_exact;
        square += u_exact * u_exact;
    }
    Ok((eta / work, theta / square))
}
