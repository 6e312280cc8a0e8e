//! Formats that are not read, and how to convert them.

/// The way of a format that the package SurfaceTopography reads, by which Python reads it, and another way.
macro_rules! in_python {
    ($or:literal) => {
        concat!("read it in Python by asperity.read, after pip install 'asperity[instruments]'; or ", $or)
    };
}

const INSTRUMENT: &str = in_python!("open it in Gwyddion, and save it as .gwy or its heights as .gsf");
const GWYDDION: &str = "open it in Gwyddion, and save it as .gwy or its heights as .gsf";
const TEXT: &str = "open it in Gwyddion, and save it as .gwy; or export its heights as a text matrix";
const IMAGE: &str = "if its grey values are heights, import it in Gwyddion and save it as .gsf; \
                     else export the heights from the program of the instrument";
const UNPACK: &str = "unpack it first";

/// A format that is not read: the bytes with which its files may begin, its name, and the way to convert it.
type Format = (&'static [&'static [u8]], &'static str, &'static str);

/// The formats that are known by their first bytes.
const STARTS: [Format; 31] = [
    (&[b"GWYO"], "a file of Gwyddion 1 (.gwy)", GWYDDION),
    (&[b"\\*File list", b"?*File list"], "a Nanoscope file (.spm)", INSTRUMENT),
    (&[b"\"\\*File list"], "a text of a Nanoscope file", "open the file itself in Gwyddion, and save it as .gwy"),
    (&[b"Zygo XYZ Data File"], "a file of Zygo's points (.xyz)", TEXT),
    (&[b"Wyko ASCII Data File"], "a text of Wyko (.asc)", TEXT),
    (&[b"\\*Force file list"], "a Nanoscope file of force curves (.spm)", "save a map of heights instead"),
    (&[b"DIGITAL SURF", b"DSCOMPRESSED"], "a Digital Surf file (.sur)", INSTRUMENT),
    (&[b"AliconaImaging\0"], "an Alicona file (.al3d)", INSTRUMENT),
    (&[b"\x01\0Directory"], "a Wyko file (.opd)", INSTRUMENT),
    (&[b"VCA DATA\x01\0"], "a Bruker file (.opdx)", INSTRUMENT),
    (&[b"\x01\xb0\x93\xff"], "an NT-MDT file (.mdt)", INSTRUMENT),
    (&[b"bBCR-", b"bISO-"], "a binary surface data file (.sdf)", INSTRUMENT),
    (&[b"\x88\x1b\x03\x6f", b"\x88\x1b\x03\x70", b"\x88\x1b\x03\x71"], "a MetroPro file (.dat)", INSTRUMENT),
    (&[b"VK4_"], "a Keyence file (.vk4)", INSTRUMENT),
    (&[b"FRTM_"], "a MicroProf file (.frt)", INSTRUMENT),
    (&[b":NANONIS_VERSION:"], "a Nanonis file (.sxm)", GWYDDION),
    (&[b"WSxM file copyright"], "a WSxM file", INSTRUMENT),
    (&[b"DSAA", b"DSBB", b"DSRB"], "a grid of Surfer (.grd)", "save it as an ESRI grid (.asc)"),
    (&[b"IGOR"], "a text of Igor (.itx)", "save its heights as a text matrix"),
    (&[b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"], "a TIFF image (.tif)", TIFF),
    (&[b"\x89PNG\r\n\x1a\n"], "a PNG image", IMAGE),
    (&[b"\xff\xd8\xff"], "a JPEG image", IMAGE),
    (&[b"GIF8"], "a GIF image", IMAGE),
    (&[b"\x89HDF\r\n\x1a\n"], "an HDF5 file", HDF5),
    (&[b"CDF\x01", b"CDF\x02", b"CDF\x05"], "a NetCDF file", NETCDF),
    (&[b"MATLAB 5.0", b"MATLAB 7.3"], "a MATLAB file (.mat)", MATLAB),
    (&[b"\x80\x02", b"\x80\x03", b"\x80\x04", b"\x80\x05"], "a Python pickle", PICKLE),
    (&[b"%PDF-"], "a PDF document", "give the file of the heights"),
    (&[b"\x1f\x8b"], "packed by gzip", UNPACK),
    (&[b"BZh"], "packed by bzip2", UNPACK),
    (&[b"\xff\xfe", b"\xfe\xff"], "a text in UTF-16", "save it in UTF-8"),
];

const TIFF: &str = in_python!(
    "open it in Gwyddion, and save its heights as .gsf: its first page may be a thumbnail, and its numbers counts; \
     tifffile.TiffFile(file) has all pages"
);
const CONTAINER: &str = "in Python: asperity.from_topography(SurfaceTopography.read_container(file)[0][0])";
const HDF5: &str = in_python!("save an array: numpy.save(\"heights.npy\", h5py.File(file)[name][()])");
const NETCDF: &str = in_python!("save an array: numpy.save(\"heights.npy\", xarray.open_dataset(file)[name])");
const MATLAB: &str = in_python!("in MATLAB: writematrix(heights, \"heights.txt\", \"Delimiter\", \" \")");
const PICKLE: &str = "load it in Python, and save its heights by numpy.save";

/// The endings of binary files with starts that tell nothing.
const ENDINGS: [(&str, &str, &str); 4] = [
    ("ibw", "an Igor file (.ibw)", INSTRUMENT),
    ("plu", "a Sensofar file (.plu)", INSTRUMENT),
    ("mnt", "a Mountains document (.mnt)", in_python!("save its heights in Mountains as text")),
    ("mat", "a MATLAB file (.mat)", MATLAB),
];

/// Members of zip archives that are no `.npz`.
const MEMBERS: [(&str, &str, &str); 5] = [
    ("main.xml", "a surface in the format of ISO 25178-72 (.x3p)", INSTRUMENT),
    ("index.xml", "a Sensofar file (.plux)", INSTRUMENT),
    ("header.properties", "a JPK file of force curves (.jpk-force)", "save a map of heights instead"),
    ("meta.yml", "a container of contact.engineering", CONTAINER),
    ("[Content_Types].xml", "a document of an office program", "save the sheet of heights as text, with tabs"),
];

/// Why a file with such a start is not read, if it is of one of the formats.
pub(super) fn by_start(start: &[u8]) -> Option<String> {
    let found = STARTS.iter().find(|(magics, ..)| magics.iter().any(|magic| start.starts_with(magic)));
    found.map(|(_, name, remedy)| format!("is {name}: {remedy}"))
}

/// Why a binary file cannot be read as a text; `ending` belongs to its name.
pub(super) fn by_ending(start: &[u8], ending: &str) -> Option<String> {
    let known = || ENDINGS.iter().find(|(other, ..)| *other == ending);
    let (_, name, remedy) = start.contains(&0).then(|| known().unwrap_or(&("", "a binary file", INSTRUMENT)))?;
    Some(format!("is {name}, of a format that is not read: {remedy}"))
}

/// Why an archive with such members is not read, if it is of one of the formats.
pub(super) fn by_member<'a>(mut names: impl Iterator<Item = &'a str>) -> Option<String> {
    let found = names.find_map(|name| MEMBERS.iter().find(|(member, ..)| *member == name));
    found.map(|(_, name, remedy)| format!("is {name}: {remedy}"))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{assert_refused, read, read_map};
    use super::*;

    #[test]
    fn files_of_instruments_and_programs_are_named_with_a_way_to_convert_them() {
        let noise: Vec<u8> = (0..5000_u32).map(|i| (i * i / 7) as u8).collect();
        for (magics, name, remedy) in STARTS {
            for magic in magics {
                assert_refused(read(magic), &[name, remedy]);
                assert_refused(read([magic, &noise[..]].concat()), &[name, remedy]);
            }
        }
        for (ending, name, remedy) in ENDINGS {
            let path = format!("map.{}", ending.to_uppercase());
            assert_refused(read_map([&b"\x05"[..], &[0; 99]].concat(), &path), &[name, remedy]);
        }
    }

    #[test]
    fn other_binary_files_are_called_so_and_texts_are_not() {
        for name in ["map", "map.xyz", "map.dat"] {
            assert_refused(read_map([0; 100_000], name), &["is a binary file", "Gwyddion"]);
            assert_refused(read_map(b"12\x1b[31mab 4 5\n", name), &["line 1", "\"12\\u{1b}[31mab\" is not a number"]);
        }
        // a text with a strange comment is one all the same, whatever its name is
        assert_eq!(read_map(b"# \x05\0\xff\n1 2\n", "map.ibw").unwrap().heights, ndarray::array![[1.0, 2.0]]);
    }
}
