//! The threads of the tool.

use asperity_scene::Outcome;

/// Makes every solve of this process use so many threads.
#[cfg(feature = "parallel")]
pub fn use_threads(threads: Option<usize>) -> Outcome<()> {
    if let Some(threads) = threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
        pool.map_err(|e| format!("{threads} threads cannot be started ({e}): use fewer --threads"))?;
    }
    Ok(())
}

/// Refuses more threads than one: this tool was built without them.
#[cfg(not(feature = "parallel"))]
pub fn use_threads(threads: Option<usize>) -> Outcome<()> {
    match threads {
        Some(threads) if threads > 1 => {
            Err(format!("--threads is {threads}: this tool was built without threads, leave the option out").into())
        }
        _ => Ok(()),
    }
}

/// The result of `work` on this number of threads, whatever number other solves use.
#[cfg(feature = "parallel")]
pub fn on<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> Outcome<R> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|e| format!("{threads} threads cannot be started ({e}): free some memory"))?.install(work))
}

/// The result of `work`: this tool was built without threads.
#[cfg(not(feature = "parallel"))]
pub fn on<R>(_threads: usize, work: impl FnOnce() -> R) -> Outcome<R> {
    Ok(work())
}

/// The number of threads of a solve.
pub fn count() -> usize {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "parallel"))]
    1
}
