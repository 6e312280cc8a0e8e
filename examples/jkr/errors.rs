//! Random scenes: what a grid and one of half the nodes along its sides say of the limit, and what finer grids say.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use common::Outcome;

use crate::case::Areas;
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
    for (id, scene) in scenes.iter().enumerate() {
        let levels = scene.levels()?;
        for level in &levels {
            writeln!(file, "{}", line(id, scene, level))?;
        }
        file.flush()?;
    }
    println!("\nvalues in {}", path.display());
    Ok(())
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
