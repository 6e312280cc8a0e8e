//! Elimination of the pressures, exact for the hubs and approximate for the rims: a preconditioner for networks of any
//! contrast.

use crate::network::Network;

/// An approximate Cholesky factorisation of the matrix of the rims of a network, by elimination of one after the other.
///
/// Without its hub a star is a clique of its rims. Without a rim its d neighbours are a clique of d(d − 1)/2 edges, w_i
/// w_j/Σw each. In its place stand d − 1 edges that are drawn at random such that the mean is the clique: each
/// neighbour, from the least weight on, gets an edge to one of those after it, drawn by their weights. The factor stays
/// as sparse as the matrix, and its quality hardly depends on the contrast: R. Kyng, S. Sachdeva, FOCS 2016, 573; Y.
/// Gao, R. Kyng, D. A. Spielman, arXiv:2303.00709 (2023).
///
/// The vertices go in rounds. Each round takes vertices that are no neighbours of one another and have no more
/// neighbours than the mean, and numbers the others anew: neighbours stay near each other in memory.
pub(crate) struct Elimination {
    /// The vertices in the order of their elimination.
    order: Vec<u32>,
    /// The reciprocal of the sum of the weights of each at its elimination.
    pivots: Vec<f64>,
    /// Where the column of each begins.
    starts: Vec<usize>,
    /// The places in the order, and the shares of the weight, of the neighbours of each at its elimination.
    rows: Vec<u32>,
    shares: Vec<f64>,
}

impl Elimination {
    /// The factorisation of a network; once it ends, the vertices that are left have no neighbours.
    pub fn new(network: &Network, goes_on: &dyn Fn() -> bool) -> Self {
        let n = network.ground();
        let mut made = Self {
            order: Vec::with_capacity(n),
            pivots: Vec::with_capacity(n),
            starts: vec![0],
            rows: Vec::with_capacity(4 * n),
            shares: Vec::with_capacity(4 * n),
        };
        let mut random = Random(0);
        let mut graph = Graph::new((0..n as u32).collect(), cliques(network));
        while !graph.names.is_empty() && goes_on() {
            let (names, edges) = made.round(&graph, &mut random);
            graph = Graph::new(names, edges.into_iter());
        }
        made.order.extend(graph.names);
        made.pivots.resize(n, 0.0);
        made.starts.resize(n + 1, made.rows.len());
        let mut place = vec![0; n];
        made.order.iter().enumerate().for_each(|(k, vertex)| place[*vertex as usize] = k as u32);
        made.rows.iter_mut().for_each(|row| *row = place[*row as usize]);
        made
    }

    /// Eliminates some vertices of a graph; the others, and the edges between them.
    fn round(&mut self, graph: &Graph, random: &mut Random) -> (Vec<u32>, Vec<(u32, u32, f64)>) {
        let n = graph.names.len();
        let most = graph.links.len().div_ceil(n);
        let mut fates = vec![Fate::Open; n + 1];
        for vertex in 0..n {
            let links = graph.links(vertex);
            if fates[vertex] == Fate::Open && links.len() <= most {
                links.iter().for_each(|(to, _)| fates[*to as usize] = Fate::Stays);
                fates[vertex] = Fate::Goes;
            }
        }
        // the numbers of those that stay; the ground stays
        let mut names = Vec::with_capacity(n / 2);
        let mut number = vec![0_u32; n + 1];
        for vertex in (0..n).filter(|vertex| fates[*vertex] != Fate::Goes) {
            number[vertex] = names.len() as u32;
            names.push(graph.names[vertex]);
        }
        number[n] = names.len() as u32;
        let mut edges = Vec::with_capacity(graph.links.len() / 2);
        let (mut star, mut after) = (Vec::new(), Vec::new());
        for vertex in 0..n {
            let (links, ground) = (graph.links(vertex), graph.ground[vertex]);
            if fates[vertex] != Fate::Goes {
                let kept = links.iter().filter(|(to, _)| *to as usize > vertex && fates[*to as usize] != Fate::Goes);
                edges.extend(kept.map(|(to, weight)| (number[vertex], number[*to as usize], *weight)));
                if ground > 0.0 {
                    edges.push((number[vertex], number[n], ground));
                }
                continue;
            }
            star.clear();
            star.extend_from_slice(links);
            if ground > 0.0 {
                star.push((n as u32, ground));
            }
            star.sort_unstable_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            let per_pivot = star.iter().map(|(_, weight)| weight).sum::<f64>().recip();
            self.order.push(graph.names[vertex]);
            // the last vertex of a network without ground has no neighbour: its pressure is zero
            self.pivots.push(if star.is_empty() { 0.0 } else { per_pivot });
            for (to, weight) in links {
                self.rows.push(graph.names[*to as usize]);
                self.shares.push(weight * per_pivot);
            }
            self.starts.push(self.rows.len());
            // the sum of the weights from each neighbour on
            after.clear();
            after.resize(star.len() + 1, 0.0);
            (0..star.len()).rev().for_each(|i| after[i] = after[i + 1] + star[i].1);
            for (i, (from, weight)) in star.iter().enumerate().take(star.len().saturating_sub(1)) {
                let drawn = random.next() * after[i + 1];
                let to = i + after[i + 1..star.len()].partition_point(|rest| *rest > drawn).max(1);
                edges.push((number[*from as usize], number[star[to].0 as usize], weight * after[i + 1] * per_pivot));
            }
        }
        (names, edges)
    }

    /// The pressures that belong to flows out of the vertices, approximately; `work` is room for as many.
    pub fn solve(&self, flows: &[f64], pressures: &mut [f64], work: &mut [f64]) {
        work.iter_mut().zip(&self.order).for_each(|(work, vertex)| *work = flows[*vertex as usize]);
        let column = |k: usize| self.starts[k]..self.starts[k + 1];
        for k in 0..work.len() {
            let own = work[k];
            for i in column(k) {
                work[self.rows[i] as usize] += self.shares[i] * own;
            }
        }
        for k in (0..work.len()).rev() {
            let own = work[k] * self.pivots[k];
            work[k] = column(k).fold(own, |sum, i| sum + self.shares[i] * work[self.rows[i] as usize]);
        }
        work.iter().zip(&self.order).for_each(|(work, vertex)| pressures[*vertex as usize] = *work);
    }
}

/// The edges between the rims of each hub of a network once the hubs are eliminated.
fn cliques(network: &Network) -> impl Iterator<Item = (u32, u32, f64)> + Clone + '_ {
    network.stars().flat_map(|star| {
        let star = &network.edges[star];
        let sum: f64 = star.iter().map(|edge| edge.conductance).sum();
        star.iter().enumerate().flat_map(move |(k, one)| {
            let others = star[..k].iter().filter(|other| other.rim != one.rim);
            others.map(move |other| (one.rim, other.rim, one.conductance / sum * other.conductance))
        })
    })
}

/// What happens to a vertex in a round.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    Open,
    Stays,
    Goes,
}

/// The vertices that are left.
struct Graph {
    /// The vertex of the network.
    names: Vec<u32>,
    /// Where the links of each begin.
    starts: Vec<usize>,
    /// The neighbours and the weights of the edges there.
    links: Vec<(u32, f64)>,
    /// The weights of the edges to the ground.
    ground: Vec<f64>,
}

impl Graph {
    /// The graph of edges; several between the same vertices become one. The ground has the number behind the last
    /// vertex.
    fn new(names: Vec<u32>, edges: impl Iterator<Item = (u32, u32, f64)> + Clone) -> Self {
        let n = names.len();
        let (mut starts, mut ground) = (vec![0_usize; n + 2], vec![0.0; n]);
        let inner = |edge: &(u32, u32, f64)| (edge.0.max(edge.1) as usize) < n;
        edges.clone().for_each(|edge| {
            let (a, b, weight) = edge;
            if inner(&edge) {
                [a, b].into_iter().for_each(|end| starts[end as usize + 2] += 1);
            } else {
                ground[a.min(b) as usize] += weight;
            }
        });
        (2..n + 2).for_each(|k| starts[k] += starts[k - 1]);
        let mut links = vec![(0, 0.0); starts[n + 1]];
        edges.filter(inner).for_each(|(a, b, weight)| {
            for (from, to) in [(a, b), (b, a)] {
                let at = &mut starts[from as usize + 1];
                links[*at] = (to, weight);
                *at += 1;
            }
        });
        starts.pop();
        let (mut seen, mut end, mut first) = (vec![usize::MAX; n], 0, 0);
        for vertex in 0..n {
            let (begin, last) = (end, starts[vertex + 1]);
            for i in first..last {
                let (to, weight) = links[i];
                let at = seen[to as usize];
                if at < end && at >= begin {
                    links[at].1 += weight;
                } else {
                    seen[to as usize] = end;
                    links[end] = (to, weight);
                    end += 1;
                }
            }
            (first, starts[vertex + 1]) = (last, end);
        }
        links.truncate(end);
        links.shrink_to_fit();
        Self { names, starts, links, ground }
    }

    fn links(&self, vertex: usize) -> &[(u32, f64)] {
        &self.links[self.starts[vertex]..self.starts[vertex + 1]]
    }
}

/// Numbers from 0 to 1 in a fixed order, by the generator splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
