//! The summary of solves for people, row by row.

use asperity::{Branch, Status};
use asperity_flow::Axis;

use crate::account::{Account, Narrowest, estimate};
use crate::key::{ENERGY_PER_AREA, FORCE, LENGTH, PRESSURE, PRESSURE_PER_LENGTH, Skin, Units, worded};
use crate::numbers::{percent, plain};

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

/// The rows of a summary of solves after a look: the name of each, and its text for each of the solves, in units as far
/// as they are known, and in the words of a skin. A row of which no solve has anything is left out.
pub fn rows(solves: &[&Account], units: &Units, skin: Skin) -> Vec<(String, Vec<String>)> {
    let mut rows = Vec::new();
    let mut row = |name: &str, of: &dyn Fn(&Account) -> Option<String>| {
        let texts: Vec<_> = solves.iter().map(|solve| of(solve)).collect();
        if texts.iter().any(Option::is_some) {
            rows.push((name.to_owned(), texts.into_iter().map(Option::unwrap_or_default).collect()));
        }
    };
    let adhesive = solves.iter().any(|solve| solve.inputs.adhesion.adheres());
    let share = |share: f64| Some(format!("{} %", percent(share)));
    let length = |value: f64| Some(units.number(value, LENGTH));
    let pressure = |value: f64| Some(units.number(value, PRESSURE));
    let energy = |value: f64| Some(units.number(value, ENERGY_PER_AREA));
    let nodes = |(nx, ny): (usize, usize)| format!("{nx} x {ny}");
    let of_branch = |branch: Option<Branch>| branch.map(|branch| branch.to_string());

    row("part of the mirrored map", &|s| {
        let solved = s.inputs.solved_shape.map_or(String::new(), |solved| format!(" of {}", nodes(solved)));
        s.inputs.part.as_ref().map(|part| format!("{part}, {}{solved} nodes", nodes(s.inputs.shape)))
    });
    row("side lengths", &|s| match (s.inputs.shape, s.inputs.lengths) {
        ((_, 1), (lx, _)) => length(lx),
        (_, sides) => Some(units.sides(sides)),
    });
    row("body", &|s| s.inputs.elastic.in_words(units));
    row("contact", &|s| share(s.contact_fraction));
    row("corrected for its edge", &|s| {
        let known = s.corrected_contact_fraction.filter(|share| share.is_finite())?;
        // of rough surfaces with waves down to the nodes, next to grids that are eight times as fine
        let few = match s.inputs.slopes.nodes_per_wave {
            Some(nodes) if nodes < 2.5 => ", some 5 to 12 % too large: its waves have 2 nodes",
            Some(nodes) if nodes < 3.5 => ", some 2 to 4 % too large: its waves have 3 nodes",
            _ => "",
        };
        Some(corrected(known, s.contact_fraction) + few)
    });
    row("by JKR", &|s| share(s.jkr_contact_fraction?));
    row("nodes in contact", &|s| {
        let (nx, ny) = s.inputs.shape;
        Some(format!("{} of {}", s.contact_nodes, nx * ny - s.absent_nodes))
    });
    if let [solve] = solves {
        for patch in solve.patches.iter().flatten() {
            let [area, contact, attractive] =
                [patch.area_fraction, patch.contact_fraction, patch.attractive_fraction].map(percent);
            row(&format!("  where w = {}", units.number(patch.work_of_adhesion, ENERGY_PER_AREA)), &|_| {
                Some(format!("{area} % of the nodes, {contact} % in contact, {attractive} % attracted"))
            });
        }
    }
    row("wanted", &|s| {
        let of = |search: &crate::Search| format!("{} %, after {} solves", percent(search.wanted), search.solves);
        s.search.as_ref().map(of)
    });
    row("mean gap", &|s| length(s.mean_gap));
    row("mean pressure", &|s| pressure(s.mean_pressure));
    row("normal force", &|s| Some(units.number(s.normal_force, FORCE)));
    row("approach", &|s| length(s.approach?));
    row("traction at the edge", &|s| share(s.edge_traction?));
    row("net pressure", &|s| pressure(s.net_pressure));
    row("mean contact pressure", &|s| pressure(s.mean_contact_pressure));
    row("least pressure", &|s| {
        let residue = s.pressure_residue;
        let left = if residue > 0.0 { format!(", to {residue:.0e} of the greatest") } else { String::new() };
        Some(pressure(s.min_pressure?)? + &left)
    });
    row("greatest pressure", &|s| pressure(s.max_pressure?));
    row("elastic energy per area", &|s| energy(s.elastic_energy));
    if adhesive {
        row("adhesive energy per area", &|s| energy(s.adhesive_energy));
        row("range of the grid", &|s| length(s.inputs.adhesion.range.filter(|_| s.peak_traction.is_some())?));
        row("mu_rho", &|s| Some(plain(s.mu_rho)));
    }
    row("yielded", &|s| share(s.plastic_fraction?));
    row("greatest plastic depth", &|s| length(s.plastic_depth_max?));
    row("mean plastic depth", &|s| length(s.plastic_depth_mean?));
    row("plastic work per area", &|s| energy(s.plastic_energy?));
    row("contact stiffness", &|s| {
        let held = if s.peak_traction.is_some() { ", of edges that the nodes hold" } else { "" };
        let error = s.stiffness_error.map(|error| format!(", to {} %", percent(error))).unwrap_or_default();
        Some(format!("{}{held}{error}", units.number(s.contact_stiffness?, PRESSURE_PER_LENGTH)))
    });
    row("conductance per area", &|s| {
        let found = s.conductance?;
        let error = found.relative_error.map(|error| format!(", to {} %", percent(error))).unwrap_or_default();
        Some(format!("{}{error}", units.number(found.value, found.conductors.dimension())))
    });
    for axis in Axis::BOTH {
        let name = |what| format!("{what} along {}", axis.name());
        row(&name("gap"), &|s| Some(Narrowest::in_words(s.constriction?.along(axis).as_ref(), units)));
        row(&name("transmissivity"), &|s| Some(s.transmissivity?.along(axis).in_words(units)));
    }
    if adhesive {
        row("branch", &|s| of_branch(s.branch));
    }
    if let [Account { other_branch: Some(other), .. }] = solves {
        let name = format!("on that of {}", of_branch(other.branch).unwrap_or_default());
        row(&name, &|_| {
            Some(match other.same {
                true => "no second equilibrium found".to_owned(),
                false if other.status != Status::Converged => format!("not found: {}", other.status),
                false => format!(
                    "{} % contact, mean gap {}, {} % away in the energy norm",
                    percent(other.contact_fraction),
                    units.number(other.mean_gap, LENGTH),
                    percent(other.distance)
                ),
            })
        });
    }
    row("certified error", &|s| Some(format!("{:.1e}", s.relative_error)));
    row("stability", &|s| {
        s.stability.map(|s| format!("{}{}", s.verdict, if s.smoothed { ", the law smoothed" } else { "" }))
    });
    row("smallest eigenvalue", &|s| Some(plain(s.stability?.eigenvalue)));
    row("its lower bound", &|s| Some(plain(s.stability?.lower_bound)));
    row("energy drop in leaving", &|s| {
        let left = s.departures.as_ref().filter(|left| !left.is_empty())?;
        energy(left.iter().map(|left| left.energy_drop).sum())
    });
    row("error bound", &|s| Some(s.stability?.error_bound.map_or("none".to_owned(), |bound| format!("{bound:.1e}"))));
    row("iterations", &|s| Some(s.iterations.to_string()));
    row("operator applications", &|s| Some(s.operator_applications.to_string()));
    row("with coarser grids", &|s| Some(format!("{:.1}", s.equivalent_applications?)));
    row("error of the grid", &|s| s.levels.as_ref().map(|_| worded(&estimate(s), skin)));
    row("time", &|s| Some(format!("{:.3} s", s.seconds)));
    row("status", &|s| Some(s.status.to_string()));
    rows
}
