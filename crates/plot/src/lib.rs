//! Pictures: fields drawn as labelled maps ([`Map`]), and curves as charts ([`Chart`]), in PNG, SVG and PDF.
//!
//! A map or a chart is drawn once, as shapes in points, and the same shapes are written in each of the formats. Text is
//! in one proportional font that comes with the crate, its widths the same in all three formats.

mod chart;
mod colours;
mod distribution;
mod font;
mod frame;
mod load;
mod map;
#[doc(hidden)]
pub mod page;
mod pdf;
mod png;
mod raster;
mod scale;
mod shape;
mod svg;

use std::fs;
use std::path::Path;

pub use chart::{Chart, Style};
pub use colours::Colouring;
pub use distribution::Distribution;
pub use load::LoadScale;
pub use map::Map;

use asperity::{Error, Result};
use raster::Raster;
use shape::{Anchor, Area, Colour, INK, Shape, Text};

/// The resolution of pictures, in pixels per inch, where no other is wanted: two pixels for each point.
pub const DPI: f64 = 144.0;

/// The paper of a picture: pixels per inch, [`DPI`] or more, and a width, if it is to have one.
///
/// ```
/// use asperity_plot::{Map, Colouring, Paper};
/// use asperity::Grid;
/// let grid = Grid::square(64, 1.0)?;
/// let heights = grid.sample(|x, y| (9.0 * x).cos() * (9.0 * y).cos());
/// let column = Paper { dpi: 300.0, width: Some(85.0 / 25.4 * 72.0) };
/// Map::new(heights.view(), grid, Colouring::Sequential).draw(column)?;
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paper {
    /// Pixels per inch, from 36 to 1200.
    pub dpi: f64,
    /// The width of the whole picture, in points. The text has the same size at any width.
    pub width: Option<f64>,
}

impl From<f64> for Paper {
    fn from(dpi: f64) -> Self {
        Self { dpi, width: None }
    }
}

/// The least width of a map or of the area of a chart, in points.
const LEAST: f64 = 40.0;

impl Paper {
    /// The width of a map or chart next to which axes and bars take `beside`; `otherwise` where the paper has no width.
    fn across(&self, beside: f64, otherwise: f64) -> Result<f64> {
        let Some(value) = self.width else { return Ok(otherwise) };
        let left = value - beside;
        let (name, requirement) = ("width of the picture in points", "wider than axes and colour bars by 40");
        if left >= LEAST { Ok(left) } else { Err(Error::Value { name, value, requirement }) }
    }
}

/// The resolutions that are not refused.
const RESOLUTIONS: std::ops::RangeInclusive<f64> = 36.0..=1200.0;

/// The format of a picture.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Pixels.
    Png,
    /// Text and lines, with maps as images in it, for web pages and drawing programs.
    Svg,
    /// Text and lines, with maps as images in it, and with the font, for print.
    Pdf,
}

impl Format {
    /// The format that the ending of a name asks for.
    ///
    /// ```
    /// use asperity_plot::Format;
    /// assert_eq!(Format::from_path("loop.pdf")?, Format::Pdf);
    /// assert!(Format::from_path("loop.jpg").is_err());
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`] if the name has another ending.
    pub fn from_path(path: impl AsRef<Path>) -> Result<Self> {
        match path.as_ref().extension().map(|ending| ending.to_string_lossy().to_lowercase()).as_deref() {
            Some("png") => Ok(Self::Png),
            Some("svg") => Ok(Self::Svg),
            Some("pdf") => Ok(Self::Pdf),
            _ => Err(Error::file(path, "does not end in .png, .svg or .pdf: rename it")),
        }
    }
}

/// A picture, drawn by [`Map::draw`] or [`Chart::draw`].
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    title: String,
    /// The sides in points.
    width: f64,
    height: f64,
    dpi: f64,
    shapes: Vec<Shape>,
    /// The colours of a map, and what each stands for.
    key: Vec<([u8; 3], String)>,
    /// The load beyond the ends of the colour bars of a map.
    beyond: Option<String>,
}

impl Picture {
    /// The colours of a map with the values that they stand for, some hundred of them along the colour bars or the
    /// classes, by which a value can be read off the picture; none of a chart.
    pub fn key(&self) -> &[([u8; 3], String)] {
        &self.key
    }

    /// The share of the load on nodes beyond the ends of the colour bars of a map, in words, as in its caption; none
    /// where the bars have all of it, and none of a chart.
    pub fn load_beyond(&self) -> Option<&str> {
        self.beyond.as_deref()
    }

    /// Writes the picture to a file, which it replaces, in the format that its name asks for: `.png`, `.svg`, `.pdf`.
    ///
    /// # Errors
    /// [`Error::File`] if the name has another ending, or the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let unwritable = |e: std::io::Error| Error::unwritable(path, e);
        let bytes = match Format::from_path(path)? {
            Format::Png => {
                let raster = Raster::draw(self);
                png::encode(raster.columns, &raster.pixels, self.dpi)
            }
            Format::Svg => svg::encode(self).map(String::into_bytes),
            Format::Pdf => pdf::encode(self),
        };
        bytes.and_then(|bytes| fs::write(path, bytes)).map_err(unwritable)
    }

    /// The picture as the text of an SVG file, as for a web page.
    ///
    /// # Errors
    /// [`Error::File`] if a map in it has too many pixels for an image.
    pub fn svg(&self) -> Result<String> {
        svg::encode(self).map_err(|e| Error::file(Path::new("picture.svg"), e.to_string()))
    }

    /// A white picture with these sides, in points.
    fn new(title: &str, (width, height): (f64, f64), dpi: f64) -> Result<Self> {
        if !RESOLUTIONS.contains(&dpi) {
            let (name, requirement) = ("resolution in pixels per inch", "from 36 to 1200");
            return Err(Error::Value { name, value: dpi, requirement });
        }
        let title = if title.is_empty() { "asperity" } else { title };
        Ok(Self { title: printable(title), width, height, dpi, shapes: Vec::new(), key: Vec::new(), beyond: None })
    }

    fn fill(&mut self, area: Area, colour: Colour) {
        self.shapes.push(Shape::Fill(area, colour));
    }

    /// A line just around `area`.
    fn outline(&mut self, area: Area) {
        self.shapes.extend(area.outline().map(|side| Shape::Fill(side, INK)));
    }

    /// Text in line with the point `at`, its digits and capitals centred on it.
    fn text(&mut self, text: &str, at: (f64, f64), size: f64, anchor: Anchor) {
        let at = (at.0, at.1 + HALF_CAPITAL * size);
        self.shapes.push(Shape::Text(Text { text: printable(text), at, size, anchor, upwards: false }));
    }

    /// Text that runs upwards, centred on `at`.
    fn text_upwards(&mut self, text: &str, at: (f64, f64), size: f64) {
        let at = (at.0 + HALF_CAPITAL * size, at.1);
        self.shapes.push(Shape::Text(Text { text: printable(text), at, size, anchor: Anchor::Middle, upwards: true }));
    }
}

/// Half of the height of a capital letter, as a share of the size of the font.
const HALF_CAPITAL: f64 = 0.35;

/// A text without characters that have no width, or that would end a line.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests;

/// Runs the code of the README as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
