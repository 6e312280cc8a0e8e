//! Nested grids: they find what the finest grid alone finds, with less work, and need no more memory.

use asperity::nested::NestedSolution;
use asperity::*;
use oracles::rough;

type Law<T> = Box<dyn AdhesionLaw<T>>;

fn half_space<T: Real>(grid: Grid) -> Result<Westergaard<T>> {
    Westergaard::new(grid, 1.0)
}

fn surface(n: usize, seed: u64) -> Surface {
    rough::rough(Grid::square(n, 1.0).unwrap(), 64, seed)
}

fn none<T: Real>() -> Law<T> {
    Box::new(NoAdhesion)
}

/// Resolved on 128² nodes.
fn exponential<T: Real>() -> Law<T> {
    Box::new(Exponential::new(1.42e-4, 2.9e-3).unwrap())
}

fn solve<T: Real>(surface: &Surface, law: Law<T>, control: Control, tolerance: f64) -> NestedSolution<T> {
    let mut solver = Solver::new(Settings::default().tolerance(tolerance));
    let found = Nested::default().solve(&mut solver, surface, half_space::<T>, law, control).unwrap();
    let report = &found.solution.report;
    assert_eq!(report.status, Status::Converged);
    assert!(report.relative_error <= tolerance && report.load_error <= tolerance);
    found
}

fn single<T: Real>(surface: &Surface, law: Law<T>, control: Control, tolerance: f64) -> Solution<T> {
    let mut problem = Problem::new(surface, half_space::<T>(*surface.grid()).unwrap(), law).unwrap();
    Solver::new(Settings::default().tolerance(tolerance)).solve(&mut problem, control).unwrap()
}

fn shapes<T: Real>(found: &NestedSolution<T>) -> Vec<(usize, usize)> {
    found.levels.iter().map(|level| level.shape).collect()
}

const PRESSED: Control = Control::MeanPressure(0.0132);
const SQUEEZED: Control = Control::MeanPressure(0.18);
const APART: Control = Control::MeanGap(0.022);
const CLOSE: Control = Control::MeanGap(0.0044);

/// No more than what was counted, to one decimal, and what rounding, which differs between processors, may add. The
/// counts are printed by `cargo test --release --test library nested:: -- --nocapture`.
#[track_caller]
fn takes<T: Real>(found: &NestedSolution<T>, counted: f64) {
    let taken = found.equivalent_applications();
    println!("{taken:.1} of {counted}");
    assert!(taken <= counted + 2.05, "{taken} and not {counted}");
}

#[test]
fn nested_grids_take_few_applications() {
    for (n, control, fine, coarse) in [
        (512, PRESSED, 32.6, 17.6),
        (512, SQUEEZED, 29.5, 15.5),
        (512, APART, 28.5, 15.5),
        (512, CLOSE, 31.4, 15.4),
        (1024, PRESSED, 28.9, 14.9),
        (1024, SQUEEZED, 26.9, 12.9),
        (1024, APART, 26.9, 12.9),
        (1024, CLOSE, 26.9, 12.9),
    ] {
        for (tolerance, counted) in [(1e-6, fine), (1e-3, coarse)] {
            takes(&solve::<f64>(&surface(n, 1), none(), control, tolerance), counted);
        }
    }
}

#[test]
fn other_surfaces_laws_and_precisions_take_few_applications() {
    for (seed, pressed, apart) in [(2, 32.6, 28.5), (3, 29.6, 28.5), (4, 32.6, 29.5)] {
        takes(&solve::<f64>(&surface(512, seed), none(), PRESSED, 1e-6), pressed);
        takes(&solve::<f64>(&surface(512, seed), none(), APART, 1e-6), apart);
    }
    for (control, counted, single) in [(PRESSED, 39.9, 28.6), (APART, 31.3, 28.5)] {
        takes(&solve::<f64>(&surface(512, 1), exponential(), control, 1e-6), counted);
        takes(&solve::<f32>(&surface(512, 1), none(), control, 1e-5), single);
    }
}

/// Equilibria that agree to a relative error of mean gap and mean pressure, and but for so many nodes in contact.
#[track_caller]
fn agree<T: Real>(nested: &NestedSolution<T>, single: &Solution<T>, relative: f64, nodes: usize) {
    let (found, single) = (&nested.solution.report, &single.report);
    assert!((found.mean_gap / single.mean_gap - 1.0).abs() < relative);
    assert!((found.mean_pressure / single.mean_pressure - 1.0).abs() < relative);
    assert!(found.contact_nodes.abs_diff(single.contact_nodes) <= nodes);
}

#[test]
fn nested_grids_find_what_the_finest_finds() {
    for control in [PRESSED, APART] {
        for law in [none::<f64>, exponential] {
            let surface = surface(512, 1);
            agree(&solve(&surface, law(), control, 1e-6), &single(&surface, law(), control, 1e-6), 1e-5, 5);
        }
        let surface = surface(256, 5);
        agree(&solve::<f32>(&surface, none(), control, 1e-5), &single(&surface, none(), control, 1e-5), 1e-4, 5);
    }
}

#[test]
fn a_level_says_what_it_found() {
    let surface = surface(256, 1);
    let NestedSolution { solution, levels, .. } = solve::<f64>(&surface, none(), PRESSED, 1e-6);
    let (finest, report) = (levels.last().unwrap(), &solution.report);
    let area = contact::ContactArea::of_solution(&solution).unwrap();
    assert_eq!((finest.mean_gap, finest.mean_pressure), (report.mean_gap, report.mean_pressure));
    assert_eq!((finest.elastic_energy, finest.area), (report.elastic_energy, area));
    // the shortest wave has four nodes on the finest grid, so that coarser ones agree roughly
    for level in &levels {
        assert_eq!(level.mean_pressure, report.mean_pressure);
        assert!((level.mean_gap / report.mean_gap - 1.0).abs() < 0.1, "{level:?}");
        assert!(level.area.corrected_contact_fraction < level.area.contact_fraction);
    }
}

#[test]
fn lines_and_rectangles_have_nested_grids_too() {
    let line = Grid::line(4096, 1.0).unwrap();
    let (long, wide) = (Grid::new((384, 256), (1.5, 1.0)).unwrap(), Grid::new((160, 320), (1.0, 2.0)).unwrap());
    for grid in [line, long, wide] {
        let surface = rough::rough(grid, 48, 1);
        for control in [Control::MeanPressure(0.02), Control::MeanGap(0.02)] {
            agree(&solve::<f64>(&surface, none(), control, 1e-6), &single(&surface, none(), control, 1e-6), 1e-5, 3);
        }
    }
}

#[test]
fn a_single_row_is_solved_as_a_single_column() {
    let column = rough::rough(Grid::line(1024, 1.0).unwrap(), 48, 1);
    let row = Grid::new((1, 1024), (1.0, 1.0)).unwrap();
    let row = Surface::new(row, column.heights().t().to_owned()).unwrap();
    let law = || Box::new(Exponential::new(1e-5, 1e-3).unwrap());
    let [column, row] = [column, row].map(|surface| solve::<f64>(&surface, law(), PRESSED, 1e-8));
    let applications = |found: &NestedSolution<f64>| -> Vec<_> {
        found.levels.iter().map(|level| level.operator_applications).collect()
    };
    assert_eq!((row.levels.len(), applications(&row)), (5, applications(&column)));
    let [a, b] = [&row, &column].map(|found| &found.solution.report);
    assert_eq!((a.mu_rho, a.contact_nodes), (b.mu_rho, b.contact_nodes));
    assert!((a.mean_gap / b.mean_gap - 1.0).abs() < 1e-8);
}

#[test]
fn odd_sizes_have_nested_grids_too() {
    let surface = surface(511, 1);
    for control in [PRESSED, APART] {
        let (found, alone) = (solve::<f64>(&surface, none(), control, 1e-6), single(&surface, none(), control, 1e-6));
        assert_eq!(shapes(&found), [(64, 64), (128, 128), (256, 256), (511, 511)]);
        agree(&found, &alone, 1e-5, 5);
        assert!(found.equivalent_applications() < 1.05 * (alone.report.operator_applications + 1) as f64);
    }
}

#[test]
fn surfaces_that_are_nearly_closed_start_anew_on_the_finest_grid() {
    let surface = surface(256, 1);
    let control = Control::MeanPressure(10.0);
    let (found, alone) = (solve::<f64>(&surface, none(), control, 1e-6), single(&surface, none(), control, 1e-6));
    assert_eq!(shapes(&found), [(64, 64), (256, 256)]);
    assert_eq!(found.solution, alone);
}

#[test]
fn laws_that_jump_are_smoothed_on_the_way() {
    let sphere = Surface::paraboloid(Grid::square(512, 1.0).unwrap(), 2.0).unwrap();
    let law = || -> Law<f64> { Box::new(MaugisDugdale::new(1e-4, 2e-3).unwrap()) };
    for control in [Control::MeanGap(0.0429), Control::MeanPressure(-5e-4)] {
        agree(&solve(&sphere, law(), control, 1e-6), &single(&sphere, law(), control, 1e-6), 1e-4, 10);
    }
}

#[test]
fn grids_that_do_not_resolve_adhesion_have_the_short_law_or_are_left_out() {
    let exponential = |range| -> Law<f64> { Box::new(Exponential::new(1.42e-4, range).unwrap()) };
    // μ_ρ on the finest grid: 1.17, and 0.37
    assert_eq!(shapes(&solve::<f64>(&surface(512, 1), exponential(4.5e-4), APART, 1e-3)), [(512, 512)]);
    let found = solve::<f64>(&surface(512, 1), exponential(1.42e-3), APART, 1e-3);
    assert_eq!(shapes(&found), [(64, 64), (128, 128), (256, 256), (512, 512)]);
    agree(&found, &single(&surface(512, 1), exponential(1.42e-3), APART, 1e-3), 2e-3, 20);
    assert_eq!(shapes(&solve::<f32>(&surface(256, 1), none(), APART, 1e-3)), [(64, 64), (128, 128), (256, 256)]);
}

#[test]
fn a_law_that_the_grid_hardly_resolves_is_led_by_one_without_a_range_on_loading() {
    let (surface, w) = (surface(256, 1), 1.42e-4_f64);
    let law = || -> Law<f64> { Box::new(Exponential::new(w, (w / 256.0).sqrt()).unwrap()) };
    let (nested, alone) = (solve(&surface, law(), PRESSED, 1e-3), single(&surface, law(), PRESSED, 1e-3));
    assert_eq!(shapes(&nested), [(64, 64), (128, 128), (256, 256)]);
    agree(&nested, &alone, 0.02, alone.report.contact_nodes / 100);
    takes(&nested, 0.7 * alone.report.operator_applications as f64);
    let mut solver = Solver::new(Settings::default().branch(Branch::Unloading));
    let unloaded = Nested::default().solve(&mut solver, &surface, half_space, law(), PRESSED).unwrap();
    assert_eq!(shapes(&unloaded), [(256, 256)]);
}

#[test]
fn nested_grids_need_no_more_memory_than_the_finest_alone() {
    /// The most bytes at any time, in units of one field of precision T.
    fn peak<T: Real>(law: fn() -> Law<T>, control: Control) -> f64 {
        let surface = surface(512, 1);
        let field = (surface.grid().nodes() * size_of::<T>()) as f64;
        rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| {
            let info = allocation_counter::measure(|| drop(solve::<T>(&surface, law(), control, 1e-2)));
            // without the coarse space, on N nodes: 8 N^(2/3) numbers in f64, and up to 5 N^(2/3) for a contact map
            // with its moments
            (info.bytes_max as f64 - 13.0 * 8.0 * (surface.grid().nodes() as f64).powf(2.0 / 3.0)) / field
        })
    }
    // five, with the start; in f32 seven, or six and the start while the heights are in f64; the rest is what does not
    // grow with the nodes
    for control in [PRESSED, APART] {
        for peak in [peak::<f64>(none, control), peak::<f64>(exponential, control)] {
            assert!((5.0..5.3).contains(&peak), "{peak}");
        }
        let peak = peak::<f32>(none, control);
        assert!((7.0..7.3).contains(&peak), "{peak}");
    }
}

#[test]
#[ignore = "half a minute: cargo test --release --test library nested::the_short_law -- --ignored --nocapture"]
fn the_short_law_of_coarser_grids_leads_to_the_same_contacts() {
    println!("| law | μ_ρ | adhesion | same contacts | nodes that differ, of those in contact | one grid | nested |");
    println!("|---|---|---|---|---|---|---|");
    let spacing = 1.0_f64 / 256.0;
    // adhesion that adds little to the contact, and adhesion that makes the most of it
    for (adhesion, times) in [("moderate", 1.0), ("strong", 8.0)] {
        for mu_rho in [None, Some(0.3), Some(0.4), Some(0.5), Some(0.7), Some(1.0)] {
            let (mut same, mut differing, mut contact) = (0, 0, 0);
            let mut applications = [0.0; 2];
            for seed in 0..40 {
                let grid = Grid::square(256, 1.0).unwrap();
                let k_s = [16.0, 32.0, 64.0][seed as usize % 3];
                let surface = SelfAffine::default().amplitude(Amplitude::RmsSlope(0.2)).k_l(2.0).k_s(k_s).seed(seed);
                let surface = surface.surface(grid).unwrap();
                let w = times * [1e-6, 3e-6, 1e-5, 2e-5][seed as usize % 4];
                let law = || -> Law<f64> {
                    match mu_rho {
                        Some(mu_rho) => Box::new(Exponential::new(w, (w * spacing).sqrt() / mu_rho).unwrap()),
                        None => Box::new(Jkr::new(w).unwrap()),
                    }
                };
                let control = Control::MeanPressure([1e-4, 0.002, 0.01, 0.03, 0.06][seed as usize % 5]);
                let alone = single::<f64>(&surface, law(), control, 1e-6);
                let nested = solve::<f64>(&surface, law(), control, 1e-6);
                let apart =
                    alone.contact_map().iter().zip(&nested.solution.contact_map()).filter(|(a, b)| a != b).count();
                same += usize::from(apart == 0);
                differing += apart;
                contact += alone.report.contact_nodes;
                let taken = [alone.report.operator_applications as f64 + 1.0, nested.equivalent_applications()];
                applications.iter_mut().zip(taken).for_each(|(sum, taken)| *sum += taken);
            }
            let [one, nested] = applications.map(|sum| sum / 40.0);
            let (name, range) = mu_rho.map_or(("jkr", String::new()), |mu_rho| ("exponential", mu_rho.to_string()));
            println!(
                "| {name} | {range} | {adhesion} | {same} of 40 | {differing} of {contact} | {one:.0} | {nested:.0} |"
            );
            // nodes at the edge may be decided by the tolerance, and without a range by the grids before
            assert!(times > 1.0 || mu_rho > Some(0.5) || differing * 1000 <= contact, "{differing} of {contact}");
        }
    }
}
