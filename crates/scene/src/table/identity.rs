//! The identity of a run: the inputs on which the rows of its table depend.

use asperity::{AdhesionLaw, Branch, Real, Surface};
use ndarray::ArrayRef2;
use serde_json::{Map, Value, json};

use crate::account::{Inputs, Slopes};
use crate::hash::Hash;
use crate::key;
use crate::key::Adhesion;

/// The inputs by name: all inputs of a report but for what does not change rows. A run continues only with equal ones;
/// numbers come as text, which can be compared exactly.
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
    /// Whether the law differs from the laws of its name and parameters.
    pub law_differs: bool,
}

/// The fields that stand for their files.
const LAW_TABLE: &str = key!(Adhesion, law_table);
const WORKS: &str = key!(Adhesion, work_of_adhesion_map);
const HARDNESS: &str = key!(Adhesion, hardness_map);
const START: &str = key!(Inputs, initial_gap);

/// All of them, with the heights.
pub(crate) const FIELDS: [&str; 5] = [key!(Inputs, heights), LAW_TABLE, WORKS, HARDNESS, START];

/// The identity of a problem with a law on a branch: all that its solutions depend on besides the loads, and the units
/// of a table.
pub(crate) fn identity<T: Real>(
    inputs: &Inputs,
    branch: Option<Branch>,
    units: &str,
    given: Fields<'_>,
    law: &dyn AdhesionLaw<T>,
) -> Identity {
    let (surface, field) = (given.surface, |field: &ArrayRef2<f64>| Hash::NEW.of_numbers(field).to_string());
    // the fields stand for their files; slopes follow from them, and typed quantities from the other keys
    let adhesion =
        Adhesion { law_table: None, work_of_adhesion_map: None, hardness_map: None, ..inputs.adhesion.clone() };
    let heights = if inputs.shift.is_some() { "surfaces" } else { "heights" };
    let inputs = Inputs {
        heights: None,
        against: None,
        shift: None,
        initial_gap: None,
        slopes: Slopes::default(),
        length_unit: None,
        pressure_unit: None,
        given: None,
        threads: 0,
        adhesion,
        ..inputs.clone()
    };
    let number = |value: &Value| value.as_f64().map(|number| number.to_string());
    let text = |value: Value| match &value {
        Value::Array(values) => values.iter().filter_map(number).collect::<Vec<_>>().join(" ").into(),
        one => number(one).map_or(value, Value::String),
    };
    let all = json!(inputs).as_object().cloned().unwrap_or_default();
    let mut identity: Identity =
        all.into_iter().filter(|(_, value)| !value.is_null()).map(|(key, value)| (key, text(value))).collect();
    let fields = [
        (heights, Some(field(surface.heights()))),
        ("absent_nodes", surface.absent().map(|absent| field(&absent.mapv(f64::from)))),
        (LAW_TABLE, given.law_table.map(field)),
        (WORKS, given.works.map(field)),
        (HARDNESS, given.hardness.map(field)),
        (START, given.start.map(field)),
        ("branch", Some(branch.map_or("by the load", Branch::name).to_owned())),
        ("units", Some(units.to_owned())),
    ];
    identity.extend(fields.into_iter().filter_map(|(key, value)| Some((key.to_owned(), value?.into()))));
    if let Some(symbol) = &inputs.elastic.symbol {
        identity.insert("symbol_values".to_owned(), symbol.fingerprint(surface.grid()).to_string().into());
    }
    if given.law_differs {
        identity.insert("law_values".to_owned(), fingerprint(law).to_string().into());
    }
    identity
}

/// The fingerprint of a law, by its energies and tractions at gaps from contact to 1024 ranges.
fn fingerprint<T: Real>(law: &dyn AdhesionLaw<T>) -> Hash {
    let range = law.hints().range.widen();
    let gaps = (-256..=320).map(|step| T::lit(range * (f64::from(step) / 32.0).exp2()));
    let values = [T::zero()].into_iter().chain(gaps).flat_map(|gap| [law.energy(gap), law.traction(gap)]);
    values.fold(Hash::NEW, |hash, value| hash.of_numbers([&value.widen()]))
}
