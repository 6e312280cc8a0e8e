//! Comments, docstrings and documents repeat the noun, where a pronoun would send their readers back for it.

use std::fs;
use std::path::Path;

/// The pronouns.
const PRONOUNS: [&str; 5] = [" that of ", " those of ", " of which ", " whose ", " as of "];

/// Adds what `part` takes of each file in a folder with an ending to the `texts`.
fn read(folder: &Path, ending: &str, part: fn(&str) -> String, texts: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            read(&path, ending, part, texts);
        } else if path.extension().is_some_and(|extension| extension == ending) {
            texts.push(part(&fs::read_to_string(&path).unwrap()));
        }
    }
}

fn comments(source: &str) -> String {
    let lines = source.lines().filter_map(|line| line.trim_start().strip_prefix("//"));
    lines.map(|line| line.trim_start_matches(['/', '!'])).collect::<Vec<_>>().join("\n")
}

fn docstrings(source: &str) -> String {
    source.split("\"\"\"").skip(1).step_by(2).collect::<Vec<_>>().join("\n")
}

/// The pronouns in 1000 words.
fn density(texts: &[String]) -> f64 {
    let (mut words, mut pronouns) = (0, 0);
    for text in texts {
        let word = |word: &str| word.trim_matches(|c: char| !c.is_alphanumeric()).to_lowercase();
        let text: Vec<_> = text.split_whitespace().map(word).collect();
        words += text.len();
        let text = format!(" {} ", text.join(" "));
        pronouns += PRONOUNS.iter().map(|pronoun| text.matches(pronoun).count()).sum::<usize>();
    }
    assert!(words > 5000, "{words} words");
    1000.0 * pronouns as f64 / words as f64
}

#[test]
fn comments_docstrings_and_documents_repeat_the_noun() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let of = |folders: &[&str], ending: &str, part: fn(&str) -> String| {
        let mut texts = Vec::new();
        folders.iter().for_each(|folder| read(&root.join(folder), ending, part, &mut texts));
        texts
    };
    let rust = ["src", "crates", "tool", "python/src", "web/src", "web/tests", "tests", "examples", "benches"];
    for (name, most, texts) in [
        ("comments", 1.2, of(&rust, "rs", comments)),
        ("docstrings", 1.2, of(&["python/asperity"], "py", docstrings)),
        ("documents", 1.2, of(&["docs", "src/guide"], "md", str::to_owned)),
    ] {
        let found = density(&texts);
        assert!(found <= most, "{found:.2} in 1000 words of {name} are {PRONOUNS:?}, at most {most}: repeat the noun");
    }
}
