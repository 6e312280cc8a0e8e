//! The tally of a state.

use super::{Fields, count};
use crate::field::{CHUNK, Field, Minimum, found, read};
use crate::par::Parts;
use crate::real::Real;
use crate::solver::potential::Potential;
use crate::vector::sums;

found! {
    /// The sums over the nodes of a state, on which the driver decides.
    #[derive(Default)]
    pub(in crate::solver) struct Tally {
        /// the number of nodes apart, and of those that yield
        pub(in crate::solver) free: f64,
        /// Σ r over these nodes
        pub(in crate::solver) sum_r: f64,
        /// the least r where the surfaces touch and do not yield
        pub(in crate::solver) min_r: Minimum,
        pub(in crate::solver) sum_gap: f64,
        /// Σ g·p
        pub(in crate::solver) sum_gp: f64,
        /// the number of nodes in contact
        pub(in crate::solver) contact: f64,
        /// Σ φ' of the law
        pub(in crate::solver) traction: f64,
        /// Σ φ of the law
        pub(in crate::solver) adhesive: f64,
        /// Σ of the constraint's energy
        pub(in crate::solver) penalty: f64,
    }
}

impl Tally {
    pub(in crate::solver) fn shift(&mut self, by: f64) {
        self.sum_r += by * self.free;
        self.min_r.0 += by;
    }
}

found! {
    /// A tally with two more sums.
    pub(in crate::solver) struct FullTally {
        pub(in crate::solver) tally: Tally,
        /// Σ g·K⁻¹h
        pub(in crate::solver) gap_surface: f64,
        /// Σ p
        pub(in crate::solver) sum_p: f64,
    }
}

/// The tally of a chunk by its gap, pressure and traction.
fn tally_of<T: Real>(touching: T, offset: T, gap: &[T], pressure: &[T], traction: &[T]) -> Tally {
    sums!([gap, pressure, traction], [], |i| {
        let (g, p) = (gap[i], pressure[i]);
        let r = (p + traction[i] + offset).widen();
        let touches = g == touching;
        let free = count(!touches);
    } => Tally {
        free: free, sum_r: if touches { 0.0 } else { r }, sum_gap: g.widen(), sum_gp: g.widen() * p.widen(),
        contact: 1.0 - free; least min_r: if touches { r } else { f64::INFINITY }
    })
}

/// As `tally_of`; writes the local tractions, if there are any.
pub(super) fn tally_chunk<T: Real>(
    local: &Potential<'_, T>,
    offset: T,
    first: usize,
    (gap, pressure): (&[T], &[T]),
    tractions: &mut [T],
) -> Tally {
    let touching = local.touching();
    if local.is_zero() {
        return tally_of(touching, offset, gap, pressure, tractions);
    }
    let mut buffer = [T::zero(); CHUNK];
    let values = &mut buffer[..gap.len()];
    local.energies_and_tractions(first, gap, values, tractions);
    let mut tally = tally_of(touching, offset, gap, pressure, tractions);
    let sum = |values: &[T]| sums!([values], [], |i| values[i].widen());
    tally.adhesive = sum(values);
    if !local.is_soft() && !local.is_capped() {
        tally.traction = sum(tractions);
    } else {
        local.attractions(first, gap, tractions, values);
        tally.traction = sum(values);
        let pressed = local.pressed(first, gap, tractions);
        (tally.contact, tally.penalty) = (pressed.nodes, pressed.energy);
    }
    tally
}

pub(in crate::solver) fn tally<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    offset: T,
    surface: &Field<T>,
) -> FullTally {
    let Fields { reducer, least_r, gap, pressure, .. } = fields;
    let chunks = read(gap).zip(read(pressure)).zip(read(surface));
    let total = local.run(reducer, chunks, |local, first, ((gap, pressure), surface)| {
        let mut tractions = [T::zero(); CHUNK];
        let tally = tally_chunk(local, offset, first, (gap, pressure), &mut tractions[..gap.len()]);
        let more = sums!([gap, pressure, surface], [], |i| {} => FullTally {
            gap_surface: gap[i].widen() * surface[i].widen(), sum_p: pressure[i].widen()
        });
        FullTally { tally, ..more }
    });
    reducer.keep(|taken: FullTally| taken.tally.min_r.0, least_r);
    total
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Grid;
    use crate::{NoAdhesion, Projection};

    /// A number of 24 bits for each node, which `f32` holds exactly.
    fn bits(node: usize, seed: u64) -> i64 {
        let mut x = (node as u64 ^ seed << 40).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        x = (x ^ x >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        (x >> 40) as i64
    }

    /// Sums over n² nodes against sums of integers. Runs of 256 chunks of 256 nodes leave less than 3·256 roundings.
    fn sums_are_accurate(n: usize) {
        const UNIT: f64 = 1.0 / (1 << 24) as f64;
        let gap = |i: usize| if i.is_multiple_of(3) { 0 } else { bits(i, 1) };
        let pressure = |i: usize| bits(i, 2) - (1 << 22);
        let surface = |i: usize| bits(i, 3) - (1 << 21);
        let field =
            |value: &dyn Fn(usize) -> i64| Field::from_fn((n, n), |(i, j)| (value(n * i + j) as f64 * UNIT) as f32);
        let mut fields = Fields::<_, f32>::new(&Grid::square(n, 1.0).unwrap(), field(&gap), field(&pressure));
        let nothing = Potential::new(&NoAdhesion, &Projection, None);
        let FullTally { tally, gap_surface, sum_p } = tally(&mut fields, &nothing, 0.0, &field(&surface));
        let [mut free, mut sum_r, mut sum_gap, mut sum_gp, mut sum_gh, mut all] = [0_i128; 6];
        for i in 0..n * n {
            let [g, p, h] = [gap(i), pressure(i), surface(i)].map(i128::from);
            if g > 0 {
                (free, sum_r) = (free + 1, sum_r + p);
            }
            (sum_gap, sum_gp, sum_gh, all) = (sum_gap + g, sum_gp + g * p, sum_gh + g * h, all + p);
        }
        assert_eq!((tally.free, tally.contact), (free as f64, (n * n) as f64 - free as f64));
        for (found, exact, unit) in [
            (tally.sum_r, sum_r, UNIT),
            (tally.sum_gap, sum_gap, UNIT),
            (tally.sum_gp, sum_gp, UNIT * UNIT),
            (gap_surface, sum_gh, UNIT * UNIT),
            (sum_p, all, UNIT),
        ] {
            let exact = exact as f64 * unit;
            assert!((found - exact).abs() <= 768.0 * f64::EPSILON * exact.abs(), "{found:e} is not {exact:e}");
        }
    }

    #[test]
    fn sums_of_f32_are_accurate() {
        sums_are_accurate(1);
        sums_are_accurate(700);
    }

    #[test]
    #[ignore = "7 GB: cargo test --release --test units_of_library sums_of_f32 -- --ignored"]
    fn sums_of_f32_are_accurate_over_16384_by_16384_nodes() {
        sums_are_accurate(16384);
    }
}
