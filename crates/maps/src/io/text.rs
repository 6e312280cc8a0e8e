//! Height maps in text files: one row of numbers a line, or one point x y z.

use std::io::BufRead;
use std::ops::Range;

use ndarray::{Array2, Axis, Slice};

use super::channels::{Channel, chosen, others};
use super::heading::{Heading, Sizes};
use super::lines::{Line, Row, for_each_line};
use super::units::{in_one_unit, is_length};
use super::xyz::{is_grid, map_of_points};
use super::{Parsed, Reading, Refusal, quoted, refuse, reserve};
use crate::Topography;

/// What is expected where a word is no number.
const NUMBERS: &str = "expected a .npy, .npz, .gwy or .gsf file, or rows of numbers with decimal points (comments \
                       behind # or %)";

/// The fewest points of which a text is known for one of points by its numbers.
const FEWEST_POINTS: usize = 9;

/// A block of rows of numbers, with what is told above it.
struct Block {
    heading: Heading,
    rows: usize,
    columns: usize,
    /// The place of its numbers among all.
    values: Range<usize>,
    /// The numbers of rows of which the first and the last field are empty.
    open: [usize; 2],
    /// Whether nothing but a comment stands before it, which may be one within a map.
    is_remarked: bool,
}

impl Block {
    /// Takes the rows of the next block.
    fn take(&mut self, next: &Self) {
        self.rows += next.rows;
        self.values.end = next.values.end;
        self.open = [0, 1].map(|end| self.open[end] + next.open[end]);
    }
}

/// The blocks of numbers of a text.
#[derive(Default)]
pub(super) struct Text {
    blocks: Vec<Block>,
    values: Vec<f64>,
    /// What is told behind the last row.
    heading: Heading,
    /// Whether a comment is behind the last row.
    is_remarked: bool,
    /// Whether a blank line is behind the last row.
    is_ended: bool,
    /// The fields of empty rows on top, and how many these are.
    empty: (usize, usize),
    /// Whether each row may be one number with a decimal comma.
    is_like_decimals: bool,
}

impl Text {
    pub fn read(reader: impl BufRead, reading: &Reading) -> Parsed<Self> {
        let mut text = Self { is_like_decimals: true, ..Self::default() };
        for_each_line(reader, reading, |number, line| {
            match line {
                Line::Comment(comment) => {
                    text.is_remarked = true;
                    text.heading.read(comment);
                }
                Line::Heading(words, reason) if text.blocks.is_empty() || words.contains([':', '=']) => {
                    text.heading.read_words(number, words, format!("{reason}: {NUMBERS}"))?;
                }
                Line::Heading(_, reason) => return refuse(format!("{reason}: {NUMBERS}")),
                Line::Broken(word, reason) => {
                    let skip = format!(", and if the line is a heading, leave it out by --skip-lines {number}");
                    return refuse(format!(
                        "{reason}: write numbers with decimal points; if it stands for a missing point, say so by asperity \
                         prepare --missing-word {}{}",
                        quoted(word),
                        if text.blocks.is_empty() { &skip } else { "" }
                    ));
                }
                Line::Empty(fields) => text.take_empty(fields)?,
                Line::Row(row) => text.take(number, &row)?,
            }
            Ok(())
        })?;
        if text.blocks.is_empty() {
            text.heading.check_words(false)?;
            return refuse(format!("holds no numbers: {NUMBERS}"));
        }
        let told_last = std::mem::take(&mut text.heading);
        told_last.check_words(false)?;
        if let Some(block) = text.blocks.last_mut() {
            block.heading.append(told_last);
        }
        if text.is_like_decimals && text.values.len() > 2 {
            return refuse(
                "has two whole numbers with a comma between on each line: are these decimal commas? write decimal points, \
                 or tabs between two columns",
            );
        }
        text.join_remarked();
        text.join_single_rows();
        text.drop_open_ends();
        Ok(text)
    }

    /// Takes a line of so many empty fields: a row of missing points, or a blank line.
    fn take_empty(&mut self, fields: usize) -> Parsed<()> {
        match self.blocks.last_mut() {
            Some(block) if fields > 1 && fields == block.columns && !self.is_ended => {
                reserve(&mut self.values, fields)?;
                self.values.extend(std::iter::repeat_n(f64::NAN, fields));
                block.rows += 1;
                block.values.end = self.values.len();
                block.open = block.open.map(|count| count + 1);
            }
            Some(_) => self.is_ended = true,
            None if fields > 1 => {
                let (before, count) = self.empty;
                self.empty = (fields, if before == fields { count + 1 } else { 1 });
            }
            None => {}
        }
        Ok(())
    }

    fn take(&mut self, number: usize, row: &Row<'_>) -> Parsed<()> {
        self.is_like_decimals &= row.is_like_decimal;
        let is_hard = self.blocks.is_empty() || self.is_ended || self.heading.tells();
        let is_remarked = std::mem::take(&mut self.is_remarked) && !is_hard;
        if is_hard || is_remarked && self.blocks.last().is_some_and(|block| block.columns == row.values.len()) {
            let heading = std::mem::take(&mut self.heading);
            let start = self.values.len();
            // empty rows on top of the first one
            let (fields, empty) = std::mem::take(&mut self.empty);
            let rows = if fields == row.values.len() { empty } else { 0 };
            reserve(&mut self.values, rows * fields)?;
            self.values.extend(std::iter::repeat_n(f64::NAN, rows * fields));
            let columns = row.values.len();
            self.blocks.push(Block {
                heading,
                rows,
                columns,
                values: start..self.values.len(),
                open: [rows; 2],
                is_remarked,
            });
            self.is_ended = false;
        }
        let Some(block) = self.blocks.last_mut() else { return Ok(()) };
        block.heading.append(std::mem::take(&mut self.heading));
        let mut values = row.values;
        if values.len() == block.columns + 1 && row.is_open[1] {
            values = &values[..block.columns];
        }
        if values.len() != block.columns {
            let skip = if block.rows == 1 {
                format!(", or leave lines on top out by --skip-lines {}", number - 1)
            } else {
                String::new()
            };
            return refuse(format!(
                "line {number} has {} numbers, expected {} as in the first row: write nan for missing points{skip}",
                values.len(),
                block.columns
            ));
        }
        reserve(&mut self.values, values.len())?;
        self.values.extend_from_slice(values);
        block.rows += 1;
        block.values.end = self.values.len();
        for (count, is_open) in block.open.iter_mut().zip(row.is_open) {
            *count += usize::from(is_open);
        }
        Ok(())
    }

    /// Takes blocks with comments between for one, unless they are of one shape, as channels are.
    fn join_remarked(&mut self) {
        let shape = |block: &Block| (block.rows, block.columns);
        let [first, others @ ..] = &self.blocks[..] else { return };
        if first.rows > 1 && others.iter().all(|block| shape(block) == shape(first)) {
            return;
        }
        self.blocks.dedup_by(|block, before| {
            if block.is_remarked {
                before.take(block);
            }
            block.is_remarked
        });
    }

    /// Takes rows with blank lines between all of them for one block.
    fn join_single_rows(&mut self) {
        let [first, others @ ..] = &mut self.blocks[..] else { return };
        let is_one = first.rows == 1
            && others.iter().all(|block| block.rows == 1 && block.columns == first.columns && !block.heading.tells());
        if is_one {
            others.iter().for_each(|other| first.take(other));
            self.blocks.truncate(1);
        }
    }

    /// Drops the first and the last column where they are empty in all rows, as where separators stand around each.
    fn drop_open_ends(&mut self) {
        let mut end = 0;
        for block in &mut self.blocks {
            let [mut first, mut last] = block.open.map(|count| usize::from(count == block.rows));
            if block.columns <= first + last {
                (first, last) = (0, 0);
            }
            let (start, kept) = (end, block.columns - first - last);
            for row in 0..block.rows {
                let from = block.values.start + row * block.columns + first;
                self.values.copy_within(from..from + kept, end);
                end += kept;
            }
            block.columns = kept;
            block.values = start..end;
        }
        self.values.truncate(end);
    }

    /// What is told of a block, on top of it or of one before.
    fn told_of(&self, place: usize) -> &Heading {
        let mut headings = self.blocks[..=place].iter().rev().map(|block| &block.heading);
        headings.find(|heading| heading.tells()).unwrap_or(&self.blocks[place].heading)
    }

    /// The channels, by their places and titles.
    pub fn channels(&self) -> Parsed<Vec<Channel>> {
        let channel = |(number, block): (usize, &Block)| {
            let mut sizes = self.told_of(number).sizes((block.rows, block.columns))?;
            let vertical = sizes.units[2].take().unwrap_or_default();
            let is_of_heights = vertical.is_empty() || is_length(&vertical);
            let shape = || format!("{} x {} numbers", block.rows, block.columns);
            Ok(Channel { number, title: block.heading.title().unwrap_or_else(shape), is_of_heights })
        };
        self.blocks.iter().enumerate().map(channel).collect()
    }

    /// The channels, if it has several.
    pub fn several(&self) -> Parsed<Vec<Channel>> {
        if self.blocks.len() == 1 || self.is_of_points() { Ok(Vec::new()) } else { self.channels() }
    }

    /// The map of its points, or of one of its blocks.
    pub fn map(self, reading: &Reading) -> Parsed<Topography> {
        if reading.channel.is_none() && self.is_of_points() {
            return self.points();
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
        let told = self.told_of(place);
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
        heading.check_words(is_image)?;
        let Sizes { pixels, sides, units: [.., vertical], factor, missing, unread } = sizes;
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
        let (lengths, lateral) = sides.unzip();
        if let (Some(unit), None) = (lateral.as_ref().filter(|unit| is_length(unit)), &vertical) {
            return refuse(format!(
                "has side lengths in {}, but no unit of the heights: add a line as # z-unit: nm on top",
                quoted(unit)
            ));
        }
        let mut map = in_one_unit(heights, lengths, &lateral.unwrap_or_default(), &vertical.unwrap_or_default())?;
        map.unread = unread;
        Ok(map)
    }

    /// Whether three columns are named x, y and z, or the first two are of a whole grid.
    fn is_of_points(&self) -> bool {
        let has_three = self.blocks.iter().all(|block| block.columns == 3);
        let (points, _) = self.values.as_chunks();
        has_three && (self.blocks[0].heading.has_columns() || points.len() >= FEWEST_POINTS && is_grid(points))
    }

    /// The map of its points.
    pub fn points(mut self) -> Parsed<Topography> {
        let mut heading = Heading::default();
        for block in &mut self.blocks {
            if block.columns != 3 {
                return refuse(format!(
                    "has a row of {} numbers, expected x, y and z: end its name otherwise if it is a matrix",
                    block.columns
                ));
            }
            heading.append(std::mem::take(&mut block.heading));
        }
        heading.check_words(heading.has_columns())?;
        let (points, _) = self.values.as_chunks();
        let (heights, lengths) = map_of_points(points)?;
        let (nx, ny) = heights.dim();
        let Sizes { units: [x, y, z], sides, unread, .. } = heading.sizes((ny, nx))?;
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
mod tests {
    use ndarray::array;

    use super::super::tests::{assert_refused, read, read_map};
    use super::*;

    #[test]
    fn text_separators_comments_and_line_ends() {
        let expected = array![[1.0, -2.5, 3e-6], [4.0, 5.0, 6.0]];
        for text in [
            "1 -2.5 3e-6\n4 5 6\n",
            "1\t-2.5\t3E-6\r\n4\t5\t6\r\n",
            "1\t-2.5\t3E-6\r4\t5\t6",
            "\t1\t-2.5\t3E-6\t\n\t4\t5\t6\t\n",
            "1 -2.5\t3E-6\n4 5\t6\n",
            "  1   -2.5 3e-6  \n\n \t \n4 5 6",
            "1,-2.5,3e-6\n4,5,6\n",
            "1, -2.5, +3e-6,\n4 , 5 , 6,\n",
            "1;-2.5;3e-6\n4; 5; 6;\n",
            "# a, b; c\n% d\n1 -2.5 3e-6 # first\n  # between\n4 5 6 % last\n#",
            "! a\n// b\n; c\n1 -2.5 3e-6 ! first\n4 5 6 // last\n",
            "\u{feff}1 -2.5 3e-6\n4 5 6\n",
            "1.0D0 -2.5d+00 3D-6\n4 5 6\n",
            "\"1\",\"-2.5\",\"3e-6\"\n\"4\",\"5\",\"6\"\n",
            "1 \u{2212}2.5 3e\u{2212}6\n4 5 6\n",
        ] {
            assert_eq!(read(text).unwrap(), expected, "{text:?}");
        }
        assert_eq!(read("1\n2\n3").unwrap(), array![[1.0], [2.0], [3.0]]);
        assert_eq!(read("7").unwrap(), array![[7.0]]);
        let skipped = Reading { skip_lines: 2, ..Reading::default() };
        assert_eq!(
            skipped.read_bytes("a", b"any words\n7 8\n1 2\n3 4\n").unwrap().heights,
            array![[1.0, 2.0], [3.0, 4.0]]
        );
    }

    /// The places of missing points.
    fn missing(text: &str) -> Vec<(usize, usize)> {
        let heights = read(text).unwrap();
        heights.indexed_iter().filter(|(_, h)| h.is_nan()).map(|(node, _)| node).collect()
    }

    #[test]
    fn missing_points_are_words_or_nothing_between_separators() {
        let words = [
            "nan",
            "NaN",
            "-nan(ind)",
            "1.#QNAN",
            "-1.#IND00",
            "#N/A",
            "#NV",
            "#DIV/0!",
            "NA",
            "Bad",
            "null",
            "No Data",
            "--",
        ];
        for word in words {
            assert_eq!(missing(&format!("1,2,{word}\n3,{word},5\n")), [(0, 2), (1, 1)], "{word}");
            assert_eq!(missing(&format!("{word}\t2\t3\n4\t5\t{word}\n")), [(0, 0), (1, 2)], "{word}");
        }
        for (text, places) in [
            ("1,,3\n4,5,6\n", vec![(0, 1)]),
            ("1\t\t3\n4\t5\t6\n", vec![(0, 1)]),
            ("\t2\t3\n4\t5\t6\n", vec![(0, 0)]),
            ("1\t2\t\n4\t5\t6\n", vec![(0, 2)]),
            ("1\t2\t3\n4\t5\t\n", vec![(1, 2)]),
            ("\t\t\n4\t5\t6\n", vec![(0, 0), (0, 1), (0, 2)]),
            ("1;2;3\n;;\n4;5;6\n", vec![(1, 0), (1, 1), (1, 2)]),
            ("1,2,3,\n4,5,,\n", vec![(1, 2)]),
            ("1,2,3\n4,5,6,\n", vec![]),
            (",1,2,3,\n,4,,6,\n", vec![(1, 1)]),
        ] {
            assert_eq!(missing(text), places, "{text:?}");
            assert_eq!(read(text).unwrap().ncols(), 3, "{text:?}");
        }
        let field = read("-inf 1 2\nInf 1 2\n").unwrap();
        assert_eq!((field[[0, 0]], field[[1, 0]]), (f64::NEG_INFINITY, f64::INFINITY));
        let reading = Reading { missing: vec!["lost".into()], ..Reading::default() };
        assert_eq!(reading.read_bytes("a", b"1 lost\n3 4\n").unwrap().missing(), 1);
        assert_refused(read("1 lost\n3 4\n"), &["\"lost\" is not a number"]);
    }

    #[test]
    fn text_that_is_no_matrix_is_refused() {
        assert_refused(read("1 2 3\n# comment\n4 5\n"), &["line 3", "2 numbers", "expected 3", "--skip-lines 2"]);
        assert_refused(read("1\n2 3\n"), &["line 2", "2 numbers", "expected 1"]);
        assert_refused(read("1 2\n3 abc\n"), &["line 2", "\"abc\" is not a number", "rows of numbers"]);
        assert_refused(read("heights of\nx y\n1 2\n"), &["line 1", "\"heights\"", "--skip-lines 2", "put #"]);
        assert_refused(read("1 2\n3 4%\n"), &["line 2", "\"4%\""]);
        assert_refused(read("1,5;2,5\n"), &["\"1,5\" is not a number", "decimal points"]);
        assert_refused(read("1,5 2,5\n"), &["\"5 2\" is not a number", "decimal points"]);
        assert_refused(read("\"1,5\",\"2,5\"\n"), &["\"\\\"1\" is not a number", "decimal points"]);
        assert_refused(read("0,00\n-9,30\n15,92\n"), &["decimal commas?", "tabs"]);
        assert_refused(read("(1+2j) 3\n"), &["\"(1+2j)\""]);
        for empty in ["", "\n\n", "# only a comment\n", "\r\n % \r\n"] {
            assert_refused(read(empty), &["holds no numbers", ".npy"]);
        }
        assert_refused(read("x".repeat(100_000)), &["line 1", "...\" is not a number"]);
        assert_refused(read("words\n".repeat(10_000)), &["line 1", "\"words\" is not a number"]);
    }

    #[test]
    fn blocks_of_numbers_are_channels() {
        let blocks = "1 2\n3 4\n\n5 6\n7 8\n";
        assert_refused(read(blocks), &["2 channels (0 \"2 x 2 numbers\", 1 \"2 x 2 numbers\")", "--channel NUMBER"]);
        assert_refused(read("1 2\n3 4\n\n5 6\n"), &["2 channels (0 \"2 x 2 numbers\", 1 \"1 x 2 numbers\")"]);
        let channel = |text: &str, channel: &str| {
            Reading { channel: Some(channel.into()), ..Reading::default() }.read_bytes("a.txt", text.as_bytes())
        };
        assert_eq!(channel(blocks, "1").unwrap().heights, array![[5.0, 6.0], [7.0, 8.0]]);
        assert_refused(channel(blocks, "2"), &["2 channels (0 \"2 x 2 numbers\"", "none of which"]);
        let titled = |unit: &str| {
            format!(
                "# Channel: A\n# Width: 1 um\n# Height: 1 um\n# Value units: nm\n1 2\n3 4\n\
                 # Channel: B\n# Width: 1 um\n# Height: 1 um\n# Value units: {unit}\n5 6\n7 8\n"
            )
        };
        assert_refused(read(titled("nm")), &["2 channels (0 \"A\", 1 \"B\")", "2 of them of heights"]);
        assert_eq!(channel(&titled("nm"), "B").unwrap().heights, array![[7e-9, 5e-9], [8e-9, 6e-9]]);
        assert_eq!(super::super::channels("a.txt", titled("V").as_bytes()).unwrap()[1].title, "B");
        // the only one of heights needs no name
        let map = read_map(titled("V"), "a.txt").unwrap();
        assert_eq!((map.heights[[0, 1]], &map.unread[..]), (1e-9, &["1 \"B\"".to_owned()][..]));
        // what is told on top holds for all
        let text = "# x-length: 1\n# y-length: 1\n# z-unit: nm\n1 2\n3 4\n\n5 6\n7 8\n";
        assert_eq!(channel(text, "1").unwrap().heights, array![[7e-9, 5e-9], [8e-9, 6e-9]]);
        // as are those of one shape with comments between
        assert_refused(read("# Frame 1\n1 2\n3 4\n# Frame 2\n5 6\n7 8\n"), &["2 channels (0 \"2 x 2 numbers\""]);
        assert_eq!(read("1 2\n3 4\n# two more\n5 6\n# last\n7 8\n9 0\n1 2\n").unwrap().dim(), (6, 2));
        assert_eq!(read("# y = 1\n1 2\n# y = 2\n3 4\n# y = 3\n5 6\n").unwrap().dim(), (3, 2));
        // rows with blank lines between all are one map
        assert_eq!(read("1 2\n\n3 4\n\n5 6\n").unwrap(), array![[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]);
    }

    /// A heading above an image of three by two heights.
    fn headed(heading: &str) -> asperity::Result<Topography> {
        Reading::default().read_bytes("a.txt", format!("{heading}\n1 2 3\n4 5 6\n").as_bytes())
    }

    #[test]
    fn headings_tell_sizes_and_units_in_any_language() {
        let expected =
            headed("# Channel: Height\n# Width: 3.0 \u{b5}m\n# Height: 20 \u{b5}m\n# Value units: nm").unwrap();
        assert_eq!(expected.heights, array![[4e-9, 1e-9], [5e-9, 2e-9], [6e-9, 3e-9]]);
        assert!(expected.heights.is_standard_layout());
        let (lx, ly) = expected.lengths.unwrap();
        assert!((lx - 3e-6).abs() < 1e-20 && (ly - 2e-5).abs() < 1e-20 && expected.unit.as_deref() == Some("m"));
        for heading in [
            "# Kanal: H\n# Breite: 3.0 \u{b5}m\n# H\u{f6}he: 20 \u{b5}m\n# Einheiten: nm",
            "# Canal : H\n# Largeur : 3.0 um\n# Hauteur : 20um\n# Unit\u{e9}s : nm",
            "# \u{901a}\u{9053}\u{ff1a}H\n# \u{5bbd}\u{ff1a}3000 nm\n# \u{9ad8}\u{ff1a}20 \u{3bc}m\n# \u{5355}\u{4f4d}\u{ff1a}nm",
            "# x-pixels = 3\n# y-pixels = 2\n# x-length = 3000\n# y-length = 20000\n# x-offset = 0\n# z-unit = nm",
            "% x-length: 3\n% y-length: 20\n% x-unit: um\n% y-unit: um\n% z-unit: nm",
            "# x-pixels = 3\n# y-pixels = 2\n# x-length = 3000\n# y-length = 20000\n# Bit2nm: 1",
            "NX = 3\nNY = 2\nScale X = 1\nScale Y = 10\nUnit X = um\nUnit Data = nm\nScale Data = 7\nDataScaleNeeded = no",
            "\"X Calibration\",\"1\",\"um\"\n\"Y Calibration\",\"10\",\"um\"\n\"Horizontal\",\"3\"\n\"Vertical\",\"2\"\n\"Unit\",\"nm\"",
            "# Size: 3 um x 20 um\n# pixels: 3 x 2\n# z-unit: nm",
            "# Width (um): 3\n# Height (um): 20\n# z-unit: nm",
            "# dx = 1\n# dy = 10\n# unit = um\n# z unit = nm",
            "X Size\t3\nY Size\t2\nPixel size x: 1 um\nPixel size y: 10 um\nz unit [nm]\nz-unit: [nm]",
        ] {
            let found = headed(heading);
            assert_eq!(found.as_ref().unwrap(), &expected, "{heading}");
        }
        let latin = b"# Kanal: H\n# Breite: 3 \xb5m\n# H\xf6he: 20 \xb5m\n# Einheiten: nm\n1 2 3\n4 5 6\n";
        assert_eq!(Reading::default().read_bytes("a", latin).unwrap(), expected);
        let grid = headed("ncols 3\nnrows 2\ncellsize 0.5\nNODATA_value 5").unwrap();
        assert_eq!((grid.lengths, grid.unit.clone(), grid.missing()), (Some((1.5, 1.0)), None, 1));
        assert!(grid.heights[[1, 0]].is_nan());
        // one number a line
        let map = read_map("# x-pixels: 3\n# y-pixels: 2\n1\n2\n3\n4\n5\n6\n", "a.txt").unwrap();
        assert_eq!(map.heights, array![[4.0, 1.0], [5.0, 2.0], [6.0, 3.0]]);
    }

    #[test]
    fn what_a_heading_tells_and_is_not_understood_is_named() {
        assert_refused(headed("# Width: 3 um\n# Height: 2 um"), &["no unit of the heights", "# z-unit"]);
        for (heading, unread) in [
            ("# Breite: 3,0 um\n# a: 1", "Breite: 3,0 um"),
            ("# Weite: 3 um", "Weite: 3 um"),
            ("# range: 78 nm\n# z-unit: nm", "range: 78 nm"),
            ("# Scale: 5 nm", "Scale: 5 nm"),
            ("# X: 12.5 mm", "X: 12.5 mm"),
            ("# Width: 3 um\n# Value units: nm", "3 um"),
        ] {
            let map = headed(heading).unwrap();
            assert_eq!((map.heights.dim(), map.lengths, &map.unread[..]), ((2, 3), None, &[unread.to_owned()][..]));
        }
        // neither lengths nor units
        for comment in [
            "# rate: 3 Hz",
            "# Created by me: 2020",
            "# heights in micrometres",
            "# y = 3",
            "# Scale: 2",
            "# size: 2 x 3",
        ] {
            let map = headed(comment).unwrap();
            assert_eq!(
                (map.heights.dim(), map.lengths, map.unread.len(), map.unit),
                ((2, 3), None, 0, None),
                "{comment}"
            );
        }
        let gwyddion = |width: &str, height: &str, unit: &str| {
            headed(&format!("# Channel: H\n# Width: {width}\n# Height: {height}\n# Value units: {unit}"))
        };
        assert_eq!(gwyddion("3", "20", "").unwrap().lengths, Some((3.0, 20.0)));
        assert_refused(gwyddion("3,0 um", "20 um", "m"), &["3,0 um", "decimal point"]);
        assert_eq!(gwyddion("-3 um", "20 um", "m").unwrap().unread, ["Width: -3 um", "20 um"]);
        let odd = gwyddion("3 um", "20 V", "m").unwrap();
        assert_eq!((odd.lengths, &odd.unread[..]), (None, &["Height: 20 V".to_owned(), "3 um".to_owned()][..]));
        assert_refused(gwyddion("3 um", "20 um", "V"), &["\"V\"", "channel of heights"]);
        assert_refused(headed("# x-pixels: 4\n# y-pixels: 2"), &["4 x 2 points", "2 lines of 3 numbers"]);
    }

    /// Reads texts that were changed at random, so many, and counts those that are refused.
    fn changed_texts(count: u64) -> u64 {
        let texts = [
            "# Channel: A\n# Width: 3 um\n# Height: 2 um\n# Value units: nm\n1.5\t2\t-3\n4\tnan\t6e-3\n",
            "ncols 3\nnrows 2\ncellsize 0.5\nNODATA_value -9999\n1 2 -9999\n4 5 6\n",
            "\"XY Calibration\",\"1\",\"um\"\n\"Horizontal\",\"3\"\n\"Unit\",\"nm\"\n\n\"1\",\"2\",\"3\"\n,#N/A,-1.#IND\n",
            "# X[um] Y[um] Z[nm]\n0 0 1\n0 1 2\n\n1 0 3\n1 1 4\n",
            "1;2;;\r\n;;;\r\n4;5;6;\r\n\r\n1;2;3 ! end\r\n",
        ];
        let mut state = 1_u64;
        let mut below = |most: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % most
        };
        let mut refused = 0;
        for k in 0..count {
            let mut bytes = texts[k as usize % texts.len()].as_bytes().to_vec();
            for _ in 0..1 + below(6) {
                let (at, other) = (below(bytes.len()), below(bytes.len()));
                let drawn = b"\n\r\t ,;#%:=\"'-.eD0123456789xN/!\xb5\xff\0"[below(33)];
                match below(4) {
                    0 => bytes[at] = drawn,
                    1 => bytes.insert(at, drawn),
                    2 if bytes.len() > 1 => drop(bytes.drain(at..(at + 1 + below(8)).min(bytes.len() - 1).max(at))),
                    _ => bytes = [&bytes[..at], &bytes[other..], b"\n"].concat(),
                }
            }
            for name in ["a.txt", "a.xyz"] {
                match Reading::default().read_bytes(name, &bytes) {
                    Ok(map) => assert!(!map.heights.is_empty() && map.heights.is_standard_layout()),
                    Err(_) => refused += 1,
                }
            }
            let _ = super::super::channels("a.txt", &bytes);
        }
        refused
    }

    #[test]
    fn changed_texts_are_read_or_refused() {
        let refused = changed_texts(2000);
        assert!((1000..3900).contains(&refused), "{refused}");
    }

    #[test]
    #[ignore = "long: cargo test --release -p asperity-tests --test units_of_maps -- --ignored changed"]
    fn many_changed_texts_are_read_or_refused() {
        assert!(changed_texts(100_000) > 25_000);
    }
}
