//! The lines of a text: comments, headings, and rows of numbers.

use std::borrow::Cow;
use std::io::BufRead;

use super::{Parsed, Reading, quoted, reserve, unreadable};

/// Words for missing points, in small letters, besides nan and [`is_error_value`].
const MISSING: &str = "|na|n/a|n.a.|bad|null|none|nil|void|invalid|missing|no data|nodata|no_data|undefined|-|--|---|";

/// A line of a text.
pub(super) enum Line<'a> {
    /// Nothing, or fields without anything in them, so many.
    Empty(usize),
    /// A comment, without its mark.
    Comment(&'a str),
    /// A row with a word among its numbers, and why the word is no number.
    Broken(&'a str, String),
    /// Words, and why they are no row.
    Heading(&'a str, String),
    /// A row.
    Row(Row<'a>),
}

/// A row of numbers.
pub(super) struct Row<'a> {
    /// The numbers, NaN for missing points.
    pub values: &'a [f64],
    /// Whether the first and the last field are empty.
    pub is_open: [bool; 2],
    /// Its text.
    pub text: &'a str,
}

/// Hands on the lines of a text behind those that are skipped, each with its number.
pub(super) fn for_each_line(
    mut reader: impl BufRead,
    reading: &Reading,
    mut take: impl FnMut(usize, Line<'_>) -> Parsed<()>,
) -> Parsed<()> {
    let (mut line, mut values) = (Vec::new(), Vec::new());
    for number in 1.. {
        line.clear();
        if !read_line(&mut reader, &mut line)? {
            break;
        }
        if number <= reading.skip_lines {
            continue;
        }
        let bytes = line.strip_prefix("\u{feff}".as_bytes()).unwrap_or(&line);
        let (row, comment) = bytes.split_at(comment_start(bytes));
        let (row, comment) = (decoded(row), decoded(comment));
        let row = row.trim_matches(' ');
        let found = if row.trim().is_empty() && !comment.is_empty() {
            Line::Comment(comment.trim_start_matches(['#', '%', '!', '/', ';']).trim())
        } else if row.trim_matches(['\t', ',', ';', ' ']).is_empty() {
            Line::Empty(if row.trim_matches(' ').is_empty() { 0 } else { fields(row).count() })
        } else {
            match numbers(row, reading, &mut values)? {
                Ok(is_open) => Line::Row(Row { values: &values, is_open, text: row }),
                Err(word) => {
                    let reason = format!("line {number}: {} is not a number", quoted(word));
                    let is_number = |field: &&str| number_of(field, reading).is_some();
                    if 2 * fields(row).filter(is_number).count() > fields(row).count() {
                        Line::Broken(word, reason)
                    } else {
                        Line::Heading(row, reason)
                    }
                }
            }
        };
        take(number, found)?;
    }
    Ok(())
}

/// Takes the numbers of a row, and tells whether its first and its last field are empty; or the word that is no number.
fn numbers<'a>(row: &'a str, reading: &Reading, values: &mut Vec<f64>) -> Parsed<Result<[bool; 2], &'a str>> {
    values.clear();
    let (mut first, mut last) = (None, "");
    for field in fields(row) {
        reserve(values, 1)?;
        let Some(value) = number_of(field, reading) else { return Ok(Err(field)) };
        values.push(value);
        first = first.or(Some(field));
        last = field;
    }
    Ok(Ok([first == Some(""), last.is_empty()]))
}

/// The fields of a row: between semicolons, or commas, or tabs, or blanks. With one kind of separator a line "0,5; 0,7"
/// or "0,5 0,7" has words that are no numbers, whereas splitting at all of them would turn decimal commas into twice as
/// many columns.
fn fields(row: &str) -> Fields<'_> {
    // blanks within the fields of a row with tabs separate numbers
    let is_between =
        |c: char| c != '\t' || !row.contains(' ') || !row.split('\t').any(|field| has_numbers(field.trim()));
    match [';', ',', '\t'].into_iter().find(|c| row.contains(*c)).filter(|c| is_between(*c)) {
        Some(separator) => Fields::Between(row.split(separator)),
        None => Fields::Words(row.split_whitespace()),
    }
}

/// Whether a text is of several numbers, with blanks between.
fn has_numbers(text: &str) -> bool {
    text.contains(' ') && text.split(' ').all(|word| word.is_empty() || word.parse::<f64>().is_ok())
}

enum Fields<'a> {
    Between(std::str::Split<'a, char>),
    Words(std::str::SplitWhitespace<'a>),
}

impl<'a> Iterator for Fields<'a> {
    type Item = &'a str;
    fn next(&mut self) -> Option<&'a str> {
        match self {
            Self::Between(fields) => fields.next().map(str::trim),
            Self::Words(words) => words.next(),
        }
    }
}

/// A number, NaN for a missing point.
fn number_of(field: &str, reading: &Reading) -> Option<f64> {
    if let Ok(value) = field.parse() {
        return Some(value);
    }
    let word = unquoted(field);
    if word.is_empty() || is_missing(word) || reading.missing.iter().any(|other| other == word) {
        return Some(f64::NAN);
    }
    // of Fortran, and of typeset tables
    word.replace(['D', 'd'], "e").replace('\u{2212}', "-").parse().ok()
}

/// A field without the quotes around it.
fn unquoted(field: &str) -> &str {
    let field = field.trim();
    let within = |quote| field.strip_prefix(quote)?.strip_suffix(quote);
    within('"').or_else(|| within('\'')).unwrap_or(field).trim()
}

/// Whether a word stands for a missing point: one of [`MISSING`], of a spreadsheet, or of the libraries of C, as -nan(ind)
/// and 1.#QNAN.
fn is_missing(word: &str) -> bool {
    let small = word.to_lowercase();
    let of_c = small.trim_start_matches(['-', '+']);
    MISSING.contains(&format!("|{small}|"))
        || of_c.starts_with("nan(")
        || of_c.starts_with("1.#")
        || is_error_value(word)
}

/// Whether a word is what spreadsheets print for an error, as #N/A, #VALUE! or #NV, in any language.
fn is_error_value(word: &str) -> bool {
    let Some(name) = word.strip_prefix('#') else { return false };
    let is_name = |c: char| c.is_uppercase() || c.is_ascii_digit() || "/!? \u{a1}\u{bf}".contains(c);
    let is_marked = name.contains('/') || name.ends_with(['!', '?']) || ["NV", "NA", "NAN"].contains(&name);
    is_marked && name.chars().all(is_name)
}

/// Where the comment of a line begins: at # or %, ! or //, at its start or behind a blank; or at a semicolon at its start
/// that separates nothing.
fn comment_start(line: &[u8]) -> usize {
    let is_blank = |at: usize| line[..at].last().is_none_or(|byte| b" \t".contains(byte));
    for (at, byte) in line.iter().enumerate() {
        let is_mark = match byte {
            b'#' | b'%' | b'!' => is_blank(at),
            b'/' => is_blank(at) && line.get(at + 1) == Some(&b'/'),
            _ => false,
        };
        let word = || line[at..].split(|byte| b" \t,;".contains(byte)).next().unwrap_or_default();
        if is_mark && !is_error_value(&decoded(word())) {
            return at;
        }
    }
    let separates = |byte: &&u8| b";\t".contains(byte);
    if line.first() == Some(&b';') && !line[1..].iter().any(|byte| separates(&byte)) { 0 } else { line.len() }
}

/// A text in UTF-8, or else in Latin-1.
fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect::<String>().into(),
    }
}

/// Reads on to the end of a line, or of the file; false at its end. A line ends with LF, CR or both.
fn read_line(reader: &mut impl BufRead, line: &mut Vec<u8>) -> Parsed<bool> {
    let mut is_there = false;
    loop {
        let bytes = reader.fill_buf().map_err(unreadable)?;
        if bytes.is_empty() {
            return Ok(is_there);
        }
        is_there = true;
        let end = bytes.iter().position(|byte| b"\n\r".contains(byte));
        let ended = end.map(|end| bytes[end]);
        let count = end.unwrap_or(bytes.len());
        reserve(line, count)?;
        line.extend_from_slice(&bytes[..count]);
        reader.consume(count + usize::from(end.is_some()));
        if ended == Some(b'\r') && reader.fill_buf().map_err(unreadable)?.first() == Some(&b'\n') {
            reader.consume(1);
        }
        if ended.is_some() {
            return Ok(true);
        }
    }
}
