//! An adhesion law of your own: a cubic that ends at its range, in fifteen lines.
//!
//! `cargo run --release --example own_law`

use asperity::adhesion::check_law;
use asperity::{AdhesionLaw, Control, Exponential, Grid, Problem, Real, Result, Solver, Surface, Westergaard};

/// φ = −w (1 − g/ρ)³ up to ρ, nothing beyond: smooth, and exactly zero at a distance.
struct Cubic<T> {
    work_of_adhesion: T,
    range: T,
}

impl<T: Real> Cubic<T> {
    fn left(&self, gap: T) -> T {
        (T::one() - gap / self.range).max(T::zero())
    }
}

impl<T: Real> AdhesionLaw<T> for Cubic<T> {
    fn energy(&self, gap: T) -> T {
        -self.work_of_adhesion * self.left(gap).powi(3)
    }
    fn traction(&self, gap: T) -> T {
        T::lit(3.0) * self.work_of_adhesion / self.range * self.left(gap).powi(2)
    }
    fn slope(&self, gap: T) -> T {
        T::lit(-6.0) * self.work_of_adhesion / self.range / self.range * self.left(gap)
    }
}

fn main() -> Result<()> {
    // in SI units: a silica sphere of radius 2 µm on a half-space of 1 GPa, on a patch of 1 µm
    let grid = Grid::square(256, 1e-6)?;
    let sphere = Surface::paraboloid(grid, 2e-6)?;
    let (work, range) = (0.05, 10e-9);

    let cubic = Cubic { work_of_adhesion: work, range: 3.0 * range };
    check_law(&cubic, 100e-9)?;

    // the same work of adhesion and the same traction at contact, with the law that decays exponentially
    let exponential = Exponential::new(work, range)?;
    let control = Control::MeanPressure(1e5);
    let half_space = Westergaard::<f64>::new(grid, 1e9)?;
    let a = Solver::default().solve(&mut Problem::new(&sphere, half_space.clone(), cubic)?, control)?.report;
    let b = Solver::default().solve(&mut Problem::new(&sphere, half_space, exponential)?, control)?.report;

    println!(
        "{:>13} {:>10} {:>9} {:>15} {:>11} {:>12}",
        "law", "status", "contact", "mean gap", "error", "applications"
    );
    for (name, report) in [("cubic", a), ("exponential", b)] {
        println!(
            "{name:>13} {:>10} {:>7.3} % {:>12.4} nm {:>11.1e} {:>12}",
            report.status.name(),
            100.0 * report.contact_fraction,
            1e9 * report.mean_gap,
            report.relative_error,
            report.operator_applications,
        );
    }
    Ok(())
}
