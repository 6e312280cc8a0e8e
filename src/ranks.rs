//! The processes that share a grid: one, or with the feature `mpi` all of an MPI job. The only file that knows MPI.

use std::fmt::Debug;

use asperity_fft::num_complex::{Complex32, Complex64};

#[cfg(feature = "mpi")]
pub(crate) use job::Job;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ranks {
    rank: usize,
    count: usize,
}

/// A value that can be sent to another process.
#[cfg(not(feature = "mpi"))]
pub trait Sent: Copy + Default + Debug + Send + 'static {}

/// A value that can be sent to another process.
#[cfg(feature = "mpi")]
pub trait Sent: Copy + Default + Debug + Send + mpi::datatype::Equivalence + 'static {}

impl Sent for f32 {}
impl Sent for f64 {}
impl Sent for bool {}
impl Sent for u8 {}
impl Sent for u64 {}
impl Sent for usize {}
impl Sent for Complex32 {}
impl Sent for Complex64 {}

/// The most numbers that MPI counts, and thus of a buffer: a grid that would need more is refused.
pub(crate) const COUNTED: usize = i32::MAX as usize;

/// The parts of a buffer, one after the other, that belong to the ranks.
#[derive(Clone, Debug)]
#[cfg_attr(not(feature = "mpi"), expect(dead_code, reason = "one process has nothing to send"))]
pub struct Shares {
    counts: Vec<i32>,
    places: Vec<i32>,
}

impl Shares {
    /// Parts of so many numbers for each rank, [`COUNTED`] at most together.
    pub(crate) fn new(counts: impl Iterator<Item = usize>) -> Self {
        let counts: Vec<i32> = counts.map(|count| count as i32).collect();
        let places = counts.iter().scan(0, |end, count| {
            *end += count;
            Some(*end - count)
        });
        Self { places: places.collect(), counts }
    }
}

impl Ranks {
    pub(crate) const ALONE: Self = Self { rank: 0, count: 1 };

    #[cfg(test)]
    pub(crate) fn of(rank: usize, count: usize) -> Self {
        Self { rank, count }
    }

    pub(crate) fn rank(self) -> usize {
        self.rank
    }

    pub(crate) fn count(self) -> usize {
        self.count
    }

    /// The parts of all ranks, in their order; this rank has `own`.
    pub(crate) fn gather<E: Sent>(self, own: &[E], shares: &Shares, all: &mut [E]) {
        if self.count == 1 {
            all.copy_from_slice(own);
        } else if !all.is_empty() {
            job::gather(own, shares, all);
        }
    }

    /// The value of every rank, in their order.
    pub(crate) fn each<E: Sent>(self, value: E) -> Vec<E> {
        let mut values = vec![value; self.count];
        self.gather(&[value], &Shares::new((0..self.count).map(|_| 1)), &mut values);
        values
    }

    /// The lists of all ranks, one after the other.
    pub(crate) fn lists<E: Sent>(self, own: Vec<E>) -> Vec<E> {
        if self.count == 1 {
            return own;
        }
        let lengths = self.each(own.len());
        let mut all = vec![E::default(); lengths.iter().sum()];
        self.gather(&own, &Shares::new(lengths.into_iter()), &mut all);
        all
    }

    /// Adds the numbers of all ranks to the numbers of this rank.
    pub(crate) fn add_up(self, numbers: &mut [u64]) {
        if self.count > 1 {
            job::add_up(numbers);
        }
    }

    /// Sends a part of `from` to every rank, and receives a part of `into` from every rank.
    pub(crate) fn exchange<E: Sent>(self, from: &[E], sent: &Shares, into: &mut [E], received: &Shares) {
        if self.count == 1 {
            into.copy_from_slice(from);
        } else {
            job::exchange(self.rank, (from, sent), (into, received));
        }
    }
}

/// Without MPI there is one process, which has nothing to send.
#[cfg(not(feature = "mpi"))]
mod job {
    use super::{Sent, Shares};

    pub(super) fn gather<E: Sent>(_: &[E], _: &Shares, _: &mut [E]) {}

    pub(super) fn add_up(_: &mut [u64]) {}

    pub(super) fn exchange<E: Sent>(_: usize, _: (&[E], &Shares), _: (&mut [E], &Shares)) {}
}

#[cfg(feature = "mpi")]
mod job {
    use std::sync::atomic::{AtomicU64, Ordering};

    use mpi::Threading;
    use mpi::collective::SystemOperation;
    use mpi::datatype::{Partition, PartitionMut};
    use mpi::environment::Universe;
    use mpi::topology::SimpleCommunicator;
    use mpi::traits::{Communicator, CommunicatorCollectives};

    use super::{Ranks, Sent, Shares};

    /// The bytes that this process has sent to others in exchanges.
    static BYTES: AtomicU64 = AtomicU64::new(0);

    /// The address of an empty buffer: the address of an empty slice of bytes means something else to MPI.
    fn placed<'a, E>(buffer: &'a [E], somewhere: &'a [E]) -> &'a [E] {
        if buffer.is_empty() { &somewhere[..0] } else { buffer }
    }

    pub(super) fn gather<E: Sent>(own: &[E], shares: &Shares, all: &mut [E]) {
        let somewhere = [E::default()];
        let own = placed(own, &somewhere);
        let mut all = PartitionMut::new(all, &shares.counts[..], &shares.places[..]);
        SimpleCommunicator::world().all_gather_varcount_into(own, &mut all);
    }

    pub(super) fn add_up(numbers: &mut [u64]) {
        let own = numbers.to_vec();
        SimpleCommunicator::world().all_reduce_into(&own[..], numbers, SystemOperation::sum());
    }

    pub(super) fn exchange<E: Sent>(rank: usize, (from, sent): (&[E], &Shares), (into, received): (&mut [E], &Shares)) {
        let counts = sent.counts.iter().enumerate().filter(|&(to, _)| to != rank);
        let numbers: u64 = counts.map(|(_, &count)| count as u64).sum();
        BYTES.fetch_add(numbers * size_of::<E>() as u64, Ordering::Relaxed);
        let (somewhere, mut nowhere) = ([E::default()], [E::default()]);
        let into = if into.is_empty() { &mut nowhere[..0] } else { into };
        let from = Partition::new(placed(from, &somewhere), &sent.counts[..], &sent.places[..]);
        let mut into = PartitionMut::new(into, &received.counts[..], &received.places[..]);
        SimpleCommunicator::world().all_to_all_varcount_into(&from, &mut into);
    }

    /// An MPI job: all processes that `mpiexec` started. MPI ends with it.
    pub struct Job(#[expect(dead_code, reason = "kept, as MPI ends where it is dropped")] Universe);

    impl Job {
        /// Joins the job; nothing if this process has done so before, or if this MPI cannot be called from threads.
        pub(crate) fn start() -> Option<Self> {
            // one call at a time, from whatever thread a solve runs on
            let (universe, threading) = mpi::initialize_with_threading(Threading::Serialized)?;
            (threading >= Threading::Serialized).then_some(Self(universe))
        }

        pub(crate) fn ranks(&self) -> Ranks {
            let world = SimpleCommunicator::world();
            Ranks { rank: world.rank() as usize, count: world.size() as usize }
        }

        pub(crate) fn bytes_sent(&self) -> u64 {
            BYTES.load(Ordering::Relaxed)
        }

        pub(crate) fn abort(&self) -> ! {
            SimpleCommunicator::world().abort(1)
        }
    }
}
