//! The way through the loads of a table.

use asperity::Control;
use asperity::path::PathSettings;

use crate::key::{Load, Scene};

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
    /// The way through loads one after the other, where a reduced pressure of 1 is the `full` pressure.
    pub fn sweep(loads: &[Load], full: f64) -> Self {
        let fractions: Vec<_> = loads.iter().filter_map(|load| load.fraction()).collect();
        if fractions.is_empty() { Self::Sweep(controls(loads, full)) } else { Self::Search(fractions) }
    }

    /// The way from load to load of a cycle.
    ///
    /// # Errors
    /// The remedy, if there are fewer than two.
    pub fn cycle(loads: &[Load], full: f64, settings: PathSettings) -> Result<Self, String> {
        if loads.len() < 2 {
            return Err("a cycle needs two turning points at least: give more loads".to_owned());
        }
        Ok(Self::Cycle(controls(loads, full), settings))
    }

    /// The load of its rows, of no meaning but for its kind; a contact fraction is searched for by one of these.
    pub fn control(&self, scene: &Scene) -> Control {
        let searched = || scene.elastic.boundary.searched_by(scene.adhesion.adheres());
        self.loads().first().copied().unwrap_or_else(searched)
    }

    /// The loads, where they are given.
    pub fn loads(&self) -> &[Control] {
        match self {
            Self::Sweep(loads) | Self::Cycle(loads, _) => loads,
            Self::Search(_) => &[],
        }
    }
}

/// The loads that are held.
fn controls(loads: &[Load], full: f64) -> Vec<Control> {
    loads.iter().map(|load| load.control(full)).collect()
}
