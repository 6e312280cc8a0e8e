//! The code of a warning, by which programs tell warnings apart.

use std::fmt;

/// The codes, with their names and what they mean.
macro_rules! codes {
    ($($(#[$meaning:meta])* $code:ident = $name:literal,)+) => {
        /// The code of a [`Warning`](crate::warning::Warning), which the page `docs/program/warnings.md` explains.
        ///
        /// ```
        /// use asperity_maps::warning::WarningCode;
        /// assert_eq!(WarningCode::OpenEdges.to_string(), "open-edges");
        /// ```
        #[non_exhaustive]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum WarningCode { $($(#[$meaning])* $code,)+ }

        impl WarningCode {
            /// All codes.
            pub const ALL: &[Self] = &[$(Self::$code,)+];

            /// The name that the tool and `report.json` use.
            pub fn name(self) -> &'static str {
                match self { $(Self::$code => $name,)+ }
            }
        }
    };
}

codes! {
    /// The map as a whole is inclined: opposite edges differ by the drop of its plane.
    Tilt = "tilt",
    /// The heights fall to all edges, or end before them, as on a sphere: a body, which in a periodic cell has images
    /// of itself as neighbours.
    Ends = "ends",
    /// The step across the periodic edge is far greater than any between neighbouring rows or columns inside.
    OpenEdges = "open-edges",
    /// The rms slope exceeds ½, or 100 for a measured map: heights and lengths may be in different units.
    Steep = "steep",
    /// The rms slope is less than 1e-8: heights and lengths may be in different units.
    Smooth = "smooth",
    /// The contact modulus E* is below any solid's in the unit that the lengths ask for.
    Modulus = "modulus",
    /// A contact pressure exceeds the contact modulus E*.
    BeyondModulus = "beyond-modulus",
    /// The shortest waves do not have the stiffness of a half-space: a layer may be thinner than some nodes.
    ThinBody = "thin-body",
    /// Single nodes are far above or below their neighbours.
    Spikes = "spikes",
    /// A value far outside the rest that stands for missing points, such as −9999.
    MissingCode = "missing-code",
    /// The first line or column, or two columns of several, are like coordinates.
    Axes = "axes",
    /// The numbers have magnitudes of bytes in the wrong order.
    ByteOrder = "byte-order",
    /// Nothing says how large the map is, but its file has something that may.
    Sides = "sides",
    /// The file has a mask, which was not taken.
    Mask = "mask",
    /// The map is known not to be periodic, and is solved as if it were.
    NotPeriodic = "not-periodic",
    /// The cells of the grid are far from square.
    Cells = "cells",
    /// The range of adhesion exceeds the heights, or is too short for the grid.
    Range = "range",
    /// The work of adhesion over the contact modulus E* is a length beyond the sides, or below the length of any solid.
    Work = "work",
    /// All heights are the same.
    Flat = "flat",
    /// Contact or traction reaches the edge of a free boundary's window.
    WindowEdge = "window-edge",
    /// The contact of a mirrored map differs from the contact of its mirror images.
    Images = "images",
    /// The lines along one axis are offset from one another at random, like scan lines of an instrument that drifts.
    LineOffsets = "line-offsets",
    /// Lines across the given scan lines have by far the larger offsets.
    ScanAxis = "scan-axis",
    /// Much of the load is on single lines, such as scars of a measurement.
    Scars = "scars",
    /// Much of the load is on single nodes, as noise makes.
    Noise = "noise",
    /// Most of the load is above a tenth of the contact modulus E*, where most solids yield.
    Hardness = "hardness",
    /// A few nodes in contact bear the pull-off.
    FewNodes = "few-nodes",
}

impl fmt::Display for WarningCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
