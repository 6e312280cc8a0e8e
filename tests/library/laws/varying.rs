//! Works of adhesion that vary.

use super::*;

#[test]
fn flats_that_attract_in_patches_take_the_shape_of_the_closed_form() {
    // within its range the traction of Maugis and Dugdale is w/ρ at any gap: a linear problem, with one wave of w
    let (grid, half_space) = unit(32);
    let flat = Surface::from_fn(grid, |_, _| 0.0).unwrap();
    let (range, mean) = (0.1, 0.02);
    let works = grid.sample(|x, _| 1e-3 * (1.0 + 0.5 * (std::f64::consts::TAU * x).cos()));
    let law = Varying::new(MaugisDugdale::new(1e-3, range).unwrap(), works.view()).unwrap();
    assert_eq!(law.strongest(), (16, 0));
    assert!((AdhesionLaw::<f64>::hints(&law).work_of_adhesion - 1.5e-3).abs() < 1e-18);
    let mut problem = Problem::new(&flat, half_space, law).unwrap();
    let settings = Settings::default().tolerance(1e-10);
    let solution = Solver::new(settings).solve(&mut problem, Control::MeanGap(mean)).unwrap();
    assert_eq!(solution.report.status, Status::Converged);
    // p = −φ', and p̂ = ½E*q û with q = 2π
    let amplitude = 0.5 * 1e-3 / range / std::f64::consts::PI;
    let expected = grid.sample(|x, _| mean - amplitude * (std::f64::consts::TAU * x).cos());
    let off = solution.gap.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-10 * mean, "{off:e}");
    assert!((solution.report.mean_pressure + 1e-3 / range).abs() < 1e-12);
}

#[test]
fn a_wave_with_two_works_of_adhesion_is_two_waves_side_by_side() {
    // ever so long along y, so that the halves meet each other by their mean displacement alone
    let (nx, ny, long) = (64, 64, 32.0);
    let grid = Grid::new((nx, ny), (1.0, long)).unwrap();
    let surface = Surface::wave(grid, 0.02, 1).unwrap();
    let law = Exponential::new(4e-4, 8e-3).unwrap();
    let works = grid.sample(|_, y| if y < 0.0 { 4e-4 } else { 1e-4 });
    let varying = Varying::new(law, works.view()).unwrap();
    let settings = Settings::default().tolerance(1e-8);
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), varying).unwrap();
    let solution = Solver::new(settings).solve(&mut problem, Control::MeanGap(0.017)).unwrap();
    assert_eq!(solution.report.status, Status::Converged);
    let line = Grid::line(nx, 1.0).unwrap();
    let profile = Surface::wave(line, 0.02, 1).unwrap();
    for (column, work) in [(ny / 4, 4e-4), (3 * ny / 4, 1e-4)] {
        let slice = solution.gap.column(column);
        let law = Exponential::new(work, 8e-3).unwrap();
        let mut alone = Problem::new(&profile, Westergaard::<f64>::new(line, 1.0).unwrap(), law).unwrap();
        let control = Control::MeanGap(slice.mean().unwrap());
        let single = Solver::new(settings).solve(&mut alone, control).unwrap();
        let off = slice.iter().zip(&single.gap).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // what varies along y over 16 wave lengths changes the waves along x by the square of a sixteenth
        assert!(off < 4e-3 * 0.04, "column {column}: {off:e}");
        let width = |contact: usize| contact as i64;
        let touching = |gaps: &mut dyn Iterator<Item = f64>| width(gaps.filter(|&g| g == 0.0).count());
        let (a, b) = (touching(&mut slice.iter().copied()), touching(&mut single.gap.iter().copied()));
        assert!((a - b).abs() <= 1 && a > 0, "{a} {b}");
    }
}

#[test]
fn nested_grids_take_every_other_node_of_a_law_that_varies() {
    let (grid, _) = unit(128);
    let surface = rough(grid, 16, 1);
    let works = grid.sample(|x, y| if x.hypot(y) < 0.3 { 4e-4 } else { 1e-4 });
    let law = Varying::new(Exponential::new(4e-4, 2e-2).unwrap(), works.view()).unwrap();
    let control = Control::MeanGap(1.0 * surface.rms_height());
    let half_space = |grid: Grid| Westergaard::<f64>::new(grid, 1.0);
    let mut solver = Solver::default();
    let nested = Nested::default().solve(&mut solver, &surface, half_space, law.clone(), control).unwrap();
    assert!(nested.levels.len() > 1);
    let mut problem = Problem::new(&surface, half_space(grid).unwrap(), law).unwrap();
    let single = Solver::default().solve(&mut problem, control).unwrap();
    assert_eq!(nested.solution.report.status, Status::Converged);
    let off = nested.solution.gap.iter().zip(&single.gap).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-4 * surface.rms_height(), "{off:e}");
}
