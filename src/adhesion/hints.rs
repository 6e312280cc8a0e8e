use super::AdhesionLaw;
use crate::real::Real;

/// The properties of a law that a solve asks for once, [`AdhesionLaw::hints`].
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hints<T> {
    /// The name of the law, by which a solution knows it; empty unless it is set, as by the laws of this crate.
    pub name: &'static str,
    /// The work of adhesion w, energy per area.
    pub work_of_adhesion: T,
    /// The length ρ over which the traction decays, for μ_ρ; peaks narrower than ρ/100 may be overlooked.
    pub range: T,
    /// The gap of rest of a law that repels below it, for [`NoWall`](crate::NoWall); none if it only attracts.
    pub rest: Option<T>,
    /// Whether the energy is concave: the traction nowhere rises, and its tangent bounds the energy after a step at a
    /// rigid wall. False is safe for every law.
    pub concave: bool,
    /// Whether the law is zero at all gaps, so that it need not be evaluated.
    pub zero: bool,
    /// Whether the grid sets the range, by [`AdhesionLaw::on_nodes`]; before a grid is known the range is zero.
    pub of_grid: bool,
    /// Whether surfaces attract each other next to contacts alone, as in the limit of no range: within four nodes of a
    /// contact, or where they have not parted since. Otherwise they attract each other wherever the gap is small.
    pub touching: bool,
    /// The shape (Nx, Ny) of the only grid of a law that varies over the surface; none for a law of the gap alone.
    pub shape: Option<(usize, usize)>,
}

impl<T: Real> Hints<T> {
    /// A law of the gap alone with a work of adhesion w and a range ρ, which only attracts.
    pub fn new(work_of_adhesion: T, range: T) -> Self {
        Self {
            name: "",
            work_of_adhesion,
            range,
            rest: None,
            concave: false,
            zero: false,
            of_grid: false,
            touching: false,
            shape: None,
        }
    }

    /// The work of adhesion w = −φ(0) and the range w/φ'(0) of a law, which is ρ for an exponential and a constant
    /// traction. The range is zero where the law does not attract in contact: set one there.
    pub fn of<L: AdhesionLaw<T> + ?Sized>(law: &L) -> Self {
        let (w, traction) = (T::zero() - law.energy(T::zero()), law.traction(T::zero()));
        Self::new(w, if w > T::zero() && traction > T::zero() { w / traction } else { T::zero() })
    }

    /// A gap at which most laws have decayed: ten ranges, from the equilibrium separation on.
    pub fn far(&self) -> T {
        // a law that has the range of the grid is looked at with any
        if self.of_grid { T::one() } else { self.rest.unwrap_or_else(T::zero) + T::lit(10.0) * self.range }
    }

    /// Whether a law that is not zero attracts next to contacts alone.
    pub fn touches(&self) -> bool {
        self.touching && !self.zero
    }

    /// Whether a law that is not zero has the range of the grid.
    pub(crate) fn takes_range_of_grid(&self) -> bool {
        self.of_grid && !self.zero
    }

    /// The name of the law in a solution; a law that is zero has the name of no adhesion.
    pub(crate) fn known_as(&self) -> &'static str {
        if self.zero { "none" } else { self.name }
    }

    /// The same for a law of this name.
    #[must_use]
    pub fn with_name(self, name: &'static str) -> Self {
        Self { name, ..self }
    }

    /// The same with another range ρ.
    #[must_use]
    pub fn with_range(self, range: T) -> Self {
        Self { range, ..self }
    }

    /// The same for a law that rests at this gap.
    #[must_use]
    pub fn with_rest(self, gap: T) -> Self {
        Self { rest: Some(gap), ..self }
    }

    /// Hints for a law with a concave energy.
    #[must_use]
    pub fn concave(self) -> Self {
        Self { concave: true, ..self }
    }

    /// The same for a law that varies over a grid of the shape (Nx, Ny).
    #[must_use]
    pub fn with_shape(self, shape: (usize, usize)) -> Self {
        Self { shape: Some(shape), ..self }
    }
}
