//! The stability of an equilibrium: the sign of the smallest eigenvalue of the Hessian of the energy.
//!
//! A [`StabilityTest`] finds that eigenvalue and its mode, and a bound from below; [`Stability::leave`] leaves an
//! equilibrium that does not last.

use ndarray::Array2;

use crate::adhesion::{AdhesionLaw, Neighbourhood, Touched};

use crate::constraint::{ContactConstraint, Projection};
use crate::elastic::ElasticOperator;
use crate::error::{Error, Result};
use crate::field::{CHUNK, Field, Minimum, ordered, write};
use crate::names::names;
use crate::par::{self, Parts as _};
use crate::problem::{Control, Held, PressedFlat, Problem, ProblemMut, smoothed_law};
use crate::real::{Real, once};
use crate::setters::setters;
use crate::solver::{Of, Potential, Solution, check_wall, refuse_hardness};

mod bound;
mod departure;
mod edge;
mod eigenpair;
mod hessian;
mod stiffness;
mod tangent;
mod watch;

pub use departure::Departure;
pub use edge::EdgeError;
use eigenpair::{Eigenpair, lowest};
use hessian::Hessian;
pub use stiffness::ContactStiffness;
pub(crate) use watch::{Saddle, Watch};

/// The most iterations of a search for a mode, or for the gap that opens least; some ten are usual.
const MOST: usize = 500;

once! {
    /// A test of stability.
    judge<'a, T>(
        test: &'a StabilityTest, problem: ProblemMut<'a, T>, constraint: &'a dyn ContactConstraint<T>, control: Control,
        gap: (&'a Array2<T>, Near<'a>), relative_error: f64,
    ) -> Result<Stability<T>> = [within] StabilityTest::judge;
}

/// The verdict on an equilibrium: stable, unstable, or undecided.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Verdict {
    /// The smallest eigenvalue is bounded below by a positive number: a strict local minimum of the energy.
    Stable,
    /// There is a change of the gap along which the curvature of the energy is negative: a saddle, or a maximum.
    Unstable,
    /// Neither was shown: the smallest eigenvalue is too close to zero, or the iterations ran out.
    Undecided,
}

names!(Verdict { Stable = "stable", Unstable = "unstable", Undecided = "undecided" });

/// The stability test of an equilibrium, by the smallest eigenvalue of the second derivative of the energy:
///
/// ```math
/// λ = min over v of  ⟨v, (K⁻¹ + φ''(g)) v⟩ / ⟨v, v⟩ ,
/// ```
///
/// over the changes v of the gap that vanish where the surfaces touch, and have no mean if the mean gap is given; a
/// spring, and with a free boundary a given approach, adds its stiffness to the mean's. It is found by locally optimal
/// conjugate gradients (Knyazev, *SIAM J. Sci. Comput.* 23 (2001)) with the compliance as preconditioner, two operator
/// applications an iteration.
///
/// Their Rayleigh quotient is above λ; a larger tolerance makes the second eigenvalue likelier. A negative quotient
/// proves instability. With a positive quotient the lower bound is the softest stiffness plus the least φ'' if this is
/// enough, and otherwise a bound by a Lanczos iteration on the Hessian with the found mode lifted, and Temple's
/// inequality: close near limit points, and wrong for one in a million random starts (every run has the same).
///
/// | field | default | meaning | range |
/// |---|---|---|---|
/// | `tolerance` | 3e-3 | the norm of the residual of the mode, over the larger of its eigenvalue and the softest stiffness; the eigenvalue is right to about its square. Where it is nearly zero, the iteration continues until its sign is sure | positive |
/// | `max_iterations` | 500 | iterations for the mode, and again for the bound, after which the verdict is open | any |
/// | `bound` | true | whether to look for a lower bound; without one only the simple bound can show stability | |
/// | `control` | `None`: as in the solution | the control that holds the equilibrium | |
///
/// A law with jumps of the traction, as [`MaugisDugdale`](crate::MaugisDugdale), has a slope φ'' on lines where no node
/// lies: every equilibrium of the discrete energy is a minimum, pinned by the grid. Its traction is smoothed over a few
/// nodes, as for the [default start](crate::adhesion::Discretisation::Smooth), and the verdict is an estimate for the
/// continuum that gets better with the grid. [`Stability::smoothed`] says so.
///
/// ```
/// use asperity::stability::{StabilityTest, Verdict};
/// use asperity::{Control, Exponential, Grid, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(16, 1.0)?;
/// let flat = Surface::from_fn(grid, |_, _| 0.0)?;
/// let mut problem = Problem::new(&flat, Westergaard::<f64>::new(grid, 1.0)?, Exponential::new(1e-3, 1e-2)?)?;
/// // two flats at a uniform gap: πE*/L + φ''(g), which changes sign at g = ρ ln(wL/(πE*ρ²))
/// for (gap, verdict) in [(0.011, Verdict::Unstable), (0.012, Verdict::Stable)] {
///     let solution = Solver::default().solve(&mut problem, Control::MeanGap(gap))?;
///     let test = StabilityTest::default().tolerance(1e-3);
///     let stability = test.run(&mut problem, &solution)?;
///     let exact = std::f64::consts::PI - 10.0 * (-gap / 1e-2_f64).exp();
///     assert_eq!(stability.verdict, verdict);
///     assert!((stability.eigenvalue - exact).abs() < 1e-5);
/// }
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityTest {
    /// The relative residual of the mode.
    pub tolerance: f64,
    /// The most iterations, for the mode and again for the bound.
    pub max_iterations: usize,
    /// Whether to look for a lower bound of the eigenvalue.
    pub bound: bool,
    /// The control that holds the equilibrium; `None` is the control of the solution.
    pub control: Option<Control>,
}

impl Default for StabilityTest {
    fn default() -> Self {
        Self { tolerance: 3e-3, max_iterations: 500, bound: true, control: None }
    }
}

/// The stability of an equilibrium. Eigenvalues are pressures per length.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Stability<T> {
    /// The verdict.
    pub verdict: Verdict,
    /// The control that holds the equilibrium.
    pub control: Control,
    /// The Rayleigh quotient of the mode: no smaller than the smallest eigenvalue. Infinite where no node can move.
    pub eigenvalue: f64,
    /// The norm of the mode's residual: some eigenvalue, not necessarily the smallest, is within this distance.
    pub residual: f64,
    /// A lower bound of the smallest eigenvalue; see [`StabilityTest`] for how sure that is.
    pub lower_bound: f64,
    /// With a positive lower bound, the bound of the relative error in the energy norm:
    /// [`Report::relative_error`](crate::Report::relative_error) times 1 + max(−φ'')/(lower bound), to first order.
    pub error_bound: Option<f64>,
    /// The mode, of shape (Nx, Ny) and mean square 1: along it, by the amount a, the energy changes by
    /// ½·eigenvalue·a². With a free boundary or absent nodes it is the part of the operator's grid that faces the
    /// surface, and means are over all of that grid.
    pub mode: Array2<T>,
    /// Whether the jumps of the law were smoothed.
    pub smoothed: bool,
    /// The number of operator applications for the mode.
    pub operator_applications: usize,
    /// The number of operator applications for the lower bound.
    pub bound_applications: usize,
}

impl StabilityTest {
    setters! { tolerance: f64, max_iterations: usize, bound: bool }

    /// The default test, under a control that may differ from the solution's.
    pub fn under(control: Control) -> Self {
        Self { control: Some(control), ..Self::default() }
    }

    /// Tests a solution with a rigid wall; its gap may be in any memory layout.
    ///
    /// # Errors
    /// [`Error::Shape`] or [`Error::Value`] for a solution of another problem, or a tolerance that is not positive;
    /// [`Error::Unsuited`] if its wall is not rigid, or the law has no bound at a wall; [`Error::Contract`] if φ'' is
    /// not finite somewhere; [`Error::Unsuited`] for a control that the problem does not have.
    pub fn run<T: Real>(&self, problem: &mut Problem<T>, solution: &Solution<T>) -> Result<Stability<T>> {
        self.run_with(problem, &Projection, solution)
    }

    /// Tests a solution that was found with a constraint. Under springs, as with [`Penalty`](crate::Penalty), or
    /// without a wall ([`NoWall`](crate::NoWall)) every node may move; the stiffness of springs adds to φ''. Under
    /// springs that [end at a rigid wall](ContactConstraint::ends_rigid), as with [`Uzawa`](crate::Uzawa) after the
    /// solve, the nodes that springs press do not move.
    ///
    /// # Errors
    /// As [`StabilityTest::run`]; [`Error::Unsuited`] for another wall than the wall of the solution or the law;
    /// [`Error::Contract`] if the stiffness of the springs is not finite somewhere.
    pub fn run_with<T: Real>(
        &self,
        problem: &mut Problem<T>,
        constraint: &dyn ContactConstraint<T>,
        solution: &Solution<T>,
    ) -> Result<Stability<T>> {
        solution.check(&problem.parts(), constraint)?;
        let control = self.control.unwrap_or(solution.report.control);
        let (gap, near) = (&solution.gap, Near::Of(solution.touched.as_ref()));
        judge(self, problem.parts(), constraint, control, (gap, near), solution.report.relative_error)
    }

    /// Tests a gap that was kept with its [`Report::relative_error`](crate::Report::relative_error), under a control.
    ///
    /// # Errors
    /// As [`StabilityTest::run_with`]; [`Error::Value`] for a negative gap at a rigid wall.
    pub fn of_gap<T: Real>(
        &self,
        problem: &mut Problem<T>,
        constraint: &dyn ContactConstraint<T>,
        control: Control,
        gap: &Array2<T>,
        relative_error: f64,
    ) -> Result<Stability<T>> {
        judge(self, problem.parts(), constraint, control, (gap, Near::Contacts), relative_error)
    }

    fn judge<T: Real>(
        &self,
        problem: ProblemMut<'_, T>,
        constraint: &dyn ContactConstraint<T>,
        control: Control,
        (gap, near): (&Array2<T>, Near<'_>),
        relative_error: f64,
    ) -> Result<Stability<T>> {
        Error::positive("tolerance", self.tolerance)?;
        check_gap(&problem, constraint, gap)?;
        // the solution has the value of the mean gap, which springs may make negative
        let kind = if control.holds() == Held::MeanGap { control.with_value(0.0) } else { control };
        let ProblemMut { operator, law, flat, .. } = problem;
        let load = flat.load(kind, constraint.wall())?;
        let smoothed = smoothed_law(&*operator, law);
        let law = smoothed.as_deref().unwrap_or(law);
        let slopes = slopes(gap, (law, constraint), near, (&*operator, flat))?;
        let smoothed = smoothed.is_some();
        let hessian = Hessian::new(operator, slopes, load);
        let mut stability = self.verdict(hessian, control, relative_error, smoothed)?;
        stability.mode = flat.crop(stability.mode, T::zero()).into_owned();
        Ok(stability)
    }

    fn verdict<T: Real>(
        &self,
        mut hessian: Hessian<'_, T>,
        control: Control,
        relative_error: f64,
        smoothed: bool,
    ) -> Result<Stability<T>> {
        let steepest = (-hessian.least_slope()).max(0.0);
        let simple = hessian.simple_bound();
        let stability = |verdict, pair: Eigenpair<T>, lower_bound: f64, taken: usize, more: usize| Stability {
            verdict,
            control,
            eigenvalue: pair.value,
            residual: pair.residual,
            lower_bound,
            error_bound: (lower_bound > 0.0).then(|| relative_error * (1.0 + steepest / lower_bound)),
            mode: pair.vector.into_array(),
            smoothed,
            operator_applications: taken,
            bound_applications: more,
        };
        if hessian.dimension() == 0 {
            let nothing = Field::zeros(hessian.shape());
            let pair = Eigenpair { value: f64::INFINITY, residual: 0.0, noise: 0.0, vector: nothing };
            return Ok(stability(Verdict::Stable, pair, f64::INFINITY, 0, 0));
        }
        let pair = lowest(&mut hessian, self.tolerance, self.max_iterations)?;
        let taken = hessian.applications();
        if pair.value < -pair.noise {
            return Ok(stability(Verdict::Unstable, pair, f64::NEG_INFINITY, taken, 0));
        }
        let mut lower = if simple.is_nan() { f64::NEG_INFINITY } else { simple };
        if lower <= 0.0 && self.bound && pair.value > pair.noise {
            lower = lower.max(bound::below(&mut hessian, &pair, self.max_iterations)?);
        }
        let verdict = if lower > pair.noise { Verdict::Stable } else { Verdict::Undecided };
        let more = hessian.applications() - taken;
        Ok(stability(verdict, pair, lower, taken, more))
    }
}

fn check_gap<T: Real>(
    problem: &ProblemMut<'_, T>,
    constraint: &dyn ContactConstraint<T>,
    gap: &Array2<T>,
) -> Result<()> {
    problem.grid().fits("gap", gap.dim())?;
    if problem.flat.faces_all() {
        problem.grid().finite("gap", gap.view())?;
    }
    let yields = "a surface that yields has no energy: it does not come back where the load is taken away";
    refuse_hardness(constraint.wall(), yields)?;
    check_wall(problem.law, constraint.wall())?;
    let negative = gap.iter().find(|&&gap| constraint.wall().is_rigid() && gap < T::zero());
    let refused = negative.map_or(Ok(()), |gap| {
        let requirement =
            "zero or positive; a solution with springs or without a wall is looked at with its constraint";
        Err(Error::Value { name: "gap", value: gap.widen(), requirement })
    });
    problem.grid().agreed(refused)
}

/// Where surfaces attract each other by a law that [does so next to contacts alone](crate::adhesion::Hints::touching).
#[derive(Clone, Copy)]
pub(crate) enum Near<'a> {
    /// Next to the contacts of the gap.
    Contacts,
    /// At the nodes of a solution, or everywhere.
    Of(Option<&'a Array2<bool>>),
}

/// φ'' at every node of the operator's grid, infinite where a rigid wall is touched, or springs press that end as one.
fn slopes<T: Real>(
    gap: &Array2<T>,
    (law, constraint): (&dyn AdhesionLaw<T>, &dyn ContactConstraint<T>),
    near: Near<'_>,
    (operator, flat): (&dyn ElasticOperator<T>, &PressedFlat<T>),
) -> Result<Field<T>> {
    let grid = operator.grid();
    let (held, gap) = (flat.held(grid), flat.hold(gap));
    let gaps = ordered(gap.view());
    let mut slopes = Field::zeros(gap.dim());
    let wall = constraint.wall();
    let touches = |node, gap| match wall.springs() {
        Some(springs) => constraint.ends_rigid() && springs.traction(node, gap) < T::zero(),
        None => wall.projects() && gap <= T::zero(),
    };
    let near = match near {
        Near::Contacts => law.hints().touches().then_some(None),
        Near::Of(touched) => touched.map(Some),
    };
    let touched = near.map(|touched| {
        let mut neighbourhood = Neighbourhood::none(held, operator.boundary().is_periodic());
        if let Some(touched) = touched {
            neighbourhood.add(&Field::of(flat.hold(touched)));
        } else {
            let nodes = neighbourhood.contact.nodes_mut().iter_mut().zip(&*gaps).zip(held.first_node()..);
            nodes.for_each(|((contact, &gap), node)| *contact = touches(node, gap));
            neighbourhood.grow();
        }
        Touched { law, neighbourhood }
    });
    let law = touched.as_ref().map_or(law, |touched| touched);
    let local = Potential::new(law, constraint, None);
    let wrong = held.reducer().run(par::chunks(&gaps, CHUNK).zip(write(&mut slopes)), |first, (gap, slopes)| {
        let mut wrong = f64::INFINITY;
        local.evaluate(Of::Slope, first, gap, slopes);
        for (i, (slope, &gap)) in slopes.iter_mut().zip(gap).enumerate() {
            if touches(first + i, gap) {
                *slope = T::infinity();
            } else if !(slope.is_finite() && gap.is_finite()) && (flat.faces_all() || gap != T::infinity()) {
                wrong = wrong.min((first + i) as f64);
            }
        }
        Minimum(wrong)
    });
    if wrong.0.is_finite() {
        let own = (wrong.0 as usize).checked_sub(held.first_node());
        let own = own.and_then(|node| Some((gaps.get(node)?.widen(), slopes.nodes().get(node)?.widen())));
        let refused =
            own.map_or(Ok(()), |(gap, value)| Err(Error::not_finite("slope of the local traction", gap, value)));
        held.agreed(refused)?;
    }
    // nothing attracts, and nothing confines, where no surface faces the half-space
    Ok(flat.place(slopes, T::zero()))
}
