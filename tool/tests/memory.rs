//! The memory of the whole process, with reading and writing.

use std::process::Stdio;

use wait4::Wait4;

use crate::bench::Bench;

/// The greatest memory of a solve, in bytes, with the default grids and without pictures. The allocator of glibc keeps
/// freed blocks of up to 32 MiB, or as large as it is told.
fn peak(bench: &Bench, size: usize, precision: &str) -> f64 {
    let heights = format!("{size}.npz");
    if !bench.path(&heights).exists() {
        bench.said(&format!("surface --size {size} --k-s 16 --rms-slope 0.1 --quiet --out {heights}"));
    }
    let asked = format!("solve --heights {heights} --mean-pressure 0.01 --tolerance 1e-4 --precision {precision}");
    let mut child = bench
        .command(&format!("{asked} --no-pictures --quiet --force --out o"))
        .env("RAYON_NUM_THREADS", "1")
        .env("MALLOC_MMAP_THRESHOLD_", "1000000")
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let used = child.wait4().unwrap();
    assert!(used.status.success());
    used.rusage.maxrss as f64
}

/// The fields of a solve over what the program takes without them.
fn fields(size: usize) -> [f64; 2] {
    let bench = Bench::new();
    ["f64", "f32"].map(|precision| {
        let width = if precision == "f64" { 8.0 } else { 4.0 };
        (peak(&bench, size, precision) - peak(&bench, 64, precision)) / (width * (size * size) as f64)
    })
}

#[test]
fn a_solve_on_nested_grids_takes_five_fields_of_f64_or_seven_of_f32() {
    let [double, single] = fields(2048);
    assert!(double < 5.3 && single < 7.5, "{double:.2} fields of f64, {single:.2} of f32");
}

/// `cargo test --release -p asperity-tool -- --ignored --nocapture memory`
#[test]
#[ignore = "half a minute"]
fn a_large_solve_takes_no_more() {
    let [double, single] = fields(4096);
    println!("{double:.2} fields of f64, {single:.2} of f32");
    assert!(double < 5.3 && single < 7.3, "{double:.2} fields of f64, {single:.2} of f32");
}
