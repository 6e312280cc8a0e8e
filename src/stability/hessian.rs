//! The Hessian of the energy, K⁻¹ + φ'', on the admissible changes of the gap.

use crate::elastic::{ElasticOperator, Foundation};
use crate::error::Result;
use crate::field::{Field, Minimum, Reducer, read, write};
use crate::grid::Grid;
use crate::par::Parts;
use crate::problem::Load;
use crate::real::Real;
use crate::solver::Coarse;

/// K⁻¹ + φ'' on fields that vanish on the contact, and have no mean if the mean gap is given.
pub(super) struct Hessian<'a, T> {
    operator: &'a mut dyn ElasticOperator<T>,
    /// φ'', infinite on the contact
    slopes: Field<T>,
    centred: bool,
    /// the stiffness that a spring adds to the mean, zero without one
    spring: f64,
    free: f64,
    least: f64,
    pub(super) reducer: Reducer,
    /// the longest waves in the preconditioner, if it knows where the contacts are
    coarse: Option<Coarse>,
    applications: usize,
}

impl<'a, T: Real> Hessian<'a, T> {
    pub(super) fn new(operator: &'a mut dyn ElasticOperator<T>, slopes: Field<T>, load: Load) -> Self {
        let (centred, spring) = (matches!(load, Load::Gap(_)), load.stiffness());
        let mut reducer = operator.grid().reducer();
        let free = reducer.run(read(&slopes), |_, slopes| slopes.iter().filter(|s| s.is_finite()).count() as f64);
        let least = |slopes: &[T]| slopes.iter().fold(f64::INFINITY, |least, slope| least.min(slope.widen()));
        let Minimum(least) = reducer.run(read(&slopes), |_, slopes| Minimum(least(slopes)));
        Self { operator, slopes, centred, spring, free, least, reducer, coarse: None, applications: 0 }
    }

    pub(super) fn shape(&self) -> (usize, usize) {
        self.slopes.dim()
    }

    pub(super) fn nodes(&self) -> f64 {
        self.operator.grid().nodes() as f64
    }

    pub(super) fn applications(&self) -> usize {
        self.applications
    }

    pub(super) fn dimension(&self) -> usize {
        let free = self.free as usize;
        if self.centred { free.saturating_sub(1) } else { free }
    }

    pub(super) fn free(&self) -> f64 {
        self.free
    }

    /// Tells the preconditioner where the contacts are, and the `stiffness` against pressing the surface flat.
    pub(super) fn hold(&mut self, stiffness: f64) {
        let range = self.operator.stiffness_range();
        let Some(mut coarse) = Coarse::of(self.operator) else { return };
        let touches = |_, slope: T| slope.is_infinite();
        coarse.renew(0, &self.slopes, touches, (stiffness, self.spring), range, self.centred);
        self.coarse = Some(coarse);
    }

    pub(super) fn least_slope(&self) -> f64 {
        if self.least.is_finite() { self.least } else { 0.0 }
    }

    /// The stiffness of the softest wave; E*/Lx on a grid of one node.
    pub(super) fn softest(&self) -> f64 {
        match self.operator.stiffness_range().0 {
            softest if softest > 0.0 => softest,
            _ => self.operator.modulus() / self.operator.grid().lengths().0,
        }
    }

    pub(super) fn stiffest(&self) -> f64 {
        self.operator.stiffness_range().1.max(self.softest()).max(self.spring)
    }

    /// A lower bound of the eigenvalues: the sum of the least eigenvalues of K⁻¹ and φ''.
    pub(super) fn simple_bound(&self) -> f64 {
        // a uniform change costs no elastic energy, but energy of a spring
        let softest = self.operator.stiffness_range().0;
        let elastic = if self.centred { softest } else { softest.min(self.spring) };
        elastic + self.least_slope()
    }

    /// Makes a field vanish on the contact and have the mean 1; it becomes uniform if it has no positive mean.
    pub(super) fn admit(&mut self, field: &mut Field<T>) {
        let nodes = self.nodes();
        let Self { reducer, slopes, free, .. } = self;
        let sum = reducer.run(read(slopes).zip(write(field)), |_, (slopes, values)| {
            let mut sum = 0.0;
            for (slope, value) in slopes.iter().zip(values) {
                *value = if slope.is_finite() { *value } else { T::zero() };
                sum += value.widen();
            }
            sum
        });
        let uniform = T::lit(nodes / *free);
        let factor = if sum > 0.0 { T::lit(nodes / sum) } else { T::zero() };
        let usable = factor > T::zero() && factor.is_finite();
        reducer.run(read(slopes).zip(write(field)), |_, (slopes, values)| {
            for (slope, value) in slopes.iter().zip(values) {
                *value = match usable {
                    true => factor * *value,
                    false if slope.is_finite() => uniform,
                    false => T::zero(),
                };
            }
        });
    }

    /// Makes a field admissible; returns the mean that was taken out.
    pub(super) fn project(&mut self, field: &mut Field<T>) -> f64 {
        let Self { reducer, slopes, centred, free, .. } = self;
        let mut mean = T::zero();
        if *centred && *free > 0.0 {
            let sum = reducer.run(read(slopes).zip(read(field)), |_, (slopes, values)| {
                let free = slopes.iter().zip(values).filter(|(slope, _)| slope.is_finite());
                free.map(|(_, value)| value.widen()).sum::<f64>()
            });
            mean = T::lit(sum / *free);
        }
        reducer.run(read(slopes).zip(write(field)), |_, (slopes, values)| {
            for (slope, value) in slopes.iter().zip(values) {
                *value = if slope.is_finite() { *value - mean } else { T::zero() };
            }
        });
        mean.widen()
    }

    /// The image of an admissible field, made admissible; returns the mean taken out. Takes one operator application.
    pub(super) fn apply(&mut self, field: &Field<T>, image: &mut Field<T>) -> Result<f64> {
        self.operator.pressure(field.view(), image.view_mut())?;
        self.applications += 1;
        let mean = if self.spring > 0.0 { self.operator.grid().mean(field.view(), T::widen) } else { 0.0 };
        let uniform = T::lit(self.spring * mean);
        let Self { reducer, slopes, .. } = self;
        reducer.run(read(slopes).zip(read(field)).zip(write(image)), |_, ((slopes, field), image)| {
            for ((&slope, &value), image) in slopes.iter().zip(field).zip(image) {
                if slope.is_finite() {
                    *image += slope * value + uniform;
                }
            }
        });
        Ok(self.project(image))
    }

    /// The force that holds a field at zero on the contact, a level less K⁻¹ of the field. One operator application.
    pub(super) fn reaction(&mut self, field: &Field<T>, level: f64, reaction: &mut Field<T>) -> Result<()> {
        self.operator.pressure(field.view(), reaction.view_mut())?;
        self.applications += 1;
        let level = T::lit(level);
        self.reducer.run(read(&self.slopes).zip(write(reaction)), |_, (slopes, values)| {
            for (slope, value) in slopes.iter().zip(values) {
                *value = if slope.is_finite() { T::zero() } else { level - *value };
            }
        });
        Ok(())
    }

    /// Preconditions an admissible field r by the compliance; returns the mean of r·Kr. One operator application.
    pub(super) fn precondition(&mut self, residual: &Field<T>, result: &mut Field<T>) -> Result<f64> {
        let softest = self.softest();
        let coarse = self.coarse.as_mut().and_then(Coarse::ready);
        let foundation = Foundation { coarse, ..Foundation::uniform(softest, softest + self.spring) };
        let found = self.operator.precondition(residual.view(), foundation, result.view_mut())?;
        self.applications += 1;
        self.project(result);
        Ok(found.error)
    }

    pub(super) fn product(&mut self, a: &Field<T>, b: &Field<T>) -> f64 {
        let sum = self
            .reducer
            .run(read(a).zip(read(b)), |_, (a, b)| a.iter().zip(b).map(|(a, b)| a.widen() * b.widen()).sum::<f64>());
        sum / self.nodes()
    }

    pub(super) fn scale(&mut self, field: &mut Field<T>, factor: f64) {
        let factor = T::lit(factor);
        self.reducer.run(write(field), |_, values| {
            values.iter_mut().for_each(|value| *value *= factor);
        });
    }

    /// a ← factor·a + other·b
    pub(super) fn combine(&mut self, factor: f64, a: &mut Field<T>, other: f64, b: &Field<T>) {
        let (factor, other) = (T::lit(factor), T::lit(other));
        self.reducer.run(write(a).zip(read(b)), |_, (a, b)| {
            a.iter_mut().zip(b).for_each(|(a, &b)| *a = factor * *a + other * b);
        });
    }

    /// Multiplies a field by the curvature of the adhesive energy, where modes are soft.
    pub(super) fn weigh(&mut self, field: &mut Field<T>) {
        let least = self.least_slope();
        if least < 0.0 {
            let least = T::lit(least);
            let Self { reducer, slopes, .. } = self;
            reducer.run(read(slopes).zip(write(field)), |_, (slopes, values)| {
                for (&slope, value) in slopes.iter().zip(values) {
                    if slope.is_finite() {
                        *value *= (slope / least).max(T::lit(0.1));
                    }
                }
            });
            self.project(field);
        }
    }

    /// An admissible field of independent normal numbers, the same for every `stream`.
    pub(super) fn random(&mut self, stream: u32) -> Field<T> {
        let mut field = normal_numbers(self.operator.grid(), stream);
        self.project(&mut field);
        field
    }

    /// Normal numbers smoothed by the compliance, not admissible, the same for every φ'' and contact. One application.
    pub(super) fn smooth_random(&mut self, stream: u32) -> Result<Field<T>> {
        let random = normal_numbers::<T>(self.operator.grid(), stream);
        let (softest, mut smooth) = (self.softest(), Field::zeros(random.dim()));
        self.operator.precondition(random.view(), Foundation::uniform(softest, softest), smooth.view_mut())?;
        self.applications += 1;
        Ok(smooth)
    }
}

fn normal_numbers<T: Real>(grid: &Grid, stream: u32) -> Field<T> {
    let (first, ny) = (grid.first_node(), grid.shape().1);
    Field::from_fn(grid.field_shape(), |(i, j)| {
        let node = (first + i * ny + j) as u64;
        let [a, b] = crate::surface::uniform([node as u32, (node >> 32) as u32, stream, 0], [0x5EED, 0]);
        T::lit((-2.0 * (1.0 - a).ln()).sqrt() * (std::f64::consts::TAU * b).cos())
    })
}
