//! Figures and their names as a page has them.

use serde_json::Value;

use crate::columns::spaced;

/// The keys of reports and the columns of tables in the order in which one asks for them, by headings. Others are of the
/// surface and the settings.
pub const GROUPS: [(&str, &str); 8] = [
    (
        "Pull-off",
        "pull_off_pressure pull_off_force limit_pressure limit_force limit_error limit_reason to_report lost_pressure preload solves",
    ),
    (
        "Load",
        "case leg direction control control_value mean_pressure normal_force net_pressure spring_stiffness branch \
         wanted_contact_fraction reached search",
    ),
    (
        "Contact",
        "contact_fraction jkr_contact_fraction corrected_contact_fraction adhesive_contact_fraction contact_nodes absent_nodes perimeter clusters largest_cluster \
         repulsive_fraction attractive_fraction plastic_fraction patches contact_stiffness stiffness_error normal_stiffness",
    ),
    ("Gap", "mean_gap min_gap approach plastic_depth_max plastic_depth_mean"),
    ("Pressures", "hardness mean_contact_pressure min_pressure max_pressure peak_traction edge_traction"),
    (
        "Energies",
        "elastic_energy adhesive_energy plastic_energy work dissipated imbalance work_error event energy_drop \
         stability departures other_branch",
    ),
    ("Error", "status criterion relative_error load_error grid_error accuracy mu_rho mu_rho_node under_resolved"),
    ("Cost", "iterations operator_applications equivalent_applications seconds"),
];

/// The keys of attraction, which say nothing of surfaces that do not adhere.
pub const OF_ADHESION: &str = "net_pressure min_pressure repulsive_fraction attractive_fraction adhesive_energy mu_rho \
                               mu_rho_node under_resolved";

/// Whether a key of a report is a constant, and no result: the law jkr has one resolution measure on every grid.
pub fn is_constant(key: &str, report: &Value) -> bool {
    key == "criterion" || report["law"] == "jkr" && matches!(key, "mu_rho" | "mu_rho_node" | "under_resolved")
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
