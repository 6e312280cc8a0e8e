//! A picture of the pull-off over the number of nodes: what laws with a range and without say on coarse grids.

use std::path::Path;

use asperity::exact::Sphere;
use asperity::{
    Amplitude, Boussinesq, ElasticOperator, Exponential, Grid, Jkr, Problem, PullOff, Result, SelfAffine, Solver,
    Surface, Westergaard,
};
use common::Outcome;
use common::chart::COLOURS;
use plotters::coord::Shift;
use plotters::prelude::*;

use crate::case::{head, pull_off, row, tension};
use crate::scene::on_grid;
use crate::sphere;

/// The relative width of the bracket of a pull-off.
const BRACKET: f64 = 0.005;

/// The rough surface: rms slope, shortest wave number, and seed.
const SLOPE: f64 = 0.5;
const SHORTEST: f64 = 4.0;
const SEED: u64 = 3;

/// Pull-offs over the nodes along a side.
type Points = Vec<(f64, f64)>;

/// A contact on grids from coarse to fine.
struct Case {
    title: &'static str,
    upwards: &'static str,
    sizes: Vec<usize>,
    surface: fn(usize) -> Result<Surface>,
    body: fn(Grid) -> Result<Box<dyn ElasticOperator<f64>>>,
    work: f64,
    preload: Option<f64>,
    /// The unit of pull-offs, a pressure.
    unit: f64,
    exact: Option<f64>,
}

impl Case {
    /// The pull-off by the law without a range on each grid, and in the limit with both ends of its error.
    fn without_range(&self) -> Outcome<(Points, Vec<[f64; 4]>)> {
        let (mut points, mut limits) = (Points::new(), Vec::new());
        let search = PullOff::default().tolerance(BRACKET).preload(self.preload);
        for &n in &self.sizes {
            let law = Jkr::new(self.work)?;
            let found = on_grid().pull_off(&mut Solver::default(), &(self.surface)(n)?, self.body, law, &search)?;
            points.push((n as f64, tension(&found.found) / self.unit));
            if let (Some(limit), Ok(error)) = (found.limit, found.error) {
                let limit = limit / self.unit;
                limits.push([n as f64, limit, limit * (1.0 - error.relative), limit * (1.0 + error.relative)]);
            }
        }
        Ok((points, limits))
    }

    /// The pull-off by an exponential law with a range on each grid.
    fn with_range(&self, range: impl Fn(usize) -> f64) -> Outcome<Points> {
        let mut points = Points::new();
        for &n in &self.sizes {
            let (surface, law) = ((self.surface)(n)?, Exponential::new(self.work, range(n))?);
            let mut problem = Problem::new(&surface, (self.body)(*surface.grid())?, law)?;
            points.push((n as f64, tension(&pull_off(&mut problem, BRACKET, self.preload)?) / self.unit));
        }
        Ok(points)
    }

    /// Prints and draws the pull-offs. Both axes are logarithmic, with powers of two.
    fn draw(&self, others: &[(&str, Points)], area: &DrawingArea<SVGBackend<'_>, Shift>) -> Outcome<()> {
        let (found, limits) = self.without_range()?;
        let names: Vec<_> = others.iter().map(|(name, _)| *name).collect();
        head(
            &format!("{}, w = {}: {}", self.title, self.work, self.upwards),
            &[&["nodes", "jkr"], &names[..], &["limit", "from", "to"]].concat(),
        );
        for (i, &(n, value)) in found.iter().enumerate() {
            let limit = limits.iter().find(|limit| limit[0] == n).map_or([f64::NAN; 4], |limit| *limit);
            let values = std::iter::once(value).chain(others.iter().map(|(_, points)| points[i].1));
            let values = values.chain(limit.into_iter().skip(1)).map(|value| format!("{value:.3}"));
            row(&std::iter::once(format!("{n}²")).chain(values).collect::<Vec<_>>());
        }

        let points = others.iter().flat_map(|(_, points)| points).chain(&found).map(|point| point.1);
        let ends = limits.iter().flat_map(|limit| [limit[2], limit[3]]).chain(self.exact);
        let (low, high) =
            points.chain(ends).fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
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
        let mesh = &mut chart.configure_mesh();
        mesh.light_line_style(TRANSPARENT).x_desc("nodes along a side").y_desc(self.upwards);
        mesh.label_style(("sans-serif", 18)).x_labels(found.len() + 1);
        mesh.x_label_formatter(&power).y_label_formatter(&plain).draw()?;
        if let Some(exact) = self.exact {
            let line = LineSeries::new([(sides.0, exact), (sides.1, exact)], BLACK);
            let drawn = chart.draw_series(line)?.label("Johnson, Kendall, Roberts");
            drawn.legend(|(x, y)| PathElement::new([(x, y), (x + 22, y)], BLACK));
        }
        for ((name, points), colour) in others.iter().zip(&COLOURS[1..]) {
            let line = ShapeStyle { filled: true, ..colour.stroke_width(2) };
            let drawn = chart.draw_series(LineSeries::new(points.iter().copied(), line).point_size(4))?;
            drawn.label(*name).legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], line));
        }
        let (ring, dot) = (COLOURS[0].stroke_width(2), COLOURS[0].filled());
        let drawn = chart.draw_series(found.iter().map(|&point| Circle::new(point, 5, ring)))?;
        drawn.label("jkr").legend(move |(x, y)| Circle::new((x + 11, y), 5, ring));
        chart.draw_series(limits.iter().map(|&[n, _, below, above]| {
            let (left, right) = (n / 1.04, n * 1.04);
            let ends = [(left, above), (right, above), (n, above), (n, below), (left, below), (right, below)];
            PathElement::new(ends, ring)
        }))?;
        let drawn = chart.draw_series(limits.iter().map(|limit| Circle::new((limit[0], limit[1]), 5, dot)))?;
        drawn.label("jkr, in the limit, with its error").legend(move |(x, y)| Circle::new((x + 11, y), 5, dot));
        let mut labels = chart.configure_series_labels();
        labels.position(SeriesLabelPosition::UpperRight).background_style(WHITE.mix(0.9)).border_style(BLACK);
        labels.label_font(("sans-serif", 18)).legend_area_size(30).draw()?;
        Ok(())
    }
}

/// Draws the pull-offs of a rough surface and of a sphere.
pub fn draw(quick: bool, path: &Path) -> Outcome<()> {
    let sizes = |largest: u32| (5..=if quick { 6 } else { largest }).map(|power| 1 << power).collect();
    let rough = Case {
        title: "Rough surface",
        upwards: "pull-off / 10⁻³ E*",
        sizes: sizes(9),
        surface: |n| {
            let rough = SelfAffine::default().k_l(1.0).k_r(1.0).k_s(SHORTEST).seed(SEED);
            rough.amplitude(Amplitude::RmsSlope(SLOPE)).surface(Grid::square(n, 1.0)?)
        },
        body: |grid| Ok(Box::new(Westergaard::new(grid, 1.0)?)),
        work: 1.5e-3,
        preload: Some(0.02),
        unit: 1e-3,
        exact: None,
    };
    let ball = Case {
        title: "Sphere",
        upwards: "pull-off / 1.5πwR",
        sizes: sizes(8),
        surface: sphere::surface,
        body: |grid| Ok(Box::new(Boussinesq::new(grid, 1.0)?)),
        work: sphere::WORK,
        preload: None,
        unit: -sphere::exact()?.pull_off().load() / (sphere::SIDE * sphere::SIDE),
        exact: Some(1.0),
    };
    let root = SVGBackend::new(path, (1200, 560)).into_drawing_area();
    root.fill(&WHITE)?;
    let (left, right) = root.split_horizontally(600);
    rough.draw(&[("exponential, ρ = 0.002", rough.with_range(|_| 2e-3)?)], &left)?;
    let by_measure = |measure: f64| move |n| (sphere::WORK * sphere::SIDE / (n as f64 * measure)).sqrt();
    let [half, two] = [ball.with_range(by_measure(0.5))?, ball.with_range(by_measure(2.0))?];
    ball.draw(&[("exponential, μ_ρ = 0.5", half), ("exponential, μ_ρ = 2", two)], &right)?;
    root.present()?;
    println!("\ndrawn in {}", path.display());
    Ok(())
}
