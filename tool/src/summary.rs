//! The summary of a solve for people: a table, and warnings where the answer is not to be trusted.

use asperity::stability::Verdict;
use asperity::{Report, Status};

use crate::accuracy::{self, Reached};
use crate::case::{Account, Case, Search, Steadiness};
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
    let mut row = |name: &str, of: &dyn Fn(&Account, &Report) -> String| {
        rows.push((name.to_owned(), solves.iter().map(|solve| of(solve, &solve.report)).collect()));
    };
    if let Some(name) = part.name() {
        let nodes = |(nx, ny): (usize, usize)| format!("{nx} x {ny}");
        let solved = part.solved().map_or(String::new(), |solved| format!(" of {}", nodes(solved)));
        row("part of the mirrored map", &|_, _| format!("{name}, {}{solved} nodes", nodes(part.grid().shape())));
    }
    let (lx, ly) = part.grid().lengths();
    row("side lengths", &|_, _| match part.grid().is_line() {
        true => units.number(lx, LENGTH),
        false => sides((lx, ly), units.of(LENGTH).as_deref()),
    });
    row("contact", &|_, r| format!("{} %", percent(r.contact_fraction)));
    row("corrected for its edge", &|s, _| format!("{} %", percent(s.contact.corrected_contact_fraction)));
    row("nodes in contact", &|s, r| format!("{} of {}", r.contact_nodes, s.nodes - r.absent_nodes));
    if let [solve] = solves {
        for patch in &solve.contact.patches {
            let [area, contact, attractive] =
                [patch.area_fraction, patch.contact_fraction, patch.attractive_fraction].map(percent);
            let shares = format!("{area} % of the nodes, {contact} % in contact, {attractive} % attracted");
            row(&format!("  where w = {}", units.number(patch.work_of_adhesion, ENERGY_PER_AREA)), &|_, _| {
                shares.clone()
            });
        }
    }
    if solves.iter().any(|solve| solve.search.is_some()) {
        row("wanted", &|s, _| {
            let of = |search: &Search| format!("{} %, after {} solves", percent(search.wanted), search.solves);
            s.search.as_ref().map_or(String::new(), of)
        });
    }
    row("mean gap", &|_, r| units.number(r.mean_gap, LENGTH));
    row("mean pressure", &|_, r| units.number(r.mean_pressure, PRESSURE));
    row("normal force", &|_, r| units.number(r.normal_force, FORCE));
    if solves.iter().any(|solve| solve.report.approach.is_some()) {
        row("approach", &|_, r| r.approach.map_or(String::new(), |approach| units.number(approach, LENGTH)));
        row("traction at the edge", &|_, r| {
            r.edge_traction.map_or(String::new(), |share| format!("{} %", percent(share)))
        });
    }
    row("net pressure", &|_, r| units.number(r.net_pressure, PRESSURE));
    row("mean contact pressure", &|_, r| units.number(r.mean_contact_pressure, PRESSURE));
    row("least pressure", &|s, _| units.number(s.pressures.0, PRESSURE));
    row("greatest pressure", &|s, _| units.number(s.pressures.1, PRESSURE));
    row("elastic energy per area", &|_, r| units.number(r.elastic_energy, ENERGY_PER_AREA));
    if adhesive {
        row("adhesive energy per area", &|_, r| units.number(r.adhesive_energy, ENERGY_PER_AREA));
        row("mu_rho", &|_, r| plain(r.mu_rho));
    }
    if solves.iter().any(|solve| solve.stiffness.is_some()) {
        row("contact stiffness", &|s, _| {
            s.stiffness.map_or(String::new(), |found| units.number(found.pressure_per_length, PRESSURE_PER_LENGTH))
        });
    }
    if adhesive {
        let name = |report: &Report| report.branch.map_or(String::new(), |branch| branch.to_string());
        row("branch", &|_, r| name(r));
        if let [Account { other: Some(other), .. }] = solves {
            let r = &other.report;
            let told = match other.same {
                true => "the same equilibrium".to_owned(),
                false if r.status != Status::Converged => format!("not found: {}", r.status),
                false => format!(
                    "{} % contact, mean gap {}, {} % away in the energy norm",
                    percent(r.contact_fraction),
                    units.number(r.mean_gap, LENGTH),
                    percent(other.distance)
                ),
            };
            row(&format!("on that of {}", name(r)), &|_, _| told.clone());
        }
    }
    row("certified error", &|_, r| format!("{:.1e}", r.relative_error));
    if solves.iter().any(|solve| solve.stability.is_some()) {
        let of = |account: &Account, text: &dyn Fn(&Steadiness) -> String| {
            account.stability.as_ref().map_or(String::new(), text)
        };
        row("stability", &|s, _| {
            of(s, &|s| format!("{}{}", s.verdict, if s.smoothed { ", the law smoothed" } else { "" }))
        });
        row("smallest eigenvalue", &|s, _| of(s, &|s| plain(s.eigenvalue)));
        row("its lower bound", &|s, _| of(s, &|s| plain(s.lower_bound)));
        if solves.iter().any(|solve| !solve.departures.is_empty()) {
            row("energy drop in leaving", &|s, _| {
                units.number(s.departures.iter().map(|left| left.energy_drop).sum(), ENERGY_PER_AREA)
            });
        }
        row("error bound", &|s, _| of(s, &|s| s.error_bound.map_or("none".to_owned(), |bound| format!("{bound:.1e}"))));
    }
    row("iterations", &|_, r| r.iterations.to_string());
    row("operator applications", &|_, r| r.operator_applications.to_string());
    if solves.iter().any(|solve| solve.grids.is_some()) {
        let count = |s: &Account| s.grids.as_ref().map_or(0.0, |(_, applications)| *applications);
        row("with coarser grids", &|s, _| format!("{:.1}", count(s)));
    }
    if solves.iter().any(|solve| solve.grids.is_some()) {
        row("error of the grid", &|s, r| {
            let errors = |(levels, _): &(Vec<_>, _)| accuracy::told_errors(levels, r, s.nodes_per_wave);
            let told = || s.grids.as_ref().and_then(errors).unwrap_or_else(|| accuracy::unknown(s.nodes_per_wave));
            s.reached.as_ref().map_or_else(told, Reached::estimate)
        });
    }
    row("time", &|s, _| format!("{:.3} s", s.seconds));
    row("status", &|_, r| r.status.to_string());

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
pub fn warn(name: &str, account: &Account, case: &Case) {
    let (report, tolerance) = (&account.report, account.report.tolerance);
    let name = if name.is_empty() { String::new() } else { format!("{name}: ") };
    if report.status != Status::Converged {
        let remedy = match report.status {
            Status::Detached => {
                "no equilibrium under this tension was found from this start: use less tension, hold a --mean-gap and \
                 start from its gap by --initial-gap, or follow the branch by asperity cycle --mean-gaps"
            }
            Status::IterationLimit => "the fields are not accurate: raise --max-iterations",
            _ if report.load_error > tolerance && report.relative_error <= tolerance => {
                "the load is not carried: try another start by --initial-gap, or hold a --mean-gap, or with a free \
                 boundary an --approach"
            }
            _ if report.precision == "f32" => "this is what f32 can do: use --precision f64, or a larger --tolerance",
            _ => "this is the best to be had: use a larger --tolerance, or another start by --initial-gap",
        };
        let errors = [("error", report.relative_error), ("load error", report.load_error)];
        let missed = errors.iter().filter(|(_, error)| *error > tolerance || error.is_nan());
        let mut missed: Vec<_> = missed.map(|(name, error)| format!("{name} {error:.1e}")).collect();
        if missed.is_empty() {
            missed.push(format!("error {:.1e}", report.relative_error));
        }
        let text = format!(
            "{name}not converged ({}): {} after {} iterations, tolerance {tolerance:e}; {remedy}",
            report.status,
            missed.join(" and "),
            report.iterations
        );
        complain("warning", &text);
    }
    if let Some(search) = account.search.as_ref().filter(|search| !search.reached && report.status == Status::Converged)
    {
        complain("warning", &format!("{name}{}", search.told()));
    }
    if let Some(reached) =
        account.reached.as_ref().filter(|reached| !reached.reached && report.status == Status::Converged)
    {
        let text = format!(
            "{name}the accuracy of {} of the {} is not reached: the estimate is {}; {}",
            reached.accuracy,
            reached.of,
            reached.estimate(),
            reached.reason()
        );
        complain("warning", &text);
    }
    let unstable = account.stability.as_ref().is_some_and(|stability| stability.verdict == Verdict::Unstable);
    if unstable && !case.leave {
        complain("warning", &format!("{name}the equilibrium is unstable, it would not last: --leave goes on from it"));
    } else if unstable {
        let count = account.departures.len();
        let text = format!("{name}still unstable after {count} departures: try another start by --initial-gap");
        complain("warning", &text);
    }
}
