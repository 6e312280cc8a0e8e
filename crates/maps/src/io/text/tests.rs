use ndarray::array;

use super::super::tests::{assert_refused, read, read_map};
use super::*;

#[test]
fn blocks_of_numbers_are_channels() {
    let blocks = "1 2\n3 4\n\n5 6\n7 8\n";
    assert_refused(read(blocks), &["2 channels (0 \"2 x 2 numbers\", 1 \"2 x 2 numbers\")", "--channel NUMBER"]);
    assert_refused(read("1 2\n3 4\n\n5 6\n"), &["2 channels (0 \"2 x 2 numbers\", 1 \"1 x 2 numbers\")"]);
    let channel = |text: &str, channel: &str| {
        Reading { channel: Some(channel.into()), ..Reading::default() }.read_bytes("a.txt", text.as_bytes())
    };
    assert_eq!(channel(blocks, "1").unwrap().heights, array![[5.0, 6.0], [7.0, 8.0]]);
    assert_refused(channel(blocks, "2"), &["2 channels (0 \"2 x 2 numbers\"", "but no"]);
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
    // a heading of words may come late
    let long = format!("nx: 1\nny: 1200\n{}", "1\n".repeat(1200)).repeat(2);
    assert_eq!(channel(&long, "1").unwrap().heights.dim(), (1, 1200));
    // a heading on top holds for all
    let text = "# x-length: 1\n# y-length: 1\n# z-unit: nm\n1 2\n3 4\n\n5 6\n7 8\n";
    assert_eq!(channel(text, "1").unwrap().heights, array![[7e-9, 5e-9], [8e-9, 6e-9]]);
    // as are frames of one shape with comments between
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
    let expected = headed("# Channel: Height\n# Width: 3.0 \u{b5}m\n# Height: 20 \u{b5}m\n# Value units: nm").unwrap();
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
    let dos = headed("# Kanal: H\n# Breite: 3 \u{e6}m\n# Hoehe: 20 \u{e6}m\n# Einheiten: nm");
    assert_eq!(dos.unwrap(), expected);
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
fn a_comment_says_the_unit_of_heights_in_words() {
    for comment in [
        "# heights in nm",
        "# z in nm",
        "# Height [nm]",
        "# Heights, nm",
        "% Z (nm)",
        "# z: nm",
        "# AFM of sample 3: heights are in nanometres; scan 20 um",
        "# size 20 um, z values given in nm",
        "# Width 3, z: nm",
        "# All units in nm",
        "# x, y, z in nm",
    ] {
        let map = headed(comment).unwrap();
        // the numbers stay as they are
        assert_eq!((map.unit.as_deref(), map.heights[[0, 1]], map.unread.len()), (Some("nm"), 2.0, 0), "{comment}");
    }
    assert_eq!(headed("# heights in micrometres").unwrap().unit.as_deref(), Some("\u{b5}m"));
    let column = read_map("Height [nm]\n1.5\n2.5\n", "a.csv").unwrap();
    assert_eq!((column.heights.dim(), column.unit.as_deref()), ((2, 1), Some("nm")));
    assert_refused(read("x [um], z [nm]\n0 1\n1 3\n"), &["\"x [um]\" is not a number", "--skip-lines 1"]);
    let sized = headed("# Width: 3 um\n# Height: 20 um\n# heights in nm").unwrap();
    assert_eq!((sized.heights[[0, 0]], sized.unit.as_deref()), (4e-9, Some("m")));
    assert_refused(headed("# dx = 1\n# dy = 1\n# heights in nm"), &["side lengths in no unit and values in \"nm\""]);
    assert_eq!(headed("# dx = 1\n# dy = 1\n# all lengths in nm").unwrap().unit.as_deref(), Some("m"));
    let points = |comment: &str| read_map(format!("{comment}\n0 0 1\n0 1 2\n1 0 3\n1 1 4\n"), "a.xyz");
    assert_eq!(points("# x, y, z in nm").unwrap().lengths, Some((2e-9, 2e-9)));
    assert_refused(points("# z in nm"), &["side lengths in no unit and values in \"nm\""]);
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
        "# scan size 20 um",
        "# Width, size in um",
        "# x data in um",
        "# height range in nm",
        "# force in nN",
        "# y = 3",
        "# Scale: 2",
        "# size: 2 x 3",
    ] {
        let map = headed(comment).unwrap();
        assert_eq!((map.heights.dim(), map.lengths, map.unread.len(), map.unit), ((2, 3), None, 0, None), "{comment}");
    }
    let gwyddion = |width: &str, height: &str, unit: &str| {
        headed(&format!("# Channel: H\n# Width: {width}\n# Height: {height}\n# Value units: {unit}"))
    };
    assert_eq!(gwyddion("3", "20", "").unwrap().lengths, Some((3.0, 20.0)));
    assert_refused(gwyddion("3,0 um", "20 um", "m"), &["3,0 um", "decimal point"]);
    for heading in ["ncols 3\nnrows 2\ncellsize 0,25", "# Bit2nm: 0,5", "# nodata = -9,5", "# size: 2 um x 3,5 um"] {
        assert_refused(headed(heading), &["has the comment", "decimal point"]);
    }
    assert_eq!(headed("# z range: 3,5 nm\n# offset: 2,5").unwrap().lengths, None);
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
