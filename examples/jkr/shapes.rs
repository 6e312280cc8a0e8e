//! The law without a range in other shapes: how strongly the nodes hold straight fronts.

use std::f64::consts::PI;
use std::sync::Arc;

use asperity::adhesion::Hints;
use asperity::{AdhesionLaw, Real};
use common::Outcome;

use crate::case::{head, ratios, row};
use crate::wave::Wave;

/// The steepest slope of the law of the library, a quintic step, times the compliance of a node.
const STEEPEST: f64 = 3.75 / 13.0;

/// Energy, traction and slope that are left at a gap from zero to one, over the values in contact.
type Left = fn(f64) -> [f64; 3];

/// Shapes of the traction, from one in contact to zero at the range, all with a mean of a half: a name, the steepest slope
/// over the range, and the shape.
const SHAPES: [(&str, f64, Left); 4] = [
    ("ramp", 1.0, |x| if x < 1.0 { [(1.0 - x).powi(2), 1.0 - x, -1.0] } else { [0.0; 3] }),
    ("half cosine", 0.5 * PI, |x| {
        let (sine, cosine) = (PI * x).sin_cos();
        [1.0 - x - sine / PI, 0.5 * (1.0 + cosine), -0.5 * PI * sine]
    }),
    ("cubic step", 1.5, |x| {
        let left = 1.0 - x;
        [left.powi(3) * (1.0 + x), left * left * (1.0 + 2.0 * x), -6.0 * x * left]
    }),
    ("quintic step, the law of the library", 1.875, |x| {
        let left = 1.0 - x;
        [
            left.powi(4) * (1.0 + 2.0 * x * (1.0 + x)),
            left.powi(3) * (1.0 + 3.0 * x + 6.0 * x * x),
            -30.0 * x * x * left * left,
        ]
    }),
];

/// A law of a work of adhesion that falls on each grid as steeply as the law of the library.
#[derive(Clone, Copy)]
struct Short {
    work_of_adhesion: f64,
    /// The range over √(w · compliance of a node).
    reach: f64,
    left: Left,
    /// The range on a grid; zero before.
    range: f64,
}

impl Short {
    fn at(&self, gap: f64) -> [f64; 3] {
        let (w, peak) = (self.work_of_adhesion, 2.0 * self.work_of_adhesion / self.range);
        // without a range all of the attraction is in contact
        let [energy, traction, slope] = (self.left)(if gap > 0.0 { (gap / self.range).min(1.0) } else { 0.0 });
        [-w * energy, peak * traction, peak / self.range * slope]
    }
}

impl<T: Real> AdhesionLaw<T> for Short {
    fn energy(&self, gap: T) -> T {
        T::lit(self.at(gap.widen())[0])
    }
    fn traction(&self, gap: T) -> T {
        T::lit(self.at(gap.widen())[1])
    }
    fn slope(&self, gap: T) -> T {
        T::lit(self.at(gap.widen())[2])
    }
    fn hints(&self) -> Hints<T> {
        let mut hints = Hints::new(T::lit(self.work_of_adhesion), T::lit(self.range)).with_name("short").concave();
        hints.of_grid = true;
        hints
    }
    fn on_nodes(&self, compliance: T) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let range = self.reach * (self.work_of_adhesion * compliance.widen()).sqrt();
        Some(Arc::new(Self { range, ..*self }))
    }
}

/// The pull-off of the wave on many grids: its fronts are straight, and their place between the nodes is by chance.
pub fn table(quick: bool) -> Outcome<()> {
    let grids = if quick { vec![128, 150] } else { vec![360, 400, 450, 486, 512, 540, 576, 600, 640, 720, 800, 1024] };
    head(
        &format!("Pull-off of the wave over the exact one, and the range over √(wΔx/E*), on {grids:?} nodes"),
        &["shape", "range", "least", "mean", "largest"],
    );
    for (name, steepest, left) in SHAPES {
        let reach = (2.0 * steepest / STEEPEST).sqrt();
        let mut found = Vec::new();
        for &n in &grids {
            let wave = Wave::line(n)?;
            let law = Short { work_of_adhesion: wave.work_of_adhesion(), reach, left, range: 0.0 };
            found.push(wave.pull_off(law)?);
        }
        found.sort_by(f64::total_cmp);
        let mean = found.iter().sum::<f64>() / found.len() as f64;
        let mut cells = vec![name.to_owned(), format!("{reach:.2}")];
        cells.extend(ratios([found[0], mean, found[found.len() - 1]]));
        row(&cells);
    }
    Ok(())
}
