//! The coarse space of a solve: when it is told where the contacts are.

use ndarray::{Array2, Axis};

use super::passes::idles;
use super::state::State;
use crate::elastic::{CoarseSpace, ElasticOperator};
use crate::par;
use crate::real::Real;

/// The dimension of the space over the cube root of the number of nodes: then its decomposition takes so many operations
/// for each node, a few hundredths of those of an iteration.
const DIMENSION: f64 = 4.0;

/// The stiffness of the contacts, over that of the stiffest wave.
const STIFFNESS: f64 = 0.085;

/// The stiffness of the mean gap without contacts, over that of the softest wave.
const MEAN: f64 = 1e-3;

/// The iterations from a far start under a given pressure before the space is used, and the error of the load above which
/// the contact map is not yet that of the solution.
const START: usize = 3;
const LOADED: f64 = 0.3;

/// The relative error above which the contact map is not yet that of the solution with adhesion.
const SETTLED: f64 = 0.1;

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

    /// The space, if it has a contact map.
    pub(super) fn ready(&mut self) -> Option<&mut CoarseSpace> {
        self.ready.then_some(&mut self.space)
    }

    /// Takes the contact map from a field of which some nodes are in contact.
    fn map<T: Real>(&mut self, field: &Array2<T>, touches: impl Fn(T) -> bool + Sync + Send) {
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
    }
}

impl<T: Real> State<'_, T> {
    /// Whether the contacts are where they will be, but for some nodes.
    fn is_settled(&self) -> bool {
        let loaded = self.near || self.is_gap_controlled() || (self.iterations >= START && self.load_error() <= LOADED);
        loaded && (self.law.is_zero() || self.relative_error() <= SETTLED)
    }

    /// Tells the coarse space where the contacts are, now and then: the nodes outside of the working set, or those that
    /// springs hold.
    pub(super) fn renew_coarse(&mut self) {
        let (settled, projects) = (self.is_settled(), self.projects());
        let (softest, stiffest) = self.operator.stiffness_range();
        let held = self.is_gap_controlled();
        let Self { coarse, fields, iterations, residual, .. } = self;
        let Some(coarse) = coarse else { return };
        if *iterations < coarse.due || !(coarse.ready || settled) {
            return;
        }
        if projects {
            coarse.map(&fields.residual, idles);
        } else {
            coarse.map(&fields.gap, |gap| gap <= T::zero());
        }
        let touches = coarse.contact.iter().any(|&share| share > 0.0) && residual.working > 0.0;
        coarse.ready = touches && coarse.space.renew(&coarse.contact, STIFFNESS * stiffest, MEAN * softest, held);
        if coarse.ready {
            coarse.due = *iterations + coarse.interval as usize;
            coarse.interval *= LONGER;
        }
    }
}
