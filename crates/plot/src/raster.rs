//! Pictures as pixels.

use ab_glyph_rasterizer::{Point, Rasterizer, point};
use ttf_parser::OutlineBuilder;

use crate::Picture;
use crate::colours::rounded;
use crate::font;
use crate::shape::{Area, Colour, Curve, Image, Shape, Text, WHITE};

/// A frame buffer; what lies outside of it is dropped.
pub(super) struct Raster {
    pub(super) columns: usize,
    pub(super) pixels: Vec<Colour>,
    /// Pixels per point.
    scale: f64,
}

/// An area in whole pixels.
#[derive(Clone, Copy)]
struct Block {
    left: i64,
    top: i64,
    columns: usize,
    rows: usize,
}

impl Raster {
    /// The pixels of a picture at its resolution.
    pub(super) fn draw(picture: &Picture) -> Self {
        let scale = picture.dpi / 72.0;
        let [columns, rows] = [picture.width, picture.height].map(|side| (side * scale).round().max(1.0) as usize);
        let mut raster = Self { columns, pixels: vec![WHITE; columns * rows], scale };
        for shape in &picture.shapes {
            match shape {
                Shape::Fill(area, colour) => raster.fill(*area, *colour),
                Shape::Triangle(corners, colour) => raster.triangle(corners, *colour),
                Shape::Curve(curve) => raster.curve(curve),
                Shape::Text(text) => raster.text(text),
                Shape::Image(image) => raster.image(image),
            }
        }
        raster
    }

    fn pixel(&mut self, column: i64, row: i64) -> Option<&mut Colour> {
        let (column, row) = (usize::try_from(column).ok()?, usize::try_from(row).ok()?);
        if column < self.columns { self.pixels.get_mut(row * self.columns + column) } else { None }
    }

    fn set(&mut self, column: i64, row: i64, colour: Colour) {
        if let Some(pixel) = self.pixel(column, row) {
            *pixel = colour;
        }
    }

    /// Covers a share of a pixel.
    fn cover(&mut self, column: i64, row: i64, colour: Colour, share: f64) {
        if let Some(pixel) = self.pixel(column, row) {
            let mix = |from: u8, to: u8| rounded(f64::from(from) + share * (f64::from(to) - f64::from(from)));
            *pixel = [0, 1, 2].map(|k| mix(pixel[k], colour[k]));
        }
    }

    /// The pixels of an area, at least one.
    fn block(&self, area: &Area) -> Block {
        let [left, top] = [area.left, area.top].map(|side| (side * self.scale).round() as i64);
        let [columns, rows] = [area.width, area.height].map(|side| (side * self.scale).round().max(1.0) as usize);
        Block { left, top, columns, rows }
    }

    fn fill(&mut self, area: Area, colour: Colour) {
        let Block { left, top, columns, rows } = self.block(&area);
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            self.set(left + column as i64, top + row as i64, colour);
        }
    }

    /// Each pixel in the colour of the one of the image that is below its middle.
    fn image(&mut self, image: &Image) {
        let Block { left, top, columns, rows } = self.block(&image.area);
        let below = |pixel: usize, pixels: usize, of: usize| (2 * pixel + 1) * of / (2 * pixels);
        let along: Vec<_> = (0..columns).map(|column| below(column, columns, image.columns)).collect();
        for row in 0..rows {
            let from = below(row, rows, image.rows()) * image.columns;
            for (column, along) in along.iter().enumerate() {
                self.set(left + column as i64, top + row as i64, image.pixels[from + along]);
            }
        }
    }

    /// A closed outline, filled, from the curves that `draw` adds to it within `(left, top)` and `(right, bottom)`.
    fn outline(
        &mut self,
        (left, top): (f64, f64),
        (right, bottom): (f64, f64),
        colour: Colour,
        draw: impl FnOnce(&mut Rasterizer, (f64, f64)),
    ) {
        let (left, top) = (left.floor() - 1.0, top.floor() - 1.0);
        let (columns, rows) = ((right - left).ceil() as usize + 2, (bottom - top).ceil() as usize + 2);
        let mut rasterizer = Rasterizer::new(columns, rows);
        draw(&mut rasterizer, (left, top));
        rasterizer.for_each_pixel_2d(|column, row, share| {
            self.cover(left as i64 + i64::from(column), top as i64 + i64::from(row), colour, f64::from(share.min(1.0)));
        });
    }

    fn triangle(&mut self, corners: &[(f64, f64); 3], colour: Colour) {
        let corners = corners.map(|(x, y)| (x * self.scale, y * self.scale));
        let (low, high) = bounds(&corners);
        self.outline(low, high, colour, |rasterizer, (left, top)| {
            let corners = corners.map(|(x, y)| point((x - left) as f32, (y - top) as f32));
            for k in 0..3 {
                rasterizer.draw_line(corners[k], corners[(k + 1) % 3]);
            }
        });
    }

    /// The share of each pixel that is covered is kept until the end, so that joints are not drawn twice.
    fn curve(&mut self, curve: &Curve) {
        let Block { left, top, columns, rows } = self.block(&curve.within);
        let reach = 0.5 * (curve.width * self.scale).max(1.0) + 0.5;
        let mut coverage = vec![0.0_f64; columns * rows];
        let pixels = |low: f64, high: f64, count: usize| {
            let from = (low - reach).clamp(0.0, count as f64) as usize;
            from..((high + reach).ceil().clamp(0.0, count as f64) as usize)
        };
        for piece in &curve.pieces {
            let place = |&(x, y): &(f64, f64)| (x * self.scale - left as f64, y * self.scale - top as f64);
            let ends = piece.iter().zip(piece.iter().skip(1).chain(piece.last()));
            for ((ax, ay), (bx, by)) in ends.map(|(from, to)| (place(from), place(to))) {
                let (dx, dy) = (bx - ax, by - ay);
                for row in pixels(ay.min(by), ay.max(by), rows) {
                    for column in pixels(ax.min(bx), ax.max(bx), columns) {
                        let (px, py) = (column as f64 + 0.5 - ax, row as f64 + 0.5 - ay);
                        let along = ((px * dx + py * dy) / (dx * dx + dy * dy).max(1e-12)).clamp(0.0, 1.0);
                        let distance = (px - along * dx).hypot(py - along * dy);
                        let covered = &mut coverage[row * columns + column];
                        *covered = covered.max((reach - distance).clamp(0.0, 1.0));
                    }
                }
            }
        }
        for (at, share) in coverage.into_iter().enumerate().filter(|(_, share)| *share > 0.0) {
            self.cover(left + (at % columns) as i64, top + (at / columns) as i64, curve.colour, share);
        }
    }

    fn text(&mut self, text: &Text) {
        let Some(face) = font::face() else { return };
        let size = text.size * self.scale / f64::from(face.units_per_em());
        let mut along = -text.anchor.before() * font::width(&text.text, text.size) * self.scale;
        let (x, y) = (text.at.0 * self.scale, text.at.1 * self.scale);
        for character in text.text.chars() {
            let glyph = font::glyph(character);
            // from the units of the font, with y upwards
            let place = |glyph_x: f64, glyph_y: f64| {
                let (forward, up) = (along + size * glyph_x, size * glyph_y);
                if text.upwards { (x - up, y - forward) } else { (x + forward, y - up) }
            };
            if let Some(bounds_of) = face.glyph_bounding_box(glyph) {
                let [x_min, y_min, x_max, y_max] =
                    [bounds_of.x_min, bounds_of.y_min, bounds_of.x_max, bounds_of.y_max].map(f64::from);
                let (low, high) = bounds(&[place(x_min, y_min), place(x_max, y_max)]);
                self.outline(low, high, [0; 3], |rasterizer, (left, top)| {
                    let place = |x: f32, y: f32| {
                        let (x, y) = place(f64::from(x), f64::from(y));
                        point((x - left) as f32, (y - top) as f32)
                    };
                    let start = point(0.0, 0.0);
                    face.outline_glyph(glyph, &mut Pen { rasterizer, place, start, last: start });
                });
            }
            along += font::advance(glyph) * text.size * self.scale;
        }
    }
}

/// The least and the largest coordinates of points.
fn bounds(points: &[(f64, f64)]) -> ((f64, f64), (f64, f64)) {
    let start = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
    points.iter().fold(start, |(low, high), (x, y)| ((low.0.min(*x), low.1.min(*y)), (high.0.max(*x), high.1.max(*y))))
}

/// The pen that draws the outline of a glyph.
struct Pen<'a, P> {
    rasterizer: &'a mut Rasterizer,
    place: P,
    start: Point,
    last: Point,
}

impl<P: Fn(f32, f32) -> Point> OutlineBuilder for Pen<'_, P> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.start = (self.place)(x, y);
        self.last = self.start;
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = (self.place)(x, y);
        self.rasterizer.draw_line(self.last, to);
        self.last = to;
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (by, to) = ((self.place)(x1, y1), (self.place)(x, y));
        self.rasterizer.draw_quad(self.last, by, to);
        self.last = to;
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let (first, second, to) = ((self.place)(x1, y1), (self.place)(x2, y2), (self.place)(x, y));
        self.rasterizer.draw_cubic(self.last, first, second, to);
        self.last = to;
    }

    fn close(&mut self) {
        self.rasterizer.draw_line(self.last, self.start);
        self.last = self.start;
    }
}
