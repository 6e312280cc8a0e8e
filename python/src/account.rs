//! The account of a solve: all that its report and the solution of Python have.

use asperity::accuracy::{GridError, Quantity};
use asperity::contact::{ContactArea, ContactStatistics};
use asperity::stability::{ContactStiffness, Stability};
use asperity::{Control, Grid, Level, Real, Solution, Warning};
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
    /// The account of the grids on the way to a solution, of a surface with so many nodes in its shortest wave.
    pub fn of<T>(
        (levels, applications): (Vec<Level>, f64),
        solution: &Solution<T>,
        nodes_per_wave: f64,
        control: Control,
    ) -> Self {
        let errors = GridError::of_all(&levels, control, nodes_per_wave, solution.report.mu_rho);
        Self { levels, applications, errors }
    }
}

/// What became of an accuracy that was asked for.
pub struct Reached {
    pub wanted: f64,
    pub of: Quantity,
    pub reached: bool,
    /// Whether the surface could be refined.
    pub refinable: bool,
    /// The next finer grid and its bytes, if that was too much.
    pub unaffordable: Option<((usize, usize), f64)>,
    /// The heights on the grid of the answer.
    pub heights: Array2<f64>,
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
    /// The nested grids, if they were used.
    pub grids: Option<Grids>,
    pub stability: Option<Stability<T>>,
    pub stiffness: Option<ContactStiffness>,
    pub reached: Option<Reached>,
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
            grids: None,
            stability: None,
            stiffness: None,
            reached: None,
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
