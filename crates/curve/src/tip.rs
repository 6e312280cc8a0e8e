//! Equilibria of a tip: approaches and loads at knots, over modulus, work of adhesion and Tabor parameter.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Approach, load, and their derivatives by the shape of the branch.
pub type Knot = [f64; 4];

/// How equilibria scale.
#[derive(Clone, Copy, Debug)]
pub enum Scale {
    /// A paraboloid of this radius R: lengths as (w²R/E*²)^(1/3), forces as wR, and a shape by the logarithm of the Tabor
    /// parameter.
    Paraboloid(f64),
    /// Any tip in lengths of its own: forces as E*, and a shape by the root (w/E*/r)^(1/3) for this greatest ratio r.
    Table(f64),
}

/// Equilibria of a model at some shapes, between which cubics interpolate.
#[derive(Clone, Debug)]
pub struct Model {
    shapes: Vec<f64>,
    /// for each shape the knots of the approach, from bodies apart on
    approach: Vec<Vec<Knot>>,
    /// for each shape the knots of the withdrawal; none where it goes along the same equilibria
    withdrawal: Vec<Vec<Knot>>,
    /// which of all models it is
    number: usize,
}

/// The number of models that were made.
static MADE: AtomicUsize = AtomicUsize::new(0);

/// What a contact has, in logarithms.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// logarithm of the contact modulus
    pub modulus: f64,
    /// logarithm of the work of adhesion
    pub work: f64,
    /// logarithm of the Tabor parameter
    pub tabor: f64,
}

/// Derivatives of the logarithms of length and force, and of the shape, by the logarithms of a contact.
#[derive(Clone, Copy, Debug)]
pub struct Chain {
    /// of the length
    pub length: [f64; 3],
    /// of the force
    pub force: [f64; 3],
    /// of the shape
    pub shape: [f64; 3],
}

impl Chain {
    /// How approach and load of a knot change by a logarithm of the contact.
    #[must_use]
    pub fn moved(&self, knot: &Knot, by: usize) -> (f64, f64) {
        let [approach, load, approach_by, load_by] = *knot;
        let shape = self.shape[by];
        (self.length[by] * approach + shape * approach_by, self.force[by] * load + shape * load_by)
    }
}

impl Scale {
    /// Length, force and shape of a contact, and how they change.
    #[must_use]
    pub fn apply(&self, contact: Contact) -> (f64, f64, f64, Chain) {
        let third = 1.0 / 3.0;
        match *self {
            Self::Paraboloid(radius) => {
                let length = (third * (2.0 * (contact.work - contact.modulus) + radius.ln())).exp();
                let force = contact.work.exp() * radius;
                let chain =
                    Chain { length: [-2.0 * third, 2.0 * third, 0.0], force: [0.0, 1.0, 0.0], shape: [0.0, 0.0, 1.0] };
                (length, force, contact.tabor, chain)
            }
            Self::Table(ratio) => {
                let root = (third * (contact.work - contact.modulus - ratio.ln())).exp();
                let shape = [-third * root, third * root, 0.0];
                let chain = Chain { length: [0.0; 3], force: [1.0, 0.0, 0.0], shape };
                (1.0, contact.modulus.exp(), root, chain)
            }
        }
    }
}

impl Model {
    /// Equilibria at shapes that grow: knots of the approach, and of the withdrawal unless it is the same, for each shape
    /// as many.
    ///
    /// # Errors
    /// If the numbers of shapes or knots differ, or are too few.
    pub fn new(shapes: Vec<f64>, approach: Vec<Vec<Knot>>, withdrawal: Vec<Vec<Knot>>) -> Result<Self, &'static str> {
        let even = |way: &[Vec<Knot>]| {
            way.len() == shapes.len() && way.iter().all(|row| row.len() == way[0].len() && row.len() > 2)
        };
        if shapes.is_empty() || !even(&approach) || !(withdrawal.is_empty() || even(&withdrawal)) {
            return Err("a table of equilibria needs as many knots, three or more, at each shape");
        }
        Ok(Self { shapes, approach, withdrawal, number: MADE.fetch_add(1, Ordering::Relaxed) })
    }

    /// Whether the withdrawal has equilibria of its own.
    #[must_use]
    pub fn has_two_ways(&self) -> bool {
        !self.withdrawal.is_empty()
    }

    /// Which of all models it is.
    pub(crate) fn number(&self) -> usize {
        self.number
    }

    /// The number of shapes.
    pub(crate) fn shapes(&self) -> usize {
        self.shapes.len()
    }

    /// The first and the last shape.
    pub(crate) fn ends(&self) -> (f64, f64) {
        (self.shapes[0], self.shapes[self.shapes.len() - 1])
    }

    /// The knots of both ways at a shape.
    pub(crate) fn at(&self, shape: f64, ways: &mut [Vec<Knot>; 2]) {
        let last = self.shapes.len() - 1;
        let shape = shape.clamp(self.shapes[0], self.shapes[last]);
        let k = self.shapes.partition_point(|&knot| knot < shape).clamp(usize::from(last > 0), last);
        for (way, found) in [&self.approach, &self.withdrawal].into_iter().zip(ways) {
            found.clear();
            if way.is_empty() {
                continue;
            }
            if last == 0 || self.shapes[k] == shape {
                found.extend_from_slice(&way[k]);
                continue;
            }
            // of Hermite
            let width = self.shapes[k] - self.shapes[k - 1];
            let t = (shape - self.shapes[k - 1]) / width;
            let (t2, u) = (t * t, 1.0 - t);
            let values = [(1.0 + 2.0 * t) * u * u, t2 * (3.0 - 2.0 * t), width * t * u * u, -width * t2 * u];
            let rates = [-6.0 * t * u / width, 6.0 * t * u / width, u * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)];
            let mixed = |weights: &[f64; 4], a: &Knot, b: &Knot, i: usize| {
                weights[0] * a[i] + weights[1] * b[i] + weights[2] * a[i + 2] + weights[3] * b[i + 2]
            };
            found.extend(way[k - 1].iter().zip(&way[k]).map(|(a, b)| {
                [mixed(&values, a, b, 0), mixed(&values, a, b, 1), mixed(&rates, a, b, 0), mixed(&rates, a, b, 1)]
            }));
        }
    }
}
