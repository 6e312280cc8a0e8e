use super::*;

/// The homogeneous elastic half-space under periodic loads: a wave with wave number q needs p̂ = E*|q|/2 û.
///
/// Westergaard (1939); Stanley and Kato (1997). E* = E/(1 − ν²) is the contact modulus, in units of pressure.
///
/// Memory per node: 1 scalar for the spectrum, which a solve in `f64` gives back; once more, in `f64`, while a
/// [`Problem`](crate::Problem) is made.
///
/// ```
/// use asperity::{ElasticOperator, Grid, Westergaard};
/// let grid = Grid::square(16, 1.0)?;
/// let mut half_space = Westergaard::new(grid, 2.0)?;
/// let u = grid.sample(|x, _| (std::f64::consts::TAU * x).cos());
/// let mut p = u.clone();
/// half_space.pressure(u.view(), p.view_mut())?;
/// assert!((p[[8, 0]] - std::f64::consts::TAU).abs() < 1e-12); // E*q/2 at the crest
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Westergaard<T: Real>(Spectral<T>);

impl<T: Real> Westergaard<T> {
    /// The half-space of contact modulus E* under a periodic grid.
    ///
    /// # Errors
    /// [`Error::Value`] if the modulus is not positive and finite, or if a stiffness leaves the range of T.
    pub fn new(grid: Grid, modulus: f64) -> Result<Self> {
        Ok(Self(Spectral::half_space(grid, modulus)?))
    }
}

impl<T: Real> ElasticOperator<T> for Westergaard<T> {
    delegate!(this => this.0, this.0.boundary(), Some(&mut this.0));
}
