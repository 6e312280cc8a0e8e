//! A sphere on a free half-space, next to the theory of Johnson, Kendall and Roberts.

use std::f64::consts::PI;

use asperity::exact::{self, Sphere};
use asperity::{AdhesionLaw, Boussinesq, Control, Grid, Jkr, Problem, Result, Surface};
use common::Outcome;

use crate::case::{areas, head, loading, pull_off, ratios, row, tension};

const RADIUS: f64 = 1.0;
pub const WORK: f64 = 2e-3;
pub const SIDE: f64 = 1.6;
/// The relative width of the bracket of the pull-off.
const BRACKET: f64 = 0.002;

/// The sphere on a window of n² nodes.
pub fn surface(n: usize) -> Result<Surface> {
    Surface::paraboloid(Grid::square(n, SIDE)?, RADIUS)
}

/// The half-space below the sphere.
pub fn half_space(grid: Grid) -> Result<Boussinesq<f64>> {
    Boussinesq::new(grid, 1.0)
}

/// The contact of the sphere by a law.
pub fn problem(n: usize, law: impl AdhesionLaw<f64> + 'static) -> Result<Problem<f64>> {
    let surface = surface(n)?;
    Problem::new(&surface, half_space(*surface.grid())?, law)
}

/// The sphere of Johnson, Kendall and Roberts.
pub fn exact() -> Result<exact::Jkr> {
    exact::Jkr::new(RADIUS, 1.0, WORK)
}

pub fn table(quick: bool) -> Outcome<()> {
    let (exact, window) = (exact()?, SIDE * SIDE);
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
            "pull-off, force",
            "its limit",
        ],
    );
    for n in if quick { vec![32, 64] } else { vec![32, 64, 128, 256] } {
        let mut problem = problem(n, Jkr::new(WORK)?)?;
        let solution = loading().solve(&mut problem, Control::Force(0.0))?;
        let found = pull_off(&mut problem, BRACKET, None)?;
        let radii = areas(&solution)?.map(|share| SIDE * (share / PI).sqrt() / at_rest.contact_radius());
        let approach = solution.report.approach.unwrap_or(f64::NAN) / at_rest.approach();
        let forces = [tension(&found), found.limit()?.unwrap_or(f64::NAN)];
        let forces = forces.map(|tension| -tension * window / exact.pull_off().load());
        let mut cells = vec![format!("{n}²"), format!("{:.1}", at_rest.contact_radius() * n as f64 / SIDE)];
        cells.extend([&ratios(radii)[..], &ratios([approach]), &ratios(forces)].concat());
        row(&cells);
    }
    Ok(())
}
