//! The memory of the machine, in bytes, as `/proc/meminfo` tells it.

use std::fs;

use asperity::{Error, Result};

/// Bytes that are taken without a look at the free memory: 64 MiB.
pub const SMALL: f64 = 67_108_864.0;

/// The free memory of the machine, in bytes; infinite where the system does not tell it.
///
/// ```
/// use asperity::accuracy::{Accuracy, Quantity};
/// use asperity_maps::io::available_memory;
/// let wanted = Accuracy::new(0.01, Quantity::Area).memory(available_memory());
/// assert!(wanted.memory > 0.0);
/// ```
pub fn available_memory() -> f64 {
    memory_line("MemAvailable:").unwrap_or(f64::INFINITY)
}

/// A line of `/proc/meminfo`, in bytes.
fn memory_line(name: &str) -> Option<f64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok().map(|kilobytes| 1024.0 * kilobytes)
}

/// Refuses fields, as `what`, that take more than 64 MiB and more than the free memory of the machine with its swap.
///
/// The system grants allocations beyond its memory, and kills the process that uses them.
///
/// # Errors
/// [`Error::Memory`].
///
/// ```
/// use asperity::ErrorKind;
/// use asperity_maps::io::check_memory;
/// check_memory("a solve", (512, 512), 40)?;
/// # #[cfg(target_os = "linux")]
/// assert_eq!(check_memory("a solve", (1 << 40, 1 << 40), 40).unwrap_err().kind(), ErrorKind::Memory);
/// # Ok::<(), asperity::Error>(())
/// ```
#[doc(hidden)]
pub fn check_memory(what: &str, (nx, ny): (usize, usize), bytes_per_node: usize) -> Result<()> {
    let bytes = nx as f64 * ny as f64 * bytes_per_node as f64;
    if is_there(bytes) { Ok(()) } else { Err(Error::Memory { what: format!("{what} on {nx} x {ny} nodes"), bytes }) }
}

/// Whether the machine has so many bytes; in WebAssembly, whether they can be had in one piece.
pub(super) fn is_there(bytes: f64) -> bool {
    if cfg!(target_family = "wasm") {
        return bytes < usize::MAX as f64 && Vec::<u8>::new().try_reserve_exact(bytes as usize).is_ok();
    }
    bytes <= SMALL || bytes <= available_memory() + memory_line("SwapFree:").unwrap_or(0.0)
}
