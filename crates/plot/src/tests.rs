//! Tests of the pictures.

use std::fs::File;
use std::io::BufReader;

use ndarray::Array2;

use super::colours::cluster_colour;
use super::map::map_size;
use super::*;
use asperity::Grid;

/// Writes a map, and reads its width, height and pixels, and the corner and size of the plot.
fn drawn(map: &Map<'_>, name: &str) -> (usize, usize, Vec<[u8; 3]>, [usize; 4]) {
    let path = std::env::temp_dir().join(format!("asperity-{}-{name}.png", std::process::id()));
    let (picture, plot) = map.draw_plot(DPI.into()).unwrap();
    picture.write(&path).unwrap();
    let mut reader = ::png::Decoder::new(BufReader::new(File::open(&path).unwrap())).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (::png::ColorType::Rgb, ::png::BitDepth::Eight));
    std::fs::remove_file(&path).unwrap();
    let plot = [plot.left, plot.top, plot.width, plot.height].map(|side| (2.0 * side).round() as usize);
    let pixels = data.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
    (info.width as usize, info.height as usize, pixels, plot)
}

#[test]
fn x_runs_to_the_right_and_y_upwards_from_neutral_zero() {
    let grid = Grid::new((3, 2), (3.0, 2.0)).unwrap();
    let mut values = Array2::zeros((3, 2));
    values[[2, 0]] = 1e6;
    values[[0, 1]] = -10.0;
    values[[1, 1]] = f64::NAN;
    let map = Map { title: "Signed", unit: Some("Pa"), ..Map::new(values.view(), grid, Colouring::Diverging) };
    let (width, height, pixels, [x, y, w, h]) = drawn(&map, "signed");
    assert_eq!((w, h), (600, 400));
    assert!(width > x + w && height > y + h && pixels.len() == width * height);
    let at = |ix: usize, iy: usize| pixels[(y + h - 1 - (200 * iy + 50)) * width + x + 200 * ix + 50];
    assert_eq!(at(0, 0), [241, 239, 237]);
    assert_eq!([at(1, 0), at(2, 1)], [at(0, 0); 2]);
    assert_eq!(at(2, 0), [103, 0, 31]);
    assert_eq!(at(0, 1), [4, 47, 96]);
    assert_eq!(at(1, 1), [201, 120, 199]);
}

#[test]
fn black_is_the_share_of_contact() {
    for (n, side) in [(60, 600), (250, 500), (1200, 600)] {
        let values = Array2::from_shape_fn((n, n), |(i, j)| f64::from((7 * i + 3 * j) % 10 < 3));
        let map = Map::new(values.view(), Grid::square(n, 1.0).unwrap(), Colouring::Contact);
        let (width, _, pixels, [x, y, w, h]) = drawn(&map, &format!("contact-{n}"));
        assert_eq!((w, h), (side, side));
        let plot = (y..y + h).flat_map(|row| &pixels[row * width + x..row * width + x + w]);
        let share = plot.map(|c| 1.0 - f64::from(c[0]) / 255.0).sum::<f64>() / (w * h) as f64;
        assert!((share - values.mean().unwrap()).abs() < if n > 1000 { 2e-3 } else { 1e-12 }, "{n}: {share}");
    }
}

#[test]
fn pictures_have_sane_sizes() {
    for (shape, lengths, size) in [
        ((256, 256), (1.0, 1.0), (512, 512)),
        ((300, 100), (3.0, 1.0), (600, 200)),
        ((100, 300), (1.0, 3.0), (200, 600)),
        ((1, 1), (1.0, 1.0), (600, 600)),
        ((1000, 1000), (1.0, 1.0), (1000, 1000)),
        ((8192, 8192), (1.0, 1.0), (911, 911)),
        ((4096, 3), (4096.0, 3.0), (820, 164)),
        ((4096, 3), (3.0, 4096.0), (195, 976)),
        ((4, 4), (1e300, 1e-300), (600, 120)),
    ] {
        assert_eq!(map_size(shape, lengths), size, "{shape:?} {lengths:?}");
    }
}

#[test]
fn degenerate_fields_are_drawn() {
    let fields = [0.0, -1e-9, 5e-324, f64::MAX, f64::NAN];
    for (value, first) in fields.into_iter().flat_map(|v| [(v, v), (v, -1e279)]) {
        for shape in [(1, 1), (1, 5), (2, 3)] {
            let mut values = Array2::from_elem(shape, value);
            values[[0, 0]] = first;
            for colouring in [Colouring::Sequential, Colouring::Diverging, Colouring::Contact, Colouring::Clusters] {
                // Flat, for a small picture.
                let map = Map::new(values.view(), Grid::new(shape, (1e300, 1e-300)).unwrap(), colouring);
                let map = Map { label: "µ\n−🦀", unit: Some("m"), length_unit: Some("m"), ..map };
                let Picture { width, height, .. } = map.draw(DPI).unwrap();
                assert!(width < 2000.0 && height < 500.0, "{value} {first} {shape:?}: {width} {height}");
            }
        }
    }
}

#[test]
fn a_curve_goes_through_its_nodes() {
    let values = Array2::from_shape_vec((4, 1), vec![0.0, 1.0, 0.0, f64::NAN]).unwrap();
    let map = Map::new(values.view(), Grid::line(4, 1.0).unwrap(), Colouring::Sequential);
    let (width, _, pixels, [x, y, w, h]) = drawn(&map, "curve");
    let at = |node: usize, value: f64| {
        let row = y as f64 + h as f64 * (1.05 - value) / 1.1;
        pixels[row as usize * width + x + w * (2 * node + 1) / 8]
    };
    assert!([at(0, 0.0), at(1, 1.0), at(2, 0.0)].iter().all(|c| c[0] < 150 && c[2] > c[0] + 40));
    assert_eq!(at(1, 0.5), [255; 3]);
    assert_eq!(at(3, 0.5), [201, 120, 199]);
}

#[test]
fn what_cannot_be_drawn_or_written_is_refused() {
    let values = Array2::zeros((4, 3));
    let map = Map::new(values.view(), Grid::square(4, 1.0).unwrap(), Colouring::Sequential);
    assert!(matches!(map.draw(DPI), Err(Error::Shape { found: (4, 3), .. })));
    let map = Map { grid: Grid::new((4, 3), (1.0, 1.0)).unwrap(), ..map };
    let path = Path::new("/no/such/directory/x.png");
    let picture = map.draw(DPI).unwrap();
    assert!(matches!(picture.write(path), Err(Error::File { path: p, .. }) if p == path));
    assert!(matches!(picture.write(Path::new("x.gif")), Err(Error::File { .. })));
    assert!(matches!(map.draw(5.0), Err(Error::Value { value: 5.0, .. })));
    for limits in [(1.0, 1.0), (2.0, 1.0), (0.0, f64::NAN)] {
        assert!(matches!(Map { limits: Some(limits), ..map.clone() }.draw(DPI), Err(Error::Value { .. })));
    }
}

/// The texts of a picture, in the order in which they are drawn.
fn texts(picture: &Picture) -> Vec<String> {
    let text = |shape: &Shape| if let Shape::Text(text) = shape { Some(text.text.clone()) } else { None };
    picture.shapes.iter().filter_map(text).collect()
}

#[test]
fn tension_and_compression_have_a_scale_and_a_colour_bar_each() {
    let values = Array2::from_shape_fn((40, 40), |(i, _)| if i < 20 { -5e7 } else { 5e9 });
    let map = Map { label: "pressure", unit: Some("Pa"), signs: ["tension", "compression"], ..signed(&values) };
    let found = texts(&map.draw(DPI).unwrap());
    for text in ["tension (MPa)", "compression (GPa)", "−40", "−20", "2", "4"] {
        assert!(found.iter().any(|found| found == text), "{text}: {found:?}");
    }
    // both ends have the full colour
    let (_, _, pixels, [x, y, w, h]) = drawn(&map, "signs");
    let width = pixels.len() / (2.0 * map.draw(DPI).unwrap().height) as usize;
    let middle = |column: usize| pixels[(y + h / 2) * width + column];
    assert_eq!([middle(x + 5), middle(x + w - 5)], [[4, 47, 96], [103, 0, 31]]);
    // without adhesion one bar is enough
    let compressed = values.mapv(|v| v.max(0.0));
    let map = Map { label: "pressure", signs: ["tension", "compression"], ..signed(&compressed) };
    let found = texts(&map.draw(DPI).unwrap());
    assert!(found.contains(&"pressure (10⁹)".to_owned()) && !found.iter().any(|text| text.contains("tension")));
}

/// A map of pressures on a square.
fn signed(values: &Array2<f64>) -> Map<'_> {
    Map::new(values.view(), Grid::square(values.nrows(), 1.0).unwrap(), Colouring::Diverging)
}

#[test]
fn contact_attraction_and_what_is_apart_have_a_colour_each() {
    let values = ndarray::array![[1.0, -1.0], [0.0, f64::NAN]];
    let map = Map::new(values.view(), Grid::square(2, 1.0).unwrap(), Colouring::Contact);
    let (width, _, pixels, [x, y, w, h]) = drawn(&map, "classes");
    let at = |ix: usize, iy: usize| pixels[(y + h - 1 - h * iy / 2 - 10) * width + x + w * ix / 2 + 10];
    let expected = [[0; 3], colours::ATTRACTIVE, [255; 3], colours::MISSING];
    assert_eq!([at(0, 0), at(0, 1), at(1, 0), at(1, 1)], expected);
    let found = texts(&map.draw(DPI).unwrap());
    assert!(["contact", "attractive", "apart", "no surface"].iter().all(|name| found.iter().any(|text| text == name)));
    // mixed where there are more nodes than pixels
    let many = Array2::from_shape_fn((2000, 2000), |(i, _)| if i % 2 == 0 { -1.0 } else { 0.0 });
    let map = Map::new(many.view(), Grid::square(2000, 1.0).unwrap(), Colouring::Contact);
    let (width, _, pixels, [x, y, ..]) = drawn(&map, "mixed");
    assert_eq!(
        pixels[(y + 9) * width + x + 9],
        colours::ATTRACTIVE.map(|part| (255.0 / 2.0 + f64::from(part) / 2.0).round() as u8)
    );
}

#[test]
fn clusters_have_colours_in_turn() {
    let values = ndarray::array![[1.0, 2.0], [0.0, f64::NAN]];
    let map = Map::new(values.view(), Grid::square(2, 1.0).unwrap(), Colouring::Clusters);
    let (width, _, pixels, [x, y, w, h]) = drawn(&map, "clusters");
    let at = |ix: usize, iy: usize| pixels[(y + h - 1 - h * iy / 2 - 10) * width + x + w * ix / 2 + 10];
    assert_eq!([at(0, 0), at(0, 1), at(1, 0), at(1, 1)], [cluster_colour(1), cluster_colour(2), [255; 3], shape::GREY]);
    let picture = map.draw(DPI).unwrap();
    assert!(texts(&picture).iter().any(|text| text == "no surface"));
    let key: Vec<_> = picture.key().iter().map(|(_, told)| told.as_str()).collect();
    assert_eq!(key, ["apart", "contact", "contact", "no surface"]);
}

/// A map with a title that SVG and PDF have to escape, and a chart of a broken curve, each drawn.
fn pictures() -> [Picture; 2] {
    let values = Array2::from_shape_fn((3, 2), |(i, j)| (i + 2 * j) as f64);
    let map = Map {
        title: "Gap < 1 & (µm)",
        label: "gap",
        unit: Some("m"),
        ..Map::new(values.view(), Grid::new((3, 2), (3.0, 2.0)).unwrap(), Colouring::Sequential)
    };
    let points = vec![(1e-3, 1.0), (1e-2, f64::NAN), (1e-1, 10.0), (1.0, 100.0)];
    let jumps = vec![[(1e-3, 1.0), (1e-1, 10.0)], [(1.0, 100.0), (-1.0, 1.0)]];
    let curves = vec![("area", points)];
    let chart = Chart { x_log: true, y_log: true, x_label: "load", curves, jumps, ..Chart::default() };
    [map.draw(DPI).unwrap(), chart.draw(DPI).unwrap()]
}

#[test]
fn svg_has_text_as_text_and_the_map_as_an_image() {
    let [map, chart] = pictures().map(|picture| picture.svg().unwrap());
    assert!(map.contains("<title>Gap &lt; 1 &amp; (µm)</title>") && map.contains(">gap (m)</text>"));
    // the map and its colour bar
    assert_eq!(map.matches("href=\"data:image/png;base64,iVBORw0KGgo").count(), 2);
    assert!(
        [">0.001<", ">0.1<", ">load<", ">area<"].iter().all(|text| chart.contains(text)) && !chart.contains("<image")
    );
    assert!(!map.contains("NaN") && !chart.contains("NaN") && !chart.contains("inf"));
    // the jump from corner to corner, 360 by 240 points, in dashes of 3 points; the other one has no place
    let dashed: Vec<_> = chart.split("<path").filter(|path| path.matches('M').count() > 10).collect();
    assert!(dashed.len() == 1 && (25..75).contains(&dashed[0].matches('M').count()), "{dashed:?}");
}

#[test]
fn a_narrow_chart_has_the_text_of_a_wide_one() {
    let curves = vec![("", (0..40).map(|k| (f64::from(k), 1e6 * f64::from(k * k))).collect())];
    let chart = Chart { x_label: "load", y_label: "area", curves, ..Chart::default() };
    let sizes = |svg: &str| svg.split("font-size=\"").skip(1).map(|text| text[..1].to_owned()).collect::<Vec<_>>();
    for width in [260.0, 420.0] {
        let picture = chart.draw(Paper { dpi: DPI, width: Some(width) }).unwrap();
        assert_eq!(picture.width, width);
        let svg = picture.svg().unwrap();
        assert!(sizes(&svg).len() > 6 && sizes(&svg).iter().all(|size| size == "8" || size == "9"), "{svg}");
    }
}

#[test]
fn pdf_has_its_objects_where_the_table_says() {
    for (picture, images) in pictures().iter().zip([2, 0]) {
        let file = pdf::encode(picture).unwrap();
        let text = String::from_utf8_lossy(&file);
        assert_eq!(text.matches("/Subtype/Image").count(), images);
        assert!(text.contains("/FontFile2") && text.contains("/ToUnicode"));
        let number = |bytes: &[u8]| std::str::from_utf8(bytes).unwrap().trim().parse::<usize>().unwrap();
        let found = |from: usize, what: &[u8]| from + file[from..].windows(what.len()).position(|w| w == what).unwrap();
        let end = file.windows(9).rposition(|w| w == b"startxref").unwrap();
        let table = number(&file[end + 9..found(end, b"%%EOF")]);
        assert!(file[table..].starts_with(b"xref\n0 "));
        let line = found(table + 5, b"\n") + 1;
        for object in 1..11 + images {
            let place = number(&file[line + 20 * object..line + 20 * object + 10]);
            assert!(file[place..].starts_with(format!("{object} 0 obj\n").as_bytes()), "{object}");
        }
        for begin in file.windows(8).enumerate().filter(|(_, w)| *w == b">>stream").map(|(at, _)| at) {
            let length = file[..begin].windows(8).rposition(|w| w == b"/Length ").unwrap() + 8;
            let length = number(&file[length..begin]);
            assert!(file[begin + 9 + length..].starts_with(b"\nendstream"));
        }
    }
}

#[test]
fn more_pixels_per_inch_make_the_same_picture_larger() {
    let values = Array2::from_shape_fn((60, 60), |(i, j)| ((7 * i + 3 * j) % 10) as f64);
    let map = Map::new(values.view(), Grid::square(60, 1.0).unwrap(), Colouring::Sequential);
    let [usual, fine] = [DPI, 2.0 * DPI].map(|dpi| Raster::draw(&map.draw(dpi).unwrap()));
    assert_eq!((fine.columns, fine.pixels.len()), (2 * usual.columns, 4 * usual.pixels.len()));
    let plot = map.draw_plot(DPI.into()).unwrap().1;
    let (left, top) = ((2.0 * plot.left) as usize, (2.0 * plot.top) as usize);
    for (row, column) in (0..600).step_by(37).flat_map(|row| (0..600).step_by(37).map(move |column| (row, column))) {
        let at = |raster: &Raster, factor: usize| {
            raster.pixels[factor * (top + row) * raster.columns + factor * (left + column)]
        };
        assert_eq!(at(&usual, 1), at(&fine, 2));
    }
}

#[test]
fn limits_hold_for_any_field_and_arrows_say_what_is_beyond() {
    let grid = Grid::new((3, 2), (3.0, 2.0)).unwrap();
    let values = Array2::from_shape_fn((3, 2), |(i, j)| (i + 2 * j) as f64);
    let limited = |field: &Array2<f64>| {
        let map = Map { limits: Some((1.0, 3.0)), ..Map::new(field.view(), grid, Colouring::Sequential) };
        map.draw(DPI).unwrap()
    };
    let colours_of = |picture: &Picture| match &picture.shapes[0] {
        Shape::Image(image) => image.pixels.clone(),
        shape => panic!("{shape:?}"),
    };
    let (all, inner) = (limited(&values), limited(&values.mapv(|v| v.clamp(1.0, 3.0))));
    assert_eq!(colours_of(&all), colours_of(&inner));
    assert!(texts(&all).iter().any(|text| text == "max 4.00") && texts(&all).iter().any(|text| text == "min 0"));
    assert!(!texts(&inner).iter().any(|text| text.contains("max") || text.contains("min")));
}

#[test]
fn a_distribution_leaves_out_spikes_and_says_so() {
    let mut heights: Vec<_> = (0..5000).map(|k| 1e-9 * f64::from(k).sin()).collect();
    let of = |heights: &[f64]| Distribution::from_values(heights.iter().copied(), 10, Some("m"));
    let whole = of(&heights);
    assert_eq!(whole.beyond, "");
    (heights[11], heights[22], heights[33]) = (2e-7, 3e-8, -4e-8);
    let spiky = of(&heights);
    assert_eq!(
        spiky.beyond,
        "less than 0.1 % below −1.00 nm, down to −40.0 nm; less than 0.1 % above 1.00 nm, up to 200 nm"
    );
    assert!(whole.curve.iter().zip(&spiky.curve).all(|(one, other)| (one.1 - other.1).abs() < 0.2), "{spiky:?}");
    let share: f64 = spiky.curve.iter().map(|(_, share)| share).sum();
    assert!((share - 99.94).abs() < 1e-9, "{share}");
    // where there are few values none is an outlier
    assert_eq!(of(&heights[..20]).beyond, "");
    assert_eq!(of(&[]), Distribution::default());
}
