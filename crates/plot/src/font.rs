//! The font: widths and outlines of the characters of a text. `font/README.md` says where it is from.

use std::sync::LazyLock;

use ttf_parser::{Face, GlyphId};

/// The file of the font, which a PDF has in it.
pub(super) const FILE: &[u8] = include_bytes!("font/arimo.ttf");

/// The families that look like it, for viewers of SVG.
pub(super) const FAMILIES: &str = "Arimo, 'Liberation Sans', Arial, Helvetica, sans-serif";

static FACE: LazyLock<Option<Face<'static>>> = LazyLock::new(|| Face::parse(FILE, 0).ok());

/// The parsed file; a test shows that it can be parsed.
pub(super) fn face() -> Option<&'static Face<'static>> {
    FACE.as_ref()
}

/// The glyph of a character, of number 0, an empty box, where the font has none.
pub(super) fn glyph(character: char) -> GlyphId {
    face().and_then(|face| face.glyph_index(character)).unwrap_or(GlyphId(0))
}

/// The way from a glyph to the next one, as a share of the size of the font.
pub(super) fn advance(glyph: GlyphId) -> f64 {
    face().map_or(0.5, |face| f64::from(face.glyph_hor_advance(glyph).unwrap_or(0)) / f64::from(face.units_per_em()))
}

/// The width of a text in points.
pub(super) fn width(text: &str, size: f64) -> f64 {
    size * text.chars().map(|character| advance(glyph(character))).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_all_that_labels_need() {
        assert!(face().is_some());
        for character in "0123456789−.,:;()/·×±% ABCXYZ abcxyz µμρτλνφ ²³⁻⁰¹⁴⁹ √≤≥′äéñ*".chars()
        {
            assert_ne!(glyph(character), GlyphId(0), "{character}");
            assert!(advance(glyph(character)) > 0.0, "{character}");
        }
        assert_eq!(glyph('🦀'), GlyphId(0));
    }

    #[test]
    fn the_font_is_proportional() {
        assert!(width("mmm", 9.0) > 2.0 * width("iii", 9.0));
        assert!((width("mi", 9.0) - width("m", 9.0) - width("i", 9.0)).abs() < 1e-12);
    }
}
