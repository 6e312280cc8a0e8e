//! A law that attracts next to contacts alone.

use super::{AdhesionLaw, Hints, Values};
use crate::field::Field;
use crate::grid::Grid;
use crate::par;
use crate::real::Real;

/// The distance from a contact within which surfaces attract each other, in the larger spacing of the grid: the process
/// zone at the edge of a contact takes three nodes, and nodes at four spacings along a diagonal are four and a bit away.
const REACH: f64 = 4.2;

/// The nodes of a surface's grid that are within four nodes of a contact, or were: there surfaces attract each other in the
/// limit of no range, and nowhere else. Two bytes a node.
#[derive(Clone, Debug)]
pub(crate) struct Neighbourhood {
    grid: Grid,
    periodic: bool,
    near: Field<bool>,
    /// contacts with a neighbourhood that is taken in next
    pub(crate) contact: Field<bool>,
}

impl Neighbourhood {
    /// No node of a grid. Opposite sides meet if `periodic`.
    pub(crate) fn none(grid: &Grid, periodic: bool) -> Self {
        let [near, contact] = [(); 2].map(|()| Field::filled(grid.field_shape(), false));
        Self { grid: *grid, periodic, near, contact }
    }

    /// Whether each node is near a contact.
    pub(crate) fn near(&self) -> &Field<bool> {
        &self.near
    }

    /// Takes in nodes that were near contacts.
    pub(crate) fn add(&mut self, near: &Field<bool>) {
        self.near.nodes_mut().iter_mut().zip(near.nodes()).for_each(|(own, &near)| *own |= near);
    }

    /// Leaves out the [contacts](Self::contact) that are not near others.
    pub(crate) fn confine(&mut self) {
        self.contact.nodes_mut().iter_mut().zip(self.near.nodes()).for_each(|(contact, &near)| *contact &= near);
    }

    /// Whether [contacts](Self::contact) are not near others. All processes have to call it.
    pub(crate) fn has_others(&self) -> bool {
        let others = self.contact.nodes().iter().zip(self.near.nodes()).any(|(&contact, &near)| contact && !near);
        self.grid.any(others)
    }

    /// The node of the whole grid that is the first of its rows.
    pub(crate) fn first_node(&self) -> usize {
        self.grid.first_node()
    }

    /// Takes in the nodes next to the [contacts](Self::contact); whether any of them is new. All processes have to call it.
    pub(crate) fn grow(&mut self) -> bool {
        let Self { grid, periodic, near, contact } = self;
        let ((nx, ny), (dx, dy), periodic) = (grid.shape(), grid.spacing(), *periodic);
        let reach = REACH * grid.largest_spacing();
        // how far it extends along the row of a contact, and along the rows beside that
        let half_chord = |away: usize| (reach.powi(2) - (away as f64 * dx).powi(2)).sqrt() / dy;
        let widths = (0..nx).map(half_chord).take_while(|width| width.is_finite()).map(|width| width as usize);
        let widths: Vec<usize> = widths.collect();
        let beside = |row: usize| {
            let inside = move |&(other, _): &(usize, usize)| periodic || other < nx;
            let ahead = widths.iter().enumerate().map(move |(away, &width)| (row + away, width)).filter(inside);
            let behind = widths.iter().enumerate().skip(1).filter(move |(away, _)| periodic || *away <= row);
            ahead.chain(behind.map(move |(away, &width)| (row + nx - away, width))).map(move |(row, w)| (row % nx, w))
        };
        let rows = grid.rows_for(contact.view(), grid, |row| beside(row).map(|(other, _)| other));
        let start = grid.rows().start;
        let mut news = vec![false; near.nrows()];
        par::update(par::chunks_mut(near.nodes_mut(), ny), &mut news, |i, near, is_new| {
            for (other, width) in beside(start + i) {
                let contact = rows.row(other);
                if let Some(contact) = contact.to_slice().filter(|contact| contact.contains(&true)) {
                    *is_new |= widen(contact, width, periodic, near);
                }
            }
        });
        grid.any(news.contains(&true))
    }
}

/// Takes in the nodes of a row that are at most so many nodes from a contact of another row; whether any of them is new.
fn widen(contact: &[bool], width: usize, periodic: bool, near: &mut [bool]) -> bool {
    let n = contact.len();
    let take_in = |near: &mut [bool], contact: &[bool]| {
        near.iter_mut().zip(contact).fold(false, |is_new, (near, &contact)| {
            let adds = contact & !*near;
            *near |= contact;
            is_new | adds
        })
    };
    let mut is_new = take_in(near, contact);
    for shift in 1..=width.min(n - 1) {
        let (front, back) = contact.split_at(n - shift);
        is_new |= take_in(&mut near[shift..], front);
        is_new |= take_in(&mut near[..n - shift], &contact[shift..]);
        if periodic {
            is_new |= take_in(&mut near[..shift], back);
            is_new |= take_in(&mut near[n - shift..], &contact[..shift]);
        }
    }
    is_new
}

/// A law that attracts in a neighbourhood of contacts alone.
pub(crate) struct Touched<'a, T> {
    pub(crate) law: &'a dyn AdhesionLaw<T>,
    pub(crate) neighbourhood: Neighbourhood,
}

impl<T: Real> Touched<'_, T> {
    /// Whether each of the nodes is near a contact.
    fn near(&self, first: usize, gaps: &[T]) -> &[bool] {
        &self.neighbourhood.near.nodes()[first - self.neighbourhood.first_node()..][..gaps.len()]
    }

    /// Sets the values of nodes that are not near a contact to zero.
    fn confine(&self, first: usize, gaps: &[T], values: &mut [T]) {
        for (value, &near) in values.iter_mut().zip(self.near(first, gaps)) {
            *value = if near { *value } else { T::zero() };
        }
    }
}

impl<T: Real> AdhesionLaw<T> for Touched<'_, T> {
    fn energy(&self, gap: T) -> T {
        self.law.energy(gap)
    }
    fn traction(&self, gap: T) -> T {
        self.law.traction(gap)
    }
    fn slope(&self, gap: T) -> T {
        self.law.slope(gap)
    }
    fn hints(&self) -> Hints<T> {
        self.law.hints()
    }
    fn evaluate(&self, first: usize, gaps: &[T], mut values: Values<'_, T>) {
        if self.near(first, gaps).contains(&true) {
            self.law.evaluate(first, gaps, values.reborrow());
        }
        values.each(|_, values| self.confine(first, gaps, values));
    }
    fn contact_shares(&self, first: usize, gaps: &[T], shares: &mut [T]) {
        self.law.contact_shares(first, gaps, shares);
        self.confine(first, gaps, shares);
    }
}

/// A law with a share of its work of adhesion, and the same range.
pub(crate) struct Weakened<'a, T> {
    pub(crate) law: &'a dyn AdhesionLaw<T>,
    pub(crate) share: T,
}

impl<T: Real> AdhesionLaw<T> for Weakened<'_, T> {
    fn energy(&self, gap: T) -> T {
        self.share * self.law.energy(gap)
    }
    fn traction(&self, gap: T) -> T {
        self.share * self.law.traction(gap)
    }
    fn slope(&self, gap: T) -> T {
        self.share * self.law.slope(gap)
    }
    fn hints(&self) -> Hints<T> {
        let hints = self.law.hints();
        Hints { work_of_adhesion: self.share * hints.work_of_adhesion, ..hints }
    }
    fn evaluate(&self, first: usize, gaps: &[T], mut values: Values<'_, T>) {
        self.law.evaluate(first, gaps, values.reborrow());
        values.each(|_, values| values.iter_mut().for_each(|value| *value *= self.share));
    }
    fn contact_shares(&self, first: usize, gaps: &[T], shares: &mut [T]) {
        self.law.contact_shares(first, gaps, shares);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_neighbourhood_is_a_disc_about_each_contact() {
        for (shape, lengths) in
            [((16, 20), (16.0, 20.0)), ((9, 7), (9.0, 7.0)), ((32, 1), (32.0, 1.0)), ((12, 30), (12.0, 15.0))]
        {
            let grid = Grid::new(shape, lengths).unwrap();
            for periodic in [true, false] {
                let contacts = [(0, 0), (shape.0 / 2, shape.1 / 3), (shape.0 - 1, shape.1 - 1)];
                let mut found = Neighbourhood::none(&grid, periodic);
                contacts.iter().for_each(|&(i, j)| found.contact.view_mut()[[i, j]] = true);
                assert!(found.grow() && !found.grow());
                let away = |a: usize, b: usize, n: usize| {
                    let distance = a.abs_diff(b);
                    if periodic { distance.min(n - distance) } else { distance }
                };
                let (dx, dy) = grid.spacing();
                for ((i, j), &near) in found.near.indexed_iter() {
                    let distance = |&(k, l): &(usize, usize)| {
                        (away(i, k, shape.0) as f64 * dx).hypot(away(j, l, shape.1) as f64 * dy)
                            / grid.largest_spacing()
                    };
                    assert_eq!(near, contacts.iter().any(|contact| distance(contact) <= REACH), "{i} {j} {periodic}");
                }
            }
        }
    }
}
