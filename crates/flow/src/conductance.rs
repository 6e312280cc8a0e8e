//! Conductance of heat and electric current through a contact, from its stiffness.

use asperity::stability::ContactStiffness;
use asperity::{Boussinesq, Control, Error, Grid, NoAdhesion, Problem, Result, Solver, Surface, Westergaard};
use ndarray::ArrayView2;

/// The mean pressure under which a punch with the outline of the contact is pressed, over E*, and its depth over the
/// longer side: displacements are far less.
const PRESSED: f64 = 1e-6;

/// The conductance of a contact between two half-spaces, for electric current or for heat.
///
/// Current is constricted by the spots of contact as stress is. With the stiffness dF/dδ of the contact at fixed spots, the
/// contact modulus E* and the resistivities ρ₁ and ρ₂ of the bodies (for heat, the reciprocals of their conductivities)
///
/// ```math
/// 1/R = 2 (dF/dδ) / (E* (ρ₁ + ρ₂))
/// ```
///
/// holds whatever the shape and the number of the spots: J. R. Barber, Proc. R. Soc. A 459, 53 (2003). A circular spot of
/// radius a has dF/dδ = 2aE*, and R = (ρ₁ + ρ₂)/4a (Holm). The spots conduct perfectly, and the gap not at all.
///
/// The stiffness has to belong to a problem on half-spaces without adhesion, with the gap of the solution: the slope of
/// a law between the spots carries load, but no current.
///
/// ```
/// use asperity::stability::ContactStiffness;
/// use asperity::{Boussinesq, Control, Grid, NoAdhesion, Problem, Solver, Surface};
/// use asperity_flow::Conductance;
/// let grid = Grid::square(64, 1.0)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&sphere, Boussinesq::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let solution = Solver::default().solve(&mut problem, Control::Approach(0.04))?; // a² = Rδ
/// let stiffness = ContactStiffness::of(&mut problem, &solution)?;
/// let conductance = Conductance::from_stiffness(&stiffness, 1.0, (2e-8, 3e-8))?;
/// let holm = 4.0 * (2.0_f64 * 0.04).sqrt() / 5e-8; // 4a/(ρ₁ + ρ₂)
/// assert!((conductance.whole / holm - 1.0).abs() < 0.03);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductance {
    /// The conductance per area of the map, in units of a length over a resistivity and an area.
    pub per_area: f64,
    /// The conductance 1/R of the whole map.
    pub whole: f64,
    /// The relative error of the stiffness: the error of its solve and, where known, the estimated error of the grid.
    pub relative_error: f64,
}

impl Conductance {
    /// The conductance of a contact of a stiffness, between bodies with a contact modulus E* and two resistivities.
    ///
    /// # Errors
    /// [`Error::Value`] if the modulus is not positive, a resistivity is negative, both are zero, or the stiffness is
    /// negative or not a number, as with adhesion.
    pub fn from_stiffness(stiffness: &ContactStiffness, modulus: f64, resistivities: (f64, f64)) -> Result<Self> {
        let pressure_per_length = stiffness.pressure_per_length;
        if pressure_per_length.is_nan() || pressure_per_length < 0.0 {
            let requirement = "at least zero: take the stiffness of a problem without adhesion";
            return Err(Error::Value { name: "contact stiffness", value: pressure_per_length, requirement });
        }
        let error = stiffness.error().unwrap_or(stiffness.relative_error);
        Self::checked((pressure_per_length, stiffness.force_per_length, error), modulus, resistivities)
    }

    /// The conductance by a stiffness per area, by the stiffness of the whole, and by its relative error.
    fn checked(
        (per_area, whole, relative_error): (f64, f64, f64),
        modulus: f64,
        resistivities: (f64, f64),
    ) -> Result<Self> {
        let modulus = Error::positive("contact modulus", modulus)?;
        let first = Error::non_negative("resistivity of the first body", resistivities.0)?;
        let second = Error::non_negative("resistivity of the second body", resistivities.1)?;
        let per_stiffness = 2.0 / (modulus * Error::positive("sum of both resistivities", first + second)?);
        Ok(Self { per_area: per_stiffness * per_area, whole: per_stiffness * whole, relative_error })
    }

    /// The conductance of spots of contact on a grid, in a periodic cell or between free half-spaces: with a law too,
    /// which leaves the spots what they are. The error contains the solves alone.
    ///
    /// ```
    /// use asperity::Grid;
    /// use asperity_flow::Conductance;
    /// let grid = Grid::square(64, 1.0)?;
    /// let spot = grid.sample(|x, y| x * x + y * y).mapv(|square| square <= 0.09);
    /// let conductance = Conductance::of_spots(spot.view(), grid, false, (0.5, 0.5))?;
    /// assert!((conductance.whole / (4.0 * 0.3) - 1.0).abs() < 0.03); // 4a/(ρ₁ + ρ₂)
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::from_stiffness`], and [`Error::Shape`] if the contact is not on the grid.
    pub fn of_spots(
        contact: ArrayView2<'_, bool>,
        grid: Grid,
        periodic: bool,
        resistivities: (f64, f64),
    ) -> Result<Self> {
        let (lx, ly) = grid.lengths();
        Error::shape("contact", contact.dim(), grid.shape())?;
        if !contact.iter().any(|contact| *contact) {
            return Self::checked((0.0, 0.0, 0.0), 1.0, resistivities);
        }
        let punch = Surface::new(grid, contact.mapv(|contact| if contact { 0.0 } else { -lx.max(ly) }))?;
        let mut problem = if periodic {
            Problem::new(&punch, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?
        } else {
            Problem::new(&punch, Boussinesq::<f64>::new(grid, 1.0)?, NoAdhesion)?
        };
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(PRESSED))?;
        let mut stiffness = ContactStiffness::of(&mut problem, &solution)?;
        // the edge of a punch is where its nodes are
        stiffness.edge = None;
        Self::from_stiffness(&stiffness, 1.0, resistivities)
    }
}
