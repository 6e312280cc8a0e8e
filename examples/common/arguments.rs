//! The arguments of the examples.

use std::process::exit;

use clap::{Parser, ValueEnum};

/// The arguments of an example; the first paragraph of its source begins the help.
///
/// Ends here where help is asked for, and, with a line on standard error and exit code 1, where an argument is unknown,
/// missing, malformed or one too many.
pub fn read<A: Parser>(source: &str) -> A {
    let about = source.lines().map_while(|line| line.strip_prefix("//! ")).collect::<Vec<_>>().join(" ");
    let command = A::command().about(about).max_term_width(120);
    command.try_get_matches().and_then(|matches| A::from_arg_matches(&matches)).unwrap_or_else(|error| {
        if !error.use_stderr() {
            error.exit();
        }
        let text = error.to_string();
        let reason = text.split("\n\n").next().unwrap_or_default().lines().map(str::trim).collect::<Vec<_>>();
        eprintln!("{}; see --help", reason.join(" "));
        exit(1);
    })
}

/// The precision of a solve.
#[derive(Clone, Copy, ValueEnum)]
pub enum Precision {
    /// Single.
    F32,
    /// Double.
    F64,
}

/// Refuses all arguments, for an example that takes none.
pub fn none(source: &str) {
    #[derive(Parser)]
    struct Nothing {}
    let Nothing {} = read(source);
}

/// Reads a number of nodes along a side, no fewer than these.
pub fn nodes<const LEAST: usize>(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(nodes) if nodes >= LEAST => Ok(nodes),
        Ok(_) => Err(format!("it must be at least {LEAST}")),
        Err(error) => Err(format!("{error}")),
    }
}

/// Reads a power of two of them.
pub fn power_of_two<const LEAST: usize>(text: &str) -> Result<usize, String> {
    let nodes = nodes::<LEAST>(text)?;
    if nodes.is_power_of_two() { Ok(nodes) } else { Err("it must be a power of two".to_owned()) }
}
