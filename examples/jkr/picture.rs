//! A picture of the pull-off over the number of nodes: what laws with a range and without say on coarse grids.

use std::path::Path;

use asperity::exact::Sphere;
use asperity::{
    Amplitude, Boussinesq, ElasticOperator, Exponential, Grid, Jkr, Problem, PullOff, Result, SelfAffine, Solver,
    Surface, Westergaard,
};
use common::Outcome;
use common::chart::{COLOURS, Chart, Series, Style};
use plotters::prelude::*;

use crate::case::{powers, pull_off, tension};
use crate::scene::on_grid;
use crate::sphere;

/// The relative width of the bracket of a pull-off.
const BRACKET: f64 = 0.005;

/// A contact on grids from coarse to fine, with pull-offs in a unit, which is a pressure.
struct Case {
    sizes: Vec<usize>,
    surface: fn(usize) -> Result<Surface>,
    body: fn(Grid) -> Result<Box<dyn ElasticOperator<f64>>>,
    work: f64,
    preload: Option<f64>,
    unit: f64,
}

impl Case {
    /// The pull-off by the law without a range on each grid, and in the limit with its error.
    fn without_range(&self, series: &mut Vec<Series>) -> Outcome<()> {
        let (colour, mut points, mut limits) = (COLOURS[0], Vec::new(), Vec::new());
        let search = PullOff::default().tolerance(BRACKET).preload(self.preload);
        for &n in &self.sizes {
            let law = Jkr::new(self.work)?;
            let found = on_grid().pull_off(&mut Solver::default(), &(self.surface)(n)?, self.body, law, &search)?;
            points.push((n as f64, tension(&found.found) / self.unit));
            if let (Some(limit), Ok(error)) = (found.limit, found.error) {
                limits.push((n as f64, limit / self.unit));
                let bar = [-1.0, 1.0].map(|sign| (n as f64, limit / self.unit * (1.0 + sign * error.relative)));
                series.push(Series { name: String::new(), colour, style: Style::Line, points: bar.to_vec() });
            }
        }
        series.push(Series { name: "jkr".to_owned(), colour, style: Style::Rings, points });
        let name = "jkr, in the limit, with its error".to_owned();
        series.push(Series { name, colour, style: Style::Dots, points: limits });
        Ok(())
    }

    /// The pull-off by an exponential law with a range on each grid.
    fn with_range(&self, name: &str, colour: RGBColor, range: impl Fn(usize) -> f64) -> Outcome<Series> {
        let mut points = Vec::new();
        for &n in &self.sizes {
            let (surface, law) = ((self.surface)(n)?, Exponential::new(self.work, range(n))?);
            let mut problem = Problem::new(&surface, (self.body)(*surface.grid())?, law)?;
            points.push((n as f64, tension(&pull_off(&mut problem, BRACKET, self.preload)?) / self.unit));
        }
        Ok(Series { name: format!("exponential, {name}"), colour, style: Style::Line, points })
    }
}

/// Draws the pull-offs of a rough surface and of a sphere, on grids of up to so many nodes along a side.
pub fn draw([of_rough, of_sphere]: [usize; 2], path: &Path) -> Outcome<()> {
    let rough = Case {
        sizes: powers(32, of_rough).collect(),
        surface: |n| {
            let rough = SelfAffine::default().k_l(1.0).k_r(1.0).k_s(4.0).seed(3);
            rough.amplitude(Amplitude::RmsSlope(0.5)).surface(Grid::square(n, 1.0)?)
        },
        body: |grid| Ok(Box::new(Westergaard::new(grid, 1.0)?)),
        work: 1.5e-3,
        preload: Some(0.02),
        unit: 1e-3,
    };
    let ball = Case {
        sizes: powers(32, of_sphere).collect(),
        surface: sphere::surface,
        body: |grid| Ok(Box::new(Boussinesq::new(grid, 1.0)?)),
        work: sphere::WORK,
        preload: None,
        unit: -sphere::exact()?.pull_off().load() / (sphere::SIDE * sphere::SIDE),
    };
    let by_measure = |measure: f64| move |n| (sphere::WORK * sphere::SIDE / (n as f64 * measure)).sqrt();
    let exact = vec![(32.0, 1.0), (of_sphere as f64, 1.0)];
    let exact =
        Series { name: "Johnson, Kendall, Roberts".to_owned(), colour: BLACK, style: Style::Thin, points: exact };
    let of_ball = vec![
        exact,
        ball.with_range("μ_ρ = 0.5", COLOURS[1], by_measure(0.5))?,
        ball.with_range("μ_ρ = 2", COLOURS[2], by_measure(2.0))?,
    ];
    let of_rough = vec![rough.with_range("ρ = 0.002", COLOURS[1], |_| 2e-3)?];
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let root = SVGBackend::new(path, (1200, 560)).into_drawing_area();
    root.fill(&WHITE)?;
    let (left, right) = root.split_horizontally(600);
    for (title, upwards, case, mut series, area) in [
        ("Rough surface", "pull-off / 10⁻³ E*", rough, of_rough, left),
        ("Sphere", "pull-off / 1.5πwR", ball, of_ball, right),
    ] {
        case.without_range(&mut series)?;
        let (title, axes, logarithmic) = (title.to_owned(), ["nodes along a side", upwards], title != "Sphere");
        Chart { title, axes, logarithmic, labels: SeriesLabelPosition::UpperRight, series }.draw(&area)?;
    }
    root.present()?;
    println!("\ndrawn in {}", path.display());
    Ok(())
}
