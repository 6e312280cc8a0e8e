//! The coarse space of a solve, and the iterations at which its map of the contacts is renewed.

use std::ops::Range;
use std::slice::Chunks;

use crate::degrees::HARDLY;
use crate::elastic::{CoarseSpace, ElasticOperator};
use crate::field::{CHUNK, Field};
use crate::grid::Grid;
use crate::par::{self, Parts};
use crate::real::Real;
use crate::vector::vectorised;

/// The dimension of the space over the cube root of the number of nodes: its decomposition takes a third of the cube,
/// 21 multiplications a node.
const DIMENSION: f64 = 4.0;

/// The stiffness of the contacts, over that which the surface meets as it is pressed flat: the best on any grid.
const STIFFNESS: f64 = 2.5;

/// The iterations before the first renewal of the contact map, which costs conjugacy, and the ratio of later intervals.
const INTERVAL: f64 = 2.0;
const LONGER: f64 = 1.4;

/// The contact of a block of nodes in whole numbers, exact in any order: the number of nodes, the sum of their places
/// along y, and both times the place along x.
type Count = [u64; 4];

#[derive(Debug)]
pub(crate) struct Coarse {
    space: CoarseSpace,
    grid: Grid,
    /// the shares of contact at the first nodes of the blocks
    contact: Vec<f64>,
    counts: Vec<Count>,
    ready: bool,
    due: usize,
    interval: f64,
}

impl Coarse {
    pub(crate) fn of<T: Real>(operator: &mut dyn ElasticOperator<T>) -> Option<Self> {
        let (grid, nodes) = (*operator.grid(), operator.grid().nodes() as f64);
        let space = operator.spectral()?.coarse_space((DIMENSION * nodes.cbrt()) as usize)?;
        let [_, blocks] = space.blocks();
        let (contact, counts) = (vec![0.0; blocks.0 * blocks.1], vec![Count::default(); blocks.0 * blocks.1]);
        Some(Self { space, grid, contact, counts, ready: false, due: 0, interval: INTERVAL })
    }

    /// Whether the contact map is to be taken; at first only when the contacts have settled.
    pub(crate) fn is_due(&self, iteration: usize, settled: bool) -> bool {
        iteration >= self.due && (self.ready || settled)
    }

    /// Takes the contact map from a field. `stiffness` resists the surface as it is pressed flat, `spring` belongs to a
    /// spring, `range` to the softest and stiffest wave; with `held` the mean gap is given.
    pub(crate) fn renew<T: Real>(
        &mut self,
        iteration: usize,
        field: &Field<T>,
        touches: impl Fn(usize, T) -> bool + Sync + Send,
        (stiffness, spring): (f64, f64),
        (softest, stiffest): (f64, f64),
        held: bool,
    ) {
        let contact = self.map(field, touches);
        let stiffness = (STIFFNESS * stiffness).max(softest).min(stiffest);
        // the mean gap without contacts
        self.ready = contact && self.space.renew(&self.contact, stiffness, HARDLY * softest + spring, held);
        if self.ready {
            self.due = iteration + self.interval as usize;
            self.interval *= LONGER;
        }
    }

    /// Forgets the contact map, as at the beginning of a solve.
    pub(crate) fn forget(&mut self) {
        (self.ready, self.due, self.interval) = (false, 0, INTERVAL);
    }

    pub(crate) fn ready(&mut self) -> Option<&mut CoarseSpace> {
        self.ready.then_some(&mut self.space)
    }

    /// Takes the contact map; returns whether some nodes touch and some do not. A node counts for its own block and the
    /// next by linear interpolation, for a map as symmetric as the surface.
    fn map<T: Real>(&mut self, field: &Field<T>, touches: impl Fn(usize, T) -> bool + Sync + Send) -> bool {
        let ([block, blocks], (nx, ny)) = (self.space.blocks(), self.grid.shape());
        let count = |nodes: &[T], from: usize, node: usize, counts: &mut [Count]| {
            for first in (0..ny).step_by(CHUNK) {
                let columns = first..ny.min(first + CHUNK);
                let (mut touching, mut along) = ([0; CHUNK], [0; CHUNK]);
                count_columns(nodes.chunks(ny), &columns, (&mut touching, &mut along), |k, value| {
                    touches(node + k, value)
                });
                for (b, counts) in (0..).zip(&mut *counts).take(columns.end.div_ceil(block.1)).skip(first / block.1) {
                    for k in columns.start.max(b * block.1)..columns.end.min((b + 1) * block.1) {
                        let [count, along] = [touching[k - first], along[k - first]].map(u64::from);
                        let (along, place) = (from as u64 * count + along, (k - b * block.1) as u64);
                        let more = [count, place * count, along, place * along];
                        counts.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
                    }
                }
            }
        };
        self.counts.fill(Count::default());
        let (rows, first) = (self.grid.rows(), self.grid.first_node());
        // the rest of a row of blocks that begins in the rows of another process
        let begun = rows.start % block.0;
        let (head, others) = field.nodes().split_at(((block.0 - begun) % block.0).min(rows.len()) * ny);
        let (before, after) = self.counts.split_at_mut(rows.start.div_ceil(block.0) * blocks.1);
        if let Some(counts) = before.len().checked_sub(blocks.1).and_then(|at| before.get_mut(at..)) {
            count(head, begun, first, counts);
        }
        par::for_each(par::chunks(others, block.0 * ny).zip(par::chunks_mut(after, blocks.1)), |i, (nodes, counts)| {
            count(nodes, 0, first + head.len() + i * block.0 * ny, counts);
        });
        self.grid.add_up(self.counts.as_flattened_mut());

        let share = (nx as f64 * ny as f64).recip();
        self.contact.fill(0.0);
        for (b, counts) in self.counts.chunks(blocks.1).enumerate() {
            let along = block.0.min(nx - b * block.0) as f64;
            let next = (b + 1) % blocks.0 * blocks.1;
            for (k, &[count, places, along_count, along_places]) in counts.iter().enumerate() {
                let across = block.1.min(ny - k * block.1) as f64;
                let [right, below_right] = [places, along_places].map(|places| places as f64 / across);
                let [left, below_left] = [count as f64 - right, along_count as f64 - below_right];
                for (k, whole, below) in [(k, left, below_left), ((k + 1) % blocks.1, right, below_right)] {
                    self.contact[b * blocks.1 + k] += share * (whole - below / along);
                    self.contact[next + k] += share * (below / along);
                }
            }
        }
        let total: f64 = self.contact.iter().sum();
        total > 0.0 && total < 1.0 - 0.5 * share
    }
}

/// Counts the nodes in contact in some columns of a few rows, and adds up the numbers of their rows.
fn count_columns<T: Real>(
    rows: Chunks<'_, T>,
    columns: &Range<usize>,
    (counts, along): (&mut [u32], &mut [u32]),
    touches: impl Fn(usize, T) -> bool,
) {
    vectorised(
        #[inline(always)]
        || {
            let mut first = columns.start;
            for (i, row) in (0..).zip(rows.clone()) {
                for (((&value, node), count), along) in
                    row[columns.clone()].iter().zip(first..).zip(&mut *counts).zip(&mut *along)
                {
                    let touches = touches(node, value);
                    *count += u32::from(touches);
                    *along += if touches { i } else { 0 };
                }
                first += row.len();
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::*;
    use crate::{Grid, Westergaard};

    #[test]
    fn a_map_has_all_of_the_contact_and_the_symmetries_of_the_field() {
        for shape in [(256, 128), (243, 75), (211, 131), (1000, 1), (50, 2500), (1, 5000)] {
            let mut operator = Westergaard::<f64>::new(Grid::new(shape, (1.0, 0.7)).unwrap(), 1.0).unwrap();
            let mut coarse = Coarse::of(&mut operator).unwrap();
            let [block, blocks] = coarse.space.blocks();
            assert!(block != (1, 1), "{shape:?}");
            let field = Field::from_fn(shape, |(i, j)| ((i * i + 3 * j + i * j * j) % 7) as f64);
            let touches = |_, value: f64| value < 2.0;
            let share = field.iter().filter(|&&value| touches(0, value)).count() as f64 / field.len() as f64;
            assert!(coarse.map(&field, touches));
            assert!((coarse.contact.iter().sum::<f64>() - share).abs() < 1e-14, "{shape:?}");
            if !shape.0.is_multiple_of(block.0) || !shape.1.is_multiple_of(block.1) {
                continue;
            }
            // mirrored at node 0, and moved by a block
            let map = Array2::from_shape_vec(blocks, coarse.contact.clone()).unwrap();
            let mirrored = |(i, j): (usize, usize), (nx, ny): (usize, usize)| [(nx - i) % nx, (ny - j) % ny];
            assert!(coarse.map(&Field::from_fn(shape, |node| field[mirrored(node, shape)]), touches));
            let expected = Array2::from_shape_fn(blocks, |node| map[mirrored(node, blocks)]);
            assert!(expected.iter().zip(&coarse.contact).all(|(a, b)| (a - b).abs() < 1e-15), "{shape:?}");
            let moved = Field::from_fn(shape, |(i, j)| field[[(i + block.0) % shape.0, j]]);
            assert!(coarse.map(&moved, touches));
            let expected = Array2::from_shape_fn(blocks, |(i, j)| map[[(i + 1) % blocks.0, j]]);
            assert!(expected.iter().zip(&coarse.contact).all(|(a, b)| (a - b).abs() < 1e-15), "{shape:?}");
        }
    }

    #[test]
    fn no_contact_and_nothing_but_contact_are_no_map() {
        let mut operator = Westergaard::<f64>::new(Grid::square(40, 1.0).unwrap(), 1.0).unwrap();
        let mut coarse = Coarse::of(&mut operator).unwrap();
        let mut field = Field::zeros((40, 40));
        assert!(!coarse.map(&field, |_, value| value > 0.0) && !coarse.map(&field, |_, value| value == 0.0));
        field.view_mut()[[7, 9]] = 1.0;
        assert!(coarse.map(&field, |_, value| value > 0.0) && coarse.map(&field, |_, value| value == 0.0));
    }
}
