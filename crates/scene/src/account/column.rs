//! The columns of tables that charts and summaries of cycles are made of.

use crate::account::Account;
use crate::key;

/// The mean gap.
pub const MEAN_GAP: &str = key!(Account, mean_gap);
/// The mean pressure.
pub const MEAN_PRESSURE: &str = key!(Account, mean_pressure);
/// The normal force.
pub const NORMAL_FORCE: &str = key!(Account, normal_force);
/// The approach.
pub const APPROACH: &str = key!(Account, approach);
/// The share of the nodes in contact.
pub const CONTACT_FRACTION: &str = key!(Account, contact_fraction);
