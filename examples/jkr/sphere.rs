//! A sphere on a free half-space, next to the theory of Johnson, Kendall and Roberts.

use std::f64::consts::PI;

use asperity::exact::{self, Contact, Sphere};
use asperity::path::{Event, Path, PathSettings};
use asperity::stability::ContactStiffness;
use asperity::{AdhesionLaw, Boussinesq, Branch, Control, Grid, Jkr, Problem, Result, Surface};
use common::Outcome;

use crate::case::{Areas, extrapolated, head, pull_off, row, secant, solve, solver, tension};

const RADIUS: f64 = 1.0;
pub const WORK: f64 = 2e-3;
pub const SIDE: f64 = 1.6;
/// The relative width of the bracket of the pull-off.
const BRACKET: f64 = 0.002;

/// The sphere on a window of n² nodes.
pub fn problem(n: usize, law: impl AdhesionLaw<f64> + 'static) -> Result<Problem<f64>> {
    let grid = Grid::square(n, SIDE)?;
    Problem::new(&Surface::paraboloid(grid, RADIUS)?, Boussinesq::new(grid, 1.0)?, law)
}

/// The sphere of Johnson, Kendall and Roberts.
pub fn exact() -> Result<exact::Jkr> {
    exact::Jkr::new(RADIUS, 1.0, WORK)
}

/// The radius of a share of the window.
fn radius(share: f64) -> f64 {
    SIDE * (share / PI).sqrt()
}

/// The contact at which it is lost under a given approach, of the load −(5/6)πwR.
fn lost_at_approach() -> Result<Contact> {
    exact()?.at_contact_radius((PI * WORK * RADIUS * RADIUS / 8.0).cbrt())
}

/// The stiffness dF/dδ = F'(a)/δ'(a) of the sphere of Johnson, Kendall and Roberts at a contact radius.
fn stiffness(a: f64) -> f64 {
    let force = 4.0 * a * a / RADIUS - 1.5 * (8.0 * PI * WORK * a).sqrt();
    force / (2.0 * a / RADIUS - 0.5 * (2.0 * PI * WORK / a).sqrt())
}

/// What is found over what is exact: radius by energy, less its zone, and by the edge; approach and pull-off at a given
/// force, each also less the zone; pull-off at a given approach, the approach at the latter, and the contact stiffness at no load, at a held edge and between two
/// loads.
type Ratios = [f64; 11];

fn cells(ratios: Ratios) -> Vec<String> {
    ratios.map(|ratio| format!("{ratio:.4}")).to_vec()
}

pub fn tables(quick: bool) -> Outcome<()> {
    let exact = exact()?;
    let at_rest = exact.at_load(0.0)?;
    head(
        &format!(
            "Sphere, R = 1, E* = 1, w = {WORK}, window {SIDE}, over JKR: radius and approach at no load, loading; pull-off \
             of bracket {BRACKET}"
        ),
        &[
            "nodes",
            "a radius",
            "radius by energy",
            "less the zone",
            "corrected",
            "approach",
            "less the zone",
            "pull-off, force",
            "less the zone",
            "at given approach",
            "approach there",
            "stiffness",
            "between two loads",
            "applications: loading, unloading",
            "nodes unloading − loading",
            "pull-off: solves, applications",
        ],
    );
    let mut found: Vec<(usize, Ratios)> = Vec::new();
    for n in if quick { vec![32, 64] } else { vec![32, 64, 128, 256] } {
        let mut problem = problem(n, Jkr::new(WORK)?)?;
        let [loading, unloading] =
            [Branch::Loading, Branch::Unloading].map(|branch| solve(&mut problem, Control::Force(0.0), branch));
        let (loading, unloading) = (loading?, unloading?);
        let areas = Areas::of(&loading)?;
        let off = pull_off(&mut problem, BRACKET, None)?;
        let (report, other) = (&loading.report, &unloading.report);
        let force = -tension(&off) * SIDE * SIDE;
        let at_approach = by_approach(n, at_rest.approach())?;
        let ratios = [
            radius(areas.by_energy) / at_rest.contact_radius(),
            radius(areas.less_zone()) / at_rest.contact_radius(),
            radius(areas.corrected) / at_rest.contact_radius(),
            report.approach.unwrap_or(f64::NAN) / at_rest.approach(),
            (report.approach.unwrap_or(f64::NAN) - areas.zone_length()) / at_rest.approach(),
            force / exact.pull_off().load(),
            force * (1.0 - Areas::of(&off.solution)?.zone_share()) / exact.pull_off().load(),
            at_approach.0 / lost_at_approach()?.load(),
            at_approach.1 / lost_at_approach()?.approach(),
            ContactStiffness::of(&mut problem, &loading)?.force_per_length / stiffness(at_rest.contact_radius()),
            secant(&mut problem, &loading)? * SIDE * SIDE / stiffness(at_rest.contact_radius()),
        ];
        let mut line = vec![format!("{n}²"), format!("{:.1}", at_rest.contact_radius() * n as f64 / SIDE)];
        line.extend(cells(ratios));
        line.push(format!("{}, {}", report.operator_applications, other.operator_applications));
        line.push((other.contact_nodes as i64 - report.contact_nodes as i64).to_string());
        line.push(format!("{}, {}", off.solves, off.operator_applications));
        row(&line);
        found.push((n, ratios));
    }
    for pair in found.windows(2) {
        let [(coarse, of_coarse), (fine, of_fine)] = [pair[0], pair[1]];
        let mut line = vec![format!("{coarse}², {fine}²"), "extrapolated".to_owned()];
        line.extend(cells(std::array::from_fn(|i| extrapolated(of_fine[i], of_coarse[i]))));
        line.extend(["", "", ""].map(str::to_owned));
        row(&line);
    }
    Ok(())
}

/// Force and approach of the last state before contact is lost as the bodies move apart from an approach.
fn by_approach(n: usize, from: f64) -> Outcome<(f64, f64)> {
    let mut problem = problem(n, Jkr::new(WORK)?)?;
    let to = lost_at_approach()?.approach();
    // a little farther than the contact is to be lost
    let legs = [from, to - 0.2 * (from - to)].map(Control::Approach);
    let settings = PathSettings::default().steps(8).smallest_step(2e-4);
    let mut solver = solver();
    let mut last = (f64::NAN, f64::NAN);
    let mut path = Path::new(legs, settings)?;
    while let Some(step) = path.next(&mut solver, &mut problem)? {
        if let Some(Event::Jump(_)) = step.event {
            break;
        }
        let report = &step.solution.report;
        last = (report.normal_force, report.approach.unwrap_or(f64::NAN));
    }
    Ok(last)
}
