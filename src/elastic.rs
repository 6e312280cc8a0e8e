//! The elastic operator: pressure from displacement, displacement from pressure, and the preconditioner.

use ndarray::{ArrayView2, ArrayViewMut2};

use crate::error::{Error, Result};
use crate::field::Field;
use crate::grid::Grid;
use crate::names::names;
use crate::real::Real;

mod body;
mod boussinesq;
mod check;
mod coarse;
mod spectral;
mod westergaard;

pub use body::{Base, Body, Coating, HalfSpace, Layer, Material, Plate, Series};
pub use boussinesq::Boussinesq;
pub use check::check_operator;
pub(crate) use coarse::CoarseSpace;
pub use spectral::Spectral;
pub use westergaard::Westergaard;

/// The elastic operator of a half-space: the pressure p = K⁻¹u of a displacement u of its surface, and u = Kp.
///
/// The operator is linear, symmetric, and positive on fields without mean. A rigid translation costs nothing: both
/// applications return fields of zero mean and ignore the mean of their argument. [`Westergaard`] is the homogeneous
/// half-space under periodic loads, [`Boussinesq`] under loads on a window alone, [`Spectral`] any operator that
/// multiplies each wave by a factor, as layers, coatings and other [bodies](Body) do. The page
/// [`own_operator`](crate::guide::own_operator) has a layer of finite thickness, and tells how to implement the trait
/// for another body.
///
/// Applications write into the caller's array and, for the operators of this crate, allocate nothing.
///
/// ```
/// use asperity::{ElasticOperator, Grid, Westergaard};
/// let grid = Grid::square(16, 1.0)?;
/// // chosen at run time
/// let mut operator: Box<dyn ElasticOperator<f64>> = Box::new(Westergaard::<f64>::new(grid, 1.0)?);
/// let u = grid.sample(|x, y| (std::f64::consts::TAU * (x + 2.0 * y)).sin());
/// let (mut p, mut again) = (u.clone(), u.clone());
/// operator.pressure(u.view(), p.view_mut())?;
/// operator.displacement(p.view(), again.view_mut())?;
/// assert!(u.iter().zip(&again).all(|(a, b)| (a - b).abs() < 1e-12));
/// # Ok::<(), asperity::Error>(())
/// ```
pub trait ElasticOperator<T: Real>: Send {
    /// The grid of the fields that the operator takes and returns.
    fn grid(&self) -> &Grid;

    /// The elastic pressure p = K⁻¹u of a normal displacement u, both of shape (Nx, Ny). The mean of p is zero.
    ///
    /// # Errors
    /// [`Error::Shape`] if a field does not fit the grid.
    fn pressure(&mut self, displacement: ArrayView2<'_, T>, pressure: ArrayViewMut2<'_, T>) -> Result<()>;

    /// The displacement u = Kp of a pressure p, both of shape (Nx, Ny). The mean of u is zero.
    ///
    /// # Errors
    /// [`Error::Shape`] if a field does not fit the grid.
    fn displacement(&mut self, pressure: ArrayView2<'_, T>, displacement: ArrayViewMut2<'_, T>) -> Result<()>;

    /// The stiffness of the softest and of the stiffest wave on the grid, pressure per length, the mean excluded.
    ///
    /// The softest bounds the rounding of an updated pressure in the certificate, and must not be overestimated; the
    /// stiffest may be an estimate. Both are zero on a grid of one node.
    fn stiffness_range(&self) -> (f64, f64);

    /// The contact modulus E* for waves as short as the grid's spacing.
    ///
    /// It tells whether adhesion is resolved ([`Problem::mu_rho`](crate::Problem::mu_rho)), where between the nodes the
    /// edge of the contact runs ([`ContactStatistics`](crate::contact::ContactStatistics)), and how smooth jumps of a
    /// law become; it is the unit of [`Criterion::Complementarity`](crate::solver::Criterion::Complementarity).
    fn modulus(&self) -> f64;

    /// The boundary of the body; periodic by default.
    fn boundary(&self) -> Boundary {
        Boundary::Periodic
    }

    /// The [`far_compliance`](Body::far_compliance) of its body, by which a periodic body has an approach; none by default.
    fn far_compliance(&self) -> Option<f64> {
        None
    }

    /// Whether the operator takes fields of [`Grid::field_shape`] on a grid that processes share; not by default.
    fn takes_slabs(&self) -> bool {
        false
    }

    /// The spectral operator that does all applications, if there is one. A solve then treats the longest waves where
    /// the contacts are, and in `f64` has its corrections in `f32`; without a spectral operator, the default, a solve
    /// takes more iterations, and each costs more.
    fn spectral(&mut self) -> Option<&mut Spectral<T>> {
        None
    }
}

/// What a solve asks of an operator, by its spectral operator or by applications alone.
impl<T: Real> dyn ElasticOperator<T> + '_ {
    /// The elastic pressure p = K⁻¹u, and the mean of u·K⁻¹u.
    pub(crate) fn pressure_and_work(
        &mut self,
        displacement: ArrayView2<'_, T>,
        mut pressure: ArrayViewMut2<'_, T>,
    ) -> Result<f64> {
        if let Some(spectral) = self.spectral() {
            return spectral.pressure_and_work(displacement, pressure);
        }
        self.pressure(displacement, pressure.view_mut())?;
        Ok(mean_product(self.grid(), displacement, pressure.view()))
    }

    /// The elastic pressure K⁻¹h of heights in `f64`, and the mean of h·K⁻¹h; the heights have no mean, or one not
    /// larger than their rms value.
    pub(crate) fn surface_pressure(
        &mut self,
        heights: ArrayView2<'_, f64>,
        mut pressure: ArrayViewMut2<'_, T>,
    ) -> Result<f64> {
        if let Some(spectral) = self.spectral() {
            return spectral.surface_pressure(heights, pressure);
        }
        self.pressure(heights.mapv(T::lit).view(), pressure.view_mut())?;
        Ok(mean_product(self.grid(), heights, pressure.view()))
    }

    /// Applies the preconditioner, M r.
    ///
    /// M is close to (K⁻¹ + s)⁻¹, with s the stiffness of the foundation, for the mean 1/mean_stiffness, which may be
    /// zero, and for the waves of a coarse space its response; without a spectral operator it is the compliance, and
    /// 1/mean_stiffness for the mean. It is symmetric, and positive but for the mean.
    pub(crate) fn precondition(
        &mut self,
        residual: ArrayView2<'_, T>,
        foundation: Foundation<'_>,
        mut preconditioned: ArrayViewMut2<'_, T>,
    ) -> Result<Preconditioned> {
        if let Some(spectral) = self.spectral() {
            return spectral.precondition(residual, foundation, preconditioned);
        }
        self.displacement(residual, preconditioned.view_mut())?;
        let error = mean_product(self.grid(), residual, preconditioned.view());
        let mean_residual = self.grid().mean(residual, T::widen);
        let mean = mean_residual / foundation.mean_stiffness;
        let shift = T::lit(mean);
        preconditioned.mapv_inplace(|u| u + shift);
        Ok(Preconditioned { error, descent: error + mean_residual * mean, mean })
    }

    /// Gives back the memory that is kept between two applications; the next one takes it anew.
    pub(crate) fn release_memory(&mut self) {
        self.spectral().into_iter().for_each(Spectral::release_memory);
    }
}

/// The operators of one body on many grids: a closure that makes an operator of a grid.
pub trait OnGrids<T: Real> {
    /// The operator on a grid.
    ///
    /// # Errors
    /// The reason, if there is none on that grid.
    fn on(&mut self, grid: Grid) -> Result<Box<dyn ElasticOperator<T>>>;
}

impl<T: Real, O: ElasticOperator<T> + 'static, F: FnMut(Grid) -> Result<O>> OnGrids<T> for F {
    fn on(&mut self, grid: Grid) -> Result<Box<dyn ElasticOperator<T>>> {
        Ok(Box::new(self(grid)?))
    }
}

/// The boundary of the elastic body: periodic, as in [`Westergaard`], or free, as in [`Boussinesq`].
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Boundary {
    /// The body and the surface repeat: the surface is on the operator's grid.
    #[default]
    Periodic,
    /// A free boundary: the surface is on the first nodes of the operator's grid along both axes, and nothing faces the
    /// body on the others.
    Free {
        /// The grid of the surface, with the spacing of the operator's.
        window: Grid,
        /// The mean displacement of the operator's grid over the mean pressure on it, length per pressure.
        mean_compliance: f64,
    },
}

names!(Boundary { Periodic = "periodic", Free = "free" });

impl Boundary {
    pub(crate) fn is_periodic(self) -> bool {
        matches!(self, Self::Periodic)
    }

    /// The grid of the surface, by the operator's.
    pub(crate) fn surface_grid(self, whole: Grid) -> Grid {
        match self {
            Self::Periodic => whole,
            Self::Free { window, .. } => window,
        }
    }

    /// The mean displacement of the operator's grid over the mean pressure on it; zero in a periodic cell.
    pub(crate) fn mean_compliance(self) -> f64 {
        match self {
            Self::Periodic => 0.0,
            Self::Free { mean_compliance, .. } => mean_compliance,
        }
    }
}

/// The foundation on which the half-space rests in the preconditioner, pressures per length.
#[derive(Debug)]
pub(crate) struct Foundation<'a> {
    /// The stiffness for every wave.
    pub(crate) stiffness: f64,
    /// The stiffness for the mean; may be infinite.
    pub(crate) mean_stiffness: f64,
    /// The longest waves and the mean, held where the contacts are; for these it takes the place of the stiffnesses.
    pub(crate) coarse: Option<&'a mut CoarseSpace>,
}

impl Foundation<'_> {
    /// A foundation that is the same everywhere.
    pub(crate) fn uniform(stiffness: f64, mean_stiffness: f64) -> Self {
        Self { stiffness, mean_stiffness, coarse: None }
    }
}

/// The products of the preconditioner besides M r, all of them means over the nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Preconditioned {
    /// r·Kr without the mean of r, of K itself, as it bounds the error ([`Report::relative_error`](crate::Report))
    pub(crate) error: f64,
    /// r·Mr
    pub(crate) descent: f64,
    /// M r
    pub(crate) mean: f64,
}

fn mean_product<S: Real, T: Real>(grid: &Grid, a: ArrayView2<'_, S>, b: ArrayView2<'_, T>) -> f64 {
    grid.mean_of_both(a, b, |a: S, b: T| a.widen() * b.widen())
}

/// The methods of an operator that wraps another, `$inner` of `$this`, with a boundary and a spectral operator of its
/// own.
macro_rules! delegate {
    ($this:ident => $inner:expr, $boundary:expr, $spectral:expr) => {
        fn grid(&self) -> &Grid {
            let $this = self;
            $inner.grid()
        }
        fn pressure(&mut self, displacement: ArrayView2<'_, T>, pressure: ArrayViewMut2<'_, T>) -> Result<()> {
            let $this = self;
            $inner.pressure(displacement, pressure)
        }
        fn displacement(&mut self, pressure: ArrayView2<'_, T>, displacement: ArrayViewMut2<'_, T>) -> Result<()> {
            let $this = self;
            $inner.displacement(pressure, displacement)
        }
        fn stiffness_range(&self) -> (f64, f64) {
            let $this = self;
            $inner.stiffness_range()
        }
        fn modulus(&self) -> f64 {
            let $this = self;
            $inner.modulus()
        }
        fn boundary(&self) -> Boundary {
            let $this = self;
            $boundary
        }
        fn far_compliance(&self) -> Option<f64> {
            let $this = self;
            $inner.far_compliance()
        }
        fn takes_slabs(&self) -> bool {
            let $this = self;
            $inner.takes_slabs()
        }
        fn spectral(&mut self) -> Option<&mut Spectral<T>> {
            let $this = self;
            $spectral
        }
    };
}
use delegate;

impl<T: Real, O: ElasticOperator<T> + ?Sized> ElasticOperator<T> for Box<O> {
    delegate!(this => (**this), (**this).boundary(), (**this).spectral());
}

#[cfg(test)]
mod tests;
