//! Figure 8: the contact area over the load, with its tangents at the origin.

use std::f64::consts::PI;
use std::path::Path;

use common::Outcome;
use common::legend::legend;
use plotters::coord::Shift;
use plotters::prelude::*;

use crate::{Curve, Point, RANGE, SMALL, named};

type Panel<'a> = DrawingArea<SVGBackend<'a>, Shift>;

const COLOURS: [RGBColor; 4] = [BLACK, RGBColor(10, 90, 200), RGBColor(225, 110, 20), RGBColor(160, 20, 30)];

/// Which of the two loads is meant.
#[derive(Clone, Copy, PartialEq)]
pub enum Load {
    External,
    Contact,
}

impl Load {
    fn value(self, point: &Point) -> f64 {
        match self {
            Self::External => point.external,
            Self::Contact => point.contact,
        }
    }
}

/// Area at no load, and slope there, of the parabola through the small loads with the least relative errors.
///
/// There is no area at no load without adhesion, nor under no contact pressure. Over the external pressure the curves
/// with adhesion get steeper towards the tension at which the surfaces part, so that their slope depends on the range
/// of the fit.
pub fn tangent(points: &[Point], load: Load, area: fn(&Point) -> f64, work: f64) -> (f64, f64) {
    let small = points.iter().filter(|p| p.external > 0.0 && p.external <= SMALL * (1.0 + 1e-9));
    let small: Vec<(f64, f64)> = small.map(|p| (load.value(p), area(p))).collect();
    let largest = small.iter().fold(f64::MIN_POSITIVE, |m, p| m.max(p.0));
    let first = usize::from(work == 0.0 || load == Load::Contact);
    // the normal equations of area/x = Σ cₖ xᵏ⁻¹, x in units of the largest load
    let mut rows = [[0.0; 4]; 3];
    for (x, area) in small.iter().map(|(x, area)| (x / largest, area)) {
        let powers = [x.recip(), 1.0, x];
        for i in first..3 {
            (first..3).for_each(|j| rows[i][j] += powers[i] * powers[j]);
            rows[i][3] += powers[i] * area / x;
        }
    }
    for i in first..3 {
        for j in (first..3).filter(|j| *j != i) {
            let (factor, row) = (rows[j][i] / rows[i][i], rows[i]);
            rows[j].iter_mut().zip(row).for_each(|(x, y)| *x -= factor * y);
        }
    }
    let offset = if first == 0 { rows[0][3] / rows[0][0] } else { 0.0 };
    (offset, rows[1][3] / rows[1][1] / largest)
}

/// κ of points (load, area).
pub fn slope_without_adhesion(points: &[(f64, f64)]) -> f64 {
    let points: Vec<Point> =
        points.iter().map(|&(x, area)| Point { external: x, contact: x, nodes: area, corrected: area }).collect();
    tangent(&points, Load::External, |p| p.nodes, 0.0).1
}

/// Load and area extrapolated to Δx = 0 from two grids: from nodes, with an error of first order, and from areas within
/// the edge, with an error nearly of second order.
pub fn extrapolate(fine: &Curve, coarse: Option<&Curve>) -> Option<[Vec<(f64, f64)>; 2]> {
    let coarse = coarse?;
    let finer = fine.n as f64 / coarse.n as f64;
    let [nodes, corrected]: [fn(&Point) -> f64; 2] = [|p| p.nodes, |p| p.corrected];
    Some([(nodes, 1), (corrected, 2)].map(|(area, order)| {
        let share = (finer.powi(order) - 1.0).recip();
        let pairs = fine.points.iter().zip(&coarse.points);
        pairs.map(|(fine, coarse)| (fine.external, area(fine) + share * (area(fine) - area(coarse)))).collect()
    }))
}

/// Area over the external pressure, its beginning, and over the mean contact pressure.
pub fn figure8(path: &Path, size: usize, curves: &[Curve], limit: Option<&[(f64, f64)]>) -> Outcome<()> {
    let root = SVGBackend::new(path, (1560, 640)).into_drawing_area();
    root.fill(&WHITE)?;
    let title = format!(
        "Figure 8: contact area against load, rms slope 0.1, exponential adhesion of range ρ = {RANGE:e} L, {size} × {size} nodes, unloading"
    );
    let root = root.titled(&title, ("sans-serif", 20))?;
    let panels = root.split_evenly((1, 3));
    let external = "external mean pressure p̄ / (E* h'rms)";
    panel(&panels[0], external, Load::External, (0.052, 0.32), curves, limit)?;
    panel(&panels[1], &format!("{external}, its beginning"), Load::External, (0.0052, 0.07), curves, limit)?;
    panel(&panels[2], "mean contact pressure ⟨λ⟩ / (E* h'rms)", Load::Contact, (0.052, 0.15), curves, limit)?;
    root.present()?;
    Ok(())
}

fn panel(
    area: &Panel<'_>,
    abscissa: &str,
    load: Load,
    (right, top): (f64, f64),
    curves: &[Curve],
    limit: Option<&[(f64, f64)]>,
) -> Outcome<()> {
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(20)
        .x_label_area_size(48)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..right, 0.0..100.0 * top)?;
    let decimals = if right < 0.01 { 3 } else { 2 };
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc(abscissa)
        .y_desc("contact area A / A₀, by nodes (%)")
        .x_labels(6)
        .y_labels(8)
        .x_label_formatter(&|x| format!("{x:.decimals$}"))
        .y_label_formatter(&|y| format!("{y:.0}"))
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 16))
        .draw()?;
    let inside = |p: &(f64, f64)| p.0 <= right && p.1 <= 100.0 * top;
    let [low, high] = [(8.0 / PI).sqrt(), (2.0 * PI).sqrt()].map(|slope| (right, 100.0 * slope * right));
    let grey = RGBColor(150, 150, 150).mix(0.35);
    chart
        .draw_series([Polygon::new(vec![(0.0, 0.0), low, high], grey)])?
        .label("κ from 1.60 (Persson) to 2.51 (BGT)")
        .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 24, y + 5)], grey.filled()));
    for (curve, colour) in curves.iter().zip(COLOURS) {
        let points: Vec<_> =
            curve.points.iter().map(|p| (load.value(p), 100.0 * p.nodes)).filter(|p| inside(p)).collect();
        let (offset, slope) = tangent(&curve.points, load, |p| p.nodes, curve.work);
        // (the tangent as far as there is room)
        let end = right.min((top - offset) / slope).min(SMALL);
        let line = [0.0, end].map(|x| (x, 100.0 * (offset + slope * x)));
        chart.draw_series(DashedLineSeries::new(line, 3, 4, colour.stroke_width(1)))?;
        let label = format!("{}, κ = {slope:.2}", named(curve.work));
        chart.draw_series(LineSeries::new(points.clone(), colour.stroke_width(2)))?;
        chart
            .draw_series(points.into_iter().map(|p| Circle::new(p, 4, colour.filled())))?
            .label(label)
            .legend(move |(x, y)| Circle::new((x + 12, y), 4, colour.filled()));
    }
    if let Some(limit) = limit {
        let ring = BLACK.stroke_width(1);
        let points: Vec<_> = limit.iter().map(|(x, area)| (*x, 100.0 * area)).filter(|p| inside(p)).collect();
        chart
            .draw_series(points.into_iter().map(|p| Circle::new(p, 6, ring)))?
            .label(format!("w = 0, Δx → 0: κ = {:.2}", slope_without_adhesion(limit)))
            .legend(move |(x, y)| Circle::new((x + 12, y), 6, ring));
    }
    legend(&mut chart, SeriesLabelPosition::UpperLeft)?;
    Ok(())
}
