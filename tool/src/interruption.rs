//! An interruption of a run, as by ^C, after which it says what stands. It leaves no temporary folder.

use std::sync::{Mutex, PoisonError};

/// The line of an interrupted run about its rows.
static STANDING: Mutex<String> = Mutex::new(String::new());

/// Sets what this run says if it is interrupted from here on.
pub fn stands(text: String) {
    *STANDING.lock().unwrap_or_else(PoisonError::into_inner) = text;
}

/// Waits for an interruption or a request to end, removes what is not complete, says what stands, and ends by the
/// signal, as whoever waits for this process expects. Where no thread is to be had for that, an interruption ends the
/// run as it does any other program.
#[cfg(unix)]
pub fn listen() {
    use std::io::{IsTerminal, stderr};
    use std::thread;

    use asperity_maps::io::OutputFolder;
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    use crate::printing::complain;

    let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else { return };
    let _ = thread::Builder::new().spawn(move || {
        for signal in signals.forever() {
            let _none = OutputFolder::abandon_all();
            let text = STANDING.lock().unwrap_or_else(PoisonError::into_inner);
            if !text.is_empty() {
                // below a bar
                if stderr().is_terminal() {
                    eprintln!();
                }
                complain("interrupted", &text);
            }
            let _ = emulate_default_handler(signal);
        }
    });
}
