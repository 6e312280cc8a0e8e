//! The patches of a law that varies over the surface: the nodes of each work of adhesion.

use crate::adhesion::{AdhesionLaw, Values};
use crate::real::Real;

const MOST: usize = 16;

/// A patch of the surface: the nodes of one work of adhesion, wherever they are.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Patch {
    /// The work of adhesion of its nodes, energy per area.
    pub work_of_adhesion: f64,
    /// The share of all nodes that are its own.
    pub area_fraction: f64,
    /// The share of its own nodes that are in contact.
    pub contact_fraction: f64,
    /// The share of its own nodes that attract without being in contact.
    pub attractive_fraction: f64,
}

/// A work of adhesion, and its nodes: all, in contact, and attracting.
type Counts = (f64, [u64; 3]);

/// The patches by work of adhesion, from contact and attraction of each node, with nothing for absent nodes. `None` if
/// the law is the same everywhere, or of more than [`MOST`] works of adhesion.
pub(super) fn patches<T: Real>(
    law: &dyn AdhesionLaw<T>,
    nodes: impl ExactSizeIterator<Item = Option<[bool; 2]>>,
) -> Vec<Patch> {
    if law.hints().shape.is_none() {
        return Vec::new();
    }
    // where nothing presses them, the surfaces have given all of it up
    let gaps = vec![law.hints().rest.unwrap_or_else(T::zero); nodes.len()];
    let mut energies = vec![T::zero(); gaps.len()];
    law.evaluate(0, &gaps, Values::one(0, &mut energies));
    let mut counts: Vec<Counts> = Vec::new();
    for (energy, node) in energies.iter().zip(nodes) {
        let (Some([touches, attracts]), work) = (node, 0.0 - energy.widen()) else { continue };
        let at = counts.iter().position(|(other, _)| *other == work).unwrap_or(counts.len());
        if at == MOST {
            return Vec::new();
        }
        if at == counts.len() {
            counts.push((work, [0; 3]));
        }
        let more = [1, u64::from(touches), u64::from(attracts)];
        counts[at].1.iter_mut().zip(more).for_each(|(count, more)| *count += more);
    }
    counts.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let whole: u64 = counts.iter().map(|(_, [all, ..])| all).sum();
    let patch = |(work_of_adhesion, [all, contact, attracting]): Counts| {
        let share = |count: u64, of: u64| count as f64 / of as f64;
        let area_fraction = share(all, whole);
        let (contact_fraction, attractive_fraction) = (share(contact, all), share(attracting, all));
        Patch { work_of_adhesion, area_fraction, contact_fraction, attractive_fraction }
    };
    counts.into_iter().map(patch).collect()
}
