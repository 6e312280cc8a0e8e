use ndarray::Array2;

use super::{Fields, Local, Of, count};
use crate::field::{CHUNK, Partial, read};
use crate::par::IndexedParallelIterator;
use crate::real::Real;
use crate::vector::sums;

/// Where the sums of a tally are among those of its pass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tally {
    /// how many nodes are apart
    pub(crate) free: f64,
    /// Σ r over these
    pub(crate) sum_r: f64,
    /// the least r in contact
    pub(crate) min_r: f64,
    pub(crate) sum_gap: f64,
    /// Σ g·p
    pub(crate) sum_gp: f64,
    /// how many nodes are in contact
    pub(crate) contact: f64,
    /// Σ φ' of the law
    pub(crate) traction: f64,
    /// Σ φ of the law
    pub(crate) adhesive: f64,
    /// Σ of the constraint's energy
    pub(crate) penalty: f64,
    /// Σ g·(p + K⁻¹h), which with Σ h·K⁻¹h makes Σ u·p
    pub(crate) work: f64,
}

impl Tally {
    pub(crate) fn new(total: &Partial) -> Self {
        let [free, sum_r, sum_gap, sum_gp, contact, traction, adhesive, penalty, surface, ..] = total.sum;
        let work = sum_gp + surface;
        Self { free, sum_r, min_r: total.min, sum_gap, sum_gp, contact, traction, adhesive, penalty, work }
    }
}

/// The local tractions of a chunk, zero where there is nothing to evaluate.
pub(super) fn tractions<'a, T: Real>(
    local: &dyn Local<T>,
    first: usize,
    gaps: &[T],
    buffer: &'a mut [T; CHUNK],
) -> &'a [T] {
    let tractions = &mut buffer[..gaps.len()];
    if !local.is_zero() {
        local.evaluate(Of::Traction, first, gaps, tractions);
    }
    tractions
}

/// The part of a tally that gap, pressure and traction of a chunk give.
pub(super) fn tally_of<T: Real>(projects: bool, offset: T, gap: &[T], pressure: &[T], traction: &[T]) -> Partial {
    sums!(5, [gap, pressure, traction], [], |i| {
        let (g, p) = (gap[i], pressure[i]);
        let r = (p + traction[i] + offset).widen();
        let touches = projects & (g <= T::zero());
        let free = count(!touches);
        let terms = [free, if touches { 0.0 } else { r }, g.widen(), g.widen() * p.widen(), 1.0 - free];
        (terms, if touches { r } else { f64::INFINITY })
    })
}

/// Adds the energies and tractions of law and constraint.
pub(super) fn tally_local<T: Real>(
    part: &mut Partial,
    local: &dyn Local<T>,
    first: usize,
    gaps: &[T],
    tractions: &[T],
    energies: bool,
) {
    let mut buffer = [T::zero(); CHUNK];
    let out = &mut buffer[..gaps.len()];
    let sum = |values: &[T]| sums!(1, [values], [], |i| ([values[i].widen()], f64::INFINITY)).sum[0];
    if local.projects() {
        part.sum[5] = sum(tractions);
    } else {
        local.law(Of::Traction, gaps, out);
        part.sum[5] = sum(out);
        [part.sum[4], part.sum[7]] = local.pressed(first, gaps);
    }
    if energies {
        local.law(Of::Energy, gaps, out);
        part.sum[6] = sum(out);
    }
}

pub(super) fn tally<T: Real>(fields: &mut Fields<T>, local: &dyn Local<T>, offset: T, surface: &Array2<T>) -> Partial {
    let Fields { reducer, gap, pressure, .. } = fields;
    reducer.run(read(gap).zip(read(pressure)).zip(read(surface)), |first, ((gap, pressure), surface)| {
        let mut buffer = [T::zero(); CHUNK];
        let tractions = tractions(local, first, gap, &mut buffer);
        let mut part = tally_of(local.projects(), offset, gap, pressure, tractions);
        if !local.is_zero() {
            tally_local(&mut part, local, first, gap, tractions, true);
        }
        let product = sums!(1, [gap, surface], [], |i| ([gap[i].widen() * surface[i].widen()], f64::INFINITY));
        part.sum[8] = product.sum[0];
        part
    })
}

pub(super) fn released<T: Real>(fields: &mut Fields<T>, at_contact: T, release: T) -> Partial {
    let Fields { reducer, gap, pressure, .. } = fields;
    let limit = release.widen();
    reducer.run_where(
        |tally| tally.min < limit,
        read(gap).zip(read(pressure)),
        |_, (gap, pressure)| {
            sums!(2, [gap, pressure], [], |i| {
                let r = pressure[i] + at_contact;
                let released = (gap[i] <= T::zero()) & (r < release);
                ([count(released), if released { r.widen() } else { 0.0 }], f64::INFINITY)
            })
        },
    )
}
