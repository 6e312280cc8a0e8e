//! Elastic operators: every mode, every parity, adjointness, inverses, threads, allocations.

use std::f64::consts::{PI, TAU};

use approx::assert_relative_eq;
use asperity::elastic::check_operator;
use asperity::*;
use ndarray::{Array2, ArrayView2, ArrayViewMut2};
use proptest::prelude::*;

const SHAPES: [(usize, usize); 16] = [
    (1, 2),
    (2, 1),
    (2, 2),
    (4, 4),
    (5, 4),
    (4, 5),
    (7, 7),
    (1, 9),
    (8, 1),
    (6, 10),
    (13, 3),
    (3, 34),
    (35, 1),
    (1, 35),
    (72, 1),
    (1, 66),
];

fn noise(shape: (usize, usize), seed: u64) -> Array2<f64> {
    use rand::{RngExt, SeedableRng};
    let mut random = rand::rngs::ChaCha8Rng::seed_from_u64(seed);
    Array2::from_shape_simple_fn(shape, || random.random::<f64>() - 0.5)
}

fn apply(operator: &mut impl ElasticOperator<f64>, u: &Array2<f64>) -> Array2<f64> {
    let mut p = Array2::from_elem(u.dim(), f64::NAN);
    operator.pressure(u.view(), p.view_mut()).unwrap();
    p
}

fn dot(a: &Array2<f64>, b: &Array2<f64>) -> f64 {
    (a * b).sum() / a.len() as f64
}

#[test]
fn every_wave_needs_its_pressure_to_rounding() {
    for shape in SHAPES {
        let (lengths, modulus) = ((1.5, 0.7), 3.0);
        let grid = Grid::new(shape, lengths).unwrap();
        let mut operator = Westergaard::new(grid, modulus).unwrap();
        for kx in 0..shape.0 {
            for ky in 0..shape.1 {
                let q = grid.wave_number_x(kx).hypot(grid.wave_number_y(ky));
                for phase in [0.0, 0.5 * PI] {
                    let wave = Array2::from_shape_fn(shape, |(i, j)| {
                        // the turns are reduced as integers, so that their rounding does not grow with the index
                        let turn = |a: usize, n: usize| (a % n) as f64 / n as f64;
                        (TAU * (turn(i * kx, shape.0) + turn(j * ky, shape.1)) + phase).cos()
                    });
                    let p = apply(&mut operator, &wave);
                    for (&p, &u) in p.iter().zip(&wave) {
                        assert_relative_eq!(p, 0.5 * modulus * q * u, epsilon = 1e-14 * modulus * (q + 1.0) * 8.0);
                    }
                }
            }
        }
    }
}

#[test]
fn displacement_inverts_pressure_and_both_ignore_the_mean() {
    for shape in SHAPES {
        let grid = Grid::new(shape, (1.0, 2.0)).unwrap();
        let mut operator = Westergaard::new(grid, 0.3).unwrap();
        let u = noise(shape, 3) + 7.0;
        let p = apply(&mut operator, &u);
        assert!(p.sum().abs() < 1e-12);
        let mut back = Array2::zeros(shape);
        operator.displacement((&p + 11.0).view(), back.view_mut()).unwrap();
        let mean = u.sum() / u.len() as f64;
        for (&back, &u) in back.iter().zip(&u) {
            assert_relative_eq!(back, u - mean, epsilon = 1e-12);
        }
    }
}

#[test]
fn the_stiffness_range_is_that_of_the_grid() {
    let grid = Grid::new((8, 6), (1.0, 2.0)).unwrap();
    let (softest, stiffest) = Westergaard::<f64>::new(grid, 2.0).unwrap().stiffness_range();
    assert_relative_eq!(softest, PI, max_relative = 1e-15);
    assert_relative_eq!(stiffest, (8.0 * PI).hypot(3.0 * PI), max_relative = 1e-15);
}

/// An operator with the required methods alone.
struct Plain(Westergaard<f64>);

impl ElasticOperator<f64> for Plain {
    fn grid(&self) -> &Grid {
        self.0.grid()
    }
    fn pressure(&mut self, u: ArrayView2<'_, f64>, p: ArrayViewMut2<'_, f64>) -> Result<()> {
        self.0.pressure(u, p)
    }
    fn displacement(&mut self, p: ArrayView2<'_, f64>, u: ArrayViewMut2<'_, f64>) -> Result<()> {
        self.0.displacement(p, u)
    }
    fn stiffness_range(&self) -> (f64, f64) {
        self.0.stiffness_range()
    }
    fn modulus(&self) -> f64 {
        self.0.modulus()
    }
}

#[test]
fn a_plain_operator_solves_the_same_problem() {
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = oracles::rough::rough(grid, 16, 1);
    let mut fast = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let mut plain = Problem::new(&surface, Plain(Westergaard::new(grid, 1.0).unwrap()), NoAdhesion).unwrap();
    for control in [Control::MeanPressure(0.05), Control::MeanGap(0.02)] {
        let a = oracles::solve(&mut fast, control, 1e-10);
        let b = oracles::solve(&mut plain, control, 1e-10);
        assert_eq!((a.report.status, b.report.status), (Status::Converged, Status::Converged));
        assert_eq!(a.report.contact_nodes, b.report.contact_nodes);
        assert_relative_eq!(a.report.mean_gap, b.report.mean_gap, max_relative = 1e-9);
    }
}

#[test]
fn anisotropic_symbols_act_on_their_waves() {
    for shape in [(8, 8), (7, 8), (8, 7), (5, 9)] {
        let grid = Grid::new(shape, (1.0, 1.0)).unwrap();
        let symbol = |qx: f64, qy: f64| (qx * qx + 0.25 * qy * qy + 0.3 * qx * qy).sqrt();
        let mut operator = Spectral::<f64>::new(grid, 1.0, symbol).unwrap();
        for (kx, ky) in [(1, 0), (0, 1), (2, 1), (shape.0 - 1, 2), (3, shape.1 - 1)] {
            let (qx, qy) = (grid.wave_number_x(kx), grid.wave_number_y(ky));
            let wave = Array2::from_shape_fn(shape, |(i, j)| {
                (TAU * ((i * kx) as f64 / shape.0 as f64 + (j * ky) as f64 / shape.1 as f64)).cos()
            });
            let p = apply(&mut operator, &wave);
            for (&p, &u) in p.iter().zip(&wave) {
                assert_relative_eq!(p, symbol(qx, qy) * u, epsilon = 1e-11);
            }
        }
        // the Nyquist waves, with an undefined sign of q, keep the operator symmetric
        let (a, b) = (noise(shape, 5), noise(shape, 6));
        assert_relative_eq!(dot(&a, &apply(&mut operator, &b)), dot(&b, &apply(&mut operator, &a)), epsilon = 1e-13);
    }
}

#[test]
fn bad_operators_are_refused() {
    let grid = Grid::square(4, 1.0).unwrap();
    for modulus in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Westergaard::<f64>::new(grid, modulus).is_err());
    }
    assert!(Westergaard::<f32>::new(grid, 1e300).is_err(), "the stiffness does not fit f32");
    assert!(Spectral::<f64>::new(grid, 1.0, |qx, _| qx).is_err(), "negative and zero stiffness");
    let mut operator = Westergaard::<f64>::new(grid, 1.0).unwrap();
    let mut out = Array2::zeros((4, 4));
    let error = operator.pressure(Array2::zeros((4, 5)).view(), out.view_mut()).unwrap_err();
    assert_eq!(error.to_string(), "operator input has shape 4 x 5: it must be 4 x 4");
}

#[test]
fn an_application_after_the_first_allocates_nothing() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| {
        for shape in [(64, 64), (4096, 1), (1, 4095), (4, 100)] {
            let grid = Grid::new(shape, (1.0, 1.0)).unwrap();
            let mut operator = Westergaard::<f64>::new(grid, 1.0).unwrap();
            let (u, mut p) = (noise(shape, 1), Array2::zeros(shape));
            // the first takes the memory of the spectrum
            operator.pressure(u.view(), p.view_mut()).unwrap();
            let count = allocation_counter::measure(|| {
                operator.pressure(u.view(), p.view_mut()).unwrap();
                operator.displacement(u.view(), p.view_mut()).unwrap();
            });
            assert_eq!(count.count_total, 0, "{shape:?}");
        }
    });
}

#[test]
fn a_line_is_a_plane_without_waves_across() {
    // many divisors, few, none
    for n in [720, 735, 766, 769] {
        let [along_x, along_y, plane] = [(n, 1), (1, n), (n, 2)].map(|shape| {
            let grid = Grid::new(shape, (2.0, 2.0)).unwrap();
            let line = noise((n, 1), 4);
            let u = Array2::from_shape_fn(shape, |(i, j)| line[[if shape.0 == n { i } else { j }, 0]]);
            let p = apply(&mut Westergaard::new(grid, 3.0).unwrap(), &u);
            let mut single = Array2::zeros(shape);
            let operator = &mut Westergaard::<f32>::new(grid, 3.0).unwrap();
            operator.pressure(u.mapv(|u| u as f32).view(), single.view_mut()).unwrap();
            // some roundings of the stiffest wave
            let size = 3.0 * PI * n as f64 / 2.0;
            for (&single, &p) in single.iter().zip(&p) {
                assert!((f64::from(single) - p).abs() < 4.0 * f64::from(f32::EPSILON) * size, "{shape:?} {single} {p}");
            }
            let first = p.iter().step_by(if shape == (n, 2) { 2 } else { 1 });
            (first.copied().collect::<Vec<_>>(), size)
        });
        for ((a, b), c) in along_x.0.iter().zip(&along_y.0).zip(&plane.0) {
            assert_eq!(a, b);
            assert!((a - c).abs() < 4.0 * f64::EPSILON * plane.1, "{n} {a} {c}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_operator_is_linear_symmetric_and_positive(
        nx in 1_usize..14, ny in 1_usize..14, lx in 0.1_f64..10.0, ly in 0.1_f64..10.0, seed in 0_u64..1000,
    ) {
        let grid = Grid::new((nx, ny), (lx, ly)).unwrap();
        prop_assume!(nx * ny > 1);
        let mut operator = Westergaard::new(grid, 1.0).unwrap();
        let (a, b) = (noise((nx, ny), seed), noise((nx, ny), seed + 1));
        let (ka, kb) = (apply(&mut operator, &a), apply(&mut operator, &b));
        let sum = apply(&mut operator, &(&a + &b));
        let size = operator.stiffness_range().1;
        for ((s, a), b) in sum.iter().zip(&ka).zip(&kb) {
            prop_assert!((s - a - b).abs() <= 1e-13 * size);
        }
        prop_assert!((dot(&a, &kb) - dot(&b, &ka)).abs() <= 1e-13 * size);
        let varies = a.iter().any(|x| (x - a[[0, 0]]).abs() > 1e-3);
        prop_assert!(!varies || dot(&a, &ka) > 0.0);
    }
}

/// An operator with one of its promises broken.
struct Broken(Westergaard<f64>, u8);

impl ElasticOperator<f64> for Broken {
    fn grid(&self) -> &Grid {
        self.0.grid()
    }
    fn pressure(&mut self, u: ArrayView2<'_, f64>, mut p: ArrayViewMut2<'_, f64>) -> asperity::Result<()> {
        self.0.pressure(u, p.view_mut())?;
        match self.1 {
            1 => p.mapv_inplace(|p| p + 1e-6),
            2 => {
                p.row_mut(0).mapv_inplace(|p| 1.001 * p);
                let mean = p.mean().unwrap();
                p.mapv_inplace(|p| p - mean);
            }
            _ => {}
        }
        Ok(())
    }
    fn displacement(&mut self, p: ArrayView2<'_, f64>, mut u: ArrayViewMut2<'_, f64>) -> asperity::Result<()> {
        self.0.displacement(p, u.view_mut())?;
        if self.1 == 3 {
            u.mapv_inplace(|u| 1.0001 * u);
        }
        Ok(())
    }
    fn stiffness_range(&self) -> (f64, f64) {
        let (softest, stiffest) = self.0.stiffness_range();
        match self.1 {
            4 => (1.01 * softest, stiffest),
            5 => (softest, 0.9 * stiffest),
            _ => (softest, stiffest),
        }
    }
    fn modulus(&self) -> f64 {
        self.0.modulus()
    }
}

#[test]
fn a_clone_of_an_operator_is_the_operator_and_has_a_spectrum_of_its_own() {
    for shape in [(24, 15), (64, 1)] {
        let grid = Grid::new(shape, (1.0, 0.7)).unwrap();
        let mut half_space = Westergaard::<f64>::new(grid, 3.0).unwrap();
        let mut layer = Spectral::<f64>::isotropic(grid, 1.0, |q| 10.0 + 0.5 * q).unwrap();
        let u = grid.sample(|x, y| (7.0 * x).sin() + (9.0 * y).cos());
        let before = [apply(&mut half_space, &u), apply(&mut layer, &u)];
        let (mut other, mut another) = (half_space.clone(), layer.clone());
        // while the clone is dropped or used, the operator stays as it was
        apply(&mut half_space, &(2.0 * &u));
        drop(layer);
        assert_eq!([apply(&mut other, &u), apply(&mut another, &u)], before);
        assert_eq!(other.stiffness_range(), half_space.stiffness_range());
        check_operator(&mut other).unwrap();
    }
}

#[test]
fn every_operator_and_every_wrapper_keeps_the_contract() {
    fn conforms<T: Real>(mut operator: impl ElasticOperator<T> + 'static) {
        check_operator(&mut operator).unwrap();
        let mut boxed: Box<dyn ElasticOperator<T>> = Box::new(operator);
        check_operator(&mut boxed).unwrap();
    }
    fn all<T: Real>(grid: Grid) {
        // the modulus of steel in Pa, and the modulus of a gel in GPa
        for modulus in [3.0, 2e11, 1e-6] {
            conforms(Westergaard::<T>::new(grid, modulus).unwrap());
        }
        conforms(Spectral::<T>::isotropic(grid, 1.0, |q| 10.0 + 0.5 * q).unwrap());
        conforms(Spectral::<T>::new(grid, 1.0, |qx, qy| 0.5 * (qx * qx + 2.0 * qy * qy).sqrt()).unwrap());
        if let Ok(free) = Boussinesq::<T>::new(grid, 2.0) {
            conforms(free);
        }
    }
    for shape in [(24, 15), (64, 1), (1, 33), (2, 2)] {
        let grid = Grid::new(shape, (1.0, 0.7)).unwrap();
        all::<f64>(grid);
        all::<f32>(grid);
    }
}

#[test]
fn the_checker_names_what_is_broken() {
    let grid = Grid::new((24, 15), (1.0, 0.7)).unwrap();
    let broken = |kind| check_operator(&mut Broken(Westergaard::new(grid, 1.0).unwrap(), kind));
    broken(0).unwrap();
    for (kind, named) in [
        (1, "mean of a pressure"),
        (2, "symmetry of the stiffness"),
        (3, "displacement by a pressure"),
        (4, "softest stiffness"),
        (5, "stiffest stiffness"),
    ] {
        match broken(kind) {
            Err(Error::Contract { function: property, .. }) => {
                assert!(property.starts_with(named), "{kind}: {property}")
            }
            other => panic!("{kind}: {other:?}"),
        }
    }
}
