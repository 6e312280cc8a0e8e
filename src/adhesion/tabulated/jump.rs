/// A place, in ranges, at which the traction falls at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Jump {
    pub place: f64,
    pub fall: f64,
}

impl Jump {
    /// What energy, traction and slope gain at a place where the traction falls evenly instead, over a width of
    /// fall·compliance about the jump, at most twice its gap.
    pub fn smoothing(self, place: f64, range: f64, compliance: f64) -> [f64; 3] {
        let width = (self.fall.abs() * compliance).min(2.0 * range * self.place);
        let beyond = range * (place - self.place);
        let left = 0.5 * width - beyond.abs();
        if left <= 0.0 {
            return [0.0; 3];
        }
        let traction = self.fall * left / width;
        [-0.5 * left * traction, if beyond < 0.0 { -traction } else { traction }, -self.fall / width]
    }
}
