//! The outline of the contact: the line of its edge between the nodes.

use std::f64::consts::{E, PI};

use ndarray::ArrayView2;

use super::places::Places;
use crate::field::ordered;
use crate::grid::Grid;
use crate::real::Real;

/// κ: the gap of the next free node per pressure of the last node in contact, over Δ/E*.
const SOFTNESS: f64 = 2.0 * E / PI;

/// The edge beside the contour, the line on which the gap between two nodes vanishes.
#[derive(Clone, Copy)]
struct Contour {
    /// How far the edge is inside, in spacings: 1/4 − (1/4π) ∫₀^π ln(k(q) / sin(q/2)) / sin²(q/2) dq, with the stiffness k
    /// over E*/Δ of waves: |q|/2 in a periodic cell; for Love's kernel the inverse of the sum of 4 sin(q'/2)/(q'|q'|) over
    /// all q' = q + 2πm.
    shift: f64,
    /// How much less an edge along the diagonals lies inside, by plane waves and Hertz contacts.
    slant: f64,
    /// The area that a full turn of the edge adds, in cells; fitted to Hertz contacts with radii of 3 to 40 nodes.
    turn: f64,
}

const PERIODIC: Contour = Contour { shift: 0.190_009_285_9, slant: 0.0147, turn: 0.78 };
const FREE: Contour = Contour { shift: 0.174_653_2, ..PERIODIC };

/// A cell in the fixed-point numbers that are added up: the same sum in any order.
const CELL: f64 = (1_u64 << 30) as f64;

pub struct Outline<'a, T> {
    pub gap: ArrayView2<'a, T>,
    pub contact_pressure: ArrayView2<'a, T>,
    pub map: ArrayView2<'a, bool>,
    pub grid: &'a Grid,
    pub periodic: bool,
    pub modulus: f64,
}

pub struct Edge {
    /// the area of the nodes in contact beyond the area within the edge, in cells
    pub excess: f64,
    /// the neighbours between which the edge runs, and how many are at independent places
    pub edges: usize,
    pub places: f64,
}

struct Rule {
    /// gap per pressure along x and y
    compliances: [f64; 2],
    contour: Contour,
}

#[derive(Clone, Copy)]
struct Node {
    touches: bool,
    gap: f64,
    pressure: f64,
}

impl Node {
    fn of<T: Real>(touches: bool, gap: T, pressure: T) -> Self {
        Self { touches, gap: gap.widen(), pressure: pressure.widen() }
    }
}

/// Where the contour cuts the side between a node in contact and a node apart.
#[derive(Clone, Copy, Default)]
struct Cut {
    /// from the node in contact, in spacings
    place: f64,
    /// the same by pressure and gap alone
    told: f64,
    /// the share of the kink of a hard wall
    kink: f64,
}

impl<T: Real> Outline<'_, T> {
    pub(crate) fn edge(&self) -> Edge {
        let Self { gap, contact_pressure, map, grid, periodic, modulus } = self;
        let ((nx, columns), nodes) = (grid.shape(), ordered(*map));
        let (dx, dy) = grid.spacing();
        let step = Rule {
            compliances: [dx, dy].map(|spacing| SOFTNESS * spacing / modulus),
            contour: if *periodic { PERIODIC } else { FREE },
        };
        // whether the four nodes of a cell are not all of one kind
        let mut mixed = Vec::with_capacity(columns);
        let (mut excess, mut places) = (0_i64, Places::new());
        for i in (0..nx).filter(|i| *periodic || i + 1 < nx) {
            let below = (i + 1) % nx;
            let rows = [i, below].map(|row| (map.row(row), gap.row(row), contact_pressure.row(row)));
            let node = |row: usize, j: usize| Node::of(rows[row].0[j], rows[row].1[j], rows[row].2[j]);
            let [here, there] = [i, below].map(|row| &nodes[row * columns..][..columns]);
            if grid.is_line() {
                excess += fixed(step.of_side(node(0, 0), node(1, 0), &mut places));
                continue;
            }
            let cells = here.iter().zip(&here[1..]).zip(there.iter().zip(&there[1..]));
            mixed.clear();
            mixed.extend(cells.map(|((a, b), (c, d))| (a != b) | (a != c) | (a != d)));
            if *periodic {
                let last = columns - 1;
                mixed.push([here[0], there[0], there[last]].iter().any(|touches| *touches != here[last]));
            }
            for (j, _) in mixed.iter().enumerate().filter(|(_, mixed)| **mixed) {
                let next = (j + 1) % columns;
                let corners = [node(0, j), node(1, j), node(1, next), node(0, next)];
                excess += fixed(step.of_cell(corners, &mut places));
            }
        }
        Edge { excess: excess as f64 / CELL, edges: places.edges(), places: places.independent() }
    }
}

fn fixed(cells: f64) -> i64 {
    (CELL * cells).round() as i64
}

impl Rule {
    fn cut(&self, one: Node, other: Node, axis: usize) -> Cut {
        let (inside, outside) = if one.touches { (one, other) } else { (other, one) };
        let pressed = self.compliances[axis] * inside.pressure.max(0.0);
        // a wall that gives lets the surfaces interpenetrate, and a law alone keeps them apart
        let (below, above) = (-inside.gap.min(0.0), inside.gap.max(0.0));
        let (depth, opening) = (pressed + below, outside.gap - above);
        let hard = if pressed + below + above > 0.0 { pressed / (pressed + below + above) } else { 1.0 };
        let told = if depth + opening > 0.0 { (depth / (depth + opening)).clamp(0.0, 1.0) } else { 0.5 };
        let place = if above > 0.0 { hard * told + (1.0 - hard) * 0.5 } else { told };
        Cut { place, told, kink: hard * hard * hard }
    }

    /// The excess between two nodes of a line, with its place.
    fn of_side(&self, one: Node, other: Node, places: &mut Places) -> f64 {
        if one.touches == other.touches || one.gap.is_infinite() || other.gap.is_infinite() {
            return 0.0;
        }
        let Cut { place, told, kink } = self.cut(one, other, 0);
        places.add(told);
        0.5 - (place - self.contour.shift * kink)
    }

    /// The excess within the rectangle of four nodes, not all of one kind; the places are on the sides of the first.
    fn of_cell(&self, corners: [Node; 4], places: &mut Places) -> f64 {
        // where the surface ends there is nothing beyond its nodes
        if corners.iter().any(|corner| corner.gap.is_infinite()) {
            return 0.0;
        }
        let touches = |k: usize| corners[k % 4].touches;
        // between each corner and the next
        let sides: [Cut; 4] = std::array::from_fn(|k| match touches(k) == touches(k + 1) {
            true => Cut::default(),
            false => self.cut(corners[k], corners[(k + 1) % 4], k % 2),
        });
        [0, 3].into_iter().filter(|&k| touches(k) != touches(k + 1)).for_each(|k| places.add(sides[k].told));
        let around = |k: usize| [sides[(k + 3) % 4], sides[k]];
        let count = (0..4).filter(|&k| touches(k)).count();
        let area = match count {
            3 => 1.0 - (0..4).filter(|&k| !touches(k)).map(|k| self.free_corner(around(k))).sum::<f64>(),
            2 if touches(0) != touches(2) => {
                let first = usize::from(touches(0) == touches(1));
                self.band([sides[first], sides[first + 2]])
            }
            // corners of contact that meet across a diagonal are apart, as clusters are
            _ => (0..4).filter(|&k| touches(k)).map(|k| self.contact_corner(around(k))).sum(),
        };
        0.25 * count as f64 - area
    }

    /// The area around one node in contact, by the cuts of its two sides.
    fn contact_corner(&self, cuts: [Cut; 2]) -> f64 {
        let [p, q] = cuts.map(|cut| cut.place);
        0.5 * p * q - kink(cuts) * (self.strip(p, q) - 0.25 * self.contour.turn)
    }

    /// The area around one free node, by the cuts of its two sides.
    fn free_corner(&self, cuts: [Cut; 2]) -> f64 {
        let [p, q] = cuts.map(|cut| 1.0 - cut.place);
        0.5 * p * q + kink(cuts) * (self.strip(p, q) + 0.25 * self.contour.turn)
    }

    /// The area next to two nodes in contact, by the cuts of the two sides that leave them.
    fn band(&self, cuts: [Cut; 2]) -> f64 {
        let [p, q] = cuts.map(|cut| cut.place);
        0.5 * (p + q) - kink(cuts) * self.strip(1.0, p - q)
    }

    /// The area between the edge and a piece of the contour with these components.
    fn strip(&self, a: f64, b: f64) -> f64 {
        let length = (a * a + b * b).sqrt();
        let sine = if length > 0.0 { (2.0 * a * b).abs() / (length * length) } else { 0.0 };
        (self.contour.shift - self.contour.slant * sine * sine * sine) * length
    }
}

fn kink(cuts: [Cut; 2]) -> f64 {
    0.5 * (cuts[0].kink + cuts[1].kink)
}
