//! The contact area of a map or of a solution, and its edge.

use ndarray::{ArrayView1, ArrayView2};

#[cfg(doc)]
use super::ContactStatistics;
use super::outline::{Edge, Outline};
use super::{contact_map, whole};
use crate::error::Result;
use crate::field::ordered;
use crate::grid::Grid;
use crate::real::{Real, once};
use crate::solver::Solution;

once! {
    /// The edge of a contact.
    edge<'a, T>(outline: &'a Outline<'a, T>) -> Edge = Outline::edge;
}

/// The excess area of a contact map per edge, in cells: (π − 1 + ln 2)/24.
const EDGE_EXCESS: f64 = (std::f64::consts::PI - 1.0 + std::f64::consts::LN_2) / 24.0;

/// The process zone at the edge of a contact, by a law that has the range of the grid; fitted to the scenes of
/// `--example jkr`.
struct Zone {
    /// The width by the adhesive energy, in nodes for each side of a cell.
    width: f64,
    /// The energy of the nodes out of contact, in nodes for each side of a cell, from which on the edge is adhesive.
    adhesive: f64,
    /// The most of the area by energy that the zone takes: contacts of a few nodes have no other inside.
    most: f64,
    /// The gap beyond an edge from which it is a step of the surface: in ranges, since a crack opens by less, and in contact
    /// pressure times spacing over E*, since a body without adhesion opens by less.
    step: [f64; 2],
}

const ZONE: Zone = Zone { width: 0.16, adhesive: 0.3, most: 0.5, step: [4.0, 2.0] };

/// The contact area, and its edge; [`ContactStatistics`] says how the area of a solution is corrected.
///
/// ```
/// use asperity::Grid;
/// use asperity::contact::ContactArea;
/// let map = ndarray::array![[true, true, false, false], [false; 4], [false; 4], [false; 4]];
/// let area = ContactArea::of(map.view(), &Grid::square(4, 1.0)?)?;
/// assert_eq!((area.contact_nodes, area.perimeter), (2, 1.5)); // six sides of cells
/// assert!(area.corrected_contact_fraction < area.contact_fraction);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactArea {
    /// The number of nodes in contact.
    pub contact_nodes: usize,
    /// The share of nodes in contact.
    pub contact_fraction: f64,
    /// The contact area within the edge between the nodes, as a share of the nominal area.
    pub corrected_contact_fraction: f64,
    /// The length of the edge, as [`ContactStatistics::perimeter`].
    pub perimeter: f64,
    /// The number of neighbours between which the edge runs.
    pub edges: usize,
    /// The contact area in the theory of Johnson, Kendall and Roberts, as a share of the nominal area, of a solution by
    /// [`Jkr`](crate::Jkr): [`ContactArea::of_solution`].
    pub jkr_contact_fraction: Option<f64>,
    /// The area of the process zone at the edge of the contact, in the area by adhesive energy; zero without adhesion.
    pub process_zone: f64,
    /// How many of the `edges` are at independent places between the nodes; 1 for a strip along the nodes.
    pub places: f64,
}

impl ContactArea {
    /// The contact area of a map of shape (Nx, Ny) on its grid, by Yastrebov, Anciaux and Molinari (2017), *On the
    /// accurate computation of the true contact-area in mechanical contact of random rough surfaces*:
    ///
    /// ```math
    /// A ≈ A_nodes − (π − 1 + ln 2)/24 · S Δx
    /// ```
    ///
    /// with S the perimeter along the cells, averaged over the directions of the edge: 0.118 cells for each side of a
    /// cell on it. For Δx ≠ Δy the area Δx·Δy is taken for Δx²; on a line nothing is corrected.
    /// [`ContactArea::of_solution`] is several times as good.
    ///
    /// # Errors
    /// [`Error::Shape`](crate::Error::Shape) if the map does not have the shape of the grid.
    pub fn of(map: ArrayView2<'_, bool>, grid: &Grid) -> Result<Self> {
        grid.fits("contact map", map.dim())?;
        let (map, grid) = (grid.whole(map), &grid.alone());
        Ok(Self::within(map.view(), grid, true, grid.nodes(), |along| edge_of_map(along, grid)))
    }

    /// The area of a solution, within the edge that its gap and contact pressure tell. Shares are of the nodes that
    /// are not [absent](crate::Surface::with_absent).
    ///
    /// By [`Jkr`](crate::Jkr) the area in the limit of no range is the area by [adhesive
    /// energy](crate::Report::adhesive_contact_fraction) less the process zone at the edge, with S the perimeter along
    /// the cells:
    ///
    /// ```math
    /// A = −E_adh/w − 0.16 S Δx
    /// ```
    ///
    /// At the edge of every contact the stress intensity is √(2E\*w), and the range goes with √(wΔx/E\*), so that the
    /// zone is the same number of nodes wide everywhere. The weaker the adhesion, the less of the zone is out of
    /// contact: below 0.3 nodes for each side of a cell, the area goes over to the corrected area without adhesion in
    /// proportion. Where attraction ends at a step of the surface, as around a flat punch, the process zone is within
    /// the contact: for this share of the edge all nodes within reach count. The page
    /// [`choosing`](crate::guide::choosing) says how right it is.
    ///
    /// # Errors
    /// [`Error::Shape`](crate::Error::Shape) if a field does not have the shape of the grid.
    pub fn of_solution<T: Real>(solution: &Solution<T>) -> Result<Self> {
        let Solution { gap, contact_pressure, grid, report, .. } = solution;
        let (gap, contact_pressure, grid) = &whole(gap.view(), contact_pressure.view(), grid)?;
        let (gap, contact_pressure) = (gap.view(), contact_pressure.view());
        let map = contact_map(gap, contact_pressure);
        let periodic = report.boundary.is_periodic();
        let outline = Outline { gap, contact_pressure, map: map.view(), grid, periodic, modulus: report.modulus };
        let facing = grid.nodes().saturating_sub(report.absent_nodes);
        let area = Self::within_edge(&outline, facing);
        Ok(report.adhesive_contact_fraction.zip(report.range).map_or(area, |(by_energy, range)| {
            let (steps, within) = reach(&outline, range);
            area.in_the_limit(by_energy, grid, facing as f64, (steps, within))
        }))
    }

    /// The area in the limit of no range, from the area by energy, and the share of the edge that is a step of the
    /// surface with the nodes within reach.
    fn in_the_limit(self, by_energy: f64, grid: &Grid, facing: f64, (steps, within): (f64, usize)) -> Self {
        let (dx, dy) = grid.spacing();
        // on a line the perimeter is a number of points
        let cell = if grid.is_line() { grid.largest_spacing() } else { dx * dy };
        let edge = self.perimeter * grid.largest_spacing() / (cell * facing);
        let outside = (by_energy - self.contact_fraction).max(0.0);
        let smooth = (1.0 - steps) * edge;
        let adhesive = if outside > 0.0 { (outside / (ZONE.adhesive * smooth)).min(1.0) } else { 0.0 };
        let zone = |share: f64| (share * ZONE.width * edge).min(ZONE.most * by_energy);
        let elastic = (1.0 - adhesive) * (self.contact_fraction - self.corrected_contact_fraction);
        let within = steps.powi(3) * (within as f64 / facing - by_energy);
        let inside = by_energy - (1.0 - steps) * (zone(adhesive) + elastic) + within;
        let process_zone = zone(adhesive + steps * (1.0 - adhesive));
        Self { jkr_contact_fraction: Some(inside), process_zone, ..self }
    }

    /// The area within the edge of a contact, with the number of nodes that face the half-space.
    pub(super) fn within_edge<'a, T: Real>(outline: &'a Outline<'a, T>, facing: usize) -> Self {
        let &Outline { map, grid, periodic, modulus, .. } = outline;
        let known = modulus.is_finite() && modulus > 0.0;
        let edge = |along| if known { edge(outline) } else { edge_of_map(along, grid) };
        Self::within(map, grid, periodic, facing, edge)
    }

    /// The area on a map, with the number of nodes that face the half-space and an edge by the neighbours along x and
    /// y.
    fn within(
        map: ArrayView2<'_, bool>,
        grid: &Grid,
        periodic: bool,
        facing: usize,
        edge: impl FnOnce((usize, usize)) -> Edge,
    ) -> Self {
        let contact_nodes = map.fold(0, |count, &touches| count + usize::from(touches));
        let (along_x, along_y) = edges(map, periodic);
        let (dx, dy) = grid.spacing();
        let perimeter = if grid.is_line() { along_x as f64 } else { along_x as f64 * dy + along_y as f64 * dx };
        let (nodes, Edge { excess, edges, places }) = (facing as f64, edge((along_x, along_y)));
        let (contact_fraction, corrected_contact_fraction) =
            (contact_nodes as f64 / nodes, (contact_nodes as f64 - excess) / nodes);
        let (jkr_contact_fraction, process_zone) = (None, 0.0);
        Self {
            contact_nodes,
            contact_fraction,
            corrected_contact_fraction,
            perimeter,
            edges,
            jkr_contact_fraction,
            process_zone,
            places,
        }
    }
}

fn edge_of_map((along_x, along_y): (usize, usize), grid: &Grid) -> Edge {
    let edges = along_x + along_y;
    let excess = if grid.is_line() { 0.0 } else { EDGE_EXCESS * edges as f64 };
    Edge { excess, edges, places: edges as f64 }
}

/// The share of the edge of an attraction's reach that is a step of the surface, and the number of nodes within reach.
fn reach<T: Real>(outline: &Outline<'_, T>, range: f64) -> (f64, usize) {
    let Outline { gap, contact_pressure, grid, periodic, modulus, .. } = outline;
    let ((nx, ny), (dx, dy)) = (grid.shape(), grid.spacing());
    let beside = |at: usize, n: usize, ahead: bool| match ahead {
        true if at + 1 < n => Some(at + 1),
        false if at > 0 => Some(at - 1),
        _ => (*periodic).then_some(if ahead { 0 } else { n - 1 }),
    };
    let [ranges, lifts] = ZONE.step;
    let [mut nodes, mut edges, mut steps] = [0; 3];
    for (node, _) in gap.indexed_iter().filter(|(_, gap)| gap.widen() < range) {
        nodes += 1;
        let next = |along_x: bool, ahead: bool| match along_x {
            true => Some((beside(node.0, nx, ahead)?, node.1)),
            false => Some((node.0, beside(node.1, ny, ahead)?)),
        };
        for (along_x, ahead) in [(true, true), (true, false), (false, true), (false, false)] {
            if [ny, nx][usize::from(along_x)] == 1 {
                continue;
            }
            let opening = next(along_x, ahead).map_or(f64::INFINITY, |other| gap[other].widen());
            if opening < range {
                continue;
            }
            let behind = next(along_x, !ahead).unwrap_or(node);
            let pressure = contact_pressure[node].max(contact_pressure[behind]).widen();
            let lift = lifts * pressure * if along_x { dx } else { dy } / modulus;
            edges += 1;
            steps += usize::from(opening > ranges * range + lift);
        }
    }
    (if edges > 0 { steps as f64 / edges as f64 } else { 0.0 }, nodes)
}

/// The pairs of neighbours along x, and along y, with one on the map; across opposite sides if periodic.
fn edges(map: ArrayView2<'_, bool>, periodic: bool) -> (usize, usize) {
    let (mut along_x, mut along_y) = (0, 0);
    let ((nx, ny), nodes) = (map.dim(), ordered(map));
    for i in 0..nx {
        let [row, after] = [i, (i + 1) % nx].map(|row| &nodes[row * ny..][..ny]);
        along_x += differences(row, after);
        along_y += differences(&row[1..], row) + usize::from(row[0] != row[row.len() - 1]);
    }
    if !periodic {
        // across the sides each meets nothing in place of the other
        let both =
            |a: ArrayView1<'_, bool>, b: ArrayView1<'_, bool>| a.iter().zip(b).filter(|&(&a, &b)| a && b).count();
        along_x += both(map.row(0), map.row(nx - 1)) * 2;
        along_y += both(map.column(0), map.column(map.ncols() - 1)) * 2;
    }
    (along_x, along_y)
}

fn differences(a: &[bool], b: &[bool]) -> usize {
    let count = |(a, b): (&[bool], &[bool])| u32::from(a.iter().zip(b).map(|(a, b)| u8::from(a != b)).sum::<u8>());
    // so many that bytes count them, which vector instructions hold most of
    a.chunks(128).zip(b.chunks(128)).map(count).sum::<u32>() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges_of(rows: &[&str], periodic: bool) -> (usize, usize) {
        let map = crate::contact::clusters::tests::map(rows);
        edges(map.view(), periodic)
    }

    #[test]
    fn differences_are_counted_in_rows_of_any_length() {
        for len in [0, 1, 127, 128, 129, 256, 300] {
            let row: Vec<bool> = (0..=len).map(|i| i % 2 == 0).collect();
            assert_eq!(differences(&row[1..], &row), len);
            assert_eq!(differences(&row, &row), 0);
        }
    }

    #[test]
    fn edges_are_counted_across_the_boundaries() {
        let count = |rows: &[&str]| edges_of(rows, true);
        assert_eq!(count(&["....", "....", "...."]), (0, 0));
        assert_eq!(count(&["####", "####", "####"]), (0, 0));
        assert_eq!(count(&["....", ".#..", "...."]), (2, 2));
        // a corner, with its sides on the other end
        assert_eq!(count(&["#...", "....", "...."]), (2, 2));
        // two neighbours across the boundary are one piece, as anywhere else
        assert_eq!(count(&["#...", "....", "#..."]), (2, 4));
        assert_eq!(count(&["#..#", "....", "...."]), (4, 2));
        // a band around the cell has two straight edges
        assert_eq!(count(&["....", "####", "...."]), (8, 0));
        // two nodes along a side are neighbours twice, and a single node is its own neighbour
        assert_eq!(count(&["#...", "...."]), (2, 2));
        assert_eq!(count(&["##..#"]), (0, 2));
    }

    #[test]
    fn beyond_a_free_boundary_nothing_is_in_contact() {
        let count = |rows: &[&str]| edges_of(rows, false);
        assert_eq!(count(&["....", ".#..", "...."]), (2, 2));
        assert_eq!(count(&["#...", "....", "#..."]), (4, 4));
        assert_eq!(count(&["####", "####"]), (8, 4));
    }
}
