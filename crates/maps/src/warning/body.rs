//! The probable mistakes in a body beside the nodes of a grid.

use std::f64::consts::PI;

use asperity::Grid;
use asperity::elastic::Body;

use super::text::Text;
use super::{Warning, WarningCode};

impl Warning {
    /// A body whose stiffness for the shortest waves on a `grid` is more than 5 % off ½E*q, that of a half-space,
    /// [`ThinBody`](WarningCode::ThinBody): what takes contact edges for those on a half-space does not hold.
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
        let over_half_space = |spacing: f64| {
            let q = PI / spacing;
            2.0 * body.stiffness(q, 0.0) / (body.modulus() * q)
        };
        let is_off = |finer: &f64| (over_half_space(spacing / finer) - 1.0).abs() > 0.05;
        let (ratio, finer) =
            (over_half_space(spacing), (0..30).map(|power| f64::from(1 << power)).find(|k| !is_off(k))?);
        let message = format!(
            "the shortest waves on the grid are {} times as stiff as on a half-space of the same contact modulus, as where \
             the body is thin beside the nodes: the area corrected for its edge, its estimated error and mu_rho are \
             those of a half-space, and do not hold; use the contact fraction, or a grid {finer} times finer",
            Self::figure(ratio)
        );
        let text = Text::default().with(message).of_severity(ratio.max(1.0 / ratio));
        is_off(&1.0).then_some(Self { code: WarningCode::ThinBody, text })
    }
}
