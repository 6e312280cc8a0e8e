//! The work on a study: its cases, solved on threads, with the rows of each in a file of a folder.

use std::collections::{HashMap, HashSet, VecDeque};
use std::fs::{self, File, TryLockError};
use std::io;
use std::iter;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::thread;

use asperity::Error;
use asperity_scene::journal::{is_whole, state_path};
use asperity_scene::output::{with_suffix, write_text};
use asperity_scene::{Hash, Outcome, Processes, warnings};

use super::case::Run;
use super::cases::Study;
use crate::interruption::stands;
use crate::printing::{Printing, Warn, complain, on_terminal};
use crate::threads;
use crate::{named, surface};

/// The folder of the cases, next to the table.
pub fn folder(table: &Path) -> PathBuf {
    with_suffix(table, ".cases")
}

/// Whether a case has all of its rows, as they were written: what it takes to continue them is removed then.
pub fn is_done(rows: &Path) -> bool {
    let sum = fs::read_to_string(sum_path(rows)).ok();
    !state_path(rows).exists() && sum.is_some() && sum == checksum(rows).ok()
}

/// The file with the checksum of rows, next to them.
fn sum_path(rows: &Path) -> PathBuf {
    with_suffix(rows, ".sum")
}

/// The checksum of rows, with the checksum of their warnings.
fn checksum(rows: &Path) -> asperity::Result<String> {
    let of_rows = Hash::NEW.extend(&fs::read(rows).map_err(|e| Error::unreadable(rows, e))?);
    let warnings = fs::read(warnings::path_for(rows)).unwrap_or_default();
    Ok(format!("{of_rows} {}\n", Hash::NEW.extend(&warnings)))
}

/// How far the work is.
#[derive(Default)]
struct Progress {
    /// The cases that nobody has taken, and those that another run is solving
    left: VecDeque<usize>,
    elsewhere: Vec<usize>,
    done: usize,
    /// The warnings with a code: each is said of one case, and not again of the next
    said: HashSet<String>,
    /// The first case that was refused for a reason, and how many were
    refused: HashMap<String, (usize, usize)>,
}

impl Progress {
    /// Notes that a case was refused, and says the reason with the first such case.
    fn refuse(&mut self, number: usize, name: &str, reason: String) {
        let (_, count) = self.refused.entry(reason.clone()).or_insert((number, 0));
        *count += 1;
        if *count == 1 {
            complain("warning", &format!("{name} is refused: {reason}"));
        }
    }

    /// How many of the cases were refused, if any.
    fn refusal(&self, of: usize) -> Outcome<()> {
        let mut reasons: Vec<_> = self.refused.values().copied().collect();
        let refused: usize = reasons.iter().map(|(_, count)| count).sum();
        if refused == 0 {
            return Ok(());
        }
        reasons.retain(|(_, count)| *count > 1);
        reasons.sort_unstable();
        let alike = |&(first, count): &(usize, usize)| {
            let alike = if count == refused { "all".to_owned() } else { count.to_string() };
            format!(", {alike} as case {}", first + 1)
        };
        let alike: String = reasons.iter().map(alike).collect();
        Err(format!("{refused} of {of} cases were refused{alike}: mend the study, and run it again").into())
    }
}

/// Solves the cases with these numbers that are not done, some at a time.
///
/// # Errors
/// How many cases were refused, each reason having been said with the first case of it.
pub fn solve(
    tool: &clap::Command,
    study: &Study,
    chosen: impl ExactSizeIterator<Item = usize>,
    jobs: usize,
    printing: Printing,
    processes: &Processes,
) -> Outcome<()> {
    let (folder, of) = (folder(&study.out), chosen.len());
    fs::create_dir_all(&folder).map_err(|e| Error::unwritable(&folder, e))?;
    // equal cases are one
    let mut known = HashSet::new();
    let new = chosen.filter(|&number| known.insert(&study.cases[number].rows));
    let (before, left): (VecDeque<_>, _) = new.partition(|&number| is_done(&study.cases[number].rows));
    let (before, count) = (before.len(), left.len());
    let jobs = jobs.min(count).max(1);
    let threads = (threads::count() / jobs).max(1);
    let stand = |done: usize| {
        let (done, all) = (before + done, before + count);
        stands(format!(
            "{done} of {all} cases are done: the same command continues, also within those that were begun"
        ));
    };
    stand(0);
    let progress = Mutex::new(Progress { left, ..Progress::default() });
    let progress = || progress.lock().unwrap_or_else(PoisonError::into_inner);
    let solve = |number: usize, wait: bool| {
        let case = &study.cases[number];
        let (name, mut warnings) = (format!("case {}: {}", number + 1, study.describe(case)), Vec::new());
        if wait {
            printing.say(&format!("{name} is solved by another run: waiting for it"));
        }
        let mut warn = |line: String| warnings.push(on_terminal(&line));
        let solved = solved(tool, study, number, processes, wait, &mut warn);
        let mut progress = progress();
        match solved.map_err(|error| on_terminal(&error.to_string())) {
            Ok(false) => progress.elsewhere.push(number),
            Ok(true) => {
                warnings.retain(|line| !line.contains(": ") || progress.said.insert(line.clone()));
                warnings.iter().for_each(|line| complain("warning", &format!("{name}: {line}")));
                progress.done += 1;
                stand(progress.done);
                let width = count.to_string().len();
                printing.say(&format!("{:>width$}/{count}  {name}", progress.done));
            }
            Err(error) => progress.refuse(number, &name, error),
        }
    };
    let work = || {
        iter::from_fn(|| progress().left.pop_front()).for_each(|number| solve(number, false));
        iter::from_fn(|| progress().elsewhere.pop()).for_each(|number| solve(number, true));
    };
    thread::scope(|scope| {
        let begun: Vec<_> = (0..jobs).map(|_| scope.spawn(|| threads::on(threads, work))).collect();
        begun.into_iter().try_for_each(|job| job.join().unwrap_or_else(|panic| resume_unwind(panic)))
    })?;
    progress().refusal(of)
}

/// Solves a case that no other run has solved by then, and tells its warnings; false if another run is solving it, unless
/// this one is to `wait`.
fn solved(
    tool: &clap::Command,
    study: &Study,
    number: usize,
    processes: &Processes,
    wait: bool,
    warn: Warn<'_>,
) -> Outcome<bool> {
    let rows = &study.cases[number].rows;
    let (state, lock) = (state_path(rows), rows.with_extension("lock"));
    let file = File::create(&lock).map_err(|e| format!("its lock cannot be written: {e}"))?;
    // not every file system has locks
    if let Err(TryLockError::WouldBlock) = if wait { file.lock().map_err(TryLockError::Error) } else { file.try_lock() }
    {
        return Ok(false);
    }
    if !is_done(rows) {
        let force = !is_whole(rows);
        // a run that has just begun has neither of these yet
        let begun = sum_path(rows).exists() || state.exists();
        if force && begun && fs::metadata(rows).is_ok_and(|file| file.len() > 0) {
            warn("its rows were damaged, and it was solved again".to_owned());
        }
        let mut scenes = study.scenes(number, tool)?;
        let scene = scenes.pop().ok_or("it has no command")?;
        let made = scenes.pop().map(|scene| surface::map(&scene.given)).transpose()?;
        let (problem, format, out) = ((named(scene.command)?.problem)(&scene.given)?, study.format, rows.clone());
        Run { problem, scene, processes, out, format, force }.solve(made, warn)?;
        write_text(&sum_path(rows), &checksum(rows)?)?;
        // last: what is left with it is not done
        if let Err(error) = fs::remove_file(state)
            && error.kind() != io::ErrorKind::NotFound
        {
            return Err(format!("its state cannot be removed: {error}").into());
        }
    }
    let _ = fs::remove_file(lock);
    Ok(true)
}
