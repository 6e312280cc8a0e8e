//! A sphere on an elastic layer of finite thickness, from the half-space to an elastic foundation.
//!
//! `cargo run --release -p asperity-examples --example layer`. It takes a second.
//!
//! Each line ends with the ratio to the limit of the layer: where it is thick Hertz, and where it is thin springs of
//! stiffness M/t (bonded) or E*/t (sliding), or, if it is incompressible, the flow of the material
//! sideways through a narrow gap. Johnson, *Contact Mechanics* (1985), section 5.8.

use std::f64::consts::PI;

use asperity::elastic::{Base, Layer, Material};
use asperity::{Control, Grid, NoAdhesion, Problem, Result, Solver, Spectral, Status, Surface};
use clap::Parser;
use common::arguments;

const MODULUS: f64 = 1.0;
const RADIUS: f64 = 2.0;
const LOAD: f64 = 0.003;

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side
    #[arg(default_value_t = 256, value_parser = arguments::nodes::<16>)]
    size: usize,
}

fn main() -> Result<()> {
    let Arguments { size } = arguments::read(include_str!("layer.rs"));
    println!("peak pressure under a sphere of radius {RADIUS} L pressed with {LOAD} E*L², and its ratio to the limits");
    println!("{:>18} {:>7} {:>10} {:>8} {:>8} {:>7}", "layer", "t/L", "p₀/E*", "thick", "thin", "applic.");
    for thickness in [2.0, 0.3, 0.1, 0.03, 0.01] {
        // p = (M/t)(a² − r²)/2R
        let springs = |stiffness: f64| 2.0 * LOAD / PI / (4.0 * LOAD * RADIUS / (PI * stiffness)).sqrt();
        // p = (3G/t³)(a² − r²)²/32R, with the shear modulus G = E*/4
        let flow = |thickness: f64| {
            let a6 = 96.0 * RADIUS * thickness.powi(3) * LOAD / (PI * 0.75 * MODULUS);
            3.0 * LOAD / (PI * a6.cbrt())
        };
        let (steel, rubber) = (Material::new(MODULUS, 0.3)?, Material::new(MODULUS, 0.5)?);
        let foundation = springs(steel.confined_modulus() / thickness);
        press(size, "bonded, ν = 0.3", thickness, Layer::new(steel, thickness, Base::Bonded)?, foundation)?;
        press(size, "bonded, ν = 0.5", thickness, Layer::new(rubber, thickness, Base::Bonded)?, flow(thickness))?;
        press(size, "sliding", thickness, Layer::new(steel, thickness, Base::Sliding)?, springs(MODULUS / thickness))?;
    }
    Ok(())
}

fn press(size: usize, name: &str, thickness: f64, layer: Layer, thin: f64) -> Result<()> {
    let grid = Grid::square(size, 1.0)?;
    let layer = Spectral::<f64>::of(grid, layer)?;
    let mut problem = Problem::new(&Surface::paraboloid(grid, RADIUS)?, layer, NoAdhesion)?;
    let solution = Solver::default().solve(&mut problem, Control::MeanPressure(LOAD))?;
    assert_eq!(solution.report.status, Status::Converged);
    let peak = solution.contact_pressure.iter().copied().fold(0.0, f64::max);
    let hertz = (6.0 * LOAD * MODULUS.powi(2) / (PI.powi(3) * RADIUS.powi(2))).cbrt();
    let applications = solution.report.operator_applications;
    println!("{name:>18} {thickness:>7} {peak:>10.5} {:>8.3} {:>8.3} {applications:>7}", peak / hertz, peak / thin);
    Ok(())
}
