//! Runs of another group by another method, on the same surface.

use approx::assert_relative_eq;

use oracles::published::{NODES, Rand, runs, surface};

#[test]
fn the_generator_is_that_of_the_gnu_c_library() {
    let mut random = Rand::new(1);
    assert_eq!([(); 3].map(|()| random.draw()), [1_804_289_383, 846_930_886, 1_681_692_777]);
}

#[test]
fn published_runs_are_near_on_a_coarse_grid() {
    let heights = surface(512).unwrap();
    let statistics = heights.statistics();
    assert_relative_eq!(statistics.rms_height, 0.01, max_relative = 1e-3);
    // four times fewer nodes along a side, which the shortest waves feel
    for k in [1, 12] {
        let run = runs().nth(k).unwrap();
        let found = run.by_a_hard_wall(&heights).unwrap().report;
        assert_relative_eq!(found.mean_gap, run.hard_gap.parse().unwrap(), max_relative = 0.02);
        assert_relative_eq!(found.elastic_energy, run.found[3].parse().unwrap(), max_relative = 0.03);
    }
}

#[test]
#[ignore = "minutes: cargo test --release --test library published:: -- --ignored"]
fn published_runs_agree_to_every_printed_digit() {
    let heights = surface(NODES).unwrap();
    let (least, greatest) = heights.heights().iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &h| (a.min(h), b.max(h)));
    assert!((greatest - least - 0.065_836_7).abs() < 5e-8);
    for k in [0, 12] {
        let run = runs().nth(k).unwrap();
        assert_eq!(run.by_springs(&heights).unwrap(), run.found);
    }
}
