//! Paths that are kept and go on.

use super::*;

/// A path that is kept continues at a problem that is made anew as it does otherwise, from every so many states.
fn resumes(
    new: impl Fn() -> Problem<f64>,
    loads: &[Control],
    settings: PathSettings,
    every: usize,
) -> Vec<PathStep<f64>> {
    let mut path = Path::new(loads.to_vec(), settings).unwrap();
    let whole = followed(path.clone(), &mut Solver::default(), &mut new());
    let (mut solver, mut problem) = (Solver::default(), new());
    for (k, expected) in whole.iter().enumerate() {
        if k % every == 0 {
            let rest = followed(path.read_again(), &mut Solver::default(), &mut new());
            assert!(rest == whole[k..], "{k}");
        }
        assert_eq!(path.next(&mut solver, &mut problem).unwrap().as_ref(), Some(expected));
    }
    whole
}

#[test]
fn a_path_by_touch_goes_on_bit_for_bit() {
    let new = || {
        let grid = Grid::square(32, 1.0).unwrap();
        let surface = SelfAffine::default().k_s(6.0).seed(4).amplitude(Amplitude::RmsSlope(0.3)).surface(grid).unwrap();
        Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), Jkr::new(2e-4).unwrap()).unwrap()
    };
    // withdrawn twice: what has not parted is part of the place
    let whole = resumes(new, &gaps(&[0.05, 0.02, 0.03, 0.02, 0.1]), PathSettings::default().steps(4), 7);
    assert!(names(&whole).contains(&"touch"), "{:?}", names(&whole));
}

#[test]
fn a_path_goes_on_through_a_bifurcation_bit_for_bit() {
    let (loads, settings) = (gaps(&[0.03, 0.012]), PathSettings::default().steps(12));
    let whole = resumes(|| two_waves(64, 0.0), &loads, settings, 3);
    assert!(names(&whole).contains(&"bifurcation"));
}

#[test]
fn a_path_on_a_free_half_space_goes_on_bit_for_bit() {
    let grid = Grid::square(24, 1.0).unwrap();
    let heights =
        Surface::paraboloid(grid, 2.0).unwrap().heights() + &(0.01 * oracles::rough::rough(grid, 8, 1).heights());
    let surface = Surface::new(grid, heights).unwrap();
    let law = Exponential::new(2e-3, 8e-3).unwrap();
    let new = || Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let (loads, settings) = ([0.0, 0.005].map(Control::Approach), PathSettings::default().steps(8));
    let (mut solver, mut problem) = (Solver::default(), new());
    let mut path = Path::new(loads, settings).unwrap();
    for _ in 0..6 {
        let next = path.read_again().next(&mut solver, &mut new()).unwrap();
        assert!(next.is_some() && next == path.next(&mut solver, &mut problem).unwrap());
    }
}

#[test]
fn a_path_that_is_kept_goes_on_bit_for_bit() {
    let loads = [gaps(&[0.03, 0.018]), pressures(&[2e-3, -0.05])].concat();
    let settings = PathSettings::default().steps(12);
    let whole = resumes(|| wave(48, 2e-3), &loads, settings, 6);
    assert!(names(&whole).len() > 1);
}
