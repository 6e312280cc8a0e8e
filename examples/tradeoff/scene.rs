//! The scene: the problem to solve, and its reference solution.

use std::collections::HashMap;

use asperity::contact::ContactStatistics;
use asperity::exact::{Hertz, Periodic, WavyLine};
use asperity::{
    AdhesionLaw, Amplitude, Control, Exponential, Grid, NoAdhesion, Real, SelfAffine, Solution, Surface, Westergaard,
};
use ndarray::Array2;

use crate::choice::{Choice, run};
use common::Outcome;

/// Radius of curvature, amplitude of the wave, rms slope of the rough surface; E* = L = 1.
const RADIUS: f64 = 2.0;
const AMPLITUDE: f64 = 0.02;
const SLOPE: f64 = 0.1;
/// The tolerance of reference solutions.
const SHARP: f64 = 1e-12;

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Sphere,
    Wave,
    Rough { k_s: f64, finest: usize },
}

/// A problem under a few loads, on grids from coarse to fine.
pub struct Scene {
    pub name: &'static str,
    pub title: &'static str,
    kind: Kind,
    /// Work of adhesion and range.
    pub adhesion: Option<(f64, f64)>,
    pub sizes: Vec<usize>,
    pub loads: Vec<Control>,
    /// The length that has to be resolved, and its name.
    pub length: f64,
    pub length_name: &'static str,
    /// On each grid, and under each load, the reference.
    references: HashMap<(usize, usize), State>,
}

/// The quantities that are compared.
#[derive(Clone)]
pub struct State {
    pub displacement: Array2<f64>,
    /// The share of nodes in contact.
    pub counted: f64,
    /// The contact fraction corrected for its edge.
    pub area: f64,
    /// The mean gap under a given mean pressure, and the other way round.
    pub answer: f64,
}

impl State {
    pub fn of<T: Real>(solution: &Solution<T>, surface: &Surface, control: Control) -> Outcome<Self> {
        let statistics = ContactStatistics::of(solution)?;
        let report = &solution.report;
        Ok(Self {
            displacement: solution.gap.mapv(Real::widen) + surface.heights(),
            counted: statistics.contact_fraction,
            area: statistics.corrected_contact_fraction,
            answer: if let Control::MeanGap(_) = control { report.mean_pressure } else { report.mean_gap },
        })
    }
}

impl Scene {
    /// All scenes, small or not, with the finest grid of the references if that is chosen.
    pub fn all(quick: bool, finest: Option<usize>) -> Outcome<Vec<Self>> {
        let of = |quick_ones: &[usize], others: &[usize]| if quick { quick_ones.to_vec() } else { others.to_vec() };
        let none = HashMap::new;
        let sphere = Periodic::new(Hertz::new(RADIUS, 1.0)?, 1.0)?;
        let radii = [0.060, 0.064, 0.067, 0.071, 0.075];
        let pressures = radii.iter().map(|&a| Ok(Control::MeanPressure(sphere.at_contact_radius(a)?.mean_pressure())));
        let wave = WavyLine::new(AMPLITUDE, 1.0, 1.0)?;
        let widths = [0.145, 0.157, 0.163, 0.178, 0.191];
        let gaps = widths.iter().map(|&a| Ok(Control::MeanGap(wave.at_half_width(a)?.mean_gap())));
        let k_s = if quick { 16.0 } else { 32.0 };
        let finest = finest.unwrap_or(if quick { 256 } else { 4096 });
        let rough = Kind::Rough { k_s, finest };
        let mut rough_sizes = of(&[64, 128], &[128, 256, 512, 1024]);
        rough_sizes.retain(|&n| n < finest);
        let gaps_between_rough = if quick { [0.0034, 0.003, 0.0025] } else { [0.0028, 0.0024, 0.002] };
        let shortest = (1.0 / k_s, "shortest wave");
        Ok(vec![
            Self {
                name: "hertz",
                title: "paraboloid, mean pressure given, against the exact periodic solution",
                kind: Kind::Sphere,
                adhesion: None,
                sizes: of(&[64, 128], &[64, 128, 256, 512]),
                loads: pressures.collect::<Outcome<_>>()?,
                length: radii[2],
                length_name: "contact radius",
                references: none(),
            },
            Self {
                name: "wave",
                title: "wave on a line, mean gap given, against Westergaard's solution",
                kind: Kind::Wave,
                adhesion: None,
                sizes: of(&[64, 256], &[32, 128, 512, 2048, 8192]),
                loads: gaps.collect::<Outcome<_>>()?,
                length: 1.0,
                length_name: "wave",
                references: none(),
            },
            Self {
                name: "rough",
                title: "rough hard wall, mean pressure given",
                kind: rough,
                adhesion: None,
                sizes: rough_sizes.clone(),
                loads: [0.01, 0.02, 0.04].map(|p| Control::MeanPressure(p * SLOPE)).to_vec(),
                length: shortest.0,
                length_name: shortest.1,
                references: none(),
            },
            Self {
                name: "adhesive",
                title: "the same surface with an exponential law, mean gap given",
                kind: rough,
                adhesion: Some(if quick { (1e-5, 8e-4) } else { (1e-5, 4e-4) }),
                sizes: rough_sizes,
                loads: gaps_between_rough.map(Control::MeanGap).to_vec(),
                length: shortest.0,
                length_name: shortest.1,
                references: none(),
            },
        ])
    }

    pub fn grid(&self, n: usize) -> Outcome<Grid> {
        Ok(if self.kind == Kind::Wave { Grid::line(n, 1.0)? } else { Grid::square(n, 1.0)? })
    }

    pub fn surface(&self, n: usize) -> Outcome<Surface> {
        let grid = self.grid(n)?;
        Ok(match self.kind {
            Kind::Sphere => Surface::paraboloid(grid, RADIUS)?,
            Kind::Wave => Surface::wave(grid, AMPLITUDE, 1)?,
            Kind::Rough { k_s, .. } => {
                let amplitude = Amplitude::RmsSlope(SLOPE);
                SelfAffine::default().k_s(k_s).amplitude(amplitude).seed(1).surface(grid)?
            }
        })
    }

    pub fn law<T: Real>(&self) -> Outcome<Box<dyn AdhesionLaw<T>>> {
        Ok(match self.adhesion {
            None => Box::new(NoAdhesion),
            Some((work, range)) => Box::new(Exponential::new(work, range)?),
        })
    }

    /// √(wΔx/E*)/ρ on a grid.
    pub fn resolution(&self, n: usize) -> f64 {
        self.adhesion.map_or(0.0, |(work, range)| (work / n as f64).sqrt() / range)
    }

    /// The name of the measured values under the loads.
    pub fn answer_name(&self) -> &'static str {
        if let Control::MeanGap(_) = self.loads[0] { "mean pressure" } else { "mean gap" }
    }

    /// The finest grid, where the reference is computed.
    pub fn finest(&self) -> Option<usize> {
        if let Kind::Rough { finest, .. } = self.kind { Some(finest) } else { None }
    }

    /// Solves on the finest grid, where there is no exact solution, and keeps the reference for all others.
    ///
    /// The contact area corrected for its edge comes near the true one with the second order, so that of
    /// the reference is extrapolated from the finest grid and one of half the nodes along a side.
    pub fn prepare(&mut self) -> Outcome<()> {
        let Some(finest) = self.finest() else { return Ok(()) };
        println!("reference: {finest}², converged to {SHARP:e}; its area extrapolated with that at {}²", finest / 2);
        let [coarse, fine] = [self.surface(finest / 2)?, self.surface(finest)?];
        for (load, &control) in self.loads.iter().enumerate() {
            let reference = |surface: &Surface| -> Outcome<State> {
                let found = run(self, surface, control, Choice { nested: true, ..Choice::sharp(SHARP) })?;
                found.must_have_converged(self.name, surface.grid().shape().0)?;
                Ok(found.state)
            };
            let (coarser, finer) = (reference(&coarse)?, reference(&fine)?);
            let area = finer.area + 0.5 * (finer.area - coarser.area);
            println!(
                "  load {}: contact {:.4} %, {:.3} % more than on the finest grid; {} {:.6e}",
                load + 1,
                100.0 * area,
                100.0 * (area / finer.area - 1.0),
                self.answer_name(),
                finer.answer
            );
            for &n in &self.sizes {
                let step = finest / n;
                let displacement = Array2::from_shape_fn((n, n), |(i, j)| finer.displacement[[i * step, j * step]]);
                self.references.insert((n, load), State { displacement, counted: area, area, answer: finer.answer });
            }
        }
        Ok(())
    }

    /// The true state at the nodes of a grid.
    pub fn truth(&self, n: usize, load: usize) -> Outcome<State> {
        let surface = self.surface(n)?;
        let grid = surface.grid();
        let exact = |displacement, area, answer| State { displacement, counted: area, area, answer };
        Ok(match (self.kind, self.loads[load]) {
            (Kind::Sphere, Control::MeanPressure(pressure)) => {
                let state = Periodic::new(Hertz::new(RADIUS, 1.0)?, 1.0)?.at_load(pressure)?;
                let area = std::f64::consts::PI * state.contact().contact_radius().powi(2);
                exact(state.displacement_field(grid)?, area, state.mean_gap(surface.mean()))
            }
            (Kind::Wave, Control::MeanGap(gap)) => {
                let state = WavyLine::new(AMPLITUDE, 1.0, 1.0)?.at_mean_gap(gap)?;
                exact(state.displacement_field(grid), 2.0 * state.half_width(), state.mean_pressure())
            }
            _ => self.references.get(&(n, load)).cloned().ok_or("the reference has not been computed")?,
        })
    }

    /// The solution converged on a grid.
    pub fn converged(&self, surface: &Surface, load: usize) -> Outcome<State> {
        let found = run(self, surface, self.loads[load], Choice::sharp(SHARP))?;
        found.must_have_converged(self.name, surface.grid().shape().0)?;
        Ok(found.state)
    }

    pub fn operator(&self, n: usize) -> Outcome<Westergaard<f64>> {
        Ok(Westergaard::new(self.grid(n)?, 1.0)?)
    }
}
