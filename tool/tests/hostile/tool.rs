//! The tool in a folder of its own, with a limit of virtual memory, of the size of files, and of time.

use std::process::{Command, Output, Stdio};
use std::thread::sleep;

use asperity::Surface;
use asperity_maps::io::write_npy;

use super::*;

pub const GIGABYTE: u64 = 1 << 20;

pub fn bench(n: usize) -> tempfile::TempDir {
    let bench = tempfile::tempdir().unwrap();
    let surface = Surface::wave_2d(Grid::square(n, 1.0).unwrap(), 0.042, 1).unwrap();
    write_npy(bench.path().join("heights.npy"), surface.heights()).unwrap();
    bench
}

/// Runs the tool with this much memory in kB, and files of no more than so many blocks of 512 bytes.
pub fn limited(folder: &Path, memory: u64, blocks: &str, arguments: &[String]) -> Output {
    Command::new("sh")
        .current_dir(folder)
        .args(["-c", "trap '' XFSZ; ulimit -v $1; ulimit -f $2; shift 2; exec \"$@\"", "sh"])
        .args([memory.to_string().as_str(), blocks, "timeout", "60", env!("CARGO_BIN_EXE_asperity")])
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

pub fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

pub fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Ended by itself, with one line where it refused, after warnings if there are any.
#[track_caller]
pub fn assert_orderly(output: &Output, what: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(matches!(output.status.code(), Some(0..=2)), "{what}: {:?} {said}", output.status);
    if output.status.code() == Some(1) {
        // help is printed where no command is given
        let lines = said.lines().filter(|line| !line.starts_with("warning: ")).count();
        assert!(lines == 1 || said.contains("Usage:"), "{what}: {said}");
    }
}

const COMMANDS: [&str; 7] = [
    "solve --heights heights.npy --mean-gap 0.0398",
    "solve --heights heights.npy --mean-pressure 1e-3 --no-pictures",
    "sweep --heights heights.npy --mean-gaps 0.04:0.03:3",
    "surface --size 16 --rms-slope 0.1 --k-s 6",
    "stats heights.npy",
    "prepare heights.npy --detrend plane --fill --window 0.2",
    "prepare heights.npy --crop 1 2 9 8 --mirror --resample 20 30",
];

const OPTIONS: &str = "--heights --lengths --modulus --law --work-of-adhesion --range --method --tolerance --max-iterations \
                       --precision --threads --initial-gap --out --force --quiet --no-pictures --mean-gap --mean-pressure \
                       --mean-gaps --mean-pressures --size --shape --rms-height --rms-slope --hurst --k-l --k-r --k-s \
                       --seed --psd --random-phase --scale --unit --crop --flip --missing --align-rows --scan-axis \
                       --despike --remove-form --channel --detrend --mirror --window --resample --format -- --help -";

const VALUES: [&str; 36] = [
    "0",
    "-0",
    "1",
    "-1",
    "1e-300",
    "1e300",
    "1e999",
    "-1e-12",
    "nan",
    "inf",
    "-inf",
    "0x10",
    "",
    " ",
    "none",
    "exponential",
    "maugis-dugdale",
    "rey2017",
    "f32",
    "f64",
    "heights.npy",
    "nothing.npy",
    ".",
    "..",
    "/",
    "/dev/null",
    "/dev/zero",
    "new/out",
    "1:2:3",
    "1:2:100000000",
    "1:1e300:5:log",
    ",,,",
    "9999999999",
    "99999999999999999999999",
    "é\u{301}",
    "\n\u{1b}[31m",
];

/// One of the options.
fn chosen(random: &mut ChaCha8Rng) -> &'static str {
    let all: Vec<_> = OPTIONS.split_whitespace().collect();
    all[random.random_range(0..all.len())]
}

#[test]
fn no_arguments_break_the_tool() {
    let bench = bench(16);
    for seed in 0..300 {
        let random = &mut ChaCha8Rng::seed_from_u64(seed);
        let mut arguments = words(COMMANDS[random.random_range(0..COMMANDS.len())]);
        for _ in 0..random.random_range(0..4) {
            let value = VALUES[random.random_range(0..VALUES.len())].to_owned();
            let at = random.random_range(1..=arguments.len());
            match random.random_range(0..4) {
                0 => drop(arguments.remove(at.min(arguments.len() - 1))),
                1 => arguments.insert(at, value),
                2 => *arguments.last_mut().unwrap() = value,
                _ => arguments.extend([chosen(random).to_owned(), value]),
            }
        }
        if !arguments.iter().any(|a| a == "--out") && random.random_bool(0.9) {
            arguments.extend(words("--out out --force"));
        }
        let output = limited(bench.path(), 4 * GIGABYTE, "200000", &arguments);
        assert_orderly(&output, &format!("seed {seed}: {arguments:?}"));
    }
}

#[test]
fn no_scenes_break_the_tool() {
    let bench = bench(16);
    for seed in 0..200 {
        let random = &mut ChaCha8Rng::seed_from_u64(seed);
        let mut scene =
            ["command = \"solve\"\nheights = \"heights.npy\"\nmean-gap = 0.0398\n", "command = \"sweep\"\n", ""]
                [random.random_range(0..3)]
            .to_owned();
        for _ in 0..random.random_range(0..4) {
            let value = VALUES[random.random_range(0..VALUES.len())];
            let key = chosen(random).trim_start_matches("--");
            scene.push_str(&match random.random_range(0..6) {
                0 => format!("{key} = {value}\n"),
                1 => format!("{key} = [{value:?}, {value:?}]\n"),
                2 => format!("[{key}]\n"),
                3 => format!("{value:?} = true\n"),
                4 => value.to_owned(),
                _ => format!("{key} = {value:?}\n"),
            });
        }
        std::fs::write(bench.path().join("scene.toml"), &scene).unwrap();
        let out = if random.random_bool(0.9) { "--out out --force" } else { "--json" };
        let output = limited(bench.path(), 4 * GIGABYTE, "200000", &words(&format!("run scene.toml {out}")));
        assert_orderly(&output, &format!("seed {seed}: {scene}"));
    }
}

#[test]
fn sizes_beyond_the_memory_are_refused() {
    let bench = bench(16);
    for size in ["--size 9999999", "--shape 9999999999 1", "--shape 4294967296 4294967296", "--size 100000"] {
        let arguments = words(&format!("surface {size} --rms-slope 0.1 --out big.npy"));
        let output = limited(bench.path(), 2 * GIGABYTE, "unlimited", &arguments);
        assert_orderly(&output, size);
        assert_eq!(output.status.code(), Some(1));
    }
    assert_eq!(names(bench.path()), ["heights.npy"]);
}

#[test]
fn small_files_take_little_memory() {
    let bench = bench(16);
    for (name, bytes) in corpus() {
        fs::write(bench.path().join(&name), bytes).unwrap();
        for command in [
            format!("stats {name}"),
            format!("solve --heights {name} --mean-gap 0.1 --out out --force"),
            format!("prepare {name} --detrend quadric --fill --mirror --resample 6 8 --out out.npz --force"),
        ] {
            let output = limited(
                bench.path(),
                GIGABYTE / 2,
                "200000",
                &words(&if command.starts_with("prepare") {
                    command.clone()
                } else {
                    format!("{command} --threads 1")
                }),
            );
            assert_orderly(&output, &command);
        }
    }
}

#[test]
fn a_solve_that_is_killed_shows_all_of_its_results_or_none() {
    let bench = bench(128);
    let fields = ["contact_pressure.npy", "gap.npy", "pressure.npy"];
    let whole = [&["contact.png"], &fields[..], &["pressure.png", "report.json", "scene.toml"]].concat();
    let mut finished = 0;
    for delay in 0..40 {
        let mut child = Command::new(env!("CARGO_BIN_EXE_asperity"))
            .current_dir(bench.path())
            .args(words("solve --heights heights.npy --mean-gap 0.0398 --quiet --out results"))
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        sleep(Duration::from_millis(3 * delay));
        let _ = child.kill();
        child.wait().unwrap();
        let results = bench.path().join("results");
        if results.exists() {
            assert_eq!(names(&results), whole);
            for name in whole.iter().filter(|name| name.ends_with(".npy")) {
                assert_eq!(read_field(results.join(name)).unwrap().dim(), (128, 128));
            }
            fs::remove_dir_all(results).unwrap();
            finished += 1;
        }
    }
    assert!(finished < 40, "none was killed in time");
    // what is left behind is hidden, and in the way of nothing
    assert!(names(bench.path()).iter().all(|name| name == "heights.npy" || name.starts_with(".asperity-")));
}
