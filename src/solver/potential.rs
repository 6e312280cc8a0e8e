//! The local energy of a node: the adhesion law, and the constraint where it is a term of the energy.

use crate::adhesion::{AdhesionLaw, Hints, NoAdhesion, Values};
use crate::constraint::{ContactConstraint, Hardness, Springs, Wall};
use crate::degrees::HALF;
use crate::field::{CHUNK, Reducer, Sums, found};
use crate::par::{Nodes, Parts};
use crate::problem::Window;
use crate::real::Real;
use crate::vector::sums;

/// The least gap of a node after a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Least<T> {
    /// the gap at which a node from above lands
    rest: T,
    /// the share of its gap that a node below `rest` keeps
    share: T,
    /// how much closer it may come still: zero or without bound
    pub(crate) depth: T,
}

impl<T: Real> Least<T> {
    fn unbounded() -> Self {
        Self { rest: T::infinity(), share: T::zero(), depth: T::infinity() }
    }

    /// Whether a wall at zero gap is all that bounds the gap.
    pub(crate) fn is_wall(self) -> bool {
        [self.rest, self.share, self.depth] == [T::zero(); 3]
    }

    #[inline(always)]
    pub(crate) fn after(self, gap: T) -> T {
        if gap > self.rest { self.rest } else { self.share * gap - self.depth }
    }
}

pub(crate) fn bounded<T: Real>(least: Least<T>, gap: T, wanted: T) -> T {
    let least = least.after(gap);
    if wanted < least { least } else { wanted }
}

/// The local energy of every node, zero at nodes that face no surface and have a free gap: passes are
/// [divided](Self::run).
#[derive(Clone, Copy)]
pub(crate) struct Potential<'a, T> {
    law: &'a dyn AdhesionLaw<T>,
    hints: Hints<T>,
    /// what keeps the surfaces apart; none where there is no surface
    wall: Option<Wall<'a, T>>,
    /// where there is a surface; none if everywhere
    window: Option<&'a Window>,
}

found! {
    /// The nodes that springs, the law or a wall that yields press apart, and the energy of springs and wall.
    pub(crate) struct Pressed {
        pub(crate) nodes: f64,
        pub(crate) energy: f64,
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Of {
    Energy,
    Traction,
    Slope,
}

impl<'a, T: Real> Potential<'a, T> {
    pub(crate) fn new(
        law: &'a dyn AdhesionLaw<T>,
        constraint: &'a dyn ContactConstraint<T>,
        window: Option<&'a Window>,
    ) -> Self {
        Self { law, hints: law.hints(), wall: Some(constraint.wall()), window }
    }

    /// The shares of the adhesive energy in contact, of at most a chunk of nodes; zeros for a law with a range of its own.
    pub(crate) fn shares(&self, first: usize, gap: &[T]) -> [T; CHUNK] {
        let mut shares = [T::zero(); CHUNK];
        if self.hints.takes_range_of_grid() {
            self.law.contact_shares(first, gap, &mut shares[..gap.len()]);
        }
        shares
    }

    fn nothing() -> Self {
        Self { law: &NoAdhesion, hints: AdhesionLaw::hints(&NoAdhesion), wall: None, window: None }
    }

    /// Runs a pass `f(potential, first node on the surface's grid, nodes)` over the chunks, as [`Reducer::run`], in
    /// pieces: all nodes of a piece face the surface, or none does.
    pub(crate) fn run<A: Parts<Part: Nodes>, S: Sums>(
        &self,
        reducer: &mut Reducer,
        chunks: A,
        f: impl Fn(&Self, usize, A::Part) -> S + Sync + Send,
    ) -> S {
        self.run_where(reducer, |_| true, chunks, f)
    }

    /// Runs a pass over the chunks with a `wanted` number, as [`Reducer::run_where`].
    pub(crate) fn run_where<A: Parts<Part: Nodes>, S: Sums>(
        &self,
        reducer: &mut Reducer,
        wanted: impl Fn(usize) -> bool + Sync + Send,
        chunks: A,
        f: impl Fn(&Self, usize, A::Part) -> S + Sync + Send,
    ) -> S {
        reducer.run_where(wanted, chunks, |first, chunk| match self.window {
            None => f(self, first, chunk),
            Some(window) => self.divide(window, first, chunk, &f),
        })
    }

    fn divide<N: Nodes, S: Sums>(
        &self,
        window: &Window,
        first: usize,
        chunk: N,
        f: &dyn Fn(&Self, usize, N) -> S,
    ) -> S {
        let (whole, nothing) = (Self { window: None, ..*self }, Self::nothing());
        let (mut total, mut rest) = (S::NONE, Some(chunk));
        let count = rest.as_ref().map_or(0, Nodes::count);
        for (len, node) in window.pieces(first..first + count) {
            let Some((piece, others)) = rest.take().map(|rest| rest.divide(len)) else { break };
            rest = Some(others);
            let (local, node) = node.map_or((&nothing, first), |node| (&whole, node));
            total = total.add(&f(local, node, piece).numbers());
        }
        total
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.hints.zero && !self.goes_below()
    }

    /// Whether the local energy of a node is linear along every step: there is no law, and steps end at its corners.
    pub(crate) fn is_straight(&self) -> bool {
        self.hints.zero && self.springs().is_none()
    }

    /// Whether the wall is a term of the energy, with gaps below zero.
    fn goes_below(&self) -> bool {
        self.wall.is_some_and(|wall| wall.goes_below())
    }

    fn springs(&self) -> Option<&'a dyn Springs<T>> {
        self.wall.and_then(|wall| wall.springs())
    }

    pub(crate) fn hardness(&self) -> Option<&'a Hardness> {
        self.wall.and_then(|wall| wall.hardness())
    }

    /// The caps on the contact pressure at so many nodes from `first` on: the hardness, or ∞ where nothing yields.
    pub(crate) fn caps(&self, first: usize, count: usize) -> [T; CHUNK] {
        self.hardness().map_or([T::infinity(); CHUNK], |hardness| hardness.caps(first, count))
    }

    pub(crate) fn is_surface(&self) -> bool {
        self.wall.is_some()
    }

    /// Whether the contact pressure is a function of the gap, by springs or by the law itself.
    pub(crate) fn is_soft(&self) -> bool {
        self.wall.is_some_and(|wall| wall.is_soft())
    }

    /// The stiffness with which springs, or a law that repels, hold nodes, and the largest load that pulls: springs
    /// bear no more than their pressure at rest.
    pub(crate) fn holds(&self, first: usize, gaps: &[T], slopes: &mut [T], limits: &mut [T]) {
        let Some(springs) = self.springs() else {
            self.law(Of::Slope, first, gaps, slopes);
            return limits.fill(T::infinity());
        };
        springs.evaluate(first, gaps, Values::tractions_and_slopes(limits, slopes));
        limits.iter_mut().for_each(|limit| *limit = (-*limit).max(T::zero()));
    }

    /// Whether steps end where the surfaces touch.
    pub(crate) fn projects(&self) -> bool {
        self.wall.is_some_and(|wall| wall.projects())
    }

    /// The gap of a node in contact with a wall, which is zero; −∞ where there is none.
    pub(crate) fn touching(&self) -> T {
        if self.projects() { T::zero() } else { T::neg_infinity() }
    }

    /// The least gap after a step: zero at a rigid wall. Where the law repels, a node lands at the gap of rest, where
    /// its repulsion begins, and keeps a part of its gap below it, if the law has no bound at zero gap.
    pub(crate) fn least(&self) -> Least<T> {
        match (self.wall, self.hints.rest) {
            (Some(Wall::Rigid | Wall::Capped(_)), _) => Least { rest: T::zero(), share: T::zero(), depth: T::zero() },
            (Some(Wall::None), Some(rest)) => {
                let bounded = self.law.energy(T::zero()).is_finite();
                let [share, depth] = if bounded { [T::zero(), T::infinity()] } else { [T::lit(HALF), T::zero()] };
                Least { rest, share, depth }
            }
            _ => Least::unbounded(),
        }
    }

    pub(crate) fn evaluate(&self, of: Of, first: usize, gaps: &[T], out: &mut [T]) {
        self.law(of, first, gaps, out);
        if let Some(hardness) = self.hardness() {
            return hardness.add(of as usize, first, gaps, out);
        }
        let Some(springs) = self.springs() else { return };
        let mut of_springs = [T::zero(); CHUNK];
        let of_springs = &mut of_springs[..gaps.len()];
        springs.evaluate(first, gaps, Values::one(of as usize, of_springs));
        out.iter_mut().zip(of_springs).for_each(|(out, of_springs)| *out += *of_springs);
    }

    /// The local tractions in a buffer of zeros.
    pub(crate) fn tractions<'b>(&self, first: usize, gaps: &[T], buffer: &'b mut [T; CHUNK]) -> &'b [T] {
        let tractions = &mut buffer[..gaps.len()];
        if !self.is_zero() {
            self.evaluate(Of::Traction, first, gaps, tractions);
        }
        tractions
    }

    /// Whether the tangent of the local energy is nowhere below it, along any step.
    pub(crate) fn is_concave(&self) -> bool {
        self.projects() && self.hints.concave
    }

    /// The energies of the law alone, and the tractions of law and constraint, at once.
    pub(crate) fn energies_and_tractions(&self, first: usize, gaps: &[T], energies: &mut [T], tractions: &mut [T]) {
        if !self.goes_below() {
            return self.law.evaluate(first, gaps, Values::energies_and_tractions(energies, tractions));
        }
        self.law(Of::Energy, first, gaps, energies);
        self.evaluate(Of::Traction, first, gaps, tractions);
    }

    pub(crate) fn tractions_and_slopes(&self, first: usize, gaps: &[T], tractions: &mut [T], slopes: &mut [T]) {
        if !self.goes_below() {
            return self.law.evaluate(first, gaps, Values::tractions_and_slopes(tractions, slopes));
        }
        self.evaluate(Of::Traction, first, gaps, tractions);
        self.evaluate(Of::Slope, first, gaps, slopes);
    }

    /// Values of the law alone, which continues to g < 0 as its tangent at g = 0.
    pub(crate) fn law(&self, of: Of, first: usize, gaps: &[T], out: &mut [T]) {
        if self.hints.zero {
            return out.fill(T::zero());
        }
        if !self.goes_below() || gaps.iter().all(|&gap| gap >= T::zero()) {
            return self.law.evaluate(first, gaps, Values::one(of as usize, out));
        }
        let (mut apart, mut at_contact) = ([T::zero(); CHUNK], [T::zero(); CHUNK]);
        let (apart, at_contact) = (&mut apart[..gaps.len()], &mut at_contact[..gaps.len()]);
        self.law.evaluate(first, apart, Values::one(1, at_contact));
        apart.iter_mut().zip(gaps).for_each(|(apart, &gap)| *apart = gap.max(T::zero()));
        self.law.evaluate(first, apart, Values::one(of as usize, out));
        let inside = out.iter_mut().zip(gaps).zip(at_contact).filter(|((_, gap), _)| **gap < T::zero());
        for ((out, &gap), &mut at_contact) in inside {
            match of {
                Of::Energy => *out += at_contact * gap,
                Of::Traction => {}
                Of::Slope => *out = T::zero(),
            }
        }
    }

    /// The tractions of the attraction alone.
    pub(crate) fn attractions(&self, first: usize, gaps: &[T], tractions: &[T], out: &mut [T]) {
        if self.goes_below() {
            self.law(Of::Traction, first, gaps, out);
        } else if self.is_soft() {
            out.iter_mut().zip(tractions).for_each(|(out, &t)| *out = t.max(T::zero()));
        } else {
            out.copy_from_slice(tractions);
        }
    }

    pub(crate) fn pressed(&self, first: usize, gaps: &[T], tractions: &[T]) -> Pressed {
        let mut found = Pressed::NONE;
        if let Some(hardness) = self.hardness() {
            let mut energies = [T::zero(); CHUNK];
            let energies = &mut energies[..gaps.len()];
            hardness.add(Of::Energy as usize, first, gaps, energies);
            return sums!([gaps, energies], [], |i| {} => Pressed {
                nodes: if gaps[i] <= T::zero() { 1.0 } else { 0.0 }, energy: energies[i].widen()
            });
        }
        let Some(springs) = self.springs() else {
            if self.is_soft() {
                found.nodes = tractions.iter().filter(|&&traction| traction < T::zero()).count() as f64;
            }
            return found;
        };
        let (mut energies, mut tractions) = ([T::zero(); CHUNK], [T::zero(); CHUNK]);
        let (energies, tractions) = (&mut energies[..gaps.len()], &mut tractions[..gaps.len()]);
        springs.evaluate(first, gaps, Values::energies_and_tractions(energies, tractions));
        for ((&gap, energy), traction) in gaps.iter().zip(energies).zip(tractions) {
            found.nodes += f64::from(u8::from(gap <= T::zero() || *traction < T::zero()));
            found.energy += energy.widen();
        }
        found
    }

    /// The contact pressures at gaps and full elastic pressures.
    pub(crate) fn contact_pressures(&self, first: usize, gaps: &[T], pressures: &[T], contact: &mut [T]) {
        if let Some(springs) = self.springs() {
            springs.evaluate(first, gaps, Values::one(Of::Traction as usize, contact));
            // from zero, as the negative of no traction is a negative zero
            return contact.iter_mut().for_each(|contact| *contact = T::zero() - *contact);
        }
        if !self.is_surface() {
            return contact.fill(T::zero());
        }
        self.law(Of::Traction, first, gaps, contact);
        if self.is_soft() {
            return contact.iter_mut().for_each(|contact| *contact = (-*contact).max(T::zero()));
        }
        let caps = self.caps(first, gaps.len());
        for (((contact, &gap), &p), cap) in contact.iter_mut().zip(gaps).zip(pressures).zip(caps) {
            *contact = if gap > T::zero() {
                T::zero()
            } else if gap < T::zero() {
                cap
            } else {
                (p + *contact).max(T::zero()).min(cap)
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Exponential, Penalty, Projection};

    #[test]
    fn springs_that_touch_nowhere_have_a_pressure_of_positive_zero() {
        let springs = Penalty::new(30.0).unwrap();
        let potential = Potential::new(&crate::NoAdhesion, &springs, None);
        let mut contact = [1.0; 3];
        potential.contact_pressures(0, &[-0.1, 0.0, 0.5], &[0.0; 3], &mut contact);
        assert_eq!(contact.map(f64::to_bits), [3.0_f64, 0.0, 0.0].map(f64::to_bits));
    }

    #[test]
    fn the_law_goes_on_as_its_tangent_into_interpenetration() {
        let (law, springs) = (Exponential::new(2.0, 0.5).unwrap(), Penalty::new(30.0).unwrap());
        let potential = Potential::new(&law, &springs, None);
        let gaps: Vec<f64> = (-20..=20).map(|i| 0.1 * f64::from(i) + 0.05).collect();
        let at = |of, shift: f64| {
            let gaps: Vec<f64> = gaps.iter().map(|g| g + shift).collect();
            let mut values = vec![0.0; gaps.len()];
            potential.evaluate(of, 0, &gaps, &mut values);
            values
        };
        let step = 1e-5;
        for (of, derivative) in [(Of::Energy, Of::Traction), (Of::Traction, Of::Slope)] {
            let (low, high, exact) = (at(of, -step), at(of, step), at(derivative, 0.0));
            for ((low, high), exact) in low.iter().zip(high).zip(exact) {
                assert!(((high - low) / (2.0 * step) - exact).abs() < 1e-6, "{low} {high} {exact}");
            }
        }
        let (mut law_alone, mut confined) = ([0.0; 3], [0.0; 2]);
        potential.law(Of::Energy, 0, &[-0.25, 0.0, 0.5], &mut law_alone);
        assert_eq!(law_alone, [-2.0 - 4.0 * 0.25, -2.0, -2.0 * (-1.0f64).exp()]);
        // where nothing interpenetrates, the law itself
        Potential::new(&law, &Projection, None).evaluate(Of::Energy, 0, &[0.0, 0.5], &mut confined);
        assert_eq!(confined, law_alone[1..]);
    }
}
