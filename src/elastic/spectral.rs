use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

use super::*;
use crate::fft::{Convolver, Layout, Products};
use crate::real::once;

mod stiffness;

use stiffness::{Columns, Stiffness, check_range, soften, stiffen, stiffness, waves};

once! {
    /// The stiffness of the homogeneous half-space, and the stiffness of its softest and stiffest wave.
    half_space<'a, T>(grid: &'a Grid, modulus: f64) -> Result<(Stiffness<T>, (f64, f64))> = waves;
    /// An application of a spectral operator.
    apply<'a, T>(
        operator: &'a mut Spectral<T>, input: ArrayView2<'a, T>, output: ArrayViewMut2<'a, T>, factor: Factor<'a>,
    ) -> Result<Products> = Spectral::convolve;
    /// The pressure of heights in `f64`, and its work.
    press<'a, T>(
        operator: &'a mut Spectral<T>, heights: ArrayView2<'a, f64>, pressure: ArrayViewMut2<'a, T>,
    ) -> Result<Products> = Spectral::<f32>::press, Spectral::<f64>::press;
}

/// The stiffness k(qx, qy) of a wave, pressure per displacement.
type Symbol = Arc<dyn Fn(f64, f64) -> f64 + Send + Sync>;

/// An elastic operator that multiplies each wave by a factor, its stiffness k(qx, qy): p̂ = k û.
///
/// A layered or an anisotropic half-space is one closure away: see the page
/// [`own_operator`](crate::guide::own_operator). The homogeneous half-space is [`Westergaard`].
///
/// Memory per node, in units of one scalar: 1 for the spectrum, which a solve in `f64` gives back, and ½ for the
/// stiffness, ¾ in such a solve; in `f32` both once more, in `f64`, while a [`Problem`](crate::Problem) is made.
///
/// ```
/// use asperity::{ElasticOperator, Grid, Spectral};
/// // a half-space on springs
/// let body = Spectral::<f64>::isotropic(Grid::square(32, 1.0)?, 1.0, |q| 10.0 + 0.5 * q)?;
/// assert!(body.stiffness_range().0 > 10.0);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone)]
pub struct Spectral<T: Real> {
    grid: Grid,
    modulus: f64,
    symbol: Symbol,
    stiffness: Stiffness<T>,
    range: (f64, f64),
    convolver: Convolver<T>,
    /// whether a solve in `f64` may have its corrections in `f32`
    single: bool,
    /// what the approach of its body has besides the waves
    far_compliance: Option<f64>,
}

impl<T: Real> fmt::Debug for Spectral<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Spectral").field("grid", &self.grid).field("modulus", &self.modulus).finish_non_exhaustive()
    }
}

impl<T: Real> Spectral<T> {
    /// The operator with stiffness `symbol(qx, qy)`, pressure per length, for wave numbers in radians per length.
    ///
    /// `modulus` is the contact modulus E* of short waves, [`ElasticOperator::modulus`]. The symbol must be even,
    /// k(−q) = k(q), and positive; it is not asked for q = 0. Where the Nyquist wave number has no sign, the mean of
    /// both signs is taken.
    ///
    /// # Errors
    /// [`Error::Value`] if the modulus is not positive and finite, or the range of the stiffness is too wide for T;
    /// [`Error::Contract`] if the symbol at a mode is not positive and finite in T; [`Error::Memory`] if there is too
    /// little for the stiffness.
    pub fn new(grid: Grid, modulus: f64, symbol: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) -> Result<Self> {
        Error::positive("contact modulus", modulus)?;
        grid.slab().afford("an elastic operator", size_of::<T>())?;
        let symbol: Symbol = Arc::new(symbol);
        let stiffness = stiffness(&grid, &symbol)?;
        let range = stiffness.range();
        if grid.nodes() > 1 {
            check_range::<T>(range.0, range.1)?;
        }
        let (stiffness, convolver) = (Stiffness::Stored(stiffness), Convolver::new(grid.slab()));
        Ok(Self { grid, modulus, symbol, stiffness, range, convolver, single: true, far_compliance: None })
    }

    /// Sets whether a solve in `f64` may have its corrections by this operator in `f32`, as by default it does: gap,
    /// pressure and certificate are in `f64` either way.
    #[doc(hidden)]
    pub fn set_single(&mut self, single: bool) {
        self.single = single;
    }

    /// The operator of a body. Its [`modulus`](ElasticOperator::modulus) is the body's [`modulus_on`](Body::modulus_on)
    /// the grid: the modulus of the body where waves on the grid are short enough, and more for a thin layer.
    ///
    /// ```
    /// use asperity::{ElasticOperator, Grid, Spectral};
    /// use asperity::elastic::{Base, Layer, Material};
    /// let layer = Layer::new(Material::new(1.0, 0.3)?, 0.1, Base::Bonded)?;
    /// let operator = Spectral::<f64>::of(Grid::square(64, 1.0)?, layer)?;
    /// assert!((operator.modulus() - 1.0).abs() < 1e-9);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Spectral::new`].
    pub fn of(grid: Grid, body: impl Body + 'static) -> Result<Self> {
        let (modulus, far_compliance) = (body.modulus_on(&grid), body.far_compliance(&grid));
        Ok(Self { far_compliance, ..Self::new(grid, modulus, move |qx, qy| body.stiffness(qx, qy))? })
    }

    pub(super) fn half_space(grid: Grid, modulus: f64) -> Result<Self> {
        Error::positive("contact modulus", modulus)?;
        let symbol: Symbol = Arc::new(move |qx, qy| 0.5 * modulus * qx.hypot(qy));
        let (stiffness, range) = half_space(&grid, modulus)?;
        let convolver = Convolver::new(grid.slab());
        Ok(Self { grid, modulus, symbol, stiffness, range, convolver, single: true, far_compliance: None })
    }

    /// The operator of a compliance that is even along both axes, without folded lines: of each column of the half
    /// spectrum that this process transforms the first half of its modes, and the middle one. The mean's is not used.
    pub(super) fn of_compliance(grid: Grid, modulus: f64, mut modes: Field<f64>) -> Result<Self> {
        Error::positive("contact modulus", modulus)?;
        let wrong = modes.iter().find(|&&compliance| !(compliance > 0.0 && compliance.is_finite()));
        let wrong = wrong.map_or(Ok(()), |&value| {
            Err(Error::Value { name: "compliance of a wave", value, requirement: "positive and finite" })
        });
        grid.slab().agreed(wrong)?;
        modes.view_mut().mapv_inplace(f64::recip);
        let slab = grid.slab();
        if let Some(mean) = modes.nodes_mut().first_mut().filter(|_| slab.ranks().rank() == 0) {
            *mean = 0.0;
        }
        let modes = Columns::of(slab, modes);
        let range = modes.range();
        check_range::<T>(range.0, range.1)?;
        let (convolver, modes) = (Convolver::new(grid.slab()), Arc::new(modes));
        let (exchanged, (lx, ly)) = (convolver.layout().mode(0, 1).0 == 0, grid.lengths());
        let symbol = {
            let modes = Arc::clone(&modes);
            move |qx: f64, qy: f64| {
                let [i, j] = [(qx * lx).abs() / TAU, (qy * ly).abs() / TAU].map(|number| number.round() as usize);
                // one process has it, and all ask
                let own = modes.get(if exchanged { [i, j] } else { [j, i] }).unwrap_or(f64::NEG_INFINITY);
                slab.each(own).into_iter().fold(f64::NEG_INFINITY, f64::max)
            }
        };
        let (symbol, stiffness) = (Arc::new(symbol), Stiffness::Even(modes));
        Ok(Self { grid, modulus, symbol, stiffness, range, convolver, single: true, far_compliance: None })
    }

    /// The operator with a stiffness that depends on the wave number's magnitude alone.
    ///
    /// # Errors
    /// As for [`Spectral::new`].
    pub fn isotropic(grid: Grid, modulus: f64, symbol: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Result<Self> {
        Self::new(grid, modulus, move |qx, qy| symbol(qx.hypot(qy)))
    }
}

fn weigh(layout: Layout, column: usize, sums: Products) -> Products {
    sums.map(|sum| layout.weight(column) * sum)
}

pub enum Factor<'a> {
    Stiffness,
    Compliance,
    Preconditioner(Foundation<'a>),
}

impl Spectral<f32> {
    /// The pressure of heights in `f64`, and its work.
    fn press(&mut self, heights: ArrayView2<'_, f64>, pressure: ArrayViewMut2<'_, f32>) -> Result<Products> {
        self.in_double()?.convolve(heights, pressure, Factor::Stiffness)
    }
}

impl Spectral<f64> {
    /// The pressure of heights, and its work.
    fn press(&mut self, heights: ArrayView2<'_, f64>, pressure: ArrayViewMut2<'_, f64>) -> Result<Products> {
        self.convolve(heights, pressure, Factor::Stiffness)
    }
}

impl<T: Real> Spectral<T> {
    fn convolve<U: Real>(
        &mut self,
        input: ArrayView2<'_, T>,
        output: ArrayViewMut2<'_, U>,
        factor: Factor<'_>,
    ) -> Result<Products> {
        let Self { stiffness, range: (softest, _), convolver, .. } = self;
        let layout = convolver.layout();
        match factor {
            Factor::Stiffness => {
                convolver.convolve(input, output, |k, column| weigh(layout, k, stiffness.modify(k, column, stiffen)))
            }
            Factor::Compliance => convolver.convolve(input, output, |k, column| {
                weigh(layout, k, soften((stiffness, *softest), k, column, T::zero(), T::zero()))
            }),
            Factor::Preconditioner(Foundation { stiffness: shift, mean_stiffness, coarse }) => {
                let shift = T::lit(if *softest > 0.0 { shift / *softest } else { 0.0 });
                let mean = T::lit(1.0 / mean_stiffness);
                convolver.convolve_after(
                    input,
                    output,
                    coarse.as_ref().map_or(0, |coarse| coarse.columns()),
                    |spectrum| {
                        coarse.map(|coarse| {
                            coarse.respond(spectrum);
                            &*coarse
                        })
                    },
                    |coarse, k, column| {
                        let mut sums = soften((stiffness, *softest), k, column, shift, mean);
                        if let Some(coarse) = coarse {
                            coarse.put(k, column, &mut sums);
                        }
                        weigh(layout, k, sums)
                    },
                )
            }
        }
    }

    fn with<U: Real>(&self, stiffness: Stiffness<U>, range: (f64, f64)) -> Spectral<U> {
        let (grid, modulus, symbol) = (self.grid, self.modulus, Arc::clone(&self.symbol));
        Spectral {
            grid,
            modulus,
            symbol,
            stiffness,
            range,
            convolver: Convolver::new(grid.slab()),
            single: self.single,
            far_compliance: self.far_compliance,
        }
    }

    fn in_double(&self) -> Result<Spectral<f64>> {
        let stiffness = match &self.stiffness {
            Stiffness::Stored(_) => Stiffness::Stored(stiffness(&self.grid, &self.symbol)?),
            Stiffness::Even(modes) => Stiffness::Even(Arc::clone(modes)),
            Stiffness::HalfSpace { .. } | Stiffness::Line { .. } => waves(&self.grid, self.modulus)?.0,
        };
        Ok(self.with(stiffness, self.range))
    }

    fn norm(&self) -> f64 {
        (self.grid.nodes() as f64).powi(2)
    }
}

impl<T: Real> Spectral<T> {
    pub(super) fn surface_pressure(
        &mut self,
        heights: ArrayView2<'_, f64>,
        pressure: ArrayViewMut2<'_, T>,
    ) -> Result<f64> {
        let [work, ..] = press(self, heights, pressure)?;
        Ok(work / self.norm())
    }

    /// The operator in `f32`, for the corrections of a solve in `f64`; none if a stiffness leaves the range of `f32`.
    pub(crate) fn in_single(&self) -> Option<Spectral<f32>> {
        if !self.single {
            return None;
        }
        let (stiffness, range) = match &self.stiffness {
            Stiffness::Stored(stiffness) => {
                check_range::<f32>(self.range.0, self.range.1).ok()?;
                (Stiffness::Stored(stiffness.cast()), self.range)
            }
            Stiffness::Even(modes) => {
                check_range::<f32>(self.range.0, self.range.1).ok()?;
                (Stiffness::Even(Arc::clone(modes)), self.range)
            }
            Stiffness::HalfSpace { .. } | Stiffness::Line { .. } => waves(&self.grid, self.modulus).ok()?,
        };
        Some(self.with(stiffness, range))
    }

    pub(crate) fn release_memory(&mut self) {
        self.convolver.release_memory();
    }

    /// The space of the longest waves, of about `dimension` dimensions, that the preconditioner treats with the contacts
    /// where they are; none where it does not pay.
    pub(crate) fn coarse_space(&self, dimension: usize) -> Option<CoarseSpace> {
        CoarseSpace::new(&self.grid, self.convolver.layout(), &*self.symbol, dimension)
    }

    pub(super) fn pressure_and_work(
        &mut self,
        displacement: ArrayView2<'_, T>,
        pressure: ArrayViewMut2<'_, T>,
    ) -> Result<f64> {
        let [work, ..] = apply(self, displacement, pressure, Factor::Stiffness)?;
        Ok(work / self.norm())
    }

    /// M has the symbol 1/(k + s), but for the waves of the coarse space; the products come from the same transform.
    pub(super) fn precondition(
        &mut self,
        residual: ArrayView2<'_, T>,
        foundation: Foundation<'_>,
        preconditioned: ArrayViewMut2<'_, T>,
    ) -> Result<Preconditioned> {
        let [error, descent, mean] = apply(self, residual, preconditioned, Factor::Preconditioner(foundation))?;
        let mean = mean / self.grid.nodes() as f64;
        Ok(Preconditioned { error: error / self.norm(), descent: descent / self.norm(), mean })
    }
}

impl<T: Real> ElasticOperator<T> for Spectral<T> {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn pressure(&mut self, displacement: ArrayView2<'_, T>, pressure: ArrayViewMut2<'_, T>) -> Result<()> {
        self.pressure_and_work(displacement, pressure).map(|_| ())
    }

    fn displacement(&mut self, pressure: ArrayView2<'_, T>, displacement: ArrayViewMut2<'_, T>) -> Result<()> {
        apply(self, pressure, displacement, Factor::Compliance).map(|_| ())
    }

    fn stiffness_range(&self) -> (f64, f64) {
        self.range
    }

    fn modulus(&self) -> f64 {
        self.modulus
    }

    fn far_compliance(&self) -> Option<f64> {
        self.far_compliance
    }

    fn takes_slabs(&self) -> bool {
        true
    }

    fn spectral(&mut self) -> Option<&mut Spectral<T>> {
        Some(self)
    }
}
