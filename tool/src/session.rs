//! The session of a command, and its warnings as it says them.

use std::io::{self, IsTerminal};

use asperity_scene::warnings::Warnings;
use asperity_scene::{Kind, Notice, Outcome, Posed, Processes, Scalar, Session, keys};

use crate::printing::complain;

/// The code of the warning that rows have not converged, which precedes its message.
pub const UNCONVERGED: &str = "unconverged";

keys! {
    /// Whether warnings are errors.
    #[derive(Copy, Default)]
    Strictness {
        "Output" {
            /// Treat warnings as errors: refuse input with a probable mistake, and write no solution with one
            strict: bool = Kind::switch(),
        }
    }
}

/// Says the warnings that were not said before.
pub fn say_new(warnings: &mut Warnings) {
    say(warnings.tell());
}

/// Says warnings, and on a terminal where their codes are explained.
pub fn say(warnings: &[Notice]) {
    warnings.iter().for_each(|told| complain("warning", &told.to_string()));
    let codes: Vec<_> = warnings.iter().map(|told| told.code.as_str()).collect();
    if !codes.is_empty() && io::stderr().is_terminal() {
        complain("note", &format!("docs/program/warnings.md explains {}", codes.join(", ")));
    }
}

impl Strictness {
    /// The session of a problem, in which warnings are errors if that is asked for.
    pub fn session<T: Scalar>(self, posed: Posed, processes: &Processes) -> Outcome<Session<T>> {
        Session::new(posed, self.strict, processes)
    }
}
