//! A sphere on a free half-space, next to the theory of Johnson, Kendall and Roberts.

use std::f64::consts::PI;

use asperity::exact::{self, Sphere};
use asperity::{Boussinesq, Control, Grid, Jkr, Problem, Result, Surface};
use common::Outcome;

use crate::case::{areas, head, loading, powers, pull_off, row, tension};

pub const WORK: f64 = 2e-3;
pub const SIDE: f64 = 1.6;
/// The relative width of the bracket of the pull-off.
const BRACKET: f64 = 0.002;

/// The sphere on a window of n² nodes.
pub fn surface(n: usize) -> Result<Surface> {
    Surface::paraboloid(Grid::square(n, SIDE)?, 1.0)
}

/// The sphere of Johnson, Kendall and Roberts.
pub fn exact() -> Result<exact::Jkr> {
    exact::Jkr::new(1.0, 1.0, WORK)
}

pub fn table(largest: usize) -> Outcome<()> {
    let exact = exact()?;
    let at_rest = exact.at_load(0.0)?;
    head(
        &format!("Sphere, R = E* = 1, w = {WORK}, side {SIDE}, over JKR: at no load, loading; pull-off to {BRACKET}"),
        &["nodes", "a radius", "radius by energy", "less the zone", "approach", "pull-off, force", "its limit"],
    );
    for n in powers(32, largest) {
        let surface = surface(n)?;
        let half_space = Boussinesq::<f64>::new(*surface.grid(), 1.0)?;
        let mut problem = Problem::new(&surface, half_space, Jkr::new(WORK)?)?;
        let solution = loading().solve(&mut problem, Control::Force(0.0))?;
        let found = pull_off(&mut problem, BRACKET, None)?;
        let [by_energy, less_zone] =
            areas(&solution)?.map(|share| SIDE * (share / PI).sqrt() / at_rest.contact_radius());
        let approach = solution.report.approach.unwrap_or(f64::NAN) / at_rest.approach();
        let [force, limit] = [tension(&found), found.limit()?.unwrap_or(f64::NAN)]
            .map(|tension| -tension * SIDE * SIDE / exact.pull_off().load());
        let radius = format!("{:.1}", at_rest.contact_radius() * n as f64 / SIDE);
        row(&[&format!("{n}²"), &radius], &[by_energy, less_zone, approach, force, limit]);
    }
    Ok(())
}
