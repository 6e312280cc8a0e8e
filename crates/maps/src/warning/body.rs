//! The probable mistakes in a body on the nodes of a grid.

use std::f64::consts::PI;

use asperity::Grid;
use asperity::elastic::Body;

use super::part::Part::Figure;
use super::{Warning, WarningCode};

impl Warning {
    /// A body with a stiffness that does not grow as the wave number to 5 % for the shortest waves on a `grid`, unlike
    /// a half-space, [`ThinBody`](WarningCode::ThinBody): figures that assume a half-space do not hold.
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
        let growth = body.stiffness(PI / spacing, 0.0) / body.stiffness(0.5 * PI / spacing, 0.0);
        let off = (growth - 2.0).abs();
        let text = "half the wavelength is {} times as stiff, not 2: use the contact fraction";
        (off > 0.1).then(|| Self::new(WarningCode::ThinBody, off, text, [Figure(growth)]))
    }
}
