//! Strips and lattices: accuracies that are asked for where the edge of the contact is at few independent places.

use std::f64::consts::TAU;

use asperity::accuracy::{Accuracy, Quantity};
use asperity::contact::ContactArea;
use asperity::{Control, Grid, Nested, NoAdhesion, Settings, Solver, Surface, Westergaard};

use common::Outcome;

const TARGETS: [f64; 4] = [0.05, 0.03, 0.02, 0.01];
/// The bytes of 512² nodes, the finest grid.
const MEMORY: f64 = 2.6e7;
const SLOPE: f64 = 0.1;
/// The nodes along a side of the references, of a line and of the cell of a lattice.
const LINE: usize = 8192;
const CELL: usize = 256;

/// What is repeated along the strips.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Wave,
    Scratches,
    Ground,
    Lattice,
}

/// Which way the wave vector runs.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    OnLine,
    AlongSide,
    Across,
}

/// Numbers between 0 and 1, by SplitMix64.
pub struct Draw(pub u64);

impl Draw {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn log(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (TAU * self.unit()).cos()
    }

    pub fn whole(&mut self, low: i32, high: i32) -> f64 {
        self.between(f64::from(low), f64::from(high) + 1.0).floor()
    }
}

/// A profile, along a wave vector and for a lattice along the vector at a right angle to it as well.
struct Scene {
    nodes: usize,
    way: Way,
    lattice: bool,
    vector: [f64; 2],
    /// Amplitudes and phases of the waves of the profile, the longest first.
    profile: Vec<(f64, f64)>,
    /// The phases by which the profile and that at a right angle are shifted.
    shifts: [f64; 2],
    control: Control,
    area: f64,
}

fn half_space(grid: Grid) -> asperity::Result<Westergaard<f64>> {
    Westergaard::new(grid, 1.0)
}

impl Scene {
    fn draw(draw: &mut Draw, kind: Kind, way: Way) -> Outcome<Self> {
        let nodes = if draw.unit() < 0.5 { 32 } else { 64 };
        let rough = matches!(kind, Kind::Scratches | Kind::Ground);
        let most = if rough { 2 } else { nodes / 8 } as i32;
        let first = draw.whole(1, most);
        let vector = match way {
            Way::Across => [first, draw.whole(1, most) * if draw.unit() < 0.5 { 1.0 } else { -1.0 }],
            Way::AlongSide if draw.unit() < 0.5 => [0.0, first],
            _ => [first, 0.0],
        };
        // the shortest wave of the profile has four nodes or more
        let waves = nodes as f64 / (4.0 * vector[0].abs().max(vector[1].abs())) * draw.between(0.4, 1.0);
        let waves = if rough { (waves as usize).max(2) } else { 1 };
        let mut scene = Self {
            nodes,
            way,
            lattice: kind == Kind::Lattice,
            vector,
            profile: profile(draw, kind, waves),
            shifts: [draw.unit(), draw.unit()],
            control: Control::MeanPressure(SLOPE * draw.log(0.01, 0.97) / std::f64::consts::SQRT_2),
            area: 0.0,
        };
        let squares = scene.profile.iter().zip(1..).map(|((a, _), m)| 0.5 * (TAU * f64::from(m) * a).powi(2));
        let slope = vector[0].hypot(vector[1]) * (squares.sum::<f64>() * if scene.lattice { 2.0 } else { 1.0 }).sqrt();
        scene.profile.iter_mut().for_each(|(amplitude, _)| *amplitude *= SLOPE / slope);
        let gap;
        (scene.area, gap) = scene.reference()?;
        if draw.unit() < 0.4 {
            scene.control = Control::MeanGap(gap);
            (scene.area, _) = scene.reference()?;
        }
        Ok(scene)
    }

    fn height(&self, along: f64) -> f64 {
        let waves = self.profile.iter().zip(1..);
        waves.map(|((amplitude, phase), m)| amplitude * (TAU * f64::from(m) * along + phase).cos()).sum()
    }

    /// The area and the mean gap, of one period: a strip is that of its profile, and a lattice that of its cell.
    fn reference(&self) -> Outcome<(f64, f64)> {
        let period = self.vector[0].hypot(self.vector[1]).recip();
        let solve = |grid: Grid| -> Outcome<(f64, f64)> {
            let surface = Surface::from_fn(grid, |x, y| {
                self.height(x / period) + if self.lattice { self.height(y / period) } else { 0.0 }
            })?;
            let mut solver = Solver::new(Settings::default().tolerance(1e-8));
            let found = Nested::default().solve(&mut solver, &surface, half_space, NoAdhesion, self.control)?.solution;
            let area = ContactArea::of_solution(&found)?.corrected_contact_fraction;
            Ok((area, found.report.mean_gap))
        };
        if !self.lattice {
            return solve(Grid::line(LINE, period)?);
        }
        let [(coarse, _), (fine, gap)] = [solve(Grid::square(CELL / 2, period)?)?, solve(Grid::square(CELL, period)?)?];
        Ok((fine + (fine - coarse) / 3.0, gap))
    }

    /// The relative error of the area where an accuracy is said to be reached.
    fn error(&self, target: f64) -> Outcome<Option<f64>> {
        let grid = if self.way == Way::OnLine { Grid::line(self.nodes, 1.0)? } else { Grid::square(self.nodes, 1.0)? };
        let ([kx, ky], [one, other]) = (self.vector, self.shifts);
        let surface = Surface::from_fn(grid, |x, y| {
            let across = if self.lattice { self.height(kx * y - ky * x + other) } else { 0.0 };
            self.height(kx * x + ky * y + one) + across
        })?;
        let wanted = Accuracy::new(target, Quantity::Area).memory(MEMORY);
        let found = wanted.solve(&mut Solver::default(), &surface, half_space, NoAdhesion, self.control)?;
        let level = found.levels.last().filter(|_| found.reached);
        Ok(level.map(|level| (level.area.corrected_contact_fraction / self.area - 1.0).abs()))
    }
}

/// The amplitudes and phases of a profile with so many waves.
fn profile(draw: &mut Draw, kind: Kind, waves: usize) -> Vec<(f64, f64)> {
    let hurst = draw.log(0.3, 1.0);
    // grooves or ridges, of one width, on a slight wave
    let width = draw.between(0.5, 1.5) / waves as f64;
    let sign = if draw.unit() < 0.5 { -1.0 } else { 1.0 };
    let grooves: Vec<_> = (0..draw.whole(1, 4) as usize).map(|_| (draw.unit(), draw.between(0.3, 1.3))).collect();
    let slight = draw.between(0.0, 0.1);
    let wave = |m: f64| match kind {
        Kind::Ground => (m.powf(-hurst - 0.5), TAU * draw.unit()),
        Kind::Scratches => {
            let size = sign * width * (-(0.5 * TAU * m * width).powi(2)).exp();
            let part = |part: fn(f64) -> f64| {
                grooves.iter().map(|(at, depth)| size * depth * part(-TAU * m * at)).sum::<f64>()
            };
            let (real, imaginary) = (part(f64::cos) + if m == 1.0 { slight } else { 0.0 }, part(f64::sin));
            (real.hypot(imaginary), imaginary.atan2(real))
        }
        Kind::Wave | Kind::Lattice => (1.0, 0.0),
    };
    (1..=waves).map(|m| m as f64).map(wave).collect()
}

/// Measures what becomes of accuracies of the area.
pub fn measure(quick: bool) -> Outcome<()> {
    let count = if quick { 3 } else { 80 };
    println!("\n== strips: accuracies of the area, right of reached, of {count} scenes each");
    println!("{:>34} {}", "", TARGETS.map(|target| format!("{:>12}", format!("{} %", 100.0 * target))).concat());
    let mut totals = [[0; 2]; TARGETS.len()];
    for (kind, name) in [
        (Kind::Wave, "waves"),
        (Kind::Scratches, "scratches and ridges"),
        (Kind::Ground, "ground surfaces"),
        (Kind::Lattice, "lattices"),
    ] {
        for (way, direction) in
            [(Way::OnLine, "on a line"), (Way::AlongSide, "along a side"), (Way::Across, "at an angle")]
        {
            if kind == Kind::Lattice && way == Way::OnLine {
                continue;
            }
            let mut draw = Draw(11);
            let scenes: Vec<_> = (0..count).map(|_| Scene::draw(&mut draw, kind, way)).collect::<Outcome<_>>()?;
            print!("{:>34} ", format!("{name}, {direction}"));
            for (target, total) in TARGETS.into_iter().zip(&mut totals) {
                let errors: Vec<_> = scenes.iter().map(|scene| scene.error(target)).collect::<Outcome<_>>()?;
                let reached: Vec<_> = errors.into_iter().flatten().collect();
                let right = reached.iter().filter(|error| **error <= target).count();
                *total = [total[0] + right, total[1] + reached.len()];
                print!("{:>12}", format!("{right} of {}", reached.len()));
            }
            println!();
        }
    }
    let all = totals.map(|[right, reached]| format!("{:>11.1}%", 100.0 * right as f64 / reached as f64));
    println!("{:>34} {}", "all", all.concat());
    Ok(())
}
