//! A wave in one direction, next to the theory of Johnson (1995).

use std::f64::consts::{PI, TAU};

use asperity::exact::AdhesiveWavyLine;
use asperity::{Control, Grid, Jkr, Problem, Result, Surface, Sweep, Westergaard};
use common::Outcome;

use crate::case::{areas, head, loading, powers, pull_off, row, tension};

/// The amplitude over the wavelength, and Johnson's parameter.
const STEEPNESS: f64 = 0.01;
const ALPHA: f64 = 0.3;
/// The loads of the way there and back, over the pressure that closes the wave.
const LOADS: [f64; 9] = [0.1, 0.2, 0.3, 0.35, 0.3, 0.2, 0.1, 0.0, -0.05];
const BRACKET: f64 = 0.001;
/// The preload of the search for the pull-off, over the same pressure.
const PRELOAD: f64 = 0.3;

/// The errors of a wave with periods along the sides of a cell with sides of one, on a half-space of contact modulus one:
/// the largest error of the area by energy on the way there, and back, and the pull-off over the exact one.
fn errors(grid: Grid, (kx, ky): (f64, f64)) -> Outcome<[f64; 3]> {
    let wavelength = kx.hypot(ky).recip();
    let amplitude = STEEPNESS * wavelength;
    let work = (ALPHA * PI * amplitude).powi(2) / (2.0 * wavelength);
    let exact = AdhesiveWavyLine::new(amplitude, wavelength, 1.0, work)?;
    let surface = Surface::from_fn(grid, |x, y| amplitude * (TAU * (kx * x + ky * y)).cos())?;
    let problem = || Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, Jkr::new(work)?);
    let (mut solver, mut sweep, mut problem, mut alone) = (loading(), Sweep::default(), problem()?, problem()?);
    let mut area = |load: f64| {
        let pressure = load * exact.closing_pressure();
        let solution = sweep.next(&mut solver, &mut problem, Control::MeanPressure(pressure))?;
        let of_exact = 2.0 * exact.at_mean_pressure(pressure)?.half_width() / wavelength;
        Ok(areas(&solution)?[0] / of_exact)
    };
    let ratios = LOADS.into_iter().map(&mut area).collect::<Result<Vec<_>>>()?;
    let largest = |ratios: &[f64]| ratios.iter().fold(0.0, |most: f64, ratio| most.max((ratio - 1.0).abs()));
    let found = pull_off(&mut alone, BRACKET, Some(PRELOAD * exact.closing_pressure()))?;
    let pull_off = -tension(&found) / exact.pull_off()?.mean_pressure();
    Ok([largest(&ratios[..4]), largest(&ratios[4..]), pull_off])
}

/// The table of waves on lines of up to so many nodes, and on grids with a quarter of them along a side.
pub fn table(largest: usize) -> Outcome<()> {
    head(
        &format!(
            "Wave, α = {ALPHA}: largest errors of the area by energy there and back, at loads of {LOADS:?} p*, and pull-off \
             over the exact one"
        ),
        &["wave", "nodes", "area there", "area back", "pull-off"],
    );
    let mut waves: Vec<_> =
        powers(64, largest).map(|n| Ok(("on a line", Grid::line(n, 1.0)?, (1.0, 0.0)))).collect::<Result<_>>()?;
    for n in powers(largest.min(256) / 4, largest / 4) {
        for (name, ny, periods) in [
            ("along x", n, (1.0, 0.0)),
            ("along y", n, (0.0, 1.0)),
            ("along the diagonal", n, (1.0, 1.0)),
            ("at 2:1", n, (2.0, 1.0)),
            ("along x, Δy = 2Δx", n / 2, (1.0, 0.0)),
            ("along y, Δy = 2Δx", n / 2, (0.0, 1.0)),
        ] {
            waves.push((name, Grid::new((n, ny), (1.0, 1.0))?, periods));
        }
    }
    for (name, grid, periods) in waves {
        let (nx, ny) = grid.shape();
        row(&[name, &format!("{nx} × {ny}")], &errors(grid, periods)?);
    }
    Ok(())
}
