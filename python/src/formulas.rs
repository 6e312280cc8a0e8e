//! The laws of the library that are formulas of a few parameters, as classes.

use asperity_scene::{Adhesion, Wall};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::given::{Given, Measure};
use crate::law::Law;

/// The type of a parameter's name.
macro_rules! name {
    ($parameter:ident) => { &'static str };
}

/// Laws of the library, each a class with its parameters, a choice that is false by default, and its name in reports.
macro_rules! laws {
    ($(
        $(#[$doc:meta])*
        $class:ident($($parameter:ident),* $(; $choice:ident)?), $signature:literal, $name:literal $(, $key:ident: $value:expr)?;
    )*) => {
        $(
            $(#[$doc])*
            #[pyclass(frozen, extends = Law, module = "asperity")]
            pub struct $class { $($parameter: f64,)* $($choice: bool)? }

            #[pymethods]
            impl $class {
                #[classattr]
                #[expect(non_upper_case_globals, reason = "Python's name")]
                const __match_args__: ($(name!($parameter),)* $(name!($choice))?) =
                    ($(stringify!($parameter),)* $(stringify!($choice))?);
                #[new]
                #[pyo3(signature = ($($parameter = None,)* $($choice = false,)? **other), text_signature = $signature)]
                fn new(
                    py: Python<'_>,
                    $($parameter: Option<Measure>,)*
                    $($choice: bool,)?
                    other: Option<&Bound<'_, PyDict>>,
                ) -> PyResult<PyClassInitializer<Self>> {
                    if let Some(other) = other {
                        let known = [$(stringify!($parameter),)* $(stringify!($choice))?];
                        // refuses other words, with those that they may mean
                        py.import("asperity._words")?.call_method1("check", (stringify!($class), other, known))?;
                    }
                    let mut given = Given::default();
                    $(let $parameter = wanted(stringify!($class), stringify!($parameter), $parameter, &mut given)?;)*
                    let adhesion =
                        Adhesion { $($parameter: Some($parameter),)* $($key: $value,)? ..Adhesion::of($name) };
                    let law = Law { given, ..Law::of_library(adhesion)? };
                    Ok(PyClassInitializer::from(law).add_subclass(Self { $($parameter,)* $($choice)? }))
                }
                $(
                    #[getter]
                    fn $parameter(&self) -> f64 {
                        self.$parameter
                    }
                )*
                $(
                    #[getter]
                    fn $choice(&self) -> bool {
                        self.$choice
                    }
                )?
                fn __getnewargs__<'py>(slf: PyRef<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
                    let (py, given) = (slf.py(), &slf.as_super().given);
                    PyTuple::new(py, [
                        $(given.typed(py, stringify!($parameter), slf.$parameter)?,)*
                        $(given.typed(py, stringify!($choice), slf.$choice)?)?
                    ])
                }
            }
        )*

        /// Adds the classes to the module.
        pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
            $(module.add_class::<$class>()?;)*
            Ok(())
        }
    };
}

/// The value of a parameter, refused if there is none.
fn wanted(class: &str, parameter: &str, value: Option<Measure>, given: &mut Given) -> PyResult<f64> {
    match value {
        Some(value) => given.read(parameter, value),
        None => Err(PyTypeError::new_err(format!("{class}() is without {parameter}: give a number"))),
    }
}

laws! {
    /// The exponential law, φ(g) = −w exp(−g/ρ).
    ///
    /// Parameters
    /// ----------
    /// work_of_adhesion : float
    ///     Work of adhesion w ≥ 0, an energy per area.
    /// range : float
    ///     Range ρ > 0, a length.
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> law = asperity.Exponential(work_of_adhesion=0.05, range=2e-9)
    /// >>> law.energy(0.0)
    /// -0.05
    Exponential(work_of_adhesion, range), "(work_of_adhesion, range)", "exponential";
    /// The law without a range, the limit of Johnson, Kendall and Roberts, as short on each grid as its nodes can follow.
    ///
    /// For contacts of which the work of adhesion is known, and no range. `Report.range` is that of the grid,
    /// √(13wΔx/E*). By itself the law attracts in contact alone.
    ///
    /// Parameters
    /// ----------
    /// work_of_adhesion : float
    ///     Work of adhesion w ≥ 0, an energy per area.
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> tip = asperity.surface.paraboloid(64, 0.36, radius=2.0)
    /// >>> law = asperity.JKR(work_of_adhesion=2e-5)
    /// >>> found = asperity.pull_off(tip, modulus=1.0, boundary="free", law=law)
    /// >>> exact = -asperity.exact.Jkr(2.0, 1.0, 2e-5).pull_off().load
    /// >>> abs(found.limit_force / exact - 1) < found.limit_error < 0.07
    /// True
    #[expect(clippy::upper_case_acronyms, reason = "Python's name")]
    JKR(work_of_adhesion), "(work_of_adhesion)", "jkr";
    /// The law of Maugis and Dugdale: a constant traction w/ρ where the gap is below ρ.
    ///
    /// Parameters
    /// ----------
    /// work_of_adhesion : float
    ///     Work of adhesion w ≥ 0, an energy per area.
    /// range : float
    ///     Range ρ > 0, a length.
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> asperity.MaugisDugdale(work_of_adhesion=1e-4, range=2e-3).traction([0.0, 3e-3])
    /// array([0.05, 0.  ])
    MaugisDugdale(work_of_adhesion, range), "(work_of_adhesion, range)", "maugis-dugdale";
    /// The law of Lennard-Jones between two half-spaces, φ'(g) = 8w/3z₀ (x³ − x⁹) with x = z₀/g.
    ///
    /// It attracts beyond the equilibrium separation z₀, and repels below: for a solve with ``wall="none"``, where
    /// contact is where it repels. For one with ``wall="hard"`` it has to be cut at z₀, from which the gap counts then.
    ///
    /// Parameters
    /// ----------
    /// work_of_adhesion : float
    ///     Work of adhesion w > 0, an energy per area.
    /// range : float
    ///     Distance of rest z₀ > 0, a length.
    /// cut : bool
    ///     Leaves the repulsion to a wall at z₀: x = z₀/(z₀ + g).
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> law = asperity.LennardJones(work_of_adhesion=0.05, range=3e-10)
    /// >>> law.traction(3e-10), bool(law.traction(2.9e-10) < 0)
    /// (0.0, True)
    LennardJones(work_of_adhesion, range; cut), "(work_of_adhesion, range, cut=False)", "lennard-jones",
        wall: if cut { Wall::Hard } else { Wall::None };
    /// The law of Morse, φ(g) = w (e² − 2e) with e = exp(−g/ρ): it attracts at g > 0, and repels at g < 0.
    ///
    /// With ``wall="none"`` it keeps the surfaces apart by itself; with a wall at g = 0 the attraction is what counts.
    ///
    /// Parameters
    /// ----------
    /// work_of_adhesion : float
    ///     Work of adhesion w > 0, an energy per area.
    /// range : float
    ///     Range ρ > 0, a length.
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> asperity.Morse(work_of_adhesion=0.05, range=5e-10).energy(0.0)
    /// -0.05
    Morse(work_of_adhesion, range), "(work_of_adhesion, range)", "morse";
    /// A power law, φ(g) = −w (1 + g/nρ)⁻ⁿ. Its tail reaches far: `CutOff` ends it.
    ///
    /// Parameters
    /// ----------
    /// work_of_adhesion : float
    ///     Work of adhesion w ≥ 0, an energy per area.
    /// range : float
    ///     Range ρ > 0, a length.
    /// exponent : float
    ///     Exponent n > 0 of the energy.
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> asperity.PowerLaw(work_of_adhesion=0.05, range=2e-9, exponent=3).traction(0.0)
    /// 25000000.0
    PowerLaw(work_of_adhesion, range, exponent), "(work_of_adhesion, range, exponent)", "power";
    /// The van der Waals attraction of two half-spaces, φ(g) = −A/12π(D₀ + g)². Its tail reaches far: `CutOff` ends it.
    ///
    /// Parameters
    /// ----------
    /// hamaker : float
    ///     Hamaker's constant A ≥ 0, an energy.
    /// range : float
    ///     Distance D₀ > 0 between the surfaces in contact, a length, often taken to be 0.165 nm.
    ///
    /// Examples
    /// --------
    /// >>> import asperity
    /// >>> law = asperity.VanDerWaals(hamaker=6e-20, range=0.165e-9)
    /// >>> f"work of adhesion {-law.energy(0.0):.4f} J/m²"
    /// 'work of adhesion 0.0585 J/m²'
    VanDerWaals(hamaker, range), "(hamaker, range)", "van-der-waals";
}
