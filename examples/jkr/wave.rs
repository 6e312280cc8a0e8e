//! A wave in one direction, next to the theory of Johnson (1995).

use std::f64::consts::{PI, TAU};

use asperity::elastic::{Base, Layer, Material};
use asperity::exact::AdhesiveWavyLine;
use asperity::{
    AdhesionLaw, Branch, Control, ElasticOperator, Grid, Jkr, Problem, Result, Solution, Spectral, Surface, Sweep,
};
use common::Outcome;

use crate::case::{Areas, extrapolated, half_space, head, pull_off, row, solve, solver, tension};

/// The amplitude over the wavelength, and Johnson's parameter.
const STEEPNESS: f64 = 0.01;
const ALPHA: f64 = 0.3;
/// The loads of the way there and back, over the pressure that closes the wave.
const LOADS: [f64; 9] = [0.1, 0.2, 0.3, 0.35, 0.3, 0.2, 0.1, 0.0, -0.05];
const BRACKET: f64 = 0.001;
/// The preload of the search for the pull-off, over the same pressure.
const PRELOAD: f64 = 0.3;

/// A wave of a wavelength on a half-space of contact modulus one, with the work of adhesion of Johnson's parameter.
#[derive(Clone, Copy)]
pub struct Wave {
    wavelength: f64,
    /// Periods along the sides.
    periods: (f64, f64),
    grid: Grid,
}

impl Wave {
    /// One period on a line.
    pub fn line(n: usize) -> Result<Self> {
        Ok(Self { wavelength: 1.0, periods: (1.0, 0.0), grid: Grid::line(n, 1.0)? })
    }

    /// So many periods along the sides of a cell with sides of one.
    fn across(shape: (usize, usize), periods: (f64, f64)) -> Result<Self> {
        Ok(Self { wavelength: periods.0.hypot(periods.1).recip(), periods, grid: Grid::new(shape, (1.0, 1.0))? })
    }

    fn amplitude(&self) -> f64 {
        STEEPNESS * self.wavelength
    }

    pub fn grid(&self) -> Grid {
        self.grid
    }

    pub fn work_of_adhesion(&self) -> f64 {
        (ALPHA * PI * self.amplitude()).powi(2) / (2.0 * self.wavelength)
    }

    pub fn exact(&self) -> Result<AdhesiveWavyLine> {
        AdhesiveWavyLine::new(self.amplitude(), self.wavelength, 1.0, self.work_of_adhesion())
    }

    /// The work of adhesion with which a contact has the mean pressure and the mean gap of a solution.
    ///
    /// With q = p̄/p*, the mean gap over the amplitude is 1 − s + q ln s, which falls for s > q.
    pub fn effective(&self, solution: &Solution<f64>) -> f64 {
        let (closing, report) = (PI * self.amplitude() / self.wavelength, &solution.report);
        let (q, gap) = (report.mean_pressure / closing, report.mean_gap / self.amplitude());
        let (mut low, mut high) = (q.max(1e-9), 1.0);
        for _ in 0..60 {
            let s: f64 = f64::midpoint(low, high);
            *if 1.0 - s + q * s.ln() > gap { &mut low } else { &mut high } = s;
        }
        (closing * (low - q)).powi(2) * self.wavelength / 2.0 / (low / (1.0 - low)).sqrt()
    }

    pub fn problem(
        &self,
        operator: impl ElasticOperator<f64> + 'static,
        law: impl AdhesionLaw<f64> + 'static,
    ) -> Result<Problem<f64>> {
        let (kx, ky) = (TAU * self.periods.0, TAU * self.periods.1);
        let surface = Surface::from_fn(self.grid, |x, y| self.amplitude() * (kx * x + ky * y).cos())?;
        Problem::new(&surface, operator, law)
    }

    /// The areas by energy under the loads, over the exact ones, and the operator applications.
    pub fn areas(&self, law: impl AdhesionLaw<f64> + 'static) -> Outcome<(Vec<f64>, usize)> {
        let (both, applications) = self.both_areas(law)?;
        Ok((both.iter().map(|both| both[0]).collect(), applications))
    }

    /// The same, with the areas less the zone at the edge.
    fn both_areas(&self, law: impl AdhesionLaw<f64> + 'static) -> Outcome<(Vec<[f64; 2]>, usize)> {
        let (exact, closing) = (self.exact()?, self.exact()?.closing_pressure());
        let mut problem = self.problem(half_space(self.grid)?, law)?;
        let mut solver = solver();
        solver.settings.branch = Some(Branch::Loading);
        let (mut sweep, mut ratios, mut applications) = (Sweep::default(), Vec::new(), 0);
        for pressure in LOADS.map(|load| load * closing) {
            let solution = sweep.next(&mut solver, &mut problem, Control::MeanPressure(pressure))?;
            let (report, areas) = (&solution.report, Areas::of(&solution)?);
            let of_exact = 2.0 * exact.at_mean_pressure(pressure)?.half_width() / self.wavelength;
            ratios.push([areas.by_energy, areas.less_zone()].map(|area| area / of_exact));
            applications += report.operator_applications;
        }
        Ok((ratios, applications))
    }

    /// The pull-off over the exact one, and the operator applications of its search.
    pub fn pull_off(&self, law: impl AdhesionLaw<f64> + 'static) -> Outcome<(f64, usize)> {
        let exact = self.exact()?;
        let mut problem = self.problem(half_space(self.grid)?, law)?;
        let found = pull_off(&mut problem, BRACKET, Some(PRELOAD * exact.closing_pressure()))?;
        Ok((-tension(&found) / exact.pull_off()?.mean_pressure(), found.operator_applications))
    }
}

/// The largest distance of ratios from one on the way there, and back, and between both at the same load.
fn distances(ratios: &[f64]) -> [f64; 3] {
    let of = |ratios: &[f64]| ratios.iter().fold(0.0, |most: f64, ratio| most.max((ratio - 1.0).abs()));
    let apart = (0..3).map(|i| ratios[6 - i] / ratios[i]).collect::<Vec<_>>();
    [of(&ratios[..4]), of(&ratios[4..]), of(&apart)]
}

pub fn tables(quick: bool) -> Outcome<()> {
    let title = format!(
        "Wave on a line, α = {ALPHA}: area by energy over the exact one at loads of {LOADS:?} p*, and pull-off over the \
         exact one"
    );
    head(
        &title,
        &["nodes", "areas", "less the zone", "there − back", "pull-off", "applications: nine loads, pull-off"],
    );
    let mut offs = Vec::new();
    for n in if quick { vec![64, 128] } else { vec![64, 128, 256, 512] } {
        let wave = Wave::line(n)?;
        let law = Jkr::new(wave.work_of_adhesion())?;
        let ((both, taken), (off, of_search)) = (wave.both_areas(law)?, wave.pull_off(law)?);
        let list = |k: usize| both.iter().map(|areas| format!("{:.4}", areas[k])).collect::<Vec<_>>().join(", ");
        let [_, _, apart] = distances(&both.iter().map(|areas| areas[0]).collect::<Vec<_>>());
        let (apart, off_exact) = (format!("{apart:.4}"), format!("{off:.4}"));
        row(&[n.to_string(), list(0), list(1), apart, off_exact, format!("{taken}, {of_search}")]);
        offs.push((n, off));
    }
    for pair in offs.windows(2) {
        let nodes = format!("{}, {}", pair[0].0, pair[1].0);
        let off = format!("{:.4}", extrapolated(pair[1].1, pair[0].1));
        row(&[nodes, "extrapolated".to_owned(), String::new(), String::new(), off, String::new()]);
    }
    directions(quick)?;
    layer(quick)
}

fn directions(quick: bool) -> Outcome<()> {
    head(
        "The same wave on grids of two directions: largest errors of the area there and back, and pull-off over the exact \
         one",
        &[
            "wave",
            "nodes",
            "nodes a wave",
            "area there",
            "area back",
            "less the zone",
            "there − back",
            "pull-off",
            "applications",
        ],
    );
    for n in if quick { vec![32] } else { vec![64, 128] } {
        for (name, shape, periods) in [
            ("along x", (n, n), (1.0, 0.0)),
            ("along y", (n, n), (0.0, 1.0)),
            ("along the diagonal", (n, n), (1.0, 1.0)),
            ("at 2:1", (n, n), (2.0, 1.0)),
            ("along x, Δy = 2Δx", (n, n / 2), (1.0, 0.0)),
            ("along y, Δy = 2Δx", (n, n / 2), (0.0, 1.0)),
        ] {
            let wave = Wave::across(shape, periods)?;
            let law = Jkr::new(wave.work_of_adhesion())?;
            let ((both, taken), (off, of_search)) = (wave.both_areas(law)?, wave.pull_off(law)?);
            let spacing = wave.grid.spacing();
            let [areas, less_zone] = [0, 1].map(|k| both.iter().map(|areas| areas[k]).collect::<Vec<_>>());
            let ([there, back, apart], [less_there, less_back, _]) = (distances(&areas), distances(&less_zone));
            row(&[
                name.to_owned(),
                format!("{} × {}", shape.0, shape.1),
                format!("{:.0}", wave.wavelength / spacing.0.max(spacing.1)),
                format!("{there:.4}"),
                format!("{back:.4}"),
                format!("{less_there:.4}, {less_back:.4}"),
                format!("{apart:.4}"),
                format!("{off:.4}"),
                format!("{taken}, {of_search}"),
            ]);
        }
    }
    Ok(())
}

/// The wave on bonded layers, without an exact solution: values converge with the grid.
fn layer(quick: bool) -> Outcome<()> {
    head(
        "The wave on a line, on bonded layers of a contact modulus of one: area by energy at loads of 0 and 0.2 p*, \
         pull-off over p*",
        &["layer", "nodes", "area, 0", "area, 0.2", "unloading, 0.2", "pull-off", "applications"],
    );
    let closing = PI * STEEPNESS;
    for (name, thickness, poisson) in
        [("t = λ/10, ν = 0.3", 0.1, 0.3), ("t = λ/10, ν = ½", 0.1, 0.5), ("t = λ/50, ν = 0.3", 0.02, 0.3)]
    {
        for n in if quick { vec![64, 128] } else { vec![64, 128, 256, 512, 1024] } {
            let wave = Wave::line(n)?;
            let body = Layer::new(Material::new(1.0, poisson)?, thickness, Base::Bonded)?;
            let law = Jkr::new(wave.work_of_adhesion())?;
            let mut problem = wave.problem(Spectral::of(wave.grid, body)?, law)?;
            let mut at = |load: f64, branch| {
                let report = solve(&mut problem, Control::MeanPressure(load * closing), branch)?.report;
                Ok::<_, asperity::Error>((
                    report.adhesive_contact_fraction.unwrap_or(f64::NAN),
                    report.operator_applications,
                ))
            };
            let [rest, there, back] =
                [at(0.0, Branch::Loading)?, at(0.2, Branch::Loading)?, at(0.2, Branch::Unloading)?];
            let found = pull_off(&mut problem, BRACKET, Some(PRELOAD * closing))?;
            row(&[
                name.to_owned(),
                n.to_string(),
                format!("{:.4}", rest.0),
                format!("{:.4}", there.0),
                format!("{:.4}", back.0),
                format!("{:.4}", tension(&found) / closing),
                format!("{}, {}, {}, {}", rest.1, there.1, back.1, found.operator_applications),
            ]);
        }
    }
    Ok(())
}
