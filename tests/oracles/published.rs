//! Published runs by another method, with their input: a half-space and a bonded layer on one rough surface of 2048² nodes,
//! from 0.6 % to 87 % contact, by Green's function molecular dynamics, 4 to 45 hours a run on one core. Sukhomlinov and
//! Müser, *Phys. Rev. Lett.* 131, 156201 (2023), with data and source of Data-Coupling-2023-07,
//! doi:10.5281/zenodo.12726265 (MIT).

use std::f64::consts::{PI, SQRT_2, TAU};

use asperity::elastic::{Base, HalfSpace, Layer, Material};
use asperity::{
    ContactConstraint, Control, Grid, NoAdhesion, Penalty, Problem, Projection, Result, Settings, Solution,
};
use asperity::{Solver, Spectral, Status, Surface};
use asperity_fft::double;
use asperity_fft::num_complex::Complex;
use ndarray::{Array2, Axis};

/// The nodes along a side in the published runs.
pub const NODES: usize = 2048;
/// The side of the cell; the contact modulus is 1.
const SIDE: f64 = 2.0;
/// The waves along a side of the longest and of the shortest wave.
const WAVES: (f64, f64) = (2.0, 256.0);
const RMS_HEIGHT: f64 = 0.01;
const HURST: f64 = 0.8;
/// The gap below which they count a node as in contact.
const CONTACT: f64 = 2e-10;

/// A published run: its body and its load, and what was found as it is printed, with six digits.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// The thickness of the layer, infinite for a half-space.
    pub thickness: f64,
    /// Poisson's ratio of the layer.
    pub poisson: f64,
    /// The mean pressure.
    pub pressure: f64,
    /// The contact fraction, the mean gap, the mean of the positive gaps, and the elastic energy per area.
    pub found: [&'static str; 4],
    /// The mean gap of a hard wall, as extrapolated.
    pub hard_gap: &'static str,
    /// The minutes on one core.
    pub minutes: &'static str,
}

/// The published runs.
pub fn runs() -> impl Iterator<Item = Run> {
    include_str!("published.csv").lines().skip(1).filter_map(|line| {
        let cells: Vec<&'static str> = line.split(',').collect();
        let [_, thickness, poisson, pressure, contact, mean_gap, open_gap, hard_gap, energy, minutes] = cells[..]
        else {
            return None;
        };
        Some(Run {
            thickness: thickness.parse().ok()?,
            poisson: poisson.parse().ok()?,
            pressure: pressure.parse().ok()?,
            found: [contact, mean_gap, open_gap, energy],
            hard_gap,
            minutes,
        })
    })
}

impl Run {
    /// What the run finds by the springs of the publication, of 0.9 times the stiffness of the shortest wave of a
    /// half-space, as it prints it.
    ///
    /// # Errors
    /// Errors of the solve.
    pub fn by_springs(&self, surface: &Surface) -> Result<[String; 4]> {
        let stiffness = 0.45 * SQRT_2 * PI * surface.grid().shape().0 as f64 / SIDE;
        let solution = self.solved(surface, Penalty::new(stiffness)?, 1e-9)?;
        let nodes = solution.gap.len() as f64;
        let close = solution.gap.iter().filter(|gap| **gap < CONTACT).count() as f64;
        let open: f64 = solution.gap.iter().map(|gap| gap.max(0.0)).sum();
        let report = &solution.report;
        Ok([close / nodes, report.mean_gap, open / nodes, report.elastic_energy].map(six_digits))
    }

    /// The run with a hard wall.
    ///
    /// # Errors
    /// Errors of the solve.
    pub fn by_a_hard_wall(&self, surface: &Surface) -> Result<Solution<f64>> {
        self.solved(surface, Projection, 1e-6)
    }

    fn solved(
        &self,
        surface: &Surface,
        wall: impl ContactConstraint<f64> + 'static,
        tolerance: f64,
    ) -> Result<Solution<f64>> {
        let grid = *surface.grid();
        let body = match self.thickness.is_finite() {
            true => Spectral::of(grid, Layer::new(Material::new(1.0, self.poisson)?, self.thickness, Base::Bonded)?)?,
            false => Spectral::of(grid, HalfSpace::new(1.0)?)?,
        };
        let mut problem = Problem::new(surface, body, NoAdhesion)?;
        let settings = Settings::default().tolerance(tolerance).max_iterations(20_000);
        let solution =
            Solver { settings, constraint: wall }.solve(&mut problem, Control::MeanPressure(self.pressure))?;
        assert_eq!(solution.report.status, Status::Converged, "{self:?}");
        Ok(solution)
    }
}

/// A number with six significant digits, as C++ prints it.
fn six_digits(value: f64) -> String {
    let rounded = format!("{value:.5e}");
    let (digits, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    let trimmed = |text: &str| text.trim_end_matches('0').trim_end_matches('.').to_owned();
    match exponent.parse::<i32>().unwrap_or_default() {
        exponent @ -4..=5 => trimmed(&format!("{value:.*}", (5 - exponent) as usize)),
        exponent => format!("{}e{}{:02}", trimmed(digits), if exponent < 0 { '-' } else { '+' }, exponent.abs()),
    }
}

/// The additive generator of the GNU C library, `rand` after `srand`.
pub struct Rand {
    last: [u32; 31],
    next: usize,
}

impl Rand {
    /// The generator after `srand(seed)`.
    pub fn new(seed: u32) -> Self {
        let mut last = [seed; 31];
        for i in 1..31 {
            last[i] = (16807 * u64::from(last[i - 1]) % 0x7fff_ffff) as u32;
        }
        let mut this = Self { last, next: 3 };
        for _ in 0..310 {
            this.draw();
        }
        this
    }

    /// r_i = r_(i−3) + r_(i−31): a draw has all but the last bit.
    pub fn draw(&mut self) -> u32 {
        let i = self.next;
        self.last[i] = self.last[i].wrapping_add(self.last[(i + 28) % 31]);
        self.next = (i + 1) % 31;
        self.last[i] >> 1
    }
}

/// The surface of the runs, on this many nodes along a side; where the publication has its low values in contact, here
/// the peaks are.
///
/// # Errors
/// Errors of the surface.
pub fn surface(nodes: usize) -> Result<Surface> {
    let mut random = Rand::new(4711);
    for _ in 0..100 {
        random.draw();
    }
    let rows = 2 * WAVES.1 as usize;
    let columns = rows / 2 + 1;
    let mut modes = Array2::<Complex<f64>>::zeros((nodes, nodes));
    let mut square = 0.0;
    for (i, j) in (1..rows * columns).map(|k| (k / columns, k % columns)) {
        let folded = i.min(rows - i);
        let waves = (folded as f64).hypot(j as f64);
        if waves > WAVES.1 {
            continue;
        }
        let phase = TAU * f64::from(random.draw()) / 2_147_483_647.0;
        if waves < WAVES.0 || (j == 0 && i >= rows / 2) {
            continue;
        }
        let mode = Complex::from_polar(waves.powf(-1.0 - HURST), phase);
        let row = if i < rows / 2 { i } else { nodes - folded };
        modes[[row, j]] = mode;
        modes[[(nodes - row) % nodes, (nodes - j) % nodes]] = mode.conj();
        square += 2.0 * mode.norm_sqr();
    }
    let transform = double(nodes).inverse;
    let mut line = vec![Complex::default(); nodes];
    for axis in [0, 1] {
        for mut lane in modes.lanes_mut(Axis(axis)) {
            line.iter_mut().zip(&lane).for_each(|(to, from)| *to = *from);
            transform.process(&mut line);
            lane.iter_mut().zip(&line).for_each(|(to, from)| *to = *from);
        }
    }
    let scale = RMS_HEIGHT / square.sqrt();
    Surface::new(Grid::square(nodes, SIDE)?, modes.mapv(|mode| -scale * mode.re))
}
