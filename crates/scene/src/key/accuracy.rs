//! The accuracy that is asked for, and its plan.

use asperity::accuracy::{Accuracy, Quantity};
use asperity::stability::ContactStiffness;
use asperity_maps::io::available_memory;

/// The bytes of a GiB.
pub(crate) const GIB: f64 = 1_073_741_824.0;

/// The accuracy that is asked for, from which tolerance and grid follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// The relative error that is wanted, between 0 and 1.
    pub accuracy: f64,
    /// The quantity that has it.
    pub of: Quantity,
    /// The memory that it may take, in GiB; all that is free if none is given.
    pub memory: Option<f64>,
}

impl Goal {
    /// The accuracy, with the contact stiffness if that is asked for.
    pub fn wanted(&self, stiffness: bool) -> Accuracy {
        let mut wanted = Accuracy::new(self.accuracy, self.of);
        wanted.memory = self.memory.map_or_else(available_memory, |memory| memory * GIB);
        wanted.nested.stiffness = stiffness.then_some(ContactStiffness::TOLERANCE);
        wanted
    }
}
