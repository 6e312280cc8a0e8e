//! The numbers of answers where Python and the documents have them: written anew where `UPDATE` is set.

mod written;

use std::collections::HashSet;

use asperity_scene::legs::CASE;
use asperity_scene::{
    ATTRIBUTES, Account, Adhesion, Conducted, CycleLimit, Elastic, GROUPS, GridErrors, GridLevel, Inputs, Left,
    Measure, Narrowest, Number, OF_ADHESION, OtherBranch, PulledOff, Refinement, Row, Search, Slopes, Steadiness, Step,
    Transmissivity,
};

use self::written::check_written;

/// The tables within a report: their names in Python, the key that has them, and their numbers.
const TABLES: [(&str, &str, &[Number]); 10] = [
    ("OtherBranch", "other_branch", OtherBranch::NUMBERS),
    ("GridLevel", "levels", GridLevel::NUMBERS),
    ("GridErrors", "grid_error", GridErrors::NUMBERS),
    ("Refinement", "accuracy", Refinement::NUMBERS),
    ("Search", "search", Search::NUMBERS),
    ("Steadiness", "stability", Steadiness::NUMBERS),
    ("Conducted", "conductance", Conducted::NUMBERS),
    ("Narrowest", "constriction", Narrowest::NUMBERS),
    ("Transmissivity", "transmissivity", Transmissivity::NUMBERS),
    ("Left", "departures", Left::NUMBERS),
];

/// Numbers that may be infinite or unknown, and are null then.
const UNSURE: &str = "distance eigenvalue lower_bound corrected_contact_fraction";

fn is_among(list: &str, name: &str) -> bool {
    list.split_whitespace().any(|one| one == name)
}

fn select<'a>(lists: &[&'a [Number]]) -> Vec<&'a Number> {
    lists.iter().flat_map(|list| list.iter()).filter(|number| number.is_reported).collect()
}

/// The numbers of the report of a solve, in their order: the numbers of some fields are among the others.
fn of_report() -> Vec<&'static Number> {
    fn in_place(number: &'static Number) -> Vec<&'static Number> {
        let within = match (number.is_reported, number.kind) {
            (true, _) => return vec![number],
            (_, "Inputs") => Inputs::NUMBERS,
            (_, "Slopes") => Slopes::NUMBERS,
            (_, "Elastic") => Elastic::NUMBERS,
            (_, "Adhesion") => Adhesion::NUMBERS,
            _ => &[],
        };
        within.iter().flat_map(in_place).collect()
    }
    Account::NUMBERS.iter().flat_map(in_place).collect()
}

/// The type in Python of a type in Rust.
fn python(kind: &str) -> String {
    let within = |before: &str| kind.strip_prefix(before)?.strip_suffix('>').map(python);
    if let Some(one) = within("Option<") {
        return format!("{one} | None");
    }
    if let Some(one) = within("Vec<") {
        return format!("list[{one}]");
    }
    if let Some(one) = within("Along<") {
        return format!("dict[str, {one}]");
    }
    match kind {
        "f64" => "float",
        "usize" => "int",
        "(usize, usize)" => "list[int]",
        "(f64, f64)" => "list[float]",
        "&'static str" | "String" | "Base" | "Symbol" => "str",
        "Value" => "dict[str, str | list[str]]",
        "Wall" => "WallName",
        "Quantity" => "AccuracyOf",
        other => other,
    }
    .to_owned()
}

/// The type of a number in Python.
fn annotation(number: &Number) -> String {
    let kind = python(number.kind);
    let may_be_null = number.measure == Measure::Error || is_among(UNSURE, number.name);
    if may_be_null && kind == "float" { "float | None".to_owned() } else { kind }
}

fn class(name: &str, about: &str, numbers: &[&Number]) -> String {
    let fields = numbers.iter().map(|number| format!("    {}: {}\n", number.name, annotation(number)));
    format!("\n\nclass {name}(TypedDict):\n    \"\"\"{about}\"\"\"\n\n{}", fields.collect::<String>())
}

fn types() -> String {
    let mut text = String::from(
        "\"\"\"The numbers of answers. Written by `UPDATE=1 cargo test -p asperity-scene --test numbers`.\"\"\"\n\n\
         from __future__ import annotations\n\nfrom typing import TypedDict, cast\n\n\
         from ..common.types import AccuracyOf, Boundary, Branch, Criterion, GridError, Method, Notice, Patch, Precision, Status, Verdict, WallName\n",
    );
    for (name, key, numbers) in TABLES {
        text += &class(name, &format!("The entries of ``{key}``."), &select(&[numbers]));
    }
    text += &class(
        "Report",
        "The report of a solve, with the keys of the tool's report.json: its outcome, then its inputs.\n\n    \
         Numbers are in the units of the input, energies per area; None where a key does not apply, or where a number is\n    \
         not finite, as an error that is not known yet: the report is what ``json.loads`` reads from that file. Attributes of\n    \
         a solution, as ``relative_error``, are infinite there.\n    ",
        &of_report(),
    );
    text += "\n\nclass Numbers:\n    \"\"\"The numbers of a solution that are known without a look at its fields.\"\"\"\n\n    \
             _told: Report\n";
    for number in of_report().into_iter().filter(|number| is_among(ATTRIBUTES, number.name)) {
        let (name, kind) = (number.name, python(number.kind));
        let told = format!("self._told[\"{name}\"]");
        let found = if kind == annotation(number) { told } else { format!("cast(\"{kind}\", {told})") };
        let otherwise = if kind.ends_with("None") { " None where it does not apply." } else { "" };
        let help = wrapped(&format!("\"\"\"{}{otherwise}\"\"\"", number.help.trim().replace('`', "``")));
        text += &format!("\n    @property\n    def {name}(self) -> {kind}:\n{help}        return {found}\n");
    }
    text
}

/// A docstring of a method on lines of at most 110 characters.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) if line.chars().count() + word.chars().count() < 102 => *line += &format!(" {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    lines.iter().map(|line| format!("        {line}\n")).collect()
}

/// A table of numbers in a document.
fn table(numbers: &[&Number]) -> String {
    let unit = |number: &Number| match number.measure {
        Measure::Of(dimension) => dimension.si,
        Measure::Seconds => "s",
        _ => "",
    };
    let row = |number: &&Number| {
        vec![format!("`{}`", number.name), unit(number).to_owned(), number.help.trim().replace('|', "\\|")]
    };
    written::table(&["Key", "Unit", "Meaning"], &numbers.iter().map(row).collect::<Vec<_>>())
}

/// The table of a table within a report, of its numbers that the report does not have itself, if it is of a solution;
/// and of numbers that the report has of the finest of nested grids.
fn table_within(numbers: &[&Number], of_report: &[&Number]) -> String {
    let is_solution = numbers.iter().any(|number| number.name == "status");
    let is_same = |one: &Number, other: &Number| one.name == other.name && !other.help.contains("nested grids");
    let is_repeated = |number: &&Number| is_solution && of_report.iter().any(|other| is_same(number, other));
    let (repeated, own): (Vec<&Number>, Vec<&Number>) = numbers.iter().copied().partition(is_repeated);
    let names: Vec<_> = repeated.iter().map(|number| format!("`{}`", number.name)).collect();
    let repeated = if names.is_empty() { String::new() } else { format!("\nAs above: {}.\n", names.join(", ")) };
    repeated + &if own.is_empty() { String::new() } else { table(&own) }
}

fn document() -> String {
    let of_solve = select(&[Account::NUMBERS]);
    let (columns, others): (Vec<_>, Vec<_>) = of_solve.iter().partition(|number| number.is_column());
    let of_row = select(&[Row::NUMBERS]).into_iter().filter(|number| number.name != "heights");
    let mut text = String::from(
        "# Numbers of reports and tables\n\nA number has the same name and the same meaning in all [reports](reports.md), in \
         columns\nof tables, and in Python. A number that does not apply, or is not finite, is `null`. Numbers are in the \
         units of this page if\nthe input has units, and otherwise in the units of the input; none is in percent.\n",
    );
    for (heading, numbers) in [
        ("Of a solution and of tables", columns),
        ("Of a solution alone", others),
        ("Of tables alone", of_row.collect()),
        ("Of a cycle", select(&[Step::NUMBERS, CycleLimit::NUMBERS])),
        ("Of a pull-off", select(&[PulledOff::NUMBERS])),
        ("Of the run", select(&[Inputs::NUMBERS, Slopes::NUMBERS])),
    ] {
        text += &format!("\n## {heading}\n{}", table(&numbers));
    }
    text += "\nReports also have the [keys](keys.md) of the body, the law and the wall.\n\n## Tables within reports\n";
    for (_, key, numbers) in TABLES {
        text += &format!("\n### {key}\n{}", table_within(&select(&[numbers]), &of_report()));
    }
    text
}

#[test]
fn types_of_python_and_the_tables_of_the_documents_are_the_numbers() {
    check_written(
        "numbers",
        [("python/asperity/answers/numbers.py", types()), ("docs/program/numbers.md", document())],
    );
}

#[test]
fn pages_and_attributes_have_numbers_that_are_known() {
    let known: HashSet<_> = Number::all().chain(of_report()).map(|number| number.name).collect();
    let lists = GROUPS.iter().map(|(_, names)| *names).chain([OF_ADHESION, ATTRIBUTES]);
    for name in lists.flat_map(str::split_whitespace).filter(|name| *name != CASE) {
        assert!(known.contains(name), "{name}");
    }
}
