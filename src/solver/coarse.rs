//! The coarse space of a solve: when it is told where the contacts are.

use ndarray::{Array2, Axis};

use crate::elastic::{CoarseSpace, ElasticOperator};
use crate::par;
use crate::real::Real;

/// The dimension of the space over the cube root of the number of nodes: then its decomposition takes so many
/// operations for each node, a few hundredths of those of an iteration.
const DIMENSION: f64 = 4.0;

/// The stiffness of the contacts, over that of the stiffest wave.
const STIFFNESS: f64 = 0.085;

/// The stiffness of the mean gap without contacts, over that of the softest wave.
const MEAN: f64 = 1e-3;

/// The iterations after which the contact map is renewed first, and the ratio of one such interval to that before. Each
/// renewal changes the preconditioner, which costs some of the conjugacy of the steps.
const INTERVAL: f64 = 2.0;
const LONGER: f64 = 1.4;

/// The coarse space of a solve.
#[derive(Debug)]
pub(super) struct Coarse {
    space: CoarseSpace,
    /// the shares of contact in the blocks of the map
    contact: Vec<f64>,
    /// whether the space has a contact map
    ready: bool,
    /// the iteration of the next renewal
    due: usize,
    interval: f64,
}

impl Coarse {
    /// The coarse space of an operator, if it has one.
    pub(super) fn of<T: Real>(operator: &dyn ElasticOperator<T>) -> Option<Self> {
        let nodes = operator.grid().nodes() as f64;
        let space = operator.coarse_space((DIMENSION * nodes.cbrt()) as usize)?;
        let [_, blocks] = space.blocks();
        let contact = vec![0.0; blocks.0 * blocks.1];
        Some(Self { space, contact, ready: false, due: 0, interval: INTERVAL })
    }

    /// Whether the contact map is to be taken in an iteration; the first one waits until the contacts have settled.
    pub(super) fn is_due(&self, iteration: usize, settled: bool) -> bool {
        iteration >= self.due && (self.ready || settled)
    }

    /// Takes the contact map from a field, of which the nodes in contact are told by their values. `range` has the
    /// stiffness of the softest and the stiffest wave; with `held` the mean gap is given.
    pub(super) fn renew<T: Real>(
        &mut self,
        iteration: usize,
        field: &Array2<T>,
        touches: impl Fn(T) -> bool + Sync + Send,
        (softest, stiffest): (f64, f64),
        held: bool,
    ) {
        let contact = self.map(field, touches);
        self.ready = contact && self.space.renew(&self.contact, STIFFNESS * stiffest, MEAN * softest, held);
        if self.ready {
            self.due = iteration + self.interval as usize;
            self.interval *= LONGER;
        }
    }

    /// The space, if it has a contact map.
    pub(super) fn ready(&mut self) -> Option<&mut CoarseSpace> {
        self.ready.then_some(&mut self.space)
    }

    /// Puts the shares of contact into the blocks; returns whether some of the nodes touch, and some do not.
    fn map<T: Real>(&mut self, field: &Array2<T>, touches: impl Fn(T) -> bool + Sync + Send) -> bool {
        let [block, blocks] = self.space.blocks();
        let share = (field.len() as f64).recip();
        let rows = field.axis_chunks_iter(Axis(0), block.0);
        par::for_each(rows, par::chunks_mut(&mut self.contact, blocks.1), |nodes, contact| {
            contact.fill(0.0);
            for row in nodes.rows() {
                let row = row.to_slice().unwrap_or_default();
                for (contact, nodes) in contact.iter_mut().zip(row.chunks(block.1)) {
                    *contact += share * nodes.iter().filter(|&&node| touches(node)).count() as f64;
                }
            }
        });
        let total: f64 = self.contact.iter().sum();
        total > 0.0 && total < 1.0 - 0.5 * share
    }
}
