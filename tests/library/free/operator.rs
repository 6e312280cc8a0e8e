//! The operator of the free half-space.

use super::*;

#[test]
fn the_operator_keeps_the_contract_in_every_shape() {
    for (shape, lengths) in [((2, 2), (1.0, 1.0)), ((24, 15), (1.0, 0.7)), ((5, 40), (1.0, 0.7)), ((33, 8), (0.1, 3.0))]
    {
        let grid = Grid::new(shape, lengths).unwrap();
        check_operator(&mut Boussinesq::<f64>::new(grid, 2.0).unwrap()).unwrap();
        check_operator(&mut Boussinesq::<f32>::new(grid, 2.0).unwrap()).unwrap();
    }
}

#[test]
fn the_compliance_between_nodes_of_the_window_is_loves() {
    for (shape, lengths) in [((24, 20), (1.0, 0.7)), ((3, 17), (1.0, 0.5)), ((9, 2), (1.0, 9.0))] {
        let grid = Grid::new(shape, lengths).unwrap();
        let mut operator = Boussinesq::<f64>::new(grid, 1.3).unwrap();
        let love = Dense::free(&grid, 1.3);
        let padded = operator.grid().shape();
        let Boundary::Free { mean_compliance, .. } = operator.boundary() else { panic!("free") };
        let pressure = Array2::from_shape_fn(shape, |(i, j)| ((7 * i + 3 * j + i * j) % 5) as f64 - 1.0);
        let (mut load, mut u) = (Array2::zeros(padded), Array2::zeros(padded));
        pressure.indexed_iter().for_each(|(node, p)| load[node] = *p);
        operator.displacement(load.view(), u.view_mut()).unwrap();
        let mean = mean_compliance * load.mean().unwrap();
        let expected = love.displacement(pressure.as_slice().unwrap());
        let size = expected.iter().fold(0.0_f64, |size, u| size.max(u.abs()));
        for ((node, _), expected) in pressure.indexed_iter().zip(&expected) {
            assert!((u[node] + mean - expected).abs() < 1e-11 * size, "{node:?} {} {expected}", u[node] + mean);
        }
    }
}

#[test]
fn a_uniform_pressure_on_a_square_displaces_its_centre_as_love_says() {
    for n in [3, 15] {
        let grid = Grid::square(n, 2.0).unwrap();
        let mut operator = Boussinesq::<f64>::new(grid, 1.0).unwrap();
        let Boundary::Free { mean_compliance, .. } = operator.boundary() else { panic!("free") };
        let padded = operator.grid().shape();
        let load = Array2::from_shape_fn(padded, |(i, j)| f64::from(u8::from(i < n && j < n)));
        let mut u = load.clone();
        operator.displacement(load.view(), u.view_mut()).unwrap();
        let centre = u[[n / 2, n / 2]] + mean_compliance * load.mean().unwrap();
        assert!((centre / (8.0 / std::f64::consts::PI * (1.0 + 2.0_f64.sqrt()).ln()) - 1.0).abs() < 1e-13);
    }
}
