//! Other shapes of the law, and other steepest slopes.

use std::f64::consts::PI;

use asperity::exact::Sphere;
use asperity::{Branch, Control, Grid, Problem};
use common::Outcome;

use crate::case::{Areas, half_space, head, pull_off, row, solve, tension};
use crate::law::{Shape, Short};
use crate::rough::{AREA, surface};
use crate::sphere;
use crate::wave::Wave;

const SLOPES: [f64; 7] = [0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.5];
const BRACKET: f64 = 0.005;

pub fn tables(quick: bool) -> Outcome<()> {
    let (line, window, side) = if quick { (128, 32, 64) } else { (512, 64, 256) };
    head(
        &format!(
            "Shapes of the law and their steepest slope c E*/Δx: the wave on {line} nodes (straight fronts), the sphere on \
             {window}², and a rough surface on {side}², rms slope 1, k 1 to 16, w = 7e-5, p̄ = 0.01, seed 3"
        ),
        &[
            "shape",
            "c",
            "wave: pull-off",
            "largest error of the area",
            "there − back",
            "applications",
            "sphere: radius by energy",
            "its excess area over the edge, cells",
            "approach",
            "pull-off",
            "applications: at rest, pull-off",
            "rough: area by energy",
            "corrected",
            "nodes unloading − loading",
            "applications: loading, unloading",
        ],
    );
    for shape in Shape::ALL {
        for steepest in shape.slopes(if quick { &[0.25] } else { &SLOPES }) {
            let wave = Wave::line(line)?;
            let law = Short::new(wave.work_of_adhesion(), shape, steepest);
            let ((areas, taken), (off, of_search)) = (wave.areas(law)?, wave.pull_off(law)?);
            let largest = areas.iter().fold(0.0_f64, |most, area| most.max((area - 1.0).abs()));
            let apart = (0..3).fold(0.0_f64, |most, i| most.max((areas[6 - i] / areas[i] - 1.0).abs()));
            let mut line = vec![shape.name_at(steepest), format!("{steepest:.3}")];
            line.extend([off, largest, apart].map(|value| format!("{value:.4}")));
            line.push(format!("{taken}, {of_search}"));

            let exact = sphere::exact()?;
            let at_rest = exact.at_load(0.0)?;
            let mut problem = sphere::problem(window, Short::new(sphere::WORK, shape, steepest))?;
            let rest = solve(&mut problem, Control::Force(0.0), Branch::Loading)?;
            let found = pull_off(&mut problem, BRACKET, None)?;
            let area = sphere::SIDE * sphere::SIDE;
            let of_rest = Areas::of(&rest)?;
            let radius = (area * of_rest.by_energy / PI).sqrt();
            let excess = of_rest.by_energy - PI * at_rest.contact_radius().powi(2) / area;
            line.extend(
                [
                    radius / at_rest.contact_radius(),
                    excess / of_rest.edge,
                    rest.report.approach.unwrap_or(f64::NAN) / at_rest.approach(),
                    -tension(&found) * area / exact.pull_off().load(),
                ]
                .map(|value| format!("{value:.4}")),
            );
            line.push(format!("{}, {}", rest.report.operator_applications, found.operator_applications));

            let grid = Grid::square(side, 1.0)?;
            let law = Short::new(AREA.work_of_adhesion, shape, steepest);
            let mut problem = Problem::new(&surface(AREA, grid, 3)?, half_space(grid)?, law)?;
            let control = Control::MeanPressure(AREA.load);
            let [loading, unloading] =
                [Branch::Loading, Branch::Unloading].map(|branch| solve(&mut problem, control, branch));
            let (loading, unloading) = (loading?, unloading?);
            let areas = Areas::of(&loading)?;
            let (there, back) = (&loading.report, &unloading.report);
            line.push(format!("{:.3} %", 100.0 * areas.by_energy));
            line.push(format!("{:.3} %", 100.0 * areas.corrected));
            line.push((back.contact_nodes as i64 - there.contact_nodes as i64).to_string());
            line.push(format!("{}, {}", there.operator_applications, back.operator_applications));
            row(&line);
        }
    }
    held_fronts(quick)
}

/// The pull-off of the wave on many grids: its fronts are straight, and their place between the nodes is by chance.
fn held_fronts(quick: bool) -> Outcome<()> {
    let grids = if quick { vec![128, 150] } else { vec![360, 400, 450, 486, 512, 540, 576, 600, 640, 720, 800, 1024] };
    let title = format!("Pull-off of the wave over the exact one, and the range over √(wΔx/E*), on {grids:?} nodes");
    head(&title, &["shape", "c", "range", "least", "mean", "largest", "applications in the mean"]);
    for shape in [Shape::HalfCosine, Shape::CubicStep, Shape::QuinticStep, Shape::Square] {
        for steepest in shape.slopes(if quick { &[0.25] } else { &[0.15, 0.2, 0.25, 0.3, 0.35] }) {
            let (mut found, mut applications) = (Vec::new(), 0);
            for &n in &grids {
                let wave = Wave::line(n)?;
                let (off, taken) = wave.pull_off(Short::new(wave.work_of_adhesion(), shape, steepest))?;
                found.push(off);
                applications += taken;
            }
            let count = found.len();
            found.sort_by(f64::total_cmp);
            let mut line = vec![shape.name_at(steepest), format!("{steepest:.3}")];
            line.push(format!("{:.2}", shape.range(steepest)));
            line.extend(
                [found[0], found.iter().sum::<f64>() / count as f64, found[count - 1]].map(|x| format!("{x:.4}")),
            );
            line.push((applications / count).to_string());
            row(&line);
        }
    }
    Ok(())
}
