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
        self.law(of, gaps, out);
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
    /// The law alone. It is defined for g ≥ 0; where the surfaces interpenetrate it goes on as its tangent at g = 0.
    pub(super) fn law<T: Real>(&self, of: Of, gaps: &[T], out: &mut [T])
    where
        L: AdhesionLaw<T>,
        C: ContactConstraint<T>,
    {
        if self.law.is_zero() {
            return;
        }
        if self.constraint.projects() || gaps.iter().all(|&gap| gap >= T::zero()) {
            return evaluate(self.law, of, gaps, out);
        }
        let mut buffer: Buffer<T> = [T::zero(); _];
        let apart = &mut buffer[..gaps.len()];
        apart.iter_mut().zip(gaps).for_each(|(apart, &gap)| *apart = gap.max(T::zero()));
        evaluate(self.law, of, apart, out);
        let at_contact = self.law.traction(T::zero());
        for (out, &gap) in out.iter_mut().zip(gaps).filter(|(_, gap)| **gap < T::zero()) {
            match of {
                Of::Energy => *out += at_contact * gap,
                Of::Traction => {}
                Of::Slope => *out = T::zero(),
            }
        }
    }
}

fn evaluate<T: Real>(law: &impl AdhesionLaw<T>, of: Of, gaps: &[T], out: &mut [T]) {
    match of {
        Of::Energy => law.energies(gaps, out),
        Of::Traction => law.tractions(gaps, out),
        Of::Slope => law.slopes(gaps, out),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Exponential, Penalty, Projection};

    #[test]
    fn the_law_goes_on_as_its_tangent_into_interpenetration() {
        let (law, springs) = (Exponential::new(2.0, 0.5).unwrap(), Penalty::new(30.0).unwrap());
        let potential = Potential { law: &law, constraint: &springs };
        let gaps: Vec<f64> = (-20..=20).map(|i| 0.1 * f64::from(i) + 0.05).collect();
        let at = |of, shift: f64| {
            let (gaps, mut buffer) = (gaps.iter().map(|g| g + shift).collect::<Vec<_>>(), [0.0; _]);
            potential.evaluate(of, 0, &gaps, &mut buffer).to_vec()
        };
        let step = 1e-5;
        for (of, derivative) in [(Of::Energy, Of::Traction), (Of::Traction, Of::Slope)] {
            let (low, high, exact) = (at(of, -step), at(of, step), at(derivative, 0.0));
            for ((low, high), exact) in low.iter().zip(high).zip(exact) {
                assert!(((high - low) / (2.0 * step) - exact).abs() < 1e-6, "{low} {high} {exact}");
            }
        }
        let (mut law_alone, mut buffer) = ([0.0; 3], [0.0; _]);
        potential.law(Of::Energy, &[-0.25, 0.0, 0.5], &mut law_alone);
        assert_eq!(law_alone, [-2.0 - 4.0 * 0.25, -2.0, -2.0 * (-1.0f64).exp()]);
        // where nothing interpenetrates, the law itself
        let hard = Potential { law: &law, constraint: &Projection };
        assert_eq!(hard.evaluate(Of::Energy, 0, &[0.0, 0.5], &mut buffer), &law_alone[1..]);
    }
}
