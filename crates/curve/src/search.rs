//! The search for the best fits of all models.

use crate::curve::{Curve, Fit, Parameters, Sides};
use crate::squares::Prediction;
use crate::tip::Model;

/// The most points by which fits choose their beginnings.
const FEW: usize = 150;
/// Of so many fits along the Tabor parameter one has a beginning of its own.
const NEIGHBOURS: usize = 8;
/// The most rounds in which fits take their own jumps, and jumps of their neighbours.
const ROUNDS: usize = 4;
/// The parts of a variance of the noise that the last step of a fit may change: on the way, and in the end.
const ROUGH: f64 = 0.1;
const FINE: f64 = 1e-2;
/// Fits that are worse by so many variances of the noise are not likely, whatever their last digits.
const FAR: f64 = 60.0;
/// Squares over the squares of the best fit, behind which neighbours learn nothing from a fit.
const WORSE: f64 = 4.0;
/// The width of a likelihood over the logarithm of the Tabor parameter for which the rows are close enough.
const WIDE: f64 = 1.0;
/// Places about the best Tabor parameter at which the likelihood is asked, in deviations.
const AROUND: [f64; 4] = [0.75, 1.5, 2.25, 3.0];

/// What is searched for.
#[derive(Clone, Debug)]
pub struct Search<'a> {
    /// the models
    pub models: &'a [Model],
    /// the models of the fits and their logarithms of the Tabor parameter, by models, in order
    pub rows: Vec<(usize, f64)>,
    /// for each model whether its work of adhesion varies
    pub adheres: Vec<bool>,
    /// the model with a Tabor parameter that varies, if there is one
    pub full: Option<usize>,
    /// logarithms of moduli, over their scale, to begin with, and the contact points to each, in their scale
    pub begins: Vec<(f64, f64)>,
    /// whether the places of jumps count
    pub jumps: bool,
    /// the least residual that counts
    pub least: f64,
}

impl Search<'_> {
    /// The best fits of a curve, in the order of the rows, with others at more Tabor parameters among the rows of the
    /// full model.
    #[must_use]
    pub fn search(&self, curve: &Curve) -> Vec<Fit> {
        let mut room = Prediction::default();
        let (few, steps) = (curve.thinned(FEW), curve.steps(self.least));
        let mut fits: Vec<Fit> = Vec::with_capacity(self.rows.len());
        for (k, &(model, log_tabor)) in self.rows.iter().enumerate() {
            // neighbours along the Tabor parameter begin with the parameters of the last
            let begins = match fits.last() {
                Some(last) if k % NEIGHBOURS != 0 && last.model == model => vec![last.parameters],
                _ => self.begun(&few, model, log_tabor, &fits, steps.is_some(), &mut room),
            };
            let begins = begins.into_iter().map(|parameters| {
                let free = [true, self.adheres[model], true, false];
                let parameters = Parameters { log_tabor, ..parameters };
                self.begin(
                    curve,
                    Fit { model, parameters, free, sides: Sides::default(), squares: 0.0 },
                    &steps,
                    &mut room,
                )
            });
            fits.extend(begins.reduce(|a, b| if b.squares < a.squares { b } else { a }));
        }
        // the first noise is one of neighbours, which a steep curve has, too
        let mut curve = curve.clone();
        for round in 0..ROUNDS {
            let noise = curve.noise_of(fits.iter());
            let changed = (noise / curve.noise - 1.0).abs() > 0.1;
            curve.noise = noise;
            if changed {
                fits.iter_mut().for_each(|fit| self.settle(&curve, fit, ROUGH, &mut room));
            }
            if !self.pass_on(&curve, &mut fits, &mut room) && round > 0 {
                break;
            }
        }
        let mut best = self.freed(&curve, &fits, &mut room);
        for _ in 0..ROUNDS {
            let noise = curve.noise_of(fits.iter().chain(&best));
            let changed = (noise / curve.noise - 1.0).abs() > 0.05;
            curve.noise = noise;
            let Some(best) = best.as_mut().filter(|_| changed) else { break };
            self.settle(&curve, best, FINE, &mut room);
        }
        let least = fits.iter().chain(&best).map(|fit| fit.squares).fold(f64::INFINITY, f64::min);
        let known = least + FAR * curve.noise.max(self.least).powi(2);
        for fit in fits.iter_mut().filter(|fit| !fit.free[1] || fit.squares < known) {
            self.settle(&curve, fit, FINE, &mut room);
        }
        if let Some(best) = best {
            self.surround(&curve, &mut fits, best, &mut room);
        }
        fits
    }

    /// Parameters to begin with, by the squares of some points over moduli and contact points that fit each: the best,
    /// and the softest of parameters that fit about as well, as a soft spring hardly tells a hard contact from a rigid
    /// contact; and parameters of a fit without adhesion.
    fn begun(
        &self,
        few: &Curve,
        model: usize,
        log_tabor: f64,
        fits: &[Fit],
        jumps: bool,
        room: &mut Prediction,
    ) -> Vec<Parameters> {
        let trials: Vec<(f64, Parameters)> = self
            .begins
            .iter()
            .map(|&(log_modulus, point)| {
                let parameters = Parameters { log_modulus, root_work: 1.0, point, log_tabor };
                (few.squares(&self.models[model], &parameters, room), parameters)
            })
            .collect();
        let Some(best) = trials.iter().min_by(|a, b| a.0.total_cmp(&b.0)) else { return Vec::new() };
        let mut found = vec![best.1];
        found.extend(
            trials.iter().find(|trial| trial.0 < 2.0 * best.0).map(|trial| trial.1).filter(|one| *one != best.1),
        );
        let bare = fits.iter().find(|fit| !fit.free[1] && self.adheres[model] && !jumps);
        found.extend(bare.map(|fit| Parameters { root_work: 0.3, ..fit.parameters }));
        found
    }

    /// Goes to the least squares from parameters on, with the steps of the force as jumps, or without.
    fn begin(&self, curve: &Curve, fit: Fit, steps: &Option<Sides>, room: &mut Prediction) -> Fit {
        let mut found = fit.clone();
        if let (Some(sides), true) = (steps, fit.free[1]) {
            found.sides = sides.clone();
            self.settle(curve, &mut found, ROUGH, room);
            if !found.sides.sides.is_empty() {
                return found;
            }
        }
        // a step that is no jump of the fit, or not a clear one
        let mut other = fit;
        self.settle(curve, &mut other, ROUGH, room);
        if found.sides == other.sides && found.squares > 0.0 && found.squares < other.squares { found } else { other }
    }

    /// Goes to the least squares, with the fit's own jumps.
    fn settle(&self, curve: &Curve, fit: &mut Fit, part: f64, room: &mut Prediction) {
        curve.improve(self.models, fit, part, self.least, room);
        if !fit.free[1] {
            return;
        }
        for _ in 0..ROUNDS {
            let sides = curve.own_sides(&self.models[fit.model], fit, self.jumps, self.least, room);
            let near = |a: f64, b: f64| (a - b).abs() <= 0.05 * b;
            let weighed = sides.seen.iter().zip(&fit.sides.seen).all(|(a, b)| near(a.weight, b.weight));
            if weighed && sides.sides == fit.sides.sides {
                break;
            }
            fit.sides = sides;
            curve.improve(self.models, fit, part, self.least, room);
        }
    }

    /// Begins fits anew with the parameters of better neighbours; whether any is better for it.
    fn pass_on(&self, curve: &Curve, fits: &mut [Fit], room: &mut Prediction) -> bool {
        let unit = curve.noise.max(self.least).powi(2);
        let adheres: Vec<usize> = (0..fits.len()).filter(|&k| fits[k].free[1]).collect();
        let mut gained = false;
        let least = fits.iter().map(|fit| fit.squares).fold(f64::INFINITY, f64::min);
        let pairs = adheres.windows(2).map(|pair| (pair[0], pair[1]));
        let pairs: Vec<_> = pairs.clone().chain(pairs.rev().map(|(a, b)| (b, a))).collect();
        for (from, to) in pairs {
            if fits[from].squares < fits[to].squares - unit && fits[from].squares < WORSE * least {
                let mut trial = fits[to].clone();
                trial.parameters = Parameters { log_tabor: trial.parameters.log_tabor, ..fits[from].parameters };
                trial.sides = fits[from].sides.clone();
                self.settle(curve, &mut trial, ROUGH, room);
                gained |= trial.squares < fits[to].squares - 0.1 * unit;
                take_better(&mut fits[to], trial);
            }
        }
        gained
    }

    /// The fit with the best Tabor parameter, if that is between the rows.
    fn freed(&self, curve: &Curve, fits: &[Fit], room: &mut Prediction) -> Option<Fit> {
        let full = self.full?;
        let inner: Vec<&Fit> = fits.iter().filter(|fit| fit.model == full).collect();
        let squares = |k: usize| inner.get(k).map_or(f64::INFINITY, |fit| fit.squares);
        let mut least: Vec<usize> = (0..inner.len())
            .filter(|&k| squares(k) <= squares(k + 1) && (k == 0 || squares(k) <= squares(k - 1)))
            .collect();
        least.sort_by(|&a, &b| squares(a).total_cmp(&squares(b)));
        let unit = curve.noise.max(self.least).powi(2);
        // minima that are hardly worse than the best are of one flat likelihood
        let flat = squares(*least.first()?) + 4.0 * unit;
        let others = least.iter().skip(1).filter(|&&k| squares(k) > flat).take(3);
        let freed = least.iter().take(1).chain(others).map(|&k| {
            let mut fit = Fit { free: [true; 4], ..inner[k].clone() };
            self.settle(curve, &mut fit, FINE, room);
            fit
        });
        let best = freed.min_by(|a, b| a.squares.total_cmp(&b.squares))?;
        (best.squares < squares(least[0])).then_some(best)
    }

    /// Adds the fit with the best Tabor parameter, and fits at others about it.
    fn surround(&self, curve: &Curve, fits: &mut Vec<Fit>, best: Fit, room: &mut Prediction) {
        let model = &self.models[best.model];
        let freedom = curve.z.len().saturating_sub(4 + curve.baseline.len()).max(1) as f64;
        let width = (curve.variance_of_tabor(model, &best, room) * best.squares / freedom).sqrt();
        let rows = || self.rows.iter().filter(|row| row.0 == best.model).map(|row| row.1);
        let (low, high) =
            rows().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), one| (low.min(one), high.max(one)));
        // the rows themselves are as close where the likelihood is wide
        for sign in [-1.0, 1.0].into_iter().filter(|_| width <= WIDE) {
            let mut last = best.clone();
            last.free[3] = false;
            for place in AROUND.map(|one| best.parameters.log_tabor + sign * width * one) {
                if place > low && place < high {
                    last.parameters.log_tabor = place;
                    curve.improve(self.models, &mut last, FINE, self.least, room);
                    fits.push(last.clone());
                }
            }
        }
        fits.push(best);
        let rank = |fit: &Fit| self.rows.iter().position(|row| row.0 == fit.model);
        fits.sort_by(|a, b| rank(a).cmp(&rank(b)).then(a.parameters.log_tabor.total_cmp(&b.parameters.log_tabor)));
    }
}

/// The greatest root of the work of adhesion, from a fit on, with squares of at most `most`.
#[must_use]
pub fn greatest_root(curve: &Curve, models: &[Model], mut fit: Fit, most: f64, least: f64) -> f64 {
    let mut room = Prediction::default();
    fit.free = [true, false, true, false];
    let mut squares_at = |fit: &mut Fit, root: f64| {
        fit.parameters.root_work = root;
        curve.improve(models, fit, ROUGH, least, &mut room);
        fit.squares
    };
    let (mut low, mut high) = (fit.parameters.root_work, fit.parameters.root_work.max(0.03) * 1.5);
    while high < 40.0 && squares_at(&mut fit, high) < most {
        (low, high) = (high, 1.5 * high);
    }
    for _ in 0..5 {
        let middle = 0.5 * (low + high);
        if squares_at(&mut fit, middle) < most { low = middle } else { high = middle }
    }
    high
}

fn take_better(fit: &mut Fit, other: Fit) {
    if other.squares < fit.squares {
        *fit = other;
    }
}

impl Curve {
    /// Some of the points, as far apart as may be.
    fn thinned(&self, most: usize) -> Self {
        let points = self.z.len();
        let step = points.div_ceil(most).max(1);
        let chosen: Vec<usize> = (0..points).step_by(step).collect();
        let of = |values: &[f64]| chosen.iter().map(|&i| values[i]).collect::<Vec<f64>>();
        let mut baseline: Vec<Vec<f64>> = Vec::new();
        for column in &self.baseline {
            // of Gram and Schmidt
            let mut column = of(column);
            for _ in 0..2 {
                for other in &baseline {
                    let share: f64 = other.iter().zip(&column).map(|(a, b)| a * b).sum();
                    column.iter_mut().zip(other).for_each(|(value, a)| *value -= share * a);
                }
            }
            let norm = column.iter().map(|one| one * one).sum::<f64>().sqrt();
            if norm > 1e-9 {
                column.iter_mut().for_each(|one| *one /= norm);
                baseline.push(column);
            }
        }
        let turn = chosen.iter().filter(|&&i| i < self.turn).count();
        Self { z: of(&self.z), force: of(&self.force), turn, baseline, ..self.clone() }.ordered()
    }

    /// The deviation of the noise by the best of some fits.
    fn noise_of<'a>(&self, fits: impl Iterator<Item = &'a Fit>) -> f64 {
        let least = fits.map(|fit| fit.squares).fold(f64::INFINITY, f64::min);
        (least / self.z.len().saturating_sub(4 + self.baseline.len()).max(1) as f64).sqrt()
    }

    /// The sum of squares of parameters, without sides of jumps.
    fn squares(&self, model: &Model, parameters: &Parameters, room: &mut Prediction) -> f64 {
        self.predict(model, parameters, &Sides::default(), room);
        let mut rest: Vec<f64> = self.force.iter().zip(&room.load).map(|(force, load)| force - load).collect();
        self.clear(&mut rest);
        rest.iter().map(|one| one * one).sum()
    }
}
