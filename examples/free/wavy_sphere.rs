//! A sphere with concentric waves, together and apart under given approach: its jumps next to the jumps of Guduru
//! (2007).

use asperity::exact::WavySphere;
use asperity::path::{Event, Path, PathSettings};
use asperity::{Boussinesq, Control, Grid, MaugisDugdale, Problem, Settings, Solver, Surface};
use plotters::prelude::*;

use common::Outcome;
use common::chart::{COLOURS, Chart, Series, Style};

/// In wavelengths and E*.
const RADIUS: f64 = 20.0;
const AMPLITUDE: f64 = 0.012;
const WORK: f64 = 1e-3;
/// The side of the window, and the contact radius on which the bodies turn back.
const SIDE: f64 = 8.0;
const LARGEST: f64 = 3.0;
/// The range of adhesion over √(wΔx/E*).
const RESOLVED: f64 = 2.5;

pub fn chart(n: usize) -> Outcome<Chart> {
    let exact = WavySphere::new(RADIUS, 1.0, WORK, (AMPLITUDE, 1.0))?;
    let grid = Grid::square(n, SIDE)?;
    let surface = Surface::from_fn(grid, |x, y| exact.height(x.hypot(y)))?;
    let range = RESOLVED * (WORK * grid.spacing().0).sqrt();
    let law = MaugisDugdale::new(WORK, range)?;
    let mut problem = Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0)?, law)?;
    println!(
        "\nwavy sphere, {n}²: range {range:.1e}, μ_ρ {:.2}; jumps as approach, and forces before and after",
        problem.mu_rho()
    );
    let (far, near) = (-0.12, exact.approach(LARGEST));
    let start = -far - surface.heights();
    let legs = [far, near, far].map(Control::Approach);
    let settings = PathSettings::default().smallest_step(2e-3);
    let mut solver = Solver::new(Settings::default().tolerance(1e-5));
    let mut ways = [Vec::new(), Vec::new()];
    let mut jumps = [Vec::new(), Vec::new()];
    let mut steps = 0;
    let mut path = Path::new(legs, settings)?.starting_from(start);
    while let Some(step) = path.next(&mut solver, &mut problem)? {
        let report = &step.solution.report;
        let way = usize::from(step.leg == 2);
        ways[way].push((report.approach.unwrap_or(f64::NAN), report.normal_force));
        if let Some(Event::Jump(jump)) = step.event {
            let area = SIDE * SIDE;
            let approach = jump.approach.map_or(f64::NAN, |(before, _)| before);
            jumps[way].push([approach, area * jump.mean_pressure.0, area * jump.mean_pressure.1]);
        }
        steps += 1;
    }
    println!("{steps} steps");
    for (name, way, jumps) in [("together", [far, near], &jumps[0]), ("apart", [near, far], &jumps[1])] {
        println!("{name}: {jumps:.4?}");
        let exact: Vec<_> = exact
            .jumps(way[0], way[1])?
            .iter()
            .map(|jump| {
                [if jump[0] > 0.0 { exact.approach(jump[0]) } else { 0.0 }, exact.load(jump[0]), exact.load(jump[1])]
            })
            .collect();
        println!("   exact: {exact:.4?}");
    }
    let curve = (1..=800).map(|i| LARGEST * f64::from(i) / 800.0).map(|a| (exact.approach(a), exact.load(a))).collect();
    let [together, apart] = ways;
    Ok(Chart {
        title: format!("Wavy sphere, {n}²: jumps"),
        axes: ["approach / λ", "force / E*λ²"],
        logarithmic: false,
        labels: SeriesLabelPosition::UpperLeft,
        series: vec![
            Series { name: "Guduru, no range".to_owned(), colour: BLACK, style: Style::Thin, points: curve },
            Series { name: "together".to_owned(), colour: COLOURS[1], style: Style::Line, points: together },
            Series { name: "apart".to_owned(), colour: COLOURS[0], style: Style::Line, points: apart },
        ],
    })
}
