//! A sphere on an elastic layer of finite thickness, from the half-space to an elastic foundation.
//!
//! `cargo run --release --example layer`. It takes a second.
//!
//! The peak pressure is that over the limit of a thick layer, Hertz, and that over the limit of a thin one: springs of
//! stiffness M/t (bonded) or E*/t (sliding), or for an incompressible layer the flow of the material sideways through
//! a narrow gap. Johnson, *Contact Mechanics* (1985), section 5.8.

use std::f64::consts::PI;

use asperity::elastic::{Base, Layer, Material};
use asperity::{Control, Grid, NoAdhesion, Problem, Result, Solver, Spectral, Status, Surface};

const MODULUS: f64 = 1.0;
const RADIUS: f64 = 2.0;
const LOAD: f64 = 0.003;
const SIZE: usize = 256;

fn main() -> Result<()> {
    println!("peak pressure under a sphere of radius {RADIUS} L pressed with {LOAD} E*L², over that of the limits\n");
    let kinds = ["bonded, ν = 0.3", "bonded, ν = ½", "sliding"];
    println!("| t/L |{} applications |", kinds.map(|kind| format!(" {kind}, thick | {kind}, thin |")).concat());
    println!("|---|{}", "---|".repeat(2 * kinds.len() + 1));
    for thickness in [2.0, 0.3, 0.1, 0.03, 0.01] {
        // p = (M/t)(a² − r²)/2R
        let springs = |stiffness: f64| 2.0 * LOAD / PI / (4.0 * LOAD * RADIUS / (PI * stiffness)).sqrt();
        // p = (3G/t³)(a² − r²)²/32R, with the shear modulus G = E*/4
        let flow = |thickness: f64| {
            let a6 = 96.0 * RADIUS * thickness.powi(3) * LOAD / (PI * 0.75 * MODULUS);
            3.0 * LOAD / (PI * a6.cbrt())
        };
        let (steel, rubber) = (Material::new(MODULUS, 0.3)?, Material::new(MODULUS, 0.5)?);
        let pressed = [
            (Layer::new(steel, thickness, Base::Bonded)?, springs(steel.confined_modulus() / thickness)),
            (Layer::new(rubber, thickness, Base::Bonded)?, flow(thickness)),
            (Layer::new(steel, thickness, Base::Sliding)?, springs(MODULUS / thickness)),
        ]
        .map(|(layer, thin)| press(layer, thin));
        let (mut ratios, mut applications) = (String::new(), Vec::new());
        for found in pressed {
            let (thick, thin, taken) = found?;
            ratios += &format!(" {thick:.3} | {thin:.3} |");
            applications.push(taken.to_string());
        }
        println!("| {thickness} |{ratios} {} |", applications.join(", "));
    }
    Ok(())
}

/// The peak pressure over the peaks of the thick and the thin limit, and the operator applications of the solve.
fn press(layer: Layer, thin: f64) -> Result<(f64, f64, usize)> {
    let grid = Grid::square(SIZE, 1.0)?;
    let layer = Spectral::<f64>::of(grid, layer)?;
    let mut problem = Problem::new(&Surface::paraboloid(grid, RADIUS)?, layer, NoAdhesion)?;
    let solution = Solver::default().solve(&mut problem, Control::MeanPressure(LOAD))?;
    assert_eq!(solution.report.status, Status::Converged);
    let peak = solution.contact_pressure.iter().copied().fold(0.0, f64::max);
    let hertz = (6.0 * LOAD * MODULUS.powi(2) / (PI.powi(3) * RADIUS.powi(2))).cbrt();
    Ok((peak / hertz, peak / thin, solution.report.operator_applications))
}
