//! The library, as its users see it: exact solutions, the paper, properties that hold for every input, and costs.

#[path = "../common/mod.rs"]
mod common;

mod accuracy;
mod algorithm3;
mod architecture;
mod bodies;
mod branches;
mod constraints;
mod cut_off;
#[cfg(feature = "serde")]
mod data;
mod ends;
mod exact;
mod exact_solutions;
mod extremes;
mod free;
mod hardness;
mod jkr;
mod laws;
mod light_loads;
mod maugis_dugdale;
mod nested;
mod no_wall;
mod operators;
mod pair;
mod paper;
mod path;
mod precision;
mod published;
mod pull_off;
mod rough;
mod rough_contact;
mod search;
mod solvers;
mod stability;
mod statistics;
mod stiffness;
mod stress;
mod sweep;
mod tabulated;
mod wrappers;
