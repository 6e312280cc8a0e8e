//! Fronts that the grid holds: the effective work of adhesion of laws with a range that is short for the grid.

use std::ops::ControlFlow;

use asperity::contact::ContactArea;
use asperity::{AdhesionLaw, Control, Exponential, Grid, Jkr, MaugisDugdale, Problem, Solution, Start, Status};
use common::Outcome;
use common::sharp::Sharp;

use crate::case::{half_space, head, row, solver};
use crate::rough::{self, Rough};
use crate::wave::Wave;

/// μ_ρ of the laws.
const RANGES: [f64; 9] = [0.15, 0.25, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0];
/// The loads on the way there, over the pressure that closes the wave, and the step of the way back.
const THERE: [f64; 11] = [0.1, 0.125, 0.15, 0.175, 0.2, 0.225, 0.25, 0.275, 0.3, 0.325, 0.35];
const BACK: f64 = 0.005;

const ROUGH: Rough = Rough { slope: 0.5, shortest: 8.0, work_of_adhesion: 5e-4, load: 0.02 };
const SEEDS: [u64; 4] = [21, 22, 23, 24];
/// The steps to the load, and of the growing tension.
const STEPS: usize = 8;
const GROWTH: f64 = 1.05;
/// The works of adhesion of the law without a range, over the given one.
const WORKS: [f64; 14] = [0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0, 8.0, 13.0, 20.0];

/// A law with a range.
#[derive(Clone, Copy)]
enum Law {
    Exponential,
    MaugisDugdale,
    /// The same, with a jump that solves do not smooth.
    Sharp,
}

impl Law {
    const ALL: [Self; 3] = [Self::Exponential, Self::MaugisDugdale, Self::Sharp];

    fn name(self) -> &'static str {
        match self {
            Self::Exponential => "exponential",
            Self::MaugisDugdale => "Maugis–Dugdale",
            Self::Sharp => "Maugis–Dugdale, never smoothed",
        }
    }

    fn of(self, w: f64, range: f64) -> Outcome<Box<dyn AdhesionLaw<f64>>> {
        Ok(match self {
            Self::Exponential => Box::new(Exponential::new(w, range)?),
            Self::MaugisDugdale => Box::new(MaugisDugdale::new(w, range)?),
            Self::Sharp => Box::new(Sharp(MaugisDugdale::new(w, range)?)),
        })
    }
}

/// A problem that goes from load to load, each from the gap of the last.
struct Followed {
    problem: Problem<f64>,
    last: Option<Solution<f64>>,
    applications: usize,
}

impl Followed {
    fn new(problem: Problem<f64>) -> Self {
        Self { problem, last: None, applications: 0 }
    }

    /// Whether the surfaces still hold each other under a mean pressure.
    fn goes_to(&mut self, pressure: f64) -> Outcome<bool> {
        let start = self.last.as_ref().map_or(Start::Default, |last| Start::From(&last.gap));
        let control = Control::MeanPressure(pressure);
        let found = solver().solve_with(&mut self.problem, control, start, |_| ControlFlow::Continue(()))?;
        self.applications += found.report.operator_applications;
        let held = found.report.status == Status::Converged && found.report.contact_nodes > 0;
        if held {
            self.last = Some(found);
        }
        Ok(held)
    }

    fn last(&self) -> Outcome<&Solution<f64>> {
        Ok(self.last.as_ref().ok_or("no load is held")?)
    }
}

/// The works of adhesion by pressure and mean gap of Johnson's wave, over the given one: the mean of the way there, and
/// where the greatest tension is borne.
fn of_wave(law: Law, mu_rho: f64, n: usize) -> Outcome<([f64; 2], usize)> {
    let wave = Wave::line(n)?;
    let (w, closing) = (wave.work_of_adhesion(), wave.exact()?.closing_pressure());
    let range = (w / n as f64).sqrt() / mu_rho;
    let mut followed = Followed::new(wave.problem(half_space(wave.grid())?, law.of(w, range)?)?);
    let mut there = Vec::new();
    for load in THERE {
        followed.goes_to(load * closing)?;
        there.push(wave.effective(followed.last()?) / w);
    }
    let mut load = THERE[THERE.len() - 1];
    while followed.goes_to((load - BACK) * closing)? {
        load -= BACK;
    }
    let back = wave.effective(followed.last()?) / w;
    let mean = there.iter().sum::<f64>() / there.len() as f64;
    Ok(([mean, back], followed.applications))
}

/// The area under the load, and the tension borne.
fn of_rough(law: Box<dyn AdhesionLaw<f64>>, seed: u64, n: usize) -> Outcome<([f64; 2], usize)> {
    let grid = Grid::square(n, 1.0)?;
    let problem = Problem::new(&rough::surface(ROUGH, grid, seed)?, half_space(grid)?, law)?;
    let mut followed = Followed::new(problem);
    let part = ROUGH.load / STEPS as f64;
    for step in 1..=STEPS {
        followed.goes_to(part * step as f64)?;
    }
    let area = ContactArea::of_solution(followed.last()?)?.corrected_contact_fraction;
    for step in (0..STEPS).rev() {
        followed.goes_to(part * step as f64)?;
    }
    let (mut tension, mut borne) = (1e-2 * ROUGH.load, 0.0);
    while followed.goes_to(-tension)? {
        borne = tension;
        tension *= GROWTH;
    }
    Ok(([area, borne], followed.applications))
}

/// The abscissa at which a growing line through points, with logarithms, has a value.
fn inverted(points: &[(f64, f64)], value: f64) -> f64 {
    let pair = points.windows(2).find(|pair| pair[0].1 > 0.0 && pair[0].1 <= value && value <= pair[1].1);
    pair.map_or(f64::NAN, |pair| {
        let share = (value / pair[0].1).ln() / (pair[1].1 / pair[0].1).ln();
        pair[0].0 * (pair[1].0 / pair[0].0).powf(share)
    })
}

pub fn tables(quick: bool) -> Outcome<()> {
    let columns = ["μ_ρ", Law::ALL[0].name(), Law::ALL[1].name(), Law::ALL[2].name()];
    let ranges = if quick { &RANGES[2..4] } else { &RANGES[..] };
    let n = if quick { 128 } else { 512 };
    head(
        &format!(
            "Effective over given work of adhesion, approach / withdrawal (operator applications): Johnson's wave on a line of {n} nodes"
        ),
        &columns,
    );
    for &mu_rho in ranges {
        let mut cells = vec![mu_rho.to_string()];
        for law in Law::ALL {
            let ([there, back], taken) = of_wave(law, mu_rho, n)?;
            cells.push(format!("{there:.2} / {back:.2} ({taken})"));
        }
        row(&cells);
    }
    let n = if quick { 64 } else { 128 };
    let seeds = if quick { &SEEDS[..1] } else { &SEEDS[..] };
    let Rough { slope, shortest, work_of_adhesion: w, load } = ROUGH;
    let title = format!(
        "The same of rough surfaces, {n}², rms slope {slope}, k 1 to {shortest}, w = {w}, load {load}: the works of \
         adhesion of jkr with the same area under the load, and the same pull-off"
    );
    head(&title, &columns);
    let mut of_jkr = Vec::new();
    for &seed in seeds {
        let mut points = [Vec::new(), Vec::new()];
        for work in WORKS {
            let (found, _) = of_rough(Box::new(Jkr::new(work * w)?), seed, n)?;
            points.iter_mut().zip(found).for_each(|(points, found)| points.push((work, found)));
        }
        of_jkr.push(points);
    }
    for &mu_rho in ranges {
        let mut cells = vec![mu_rho.to_string()];
        for law in Law::ALL {
            let range = (w / n as f64).sqrt() / mu_rho;
            let mut found = Vec::new();
            for (&seed, points) in seeds.iter().zip(&of_jkr) {
                let ([area, tension], taken) = of_rough(law.of(w, range)?, seed, n)?;
                let [there, back] = [inverted(&points[0], area), inverted(&points[1], tension)];
                found.push(format!("{there:.2} / {back:.2} ({taken})"));
            }
            cells.push(found.join(", "));
        }
        row(&cells);
    }
    Ok(())
}
