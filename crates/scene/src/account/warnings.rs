//! The probable mistakes in the input of a solve.

use asperity::{AdhesionLaw, Real, Surface};
use asperity_maps::Topography;
use asperity_maps::warning::{Warning, WarningCode};

use crate::key::{Elastic, Notice, Units, power_of_length, times_ten_to};

/// The warnings of the input of a solve, before it: of the heights, of the modulus unless its unit is known, and of the
/// law on the heights; in units as far as they are known. Heights may have been converted from the unit of their file.
pub fn warnings_of_input<T: Real>(
    (surface, converted_from): (&Surface, Option<&str>),
    elastic: &Elastic,
    law: &dyn AdhesionLaw<T>,
    units: &Units,
) -> Vec<Notice> {
    let mut found = elastic.boundary.warnings(surface);
    let codes = converted_from.map_or(Vec::new(), |unit| codes_in_file(surface, unit));
    if !codes.is_empty() {
        // nothing else can be told of the heights
        found.retain(|warning| warning.code == WarningCode::Cells);
    }
    let moduli = [Some(elastic.modulus), elastic.against_modulus].into_iter().flatten();
    let of_modulus = |modulus| Warning::of_modulus(modulus, surface.grid(), units.length.as_deref());
    found.extend(moduli.filter(|_| units.pressure.is_none()).find_map(of_modulus));
    let body = elastic.body().ok();
    found.extend(body.as_deref().and_then(|body| Warning::of_body(body, surface.grid())));
    let modulus = body.map_or(elastic.modulus, |body| body.modulus_on(surface.grid()));
    found.extend(Warning::of_law(&law, surface, modulus));
    found.iter().map(|warning| units.describe(warning)).chain(codes).collect()
}

/// The codes for missing points in heights that were converted from a unit, as they stand in the file.
fn codes_in_file(surface: &Surface, unit: &str) -> Vec<Notice> {
    let Some(power) = power_of_length(unit) else { return Vec::new() };
    // codes are whole numbers; the conversion may have rounded the last digit
    let in_file = surface.heights().mapv(|height| {
        let height = times_ten_to(-power, height);
        let whole = height.round();
        if (height - whole).abs() <= f64::EPSILON * whole.abs() { whole } else { height }
    });
    let codes = Warning::of_topography(&Topography::new(in_file));
    let codes = codes.iter().filter(|warning| warning.code == WarningCode::MissingCode);
    codes.map(|warning| Units::of_map(Some(unit)).describe(warning)).collect()
}
