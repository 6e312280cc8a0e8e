//! Kinds of scenes: how often the true errors of area, gap, approach, pressure and pull-off are within the estimates.

use std::f64::consts::PI;

use asperity::accuracy::{AccuratePullOff, NoEstimate, Quantity};
use asperity::nested::Level;
use asperity::{Boussinesq, Control, Grid, Jkr, PullOff, Solver, Surface};
use common::{Outcome, quantile};

use crate::case::{extrapolate, head, row};
use crate::scene::{BRACKET, Draw, KINDS, Kind, SIDE, Scene, on_grid};

/// The nodes along a side of the coarsest grid on which a pull-off is found.
const SMALL: usize = 64;

/// The difference of the finer grids beyond the difference of the coarser ones, as a share, which is a jump.
const JUMP: f64 = 0.01;

/// Every so many scenes the pull-off is found.
const PULLED: usize = 4;

/// The columns of the table: quantities of a solution in the order of their errors, and the pull-off.
const COLUMNS: [&str; 5] = ["area", "gap", "approach", "pressure", "pull-off"];

/// The true error and the estimate of a quantity of a scene.
type Pair = (f64, f64);

/// What the scenes of a kind tell.
#[derive(Default)]
struct Tally {
    pairs: [Vec<Pair>; COLUMNS.len()],
    without_area: usize,
    /// The errors of the area: by nodes, corrected, by energy, and less the zone, on a grid and on a grid twice as fine.
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

/// The limit of a value on a grid and on two finer ones, by the finer two; the finest value where these differ by more
/// than the coarser two, as where the state jumps between them.
fn limit([here, half, fine]: [f64; 3]) -> f64 {
    let jumps = (fine - half).abs() > (half - here).abs() + JUMP * fine.abs();
    if jumps { fine } else { extrapolate(fine, half) }
}

impl Tally {
    /// Adds a scene, with the pull-off if it is asked for.
    fn add(&mut self, mut scene: Scene, with_pull_off: bool) -> Outcome<()> {
        let mut control = Control::MeanPressure(scene.pressure);
        if scene.by_gap {
            control = Control::MeanGap(scene.solve(1, control)?.0.last().map_or(0.0, |level| level.mean_gap));
        }
        let (levels, errors) = scene.solve(1, control)?;
        let [Ok((half, _)), Ok((fine, _))] = [2, 4].map(|finer| scene.solve(finer, control)) else { return Ok(()) };
        let [Some(here), Some(half), Some(fine)] = [levels.last(), half.last(), fine.last()] else { return Ok(()) };
        for (column, (quantity, error)) in errors.iter().enumerate() {
            let values = [here, half, fine].map(|level| value(*quantity, level));
            let truth = limit(values);
            if let Some(error) = error {
                self.pairs[column].push(((values[0] / truth - 1.0).abs(), error.relative));
            } else if *quantity == Quantity::Area {
                self.without_area += 1;
            }
            if *quantity == Quantity::Area && !scene.free {
                for (errors, Level { area, adhesive_contact_fraction, .. }) in self.areas.iter_mut().zip([here, half]) {
                    let by_energy = adhesive_contact_fraction.unwrap_or(f64::NAN);
                    let less_zone = area.jkr_contact_fraction.unwrap_or(f64::NAN);
                    let all = [area.contact_fraction, area.corrected_contact_fraction, by_energy, less_zone];
                    errors.iter_mut().zip(all).for_each(|(errors, area)| errors.push((area / truth - 1.0).abs()));
                }
            }
        }
        if with_pull_off {
            scene.n = SMALL;
            self.pairs[4].extend(pull_off(&scene)?);
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
    let kinds = KINDS.iter().zip(0..).filter(|(kind, _)| only.is_none_or(|only| kind.name == only));
    let mut tallies: Vec<(&Kind, Tally)> = Vec::new();
    for (kind, number) in kinds {
        let (mut draw, mut tally) = (Draw::new(seed + 1000 * number), Tally::default());
        for scene in 0..count.div_ceil(KINDS.len()) {
            tally.add(Scene::drawn(kind, &mut draw), only.is_some() || scene % PULLED == 0)?;
        }
        tallies.push((kind, tally));
    }
    head(
        "Kinds of scenes: in how many the true error is within the estimate; medians of both in %; the estimates of zero \
         or below",
        &[&["kind"], &COLUMNS[..], &["no area"]].concat(),
    );
    for (kind, tally) in &tallies {
        let mut cells = vec![kind.name.to_owned()];
        cells.extend(tally.pairs.iter().map(|pairs| coverage(pairs)));
        cells.push(tally.without_area.to_string());
        row(&cells);
    }
    head(
        "Periodic scenes: median errors of the area",
        &["nodes in the shortest wave", "nodes in contact", "corrected", "by energy", "less the zone"],
    );
    for (grid, waves) in ["8 to 16", "16 to 32"].into_iter().enumerate() {
        let median = |area: usize| {
            let mut errors: Vec<_> = tallies.iter().flat_map(|(_, tally)| &tally.areas[grid][area]).copied().collect();
            format!("{:.2} %", 100.0 * quantile(&mut errors, 0.5))
        };
        row(&[waves.to_owned(), median(0), median(1), median(2), median(3)]);
    }
    Ok(())
}

fn coverage(pairs: &[Pair]) -> String {
    if pairs.is_empty() {
        return "–".to_owned();
    }
    let within = pairs.iter().filter(|(off, estimate)| off <= estimate).count();
    let none = pairs.iter().filter(|(_, estimate)| *estimate <= 0.0).count();
    let median = |of: fn(&Pair) -> f64| 100.0 * quantile(&mut pairs.iter().map(of).collect::<Vec<_>>(), 0.5);
    let none = if none > 0 { format!(", {none} ≤ 0") } else { String::new() };
    format!("{within}/{}, {:.2} of {:.2}{none}", pairs.len(), median(|pair| pair.0), median(|pair| pair.1))
}

/// Spheres with contact radii, by the theory of Johnson, Kendall and Roberts, of a share of a node to several nodes:
/// how many have a pull-off within its error, and how many a reason for no error.
pub fn spheres(count: usize) -> Outcome<()> {
    let nodes = 64;
    let [mut within, mut missed, mut few, mut others] = [0; 4];
    for sphere in 0..count {
        let radius = 0.1 * 60_f64.powf(sphere as f64 / (count - 1) as f64) * SIDE / nodes as f64;
        let work = 8.0 * radius.powi(3) / (9.0 * PI);
        let surface = Surface::paraboloid(Grid::square(nodes, SIDE)?, 1.0)?;
        let half_space = |grid| Boussinesq::<f64>::new(grid, 1.0);
        let search = PullOff::default().tolerance(BRACKET);
        let found = on_grid().pull_off(&mut Solver::default(), &surface, half_space, Jkr::new(work)?, &search)?;
        match (found.limit, found.error) {
            (Some(limit), Ok(error)) => {
                let holds = (limit * SIDE * SIDE / (1.5 * PI * work) - 1.0).abs() <= error.relative;
                *(if holds { &mut within } else { &mut missed }) += 1;
            }
            (_, Err(NoEstimate::FewNodes { .. })) => few += 1,
            _ => others += 1,
        }
    }
    println!(
        "\n{count} spheres of contact radii of 0.1 to 6 nodes: {within} pull-offs within the error, {missed} not, {few} of a \
         few nodes, {others} without an error for another reason"
    );
    Ok(())
}
