//! The work on a study: its cases, solved on threads, with the rows of each in a file of a folder.

use std::collections::{HashMap, HashSet};
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;

use asperity::Error;
use asperity_scene::Hash;

use super::case::Run;
use super::cases::{Case, Study};
use crate::interruption::stands;
use crate::journal::{is_whole, state_path};
use crate::outcome::Outcome;
use crate::output::{with_suffix, write_text};
use crate::printing::{Printing, Warn, complain, on_terminal};
use crate::processes::Processes;
use crate::threads;
use crate::{Command, parsed, surface, warnings};

/// The folder of the cases, beside the table.
pub fn folder(table: &Path) -> PathBuf {
    with_suffix(table, ".cases")
}

/// Whether a case has all of its rows, as they were written: what it takes to go on with them is removed then.
pub fn is_done(rows: &Path) -> bool {
    let sum = fs::read_to_string(sum_path(rows)).ok();
    !state_path(rows).exists() && sum.is_some() && sum == checksum(rows).ok()
}

/// The file with the checksum of rows, beside them.
fn sum_path(rows: &Path) -> PathBuf {
    with_suffix(rows, ".sum")
}

/// The checksum of rows, with that of their warnings.
fn checksum(rows: &Path) -> asperity::Result<String> {
    let of_rows = Hash::NEW.of(&fs::read(rows).map_err(|e| Error::unreadable(rows, e))?);
    let warnings = fs::read(warnings::beside(rows)).unwrap_or_default();
    Ok(format!("{of_rows} {}\n", Hash::NEW.of(&warnings)))
}

/// The lock of a case, which a run has as long as it solves it; nothing as long as another run has it, unless this one is
/// to `wait` for that.
fn locked(lock: &Path, wait: bool) -> Outcome<Option<File>> {
    let file = File::create(lock).map_err(|e| format!("its lock cannot be written: {e}"))?;
    match if wait { file.lock().map_err(TryLockError::Error) } else { file.try_lock() } {
        Err(TryLockError::WouldBlock) => Ok(None),
        // not every file system has locks
        Ok(()) | Err(TryLockError::Error(_)) => Ok(Some(file)),
    }
}

/// The work on the cases of a study.
struct Work<'a> {
    study: &'a Study,
    processes: &'a Processes,
    printing: Printing,
    /// The cases that are to be solved, and those that were done before
    left: Vec<usize>,
    before: usize,
    progress: Mutex<Progress>,
}

/// How far the work is.
#[derive(Default)]
struct Progress {
    next: usize,
    done: usize,
    /// The cases that another run is solving
    elsewhere: Vec<usize>,
    /// The warnings with a code, each of which is said of one case, and not again of the next
    said: HashSet<String>,
    /// The first case that was refused for a reason, and how many were
    refused: HashMap<String, (usize, usize)>,
}

/// Solves the cases with these numbers that are not done, some at a time.
///
/// # Errors
/// How many cases were refused, each reason having been said with the first case of it.
pub fn solve(
    tool: &clap::Command,
    study: &Study,
    chosen: &[usize],
    jobs: usize,
    printing: Printing,
    processes: &Processes,
) -> Outcome<()> {
    let folder = folder(&study.out);
    fs::create_dir_all(&folder).map_err(|e| Error::unwritable(&folder, e))?;
    let jobs = jobs.min(chosen.len().max(1));
    let threads = (threads::count() / jobs).max(1);
    // equal cases are one
    let mut known = HashSet::new();
    let new = chosen.iter().copied().filter(|&number| known.insert(&study.cases[number].rows));
    let (done, left): (Vec<_>, Vec<_>) = new.partition(|&number| is_done(&study.cases[number].rows));
    let work = Work { study, processes, printing, left, before: done.len(), progress: Mutex::default() };
    work.stands(0);
    thread::scope(|scope| {
        let begun: Vec<_> =
            (0..jobs).map(|_| scope.spawn(|| threads::on(threads, || work.work(tool.clone())))).collect();
        begun.into_iter().filter_map(|job| job.join().ok()).collect::<Outcome<()>>()
    })?;
    let reasons = work.progress.into_inner().unwrap_or_else(PoisonError::into_inner).refused;
    refused(reasons.into_values().collect(), chosen.len())
}

/// Refuses a study of which some of all cases were refused: by each reason a first case, and how many in all.
fn refused(mut reasons: Vec<(usize, usize)>, of: usize) -> Outcome<()> {
    let count: usize = reasons.iter().map(|(_, count)| count).sum();
    if count == 0 {
        return Ok(());
    }
    reasons.retain(|(_, count)| *count > 1);
    reasons.sort_unstable();
    let alike = reasons.iter().map(|&(first, alike)| {
        let alike = if alike == count { "all".to_owned() } else { alike.to_string() };
        format!(", {alike} as case {}", first + 1)
    });
    let alike: String = alike.collect();
    Err(format!("{count} of {of} cases were refused{alike}: mend the study, and run it again").into())
}

impl Work<'_> {
    fn progress(&self) -> MutexGuard<'_, Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn told(&self, number: usize) -> String {
        format!("case {}: {}", number + 1, self.study.told(&self.study.cases[number]))
    }

    /// Sets what an interruption says of the cases.
    fn stands(&self, done: usize) {
        let (done, all) = (self.before + done, self.before + self.left.len());
        stands(format!("{done} of {all} cases are done: the same command goes on, also within those that were begun"));
    }

    /// Solves one case after the other, as long as there are some, and at the end those of other runs.
    fn work(&self, mut tool: clap::Command) {
        let next = || {
            let mut progress = self.progress();
            progress.next += 1;
            self.left.get(progress.next - 1).copied()
        };
        while let Some(number) = next() {
            self.case(&mut tool, number, false);
        }
        loop {
            let Some(number) = self.progress().elsewhere.pop() else { break };
            self.printing.say(&format!("{} is solved by another run: waiting for it", self.told(number)));
            self.case(&mut tool, number, true);
        }
    }

    /// Solves a case, and says its warnings, or why it is refused; leaves one that another run is solving for later,
    /// unless this one is to `wait`.
    fn case(&self, tool: &mut clap::Command, number: usize, wait: bool) {
        let (name, mut warnings) = (self.told(number), Vec::new());
        let solved = self.solved(tool, &self.study.cases[number], wait, &mut |line| warnings.push(on_terminal(&line)));
        let mut progress = self.progress();
        match solved.map_err(|error| on_terminal(&error.to_string())) {
            Ok(false) => progress.elsewhere.push(number),
            Ok(true) => {
                warnings.retain(|line| !line.contains(": ") || progress.said.insert(line.clone()));
                warnings.iter().for_each(|line| complain("warning", &format!("{name}: {line}")));
                progress.done += 1;
                let (done, of) = (progress.done, self.left.len());
                self.stands(done);
                self.printing.say(&format!("{done:>width$}/{of}  {name}", width = of.to_string().len()));
            }
            Err(error) => {
                let (_, count) = progress.refused.entry(error.clone()).or_insert((number, 0));
                *count += 1;
                if *count == 1 {
                    complain("warning", &format!("{name} is refused: {error}"));
                }
            }
        }
    }

    /// Solves a case that no other run has solved by then; false if another run is solving it, unless this one is to
    /// `wait`.
    fn solved(&self, tool: &mut clap::Command, case: &Case, wait: bool, warn: Warn<'_>) -> Outcome<bool> {
        let lock = case.rows.with_extension("lock");
        let Some(_lock) = locked(&lock, wait)? else { return Ok(false) };
        if !is_done(&case.rows) {
            self.solve(tool, case, warn)?;
        }
        let _ = fs::remove_file(lock);
        Ok(true)
    }

    fn solve(&self, tool: &mut clap::Command, case: &Case, warn: Warn<'_>) -> Outcome<()> {
        let (rows, state) = (&case.rows, state_path(&case.rows));
        let force = !is_whole(rows);
        // a run that has just begun has neither of these yet
        let begun = sum_path(rows).exists() || state.exists();
        if force && begun && fs::metadata(rows).is_ok_and(|file| file.len() > 0) {
            warn("its rows were damaged, and it was solved again".to_owned());
        }
        let mut run = |words: &[_]| parsed(tool, words).map_err(|error| error.to_string());
        let made = match case.surface.as_deref().map(&mut run).transpose()? {
            Some((Command::Surface(options), scene)) => Some(surface::map(&options, &scene)?),
            _ => None,
        };
        let (command, scene) = run(&case.words)?;
        let ((problem, strictness), format) = (command.problem()?, self.study.format);
        let (command, processes, out) = (&*self.study.command, self.processes, rows.clone());
        Run { command, problem, strictness, scene, processes, out, format, force }.solve(made, warn)?;
        write_text(&sum_path(rows), &checksum(rows)?)?;
        // last: what is left with it is not done
        match fs::remove_file(state) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(format!("its state cannot be removed: {error}").into())
            }
            _ => Ok(()),
        }
    }
}
