//! A check of an elastic operator, for users' tests.

use ndarray::Array2;

use super::coarse::CoarseSpace;
use super::{Boundary, ElasticOperator, Foundation, mean_product};
use crate::error::{Breach, Error, Place, Result};
use crate::grid::Grid;
use crate::real::Real;

/// The applications of compliance and stiffness that look for the softest and the stiffest wave, and the dimension of a
/// coarse space that is checked: enough to find what is broken.
const ENOUGH: usize = 20;

/// A check of an elastic operator against the contract of [`ElasticOperator`], for a test of yours.
///
/// On random fields, the same in every run, and to the rounding of the precision, it compares
///
/// - ⟨a, K⁻¹b⟩ with ⟨K⁻¹a, b⟩, and ⟨a, K b⟩ with ⟨K a, b⟩ (symmetric);
/// - the means of K⁻¹a and K a with zero, and K⁻¹(a + 1) with K⁻¹a (a rigid translation costs nothing);
/// - K K⁻¹a with a less its mean (each other's inverse);
/// - Rayleigh quotients of the softest and stiffest fields that twenty applications find with `stiffness_range`;
/// - the work of a displacement and the products of the preconditioner M with products of the fields, and ⟨a, M b⟩ with
///   ⟨M a, b⟩;
/// - with a spectral operator, K⁻¹a with K⁻¹a in `f32`, with K⁻¹a of heights in `f64`, and with K⁻¹a after memory was
///   given back.
///
/// # Errors
/// [`Error::Contract`] with the first property that does not hold; errors of the operator itself.
///
/// ```
/// use asperity::elastic::check_operator;
/// use asperity::{Grid, Westergaard};
/// check_operator(&mut Westergaard::<f64>::new(Grid::new((24, 15), (1.0, 0.7))?, 1.0)?)?;
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn check_operator<T: Real>(operator: &mut dyn ElasticOperator<T>) -> Result<()> {
    let grid = *operator.grid();
    grid.slab().alone("check of an operator")?;
    let shape = grid.shape();
    let [a, b] = [1, 2].map(|seed| random::<T>(shape, seed));
    let (of_a, of_b) = (Array2::zeros(shape), Array2::zeros(shape));
    if a.len() < 2 {
        return Ok(());
    }
    let mut check = Check { operator, grid, a, b, of_a, of_b };
    check.stiffness()?;
    check.compliance()?;
    check.preconditioner()?;
    if let Boundary::Free { window, mean_compliance } = check.operator.boundary() {
        holds("spacing of the window over the spacing of the grid", window.spacing().0 / grid.spacing().0, 1.0, 1e-12)?;
        holds("sign of the mean compliance", mean_compliance.signum(), 1.0, 0.0)?;
    }
    let space = check.spectral()?;
    check.coarse_space(space)?;
    check.range()
}

/// An operator, two random fields, and what it makes of them.
struct Check<'a, T> {
    operator: &'a mut dyn ElasticOperator<T>,
    grid: Grid,
    a: Array2<T>,
    b: Array2<T>,
    of_a: Array2<T>,
    of_b: Array2<T>,
}

impl<T: Real> Check<'_, T> {
    fn rounding(&self) -> f64 {
        64.0 * T::epsilon().widen()
    }

    fn product(&self, a: &Array2<T>, b: &Array2<T>) -> f64 {
        mean_product(&self.grid, a.view(), b.view())
    }

    fn mean(&self, field: &Array2<T>) -> f64 {
        self.grid.mean(field.view(), T::widen)
    }

    fn centred(&self) -> Array2<T> {
        let mean = self.mean(&self.a);
        self.a.mapv(|x| x - T::lit(mean))
    }

    /// ⟨a, F b⟩ is ⟨F a, b⟩, of the function applied last.
    fn symmetric(&self, property: &'static str, allowed: f64) -> Result<()> {
        holds(property, self.product(&self.a, &self.of_b), self.product(&self.of_a, &self.b), allowed)
    }

    /// Both results are the same.
    fn same(&self, property: &'static str, allowed: f64) -> Result<()> {
        holds(property, largest(&(&self.of_b - &self.of_a)), 0.0, allowed)
    }

    fn stiffness(&mut self) -> Result<()> {
        let stiff = self.rounding() * self.operator.stiffness_range().1;
        self.operator.pressure(self.a.view(), self.of_a.view_mut())?;
        let work = self.operator.pressure_and_work(self.b.view(), self.of_b.view_mut())?;
        holds("mean of a pressure", self.mean(&self.of_a), 0.0, stiff)?;
        self.symmetric("symmetry of the stiffness, ⟨a, K⁻¹b⟩", stiff)?;
        holds("work of pressure_and_work", work, self.product(&self.b, &self.of_b), stiff)?;
        let lifted = self.a.mapv(|x| x + T::one());
        self.operator.pressure(lifted.view(), self.of_b.view_mut())?;
        self.same("pressure of a rigid translation", 4.0 * stiff)
    }

    /// Of the pressure of a.
    fn compliance(&mut self) -> Result<()> {
        let (softest, stiffest) = self.operator.stiffness_range();
        self.operator.displacement(self.of_a.view(), self.of_b.view_mut())?;
        let property = "displacement by a pressure, against the displacement that made the pressure";
        let difference = largest(&(&self.of_b - &self.centred()));
        holds(property, difference, 0.0, self.rounding() * (stiffest / softest))?;
        self.operator.displacement(self.a.view(), self.of_a.view_mut())?;
        self.operator.displacement(self.b.view(), self.of_b.view_mut())?;
        let soft = self.rounding() / softest;
        holds("mean of a displacement", self.mean(&self.of_a), 0.0, soft)?;
        self.symmetric("symmetry of the compliance, ⟨a, K b⟩", soft)
    }

    /// Of the displacement of a.
    fn preconditioner(&mut self) -> Result<()> {
        let (softest, _) = self.operator.stiffness_range();
        let (soft, compliant) = (self.rounding() / softest, self.product(&self.a, &self.of_a));
        let foundation = || Foundation::uniform(2.0 * softest, 3.0 * softest);
        let found = self.operator.precondition(self.a.view(), foundation(), self.of_a.view_mut())?;
        holds("error of precondition, ⟨a, K a⟩", found.error, compliant, soft)?;
        holds("descent of precondition, ⟨a, M a⟩", found.descent, self.product(&self.a, &self.of_a), soft)?;
        holds("mean of precondition", found.mean, self.mean(&self.of_a), soft)?;
        self.operator.precondition(self.b.view(), foundation(), self.of_b.view_mut())?;
        self.symmetric("symmetry of precondition, ⟨a, M b⟩", soft)?;
        if found.descent > 0.0 { Ok(()) } else { Err(broken("descent of precondition", found.descent, 0.0)) }
    }

    /// What a spectral operator has besides; returns its coarse space.
    fn spectral(&mut self) -> Result<Option<CoarseSpace>> {
        let stiffest = self.operator.stiffness_range().1;
        let stiff = self.rounding() * stiffest;
        self.operator.pressure(self.a.view(), self.of_a.view_mut())?;
        let pressed = self.product(&self.a, &self.of_a);
        let mut space = None;
        if let Some(spectral) = self.operator.spectral() {
            let work = spectral.surface_pressure(self.a.mapv(T::widen).view(), self.of_b.view_mut())?;
            holds("work of surface_pressure", work, pressed, stiff)?;
            let difference = largest(&(&self.of_b - &self.of_a));
            holds("pressure of surface_pressure", difference, 0.0, 4.0 * stiff)?;
            if let Some(mut single) = spectral.in_single() {
                let (rounded, mut found) = (self.a.mapv(|x| T::widen(x) as f32), Array2::zeros(self.grid.shape()));
                single.pressure(rounded.view(), found.view_mut())?;
                let difference = largest(&(found.mapv(|p: f32| T::lit(f64::from(p))) - &self.of_a));
                let single = 64.0 * f64::from(f32::EPSILON) * stiffest;
                holds("pressure in single precision", difference, 0.0, single)?;
            }
            space = spectral.coarse_space(ENOUGH);
            spectral.release_memory();
        }
        self.operator.pressure(self.a.view(), self.of_b.view_mut())?;
        self.same("pressure after memory was given back", 0.0)?;
        Ok(space)
    }

    fn coarse_space(&mut self, space: Option<CoarseSpace>) -> Result<()> {
        let Some(mut space) = space else { return Ok(()) };
        let [_, (rows, columns)] = space.blocks();
        let blocks = (rows * columns) as f64;
        let shares: Vec<f64> = (0..rows * columns).map(|block| (block % 2) as f64 / blocks).collect();
        let stiffness = 2.0 * self.operator.stiffness_range().0;
        let mean_stiffness = 0.1 * stiffness;
        if !space.renew(&shares, stiffness, mean_stiffness, false) {
            return Ok(());
        }
        let mut precondition = |residual: &Array2<T>, preconditioned: &mut Array2<T>| {
            let foundation = Foundation { stiffness, mean_stiffness, coarse: Some(&mut space) };
            self.operator.precondition(residual.view(), foundation, preconditioned.view_mut())
        };
        let found = precondition(&self.a, &mut self.of_a)?;
        precondition(&self.b, &mut self.of_b)?;
        let soft = self.rounding() * (largest(&self.of_a) + largest(&self.of_b));
        let descent = self.product(&self.a, &self.of_a);
        holds("descent of precondition with a coarse space", found.descent, descent, soft)?;
        self.symmetric("symmetry of precondition with a coarse space", soft)
    }

    fn range(&mut self) -> Result<()> {
        let (softest, stiffest) = self.operator.stiffness_range();
        for (property, bound, inverse) in
            [("softest stiffness", softest, true), ("stiffest stiffness", stiffest, false)]
        {
            let (mut x, mut quotient) = (self.centred(), bound);
            for _ in 0..ENOUGH {
                let size = self.product(&x, &x).sqrt();
                x.mapv_inplace(|x| x / T::lit(size));
                self.operator.pressure(x.view(), self.of_a.view_mut())?;
                quotient = self.product(&x, &self.of_a);
                if inverse {
                    self.operator.displacement(x.view(), self.of_a.view_mut())?;
                }
                x.assign(&self.of_a);
            }
            let least = bound * (1.0 - self.rounding());
            let beyond = if inverse { quotient < least } else { quotient > bound * (1.0 + 1e-3) };
            if beyond {
                return Err(broken(property, bound, quotient));
            }
        }
        Ok(())
    }
}

fn holds(property: &'static str, found: f64, expected: f64, allowed: f64) -> Result<()> {
    if (found - expected).abs() <= allowed { Ok(()) } else { Err(broken(property, found, expected)) }
}

fn broken(function: &'static str, value: f64, expected: f64) -> Error {
    Error::Contract { function, value, place: Place::Grid, breach: Breach::Operator(expected) }
}

fn largest<T: Real>(field: &Array2<T>) -> f64 {
    field.iter().fold(0.0, |largest, x| largest.max(x.widen().abs()))
}

/// Numbers between −1 and 1, the same for a seed.
fn random<T: Real>(shape: (usize, usize), seed: u64) -> Array2<T> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    Array2::from_shape_fn(shape, |_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        T::lit((state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    })
}
