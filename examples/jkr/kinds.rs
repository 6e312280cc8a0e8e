//! Kinds of scenes: how often the true errors of area, gap, approach, pressure and pull-off are within the estimates.

use asperity::accuracy::{AccuratePullOff, Quantity};
use asperity::nested::Level;
use common::{Draw, Outcome, quantile};

use crate::case::head;
use crate::scene::{KINDS, Scene};

/// The difference of the finer grids beyond the difference of the coarser ones, as a share, which is a jump.
const JUMP: f64 = 0.01;

/// The true error and the estimate of a quantity of a scene.
type Pair = (f64, f64);

/// The findings on the scenes of a kind: errors of area, gap, approach, pressure and pull-off; and the errors of the area
/// by nodes, corrected, by energy, and less the zone, on a grid and on a grid twice as fine.
#[derive(Default)]
struct Tally {
    pairs: [Vec<Pair>; 5],
    areas: [[Vec<f64>; 4]; 2],
}

fn value(quantity: Quantity, level: &Level) -> f64 {
    match quantity {
        Quantity::Area => level.area.jkr_contact_fraction.unwrap_or(level.area.corrected_contact_fraction),
        Quantity::Gap => level.mean_gap,
        Quantity::Approach => level.approach.unwrap_or(f64::NAN),
        _ => level.mean_pressure,
    }
}

/// The value to which a grid and a grid of half as many nodes along the sides converge with the first order.
fn extrapolate(fine: f64, coarse: f64) -> f64 {
    2.0 * fine - coarse
}

impl Tally {
    /// Adds the solutions of a scene.
    fn add(&mut self, scene: &Scene) -> Outcome<()> {
        let control = scene.control()?;
        let (here, errors) = scene.solve(1, control)?;
        let [Ok((half, _)), Ok((fine, _))] = [2, 4].map(|finer| scene.solve(finer, control)) else { return Ok(()) };
        for (column, (quantity, error)) in errors.into_iter().enumerate() {
            let [a, b, c] = [&here, &half, &fine].map(|level| value(quantity, level));
            // the finest value where the state jumps between the grids
            let jumps = (c - b).abs() > (b - a).abs() + JUMP * c.abs();
            let truth = if jumps { c } else { extrapolate(c, b) };
            self.pairs[column].extend(error.map(|error| ((a / truth - 1.0).abs(), error.relative)));
            if quantity == Quantity::Area && !scene.free {
                for (errors, Level { area, adhesive_contact_fraction, .. }) in self.areas.iter_mut().zip([&here, &half])
                {
                    let energies = [*adhesive_contact_fraction, area.jkr_contact_fraction];
                    let [by_energy, less_zone] = energies.map(|area| area.unwrap_or(f64::NAN));
                    let all = [area.contact_fraction, area.corrected_contact_fraction, by_energy, less_zone];
                    errors.iter_mut().zip(all).for_each(|(errors, area)| errors.push((area / truth - 1.0).abs()));
                }
            }
        }
        Ok(())
    }
}

/// The true error and the estimate of a pull-off.
fn pull_off(scene: &Scene) -> Outcome<Option<Pair>> {
    let [here, half, fine] = [1, 2, 4].map(|finer| scene.pull_off(finer));
    let (Some(here), Some(half), Some(fine)) = (here?, half?, fine?) else { return Ok(None) };
    let Some((found, error)) = here.limit.zip(here.error.ok()) else { return Ok(None) };
    let tension = |found: &AccuratePullOff<f64>| -found.found.solution.report.mean_pressure;
    let by_zone =
        |found: &AccuratePullOff<f64>| Ok::<_, asperity::Error>(found.found.limit()?.unwrap_or(tension(found)));
    let above = extrapolate(tension(&fine), tension(&half));
    let below = extrapolate(by_zone(&fine)?, by_zone(&half)?);
    Ok(Some(((found / above.midpoint(below) - 1.0).abs(), error.relative)))
}

/// The table of all kinds, with the pull-off of each fourth scene; or of one kind, with the pull-off of each.
pub fn table(count: usize, seed: u64, only: Option<&str>) -> Outcome<()> {
    head(
        "Kinds of scenes: in how many the true error is within the estimate; medians of both in %",
        &["kind", "area", "gap", "approach", "pressure", "pull-off"],
    );
    let mut areas: [[Vec<f64>; 4]; 2] = Default::default();
    for (kind, number) in KINDS.into_iter().zip(0..).filter(|(kind, _)| only.is_none_or(|only| *kind == only)) {
        let (mut draw, mut tally) =
            (Draw((seed + 1000 * number).wrapping_mul(0x2545_f491_4f6c_dd1d)), Tally::default());
        for drawn in 0..count.div_ceil(KINDS.len()) {
            let mut scene = Scene::drawn(kind, &mut draw);
            tally.add(&scene)?;
            if only.is_some() || drawn % 4 == 0 {
                scene.n = 64;
                tally.pairs[4].extend(pull_off(&scene)?);
            }
        }
        println!("| {kind} | {} |", tally.pairs.map(|pairs| coverage(&pairs)).join(" | "));
        areas.iter_mut().flatten().zip(tally.areas.into_iter().flatten()).for_each(|(all, errors)| all.extend(errors));
    }
    head(
        "Periodic scenes: median errors of the area",
        &["nodes in the shortest wave", "nodes in contact", "corrected", "by energy", "less the zone"],
    );
    for (waves, mut errors) in ["8 to 16", "16 to 32"].into_iter().zip(areas) {
        let medians = errors.each_mut().map(|errors| format!("{:.2} %", 100.0 * quantile(errors, 0.5)));
        println!("| {waves} | {} |", medians.join(" | "));
    }
    Ok(())
}

fn coverage(pairs: &[Pair]) -> String {
    if pairs.is_empty() {
        return "–".to_owned();
    }
    let within = pairs.iter().filter(|(off, estimate)| off <= estimate).count();
    let median = |of: fn(&Pair) -> f64| 100.0 * quantile(&mut pairs.iter().map(of).collect::<Vec<_>>(), 0.5);
    format!("{within}/{}, {:.2} of {:.2}", pairs.len(), median(|pair| pair.0), median(|pair| pair.1))
}
