use crate::adhesion::AdhesionLaw;
use crate::constraint::ContactConstraint;
use crate::field::CHUNK;
use crate::real::Real;

/// What each node feels by its own gap: the adhesion law, and the constraint where it is a term of the energy.
pub(super) struct Potential<'a, L, C> {
    pub(super) law: &'a L,
    pub(super) constraint: &'a C,
}

/// Room for one value per node of a chunk.
pub(super) type Buffer<T> = [T; CHUNK];

/// Which derivative of the potential.
#[derive(Clone, Copy)]
pub(super) enum Of {
    Energy,
    Traction,
    Slope,
}

impl<L, C> Potential<'_, L, C> {
    /// Whether there is nothing to evaluate: then [`Self::evaluate`] leaves its buffer as it is.
    pub(super) fn is_zero<T: Real>(&self) -> bool
    where
        L: AdhesionLaw<T>,
        C: ContactConstraint<T>,
    {
        self.law.is_zero() && self.constraint.projects()
    }

    /// The energies, tractions or slopes of law and constraint at the nodes from `first` on.
    pub(super) fn evaluate<'b, T: Real>(&self, of: Of, first: usize, gaps: &[T], buffer: &'b mut Buffer<T>) -> &'b [T]
    where
        L: AdhesionLaw<T>,
        C: ContactConstraint<T>,
    {
        let out = &mut buffer[..gaps.len()];
        if !self.law.is_zero() {
            match of {
                Of::Energy => self.law.energies(gaps, out),
                Of::Traction => self.law.tractions(gaps, out),
                Of::Slope => self.law.slopes(gaps, out),
            }
        }
        if !self.constraint.projects() {
            if self.law.is_zero() {
                out.fill(T::zero());
            }
            for (i, (out, &gap)) in out.iter_mut().zip(gaps).enumerate() {
                *out += match of {
                    Of::Energy => self.constraint.energy(first + i, gap),
                    Of::Traction => self.constraint.traction(first + i, gap),
                    Of::Slope => self.constraint.slope(first + i, gap),
                };
            }
        }
        out
    }
}
