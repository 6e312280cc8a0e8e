//! Algorithm 3 of Rey, Anciaux and Molinari (2017), with its misprints corrected.

use super::{Descent, End};
use crate::error::{Error, Result};
use crate::field::{read, write};
use crate::names::names;
use crate::par::Parts;
use crate::problem::Load;
use crate::real::{Real, cast};
use crate::solver::driver::Observer;
use crate::solver::passes::Fields;
use crate::solver::posed::Posed;

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
pub(in crate::solver) fn refused(reason: &'static str) -> Error {
    Error::Unsuited { what: "Algorithm 3 of Rey, Anciaux and Molinari (2017)", reason }
}

/// Minimises the energy that is posed. The criterion ε of the paper measures the progress.
pub(super) fn descend<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, observe: Observer<'_>) -> Result<End> {
    descent.coarse = None;
    descent.iterate.residual();
    loop {
        descent.certificate = f64::INFINITY;
        let certifies = descent.iterate.posed.settings.criterion == Criterion::EnergyNorm;
        if certifies && descent.iterations.is_multiple_of(CERTIFY) {
            descent.certify()?;
        }
        if let Some(end) = descent.check_end(observe)? {
            return Ok(end);
        }
        descent.note_error(descent.proof().scaled_complementarity());
        if descent.progress.idle() == PATIENCE.0 {
            descent.norm = None;
        }
        if let Some(end) = descent.verdict(PATIENCE.1) {
            return Ok(end);
        }
        if descent.proof().is_adrift() {
            return Ok(End::Adrift);
        }
        if !step(descent)? {
            return Ok(End::Stalled);
        }
    }
}

/// Whether a gap is one of nodes apart, which all nodes are if steps do not end where the surfaces touch.
fn apart<T: Real, Lo: Real>(posed: &Posed<'_, T, Lo>) -> impl Fn(T) -> bool + Copy + Sync + use<T, Lo> {
    let projects = posed.projects();
    move |gap| !projects || gap > T::zero()
}

/// One pass of the loop: an operator application for the direction, another after clipping or release. `false` if
/// no step is possible.
fn step<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>) -> Result<bool> {
    let apart = apart(&descent.iterate.posed);

    let Fields { reducer, gap, residual, .. } = &mut descent.iterate.fields;
    let norm = reducer.run(read(gap).zip(read(residual)), |_, (gap, residual)| {
        let squares = gap.iter().zip(residual).map(|(&gap, &r)| if apart(gap) { r.widen().powi(2) } else { 0.0 });
        squares.sum::<f64>()
    });
    let conjugate = descent.norm.map_or(0.0, |before| norm / before);
    let mut slope = turn(descent, if conjugate.is_finite() { conjugate } else { 0.0 });
    if !(slope.is_finite() && slope > 0.0) && conjugate > 0.0 {
        // uphill, or beyond all numbers: the norm of the residual has jumped, as rounding may let it
        slope = turn(descent, 0.0);
    }
    let Some(length) = length(descent, slope)? else { return Ok(false) };
    let length = T::lit(length);
    let [sum, released, clipped] = advance(descent, length);
    let scale = match descent.iterate.posed.load {
        Load::Gap(mean) if descent.iterate.posed.projects() => mean * descent.iterate.posed.nodes() / sum,
        _ => 1.0,
    };
    if !scale.is_finite() {
        // every node was clipped: only the mean gap remains to be kept
        if let Load::Gap(mean) = descent.iterate.posed.load {
            descent.iterate.fields.gap.nodes_mut().fill(T::lit(mean));
            descent.iterate.refresh()?;
            descent.certificate = f64::INFINITY;
        }
        return Ok(false);
    }
    descent.norm = (released == 0.0).then_some(norm);
    let linear = released == 0.0 && clipped == 0.0;
    rescale(descent, T::lit(scale), length, linear);
    if !linear {
        descent.iterate.refresh()?;
    }
    descent.iterations += 1;
    if descent.iterate.is_stale(descent.certificate) {
        descent.iterate.refresh()?;
    }
    descent.iterate.residual();
    Ok(true)
}

/// The length of a step along the direction, which goes uphill by `slope`; none without bounds.
fn length<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, slope: f64) -> Result<Option<f64>> {
    let apart = apart(&descent.iterate.posed);
    let Fields { change, preconditioned: response, .. } = &mut descent.iterate.fields;
    descent.iterate.posed.operators.corrections().pressure(change.view(), response.view_mut())?;
    descent.iterate.applied();
    let Fields { reducer, gap, change, preconditioned: response, .. } = &mut descent.iterate.fields;
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
    let mean = if descent.iterate.posed.is_gap_controlled() { response / descent.iterate.tally().free } else { 0.0 };
    let length = slope / (curvature - mean * t);
    // a uniform direction has no curvature: the softest wave bounds the step
    let softest = descent.iterate.posed.operators.state().stiffness_range().0;
    let length = if length.is_finite() && length > 0.0 { length } else { 1.0 / softest };
    // nor has one that is uniform up to rounding
    let length = length.min(1.0 / (T::epsilon().widen().sqrt() * softest));
    Ok(length.is_finite().then_some(length))
}

/// Takes a step of a length; returns Σ g, and the numbers of nodes that were released and clipped.
fn advance<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, length: T) -> [f64; 3] {
    let projects = descent.iterate.posed.projects();
    let Fields { reducer, gap, residual, change, .. } = &mut descent.iterate.fields;
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
fn turn<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, conjugate: f64) -> f64 {
    let (apart, conjugate) = (apart(&descent.iterate.posed), Lo::lit(conjugate));
    let Fields { reducer, gap, residual, change, .. } = &mut descent.iterate.fields;
    reducer.run(read(gap).zip(read(residual)).zip(write(change)), |_, ((gap, residual), direction)| {
        let mut slope = 0.0;
        for ((&gap, &r), t) in gap.iter().zip(residual).zip(direction) {
            *t = if apart(gap) {
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
fn rescale<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, scale: T, length: T, linear: bool) {
    let Fields { reducer, gap, pressure, preconditioned: response, .. } = &mut descent.iterate.fields;
    let fields = write(gap).zip(write(pressure)).zip(read(response)).zip(read(&descent.iterate.posed.flat.pressure));
    reducer.run(fields, |_, (((gap, pressure), response), surface)| {
        gap.iter_mut().for_each(|gap| *gap *= scale);
        if linear {
            for ((p, &response), &surface) in pressure.iter_mut().zip(response).zip(surface) {
                *p = scale * (*p - surface - length * cast(response)) + surface;
            }
        }
    });
    if linear {
        descent.iterate.advance_both();
    }
}
