//! The way through the loads of a table.

use asperity::Control;
use asperity::path::PathSettings;

use crate::session::pace::Pace;

/// The way through the loads of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Way {
    /// An equilibrium under each load.
    Sweep(Vec<Control>),
    /// An equilibrium with each contact fraction, under a load that is found.
    Search(Vec<f64>),
    /// A path from load to load in small steps.
    Cycle(Vec<Control>, PathSettings),
}

impl Way {
    /// The loads, where they are given.
    pub fn loads(&self) -> &[Control] {
        match self {
            Self::Sweep(loads) | Self::Cycle(loads, _) => loads,
            Self::Search(_) => &[],
        }
    }

    /// The pace of a cycle from its beginning.
    pub(crate) fn pace(&self) -> Option<Pace> {
        let Self::Cycle(loads, settings) = self else { return None };
        Some(Pace::new(loads.len().saturating_sub(1), settings))
    }
}
