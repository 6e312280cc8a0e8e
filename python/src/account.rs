//! The account of a solve: all that its report and the solution of Python have.

use asperity::accuracy::{GridError, Quantity};
use asperity::contact::{ContactArea, ContactStatistics};
use asperity::stability::Stability;
use asperity::{Control, FoundContact, Grid, Level, NestedSolution, Real, Solution, Warning};
use numpy::Element;
use numpy::ndarray::Array2;
use rayon::prelude::*;

/// A scalar in which one can solve, and that numpy has.
pub trait Scalar: Real + Element {}
impl<T: Real + Element> Scalar for T {}

/// The account of nested grids.
pub struct Grids {
    pub levels: Vec<Level>,
    /// The applications on all of them in units of one on the finest.
    pub applications: f64,
    /// The estimated errors of the finest grid, where they can be told.
    pub errors: [(Quantity, Option<GridError>); 4],
}

impl Grids {
    /// The account of a solution, of a surface with so many nodes in its shortest wave.
    pub fn of<T>(found: &NestedSolution<T>, nodes_per_wave: f64, control: Control) -> Self {
        let errors = GridError::of_all(&found.levels, control, nodes_per_wave, found.solution.report.mu_rho);
        Self { levels: found.levels.clone(), applications: found.equivalent_applications(), errors }
    }
}

/// The account of a search for the load of a contact fraction.
pub struct Search {
    pub wanted: f64,
    pub reached: bool,
    pub below: Option<f64>,
    pub above: Option<f64>,
    pub solves: usize,
    pub operator_applications: usize,
}

impl Search {
    /// The account of what was found for a fraction.
    pub fn of<T>(wanted: f64, found: &FoundContact<T>) -> Self {
        let &FoundContact { reached, below, above, solves, operator_applications, .. } = found;
        Self { wanted, reached, below, above, solves, operator_applications }
    }
}

/// The account of a solve.
pub struct Account<T> {
    pub solution: Solution<T>,
    pub contact: Array2<bool>,
    pub area: ContactArea,
    /// The statistics of the contact.
    pub statistics: Option<ContactStatistics>,
    /// The least (most tensile) and the greatest elastic pressure.
    pub pressures: (f64, f64),
    pub control: Control,
    /// The search for the load, if there was one.
    pub search: Option<Search>,
    /// The nested grids, if they were used.
    pub grids: Option<Grids>,
    pub stability: Option<Stability<T>>,
    /// The eigenvalue, energy drop and distance of each unstable equilibrium that was left.
    pub departures: Option<Vec<(f64, f64, f64)>>,
    /// The node with the largest work of adhesion, where that varies.
    pub strongest: Option<(usize, usize)>,
    pub warnings: Vec<Warning>,
    pub seconds: f64,
}

impl<T: Scalar> Account<T> {
    /// The account of a solution, with the warnings of the answer alone.
    pub fn of(solution: Solution<T>, grid: &Grid, control: Control, modulus: f64) -> asperity::Result<Self> {
        let contact = || {
            let map = solution.contact_map();
            ContactArea::of_solution(&solution, map.view(), grid).map(|area| (map, area))
        };
        let pressures = || (extremes(&solution.pressure), Warning::of_solution(&solution, modulus));
        let (contact, (pressures, warnings)) = rayon::join(contact, pressures);
        let (contact, area) = contact?;
        Ok(Self {
            solution,
            contact,
            area,
            statistics: None,
            pressures,
            control,
            search: None,
            grids: None,
            stability: None,
            departures: None,
            strongest: None,
            warnings,
            seconds: 0.0,
        })
    }
}

/// The least and the greatest value of a field.
fn extremes<T: Scalar>(field: &Array2<T>) -> (f64, f64) {
    let join = |(a, b): (f64, f64), (c, d): (f64, f64)| (a.min(c), b.max(d));
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let of = |values: &[T]| values.iter().fold(none, |found, value| join(found, (value.widen(), value.widen())));
    let field = field.as_standard_layout();
    field.as_slice().unwrap_or_default().par_chunks(1 << 12).map(of).reduce(|| none, join)
}
