//! The fields that a solve may leave besides gap and pressures: the softest mode, displacements, and the plastic depth.

use asperity::{Result, Surface};
use asperity_scene::{Answer, Elastic, Scalar, gap_to_write};
use ndarray::Array2;

/// The files.
pub const OTHERS: [&str; 4] = ["mode.npy", "displacement.npy", "against_displacement.npy", "plastic_depth.npy"];

/// A field on the whole of the map, by its file.
pub type Named = (&'static str, Array2<f64>);

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
