//! The shapes that make pictures. All lengths are in points, 1/72 inch, from the upper left corner.

/// A colour: red, green and blue.
pub(super) type Colour = [u8; 3];

pub(super) const BLACK: Colour = [0; 3];
/// The colour of frames and ticks, no colour of data: a dark page draws it lighter.
pub(super) const INK: Colour = [17; 3];
pub(super) const WHITE: Colour = [255; 3];
pub(super) const GREY: Colour = [211; 3];

/// The width of frames and ticks.
pub(super) const HAIRLINE: f64 = 0.5;

/// A rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Area {
    pub(super) fn new(left: f64, top: f64, width: f64, height: f64) -> Self {
        Self { left, top, width, height }
    }

    pub(super) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// The line around the area, just outside of it.
    pub(super) fn outline(&self) -> [Self; 4] {
        let Self { left, top, width, height } = *self;
        [
            Self::new(left - HAIRLINE, top - HAIRLINE, width + 2.0 * HAIRLINE, HAIRLINE),
            Self::new(left - HAIRLINE, top + height, width + 2.0 * HAIRLINE, HAIRLINE),
            Self::new(left - HAIRLINE, top, HAIRLINE, height),
            Self::new(left + width, top, HAIRLINE, height),
        ]
    }
}

/// The part of a text that is at its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    /// The share of the width of a text that is before its place.
    pub(super) fn before(self) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => 0.5,
            Self::End => 1.0,
        }
    }
}

/// A line of text, black.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Text {
    pub(super) text: String,
    /// The place on the base line.
    pub(super) at: (f64, f64),
    pub(super) size: f64,
    pub(super) anchor: Anchor,
    /// Whether it runs upwards rather than to the right.
    pub(super) upwards: bool,
}

/// A curve of one width.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    /// The pieces, of finite points; one of a single point is a dot.
    pub(super) pieces: Vec<Vec<(f64, f64)>>,
    pub(super) width: f64,
    pub(super) colour: Colour,
    /// The area; shapes are cut off at its edges.
    pub(super) within: Area,
}

/// Pixels from the upper left corner of an area, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Image {
    pub(super) area: Area,
    pub(super) columns: usize,
    pub(super) pixels: Vec<Colour>,
}

impl Image {
    pub(super) fn rows(&self) -> usize {
        self.pixels.len() / self.columns.max(1)
    }
}

/// A shape; later ones cover earlier ones.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    Fill(Area, Colour),
    /// A filled triangle.
    Triangle([(f64, f64); 3], Colour),
    Curve(Curve),
    Text(Text),
    Image(Image),
}
