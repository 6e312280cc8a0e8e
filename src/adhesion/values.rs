use std::ops::Range;

use crate::real::Real;
use crate::vector::vectors;

/// The energies, tractions and slopes that are asked of a law at some nodes, each of the length of the gaps.
///
/// ```
/// use asperity::adhesion::Values;
/// use asperity::{AdhesionLaw, Exponential};
/// let (mut energies, mut tractions) = ([0.0; 2], [0.0; 2]);
/// let values = Values { energies: Some(&mut energies), tractions: Some(&mut tractions), slopes: None };
/// Exponential::new(1e-4, 2e-3)?.evaluate(0, &[0.0, 1e-3], values);
/// assert_eq!((energies[0], tractions[0]), (-1e-4, 1e-4 / 2e-3));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Debug, Default)]
pub struct Values<'a, T> {
    /// The energies φ.
    pub energies: Option<&'a mut [T]>,
    /// The tractions φ'.
    pub tractions: Option<&'a mut [T]>,
    /// The slopes φ''.
    pub slopes: Option<&'a mut [T]>,
}

impl<'a, T: Real> Values<'a, T> {
    /// The slice of one order of the derivative: 0 energies, 1 tractions, 2 slopes.
    pub fn one(order: usize, values: &'a mut [T]) -> Self {
        let none = Self { energies: None, tractions: None, slopes: None };
        match order {
            0 => Self { energies: Some(values), ..none },
            1 => Self { tractions: Some(values), ..none },
            _ => Self { slopes: Some(values), ..none },
        }
    }

    pub(crate) fn energies_and_tractions(energies: &'a mut [T], tractions: &'a mut [T]) -> Self {
        Self { energies: Some(energies), tractions: Some(tractions), slopes: None }
    }

    pub(crate) fn tractions_and_slopes(tractions: &'a mut [T], slopes: &'a mut [T]) -> Self {
        Self { energies: None, tractions: Some(tractions), slopes: Some(slopes) }
    }

    /// The same slices, for a call after which they are still needed.
    pub fn reborrow(&mut self) -> Values<'_, T> {
        let Self { energies, tractions, slopes } = self;
        Values { energies: energies.as_deref_mut(), tractions: tractions.as_deref_mut(), slopes: slopes.as_deref_mut() }
    }

    /// The slices of some of the nodes.
    pub fn part(&mut self, nodes: Range<usize>) -> Values<'_, T> {
        let Self { energies, tractions, slopes } = self;
        let [energies, tractions, slopes] = [energies, tractions, slopes]
            .map(|values| values.as_deref_mut().and_then(|all| all.get_mut(nodes.clone())));
        Values { energies, tractions, slopes }
    }

    /// Visits each slice that is asked for, with its order.
    pub fn each(self, mut visit: impl FnMut(usize, &mut [T])) {
        let slices = [self.energies, self.tractions, self.slopes].into_iter().enumerate();
        slices.for_each(|(order, values)| values.into_iter().for_each(|values| visit(order, values)));
    }

    /// Sets the slices that are asked for by a function of the gap that returns energy, traction and slope.
    #[inline(always)]
    pub fn set(self, gaps: &[T], of: impl Fn(T) -> [T; 3] + Copy) {
        match self {
            Self { energies: Some(energies), tractions: Some(tractions), slopes: None } => {
                vectors!([gaps], [energies, tractions], |i| {
                    [energies[i], tractions[i], _] = of(gaps[i]);
                });
            }
            Self { energies: None, tractions: Some(tractions), slopes: Some(slopes) } => {
                vectors!([gaps], [tractions, slopes], |i| {
                    [_, tractions[i], slopes[i]] = of(gaps[i]);
                });
            }
            Self { energies, tractions, slopes } => {
                if let Some(energies) = energies {
                    vectors!([gaps], [energies], |i| {
                        [energies[i], _, _] = of(gaps[i]);
                    });
                }
                if let Some(tractions) = tractions {
                    vectors!([gaps], [tractions], |i| {
                        [_, tractions[i], _] = of(gaps[i]);
                    });
                }
                if let Some(slopes) = slopes {
                    vectors!([gaps], [slopes], |i| {
                        [_, _, slopes[i]] = of(gaps[i]);
                    });
                }
            }
        }
    }
}
