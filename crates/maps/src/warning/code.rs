//! The code of a warning, by which programs tell warnings apart.

use std::fmt;

/// The code of a [`Warning`](crate::warning::Warning).
///
/// ```
/// use asperity_maps::warning::WarningCode;
/// assert_eq!(WarningCode::OpenEdges.to_string(), "open-edges");
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum WarningCode {
    /// The map as a whole is inclined: opposite edges differ by the drop of its plane.
    Tilt,
    /// The heights fall to all edges, or end before them, as those of a sphere: a body, which in a periodic cell stands
    /// among images of itself.
    Ends,
    /// The step across the periodic edge is far greater than any between neighbouring rows or columns inside.
    OpenEdges,
    /// The rms slope exceeds ½, that of a measured map 100, as where heights and lengths are in different units.
    Steep,
    /// The rms slope is less than 1e-8, as where heights and lengths are in different units.
    Smooth,
    /// The contact modulus E* is below that of any solid in the unit that the lengths ask for.
    Modulus,
    /// A contact pressure exceeds the contact modulus E*.
    BeyondModulus,
    /// The stiffness of the shortest waves is not that of a half-space, as of a layer that is thinner than some nodes.
    ThinBody,
    /// Single nodes are far out of their neighbours.
    Spikes,
    /// A value far outside the rest that stands for missing points, as −9999.
    MissingCode,
    /// The first line or column runs evenly, as coordinates do.
    Axes,
    /// The magnitudes of the numbers are those of bytes in the wrong order.
    ByteOrder,
    /// The cells of the grid are far from square.
    Cells,
    /// The range of adhesion exceeds the heights, or is too short for the grid.
    Range,
    /// All heights are the same.
    Flat,
    /// Contact or traction reaches the edge of a free boundary's window.
    WindowEdge,
    /// The contact of a mirrored map is not that of its mirror images.
    Images,
    /// The lines across the scan lines that are to be brought to one height have by far the larger offsets.
    ScanAxis,
    /// Much of the load stands on single lines, as on scars of a measurement.
    Scars,
    /// Much of the load stands on single nodes, as on noise.
    Noise,
    /// Most of the load stands above a tenth of the contact modulus E*, where most solids yield.
    Hardness,
}

impl WarningCode {
    /// The name that the tool and `report.json` use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tilt => "tilt",
            Self::Ends => "ends",
            Self::OpenEdges => "open-edges",
            Self::Steep => "steep",
            Self::Smooth => "smooth",
            Self::Modulus => "modulus",
            Self::BeyondModulus => "beyond-modulus",
            Self::ThinBody => "thin-body",
            Self::Spikes => "spikes",
            Self::MissingCode => "missing-code",
            Self::Axes => "axes",
            Self::ByteOrder => "byte-order",
            Self::Cells => "cells",
            Self::Range => "range",
            Self::Flat => "flat",
            Self::WindowEdge => "window-edge",
            Self::Images => "images",
            Self::ScanAxis => "scan-axis",
            Self::Scars => "scars",
            Self::Noise => "noise",
            Self::Hardness => "hardness",
        }
    }
}

impl fmt::Display for WarningCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
