//! The work on a study: its cases, solved by workers, with the rows of each in a file of a folder.

use std::collections::{HashMap, HashSet};
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Mutex, PoisonError};
use std::thread;

use asperity::Error;
use asperity_scene::Hash;

use super::cases::{Case, Study};
use super::worker::Worker;
use crate::interruption::stands;
use crate::journal::{is_whole, state_path};
use crate::outcome::Outcome;
use crate::output::{with_suffix, write_text};
use crate::printing::{Printing, complain};
use crate::session::UNCONVERGED;
use crate::threads;
use crate::warnings;

/// The folder of the cases, beside the table.
pub struct Folder {
    path: PathBuf,
    extension: &'static str,
}

impl Folder {
    pub fn of(study: &Study) -> Self {
        let path = with_suffix(&study.out, ".cases");
        Self { path, extension: study.format.name() }
    }

    pub fn exists(&self) -> bool {
        self.path.exists()
    }

    /// The file with the rows of a case.
    pub fn rows(&self, case: &Case) -> PathBuf {
        self.path.join(format!("{}.{}", case.identity, self.extension))
    }

    /// The name of the surface that is made for a case, which no file has.
    fn surface(&self, case: &Case) -> PathBuf {
        self.path.join(format!("{}.npz", case.identity))
    }

    /// The file that is locked as long as a run solves a case.
    fn lock(&self, case: &Case) -> PathBuf {
        self.path.join(format!("{}.lock", case.identity))
    }

    /// The lock of a case; nothing as long as another run has it, unless this one is to `wait` for that.
    fn locked(&self, case: &Case, wait: bool) -> Result<Option<File>, String> {
        let file = File::create(self.lock(case)).map_err(|e| format!("its lock cannot be written: {e}"))?;
        match if wait { file.lock().map_err(TryLockError::Error) } else { file.try_lock() } {
            Err(TryLockError::WouldBlock) => Ok(None),
            // not every file system has locks
            Ok(()) | Err(TryLockError::Error(_)) => Ok(Some(file)),
        }
    }

    /// Whether a case has all of its rows, as they were written: what it takes to go on with them is removed then.
    pub fn is_done(&self, case: &Case) -> bool {
        let rows = self.rows(case);
        let sum = fs::read_to_string(sum_path(&rows)).ok();
        !state_path(&rows).exists() && sum.is_some() && sum == checksum(&rows).ok()
    }
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

/// Solves the cases with these numbers that are not done, some at a time.
///
/// # Errors
/// How many cases were refused, each reason having been said with the first case of it.
pub fn solve(
    study: &Study,
    folder: &Folder,
    chosen: &[usize],
    program: &[OsString],
    jobs: usize,
    printing: Printing,
) -> Outcome<()> {
    fs::create_dir_all(&folder.path).map_err(|e| Error::unwritable(&folder.path, e))?;
    let jobs = jobs.min(chosen.len().max(1));
    let threads = (threads::count() / jobs).max(1);
    // equal cases are one
    let (mut known, mut before) = (HashSet::new(), 0);
    let is_left = |number: &usize| {
        let case = &study.cases[*number];
        let is_new = known.insert(case.identity.0);
        let is_done = is_new && folder.is_done(case);
        before += usize::from(is_done);
        is_new && !is_done
    };
    let left: Vec<_> = chosen.iter().copied().filter(is_left).collect();
    let [next, done] = [(); 2].map(|()| AtomicUsize::new(0));
    // a warning with a code is said of one case, and not again of the next: the file of warnings has the cases
    let (refusals, said) = (Mutex::new(HashMap::new()), Mutex::new(HashSet::new()));
    let told = |number: usize| format!("case {}: {}", number + 1, study.told(&study.cases[number]));
    let stand = |done: usize| {
        let (done, all) = (before + done, before + left.len());
        stands(format!("{done} of {all} cases are done: the same command goes on, also within those that were begun"));
    };
    stand(0);
    // whether the case is over, as it is not where another run has it
    let over = |number: usize, worker: &mut Worker<'_>, wait: bool| {
        match solved(study, &study.cases[number], folder, worker, wait) {
            Ok(None) => return false,
            Ok(Some(warnings)) => {
                let name = told(number);
                let mut said = said.lock().unwrap_or_else(PoisonError::into_inner);
                let new = warnings.into_iter().filter(|line| code(line).is_none() || said.insert(line.clone()));
                new.for_each(|line| complain("warning", &format!("{name}: {line}")));
                drop(said);
                let done = done.fetch_add(1, Relaxed) + 1;
                stand(done);
                let width = left.len().to_string().len();
                printing.say(&format!("{done:>width$}/{}  {name}", left.len()));
            }
            Err(error) => {
                let mut refusals = refusals.lock().unwrap_or_else(PoisonError::into_inner);
                let (_, count) = refusals.entry(error.clone()).or_insert((number, 0));
                *count += 1;
                if *count == 1 {
                    complain("warning", &format!("{} is refused: {error}", told(number)));
                }
            }
        }
        true
    };
    let elsewhere = Mutex::new(Vec::new());
    let elsewhere = || elsewhere.lock().unwrap_or_else(PoisonError::into_inner);
    let work = || {
        let mut worker = Worker::new(program, threads);
        while let Some(&number) = left.get(next.fetch_add(1, Relaxed)) {
            if !over(number, &mut worker, false) {
                elsewhere().push(number);
            }
        }
        loop {
            let Some(number) = elsewhere().pop() else { break };
            printing.say(&format!("{} is solved by another run: waiting for it", told(number)));
            over(number, &mut worker, true);
        }
    };
    thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(work);
        }
    });
    refused(refusals.into_inner().unwrap_or_else(PoisonError::into_inner).into_values().collect(), chosen.len())
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

/// Solves a case that no other run has solved by then; the warnings of its runs, or the line by which one was refused.
/// None if another run is solving the case, unless this one is to `wait`.
fn solved(
    study: &Study,
    case: &Case,
    folder: &Folder,
    worker: &mut Worker<'_>,
    wait: bool,
) -> Result<Option<Vec<String>>, String> {
    let Some(_lock) = folder.locked(case, wait)? else { return Ok(None) };
    let mut warnings = Vec::new();
    if !folder.is_done(case) {
        warnings = rows_of(study, case, folder, worker)?;
    }
    let _ = fs::remove_file(folder.lock(case));
    Ok(Some(warnings))
}

/// Solves a case; the warnings of its runs, or the line by which one was refused.
fn rows_of(study: &Study, case: &Case, folder: &Folder, worker: &mut Worker<'_>) -> Result<Vec<String>, String> {
    let (rows, made) = (folder.rows(case), folder.surface(case));
    let command = |name: &str, arguments: &[OsString], out: &Path| {
        let before = ["asperity", name, "--quiet", "--out"].map(OsString::from);
        [&before[..], &[out.into()], arguments].concat()
    };
    let mut warnings = Vec::new();
    let mut fill = command(&study.command, &case.arguments, &rows);
    if !is_whole(&rows) {
        // a run that has just begun has neither of these yet
        let begun = sum_path(&rows).exists() || state_path(&rows).exists();
        if begun && fs::metadata(&rows).is_ok_and(|file| file.len() > 0) {
            warnings.push("its rows were damaged, and it was solved again".to_owned());
        }
        fill.push("--force".into());
    }
    let mut make = None;
    if let Some(surface) = &case.surface {
        fill.extend(["--heights".into(), made.clone().into()]);
        make = Some([command("surface", surface, &made), vec!["--force".into()]].concat());
    }
    let said = worker.run(&make.into_iter().chain([fill]).collect::<Vec<_>>())?;
    // rows that did not converge are counted in the table
    warnings.extend(said.into_iter().filter(|line| code(line) != Some(UNCONVERGED)));
    checksum(&rows).and_then(|sum| write_text(&sum_path(&rows), &sum)).map_err(|error| error.to_string())?;
    // last: what is left with it is not done
    match fs::remove_file(state_path(&rows)) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(format!("its state cannot be removed: {error}")),
        _ => Ok(warnings),
    }
}

/// The code of a warning, which stands before its message.
fn code(line: &str) -> Option<&str> {
    line.split_once(": ").map(|(code, _)| code)
}
