//! A worker of a study: a process that runs the commands of many cases, one after the other.
//!
//! The study sends the arguments of the commands of a case as a line of JSON. The worker answers on standard error with
//! what they say, and at the end with the exit code of the last one that ran.

use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, Write};
#[cfg(unix)]
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStderr, Command, Stdio, exit};
use std::sync::mpsc::channel;
use std::{env, thread};

use asperity_maps::io::OutputFolder;

use crate::outcome::Outcome;
use crate::threads::use_this_one;
use crate::{CONVERGED, REFUSED};

/// The variable of the environment that workers have.
const WORKER: &str = "ASPERITY_WORKER";

/// What stands before an exit code.
const ENDED: &str = "ended";

/// Whether this process is a worker of a study.
pub fn is_worker() -> bool {
    env::var_os(WORKER).is_some()
}

/// Runs the commands of each case by `run`, which returns their exit codes, as far as none is refused. The process ends
/// when the study does, however that happens, also in the middle of a command.
pub fn serve(mut run: impl FnMut(Vec<OsString>) -> u8) -> Outcome<()> {
    use_this_one()?;
    let (sender, cases) = channel::<Vec<Vec<OsString>>>();
    let listening = thread::Builder::new().spawn(move || {
        let lines = io::stdin().lines().map_while(Result::ok);
        let sent = lines.map_while(|line| serde_json::from_str(&line).ok());
        sent.for_each(|commands| drop(sender.send(commands)));
        let _none = OutputFolder::abandon_all();
        exit(1)
    });
    listening.map_err(|e| format!("no thread can be started ({e}): free some memory"))?;
    for commands in cases {
        let mut codes = commands.into_iter().map(&mut run);
        let code = codes.try_fold(CONVERGED, |_, code| if code == REFUSED { Err(code) } else { Ok(code) });
        let end = format!("{ENDED}: {}\n", code.unwrap_or(REFUSED));
        io::stderr().write_all(end.as_bytes())?;
    }
    Ok(())
}

/// A worker as the study has it, with its process from the first command on.
pub struct Worker<'a> {
    program: &'a [OsString],
    threads: usize,
    process: Option<Process>,
}

struct Process {
    child: Child,
    said: BufReader<ChildStderr>,
}

impl<'a> Worker<'a> {
    /// A worker that is this `program`, whose solves use so many threads.
    pub fn new(program: &'a [OsString], threads: usize) -> Self {
        Self { program, threads, process: None }
    }

    /// Runs the commands of a case, each by its arguments; their warnings, or the line by which one was refused. After a
    /// process that dies the next case has another one.
    pub fn run(&mut self, commands: &[Vec<OsString>]) -> Result<Vec<String>, String> {
        let mut process = self.process.take().map_or_else(|| self.started(), Ok)?;
        let (mut said, code) = process.answer(commands);
        if code.is_some() {
            self.process = Some(process);
        } else if process.child.wait().is_ok_and(|status| status.code().is_none()) {
            return Err("its process was killed".to_owned());
        }
        match code.as_deref() {
            Some("0" | "2") => Ok(said),
            _ => Err(said.pop().unwrap_or_else(|| "it said nothing".to_owned())),
        }
    }

    fn started(&self) -> Result<Process, String> {
        let [program, before @ ..] = self.program else { return Err("this program is not found any more".to_owned()) };
        let mut child = Command::new(program);
        child.args(before).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        child.env(WORKER, "1").env("NO_COLOR", "1").env("RAYON_NUM_THREADS", self.threads.to_string());
        // ^C is for this process, with which the other one ends
        #[cfg(unix)]
        child.process_group(0);
        let mut child = child.spawn().map_err(|e| format!("it cannot be started: {e}"))?;
        let said = child.stderr.take().ok_or("it cannot be heard")?;
        Ok(Process { child, said: BufReader::new(said) })
    }
}

impl Process {
    /// The lines that commands say, and their exit code, or none if the process has ended.
    fn answer(&mut self, commands: &[Vec<OsString>]) -> (Vec<String>, Option<String>) {
        let sent = serde_json::to_string(commands).unwrap_or_default() + "\n";
        // a process that has ended does not take it, and says no more
        let _ = self.child.stdin.as_mut().map(|input| input.write_all(sent.as_bytes()));
        let (mut said, mut line) = (Vec::new(), Vec::new());
        while self.said.read_until(b'\n', &mut line).is_ok_and(|read| read > 0) {
            let text = String::from_utf8_lossy(&line).trim_end().to_owned();
            match text.split_once(": ") {
                Some((ENDED, code)) => return (said, Some(code.to_owned())),
                Some(("warning" | "error", text)) => said.push(text.to_owned()),
                _ => said.push(text),
            }
            line.clear();
        }
        (said, None)
    }
}

impl Drop for Process {
    /// Lets it end, and waits for that.
    fn drop(&mut self) {
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}
