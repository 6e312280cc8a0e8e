/// The traction over one piece of a table: Σ cₙ tⁿ, with t the distance from its start times its rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    /// the start, in units of the table
    pub start: f64,
    /// t over the distance, in units of the table
    pub rate: f64,
    /// the energy at the start
    pub energy: f64,
    pub coefficients: [f64; 4],
}

impl Piece {
    /// The piece between two places with energies, tractions and slopes, in a table of this unit.
    pub fn between((start, end): (f64, f64), a: [f64; 3], b: [f64; 3], unit: f64) -> Self {
        let width = end - start;
        let (first, last, rise) = (a[2] * width * unit, b[2] * width * unit, b[1] - a[1]);
        let coefficients = [a[1], first, 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise];
        Self { start, rate: width.recip(), energy: a[0], coefficients }
    }

    /// Energy, traction and slope at t, in a table of this unit.
    #[inline(always)]
    pub fn at(&self, t: f64, unit: f64) -> [f64; 3] {
        let [a, b, c, d] = self.coefficients;
        let energy = self.energy + unit / self.rate * t * (a + t * (b / 2.0 + t * (c / 3.0 + t * d / 4.0)));
        [energy, a + t * (b + t * (c + t * d)), self.rate * (b + t * (2.0 * c + t * 3.0 * d)) / unit]
    }
}
