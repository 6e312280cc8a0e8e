//! What ends a run before its end: an interruption, as by ^C, which leaves no temporary folder.

/// Listens for all that may end the run, on a thread of its own.
pub fn listen() {
    #[cfg(unix)]
    listen_to_signals();
}

/// Waits for an interruption or a request to end, removes what is not complete, and ends by the signal, as whoever waits
/// for this process expects.
#[cfg(unix)]
fn listen_to_signals() {
    use std::thread;

    use asperity::io::OutputFolder;
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else { return };
    // without it an interruption ends the run as it does any other
    let _ = thread::Builder::new().spawn(move || {
        for signal in signals.forever() {
            OutputFolder::abandon_all();
            let _ = emulate_default_handler(signal);
        }
    });
}
