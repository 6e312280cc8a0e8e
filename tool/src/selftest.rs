//! `asperity selftest`: contacts with a known solution, solved and compared with it.

use std::f64::consts::PI;
use std::sync::Arc;
use std::time::Instant;

use asperity::adhesion::Formula;
use asperity::exact::{AdhesiveWavyLine, Hertz, MaugisDugdale as Maugis, Periodic, WavyLine, closing_pressure_2d};
use asperity::{
    Amplitude, Control, Exponential, Grid, MaugisDugdale, NoAdhesion, Problem, Report, SelfAffine, Settings, Solution,
    Solver, Status, Surface, Westergaard,
};
use asperity_scene::numbers::plain;
use asperity_scene::{Outcome, Scalar, keys};
use ndarray::Array2;
use serde::Serialize;
use serde_json::json;

use crate::command::Call;
use crate::printing::{Printing, bold, complain, green, yellow};
use crate::threads;

keys! {
    /// Solve contacts with a known solution, and compare.
    ///
    /// Checks in some seconds, without files, that this program agrees with theory on this machine: for the spheres of
    /// Hertz and of Maugis and Dugdale, and the waves of Westergaard and Johnson, in f64 and f32. A rough contact must also
    /// come out the same, bit for bit, on one thread and on all. Lengths are in periods of the surface, and pressures in
    /// contact moduli. The page self-test of the documentation explains the allowed differences. Exits with 0 if all checks
    /// hold, and 2 if one does not.
    ///
    /// # Examples
    ///   asperity selftest
    ///   asperity selftest --json
    Options {}
}

const NODES: usize = 256;
/// The radius of the spheres.
const RADIUS: f64 = 2.0;
/// The amplitude of the waves.
const AMPLITUDE: f64 = 0.02;

/// A computed value next to the value of theory.
#[derive(Serialize)]
struct Check {
    what: &'static str,
    precision: &'static str,
    found: f64,
    theory: f64,
    difference: f64,
    /// The largest difference that the method explains
    allowed: f64,
    /// How the solve ended
    status: Status,
    /// Whether the solve converged to the value of theory.
    ok: bool,
}

impl Check {
    fn new(report: &Report, what: &'static str, [found, theory, allowed]: [f64; 3]) -> Self {
        let (precision, status, difference) = (report.precision, report.status, (found - theory).abs());
        let ok = status == Status::Converged && difference <= allowed;
        Self { what, precision, found, theory, difference, allowed, status, ok }
    }
}

/// Runs the command; whether all checks hold.
pub fn run(&Call { scene, .. }: &Call<'_>) -> Outcome<bool> {
    let printing: Printing = scene.keys();
    let start = Instant::now();
    let mut checks = known()?;
    checks.extend(rough()?);
    let (seconds, all) = (start.elapsed().as_secs_f64(), checks.iter().all(|check| check.ok));

    printing.say(&table(&checks));
    let outcome = if all { "all hold" } else { "not all hold" };
    printing.say(&format!("\n{} checks in {seconds:.1} s: {outcome}", checks.len()));
    printing.report(|| {
        let (threads, version) = (threads::count(), env!("CARGO_PKG_VERSION"));
        json!({
            "command": "selftest", "ok": all, "checks": checks,
            "seconds": seconds, "threads": threads, "version": version,
        })
    });
    for Check { what, precision, found, theory, allowed, status, .. } in checks.iter().filter(|check| !check.ok) {
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
    let cells = |&Check { what, precision, found, theory, difference, allowed, ok, .. }: &Check| {
        let [difference, allowed] = [difference, allowed].map(|difference| format!("{difference:.1e}"));
        let ok = if ok { "yes" } else { "no" };
        [what.to_owned(), precision.to_owned(), plain(found), plain(theory), difference, allowed, ok.to_owned()]
    };
    let head = ["what", "precision", "found", "theory", "difference", "allowed", "ok"].map(str::to_owned);
    let lines: Vec<_> = [head].into_iter().chain(checks.iter().map(cells)).collect();
    let widths: Vec<_> = (0..6).map(|k| lines.iter().map(|cells| cells[k].len()).max().unwrap_or(0)).collect();
    let line = |(number, cells): (usize, &[String; 7])| {
        let padded = cells.iter().zip(widths.iter().chain([&0])).map(|(cell, &width)| match (number, cell.as_str()) {
            (0, _) => bold(&format!("{cell:width$}")),
            (_, "yes") => green(cell),
            (_, "no") => yellow(cell),
            _ => format!("{cell:width$}"),
        });
        padded.collect::<Vec<_>>().join("  ")
    };
    lines.iter().enumerate().map(line).collect::<Vec<_>>().join("\n")
}

/// What is found in a report, and by the greatest pressure.
type Figure = fn(&Report, f64) -> f64;

/// What is compared of a contact: its name, how it is found, its value in theory, the difference that the grid
/// explains, and what share of theory's value the tolerance of the solve adds to it.
type Compared = (&'static str, Figure, f64, f64, f64);

/// A surface on a half-space of contact modulus 1, with its law and its load.
type Contact<'a> = (&'a Surface, Formula, Control);

/// The equilibrium, to 1e-8 in f64, so that the grid alone makes the error, and to the default of 1e-4 in f32.
fn solved<T: Scalar>((surface, law, control): &Contact<'_>) -> asperity::Result<Solution<T>> {
    let body = Westergaard::<T>::new(*surface.grid(), 1.0)?;
    let mut problem = Problem::new(surface, body, T::law(law.clone()))?;
    let default = Settings::default();
    let tolerance = default.tolerance_in::<T>();
    let tolerance = if tolerance < 1e-5 { 1e-8 } else { tolerance };
    Solver::new(default.tolerance(tolerance)).solve(&mut problem, *control)
}

/// The checks of a contact in one precision.
fn compared<T: Scalar>(contact: &Contact<'_>, all: &[Compared]) -> asperity::Result<Vec<Check>> {
    let Solution { report, pressure, .. } = &solved::<T>(contact)?;
    let greatest = pressure.iter().fold(0.0, |greatest: f64, pressure| greatest.max(pressure.widen()));
    let check = |&(what, found, theory, error, share): &Compared| {
        Check::new(report, what, [found(report, greatest), theory, error + share * report.tolerance * theory.abs()])
    };
    Ok(all.iter().map(check).collect())
}

/// The contacts with a solution that is known: in f64 and in f32, those on a line in f64.
fn known() -> Outcome<Vec<Check>> {
    let mut checks = Vec::new();
    let mut check = |contact: Contact<'_>, all: &[Compared]| -> Outcome<()> {
        checks.extend(compared::<f64>(&contact, all)?);
        checks.extend(if contact.0.grid().is_line() { Vec::new() } else { compared::<f32>(&contact, all)? });
        Ok(())
    };
    spheres(&mut check)?;
    waves(&mut check)?;
    Ok(checks)
}

fn spheres(mut check: impl FnMut(Contact<'_>, &[Compared]) -> Outcome<()>) -> Outcome<()> {
    let pressure: Figure = |report, _| report.mean_pressure;
    let radius: Figure = |report, _| (report.contact_fraction / PI).sqrt();
    let (grid, spacing) = (Grid::square(NODES, 1.0)?, 1.0 / NODES as f64);
    let sphere = &Surface::paraboloid(grid, RADIUS)?;

    // a sphere among its periodic images; the edge of the contact falls between nodes: second order in the spacing
    let theory = Periodic::new(Hertz::new(RADIUS, 1.0)?, 1.0)?.at_mean_gap(0.037, sphere.mean())?;
    let (p, a) = (theory.mean_pressure(), theory.contact().contact_radius());
    let all = [
        ("sphere of Hertz, mean pressure", pressure, p, 0.1 * (spacing / a).powi(2) * p, 1.0),
        ("sphere of Hertz, contact radius", radius, a, spacing, 0.0),
    ];
    check((sphere, Arc::new(NoAdhesion), Control::MeanGap(0.037)), &all)?;

    // of a Tabor parameter of 1.4, near the limit of Johnson, Kendall and Roberts, in tension; the traction w/ρ is on
    // whole nodes: its force is missed by a tenth of the nodes along the edge of its zone
    let (work, range) = (1e-4, 2e-3);
    let theory = Periodic::new(Maugis::new(RADIUS, 1.0, work, range)?, 1.0)?.at_mean_gap(0.0429, sphere.mean())?;
    let (p, a) = (theory.mean_pressure(), theory.contact().contact_radius());
    let edge = work / range * 2.0 * PI * theory.contact().adhesion_radius() * spacing;
    let all = [
        ("sphere of Maugis and Dugdale, mean pressure", pressure, p, 0.1 * edge, 1.0),
        ("sphere of Maugis and Dugdale, contact radius", radius, a, spacing, 0.0),
    ];
    check((sphere, Arc::new(MaugisDugdale::new(work, range)?), Control::MeanGap(0.0429)), &all)
}

fn waves(mut check: impl FnMut(Contact<'_>, &[Compared]) -> Outcome<()>) -> Outcome<()> {
    let pressure: Figure = |report, _| report.mean_pressure;
    let half_width: Figure = |report, _| 0.5 * report.contact_fraction;
    let (grid, ridges) =
        (Grid::square(NODES, 1.0)?, |nodes: usize| Surface::wave(Grid::line(nodes, 1.0)?, AMPLITUDE, 1));

    // a wave in both directions: its pressure is one Fourier mode, exact on any grid
    let closing = closing_pressure_2d(AMPLITUDE, 1.0, 1.0)?;
    let (wave, mean, greatest): (_, _, Figure) =
        (&Surface::wave_2d(grid, AMPLITUDE, 1)?, 1.1 * closing, |_, most| most);
    let all = [("wave in full contact, greatest pressure", greatest, mean + closing, 0.0, 1.0)];
    check((wave, Arc::new(NoAdhesion), Control::MeanPressure(mean)), &all)?;

    // half in contact
    let (spacing, theory) = (1.0 / 1024.0, WavyLine::new(AMPLITUDE, 1.0, 1.0)?);
    let (error, theory) = (10.0 * spacing * spacing * theory.closing_pressure(), theory.at_half_width(0.25)?);
    let all = [
        ("wave of Westergaard, mean pressure", pressure, theory.mean_pressure(), error, 0.0),
        ("wave of Westergaard, half-width of the contact", half_width, 0.25, spacing, 0.0),
    ];
    check((&ridges(1024)?, Arc::new(NoAdhesion), Control::MeanGap(theory.mean_gap())), &all)?;

    // of so short a range that it is the limit of Johnson, Kendall and Roberts; theory has none: what differs is a zone
    // of attraction of some ten ranges at the edge, of little force
    let (work, range) = (0.5 * (0.2 * PI * AMPLITUDE).powi(2), 0.025 * AMPLITUDE);
    let theory = AdhesiveWavyLine::new(AMPLITUDE, 1.0, 1.0, work)?;
    let (error, theory) = (2e-4 * theory.closing_pressure(), theory.at_half_width(0.25)?);
    let all = [
        ("adhesive wave of Johnson, mean pressure", pressure, theory.mean_pressure(), error, 0.0),
        ("adhesive wave of Johnson, half-width of the contact", half_width, 0.25, 6.0 * range, 0.0),
    ];
    check((&ridges(16384)?, Arc::new(Exponential::new(work, range)?), Control::MeanGap(theory.mean_gap())), &all)
}

/// A rough contact with adhesion, which is the same on one thread and on all of them, and in f32 as in f64.
fn rough() -> Outcome<Vec<Check>> {
    let spectrum = SelfAffine::default().k_l(3.0).k_r(3.0).k_s(40.0).amplitude(Amplitude::RmsHeight(5e-3)).seed(2017);
    let surface = spectrum.surface(Grid::square(NODES, 1.0)?)?;
    let contact = (&surface, Exponential::new(5e-5, 1e-3)?.into(), Control::MeanPressure(5e-3));
    let ((double, of_double), (single, of_single)) = (on_threads::<f64>(&contact)?, on_threads::<f32>(&contact)?);
    let mut checks: Vec<_> = of_double.into_iter().chain(of_single).collect();
    let gaps = [single.mean_gap, double.mean_gap, single.tolerance * double.mean_gap];
    checks.push(Check::new(&single, "rough contact, mean gap in f32 against f64", gaps));
    Ok(checks)
}

/// The report of one thread, and how many values differ from the values of all threads, but of two at least.
fn on_threads<T: Scalar>(contact: &Contact<'_>) -> Outcome<(Report, Option<Check>)> {
    let on = |count| threads::on(count, || solved::<T>(contact));
    let one = on(1)??;
    if !cfg!(feature = "parallel") {
        return Ok((one.report, None));
    }
    let all = on(threads::count().max(2))??;
    let differing = |a: &Array2<T>, b: &Array2<T>| a.iter().zip(b).filter(|(a, b)| a != b).count();
    let count = (differing(&one.gap, &all.gap) + differing(&one.pressure, &all.pressure)) as f64;
    let check = Check::new(&one.report, "rough contact, values that differ with the threads", [count, 0.0, 0.0]);
    Ok((one.report, Some(check)))
}
