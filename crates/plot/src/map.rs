//! The map: a field on its rectangle, in colours.

use ndarray::ArrayView2;

use crate::chart::{COLOURS, WIDTH, pieces};
use crate::colours::{ATTRACTIVE, Colouring, Colours, MISSING, YIELDED, cluster_colour};
use crate::frame::{
    Entry, LINE, MARGIN, NUMBERS, STEP_BELOW, STEP_BESIDE, Texts, draw_axis_below, draw_axis_beside, label_length, room,
};
use crate::scale::{Axis, Part, drawable, three_digits};
use crate::shape::{Area, BLACK, Colour, Curve, GREY, HAIRLINE, Image, Shape, WHITE};
use crate::{Paper, Picture};
use asperity::Grid;
use asperity::{Error, Result};

mod bar;

use bar::{BAR, Bar, GAP};

/// The steps along a colour bar in the key of a map.
const SHADES: usize = 100;
/// The pixels of a map to a point, for which its size is chosen.
const PIXELS: f64 = 2.0;

/// The steps in which a map is fitted to the width of a paper.
const FITS: usize = 3;

/// The room at the left of a map, its sides, and the room at its right.
struct Sides {
    left: f64,
    width: f64,
    right: f64,
    height: f64,
}

/// The room that an axis takes at the left of a map, and the room that colour bars take at its right.
fn measure_rooms(y: Option<&Axis>, bars: &[Bar]) -> (f64, f64) {
    let bars_room = bars.iter().map(|bar| room(&bar.axis)).fold(0.0, f64::max);
    let right = if bars.is_empty() { 3.0 * MARGIN } else { GAP + BAR + bars_room + MARGIN };
    (2.0 * MARGIN + y.map_or(0.0, room), right)
}

/// A picture of a field on a periodic rectangle, with its title, axes and legend.
///
/// x runs to the right and y upwards, both from zero to the side length wherever the grid has its origin.
/// At [`DPI`](super::DPI) each node is a cell of one or more pixels; more than 1000 nodes to a side, or more than there
/// are pixels, are averaged in blocks. A value that is not finite has a colour of its own. The picture keeps the aspect
/// ratio of the rectangle up to 5 : 1. A line (`Nx = 1` or `Ny = 1`) is drawn as a curve, on one linear scale whatever
/// the colouring, or as a strip if that is of classes, as [`Colouring::Contact`].
///
/// Units such as "m", "Pa" or "N/m" get the SI prefix that makes the numbers readable; others, and pure
/// numbers (`None`), a power of ten where they are very large or small: "gap (10⁻⁶)".
///
/// ```
/// use asperity_plot::{Colouring, DPI, Map};
/// use asperity::Grid;
/// let grid = Grid::square(64, 500e-9)?;
/// let heights = grid.sample(|x, y| 2e-9 * (2e7 * x).cos() * (2e7 * y).cos());
/// let map = Map {
///     title: "Egg box",
///     length_unit: Some("m"),
///     label: "height",
///     unit: Some("m"),
///     ..Map::new(heights.view(), grid, Colouring::Sequential)
/// };
/// map.draw(DPI)?.write(&std::env::temp_dir().join("asperity-egg-box.png"))?;
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Map<'a> {
    /// The values at the nodes, of shape `(Nx, Ny)`.
    pub values: ArrayView2<'a, f64>,
    /// The grid of the nodes.
    pub grid: Grid,
    /// The colours of the values.
    pub colouring: Colouring,
    /// The title; may be empty.
    pub title: &'a str,
    /// A line below the title, such as "6.8 % contact"; may be empty.
    pub caption: &'a str,
    /// The unit of the side lengths.
    pub length_unit: Option<&'a str>,
    /// The quantity, such as "pressure"; may be empty.
    pub label: &'a str,
    /// The unit of the values.
    pub unit: Option<&'a str>,
    /// The values at the ends of the colour bar, as for maps that are to be compared; the values of the field if
    /// `None`. With [`Colouring::Diverging`] each end has its own sign.
    pub limits: Option<(f64, f64)>,
    /// The names of negative and of positive values, such as "tension" and "compression", at colour bars of their own;
    /// the label stands at both if they are empty.
    pub signs: [&'a str; 2],
    /// The name of values that are not finite, as "contact" on a map of what is outside of it; they are grey then.
    pub without: Option<&'a str>,
    /// Nodes, `(ix, iy)`, that a line connects from neighbour to neighbour, across opposite sides too.
    pub path: &'a [(usize, usize)],
    /// A node with a dot.
    pub mark: Option<(usize, usize)>,
}

impl<'a> Map<'a> {
    /// A map of `values` on `grid`, as yet without text or units.
    pub fn new(values: ArrayView2<'a, f64>, grid: Grid, colouring: Colouring) -> Self {
        Self {
            values,
            grid,
            colouring,
            title: "",
            caption: "",
            length_unit: None,
            label: "",
            unit: None,
            limits: None,
            signs: [""; 2],
            without: None,
            path: &[],
            mark: None,
        }
    }

    /// Draws the map on a [`Paper`], or for pixels per inch: [`DPI`](super::DPI), or more.
    ///
    /// # Errors
    /// [`Error::Shape`] if the values are not on the grid, and [`Error::Value`] if the pixels per inch are below 36 or
    /// above 1200, the paper is too narrow, or the limits are not finite and in order.
    pub fn draw(&self, paper: impl Into<Paper>) -> Result<Picture> {
        self.draw_plot(paper.into()).map(|(picture, _)| picture)
    }

    /// The picture, and where in it the map or curve is.
    pub(super) fn draw_plot(&self, paper: Paper) -> Result<(Picture, Area)> {
        Error::shape("field to draw", self.values.dim(), self.grid.shape())?;
        if let Some((_, value)) = self.limits.filter(|(low, high)| !(low < high && drawable(*low) && drawable(*high))) {
            let (name, requirement) = ("upper limit of the colours", "finite and above the lower limit");
            return Err(Error::Value { name, value, requirement });
        }
        let mut colours = Colours::new(self.values, self.colouring, self.limits);
        if self.without.is_some() {
            colours.missing = GREY;
        }
        let (x, y, bars, Sides { left, width, right, height }) = self.framed(&colours, &paper)?;
        let bars_height = bars.iter().map(|bar| bar.place.1).fold(0.0, f64::max);
        let beyond = if self.is_line() { None } else { colours.load_beyond(self.signs, self.unit) };
        let caption: Vec<_> =
            [self.caption].into_iter().chain(beyond.as_deref()).filter(|text| !text.is_empty()).collect();
        let caption = caption.join("; ");
        let texts = Texts::new([self.title, &caption], self.legend(), paper.width.map(|_| width + right - MARGIN));
        let plot = Area::new(left, texts.above(), width, height);
        let bottom = plot.top + height.max(bars_height - NUMBERS - LINE) + NUMBERS + LINE + MARGIN;
        let across = (width + right).max(texts.widest() + MARGIN);
        let mut picture = Picture::new(self.title, ((left + across).ceil(), bottom + texts.below(across)), paper.dpi)?;
        if y.is_some() && self.is_line() {
            self.draw_curve(&mut picture, plot, &colours);
        } else {
            let image = self.image(plot, &colours, paper.dpi);
            picture.shapes.push(Shape::Image(image));
            self.draw_path(&mut picture, plot);
        }
        picture.outline(plot);
        draw_axis_below(&mut picture, &x, plot);
        if let Some(y) = y {
            draw_axis_beside(&mut picture, &y, plot, -1.0, room(&y));
        }
        for bar in bars {
            let bars_room = right - GAP - BAR - MARGIN;
            bar.draw(&mut picture, (plot.right() + GAP, plot.top), bars_room, &colours);
        }
        texts.draw(&mut picture, left, bottom, across);
        picture.key = self.key(&colours);
        picture.beyond = beyond;
        Ok((picture, plot))
    }

    /// The colours with their values: of contact as in the legend, of clusters all, else evenly along each colour bar.
    fn key(&self, colours: &Colours) -> Vec<(Colour, String)> {
        let classes = self.legend().into_iter().map(|entry| (entry.colour, entry.text));
        match self.colouring {
            Colouring::Contact => return classes.collect(),
            Colouring::Clusters => {
                // each colour once
                let most = self.values.iter().copied().filter(|label| *label < 10.0).fold(0.0, f64::max) as usize;
                let of = |label| (cluster_colour(label), if label == 0 { "apart" } else { "contact" }.to_owned());
                return (0..=most).map(of).chain(classes).collect();
            }
            _ => {}
        }
        let along = |(low, high): (f64, f64)| {
            let value = move |k: usize| low + (high - low) * k as f64 / SHADES as f64;
            (0..=SHADES).map(move |k| (colours.colour(value(k)), three_digits(value(k), self.unit)))
        };
        colours.ranges().into_iter().flat_map(along).chain(classes).collect()
    }

    fn is_line(&self) -> bool {
        let (nx, ny) = self.grid.shape();
        nx == 1 || ny == 1
    }

    /// The width and height of the map or curve.
    fn size(&self) -> (f64, f64) {
        match (self.is_line(), self.colouring.is_of_classes()) {
            (true, true) => (360.0, 30.0),
            (true, _) => (360.0, label_length(self.label).max(180.0)),
            _ => {
                let (width, height) = map_size(self.grid.shape(), self.grid.lengths());
                (f64::from(width) / PIXELS, f64::from(height) / PIXELS)
            }
        }
    }

    /// Axes and colour bars, and the sides that these leave to the map on a paper.
    fn framed(&self, colours: &Colours, paper: &Paper) -> Result<(Axis, Option<Axis>, Vec<Bar>, Sides)> {
        let (mut width, mut height) = self.size();
        // numbers at the sides depend on the height, and it on their widths
        for _ in 0..FITS {
            let (_, y, bars) = self.axes(colours, width, height);
            let (left, right) = measure_rooms(y.as_ref(), &bars);
            let found = paper.across(left + right, width)?;
            height *= if self.is_line() { 1.0 } else { found / width };
            width = found;
        }
        let (x, y, bars) = self.axes(colours, width, height);
        let (left, right) = measure_rooms(y.as_ref(), &bars);
        let width = paper.across(left + right, width)?;
        Ok((x, y, bars, Sides { left, width, right, height }))
    }

    /// The axis below, the one at the left, and the colour bars.
    fn axes(&self, colours: &Colours, width: f64, height: f64) -> (Axis, Option<Axis>, Vec<Bar>) {
        let (lx, ly) = self.grid.lengths();
        let (steps_below, steps_beside) = ((width / STEP_BELOW) as i32, (height / STEP_BESIDE) as i32);
        let across = |length: f64, longest: f64, name: &str| {
            Axis::new(&Part::side(length, longest, self.length_unit), name, steps_below)
        };
        let classes = self.colouring.is_of_classes();
        if self.is_line() {
            let (length, name) = if self.grid.is_line() { (lx, "x") } else { (ly, "y") };
            let (low, high) = colours.range_of_curve();
            let values = Axis::new(&Part::new(low, high, self.unit), self.label, steps_beside);
            return (across(length, length, name), (!classes).then_some(values), Vec::new());
        }
        let y = Axis::new(&Part::side(ly, lx.max(ly), self.length_unit), "y", steps_beside);
        let bars = if classes { Vec::new() } else { Bar::all(self, colours, height) };
        (across(lx, lx.max(ly), "x"), Some(y), bars)
    }

    fn legend(&self) -> Vec<Entry> {
        let mut legend = Vec::new();
        let mut entry = |colour, text: &str| legend.push(Entry { colour, line: None, text: text.to_owned() });
        if self.colouring == Colouring::Contact {
            entry(BLACK, "contact");
            if self.values.iter().any(|v| *v > 1.0) {
                entry(YIELDED, "yielded");
            }
            if self.values.iter().any(|v| *v < 0.0) {
                entry(ATTRACTIVE, "attractive");
            }
            entry(WHITE, "apart");
        }
        if self.values.iter().any(|v| !drawable(*v)) {
            match self.colouring {
                Colouring::Clusters => entry(GREY, "no surface"),
                Colouring::Contact => entry(MISSING, "no surface"),
                _ => match self.without {
                    Some(name) => entry(GREY, name),
                    None => entry(MISSING, "not finite"),
                },
            }
        }
        legend
    }

    /// A pixel for each node, or where there are more nodes than pixels, the mean of the nodes within.
    fn image(&self, plot: Area, colours: &Colours, dpi: f64) -> Image {
        let (nx, ny) = self.grid.shape();
        // A line along y is drawn along x.
        let (values, nx, ny) = if nx == 1 { (self.values.reversed_axes(), ny, nx) } else { (self.values, nx, ny) };
        let [columns, rows] = [(plot.width, nx), (plot.height, ny)]
            .map(|(side, nodes)| nodes.min((side * dpi / 72.0).round().max(1.0) as usize));
        let nodes = |pixel: usize, pixels: usize, n: usize| {
            let first = pixel * n / pixels;
            first..((pixel + 1) * n / pixels).max(first + 1)
        };
        let mut pixels = Vec::with_capacity(columns * rows);
        for row in (0..rows).rev() {
            let across = nodes(row, rows, ny);
            for column in 0..columns {
                let along = nodes(column, columns, nx);
                let first = values[[along.start, across.start]];
                let is_one = along.len() == 1 && across.len() == 1;
                let cells = along.flat_map(|ix| across.clone().map(move |iy| values[[ix, iy]]));
                pixels.push(if is_one { colours.colour(colours.shown(first)) } else { colours.of_block(cells) });
            }
        }
        Image { area: plot, columns, pixels }
    }

    /// The path from node to node, white on black, and the node with a dot.
    fn draw_path(&self, picture: &mut Picture, plot: Area) {
        let (nx, ny) = self.grid.shape();
        let (width, height) = (plot.width / nx as f64, plot.height / ny as f64);
        let point = |&(i, j): &(usize, usize)| {
            (plot.left + (i as f64 + 0.5) * width, plot.bottom() - (j as f64 + 0.5) * height)
        };
        // where it leaves the map it begins anew at the opposite side
        let meet = |a: &(usize, usize), b: &(usize, usize)| a.0.abs_diff(b.0) <= 1 && a.1.abs_diff(b.1) <= 1;
        let pieces: Vec<Vec<_>> = self.path.chunk_by(meet).map(|piece| piece.iter().map(point).collect()).collect();
        let mark: Vec<Vec<_>> = self.mark.iter().map(|node| vec![point(node)]).collect();
        for (pieces, width) in [(pieces, WIDTH), (mark, 4.0 * WIDTH)] {
            for (width, colour) in [(2.0 * width, BLACK), (width, WHITE)] {
                let curve = Curve { pieces: pieces.clone(), width, colour, within: plot };
                picture.shapes.push(Shape::Curve(curve));
            }
        }
    }

    /// The values on a line as a curve, periodically continued to the frame.
    fn draw_curve(&self, picture: &mut Picture, plot: Area, colours: &Colours) {
        let (low, high) = colours.range_of_curve();
        let values: Vec<f64> = self.values.iter().map(|v| colours.shown(*v)).collect();
        let cell = plot.width / values.len() as f64;
        let above = |v: f64| plot.top + plot.height * (high - v) / (high - low);
        if low < 0.0 && high > 0.0 {
            picture.fill(Area::new(plot.left, above(0.0) - 0.5 * HAIRLINE, plot.width, HAIRLINE), GREY);
        }
        for (i, _) in values.iter().enumerate().filter(|(_, v)| v.is_nan()) {
            picture.fill(Area::new(plot.left + i as f64 * cell, plot.top, cell, plot.height), MISSING);
        }
        let around = values.last().into_iter().chain(&values).chain(values.first());
        let points: Vec<_> =
            around.enumerate().map(|(i, v)| (plot.left + (i as f64 - 0.5) * cell, above(*v))).collect();
        let curve = Curve { pieces: pieces(&points), width: WIDTH, colour: COLOURS[0], within: plot };
        picture.shapes.push(Shape::Curve(curve));
    }
}

/// The pixels of a map at the usual resolution: the longer side has a whole number of pixels for each node, about 600
/// in all, or of nodes for each pixel, at most 1000 pixels.
pub(super) fn map_size((nx, ny): (usize, usize), (lx, ly): (f64, f64)) -> (i32, i32) {
    let aspect = (lx / ly).clamp(0.2, 5.0);
    let (long, short, aspect) = if aspect >= 1.0 { (nx, ny, aspect) } else { (ny, nx, 1.0 / aspect) };
    // Where the nodes are closer along the shorter side, that decides.
    let nodes = (long as f64).max(short as f64 * aspect).round();
    let pixels = if nodes > 1000.0 {
        (nodes / (nodes / 1000.0).ceil()).ceil()
    } else {
        nodes * (600.0 / nodes).round().max(1.0)
    };
    let (pixels, across) = (pixels as i32, (pixels / aspect).round() as i32);
    if lx >= ly { (pixels, across) } else { (across, pixels) }
}
