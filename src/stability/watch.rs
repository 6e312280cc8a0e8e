//! The softest mode along a path of equilibria.

use ndarray::Array2;

use super::eigenpair::{Eigenpair, lowest_from, normalise};
use super::hessian::Hessian;
use super::{MOST, Near, slopes};
use crate::adhesion::AdhesionLaw;
use crate::constraint::ContactConstraint;
use crate::degrees::{LITTLE, ROUGHLY};
use crate::elastic::ElasticOperator;
use crate::error::Result;
use crate::field::Field;
use crate::grid::Grid;
use crate::problem::{Load, PressedFlat};
use crate::real::Real;
use crate::solver::{Least, Potential, bounded};

/// The share of a random field added to the last mode: an antisymmetric mode has no share in a symmetric start.
const FRESH: f64 = 0.03;

/// The watch for saddles at given mean gaps; each search starts from the last mode.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Watch<T> {
    /// the mode that was last found, of mean square 1
    pub(crate) mode: Option<Array2<T>>,
    #[cfg_attr(feature = "serde", serde(skip, default = "Option::default"))]
    random: Option<Field<T>>,
}

impl<T> Default for Watch<T> {
    fn default() -> Self {
        Self { mode: None, random: None }
    }
}

/// A saddle, and its unstable mode in [`Watch::mode`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Saddle {
    /// the Rayleigh quotient of the mode, negative
    pub(crate) eigenvalue: f64,
}

impl<T: Real> Watch<T> {
    /// Refuses a mode of another grid.
    pub(crate) fn check(&self, grid: &Grid) -> Result<()> {
        self.mode.iter().try_for_each(|mode| grid.fits("mode of the path", mode.dim()))
    }

    /// Whether an equilibrium is a saddle at its mean gap, or under the spring that loads it. Costs nothing if the
    /// softest stiffness and the least φ'' rule it out, and five or seven operator applications as a rule.
    pub(crate) fn look(
        &mut self,
        operator: &mut dyn ElasticOperator<T>,
        (law, constraint): (&dyn AdhesionLaw<T>, &dyn ContactConstraint<T>),
        (gap, near, flat): (&Array2<T>, Near<'_>, &PressedFlat<T>),
        load: Load,
    ) -> Result<Option<Saddle>> {
        if Potential::new(law, constraint, None).is_zero() {
            return Ok(None);
        }
        let slopes = slopes(gap, (law, constraint), near, (&*operator, flat))?;
        let mut hessian = Hessian::new(operator, slopes, load);
        if hessian.simple_bound() > 0.0 || hessian.dimension() == 0 {
            return Ok(None);
        }
        let mut start = match &self.random {
            Some(random) => random.clone(),
            None => self.random.insert(hessian.smooth_random(2)?).clone(),
        };
        hessian.project(&mut start);
        hessian.weigh(&mut start);
        if let Some(mode) = self.mode.take() {
            let mut mode = flat.extend(mode);
            hessian.project(&mut mode);
            normalise(&mut hessian, &mut mode);
            normalise(&mut hessian, &mut start);
            hessian.combine(FRESH, &mut start, 1.0, &mode);
        }
        let mut pair = lowest_from(&mut hessian, start, MOST, false, |hessian, found| {
            let scale = found.value.max(hessian.softest());
            found.value < -found.noise
                || found.iteration > 0 && found.residual * found.residual <= LITTLE * found.value * scale
        })?;
        let unstable = |pair: &Eigenpair<T>| pair.value < -pair.noise;
        if unstable(&pair) {
            pair = lowest_from(&mut hessian, pair.vector, MOST, true, |hessian, found| {
                found.residual <= ROUGHLY * found.value.abs().max(hessian.softest())
            })?;
        }
        let saddle = unstable(&pair).then_some(Saddle { eigenvalue: pair.value });
        self.mode = Some(flat.crop(pair.vector.into_array(), T::zero()).into_owned());
        Ok(saddle)
    }

    /// The cosine of the angle between the mode and a change of the gap.
    pub(crate) fn share(&self, change: &Array2<T>, grid: &Grid) -> f64 {
        let Some(mode) = &self.mode else { return 0.0 };
        let product =
            |a: &Array2<T>, b: &Array2<T>| grid.mean_of_both(a.view(), b.view(), |a, b| a.widen() * b.widen());
        let share = product(mode, change) / (product(mode, mode) * product(change, change)).sqrt();
        if share.is_finite() { share } else { 0.0 }
    }

    /// Adds the mode to the gap, with the largest change given: signed as its `share` in another change, or
    /// such that the gap closes at the first node where the mode is largest. Gaps stay above the `least`.
    pub(crate) fn displace(
        &self,
        (gap, grid): (&mut Array2<T>, &Grid),
        least: Least<T>,
        largest: f64,
        share: Option<f64>,
    ) {
        let Some(mode) = &self.mode else { return };
        let top = mode.iter().fold(T::zero(), |top, value| top.max(value.abs()));
        let top = T::lit(grid.greatest(top.widen()));
        let own =
            mode.iter().find(|value| value.abs() >= T::lit(1.0 - LITTLE) * top).map_or(f64::NAN, |value| value.widen());
        let first = grid.each(own).into_iter().find(|value| !value.is_nan());
        let sign = share.unwrap_or_else(|| -first.unwrap_or_default()).signum();
        let factor = T::lit(sign * largest) / top;
        if factor.is_finite() {
            gap.zip_mut_with(mode, |gap, &mode| *gap = bounded(least, *gap, *gap + factor * mode));
        }
    }
}
