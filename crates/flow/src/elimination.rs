//! Approximate elimination of the pressures: a preconditioner for networks of any contrast.

use crate::network::{NONE, Network};

/// The degrees from this one on share a queue.
const DEGREES: usize = 32;

/// An approximate Cholesky factorisation of the matrix of a network, by elimination of one vertex after the other.
///
/// Without a vertex its d neighbours are a clique of d(d − 1)/2 edges, w_i w_j/Σw each. In its place stand d − 1 edges
/// that are drawn at random such that the mean is the clique: each neighbour, from the least weight on, gets an edge to one
/// of those after it, drawn by their weights. The factor stays as sparse as the matrix, and its quality hardly depends on
/// the contrast: R. Kyng, S. Sachdeva, FOCS 2016, 573; Y. Gao, R. Kyng, D. A. Spielman, arXiv:2303.00709 (2023). The
/// vertices go by their degrees, the least first. Chains and trees are eliminated exactly.
pub(crate) struct Elimination {
    /// The vertices in the order of their elimination.
    order: Vec<u32>,
    /// The sum of the weights of each at its elimination.
    pivots: Vec<f64>,
    /// Where the column of each begins.
    starts: Vec<usize>,
    /// The places in the order, and the shares of the weight, of the neighbours of each at its elimination.
    rows: Vec<u32>,
    shares: Vec<f64>,
}

impl Elimination {
    /// The factorisation of a network.
    pub fn new(network: &Network) -> Self {
        let n = network.ground();
        let mut graph = Graph::new(n, network);
        let mut random = Random(0);
        let mut made = Self {
            order: Vec::with_capacity(n),
            pivots: Vec::with_capacity(n),
            starts: vec![0],
            rows: Vec::with_capacity(4 * n),
            shares: Vec::with_capacity(4 * n),
        };
        let (mut star, mut after) = (Vec::new(), Vec::new());
        while let Some(vertex) = graph.queue.pop() {
            graph.take(vertex, &mut star);
            let pivot: f64 = star.iter().map(|(_, weight)| weight).sum();
            made.order.push(vertex as u32);
            made.pivots.push(pivot);
            for (to, weight) in star.iter().filter(|(to, _)| *to as usize != n) {
                made.rows.push(*to);
                made.shares.push(weight / pivot);
            }
            made.starts.push(made.rows.len());
            star.sort_unstable_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            // the sum of the weights from each neighbour on
            after.clear();
            after.resize(star.len() + 1, 0.0);
            (0..star.len()).rev().for_each(|i| after[i] = after[i + 1] + star[i].1);
            for (i, (from, weight)) in star.iter().enumerate().take(star.len().saturating_sub(1)) {
                let drawn = random.next() * after[i + 1];
                let to = i + after[i + 1..star.len()].partition_point(|rest| *rest > drawn).max(1);
                graph.connect(*from, star[to].0, weight * after[i + 1] / pivot);
            }
        }
        let mut place = vec![0; n];
        made.order.iter().enumerate().for_each(|(k, vertex)| place[*vertex as usize] = k as u32);
        made.rows.iter_mut().for_each(|row| *row = place[*row as usize]);
        made
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
            // the last vertex of a network without ground has no neighbour: its pressure is zero
            let own = if self.pivots[k] > 0.0 { work[k] / self.pivots[k] } else { 0.0 };
            work[k] = column(k).fold(own, |sum, i| sum + self.shares[i] * work[self.rows[i] as usize]);
        }
        work.iter().zip(&self.order).for_each(|(work, vertex)| pressures[*vertex as usize] = *work);
    }
}

/// The edges of the vertices that are left, each in the lists of both of its ends.
struct Graph {
    ends: Vec<End>,
    first: Vec<u32>,
    unused: u32,
    queue: Queue,
}

#[derive(Clone, Copy)]
struct End {
    to: u32,
    next: u32,
    weight: f64,
}

impl Graph {
    fn new(n: usize, network: &Network) -> Self {
        let mut degrees = vec![0_u32; n + 1];
        let between = || network.edges.iter().filter(|edge| edge.tail != edge.head);
        between().for_each(|edge| [edge.tail, edge.head].iter().for_each(|end| degrees[*end as usize] += 1));
        degrees.truncate(n);
        let ends = Vec::with_capacity(2 * network.edges.len());
        let mut graph = Self { ends, first: vec![NONE; n], unused: NONE, queue: Queue::new(degrees) };
        for edge in between() {
            graph.push(edge.tail, edge.head, edge.conductance);
            graph.push(edge.head, edge.tail, edge.conductance);
        }
        graph
    }

    /// Puts an edge into the list of one of its ends; the ground has none.
    fn push(&mut self, from: u32, to: u32, weight: f64) {
        let Some(&next) = self.first.get(from as usize) else { return };
        let end = End { to, next, weight };
        self.first[from as usize] = self.unused;
        if let Some(free) = self.ends.get_mut(self.unused as usize) {
            self.unused = free.next;
            *free = end;
        } else {
            self.first[from as usize] = self.ends.len() as u32;
            self.ends.push(end);
        }
    }

    fn connect(&mut self, a: u32, b: u32, weight: f64) {
        self.push(a, b, weight);
        self.push(b, a, weight);
        self.queue.change(a as usize, 1);
        self.queue.change(b as usize, 1);
    }

    /// The neighbours of a vertex that are left, with the weights of the edges there, of which it is taken out.
    fn take(&mut self, vertex: usize, star: &mut Vec<(u32, f64)>) {
        star.clear();
        let mut at = self.first[vertex];
        while let Some(&End { to, next, weight }) = self.ends.get(at as usize) {
            if !self.queue.is_gone(to as usize) {
                star.push((to, weight));
                self.queue.change(to as usize, -1);
            }
            self.ends[at as usize].next = self.unused;
            self.unused = at;
            at = next;
        }
        star.sort_unstable_by_key(|(to, _)| *to);
        star.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            kept.1 += if same { next.1 } else { 0.0 };
            same
        });
    }
}

/// The vertices that are left, by their degrees.
struct Queue {
    degrees: Vec<u32>,
    first: [u32; DEGREES],
    /// The neighbours in the queue of a degree.
    before: Vec<u32>,
    next: Vec<u32>,
    least: usize,
}

/// The degree of a vertex that was eliminated.
const GONE: u32 = u32::MAX;

impl Queue {
    fn new(degrees: Vec<u32>) -> Self {
        let n = degrees.len();
        let mut queue = Self { degrees, first: [NONE; DEGREES], before: vec![NONE; n], next: vec![NONE; n], least: 0 };
        (0..n).rev().for_each(|vertex| queue.insert(vertex));
        queue
    }

    fn of(degree: u32) -> usize {
        (degree as usize).min(DEGREES - 1)
    }

    fn insert(&mut self, vertex: usize) {
        let queue = Self::of(self.degrees[vertex]);
        let next = self.first[queue];
        (self.before[vertex], self.next[vertex]) = (NONE, next);
        if next != NONE {
            self.before[next as usize] = vertex as u32;
        }
        self.first[queue] = vertex as u32;
        self.least = self.least.min(queue);
    }

    fn remove(&mut self, vertex: usize) {
        let (before, next) = (self.before[vertex], self.next[vertex]);
        match before {
            NONE => self.first[Self::of(self.degrees[vertex])] = next,
            before => self.next[before as usize] = next,
        }
        if next != NONE {
            self.before[next as usize] = before;
        }
    }

    /// A vertex of the least degree, which is gone then.
    fn pop(&mut self) -> Option<usize> {
        while self.first[self.least] == NONE {
            if self.least + 1 == DEGREES {
                return None;
            }
            self.least += 1;
        }
        let vertex = self.first[self.least] as usize;
        self.remove(vertex);
        self.degrees[vertex] = GONE;
        Some(vertex)
    }

    fn is_gone(&self, vertex: usize) -> bool {
        self.degrees.get(vertex) == Some(&GONE)
    }

    /// Changes the degree of a vertex; the ground has none.
    fn change(&mut self, vertex: usize, by: i32) {
        let Some(&degree) = self.degrees.get(vertex) else { return };
        let changed = degree.saturating_add_signed(by);
        if Self::of(degree) == Self::of(changed) {
            self.degrees[vertex] = changed;
        } else {
            self.remove(vertex);
            self.degrees[vertex] = changed;
            self.insert(vertex);
        }
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
