//! Printing: tables for people or JSON, and the colours of a terminal.

use std::io::{self, Write};
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use anstream::AutoStream;
use asperity_scene::{Kind, Outcome, Skin, keys, worded};
use serde_json::Value;

keys! {
    /// The form of standard output: a table, JSON or nothing.
    #[derive(Copy)]
    Printing {
        "Output" {
            /// Print no table and no progress, only warnings
            quiet: bool = Kind::switch(),
            /// Print the report as one JSON document, and nothing else; the page reports of the documentation explains
            /// its keys
            json: bool = Kind::switch(),
        }
    }
}

impl Printing {
    /// Whether tables and other words for people are wanted.
    pub fn for_people(self) -> bool {
        !self.quiet && !self.json
    }

    /// Whether bars are unwanted.
    pub fn without_bars(self) -> bool {
        self.quiet || is_silent()
    }

    /// Prints words for people, if they are wanted.
    pub fn say(self, text: &str) {
        if self.for_people() {
            say(text);
        }
    }

    /// Prints a report as JSON, if that is wanted; numbers that are not finite become null.
    pub fn report(self, report: impl FnOnce() -> Value) {
        if self.json {
            // only within words, which may have them escaped
            let escaped = |c: char| match c {
                c if c.is_control() && c != '\n' => format!("\\u{:04x}", u32::from(c)),
                c => c.to_string(),
            };
            say(&format!("{:#}", report()).chars().map(escaped).collect::<String>());
        }
    }
}

/// Text in bold, where that is shown.
pub fn bold(text: &str) -> String {
    format!("\u{1b}[1m{text}\u{1b}[0m")
}

/// Text in bold and in one of the eight colours of terminals, where that is shown.
fn coloured(text: &str, colour: u8) -> String {
    format!("\u{1b}[1;3{colour}m{text}\u{1b}[0m")
}

pub fn green(text: &str) -> String {
    coloured(text, 2)
}

pub fn yellow(text: &str) -> String {
    coloured(text, 3)
}

/// Whether this process prints nothing but its errors, as another one prints for all.
static SILENT: AtomicBool = AtomicBool::new(false);

/// Leaves all printing but errors to another process.
pub fn silence() {
    SILENT.store(true, Ordering::Relaxed);
}

fn is_silent() -> bool {
    SILENT.load(Ordering::Relaxed)
}

/// The first error of standard output.
static UNPRINTED: OnceLock<String> = OnceLock::new();

/// Prints to standard output, with colours only if that is a terminal.
pub fn say(text: &str) {
    if !is_silent() {
        printed(writeln!(AutoStream::auto(io::stdout()), "{text}"));
    }
}

/// Keeps the error of something that was printed, for [`check_printed`]. Nobody may be listening any more, as behind
/// `| head`, which is none: the files are written all the same.
pub fn printed(outcome: io::Result<()>) {
    if let Err(error) = outcome.and_then(|()| io::stdout().flush())
        && error.kind() != io::ErrorKind::BrokenPipe
    {
        let _ = UNPRINTED.set(error.to_string());
    }
}

/// Refuses to have succeeded where something could not be printed.
pub fn check_printed() -> Outcome<()> {
    UNPRINTED.get().map_or(Ok(()), |reason| Err(format!("standard output cannot be written: {reason}").into()))
}

/// Texts under each other, behind their names.
pub fn aligned(rows: &[(impl AsRef<str>, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.as_ref().len()).max().unwrap_or(0);
    let lines = rows.iter().map(|(name, text)| format!("{:width$}  {text}", name.as_ref()));
    lines.collect::<Vec<_>>().join("\n")
}

/// A text that quotes names, with nothing in it that controls a terminal, on one line.
pub fn on_terminal(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// The name of a file for people.
pub fn name(path: &Path) -> String {
    on_terminal(&path.to_string_lossy())
}

/// A listener to warnings.
pub type Warn<'a> = &'a mut dyn FnMut(String);

/// Prints a warning.
pub fn warn(text: String) {
    complain("warning", &text);
}

/// Prints one line to standard error, whatever names with line breaks it quotes.
pub fn complain(kind: &str, text: &str) {
    if is_silent() && kind != "error" {
        return;
    }
    let line = on_terminal(text);
    let kind = if kind == "error" { coloured("error:", 1) } else { yellow(&format!("{kind}:")) };
    let _ = writeln!(AutoStream::auto(io::stderr()), "{kind} {line}");
}

/// The mistake in some arguments on one line.
pub fn on_one_line(error: &clap::Error) -> String {
    let text = error.to_string();
    let text = text.split("\nUsage:").next().unwrap_or_default();
    let text = text.split("\nFor more information").next().unwrap_or_default();
    let mut line = String::new();
    for part in text.trim_start_matches("error: ").lines().map(str::trim).filter(|part| !part.is_empty()) {
        line.push_str(match part {
            _ if line.is_empty() => "",
            _ if part.starts_with('[') || line.ends_with(':') => " ",
            _ if part.starts_with("tip: ") => "; ",
            _ => ", ",
        });
        line.push_str(part.trim_start_matches("tip: "));
    }
    line
}

/// A value, or the reason why there is none, in the words of options.
pub fn in_options<V>(found: Result<V, String>) -> Outcome<V> {
    Ok(found.map_err(|text| worded(&text, Skin::Options))?)
}
