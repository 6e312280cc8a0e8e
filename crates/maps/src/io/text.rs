//! Height maps in text files: one row of numbers a line.

use std::io::BufRead;

use ndarray::Array2;

use super::units::in_one_unit;
use super::{Parsed, quoted, refuse, reserve, unreadable};
use crate::Topography;

pub(super) const NUMBERS: &str =
    "expected a .npy, .npz, .gwy or .gsf file, or rows of numbers with decimal points (comments behind # or %)";

/// Reads a matrix, one row of nodes along y per line; with the header of Gwyddion's text export, one row along x, from
/// the top, and side lengths and units.
pub(super) fn read_text(reader: impl BufRead) -> Parsed<Topography> {
    let (mut values, mut rows, mut columns) = (Vec::new(), 0, 0);
    let mut header = Header::default();
    for_each_line(
        reader,
        NUMBERS,
        |comment| header.read(comment),
        |number, row| {
            if rows == 0 {
                columns = row.len();
            } else if row.len() != columns {
                return refuse(format!(
                    "line {number} has {} numbers, expected {columns} as in the first row: write nan for missing points",
                    row.len()
                ));
            }
            reserve(&mut values, row.len())?;
            values.extend_from_slice(row);
            rows += 1;
            Ok(())
        },
    )?;
    let heights = Array2::from_shape_vec((rows, columns), values).map_err(|e| e.to_string())?;
    let Header { width: Some(width), height: Some(height), unit: Some(unit) } = header else {
        return Ok(Topography::new(heights));
    };
    // from the top to the bottom
    let upright = heights.slice_axis(ndarray::Axis(0), ndarray::Slice::new(0, None, -1)).reversed_axes();
    let ((lx, lateral), (ly, other)) = (length(&width)?, length(&height)?);
    if lateral != other {
        return refuse(format!(
            "has a width of {} and a height of {}, expected one unit",
            quoted(&width),
            quoted(&height)
        ));
    }
    in_one_unit(upright.as_standard_layout().into_owned(), Some((lx, ly)), lateral, &unit)
}

/// The header of Gwyddion's text export, in its comments.
#[derive(Default)]
struct Header {
    width: Option<String>,
    height: Option<String>,
    unit: Option<String>,
}

impl Header {
    fn read(&mut self, comment: &str) {
        let Some((name, value)) = comment.split_once(':') else { return };
        let field = match name.trim() {
            "Width" => &mut self.width,
            "Height" => &mut self.height,
            "Value units" => &mut self.unit,
            _ => return,
        };
        *field = Some(value.trim().to_owned());
    }
}

/// A number and its unit.
fn length(text: &str) -> Parsed<(f64, &str)> {
    let (number, unit) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    let number = number.parse().map_err(|_| {
        format!("has a side length of {}, expected a number with a decimal point and its unit", quoted(text))
    })?;
    Ok((number, unit.trim()))
}

/// Hands on comments, of lines that hold nothing else, and rows of numbers with the number of their line; refuses what
/// is no number, by what is `expected`.
pub(super) fn for_each_line(
    mut reader: impl BufRead,
    expected: &str,
    mut comment: impl FnMut(&str),
    mut row: impl FnMut(usize, &[f64]) -> Parsed<()>,
) -> Parsed<()> {
    let (mut line, mut values, mut rows) = (Vec::new(), Vec::new(), 0);
    for number in 1.. {
        line.clear();
        read_line(&mut reader, &mut line)?;
        if line.is_empty() {
            break;
        }
        // Cut before decoding: instruments write their units in any encoding.
        let end = line.iter().position(|b| b"#%".contains(b)).unwrap_or(line.len());
        let text = String::from_utf8_lossy(&line[..end]);
        let text = text.trim_start_matches('\u{feff}').trim();
        if text.is_empty() {
            if end < line.len() {
                comment(&String::from_utf8_lossy(&line[end + 1..]));
            }
            continue;
        }
        // One kind of separator per line: with "0,5; 0,7" or "0,5 0,7" the words are not numbers, whereas
        // splitting at all of them would turn decimal commas into twice as many columns.
        let separator = [';', ','].into_iter().find(|&c| text.contains(c));
        let text = separator.and_then(|c| text.strip_suffix(c)).unwrap_or(text);
        let mut take = |word: &str| -> Parsed<()> {
            let value: f64 =
                word.parse().map_err(|_| format!("line {number}: {} is not a number: {expected}", quoted(word)))?;
            reserve(&mut values, 1)?;
            values.push(value);
            Ok(())
        };
        match separator {
            Some(c) => text.split(c).map(str::trim).try_for_each(&mut take)?,
            None => text.split_whitespace().try_for_each(&mut take)?,
        }
        row(number, &values)?;
        values.clear();
        rows += 1;
    }
    if rows == 0 { refuse(format!("holds no numbers: {expected}")) } else { Ok(()) }
}

/// Reads on to the end of a line, or of the file.
fn read_line(reader: &mut impl BufRead, line: &mut Vec<u8>) -> Parsed<()> {
    loop {
        let bytes = reader.fill_buf().map_err(unreadable)?;
        let end = bytes.iter().position(|byte| *byte == b'\n');
        let count = end.map_or(bytes.len(), |end| end + 1);
        reserve(line, count)?;
        line.extend_from_slice(&bytes[..count]);
        reader.consume(count);
        if end.is_some() || count == 0 {
            return Ok(());
        }
    }
}

#[cfg(test)]
mod tests {
    use ndarray::array;

    use super::super::tests::{assert_refused, read, read_map};

    #[test]
    fn text_separators_comments_and_line_ends() {
        let expected = array![[1.0, -2.5, 3e-6], [4.0, 5.0, 6.0]];
        for text in [
            "1 -2.5 3e-6\n4 5 6\n",
            "1\t-2.5\t3E-6\r\n4\t5\t6\r\n",
            "  1   -2.5 3e-6  \n\n \t \n4 5 6",
            "1,-2.5,3e-6\n4,5,6\n",
            "1, -2.5, +3e-6,\n4 , 5 , 6,\n",
            "1;-2.5;3e-6\n4; 5; 6;\n",
            "# a, b; c\n% d\n1 -2.5 3e-6 # first\n  # between\n4 5 6% last\n#",
            "\u{feff}1 -2.5 3e-6\n4 5 6\n",
        ] {
            assert_eq!(read(text).unwrap(), expected, "{text:?}");
        }
        // A unit in Latin-1.
        assert_eq!(read(b"# heights in \xb5m\n1 2\n").unwrap(), array![[1.0, 2.0]]);
        assert_eq!(read("1\n2\n3").unwrap(), array![[1.0], [2.0], [3.0]]);
        assert_eq!(read("7").unwrap(), array![[7.0]]);
    }

    #[test]
    fn text_with_values_that_are_not_finite() {
        let field = read("nan NaN -inf\nInf 1 2\n").unwrap();
        assert!(field[[0, 0]].is_nan() && field[[0, 1]].is_nan());
        assert_eq!((field[[0, 2]], field[[1, 0]]), (f64::NEG_INFINITY, f64::INFINITY));
    }

    #[test]
    fn text_that_is_no_matrix_is_refused() {
        assert_refused(read("1 2 3\n# comment\n4 5\n"), &["line 3", "2 numbers", "expected 3"]);
        assert_refused(read("1\n2 3\n"), &["line 2", "2 numbers", "expected 1"]);
        assert_refused(read("1 2\n3 abc\n"), &["line 2", "\"abc\" is not a number", "rows of numbers"]);
        assert_refused(read("x y\n1 2\n"), &["line 1", "\"x\""]);
        assert_refused(read("1,,3\n"), &["line 1", "\"\" is not a number"]);
        assert_refused(read("1,5;2,5\n"), &["\"1,5\" is not a number", "decimal points"]);
        assert_refused(read("1,5 2,5\n"), &["\"5 2\" is not a number", "decimal points"]);
        assert_refused(read("1,2\r3,4\r"), &["\"2\\r3\" is not a number"]);
        assert_refused(read("(1+2j) 3\n"), &["\"(1+2j)\""]);
        for empty in ["", "\n\n", "# only a comment\n", "\r\n % \r\n"] {
            assert_refused(read(empty), &["holds no numbers", ".npy"]);
        }
        assert_refused(read("x".repeat(100_000)), &["line 1", "...\" is not a number"]);
    }

    #[test]
    fn the_text_export_of_gwyddion() {
        let text = "# Channel: Height\n# Width: 3.0 \u{b5}m\n# Height: 20 \u{b5}m\n# Value units: m\n1 2 3\n4 5 6\n";
        let map = read_map(text, "a.txt").unwrap();
        assert_eq!(map.heights, array![[4.0, 1.0], [5.0, 2.0], [6.0, 3.0]]);
        assert!(map.heights.is_standard_layout());
        let (lx, ly) = map.lengths.unwrap();
        assert!((lx - 3e-6).abs() < 1e-20 && (ly - 2e-5).abs() < 1e-20 && map.unit.as_deref() == Some("m"));
        // with a part of the header only it is a matrix as any other
        let plain = read_map(text.replace("Width", "width"), "a.txt").unwrap();
        assert_eq!((plain.heights.dim(), plain.lengths, plain.unit), ((2, 3), None, None));
        // without units
        let bare = text.replace(" \u{b5}m", "").replace("units: m", "units:");
        assert_eq!(read_map(bare, "a.txt").unwrap().lengths, Some((3.0, 20.0)));
        for (old, new, parts) in [
            ("3.0", "3,0", vec!["\"3,0 \u{b5}m\"", "decimal point"]),
            ("3.0", "-3", vec!["positive"]),
            ("20 \u{b5}m", "20 nm", vec!["one unit"]),
            ("units: m", "units: V", vec!["\"V\"", "channel of heights"]),
        ] {
            assert_refused(read_map(text.replace(old, new), "a.txt"), &parts);
        }
    }
}
