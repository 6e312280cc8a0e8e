//! The keys of scenes where Python and the documents have them: written anew where `UPDATE` is set.

mod written;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use asperity_scene::{KEYWORDS, Key, Skin, Values, worded};

use self::written::{check_written, table};

/// The type of a keyword.
fn annotation(key: &Key) -> String {
    let one = match key.kind.values {
        Values::Quantity(..) => "Quantity".to_owned(),
        Values::Number(_) => "float".to_owned(),
        Values::Whole(..) => "int".to_owned(),
        Values::Switch => "bool".to_owned(),
        Values::Word(words) => {
            // a table is an object, asperity.Tabulated
            let words = words().into_iter().filter(|word| word.name != "table");
            let words: Vec<_> = words.map(|word| format!("{:?}", word.name)).collect();
            format!("Literal[{}]", words.join(", "))
        }
        Values::Text(_) | Values::File => "str".to_owned(),
        Values::Quantities(..) => "Iterable[Quantity]".to_owned(),
        Values::Numbers(_) => "Iterable[float]".to_owned(),
    };
    let several = format!("tuple[{one}, {one}]");
    let values = match key.kind.count {
        (1, 2) => format!("{one} | {several}"),
        (2, 2) => several,
        _ => one,
    };
    let object = match key.name {
        "law" => " | OwnLaw",
        "wall" => " | Penalty | Uzawa",
        "hardness" => " | ArrayLike",
        _ => "",
    };
    format!("{values}{object} | None")
}

/// The default of a keyword, as Python writes it.
fn default(key: &Key) -> String {
    let text = key.kind.default.unwrap_or("none");
    match key.kind.values {
        // one that denies another has three values
        Values::Switch if key.kind.replaces.is_none() => "False".to_owned(),
        Values::Number(_) => text.parse::<f64>().map_or("None".to_owned(), |number| format!("{number:?}")),
        Values::Whole(..) => text.parse::<u64>().map_or("None".to_owned(), |number| number.to_string()),
        Values::Word(_) if text != "none" => format!("{text:?}"),
        _ => "None".to_owned(),
    }
}

fn python() -> String {
    let mut text = String::from(
        "\"\"\"The keywords of solves, by the lists of the keys of scenes: types and defaults.\n\nWritten by `UPDATE=1 cargo \
         test -p asperity-scene --test keys`.\n\"\"\"\n\nKEYS = {\n",
    );
    for (name, _, list) in KEYWORDS {
        let _ = writeln!(text, "    \"{name}\": {{");
        for key in list.iter().filter(|key| key.is_keyword()) {
            let _ = writeln!(text, "        \"{}\": '{} = {}',", key.name, annotation(key), default(key));
        }
        text.push_str("    },\n");
    }
    text + "}\n"
}

fn document() -> String {
    let mut text = String::from(
        "# Keys of a scene\n\nOptions of the program, keywords of Python and entries of scene files have these names, with \
         hyphens in options. Quantities are numbers in consistent units, or all have units. Python has no default of \
         `modulus`.\n",
    );
    for (_, about, list) in KEYWORDS {
        let row = |key: &Key| {
            let unit = key.kind.dimension().map_or("", |dimension| dimension.si);
            let help = worded(key.help.trim(), Skin::Keywords).replace('|', "\\|");
            let default = key.kind.default.map_or(String::new(), |default| format!(" [default: {default}]"));
            vec![format!("`{}`", key.name), unit.to_owned(), help + &default]
        };
        let rows: Vec<_> = list.iter().map(row).collect();
        let _ = write!(text, "\n## {about}\n{}", table(&["Key", "Unit", "Meaning"], &rows));
    }
    text
}

#[test]
fn keywords_of_python_and_the_table_of_the_documents_are_the_keys() {
    check_written("keys", [("python/tests/keys.py", python()), ("docs/program/keys.md", document())]);
}

/// The names of keys that no report has stand in `crates/scene/src/key` alone: faces ask for them by what they are.
#[test]
fn keys_stand_in_their_lists_alone() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let promised = fs::read_to_string(root.join("tool/tests/promised.toml")).unwrap();
    let keys = promised.lines().filter(|line| !line.trim_start().starts_with(['\'', '#']));
    let reports: Vec<_> = keys.take_while(|line| !line.starts_with("[scenes")).collect();
    let reports = reports.join("\n");
    // figures of a surface that is made, and the inputs of a cycle in the identity of its table
    let reported = ["form", "fourier", "hurst", "k_l", "k_r", "k_s", "missing", "random_phase", "rms_height"];
    let of_identity = ["sharp", "smallest_step", "steps"];
    // words that mean other things as well, and values that only completions and studies have
    let others = ["unit", "size", "fourier_unit", "detrend", "percolation"];
    let is_told = |name: &str| {
        let words = reports.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        words.clone().any(|word| word == name)
            || reported.contains(&name)
            || of_identity.contains(&name)
            || others.contains(&name)
    };
    let names: Vec<_> = Key::all().map(|key| key.name).filter(|name| !is_told(name)).collect();
    assert!(names.len() > 20, "{names:?}");
    let mut files = Vec::new();
    for folder in ["crates/scene/src", "tool/src", "python/src", "web/src"] {
        sources(&root.join(folder), &mut files);
    }
    for file in files.iter().filter(|file| !file.starts_with(root.join("crates/scene/src/key"))) {
        let text = fs::read_to_string(file).unwrap();
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        for (number, line) in code.enumerate() {
            let found = names.iter().find(|name| line.contains(&format!("\"{name}\"")));
            assert!(found.is_none(), "{}: line {number} of code has the key {found:?}", file.display());
        }
    }
}

fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            into.push(path);
        }
    }
}
