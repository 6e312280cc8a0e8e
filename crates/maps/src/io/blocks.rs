//! Blocks of rows of numbers in texts, with the heading of each.

use std::io::BufRead;
use std::ops::Range;

use super::commas::Commas;
use super::heading::Heading;
use super::lines::{Line, Row, for_each_line};
use super::{Parsed, Reading, quoted, refuse, reserve};

/// What is expected where a word is no number.
const NUMBERS: &str = "expected a .npy, .npz, .gwy or .gsf file, or rows of numbers with decimal points (comments \
                       behind # or %)";

/// Reads the blocks of numbers of a text, one at least, and the numbers of all.
pub(super) fn read_blocks(reader: impl BufRead, reading: &Reading) -> Parsed<(Vec<Block>, Vec<f64>)> {
    Blocks::read(reader, reading).map(|text| (text.blocks, text.values))
}

/// A block of rows of numbers, with its heading.
pub(super) struct Block {
    pub heading: Heading,
    pub rows: usize,
    pub columns: usize,
    /// The place of its numbers among all.
    pub values: Range<usize>,
    /// The numbers of rows with an empty first and an empty last field.
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

/// The blocks of numbers of a text, as they are read.
#[derive(Default)]
struct Blocks {
    blocks: Vec<Block>,
    values: Vec<f64>,
    /// The heading behind the last row.
    heading: Heading,
    /// Whether a comment is behind the last row.
    is_remarked: bool,
    /// Whether a blank line is behind the last row.
    is_ended: bool,
    /// The fields of empty rows on top, and how many these are.
    empty: (usize, usize),
    commas: Commas,
}

impl Blocks {
    fn read(reader: impl BufRead, reading: &Reading) -> Parsed<Self> {
        let mut text = Self::default();
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
        let are_named = text.blocks[0].heading.columns().is_some();
        if text.commas.may_be_decimal() && text.values.len() > 2 && !are_named {
            return refuse(
                "has lines in which each comma may be one within a number: are these decimal commas? write decimal points, or \
                 tabs between the columns",
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
        self.commas.take(row.text);
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

    /// Drops the last column where it is empty in all rows, as behind separators at their ends, and the first is not.
    fn drop_open_ends(&mut self) {
        let mut end = 0;
        for block in &mut self.blocks {
            let [first, last] = block.open.map(|count| count == block.rows);
            let (start, kept) = (end, block.columns - usize::from(last && !first && block.columns > 1));
            for row in 0..block.rows {
                let from = block.values.start + row * block.columns;
                self.values.copy_within(from..from + kept, end);
                end += kept;
            }
            block.columns = kept;
            block.values = start..end;
        }
        self.values.truncate(end);
    }
}

#[cfg(test)]
mod tests {
    use ndarray::array;

    use super::super::tests::{assert_refused, read};
    use super::*;

    #[test]
    fn text_separators_comments_and_line_ends() {
        let expected = array![[1.0, -2.5, 3e-6], [4.0, 5.0, 6.0]];
        for text in [
            "1 -2.5 3e-6\n4 5 6\n",
            "1\t-2.5\t3E-6\r\n4\t5\t6\r\n",
            "1\t-2.5\t3E-6\r4\t5\t6",
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
        ] {
            assert_eq!(missing(text), places, "{text:?}");
            assert_eq!(read(text).unwrap().ncols(), 3, "{text:?}");
        }
        // a first column, and a last one next to it
        assert_eq!(missing("\t1\t2\n\t4\t5\n"), [(0, 0), (1, 0)]);
        assert_eq!(missing(",1,,\n,4,5,\n"), [(0, 0), (0, 2), (0, 3), (1, 0), (1, 3)]);
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
        for lines in [
            "1,5, 2,5\n4,5, -5,5",
            "1,234E-7\n2,345e-07\n-3,456E+7",
            "1.234,5\n-2.345,5\n12,3",
            "1,234.5\n2,345.0\n12,345",
            "1,5\n\u{2212}2,5\n3,25",
            ",5\n1,5",
            "1,5,2,5\n4,5,5,5",
            "1,5,2,5\n4,5,-5,5",
            "1,5,2,5,\n4,5,5,5,",
        ] {
            assert_refused(read(lines), &["decimal commas?"]);
        }
        assert_eq!(read("1,5,2,5\n4,-5,5,5").unwrap().dim(), (2, 4));
        assert_eq!(read("0.5,1\n1.5,2\n").unwrap().dim(), (2, 2));
        assert_eq!(read("1,-5\n2,5\n").unwrap().dim(), (2, 2));
        assert_eq!(read("1,2.5\n2,0.5\n").unwrap().dim(), (2, 2));
        assert_refused(read("(1+2j) 3\n"), &["\"(1+2j)\""]);
        for empty in ["", "\n\n", "# only a comment\n", "\r\n % \r\n"] {
            assert_refused(read(empty), &["holds no numbers", ".npy"]);
        }
        assert_refused(read("x".repeat(100_000)), &["line 1", "...\" is not a number"]);
        assert_refused(read("words\n".repeat(10_000)), &["line 1", "\"words\" is not a number"]);
    }
}
