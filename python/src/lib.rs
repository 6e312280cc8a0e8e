//! The compiled core of the Python package `asperity`: arrays in, arrays out. What users see is written in Python, in
//! the folder `asperity` next to this one.

mod answer;
mod command;
mod contact;
mod curve;
mod exact;
mod flow;
mod functions;
mod inputs;
mod interface;
mod keywords;
mod law;
mod numbers;
mod pair;
mod pools;
mod problem;
mod refusal;
mod report;
mod running;
mod state;
mod surface;

/// The compiled core.
#[pyo3::pymodule]
mod _asperity {
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_export]
    use crate::{
        answer::unbalanced,
        command::{command, figures_of, page},
        contact::{clusters, contact_picture, contact_tables, load_scale, palette, pressure_distribution},
        curve::{Curve, Equilibria},
        exact::{
            AdhesiveWavyLine, Contact, GreenwoodWilliamson, Hertz, Jkr, MaugisDugdale, Persson, WaveContact, WavyLine,
            closing_pressure_2d,
        },
        flow::{conductance, leakage, percolation},
        inputs::{has_dimension, in_si, quantity, shown},
        interface::interface_files,
        keywords::Keywords,
        law::{Law, check_law, cut_off, law, read_law, tabulated, varied},
        pair::contact_modulus,
        problem::Problem,
        refusal::meant,
        running::Iteration,
        surface::{fourier, in_metres, knee_wavelength, made, prepare, read, spectrum, statistics, write},
    };
}
