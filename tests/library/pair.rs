//! Two surfaces that face each other.

use asperity::elastic::{HalfSpace, Series};
use asperity::surface::resample;
use asperity::{
    Boussinesq, Control, ElasticOperator, Error, Grid, NoAdhesion, Problem, SelfAffine, Solver, Spectral, Surface,
    Westergaard,
};
use asperity_maps::surface_with_absent;
use ndarray::{Array2, Axis, concatenate};

fn grid() -> Grid {
    Grid::new((48, 40), (1.2, 1.0)).unwrap()
}

fn rough(seed: u64) -> Surface {
    SelfAffine::default().k_l(2.0).k_s(12.0).seed(seed).surface(grid()).unwrap()
}

/// The other surface turned over about the y axis.
fn turned(surface: &Surface) -> Array2<f64> {
    Array2::from_shape_fn(grid().shape(), |(i, j)| surface.heights()[[47 - i, j]])
}

/// A field moved by whole nodes along x, opposite sides meeting.
fn rolled(field: &Array2<f64>, nodes: usize) -> Array2<f64> {
    let (before, after) = field.view().split_at(Axis(0), field.nrows() - nodes);
    concatenate(Axis(0), &[after, before]).unwrap()
}

fn spacing() -> f64 {
    grid().spacing().0
}

#[track_caller]
fn close(a: &Array2<f64>, b: &Array2<f64>, tolerance: f64) {
    let most = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(most <= tolerance, "{most:e}");
}

#[test]
fn the_heights_of_both_add_as_they_face_each_other() {
    let (one, other) = (rough(1), rough(2));
    let between = |shift| one.against(&other, shift).unwrap().heights().clone();
    assert_eq!(between((0.0, 0.0)), one.heights() + &turned(&other));
    // whole nodes exactly, whatever the rounding of their length, and around the cell
    for (shift, nodes) in [(7.0 * spacing(), 7), (-41.0 * spacing(), 7), (1.2 + 7.0 * spacing(), 7), (1.2, 0)] {
        assert_eq!(between((shift, -2.0)), one.heights() + &rolled(&turned(&other), nodes), "{shift}");
    }
    // uncorrelated slopes: h'^2 is the sum, to the correlation of some thousand waves
    let fine = |seed| SelfAffine::default().k_l(2.0).k_s(64.0).seed(seed).surface(Grid::square(160, 1.0).unwrap());
    let (one, other) = (fine(1).unwrap(), fine(2).unwrap());
    let slope = |surface: &Surface| surface.spectrum().rms_slope().powi(2);
    let share = slope(&one.against(&other, (0.0, 0.0)).unwrap()) / (slope(&one) + slope(&other));
    assert!((share - 1.0).abs() < 0.05, "{share}");
}

#[test]
fn surfaces_on_finer_and_coarser_grids_face_each_other_alike() {
    let (one, other) = (rough(1), rough(2));
    for nodes in [(96, 80), (384, 41), (31, 30)] {
        let grid = Grid::new(nodes, (1.2, 1.0)).unwrap();
        let on = |surface: &Surface| Surface::new(grid, resample(surface.heights().clone(), nodes).unwrap()).unwrap();
        // by lengths, half a node of the first grid among them
        for shift in [(0.0, 0.0), (0.5 * spacing(), 0.3)] {
            let between = one.against(&other, shift).unwrap();
            // sums of some thousand waves of heights of some 1e-2
            close(on(&one).against(&on(&other), shift).unwrap().heights(), on(&between).heights(), 1e-14);
        }
    }
}

#[test]
fn waves_move_by_any_part_of_a_node() {
    let (flat, other) = (Surface::from_fn(grid(), |_, _| 1e6).unwrap(), rough(3));
    let move_by = |surface: &Surface, x: f64, y: f64| {
        // turned over twice
        let facing = |surface: &Surface| Surface::new(grid(), turned(surface)).unwrap();
        let datum = Surface::from_fn(grid(), |_, _| 0.0).unwrap();
        datum.against(&facing(surface), (x, y)).unwrap()
    };
    // band-limited: half a node twice is one node, and there and back is nothing
    let half = move_by(&other, 0.5 * spacing(), 0.0);
    close(move_by(&half, 0.5 * spacing(), 0.0).heights(), move_by(&other, spacing(), 0.0).heights(), 1e-15);
    let there = move_by(&other, 0.3 * spacing(), 0.011);
    close(move_by(&there, -0.3 * spacing(), -0.011).heights(), other.heights(), 1e-15);
    // a wave is where its phase says
    let wave = |shift: f64| {
        let q = std::f64::consts::TAU / 1.2;
        Surface::from_fn(grid(), |x, _| (3.0 * q * (x - shift)).cos()).unwrap()
    };
    close(move_by(&wave(0.0), 0.0317, 0.0).heights(), wave(0.0317).heights(), 1e-13);
    // the shortest wave of an even side is what it is at the nodes
    let shortest = Surface::from_fn(grid(), |x, _| (std::f64::consts::PI * x / spacing()).cos()).unwrap();
    let share = (std::f64::consts::PI * 0.3).cos();
    close(move_by(&shortest, 0.3 * spacing(), 0.0).heights(), &shortest.heights().mapv(|h| share * h), 1e-14);
    // a datum costs the moved waves no digits
    let lifted = Surface::new(grid(), other.heights() + 1e6).unwrap();
    let moved = flat.against(&lifted, (0.4 * spacing(), 0.0)).unwrap();
    let plain = flat.against(&other, (0.4 * spacing(), 0.0)).unwrap();
    close(&(moved.heights() - 1e6), plain.heights(), 1e-9);
}

#[test]
fn congruent_surfaces_are_in_full_contact_at_no_load() {
    let one = rough(4);
    let fits = Surface::new(grid(), -turned(&one)).unwrap();
    let between = one.against(&fits, (0.0, 0.0)).unwrap();
    assert!(between.heights().iter().all(|&h| h == 0.0));
    let contact = |surface: &Surface| {
        let operator = Westergaard::<f64>::new(grid(), 1.0).unwrap();
        let mut problem = Problem::new(surface, operator, NoAdhesion).unwrap();
        Solver::default().solve(&mut problem, Control::MeanPressure(1e-6)).unwrap().report.contact_fraction
    };
    assert_eq!(contact(&between), 1.0);
    // not so a node further
    assert!(contact(&one.against(&fits, (spacing(), 0.0)).unwrap()) < 0.1);
}

#[test]
fn nodes_that_one_of_both_lacks_are_absent() {
    let lacking = |surface: &Surface, node| {
        let mut heights = surface.heights().clone();
        heights[node] = f64::NAN;
        surface_with_absent(grid(), heights).unwrap()
    };
    let (one, other) = (lacking(&rough(1), (3, 4)), lacking(&rough(2), (0, 9)));
    let between = one.against(&other, (2.0 * spacing(), 0.0)).unwrap();
    let absent: Vec<_> =
        between.absent().unwrap().indexed_iter().filter(|(_, absent)| **absent).map(|(node, _)| node).collect();
    assert_eq!(absent, [(1, 9), (3, 4)]);
    assert_eq!(between.heights()[[7, 7]], one.heights()[[7, 7]] + other.heights()[[42, 7]]);
    let refused = one.against(&other, (0.5 * spacing(), 0.0)).unwrap_err();
    assert!(refused.to_string().contains("a whole number of nodes"), "{refused}");
    // the first one stays where it is
    one.against(&rough(2), (0.5 * spacing(), 0.0)).unwrap();
}

#[test]
fn surfaces_that_do_not_fit_are_refused() {
    let one = rough(1);
    let other = |shape, lengths| Surface::from_fn(Grid::new(shape, lengths).unwrap(), |_, _| 0.0).unwrap();
    let refused = |surface: &Surface, shift| one.against(surface, shift).unwrap_err();
    assert!(matches!(refused(&other((40, 48), (1.2, 1.0)), (0.0, 0.0)), Error::Shape { .. }));
    assert!(matches!(refused(&other((48, 40), (1.2, 1.1)), (0.0, 0.0)), Error::Value { value: 1.1, .. }));
    assert!(matches!(refused(&one, (f64::NAN, 0.0)), Error::Value { .. }));
    // a line has no y
    let line = Surface::wave(Grid::line(16, 1.0).unwrap(), 0.1, 3).unwrap();
    assert_eq!(line.against(&line, (0.125, 0.4)).unwrap(), line.against(&line, (0.125, 0.0)).unwrap());
}

#[test]
fn a_start_before_a_small_shift_leads_to_the_same_contact_in_fewer_applications() {
    let (one, other) = (rough(1), rough(2));
    let pressed = |shift: f64, start: Option<&Array2<f64>>| {
        let between = one.against(&other, (shift, 0.0)).unwrap();
        let operator = Westergaard::<f64>::new(grid(), 1.0).unwrap();
        let mut problem = Problem::new(&between, operator, NoAdhesion).unwrap();
        oracles::solve_from(&mut problem, Control::MeanPressure(0.02), 1e-6, start)
    };
    let before = pressed(0.0, None);
    let (cold, warm) = (pressed(0.2 * spacing(), None), pressed(0.2 * spacing(), Some(&before.gap)));
    let [fewer, more] = [&warm, &cold].map(|solution| solution.report.operator_applications);
    assert!(fewer < more, "{fewer} {more}");
    close(&warm.gap, &cold.gap, 1e-8);
}

#[test]
fn two_half_spaces_are_one_and_each_moves_by_its_compliance() {
    let (one, other) = (rough(1), rough(2));
    let surface = one.against(&other, (0.0, 0.0)).unwrap();
    let series = Series(HalfSpace::new(3.0).unwrap(), HalfSpace::new(6.0).unwrap());
    let mut problem = Problem::new(&surface, Spectral::<f64>::of(grid(), series).unwrap(), NoAdhesion).unwrap();
    let both = Solver::default().solve(&mut problem, Control::MeanPressure(0.02)).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid(), 2.0).unwrap(), NoAdhesion).unwrap();
    let single = Solver::default().solve(&mut problem, Control::MeanPressure(0.02)).unwrap();
    assert_eq!(both.report.contact_nodes, single.report.contact_nodes);
    // both to a certified 1e-6, of gaps of some 1e-2
    close(&both.gap, &single.gap, 1e-8);

    let displaced = |modulus: f64| {
        let mut u = Array2::zeros(grid().shape());
        Westergaard::new(grid(), modulus).unwrap().displacement(both.pressure.view(), u.view_mut()).unwrap();
        u
    };
    let (u1, u2) = (displaced(3.0), displaced(6.0));
    close(&u1, &(2.0 * &u2), 1e-15);
    let sum = &both.gap + surface.heights();
    close(&(&u1 + &u2), &(&sum - sum.mean().unwrap()), 1e-12);
    // on a free boundary too
    let free = |modulus| Boussinesq::<f64>::new(grid(), modulus).unwrap().stiffness_range().0;
    assert!((1.0 / free(2.0) - 1.0 / free(3.0) - 1.0 / free(6.0)).abs() < 1e-12 / free(2.0));
}
