//! The account of a solve: all that its report and the solution of Python have.

use asperity::accuracy::Quantity;
use asperity::nested::Level;
use asperity::search::FoundContact;
use asperity::stability::{ContactStiffness, Stability};
use asperity::{Real, Report, Solution};
use asperity_maps::warning::Warning;
use numpy::Element;
use numpy::ndarray::Array2;

use crate::sight::Sight;

/// A scalar in which one can solve, and that numpy has.
pub trait Scalar: Real + Element {}
impl<T: Real + Element> Scalar for T {}

/// The account of nested grids.
pub struct Grids {
    pub levels: Vec<Level>,
    /// The applications on all of them in units of one on the finest.
    pub applications: f64,
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

/// The solution on the other branch of equilibria.
pub struct Other {
    pub report: Report,
    pub distance: f64,
    pub same: bool,
}

/// The account of a solve.
pub struct Account<T> {
    pub solution: Solution<T>,
    /// The search for the load, if there was one.
    pub search: Option<Search>,
    /// The nested grids, if they were used.
    pub grids: Option<Grids>,
    pub stability: Option<Stability<T>>,
    pub stiffness: Option<ContactStiffness>,
    pub reached: Option<Reached>,
    /// The solution on the other branch, if both are asked for.
    pub other: Option<Other>,
    /// The eigenvalue, energy drop and distance of each unstable equilibrium that was left.
    pub departures: Option<Vec<(f64, f64, f64)>>,
    /// The node with the largest work of adhesion, where that varies.
    pub strongest: Option<(usize, usize)>,
    pub warnings: Vec<Warning>,
    /// The unit of lengths, if it is known.
    pub unit: Option<String>,
    /// The time of the solve.
    pub seconds: f64,
    /// What is found once it is asked for.
    pub sight: Sight<T>,
}
