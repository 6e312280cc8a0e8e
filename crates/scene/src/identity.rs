//! The identity of a run: the inputs on which the rows of its table depend.

use asperity::{AdhesionLaw, Branch, Real, Surface};
use ndarray::ArrayRef2;
use serde_json::{Map, Value, json};

use crate::account::Inputs;
use crate::hash::Hash;

/// The inputs by name. A run goes on only with equal ones; numbers come as text, which can be compared exactly.
pub type Identity = Map<String, Value>;

/// The fields of a problem, each on the whole of its grid.
#[derive(Clone, Copy)]
pub struct Fields<'a> {
    /// The surface.
    pub surface: &'a Surface,
    /// The gaps and tractions of a law, a pair in each row.
    pub law_table: Option<&'a ArrayRef2<f64>>,
    /// The works of adhesion, where they vary.
    pub works: Option<&'a ArrayRef2<f64>>,
    /// The hardness, where it varies.
    pub hardness: Option<&'a ArrayRef2<f64>>,
    /// The gap from which to start, if it is given.
    pub start: Option<&'a ArrayRef2<f64>>,
    /// Whether the law is another one than those of its name and parameters.
    pub law_differs: bool,
}

/// The identity of a problem with a law on a branch: all that its solutions depend on beside the loads, and the units of
/// a table.
pub(crate) fn identity<T: Real>(
    inputs: &Inputs,
    branch: Option<Branch>,
    units: &str,
    given: Fields<'_>,
    law: &dyn AdhesionLaw<T>,
) -> Identity {
    let (grid, adhesion) = (given.surface.grid(), &inputs.adhesion);
    let number = |value: Option<f64>| value.map_or("none".to_owned(), |value| value.to_string());
    let field = |field: &ArrayRef2<f64>| Hash::NEW.of_numbers(field).to_string();
    let given_field = |given: Option<&ArrayRef2<f64>>| given.map_or("none".to_owned(), field);
    let heights = if inputs.shift.is_some() { "surfaces" } else { "heights" };
    let identity = json!({
        "shape": format!("{} {}", grid.shape().0, grid.shape().1),
        (heights): field(given.surface.heights()),
        "lengths": format!("{} {}", grid.lengths().0, grid.lengths().1),
        "absent_nodes": given.surface.absent().map_or("none".to_owned(), |absent| field(&absent.mapv(f64::from))),
        "boundary": inputs.elastic.boundary,
        "modulus": inputs.elastic.modulus.to_string(),
        "law": adhesion.law,
        "work_of_adhesion": number(adhesion.work_of_adhesion),
        "range": number(adhesion.range),
        "exponent": number(adhesion.exponent),
        "hamaker": number(adhesion.hamaker),
        "law_table": given_field(given.law_table),
        "cut_off": number(adhesion.cut_off),
        "work_of_adhesion_map": given_field(given.works),
        "wall": adhesion.wall,
        "precision": inputs.precision,
        "method": inputs.method.name(),
        "tolerance": inputs.tolerance.to_string(),
        "max_iterations": inputs.max_iterations.to_string(),
        "branch": branch.map_or("by the load", Branch::name),
        "initial_gap": given_field(given.start),
        "version": inputs.version,
        "units": units,
        "part": inputs.part.as_deref().unwrap_or("all"),
    });
    let mut identity = identity.as_object().cloned().unwrap_or_default();
    if let Some(stiffness) = adhesion.wall_stiffness {
        // a table of a wall without springs has none
        identity.insert("wall_stiffness".to_owned(), stiffness.to_string().into());
    }
    // nor has one of a surface that does not yield a hardness
    identity.extend(adhesion.hardness.map(|hardness| ("hardness".to_owned(), hardness.to_string().into())));
    identity.extend(given.hardness.map(|hardness| ("hardness_map".to_owned(), field(hardness).into())));
    // nor one of a half-space a body
    identity.extend(inputs.elastic.given().map(|(key, value)| (key.to_owned(), value.into())));
    if let Some(symbol) = &inputs.elastic.symbol {
        identity.insert("symbol_values".to_owned(), symbol.fingerprint(grid).to_string().into());
    }
    if given.law_differs {
        identity.insert("law_values".to_owned(), fingerprint(law).to_string().into());
    }
    identity
}

/// The fingerprint of a law: that of its energies and tractions at gaps from contact to 1024 ranges.
fn fingerprint<T: Real>(law: &dyn AdhesionLaw<T>) -> Hash {
    let range = law.hints().range.widen();
    let gaps = (-256..=320).map(|step| T::lit(range * (f64::from(step) / 32.0).exp2()));
    let values = [T::zero()].into_iter().chain(gaps).flat_map(|gap| [law.energy(gap), law.traction(gap)]);
    values.fold(Hash::NEW, |hash, value| hash.of_numbers([&value.widen()]))
}
