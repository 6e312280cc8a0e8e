//! The table of a study: the rows of its cases, after what varies between them.

use std::fs::{self, File};
use std::path::Path;

use asperity::Error;
use asperity_scene::csv::bare;
use asperity_scene::legs::CASE;
use asperity_scene::output::{OutputFile, write_text};
use asperity_scene::warnings::{read_beside, write_beside};
use asperity_scene::{Notice, Outcome};
use serde_json::{Map, Number, Value};

use super::cases::{Case, Study, text};

/// Writes the table of a study with all cases done; the number of its rows, and of rows that did not converge.
pub fn merge(study: &Study) -> Outcome<(usize, usize)> {
    let (mut table, mut count, mut unconverged) = (String::new(), 0, 0);
    let (format, columns) = (study.format, columns(study)?);
    for (k, Case { rows, values, .. }) in study.cases.iter().enumerate() {
        let text = read(rows)?;
        let (names, lines) = format.parts(&text);
        // what varies, but for what is a column of the rows
        let is_column = |name: &String| columns.iter().any(|column| bare(column) == name);
        let own = study.columns.iter().zip(values).filter(|(name, _)| !is_column(name));
        let own: Map<_, _> =
            own.map(|(name, value)| (name.clone(), value.as_ref().map_or(Value::Null, cell))).collect();
        for line in lines {
            let Value::Object(mut row) = format.parsed(&names, line) else { continue };
            let converged = row.get("status").is_some_and(|status| status == "converged");
            unconverged += usize::from(!converged || row.get("reached") == Some(&Value::Bool(false)));
            // a surface that was made has the name of no file
            let told = columns.iter().filter(|name| !study.makes_surface() || *name != "heights");
            let cells = told.map(|name| (name.clone(), row.remove(name).unwrap_or_default()));
            let number = std::iter::once((CASE.to_owned(), (k + 1).into()));
            let row = number.chain(own.clone()).chain(cells).collect::<Map<_, _>>();
            if count == 0 {
                table = format.header(&row.keys().collect::<Vec<_>>());
            }
            table += &(format.line(&row) + "\n");
            count += 1;
        }
    }
    OutputFile::create(&study.out, true)?.complete(|path| {
        write_text(path, &table)?;
        // the rows of cases may not be on the disk yet
        let synced = File::options().append(true).open(path).and_then(|file| file.sync_all());
        synced.map_err(|e| Error::unwritable(path, e))
    })?;
    write_beside(&study.out, &warnings(study)?)?;
    Ok((count, unconverged))
}

/// The columns of all cases: of the first case, then columns that others add.
fn columns(study: &Study) -> Outcome<Vec<String>> {
    let mut columns: Vec<String> = Vec::new();
    for Case { rows, .. } in &study.cases {
        let text = read(rows)?;
        let (names, _) = study.format.parts(&text);
        if names.is_empty() && !text.is_empty() {
            return Err(Error::file(rows, "has no columns in its first line: remove the file").into());
        }
        for name in names {
            match columns.iter().find(|column| bare(column) == bare(&name)) {
                Some(column) if *column != name => {
                    let reason =
                        format!("has {name} and not {column}: give numbers with units in all cases, or in none");
                    return Err(Error::file(rows, reason).into());
                }
                Some(_) => {}
                None => columns.push(name),
            }
        }
    }
    Ok(columns)
}

fn read(rows: &Path) -> Outcome<String> {
    Ok(fs::read_to_string(rows).map_err(|e| Error::unreadable(rows, e))?)
}

/// The warnings of all cases: of each code the worst, with the numbers of its cases if these are not all, and of the
/// one that it is the text of, if the texts differ.
fn warnings(study: &Study) -> Outcome<Vec<Notice>> {
    let mut all: Vec<(Notice, usize, Vec<usize>, bool)> = Vec::new();
    for (number, case) in (1..).zip(&study.cases) {
        for told in read_beside(&case.rows)? {
            let Some((known, worst, cases, differ)) = all.iter_mut().find(|(known, ..)| known.code == told.code) else {
                all.push((told, number, vec![number], false));
                continue;
            };
            cases.push(number);
            *differ |= *known != told;
            if told.replace_if_worse(known) {
                *worst = number;
            }
        }
    }
    for (told, worst, cases, differ) in &mut all {
        let is_all = cases.len() == study.cases.len();
        let of = if is_all { "all cases".to_owned() } else { numbered(cases) };
        if *differ {
            told.message = format!("{of}, with the figures of case {worst}, the worst: {}", told.message);
        } else if !is_all {
            told.message = format!("{of}: {}", told.message);
        }
    }
    Ok(all.into_iter().map(|(told, ..)| told).collect())
}

/// Cases by their numbers, those in a row as a range: `cases 1-40, 57`, or `case 3`.
fn numbered(cases: &[usize]) -> String {
    let runs = cases.chunk_by(|case, next| case + 1 == *next).map(|run| match run {
        [one] => one.to_string(),
        run => format!("{}-{}", run[0], run[run.len() - 1]),
    });
    format!("case{} {}", if cases.len() > 1 { "s" } else { "" }, runs.collect::<Vec<_>>().join(", "))
}

/// A value of what varies in a cell: a number, if it is one.
fn cell(value: &toml::Value) -> Value {
    match value {
        toml::Value::Integer(number) => (*number).into(),
        toml::Value::Float(number) => (*number).into(),
        other => text(other).parse::<Number>().map_or_else(|_| text(other).into(), Value::Number),
    }
}
