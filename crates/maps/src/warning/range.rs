//! The warnings about adhesion: its range is too short for the grid, or exceeds the heights, and its work does not suit
//! the body.

use asperity::adhesion::{Discretisation, mu_rho};
use asperity::{AdhesionLaw, Grid, Real, Report, Surface};

use super::extremes::Extremes;
use super::part::Part::{Figure, Length, Word};
use super::{Warning, WarningCode};

/// The resolution measure μ_ρ that the grid resolves.
const RESOLVED: f64 = Report::RESOLVED_MU_RHO;

/// The least length w/E* over the sides: of a hard solid it is 1e-15 m, and of maps the sides are below 10 mm.
const LEAST_WORK: f64 = 1e-13;

/// The greatest one: strains by adhesion, √(w/(E* L)), exceed one beyond it.
const MOST_WORK: f64 = 1.0;

/// The share of its range by which a smoothed law may reach farther.
const FARTHER: f64 = 0.1;

impl Warning {
    /// Why a cycle with `law` on a body of contact `modulus` E* jumps into contact too early, and so dissipates too little:
    /// the grid smooths jumps of its traction.
    pub fn of_cycle<T: Real>(law: &dyn AdhesionLaw<T>, grid: &Grid, modulus: f64, smooth: bool) -> Option<Self> {
        if law.hints().zero {
            return None;
        }
        let farther = f64::min(0.5 * Discretisation::<T>::SMOOTHING * mu_rho(law, grid, modulus).powi(2), 1.0);
        let is_smoothed = smooth && law.adapted(Discretisation::Smooth(T::infinity())).is_some();
        let text = "smoothed, the law reaches {} % farther and cycles dissipate less: refine the map";
        let warning = || Self::new(WarningCode::Range, farther, text, [Figure(100.0 * farther)]);
        (is_smoothed && farther > FARTHER).then(warning)
    }

    /// The probable mistakes in the range of `law` on a surface pressed against a body of contact `modulus` E*:
    /// [`Range`](WarningCode::Range), and in its work of adhesion: [`Work`](WarningCode::Work). Nothing without adhesion.
    pub fn of_law<T: Real>(law: &dyn AdhesionLaw<T>, surface: &Surface, modulus: f64) -> Vec<Self> {
        if law.hints().zero {
            return Vec::new();
        }
        let mu_rho = mu_rho(law, surface.grid(), modulus);
        let (range, span) = (law.hints().range.widen(), Extremes::find(surface.whole().heights()).span());
        let mut found = Vec::new();
        if mu_rho > RESOLVED {
            found.push(Self::new(
                WarningCode::Range,
                mu_rho / RESOLVED,
                "mu_rho = {} exceeds {}: the grid makes w act as {} w: use jkr",
                [Figure(mu_rho), Figure(RESOLVED), Word(held(mu_rho))],
            ));
        }
        if law.hints().work_of_adhesion > T::zero() && span > 0.0 && range > span {
            found.push(Self::new(
                WarningCode::Range,
                range / span,
                "the range of adhesion, {}, exceeds the heights, {}: check its unit",
                [Length(range), Length(span)],
            ));
        }
        let (lx, ly) = surface.grid().lengths();
        let work = law.hints().work_of_adhesion.widen() / modulus;
        let share = work / if surface.grid().is_line() { lx } else { lx.max(ly) };
        if share > MOST_WORK && share.is_finite() || share > 0.0 && share < LEAST_WORK {
            found.push(Self::new(
                WarningCode::Work,
                share.max(share.recip()),
                "w/E* is {}, {} sides: check the units of work of adhesion and modulus",
                [Length(work), Figure(share)],
            ));
        }
        found
    }
}

/// By μ_ρ, with how many times the given work of adhesion a front acts that the grid holds, on approach and on
/// withdrawal: the factor farthest from one of the exponential law and the law of Maugis and Dugdale, by Johnson's wave
/// on a line, where straight fronts along the grid are held most (example `jkr`, table `held`).
const HELD: [(f64, [f64; 2]); 7] = [
    (0.5, [0.99, 1.01]),
    (0.7, [0.98, 1.03]),
    (1.0, [0.95, 1.17]),
    (1.4, [0.68, 1.78]),
    (2.0, [0.41, 3.49]),
    (2.8, [0.32, 6.81]),
    (4.0, [0.25, 13.8]),
];

/// The interval of this table at a μ_ρ above the least, in words.
fn held(mu_rho: f64) -> String {
    let words = |[low, high]: [f64; 2], [less, more]: [&str; 2]| {
        format!("{less}{low:.2} to {more}{high:.*}", if high < 2.0 { 2 } else { 1 })
    };
    let Some(pair) = HELD.windows(2).find(|pair| mu_rho <= pair[1].0) else {
        return words(HELD[HELD.len() - 1].1, ["<", ">"]);
    };
    let share = (mu_rho / pair[0].0).ln() / (pair[1].0 / pair[0].0).ln();
    words([0, 1].map(|k| pair[0].1[k].powf(1.0 - share) * pair[1].1[k].powf(share)), [""; 2])
}
