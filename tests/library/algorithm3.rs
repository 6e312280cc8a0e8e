//! Algorithm 3 of the paper as it is printed: what each of its misprints does, by experiment.

use asperity::solver::Criterion;
use asperity::*;
use ndarray::Array2;
use oracles::rough::rough;

/// The misprints; each can be left in.
#[derive(Clone, Copy)]
struct Printed {
    /// R is summed over I, all nodes, not over I_nc, where the surfaces are apart
    norm_over_all: bool,
    /// I_na are the contact nodes with q < 0, and they are moved by q; not by q'
    release_by_q: bool,
    /// ε alone ends the loop, whether or not I_na is empty
    epsilon_alone: bool,
    /// t is not set to zero on I_c
    direction_kept: bool,
}

/// None of them.
const RIGHT: Printed =
    Printed { norm_over_all: false, release_by_q: false, epsilon_alone: false, direction_kept: false };

#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    Converged,
    Limit,
    NotFinite,
}

/// Where the algorithm ended, with p and q of the gap that it returns.
struct Returned {
    end: End,
    iterations: usize,
    epsilon: f64,
    gap: Array2<f64>,
    q: Array2<f64>,
}

impl Returned {
    /// The mean of q where the surfaces are apart: minus the mean pressure.
    fn mean(&self) -> f64 {
        let apart = self.gap.iter().zip(&self.q).filter(|(g, _)| **g > 0.0);
        let (sum, count) = apart.fold((0.0, 0.0), |(sum, count), (_, q)| (sum + q, count + 1.0));
        sum / count
    }

    fn contact(&self) -> usize {
        self.gap.iter().filter(|&&g| g == 0.0).count()
    }

    /// The contact pressures, in order.
    fn contact_pressures(&self) -> Vec<f64> {
        let mean = self.mean();
        let touching = self.gap.iter().zip(&self.q).filter(|(g, _)| **g == 0.0);
        let mut all: Vec<f64> = touching.map(|(_, q)| q - mean).collect();
        all.sort_by(f64::total_cmp);
        all
    }

    /// How many contact nodes are under tension, and by what share of the largest pressure at worst.
    fn under_tension(&self) -> (usize, f64) {
        let all = self.contact_pressures();
        let (least, largest) = (all.first().copied().unwrap_or(0.0), all.last().copied().unwrap_or(0.0));
        (all.iter().filter(|&&p| p < 0.0).count(), -least / largest)
    }
}

/// Algorithm 3, line by line, with E* = L = 1.
fn algorithm_3(
    surface: &Surface,
    law: &impl AdhesionLaw<f64>,
    mean_gap: f64,
    (tolerance, limit): (f64, usize),
    printed: Printed,
) -> Returned {
    let mut operator = Westergaard::<f64>::new(*surface.grid(), 1.0).unwrap();
    let mut pressure = |u: &Array2<f64>| {
        let mut p = Array2::zeros(u.dim());
        operator.pressure(u.view(), p.view_mut()).unwrap();
        p
    };
    let attraction = |g: &Array2<f64>| g.mapv(|g| law.traction(g));
    let mean_over = |f: &Array2<f64>, g: &Array2<f64>| {
        let (sum, count) =
            f.iter().zip(g).fold((0.0, 0.0), |(s, n), (f, &g)| if g > 0.0 { (s + f, n + 1.0) } else { (s, n) });
        sum / count
    };

    let mut old_norm = 1.0;
    let mut delta = 0.0;
    let mut t = Array2::zeros(surface.heights().dim());
    let mut g = Array2::from_elem(t.dim(), mean_gap);
    let (mut end, mut iterations, mut epsilon) = (End::Limit, 0, f64::INFINITY);
    while iterations < limit {
        let q = pressure(&(&g + surface.heights())) + attraction(&g);
        let centred = &q - mean_over(&q, &g);
        let counted = |g: f64| printed.norm_over_all || g > 0.0;
        let norm: f64 = centred.iter().zip(&g).map(|(c, &g)| if counted(g) { c * c } else { 0.0 }).sum();
        for ((t, &c), &g) in t.iter_mut().zip(&centred).zip(&g) {
            if g > 0.0 {
                *t = c + delta * norm / old_norm * *t;
            } else if !printed.direction_kept {
                *t = 0.0;
            }
        }
        old_norm = norm;
        let r = pressure(&t);
        let mean_r = mean_over(&r, &g);
        let apart = || centred.iter().zip(&t).zip(&r).zip(&g).filter(|(_, g)| **g > 0.0).map(|(fields, _)| fields);
        let tau =
            apart().map(|((c, t), _)| c * t).sum::<f64>() / apart().map(|((_, t), r)| (r - mean_r) * t).sum::<f64>();
        g.zip_mut_with(&t, |g, t| *g = (*g - tau * t).max(0.0));

        let by = if printed.release_by_q { &q } else { &centred };
        let mut released = 0;
        for (g, &by) in g.iter_mut().zip(by) {
            if *g == 0.0 && by < 0.0 {
                *g -= tau * by;
                released += 1;
            }
        }
        delta = if released == 0 { 1.0 } else { 0.0 };
        g *= mean_gap / (g.sum() / g.len() as f64);
        epsilon = g.iter().zip(&centred).map(|(g, c)| (g * c).abs()).sum();
        iterations += 1;
        if !epsilon.is_finite() {
            end = End::NotFinite;
            break;
        }
        if epsilon < tolerance && (printed.epsilon_alone || released == 0) {
            end = End::Converged;
            break;
        }
    }
    let q = pressure(&(&g + surface.heights())) + attraction(&g);
    Returned { end, iterations, epsilon, gap: g, q }
}

fn sphere(n: usize) -> Surface {
    Surface::paraboloid(Grid::square(n, 1.0).unwrap(), 2.0).unwrap()
}

/// A rough surface of an rms slope, and its rms height.
fn rough_of_slope(slope: f64) -> (Surface, f64) {
    let unit = rough(Grid::square(64, 1.0).unwrap(), 16, 1);
    let surface = Surface::new(*unit.grid(), unit.heights().mapv(|h| slope * h)).unwrap();
    let rms = surface.rms_height();
    (surface, rms)
}

/// The sphere and the rough surface, at mean gaps from nearly half of the nodes in contact to a few.
fn hard_cases() -> Vec<(Surface, f64)> {
    let mut cases = vec![(sphere(64), 0.0398)];
    cases.extend([0.3, 0.5, 0.7, 1.0, 1.5, 2.0].map(|share| {
        let (surface, rms) = rough_of_slope(1.0);
        (surface, share * rms)
    }));
    cases
}

/// The paper's criterion, and a limit far beyond what it takes.
const PAPER: (f64, usize) = (1e-9, 1000);

/// The number of nodes in contact with a sphere at a mean gap, and the mean pressure.
pub fn of_sphere(n: usize, mean_gap: f64) -> (usize, f64) {
    let ended = algorithm_3(&sphere(n), &NoAdhesion, mean_gap, (1e-11, 1000), RIGHT);
    assert_eq!(ended.end, End::Converged);
    (ended.contact(), -ended.mean())
}

fn library(surface: &Surface, mean_gap: f64, settings: Settings) -> Solution<f64> {
    let operator = Westergaard::<f64>::new(*surface.grid(), 1.0).unwrap();
    let mut problem = Problem::new(surface, operator, NoAdhesion).unwrap();
    Solver::new(settings).solve(&mut problem, Control::MeanGap(mean_gap)).unwrap()
}

#[test]
fn corrected_it_is_the_method_of_the_library() {
    for (surface, gap) in hard_cases() {
        let here = algorithm_3(&surface, &NoAdhesion, gap, PAPER, RIGHT);
        assert!(here.end == End::Converged && here.iterations < 100 && here.under_tension().0 == 0);
        let there = library(&surface, gap, Settings::rey2017().criterion(Criterion::Complementarity)).report;
        assert_eq!((there.status, there.contact_nodes), (Status::Converged, here.contact()));
        assert!(there.iterations.abs_diff(here.iterations) <= 1, "{} {}", there.iterations, here.iterations);
        assert!((there.mean_pressure + here.mean()).abs() < 1e-7 * there.mean_pressure);
    }
}

#[test]
fn with_r_summed_over_all_nodes_it_never_converges() {
    for (surface, gap) in hard_cases() {
        let ended = algorithm_3(&surface, &NoAdhesion, gap, PAPER, Printed { norm_over_all: true, ..RIGHT });
        // it hovers about the solution: the quotient of two sums over the contact pressures is one, and t does not
        // forget
        assert!(ended.end == End::Limit && ended.epsilon > 1e3 * PAPER.0, "{:e}", ended.epsilon);
    }
}

#[test]
fn released_by_q_it_fails_where_a_contact_pressure_is_below_the_mean_pressure() {
    let mut failed = 0;
    for (surface, gap) in hard_cases() {
        let right = algorithm_3(&surface, &NoAdhesion, gap, PAPER, RIGHT);
        let printed = algorithm_3(&surface, &NoAdhesion, gap, PAPER, Printed { release_by_q: true, ..RIGHT });
        // q = λ − p̄: nodes with λ < p̄ are released for ever, though the solution holds them in contact
        let mean_pressure = -right.mean();
        assert!(mean_pressure > 0.0);
        if right.contact_pressures()[0] < mean_pressure {
            assert_eq!(printed.end, End::Limit);
            failed += 1;
        } else {
            assert!(printed.end == End::Converged && printed.iterations >= right.iterations);
            assert_eq!(printed.contact(), right.contact());
        }
    }
    // the cases are of both kinds
    assert!((1..7).contains(&failed), "{failed}");
}

#[test]
fn released_by_q_it_passes_contact_under_tension_where_the_mean_pressure_is_a_tension() {
    let surface = sphere(64);
    let (dugdale, exponential) = (MaugisDugdale::new(1e-4, 4e-3).unwrap(), Exponential::new(1e-4, 2e-3).unwrap());
    let mut inadmissible = 0;
    for i in 0..20 {
        let gap = 0.04 + 2e-4 * f64::from(i);
        for law in [&dugdale as &dyn AdhesionLaw<f64>, &exponential] {
            let right = algorithm_3(&surface, &law, gap, PAPER, RIGHT);
            assert!(right.end == End::Limit || right.under_tension().0 == 0);
            let printed = algorithm_3(&surface, &law, gap, PAPER, Printed { release_by_q: true, ..RIGHT });
            if printed.end == End::Converged && printed.under_tension().0 > 0 {
                // q = λ − p̄ is not negative until the tension exceeds the mean one
                assert!(printed.mean() > 0.0 && printed.contact_pressures()[0] >= -printed.mean());
                inadmissible += 1;
            }
        }
    }
    // most states have no contact node between the two bounds
    assert!((1..20).contains(&inadmissible), "{inadmissible}");
}

#[test]
fn stopped_on_epsilon_alone_it_returns_contact_under_tension() {
    // ε is absolute: on a surface of rms slope 1e-5 it is small from the start
    let (surface, rms) = rough_of_slope(1e-5);
    let alone = algorithm_3(&surface, &NoAdhesion, 0.5 * rms, PAPER, Printed { epsilon_alone: true, ..RIGHT });
    let (nodes, tension) = alone.under_tension();
    assert!(alone.end == End::Converged && alone.iterations < 5 && nodes > 20 && tension > 0.05, "{nodes} {tension}");
    // I_na of the last step, by the q' before it, leaves what that step did
    let step = algorithm_3(&surface, &NoAdhesion, 0.5 * rms, PAPER, RIGHT);
    let (fewer, less) = step.under_tension();
    assert!(step.end == End::Converged && (1..nodes).contains(&fewer) && less < 0.1 * tension, "{fewer} {less}");
    // I_na of the state that is returned leaves nothing
    let solution = library(&surface, 0.5 * rms, Settings::rey2017().criterion(Criterion::Complementarity));
    assert_eq!(solution.report.status, Status::Converged);
    let touching = solution.gap.iter().zip(&solution.pressure).filter(|(g, _)| **g == 0.0);
    assert!(touching.map(|(_, p)| p).all(|&p| p >= 0.0));
    // which is not yet accuracy: the certificate says so
    assert!(solution.report.relative_error > 1e-3);
}

#[test]
fn directions_kept_in_contact_spoil_the_step() {
    for (surface, gap) in hard_cases() {
        let kept = algorithm_3(&surface, &NoAdhesion, gap, PAPER, Printed { direction_kept: true, ..RIGHT });
        assert_ne!(kept.end, End::Converged);
        assert!(kept.epsilon.is_nan() || kept.epsilon > 10.0 * PAPER.0, "{:e}", kept.epsilon);
    }
}

#[test]
fn with_no_node_apart_or_one_it_divides_zero_by_zero() {
    let (surface, _) = rough_of_slope(1.0);
    for gap in [0.0, 1e-8] {
        // with one node apart q' is zero there, and so are both sums of τ
        assert_eq!(algorithm_3(&surface, &NoAdhesion, gap, PAPER, RIGHT).end, End::NotFinite);
        for settings in [Settings::rey2017().criterion(Criterion::Complementarity), Settings::default()] {
            let report = library(&surface, gap, settings).report;
            assert_eq!(report.status, Status::Converged);
            assert_eq!(report.contact_nodes, 64 * 64 - usize::from(gap > 0.0));
            assert!(report.mean_pressure.is_finite() && report.relative_error < 1e-9);
        }
    }
}

#[test]
fn the_least_q_carries_the_noise_that_the_mean_does_not() {
    let surface = sphere(64);
    let exact = algorithm_3(&surface, &NoAdhesion, 0.0398, (1e-12, 1000), RIGHT).mean();
    for exponent in 2..=10 {
        let tolerance = 10f64.powi(-exponent);
        let found = algorithm_3(&surface, &NoAdhesion, 0.0398, (tolerance, 1000), RIGHT);
        let least = found.q.iter().copied().fold(f64::INFINITY, f64::min);
        let [by_mean, by_least] = [found.mean(), least].map(|q| (q / exact - 1.0).abs());
        // relative errors of p₀, about 100 ε by the least
        assert!(by_least > 30.0 * by_mean, "{tolerance:e} {by_mean:e} {by_least:e}");
        assert!((10.0..1000.0).contains(&(by_least / tolerance)), "{tolerance:e} {by_least:e}");
    }
}

/// How fast the floor grows with the nodes along a side.
fn exponent(floors: &[(usize, f64)]) -> f64 {
    let (first, last) = (floors[0], floors[floors.len() - 1]);
    (last.1 / first.1).ln() / (last.0 as f64 / first.0 as f64).ln()
}

#[test]
fn the_floor_of_epsilon_grows_like_the_cube_of_the_nodes_along_a_side() {
    // the noise of q grows like the stiffest wave, and there are n² nodes
    let sizes = [(64, 200), (128, 300), (256, 400)];
    let printed = sizes.map(|(n, limit)| {
        let ended = algorithm_3(&sphere(n), &NoAdhesion, 0.0398, (1e-30, limit), RIGHT);
        assert_eq!(ended.end, End::Limit);
        (n, ended.epsilon)
    });
    assert!((2.7..3.3).contains(&exponent(&printed)), "{printed:?}");
    // 1.4e-11 at 512² by this
    let at_512 = printed[2].1 * 8.0;
    assert!((0.5e-11..3e-11).contains(&at_512), "{at_512:e}");
    // the library's is some times higher: it adds the pressures of gap and surface, each larger than their sum
    let ours = sizes.map(|(n, limit)| {
        let settings = Settings::rey2017().criterion(Criterion::Complementarity).tolerance(1e-30).max_iterations(limit);
        (n, library(&sphere(n), 0.0398, settings).report.complementarity)
    });
    assert!((2.5..3.7).contains(&exponent(&ours)), "{ours:?}");
    assert!(ours.iter().zip(&printed).all(|(a, b)| (1.0..20.0).contains(&(a.1 / b.1))), "{ours:?} {printed:?}");
}

#[test]
fn at_the_floor_of_rounding_the_method_keeps_what_it_has() {
    let solution =
        library(&sphere(64), 0.0398, Settings::rey2017().criterion(Criterion::Complementarity).tolerance(1e-30));
    let (points, _) = of_sphere(64, 0.0398);
    assert_eq!((solution.report.status, solution.report.contact_nodes), (Status::Stalled, points));
    assert!(solution.report.relative_error < 1e-11, "{:e}", solution.report.relative_error);
}
