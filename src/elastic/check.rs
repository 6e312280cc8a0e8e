//! A check of an elastic operator, for users' tests.

use ndarray::Array2;

use super::{Boundary, ElasticOperator, Foundation, mean_product};
use crate::error::{Breach, Error, Place, Result};
use crate::real::Real;

/// Applications of the compliance, and of the stiffness, that look for the softest and for the stiffest wave.
const POWERS: usize = 20;

const DIMENSION: usize = 20;

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
    let field = || Array2::<T>::zeros(shape);
    let ([a, b], mut of_a, mut of_b) = ([1, 2].map(|seed| random::<T>(shape, seed)), field(), field());
    let (softest, stiffest) = operator.stiffness_range();
    if a.len() < 2 {
        return Ok(());
    }
    let rounding = 64.0 * T::epsilon().widen();
    let product = |a: &Array2<T>, b: &Array2<T>| mean_product(&grid, a.view(), b.view());
    let mean = |field: &Array2<T>| grid.mean(field.view(), T::widen);
    let holds = |property, found: f64, expected: f64, allowed: f64| match (found - expected).abs() <= allowed {
        true => Ok(()),
        false => Err(broken(property, found, expected)),
    };

    operator.pressure(a.view(), of_a.view_mut())?;
    let work = operator.pressure_and_work(b.view(), of_b.view_mut())?;
    let stiff = rounding * stiffest;
    holds("mean of a pressure", mean(&of_a), 0.0, stiff)?;
    holds("symmetry of the stiffness, ⟨a, K⁻¹b⟩", product(&a, &of_b), product(&of_a, &b), stiff)?;
    holds("work of pressure_and_work", work, product(&b, &of_b), stiff)?;
    let lifted = a.mapv(|x| x + T::one());
    operator.pressure(lifted.view(), of_b.view_mut())?;
    let difference = largest(&(&of_b - &of_a));
    holds("pressure of a rigid translation", difference, 0.0, 4.0 * stiff)?;

    let condition = stiffest / softest;
    operator.displacement(of_a.view(), of_b.view_mut())?;
    let centred = a.mapv(|x| x - T::lit(mean(&a)));
    holds(
        "displacement by a pressure, against the displacement that made the pressure",
        largest(&(&of_b - &centred)),
        0.0,
        rounding * condition,
    )?;
    operator.displacement(a.view(), of_a.view_mut())?;
    operator.displacement(b.view(), of_b.view_mut())?;
    let soft = rounding / softest;
    holds("mean of a displacement", mean(&of_a), 0.0, soft)?;
    holds("symmetry of the compliance, ⟨a, K b⟩", product(&a, &of_b), product(&of_a, &b), soft)?;
    let compliant = product(&a, &of_a);

    let (foundation, mean_stiffness) = (2.0 * softest, 3.0 * softest);
    let found = operator.precondition(a.view(), Foundation::uniform(foundation, mean_stiffness), of_a.view_mut())?;
    holds("error of precondition, ⟨a, K a⟩", found.error, compliant, soft)?;
    holds("descent of precondition, ⟨a, M a⟩", found.descent, product(&a, &of_a), soft)?;
    holds("mean of precondition", found.mean, mean(&of_a), soft)?;
    operator.precondition(b.view(), Foundation::uniform(foundation, mean_stiffness), of_b.view_mut())?;
    holds("symmetry of precondition, ⟨a, M b⟩", product(&a, &of_b), product(&of_a, &b), soft)?;
    if found.descent <= 0.0 {
        return Err(broken("descent of precondition", found.descent, 0.0));
    }

    operator.pressure(a.view(), of_a.view_mut())?;
    if let Boundary::Free { window, mean_compliance } = operator.boundary() {
        holds("spacing of the window over the spacing of the grid", window.spacing().0 / grid.spacing().0, 1.0, 1e-12)?;
        holds("sign of the mean compliance", mean_compliance.signum(), 1.0, 0.0)?;
    }
    let mut space = None;
    if let Some(spectral) = operator.spectral() {
        let heights = a.mapv(T::widen);
        let work = spectral.surface_pressure(heights.view(), of_b.view_mut())?;
        holds("work of surface_pressure", work, product(&a, &of_a), stiff)?;
        holds("pressure of surface_pressure", largest(&(&of_b - &of_a)), 0.0, 4.0 * stiff)?;
        if let Some(mut single) = spectral.in_single() {
            let (rounded, mut found) = (a.mapv(|x| T::widen(x) as f32), Array2::zeros(shape));
            single.pressure(rounded.view(), found.view_mut())?;
            let difference = largest(&(found.mapv(|p: f32| T::lit(f64::from(p))) - &of_a));
            holds("pressure in single precision", difference, 0.0, 64.0 * f64::from(f32::EPSILON) * stiffest)?;
        }
        space = spectral.coarse_space(DIMENSION);
        spectral.release_memory();
    }
    operator.pressure(a.view(), of_b.view_mut())?;
    holds("pressure after memory was given back", largest(&(&of_b - &of_a)), 0.0, 0.0)?;
    if let Some(mut space) = space {
        let [_, (rows, columns)] = space.blocks();
        let blocks = (rows * columns) as f64;
        let shares: Vec<f64> = (0..rows * columns).map(|block| (block % 2) as f64 / blocks).collect();
        let mean_stiffness = 0.1 * foundation;
        if space.renew(&shares, foundation, mean_stiffness, false) {
            let mut precondition = |residual: &Array2<T>, preconditioned: &mut Array2<T>| {
                let foundation = Foundation { stiffness: foundation, mean_stiffness, coarse: Some(&mut space) };
                operator.precondition(residual.view(), foundation, preconditioned.view_mut())
            };
            let found = precondition(&a, &mut of_a)?;
            precondition(&b, &mut of_b)?;
            let soft = rounding * (largest(&of_a) + largest(&of_b));
            holds("descent of precondition with a coarse space", found.descent, product(&a, &of_a), soft)?;
            holds("symmetry of precondition with a coarse space", product(&a, &of_b), product(&of_a, &b), soft)?;
        }
    }

    for (property, bound, inverse) in [("softest stiffness", softest, true), ("stiffest stiffness", stiffest, false)] {
        let mut x = centred.clone();
        let mut quotient = bound;
        for _ in 0..POWERS {
            let size = product(&x, &x).sqrt();
            x.mapv_inplace(|x| x / T::lit(size));
            operator.pressure(x.view(), of_a.view_mut())?;
            quotient = product(&x, &of_a);
            if inverse {
                operator.displacement(x.view(), of_a.view_mut())?;
            }
            x.assign(&of_a);
        }
        let beyond = if inverse { quotient < bound * (1.0 - rounding) } else { quotient > bound * (1.0 + 1e-3) };
        if beyond {
            return Err(broken(property, bound, quotient));
        }
    }
    Ok(())
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
