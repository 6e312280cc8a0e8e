//! Cycles of contacts that yield, and their energies.

use super::*;

#[test]
fn reloading_repeats_the_state_and_dissipates_nothing_more() {
    let mut problem = rough::<f64>(64, 8, NoAdhesion);
    let hardness = 0.2;
    let mut solver = capped(hardness, 1e-9);
    let loads = [0.02, 0.01, 0.004, 0.01, 0.02, 0.03].map(Control::MeanPressure);
    let states = swept(&mut Sweep::default(), &mut solver, &mut problem, &loads);
    let energy = |k: usize| states[k].report.plastic.unwrap().energy;
    assert!(energy(0) > 0.0);
    for k in 1..5 {
        assert_relative_eq!(energy(k), energy(0), max_relative = 1e-6);
    }
    assert!(energy(5) > 1.2 * energy(0));
    // the same state at the same load, and another one on the way up than without yielding
    let error = states[4].distance(&states[0]);
    assert!(error < 1e-7, "{error:e}");
    assert!(states[4].report.contact_nodes.abs_diff(states[0].report.contact_nodes) <= 1);
    // elastic unloading on the flattened surface leaves more contact than loading did
    let virgin =
        capped(hardness, 1e-9).solve(&mut rough::<f64>(64, 8, NoAdhesion), Control::MeanPressure(0.01)).unwrap();
    assert!(states[1].report.contact_fraction > 1.05 * virgin.report.contact_fraction);
    let reverse = states[3].distance(&states[1]);
    assert!(reverse < 1e-7, "{reverse:e}");
}

#[test]
fn the_energy_of_a_cycle_is_balanced_with_the_plastic_work() {
    let mut problem = rough::<f64>(48, 6, NoAdhesion);
    let mut solver = capped(0.2, 1e-9);
    let legs = [1e-4, 0.03, 1e-4, 0.03, 1e-4].map(Control::MeanPressure);
    let settings = PathSettings::default().steps(20);
    let steps = followed(Path::new(legs, settings).unwrap(), &mut solver, &mut problem);
    // the same cycle has the same bits
    let again =
        followed(Path::new(legs, settings).unwrap(), &mut capped(0.2, 1e-9), &mut rough::<f64>(48, 6, NoAdhesion));
    assert_eq!(steps.len(), again.len());
    for (one, other) in steps.iter().zip(&again) {
        let bits = [one, other].map(|step| [step.work, step.imbalance].map(f64::to_bits));
        assert!(bits[0] == bits[1] && one.solution.gap == other.solution.gap);
    }
    let ends: Vec<_> = (1..5).map(|leg| steps.iter().rfind(|step| step.leg == leg).unwrap()).collect();
    let plastic = |k: usize| ends[k].solution.report.plastic.unwrap().energy;
    assert!(plastic(0) > 0.0);
    // nothing yields after the first loading
    for k in 1..4 {
        assert_relative_eq!(plastic(k), plastic(0), max_relative = 1e-5);
    }
    assert!(steps.iter().all(|step| step.event.is_none()));
    // the work of a cycle is what yielding has dissipated, to the balance of its steps
    let range = ends[0].solution.report.elastic_energy + plastic(0);
    assert_relative_eq!(ends[1].work, plastic(0), epsilon = 3e-3 * range);
    assert!((ends[3].work - ends[1].work).abs() < 3e-3 * range, "{:e} {:e}", ends[3].work, ends[1].work);
    assert!(steps.iter().all(|step| step.imbalance.abs() < 3e-3 * range));
}

/// Adhesion that differs from node to node, with its tractions at contact, and a hardness that does.
fn both_vary(n: usize) -> (Problem<f64>, Array2<f64>, Array2<f64>) {
    let (grid, rho) = (Grid::square(n, 1.0).unwrap(), 2e-3);
    let works = Array2::from_shape_fn((n, n), |(i, j)| 2e-5 * (1 + (i + 3 * j) % 4) as f64 / 4.0);
    let caps = Array2::from_shape_fn((n, n), |(i, j)| 0.08 + 0.01 * ((2 * i + j) % 5) as f64);
    let law = adhesion::Varying::new(Exponential::new(2e-5, rho).unwrap(), works.view()).unwrap();
    let surface = SelfAffine::default().k_s(n as f64 / 4.0).amplitude(Amplitude::RmsSlope(0.2)).surface(grid).unwrap();
    let problem = Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap();
    (problem, works / rho, caps)
}

#[test]
fn yielding_dissipates_the_hardness_less_the_traction_of_the_law() {
    let (mut problem, pulls, caps) = both_vary(32);
    let constraint = Hardness::varying(caps.clone()).unwrap();
    let mut solver = Solver { settings: Settings::default(), constraint };
    let loads = [0.02, 0.03, 0.01].map(Control::MeanPressure);
    for solution in swept(&mut Sweep::default(), &mut solver, &mut problem, &loads) {
        let (plastic, depth) = (solution.report.plastic.unwrap(), solution.plastic_depth.unwrap());
        assert!(plastic.fraction > 0.0);
        assert_relative_eq!(plastic.energy, ((&caps - &pulls) * depth).mean().unwrap(), max_relative = 1e-12);
        // φ = −tρ exp(−g/ρ) at the gap to the surface as it is now
        let adhesive = -2e-3 * (&pulls * solution.gap.mapv(|gap| (-gap / 2e-3).exp())).mean().unwrap();
        assert_relative_eq!(solution.report.adhesive_energy, adhesive, max_relative = 1e-12);
    }
}

#[test]
fn the_energy_of_a_cycle_with_adhesion_is_balanced_without_jumps() {
    let (mut problem, pulls, caps) = both_vary(32);
    let legs = [1e-3, 0.03, 1e-3].map(Control::MeanPressure);
    let mut steps = |caps| {
        let mut solver = Solver { settings: Settings::default().tolerance(1e-8), constraint: caps };
        problem.flatten(Array2::zeros((32, 32)).view()).unwrap();
        followed(Path::new(legs, PathSettings::default().steps(12)).unwrap(), &mut solver, &mut problem)
    };
    let elastic = steps(Hardness::new(1e3).unwrap());
    for caps in [Hardness::varying(caps).unwrap(), Hardness::new(0.1).unwrap()] {
        let yields = steps(caps);
        assert!(yields.iter().all(|step| step.event.is_none()));
        assert!(yields.len() < 2 * elastic.len(), "{} for {}", yields.len(), elastic.len());
        let last = yields.last().unwrap();
        let plastic = last.solution.report.plastic.unwrap();
        // what the balance missed
        assert!(pulls.mean().unwrap() * plastic.depth_mean > 0.05 * last.work);
        let range = yields.iter().fold(0.0_f64, |most, step| most.max(step.work));
        assert!(last.imbalance.abs() < 3e-3 * range, "{:e} of {range:e}", last.imbalance);
    }
}

#[test]
fn a_path_and_a_sweep_with_depth_go_on_bit_for_bit() {
    let loads = [1e-3, 0.03, 1e-3, 0.04].map(Control::MeanPressure);
    let solver = || capped(0.2, 1e-6);
    let grid = Grid::square(24, 1.0).unwrap();
    let (periodic, free) = (Westergaard::<f64>::new(grid, 1.0).unwrap(), Boussinesq::<f64>::new(grid, 1.0).unwrap());
    for is_free in [false, true] {
        let new = || {
            let body: Box<dyn ElasticOperator<f64>> =
                if is_free { Box::new(free.clone()) } else { Box::new(periodic.clone()) };
            Problem::new(&rough_surface(grid, 4, 1), body, NoAdhesion).unwrap()
        };
        let (mut one, mut problem) = (solver(), new());
        let mut path = Path::new(loads, PathSettings::default().steps(4)).unwrap();
        let whole = followed(path.clone(), &mut solver(), &mut new());
        for (k, expected) in whole.iter().enumerate() {
            if k % 3 == 2 {
                let rest = followed(path.read_again(), &mut solver(), &mut new());
                assert!(rest == whole[k..], "{k}");
            }
            assert_eq!(path.next(&mut one, &mut problem).unwrap().as_ref(), Some(expected));
        }
        assert!(whole.iter().any(|step| step.solution.report.plastic.unwrap().fraction > 0.0));

        let (mut sweep, mut problem) = (Sweep::default(), new());
        let whole = swept(&mut sweep.clone(), &mut solver(), &mut new(), &loads);
        for (k, &load) in loads.iter().enumerate() {
            assert!(swept(&mut sweep.read_again(), &mut solver(), &mut new(), &loads[k..]) == whole[k..], "{k}");
            sweep.next(&mut one, &mut problem, load).unwrap();
        }

        let (mut search, mut problem) = (ContactSearch::default(), new());
        for fraction in [0.05, 0.2, 0.4] {
            let again = search.read_again().at(&mut solver(), &mut new(), fraction).unwrap();
            let expected = search.at(&mut one, &mut problem, fraction).unwrap();
            assert!(again.solution == expected.solution && again.solves == expected.solves, "{fraction}");
        }
    }
}
