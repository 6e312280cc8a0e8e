//! The warnings about heights: tilt, edges, slopes, spikes, codes of missing points, and cells.

use asperity::{Grid, Surface};
use ndarray::Array2;

use super::part::Part::{Figure, Length, Pressure, Word};
use super::relief::{Relief, Side};
use super::spikes::Spikes;
use super::{Warning, WarningCode};

/// The drop of a plane across the map, in rms heights about the plane, from which there is a tilt: at a few per cent
/// of contact, some two rms heights above the mean, a fifth gives one side of Gaussian heights half as much contact
/// again as the other.
const TILT: f64 = 0.2;

/// The least difference of mean height across the periodic edge, as a share of the drop of the plane. The share is 1
/// on a tilted map, and 0 on a long wave, which also has a plane in it.
const TILT_AT_EDGE: f64 = 0.5;

/// The difference of mean height across the periodic edge from which a tilt stands out, in the greatest difference
/// between the means of neighbouring rows (columns): one of these exceeds the others on every surface, but not by a
/// factor of 3.
const TILT_STANDS_OUT: f64 = 3.0;

/// The rms step across the periodic edge, in rms steps between neighbouring rows (columns) inside, from which edges
/// do not meet: on a periodic surface the edge is a place like any other, and the mean over many nodes along it
/// scatters little.
const OPEN_EDGE: f64 = 3.0;

/// The same on a line, where the edge is one step alone; the step of Gaussian heights stays below 6.
const OPEN_END: f64 = 6.0;

/// The rms step across the periodic edge from which it stands out, in the greatest rms step inside: a surface of
/// steps, as a grating, may have one at the edge, but has equal steps inside.
const STANDS_OUT: f64 = 1.5;

/// The fall of mean height to an edge, in the greatest difference between the means of neighbouring rows (columns),
/// from which heights fall to the edge: a sphere is steepest there, and a wave or an asperity within the map flat.
const FALLS: f64 = 0.5;

/// The bend of mean height across the periodic edge, in the greatest one inside, from which the edge is a crease. The
/// bends of a mirrored map are as great along its mirror lines inside. The bend of a sphere goes with the number of
/// nodes, and is 7 on 16; the bend of a cone, which has an apex inside, is 4 on 32.
const CREASE: f64 = 4.0;

/// The contact modulus in Pa below which lengths in metres have another unit of pressure next to them: soft gels.
const SOFTEST: f64 = 1e3;

/// The spacing of nodes below which lengths are in metres: in millimetres it would be less than an atom.
const METRES: f64 = 1e-7;

/// The rms slope below which heights and lengths are in different units: the best mirrors have some 5e-8, and heights
/// in metres next to lengths in nanometres 1e-9 at most.
const SMOOTH: f64 = 1e-8;

/// The share of the points of a map that may be spikes, above which they are features of its surface.
const MANY_SPIKES: f64 = 0.01;

/// The aspect ratio of cells from which they are far from square: the longer side then resolves half as much, and
/// side lengths may have been forgotten.
const CELLS: f64 = 2.0;

pub(super) fn cells(grid: &Grid) -> Option<Warning> {
    let ((nx, ny), (dx, dy)) = (grid.shape(), grid.spacing());
    let aspect = (dx / dy).max(dy / dx);
    if nx == 1 || ny == 1 || aspect <= CELLS {
        return None;
    }
    Some(Warning::new(
        WarningCode::Cells,
        aspect,
        "cells are {} by {}, {} times as long as wide: check the side lengths",
        [Length(dx), Length(dy), Figure(aspect)],
    ))
}

pub(super) fn missing_code(value: f64, count: usize) -> Warning {
    // all digits, as the remedy needs them
    let value = if (1e-3..1e9).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") };
    let nodes = format!("{count} {}", if count == 1 { "node" } else { "nodes" });
    Warning::new(
        WarningCode::MissingCode,
        count as f64,
        "{} stands at {}: use prepare --missing {} --fill",
        [Word(value.clone()), Word(nodes), Word(value)],
    )
}

pub(super) fn tilt(relief: &Relief, grid: &Grid) -> Option<Warning> {
    let tilted = |side: &Side| {
        let drop = side.drop.abs();
        let missed = -side.drop.signum() * side.mean_edge;
        let stands_out = missed > TILT_STANDS_OUT * side.greatest_mean_step;
        side.tells() && drop > TILT * relief.rms && missed > TILT_AT_EDGE * drop && stands_out
    };
    if !relief.sides.iter().any(tilted) {
        return None;
    }
    let (lx, ly) = grid.lengths();
    let [x, y] = [&relief.sides[0], &relief.sides[1]].map(|side| side.drop * relief.unit);
    let times = (x.abs() + y.abs()) / (relief.rms * relief.unit);
    Some(Warning::new(
        WarningCode::Tilt,
        times,
        "the map is tilted by {} along x, {} along y: remove a plane",
        [Figure(x / lx), Figure(y / ly)],
    ))
}

pub(super) fn open_edges(relief: &Relief) -> Option<Warning> {
    let (nx, ny) = relief.heights.dim();
    let factor = if nx.min(ny) == 1 { OPEN_END } else { OPEN_EDGE };
    let stands_out = |side: &Side| side.edge > STANDS_OUT * side.greatest_step;
    let open = |side: &Side| side.tells() && side.edge > factor * side.rms_step && stands_out(side);
    let (sides, axes): (Vec<_>, Vec<_>) = relief.sides.iter().zip(["x", "y"]).filter(|(side, _)| open(side)).unzip();
    let worst = sides.iter().map(|side| side.edge / side.rms_step).reduce(f64::max)?;
    let step = sides.iter().map(|side| side.edge * relief.unit).fold(0.0, f64::max);
    let text = "opposite edges do not meet along {}, by {} rms: mirror the map";
    Some(Warning::new(WarningCode::OpenEdges, worst, text, [Word(axes.join(" and ")), Length(step)]))
}

/// The greatest height along the edges, without absent nodes; −∞ if all are absent.
fn highest_at_edges(surface: &Surface, heights: &Array2<f64>) -> f64 {
    let (nx, ny) = heights.dim();
    let rows = [0, nx - 1].into_iter().flat_map(|i| (0..ny).map(move |j| (i, j)));
    let edges = rows.chain((0..nx).flat_map(|i| [(i, 0), (i, ny - 1)]));
    let present = edges.filter(|&node| surface.absent().is_none_or(|absent| !absent[node]));
    present.map(|node| heights[node]).fold(f64::NEG_INFINITY, f64::max)
}

/// A body that ends before the edges.
pub(super) fn ends_within(surface: &Surface) -> Option<Warning> {
    let text = "no surface along the edges: use a free boundary, except for an array of pillars";
    let ends = surface.absent().is_some() && highest_at_edges(surface, surface.heights()) == f64::NEG_INFINITY;
    ends.then(|| Warning::new(WarningCode::Ends, 0.0, text, []))
}

/// A body that falls to the edges, which are creases between it and its images.
pub(super) fn ends_at_edges(relief: &Relief, surface: &Surface) -> Option<Warning> {
    let falls = |side: &Side| {
        let crease = side.falls.iter().sum::<f64>() > CREASE * side.greatest_bend;
        side.tells() && crease && side.falls.iter().all(|fall| *fall > FALLS * side.greatest_mean_step)
    };
    let below = relief.mean - highest_at_edges(surface, &relief.heights);
    if !relief.sides.iter().all(falls) || below <= 0.0 {
        return None;
    }
    let text = "the heights fall to all edges, by {} or more: use a free boundary";
    Some(Warning::new(WarningCode::Ends, 0.0, text, [Length(below * relief.unit)]))
}

impl Warning {
    /// A contact `modulus` E* that is probably in another unit than the lengths of the `grid` ask for,
    /// [`Modulus`](WarningCode::Modulus): below 1 kPa with lengths in metres. Lengths are in metres if their `unit` is
    /// m, or without a unit if the nodes are less than 1e-7 apart. E* = 1 has no warning, as it makes all pressures
    /// relative.
    ///
    /// ```
    /// use asperity_maps::warning::{Warning, WarningCode};
    /// use asperity::Grid;
    /// let grid = Grid::square(512, 10e-6)?;
    /// assert_eq!(Warning::of_modulus(70.0, &grid, Some("m")).map(|found| found.code), Some(WarningCode::Modulus));
    /// assert!(Warning::of_modulus(70e9, &grid, Some("m")).is_none());
    /// assert!(Warning::of_modulus(70.0, &Grid::square(512, 10.0)?, Some("µm")).is_none());
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn of_modulus(modulus: f64, grid: &Grid, unit: Option<&str>) -> Option<Self> {
        let spacing = grid.spacing().0.min(grid.spacing().1);
        let in_metres = unit.map_or(spacing < METRES, |unit| unit == "m");
        if modulus == 1.0 || modulus >= SOFTEST || !in_metres {
            return None;
        }
        Some(Self::new(
            WarningCode::Modulus,
            0.0,
            "the contact modulus is {}, below {} Pa: give it in Pa, since lengths are in m",
            [Pressure(modulus), Word(format!("{SOFTEST:e}"))],
        ))
    }
}

/// The probable mistake behind an rms slope, if a slope of more than `most` is steep.
pub(super) fn slope(slope: f64, most: f64) -> Option<Warning> {
    let (code, than, severity) = match slope {
        _ if slope > most => (WarningCode::Steep, format!("more than {most}"), slope),
        _ if slope > 0.0 && slope < SMOOTH => (WarningCode::Smooth, format!("less than {SMOOTH:e}"), slope.recip()),
        _ => return None,
    };
    let text = "the rms slope by differences is {}, {}: check the units";
    Some(Warning::new(code, severity, text, [Figure(slope), Word(than)]))
}

pub(super) fn spikes(relief: &Relief) -> Option<Warning> {
    let Spikes { count, farthest, node: (i, j) } = Spikes::find(relief)?;
    let nodes = format!("{count} single {}", if count == 1 { "node stands" } else { "nodes stand" });
    let (times, node) = (farthest / relief.rms, format!("[{i}, {j}]"));
    Some(Warning::new(
        WarningCode::Spikes,
        times,
        "{} out, by up to {}, at {}: use despike",
        [Word(nodes), Length(farthest * relief.unit), Word(node)],
    ))
}

impl Warning {
    /// The probable mistake behind many spikes among the points of a map: they are its roughness.
    ///
    /// ```
    /// use asperity_maps::warning::Warning;
    /// assert!(Warning::of_despiked(10, 1000).is_none());
    /// let warning = Warning::of_despiked(11, 1000).unwrap().to_string();
    /// assert!(warning.contains("1.1 % of the points"));
    /// ```
    pub fn of_despiked(spikes: usize, points: usize) -> Option<Self> {
        let share = spikes as f64 / points as f64;
        (share > MANY_SPIKES).then(|| {
            let text = "{} % of the points are spikes, more than {} %: raise the threshold of despike";
            Self::new(WarningCode::Spikes, share, text, [Figure(100.0 * share), Figure(100.0 * MANY_SPIKES)])
        })
    }
}
