//! The bodies in layers of scenes.

use super::*;

/// An elastic body in layers.
#[derive(Clone, Copy, Debug)]
pub enum Layered {
    Layer(Layer),
    Coating(Coating),
    /// two bodies that both deform
    Pair(Series<Coating, Series<Layer, HalfSpace>>),
}

impl Layered {
    pub(super) fn draw(random: &mut ChaCha8Rng, side: f64, modulus: f64) -> Self {
        let material = |random: &mut ChaCha8Rng| {
            let poisson = random.random_range(-0.5_f64..0.6).min(0.5);
            Material::new(modulus * power(random, -1.5, 1.5), poisson).unwrap()
        };
        let [coat, substrate] = std::array::from_fn(|_| material(random));
        let [thickness, other] = std::array::from_fn(|_| side * power(random, -2.5, 0.5));
        let base = if random.random_bool(0.5) { Base::Bonded } else { Base::Sliding };
        let (layer, coating) = (Layer::new(substrate, other, base), Coating::new(coat, thickness, substrate));
        match random.random_range(0..3) {
            0 => Self::Layer(layer.unwrap()),
            1 => Self::Coating(coating.unwrap()),
            _ => Self::Pair(Series(coating.unwrap(), Series(layer.unwrap(), HalfSpace::new(modulus).unwrap()))),
        }
    }

    fn body(&self) -> &dyn elastic::Body {
        match self {
            Self::Layer(layer) => layer,
            Self::Coating(coating) => coating,
            Self::Pair(pair) => pair,
        }
    }
}

impl elastic::Body for Layered {
    fn stiffness(&self, qx: f64, qy: f64) -> f64 {
        self.body().stiffness(qx, qy)
    }
    fn modulus(&self) -> f64 {
        self.body().modulus()
    }
}
