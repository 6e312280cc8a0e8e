//! Algorithm 3 of Rey, Anciaux and Molinari (2017), with its misprints corrected.

use super::driver::{End, Observer};
use super::passes::Fields;
use super::state::State;
use crate::error::{Error, Result};
use crate::field::{read, write};
use crate::names::names;
use crate::par::Parts;
use crate::problem::Load;
use crate::real::{Real, cast};

/// The iterations between two certificates, which the algorithm needs for the report only.
const CERTIFY: usize = 10;

/// Iterations without progress until the direction is dropped, and until the solve has stalled: energy and residual
/// need not fall.
const PATIENCE: (usize, usize) = (400, 800);

/// The criterion of convergence: the measure that has to fall below the tolerance.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Criterion {
    /// The certified relative error in the energy norm, [`Report::relative_error`](crate::Report::relative_error).
    #[default]
    EnergyNorm,
    /// The criterion ε = Σ|g r'| of the paper, in units of E*·√(Lx·Ly): no bound of an error; its rounding floor grows
    /// with the number of nodes.
    Complementarity,
}

names!(Criterion { EnergyNorm = "energy-norm", Complementarity = "complementarity" });

/// The refusal of what the algorithm does not know.
pub(super) fn refused(reason: &'static str) -> Error {
    Error::Unsuited { what: "Algorithm 3 of Rey, Anciaux and Molinari (2017)", reason }
}

/// Minimises the energy that is posed. The criterion ε of the paper measures the progress.
pub(super) fn descend<T: Real, Lo: Real>(state: &mut State<'_, T, Lo>, observe: Observer<'_>) -> Result<End> {
    state.steps.coarse = None;
    state.residual();
    loop {
        state.sums.certificate = f64::INFINITY;
        let certifies = state.posed.settings.criterion == Criterion::EnergyNorm;
        if certifies && state.counters.iterations.is_multiple_of(CERTIFY) {
            state.certify()?;
        }
        if let Some(end) = state.check_end(observe)? {
            return Ok(end);
        }
        state.note_error(state.scaled_complementarity());
        if state.counters.progress.idle == PATIENCE.0 {
            state.steps.norm = None;
        }
        if let Some(end) = state.verdict(PATIENCE.1) {
            return Ok(end);
        }
        if state.is_adrift() {
            return Ok(End::Adrift);
        }
        if !state.step_of_paper()? {
            return Ok(End::Stalled);
        }
    }
}

impl<T: Real, Lo: Real> State<'_, T, Lo> {
    /// The measure that has to fall below the tolerance.
    pub(super) fn measure(&self) -> f64 {
        match self.posed.settings.criterion {
            Criterion::EnergyNorm => self.relative_error(),
            Criterion::Complementarity if self.sums.residual.working > self.sums.tally.free => f64::INFINITY,
            Criterion::Complementarity => self.scaled_complementarity(),
        }
    }

    pub(super) fn scaled_complementarity(&self) -> f64 {
        let (lx, ly) = self.posed.operators.state().grid().lengths();
        self.sums.residual.complementarity / (self.posed.operators.state().modulus() * (lx * ly).sqrt())
    }

    /// One pass of the loop: an operator application for the direction, another after clipping or release. `false` if
    /// no step is possible.
    fn step_of_paper(&mut self) -> Result<bool> {
        let projects = self.posed.projects();
        let apart = move |gap: T| !projects || gap > T::zero();

        let Fields { reducer, gap, residual, .. } = &mut self.fields;
        let norm = reducer.run(read(gap).zip(read(residual)), |_, (gap, residual)| {
            let squares = gap.iter().zip(residual).map(|(&gap, &r)| if apart(gap) { r.widen().powi(2) } else { 0.0 });
            squares.sum::<f64>()
        });
        let conjugate = self.steps.norm.map_or(0.0, |before| norm / before);
        let mut slope = self.conjugate_direction(if conjugate.is_finite() { conjugate } else { 0.0 });
        if !(slope.is_finite() && slope > 0.0) && conjugate > 0.0 {
            // uphill, or beyond all numbers: the norm of the residual has jumped, as rounding may let it
            slope = self.conjugate_direction(0.0);
        }
        let Some(length) = self.length_of_paper(slope)? else { return Ok(false) };
        let length = T::lit(length);
        let [sum, released, clipped] = self.advance_by(length);
        let scale = match self.posed.load {
            Load::Gap(mean) if self.posed.projects() => mean * self.posed.nodes() / sum,
            _ => 1.0,
        };
        if !scale.is_finite() {
            // every node was clipped: only the mean gap remains to be kept
            if let Load::Gap(mean) = self.posed.load {
                self.fields.gap.nodes_mut().fill(T::lit(mean));
                self.refresh()?;
                self.sums.certificate = f64::INFINITY;
            }
            return Ok(false);
        }
        self.steps.norm = (released == 0.0).then_some(norm);
        let linear = released == 0.0 && clipped == 0.0;
        self.scale(T::lit(scale), length, linear);
        if !linear {
            self.refresh()?;
        }
        self.counters.iterations += 1;
        if self.is_stale() {
            self.refresh()?;
        }
        self.residual();
        Ok(true)
    }

    /// The length of a step along the direction, which goes uphill by `slope`; none without bounds.
    fn length_of_paper(&mut self, slope: f64) -> Result<Option<f64>> {
        let projects = self.posed.projects();
        let apart = move |gap: T| !projects || gap > T::zero();
        let Fields { change, preconditioned: response, .. } = &mut self.fields;
        self.posed.operators.corrections().pressure(change.view(), response.view_mut())?;
        self.counters.applications += 1;
        let Fields { reducer, gap, change, preconditioned: response, .. } = &mut self.fields;
        let pass = read(gap).zip(read(change)).zip(read(response));
        let [curvature, response, t] = reducer.run(pass, |_, ((gap, direction), response)| {
            let [mut curvature, mut responses, mut sum] = [0.0; 3];
            for ((&gap, &t), &response) in gap.iter().zip(direction).zip(response) {
                if apart(gap) {
                    let [t, response] = [t, response].map(Lo::widen);
                    curvature += response * t;
                    responses += response;
                    sum += t;
                }
            }
            [curvature, responses, sum]
        });
        let mean = if self.posed.is_gap_controlled() { response / self.sums.tally.free } else { 0.0 };
        let length = slope / (curvature - mean * t);
        // a uniform direction has no curvature: the softest wave bounds the step
        let softest = self.posed.operators.state().stiffness_range().0;
        let length = if length.is_finite() && length > 0.0 { length } else { 1.0 / softest };
        // nor has one that is uniform up to rounding
        let length = length.min(1.0 / (T::epsilon().widen().sqrt() * softest));
        Ok(length.is_finite().then_some(length))
    }

    /// Takes a step of a length; returns Σ g, and the numbers of nodes that were released and clipped.
    fn advance_by(&mut self, length: T) -> [f64; 3] {
        let projects = self.posed.projects();
        let Fields { reducer, gap, residual, change, .. } = &mut self.fields;
        let pass = write(gap).zip(read(residual)).zip(read(change));
        reducer.run(pass, |_, ((gap, residual), direction)| {
            let [mut sum, mut released, mut clipped] = [0.0; 3];
            for ((gap, &r), &t) in gap.iter_mut().zip(residual).zip(direction) {
                let next = *gap - length * cast(t);
                clipped += f64::from(u8::from(projects && next < T::zero()));
                *gap = if projects { next.max(T::zero()) } else { next };
                if projects && *gap <= T::zero() && r < Lo::zero() {
                    *gap = -length * cast(r);
                    released += 1.0;
                }
                sum += gap.widen();
            }
            [sum, released, clipped]
        })
    }

    /// The direction t = r' + `conjugate` t where the surfaces are apart; returns ⟨r', t⟩.
    fn conjugate_direction(&mut self, conjugate: f64) -> f64 {
        let projects = self.posed.projects();
        let conjugate = Lo::lit(conjugate);
        let Fields { reducer, gap, residual, change, .. } = &mut self.fields;
        reducer.run(read(gap).zip(read(residual)).zip(write(change)), |_, ((gap, residual), direction)| {
            let mut slope = 0.0;
            for ((&gap, &r), t) in gap.iter().zip(residual).zip(direction) {
                *t = if !projects || gap > T::zero() {
                    r + if conjugate > Lo::zero() { conjugate * *t } else { Lo::zero() }
                } else {
                    Lo::zero()
                };
                slope += r.widen() * t.widen();
            }
            slope
        })
    }

    /// Scales the gap to its mean and, if the step was `linear`, the pressure with it: K⁻¹(s(g − τt) + h).
    fn scale(&mut self, scale: T, length: T, linear: bool) {
        let Fields { reducer, gap, pressure, preconditioned: response, .. } = &mut self.fields;
        let fields = write(gap).zip(write(pressure)).zip(read(response)).zip(read(&self.posed.flat.pressure));
        reducer.run(fields, |_, (((gap, pressure), response), surface)| {
            gap.iter_mut().for_each(|gap| *gap *= scale);
            if linear {
                for ((p, &response), &surface) in pressure.iter_mut().zip(response).zip(surface) {
                    *p = scale * (*p - surface - length * cast(response)) + surface;
                }
            }
        });
        if linear {
            self.steps.age += 1;
            self.sums.work = self.count();
        }
    }
}
