//! Self-affine surfaces on grids from coarse to fine: the pull-off, and the area.

use asperity::{AdhesionLaw, Amplitude, Branch, Control, Grid, Jkr, Problem, Result, SelfAffine, Surface};
use common::Outcome;

use crate::case::{Areas, extrapolated, half_space, head, pull_off, row, solve, tension};

/// A rough surface with adhesion on a half-space of contact modulus one.
#[derive(Clone, Copy)]
pub struct Rough {
    pub slope: f64,
    pub shortest: f64,
    pub work_of_adhesion: f64,
    pub load: f64,
}

/// The surfaces for pull-offs, and the surfaces for areas.
pub const PULL_OFF: Rough = Rough { slope: 0.5, shortest: 8.0, work_of_adhesion: 1.5e-3, load: 0.02 };
pub const AREA: Rough = Rough { slope: 1.0, shortest: 16.0, work_of_adhesion: 7e-5, load: 0.01 };
const SEEDS: [u64; 6] = [3, 11, 12, 13, 14, 15];
const BRACKET: f64 = 0.005;

pub fn surface(rough: Rough, grid: Grid, seed: u64) -> Result<Surface> {
    let of = SelfAffine::default().k_l(1.0).k_r(1.0).k_s(rough.shortest).seed(seed);
    of.amplitude(Amplitude::RmsSlope(rough.slope)).surface(grid)
}

/// The surface on a grid of n² nodes.
pub fn problem(rough: Rough, n: usize, seed: u64, law: impl AdhesionLaw<f64> + 'static) -> Result<Problem<f64>> {
    let grid = Grid::square(n, 1.0)?;
    Problem::new(&surface(rough, grid, seed)?, half_space(grid)?, law)
}

pub fn tables(quick: bool, largest: usize) -> Outcome<()> {
    let sizes: Vec<usize> = (6..=largest.ilog2()).map(|power| 1 << power).collect();
    let seeds = if quick { &SEEDS[..1] } else { &SEEDS[..] };
    let names: Vec<_> = sizes.iter().map(|n| format!("{n}²")).collect();
    let columns = |first: &[&'static str], last: &[&'static str]| -> Vec<String> {
        let first = first.iter().map(|&name| name.to_owned());
        first.chain(names.iter().cloned()).chain(last.iter().map(|&name| name.to_owned())).collect()
    };
    let refer = |columns: &[String]| {
        let Rough { slope, shortest, work_of_adhesion, load } = PULL_OFF;
        let title = format!(
            "Pull-off, rms slope {slope}, k 1 to {shortest}, w = {work_of_adhesion}, preload {load}: mean tension, and \
             over the one extrapolated from the two finest"
        );
        head(&title, &columns.iter().map(String::as_str).collect::<Vec<_>>());
    };
    refer(&columns(&["seed"], &["limit", "over the limit", "less the zone", "applications"]));
    for &seed in seeds {
        let (mut values, mut less, mut applications) = (Vec::new(), Vec::new(), Vec::new());
        for &n in &sizes {
            let found = pull_off(
                &mut problem(PULL_OFF, n, seed, Jkr::new(PULL_OFF.work_of_adhesion)?)?,
                BRACKET,
                Some(PULL_OFF.load),
            )?;
            values.push(tension(&found));
            less.push(tension(&found) * (1.0 - Areas::of(&found.solution)?.zone_share()));
            applications.push(found.operator_applications.to_string());
        }
        let limit = extrapolated(values[values.len() - 1], values[values.len() - 2]);
        let mut line = vec![seed.to_string()];
        line.extend(values.iter().map(|value| format!("{value:.4e}")));
        line.push(format!("{limit:.4e}"));
        line.push(values.iter().map(|value| format!("{:.3}", value / limit)).collect::<Vec<_>>().join(", "));
        line.push(less.iter().map(|value| format!("{:.3}", value / limit)).collect::<Vec<_>>().join(", "));
        line.push(applications.join(", "));
        row(&line);
    }
    let Rough { slope, shortest, work_of_adhesion, load } = AREA;
    head(
        &format!(
            "Area, rms slope {slope}, k 1 to {shortest}, w = {work_of_adhesion}, p̄ = {load}: shares in %, and over the \
             limit, that by energy extrapolated from the two finest"
        ),
        &[
            "seed",
            "nodes",
            "by energy",
            "less its zone",
            "corrected",
            "middle",
            "counted",
            "over the limit",
            "mean gap",
            "nodes unloading − loading",
            "applications: loading, unloading",
        ],
    );
    for &seed in seeds {
        let mut levels = Vec::new();
        for &n in &sizes {
            let mut problem = problem(AREA, n, seed, Jkr::new(AREA.work_of_adhesion)?)?;
            let [loading, unloading] = [Branch::Loading, Branch::Unloading]
                .map(|branch| solve(&mut problem, Control::MeanPressure(load), branch));
            levels.push((n, Areas::of(&loading?)?, Areas::of(&unloading?)?));
        }
        for &(n, areas, back) in &levels {
            let [finer, finest] = [levels[levels.len() - 2], levels[levels.len() - 1]];
            let limit = extrapolated(finest.1.by_energy, finer.1.by_energy);
            let all = [areas.by_energy, areas.less_zone(), areas.corrected, areas.middle(), areas.counted];
            let mut line = vec![seed.to_string(), format!("{n}²")];
            line.extend(all.map(|area| format!("{:.3}", 100.0 * area)));
            line.push(all.map(|area| format!("{:.3}", area / limit)).join(", "));
            line.push(format!("{:.4e}", areas.mean_gap));
            line.push((back.nodes as i64 - areas.nodes as i64).to_string());
            line.push(format!("{}, {}", areas.applications, back.applications));
            row(&line);
        }
    }
    Ok(())
}
