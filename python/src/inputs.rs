//! The inputs of a problem by the names of their keywords: body, wall, load and settings. The law has a file of its
//! own.

use asperity::accuracy::{Accuracy, Quantity};
use asperity::{
    Boussinesq, Branch, ContactConstraint, Control, ElasticOperator, Grid, NoWall, Projection, Real, Settings, Solver,
    Surface, Westergaard,
};
use asperity_maps::io::{available_memory, check_memory};
use asperity_maps::warning::{Warning, WarningCode};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// What is beyond the surface.
#[derive(Clone, Copy, PartialEq)]
pub enum Beyond {
    /// the same again
    Periodic,
    /// nothing
    Free,
}

impl Beyond {
    /// The boundary of a name.
    pub fn of(name: &str) -> PyResult<Self> {
        match name {
            "periodic" => Ok(Self::Periodic),
            "free" => Ok(Self::Free),
            other => Err(PyValueError::new_err(format!("boundary is {other}: it must be periodic or free"))),
        }
    }

    /// The elastic body of a problem, if the machine has the memory for a solve: five fields of `f64`, and four times
    /// as many with a free boundary.
    pub fn half_space<T: Real>(self, grid: Grid, modulus: f64) -> asperity::Result<Box<dyn ElasticOperator<T>>> {
        check_memory("a solve", grid.shape(), if self == Self::Free { 160 } else { 40 })?;
        Ok(match self {
            Self::Periodic => Box::new(Westergaard::<T>::new(grid, modulus)?),
            Self::Free => Box::new(Boussinesq::<T>::new(grid, modulus)?),
        })
    }

    /// The probable mistakes in the heights: where nothing repeats, nothing has to meet, and a body that ends may be
    /// flat.
    pub fn warnings(self, surface: &Surface) -> Vec<Warning> {
        let (mut found, free) = (Warning::of_surface(surface), self == Self::Free);
        found.retain(|warning| match warning.code {
            WarningCode::Tilt | WarningCode::OpenEdges | WarningCode::Ends => !free,
            WarningCode::Flat => !free && surface.absent().is_none(),
            _ => true,
        });
        found
    }
}

/// What keeps the surfaces apart.
#[derive(Clone, Copy, PartialEq)]
pub enum Wall {
    /// A rigid wall, at zero gap
    Hard,
    /// The law itself
    None,
}

impl Wall {
    /// The wall of a name.
    pub fn of(name: &str) -> PyResult<Self> {
        match name {
            "hard" => Ok(Self::Hard),
            "none" => Ok(Self::None),
            other => Err(PyValueError::new_err(format!("wall is {other}: it must be hard or none"))),
        }
    }
}

impl<T: Real> ContactConstraint<T> for Wall {
    fn wall(&self) -> asperity::constraint::Wall<'_, T> {
        match self {
            Self::Hard => Projection.wall(),
            Self::None => NoWall.wall(),
        }
    }
}

/// A load as Python passes it: the name of the keyword and its numbers.
pub type Load = (String, Vec<f64>);

/// The control of a load.
pub fn control((name, numbers): &Load) -> PyResult<Control> {
    match (name.as_str(), numbers.as_slice()) {
        ("mean_gap", &[gap]) => Ok(Control::MeanGap(gap)),
        ("mean_pressure", &[pressure]) => Ok(Control::MeanPressure(pressure)),
        ("normal_force", &[force]) => Ok(Control::Force(force)),
        ("approach", &[approach]) => Ok(Control::Approach(approach)),
        ("spring", &[stiffness, rest]) => Ok(Control::Spring { stiffness, rest }),
        // of no meaning before it is found
        ("contact_fraction", &[_]) => Ok(Control::MeanPressure(0.0)),
        (name, numbers) => Err(PyValueError::new_err(format!("{name} is no load with {} numbers", numbers.len()))),
    }
}

/// The contact fraction of a load, if its load is to be found.
pub fn contact_fraction((name, numbers): &Load) -> Option<f64> {
    if let ("contact_fraction", &[fraction]) = (name.as_str(), numbers.as_slice()) { Some(fraction) } else { None }
}

/// An accuracy as Python passes it: the relative error, the name of the quantity, and the memory in GiB.
pub type Goal = (f64, String, Option<f64>);

/// The bytes of a GiB.
const GIB: f64 = 1_073_741_824.0;

/// The accuracy that is asked for, by a solver.
pub fn accuracy((target, of, memory): &Goal, solver: Solver<Wall>) -> PyResult<Accuracy<Wall>> {
    let quantities = [Quantity::Area, Quantity::Gap, Quantity::Pressure, Quantity::Stiffness];
    let Some(quantity) = quantities.into_iter().find(|quantity| quantity.name() == of) else {
        let names = quantities.map(Quantity::name).join(", ");
        return Err(PyValueError::new_err(format!("accuracy_of is {of}: it must be one of {names}")));
    };
    let mut wanted = Accuracy::with_solver(*target, quantity, solver);
    wanted.memory = match *memory {
        None => available_memory(),
        Some(memory) if memory > 0.0 => memory * GIB,
        Some(memory) => return Err(PyValueError::new_err(format!("memory is {memory}: it must be positive, in GiB"))),
    };
    Ok(wanted)
}

/// The stiffness of a spring, if the load is one.
pub fn stiffness(control: Control) -> Option<f64> {
    if let Control::Spring { stiffness, .. } = control { Some(stiffness) } else { None }
}

/// The settings of a solver.
pub fn settings(
    tolerance: Option<f64>,
    max_iterations: Option<usize>,
    method: &str,
    branch: Option<&str>,
) -> PyResult<Settings> {
    let default = match method {
        "default" => Settings::default(),
        "rey2017" => Settings::rey2017(),
        other => return Err(PyValueError::new_err(format!("method is {other}: it must be default or rey2017"))),
    };
    let max_iterations = max_iterations.unwrap_or(default.max_iterations);
    let branch = match branch {
        None | Some("both") => None,
        Some("loading") => Some(Branch::Loading),
        Some("unloading") => Some(Branch::Unloading),
        Some(other) => {
            return Err(PyValueError::new_err(format!("branch is {other}: it must be loading, unloading or both")));
        }
    };
    Ok(default.tolerance(tolerance).max_iterations(max_iterations).branch(branch))
}
