//! Tables: lines and the rows that they were, and the journal after kills, changes and locks of its files.

use std::fs;
use std::path::Path;

use asperity_scene::csv::{header, line, names, parsed};
use asperity_scene::journal::{Journal, Row, state_path};
use asperity_scene::output::with_suffix;
use asperity_scene::{Identity, Outcome};
use serde_json::{Value, json};

const HEADER: &str = "load,answer\n";
const LOADS: [f64; 3] = [1.0, 2.0, 3.0];

fn identity(modulus: &str) -> Identity {
    let Value::Object(identity) = json!({ "shape": "2 1", "modulus": modulus, "heights": "0123" }) else { panic!() };
    identity
}

fn open(path: &Path, loads: &[f64]) -> Outcome<(Journal, Vec<u8>)> {
    Journal::open(path, HEADER, identity("1"), Some(loads), (false, false))
}

/// A sweep with answers that depend on the two loads and answers before, killed after so many rows.
fn sweep(path: &Path, loads: &[f64], killed: usize) -> Outcome<String> {
    let (mut journal, mut place) = open(path, loads)?;
    for &load in &loads[journal.written().rows..killed] {
        let sum = place.chunks(2).fold(0.0, |sum, two| sum + f64::from(two[0]) + 2.0 * f64::from(two[1]));
        place.extend([load as u8, sum as u8]);
        place.drain(..place.len().saturating_sub(4));
        let text = format!("{load},{sum}");
        journal.append(Row { text: &text, load, converged: load != 2.0, place: Some(place.clone()) })?;
    }
    assert_eq!(journal.written().unconverged, usize::from(journal.written().rows > 1));
    Ok(fs::read_to_string(path)?)
}

fn reason(result: Outcome<impl std::fmt::Debug>) -> String {
    result.unwrap_err().to_string()
}

#[test]
fn a_sweep_killed_anywhere_ends_as_one_that_was_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("new/sweep.csv");
    let whole = sweep(&path, &LOADS, 3).unwrap();
    assert_eq!(whole, "load,answer\n1,0\n2,1\n3,5\n");
    assert_eq!(sweep(&path, &LOADS, 3).unwrap(), whole);
    let rows: Vec<usize> = (0..whole.len()).filter(|&i| whole.as_bytes()[i] == b'\n').map(|i| i + 1).collect();
    for killed in 0..=3 {
        // all that an interrupted write of the next row may leave
        let (from, to) = match killed {
            0 => (0, rows[1]),
            3 => (whole.len(), whole.len()),
            k => (rows[k], rows[k + 1]),
        };
        for length in from..=to {
            let path = folder.path().join(format!("{killed}-{length}.csv"));
            sweep(&path, &LOADS, killed).unwrap();
            fs::write(&path, &whole[..length]).unwrap();
            fs::write(with_suffix(&path, ".state.tmp"), "half of it").unwrap();
            assert_eq!(sweep(&path, &LOADS, 3).unwrap(), whole, "{killed} {length}");
        }
    }
}

#[test]
fn a_sweep_can_be_made_longer_but_not_another() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sweep.csv");
    sweep(&path, &LOADS[..2], 2).unwrap();
    let whole = sweep(&path, &LOADS, 3).unwrap();
    assert!(reason(sweep(&path, &LOADS[..2], 2)).contains("loads are others"));
    assert!(reason(sweep(&path, &[1.0, 2.5, 3.0], 3)).contains("loads are others"));
    let other = |modulus, force| Journal::open(&path, HEADER, identity(modulus), Some(&LOADS), (force, false));
    let refused = reason(other("2", false));
    assert!(["modulus is 1, and not 2", "--force"].iter().all(|part| refused.contains(part)), "{refused}");
    assert_eq!(fs::read_to_string(&path).unwrap(), whole);
    assert_eq!(other("2", true).unwrap().0.written().rows, 0);
    assert_eq!(fs::read_to_string(&path).unwrap(), "");
    assert!(reason(open(&path, &LOADS)).contains("modulus is 2, and not 1"));
}

#[test]
fn files_that_were_changed_are_refused_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sweep.csv");
    let whole = sweep(&path, &LOADS, 3).unwrap();
    let partly = folder.path().join("partly.csv");
    sweep(&partly, &LOADS, 0).unwrap();
    for (path, content) in [
        (&path, whole.replace("2,1", "2,7")),
        (&path, whole.replace("2,1\n", "")),
        (&path, String::new()),
        (&path, format!("{whole}4,5\n5,6\n")),
        (&path, format!("{whole}4,5\n5")),
        (&partly, "a note\n".to_owned()),
        (&partly, "a note\n".to_owned() + &whole),
        (&partly, whole.clone()),
    ] {
        fs::write(path, &content).unwrap();
        assert!(reason(open(path, &LOADS)).contains("was changed"), "{content}");
        assert_eq!(fs::read_to_string(path).unwrap(), content);
    }
    fs::write(&path, &whole).unwrap();
    let state = fs::read(state_path(&path)).unwrap();
    for length in 0..state.len() {
        fs::write(state_path(&path), &state[..length]).unwrap();
        assert!(reason(open(&path, &LOADS)).contains("is damaged"));
    }
    for at in 0..state.len() {
        let mut state = state.clone();
        state[at] ^= 0x15;
        fs::write(state_path(&path), state).unwrap();
        assert!(reason(open(&path, &LOADS)).contains("is damaged"), "{at}");
        assert_eq!(fs::read_to_string(&path).unwrap(), whole);
    }
    fs::remove_file(state_path(&path)).unwrap();
    let refused = reason(open(&path, &LOADS));
    assert!(["sweep.csv.state", "does not", "--force"].iter().all(|part| refused.contains(part)), "{refused}");
    // the state that versions before wrote
    fs::write(with_suffix(&path, ".state.npz"), "PK").unwrap();
    let refused = reason(open(&path, &LOADS));
    assert!(["earlier version", "--force"].iter().all(|part| refused.contains(part)), "{refused}");
    assert_eq!(fs::read_to_string(&path).unwrap(), whole);
    assert!(reason(open(folder.path(), &LOADS)).contains("not a regular file"));
}

#[test]
fn two_sweeps_do_not_write_into_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sweep.csv");
    let (mut first, _) = open(&path, &LOADS).unwrap();
    for force in [false, true] {
        let second = Journal::open(&path, HEADER, identity("1"), Some(&LOADS), (force, false));
        assert!(reason(second).contains("sweep.csv: another run is writing there"));
    }
    let row = |text, load| Row { text, load, converged: true, place: Some(vec![1]) };
    first.append(row("1,0", 1.0)).unwrap();
    assert_eq!(first.text().unwrap(), "load,answer\n1,0\n");
    // what knows nothing of the lock
    for changed in ["load,answer\n", ""] {
        fs::write(&path, changed).unwrap();
        assert!(reason(first.append(row("2,1", 2.0))).contains("another program"));
        assert_eq!(fs::read_to_string(&path).unwrap(), changed);
    }
    fs::remove_file(&path).unwrap();
    assert!(reason(first.append(row("2,1", 2.0))).contains("cannot be written"));
    drop(first);
    assert_eq!(open(&path, &LOADS).unwrap().0.written().rows, 0);
}

#[test]
fn a_line_says_what_its_row_was() {
    let row = json!({ "a": 1.5, "b": "none", "c": null, "d": "one, \"two\".npy", "e": true, "f": "7, 8" });
    let line = line(row.as_object().unwrap());
    assert_eq!(line, "1.5,none,,\"one, \"\"two\"\".npy\",true,\"7, 8\"");
    assert_eq!(parsed(&["a", "b", "c", "d", "e", "f"], &line), row);
    assert_eq!(parsed(&["a", "b", "c"], "1"), json!({ "a": 1 }));
    // nothing that a spreadsheet computes, and no word that becomes a number or nothing
    for text in ["=1+1", "+5", "-x", "@a", "7", "true", "null", "", "a,b", "\"", "1e-3", "none", "a = b"] {
        let row = json!({ "a": text, "b": 1 });
        let line = asperity_scene::csv::line(row.as_object().unwrap());
        assert_eq!(parsed(&["a", "b"], &line), row);
        assert_eq!(line.starts_with('"'), !["none", "a = b"].contains(&text), "{line}");
    }
}

#[test]
fn a_header_says_what_its_names_were() {
    let all = ["case", "mean_gap [m, or so]", "say \"nm\""];
    let line = header(all);
    assert_eq!(line, "case,\"mean_gap [m, or so]\",\"say \"\"nm\"\"\"");
    assert_eq!(names(&line), all);
}
