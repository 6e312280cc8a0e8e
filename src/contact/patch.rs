//! The patches of a law that varies over the surface: the nodes of each work of adhesion.

use crate::adhesion::AdhesionLaw;
use crate::real::Real;

/// The largest number of works of adhesion that are told apart.
const MOST: usize = 16;

/// A patch of the surface: the nodes of one work of adhesion, wherever they are.
///
/// [`ContactStatistics::patches`](super::ContactStatistics::patches) has an example.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
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

/// The patches, by their work of adhesion, of nodes of which is told whether they are in contact and whether they
/// attract, and nothing of absent ones. None if the law is the same everywhere, or of too many works of adhesion.
pub(super) fn patches<T: Real>(
    law: &impl AdhesionLaw<T>,
    nodes: impl ExactSizeIterator<Item = Option<[bool; 2]>>,
) -> Vec<Patch> {
    if law.shape().is_none() {
        return Vec::new();
    }
    // where nothing presses them, the surfaces have given all of it up
    let gaps = vec![law.rest().unwrap_or_else(T::zero); nodes.len()];
    let mut energies = vec![T::zero(); gaps.len()];
    law.energies(0, &gaps, &mut energies);
    let mut counts: Vec<(f64, [usize; 3])> = Vec::new();
    for (energy, node) in energies.iter().zip(nodes) {
        let (Some([touches, attracts]), work) = (node, 0.0 - energy.widen()) else { continue };
        let at = counts.iter().position(|(other, _)| *other == work).unwrap_or(counts.len());
        if at == MOST {
            return Vec::new();
        }
        if at == counts.len() {
            counts.push((work, [0; 3]));
        }
        let (_, [all, contact, attracting]) = &mut counts[at];
        *all += 1;
        *contact += usize::from(touches);
        *attracting += usize::from(attracts);
    }
    counts.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let whole: usize = counts.iter().map(|(_, [all, ..])| all).sum();
    let patch = |(work_of_adhesion, [all, contact, attracting]): (f64, [usize; 3])| {
        let share = |count: usize, of: usize| count as f64 / of as f64;
        let area_fraction = share(all, whole);
        let (contact_fraction, attractive_fraction) = (share(contact, all), share(attracting, all));
        Patch { work_of_adhesion, area_fraction, contact_fraction, attractive_fraction }
    };
    counts.into_iter().map(patch).collect()
}
