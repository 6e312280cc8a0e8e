//! From the physics to the code, how to do this and that, and how the crate is built.
//!
//! | page | what for |
//! |---|---|
//! | [`tour`] | the whole way once: gap, pressure, balance, energy, adhesion, grid, certificate, each with its line of code |
//! | [`own_law`] | an adhesion law of your own |
//! | [`own_operator`] | an elastic operator of your own: a layer of finite thickness |
//! | [`own_constraint`] | a way of your own to keep the surfaces apart |
//! | [`penalty_and_uzawa`] | the two classical ways beside projection, with figures |
//! | [`branches`] | loading and unloading with adhesion: jumps, limit points, stability |
//! | [`python`] | heights from numpy, results to numpy |
//! | [`architecture`] | the layers of the crate, what may use what, and the data's way through one iteration |
//!
//! Measured figures are on pages of their own: [`performance`](crate::performance), [`precision`](crate::precision), and
//! [`paper_checked`](crate::paper_checked), which holds the paper against this crate. How to choose grid, range and
//! tolerance is the page `choosing`.
//!
//! The code on these pages is run by the tests.

pub mod tour {
    #![doc = include_str!("guide/tour.md")]
}
pub mod own_law {
    #![doc = include_str!("guide/own_law.md")]
}
pub mod own_operator {
    #![doc = include_str!("guide/own_operator.md")]
}
pub mod own_constraint {
    #![doc = include_str!("guide/own_constraint.md")]
}
pub mod penalty_and_uzawa {
    #![doc = include_str!("guide/penalty_and_uzawa.md")]
}
pub mod branches {
    #![doc = include_str!("guide/branches.md")]
}
#[cfg(feature = "cli")]
pub mod python {
    #![doc = include_str!("guide/python.md")]
}
pub mod architecture {
    #![doc = include_str!("guide/architecture.md")]
}
