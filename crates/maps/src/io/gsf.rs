//! Height maps in Gwyddion Simple Field files (`.gsf`).

use std::fs::File;
use std::io::{self, BufRead, BufWriter, Read, Write};
use std::path::Path;

use ndarray::Array2;

use super::units::in_one_unit;
use super::{Parsed, TRUNCATED, quoted, refuse, reserve, unreadable};
use crate::Topography;

pub(super) const GSF: &[u8] = b"Gwyddion Simple Field ";
/// The most bytes of a header; far more than any has.
const LONGEST_HEADER: u64 = 1 << 20;
const MAGIC: &str = "Gwyddion Simple Field 1.0";

/// Reads a Gwyddion Simple Field of `size` bytes: a header of lines `name = value`, 1 to 4 zeros up to a multiple of
/// four bytes, and the heights as little-endian `f32`, row by row from the top.
pub(super) fn read_gsf(reader: &mut impl BufRead, size: u64) -> Parsed<Topography> {
    let mut header = Vec::new();
    reader.by_ref().take(LONGEST_HEADER).read_until(0, &mut header).map_err(unreadable)?;
    if header.pop() != Some(0) {
        return refuse(TRUNCATED);
    }
    let start = header.len() as u64 / 4 * 4 + 4;
    let padding = (start as usize - header.len() - 1).min(3);
    reader.read_exact(&mut [0; 3][..padding]).map_err(unreadable)?;
    let header = String::from_utf8_lossy(&header);
    let (magic, header) = header.split_once('\n').unwrap_or((&header, ""));
    if magic != MAGIC {
        return refuse(format!("starts with {}, expected \"{MAGIC}\": save it again as that", quoted(magic)));
    }
    let value = |name: &str| {
        let mut fields = header.lines().filter_map(|line| line.split_once('='));
        fields.find(|(found, _)| found.trim() == name).map(|(_, value)| value.trim())
    };
    let nodes = |name: &str| match value(name).map(str::parse::<usize>) {
        Some(Ok(n)) if n > 0 => Ok(n),
        _ => {
            refuse(format!("gives {} for {name}, expected a positive whole number", quoted(value(name).unwrap_or(""))))
        }
    };
    let (nx, ny) = (nodes("XRes")?, nodes("YRes")?);
    let bytes = nx.checked_mul(ny).and_then(|n| n.checked_mul(4));
    if bytes.is_none_or(|bytes| bytes as u64 != size.saturating_sub(start)) {
        let found = size.saturating_sub(start);
        return refuse(format!(
            "promises {nx} x {ny} heights but has {found} bytes of data: it is truncated or damaged, save it again"
        ));
    }
    let number = |name: &str| match value(name).map(str::parse::<f64>) {
        None => Ok(None),
        Some(Ok(length)) => Ok(Some(length)),
        Some(Err(_)) => refuse(format!("gives {} for {name}, expected a number", quoted(value(name).unwrap_or("")))),
    };
    let lengths = number("XReal")?.zip(number("YReal")?);

    let mut values = Vec::new();
    reserve(&mut values, nx * ny)?;
    values.resize(nx * ny, 0.0);
    let mut heights = Array2::from_shape_vec((nx, ny), values).map_err(|e| e.to_string())?;
    let mut row = vec![0; 4 * nx];
    for j in (0..ny).rev() {
        reader.read_exact(&mut row).map_err(unreadable)?;
        for (height, bytes) in heights.column_mut(j).iter_mut().zip(row.as_chunks().0) {
            *height = f64::from(f32::from_le_bytes(*bytes));
        }
    }
    in_one_unit(heights, lengths, value("XYUnits").unwrap_or(""), value("ZUnits").unwrap_or(""))
}

/// Writes a map as a Gwyddion Simple Field, rounded to `f32`.
pub(super) fn write_gsf(path: &Path, map: &Topography) -> io::Result<()> {
    let (nx, ny) = map.heights.dim();
    let mut header = format!("{MAGIC}\nXRes = {nx}\nYRes = {ny}\n");
    if let Some((lx, ly)) = map.lengths {
        header.push_str(&format!("XReal = {lx:e}\nYReal = {ly:e}\n"));
    }
    if let Some(unit) = &map.unit {
        // what ends a line or the header has no place in it
        let unit = unit.replace(char::is_control, " ");
        header.push_str(&format!("XYUnits = {unit}\nZUnits = {unit}\n"));
    }
    header.push_str(&"\0".repeat(4 - header.len() % 4));
    let mut file = BufWriter::new(File::create(path)?);
    file.write_all(header.as_bytes())?;
    for j in (0..ny).rev() {
        for height in map.heights.column(j) {
            file.write_all(&(*height as f32).to_le_bytes())?;
        }
    }
    file.into_inner().map_err(io::IntoInnerError::into_error).map(drop)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use ndarray::array;

    use super::super::tests::{assert_refused, read_map};
    use super::super::write_topography;
    use super::*;

    fn gsf(header: &str, data: &[f32]) -> Vec<u8> {
        let mut file = format!("{MAGIC}\n{header}").into_bytes();
        file.resize((file.len() / 4 + 1) * 4, 0);
        file.extend(data.iter().flat_map(|v| v.to_le_bytes()));
        file
    }

    #[test]
    fn gsf_with_every_padding_and_unit() {
        let data = [1.0, 2.0, 3.0, 4.0, f32::NAN, 6.0];
        for title in ["", "a", "ab", "abc", "abcd"] {
            let header =
                format!("  XRes=3\nYRes =  2 \nTitle = {title}\nXReal = 6\nYReal=2e0\nXYUnits=\u{3bc}m\nZUnits= nm\n");
            let map = read_map(gsf(&header, &data), "a.gsf").unwrap();
            assert_eq!((map.heights.dim(), map.missing(), map.unit.as_deref()), ((3, 2), 1, Some("m")));
            // the first row is the upper one
            assert_eq!(map.heights.column(1), array![1e-9, 2e-9, 3e-9]);
            assert_eq!((map.heights[[0, 0]], map.heights[[2, 0]]), (4e-9, 6e-9));
            let (lx, ly) = map.lengths.unwrap();
            assert!((lx - 6e-6).abs() < 1e-20 && (ly - 2e-6).abs() < 1e-20);
        }
        let bare = read_map(gsf("XRes=3\nYRes=2\n", &data), "a").unwrap();
        assert_eq!((bare.lengths, bare.unit, bare.heights[[1, 1]]), (None, None, 2.0));
        let other = read_map(gsf("XRes=6\nYRes=1\nXReal=1\nYReal=1\nXYUnits=px\nZUnits=px", &data), "a").unwrap();
        assert_eq!((other.heights.dim(), other.unit.as_deref()), ((6, 1), Some("px")));
    }

    #[test]
    fn gsf_that_is_no_height_map_is_refused() {
        let data = [0.0; 6];
        for (header, parts) in [
            ("XRes=3\nYRes=3\n", vec!["3 x 3 heights", "24 bytes", "truncated"]),
            ("XRes=4294967296\nYRes=4294967296\n", vec!["truncated"]),
            ("XRes=3\n", vec!["YRes", "positive whole number"]),
            ("XRes=-3\nYRes=2\n", vec!["\"-3\"", "XRes"]),
            ("XRes=3\nYRes=0\n", vec!["\"0\"", "YRes"]),
            ("XRes=3\nYRes=2\nXReal=wide\nYReal=1", vec!["\"wide\"", "XReal"]),
            ("XRes=3\nYRes=2\nXReal=0\nYReal=1", vec!["side lengths of 0 and 1", "positive"]),
            ("XRes=3\nYRes=2\nXReal=1\nYReal=1\nXYUnits=m\nZUnits=V\n", vec!["\"m\"", "\"V\"", "channel of heights"]),
            ("XRes=3\nYRes=2\nZUnits=\x1b[31m\n", vec!["\"\\u{1b}[31m\"", "control characters"]),
            ("XRes=3\nYRes=2\nXReal=1\nYReal=1\nXYUnits=m\n", vec!["\"m\"", "no unit", "both units"]),
        ] {
            assert_refused(read_map(gsf(header, &data), "a"), &parts);
        }
        assert_refused(read_map("Gwyddion Simple Field 2.0\n\0\0\0\0", "a"), &["2.0", "1.0"]);
        assert_refused(read_map("Gwyddion Simple Field 1.0\nXRes=3", "a"), &["ends too early"]);
    }

    #[test]
    fn written_gsf_is_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.GSF");
        let mut map = Topography::new(array![[1.5, -2.0], [f64::NAN, 0.25], [4.0, 5.0]]);
        for (lengths, unit) in [(None, None), (Some((3e-7, 2e-7)), None), (Some((3e-7, 2e-7)), Some("m".to_owned()))] {
            (map.lengths, map.unit) = (lengths, unit);
            write_topography(&path, &map).unwrap();
            let back = super::super::read_topography(&path).unwrap();
            assert_eq!((back.lengths, &back.unit, back.missing()), (map.lengths, &map.unit, 1));
            assert!(back.heights.iter().zip(&map.heights).all(|(a, b)| a == b || a.is_nan() && b.is_nan()));
            assert_eq!(fs::read(&path).unwrap().len() % 4, 0);
        }
        assert_refused(write_topography(folder.path().join("map.tif"), &map), &["ending", ".gsf"]);
        assert_refused(write_topography(folder.path().join("none/map.gsf"), &map), &["cannot be written"]);
        map.heights[[0, 0]] = 1e39;
        assert_refused(write_topography(&path, &map), &["f32", ".npz"]);
    }
}
