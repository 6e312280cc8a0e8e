//! The contact of a solve in tables: distributions of gap and pressure, the autocorrelation of the pressure, and spots.

use asperity::contact::Clusters;
use asperity::{Error, Grid, Result, Surface};
use ndarray::{Array2, ArrayView2, Zip};
use serde::{Deserialize, Serialize};

use crate::key::{Boundary, LENGTH, PRESSURE, Units, record};

/// The bins of a distribution in a decade, and the most decades.
const PER_DECADE: usize = 8;
const DECADES: usize = 9;
/// The share of the nodes at the edge with values below the window of an exponent: the grid makes their distribution
/// uniform.
const AT_EDGE: f64 = 0.99;
/// The windows of the exponents, a ratio of values; and the least share of the median that must remain beyond them.
const GAP_WINDOW: f64 = 10.0;
const PRESSURE_WINDOW: f64 = 4.0;
const BELOW_MEDIAN: f64 = 0.5;
/// The least number of nodes in a window, and at a point of a curve, where these are not more than a share of all.
const LEAST_NODES: usize = 100;
const ENOUGH: f64 = 0.02;

/// The contact of a solve in tables.
#[derive(Clone, Debug)]
pub struct ContactTables {
    /// The distribution of the gap, where it is open.
    pub gap: Density,
    /// The distribution of the contact pressure, where there is one.
    pub pressure: Density,
    /// The autocorrelation of the contact pressure about its mean, over the variance, by the distance: averaged over
    /// directions. Empty without a pressure, and where opposite sides do not meet.
    pub autocorrelation: Vec<(f64, f64)>,
    /// The spots of contact, the largest first.
    pub spots: Vec<Spot>,
    /// The mean contact pressure.
    pub mean_contact_pressure: f64,
}

/// The probability density of a quantity over the nodes, in bins that are equally wide in its logarithm.
#[derive(Clone, Debug, PartialEq)]
pub struct Density {
    /// The edges of the bins: one more than there are bins.
    pub edges: Vec<f64>,
    /// The density in each bin: its share of the nodes, absent ones not counted, over its width.
    pub density: Vec<f64>,
    /// The power of the quantity as which its density grows where it is small; none where the nodes do not tell.
    pub exponent: Option<Exponent>,
}

/// An exponent of a density, by the most likely power law of the nodes in a window.
///
/// The window begins above the values of nodes at the edge of the contact, as the grid makes their density uniform:
/// along an edge in the continuum g ∝ x^(3/2) and λ ∝ x^(1/2) at a distance x, and from P dx uniform P(g) ∝ g^(−1/3)
/// and P(λ) ∝ λ follow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Exponent {
    /// The exponent.
    pub exponent: f64,
    /// The lower end of the window.
    pub from: f64,
    /// The upper end.
    pub to: f64,
    /// The nodes in the window.
    pub nodes: usize,
}

/// A spot: a cluster of contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spot {
    /// The number of nodes.
    pub nodes: usize,
    /// The area of their cells, on a line a length.
    pub area: f64,
    /// The length of the edge along the sides of the cells, on a line the number of ends.
    pub perimeter: f64,
    /// The force that it carries, on a line a force per length.
    pub force: f64,
}

record! {
    /// The figures of the tables, as a report has them.
    #[derive(Clone, Debug, Serialize, Deserialize)]
    ContactFigures of (tables: &ContactTables) {
        /// The number of spots.
        clusters: usize = tables.spots.len(),
        /// The nodes of the largest one.
        largest_cluster: usize = tables.spots.first().map_or(0, |spot| spot.nodes),
        /// The length of all edges.
        perimeter: f64 = tables.spots.iter().map(|spot| spot.perimeter).sum(),
        /// The mean contact pressure.
        mean_contact_pressure: f64 = tables.mean_contact_pressure,
        /// The exponent of the distribution of small gaps.
        gap_exponent: Option<Exponent> = tables.gap.exponent,
        /// The exponent of the distribution of small contact pressures.
        pressure_exponent: Option<Exponent> = tables.pressure.exponent,
        /// The distance at which the autocorrelation of the pressure has fallen to a half.
        correlation_length: Option<f64> = tables.correlation_length(),
    }
}

impl ContactTables {
    /// The tables of a gap, infinite at absent nodes, and a contact pressure on their grid: on all of a surface, or on
    /// the original of a mirrored surface: its sides are no edges of the contact.
    ///
    /// # Errors
    /// [`Error::Shape`] if a field is not on the grid.
    pub fn measure(
        gap: ArrayView2<'_, f64>,
        contact_pressure: ArrayView2<'_, f64>,
        grid: Grid,
        boundary: Boundary,
        is_original: bool,
    ) -> Result<Self> {
        Error::shape("gap", gap.dim(), grid.shape())?;
        Error::shape("contact pressure", contact_pressure.dim(), grid.shape())?;
        let meets = boundary == Boundary::Periodic && !is_original;
        let contact = Zip::from(gap).and(contact_pressure).map_collect(|gap, pressure| *gap <= 0.0 || *pressure > 0.0);
        let facing = gap.iter().filter(|gap| gap.is_finite()).count();
        let edge = Zip::indexed(&contact).map_collect(|node, own| {
            neighbours(node, grid, meets).any(|(other, _)| contact[other] != *own && gap[other].is_finite())
        });
        let values = |field: ArrayView2<'_, f64>| {
            let all = field.iter().zip(&edge).map(|(value, edge)| (*value, *edge));
            all.filter(|(value, _)| *value > 0.0 && value.is_finite()).collect::<Vec<_>>()
        };
        let autocorrelation = if meets { autocorrelation(contact_pressure, grid)? } else { Vec::new() };
        Ok(Self {
            gap: Density::measure(values(gap), facing, GAP_WINDOW),
            pressure: Density::measure(values(contact_pressure), facing, PRESSURE_WINDOW),
            autocorrelation,
            spots: spots(&contact, contact_pressure, grid, (meets, !meets && !is_original)),
            mean_contact_pressure: contact_pressure.sum() / facing.max(1) as f64,
        })
    }

    /// The figures of the tables.
    pub fn figures(&self) -> ContactFigures {
        ContactFigures::record(self)
    }

    /// The distance at which the autocorrelation of the pressure has fallen to a half.
    fn correlation_length(&self) -> Option<f64> {
        let [before, behind] = *self.autocorrelation.windows(2).find(|two| two[1].1 < 0.5)? else { return None };
        let share = (before.1 - 0.5) / (before.1 - behind.1);
        Some(before.0 + share * (behind.0 - before.0))
    }
}

impl ContactFigures {
    /// The rows of a summary.
    pub fn rows(&self, units: &Units) -> Vec<(String, String)> {
        let exponent = |found: Option<Exponent>, dimension| match found {
            Some(Exponent { exponent, from, to, nodes }) => {
                let [from, to] = [from, to].map(|value| units.number(value, dimension));
                format!("{exponent:.3}, from {from} to {to}, {nodes} nodes")
            }
            None => "not determined: the nodes do not come close enough to the edge of the contact".to_owned(),
        };
        let mut rows = vec![
            ("clusters of contact", self.clusters.to_string()),
            ("nodes of the largest", self.largest_cluster.to_string()),
            ("mean contact pressure", units.number(self.mean_contact_pressure, PRESSURE)),
            ("exponent of small gaps", exponent(self.gap_exponent, LENGTH)),
            ("exponent of small pressures", exponent(self.pressure_exponent, PRESSURE)),
        ];
        rows.extend(self.correlation_length.map(|length| ("correlation length", units.number(length, LENGTH))));
        rows.into_iter().map(|(name, text)| (name.to_owned(), text)).collect()
    }
}

impl Density {
    /// The density of values, each with whether its node is at the edge, among as many nodes.
    fn measure(values: Vec<(f64, bool)>, nodes: usize, window: f64) -> Self {
        let (least, greatest) =
            values.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), (value, _)| (low.min(*value), high.max(*value)));
        let exponent = Exponent::find(&values, window);
        if values.is_empty() {
            return Self { edges: Vec::new(), density: Vec::new(), exponent };
        }
        let place = |value: f64| (greatest / value).log10() * PER_DECADE as f64;
        // the ratio to the least one may be infinite
        let bins = (place(least).floor() as usize).saturating_add(1).min(DECADES * PER_DECADE);
        let edge = |k: usize| greatest * 10f64.powf(-(k as f64) / PER_DECADE as f64);
        let edges: Vec<f64> = (0..=bins).rev().map(edge).collect();
        let mut counts = vec![0_usize; bins];
        for (value, _) in values {
            // the greatest one may be beyond the last edge by rounding
            if let Some(count) = counts.get_mut(place(value).max(0.0) as usize) {
                *count += 1;
            }
        }
        let widths = edges.windows(2).map(|two| two[1] - two[0]);
        let density = counts.iter().rev().zip(widths).map(|(count, width)| *count as f64 / nodes as f64 / width);
        Self { density: density.collect(), edges, exponent }
    }

    /// The densities for a curve, each at the middle of its bin in the logarithm, on a map of as many nodes. Bins of few
    /// values are joined to the next ones below, as their densities are noise.
    pub fn points(&self, nodes: usize) -> Vec<(f64, f64)> {
        let bins = self.edges.windows(2).zip(&self.density);
        let values = |two: &[f64], density: f64| nodes as f64 * density * (two[1] - two[0]);
        let all: f64 = bins.clone().map(|(two, density)| values(two, *density)).sum();
        let enough = (ENOUGH * all).clamp(1.0, LEAST_NODES as f64) * (1.0 - 1e-9);
        let (mut points, mut to, mut count) = (Vec::new(), None, 0.0);
        for (two, density) in bins.rev() {
            let to_edge = *to.get_or_insert(two[1]);
            count += values(two, *density);
            if count >= enough {
                points.push(((two[0] * to_edge).sqrt(), count / nodes as f64 / (to_edge - two[0])));
                (to, count) = (None, 0.0);
            }
        }
        points.reverse();
        points
    }
}

impl Exponent {
    /// The exponent of values above those at the edge, in a window of a ratio.
    fn find(values: &[(f64, bool)], window: f64) -> Option<Self> {
        let mut at_edge: Vec<_> = values.iter().filter(|(_, edge)| *edge).map(|(value, _)| *value).collect();
        let mut all: Vec<_> = values.iter().map(|(value, _)| *value).collect();
        let from = quantile(&mut at_edge, AT_EDGE)?;
        let to = window * from;
        if to > BELOW_MEDIAN * quantile(&mut all, 0.5)? {
            return None;
        }
        let logarithms = all.iter().filter(|value| (from..to).contains(*value)).map(|value| (value / from).ln());
        let (nodes, sum) = logarithms.fold((0, 0.0), |(nodes, sum), logarithm| (nodes + 1, sum + logarithm));
        let exponent = most_likely(sum / nodes as f64, window.ln()) - 1.0;
        (nodes >= LEAST_NODES).then_some(Self { exponent, from, to, nodes })
    }
}

/// A quantile of numbers, which it reorders; none of none.
fn quantile(values: &mut [f64], share: f64) -> Option<f64> {
    let at = (share * values.len().checked_sub(1)? as f64).round() as usize;
    Some(*values.select_nth_unstable_by(at, f64::total_cmp).1)
}

/// The rate t at which e^(t y), for y from 0 to a width, has a given mean of y: the root of w/(1 − e^(−t w)) − 1/t =
/// mean, which grows with t.
fn most_likely(mean: f64, width: f64) -> f64 {
    let of = |rate: f64| match rate * width {
        product if product.abs() < 1e-4 => width * (0.5 + product / 12.0),
        product => -width / (-product).exp_m1() - rate.recip(),
    };
    let (mut low, mut high) = (-1e3 / width, 1e3 / width);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if of(middle) < mean { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The neighbours of a node, by cells that share a side, and the lengths of these sides.
fn neighbours((i, j): (usize, usize), grid: Grid, meets: bool) -> impl Iterator<Item = ((usize, usize), f64)> {
    let ((nx, ny), (dx, dy)) = (grid.shape(), grid.spacing());
    let along = move |at: usize, count: usize| {
        let back = if at > 0 { Some(at - 1) } else { (meets && count > 1).then_some(count - 1) };
        let next = if at + 1 < count { Some(at + 1) } else { (meets && count > 1).then_some(0) };
        [back, next].into_iter().flatten()
    };
    let side = if grid.is_line() { 1.0 } else { dy };
    along(i, nx).map(move |i| ((i, j), side)).chain(along(j, ny).map(move |j| ((i, j), dx)))
}

/// The length of the sides of a cell beyond which nothing is.
fn outer_sides((i, j): (usize, usize), grid: Grid) -> f64 {
    let ((nx, ny), (dx, dy)) = (grid.shape(), grid.spacing());
    let ends = |at: usize, count: usize| f64::from(u8::from(at == 0) + u8::from(at + 1 == count));
    if grid.is_line() { ends(i, nx) } else { ends(i, nx) * dy + ends(j, ny) * dx }
}

/// The autocorrelation of a pressure about its mean, over the variance.
fn autocorrelation(pressure: ArrayView2<'_, f64>, grid: Grid) -> Result<Vec<(f64, f64)>> {
    let found = Surface::new(grid, pressure.to_owned())?.spectrum().radial_autocorrelation();
    let variance = found.first().map_or(0.0, |(_, variance)| *variance);
    Ok(if variance > 0.0 {
        found.into_iter().map(|(lag, value)| (lag, value / variance)).collect()
    } else {
        Vec::new()
    })
}

/// The spots of contact.
fn spots(contact: &Array2<bool>, pressure: ArrayView2<'_, f64>, grid: Grid, (meets, ends): (bool, bool)) -> Vec<Spot> {
    let Clusters { sizes, labels, .. } =
        if meets { Clusters::of(contact.view()) } else { Clusters::of_part(contact.view()) };
    let (dx, dy) = grid.spacing();
    let cell = if grid.is_line() { dx } else { dx * dy };
    let mut spots: Vec<_> =
        sizes.into_iter().map(|nodes| Spot { nodes, area: nodes as f64 * cell, perimeter: 0.0, force: 0.0 }).collect();
    for (node, label) in labels.indexed_iter() {
        let Some(spot) = label.checked_sub(1).and_then(|spot| spots.get_mut(spot)) else { continue };
        spot.force += pressure[node] * cell;
        let inside = neighbours(node, grid, meets).filter(|(other, _)| !contact[*other]).map(|(_, side)| side);
        spot.perimeter += inside.sum::<f64>() + if ends { outer_sides(node, grid) } else { 0.0 };
    }
    spots
}
