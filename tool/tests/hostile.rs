//! Files and arguments made to break the readers and the tool: no panic, bounded memory, one line of error.
//!
//! `HOSTILE_SECONDS=600 cargo test --release --test tool hostile:: -- --ignored --nocapture` runs for ten minutes,
//! `HOSTILE_FIRST` says from which seed on. Whatever the seed, it is tried alone with `HOSTILE_FIRST=seed
//! HOSTILE_SECONDS=0`.

#[cfg(unix)]
mod files;
#[cfg(unix)]
mod outputs;
#[cfg(unix)]
mod tool;

use std::fs;
use std::io::{Cursor, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use asperity::Grid;
use asperity_maps::io::{read_field, read_fourier};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// The bytes that the reader may allocate at once: its result, its buffers, the windows of the decompression, and an
/// error.
fn allowed(bytes: usize, values: usize) -> u64 {
    // room is made, if not used, for the most entries that a zip file can claim, 2¹⁶ of 216 bytes;
    // twice for an array in Fortran's order, and half as much again for how the vector of a text grows
    (1 << 24) + 24 * values as u64 + 32 * bytes as u64
}

fn corpus() -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus");
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.iter().map(|path| (path.file_name().unwrap().to_string_lossy().into(), fs::read(path).unwrap())).collect()
}

/// The replacements of numbers in headers.
const NUMBERS: &str = "0 1 -1 2 3L 255 65535 4294967295 9223372036854775807 18446744073709551616 1e999 nan inf \
                       -0.0";

/// The insertions into headers and texts.
const PIECES: [&str; 33] = [
    "'descr': '<f8'",
    "'shape': (",
    ")",
    "'fortran_order': True",
    "|O",
    "<f4",
    ">u8",
    "(((((((((",
    "{'",
    "\n",
    "\r",
    ";",
    ",",
    "#",
    "1e308",
    "1e-400",
    "0x10",
    "\u{feff}",
    "\0",
    "PK\x03\x04",
    "PK\x01\x02",
    "PK\x05\x06",
    "Gwyddion Simple Field 1.0\n",
    "XRes = 4\nYRes = 3\n",
    "XReal = 1e-6\nYReal = 1e-6\n",
    "XYUnits = nm\nZUnits = V\n",
    "# Width: 1 nm\n# Height: 1 nm\n# Value units: m\n",
    "'descr': '<U4', 'fortran_order': False, 'shape': ()",
    "1 1 1\n",
    "GWYPGwyContainer\0",
    "/1/data\0oGwyDataField\0",
    "data\0D\u{7}\0\0\0",
    "xres\0i\u{7f}\u{7f}\u{7f}\u{7f}",
];

/// One or more changes to a file of the corpus, or something made from nothing.
fn mutated(random: &mut ChaCha8Rng, corpus: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut file = corpus[random.random_range(0..corpus.len())].1.clone();
    for _ in 0..random.random_range(1..6) {
        let length = file.len();
        let at = random.random_range(0..=length);
        let end = (at + random.random_range(0..32)).min(length);
        match random.random_range(0..14) {
            0 | 1 if length > 0 => file[at.min(length - 1)] ^= 1 << random.random_range(0..8),
            2 if length > 0 => file[at.min(length - 1)] = random.random_range(0..=255),
            3 => file.truncate(at),
            4 => drop(file.drain(at..end)),
            5 => {
                let piece = file[at..end].to_vec();
                let to = random.random_range(0..=length);
                file.splice(to..to, piece);
            }
            6 => {
                let piece = PIECES[random.random_range(0..PIECES.len())].bytes();
                file.splice(at..at, piece);
            }
            // lengths and offsets of headers
            7 if length > 8 => {
                let at = at.min(length - 4);
                let claims = [0, 1, 0xff, 0xffff, 0x7fff_ffff, 0xffff_fffe, u32::MAX, length as u32, 1 << 24];
                file[at..at + 4].copy_from_slice(&claims[random.random_range(0..claims.len())].to_le_bytes());
            }
            8 => {
                // a number becomes another
                if let Some(start) = (at..length).find(|&i| file[i].is_ascii_digit()) {
                    let end = (start..length).find(|&i| !file[i].is_ascii_digit()).unwrap_or(length);
                    let numbers: Vec<_> = NUMBERS.split_whitespace().collect();
                    file.splice(start..end, numbers[random.random_range(0..numbers.len())].bytes());
                }
            }
            9 => {
                let bytes: Vec<u8> = (0..random.random_range(0..300)).map(|_| random.random_range(0..=255)).collect();
                file.splice(at..end, bytes);
            }
            10 => {
                let nested = PIECES[random.random_range(0..PIECES.len())].repeat(random.random_range(1..2000));
                file.splice(at..at, nested.bytes());
            }
            11 => {
                let other = &corpus[random.random_range(0..corpus.len())].1;
                let from = random.random_range(0..=other.len());
                file.truncate(at);
                file.extend_from_slice(&other[from..]);
            }
            // an array that was damaged before it was packed
            12 => {
                let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
                let methods = [zip::CompressionMethod::Stored, zip::CompressionMethod::Deflated];
                let options = zip::write::SimpleFileOptions::default();
                let options = options.compression_method(methods[random.random_range(0..2)]);
                zip.start_file("heights.npy", options).unwrap();
                zip.write_all(&file).unwrap();
                file = zip.finish().unwrap().into_inner();
            }
            _ => {
                let letters = b"0123456789.,;-+eE \t\n\r#%nainf";
                let text = (0..random.random_range(0..200)).map(|_| letters[random.random_range(0..letters.len())]);
                file.splice(at..end, text.collect::<Vec<_>>());
            }
        }
    }
    file.truncate(1 << 16);
    file
}

/// Reads it, and says what is wrong with how that went.
fn wrong(path: &Path, bytes: &[u8]) -> Option<String> {
    fs::write(path, bytes).unwrap();
    let mut result = None;
    let read = || match path.ends_with("waves") {
        true => read_fourier(path, Grid::square(8, 1.0)?, 1.0).map(|surface| surface.heights().clone()),
        false => read_field(path),
    };
    let memory = allocation_counter::measure(|| result = catch_unwind(AssertUnwindSafe(read)).ok());
    let Some(result) = result else { return Some("panic".into()) };
    let values = match &result {
        Ok(field) => field.len(),
        Err(error) => {
            let text = error.to_string();
            if text.lines().count() != 1 || text.chars().any(char::is_control) || text.len() > 4000 {
                return Some(format!("error {text:?}"));
            }
            0
        }
    };
    let most = allowed(bytes.len(), values);
    if memory.bytes_max > most {
        return Some(format!("{} bytes of memory for {} of file, {values} values", memory.bytes_max, bytes.len()));
    }
    // deflate packs a thousandfold at best
    (values > 1032 * bytes.len()).then(|| format!("{values} values from {} bytes", bytes.len()))
}

fn attack(seeds: impl Iterator<Item = u64>, until: impl Fn() -> bool) -> u64 {
    let (corpus, folder) = (corpus(), tempfile::tempdir().unwrap());
    assert!(corpus.len() >= 10);
    let [path, points, waves] = ["heights", "heights.xyz", "waves"].map(|name| folder.path().join(name));
    let (mut count, mut found) = (0, Vec::new());
    for seed in seeds {
        let bytes = mutated(&mut ChaCha8Rng::seed_from_u64(seed), &corpus);
        // the formats that go by the name of the file
        let path = match seed % 8 {
            0 | 4 => &points,
            1 => &waves,
            _ => &path,
        };
        if let Some(wrong) = wrong(path, &bytes) {
            found.push(format!("seed {seed}: {wrong}"));
        }
        count += 1;
        if until() || found.len() > 20 {
            break;
        }
    }
    assert!(found.is_empty(), "of {count} files: {found:#?}");
    count
}

#[test]
fn the_corpus_is_read_or_refused_as_its_names_say() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in corpus() {
        let path = folder.path().join(&name);
        assert_eq!(wrong(&path, &bytes), None, "{name}");
        assert_eq!(read_field(&path).is_ok(), !name.starts_with("bad-"), "{name}");
    }
}

#[test]
fn damaged_files_are_refused_without_panic_and_in_little_memory() {
    attack(0..6000, || false);
}

#[test]
#[ignore = "runs for HOSTILE_SECONDS, ten minutes unless told"]
fn damaged_files_for_ten_minutes() {
    let number = |name: &str, default| std::env::var(name).map_or(default, |value| value.parse().unwrap());
    let (first, seconds) = (number("HOSTILE_FIRST", 6000), number("HOSTILE_SECONDS", 600));
    let start = Instant::now();
    let count = attack(first.., || start.elapsed() >= Duration::from_secs(seconds));
    println!("{count} files from seed {first} on, none of them wrong");
}
