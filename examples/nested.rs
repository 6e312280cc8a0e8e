//! Operator applications of nested grids against the finest grid alone, over a set of scenes.
//!
//! `cargo run --release -p asperity-examples --example nested`

use asperity::{
    AdhesionLaw, Boussinesq, Control, ElasticOperator, Exponential, Grid, MaugisDugdale, Nested, NoAdhesion, Problem,
    Real, Result, Settings, Solver, Surface, Westergaard,
};
use clap::Parser;
use common::arguments::{self, Precision};
use common::rough;

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side
    #[arg(default_value_t = 512, value_parser = arguments::nodes::<32>)]
    size: usize,
    /// The certified relative error at which solves end
    #[arg(default_value_t = 1e-6)]
    tolerance: f64,
    #[arg(default_value = "f64")]
    precision: Precision,
    /// Other scenes: tips on a free half-space, by force, approach and spring
    #[arg(long)]
    free: bool,
}

/// The sums of a table: how many scenes, the sum of the logarithms of the ratios, and the largest ratio, over all
/// scenes and over those where nested grids are the default.
struct Table {
    settings: Settings,
    all: (f64, f64, f64),
    default: (f64, f64, f64),
}

fn main() -> Result<()> {
    let Arguments { size, tolerance, precision, free } = arguments::read(include_str!("nested.rs"));
    match precision {
        Precision::F32 => table::<f32>(size, tolerance, free),
        Precision::F64 => table::<f64>(size, tolerance, free),
    }
}

fn table<T: Real>(size: usize, tolerance: f64, free: bool) -> Result<()> {
    let settings = Settings::default().tolerance(tolerance);
    let none = (0.0, 0.0, 0.0);
    let mut table = Table { settings, all: none, default: none };
    println!(
        "{:<38} {:>6} {:>7} {:>6}  default  difference of mean gap, mean pressure",
        "scene", "single", "nested", "ratio"
    );
    let grid = Grid::square(size, 1.0)?;
    if free {
        table.free_scenes::<T>(grid)?
    } else {
        table.scenes::<T>(grid)?
    }
    let sums = [("all", table.all), ("where it is the default", table.default)];
    for (name, (count, logarithms, worst)) in sums.into_iter().filter(|(_, (count, ..))| *count > 0.0) {
        println!("{name}: {count} scenes, ratio {:.2} in the mean, {worst:.2} at most", (logarithms / count).exp());
    }
    Ok(())
}

impl Table {
    fn scenes<T: Real>(&mut self, grid: Grid) -> Result<()> {
        let (table, size) = (self, grid.shape().0);
        for nodes in [8, 16, 32] {
            let surface = rough::rough(grid, (size / nodes).max(5) as i32, 1);
            let rms = surface.rms_height();
            for control in [0.002, 0.0125, 0.2].map(Control::MeanPressure) {
                table.row::<T>(&format!("rough, {nodes} nodes a wave"), &surface, NoAdhesion, control)?;
            }
            for control in [2.0, 1.0, 0.3].map(|gap| Control::MeanGap(gap * rms)) {
                table.row::<T>(&format!("rough, {nodes} nodes a wave"), &surface, NoAdhesion, control)?;
            }
        }
        let surface = rough::rough(grid, (size / 16).max(5) as i32, 1);
        let rms = surface.rms_height();
        let bowed = surface.heights()
            + &grid.sample(|x, y| {
                let turn = std::f64::consts::TAU;
                rms * (3.0 * (turn * x).cos() + (turn * y).cos())
            });
        let bowed = Surface::new(grid, bowed)?;
        let loads = [Control::MeanPressure(0.002), Control::MeanPressure(0.02), Control::MeanGap(rms)];
        for control in loads {
            table.row::<T>("rough, bowed", &bowed, NoAdhesion, control)?;
            let law = |work, range| Exponential::new(work, range);
            table.row::<T>("rough, exponential, weak", &surface, law(0.01 * rms * rms, 0.1 * rms)?, control)?;
            table.row::<T>("rough, exponential, strong", &surface, law(1.42e-4, 2.9e-3)?, control)?;
            let law = MaugisDugdale::new(1.42e-4, 2.9e-3)?;
            table.row::<T>("rough, Maugis-Dugdale", &surface, law, control)?;
        }
        let sphere = Surface::paraboloid(grid, 2.0)?;
        for control in [Control::MeanPressure(2e-3), Control::MeanGap(0.0398)] {
            table.row::<T>("sphere", &sphere, NoAdhesion, control)?;
            table.row::<T>("sphere, Maugis-Dugdale", &sphere, MaugisDugdale::new(1e-4, 2e-3)?, control)?;
        }
        table.row::<T>("wave", &Surface::wave_2d(grid, 0.02, 1)?, NoAdhesion, Control::MeanPressure(0.01))?;
        table.free::<T>("sphere, free boundary", &sphere, NoAdhesion, Control::Force(2e-3))?;
        table.free::<T>("rough, free boundary", &surface, NoAdhesion, Control::Force(0.0125))
    }

    fn free_scenes<T: Real>(&mut self, grid: Grid) -> Result<()> {
        let sphere = Surface::paraboloid(grid, 2.0)?;
        self.tip::<T>("sphere", &sphere)?;
        for nodes in [16, 64] {
            let rough = rough::rough(grid, (grid.shape().0 / nodes).max(5) as i32, 1);
            let tip = Surface::new(grid, sphere.heights() + rough.heights())?;
            self.tip::<T>(&format!("rough sphere, {nodes} nodes a wave"), &tip)?;
        }
        Ok(())
    }

    /// A tip on a free half-space, under every control.
    fn tip<T: Real>(&mut self, name: &str, tip: &Surface) -> Result<()> {
        let (approach, spring) = (Control::Approach(0.02), Control::Spring { stiffness: 0.1, rest: 0.03 });
        for control in [Control::Force(2e-4), Control::Force(5e-3), approach, spring] {
            self.free::<T>(name, tip, NoAdhesion, control)?;
        }
        let law = Exponential::new(2e-4, 4e-3)?;
        for control in [Control::Force(5e-3), approach, spring] {
            self.free::<T>(&format!("{name}, exponential"), tip, law, control)?;
        }
        let law = MaugisDugdale::new(2e-4, 4e-3)?;
        self.free::<T>(&format!("{name}, Maugis-Dugdale"), tip, law, Control::Force(2e-3))
    }

    fn row<T: Real>(
        &mut self,
        name: &str,
        surface: &Surface,
        law: impl AdhesionLaw<T> + Copy + 'static,
        control: Control,
    ) -> Result<()> {
        self.compare(name, surface, |grid| Westergaard::<T>::new(grid, 1.0), law, control)
    }

    fn free<T: Real>(
        &mut self,
        name: &str,
        surface: &Surface,
        law: impl AdhesionLaw<T> + Copy + 'static,
        control: Control,
    ) -> Result<()> {
        self.compare(name, surface, |grid| Boussinesq::<T>::new(grid, 1.0), law, control)
    }

    fn compare<T: Real, O: ElasticOperator<T> + 'static>(
        &mut self,
        name: &str,
        surface: &Surface,
        half_space: impl Fn(Grid) -> Result<O>,
        law: impl AdhesionLaw<T> + Copy + 'static,
        control: Control,
    ) -> Result<()> {
        let mut problem = Problem::new(surface, half_space(*surface.grid())?, law)?;
        let (mut solver, nested) = (Solver::new(self.settings), Nested::default());
        let single = solver.solve(&mut problem, control)?.report;
        let pays = nested.pays::<T>(&self.settings, surface, &law, control);
        let found = nested.solve(&mut solver, surface, half_space, law, control)?;
        let (alone, taken) = ((single.operator_applications + 1) as f64, found.equivalent_applications());
        let (ratio, report) = (taken / alone, &found.solution.report);
        for sums in [Some(&mut self.all), pays.then_some(&mut self.default)].into_iter().flatten() {
            *sums = (sums.0 + 1.0, sums.1 + ratio.ln(), sums.2.max(ratio));
        }
        let ended = if report.status == single.status { String::new() } else { format!("{}", report.status) };
        println!(
            "{:<38} {alone:>6} {taken:>7.1} {ratio:>6.2}  {:<7}  {:.0e} {:.0e} {ended}",
            format!("{name}, {} {:.4}", control.name(), control.value()),
            if pays { "nested" } else { "single" },
            (report.mean_gap / single.mean_gap - 1.0).abs(),
            (report.mean_pressure / single.mean_pressure - 1.0).abs(),
        );
        Ok(())
    }
}
