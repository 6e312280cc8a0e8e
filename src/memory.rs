//! The memory that there is.

use std::fs;

use crate::error::{Error, Result};
use crate::slab::Slab;

/// What any program may take, in bytes: 64 MiB. Less is not asked for first.
const SMALL: f64 = 67_108_864.0;

/// The memory that a solve may take, in bytes, as the system tells it; infinite where it does not tell.
///
/// ```
/// use asperity::accuracy::{Accuracy, Quantity, available_memory};
/// let wanted = Accuracy { memory: available_memory(), ..Accuracy::new(0.01, Quantity::Area) };
/// assert!(wanted.memory > 0.0);
/// ```
pub fn available_memory() -> f64 {
    told("MemAvailable:").unwrap_or(f64::INFINITY)
}

/// A line of what the system tells of its memory, in bytes.
fn told(name: &str) -> Option<f64> {
    let told = fs::read_to_string("/proc/meminfo").ok()?;
    let line = told.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok().map(|kilobytes| 1024.0 * kilobytes)
}

/// Refuses what takes more memory than the system has, or gives to this process.
///
/// An allocation that fails ends the process, so that it is asked for as a whole before the first of its parts, and
/// given back. Where several processes share the grid, each asks for its own rows.
pub(crate) fn afford(what: &str, slab: Slab, bytes_per_node: usize) -> Result<()> {
    let ((nx, ny), (rows, _)) = (slab.shape(), slab.held());
    let bytes = rows as f64 * ny as f64 * bytes_per_node as f64;
    let what = || format!("{what} on {nx} x {ny} nodes");
    let affordable = if is_there(bytes) { Ok(()) } else { Err(Error::Memory { what: what(), bytes }) };
    slab.agreed(affordable)
}

/// Whether the system has so many bytes, and gives them to this process.
pub(crate) fn is_there(bytes: f64) -> bool {
    let given = || Vec::<u8>::new().try_reserve_exact(bytes as usize).is_ok();
    bytes <= SMALL || bytes <= available_memory() + told("SwapFree:").unwrap_or(0.0) && given()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_no_system_has_is_refused() {
        let asked = |shape| afford("a solve", Slab::whole(shape), 40);
        let error = asked((1 << 20, 1 << 20)).unwrap_err();
        assert_eq!(
            error,
            Error::Memory { what: "a solve on 1048576 x 1048576 nodes".into(), bytes: 40.0 * (1_u64 << 40) as f64 }
        );
        assert!(error.to_string().contains("40960.0 GiB"), "{error}");
        // more bytes than there are addresses
        assert!(asked((1 << 40, 1 << 40)).is_err());
        assert_eq!(asked((1 << 11, 1 << 11)), Ok(()));
    }
}
