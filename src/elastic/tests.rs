//! What a solve asks of an operator besides its applications, by its spectral operator and by applications alone.

use ndarray::Array2;

use super::*;

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

/// Fields of both parities, lines among them.
const SHAPES: [(usize, usize); 8] = [(1, 2), (2, 2), (5, 4), (7, 7), (13, 3), (3, 34), (35, 1), (1, 66)];

fn noise((nx, ny): (usize, usize), seed: usize) -> Array2<f64> {
    let value = |node: usize| ((node + 1009 * seed) as f64 * 0.754_877_666).fract() - 0.5;
    Array2::from_shape_fn((nx, ny), |(i, j)| value(1 + i * ny + j))
}

#[test]
fn the_preconditioner_is_symmetric_and_positive_and_the_products_are_those_of_the_fields() {
    let dot = |a: &Array2<f64>, b: &Array2<f64>| (a * b).mean().unwrap();
    let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-14 + 1e-12 * b.abs(), "{a} {b}");
    for shape in SHAPES {
        let grid = Grid::new(shape, (1.0, 1.0)).unwrap();
        let half_space = || Westergaard::<f64>::new(grid, 1.0).unwrap();
        let (a, b) = (noise(shape, 1), noise(shape, 2));
        let [mut stiff, mut compliant, mut pressure, mut ma, mut mb] = [(); 5].map(|()| Array2::zeros(shape));
        half_space().pressure(a.view(), stiff.view_mut()).unwrap();
        half_space().displacement(a.view(), compliant.view_mut()).unwrap();
        let operators: [Box<dyn ElasticOperator<f64>>; 2] = [Box::new(half_space()), Box::new(Plain(half_space()))];
        for mut operator in operators {
            let found = operator.precondition(a.view(), Foundation::uniform(0.7, 0.6), ma.view_mut()).unwrap();
            operator.precondition(b.view(), Foundation::uniform(0.7, 0.6), mb.view_mut()).unwrap();
            close(found.error, dot(&a, &compliant));
            close(found.descent, dot(&a, &ma));
            close(found.mean, ma.mean().unwrap());
            close(operator.pressure_and_work(a.view(), pressure.view_mut()).unwrap(), dot(&a, &stiff));
            assert_eq!(pressure, stiff);
            close(dot(&a, &mb), dot(&b, &ma));
            assert!(dot(&a, &ma) > 0.0);
        }
    }
}

#[test]
fn operators_in_single_precision_keep_the_contract() {
    let grid = Grid::new((24, 15), (1.0, 0.7)).unwrap();
    let mut operators: [Box<dyn ElasticOperator<f64>>; 4] = [
        Box::new(Westergaard::new(grid, 2e11).unwrap()),
        Box::new(Spectral::isotropic(grid, 1.0, |q| 10.0 + 0.5 * q).unwrap()),
        Box::new(Spectral::new(grid, 1.0, |qx, qy| 0.5 * (qx * qx + 2.0 * qy * qy).sqrt()).unwrap()),
        Box::new(Boussinesq::new(grid, 2.0).unwrap()),
    ];
    for operator in &mut operators {
        let mut single = operator.spectral().and_then(|spectral| spectral.in_single()).unwrap();
        check_operator(&mut single).unwrap();
    }
}
