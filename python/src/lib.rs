//! The compiled core of the Python package `asperity`: arrays in, arrays out. What users see is written in Python, in
//! the folder `asperity` beside this one.

mod answer;
mod command;
mod contact;
mod exact;
mod flow;
mod formulas;
mod functions;
mod given;
mod inputs;
mod interface;
mod keywords;
mod law;
mod look;
mod numbers;
mod original;
mod pair;
mod pools;
mod problem;
mod refusal;
mod report;
mod running;
mod state;
mod surface;
mod symbol;

/// The compiled core.
#[pyo3::pymodule]
mod _asperity {
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_export]
    use crate::command::{command, figures_of, page};
    #[pymodule_export]
    use crate::contact::{cluster_colours, clusters, contact_tables, load_scale, pressure_distribution};
    #[pymodule_export]
    use crate::exact::{AdhesiveWavyLine, Contact, Hertz, Jkr, WaveContact, WavyLine, closing_pressure_2d};
    #[pymodule_export]
    use crate::flow::{conductance, leakage, percolation};
    #[pymodule_export]
    use crate::inputs::{has_dimension, quantity};
    #[pymodule_export]
    use crate::interface::interface_files;
    #[pymodule_export]
    use crate::keywords::Keywords;
    #[pymodule_export]
    use crate::law::{CutOff, Law, Tabulated, Varying, check_law};
    #[pymodule_export]
    use crate::look::Look;
    #[pymodule_export]
    use crate::original::Original;
    #[pymodule_export]
    use crate::pair::{between, contact_modulus};
    #[pymodule_export]
    use crate::problem::Problem;
    #[pymodule_export]
    use crate::refusal::meant;
    #[pymodule_export]
    use crate::running::Iteration;
    #[pymodule_export]
    use crate::surface::{fourier, in_metres, knee_wavelength, made, prepare, read, spectrum, statistics};

    use pyo3::prelude::*;

    /// The laws, and the sphere of Maugis, whose name a law has.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::formulas::add(module)?;
        module.add("MaugisSphere", module.py().get_type::<crate::exact::MaugisDugdale>())
    }
}
