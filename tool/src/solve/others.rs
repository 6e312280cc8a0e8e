//! The fields that a solve may leave besides gap and pressures: the softest mode, displacements, and the plastic depth.

use asperity::{Result, Surface};
use asperity_scene::{Answer, Case, Elastic, gap_to_write};
use ndarray::Array2;

use super::Options;
use crate::options::Scalar;

/// The files.
pub const OTHERS: [&str; 4] = ["mode.npy", "displacement.npy", "against_displacement.npy", "plastic_depth.npy"];

/// A field on the whole of the map, by its file.
pub type Named = (&'static str, Array2<f64>);

impl Options {
    /// The files of the fields that are asked for, or come with a hardness.
    pub fn other_files(&self, case: &Case) -> impl Iterator<Item = &'static str> + use<> {
        let (displacement, scene) = (self.fields.is_some(), case.scene());
        let both = displacement && scene.elastic.against_modulus.is_some();
        let asked = [case.given().is_tested(), displacement, both, scene.adhesion.yields()];
        OTHERS.into_iter().zip(asked).filter_map(|(name, asked)| asked.then_some(name))
    }
}

/// These fields of what was found, on its surface if displacements are asked for.
pub fn other_fields<T: Scalar>(found: &Answer<T>, elastic: &Elastic, surface: Option<&Surface>) -> Result<Vec<Named>> {
    let mode = found.mode.as_ref().map(|mode| mode.mapv(T::widen));
    let solution = &found.solution;
    let depth = solution.plastic_depth.as_ref().map(|depth| depth.mapv(T::widen));
    let (own, other) = match surface {
        None => (None, None),
        Some(surface) => match found.sight.displacements(elastic, solution.pressure.view())? {
            Some([own, other]) => (Some(own), Some(other)),
            None => {
                let mut own = gap_to_write(solution).mapv(T::widen) + surface.heights();
                depth.iter().for_each(|depth| own -= depth);
                (Some(own), None)
            }
        },
    };
    Ok(OTHERS.into_iter().zip([mode, own, other, depth]).filter_map(|(name, field)| Some((name, field?))).collect())
}
