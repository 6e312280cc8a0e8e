//! Height maps in lists of points (x, y, z).

use ndarray::{Array2, ArrayView2};

use super::{Parsed, check_room, quoted, refuse};

/// The largest distance of a point from its place on the grid, in spacings.
const SLACK: f64 = 0.1;
/// The most nodes of a grid for each of its points: a bound on the memory that a small file can ask for.
const SPARSEST: f64 = 4.0;
/// The fewest points and the most columns of a table that is known for one of points by its numbers.
const FEWEST_POINTS: usize = 9;
const MOST_COLUMNS: usize = 8;

/// The heights of points, and the side lengths.
pub(super) type Gridded = (Array2<f64>, (f64, f64));

/// The heights of points x y z of a regular grid, in any order, and the side lengths; points that are not there are missing.
pub(super) fn map_of_points(points: &[[f64; 3]]) -> Parsed<Gridded> {
    if let Some([x, y, _]) = points.iter().find(|[x, y, _]| !(x.is_finite() && y.is_finite())) {
        return refuse(format!("has a point with the coordinates {x} and {y}, expected finite numbers"));
    }
    // what the axes and the map take at most
    check_room(points.len().saturating_mul(64))?;
    let axis = |k: usize, name: &str| {
        Axis::new(points.iter().map(|point| point[k]).collect()).ok_or_else(|| {
            format!(
                "is not on a regular grid: its {} points have no common spacing along {name}; interpolate them on a grid first",
                points.len()
            )
        })
    };
    let (x, y) = (axis(0, "x")?, axis(1, "y")?);
    if x.nodes as f64 * y.nodes as f64 > SPARSEST * points.len() as f64 {
        return refuse(format!(
            "is not on a regular grid: its {} points would be scattered over {} x {} nodes; \
             interpolate them on a grid first",
            points.len(),
            x.nodes,
            y.nodes
        ));
    }
    // a line has no spacing across it
    let (dx, dy) = match (x.spacing, y.spacing) {
        (Some(dx), dy) => (dx, dy.unwrap_or(dx)),
        (None, Some(dy)) => (dy, dy),
        (None, None) => return refuse("has points in one place only, expected a grid of them"),
    };
    let mut heights = Array2::from_elem((x.nodes, y.nodes), f64::NAN);
    let mut taken = vec![false; heights.len()];
    for &[px, py, z] in points {
        let (i, j) = (x.index(px), y.index(py));
        if std::mem::replace(&mut taken[i * y.nodes + j], true) {
            let place = quoted(&format!("{px} {py}"));
            return refuse(format!(
                "has two points at the node of {place}: it is not one map, or not on a regular grid"
            ));
        }
        heights[[i, j]] = z;
    }
    Ok((heights, (dx * x.nodes as f64, dy * y.nodes as f64)))
}

/// The first two columns of several that are the coordinates of a grid, with at most so many nodes for each of the points.
pub(crate) fn coordinates(table: ArrayView2<'_, f64>, most_nodes: f64) -> Option<[usize; 2]> {
    let (count, columns) = table.dim();
    if count < FEWEST_POINTS || !(3..=MOST_COLUMNS).contains(&columns) {
        return None;
    }
    let is_axis = |column: &usize| Axis::new(table.column(*column).to_vec()).is_some_and(|axis| axis.nodes > 1);
    let is_finite = |column: &usize| table.column(*column).iter().all(|value| value.is_finite());
    let axes: Vec<_> = (0..columns).filter(is_finite).filter(is_axis).collect();
    let pairs = axes.iter().enumerate().flat_map(|(k, x)| axes[k + 1..].iter().map(move |y| [*x, *y]));
    let is_grid = |&[x, y]: &[usize; 2]| {
        let points: Vec<_> = table.rows().into_iter().map(|row| [row[x], row[y], 0.0]).collect();
        map_of_points(&points).is_ok_and(|(heights, _)| heights.len() as f64 <= most_nodes * count as f64)
    };
    pairs.into_iter().find(is_grid)
}

/// Equidistant coordinates.
struct Axis {
    first: f64,
    /// none if there is only one node
    spacing: Option<f64>,
    nodes: usize,
}

impl Axis {
    /// The finest axis with all values on nodes, but for rounding and noise.
    fn new(mut values: Vec<f64>) -> Option<Self> {
        values.sort_unstable_by(f64::total_cmp);
        let (first, last) = (*values.first()?, *values.last()?);
        if first == last {
            return Some(Self { first, spacing: None, nodes: 1 });
        }
        let gaps = || values.windows(2).map(|pair| pair[1] - pair[0]);
        let largest = gaps().fold(0.0, f64::max);
        // steps below a share of the largest gap, which missing lines may have widened, are noise
        for share in [0.003, 0.03, 0.3] {
            let step = gaps().filter(|gap| *gap > share * largest).fold(f64::INFINITY, f64::min);
            // one after the other, so that the rounding of coordinates does not add up
            let indices = std::iter::once(0.0).chain(gaps().scan(0.0, |index, gap| {
                *index += (gap / step).round();
                Some(*index)
            }));
            let indices: Vec<f64> = indices.collect();
            let steps = *indices.last()?;
            if !(steps >= 1.0 && steps <= SPARSEST * values.len() as f64) {
                continue;
            }
            // the straight line through all of them
            let mean = |of: &[f64]| of.iter().map(|value| value / of.len() as f64).sum::<f64>();
            let (index, value) = (mean(&indices), mean(&values));
            let pairs = || indices.iter().zip(&values).map(|(i, v)| (i - index, v - value));
            let spacing = pairs().map(|(i, v)| i * v).sum::<f64>() / pairs().map(|(i, _)| i * i).sum::<f64>();
            let axis = Self { first: value - spacing * index, spacing: Some(spacing), nodes: steps as usize + 1 };
            if values.iter().all(|value| axis.fits(*value)) {
                return Some(axis);
            }
        }
        None
    }

    /// The place in spacings.
    fn place(&self, value: f64) -> f64 {
        self.spacing.map_or(0.0, |spacing| (value - self.first) / spacing)
    }

    fn fits(&self, value: f64) -> bool {
        let place = self.place(value);
        (place - place.round()).abs() <= SLACK
    }

    fn index(&self, value: f64) -> usize {
        (self.place(value).round() as usize).min(self.nodes - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{assert_refused, read_map};
    #[test]
    fn points_in_any_order_with_rounded_coordinates_and_holes() {
        // x from 1/3 by thirds, written with two decimals; y downwards by 2; z = 10 i + j
        let x = ["0.33", "0.67", "1.00", "1.33", "1.67", "2.00", "2.33"];
        let mut lines: Vec<String> = Vec::new();
        for (i, x) in x.iter().enumerate() {
            for j in 0..5 {
                lines.push(format!("{x}\t{}\t{}", 2 * j as i32 - 7, 10 * i + j));
            }
        }
        let order: Vec<_> = (0..35).map(|k| (k * 17 + 3) % 35).collect();
        let text: String = order.iter().filter(|k| **k != 12).map(|k| format!("{}\n", lines[*k])).collect();
        let map = read_map(format!("# x y z\n{text}"), "points.XYZ").unwrap();
        assert_eq!((map.heights.dim(), map.missing(), map.unit.clone()), ((7, 5), 1, None));
        assert!(map.heights[[2, 2]].is_nan());
        for ((i, j), h) in map.heights.indexed_iter().filter(|((i, j), _)| (*i, *j) != (2, 2)) {
            assert_eq!(*h, (10 * i + j) as f64);
        }
        let (lx, ly) = map.lengths.unwrap();
        assert!((lx - 7.0 / 3.0).abs() < 0.01 && (ly - 10.0).abs() < 1e-12, "{lx} {ly}");
        // without this ending they are known by their numbers, if few are missing
        assert_eq!(read_map(&text, "points.txt").unwrap().heights.dim(), (7, 5));
        let half: String = text.split_inclusive('\n').step_by(2).collect();
        assert_eq!(read_map(half, "points.txt").unwrap().heights.dim(), (17, 3));
    }

    #[test]
    fn missing_lines_noise_and_lines_of_points() {
        // a line at x = 0, 1, 2, 15, 16: the rest is missing, and too little is there for a grid of four rows
        let line = |y: &str| [0, 1, 2, 15, 16].map(|x| format!("{x} {y} {x}\n")).concat();
        let map = read_map(line("3"), "a.xyz").unwrap();
        assert_eq!((map.heights.dim(), map.missing(), map.lengths), ((17, 1), 12, Some((17.0, 1.0))));
        let noisy = "0.01 0 1\n1.02 0.03 2\n-0.02 1 3\n0.98 1.04 4\n2 0 5\n2.03 0.97 6\n";
        let map = read_map(noisy, "a.xyz").unwrap();
        assert_eq!(map.heights, ndarray::array![[1.0, 3.0], [2.0, 4.0], [5.0, 6.0]]);
        let profile = read_map("5,0,1\n5,2,2\n5,4,nan\n", "a.xyz").unwrap();
        assert_eq!((profile.heights.dim(), profile.missing(), profile.lengths), ((1, 3), 1, Some((2.0, 6.0))));
    }

    #[test]
    fn units_and_points_of_any_name_are_known() {
        let points: String = (0..12).map(|k| format!("{} {} {}\n", k % 4, k / 4, 7 * k * k % 11)).collect();
        let plain = read_map(&points, "a.xyz").unwrap();
        assert_eq!((plain.heights.dim(), plain.lengths), ((4, 3), Some((4.0, 3.0))));
        let blocks = points.replace("3 0", "3 0 ").replace("\n0 1", "\n\n0 1").replace("\n0 2", "\n\n0 2");
        let separated = points.replace(' ', ",").replace('\n', ",\n");
        for text in [points.clone(), blocks, separated] {
            assert_eq!(read_map(text, "a.txt").unwrap(), plain);
        }
        for heading in [
            "# X[um] Y[um] Z[nm]",
            "x (um), y (um), z (nm)",
            "x/um y/um z/nm",
            "#Lateral units: um\n#Value units: nm",
            "X,Y,Z\num,um,nm",
            "# x y z\n# [um] [um] [nm]",
            "# units: um um nm",
        ] {
            let map = read_map(format!("{heading}\n{points}"), "a.xyz").unwrap();
            assert_eq!((map.unit.as_deref(), map.lengths), (Some("m"), Some((4e-6, 3e-6))), "{heading}");
            assert_eq!(map.heights, &plain.heights / 1e9, "{heading}");
        }
        let swapped: String = (0..12).map(|k| format!("{} {} {}\n", k / 4, k % 4, 7 * k * k % 11)).collect();
        assert_eq!(read_map(format!("# y x z\n{swapped}"), "a.txt").unwrap(), plain);
        let told = points.lines().map(|line| format!("{line}\n")).collect::<String>();
        let map = read_map(format!("# pixel size: 250 nm\n# z-unit: um\n{told}"), "a.xyz").unwrap();
        assert_eq!((map.lengths, map.heights[[1, 0]]), (Some((1e-6, 7.5e-7)), 7e-6));
        let fewer = points.replacen("1 1 ", "# 1 1 ", 1);
        assert_eq!(read_map(fewer, "a.txt").unwrap().missing(), 1);
        // a matrix of three columns is none of points
        let matrix: String = (0..12).map(|k| format!("{} {} {}\n", k % 4, k / 3, k * k % 11)).collect();
        assert_eq!(read_map(matrix, "a.txt").unwrap().heights.dim(), (12, 3));
    }

    #[test]
    fn what_is_no_grid_is_refused() {
        let scattered: String = (0..50).map(|k| format!("{} {} 1\n", (k * k * 7) % 101, (k * 31) % 97)).collect();
        assert_refused(read_map(scattered, "a.xyz"), &["not on a regular grid", "50 points", "interpolate"]);
        let diagonal: String = (0..50).map(|k| format!("{k} {k} 1\n")).collect();
        assert_refused(read_map(diagonal, "a.xyz"), &["scattered over 50 x 50 nodes", "interpolate"]);
        assert_refused(read_map("0 0 1\n0 1 2\n0.4 0 1\n1 1 1\n", "a.xyz"), &["common spacing along x"]);
        assert_refused(read_map("0 0 1\n1 0 2\n1 0 3\n", "a.xyz"), &["two points", "\"1 0\""]);
        assert_refused(read_map("3 4 1\n", "a.xyz"), &["one place"]);
        assert_refused(read_map("0 0 1\n0 1\n", "a.xyz"), &["line 2", "2 numbers"]);
        assert_refused(read_map("0 1\n", "a.xyz"), &["2 numbers", "x, y and z"]);
        assert_refused(read_map("0 inf 1\n", "a.xyz"), &["0 and inf", "finite"]);
        assert_refused(read_map("-1e308 0 1\n1e308 0 1\n", "a.xyz"), &["common spacing"]);
        assert_refused(read_map("# nothing\n", "a.xyz"), &["holds no numbers"]);
        assert_refused(read_map("x y w\n0 0 1\n", "a.xyz"), &["columns \"x y w\"", "name one of heights z"]);
        assert_refused(read_map("# x y z\n0 0 1 7\n0 1 1 7\n", "a.xyz"), &["names 3 columns", "4 numbers"]);
        assert_refused(read_map("# x[um] y[nm] z[nm]\n0 0 1\n0 1 1\n", "a.xyz"), &["x in \"um\" and y in \"nm\""]);
    }
}
