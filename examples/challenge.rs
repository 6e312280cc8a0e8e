//! The contact-mechanics challenge: area, mean gap, and distributions of pressure and gap over the load, without
//! adhesion, with it, and with a law without a range, each with its certified error, its branch and the error of the grid.
//!
//! Müser et al., *Meeting the contact-mechanics challenge*, *Tribology Letters* 65:118 (2017): a self-affine surface of
//! 100 µm by 100 µm with an rms slope of 1, waves from 100 µm to 0.1 µm and a plateau down to 20 µm, on a half-space of
//! E* = 25 MPa, with an exponential law of 50 mJ/m² and a range of 2.071 nm. Its Fourier coefficients are a file of the
//! authors' site, `surface.Fourier.ASCII.dat`, in units of the side; low values touch first. It takes a grid of more
//! than 2000 nodes a side. Without the file a surface of the same statistics is drawn, on fewer than 4096 nodes a piece
//! of it with the same spacing of nodes. An error of the grid with ~ is rough, and none is told where the grid does not
//! resolve the adhesion (μ_ρ above 0.5), which takes some 45 times as many nodes a side.
//!
//! `cargo run --release -p asperity-examples --example challenge -- --file surface.Fourier.ASCII.dat --size 4096`

use std::path::PathBuf;
use std::time::Instant;

use asperity::accuracy::{GridError, Quantity};
use asperity::elastic::Boundary;
use asperity::stability::ContactStiffness;
use asperity::{
    AdhesionLaw, Amplitude, Branch, Control, Exponential, Grid, Jkr, Nested, NoAdhesion, Report, SelfAffine, Settings,
    Solver, Surface, Westergaard,
};
use asperity_maps::io::read_fourier;
use clap::Parser;
use common::{Outcome, arguments, quantile};

const SIDE: f64 = 100e-6;
const LONGEST_SELF_AFFINE: f64 = 20e-6;
const SHORTEST: f64 = 0.1e-6;
const MODULUS: f64 = 25e6;
const WORK_OF_ADHESION: f64 = 50e-3;
const RANGE: f64 = 2.071e-9;
/// Mean pressures, over E*; the third is the load of reference.
const PRESSURES: [f64; 5] = [5e-4, 2e-3, 1e-2, 2e-2, 5e-2];
const SHARES: [f64; 5] = [0.1, 0.25, 0.5, 0.75, 0.9];

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = arguments::nodes::<32>)]
    size: usize,
    /// The Fourier coefficients of the surface, a text
    #[arg(long, value_name = "FILE")]
    file: Option<PathBuf>,
    /// Take the branch of unloading as well, from full contact
    #[arg(long)]
    unloading: bool,
    /// Solve under the load of reference without a range alone
    #[arg(long)]
    jkr: bool,
}

fn main() -> Outcome<()> {
    let Arguments { size, file, unloading, jkr } = arguments::read(include_str!("challenge.rs"));
    let surface = match &file {
        Some(file) => read_surface(file, size)?,
        None => drawn(size)?,
    };
    let (statistics, (side, _)) = (surface.statistics(), surface.grid().lengths());
    println!(
        "{size} x {size} nodes, {:.4} um a side: rms slope {:.4}, rms height {:.4} um",
        1e6 * side,
        statistics.rms_slope,
        1e6 * statistics.rms_height
    );
    let law = Exponential::new(WORK_OF_ADHESION, RANGE)?;
    let mut rows = Vec::new();
    println!(
        "{:>7} {:>12} {:>8} {:>7} {:>9} {:>7} {:>8} {:>6} {:>7} {:>7}",
        "p/E*", "adhesion", "area, %", "error", "gap, nm", "error", "certif.", "mu_rho", "applic.", "s"
    );
    if jkr {
        return Row::solve(&surface, Jkr::new(WORK_OF_ADHESION)?, PRESSURES[2], None).map(drop);
    }
    for pressure in PRESSURES {
        rows.push(Row::solve(&surface, NoAdhesion, pressure, None)?);
        rows.push(Row::solve(&surface, law, pressure, Some(Branch::Loading))?);
        rows.push(Row::solve(&surface, Jkr::new(WORK_OF_ADHESION)?, pressure, None)?);
        if unloading {
            rows.push(Row::solve(&surface, law, pressure, Some(Branch::Unloading))?);
        }
    }
    areas(size, &rows);
    distribution("contact pressure over E* that a share of the contact is below", 4, &rows, |row| &row.pressures);
    distribution("gap in nm that a share of the nodes apart is below", 1, &rows, |row| &row.gaps);
    Ok(())
}

/// Prints the contact areas as a table in Markdown.
fn areas(size: usize, rows: &[Row]) {
    let first: Vec<_> = rows.iter().filter(|row| row.pressure == PRESSURES[0]).collect();
    let name = |row: &&Row| format!(" {}, {size}² |", row.law);
    println!("\ncontact area, %\n\n| p/E* |{}", first.iter().map(name).collect::<String>());
    println!("|---|{}", "---|".repeat(first.len()));
    for of_pressure in rows.chunks(first.len()) {
        let area = |row: &Row| format!(" {:.*} |", (2.0 - row.area.log10().floor()).clamp(0.0, 9.0) as usize, row.area);
        println!("| {} |{}", of_pressure[0].pressure, of_pressure.iter().map(area).collect::<String>());
    }
}

/// Prints the values that shares of all are below.
fn distribution(what: &str, decimals: usize, rows: &[Row], of: impl Fn(&Row) -> &Vec<f64>) {
    println!("\n{what}");
    println!("{:>7} {:>12}{}", "p/E*", "adhesion", SHARES.map(|share| format!(" {share:>9}")).concat());
    for row in rows {
        println!("{}{}", row.name, of(row).iter().map(|value| format!(" {value:>9.decimals$}")).collect::<String>());
    }
}

/// The surface of the file, turned over, as peaks touch here.
fn read_surface(file: &PathBuf, size: usize) -> Outcome<Surface> {
    let grid = Grid::square(size, SIDE)?;
    Ok(Surface::new(grid, -read_fourier(file, grid, SIDE)?.heights())?)
}

/// A surface of the same statistics.
fn drawn(size: usize) -> Outcome<Surface> {
    let side = SIDE * (size as f64 / 4096.0).min(1.0);
    let rough = SelfAffine::default().hurst(0.8).k_l(1.0).k_r((side / LONGEST_SELF_AFFINE).max(1.0));
    let rough = rough.k_s(side / SHORTEST).amplitude(Amplitude::RmsSlope(1.0)).seed(1);
    Ok(rough.surface(Grid::square(size, side)?)?)
}

/// The answer under a load.
struct Row {
    name: String,
    pressure: f64,
    /// The law, or the branch of the law with a range.
    law: &'static str,
    /// In %, corrected for its edge; with `jkr` the area in the limit.
    area: f64,
    pressures: Vec<f64>,
    gaps: Vec<f64>,
}

impl Row {
    /// Solves, and prints what was found.
    fn solve(
        surface: &Surface,
        law: impl AdhesionLaw<f64> + 'static,
        pressure: f64,
        branch: Option<Branch>,
    ) -> Outcome<Self> {
        let clock = Instant::now();
        let control = Control::MeanPressure(pressure * MODULUS);
        let half_space = |grid| Westergaard::<f64>::new(grid, MODULUS);
        let mut solver = Solver::new(Settings::default().branch(branch));
        let nested = Nested::default().stiffness(ContactStiffness::TOLERANCE);
        let found = nested.solve(&mut solver, surface, half_space, law, control)?;
        let (report, applications) = (&found.solution.report, found.equivalent_applications());
        let errors = GridError::of_all(&found.levels, report, surface.nodes_per_wave(Boundary::Periodic));
        let error = |of: Quantity| {
            let error = errors.iter().find(|(quantity, _)| *quantity == of).and_then(|(_, error)| *error);
            let rough = |error: GridError| if error.rough { "~" } else { "" };
            error.map_or("-".to_owned(), |error| format!("{}{:.1} %", rough(error), 100.0 * error.relative))
        };
        let area = found.levels.last().map_or(f64::NAN, |level| {
            100.0 * level.area.jkr_contact_fraction.unwrap_or(level.area.corrected_contact_fraction)
        });
        let law = match (&*report.law, report.branch) {
            ("jkr", _) => "jkr",
            (_, branch) => branch.map_or("no adhesion", Branch::name),
        };
        let name = format!("{pressure:>7} {law:>12}");
        println!(
            "{name} {:>8.4} {:>7} {:>9.3} {:>7} {:>8.1e} {:>6.2} {applications:>7.0} {:>7.1}{}",
            area,
            error(Quantity::Area),
            1e9 * report.mean_gap,
            error(Quantity::Gap),
            report.relative_error,
            report.mu_rho,
            clock.elapsed().as_secs_f64(),
            remark(report)
        );
        let solution = &found.solution;
        let contact = solution.contact_map();
        let of = |wanted: bool, field: &ndarray::Array2<f64>, unit: f64| {
            let chosen = contact.iter().zip(field).filter(|(touches, _)| **touches == wanted);
            quantiles(chosen.map(|(_, value)| value / unit).collect())
        };
        Ok(Self {
            name,
            pressure,
            law,
            area,
            pressures: of(true, &solution.contact_pressure, MODULUS),
            gaps: of(false, &solution.gap, 1e-9),
        })
    }
}

/// What a reader has to know of a solve that is not as it should be.
fn remark(report: &Report) -> String {
    let status = match report.status {
        asperity::Status::Converged => String::new(),
        status => format!("  {status}"),
    };
    let unresolved = if report.under_resolved { "  adhesion is not resolved" } else { "" };
    status + unresolved
}

/// The values that shares of all are below.
fn quantiles(mut values: Vec<f64>) -> Vec<f64> {
    SHARES.iter().map(|&share| quantile(&mut values, share)).collect()
}
