//! Height maps in text files: one row of numbers a line, or one point x y z.

use std::io::BufRead;

use ndarray::{Array2, ArrayView2, Axis, Slice};

use super::blocks::{Block, read_blocks};
use super::channels::{Channel, chosen, others};
use super::heading::{Heading, Sizes};
use super::units::{in_one_unit, is_length};
use super::xyz::{Gridded, coordinates, map_of_points};
use super::{Parsed, Reading, Refusal, quoted, refuse};
use crate::Topography;

/// The most nodes of a grid for each of the points of such a text.
const MOST_NODES: f64 = 1.1;

/// The blocks of numbers of a text, and the numbers of all.
pub(super) struct Text {
    blocks: Vec<Block>,
    values: Vec<f64>,
}

impl Text {
    pub fn read(reader: impl BufRead, reading: &Reading) -> Parsed<Self> {
        let (mut blocks, mut values) = read_blocks(reader, reading)?;
        let count = blocks[0].columns;
        if let Some(columns) = blocks[0].heading.columns().filter(|_| blocks.iter().all(|block| block.columns == count))
        {
            let places = columns.places(count)?;
            if (count, places) != (3, [0, 1, 2]) {
                values = values.chunks_exact(count).flat_map(|row| places.map(|place| row[place])).collect();
            }
            for block in &mut blocks {
                (block.columns, block.values) = (3, block.values.start / count * 3..block.values.end / count * 3);
            }
        }
        Ok(Self { blocks, values })
    }

    /// The heading of a block, on top of the block or of a block before.
    fn heading_of(&self, place: usize) -> &Heading {
        let mut headings = self.blocks[..=place].iter().rev().map(|block| &block.heading);
        headings.find(|heading| heading.tells()).unwrap_or(&self.blocks[place].heading)
    }

    /// The channels, by their places and titles.
    pub fn channels(&self) -> Parsed<Vec<Channel>> {
        let channel = |(number, block): (usize, &Block)| {
            let mut sizes = self.heading_of(number).sizes((block.rows, block.columns))?;
            let vertical = sizes.units[2].take().unwrap_or_default();
            let is_of_heights = vertical.is_empty() || is_length(&vertical);
            let shape = || format!("{} x {} numbers", block.rows, block.columns);
            Ok(Channel { number, title: block.heading.title().unwrap_or_else(shape), is_of_heights })
        };
        self.blocks.iter().enumerate().map(channel).collect()
    }

    /// The channels, if it has several.
    pub fn several(&self) -> Parsed<Vec<Channel>> {
        if self.blocks.len() == 1 || self.gridded().is_some() { Ok(Vec::new()) } else { self.channels() }
    }

    /// The map of its points, or of one of its blocks.
    pub fn map(self, reading: &Reading) -> Parsed<Topography> {
        if let (None, Some(gridded)) = (&reading.channel, self.gridded()) {
            return self.map_of_grid(gridded);
        }
        let channels = self.channels()?;
        let place = chosen(&channels, reading.channel.as_deref()).map_err(|refusal| match refusal {
            Refusal::Reason(why) if reading.channel.is_none() => {
                format!("{why}, or take out the lines between if they are one map").into()
            }
            refusal => refusal,
        })?;
        let mut map = self.map_of(place)?;
        map.unread.extend(others(&channels, place));
        Ok(map)
    }

    fn map_of(mut self, place: usize) -> Parsed<Topography> {
        let &Block { mut rows, mut columns, ref values, ref heading, .. } = &self.blocks[place];
        let told = self.heading_of(place);
        let mut sizes = told.sizes((rows, columns))?;
        // one number a line
        if let [Some(nx), Some(ny)] = sizes.pixels
            && columns == 1
            && nx.checked_mul(ny) == Some(rows)
        {
            (rows, columns) = (ny, nx);
            sizes = told.sizes((rows, columns))?;
        }
        let is_image = sizes.is_image();
        // one column may be named, with its unit
        heading.check_words(is_image || columns == 1 && sizes.said.is_some())?;
        let Sizes { pixels, sides, units: [.., vertical], said, factor, missing, unread } = sizes;
        if let [Some(nx), Some(ny)] = pixels
            && (nx, ny) != (columns, rows)
        {
            return refuse(format!(
                "is said to have {nx} x {ny} points, but has {rows} lines of {columns} numbers: it is damaged, or save it \
                 with one line of the image on each"
            ));
        }
        self.values.truncate(values.end);
        self.values.drain(..values.start);
        let mut heights = Array2::from_shape_vec((rows, columns), self.values).map_err(|e| e.to_string())?;
        if factor.is_some() || missing.is_some() {
            let factor = factor.unwrap_or(1.0);
            heights.mapv_inplace(|h| if missing == Some(h) { f64::NAN } else { factor * h });
        }
        if is_image {
            // from the top to the bottom
            let upright = heights.slice_axis(Axis(0), Slice::new(0, None, -1)).reversed_axes();
            heights = upright.as_standard_layout().into_owned();
        }
        let (lengths, mut lateral) = sides.unzip();
        let (unit, is_of_all) = said.unzip();
        // heights next to sides are brought to one unit, and stay as they are alone
        let is_alone = lengths.is_none() && vertical.is_none();
        let vertical = vertical.or(unit.filter(|_| !is_alone).map(str::to_owned));
        if is_of_all == Some(true) && lateral.as_deref() == Some("") {
            lateral.clone_from(&vertical);
        }
        if let (Some(unit), None) = (lateral.as_ref().filter(|unit| is_length(unit)), &vertical) {
            return refuse(format!(
                "has side lengths in {}, but no unit of the heights: add a line as # z-unit: nm on top",
                quoted(unit)
            ));
        }
        let mut map = in_one_unit(heights, lengths, &lateral.unwrap_or_default(), &vertical.unwrap_or_default())?;
        map.unit = map.unit.or(unit.filter(|_| is_alone).map(str::to_owned));
        map.unread = unread;
        Ok(map)
    }

    /// The grid of its points, if columns are named x, y and z, or two columns are all nodes of several lines.
    fn gridded(&self) -> Option<Parsed<Gridded>> {
        let columns = self.blocks[0].columns.max(1);
        if self.blocks.iter().any(|block| block.columns != columns) {
            return None;
        }
        let points = || map_of_points(self.values.as_chunks().0);
        if self.blocks[0].heading.columns().is_some() {
            return Some(points());
        }
        let rows = ArrayView2::from_shape((self.values.len() / columns, columns), &self.values).ok()?;
        match coordinates(rows, MOST_NODES)? {
            [0, 1] if columns == 3 => Some(points()),
            [first, second] => Some(refuse(format!(
                "has the coordinates of a grid in columns {} and {} of {columns}: name the columns on top, as # x y z",
                first + 1,
                second + 1
            ))),
        }
    }

    /// The map of its points.
    pub fn points(self) -> Parsed<Topography> {
        if let Some(block) = self.blocks.iter().find(|block| block.columns != 3) {
            return refuse(format!(
                "has a row of {} numbers, expected x, y and z: end its name otherwise if it is a matrix",
                block.columns
            ));
        }
        let gridded = map_of_points(self.values.as_chunks().0);
        self.map_of_grid(gridded)
    }

    fn map_of_grid(mut self, gridded: Parsed<Gridded>) -> Parsed<Topography> {
        let mut heading = Heading::default();
        self.blocks.iter_mut().for_each(|block| heading.append(std::mem::take(&mut block.heading)));
        heading.check_words(heading.columns().is_some())?;
        let (heights, lengths) = gridded?;
        let (nx, ny) = heights.dim();
        let Sizes { units: [x, y, z], said, sides, unread, .. } = heading.sizes((ny, nx))?;
        let all = said.filter(|(_, is_of_all)| *is_of_all);
        let or_said = |unit: Option<String>, said: Option<(&str, bool)>| unit.or(said.map(|(unit, _)| unit.to_owned()));
        let [x, y, z] = [or_said(x, all), or_said(y, all), or_said(z, said)];
        let [x, y, z] = [x, y, z].map(Option::unwrap_or_default);
        if x != y {
            return refuse(format!("has x in {} and y in {}, expected one unit", quoted(&x), quoted(&y)));
        }
        // coordinates may be numbers of pixels
        let pixels = sides.filter(|_| lengths == (nx as f64, ny as f64));
        let (lengths, lateral) = pixels.unwrap_or((lengths, x));
        let mut map = in_one_unit(heights, Some(lengths), &lateral, &z)?;
        map.unread = unread;
        Ok(map)
    }
}

#[cfg(test)]
mod tests;
