//! The table of a study: the rows of its cases, after what varies between them.

use std::fs::{self, File};

use asperity::Error;
use asperity_scene::{Format, Told};
use serde_json::{Map, Number, Value};

use super::cases::{Case, Study, text};
use crate::csv;
use crate::outcome::Outcome;
use crate::output::{OutputFile, write_text};
use crate::warnings::{read_beside, write_beside};

/// The rows of a table that was written.
pub struct Merged {
    pub rows: usize,
    /// The number of rows that did not converge
    pub unconverged: usize,
}

/// Writes the table of a study whose cases are all done.
pub fn merge(study: &Study) -> Outcome<Merged> {
    let (mut table, mut merged) = (String::new(), Merged { rows: 0, unconverged: 0 });
    let mut columns = Vec::new();
    for (k, case) in study.cases.iter().enumerate() {
        let path = &case.rows;
        let rows = fs::read_to_string(path).map_err(|e| Error::unreadable(path, e))?;
        let mut lines = rows.lines();
        let names: Vec<String> = match study.format {
            Format::Csv => csv::names(lines.next().unwrap_or_default()),
            Format::Jsonl => {
                let first: Map<_, _> = lines.clone().next().map_or(Ok(Map::new()), serde_json::from_str)?;
                first.into_iter().map(|(name, _)| name).collect()
            }
        };
        if k == 0 {
            columns = names;
            if study.format == Format::Csv {
                let own = own(study, k, case, &columns);
                let kept = columns.iter().filter(|name| !is_left_out(study, name));
                table = csv::header(own.iter().map(|(name, _)| name).chain(kept)) + "\n";
            }
        } else if names != columns {
            return Err(Error::file(path, "has other columns than the first case: vary nothing that adds some").into());
        }
        for line in lines {
            let row = match study.format {
                Format::Csv => csv::parsed(&columns, line),
                Format::Jsonl => serde_json::from_str(line)?,
            };
            let Value::Object(mut row) = row else { continue };
            merged.rows += 1;
            let converged = row.get("status").is_some_and(|status| status == "converged");
            merged.unconverged += usize::from(!converged || row.get("reached") == Some(&Value::Bool(false)));
            row.retain(|name, _| !is_left_out(study, name));
            let mut whole = own(study, k, case, &columns);
            whole.extend(row);
            table += &study.format.line(&whole);
            table.push('\n');
        }
    }
    let file = OutputFile::create(&study.out, true)?;
    file.write(|path| {
        write_text(path, &table)?;
        // the rows of cases may not be on the disk yet
        let synced = File::options().append(true).open(path).and_then(|file| file.sync_all());
        synced.map_err(|e| Error::unwritable(path, e))
    })?;
    file.commit()?;
    write_beside(&study.out, &warnings(study)?)?;
    Ok(merged)
}

/// The warnings of all cases: of each code the worst, with the numbers of its cases if these are not all, and of the
/// one that it is the text of, if the texts differ.
fn warnings(study: &Study) -> Outcome<Vec<Told>> {
    let mut all: Vec<(Told, usize, Vec<usize>, bool)> = Vec::new();
    for (number, case) in (1..).zip(&study.cases) {
        for told in read_beside(&case.rows)? {
            match all.iter_mut().find(|(known, ..)| known.code == told.code) {
                Some((known, worst, cases, differ)) => {
                    cases.push(number);
                    *differ |= *known != told;
                    if told.replace_if_worse(known) {
                        *worst = number;
                    }
                }
                None => all.push((told, number, vec![number], false)),
            }
        }
    }
    let with_cases = |(mut told, worst, cases, differ): (Told, usize, Vec<usize>, bool)| {
        let all = cases.len() == study.cases.len();
        let of = if all { "all cases".to_owned() } else { numbered(&cases) };
        if differ {
            told.message = format!("{of}, with the figures of case {worst}, the worst: {}", told.message);
        } else if !all {
            told.message = format!("{of}: {}", told.message);
        }
        told
    };
    Ok(all.into_iter().map(with_cases).collect())
}

/// Cases by their numbers, those in a row as a range: `cases 1-40, 57`, or `case 3`.
fn numbered(cases: &[usize]) -> String {
    let runs = cases.chunk_by(|case, next| case + 1 == *next).map(|run| match run {
        [one] => one.to_string(),
        run => format!("{}-{}", run[0], run[run.len() - 1]),
    });
    format!("case{} {}", if cases.len() > 1 { "s" } else { "" }, runs.collect::<Vec<_>>().join(", "))
}

/// Whether a column of the rows is left out of the table: the name of a surface that was made for a case.
fn is_left_out(study: &Study, column: &str) -> bool {
    column == "heights" && study.cases.iter().any(|case| case.surface.is_some())
}

/// The number of a case, and its values of what varies, but for those that are columns of its rows, where a unit may
/// stand behind the name.
fn own(study: &Study, number: usize, case: &Case, columns: &[String]) -> Map<String, Value> {
    let value = |value: &toml::Value| match value {
        toml::Value::Integer(number) => (*number).into(),
        toml::Value::Float(number) => (*number).into(),
        other => text(other).parse::<Number>().map_or_else(|_| text(other).into(), Value::Number),
    };
    let is_column = |name: &String| columns.iter().any(|column| column.split(" [").next() == Some(name));
    let values = study.columns.iter().zip(&case.values).filter(|(name, _)| !is_column(name));
    let values = values.map(|(name, found)| (name.clone(), found.as_ref().map_or(Value::Null, value)));
    std::iter::once(("case".to_owned(), (number + 1).into())).chain(values).collect()
}
