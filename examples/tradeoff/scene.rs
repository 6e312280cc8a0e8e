//! The scene: the problem to solve, and its true solution.

use asperity::contact::ContactStatistics;
use asperity::{
    AdhesionLaw, Amplitude, Control, Exponential, Grid, Nested, NoAdhesion, Problem, Real, SelfAffine, Settings,
    Solver, Status, Surface, Westergaard,
};
use ndarray::Array2;

use common::Outcome;

/// Radius of curvature, and rms slope of the rough surface; E* = L = 1.
const RADIUS: f64 = 2.0;
const SLOPE: f64 = 0.1;
/// The tolerance of reference solutions.
const SHARP: f64 = 1e-12;

/// A problem under a few loads, on grids from coarse to fine.
#[derive(Clone)]
pub struct Scene {
    pub name: &'static str,
    /// Whether it is a paraboloid; all others are rough.
    smooth: bool,
    /// Work of adhesion and range.
    adhesion: Option<(f64, f64)>,
    pub sizes: Vec<usize>,
    pub loads: Vec<Control>,
    /// The length that has to be resolved, and its name.
    pub length: (f64, &'static str),
    /// The nodes along a side of the references.
    finest: usize,
}

/// Choices of a user by name: whether by Algorithm 3 of Rey, Anciaux and Molinari (2017), with the certified error as its
/// criterion, whether in `f32`, and whether on nested grids.
pub type Family = (&'static str, bool, bool, bool);

pub const FAMILIES: [Family; 5] = [
    ("default, f64", false, false, false),
    ("nested, f64", false, false, true),
    ("default, f32", false, true, false),
    ("nested, f32", false, true, true),
    ("rey2017, f64", true, false, false),
];

/// The displacement, and the quantities that are compared: the share of nodes in contact, the contact fraction
/// corrected for its edge, and the mean gap under a given mean pressure, or the other way round.
pub type State = (Array2<f64>, [f64; 3]);

/// A solution, the operator applications in units of one on the grid, and whether it has converged.
pub type Found = (State, f64, bool);

impl Scene {
    /// All scenes, small or not, with the finest grid of the references if that is chosen.
    pub fn all(quick: bool, finest: Option<usize>) -> [Self; 3] {
        let finest = finest.unwrap_or(if quick { 256 } else { 4096 });
        let [small, large] =
            if quick { [&[64, 128][..]; 2] } else { [&[64, 128, 256, 512][..], &[128, 256, 512, 1024]] };
        let sizes = |of: &[usize]| of.iter().copied().filter(|&n| n < finest).collect();
        // loads of spheres with these contact radii
        let radii = [0.060, 0.064, 0.067, 0.071, 0.075];
        let pressures = radii.map(|a: f64| Control::MeanPressure(4.0 * a.powi(3) / (3.0 * RADIUS))).to_vec();
        let pressed = [0.01, 0.02, 0.04].map(|pressure| Control::MeanPressure(pressure * SLOPE)).to_vec();
        let held = if quick { [0.0034, 0.003, 0.0025] } else { [0.0028, 0.0024, 0.002] }.map(Control::MeanGap).to_vec();
        let law = (1e-5, if quick { 8e-4 } else { 4e-4 });
        let rough = Self {
            name: "rough",
            smooth: false,
            adhesion: None,
            sizes: sizes(large),
            loads: pressed,
            length: (if quick { 1.0 / 16.0 } else { 1.0 / 32.0 }, "shortest wave"),
            finest,
        };
        let adhesive = Self { name: "adhesive", adhesion: Some(law), loads: held, ..rough.clone() };
        let length = (radii[2], "contact radius");
        let (sizes, loads) = (sizes(small), pressures);
        [Self { name: "hertz", smooth: true, sizes, loads, length, ..rough.clone() }, rough, adhesive]
    }

    pub fn surface(&self, n: usize) -> Outcome<Surface> {
        let grid = Grid::square(n, 1.0)?;
        if self.smooth {
            return Ok(Surface::paraboloid(grid, RADIUS)?);
        }
        let rough = SelfAffine::default().k_s(self.length.0.recip()).amplitude(Amplitude::RmsSlope(SLOPE));
        Ok(rough.seed(1).surface(grid)?)
    }

    fn law<T: Real>(&self) -> Outcome<Box<dyn AdhesionLaw<T>>> {
        Ok(match self.adhesion {
            None => Box::new(NoAdhesion),
            Some((work, range)) => Box::new(Exponential::new(work, range)?),
        })
    }

    /// √(wΔx/E*)/ρ on a grid.
    pub fn resolution(&self, n: usize) -> f64 {
        self.adhesion.map_or(0.0, |(work, range)| (work / n as f64).sqrt() / range)
    }

    /// The solution by a choice.
    pub fn solve<T: Real>(&self, surface: &Surface, control: Control, by: (Family, f64)) -> Outcome<Found> {
        let ((_, rey2017, _, nested), tolerance) = by;
        let settings = if rey2017 { Settings::rey2017() } else { Settings::default() }.tolerance(tolerance);
        let (mut solver, law) = (Solver::new(settings), self.law::<T>()?);
        let half_space = |grid| Westergaard::<T>::new(grid, 1.0);
        let (solution, count) = if nested {
            let found = Nested::default().solve(&mut solver, surface, half_space, law, control)?;
            let count = found.equivalent_applications();
            (found.solution, count)
        } else {
            let mut problem = Problem::new(surface, half_space(*surface.grid())?, law)?;
            let solution = solver.solve(&mut problem, control)?;
            let count = solution.report.operator_applications as f64 + 1.0;
            (solution, count)
        };
        let (statistics, report) = (ContactStatistics::of(&solution)?, &solution.report);
        let answer = if let Control::MeanGap(_) = control { report.mean_pressure } else { report.mean_gap };
        let figures = [statistics.contact_fraction, statistics.corrected_contact_fraction, answer];
        let displacement = solution.gap.mapv(Real::widen) + surface.heights();
        Ok(((displacement, figures), count, report.status == Status::Converged))
    }

    /// The solution converged on a grid.
    pub fn converged(&self, surface: &Surface, control: Control, family: Family) -> Outcome<State> {
        match self.solve::<f64>(surface, control, (family, SHARP))? {
            (state, _, true) => Ok(state),
            _ => Err(format!("{}: the reference has not converged", self.name).into()),
        }
    }

    /// The solutions on the finest grid under each load. The contact area corrected for its
    /// edge is extrapolated from that grid and one of half the nodes along a side, with the order log₂ 3.
    pub fn references(&self) -> Outcome<Vec<State>> {
        let [coarse, fine] = [self.surface(self.finest / 2)?, self.surface(self.finest)?];
        let reference = |&control: &Control| -> Outcome<State> {
            let (_, [_, coarser, _]) = self.converged(&coarse, control, FAMILIES[1])?;
            let (displacement, [_, finer, answer]) = self.converged(&fine, control, FAMILIES[1])?;
            let area = finer + 0.5 * (finer - coarser);
            Ok((displacement, [area, area, answer]))
        };
        self.loads.iter().map(reference).collect()
    }

    /// The true state at the nodes of a coarser grid.
    pub fn truth(&self, n: usize, (finer, figures): &State) -> State {
        let step = self.finest / n;
        (Array2::from_shape_fn((n, n), |(i, j)| finer[[i * step, j * step]]), *figures)
    }
}
