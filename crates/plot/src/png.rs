//! PNG: whole pictures, and the maps in SVG and PDF.

use crate::shape::Colour;

/// A PNG file of 8-bit RGB pixels, row by row; `dpi` of them to an inch.
pub(super) fn encode(columns: usize, pixels: &[Colour], dpi: f64) -> std::io::Result<Vec<u8>> {
    let mut file = Vec::new();
    let side = |pixels: usize| u32::try_from(pixels).map_err(|_| std::io::Error::other("too many pixels"));
    let mut encoder = png::Encoder::new(&mut file, side(columns)?, side(pixels.len() / columns.max(1))?);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Balanced);
    let per_metre = (dpi / 0.0254).round() as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit: png::Unit::Meter }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels.as_flattened())?;
    writer.finish()?;
    Ok(file)
}

/// The compressed pixels in a PNG file, as its data chunks have them.
pub(super) fn compressed(mut file: &[u8]) -> Vec<u8> {
    let mut data = Vec::new();
    file = file.get(8..).unwrap_or_default();
    while let Some((head, rest)) = file.split_at_checked(8) {
        let length = head[..4].iter().fold(0, |sum, byte| 256 * sum + usize::from(*byte));
        let Some(chunk) = rest.get(..length) else { break };
        if &head[4..] == b"IDAT" {
            data.extend_from_slice(chunk);
        }
        // a checksum of four bytes ends the chunk
        file = rest.get(length + 4..).unwrap_or_default();
    }
    data
}
