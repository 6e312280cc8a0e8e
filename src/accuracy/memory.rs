//! The memory that is there.

/// The memory that a solve may take, in bytes, as the system tells it; infinite where it does not tell.
///
/// ```
/// use asperity::accuracy::{Accuracy, Quantity, available_memory};
/// let wanted = Accuracy { memory: available_memory(), ..Accuracy::new(0.01, Quantity::Area) };
/// assert!(wanted.memory > 0.0);
/// ```
pub fn available_memory() -> f64 {
    let told = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let line = told.lines().find_map(|line| line.strip_prefix("MemAvailable:"));
    let kilobytes = line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok());
    kilobytes.map_or(f64::INFINITY, |kilobytes| 1024.0 * kilobytes)
}
