//! Percolation against drawings and against paths that are tried out.

use std::collections::HashSet;

use asperity::Grid;
use asperity_flow::{Axis, Gap, Percolation};
use ndarray::Array2;

use crate::random_gaps;

fn grid(values: &Array2<f64>) -> Grid {
    Grid::new(values.dim(), (1.0, 1.0)).unwrap()
}

/// Both percolations of a drawing, in which `#` is closed.
fn drawn(rows: &[&str]) -> [Percolation; 2] {
    let values = rows.iter().flat_map(|row| row.bytes().map(|c| if c == b'#' { 0.0 } else { 1.0 })).collect();
    let values = Array2::from_shape_vec((rows.len(), rows[0].len()), values).unwrap();
    let gap = Gap::new(values.view(), grid(&values)).unwrap();
    [gap.clone().percolation(), gap.free().percolation()]
}

#[test]
fn drawings_percolate_as_one_sees() {
    // around the cell along x and y, and from side to side along x and y; x is from row to row
    for (rows, expected) in [
        (&["#.##", "#.##", "#.##"][..], [true, false, true, false]),
        (&["####", "....", "####"], [false, true, false, true]),
        (&["#.##", "....", "#.##"], [true, true, true, true]),
        (&["####", "####", "####"], [false; 4]),
        // side to side, but not around
        (&["#.##", "#..#", "##.#"], [false, false, true, false]),
        // corners do not connect
        (&[".##", "#.#", "##."], [false; 4]),
        // one way around along both axes at once
        (&[".###.", "..###", "#..##", "##..#", "###.."], [true, true, true, true]),
        // around twice along x and once along y
        (&[".#", "#.", ".."], [false, true, false, true]),
        (&["."], [true; 4]),
        (&["#"], [false; 4]),
        // two pieces that touch opposite sides each, and each other across the boundary alone
        (&["..##", "####", "##.."], [false; 4]),
    ] {
        let [periodic, free] = drawn(rows);
        let found = [&periodic, &free].map(|found| Axis::BOTH.map(|axis| found.above(0.0, axis)));
        assert_eq!(found.concat(), expected, "{rows:?}");
    }
}

/// Whether nodes that `open` names percolate, by all ways from each node through the cells around it.
fn tried(open: &Array2<bool>, periodic: bool, axis: Axis) -> bool {
    let (nx, ny) = open.dim();
    let n = [nx as i32, ny as i32];
    let is_open = |[x, y]: [i32; 2]| open[[x.rem_euclid(n[0]) as usize, y.rem_euclid(n[1]) as usize]];
    let inside = |place: [i32; 2]| {
        (0..2).all(|a| if periodic { place[a].abs() <= 5 * n[a] } else { (0..n[a]).contains(&place[a]) })
    };
    let starts = (0..n[0]).flat_map(|x| (0..n[1]).map(move |y| [x, y]));
    let a = axis as usize;
    starts.filter(|start| periodic || start[a] == 0).any(|start| {
        let (mut seen, mut next) = (HashSet::from([start]), vec![start]);
        while let Some(place) = next.pop().filter(|_| is_open(start)) {
            let around = (0..2).all(|b| (place[b] - start[b]) % n[b] == 0) && place[a] != start[a];
            if if periodic { around } else { place[a] == n[a] - 1 } {
                return true;
            }
            for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                let to = [place[0] + dx, place[1] + dy];
                if inside(to) && is_open(to) && seen.insert(to) {
                    next.push(to);
                }
            }
        }
        false
    })
}

#[test]
fn the_constriction_is_the_last_to_close_and_a_path_leads_through() {
    let mut percolating = 0;
    for (case, (values, periodic)) in random_gaps(7).take(200).enumerate() {
        let gap = Gap::new(values.view(), grid(&values)).unwrap();
        let found = if periodic { gap } else { gap.free() }.percolation();
        let (nx, ny) = values.dim();
        for axis in Axis::BOTH {
            let Some(narrowest) = found.along(axis) else {
                assert!(!tried(&values.mapv(|gap| gap > 0.0), periodic, axis), "{case}");
                continue;
            };
            percolating += 1;
            let size = narrowest.gap;
            assert_eq!(values[narrowest.node], size);
            assert!(tried(&values.mapv(|gap| gap >= size), periodic, axis), "{case}");
            assert!(!tried(&values.mapv(|gap| gap > size), periodic, axis), "{case}");
            assert!(found.above(0.99 * size, axis) && !found.above(size, axis));

            let path = &narrowest.path;
            assert!(path.contains(&narrowest.node) && path.iter().all(|node| values[*node] >= size));
            assert_eq!(path.iter().collect::<HashSet<_>>().len(), path.len());
            // from node to node, and around to the first one
            let ends = path.iter().zip(path.iter().cycle().skip(1));
            let mut cells = 0;
            for (k, (from, to)) in ends.enumerate().take(if periodic { path.len() } else { path.len() - 1 }) {
                let step = |from: usize, to: usize, n: usize| match (to + n - from) % n {
                    0 => 0,
                    1 => 1,
                    last if last == n - 1 => -1,
                    far => panic!("{case}: a step over {far} nodes after node {k}"),
                };
                // along a side of two nodes a step forwards and one backwards look alike
                cells += if axis == Axis::X { step(from.0, to.0, nx) } else { step(from.1, to.1, ny) };
            }
            let (n, first, last) = match axis {
                Axis::X => (nx, path[0].0, path[path.len() - 1].0),
                Axis::Y => (ny, path[0].1, path[path.len() - 1].1),
            };
            if periodic {
                assert!(n < 3 || (cells != 0 && cells % n as i32 == 0), "{case}: {cells}");
            } else {
                assert_eq!((first, last), (0, n - 1));
            }
        }
    }
    assert!(percolating > 50, "{percolating}");
}
