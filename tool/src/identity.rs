//! The identity of a run: the inputs on which the rows of its table depend.

use asperity::{Branch, Surface};
use ndarray::ArrayRef2;
use serde_json::{Map, Value, json};

use crate::adhesion::Adhesion;
use crate::hash::Hash;
use crate::options::ProblemOptions;
use crate::quantity::Quantity;

/// The inputs by name. A run goes on only with equal ones; numbers come as text, which can be compared exactly.
pub type Identity = Map<String, Value>;

/// The inputs of a problem: all that its solutions depend on beside the loads.
pub fn identity(
    ProblemOptions { surface: options, adhesion, solver }: ProblemOptions<'_>,
    surface: &Surface,
    given: &Adhesion<'_>,
    start: Option<&ArrayRef2<f64>>,
) -> Identity {
    let (grid, settings) = (surface.grid(), solver.settings());
    let number = |value: Option<Quantity>| value.map_or("none".to_owned(), |value| value.to_string());
    let field = |field: &ArrayRef2<f64>| Hash::NEW.of_numbers(field).to_string();
    let pair = |a: String, b: String| format!("{a} {b}");
    let identity = json!({
        "shape": pair(grid.shape().0.to_string(), grid.shape().1.to_string()),
        "heights": field(surface.heights()),
        "lengths": pair(grid.lengths().0.to_string(), grid.lengths().1.to_string()),
        "absent_nodes": surface.absent().map_or("none".to_owned(), |absent| field(&absent.mapv(f64::from))),
        "boundary": options.beyond.boundary,
        "modulus": options.modulus().to_string(),
        "law": adhesion.law,
        "work_of_adhesion": number(adhesion.work_of_adhesion),
        "range": number(adhesion.range),
        "exponent": adhesion.exponent.map_or("none".to_owned(), |value| value.to_string()),
        "hamaker": number(adhesion.hamaker),
        "law_table": given.table.as_deref().map_or("none".to_owned(), field),
        "cut_off": number(adhesion.cut_off),
        "work_of_adhesion_map": given.works.as_deref().map_or("none".to_owned(), field),
        "wall": adhesion.wall,
        "precision": solver.precision.name(),
        "method": settings.method.name(),
        "tolerance": solver.tolerance().to_string(),
        "max_iterations": settings.max_iterations.to_string(),
        "branch": settings.branch.map_or("by the load", Branch::name),
        "initial_gap": start.map_or("none".to_owned(), field),
        "version": env!("CARGO_PKG_VERSION"),
    });
    let mut identity = identity.as_object().cloned().unwrap_or_default();
    if let Some(stiffness) = adhesion.wall_stiffness {
        // a table of a wall without springs has none
        identity.insert("wall_stiffness".to_owned(), stiffness.to_string().into());
    }
    identity
}
