//! Clusters of contact: connected nodes of a periodic map.

use std::cmp::Reverse;

use ndarray::{Array2, ArrayView2, Axis};

use crate::elastic::Boundary;

/// The connected pieces of a periodic map: neighbours share a side of their cells.
///
/// ```
/// use asperity::contact::Clusters;
/// let map = ndarray::array![
///     [true, false, false, true],
///     [false, true, false, false],
///     [false, false, false, false],
/// ];
/// let clusters = Clusters::of(map.view());
/// assert_eq!(clusters.sizes, [2, 1]); // the upper corners are neighbours across the boundary
/// assert_eq!((clusters.labels[[0, 3]], clusters.labels[[1, 1]], clusters.labels[[2, 2]]), (1, 2, 0));
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clusters {
    /// The number of nodes of each cluster, the largest first; equal ones in row-major order.
    pub sizes: Vec<usize>,
    /// The cluster of each node: k for the k-th of the sizes, counted from 1, and 0 for none.
    pub labels: Array2<usize>,
}

impl Clusters {
    /// The clusters of the nodes that are `true`, on a periodic map. Memory: eight bytes for each node, and 24 for each
    /// row of nodes side by side.
    pub fn of(map: ArrayView2<'_, bool>) -> Self {
        Self::within(map, Boundary::Periodic)
    }

    /// The clusters as [`Clusters::of`], on a map with opposite sides that meet only if the boundary is periodic.
    pub(crate) fn within(map: ArrayView2<'_, bool>, boundary: Boundary) -> Self {
        let periodic = boundary.is_periodic();
        Self::meeting(map, [periodic; 2])
    }

    /// The clusters as [`Clusters::of`], on a part of a surface: opposite sides do not meet.
    pub fn of_part(map: ArrayView2<'_, bool>) -> Self {
        Self::meeting(map, [false; 2])
    }

    /// The clusters on a map with opposite sides along x, and along y, that meet or do not.
    pub(super) fn meeting(map: ArrayView2<'_, bool>, [meets_x, meets_y]: [bool; 2]) -> Self {
        let (nx, ny) = map.dim();
        let (runs, before) = runs(map);
        // each run's parent, which comes before it in its tree
        let mut tree: Vec<usize> = (0..runs.len()).collect();
        for i in 0..nx {
            let (here, below) = (before[i]..before[i + 1], (i + 1) % nx);
            if meets_y && !here.is_empty() && runs[here.start].0 == 0 && runs[here.end - 1].1 == ny {
                unite(&mut tree, here.start, here.end - 1);
            }
            if i + 1 == nx && !meets_x {
                continue;
            }
            let (mut a, mut b) = (here.start, before[below]);
            while a < here.end && b < before[below + 1] {
                let (one, other) = (runs[a], runs[b]);
                if one.0 < other.1 && other.0 < one.1 {
                    unite(&mut tree, a, b);
                }
                if one.1 < other.1 { a += 1 } else { b += 1 }
            }
        }
        // from parents to numbers, in place: a parent has its number before its children ask for it
        let mut sizes = Vec::new();
        for (k, &(start, end)) in runs.iter().enumerate() {
            if tree[k] == k {
                tree[k] = sizes.len();
                sizes.push(0);
            } else {
                tree[k] = tree[tree[k]];
            }
            sizes[tree[k]] += end - start;
        }
        let mut order: Vec<usize> = (0..sizes.len()).collect();
        order.sort_by_key(|&cluster| Reverse(sizes[cluster]));
        let mut label = vec![0; sizes.len()];
        order.iter().enumerate().for_each(|(rank, &cluster)| label[cluster] = rank + 1);
        let mut labels = Array2::zeros((nx, ny));
        for (mut row, runs_of) in labels.outer_iter_mut().zip(before.windows(2)) {
            for k in runs_of[0]..runs_of[1] {
                row.slice_axis_mut(Axis(0), (runs[k].0..runs[k].1).into()).fill(label[tree[k]]);
            }
        }
        sizes.sort_by_key(|&size| Reverse(size));
        Self { sizes, labels }
    }
}

/// The runs of nodes side by side along y, from the first to behind the last, and how many are before each row.
fn runs(map: ArrayView2<'_, bool>) -> (Vec<(usize, usize)>, Vec<usize>) {
    let (mut runs, mut before) = (Vec::new(), vec![0]);
    for row in map.outer_iter() {
        let mut first = None;
        for (j, &inside) in row.iter().enumerate() {
            match first {
                None if inside => first = Some(j),
                Some(start) if !inside => {
                    runs.push((start, j));
                    first = None;
                }
                _ => {}
            }
        }
        runs.extend(first.map(|start| (start, row.len())));
        before.push(runs.len());
    }
    (runs, before)
}

/// Joins the clusters of two runs.
fn unite(tree: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(tree, a), root(tree, b));
    tree[a.max(b)] = a.min(b);
}

/// The first run of a cluster; on the way there, every other run gets its grandparent as parent.
fn root(tree: &mut [usize], mut node: usize) -> usize {
    while tree[node] != node {
        tree[node] = tree[tree[node]];
        node = tree[node];
    }
    node
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A map from a drawing: `#` is contact.
    pub fn map(rows: &[&str]) -> Array2<bool> {
        let nodes = rows.iter().flat_map(|row| row.bytes().map(|c| c == b'#')).collect();
        Array2::from_shape_vec((rows.len(), rows[0].len()), nodes).unwrap()
    }

    #[track_caller]
    fn check(rows: &[&str], sizes: &[usize]) {
        let map = map(rows);
        let clusters = Clusters::of(map.view());
        assert_eq!(clusters.sizes, sizes);
        assert!(clusters.labels.iter().zip(&map).all(|(label, inside)| (*label > 0) == *inside));
        for (k, &size) in sizes.iter().enumerate() {
            assert_eq!(clusters.labels.iter().filter(|label| **label == k + 1).count(), size);
        }
    }

    #[test]
    fn clusters_that_can_be_counted_by_hand() {
        check(&["....", "....", "...."], &[]);
        check(&["####", "####", "####"], &[12]);
        check(&["#....", ".....", "..##.", "....."], &[2, 1]);
        // nodes that share a corner alone
        check(&[".....", ".#...", "..#..", "....."], &[1, 1]);
        check(&[".....", "..#..", ".#...", "....."], &[1, 1]);
        // a ring, a spiral, and a comb with teeth that meet late
        check(&["......", ".####.", ".#..#.", ".####.", "......"], &[10]);
        check(&[".......", ".#####.", ".....#.", ".###.#.", ".#...#.", ".#####.", "......."], &[17]);
        check(&["........", ".#.#.#..", ".#.#.#..", ".#####..", "........"], &[11]);
    }

    #[test]
    fn clusters_go_across_the_boundaries() {
        check(&["#..#", "....", "...."], &[2]);
        check(&["#...", "....", "#..."], &[2]);
        check(&["#..#", "....", "#..#"], &[4]);
        // diagonally across a side, and across the corner
        check(&[".....", "#....", "....#", "....."], &[1, 1]);
        check(&["..#..", ".....", ".....", "...#."], &[1, 1]);
        check(&["#....", ".....", ".....", "....#"], &[1, 1]);
        check(&["....#", ".....", ".....", "#...."], &[1, 1]);
        // a band that closes on itself, and one that winds
        check(&["....", "####", "...."], &[4]);
        check(&["##..", ".##.", "..##", "#..#"], &[8]);
    }

    #[test]
    fn clusters_of_lines_and_of_a_single_node() {
        check(&["#.##.#"], &[2, 2]);
        check(&["#", ".", "#", "#"], &[3]);
        check(&["#"], &[1]);
        check(&["."], &[]);
        check(&["#.", ".#"], &[1, 1]);
        assert!(Clusters::of(Array2::default((0, 3)).view()).sizes.is_empty());
    }

    /// A number below 97 that tells nothing of the node.
    fn hash(i: usize, j: usize) -> usize {
        (i * 7919 + j * 104_729 + i * j * 31) % 97
    }

    #[test]
    fn clusters_are_those_that_floods_fill() {
        let shapes = [((23, 31), 40), ((23, 31), 60), ((64, 5), 80), ((40, 1), 60), ((1, 40), 60)];
        for (((nx, ny), share), (meets_x, meets_y)) in shapes
            .into_iter()
            .flat_map(|of| [(false, false), (true, false), (false, true), (true, true)].map(|m| (of, m)))
        {
            let mut dry = Array2::from_shape_fn((nx, ny), |(i, j)| hash(i, j) < share);
            let found = Clusters::meeting(dry.view(), [meets_x, meets_y]);
            let (mut sizes, starts) = (Vec::new(), dry.indexed_iter().map(|(node, _)| node).collect::<Vec<_>>());
            for start in starts.into_iter().filter(|&start| found.labels[start] > 0) {
                let (mut size, mut reached) = (0, vec![start]);
                while let Some((i, j)) = reached.pop() {
                    if !std::mem::take(&mut dry[[i, j]]) {
                        continue;
                    }
                    assert_eq!(found.labels[[i, j]], found.labels[start]);
                    size += 1;
                    let beside = |k: usize, n: usize, meets: bool| {
                        [(k > 0 || meets).then_some((k + n - 1) % n), (k + 1 < n || meets).then_some((k + 1) % n)]
                    };
                    reached.extend(beside(i, nx, meets_x).into_iter().flatten().map(|i| (i, j)));
                    reached.extend(beside(j, ny, meets_y).into_iter().flatten().map(|j| (i, j)));
                }
                sizes.extend((size > 0).then_some((size, found.labels[start])));
            }
            assert!(dry.iter().all(|dry| !dry));
            sizes.sort_by_key(|&(size, _)| Reverse(size));
            assert!(sizes.into_iter().eq(found.sizes.into_iter().zip(1..)));
        }
    }

    #[test]
    fn clusters_do_not_depend_on_where_the_cell_begins() {
        let (nx, ny) = (23, 31);
        let sizes = |di: usize, dj: usize| {
            let map = Array2::from_shape_fn((nx, ny), |(i, j)| hash((i + di) % nx, (j + dj) % ny) < 48);
            Clusters::of(map.view()).sizes
        };
        let there = sizes(0, 0);
        assert!(there.len() > 1);
        for shift in [(1, 0), (0, 1), (11, 17), (22, 30)] {
            assert_eq!(sizes(shift.0, shift.1), there);
        }
    }
}
