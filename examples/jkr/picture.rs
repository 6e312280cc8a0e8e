//! A picture of the pull-off over the number of nodes: what laws with a range and without say on coarse grids.

use std::path::Path;

use asperity::exact::Sphere;
use asperity::{Exponential, Jkr, Problem};
use common::Outcome;
use common::chart::COLOURS;
use plotters::coord::Shift;
use plotters::prelude::*;

use crate::case::{Areas, head, pull_off, row, tension};
use crate::estimate::{Found, Quantity};
use crate::{rough, sphere};

const BRACKET: f64 = 0.005;
const SEED: u64 = 3;
/// The range of the law that has one, on the rough surface.
const RANGE: f64 = 2e-3;
/// The resolution measures of the laws with a range on the sphere.
const MEASURES: [f64; 2] = [0.5, 2.0];

/// Nodes along a side of the coarsest grid that is drawn.
const COARSEST: usize = 32;

/// Pull-offs over the nodes along a side.
type Points = Vec<(f64, f64)>;

/// By the law without a range: as found, less the zone, and the error of the latter.
#[derive(Default)]
struct Short {
    found: Points,
    less_zone: Points,
    errors: Vec<f64>,
}

impl Short {
    /// On the grids that are drawn, of those that are found.
    fn of(sizes: &[usize], unit: f64, find: impl Fn(usize) -> Outcome<(f64, Areas)>) -> Outcome<Self> {
        let (mut of, mut coarse) = (Self::default(), None);
        for &n in sizes {
            let (pull_off, areas) = find(n)?;
            let found = Found { value: pull_off / unit, zone: pull_off / unit * areas.zone_share() };
            if n >= COARSEST {
                of.found.push((n as f64, found.value));
                of.less_zone.push((n as f64, found.less_zone()));
                of.errors.push(Quantity::PullOff.error(&found, coarse.as_ref(), false));
            }
            coarse = Some(found);
        }
        Ok(of)
    }
}

/// Draws the pull-offs of a rough surface and of a sphere.
pub fn draw(quick: bool, path: &Path) -> Outcome<()> {
    let root = SVGBackend::new(path, (1200, 560)).into_drawing_area();
    root.fill(&WHITE)?;
    let (left, right) = root.split_horizontally(600);
    of_rough(if quick { 64 } else { 512 }, &left)?;
    of_sphere(if quick { 64 } else { 256 }, &right)?;
    root.present()?;
    println!("\ndrawn in {}", path.display());
    Ok(())
}

/// The pull-off of a problem, with the areas before contact is lost.
fn find(problem: &mut Problem<f64>, preload: Option<f64>) -> Outcome<(f64, asperity::Solution<f64>)> {
    let found = pull_off(problem, BRACKET, preload)?;
    Ok((tension(&found), found.solution))
}

fn of_rough(largest: usize, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Outcome<()> {
    let rough::Rough { slope, shortest, work_of_adhesion, load } = rough::PULL_OFF;
    // in thousandths of the contact modulus
    let unit = 1e-3;
    let sizes: Vec<_> = (5..=largest.ilog2()).map(|power| 1 << power).collect();
    let short = Short::of(&sizes, unit, |n| {
        let (tension, solution) =
            find(&mut rough::problem(rough::PULL_OFF, n, SEED, Jkr::new(work_of_adhesion)?)?, Some(load))?;
        Ok((tension, Areas::of(&solution)?))
    })?;
    let mut long = Points::new();
    for &n in &sizes {
        let law = Exponential::new(work_of_adhesion, RANGE)?;
        long.push((n as f64, find(&mut rough::problem(rough::PULL_OFF, n, SEED, law)?, Some(load))?.0 / unit));
    }
    head(
        &format!("Rough surface, rms slope {slope}, k 1 to {shortest}, w = {work_of_adhesion}: pull-off in 10⁻³ E*"),
        &["nodes", "jkr", "less the zone", "its error", "exponential"],
    );
    print(&short, &[&long]);
    let name = format!("exponential, ρ = {RANGE}");
    let panel = Panel {
        title: "Rough surface",
        upwards: "pull-off / 10⁻³ E*",
        short: &short,
        others: vec![(name, long)],
        exact: None,
    };
    panel.draw(area)
}

fn of_sphere(largest: usize, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Outcome<()> {
    let unit = -sphere::exact()?.pull_off().load() / (sphere::SIDE * sphere::SIDE);
    let sizes: Vec<_> = (4..=largest.ilog2()).map(|power| 1 << power).collect();
    let short = Short::of(&sizes, unit, |n| {
        let (tension, solution) = find(&mut sphere::problem(n, Jkr::new(sphere::WORK)?)?, None)?;
        Ok((tension, Areas::of(&solution)?))
    })?;
    let mut others = Vec::new();
    for measure in MEASURES {
        let mut points = Points::new();
        for &n in &sizes[1..] {
            let range = (sphere::WORK * sphere::SIDE / (n as f64 * measure)).sqrt();
            let law = Exponential::new(sphere::WORK, range)?;
            points.push((n as f64, find(&mut sphere::problem(n, law)?, None)?.0 / unit));
        }
        others.push((format!("exponential, μ_ρ = {measure}"), points));
    }
    head(
        &format!("Sphere, R = 1, w = {}, window {}: pull-off over 1.5πwR", sphere::WORK, sphere::SIDE),
        &["nodes", "jkr", "less the zone", "its error", "exponential, μ_ρ = 0.5", "μ_ρ = 2"],
    );
    print(&short, &others.iter().map(|(_, points)| points).collect::<Vec<_>>());
    let panel = Panel { title: "Sphere", upwards: "pull-off / 1.5πwR", short: &short, others, exact: Some(1.0) };
    panel.draw(area)
}

fn print(short: &Short, others: &[&Points]) {
    for (i, &(n, found)) in short.found.iter().enumerate() {
        let values = [found, short.less_zone[i].1, short.errors[i]].into_iter();
        let values = values.chain(others.iter().map(|points| points[i].1)).map(|value| format!("{value:.3}"));
        row(&std::iter::once(format!("{n}²")).chain(values).collect::<Vec<_>>());
    }
}

struct Panel<'a> {
    title: &'a str,
    upwards: &'a str,
    short: &'a Short,
    others: Vec<(String, Points)>,
    exact: Option<f64>,
}

impl Panel<'_> {
    /// Both axes are logarithmic, with powers of two.
    fn draw(&self, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Outcome<()> {
        let Short { found, less_zone, errors } = self.short;
        let bars: Vec<_> =
            less_zone.iter().zip(errors).map(|(&(n, value), error)| (n, value - error, value + error)).collect();
        let ends = bars.iter().flat_map(|bar| [bar.1, bar.2]).chain(self.exact);
        let points = self.others.iter().flat_map(|(_, points)| points).chain(found);
        let (low, high) = ends
            .chain(points.map(|point| point.1))
            .fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
        let sides = (found[0].0 / 1.2, found[found.len() - 1].0 * 1.2);
        // room for the legend above
        let heights = low / 1.1..high * (high / low).powf(0.5);
        let area = area.titled(self.title, ("sans-serif", 22))?;
        let mut chart = ChartBuilder::on(&area)
            .margin(14)
            .margin_right(26)
            .x_label_area_size(56)
            .y_label_area_size(76)
            .build_cartesian_2d((sides.0..sides.1).log_scale().base(2.0), heights.log_scale().base(2.0))?;
        let plain = |value: &f64| value.to_string();
        let power = |value: &f64| if value.log2().fract() == 0.0 { value.to_string() } else { String::new() };
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .x_desc("nodes along a side")
            .y_desc(self.upwards)
            .label_style(("sans-serif", 18))
            .x_labels(found.len() + 1)
            .x_label_formatter(&power)
            .y_label_formatter(&plain)
            .draw()?;
        if let Some(exact) = self.exact {
            let line = LineSeries::new([(sides.0, exact), (sides.1, exact)], BLACK.stroke_width(1));
            let drawn = chart.draw_series(line)?;
            drawn.label("Johnson, Kendall, Roberts").legend(|(x, y)| PathElement::new([(x, y), (x + 22, y)], BLACK));
        }
        for ((name, points), colour) in self.others.iter().zip(&COLOURS[1..]) {
            let line = colour.stroke_width(2);
            chart.draw_series(points.iter().map(|&point| Circle::new(point, 4, colour.filled())))?;
            let drawn = chart.draw_series(LineSeries::new(points.iter().copied(), line))?;
            drawn.label(name).legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], line));
        }
        let colour = COLOURS[0];
        let rings = found.iter().map(|&point| Circle::new(point, 5, colour.stroke_width(2)));
        chart
            .draw_series(rings)?
            .label("jkr")
            .legend(move |(x, y)| Circle::new((x + 11, y), 5, colour.stroke_width(2)));
        let stroke = colour.stroke_width(2);
        chart.draw_series(bars.iter().map(|&(n, below, above)| {
            let (left, right) = (n / 1.04, n * 1.04);
            PathElement::new(
                [(left, above), (right, above), (n, above), (n, below), (left, below), (right, below)],
                stroke,
            )
        }))?;
        let dots = less_zone.iter().map(|&point| Circle::new(point, 5, colour.filled()));
        let drawn = chart.draw_series(dots)?.label("jkr, less the zone, with its error");
        drawn.legend(move |(x, y)| Circle::new((x + 11, y), 5, colour.filled()));
        let mut labels = chart.configure_series_labels();
        labels.position(SeriesLabelPosition::UpperRight).background_style(WHITE.mix(0.9)).border_style(BLACK);
        labels.label_font(("sans-serif", 18)).legend_area_size(30).draw()?;
        Ok(())
    }
}
