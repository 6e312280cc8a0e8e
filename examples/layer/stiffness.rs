//! The stiffness of elastic layers of finite thickness.

/// The stiffness of waves on a layer of thickness t that is bonded to a rigid base, pressure per displacement.
pub fn bonded(modulus: f64, thickness: f64, poisson: f64) -> impl Fn(f64) -> f64 + Send + Sync + 'static {
    let a = 3.0 - 4.0 * poisson;
    let b = 5.0 - 12.0 * poisson + 8.0 * poisson * poisson;
    move |q| {
        // beyond, both are one to the last digit, and would overflow
        let x = (q * thickness).min(25.0);
        0.5 * modulus * q * (a * (2.0 * x).cosh() + 2.0 * x * x + b) / (a * (2.0 * x).sinh() - 2.0 * x)
    }
}

/// The same on a rigid base on which it slides without friction: Poisson's ratio enters by the contact modulus alone.
pub fn sliding(modulus: f64, thickness: f64) -> impl Fn(f64) -> f64 + Send + Sync + 'static {
    move |q| {
        let x = (q * thickness).min(25.0);
        0.5 * modulus * q * ((2.0 * x).sinh() + 2.0 * x) / (2.0 * x.sinh().powi(2))
    }
}

/// The modulus M against compression without strain sideways, E(1 − ν)/((1 + ν)(1 − 2ν)), from E* = E/(1 − ν²).
///
/// By p̄t/M a mean pressure compresses the layer as a whole. The operator leaves it out, as a mean displacement is
/// free.
pub fn confined(modulus: f64, poisson: f64) -> f64 {
    modulus * (1.0 - poisson).powi(2) / (1.0 - 2.0 * poisson)
}
