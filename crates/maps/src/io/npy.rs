//! Height maps in NumPy arrays (`.npy`).

use std::io::{Read, Seek};
use std::ops::Range;

use super::{DAMAGED, LONGEST_UNIT, Parsed, TRUNCATED, check_room, quoted, refuse, reserve, unreadable};
use ndarray::{Array2, Axis, Slice};

pub(super) const NPY: &[u8] = b"\x93NUMPY";
const HEADER: &str = "has a .npy header that cannot be understood: save it again with numpy.save";
/// Numbers converted at a time, so that a file and its array are never both in memory.
const CHUNK: usize = 8192;

/// The width in bytes of a stored value, and how to take one from its bytes in little-endian order.
type Decoder = (usize, fn(&[u8]) -> f64);

/// Reads a `.npy` array that takes `size` bytes, which bounds what its header may make us allocate.
pub(super) fn read_npy(reader: &mut impl Read, size: u64) -> Parsed<Array2<f64>> {
    let Header { shape: (rows, columns), decoder, reversed, fortran } = read_shape(reader, size)?;
    let values = read_values(reader, rows * columns, decoder, reversed)?;
    ended(reader)?;
    if fortran {
        check_room(size_of_val(&values[..]))?;
        let transposed = Array2::from_shape_vec((columns, rows), values).map_err(|e| e.to_string())?;
        Ok(transposed.t().as_standard_layout().into_owned())
    } else {
        Ok(Array2::from_shape_vec((rows, columns), values).map_err(|e| e.to_string())?)
    }
}

/// Reads some rows of a `.npy` array, as [`read_npy`], which `rows` chooses by its shape.
pub(super) fn read_npy_rows<R: Read + Seek>(
    reader: &mut R,
    size: u64,
    rows: impl FnOnce((usize, usize)) -> Range<usize>,
) -> Parsed<(Array2<f64>, (usize, usize))> {
    let Header { shape, decoder, reversed, fortran } = read_shape(reader, size)?;
    let rows = rows(shape);
    if fortran {
        reader.rewind().map_err(unreadable)?;
        let all = read_npy(reader, size)?;
        return Ok((all.slice_axis(Axis(0), Slice::from(rows)).to_owned(), shape));
    }
    let skipped = (rows.start * shape.1 * decoder.0) as u64;
    reader.seek_relative(skipped as i64).map_err(unreadable)?;
    let values = read_values(reader, rows.len() * shape.1, decoder, reversed)?;
    let field = Array2::from_shape_vec((rows.len(), shape.1), values).map_err(|e| e.to_string())?;
    Ok((field, shape))
}

/// The header of an array of numbers, of one dimension or two.
struct Header {
    shape: (usize, usize),
    decoder: Decoder,
    /// whether the bytes of a number are in big-endian order
    reversed: bool,
    /// whether the first index runs fastest
    fortran: bool,
}

fn read_shape(reader: &mut impl Read, size: u64) -> Parsed<Header> {
    let (header, data_size) = read_header(reader, size)?;
    let (dtype, fortran, shape) = parse_header(&header).ok_or(HEADER)?;
    let Some(decoder) = decoder(dtype) else {
        // as [('z', '<f8'), ('q', '<f4')]
        let columns: Vec<_> = dtype.split("('").skip(1).filter_map(|column| column.split('\'').next()).collect();
        if let [first, ..] = columns[..] {
            let names = quoted(&columns.join(", "));
            return refuse(format!(
                "is a record array with the columns {names}: save one, such as array[{}]",
                quoted(first)
            ));
        }
        let dtype = quoted(dtype);
        return refuse(format!(
            "has dtype {dtype}, expected real numbers (f4, f8 or integers): convert with .astype('f8')"
        ));
    };
    let (rows, columns) = match shape[..] {
        [rows] => (rows, 1),
        [rows, columns] => (rows, columns),
        _ => {
            let least = shape.iter().min().copied().unwrap_or_default();
            let one = if shape.first() == Some(&least) { "array[0]" } else { "array[..., 0]" };
            return refuse(format!(
                "has shape {shape:?}, expected two dimensions [Nx, Ny], or one: save one height map, such as {one}"
            ));
        }
    };
    if rows == 0 || columns == 0 {
        return refuse(format!("has shape {shape:?}, expected at least one value: save the heights again"));
    }
    let promised = rows.checked_mul(columns).and_then(|n| n.checked_mul(decoder.0));
    if promised.is_none_or(|bytes| bytes as u64 != data_size) {
        return refuse(format!(
            "has shape {shape:?} of dtype {dtype} but {data_size} bytes of data: \
             it is truncated or damaged, save it again"
        ));
    }
    Ok(Header { shape: (rows, columns), decoder, reversed: dtype.starts_with('>'), fortran })
}

/// Reads a `.npy` text, of no dimension, that takes `size` bytes.
pub(super) fn read_npy_text(reader: &mut impl Read, size: u64) -> Parsed<String> {
    let (header, data_size) = read_header(reader, size)?;
    let (dtype, _, shape) = parse_header(&header).ok_or(HEADER)?;
    let characters = dtype.strip_prefix("<U").and_then(|n| n.parse::<u64>().ok()).filter(|n| *n <= LONGEST_UNIT as u64);
    if !shape.is_empty() || characters.and_then(|n| n.checked_mul(4)) != Some(data_size) {
        return refuse(format!(
            "has a unit or a seed of dtype {}, expected a text: save it as numpy.array(\"m\")",
            quoted(dtype)
        ));
    }
    let mut text = vec![0; data_size as usize];
    reader.read_exact(&mut text).map_err(unreadable)?;
    ended(reader)?;
    let characters = text.as_chunks().0.iter().map(|bytes| char::from_u32(u32::from_le_bytes(*bytes)));
    characters.take_while(|c| *c != Some('\0')).collect::<Option<String>>().ok_or_else(|| DAMAGED.into())
}

/// Reads the dictionary of an array that takes `size` bytes, and finds how many bytes of data follow.
fn read_header(reader: &mut impl Read, size: u64) -> Parsed<(String, u64)> {
    let mut start = [0; 8];
    reader.read_exact(&mut start).map_err(unreadable)?;
    if !start.starts_with(NPY) {
        return refuse("holds something else than a .npy array: save the heights with numpy.save or savez");
    }
    let prefix = match start[6] {
        1 => 2,
        2 | 3 => 4,
        version => {
            return refuse(format!("is .npy of version {version}, expected 1 to 3: save it again with numpy.save"));
        }
    };
    let mut length = [0; 4];
    reader.read_exact(&mut length[..prefix]).map_err(unreadable)?;
    let length = u32::from_le_bytes(length);
    let Some(data_size) = size.checked_sub(8 + prefix as u64 + u64::from(length)) else {
        return refuse(TRUNCATED);
    };
    let mut header = Vec::new();
    reserve(&mut header, length as usize)?;
    header.resize(length as usize, 0);
    reader.read_exact(&mut header).map_err(unreadable)?;
    Ok((String::from_utf8(header).unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned()), data_size))
}

/// Reads `count` values, each with its bytes `reversed` if they are big-endian.
fn read_values(reader: &mut impl Read, count: usize, (width, decode): Decoder, reversed: bool) -> Parsed<Vec<f64>> {
    let mut values = Vec::new();
    reserve(&mut values, count)?;
    let mut buffer = vec![0; CHUNK * width];
    while values.len() < count {
        let chunk = &mut buffer[..(count - values.len()).min(CHUNK) * width];
        reader.read_exact(chunk).map_err(unreadable)?;
        for item in chunk.chunks_exact_mut(width) {
            if reversed {
                item.reverse();
            }
            values.push(decode(item));
        }
    }
    Ok(values)
}

/// Refuses what continues after its last value. A zip entry is checked against its checksum when its end is reached.
fn ended(reader: &mut impl Read) -> Parsed<()> {
    if reader.read(&mut [0]).map_err(unreadable)? == 0 { Ok(()) } else { refuse(DAMAGED) }
}

/// Takes the dtype, whether the order is Fortran's, and the shape from the dictionary in a `.npy` header.
/// The dtype of structured arrays, which are refused, comes as whatever text stands there.
fn parse_header(header: &str) -> Option<(&str, bool, Vec<usize>)> {
    let value = |key: &str| Some(header.split_once(key)?.1.trim_start().strip_prefix(':')?.trim_start());
    let descr = value("'descr'")?;
    let Some((dtype, _)) = descr.strip_prefix('\'').and_then(|d| d.split_once('\'')) else {
        let (dtype, _) = descr.split_once(", 'fortran_order'").unwrap_or((descr, ""));
        return Some((dtype, false, Vec::new()));
    };
    let order = value("'fortran_order'")?;
    let fortran = order.starts_with("True");
    if !fortran && !order.starts_with("False") {
        return None;
    }
    let (shape, _) = value("'shape'")?.strip_prefix('(')?.split_once(')')?;
    // Python 2 wrote `(3L, 4L)`.
    let lengths = shape.split(',').map(|n| n.trim().trim_end_matches('L')).filter(|n| !n.is_empty());
    Some((dtype, fortran, lengths.map(|n| n.parse().ok()).collect::<Option<_>>()?))
}

fn decoder(dtype: &str) -> Option<Decoder> {
    macro_rules! decoder {
        ($type:ty) => {{
            fn decode(bytes: &[u8]) -> f64 {
                let mut value = [0; size_of::<$type>()];
                value.copy_from_slice(bytes);
                <$type>::from_le_bytes(value) as f64
            }
            Some((size_of::<$type>(), decode))
        }};
    }
    match dtype.strip_prefix(['<', '>', '|'])? {
        "f4" => decoder!(f32),
        "f8" => decoder!(f64),
        "i1" => decoder!(i8),
        "i2" => decoder!(i16),
        "i4" => decoder!(i32),
        "i8" => decoder!(i64),
        "u1" => decoder!(u8),
        "u2" => decoder!(u16),
        "u4" => decoder!(u32),
        "u8" => decoder!(u64),
        _ => None,
    }
}

#[cfg(test)]
pub(super) mod tests {
    use ndarray::array;

    use super::super::tests::{assert_refused, read};
    use super::*;

    pub fn npy(dtype: &str, fortran: &str, shape: &str, data: &[u8]) -> Vec<u8> {
        npy_from(&format!("{{'descr': {dtype}, 'fortran_order': {fortran}, 'shape': {shape}, }}"), data)
    }

    fn npy_from(header: &str, data: &[u8]) -> Vec<u8> {
        let header = format!("{header:117}\n");
        let length = u16::try_from(header.len()).unwrap().to_le_bytes();
        [NPY, &[1, 0], &length, header.as_bytes(), data].concat()
    }

    pub fn f8(values: &[f64]) -> Vec<u8> {
        values.iter().flat_map(|v| v.to_le_bytes()).collect()
    }

    #[test]
    fn npy_of_every_dtype() {
        macro_rules! check {
            ($type:ty, $code:expr, $values:expr) => {{
                let values: [$type; 6] = $values;
                let expected = Array2::from_shape_vec((2, 3), values.map(|v| v as f64).to_vec()).unwrap();
                let little: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
                let big: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
                let orders = if size_of::<$type>() == 1 { ["|", "|"] } else { ["<", ">"] };
                for (order, data) in orders.iter().zip([little, big]) {
                    let file = npy(&format!("'{order}{}'", $code), "False", "(2, 3)", &data);
                    assert_eq!(read(file).unwrap(), expected, "{order}{}", $code);
                }
            }};
        }
        check!(f32, "f4", [0.5, -1.25, 3e-30, 4e30, f32::INFINITY, 6.0]);
        check!(f64, "f8", [0.5, -1.25, 3e-300, 4e300, f64::NEG_INFINITY, 6.0]);
        check!(i8, "i1", [i8::MIN, -1, 0, 1, 2, i8::MAX]);
        check!(i16, "i2", [i16::MIN, -1, 0, 1, 2, i16::MAX]);
        check!(i32, "i4", [i32::MIN, -1, 0, 1, 2, i32::MAX]);
        check!(i64, "i8", [i64::MIN, -1, 0, 1, 2, i64::MAX]);
        check!(u8, "u1", [0, 1, 2, 3, 4, u8::MAX]);
        check!(u16, "u2", [0, 1, 2, 3, 4, u16::MAX]);
        check!(u32, "u4", [0, 1, 2, 3, 4, u32::MAX]);
        check!(u64, "u8", [0, 1, 2, 3, 4, u64::MAX]);
    }

    #[test]
    fn npy_orders_and_shapes() {
        let expected = array![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
        let fortran = read(npy("'<f8'", "True", "(2, 3)", &f8(&[1.0, 4.0, 2.0, 5.0, 3.0, 6.0]))).unwrap();
        assert_eq!(fortran, expected);
        assert!(fortran.is_standard_layout());
        for order in ["True", "False"] {
            for shape in ["(3,)", "(3, 1)", "(3L,)"] {
                let line = read(npy("'<f8'", order, shape, &f8(&[1.0, 2.0, 3.0]))).unwrap();
                assert_eq!(line, array![[1.0], [2.0], [3.0]]);
                assert!(line.is_standard_layout() && line.as_slice().is_some());
            }
            let row = read(npy("'<f8'", order, "(1, 3)", &f8(&[1.0, 2.0, 3.0]))).unwrap();
            assert_eq!(row, array![[1.0, 2.0, 3.0]]);
            assert!(row.is_standard_layout() && row.as_slice().is_some());
        }
        assert!(read(npy("'<f8'", "False", "(1, 1)", &f8(&[f64::NAN]))).unwrap()[[0, 0]].is_nan());
        let reordered = "{'shape': (1, 2), 'fortran_order': False, 'descr': '<f8'}";
        assert_eq!(read(npy_from(reordered, &f8(&[1.0, 2.0]))).unwrap(), array![[1.0, 2.0]]);
    }

    #[test]
    fn npy_longer_than_a_chunk() {
        let values: Vec<f64> = (0..3 * CHUNK + 17).map(|i| i as f64).collect();
        let shape = format!("({},)", values.len());
        let field = read(npy("'<f8'", "False", &shape, &f8(&values))).unwrap();
        assert_eq!(field.into_raw_vec_and_offset().0, values);
    }

    #[test]
    fn npy_versions() {
        for version in [2, 3] {
            let header = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }\n";
            let length = (header.len() as u32).to_le_bytes();
            let file = [NPY, &[version, 0], &length, header, &f8(&[7.0])].concat();
            assert_eq!(read(file).unwrap(), array![[7.0]]);
        }
        let mut file = npy("'<f8'", "False", "(1,)", &f8(&[7.0]));
        file[6] = 9;
        assert_refused(read(file), &["version 9", "1 to 3"]);
    }

    #[test]
    fn npy_of_other_dimensions_is_refused() {
        let data = f8(&[0.0; 8]);
        assert_refused(read(npy("'<f8'", "False", "(2, 2, 2)", &data)), &["shape [2, 2, 2]", "two dimensions"]);
        assert_refused(read(npy("'<f8'", "False", "()", &data[..8])), &["shape []", "two dimensions"]);
        assert_refused(read(npy("'<f8'", "False", "(0, 5)", &[])), &["shape [0, 5]", "at least one value"]);
        assert_refused(read(npy("'<f8'", "False", "(0,)", &[])), &["shape [0]", "at least one value"]);
    }

    #[test]
    fn npy_of_other_dtypes_is_refused() {
        for dtype in ["<c8", "<c16", "|b1", "|O", "<f2", "<f16", "<U5", "|S5", "<M8[ns]", "|V8", "f8", "", "é"] {
            let file = npy(&format!("'{dtype}'"), "False", "(2,)", &[0; 16]);
            assert_refused(read(file), &[&format!("dtype \"{dtype}\""), "astype"]);
        }
        let fields = "[('shape', '<f8'), ('y', '<i4')]";
        assert_refused(read(npy(fields, "False", "(1,)", &[0; 12])), &["columns \"shape, y\"", "array[\"shape\"]"]);
    }

    #[test]
    fn npy_of_another_length_than_promised_is_refused() {
        let file = npy("'<f8'", "False", "(2, 2)", &f8(&[1.0, 2.0, 3.0, 4.0]));
        assert!(read(&file).is_ok());
        for length in 0..file.len() {
            assert!(read(&file[..length]).is_err(), "{length}");
        }
        assert_refused(read(&file[..file.len() - 1]), &["shape [2, 2]", "<f8", "31 bytes", "truncated"]);
        assert_refused(read([&file[..], &[0]].concat()), &["33 bytes", "damaged"]);
        // More than memory, more than usize, and more than usize only in bytes.
        for shape in ["(1000000, 1000000)", "(99999999999999999, 99999999999999999)", "(4611686018427387904, 1)"] {
            assert_refused(read(npy("'<f8'", "False", shape, &[0; 64])), &["64 bytes", "truncated"]);
        }
        // A header that claims 4 GB.
        assert_refused(read([NPY, &[2, 0, 255, 255, 255, 255, b'{']].concat()), &["truncated"]);
    }

    #[test]
    fn damaged_npy_header_is_refused() {
        for header in [
            "",
            "garbage",
            "{'descr'}",
            "{'descr': '<f8', 'fortran_order': False}",
            "{'descr': '<f8', 'fortran_order': 1, 'shape': (1,)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (-1,)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999,)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (1,",
            "{'descr': '<f8', 'fortran_order': False, 'shape': 1}",
        ] {
            assert_refused(read(npy_from(header, &[0; 8])), &["header", "numpy.save"]);
        }
        let nested = "(".repeat(60_000);
        assert_refused(read(npy_from(&nested, &[])), &["header"]);
        assert_refused(read(npy_from(&format!("{{'descr': {nested}"), &[])), &["dtype \"((", "...\""]);
        assert_refused(read(npy_from("{'descr': '\n\x1b[31m'", &[])), &["header"]);
        assert_refused(read(npy("'\n\x1b[31m'", "False", "(1,)", &[0; 8])), &["dtype \"\\n\\u{1b}[31m\""]);
    }
}
