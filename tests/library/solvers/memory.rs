//! How much memory solves take.

use super::*;

#[test]
fn an_iteration_allocates_nothing() {
    use std::cell::RefCell;
    let mut problem = rough::<f64>(64, 16, Exponential::new(1e-5, 1e-3).unwrap());
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| {
        let count = |iterations: usize| {
            let problem = RefCell::new(&mut problem);
            let mut renewed = 0;
            let info = allocation_counter::measure(|| {
                let solution = limited(iterations, 1e-14).solve(&mut problem.borrow_mut(), Control::MeanGap(0.01));
                // besides two applications an iteration, one each for the pressure of the gap
                let report = solution.unwrap().report;
                renewed = report.operator_applications - 2 * report.iterations;
            });
            [renewed as u64, info.count_total]
        };
        let mut count = count;
        count(1);
        let [few, many] = [count(2), count(12)];
        // the pressure of the gap takes the memory of a field in f32, and of the spectra, by turns
        assert!(many[0] > few[0]);
        assert_eq!(many[1] - few[1], 3 * (many[0] - few[0]));
    });
}

#[test]
fn a_solve_in_f32_allocates_its_five_fields_the_spectrum_and_one_for_the_answer() {
    let mut problem = rough::<f32>(256, 16, NoAdhesion);
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| {
        let problem = std::cell::RefCell::new(&mut problem);
        let info = allocation_counter::measure(|| {
            let solution = Solver::default().solve(&mut problem.borrow_mut(), Control::MeanGap(0.01)).unwrap();
            assert_eq!(solution.report.status, Status::Converged);
        });
        // besides the fields, the partial sums of a reduction, 16 numbers for 256 nodes, and the coarse space with the
        // workspace of its decomposition
        let fields = [info.bytes_total, info.bytes_max]
            .map(|bytes| (bytes as f64 - coarse_space(256 * 256)) / (256.0 * 256.0 * 4.0));
        assert!((7.0..7.25).contains(&fields[0]) && (6.0..6.2).contains(&fields[1]), "{fields:?}");
    });
}

/// The bytes of the coarse space on N nodes, in numbers of eight: 8 N^(2/3) of a triangle, and up to 5 N^(2/3) of the
/// contact map with its moments.
fn coarse_space(nodes: usize) -> f64 {
    13.0 * 8.0 * (nodes as f64).powf(2.0 / 3.0)
}

/// The most bytes at any time, in units of one field of precision T: of making the operator and the problem, and of
/// that and the solve.
fn peak<T: Real, O: ElasticOperator<T> + 'static>(
    grid: Grid,
    operator: impl Fn(Grid) -> Result<O> + Sync,
    law: Law<T>,
    control: Control,
) -> [f64; 2] {
    let surface = rough::rough(grid, 64, 1);
    let problem = || Problem::new(&surface, operator(*surface.grid()).unwrap(), law()).unwrap();
    let field = (surface.grid().nodes() * size_of::<T>()) as f64;
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| {
        let built = allocation_counter::measure(|| drop(problem()));
        let solved = allocation_counter::measure(|| {
            let report = limited(4, 1e-14).solve(&mut problem(), control).unwrap().report;
            assert_eq!(report.iterations, 4);
        });
        let solved = solved.bytes_max as f64 - coarse_space(grid.nodes());
        [built.bytes_max as f64, solved].map(|bytes| bytes / field)
    })
}

#[test]
fn a_solve_needs_five_fields_of_f64_and_seven_of_f32() {
    // for what grows less than the nodes: plans, tiles, the partial sums of a reduction; and on a line its twiddles, in
    // f64 too
    let (small, twiddles) = (0.3, 0.3);
    fn half_space<T: Real>(grid: Grid) -> Result<Westergaard<T>> {
        Westergaard::new(grid, 1.0)
    }
    let (square, line) = (Grid::square(512, 1.0).unwrap(), Grid::line(1 << 18, 1.0).unwrap());
    for (grid, control, small) in [
        (square, Control::MeanGap(0.02), small),
        (square, Control::MeanPressure(0.0125), small),
        (line, Control::MeanGap(0.02), small + twiddles),
        (line, Control::MeanPressure(0.0125), small + twiddles),
    ] {
        let laws: [Law<f64>; 3] = [
            || Box::new(NoAdhesion),
            || Box::new(MaugisDugdale::new(1.42e-4, 2.9e-3).unwrap()),
            || Box::new(Exponential::new(1.42e-4, 2.9e-3).unwrap()),
        ];
        for law in laws {
            // the spectrum and K⁻¹h; then gap and pressure, and four halves: the corrections and their spectrum
            let [built, solved] = peak(grid, half_space, law, control);
            assert!((2.0..2.0 + small).contains(&built) && (5.0..5.0 + small).contains(&solved), "{built} {solved}");
        }
        // a spectrum of the heights in f64
        let [built, solved] = peak::<f32, _>(grid, half_space, || Box::new(NoAdhesion), control);
        assert!((3.0..3.0 + small).contains(&built) && (7.0..7.0 + small).contains(&solved), "{built} {solved}");
    }
    // half a field for the stiffness of any other operator, and half of that in f32
    let layer = |grid| Spectral::isotropic(grid, 1.0, |q| q / 2.0 + 1.0);
    let [built, solved] = peak::<f64, _>(square, layer, || Box::new(NoAdhesion), Control::MeanGap(0.02));
    assert!(built < 8.0 && (5.75..5.75 + small).contains(&solved), "{built} {solved}");
}
