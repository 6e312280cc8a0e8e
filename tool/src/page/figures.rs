//! Figures and their names as a page has them.

use asperity_scene::{Adhesion, GROUPS, key};
use serde_json::Value;

use crate::columns::spaced;

/// Whether a key of a report is a constant, and no result: the law jkr has one resolution measure on every grid.
pub fn is_constant(key: &str, report: &Value) -> bool {
    key == "criterion"
        || report[key!(Adhesion, law)] == "jkr" && matches!(key, "mu_rho" | "mu_rho_node" | "under_resolved")
}

/// The place of a key or column in the order in which one asks.
pub fn place(name: &str) -> usize {
    let mut all = GROUPS.iter().flat_map(|(_, names)| names.split_whitespace());
    all.position(|known| known == name).unwrap_or(usize::MAX)
}

/// A value as people read it, with a number of a name as it is to be; none for what there is not.
pub fn shown(name: &str, value: &Value, number: &dyn Fn(&str, f64) -> String) -> Option<String> {
    let all = |parts: Vec<String>, between: &str| (!parts.is_empty()).then(|| parts.join(between));
    match value {
        Value::Null => None,
        Value::String(word) => Some(word.clone()),
        Value::Number(found) if found.is_f64() => found.as_f64().map(|found| number(name, found)),
        Value::Array(values) => {
            let between = if values.iter().any(Value::is_object) { "; " } else { " × " };
            all(values.iter().filter_map(|value| shown(name, value, number)).collect(), between)
        }
        Value::Object(values) => {
            let part = |(name, value): (&String, &Value)| match value {
                Value::Bool(is_so) => is_so.then(|| spaced(name)),
                _ if name == "relative" => shown(name, value, number),
                _ => Some(format!("{} {}", spaced(name), shown(name, value, number)?)),
            };
            let between = if values.values().any(Value::is_object) { "; " } else { ", " };
            all(values.iter().filter_map(part).collect(), between)
        }
        other => Some(other.to_string()),
    }
}
