//! `asperity selftest`: contacts whose solution is known, solved and compared with it.

use std::f64::consts::PI;
use std::time::Instant;

use asperity::exact::{AdhesiveWavyLine, Hertz, MaugisDugdale as Maugis, Periodic, WavyLine, closing_pressure_2d};
use asperity::{
    AdhesionLaw, Amplitude, Control, Exponential, Grid, MaugisDugdale, NoAdhesion, Problem, Real, SelfAffine, Settings,
    Solution, Solver, Status, Surface, Westergaard,
};
use clap::Args;
use serde_json::{Value, json};

use crate::numbers::plain;
use crate::outcome::Outcome;
use crate::printing::{Printing, bold, complain, green, yellow};
use crate::threads;

/// Solve contacts whose solution is known, and compare.
///
/// Shows in some seconds, without files, that this program finds on this machine what theory says: the sphere of Hertz,
/// that of Maugis and Dugdale, and the waves of Westergaard and Johnson, in f64 and f32; and that a rough contact comes
/// out the same, bit for bit, from one thread and from all. Lengths are in periods of the surface, pressures in contact
/// moduli. What each difference may be is in the documentation, on the page self-test. Exits with 0 if all holds, and 2 if
/// something does not.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Options {
    #[command(flatten)]
    printing: Printing,
}

const EXAMPLES: &str = "\
\u{1b}[1;4mExamples:\u{1b}[0m
  asperity selftest
  asperity selftest --json";

/// A value that was found beside that of theory.
struct Check {
    what: &'static str,
    precision: &'static str,
    found: f64,
    theory: f64,
    /// The largest difference that the method explains
    allowed: f64,
    /// How the solve ended
    status: Status,
}

impl Check {
    fn difference(&self) -> f64 {
        (self.found - self.theory).abs()
    }

    /// Whether the solve converged to the value of theory.
    fn holds(&self) -> bool {
        self.status == Status::Converged && self.difference() <= self.allowed
    }

    fn cells(&self) -> [String; 7] {
        [
            self.what.to_owned(),
            self.precision.to_owned(),
            plain(self.found),
            plain(self.theory),
            format!("{:.1e}", self.difference()),
            format!("{:.1e}", self.allowed),
            if self.holds() { "yes" } else { "no" }.to_owned(),
        ]
    }

    fn report(&self) -> Value {
        json!({
            "what": self.what,
            "precision": self.precision,
            "found": self.found,
            "theory": self.theory,
            "difference": self.difference(),
            "allowed": self.allowed,
            "status": self.status.name(),
            "ok": self.holds(),
        })
    }
}

const NODES: usize = 256;
/// The radius of the spheres.
const RADIUS: f64 = 2.0;
/// The amplitude of the waves.
const AMPLITUDE: f64 = 0.02;

/// Runs the command; whether all checks hold.
pub fn run(options: &Options) -> Outcome<bool> {
    let &Options { printing } = options;
    let start = Instant::now();
    let mut checks = Vec::new();
    hertz::<f64>(&mut checks)?;
    hertz::<f32>(&mut checks)?;
    maugis::<f64>(&mut checks)?;
    maugis::<f32>(&mut checks)?;
    full_contact::<f64>(&mut checks)?;
    full_contact::<f32>(&mut checks)?;
    westergaard(&mut checks)?;
    johnson(&mut checks)?;
    let double = rough::<f64>(&mut checks)?;
    let single = rough::<f32>(&mut checks)?;
    checks.push(Check {
        what: "rough contact, mean gap in f32 beside f64",
        precision: "f32",
        found: single.report.mean_gap,
        theory: double.report.mean_gap,
        allowed: single.report.tolerance * double.report.mean_gap,
        status: single.report.status,
    });
    let (seconds, all) = (start.elapsed().as_secs_f64(), checks.iter().all(Check::holds));

    printing.say(&table(&checks));
    let outcome = if all { "all hold" } else { "not all hold" };
    printing.say(&format!("\n{} checks in {seconds:.1} s: {outcome}", checks.len()));
    printing.report(|| {
        json!({
            "command": "selftest",
            "ok": all,
            "checks": checks.iter().map(Check::report).collect::<Vec<_>>(),
            "seconds": seconds,
            "threads": threads::count(),
            "version": env!("CARGO_PKG_VERSION"),
        })
    });
    for check in checks.iter().filter(|check| !check.holds()) {
        let Check { what, precision, found, theory, allowed, status } = check;
        let text = format!(
            "{what} in {precision} is {found:e}, by theory {theory:e}, allowed difference {allowed:.1e}; the solve: \
             {status}; results of this program on this machine are not to be trusted, please report it"
        );
        complain("warning", &text);
    }
    Ok(all)
}

/// A table with a line for each of the checks.
fn table(checks: &[Check]) -> String {
    let head = ["what", "precision", "found", "theory", "difference", "allowed", "ok"].map(str::to_owned);
    let lines: Vec<_> = [head].into_iter().chain(checks.iter().map(Check::cells)).collect();
    let widths: Vec<_> = (0..7).map(|k| lines.iter().map(|cells| cells[k].len()).max().unwrap_or(0)).collect();
    let line = |(number, cells): (usize, &[String; 7])| {
        let padded = cells.iter().zip(&widths).map(|(cell, &width)| match (number, cell.as_str()) {
            (0, "ok") => bold(cell),
            (0, _) => bold(&format!("{cell:width$}")),
            (_, "yes") => green(cell),
            (_, "no") => yellow(cell),
            _ => format!("{cell:width$}"),
        });
        padded.collect::<Vec<_>>().join("  ")
    };
    lines.iter().enumerate().map(line).collect::<Vec<_>>().join("\n")
}

/// The equilibrium on a half-space of contact modulus 1; to 1e-8 in f64, so that the error is that of the grid, and to
/// the default of 1e-4 in f32.
fn solved<T: Real>(
    surface: &Surface,
    law: impl AdhesionLaw<T> + 'static,
    control: Control,
) -> asperity::Result<Solution<T>> {
    let mut problem = Problem::new(surface, Westergaard::<T>::new(*surface.grid(), 1.0)?, law)?;
    let default = Settings::default();
    let tolerance = default.tolerance_in::<T>();
    let tolerance = if tolerance < 1e-5 { 1e-8 } else { tolerance };
    Solver::new(default.tolerance(tolerance)).solve(&mut problem, control)
}

/// Two checks of a contact: its mean pressure, and a radius of its own.
fn compare<T: Real>(
    checks: &mut Vec<Check>,
    solution: &Solution<T>,
    [pressure, radius]: [(&'static str, f64, f64, f64); 2],
) {
    let report = &solution.report;
    checks.extend([pressure, radius].map(|(what, found, theory, allowed)| Check {
        what,
        precision: report.precision,
        found,
        theory,
        allowed,
        status: report.status,
    }));
}

/// A sphere without adhesion, among its periodic images.
fn hertz<T: Real>(checks: &mut Vec<Check>) -> Outcome<()> {
    let surface = Surface::paraboloid(Grid::square(NODES, 1.0)?, RADIUS)?;
    let gap = 0.037;
    let theory = Periodic::new(Hertz::new(RADIUS, 1.0)?, 1.0)?.at_mean_gap(gap, surface.mean())?;
    let solution = solved::<T>(&surface, NoAdhesion, Control::MeanGap(gap))?;
    let (report, pressure, radius) = (&solution.report, theory.mean_pressure(), theory.contact().contact_radius());
    // the edge of the contact falls between nodes: second order in the spacing
    let share = 0.1 * (spacing() / radius).powi(2) + report.tolerance;
    compare(
        checks,
        &solution,
        [
            ("sphere of Hertz, mean pressure", report.mean_pressure, pressure, share * pressure),
            ("sphere of Hertz, contact radius", (report.contact_fraction / PI).sqrt(), radius, spacing()),
        ],
    );
    Ok(())
}

/// A sphere with the law of Maugis and Dugdale, among its periodic images: of a Tabor parameter of 1.4, near that of
/// Johnson, Kendall and Roberts, in tension.
fn maugis<T: Real>(checks: &mut Vec<Check>) -> Outcome<()> {
    let surface = Surface::paraboloid(Grid::square(NODES, 1.0)?, RADIUS)?;
    let (work, range, gap) = (1e-4, 2e-3, 0.0429);
    let sphere = Maugis::new(RADIUS, 1.0, work, range)?;
    let theory = Periodic::new(sphere, 1.0)?.at_mean_gap(gap, surface.mean())?;
    let solution = solved::<T>(&surface, MaugisDugdale::new(work, range)?, Control::MeanGap(gap))?;
    let (report, contact) = (&solution.report, theory.contact());
    // the traction w/ρ is on whole nodes: its force is missed by a tenth of the nodes along the edge of its zone
    let edge = work / range * 2.0 * PI * contact.adhesion_radius() * spacing();
    compare(
        checks,
        &solution,
        [
            (
                "sphere of Maugis and Dugdale, mean pressure",
                report.mean_pressure,
                theory.mean_pressure(),
                0.1 * edge + report.tolerance * theory.mean_pressure().abs(),
            ),
            (
                "sphere of Maugis and Dugdale, contact radius",
                (report.contact_fraction / PI).sqrt(),
                contact.contact_radius(),
                spacing(),
            ),
        ],
    );
    Ok(())
}

/// A wave in both directions, in full contact: the greatest pressure is that of one Fourier mode, exact on any grid.
fn full_contact<T: Real>(checks: &mut Vec<Check>) -> Outcome<()> {
    let surface = Surface::wave_2d(Grid::square(NODES, 1.0)?, AMPLITUDE, 1)?;
    let closing = closing_pressure_2d(AMPLITUDE, 1.0, 1.0)?;
    let mean = 1.1 * closing;
    let solution = solved::<T>(&surface, NoAdhesion, Control::MeanPressure(mean))?;
    let greatest = solution.pressure.iter().fold(T::lit(0.0), |greatest, &p| if p > greatest { p } else { greatest });
    let theory = mean + closing;
    checks.push(Check {
        what: "wave in full contact, greatest pressure",
        precision: solution.report.precision,
        found: greatest.widen(),
        theory,
        allowed: solution.report.tolerance * theory,
        status: solution.report.status,
    });
    Ok(())
}

/// A wave on a line without adhesion, half in contact.
fn westergaard(checks: &mut Vec<Check>) -> Outcome<()> {
    let nodes = 1024;
    let surface = Surface::wave(Grid::line(nodes, 1.0)?, AMPLITUDE, 1)?;
    let wave = WavyLine::new(AMPLITUDE, 1.0, 1.0)?;
    let theory = wave.at_half_width(0.25)?;
    let solution = solved::<f64>(&surface, NoAdhesion, Control::MeanGap(theory.mean_gap()))?;
    let (report, spacing) = (&solution.report, 1.0 / nodes as f64);
    // of second order in the spacing, as the edge of the contact falls between nodes
    let allowed = 10.0 * spacing * spacing * wave.closing_pressure();
    compare(
        checks,
        &solution,
        [
            ("wave of Westergaard, mean pressure", report.mean_pressure, theory.mean_pressure(), allowed),
            ("wave of Westergaard, half-width of the contact", 0.5 * report.contact_fraction, 0.25, spacing),
        ],
    );
    Ok(())
}

/// A wave on a line with adhesion of so short a range that it is that of Johnson, Kendall and Roberts.
fn johnson(checks: &mut Vec<Check>) -> Outcome<()> {
    let surface = Surface::wave(Grid::line(16384, 1.0)?, AMPLITUDE, 1)?;
    let work = 0.5 * (0.2 * PI * AMPLITUDE).powi(2);
    let wave = AdhesiveWavyLine::new(AMPLITUDE, 1.0, 1.0, work)?;
    let theory = wave.at_half_width(0.25)?;
    let range = 0.025 * AMPLITUDE;
    let solution = solved::<f64>(&surface, Exponential::new(work, range)?, Control::MeanGap(theory.mean_gap()))?;
    let report = &solution.report;
    // theory has no range: what differs is a zone of attraction of some ten ranges at the edge, of little force
    compare(
        checks,
        &solution,
        [
            (
                "adhesive wave of Johnson, mean pressure",
                report.mean_pressure,
                theory.mean_pressure(),
                2e-4 * wave.closing_pressure(),
            ),
            ("adhesive wave of Johnson, half-width of the contact", 0.5 * report.contact_fraction, 0.25, 6.0 * range),
        ],
    );
    Ok(())
}

/// A rough contact with adhesion, on one thread and on all of them, but on two at least: that of one thread.
fn rough<T: Real>(checks: &mut Vec<Check>) -> Outcome<Solution<T>> {
    let amplitude = Amplitude::RmsHeight(5e-3);
    let spectrum = SelfAffine::default().k_l(3.0).k_r(3.0).k_s(40.0).amplitude(amplitude).seed(2017);
    let surface = spectrum.surface(Grid::square(NODES, 1.0)?)?;
    let law = Exponential::new(5e-5, 1e-3)?;
    let on = |count| threads::on(count, || solved::<T>(&surface, law, Control::MeanPressure(5e-3)));
    let one = on(1)??;
    if cfg!(feature = "parallel") {
        let all = on(threads::count().max(2))??;
        let differ = |(a, b): &(&T, &T)| a != b;
        let gaps = one.gap.iter().zip(&all.gap).filter(differ).count();
        let pressures = one.pressure.iter().zip(&all.pressure).filter(differ).count();
        checks.push(Check {
            what: "rough contact, values that differ with the threads",
            precision: one.report.precision,
            found: (gaps + pressures) as f64,
            theory: 0.0,
            allowed: 0.0,
            status: one.report.status,
        });
    }
    Ok(one)
}

/// Between the nodes of the square grids.
fn spacing() -> f64 {
    1.0 / NODES as f64
}
