//! The arguments of the examples that draw.

use std::path::PathBuf;

/// The values of `--size N` and `--out PATH`, or the given defaults.
pub fn size_and_out(size: usize, out: &str) -> Result<(usize, PathBuf), String> {
    let (mut size, mut out) = (size, PathBuf::from(out));
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or_else(|| format!("{name}: a value must follow"))?;
        match name.as_str() {
            "--size" => size = value.parse().map_err(|e| format!("--size {value}: {e}"))?,
            "--out" => out = value.into(),
            _ => return Err(format!("{name}: the options are --size N and --out PATH")),
        }
    }
    Ok((size, out))
}
