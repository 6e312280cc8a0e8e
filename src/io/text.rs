use std::io::BufRead;

use ndarray::Array2;

use super::{Parsed, quoted, unreadable};

const NUMBERS: &str = "expected a .npy or .npz file, or rows of numbers with decimal points (comments behind # or %)";

pub(super) fn read_text(mut reader: impl BufRead) -> Parsed<Array2<f64>> {
    let (mut values, mut rows, mut columns) = (Vec::new(), 0, 0);
    let mut line = Vec::new();
    for number in 1.. {
        line.clear();
        if reader.read_until(b'\n', &mut line).map_err(unreadable)? == 0 {
            break;
        }
        // Cut before decoding: instruments write their units in any encoding.
        let end = line.iter().position(|b| b"#%".contains(b)).unwrap_or(line.len());
        let text = String::from_utf8_lossy(&line[..end]);
        let text = text.trim_start_matches('\u{feff}').trim();
        if text.is_empty() {
            continue;
        }
        // One kind of separator per line: with "0,5; 0,7" or "0,5 0,7" the words are not numbers, whereas
        // splitting at all of them would turn decimal commas into twice as many columns.
        let words: Vec<_> = match [';', ','].into_iter().find(|&c| text.contains(c)) {
            Some(c) => text.strip_suffix(c).unwrap_or(text).split(c).map(str::trim).collect(),
            None => text.split_whitespace().collect(),
        };
        for word in &words {
            let value: f64 =
                word.parse().map_err(|_| format!("line {number}: {} is not a number: {NUMBERS}", quoted(word)))?;
            values.push(value);
        }
        if rows == 0 {
            columns = words.len();
        } else if words.len() != columns {
            return Err(format!(
                "line {number} has {} numbers, expected {columns} as in the first row: write nan for missing points",
                words.len()
            ));
        }
        rows += 1;
    }
    if rows == 0 {
        return Err(format!("holds no numbers: {NUMBERS}"));
    }
    Array2::from_shape_vec((rows, columns), values).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use ndarray::array;

    use super::super::tests::{assert_refused, read};

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
        assert_refused(read(b"\x89PNG\r\n\x1a\n\0\0\0"), &["line 1", "not a number"]);
        assert_refused(read([0; 100_000]), &["line 1", "...\" is not a number"]);
        assert_refused(read(b"\xff\xfe1\0 \x002\0"), &["not a number"]);
    }
}
