//! The boundary of the elastic body.

use asperity::{Control, Held, Surface};
use asperity_maps::warning::{Warning, WarningCode};
use ndarray::Array2;

use crate::key::choice;

choice! {
    /// The boundary of the elastic body, by the surroundings of the map.
    Boundary {
        /// copies of the map: it is a piece of a larger surface
        Periodic = "periodic",
        /// nothing: the map is a tip, an indenter or a chip, and the half-space carries no load there
        Free = "free",
    }
}

impl Boundary {
    /// The probable mistakes in the heights: with a free boundary opposite sides need not meet, and a body that ends
    /// may be flat.
    pub fn warnings(self, surface: &Surface) -> Vec<Warning> {
        let (mut found, free) = (Warning::of_surface(surface), self == Self::Free);
        found.retain(|warning| match warning.code {
            WarningCode::Tilt | WarningCode::OpenEdges | WarningCode::Ends => !free,
            WarningCode::Flat => !free && surface.absent().is_none(),
            _ => true,
        });
        found
    }

    /// The load by which a contact fraction is searched for, of no meaning but for its kind.
    pub fn searched_by(self, adhesive: bool) -> Control {
        match (adhesive, self) {
            (false, _) => Control::MeanPressure(0.0),
            (true, Self::Periodic) => Control::MeanGap(0.0),
            (true, Self::Free) => Control::Approach(0.0),
        }
    }

    /// The gap of a body that comes from afar: undeformed, at the approach at which `loads` begin, if they grow from
    /// one before touch. The default start of a solve under a pull would find the body sticking.
    pub fn start_afar(self, surface: &Surface, loads: &[Control]) -> Option<Array2<f64>> {
        let [from, to, ..] = *loads else { return None };
        let comes = self == Self::Free && from.holds() != Held::Load && from.value() < 0.0 && to.value() > from.value();
        comes.then(|| self.undeformed(surface, from.value()))
    }

    /// The gap of undeformed bodies at an approach, a mean gap, or the position at rest of a spring.
    ///
    /// # Errors
    /// The reason and the remedy, if a load does not say how far they are, or if they overlap.
    pub fn apart(self, surface: &Surface, load: Control) -> std::result::Result<Array2<f64>, String> {
        let (name, at) = (load.name().replace('-', " "), load.value());
        if load.holds() == Held::Load {
            let remedy = if self == Self::Free { "an approach" } else { "a mean gap" };
            return Err(format!(
                "undeformed bodies are to be apart, but a {name} does not say how far: give {remedy} or a spring, or a \
                 gap to start from"
            ));
        }
        let gap = self.undeformed(surface, at);
        match surface.grid().each(gap.iter().any(|&gap| gap < 0.0)).contains(&true) {
            true => {
                Err(format!("undeformed bodies overlap where the {name} is {at}: give one at which they are apart"))
            }
            false => Ok(gap),
        }
    }

    fn undeformed(self, surface: &Surface, at: f64) -> Array2<f64> {
        let heights = surface.heights();
        if self == Self::Periodic {
            let mean = surface.mean();
            return heights.mapv(|height| at + mean - height);
        }
        let peak = peak(surface);
        heights.mapv(|height| peak - height - at)
    }
}

/// The greatest height.
pub(crate) fn peak(surface: &Surface) -> f64 {
    let own = surface.heights().fold(f64::NEG_INFINITY, |highest, height| highest.max(*height));
    surface.grid().each(own).into_iter().fold(own, f64::max)
}
