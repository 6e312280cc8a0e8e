//! The canvas: pixels, text and lines of a picture.

use std::convert::Infallible;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{PrimitiveStyle, PrimitiveStyleBuilder, Rectangle, Triangle};
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyleBuilder};

use crate::error::{Error, Result};

/// The width of a character in each of the fonts.
pub(super) const CHARACTER: i32 = 9;

pub(super) fn text_width(text: &str) -> i32 {
    text.chars().count() as i32 * CHARACTER
}

/// A frame buffer on which one draws; what lies outside of it is dropped.
pub(super) struct Canvas {
    size: Size,
    pixels: Vec<Rgb888>,
}

impl Canvas {
    pub(super) fn new(width: i32, height: i32) -> Self {
        let size = Size::new(width.unsigned_abs(), height.unsigned_abs());
        Self { size, pixels: vec![Rgb888::WHITE; size.width as usize * size.height as usize] }
    }

    fn pixel(&mut self, at: Point) -> Option<&mut Rgb888> {
        let (x, y) = (usize::try_from(at.x).ok()?, usize::try_from(at.y).ok()?);
        let width = self.size.width as usize;
        if x < width { self.pixels.get_mut(y * width + x) } else { None }
    }

    pub(super) fn fill(&mut self, area: Rectangle, colour: Rgb888) {
        let Ok(()) = area.into_styled(PrimitiveStyle::with_fill(colour)).draw(self);
    }

    /// A frame of one pixel just outside of `area`.
    pub(super) fn frame(&mut self, area: Rectangle) {
        let Ok(()) = area.offset(1).into_styled(PrimitiveStyle::with_stroke(Rgb888::BLACK, 1)).draw(self);
    }

    /// A triangle with a black outline.
    pub(super) fn triangle(&mut self, [a, b, c]: [Point; 3], colour: Rgb888) {
        let style = PrimitiveStyleBuilder::new().fill_color(colour).stroke_color(Rgb888::BLACK).stroke_width(1).build();
        let Ok(()) = Triangle::new(a, b, c).into_styled(style).draw(self);
    }

    /// Text in line with the point `at`, vertically centred on it.
    pub(super) fn text(&mut self, text: &str, at: Point, font: &MonoFont<'_>, alignment: Alignment) {
        // The fonts have Latin-1 only, and a line break would run into the text below.
        let printable = |c: char| match c {
            'μ' => 'µ',
            '−' | '–' | '—' => '-',
            c if c.is_control() => ' ',
            c => c,
        };
        let text: String = text.chars().map(printable).collect();
        let style = TextStyleBuilder::new().alignment(alignment).baseline(Baseline::Middle).build();
        let Ok(_) = Text::with_text_style(&text, at, MonoTextStyle::new(font, Rgb888::BLACK), style).draw(self);
    }

    /// Text that runs upwards, centred on `at`.
    pub(super) fn text_upwards(&mut self, text: &str, at: Point, font: &MonoFont<'_>) {
        let (length, height) = (text_width(text), font.character_size.height as i32);
        let mut level = Self::new(length, height);
        level.text(text, Point::new(0, height / 2), font, Alignment::Left);
        for p in level.bounding_box().points() {
            if let (Some(Rgb888::BLACK), Some(pixel)) =
                (level.pixel(p).copied(), self.pixel(at + Point::new(p.y - height / 2, length / 2 - p.x)))
            {
                *pixel = Rgb888::BLACK;
            }
        }
    }

    /// A smooth curve through `points`, two pixels wide, broken where they are not finite, and cut off at the edges of
    /// `area`.
    pub(super) fn curve(&mut self, points: &[(f64, f64)], area: Rectangle, colour: Rgb888) {
        let (corner, width) = (area.top_left, area.size.width as usize);
        // The coverage of each pixel is kept until the end, so that joints are not drawn twice.
        let mut coverage = vec![0.0_f64; width * area.size.height as usize];
        for pair in points.windows(2) {
            let ((ax, ay), (bx, by)) = (pair[0], pair[1]);
            if !(ay.is_finite() && by.is_finite()) {
                continue;
            }
            let (dx, dy) = (bx - ax, by - ay);
            let low = Point::new((ax.min(bx) - 2.0) as i32, (ay.min(by) - 2.0) as i32);
            let high = Point::new((ax.max(bx) + 2.0) as i32, (ay.max(by) + 2.0) as i32);
            for p in Rectangle::with_corners(low, high).intersection(&area).points() {
                let (px, py) = (f64::from(p.x) + 0.5 - ax, f64::from(p.y) + 0.5 - ay);
                let along = ((px * dx + py * dy) / (dx * dx + dy * dy).max(1e-12)).clamp(0.0, 1.0);
                let distance = ((px - along * dx).powi(2) + (py - along * dy).powi(2)).sqrt();
                let at = p - corner;
                let covered = &mut coverage[at.y as usize * width + at.x as usize];
                *covered = covered.max((1.5 - distance).clamp(0.0, 1.0));
            }
        }
        for (at, covered) in area.points().zip(coverage) {
            if let Some(pixel) = self.pixel(at) {
                let mix = |a: u8, b: u8| (f64::from(a) + covered * (f64::from(b) - f64::from(a))).round() as u8;
                *pixel =
                    Rgb888::new(mix(pixel.r(), colour.r()), mix(pixel.g(), colour.g()), mix(pixel.b(), colour.b()));
            }
        }
    }

    /// Writes the picture as an 8-bit RGB PNG file.
    pub(super) fn write_png(&self, path: &Path) -> Result<()> {
        let unwritable = |e: std::io::Error| Error::file(path, format!("cannot be written: {e}"));
        let data: Vec<u8> = self.pixels.iter().flat_map(|c| [c.r(), c.g(), c.b()]).collect();
        let mut file = BufWriter::new(File::create(path).map_err(unwritable)?);
        let mut encoder = png::Encoder::new(&mut file, self.size.width, self.size.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::Balanced);
        encoder
            .write_header()
            .and_then(|mut writer| writer.write_image_data(&data).and_then(|()| writer.finish()))
            .map_err(|e| unwritable(e.into()))?;
        file.flush().map_err(unwritable)
    }
}

impl OriginDimensions for Canvas {
    fn size(&self) -> Size {
        self.size
    }
}

impl DrawTarget for Canvas {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> std::result::Result<(), Infallible> {
        for Pixel(at, colour) in pixels {
            if let Some(pixel) = self.pixel(at) {
                *pixel = colour;
            }
        }
        Ok(())
    }
}
