//! Charts and colours, as in the pictures of the program.

use asperity_plot::{Chart, Colouring, DPI, Paper};
use asperity_scene::{Adhesion, LAWS, Outcome, key};
use serde::Deserialize;
use serde_json::{Value, json};

/// The version, the laws, and the colours of maps.
pub fn about() -> Value {
    let law = |law: &asperity_scene::Law| {
        json!({
            "name": law.name,
            "formula": law.formula,
            "needs": law.needs,
            "never_ends": law.never_ends,
            "repels": law.repels,
        })
    };
    let files = |law: &&asperity_scene::Law| law.needs.contains(&key!(Adhesion, law_table));
    let laws: Vec<_> = LAWS.iter().filter(|found| !files(found)).map(law).collect();
    let [sequential, diverging] = [Colouring::Sequential, Colouring::Diverging].map(|scale| scale.steps().concat());
    let contact = Colouring::Contact.steps();
    let colours = json!({
        "sequential": sequential,
        "diverging": diverging,
        "missing": Colouring::MISSING,
        "attractive": contact[2],
        "yielded": contact[3],
    });
    json!({ "version": env!("CARGO_PKG_VERSION"), "laws": laws, "colours": colours })
}

/// The name of a curve and its points; a `null` breaks it.
type Curve = (String, Vec<(Option<f64>, Option<f64>)>);

/// A chart by the keys of `Chart`, and the width of its picture in points.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct ChartKeys {
    title: String,
    caption: String,
    x_label: String,
    x_unit: Option<String>,
    x_log: bool,
    y_label: String,
    y_unit: Option<String>,
    y_log: bool,
    curves: Vec<Curve>,
    jumps: Vec<[(f64, f64); 2]>,
    width: f64,
}

/// The least width of a chart in points, as of a place that is not shown.
const NARROWEST: f64 = 200.0;

/// The chart as SVG.
pub fn chart(given: &str) -> Outcome<String> {
    let given: ChartKeys = serde_json::from_str(given)?;
    let number = |number: Option<f64>| number.unwrap_or(f64::NAN);
    let curve = |(name, points): &Curve| {
        (name.clone(), points.iter().map(|(x, y)| (number(*x), number(*y))).collect::<Vec<_>>())
    };
    let curves: Vec<_> = given.curves.iter().map(curve).collect();
    let chart = Chart {
        title: &given.title,
        caption: &given.caption,
        x_label: &given.x_label,
        x_unit: given.x_unit.as_deref(),
        x_log: given.x_log,
        y_label: &given.y_label,
        y_unit: given.y_unit.as_deref(),
        y_log: given.y_log,
        curves: curves.iter().map(|(name, points)| (name.as_str(), points.clone())).collect(),
        jumps: given.jumps,
        ..Chart::default()
    };
    Ok(chart.draw(Paper { dpi: DPI, width: Some(given.width.max(NARROWEST)) })?.svg()?)
}
