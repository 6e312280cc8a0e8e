//! The summary of a solve for people: a table, and warnings where the answer is not to be trusted.

use asperity::stability::Verdict;
use asperity::{Branch, Status};
use asperity_scene::{Account, Search, Steadiness};

use crate::accuracy;
use crate::heights::sides;
use crate::numbers::{percent, plain};
use crate::part::Part;
use crate::printing::complain;
use crate::printing::{bold, green, yellow};
use crate::quantity::{ENERGY_PER_AREA, FORCE, LENGTH, PRESSURE, PRESSURE_PER_LENGTH};
use crate::units::Units;

/// A table with a column for each of the solves, of which one has adhesion or none.
pub fn table(names: &[&str], solves: &[&Account], adhesive: bool, units: &Units, part: &Part) -> String {
    let mut rows: Vec<(String, Vec<String>)> = Vec::new();
    if !names.is_empty() {
        rows.push((String::new(), names.iter().map(|name| (*name).to_owned()).collect()));
    }
    let mut row = |name: &str, of: &dyn Fn(&Account) -> String| {
        rows.push((name.to_owned(), solves.iter().map(|solve| of(solve)).collect()));
    };
    let share = |found: Option<f64>| found.map_or(String::new(), percent);
    let pressure = |found: Option<f64>| found.map_or(String::new(), |found| units.number(found, PRESSURE));
    let nodes = part.grid().nodes();
    if let Some(name) = part.name() {
        let nodes = |(nx, ny): (usize, usize)| format!("{nx} x {ny}");
        let solved = part.solved().map_or(String::new(), |solved| format!(" of {}", nodes(solved)));
        row("part of the mirrored map", &|_| format!("{name}, {}{solved} nodes", nodes(part.grid().shape())));
    }
    let (lx, ly) = part.grid().lengths();
    row("side lengths", &|_| match part.grid().is_line() {
        true => units.number(lx, LENGTH),
        false => sides((lx, ly), units.of(LENGTH).as_deref()),
    });
    row("contact", &|s| format!("{} %", percent(s.contact_fraction)));
    row("corrected for its edge", &|s| format!("{} %", share(s.corrected_contact_fraction)));
    row("nodes in contact", &|s| format!("{} of {}", s.contact_nodes, nodes - s.absent_nodes));
    if let [solve] = solves {
        for patch in solve.patches.iter().flatten() {
            let [area, contact, attractive] =
                [patch.area_fraction, patch.contact_fraction, patch.attractive_fraction].map(percent);
            let shares = format!("{area} % of the nodes, {contact} % in contact, {attractive} % attracted");
            row(&format!("  where w = {}", units.number(patch.work_of_adhesion, ENERGY_PER_AREA)), &|_| shares.clone());
        }
    }
    if solves.iter().any(|solve| solve.search.is_some()) {
        row("wanted", &|s| {
            let of = |search: &Search| format!("{} %, after {} solves", percent(search.wanted), search.solves);
            s.search.as_ref().map_or(String::new(), of)
        });
    }
    row("mean gap", &|s| units.number(s.mean_gap, LENGTH));
    row("mean pressure", &|s| units.number(s.mean_pressure, PRESSURE));
    row("normal force", &|s| units.number(s.normal_force, FORCE));
    if solves.iter().any(|solve| solve.approach.is_some()) {
        row("approach", &|s| s.approach.map_or(String::new(), |approach| units.number(approach, LENGTH)));
        row("traction at the edge", &|s| {
            s.edge_traction.map_or(String::new(), |share| format!("{} %", percent(share)))
        });
    }
    row("net pressure", &|s| units.number(s.net_pressure, PRESSURE));
    row("mean contact pressure", &|s| units.number(s.mean_contact_pressure, PRESSURE));
    row("least pressure", &|s| pressure(s.min_pressure));
    row("greatest pressure", &|s| pressure(s.max_pressure));
    row("elastic energy per area", &|s| units.number(s.elastic_energy, ENERGY_PER_AREA));
    if adhesive {
        row("adhesive energy per area", &|s| units.number(s.adhesive_energy, ENERGY_PER_AREA));
        row("mu_rho", &|s| plain(s.mu_rho));
    }
    if solves.iter().any(|solve| solve.contact_stiffness.is_some()) {
        row("contact stiffness", &|s| {
            s.contact_stiffness.map_or(String::new(), |found| units.number(found, PRESSURE_PER_LENGTH))
        });
    }
    if adhesive {
        let name = |branch: Option<Branch>| branch.map_or(String::new(), |branch| branch.to_string());
        row("branch", &|s| name(s.branch));
        if let [Account { other_branch: Some(other), .. }] = solves {
            let told = match other.same {
                true => "the same equilibrium".to_owned(),
                false if other.status != Status::Converged => format!("not found: {}", other.status),
                false => format!(
                    "{} % contact, mean gap {}, {} % away in the energy norm",
                    percent(other.contact_fraction),
                    units.number(other.mean_gap, LENGTH),
                    percent(other.distance)
                ),
            };
            row(&format!("on that of {}", name(other.branch)), &|_| told.clone());
        }
    }
    row("certified error", &|s| format!("{:.1e}", s.relative_error));
    if solves.iter().any(|solve| solve.stability.is_some()) {
        let of = |account: &Account, text: &dyn Fn(&Steadiness) -> String| {
            account.stability.as_ref().map_or(String::new(), text)
        };
        row("stability", &|s| {
            of(s, &|s| format!("{}{}", s.verdict, if s.smoothed { ", the law smoothed" } else { "" }))
        });
        row("smallest eigenvalue", &|s| of(s, &|s| plain(s.eigenvalue)));
        row("its lower bound", &|s| of(s, &|s| plain(s.lower_bound)));
        if solves.iter().any(|solve| solve.departures.iter().flatten().next().is_some()) {
            row("energy drop in leaving", &|s| {
                units.number(s.departures.iter().flatten().map(|left| left.energy_drop).sum(), ENERGY_PER_AREA)
            });
        }
        row("error bound", &|s| of(s, &|s| s.error_bound.map_or("none".to_owned(), |bound| format!("{bound:.1e}"))));
    }
    row("iterations", &|s| s.iterations.to_string());
    row("operator applications", &|s| s.operator_applications.to_string());
    if solves.iter().any(|solve| solve.levels.is_some()) {
        row("with coarser grids", &|s| format!("{:.1}", s.equivalent_applications.unwrap_or_default()));
        row("error of the grid", &|s| accuracy::estimate(s));
    }
    row("time", &|s| format!("{:.3} s", s.seconds));
    row("status", &|s| s.status.to_string());

    let length = |text: &str| text.chars().count();
    let first = rows.iter().map(|(name, _)| length(name)).max().unwrap_or(0);
    let widths: Vec<_> =
        (0..solves.len()).map(|k| rows.iter().map(|(_, cells)| length(&cells[k])).max().unwrap_or(0)).collect();
    let line = |(name, cells): &(String, Vec<String>)| {
        let cells = cells.iter().zip(&widths).map(|(cell, &width)| {
            // A single column reads better from the left.
            let cell = if solves.len() == 1 { cell.clone() } else { format!("{cell:>width$}") };
            let cell = match name.as_str() {
                "" => bold(&cell),
                "status" if cell.trim() == Status::Converged.name() => green(&cell),
                "status" => yellow(&cell),
                _ => cell,
            };
            format!("  {cell}")
        });
        format!("{name:first$}{}", cells.collect::<String>())
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Warns of a solve that has not converged, or whose equilibrium is unstable; `name` is that of the case.
pub fn warn(name: &str, account: &Account) {
    let tolerance = account.inputs.tolerance;
    let name = if name.is_empty() { String::new() } else { format!("{name}: ") };
    if account.status != Status::Converged {
        let remedy = match account.status {
            Status::Detached => {
                "no equilibrium under this tension was found from this start: use less tension, hold a --mean-gap and \
                 start from its gap by --initial-gap, or follow the branch by asperity cycle --mean-gaps"
            }
            Status::IterationLimit => "the fields are not accurate: raise --max-iterations",
            _ if account.load_error > tolerance && account.relative_error <= tolerance => {
                "the load is not carried: try another start by --initial-gap, or hold a --mean-gap, or with a free \
                 boundary an --approach"
            }
            _ if account.inputs.precision == "f32" => {
                "this is what f32 can do: use --precision f64, or a larger --tolerance"
            }
            _ => "this is the best to be had: use a larger --tolerance, or another start by --initial-gap",
        };
        let errors = [("error", account.relative_error), ("load error", account.load_error)];
        let missed = errors.iter().filter(|(_, error)| *error > tolerance || error.is_nan());
        let mut missed: Vec<_> = missed.map(|(name, error)| format!("{name} {error:.1e}")).collect();
        if missed.is_empty() {
            missed.push(format!("error {:.1e}", account.relative_error));
        }
        let text = format!(
            "{name}not converged ({}): {} after {} iterations, tolerance {tolerance:e}; {remedy}",
            account.status,
            missed.join(" and "),
            account.iterations
        );
        complain("warning", &text);
    }
    if let Some(search) =
        account.search.as_ref().filter(|search| !search.reached && account.status == Status::Converged)
    {
        complain("warning", &format!("{name}{}", jump(search)));
    }
    if let Some(reached) =
        account.accuracy.as_ref().filter(|reached| !reached.reached && account.status == Status::Converged)
    {
        let text = format!(
            "{name}the accuracy of {} of the {} is not reached: the estimate is {}; {}",
            reached.wanted,
            reached.of,
            accuracy::estimate(account),
            accuracy::reason(reached)
        );
        complain("warning", &text);
    }
    let unstable = account.stability.as_ref().is_some_and(|stability| stability.verdict == Verdict::Unstable);
    if unstable && account.departures.is_none() {
        complain("warning", &format!("{name}the equilibrium is unstable, it would not last: --leave goes on from it"));
    } else if unstable {
        let count = account.departures.as_ref().map_or(0, Vec::len);
        let text = format!("{name}still unstable after {count} departures: try another start by --initial-gap");
        complain("warning", &text);
    }
}

/// The end of a search for a contact fraction that was not reached by a solve that has converged.
pub fn jump(search: &Search) -> String {
    let share = |fraction: Option<f64>| fraction.map_or("nothing".to_owned(), |share| format!("{} %", percent(share)));
    format!(
        "no load was found with {} % contact: it jumps from {} to {}, and the nearer one is written",
        percent(search.wanted),
        share(search.below),
        share(search.above)
    )
}
