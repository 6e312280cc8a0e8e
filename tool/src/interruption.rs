//! What ends a run before its end: an interruption, as by ^C, after which it says what stands, and the end of the study
//! of which it is a case. Neither leaves a temporary folder.

use std::sync::{Mutex, PoisonError};
use std::{env, io, process, thread};

use asperity_maps::io::OutputFolder;

/// The line of an interrupted run about its rows.
static STANDING: Mutex<String> = Mutex::new(String::new());

/// The variable of the environment that a case of a study has.
pub const CASE: &str = "ASPERITY_CASE";

/// Whether this run is a case of a study.
pub fn is_case() -> bool {
    env::var_os(CASE).is_some()
}

/// Sets what this run says if it is interrupted from here on.
pub fn stands(text: String) {
    *STANDING.lock().unwrap_or_else(PoisonError::into_inner) = text;
}

/// Listens for all that may end the run, each on a thread of its own. Where no thread is to be had, an interruption
/// ends the run as it does any other program.
pub fn listen() {
    #[cfg(unix)]
    listen_to_signals();
    if is_case() {
        // nobody writes to it: it ends when the study does, however that happens
        let _ = thread::Builder::new().spawn(|| {
            let _ = io::copy(&mut io::stdin(), &mut io::sink());
            OutputFolder::abandon_all();
            process::exit(1)
        });
    }
}

/// Waits for an interruption or a request to end, removes what is not complete, says what stands, and ends by the
/// signal, as whoever waits for this process expects.
#[cfg(unix)]
fn listen_to_signals() {
    use std::io::IsTerminal;

    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    use crate::printing::complain;

    let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else { return };
    let _ = thread::Builder::new().spawn(move || {
        for signal in signals.forever() {
            OutputFolder::abandon_all();
            let text = STANDING.lock().unwrap_or_else(PoisonError::into_inner);
            if !text.is_empty() {
                // below a bar
                if io::stderr().is_terminal() {
                    eprintln!();
                }
                complain("interrupted", &text);
            }
            let _ = emulate_default_handler(signal);
        }
    });
}
