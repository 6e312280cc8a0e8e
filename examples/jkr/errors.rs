//! Random scenes: what a grid and one of half the nodes along its sides say of the limit, and what finer grids say.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use common::{Outcome, quantile};

use crate::case::{Areas, extrapolated, head, row};
use crate::estimate::Quantity;
use crate::scene::{Kind, Level, Scene};

/// The columns of the values that are written.
const COLUMNS: &str = "scene,kind,n,nodes,nodes_per_wave,hurst,k_l,k_s,slope,rms_height,work_of_adhesion,by_gap,\
                       pressure_given,loading,unloading,by_energy,corrected,counted,contact_nodes,perimeter,\
                       by_energy_unloading,contact_nodes_unloading,mean_gap,approach,pressure,contact_pressure,\
                       elastic_energy,stiffness,secant,pull_off,pull_off_reached,pull_off_by_energy,pull_off_corrected,\
                       pull_off_nodes,pull_off_perimeter,applications,applications_unloading,\
                       applications_stiffness,applications_pull_off";

pub fn tables(count: usize, seed: u64, quick: bool, path: &Path) -> Outcome<()> {
    let scenes = Scene::all(count, seed, quick);
    let mut file = BufWriter::new(File::create(path)?);
    writeln!(file, "{COLUMNS}")?;
    let mut all = Vec::new();
    for (id, scene) in scenes.iter().enumerate() {
        let levels = scene.levels()?;
        for level in &levels {
            writeln!(file, "{}", line(id, scene, level))?;
        }
        file.flush()?;
        all.push(levels);
    }
    let found: Vec<_> = scenes.iter().zip(&all).map(|(scene, levels)| (scene, &levels[..])).collect();
    let jumps = found.iter().filter(|(_, levels)| jumps(levels)).count();
    let differ = all.iter().filter(|levels| levels[1].areas.nodes != levels[1].unloading.nodes).count();
    println!(
        "\n{count} random scenes of seed {seed}; {jumps} jump to another state between the grids; on the grid itself \
         {differ} differ between loading and unloading"
    );
    brackets(&found);
    estimates(&found);
    println!("\nvalues in {}", path.display());
    Ok(())
}

/// A scene with its levels.
type Found<'a> = (&'a Scene, &'a [Level]);

/// Whether the state jumps between two grids: the area by energy changes more than it did from the grid before.
fn jumps(levels: &[Level]) -> bool {
    let areas: Vec<_> = levels.iter().map(|level| level.areas.by_energy).collect();
    let slack = 0.01 * areas[areas.len() - 1];
    areas[1..].windows(3).any(|areas| (areas[1] - areas[2]).abs() > (areas[0] - areas[1]).abs() + slack)
}

/// The limit of a quantity, by the two finest grids.
fn limit(quantity: Quantity, levels: &[Level]) -> f64 {
    let [.., finer, finest] = levels else { return f64::NAN };
    extrapolated(quantity.found(finest).value, quantity.found(finer).value)
}

fn share<'a, T: 'a>(of: impl IntoIterator<Item = &'a T>, holds: impl Fn(&T) -> bool) -> String {
    let (mut count, mut all) = (0_u32, 0_u32);
    for one in of {
        count += u32::from(holds(one));
        all += 1;
    }
    if all == 0 {
        return "–".to_owned();
    }
    format!("{:.1} %", 100.0 * f64::from(count) / f64::from(all))
}

/// The median, and what nine in ten do not exceed, in per cent.
fn quantiles(mut values: Vec<f64>) -> String {
    if values.is_empty() || values.iter().any(|value| value.is_nan()) {
        return "–".to_owned();
    }
    let mut at = |share| 100.0 * quantile(&mut values, share);
    format!("{:.2}, {:.2}", at(0.5), at(0.9))
}

fn quartiles(mut values: Vec<f64>) -> String {
    if values.is_empty() {
        return "–".to_owned();
    }
    let mut at = |share| quantile(&mut values, share);
    [0.25, 0.5, 0.75].map(|share| format!("{:.3}", at(share))).join(", ")
}

/// Whether the areas by energy and within the edge enclose the limit, and how good what is between them is.
fn brackets(found: &[Found<'_>]) {
    head(
        "The limit of the area: whether it is between the corrected one and that by energy, or within shares f of the zone \
         about the area less the zone; errors in %, the median and nine in ten",
        &[
            "nodes",
            "scenes",
            "excess of the area by energy over the edge, cells: quartiles",
            "enclosed",
            "half width",
            "middle ± ¾ half width",
            "zone",
            "f = ½",
            "f = ¾",
            "f = 1",
            "by energy",
            "corrected",
            "counted",
            "middle",
            "less the zone",
            "extrapolated",
        ],
    );
    for finer in 0..3 {
        for (name, wanted) in [("all", None), ("no jump", Some(false)), ("jump", Some(true))] {
            let chosen = |(_, levels): &&Found<'_>| {
                finer + 1 < levels.len() && wanted.is_none_or(|wanted| jumps(levels) == wanted)
            };
            let rows: Vec<_> = found
                .iter()
                .filter(chosen)
                .map(|(_, levels)| {
                    (levels[finer].areas, finer.checked_sub(1).map(|i| levels[i].areas), limit(Quantity::Area, levels))
                })
                .collect();
            let errors = |of: &dyn Fn(&Areas, Option<Areas>) -> f64| {
                quantiles(rows.iter().map(|(areas, coarse, limit)| (of(areas, *coarse) / limit - 1.0).abs()).collect())
            };
            let half = |areas: &Areas| 0.5 * (areas.by_energy - areas.corrected).abs();
            let within =
                |f: f64| share(&rows, |(areas, _, limit)| (areas.less_zone() - limit).abs() <= f * areas.zone());
            let nodes = ["n/2", "n", "2n"][finer];
            row(&[
                nodes.to_owned() + ", " + name,
                rows.len().to_string(),
                quartiles(rows.iter().map(|(areas, _, limit)| (areas.by_energy - limit) / areas.edge).collect()),
                share(&rows, |(areas, _, limit)| (areas.middle() - limit).abs() <= half(areas)),
                quantiles(rows.iter().map(|(areas, _, limit)| half(areas) / limit).collect()),
                share(&rows, |(areas, _, limit)| (areas.middle() - limit).abs() <= 0.75 * half(areas)),
                quantiles(rows.iter().map(|(areas, _, limit)| areas.zone() / limit).collect()),
                within(0.5),
                within(0.75),
                within(1.0),
                errors(&|areas, _| areas.by_energy),
                errors(&|areas, _| areas.corrected),
                errors(&|areas, _| areas.counted),
                errors(&|areas, _| areas.middle()),
                errors(&|areas, _| areas.less_zone()),
                errors(&|areas, coarse| {
                    coarse.map_or(f64::NAN, |coarse| extrapolated(areas.by_energy, coarse.by_energy))
                }),
            ]);
        }
    }
}

/// The estimated errors next to the true ones, where the shortest wave has four nodes on the coarsest grid that is
/// asked.
fn estimates(found: &[Found<'_>]) {
    head(
        "What is reported on n and 2n, its error by two grids and by one: errors in %, the median and nine in ten; shares \
         of scenes in which the estimate is no less than the true error, and more than four and ten times that: of all, of \
         the sure ones, and of the rough ones",
        &[
            "quantity",
            "grids",
            "solutions",
            "jumps",
            "rough",
            "found",
            "less the zone",
            "zone",
            "difference, less the zone",
            "estimate",
            "true ≤ estimate",
            "estimate > 4 true",
            "> 10 true",
        ],
    );
    for quantity in Quantity::ALL {
        for grids in [2, 1] {
            let rows: Vec<_> = found.iter().flat_map(|found| estimated(quantity, grids, found)).collect();
            let column = |of: fn(&Estimated) -> f64| quantiles(rows.iter().map(of).collect());
            let shares = |holds: fn(&Estimated) -> bool| {
                let of = |rough: bool| share(rows.iter().filter(|row| row.rough == rough), holds);
                [share(&rows, holds), of(false), of(true)].join(", ")
            };
            row(&[
                quantity.name().to_owned(),
                grids.to_string(),
                rows.len().to_string(),
                share(&rows, |row| row.jumps),
                share(&rows, |row| row.rough),
                column(|row| row.found),
                column(|row| row.less_zone),
                column(|row| row.zone),
                if grids == 2 { column(|row| row.difference) } else { String::new() },
                column(|row| row.estimate),
                shares(|row| row.truth <= row.estimate),
                shares(|row| row.estimate > 4.0 * row.truth),
                shares(|row| row.estimate > 10.0 * row.truth),
            ]);
        }
    }
}

/// The errors of a quantity on a grid, relative to its limit.
struct Estimated {
    found: f64,
    less_zone: f64,
    zone: f64,
    difference: f64,
    /// Of what is reported.
    truth: f64,
    estimate: f64,
    rough: bool,
    jumps: bool,
}

/// On the grids of n and 2n nodes, by so many grids.
fn estimated(quantity: Quantity, grids: usize, &(scene, levels): &Found<'_>) -> Vec<Estimated> {
    if !quantity.is_found(scene) {
        return Vec::new();
    }
    let (limit, finest) = (limit(quantity, levels), &levels[levels.len() - 1]);
    let scale = quantity.scale(limit, finest);
    let levels_told = (1..3).filter(|&finer| finer + 1 < levels.len() && scene.resolves(levels[finer + 1 - grids].n));
    let of = |finer: usize| {
        let (fine, coarse) = (&levels[finer], (grids == 2).then(|| &levels[finer - 1]));
        let (here, half) = (quantity.found(fine), quantity.found(&levels[finer - 1]));
        let rough = quantity.is_rough(fine, coarse);
        let far = |value: f64| (value - limit).abs() / scale;
        Estimated {
            found: far(here.value),
            less_zone: far(here.less_zone()),
            zone: here.zone.abs() / scale,
            difference: (here.less_zone() - half.less_zone()).abs() / scale,
            truth: far(quantity.reported(&here)),
            estimate: quantity.error(&here, coarse.map(|_| &half), rough) / scale,
            rough,
            jumps: jumps(levels),
        }
    };
    let rows = levels_told.map(of);
    rows.filter(|row| [row.truth, row.estimate, row.difference].iter().all(|value| value.is_finite())).collect()
}

fn line(id: usize, scene: &Scene, level: &Level) -> String {
    let kind = if scene.kind == Kind::Sphere { "sphere" } else { "periodic" };
    let [hurst, k_l, k_s] = scene.roughness.map_or([0.0; 3], |of| [of.hurst, of.k_l, of.k_s]);
    let (areas, back) = (&level.areas, &level.unloading);
    let [loading, unloading] = level.statuses.map(asperity::Status::name);
    let lost = |of: fn(&Areas) -> f64| level.lost.as_ref().map_or(f64::NAN, of).to_string();
    let words: Vec<String> = vec![
        id.to_string(),
        kind.to_owned(),
        scene.n.to_string(),
        level.n.to_string(),
        scene.nodes_per_wave.to_string(),
        hurst.to_string(),
        k_l.to_string(),
        k_s.to_string(),
        scene.slope.to_string(),
        level.rms_height.to_string(),
        scene.work_of_adhesion.to_string(),
        u8::from(scene.by_gap).to_string(),
        scene.pressure.to_string(),
        loading.to_owned(),
        unloading.to_owned(),
        areas.by_energy.to_string(),
        areas.corrected.to_string(),
        areas.counted.to_string(),
        areas.nodes.to_string(),
        areas.perimeter.to_string(),
        back.by_energy.to_string(),
        back.nodes.to_string(),
        level.gap.to_string(),
        level.approach.to_string(),
        level.pressure.to_string(),
        level.contact_pressure.to_string(),
        level.elastic_energy.to_string(),
        level.stiffness.to_string(),
        level.secant.to_string(),
        level.pull_off.to_string(),
        u8::from(level.pulled).to_string(),
        lost(|areas| areas.by_energy),
        lost(|areas| areas.corrected),
        lost(|areas| areas.nodes as f64),
        lost(|areas| areas.perimeter),
    ];
    let applications = level.applications.map(|taken| taken.to_string());
    words.into_iter().chain(applications).collect::<Vec<_>>().join(",")
}
