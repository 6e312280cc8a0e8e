//! Tables 1 to 4 of Rey, Anciaux and Molinari (2017), the paper's values next to ours; and waves and limits that have
//! exact solutions.
//!
//! `cargo run --release -p asperity-examples --example tables`

mod errors;
mod penalty;
mod waves;

use asperity::{Result, Settings};
use clap::Parser;
use common::arguments;

#[derive(Parser)]
struct Arguments {
    /// The largest grid, in nodes along a side; below 512 the tables of larger grids are shown on smaller ones
    #[arg(default_value_t = 1024, value_parser = arguments::nodes::<64>)]
    largest: usize,
}

fn main() -> Result<()> {
    let Arguments { largest } = arguments::read(include_str!("main.rs"));
    let sizes: Vec<usize> = [64, 128, 256, 512, 1024, 2048].into_iter().filter(|&n| n <= largest).collect();
    errors::table_1(&sizes)?;
    penalty::table_2(largest.min(512))?;
    waves::limits()?;
    waves::waves(largest)?;
    errors::table_34(
        "Table 3: rho = 3e-4, w = 1e-5, mean gap 0.0405; the paper against JKR",
        &sizes,
        (3e-4, 1e-5, 0.0405),
        [36.35, 14.06, 5.47, 1.70, 0.5856, 0.2876],
    )?;
    errors::table_34(
        "Table 4: rho = 2e-3, w = 1e-4, mean gap 0.0429; the paper against Maugis-Dugdale",
        &sizes,
        (2e-3, 1e-4, 0.0429),
        [9.52, 2.07, 0.648, 0.133, 0.0865, 0.0495],
    )
}

fn settings(tolerance: f64) -> Settings {
    Settings::default().tolerance(tolerance)
}
