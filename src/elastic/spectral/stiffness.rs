//! The stiffness of every wave, and its application to a column of the spectrum.

use std::f64::consts::PI;
use std::sync::Arc;

use asperity_fft::num_complex::Complex;

use super::Symbol;
use crate::error::{Breach, Error, Place, Result};
use crate::fft::{Layout, Products};
use crate::field::{Field, contiguous};
use crate::grid::Grid;
use crate::real::{Real, cast};
use crate::slab::Slab;
use crate::vector::{BLOCK, LANES, vectorised};

#[derive(Clone)]
pub enum Stiffness<T> {
    Stored(Columns<T>),
    /// the half-space, `unit·√(x² + y²)`, faster computed than stored: x² and y² in and across columns
    HalfSpace {
        unit: T,
        x: Vec<T>,
        y: Vec<T>,
    },
    /// the half-space on a folded line, `unit·|x + column|`
    Line {
        unit: T,
        x: Vec<T>,
    },
    /// even along both axes, always in `f64`: of each column the first half of its modes, and the middle one
    Even(Arc<Columns<f64>>),
}

#[derive(Clone)]
pub struct Columns<T> {
    slab: Slab,
    first: usize,
    modes: Field<T>,
}

impl<T: Real> Columns<T> {
    pub(super) fn new(slab: Slab, count: usize, mut f: impl FnMut(usize, usize) -> T) -> Self {
        let own = Layout::new(slab.shape()).columns_of(&slab);
        let modes = Field::from_fn((own.len(), count), |(k, i)| f(own.start + k, i));
        Self { slab, first: own.start, modes }
    }

    pub(super) fn of(slab: Slab, modes: Field<T>) -> Self {
        Self { slab, first: Layout::new(slab.shape()).columns_of(&slab).start, modes }
    }

    fn column(&self, k: usize) -> &[T] {
        contiguous(self.modes.row(k - self.first).to_slice())
    }

    pub(super) fn get(&self, [column, mode]: [usize; 2]) -> Option<T> {
        self.modes.get([column.checked_sub(self.first)?, mode]).copied()
    }

    /// The least and the largest number of all modes, the mean excluded; zero if there are none.
    pub(super) fn range(&self) -> (f64, f64) {
        let waves = || self.modes.iter().skip(usize::from(self.first == 0)).map(|k: &T| k.widen());
        let (least, most) = (waves().fold(f64::INFINITY, f64::min), waves().fold(0.0, f64::max));
        let (least, most) = (self.slab.each(least).into_iter(), self.slab.each(most).into_iter());
        if self.slab.nodes() > 1 { (least.fold(f64::INFINITY, f64::min), most.fold(0.0, f64::max)) } else { (0.0, 0.0) }
    }

    pub(super) fn cast<U: Real>(&self) -> Columns<U> {
        Columns { slab: self.slab, first: self.first, modes: Field::of(self.modes.mapv(cast)) }
    }
}

/// The stiffness of the homogeneous half-space, and the stiffness of its softest and stiffest wave.
pub(crate) fn waves<T: Real>(grid: &Grid, modulus: f64) -> Result<(Stiffness<T>, (f64, f64))> {
    let ((nx, ny), (lx, ly)) = (grid.shape(), grid.lengths());
    let unit = PI * modulus / lx;
    let softest = match (nx, ny) {
        (1, 1) => 0.0,
        (1, _) => unit * (lx / ly),
        (_, 1) => unit,
        _ => unit * (lx / ly).min(1.0),
    };
    let stiffest = unit * (nx as f64 / 2.0).floor().hypot((lx / ly) * (ny as f64 / 2.0).floor());
    if grid.nodes() > 1 {
        check_range::<T>(softest, stiffest)?;
        // of the squares, too
        check_range::<T>((softest / unit).powi(2), (stiffest / unit).powi(2))?;
    }
    let layout = Layout::new((nx, ny));
    let ((columns, modes), (_, divisor)) = (layout.spectrum(), layout.plane());
    let stiffness = if layout.is_folded() {
        // with the sign of the mode, so that long waves are exact
        let signed = |i: usize| if 2 * i < modes { i as f64 } else { i as f64 - modes as f64 };
        let x = (0..modes).map(|i| T::lit(divisor as f64 * signed(i))).collect();
        Stiffness::Line { unit: T::lit(softest), x }
    } else {
        let square = |(i, j): (usize, usize)| {
            T::lit((i.min(nx - i) as f64).powi(2).max((lx / ly * j.min(ny - j) as f64).powi(2)))
        };
        let x = (0..modes).map(|i| square(layout.mode(0, i))).collect();
        let y = (0..columns).map(|column| square(layout.mode(column, 0))).collect();
        Stiffness::HalfSpace { unit: T::lit(unit), x, y }
    };
    Ok((stiffness, (softest, stiffest)))
}

/// Refuses stiffnesses that leave the range of T, by themselves or by the square of their ratio.
pub(super) fn check_range<T: Real>(softest: f64, stiffest: f64) -> Result<()> {
    let holds = |value: f64| T::lit(value) >= T::min_positive_value() && T::lit(value).is_finite();
    match [softest, stiffest, (stiffest / softest).powi(2)].into_iter().find(|&value| !holds(value)) {
        Some(value) => Err(Error::Value {
            name: "stiffness of a wave",
            value,
            requirement: "positive and finite in the precision of the fields",
        }),
        None => Ok(()),
    }
}

/// The symbol at every mode of the half spectrum, in the layout of the convolver.
pub(super) fn stiffness<T: Real>(grid: &Grid, symbol: &Symbol) -> Result<Columns<T>> {
    let (nx, ny) = grid.shape();
    let (layout, mut wrong) = (Layout::new((nx, ny)), None);
    let modes = Columns::new(grid.slab(), layout.spectrum().1, |column, i| {
        let (i, j) = layout.mode(column, i);
        if (i, j) == (0, 0) {
            return T::zero();
        }
        let (qx, qy) = (grid.wave_number_x(i), grid.wave_number_y(j));
        let nyquist = (2 * i == nx && j > 0) || (2 * j == ny && i > 0);
        let value = if nyquist { 0.5 * (symbol(qx, qy) + symbol(-qx, qy)) } else { symbol(qx, qy) };
        let rounded = T::lit(value);
        if !(rounded > T::zero() && rounded.is_finite()) {
            let (function, place, breach) = ("stiffness", Place::Wave(qx, qy), Breach::Stiff);
            wrong.get_or_insert(Error::Contract { function, value, place, breach });
        }
        rounded
    });
    grid.slab().agreed(wrong.map_or(Ok(modes), Err))
}

impl<T: Real> Stiffness<T> {
    /// Multiplies the modes z of column `k` by the first function of their stiffness; returns the column's sums of |z|²
    /// times the other two.
    pub(super) fn modify(&self, k: usize, column: &mut [Complex<T>], by: impl Fn(T) -> [T; 3]) -> Products {
        match self {
            Self::Stored(stiffness) => {
                let stiffness = stiffness.column(k);
                modify(column, stiffness, by)
            }
            Self::HalfSpace { unit, x, y } => {
                let (unit, y) = (*unit, y[k]);
                modify(
                    column,
                    x,
                    #[inline(always)]
                    move |x| by(unit * (x + y).sqrt()),
                )
            }
            Self::Line { unit, x } => {
                let (unit, k) = (*unit, T::lit(k as f64));
                modify(
                    column,
                    x,
                    #[inline(always)]
                    move |x| by(unit * (x + k).abs()),
                )
            }
            Self::Even(stiffness) => {
                let stiffness = stiffness.column(k);
                let (first, second) = column.split_at_mut(stiffness.len());
                let mut sums = modify(
                    first,
                    stiffness,
                    #[inline(always)]
                    |k| by(T::lit(k)),
                );
                // the others mirror these, but for the first one
                let mut end = second.len() + 1;
                for modes in second.chunks_mut(BLOCK) {
                    let mut mirrored = [0.0; BLOCK];
                    let start = end - modes.len();
                    mirrored.iter_mut().zip(stiffness[start..end].iter().rev()).for_each(|(to, from)| *to = *from);
                    let more = modify(
                        modes,
                        &mirrored[..modes.len()],
                        #[inline(always)]
                        |k| by(T::lit(k)),
                    );
                    sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
                    end = start;
                }
                sums
            }
        }
    }
}

fn modify<T: Real, U: Copy>(column: &mut [Complex<T>], of: &[U], by: impl Fn(U) -> [T; 3]) -> Products {
    let mut sums = [0.0; 3];
    let total = &mut sums;
    vectorised(
        #[inline(always)]
        move || {
            let (mut lanes, mut buffers) = ([[0.0; LANES]; 2], ([T::zero(); BLOCK], [[0.0; BLOCK]; 2]));
            let mut blocks = column.chunks_exact_mut(BLOCK);
            let mut ofs = of.chunks_exact(BLOCK);
            for (modes, of) in blocks.by_ref().zip(ofs.by_ref()) {
                block(modes, of, &by, &mut buffers, &mut lanes);
            }
            buffers.1 = [[0.0; BLOCK]; 2];
            block(blocks.into_remainder(), ofs.remainder(), &by, &mut buffers, &mut lanes);
            for (total, lanes) in total.iter_mut().zip(&lanes) {
                *total = lanes.iter().sum();
            }
        },
    );
    sums
}

#[inline(always)]
fn block<T: Real, U: Copy>(
    modes: &mut [Complex<T>],
    of: &[U],
    by: &impl Fn(U) -> [T; 3],
    (factors, terms): &mut ([T; BLOCK], [[f64; BLOCK]; 2]),
    lanes: &mut [[f64; LANES]; 2],
) {
    for (i, (z, &of)) in modes.iter().zip(of).enumerate() {
        let [factor, a, b] = by(of);
        let power = z.re.widen() * z.re.widen() + z.im.widen() * z.im.widen();
        factors[i] = factor;
        terms[0][i] = power * a.widen();
        terms[1][i] = power * b.widen();
    }
    for (z, &factor) in modes.iter_mut().zip(&*factors) {
        *z = Complex::new(z.re * factor, z.im * factor);
    }
    for (lanes, terms) in lanes.iter_mut().zip(&*terms) {
        for terms in terms.chunks_exact(LANES) {
            for (lane, term) in lanes.iter_mut().zip(terms) {
                *lane += term;
            }
        }
    }
}

#[inline(always)]
pub(super) fn stiffen<T: Real>(stiffness: T) -> [T; 3] {
    [stiffness, stiffness, T::zero()]
}

/// Divides by the stiffness plus `shift` times the softest, and multiplies the mean by `mean`; returns the sums of
/// [`Preconditioned`](crate::elastic::Preconditioned).
pub(super) fn soften<T: Real>(
    (stiffness, softest): (&Stiffness<T>, f64),
    k: usize,
    column: &mut [Complex<T>],
    shift: T,
    mean: T,
) -> Products {
    let softest = if softest > 0.0 { T::lit(softest) } else { T::one() };
    let still = if k == 0 { column.first_mut().map(std::mem::take).unwrap_or_default() } else { Complex::default() };
    let compliance = softest.recip();
    let mut sums = stiffness.modify(
        k,
        column,
        #[inline(always)]
        move |k| {
            // in units of the softest
            let k = k * compliance;
            // the mean, which has no stiffness, is seen to below
            let k = if k > T::zero() { k } else { T::one() };
            // one division for both
            let inverse = T::one() / (k * (k + shift));
            [k * inverse * compliance, (k + shift) * inverse, k * inverse]
        },
    );
    sums.iter_mut().for_each(|sum| *sum *= compliance.widen());
    if let (0, Some(first)) = (k, column.first_mut()) {
        *first = still.scale(mean);
        sums[1] += still.re.widen() * first.re.widen();
        sums[2] = first.re.widen();
    }
    sums
}
