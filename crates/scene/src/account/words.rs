//! The words of a summary, where a row says more than a number.

use asperity::Status;
use asperity_flow::Axis;

use crate::account::{Account, Narrowest};
use crate::key::{ENERGY_PER_AREA, LENGTH, PRESSURE, PRESSURE_PER_LENGTH, Skin, Units};
use crate::numbers::percent;

/// The difference of the counted and the corrected contact area, as a share, from which the contact is one of noise, or
/// of waves that the nodes do not resolve: its pieces are of a few nodes then.
const NOISE: f64 = 0.25;

/// The corrected contact fraction for people, and what it says if it is far from the counted one.
pub fn corrected(corrected: f64, counted: f64) -> String {
    let (apart, share) = ((corrected / counted - 1.0).abs(), percent(corrected));
    match apart > NOISE {
        true => format!("{share} %, {} % apart: noise, or waves finer than the nodes", percent(apart)),
        false => format!("{share} %"),
    }
}

/// The numbers of nodes along the sides.
fn nodes((nx, ny): (usize, usize)) -> String {
    format!("{nx} x {ny}")
}

pub(super) fn part(solve: &Account, _: &Units, _: Skin) -> Option<String> {
    let solved = solve.inputs.solved_shape.map_or(String::new(), |solved| format!(" of {}", nodes(solved)));
    solve.inputs.part.as_ref().map(|part| format!("{part}, {}{solved} nodes", nodes(solve.inputs.shape)))
}

pub(super) fn sides(solve: &Account, units: &Units, _: Skin) -> Option<String> {
    Some(match (solve.inputs.shape, solve.inputs.lengths) {
        ((_, 1), (lx, _)) => units.number(lx, LENGTH),
        (_, sides) => units.sides(sides),
    })
}

pub(super) fn corrected_area(solve: &Account, _: &Units, _: Skin) -> Option<String> {
    let known = Some(solve.corrected_contact_fraction).filter(|share| share.is_finite())?;
    // of rough surfaces with waves down to the nodes, next to grids that are eight times as fine
    let few = match solve.inputs.slopes.nodes_per_wave {
        Some(nodes) if nodes < 2.5 => ", some 5 to 12 % too large: its waves have 2 nodes",
        Some(nodes) if nodes < 3.5 => ", some 2 to 4 % too large: its waves have 3 nodes",
        _ => "",
    };
    Some(corrected(known, solve.contact_fraction) + few)
}

pub(super) fn nodes_in_contact(solve: &Account, _: &Units, _: Skin) -> Option<String> {
    let (nx, ny) = solve.inputs.shape;
    Some(format!("{} of {}", solve.contact_nodes, nx * ny - solve.absent_nodes))
}

pub(super) fn patches(solve: &Account, units: &Units) -> Vec<(String, String)> {
    let patches = solve.patches.iter().flatten().map(|patch| {
        let [area, contact, attractive] =
            [patch.area_fraction, patch.contact_fraction, patch.attractive_fraction].map(percent);
        let name = format!("  where w = {}", units.number(patch.work_of_adhesion, ENERGY_PER_AREA));
        (name, format!("{area} % of the nodes, {contact} % in contact, {attractive} % attracted"))
    });
    patches.collect()
}

pub(super) fn wanted(solve: &Account, _: &Units, _: Skin) -> Option<String> {
    let search = solve.search?;
    Some(format!("{} %, after {} solves", percent(search.wanted), search.solves))
}

pub(super) fn range_of_the_grid(solve: &Account, units: &Units, _: Skin) -> Option<String> {
    solve.peak_traction?;
    Some(units.number(solve.inputs.adhesion.range?, LENGTH))
}

pub(super) fn least_pressure(solve: &Account, units: &Units, _: Skin) -> Option<String> {
    let residue = solve.pressure_residue;
    let left = if residue > 0.0 { format!(", to {residue:.0e} of the greatest") } else { String::new() };
    Some(solve.min_pressure).filter(|least| least.is_finite()).map(|least| units.number(least, PRESSURE) + &left)
}

pub(super) fn stiffness(solve: &Account, units: &Units, _: Skin) -> Option<String> {
    let held = if solve.peak_traction.is_some() { ", of edges that the nodes hold" } else { "" };
    let error = solve.stiffness_error.map(|error| format!(", to {} %", percent(error))).unwrap_or_default();
    Some(format!("{}{held}{error}", units.number(solve.contact_stiffness?, PRESSURE_PER_LENGTH)))
}

pub(super) fn conductance(solve: &Account, units: &Units, _: Skin) -> Option<String> {
    let found = solve.conductance?;
    let error = found.relative_error.map(|error| format!(", to {} %", percent(error))).unwrap_or_default();
    Some(format!("{}{error}", units.number(found.value, found.conductors.dimension())))
}

pub(super) fn narrowest(solve: &Account, axis: Axis, units: &Units) -> Option<String> {
    Some(Narrowest::in_words(solve.constriction?.along(axis).as_ref(), units))
}

pub(super) fn transmissivity(solve: &Account, axis: Axis, units: &Units) -> Option<String> {
    Some(solve.transmissivity?.along(axis).in_words(units))
}

pub(super) fn other_branch(solve: &Account, units: &Units) -> Vec<(String, String)> {
    let Some(other) = &solve.other_branch else { return Vec::new() };
    let name = format!("on that of {}", other.branch.map_or(String::new(), |branch| branch.to_string()));
    let text = match other.same {
        true => "no second equilibrium found".to_owned(),
        false if other.status != Status::Converged => format!("not found: {}", other.status),
        false => format!(
            "{} % contact, mean gap {}, {} % away in the energy norm",
            percent(other.contact_fraction),
            units.number(other.mean_gap, LENGTH),
            percent(other.distance)
        ),
    };
    vec![(name, text)]
}

pub(super) fn stability(solve: &Account, _: &Units, _: Skin) -> Option<String> {
    let found = solve.stability?;
    Some(format!("{}{}", found.verdict, if found.smoothed { ", the law smoothed" } else { "" }))
}

pub(super) fn error_bound(solve: &Account, _: &Units, _: Skin) -> Option<String> {
    Some(solve.stability?.error_bound.map_or("none".to_owned(), |bound| format!("{bound:.1e}")))
}

pub(super) fn energy_drop(solve: &Account, units: &Units, _: Skin) -> Option<String> {
    let left = solve.departures.as_ref().filter(|left| !left.is_empty())?;
    Some(units.number(left.iter().map(|left| left.energy_drop).sum(), ENERGY_PER_AREA))
}
