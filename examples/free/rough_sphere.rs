//! A rough sphere without adhesion: its contact area over the load, on the formula of Pastewka and Robbins (2016).
//!
//! Under light loads one asperity touches; then the area is the load over p_rms = E*h'/2, as on a rough plane; and
//! under heavy loads the area of Hertz. The formula joins the last two.

use std::f64::consts::PI;

use asperity::contact::ContactStatistics;
use asperity::exact::{Hertz, Sphere};
use asperity::{
    Amplitude, Boussinesq, Control, Grid, NoAdhesion, Problem, SelfAffine, Settings, Solver, Surface, Sweep,
};
use plotters::prelude::*;

use common::Outcome;
use common::chart::{COLOURS, Chart, Series, Style};

const RADIUS: f64 = 1.0;
/// Rms slopes h'.
const SLOPES: [f64; 3] = [0.02, 0.06, 0.2];
/// Random surfaces over which the areas are averaged.
const SEEDS: u64 = 4;
/// The contact radii without roughness, from the lightest to the heaviest load.
const RADII: (f64, f64) = (0.006, 0.4);
const LOADS: usize = 12;

/// A·p_rms/F by the formula, of the load over that on Hertz's area A₀ under p_rms, x = F/(A₀ p_rms).
fn formula(x: f64) -> f64 {
    libm::erf(0.5 * PI.sqrt() * x) / x
}

pub fn chart(n: usize) -> Outcome<Chart> {
    let hertz = Hertz::new(RADIUS, 1.0)?;
    println!("\nrough sphere, {n}², mean of {SEEDS}: A p_rms/F, the formula and one asperity, over F/(A₀ p_rms)");
    let ratio = (RADII.1 / RADII.0).powf(1.0 / (LOADS - 1) as f64);
    let radii = (0..LOADS).map(|i| RADII.0 * ratio.powi(i as i32));
    let loads =
        radii.map(|a| hertz.at_contact_radius(a).map(|contact| contact.load())).collect::<Result<Vec<_>, _>>()?;
    let (mut series, mut range) = (Vec::new(), (f64::INFINITY, 0.0_f64));
    for (slope, colour) in SLOPES.into_iter().zip(COLOURS) {
        let p_rms = 0.5 * slope;
        let (mut found, mut alone) = (vec![0.0; LOADS], vec![0.0; LOADS]);
        for seed in 0..SEEDS {
            let surface = surface(n, slope, seed)?;
            let asperity = Hertz::new(radius_at_top(&surface), 1.0)?;
            for (i, area) in areas(&surface, &loads)?.into_iter().enumerate() {
                found[i] += area / SEEDS as f64;
                alone[i] += PI * asperity.at_load(loads[i])?.contact_radius().powi(2) / SEEDS as f64;
            }
        }
        println!("h' = {slope}");
        let [mut points, mut light] = [Vec::new(), Vec::new()];
        for ((load, area), alone) in loads.iter().zip(found).zip(alone) {
            let x = load / (PI * hertz.at_load(*load)?.contact_radius().powi(2) * p_rms);
            let [found, alone] = [area, alone].map(|area| area * p_rms / load);
            println!("{x:>10.4} {found:>8.4} {:>8.4} {alone:>8.4}", formula(x));
            points.push((x, found));
            light.push((x, alone));
            range = (range.0.min(x), range.1.max(x));
        }
        light.retain(|point| point.1 > 0.7);
        series.push(Series { name: format!("h' = {slope}"), colour, style: Style::Dots, points });
        let name = if slope == SLOPES[0] { "one asperity" } else { "" }.to_owned();
        series.push(Series { name, colour, style: Style::Thin, points: light });
    }
    let ratio = (range.1 / range.0).powf(0.01);
    let points = (0..=100).map(|i| range.0 * ratio.powi(i)).map(|x| (x, formula(x))).collect();
    let name = "Pastewka and Robbins".to_owned();
    series.push(Series { name, colour: BLACK, style: Style::Thin, points });
    Ok(Chart {
        title: format!("Rough sphere, {n}²: area over force"),
        axes: ["F / (A₀ pᵣₘₛ)", "A pᵣₘₛ / F"],
        logarithmic: true,
        labels: SeriesLabelPosition::LowerLeft,
        series,
    })
}

/// A self-affine sphere.
fn surface(n: usize, slope: f64, seed: u64) -> Outcome<Surface> {
    let grid = Grid::square(n, 1.0)?;
    let amplitude = Amplitude::RmsSlope(slope);
    let roughness = SelfAffine::default().amplitude(amplitude).k_l(8.0).k_r(8.0).k_s(n as f64 / 12.0).seed(seed);
    let sphere = Surface::paraboloid(grid, RADIUS)?;
    Ok(Surface::new(grid, roughness.surface(grid)?.heights() + sphere.heights())?)
}

/// The contact areas under some loads, each corrected for its edge.
fn areas(surface: &Surface, loads: &[f64]) -> Outcome<Vec<f64>> {
    let grid = surface.grid();
    let mut problem = Problem::new(surface, Boussinesq::<f64>::new(*grid, 1.0)?, NoAdhesion)?;
    let mut solver = Solver::new(Settings::default().tolerance(1e-4));
    let (mut sweep, mut areas) = (Sweep::default(), Vec::new());
    for load in loads.iter().copied().map(Control::Force) {
        let statistics = ContactStatistics::of(&sweep.next(&mut solver, &mut problem, load)?)?;
        areas.push(grid.lengths().0 * grid.lengths().1 * statistics.corrected_contact_fraction);
    }
    Ok(areas)
}

/// The radius of the mean curvature at the highest node, by differences.
fn radius_at_top(surface: &Surface) -> f64 {
    let (heights, (nx, ny)) = (surface.heights(), surface.grid().shape());
    let (dx, dy) = surface.grid().spacing();
    let mut top = (0, 0);
    for (node, height) in heights.indexed_iter() {
        if *height > heights[top] {
            top = node;
        }
    }
    let (i, j) = top;
    let second = |before: f64, after: f64, spacing: f64| (2.0 * heights[top] - before - after) / spacing.powi(2);
    let along_x = second(heights[[(i + nx - 1) % nx, j]], heights[[(i + 1) % nx, j]], dx);
    let along_y = second(heights[[i, (j + ny - 1) % ny]], heights[[i, (j + 1) % ny]], dy);
    2.0 / (along_x + along_y)
}
