//! A wave in one direction, next to the theory of Johnson (1995).

use std::f64::consts::{PI, TAU};

use asperity::exact::AdhesiveWavyLine;
use asperity::{Control, Grid, Jkr, Problem, Result, Surface, Sweep, Westergaard};
use common::Outcome;

use crate::case::{areas, head, loading, pull_off, ratios, row, tension};

/// The amplitude over the wavelength, and Johnson's parameter.
const STEEPNESS: f64 = 0.01;
const ALPHA: f64 = 0.3;
/// The loads of the way there and back, over the pressure that closes the wave.
const LOADS: [f64; 9] = [0.1, 0.2, 0.3, 0.35, 0.3, 0.2, 0.1, 0.0, -0.05];
const BRACKET: f64 = 0.001;
/// The preload of the search for the pull-off, over the same pressure.
const PRELOAD: f64 = 0.3;

/// A wave of a wavelength on a half-space of contact modulus one, with the work of adhesion of Johnson's parameter.
struct Wave {
    wavelength: f64,
    /// Periods along the sides.
    periods: (f64, f64),
    grid: Grid,
}

impl Wave {
    /// One period on a line.
    fn line(n: usize) -> Result<Self> {
        Ok(Self { wavelength: 1.0, periods: (1.0, 0.0), grid: Grid::line(n, 1.0)? })
    }

    /// So many periods along the sides of a cell with sides of one.
    fn across(shape: (usize, usize), periods: (f64, f64)) -> Result<Self> {
        Ok(Self { wavelength: periods.0.hypot(periods.1).recip(), periods, grid: Grid::new(shape, (1.0, 1.0))? })
    }

    fn amplitude(&self) -> f64 {
        STEEPNESS * self.wavelength
    }

    fn work_of_adhesion(&self) -> f64 {
        (ALPHA * PI * self.amplitude()).powi(2) / (2.0 * self.wavelength)
    }

    fn exact(&self) -> Result<AdhesiveWavyLine> {
        AdhesiveWavyLine::new(self.amplitude(), self.wavelength, 1.0, self.work_of_adhesion())
    }

    fn problem(&self) -> Result<Problem<f64>> {
        let (kx, ky) = (TAU * self.periods.0, TAU * self.periods.1);
        let surface = Surface::from_fn(self.grid, |x, y| self.amplitude() * (kx * x + ky * y).cos())?;
        Problem::new(&surface, Westergaard::new(self.grid, 1.0)?, Jkr::new(self.work_of_adhesion())?)
    }

    /// The areas by energy and less the process zone under the loads, over the exact ones.
    fn areas(&self) -> Outcome<[Vec<f64>; 2]> {
        let exact = self.exact()?;
        let mut problem = self.problem()?;
        let (mut solver, mut sweep, mut found) = (loading(), Sweep::default(), [Vec::new(), Vec::new()]);
        for pressure in LOADS.map(|load| load * exact.closing_pressure()) {
            let solution = sweep.next(&mut solver, &mut problem, Control::MeanPressure(pressure))?;
            let of_exact = 2.0 * exact.at_mean_pressure(pressure)?.half_width() / self.wavelength;
            found.iter_mut().zip(areas(&solution)?).for_each(|(found, area)| found.push(area / of_exact));
        }
        Ok(found)
    }

    /// The pull-off over the exact one.
    fn pull_off(&self) -> Outcome<f64> {
        let exact = self.exact()?;
        let found = pull_off(&mut self.problem()?, BRACKET, Some(PRELOAD * exact.closing_pressure()))?;
        Ok(-tension(&found) / exact.pull_off()?.mean_pressure())
    }
}

/// The largest distance of ratios from one on the way there, and back, and between both at the same load.
fn distances(ratios: &[f64]) -> [f64; 3] {
    let largest = |ratios: &[f64]| ratios.iter().fold(0.0, |most: f64, ratio| most.max((ratio - 1.0).abs()));
    let apart = (0..3).map(|i| ratios[6 - i] / ratios[i]).collect::<Vec<_>>();
    [largest(&ratios[..4]), largest(&ratios[4..]), largest(&apart)]
}

pub fn table(quick: bool) -> Outcome<()> {
    head(
        &format!(
            "Wave, α = {ALPHA}: largest errors of the area by energy there and back, at loads of {LOADS:?} p*, and pull-off \
             over the exact one"
        ),
        &["wave", "nodes", "nodes a wave", "area there", "area back", "less the zone", "there − back", "pull-off"],
    );
    let mut waves = Vec::new();
    for n in if quick { vec![64, 128] } else { vec![64, 128, 256, 512] } {
        waves.push(("on a line", Wave::line(n)?));
    }
    for n in if quick { vec![32] } else { vec![64, 128] } {
        for (name, ny, periods) in [
            ("along x", n, (1.0, 0.0)),
            ("along y", n, (0.0, 1.0)),
            ("along the diagonal", n, (1.0, 1.0)),
            ("at 2:1", n, (2.0, 1.0)),
            ("along x, Δy = 2Δx", n / 2, (1.0, 0.0)),
            ("along y, Δy = 2Δx", n / 2, (0.0, 1.0)),
        ] {
            waves.push((name, Wave::across((n, ny), periods)?));
        }
    }
    for (name, wave) in &waves {
        let [by_energy, less_zone] = wave.areas()?.map(|ratios| distances(&ratios));
        let off = wave.pull_off()?;
        let (nx, ny) = wave.grid.shape();
        let mut cells = vec![(*name).to_owned(), format!("{nx} × {ny}")];
        cells.push(format!("{:.0}", wave.wavelength / wave.grid.largest_spacing()));
        cells.extend(ratios([by_energy[0], by_energy[1]]));
        cells.push(ratios([less_zone[0], less_zone[1]]).join(", "));
        cells.extend(ratios([by_energy[2], off]));
        row(&cells);
    }
    Ok(())
}
