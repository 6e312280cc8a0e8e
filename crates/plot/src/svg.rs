//! Pictures as SVG: text as text, maps as embedded PNG images.

use std::fmt::Write;

use crate::Picture;
use crate::font;
use crate::page::escaped;
use crate::png;
use crate::shape::{Anchor, Colour, Shape};

/// The content of an SVG file, which needs no other file.
pub(super) fn encode(picture: &Picture) -> std::io::Result<String> {
    let (width, height) = (number(picture.width), number(picture.height));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}pt\" height=\"{height}pt\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"{}\">\n<title>{}</title>\n<path fill=\"#fff\" d=\"M0 0H{width}V{height}H0z\"/>\n",
        font::FAMILIES,
        escaped(&picture.title)
    );
    for shape in &picture.shapes {
        let line = match shape {
            Shape::Fill(area, fill) => {
                let [x, y, w, h] = [area.left, area.top, area.width, area.height].map(number);
                format!("<path fill=\"{}\" d=\"M{x} {y}h{w}v{h}h-{w}z\"/>", hex(*fill))
            }
            Shape::Triangle(corners, fill) => format!("<path fill=\"{}\" d=\"{}z\"/>", hex(*fill), path(corners)),
            Shape::Curve(curve) => {
                // the name of what cuts the curve off says what it is: another picture on a page may have it, too
                let [x, y, w, h] =
                    [curve.within.left, curve.within.top, curve.within.width, curve.within.height].map(number);
                let pieces: String = curve.pieces.iter().map(|piece| path(piece)).collect();
                format!(
                    "<clipPath id=\"within-{x}-{y}-{w}-{h}\"><path d=\"M{x} {y}h{w}v{h}h-{w}z\"/></clipPath>\
                     <path clip-path=\"url(#within-{x}-{y}-{w}-{h})\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" \
                     stroke-linecap=\"round\" stroke-linejoin=\"round\" d=\"{pieces}\"/>",
                    hex(curve.colour),
                    number(curve.width)
                )
            }
            Shape::Text(text) => {
                let (x, y) = (number(text.at.0), number(text.at.1));
                let anchor = match text.anchor {
                    Anchor::Start => "",
                    Anchor::Middle => " text-anchor=\"middle\"",
                    Anchor::End => " text-anchor=\"end\"",
                };
                let turn = if text.upwards { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
                let (size, words) = (number(text.size), escaped(&text.text));
                format!("<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\"{anchor}{turn}>{words}</text>")
            }
            Shape::Image(image) => {
                let [x, y, w, h] = [image.area.left, image.area.top, image.area.width, image.area.height].map(number);
                let data = base64(&png::encode(image.columns, &image.pixels, picture.dpi)?);
                format!(
                    "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\" \
                     style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{data}\"/>"
                )
            }
        };
        svg.push_str(&line);
        svg.push('\n');
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}

/// A coordinate, to a hundredth of a point.
pub(super) fn number(value: f64) -> String {
    let text = format!("{:.2}", value.clamp(-1e6, 1e6));
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn hex([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// The way through points; through a single one, a line of no length.
fn path(points: &[(f64, f64)]) -> String {
    let mut path = String::new();
    for (k, (x, y)) in points.iter().enumerate() {
        let _ = write!(path, "{}{} {}", if k == 0 { 'M' } else { 'L' }, number(*x), number(*y));
    }
    if points.len() == 1 { path + "h0" } else { path }
}

/// Bytes in the 64 characters of RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0, |bits, k| bits << 8 | usize::from(three.get(k).copied().unwrap_or(0)));
        for k in 0..4 {
            text.push(if k <= three.len() { char::from(DIGITS[bits >> (18 - 6 * k) & 63]) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_rfc_4648() {
        let of = |text: &str| base64(text.as_bytes());
        assert_eq!(["", "f", "fo", "foo", "foob"].map(of), ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg=="]);
        assert_eq!(base64(&[0xfb, 0xff, 0xfe]), "+//+");
    }

    #[test]
    fn coordinates_are_short_and_finite() {
        assert_eq!(
            [0.0, -0.001, 2.5, 100.0, 1.0 / 3.0, 1e300].map(number),
            ["0", "0", "2.5", "100", "0.33", "1000000"]
        );
    }
}
