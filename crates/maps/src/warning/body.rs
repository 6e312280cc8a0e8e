//! The probable mistakes in a body beside the nodes of a grid.

use std::f64::consts::PI;

use asperity::Grid;
use asperity::elastic::Body;

use super::part::Part::{Figure, Word};
use super::{Warning, WarningCode};

impl Warning {
    /// A body whose stiffness for the shortest waves on a `grid` does not grow as their wave number to 5 %, as that of a
    /// half-space does, [`ThinBody`](WarningCode::ThinBody): what takes contact edges for those on a half-space does not
    /// hold.
    ///
    /// ```
    /// use asperity::Grid;
    /// use asperity::elastic::{Base, Layer, Material};
    /// use asperity_maps::warning::Warning;
    /// let (rubber, grid) = (Material::new(2e6, 0.49)?, Grid::square(256, 1e-3)?);
    /// assert!(Warning::of_body(&Layer::new(rubber, 50e-6, Base::Bonded)?, &grid).is_none());
    /// assert!(Warning::of_body(&Layer::new(rubber, 2e-6, Base::Bonded)?, &grid).is_some());
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn of_body(body: &dyn Body, grid: &Grid) -> Option<Self> {
        let (dx, dy) = grid.spacing();
        let spacing = match grid.shape() {
            (_, 1) => dx,
            (1, _) => dy,
            _ => dx.max(dy),
        };
        // 2 on a half-space, and 1 on springs
        let growth = |spacing: f64| body.stiffness(PI / spacing, 0.0) / body.stiffness(0.5 * PI / spacing, 0.0);
        let is_off = |finer: &f64| (growth(spacing / finer) - 2.0).abs() > 0.1;
        let finer = (0..30).map(|power| f64::from(1 << power)).find(|finer| !is_off(finer));
        let or_finer = finer.map_or(String::new(), |finer| format!(", or a grid {finer} times finer"));
        let text = "the stiffness of the shortest waves on the grid is {} times that of waves twice as long, not 2 \
                    times as on a half-space, as where the body is thin beside the nodes: the area corrected for its \
                    edge, its estimated error and mu_rho are those of a half-space, and do not hold; use the contact \
                    fraction{}";
        let growth = growth(spacing);
        is_off(&1.0)
            .then(|| Self::told(WarningCode::ThinBody, (growth - 2.0).abs(), text, [Figure(growth), Word(or_finer)]))
    }
}
