//! The least squares of a curve: what a contact predicts at its points, and the steps to the best parameters.

use crate::curve::{Curve, Fit, Parameters, Side, Sides};
use crate::tip::{Chain, Knot, Model};
use crate::ways::{Place, Way};

/// What a fit predicts, and room for it.
#[derive(Debug, Default)]
pub struct Prediction {
    /// loads at the points
    pub load: Vec<f64>,
    /// their derivatives by the parameters
    pub load_by: Vec<[f64; 4]>,
    /// how far the jumps of approach and withdrawal are off, as forces
    pub off: [f64; 2],
    /// their derivatives
    pub off_by: [[f64; 4]; 2],
    /// the knots of both ways, and the model and the shape to which they belong
    knots: [Vec<Knot>; 2],
    known: Option<(usize, f64)>,
    /// the force of their loads
    force: f64,
    pub(crate) ways: [Way; 2],
    rest: Vec<f64>,
}

/// The part of a variance from which on a fit is quick, and not exact.
const QUICK: f64 = 0.05;
const LOWEST: [f64; 4] = [-14.0, 1e-4, -400.0, f64::NEG_INFINITY];
const HIGHEST: [f64; 4] = [14.0, 50.0, 400.0, f64::INFINITY];
const LONGEST: [f64; 4] = [0.7, 1.0, 10.0, 1.0];

impl Prediction {
    /// The load at a place of a way.
    pub(crate) fn load_at(&self, way: usize, place: Place) -> f64 {
        let (a, b) = (self.knots[way][place.knot][1], self.knots[way][place.knot + 1][1]);
        self.force * (a + place.share * (b - a))
    }

    /// How much the load changes at the greatest jump.
    pub(crate) fn greatest_jump(&self) -> f64 {
        self.force * self.ways.iter().map(|way| way.size).fold(0.0, f64::max)
    }
}

impl Curve {
    /// The equilibria of parameters and the ways along them; the shift of the contact point.
    pub(crate) fn follow(&self, model: &Model, parameters: &Parameters, room: &mut Prediction) -> (f64, Scaled) {
        let (length, force, shape, chain) = self.scale.apply(self.contact(parameters));
        let known = Some((model.number(), shape));
        if room.known != known {
            model.at(shape, &mut room.knots);
            room.known = known;
        }
        room.force = force;
        let point = self.scales.point + self.scales.length * parameters.point;
        let (compliance, farthest) = (self.compliance * force, self.farthest - point);
        room.ways[0].follow(&room.knots[0], length, compliance, farthest, false);
        room.ways[1].follow(&room.knots[usize::from(model.has_two_ways())], length, compliance, farthest, true);
        (point, Scaled { length, force, chain })
    }

    /// What a fit predicts.
    pub fn predict(&self, model: &Model, parameters: &Parameters, sides: &Sides, room: &mut Prediction) {
        let shaped = model.shapes() > 1;
        let (point, scaled) = self.follow(model, parameters, room);
        let (points, two) = (self.z.len(), usize::from(model.has_two_ways()));
        room.load.resize(points, 0.0);
        room.load_by.resize(points, [0.0; 4]);
        let root = parameters.root_work;
        let by_root = 2.0 * root / (root * root + self.scales.floor);
        let c = self.compliance;
        let ends = [room.ways[0].end_position(), room.ways[1].end_position()];
        for (branch, order) in self.order.iter().enumerate() {
            let mut from = 0;
            for &i in order {
                let z = self.z[i] - point;
                let side = sides.sides.get(i).copied().unwrap_or(Side::Free);
                let mut way = branch;
                let other = match (side, ends) {
                    (Side::Apart, [Some(_), Some(last)]) if branch == 0 || z > last => Some((0, room.ways[0].apart(z))),
                    (Side::Contact, [Some(first), Some(_)]) if branch == 1 || z < first => {
                        Some((1, room.ways[1].contact(z)))
                    }
                    _ => None,
                };
                let place = match other {
                    Some((on, Some(place))) => {
                        way = on;
                        place
                    }
                    _ => room.ways[way].place(z, &mut from),
                };
                let knots = &room.knots[way * two];
                let (load, by) = scaled.at(knots, place, c, shaped);
                room.load[i] = load;
                room.load_by[i] = [by[0], by[1] * by_root, by[3] * self.scales.length, by[2]];
            }
        }
        for branch in 0..2 {
            let (seen, end) = (sides.seen[branch], room.ways[branch].end());
            (room.off[branch], room.off_by[branch]) = (0.0, [0.0; 4]);
            if let (true, Some(end)) = (seen.weight > 0.0, end) {
                let knot = &room.knots[branch * two][end];
                room.off[branch] = (point + room.ways[branch].positions[end] - seen.place) * seen.weight;
                let by = |parameter| {
                    let (approach, load) = scaled.moved(knot, parameter);
                    (approach + c * load) * seen.weight
                };
                room.off_by[branch] = [by(0), by(1) * by_root, self.scales.length * seen.weight, by(2)];
            }
        }
    }

    /// The variance of the logarithm of the Tabor parameter for residuals of variance one.
    pub(crate) fn variance_of_tabor(&self, model: &Model, fit: &Fit, room: &mut Prediction) -> f64 {
        let (_, normal, _) = self.equations(model, fit, room);
        solved(normal, [0.0, 0.0, 0.0, 1.0]).map_or(f64::INFINITY, |column| column[3].max(0.0))
    }

    /// Sum of squares, normal matrix and gradient of a fit.
    fn equations(&self, model: &Model, fit: &Fit, room: &mut Prediction) -> (f64, [[f64; 4]; 4], [f64; 4]) {
        self.predict(model, &fit.parameters, &fit.sides, room);
        let mut rest = std::mem::take(&mut room.rest);
        rest.clear();
        rest.extend(self.force.iter().zip(&room.load).map(|(force, load)| force - load));
        self.clear(&mut rest);
        let mut squares: f64 = rest.iter().map(|one| one * one).sum();
        let (mut normal, mut gradient) = ([[0.0; 4]; 4], [0.0; 4]);
        for (by, one) in room.load_by.iter().zip(&rest) {
            for j in 0..4 {
                gradient[j] += by[j] * one;
                for k in 0..=j {
                    normal[j][k] += by[j] * by[k];
                }
            }
        }
        for column in &self.baseline {
            let mut across = [0.0; 4];
            for (by, a) in room.load_by.iter().zip(column) {
                for j in 0..4 {
                    across[j] += by[j] * a;
                }
            }
            for j in 0..4 {
                for k in 0..=j {
                    normal[j][k] -= across[j] * across[k];
                }
            }
        }
        for (off, by) in room.off.iter().zip(&room.off_by) {
            squares += off * off;
            for j in 0..4 {
                gradient[j] -= by[j] * off;
                for k in 0..=j {
                    normal[j][k] += by[j] * by[k];
                }
            }
        }
        for j in 0..4 {
            if !fit.free[j] {
                gradient[j] = 0.0;
                normal[j] = [0.0; 4];
                normal.iter_mut().for_each(|row| row[j] = 0.0);
                normal[j][j] = 1.0;
            }
        }
        let lower = normal;
        for (k, row) in normal.iter_mut().enumerate() {
            row.iter_mut().enumerate().skip(k + 1).for_each(|(j, one)| *one = lower[j][k]);
        }
        room.rest = rest;
        (squares, normal, gradient)
    }

    /// Goes to the parameters of least squares near a fit, by the method of Levenberg and Marquardt.
    ///
    /// The last step changes the squares by less than a part of the variance of the noise.
    pub fn improve(&self, models: &[Model], fit: &mut Fit, part: f64, least: f64, room: &mut Prediction) {
        let model = &models[fit.model];
        let (mut squares, mut normal, mut gradient) = self.equations(model, fit, room);
        let mut damping = 1e-3;
        for _ in 0..if part < QUICK { 40 } else { 15 } {
            let mut damped = normal;
            (0..4).for_each(|j| damped[j][j] += damping * normal[j][j].max(f64::MIN_POSITIVE));
            let Some(mut step) = solved(damped, gradient) else { break };
            let gain: f64 = step.iter().zip(&gradient).map(|(a, b)| a * b).sum();
            let cut = step.iter().zip(LONGEST).map(|(one, most)| most / one.abs().max(f64::MIN_POSITIVE));
            let cut = cut.fold(1.0, f64::min);
            step.iter_mut().for_each(|one| *one *= cut);
            let old = fit.parameters.to_array();
            let new = |j: usize| (old[j] + step[j]).clamp(LOWEST[j], HIGHEST[j]);
            let mut trial = Fit { parameters: Parameters::from_array([new(0), new(1), new(2), new(3)]), ..fit.clone() };
            if fit.free[3] {
                let (low, high) = model.ends();
                trial.parameters.log_tabor = trial.parameters.log_tabor.clamp(low, high);
            }
            let found = self.equations(model, &trial, room);
            let small = gain < part * (squares / self.z.len() as f64).max(least * least);
            if found.0 <= squares {
                (squares, normal, gradient) = found;
                fit.parameters = trial.parameters;
                damping = (0.2 * damping).max(1e-9);
            } else {
                damping *= 5.0;
            }
            if small || damping > 1e6 {
                break;
            }
        }
        fit.squares = squares;
    }
}

/// The units of knots, and how they change.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scaled {
    length: f64,
    force: f64,
    chain: Chain,
}

impl Scaled {
    /// How approach and load of a knot change by a logarithm of the contact.
    fn moved(&self, knot: &Knot, by: usize) -> (f64, f64) {
        let (approach, load) = self.chain.moved(knot, by);
        (self.length * approach, self.force * load)
    }

    /// The load at a place, and its derivatives by the logarithms of modulus, work and Tabor parameter, and by the contact
    /// point; knots of several shapes change with these.
    fn at(&self, knots: &[Knot], place: Place, compliance: f64, shaped: bool) -> (f64, [f64; 4]) {
        let (a, b) = (&knots[place.knot], &knots[place.knot + 1]);
        let mixed = |i: usize| a[i] + place.share * (b[i] - a[i]);
        let rise = self.force * (b[1] - a[1]);
        let run = self.length * (b[0] - a[0]) + compliance * rise;
        let slope = if place.clamped || run == 0.0 { 0.0 } else { rise / run };
        let (approach, load) = (self.length * mixed(0), self.force * mixed(1));
        let chain = &self.chain;
        let held = 1.0 - slope * compliance;
        let mut by: [f64; 4] = [0, 1, 2, 3].map(|parameter| match parameter {
            3 => -slope,
            _ => held * chain.force[parameter] * load - slope * chain.length[parameter] * approach,
        });
        if shaped {
            let shape = held * self.force * mixed(3) - slope * self.length * mixed(2);
            by.iter_mut().zip(chain.shape).for_each(|(one, part)| *one += part * shape);
        }
        (load, by)
    }
}

/// The solution of a symmetric positive system, if it is one.
fn solved(mut matrix: [[f64; 4]; 4], mut right: [f64; 4]) -> Option<[f64; 4]> {
    let scale: [f64; 4] = std::array::from_fn(|j| matrix[j][j].sqrt());
    if scale.iter().any(|one| !(one.is_finite() && *one > 0.0)) {
        return None;
    }
    for j in 0..4 {
        right[j] /= scale[j];
        for k in 0..4 {
            matrix[j][k] /= scale[j] * scale[k];
        }
    }
    for j in 0..4 {
        for k in 0..j {
            let sum: f64 = (0..k).map(|l| matrix[j][l] * matrix[k][l]).sum();
            matrix[j][k] = (matrix[j][k] - sum) / matrix[k][k];
        }
        let sum: f64 = (0..j).map(|l| matrix[j][l] * matrix[j][l]).sum();
        matrix[j][j] = (matrix[j][j] - sum).max(1e-14).sqrt();
    }
    for j in 0..4 {
        let sum: f64 = (0..j).map(|l| matrix[j][l] * right[l]).sum();
        right[j] = (right[j] - sum) / matrix[j][j];
    }
    for j in (0..4).rev() {
        let sum: f64 = (j + 1..4).map(|l| matrix[l][j] * right[l]).sum();
        right[j] = (right[j] - sum) / matrix[j][j];
    }
    Some(std::array::from_fn(|j| right[j] / scale[j]))
}
