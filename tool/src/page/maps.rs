//! The maps and the histograms of a solve.

use asperity::Grid;
use asperity_maps::io::read_field;
use asperity_plot::{Chart, Colouring, Distribution, Map, Paper};
use asperity_scene::{Account, Adhesion, Boundary, Inputs, Outcome, Units, key};
use ndarray::Zip;
use serde_json::Value;

use super::{FINE, Page};
use crate::pictures::{MapColours, draw_contact, draw_pressure, mark_yielded};
use crate::solved::Solved;

/// The finest resolution of the maps.
const FINEST: f64 = 1200.0;
/// The share of w/ρ from which on attraction is shown, as in the column `attractive_fraction`.
const NOTICEABLE: f64 = 0.01;
/// The number of classes of a distribution.
const CLASSES: usize = 60;

/// The resolution of a map with a pixel for each of the nodes along its longer side, which are 0.25 to 0.5 points wide.
pub fn resolution(nodes: u64) -> Paper {
    (0.288 * nodes as f64).clamp(FINE, FINEST).into()
}

/// The traction from which on attraction is shown. The traction of the law is what the contact pressure has more than the
/// elastic one.
fn noticeable(report: &Value) -> f64 {
    let number = |key: &str| report[key].as_f64();
    let law = number(key!(Adhesion, work_of_adhesion)).zip(number(key!(Adhesion, range)));
    law.map_or(f64::INFINITY, |(w, range)| NOTICEABLE * w / range)
}

/// Puts the maps of a solve on a page, with histograms of gap and pressure.
pub fn draw(page: &mut Page, solved: &Solved<'_>, units: &Units, colours: &MapColours) -> Outcome<()> {
    let Solved { folder, report } = solved;
    let [gap, pressure, contact_pressure] =
        ["gap", "pressure", "contact_pressure"].map(|name| read_field(folder.join(format!("{name}.npy"))));
    let (gap, pressure, contact_pressure) = (gap?, pressure?, contact_pressure?);
    let side = |k: usize| report[key!(Inputs, lengths)][k].as_f64().unwrap_or(1.0);
    let grid = Grid::new(gap.dim(), (side(0), side(1)))?;
    if [pressure.dim(), contact_pressure.dim()] != [gap.dim(); 2] {
        return Err("gap, pressure and contact pressure have not one shape: they are of different runs".into());
    }
    let (length, pressure_unit) = (units.length.as_deref(), units.pressure.as_deref());

    let adhesive = report[key!(Adhesion, law)].as_str() != Some("none");
    let least = if adhesive { noticeable(report) } else { f64::INFINITY };
    let mut regions = Zip::from(&gap).and(&pressure).and(&contact_pressure).map_collect(|&gap, &pressure, &contact| {
        match contact - pressure {
            _ if contact > 0.0 || gap <= 0.0 => 1.0,
            _ if gap.is_nan() => f64::NAN,
            traction if traction > least => -1.0,
            _ => 0.0,
        }
    });
    if report[key!(Account, plastic_fraction)].is_number() {
        let depth = read_field(folder.join("plastic_depth.npy"))?;
        if depth.dim() == gap.dim() {
            mark_yielded(&mut regions, depth.view());
        }
    }
    let paper = resolution(gap.dim().0.max(gap.dim().1) as u64);
    let clusters = colours.clusters(solved.boundary() == Boundary::Periodic);
    let contact = draw_contact(grid, "Contact", units, &regions, clusters, paper)?;
    let drawn = if adhesive { &pressure } else { &contact_pressure };
    let pressures = draw_pressure(grid, ("Pressure", ""), units, drawn, colours.limits(), paper)?;
    let gaps = Map {
        title: "Gap",
        length_unit: length,
        label: "gap",
        unit: length,
        ..Map::new(gap.view(), grid, Colouring::Sequential)
    };
    let gaps = gaps.draw(paper)?;
    for map in [contact, pressures, gaps] {
        page.map(&map, grid.lengths(), length)?;
    }
    let gap = ("gap", length, &gap, "nodes apart");
    for (x_label, x_unit, field, y_label) in
        [gap, ("contact pressure", pressure_unit, &contact_pressure, "nodes in contact")]
    {
        let title = &format!("Distribution of the {x_label}");
        let Distribution { curve, beyond, .. } =
            Distribution::from_values(field.iter().copied().filter(|value| *value > 0.0), CLASSES, x_unit);
        let axes = Chart { title, caption: &beyond, x_label, x_unit, y_label, y_unit: Some("%"), ..Chart::default() };
        page.figure(&Chart { curves: vec![("", curve)], ..axes }.draw(FINE)?.svg()?);
    }
    Ok(())
}
