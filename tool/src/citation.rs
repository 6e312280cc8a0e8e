//! How to cite the program and its method, from `CITATION.cff`.

const FILE: &str = include_str!("../../CITATION.cff");

/// The program, and the paper whose method it builds on, a text each.
pub fn citations() -> [String; 2] {
    let (program, paper) = FILE.split_once("references:").unwrap_or((FILE, ""));
    let names = values(paper, "family-names").join(", ");
    let one = |text, key| values(text, key).into_iter().next().unwrap_or_default();
    [
        format!(
            "{}: {}, version {}.",
            values(program, "- name").join(", "),
            one(program, "title"),
            one(program, "version")
        ),
        format!(
            "{names}: {}, {} {} ({}), doi:{}.",
            one(paper, "title"),
            one(paper, "journal"),
            one(paper, "volume"),
            one(paper, "year"),
            one(paper, "doi")
        ),
    ]
}

/// The values of all lines with a key; one that is folded (`>-`) is on the next line.
fn values(text: &str, key: &str) -> Vec<String> {
    let lines: Vec<_> = text.lines().map(str::trim).collect();
    let value = |(k, line): (usize, &&str)| {
        let line = line.strip_prefix(key).or_else(|| line.strip_prefix("- ")?.strip_prefix(key))?;
        let value = line.strip_prefix(':')?.trim();
        Some(if value == ">-" { lines.get(k + 1)?.to_string() } else { value.to_owned() })
    };
    lines.iter().enumerate().filter_map(value).collect()
}
