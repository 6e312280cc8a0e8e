//! Tests of the pictures.

use std::fs::File;
use std::io::BufReader;

use ndarray::Array2;

use super::*;

/// Writes a map, and reads its width, height and pixels, and the corner and size of the plot.
fn drawn(map: &Map<'_>, name: &str) -> (usize, usize, Vec<[u8; 3]>, [usize; 4]) {
    let path = std::env::temp_dir().join(format!("asperity-{}-{name}.png", std::process::id()));
    map.write_png(&path).unwrap();
    let mut reader = png::Decoder::new(BufReader::new(File::open(&path).unwrap())).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    std::fs::remove_file(&path).unwrap();
    let plot = map.draw().1;
    let [x, y] = [plot.top_left.x, plot.top_left.y].map(|c| c as usize);
    let plot = [x, y, plot.size.width as usize, plot.size.height as usize];
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
        let map = Map::new(values.view(), Grid::square(n, 1.0).unwrap(), Colouring::Binary);
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
            for colouring in [Colouring::Sequential, Colouring::Diverging, Colouring::Binary] {
                // Flat, for a small picture.
                let map = Map::new(values.view(), Grid::new(shape, (1e300, 1e-300)).unwrap(), colouring);
                let map = Map { label: "µ\n−🦀", unit: Some("m"), length_unit: Some("m"), ..map };
                let size = map.draw().0.size();
                assert!(size.width < 4000 && size.height < 1000, "{value} {first} {shape:?}: {size}");
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
    assert!(matches!(map.write_png(Path::new("x.png")), Err(Error::Shape { found: (4, 3), .. })));
    let map = Map { grid: Grid::new((4, 3), (1.0, 1.0)).unwrap(), ..map };
    let path = Path::new("/no/such/directory/x.png");
    assert!(matches!(map.write_png(path), Err(Error::File { path: p, .. }) if p == path));
}
