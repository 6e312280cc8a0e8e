//! Elastic bodies by the stiffness of their waves: the equations of elasticity, limits, and contact on them.

use approx::assert_relative_eq;
use asperity::elastic::{Base, Body, Coating, HalfSpace, Layer, Material, Plate, Series, check_operator};
use asperity::*;

fn material(modulus: f64, poisson: f64) -> Material {
    Material::new(modulus, poisson).unwrap()
}

fn bonded(thickness: f64, poisson: f64) -> Layer {
    Layer::new(material(1.0, poisson), thickness, Base::Bonded).unwrap()
}

fn sliding(thickness: f64) -> Layer {
    Layer::new(material(1.0, 0.3), thickness, Base::Sliding).unwrap()
}

fn stiffness(body: &impl Body, q: f64) -> f64 {
    body.stiffness(0.6 * q, -0.8 * q)
}

/// The amplitudes [U, W, T, S] of a wave, u_x = U sin qx, u_z = W cos qx, σ_xz = T sin qx, σ_zz = S cos qx, z upwards.
type State = [f64; 4];

/// The stiffness of a wave on a plate of a material, by integrating the equations of plane strain through its
/// thickness: four linear equations in these amplitudes, with right-hand sides that stay finite for ν = ½. Two possible
/// states at the lower face are carried to the free face, and combined there so that T = 0.
fn integrated(q: f64, thickness: f64, material: Material, lower: [State; 2]) -> f64 {
    let (e, nu) = (material.modulus(), material.poisson());
    let side = nu / (1.0 - nu);
    let slope = |[u, w, t, s]: State| {
        let squeeze = (1.0 - 2.0 * nu) / (1.0 - nu).powi(2) / e;
        [q * w + t / material.shear_modulus(), squeeze * s - side * q * u, e * q * q * u + side * q * s, -q * t]
    };
    let add = |y: State, k: State, h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
    let carry = |mut y: State| {
        let steps = 4000;
        let h = thickness / f64::from(steps);
        for _ in 0..steps {
            let a = slope(y);
            let b = slope(add(y, a, 0.5 * h));
            let c = slope(add(y, b, 0.5 * h));
            let d = slope(add(y, c, h));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        y
    };
    let [y, z] = lower.map(carry);
    let mix = |i: usize| z[2] * y[i] - y[2] * z[i];
    mix(3) / mix(1)
}

/// The two states on top of a half-space that vanish in its depth: v e^(qz) and (w + zv) e^(qz) of the same equations.
fn on_half_space(q: f64, material: Material) -> [State; 2] {
    let (e, nu) = (material.modulus(), material.poisson());
    let t = e * q * (1.0 - nu);
    [[1.0, -1.0, t, -t], [0.0, (3.0 - 4.0 * nu) / q, -e * (1.0 - 2.0 * nu) * (1.0 - nu), 2.0 * e * (1.0 - nu).powi(2)]]
}

const BONDED: [State; 2] = [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
const SLIDING: [State; 2] = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

#[test]
fn the_symbols_of_a_layer_solve_its_equations() {
    for x in [0.05, 0.3, 1.0, 2.0, 4.0] {
        let (q, t) = (x / 0.7, 0.7);
        for nu in [0.0, 0.3, 0.45, 0.5] {
            assert_relative_eq!(
                stiffness(&bonded(t, nu), q),
                integrated(q, t, material(1.0, nu), BONDED),
                max_relative = 1e-9
            );
            // what Poisson's ratio does is in E* alone
            assert_relative_eq!(
                stiffness(&sliding(t), q),
                integrated(q, t, material(1.0, nu), SLIDING),
                max_relative = 1e-9
            );
        }
    }
}

#[test]
fn a_thick_layer_is_the_half_space_but_for_exp_minus_two_q_t() {
    for nu in [0.0, 0.3, 0.5] {
        for x in [4.0_f64, 6.0, 8.0, 10.0] {
            let decay = (-2.0 * x).exp();
            // to leading order, from the closed forms
            let (a, b) = (3.0 - 4.0 * nu, 5.0 - 12.0 * nu + 8.0 * nu * nu);
            let above = 2.0 * stiffness(&bonded(x, nu), 1.0) - 1.0;
            assert_relative_eq!(above, 2.0 / a * (2.0 * x * x + 2.0 * x + b) * decay, max_relative = 0.1);
            let above = 2.0 * stiffness(&sliding(x), 1.0) - 1.0;
            assert_relative_eq!(above, (4.0 * x + 2.0) * decay, max_relative = 0.1);
        }
        assert_relative_eq!(stiffness(&bonded(1e9, nu), 3.0), 1.5, max_relative = 1e-15);
    }
    assert_relative_eq!(stiffness(&sliding(1e9), 3.0), 1.5, max_relative = 1e-15);
}

#[test]
fn a_thin_layer_is_a_foundation_of_springs_or_flows_if_it_is_incompressible() {
    for x in [1e-2, 3e-3, 1e-3] {
        let (q, t) = (5.0, x / 5.0);
        for nu in [0.0, 0.3, 0.45] {
            // the modulus against compression without strain sideways, E(1 − ν)/((1 + ν)(1 − 2ν)) with E = 1 − ν²
            let confined = (1.0 - nu * nu) * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
            assert_relative_eq!(material(1.0, nu).confined_modulus(), confined, max_relative = 1e-14);
            let softer = (stiffness(&bonded(t, nu), q) * t / confined - 1.0).abs();
            assert!(softer < 10.0 * (x / (1.0 - 2.0 * nu)).powi(2), "{nu} {x} {softer}");
        }
        assert_relative_eq!(stiffness(&sliding(t), q) * t, 1.0, max_relative = x * x);
        // 3G/(q²t³), E* = 4G: the lubrication of a narrow gap; in units of the half-space's 3/2 (qt)⁻³
        assert_relative_eq!(stiffness(&bonded(t, 0.5), q) * q * q * t.powi(3), 0.75, max_relative = 2.0 * x * x);
        assert_relative_eq!(stiffness(&bonded(t, 0.5), q) / (0.5 * q), 1.5 * x.powi(-3), max_relative = 2.0 * x * x);
    }
}

fn on(body: impl Body + 'static, n: usize, control: Control) -> Solution<f64> {
    let grid = Grid::square(n, 1.0).unwrap();
    let operator = Spectral::of(grid, body).unwrap();
    oracles::solve(&mut Problem::new(&oracles::rough::rough(grid, 12, 3), operator, NoAdhesion).unwrap(), control, 1e-8)
}

#[test]
fn contact_on_a_thick_layer_is_that_on_the_half_space() {
    let grid = Grid::square(64, 1.0).unwrap();
    let half_space = Westergaard::<f64>::new(grid, 1.0).unwrap();
    let mut problem = Problem::new(&oracles::rough::rough(grid, 12, 3), half_space, NoAdhesion).unwrap();
    for control in [Control::MeanPressure(0.05), Control::MeanGap(0.02)] {
        let expected = oracles::solve(&mut problem, control, 1e-8);
        let mut last = f64::INFINITY;
        for thickness in [0.25, 0.5, 1.0, 2.0] {
            for solution in [on(sliding(thickness), 64, control), on(bonded(thickness, 0.5), 64, control)] {
                assert_eq!(solution.report.status, Status::Converged);
                // the softest wave has q = 2π
                let x = std::f64::consts::TAU * thickness;
                let bound = 8.0 * (x + 1.0).powi(2) * (-2.0 * x).exp() + 1e-6;
                let error = (&solution.contact_pressure - &expected.contact_pressure)
                    .iter()
                    .fold(0.0_f64, |largest, p| largest.max(p.abs()));
                let peak = expected.contact_pressure.iter().copied().fold(0.0, f64::max);
                assert!(error < bound * peak, "{thickness} {error} {bound} {peak}");
                last = error / peak;
            }
        }
        assert!(last < 1e-6);
    }
}

#[test]
fn contact_on_a_thin_layer_is_that_on_springs_whose_rest_is_where_the_base_is() {
    let (n, thickness, nu, load) = (64, 1e-5, 0.3, 0.2);
    let stiffness = material(1.0, nu).confined_modulus() / thickness;
    let grid = Grid::square(n, 1.0).unwrap();
    let surface = oracles::rough::rough(grid, 12, 3);
    let solution = on(bonded(thickness, nu), n, Control::MeanPressure(load));
    assert_eq!(solution.report.status, Status::Converged);
    // the base: the mean of the displaced surface, less the compression of the layer as a whole
    let base = solution.report.mean_gap + surface.mean() - load / stiffness;
    let springs = surface.heights().mapv(|h| stiffness * (h - base).max(0.0));
    let peak = springs.iter().copied().fold(0.0, f64::max);
    for (&found, &expected) in solution.contact_pressure.iter().zip(&springs) {
        assert!((found - expected).abs() < 1e-4 * peak, "{found} {expected} {peak}");
    }
    assert_relative_eq!(springs.sum() / springs.len() as f64, load, max_relative = 1e-3);
}

#[test]
fn closed_springs_are_pressed_by_their_heights_alone() {
    let (grid, stiffness) = (Grid::square(16, 1.0).unwrap(), 7.0);
    let surface = oracles::rough::rough(grid, 6, 3);
    let springs = Spectral::<f64>::new(grid, 1.0, move |_, _| stiffness).unwrap();
    let mut problem = Problem::new(&surface, springs, NoAdhesion).unwrap();
    let solution = oracles::solve(&mut problem, Control::MeanPressure(1.0), 1e-10);
    assert_eq!((solution.report.status, solution.report.contact_fraction), (Status::Converged, 1.0));
    for (&pressure, &height) in solution.pressure.iter().zip(surface.heights()) {
        assert_relative_eq!(pressure - 1.0, stiffness * (height - surface.mean()), epsilon = 1e-9);
    }
}

#[test]
fn layers_of_any_thickness_are_solved_in_few_applications() {
    for thickness in [1e-3, 1e-2, 0.1, 1.0] {
        for solution in [
            on(bonded(thickness, 0.3), 64, Control::MeanPressure(0.05)),
            on(sliding(thickness), 64, Control::MeanGap(0.02)),
        ] {
            assert_eq!(solution.report.status, Status::Converged);
            let taken = solution.report.operator_applications;
            assert!(taken < 70, "{thickness} {taken}");
        }
    }
}

#[test]
fn the_symbol_of_a_coating_solves_its_equations() {
    use rand::{RngExt, SeedableRng};
    let mut random = rand::rngs::ChaCha8Rng::seed_from_u64(7);
    for _ in 0..60 {
        let mut any = |from: f64, to: f64| from + (to - from) * random.random::<f64>();
        let upper = material(10f64.powf(any(-2.0, 2.0)), any(-0.2, 0.5));
        let lower = material(1.0, any(-0.2, 0.5));
        let (q, t) = (any(0.5, 2.0), any(0.05, 2.0));
        let coated = Coating::new(upper, t, lower).unwrap();
        assert_relative_eq!(
            stiffness(&coated, q),
            integrated(q, t, upper, on_half_space(q, lower)),
            max_relative = 1e-9
        );
    }
}

#[test]
fn a_coating_has_four_limits() {
    let (coating, substrate) = (material(3.0, 0.2), material(2.0, 0.4));
    let coated = |thickness: f64| Coating::new(coating, thickness, substrate).unwrap();
    for q in [0.1, 1.0, 30.0] {
        // thick, thin, of the material of its substrate, and on one that does not yield
        assert_relative_eq!(stiffness(&coated(1e9), q), 0.5 * 3.0 * q, max_relative = 1e-15);
        assert_relative_eq!(stiffness(&coated(1e-12), q), 0.5 * 2.0 * q, max_relative = 1e-9);
        let same = Coating::new(substrate, 0.3, substrate).unwrap();
        assert_relative_eq!(stiffness(&same, q), 0.5 * 2.0 * q, max_relative = 1e-14);
        let rigid = Coating::new(material(1.0, 0.3), 0.3, material(1e12, 0.3)).unwrap();
        assert_relative_eq!(stiffness(&rigid, q), stiffness(&bonded(0.3, 0.3), q), max_relative = 1e-9);
    }
}

#[test]
fn a_coating_much_softer_or_harder_than_its_substrate_keeps_its_digits() {
    for x in [1e-4, 1e-2, 1.0, 30.0] {
        let rubber = Coating::new(material(1.0, 0.5), x, material(1e30, 0.3)).unwrap();
        assert_relative_eq!(stiffness(&rubber, 1.0), stiffness(&bonded(x, 0.5), 1.0), max_relative = 1e-14);
    }
    // a plate on a half-space that does not move sideways under a pressure: ½E₂*q + E₁*t³q⁴/12, but for terms in (qt)²
    for (x, modulus) in [(1e-4, 1e9), (1e-4, 1e12), (1e-3, 1e12)] {
        let film = Coating::new(material(modulus, 0.3), x, material(1.0, 0.5)).unwrap();
        assert_relative_eq!(stiffness(&film, 1.0), 0.5 + modulus * x.powi(3) / 12.0, max_relative = 10.0 * x * x);
    }
}

#[test]
fn two_bodies_yield_by_the_sum_of_their_compliances() {
    let both = Series(HalfSpace::new(3.0).unwrap(), HalfSpace::new(1.5).unwrap());
    assert_relative_eq!(stiffness(&both, 7.0), stiffness(&HalfSpace::new(1.0).unwrap(), 7.0), max_relative = 1e-15);
    let coated = Series(bonded(0.1, 0.3), Series(sliding(0.2), HalfSpace::new(1e300).unwrap()));
    let compliance = 1.0 / stiffness(&bonded(0.1, 0.3), 4.0) + 1.0 / stiffness(&sliding(0.2), 4.0);
    assert_relative_eq!(1.0 / stiffness(&coated, 4.0), compliance, max_relative = 1e-14);
    assert_relative_eq!(
        coated.mean_compliance(),
        0.1 / material(1.0, 0.3).confined_modulus() + 0.2 / material(1.0, 0.3).confined_modulus(),
        max_relative = 1e-14
    );

    // a modulus that is unknown of one of them is unknown of both
    struct Own;
    impl Body for Own {
        fn stiffness(&self, qx: f64, qy: f64) -> f64 {
            qx.hypot(qy)
        }
        fn modulus(&self) -> f64 {
            f64::NAN
        }
    }
    assert!(Series(Own, HalfSpace::new(1.0).unwrap()).modulus().is_nan());
    assert!(Series(HalfSpace::new(1.0).unwrap(), Own).modulus().is_nan());
}

#[test]
fn bodies_keep_the_contract_of_operators_in_both_precisions() {
    let coated = Coating::new(material(5.0, 0.2), 0.05, material(1.0, 0.5)).unwrap();
    for shape in [(16, 12), (9, 15), (32, 1)] {
        let grid = Grid::new(shape, (1.0, 0.75)).unwrap();
        check_operator(&mut Spectral::<f64>::of(grid, coated).unwrap()).unwrap();
        check_operator(&mut Spectral::<f32>::of(grid, coated).unwrap()).unwrap();
        check_operator(&mut Spectral::<f64>::of(grid, Series(coated, sliding(0.02))).unwrap()).unwrap();
    }
}

#[test]
fn the_modulus_of_an_operator_is_that_of_the_shortest_waves() {
    let modulus = |body: Layer, n| Spectral::<f64>::of(Grid::square(n, 1.0).unwrap(), body).unwrap().modulus();
    assert_relative_eq!(modulus(bonded(0.2, 0.3), 64), 1.0, max_relative = 1e-14);
    // springs of stiffness M/t, thinner than a node
    let q = std::f64::consts::PI * 64.0;
    let springs = 2.0 * material(1.0, 0.3).confined_modulus() / 1e-4 / q;
    assert_relative_eq!(modulus(bonded(1e-4, 0.3), 64), springs, max_relative = 1e-2);
}

#[test]
fn materials_and_thicknesses_that_do_not_exist_are_refused() {
    let steel = Material::of_young(210e9, 0.3).unwrap();
    assert_relative_eq!(steel.shear_modulus(), 210e9 / 2.6, max_relative = 1e-14);
    for (modulus, poisson) in [(0.0, 0.3), (-1.0, 0.3), (f64::NAN, 0.3), (1.0, 0.51), (1.0, -1.0), (1.0, f64::NAN)] {
        assert!(matches!(Material::new(modulus, poisson), Err(Error::Value { .. })), "{modulus} {poisson}");
        assert!(matches!(Material::of_young(modulus, poisson), Err(Error::Value { .. })), "{modulus} {poisson}");
    }
    for thickness in [0.0, -1.0, f64::INFINITY, f64::NAN] {
        assert!(Layer::new(steel, thickness, Base::Bonded).is_err() && Coating::new(steel, thickness, steel).is_err());
    }
    assert!(HalfSpace::new(0.0).is_err());
}

/// A wavy plate is pressed flat by the amplitude of its stiffness: at p̄ = k A every node touches, and below it one gap
/// opens.
#[test]
fn a_wave_on_a_plate_closes_at_its_stiffness_times_the_amplitude() {
    let (grid, amplitude) = (Grid::square(32, 1.0).unwrap(), 0.01);
    let plate = Plate::new(1e-3, HalfSpace::new(1.0).unwrap()).unwrap();
    let q = std::f64::consts::TAU;
    let closing = plate.stiffness(q, 0.0) * amplitude;
    assert_relative_eq!(closing, (0.5 * q + 1e-3 * q.powi(4)) * amplitude, max_relative = 1e-15);
    let surface = Surface::new(grid, grid.sample(|x, _| amplitude * (q * x).cos())).unwrap();
    for (share, all) in [(1.01, true), (0.97, false)] {
        let operator = Spectral::<f64>::of(grid, plate).unwrap();
        let mut problem = Problem::new(&surface, operator, NoAdhesion).unwrap();
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(share * closing)).unwrap();
        assert_eq!((solution.report.status, solution.report.contact_fraction == 1.0), (Status::Converged, all));
    }
}

#[test]
fn what_a_cell_lacks_of_an_approach_is_the_limit_of_long_waves() {
    let grid = Grid::square(8, 2.0).unwrap();
    let same = Coating::new(material(1.0, 0.3), 0.1, material(1.0, 0.3)).unwrap();
    // the sum over a square lattice of charges on a background
    assert_relative_eq!(
        same.far_compliance(&grid).unwrap(),
        2.0 * 3.900_264_920_001_956 / std::f64::consts::PI,
        max_relative = 1e-12
    );
    let twice = Grid::new((8, 16), (2.0, 4.0)).unwrap();
    let turned = Grid::new((16, 8), (4.0, 2.0)).unwrap();
    let both = [twice, turned].map(|grid| same.far_compliance(&grid).unwrap());
    assert_relative_eq!(both[0], both[1], max_relative = 1e-12);
    for (modulus, nu, other) in [(0.01, 0.3, 0.5), (0.1, 0.5, 0.5), (20.0, 0.2, 0.3)] {
        let coated = Coating::new(material(modulus, nu), 0.1, material(1.0, other)).unwrap();
        let beyond = coated.far_compliance(&grid).unwrap() - same.far_compliance(&grid).unwrap();
        let long = |q: f64| 1.0 / stiffness(&coated, q) - 2.0 / q;
        assert_relative_eq!(beyond, 2.0 * long(1e-4) - long(2e-4), max_relative = 1e-4, epsilon = 1e-6);
    }
    for layer in [bonded(0.1, 0.3), sliding(0.1)] {
        assert_relative_eq!(layer.far_compliance(&grid).unwrap(), 1.0 / stiffness(&layer, 1e-4), max_relative = 1e-6);
    }
    // on lines a half-space yields without end
    assert_eq!(same.far_compliance(&Grid::new((8, 1), (2.0, 1.0)).unwrap()), None);
}

#[test]
fn a_sphere_on_a_layer_has_an_approach() {
    let surface = Surface::paraboloid(Grid::square(64, 2.0).unwrap(), 20.0).unwrap();
    // an incompressible one does not yield in the mean
    for nu in [0.3, 0.5] {
        let body = Spectral::<f64>::of(*surface.grid(), bonded(0.2, nu)).unwrap();
        let mut problem = Problem::new(&surface, body, NoAdhesion).unwrap();
        let held = Solver::default().solve(&mut problem, Control::Approach(2e-3)).unwrap().report;
        // by the gap, and the compression of the whole
        let peak = surface.heights().iter().copied().fold(f64::NEG_INFINITY, f64::max) - surface.mean();
        let squeezed = 0.2 / material(1.0, nu).confined_modulus() * held.mean_pressure;
        assert_relative_eq!(peak - held.mean_gap + squeezed, 2e-3, max_relative = 1e-9);
        let pressed = Solver::default().solve(&mut problem, Control::MeanPressure(held.mean_pressure)).unwrap().report;
        assert_relative_eq!(pressed.mean_gap, held.mean_gap, max_relative = 1e-4);
    }
}
