//! Adhesion in patches and a wall with a soft coat, both written outside of the crate: a law and a constraint that
//! differ from node to node.
//!
//! `cargo run --release --example patches`

#[path = "patches/law.rs"]
mod law;

use asperity::adhesion::check_law;
use asperity::constraint::{Springs, Wall};
use asperity::{
    ContactConstraint, Control, Exponential, Grid, NoAdhesion, Problem, Result, Settings, Solver, Surface, Westergaard,
};
use law::Patches;

/// A coat on part of the rigid surface, which resists being compressed below its thickness at each node.
struct Coat {
    thickness: Vec<f64>,
    stiffness: f64,
}

impl Coat {
    fn depth(&self, node: usize, gap: f64) -> f64 {
        (self.thickness[node] - gap).max(0.0)
    }
}

impl ContactConstraint<f64> for Coat {
    fn wall(&self) -> Wall<'_, f64> {
        Wall::Springs(self)
    }
}

impl Springs<f64> for Coat {
    fn energy(&self, node: usize, gap: f64) -> f64 {
        0.5 * self.stiffness * self.depth(node, gap).powi(2)
    }
    fn traction(&self, node: usize, gap: f64) -> f64 {
        -self.stiffness * self.depth(node, gap)
    }
    fn slope(&self, node: usize, gap: f64) -> f64 {
        if self.depth(node, gap) > 0.0 { self.stiffness } else { 0.0 }
    }
}

fn main() -> Result<()> {
    let size = 256;
    let grid = Grid::square(size, 1.0)?;
    let waves = Surface::wave_2d(grid, 5e-3, 4)?;
    let half_space = Westergaard::<f64>::new(grid, 1.0)?;

    println!("waves under a mean pressure of 1e-3 E*, with adhesion of a share of its strength on every other square");
    println!("share of the work   contact, %   strongest tension, E*");
    for share in [0.0, 0.5, 1.0] {
        let of = (0..size * size).map(|node| (4 * (node / size) / size + 4 * (node % size) / size) % 2).collect();
        let laws = vec![Exponential::new(2e-5, 2e-3)?, Exponential::new(share * 2e-5, 2e-3)?];
        let law = Patches { laws, shape: (size, size), of };
        check_law::<f64>(&law, 0.02)?;
        let mut problem = Problem::new(&waves, half_space.clone(), law)?;
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(1e-3))?;
        let tension = solution.pressure.iter().fold(0.0_f64, |least, &p| least.min(p));
        println!("{share:17} {:12.2} {:23.3e}", 100.0 * solution.report.contact_fraction, -tension);
    }

    println!("\nthe same waves without adhesion, under a coat of 1e-3 on one half");
    let thickness = (0..size * size).map(|node| if 4 * (node / size) / size < 2 { 1e-3 } else { 0.0 }).collect();
    let coat = Coat { thickness, stiffness: 500.0 };
    let mut problem = Problem::new(&waves, half_space, NoAdhesion)?;
    let mut solver = Solver { settings: Settings::default(), constraint: coat };
    let solution = solver.solve(&mut problem, Control::MeanPressure(1e-3))?;
    let half = |from: usize, to: usize| {
        let rows = solution.contact_pressure.rows().into_iter().skip(from).take(to - from);
        rows.map(|row| row.sum()).sum::<f64>() / (size * size) as f64
    };
    println!("load on the coated half {:.3e}, on the bare one {:.3e}", half(0, size / 2), half(size / 2, size));
    Ok(())
}
