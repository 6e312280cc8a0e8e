//! Colour bars at the side of a map.

use super::{Map, PIXELS};
use crate::Picture;
use crate::colours::Colours;
use crate::frame::{STEP_BESIDE, draw_axis_beside, label_length};
use crate::scale::{Axis, Part, three_digits};
use crate::shape::{Area, BLACK, Curve, HAIRLINE, Image, Shape};

/// The width of the colour bar, its distance from the map, and the height of its arrows.
pub(super) const BAR: f64 = 11.0;
pub(super) const GAP: f64 = 15.0;
const ARROW: f64 = 9.0;
/// The distance between the bars of two signs.
const SPLIT: f64 = 10.0;

/// A colour bar with its numbers, and an arrow at each end beyond which there are values.
pub(super) struct Bar {
    pub(super) axis: Axis,
    range: (f64, f64),
    /// The top and the bottom, below the top of the map.
    pub(super) place: (f64, f64),
    /// The room for the arrows at the lower and the upper end.
    arrows: (f64, f64),
}

impl Bar {
    /// A colour bar for all values, or one for each sign, the positive one on top.
    pub(super) fn all(map: &Map<'_>, colours: &Colours, height: f64) -> Vec<Self> {
        let ranges = colours.ranges();
        let count = ranges.len();
        let named = |sign: &str| if count == 2 && !sign.is_empty() { sign } else { map.label }.to_owned();
        let names = map.signs.map(named);
        let longest = names.iter().map(|name| label_length(name)).fold(0.0, f64::max);
        let length = ((height - SPLIT * (count as f64 - 1.0)) / count as f64).max(longest);
        let (below, above) = colours.beyond();
        let bar = |(k, (range, name)): (usize, ((f64, f64), &String))| {
            let top = (count - 1 - k) as f64 * (length + SPLIT);
            let arrow = |there: bool| if there { ARROW } else { 0.0 };
            let arrows = (arrow(below && k == 0), arrow(above && k + 1 == count));
            let body = length - arrows.0 - arrows.1;
            let mut axis = Axis::new(&Part::new(range.0, range.1, map.unit), name, (body / STEP_BESIDE) as i32);
            for (there, share, extreme, value) in [
                (arrows.0 > 0.0, -ARROW / body, "min", colours.extremes.0),
                (arrows.1 > 0.0, 1.0 + ARROW / body, "max", colours.extremes.1),
            ] {
                if there {
                    axis.ticks.push((share, format!("{extreme} {}", three_digits(value, map.unit))));
                }
            }
            Self { axis, range, place: (top, top + length), arrows }
        };
        ranges.into_iter().zip(&names).enumerate().map(bar).collect()
    }

    pub(super) fn draw(&self, picture: &mut Picture, (left, top): (f64, f64), room: f64, colours: &Colours) {
        let (top, bottom) = (top + self.place.0, top + self.place.1);
        let body = Area::new(left, top + self.arrows.1, BAR, bottom - top - self.arrows.0 - self.arrows.1);
        let rows = (PIXELS * body.height).round() as usize;
        // as many columns as at the usual resolution: programs that smooth an image would smear a single one
        let columns = (PIXELS * BAR).round() as usize;
        let shade = |row: usize| {
            let along = (rows as f64 - row as f64 - 0.5) / rows as f64;
            colours.colour(self.range.0 + (self.range.1 - self.range.0) * along)
        };
        let pixels = (0..rows).flat_map(|row| std::iter::repeat_n(shade(row), columns)).collect();
        picture.shapes.push(Shape::Image(Image { area: body, columns, pixels }));
        picture.outline(body);
        let ends = [(self.arrows.0, body.bottom(), bottom, self.range.0), (self.arrows.1, body.top, top, self.range.1)];
        for (length, base, tip, end) in ends.into_iter().filter(|(length, ..)| *length > 0.0) {
            let corners = |out: f64| [(left - out, base), (left + 0.5 * BAR, tip), (left + BAR + out, base)];
            picture.shapes.push(Shape::Triangle(corners(HAIRLINE), colours.colour(end)));
            let within = Area::new(left - 1.0, base.min(tip) - 1.0, BAR + 2.0, length + 2.0);
            let pieces = vec![corners(0.0).to_vec()];
            picture.shapes.push(Shape::Curve(Curve { pieces, width: HAIRLINE, colour: BLACK, within }));
        }
        draw_axis_beside(picture, &self.axis, body, 1.0, room);
    }
}
