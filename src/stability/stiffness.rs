//! The contact stiffness: the increment of pressure over the increment of approach.

use super::edge::EdgeError;
use super::hessian::Hessian;
use super::tangent::Tangent;
use super::{MOST, Near, check_gap, slopes};
use crate::constraint::{ContactConstraint, Projection};
use crate::error::{Error, Result};
use crate::field::Field;
use crate::problem::{Load, Problem, ProblemMut, smoothed_law};
use crate::real::{Real, once};
use crate::solver::Solution;

once! {
    /// The contact stiffness of a solution.
    find<'a, T>(
        problem: ProblemMut<'a, T>, constraint: &'a dyn ContactConstraint<T>, solution: &'a Solution<T>, tolerance: f64,
    ) -> Result<ContactStiffness> = [within] ContactStiffness::find;
}

/// The contact stiffness of an equilibrium: how much the load grows as the bodies approach each other by a length.
///
/// With δ the approach, p̄ the mean pressure and F = p̄·Lx·Ly, the stiffness is k = dp̄/dδ, a pressure per length, and
/// dF/dδ, a force per length. In a periodic cell it is the stiffness against the mean gap, k = −dp̄/dḡ. To first order
/// the nodes in contact stay in contact, and the others change their gaps by v at a mean of 1, with
///
/// ```math
/// v = 0 on the contact ,   K⁻¹v + φ''(g) v = k elsewhere ,   ⟨v⟩ = 1 ,   k = ⟨v, (K⁻¹ + φ''(g)) v⟩ .
/// ```
///
/// Without adhesion this is a flat punch with the outline of the contact, and k is the least energy of all such v,
/// found by conjugate gradients from above; ⟨r, K r⟩ ≥ ⟨v − v*, K⁻¹(v − v*)⟩ with the residual r bounds
/// [`relative_error`](Self::relative_error). A contact of radius a on a free half-space has dF/dδ = 2aE* (Sneddon
/// 1965). On rough surfaces the grid leaves some 1 % with 8 nodes in the shortest wave, and 0.3 % with 16.
///
/// It is zero without contact and adhesion, infinite where all nodes are in contact, and under adhesion possibly
/// negative: then the equilibrium needs a given mean gap, or a stiff spring.
///
/// The conductance follows from the stiffness (Barber, *Proc. R. Soc. A* 459, 53 (2003)): between half-spaces of
/// resistivities ρ₁ and ρ₂ (for heat, reciprocal conductivities) the conductance per area is
///
/// ```math
/// G = 2k / (E* (ρ₁ + ρ₂)) ,
/// ```
///
/// and a circular spot of radius a has Holm's 4a/(ρ₁ + ρ₂).
///
/// ```
/// use asperity::stability::ContactStiffness;
/// use asperity::{Boussinesq, Control, Grid, NoAdhesion, Problem, Solver, Surface};
/// let grid = Grid::square(64, 1.0)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&sphere, Boussinesq::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let solution = Solver::default().solve(&mut problem, Control::Approach(0.04))?; // a² = Rδ
/// let stiffness = ContactStiffness::of(&mut problem, &solution)?;
/// let hertz = 2.0 * (2.0_f64 * 0.04).sqrt(); // 2aE*
/// assert!((stiffness.force_per_length / hertz - 1.0).abs() < 0.03);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactStiffness {
    /// The stiffness k = dp̄/dδ, pressure per length. NaN where the curvature is negative along some change of the
    /// gap: such an equilibrium does not last even at a given mean gap.
    pub pressure_per_length: f64,
    /// The stiffness dF/dδ = k·Lx·Ly, force per length.
    pub force_per_length: f64,
    /// The relative error of the linear solve, at most 1e-6 from [`ContactStiffness::of`], 1e-4 in `f32`. Without
    /// adhesion it bounds how much too large the stiffness is.
    pub relative_error: f64,
    /// Whether the jumps of the law were smoothed, as for [`StabilityTest`](super::StabilityTest).
    pub smoothed: bool,
    /// The number of operator applications.
    pub operator_applications: usize,
    /// The estimated error of the grid in a periodic cell. `None` with a free boundary or absent nodes, where no node
    /// or every one is in contact, under springs or a law in place of the wall, and by a law with the range of the
    /// grid: there edges move.
    pub edge: Option<EdgeError>,
}

impl ContactStiffness {
    /// A relative error far below the error of any affordable grid, in either precision.
    pub const TOLERANCE: f64 = 1e-4;

    /// The contact stiffness of a solution with a rigid wall; its gap may be in any memory layout. Memory per node:
    /// seven scalars.
    ///
    /// # Errors
    /// As [`StabilityTest::run`](super::StabilityTest::run), but for the tolerance.
    pub fn of<T: Real>(problem: &mut Problem<T>, solution: &Solution<T>) -> Result<Self> {
        Self::of_constrained(problem, &Projection, solution, if T::NAME == f32::NAME { Self::TOLERANCE } else { 1e-6 })
    }

    /// The contact stiffness of a solution that was found with a constraint, to a relative error. Springs of the
    /// constraint, and laws without a wall, resist with their slopes; no node is fixed then. Under springs that
    /// [end at a rigid wall](ContactConstraint::ends_rigid), as with [`Uzawa`](crate::Uzawa) after the solve, the nodes
    /// that springs press are fixed.
    ///
    /// # Errors
    /// As [`StabilityTest::run_with`](super::StabilityTest::run_with), with the tolerance.
    pub fn of_constrained<T: Real>(
        problem: &mut Problem<T>,
        constraint: &dyn ContactConstraint<T>,
        solution: &Solution<T>,
        tolerance: f64,
    ) -> Result<Self> {
        find(problem.parts(), constraint, solution, tolerance)
    }

    fn find<T: Real>(
        problem: ProblemMut<'_, T>,
        constraint: &dyn ContactConstraint<T>,
        solution: &Solution<T>,
        tolerance: f64,
    ) -> Result<Self> {
        Error::positive("tolerance", tolerance)?;
        solution.check(&problem, constraint)?;
        check_gap(&problem, constraint, &solution.gap)?;
        let ProblemMut { operator, law, flat, .. } = problem;
        if law.hints().zero && solution.report.contact_nodes == 0 {
            return Ok(Self {
                pressure_per_length: 0.0,
                force_per_length: 0.0,
                relative_error: 0.0,
                smoothed: false,
                operator_applications: 0,
                edge: None,
            });
        }
        let smoothed = smoothed_law(&*operator, law);
        let followed = smoothed.as_deref().unwrap_or(law);
        let near = Near::Of(solution.touched.as_ref());
        let slopes = slopes(&solution.gap, (followed, constraint), near, (&*operator, flat))?;
        let rigid = constraint.wall().is_rigid() && flat.faces_all();
        let (is_adhesive, of_grid) = (!law.hints().zero, law.hints().of_grid);
        let at_edge = rigid && solution.report.contact_nodes > 0 && !of_grid;
        let smoothed = smoothed.is_some();
        let mut hessian = Hessian::new(operator, slopes, Load::Gap(0.0));
        hessian.hold(flat.stiffness);
        let gap = &solution.gap;
        let start = flat.extend(gap);
        let least = least_energy(&mut hessian, start, (tolerance, at_edge))?;
        let LeastEnergy { energy: on_grid, relative_error, tangent } = least;
        let operator_applications = hessian.applications();
        // the mean of a free half-space gives way besides its waves
        let series = if on_grid == 0.0 { 0.0 } else { (on_grid.recip() + flat.boundary.mean_compliance()).recip() };
        let pressure_per_length = flat.padding * series;
        let force_per_length = pressure_per_length * flat.area;
        let edge = tangent.map(|tangent| EdgeError::of(solution, &tangent, (on_grid, is_adhesive))).transpose()?;
        Ok(Self { pressure_per_length, force_per_length, relative_error, smoothed, operator_applications, edge })
    }
}

/// The least ⟨v, Hv⟩ of all v that vanish on the contact and have the mean 1.
struct LeastEnergy<T> {
    energy: f64,
    relative_error: f64,
    /// The field v, and its pressure, if wanted and v exists.
    tangent: Option<Tangent<T>>,
}

/// The least energy, from a start that need not vanish on the contact or have the mean 1.
fn least_energy<T: Real>(
    hessian: &mut Hessian<'_, T>,
    start: Field<T>,
    (tolerance, with_tangent): (f64, bool),
) -> Result<LeastEnergy<T>> {
    if hessian.free() == 0.0 {
        return Ok(LeastEnergy { energy: f64::INFINITY, relative_error: 0.0, tangent: None });
    }
    let mut opening = start;
    hessian.admit(&mut opening);
    let [mut residual, mut image] = [(); 2].map(|()| Field::<T>::zeros(hessian.shape()));
    let level = hessian.apply(&opening, &mut image)?;
    let mut energy = hessian.product(&opening, &image) + level;
    hessian.combine(0.0, &mut residual, -1.0, &image);
    let [mut direction, mut preconditioned] = [(); 2].map(|()| Field::zeros(hessian.shape()));
    let mut before = 0.0;
    let mut error = f64::INFINITY;
    for iteration in 0..=MOST {
        error = hessian.precondition(&residual, &mut preconditioned)?;
        let descent = hessian.product(&residual, &preconditioned);
        if descent <= 0.0 || error <= tolerance * energy.abs() || iteration == MOST {
            break;
        }
        let keep = if iteration == 0 { 0.0 } else { descent / before };
        hessian.combine(keep, &mut direction, 1.0, &preconditioned);
        hessian.apply(&direction, &mut image)?;
        let curvature = hessian.product(&direction, &image);
        if curvature.is_nan() || curvature <= 0.0 {
            return Ok(LeastEnergy { energy: f64::NAN, relative_error: f64::NAN, tangent: None });
        }
        let step = descent / curvature;
        hessian.combine(1.0, &mut opening, step, &direction);
        hessian.combine(1.0, &mut residual, -step, &image);
        energy -= step * descent;
        before = descent;
    }
    if with_tangent {
        hessian.reaction(&opening, energy, &mut image)?;
    }
    let relative_error = if error == 0.0 { 0.0 } else { error / energy.abs() };
    Ok(LeastEnergy { energy, relative_error, tangent: with_tangent.then_some(Tangent { opening, pressure: image }) })
}
