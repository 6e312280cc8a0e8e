//! Clusters of contact: connected nodes of a periodic map.

use std::cmp::Reverse;

use ndarray::{Array2, ArrayView2};

use crate::elastic::Boundary;

/// The pieces of a periodic map that hang together: of neighbours whose cells share a side.
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
    /// The clusters of the nodes that are `true`, on a map whose opposite sides meet. Memory per node: eight bytes.
    pub fn of(map: ArrayView2<'_, bool>) -> Self {
        Self::within(map, Boundary::Periodic)
    }

    /// The clusters as [`Clusters::of`], on a map whose opposite sides meet only if the boundary is periodic.
    pub fn within(map: ArrayView2<'_, bool>, boundary: Boundary) -> Self {
        let periodic = boundary == Boundary::Periodic;
        Self::meeting(map, [periodic; 2])
    }

    /// The clusters as [`Clusters::of`], on a part of a surface, whose opposite sides do not meet.
    pub fn of_part(map: ArrayView2<'_, bool>) -> Self {
        Self::meeting(map, [false; 2])
    }

    /// The clusters on a map of which opposite sides along x, and along y, meet or do not.
    pub(super) fn meeting(map: ArrayView2<'_, bool>, [meets_x, meets_y]: [bool; 2]) -> Self {
        let (nx, ny) = map.dim();
        // each node's parent, which comes before it in its tree; nodes of no cluster have none
        let mut tree: Vec<usize> = map.iter().enumerate().map(|(k, &inside)| if inside { k } else { NONE }).collect();
        for i in 0..nx {
            let below = (i + 1) % nx;
            for j in 0..ny {
                if tree[i * ny + j] == NONE {
                    continue;
                }
                if j + 1 < ny || meets_y {
                    unite(&mut tree, i * ny + j, i * ny + (j + 1) % ny);
                }
                if i + 1 < nx || meets_x {
                    unite(&mut tree, i * ny + j, below * ny + j);
                }
            }
        }
        // from parents to numbers, in place: a parent has its number before its children ask for it
        let mut sizes = Vec::new();
        for k in 0..tree.len() {
            if tree[k] == k {
                tree[k] = sizes.len();
                sizes.push(1);
            } else if tree[k] != NONE {
                tree[k] = tree[tree[k]];
                sizes[tree[k]] += 1;
            }
        }
        let mut order: Vec<usize> = (0..sizes.len()).collect();
        order.sort_by_key(|&cluster| Reverse(sizes[cluster]));
        let mut label = vec![0; sizes.len()];
        order.iter().enumerate().for_each(|(rank, &cluster)| label[cluster] = rank + 1);
        tree.iter_mut().for_each(|k| *k = label.get(*k).copied().unwrap_or(0));
        sizes.sort_by_key(|&size| Reverse(size));
        let labels = Array2::from_shape_vec((nx, ny), tree).unwrap_or_else(|_| Array2::zeros((nx, ny)));
        Self { sizes, labels }
    }
}

const NONE: usize = usize::MAX;

/// Makes one cluster of those of two nodes, if both have one.
fn unite(tree: &mut [usize], a: usize, b: usize) {
    if tree[a] == NONE || tree[b] == NONE {
        return;
    }
    let (a, b) = (root(tree, a), root(tree, b));
    tree[a.max(b)] = a.min(b);
}

/// The first node of a cluster; on the way there, every other node gets its grandparent as parent.
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
        // a ring, a spiral, and a comb whose teeth meet late
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

    #[test]
    fn clusters_do_not_depend_on_where_the_cell_begins() {
        let (nx, ny) = (23, 31);
        let hash = |i: usize, j: usize| (i * 7919 + j * 104_729 + i * j * 31) % 97;
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
