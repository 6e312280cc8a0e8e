//! The same question gets the same answer by the program and by the page: one table of givens, right and wrong, whose
//! reports are the same to the last bit, and whose refusals are the same but for the words of the skin. The tests of the
//! Python package hold the third face to the same table.

use std::fs;
use std::path::Path;

use asperity_scene::{Skin, worded};
use asperity_web::Engine;
use serde::Deserialize;
use serde_json::{Map, Value, json};

use crate::bench::{Bench, text};

/// The folder of the table and its maps.
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../crates/scene/tests/givens");

/// What is different from face to face: the time, and the threads, of which a page has one.
const DIFFERENT: [&str; 1] = ["seconds"];

/// A row of the table.
#[derive(Deserialize)]
struct Row {
    name: String,
    map: String,
    given: Map<String, Value>,
    /// Files besides that of the map, and findings, which a page does not have
    #[serde(default)]
    files: Map<String, Value>,
    /// The refusal, with keys in braces; none where all faces solve
    refused: Option<String>,
    /// The refusals of faces that have words of their own
    #[serde(default)]
    own: Map<String, Value>,
    /// The codes of the warnings
    #[serde(default)]
    warned: Vec<String>,
}

/// A report, or the refusal.
type Answer = Result<Map<String, Value>, String>;

fn text_of(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// The answer of the program.
fn of_program(bench: &Bench, row: &Row) -> Answer {
    let mut command = bench.command("solve --json --threads 1");
    command.args(["--heights", &row.map]);
    for (key, value) in row.given.iter().chain(&row.files) {
        let option = format!("--{}", key.replace('_', "-"));
        match value {
            Value::Bool(true) => command.arg(option),
            Value::Array(all) => command.arg(option).args(all.iter().map(text_of)),
            one => command.arg(format!("{option}={}", text_of(one))),
        };
    }
    let output = command.output().unwrap();
    match output.status.code() {
        Some(1) => {
            Err(text(&output.stderr).trim_start_matches("error: ").trim_end_matches("; see --help\n").trim().to_owned())
        }
        _ => Ok(serde_json::from_slice(&output.stdout).unwrap()),
    }
}

/// The answer of the page.
fn of_page(row: &Row) -> Answer {
    let mut engine = Engine::default();
    engine.open(&row.map, &fs::read(Path::new(FOLDER).join(&row.map)).unwrap(), None, false).unwrap();
    let given = Value::from(row.given.clone()).to_string();
    let answer = engine.solve(&given, false, &mut |_, _, _| {});
    answer.map(|answer| answer["account"].as_object().unwrap().clone()).map_err(|error| error.to_string())
}

#[test]
fn program_and_page_answer_a_given_alike() {
    let bench = Bench::new();
    for entry in fs::read_dir(FOLDER).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, bench.path(path.file_name().unwrap().to_str().unwrap())).unwrap();
    }
    let rows: Vec<Row> = serde_json::from_str(&bench.read("givens.json")).unwrap();
    assert!(rows.len() >= 60);
    let mut unlike = Vec::new();
    for row in &rows {
        let mut faces = vec![("program", Skin::Options, of_program(&bench, row))];
        if row.files.is_empty() {
            faces.push(("page", Skin::Keywords, of_page(row)));
        }
        for (face, skin, answer) in &faces {
            let own = row.own.get(*face).and_then(Value::as_str).map(str::to_owned);
            let expected = row.refused.as_ref().map(|refused| own.unwrap_or_else(|| worded(refused, *skin)));
            match (answer, expected) {
                (Err(said), Some(expected)) if *said == expected => {}
                (Err(said), _) => unlike.push(format!("{}: the {face} says: {said}", row.name)),
                (Ok(_), Some(_)) => unlike.push(format!("{}: the {face} solves", row.name)),
                (Ok(report), None) => {
                    let codes: Vec<_> =
                        report["warnings"].as_array().unwrap().iter().map(|told| told["code"].clone()).collect();
                    if json!(codes) != json!(row.warned) {
                        unlike.push(format!("{}: the {face} warns of {codes:?}", row.name));
                    }
                }
            }
        }
        if let [(.., Ok(one)), (.., Ok(other))] = &faces[..] {
            let keys = one.keys().chain(other.keys()).filter(|key| !DIFFERENT.contains(&key.as_str()));
            for key in keys.filter(|key| one.get(*key) != other.get(*key)) {
                unlike.push(format!("{}: {key} is {:?} and {:?}", row.name, one.get(key), other.get(key)));
            }
        }
    }
    assert!(unlike.is_empty(), "{} differences\n{}", unlike.len(), unlike.join("\n"));
}
