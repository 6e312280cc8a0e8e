//! Published runs by another method, theirs next to ours: a half-space and a bonded layer on one rough surface of 2048²
//! nodes, from 0.6 % to 87 % contact.
//!
//! Green's function molecular dynamics took 4 to 45 hours for each on one core: Sukhomlinov and Müser, *Phys. Rev.
//! Lett.* 131, 156201 (2023), data and source doi:10.5281/zenodo.12726265 (MIT). The wall there is made of springs, of 0.9
//! times the stiffness of the shortest wave. Next to it stands the hard wall that these stand for, with the mean gap
//! that the publication extrapolates for it.
//!
//! `cargo run --release -p asperity-examples --example published -- --rows 0:22` makes the whole table.

use std::ops::Range;
use std::time::Instant;

use clap::Parser;
use common::published::{NODES, runs, surface};
use common::{Outcome, arguments};

#[derive(Parser)]
struct Arguments {
    /// The runs, by the numbers of their first and behind their last one
    #[arg(long, value_name = "FROM:TO", default_value = "0:2", value_parser = range)]
    rows: Range<usize>,
    /// The nodes along a side, 512 or more for the shortest wave: with others than 2048 the figures are others
    #[arg(long, value_name = "N", default_value_t = NODES, value_parser = arguments::nodes::<512>)]
    size: usize,
}

fn range(text: &str) -> Result<Range<usize>, String> {
    let (from, to) = text.split_once(':').ok_or("it must be two numbers with a colon between")?;
    let [from, to] = [from, to].map(|number| number.parse::<usize>().map_err(|error| error.to_string()));
    Ok(from?..to?)
}

fn main() -> Outcome<()> {
    let Arguments { rows, size } = arguments::read(include_str!("published.rs"));
    let heights = surface(size)?;
    println!("theirs, ours by the same springs, and ours by a hard wall; digits of theirs that differ are named");
    println!(
        "| thickness | pressure | contact | mean gap | energy | time, theirs and ours | by a hard wall: contact | \
         mean gap, their converged gap | time |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let (mut agree, mut figures) = (0, 0);
    for run in runs().skip(rows.start).take(rows.len()) {
        let clock = Instant::now();
        let ours = run.by_springs(&heights)?;
        let springs = clock.elapsed();
        let clock = Instant::now();
        let hard = run.by_a_hard_wall(&heights)?.report;
        let beside = |k: usize| match ours[k] == run.found[k] {
            true => ours[k].clone(),
            false => format!("{}, theirs {}", ours[k], run.found[k]),
        };
        figures += 4;
        agree += (0..4).filter(|&k| ours[k] == run.found[k]).count();
        println!(
            "| {} | {} | {} | {} | {} | {} min, {:.1} s | {:.6} | {:.6e}, {} | {:.1} s |",
            run.thickness,
            run.pressure,
            beside(0),
            beside(1),
            beside(3),
            run.minutes,
            springs.as_secs_f64(),
            hard.contact_fraction,
            hard.mean_gap,
            run.hard_gap,
            clock.elapsed().as_secs_f64()
        );
    }
    println!("{agree} of {figures} figures agree to all printed digits");
    Ok(())
}
