//! The factors of estimates of this folder: each is fitted to the true errors of some scenes, none is derived.

use super::Quantity;

/// The factors in the error of one quantity, fitted to rough surfaces, strips, lattices and lines; with a law that has the
/// range of the grid to the scenes of `--example jkr -- kinds`.
#[derive(Clone, Copy)]
pub(super) struct Factors {
    /// Of the difference to a coarser grid.
    pub difference: f64,
    /// Of the change of the counted area to that grid.
    pub edge: f64,
    /// Of the power of the nodes in the shortest wave, and that power.
    pub waves: f64,
    pub order: f64,
    /// Of the inverse square of the nodes in the shortest wave, in the estimate to be expected.
    pub expected: f64,
    /// Of the inverse of these nodes there, with a law that has the range of the grid.
    pub expected_with_range: f64,
    /// With a law that has the range of the grid, of the process zone and of the difference to a coarser grid, and of the
    /// zone without a coarser grid.
    pub zone: [f64; 3],
    /// Of the difference there, where there is next to no adhesion.
    pub weak: f64,
    /// Of the places of the edge there, with a coarser grid and without one.
    pub places: [f64; 2],
}

const AREA: Factors = Factors {
    difference: 0.25,
    edge: 0.0,
    waves: 0.6,
    order: 2.0,
    expected: 0.3,
    expected_with_range: 0.7,
    zone: [0.7, 1.4, 1.7],
    weak: 0.25,
    places: [1.0, 2.0],
};

const GAP: Factors = Factors {
    difference: 0.15,
    edge: 0.001,
    waves: 0.4,
    order: 3.0,
    expected: 0.05,
    expected_with_range: 0.3,
    zone: [4.0, 4.0, 7.5],
    weak: 0.15,
    places: [0.5; 2],
};

// of first order where a body ends
const APPROACH: Factors = Factors { zone: [2.5, 1.5, 3.75], weak: 0.625, places: [1.2; 2], ..GAP };

const PRESSURE: Factors = Factors { waves: 1.0, expected: 0.1, zone: [6.0, 3.0, 15.0], ..GAP };

impl Factors {
    /// The factors of a quantity on a plane, or on a line; none of a quantity of loops.
    pub(super) fn of(quantity: Quantity, line: bool) -> Option<Self> {
        let on_plane = match quantity {
            Quantity::Area => AREA,
            Quantity::Gap => GAP,
            Quantity::Approach => APPROACH,
            Quantity::Pressure => PRESSURE,
            Quantity::Work | Quantity::Tension => return None,
        };
        Some(match quantity {
            _ if !line => on_plane,
            Quantity::Area => Self { difference: 0.5, waves: 5.0, expected: 0.6, ..on_plane },
            _ => Self { difference: 1.0 / 3.0, edge: 0.02, ..on_plane },
        })
    }
}

/// The factors of the places of the edge in the error of the area, fitted to the same scenes: of the root of their number,
/// and where they are alike of the edge and of the inverse square of the nodes in the shortest wave; and of the adhesion.
pub(super) struct Edge {
    pub scatter: f64,
    pub alike: f64,
    pub waves: f64,
    pub adhesion: f64,
}

pub(super) const EDGE: Edge = Edge { scatter: 0.03, alike: 0.1, waves: 4.0, adhesion: 0.1 };

/// The process zone of a law that has the range of the grid, fitted to the scenes of `--example jkr -- kinds`.
pub(super) struct Zone {
    /// How many times as large an error is where the area changes from grid to grid by more than half the zone.
    pub apart: f64,
    /// How much more of the zone is in the error of the area where adhesion carries all of the contact pressure.
    pub strong: f64,
}

pub(super) const ZONE: Zone = Zone { apart: 4.5, strong: 0.8 };

/// The pull-off by a law that has the range of the grid, fitted to the scenes of `--example jkr -- kinds`.
pub(super) struct PullOffs {
    /// Of the process zone, and of the difference to the grid of half as many nodes.
    pub zone: f64,
    pub difference: f64,
    /// Of the adhesion of a rough surface, by which the error is larger.
    pub adhesion: f64,
    /// The adhesion of a rough surface above which two grids tell no error: of 13 scenes with more adhesion the pull-off
    /// was within it in 6.
    pub strong: f64,
    /// The waves along a side below which surfaces peel alike on all grids.
    pub few_waves: f64,
    /// The contact fraction by the adhesive energy above which a periodic cell is closed: the grid decides when it opens.
    pub closed: f64,
    /// The same fraction above which the error is not told: on finer grids the surfaces may be closed.
    pub nearly_closed: f64,
    /// The growth from one grid to the next above which the two tell no error.
    pub growth: f64,
    /// The change to a grid of twice as many nodes, where a single grid is known.
    pub change: f64,
    /// The least number of nodes in a contact that bears the pull-off, and the least radius of a contact by the theory of
    /// Johnson, Kendall and Roberts, in spacings.
    pub nodes: f64,
    pub radius: f64,
}

pub(super) const PULL_OFF: PullOffs = PullOffs {
    zone: 1.5,
    difference: 1.5,
    adhesion: 10.0,
    strong: 0.03,
    few_waves: 3.5,
    closed: 0.75,
    nearly_closed: 0.4,
    growth: 1.15,
    change: 0.85,
    nodes: 10.0,
    radius: 2.0,
};

/// What loops dissipate by a law that has the range of the grid, fitted to spheres and to the first 12 surfaces of
/// `--example touch -- --seed 700`.
pub(super) struct Loops {
    /// The shares of the difference of two grids by which the limits of work and tension are beyond the finer one, where
    /// surfaces touch once. The order of the work is 0.6 to 1 on bodies with few nodes in contact, the order of the tension
    /// is 1.
    pub beyond: [f64; 2],
    /// The same share where surfaces touch at several places one after the other. Which places touch differs from grid to
    /// grid, too, and half of the difference has the least errors there.
    pub beyond_places: f64,
    /// The share of a limit that these places take in its error, on a grid of at most this number of nodes along the sides.
    pub scatter: f64,
    pub nodes: f64,
    /// The standard errors of the work, in the error of its limit.
    pub standard: f64,
    /// The share of an error that is left on a grid of twice as many nodes along the sides. It comes to a half where
    /// contacts have many nodes, and is nearer to one where they have few; the share of the places falls as that.
    pub left: f64,
}

pub(super) const LOOP: Loops =
    Loops { beyond: [1.35, 1.0], beyond_places: 0.5, scatter: 0.24, nodes: 128.0, standard: 2.0, left: 0.7 };

/// The cost that a solve is expected to have, by the cost on other surfaces.
pub(super) struct Cost {
    /// The numbers of 8 bytes that a solve holds for each node at most, with the numbers of the surface and of its
    /// refinement.
    pub numbers: f64,
    /// The numbers that a path takes besides: its gaps, and the softest mode.
    pub of_path: f64,
    /// The operator applications of a solve, those on coarser grids included.
    pub applications: f64,
    /// The factor by which expected errors may be too large where an accuracy is refused.
    pub doubt: f64,
}

pub(super) const COST: Cost = Cost { numbers: 12.0, of_path: 24.0, applications: 40.0, doubt: 3.0 };

/// Heights between the given nodes that decide the contact: white noise has a ratio of areas on the given grid and on one
/// of twice as many nodes of 1.27 with 268 nodes in contact and of 1.67 with 37, other rough surfaces of at most 1.1, and
/// plateaus with flanks of eight nodes of 1.46 with 137.
pub(super) struct Interpolation {
    /// The ratio beyond which the heights in between decide.
    pub ratio: f64,
    /// What it may have more, over the root of the nodes in contact.
    pub scatter: f64,
}

pub(super) const INTERPOLATION: Interpolation = Interpolation { ratio: 1.35, scatter: 5.0 };
