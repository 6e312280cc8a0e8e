//! Iterations and operator applications of both presets, side by side.
#[path = "../tests/common/rough.rs"]
mod rough;

use asperity::*;
use std::time::Instant;

fn main() -> Result<()> {
    for n in [64, 128, 256, 512] {
        let grid = Grid::square(n, 1.0)?;
        run("Hertz", &Surface::paraboloid(grid, 2.0)?, NoAdhesion, Control::MeanGap(0.0398))?;
        run("Hertz P", &Surface::paraboloid(grid, 2.0)?, NoAdhesion, Control::MeanPressure(1.8e-4))?;
        run("MD", &Surface::paraboloid(grid, 2.0)?, MaugisDugdale::new(1e-4, 2e-3)?, Control::MeanGap(0.0429))?;
        if n > 64 {
            let surface = rough::rough(grid, (n as i32 / 2 - 1).min(64), 1);
            for p in [0.012, 0.2] {
                let g = run("rough P", &surface, NoAdhesion, Control::MeanPressure(p))?;
                run("rough G", &surface, NoAdhesion, Control::MeanGap(g))?;
            }
        }
    }
    Ok(())
}

fn run<L: AdhesionLaw<f64> + Copy>(name: &str, surface: &Surface, law: L, control: Control) -> Result<f64> {
    let mut out = 0.0;
    print!("{name:10} {:4} ", surface.grid().shape().0);
    for settings in [Settings::default(), Settings { max_iterations: 3000, ..Settings::rey2017() }] {
        let mut problem = Problem::new(surface, Westergaard::new(*surface.grid(), 1.0)?, law)?;
        let t = Instant::now();
        let r = Solver::new(settings).solve(&mut problem, control)?.report;
        if settings.method == Method::Preconditioned {
            out = r.mean_gap;
        }
        print!(
            "| {:10} {:4} it {:5} apps err {:.1e} load {:.0e} eps {:.0e} c {:6} p {:.7e} {:.2}s ",
            r.status,
            r.iterations,
            r.operator_applications,
            r.relative_error,
            r.load_error,
            r.orthogonality,
            r.contact_points,
            r.mean_pressure,
            t.elapsed().as_secs_f64()
        );
    }
    println!();
    Ok(out)
}
